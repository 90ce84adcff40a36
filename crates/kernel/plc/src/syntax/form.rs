//! The table of commands: spelling, legal operands, nominal time and code length [000:12054-14735].

/// Kinds of operands that the table tells apart.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub(crate) enum Class {
    /// The command stands alone.
    None,
    /// M, I, O, T, C; also a bracket on the logic accumulator.
    Bit,
    /// B; also a bracket on the word accumulator.
    Byte,
    /// W.
    Word,
    /// D.
    Double,
    /// K.
    Constant,
    /// S0 to S3, S0^X.
    TextMemory,
    /// S"text"; the code grows with the text.
    TextLiteral,
    /// S#E, S#D.
    TextReference,
    /// The name of a constants field.
    Field,
    /// Name or number of a label.
    Label,
    /// The number of an internal module.
    Module,
    /// The name of a source file.
    File,
}

/// What one form of a command costs.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) struct Cost {
    /// Nominal time in ns: the upper bound that the manual prints.
    pub time: u32,
    /// The same when a jump or call is not taken.
    pub skipped: u32,
    /// Code length in bytes.
    pub bytes: u16,
}

/// Time of the forms for which the manual prints none, in ns.
const UNPRINTED_TIME: u32 = 500;
/// Code length of the forms for which the manual prints none (inferred from their neighbours).
const UNPRINTED_BYTES: u16 = 8;

/// Nominal time, ns, and length of code, bytes.
const fn cost(time: u32, bytes: u16) -> Cost {
    Cost {
        time,
        skipped: time,
        bytes,
    }
}

/// Times of a jump taken and not taken, and length.
const fn jump(time: u32, skipped: u32, bytes: u16) -> Cost {
    Cost { time, skipped, bytes }
}

/// Neither time nor length is printed.
const U: Cost = cost(UNPRINTED_TIME, UNPRINTED_BYTES);

macro_rules! forms {
    ($($id:ident $spelling:literal { $($class:ident: $cost:expr),+ $(,)? })+) => {
        /// A command by its spelling.
        #[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
        pub(crate) enum Mnemonic { $($id),+ }

        impl Mnemonic {
            /// All commands, in the order of the table.
            pub(crate) const ALL: &[Mnemonic] = &[$(Mnemonic::$id),+];

            /// How programs write it, in capitals.
            pub(crate) const fn spelling(self) -> &'static str {
                match self { $(Mnemonic::$id => $spelling,)+ }
            }

            /// Its legal operands with their costs.
            pub(crate) const fn forms(self) -> &'static [(Class, Cost)] {
                match self { $(Mnemonic::$id => const { &[$((Class::$class, $cost)),+] },)+ }
            }
        }
    };
}

forms! {
    Load "L" { Bit: cost(700, 4), Byte: cost(800, 6), Word: cost(800, 6), Double: cost(700, 4), Constant: cost(300, 6),
        TextMemory: cost(80_000, 10), TextLiteral: cost(80_000, 18), TextReference: cost(80_000, 24), Field: U }
    LoadNot "LN" { Bit: cost(700, 6), Byte: cost(1600, 8), Word: cost(1600, 8), Double: cost(700, 6), Constant: cost(300, 8) }
    LoadMinus "L-" { Byte: cost(1600, 8), Word: cost(1600, 8), Double: cost(700, 6), Constant: cost(300, 8) }
    LoadByte "LB" { Bit: cost(12_500, 18) }
    LoadWord "LW" { Bit: cost(23_800, 18) }
    LoadDouble "LD" { Bit: cost(46_500, 16) }
    Assign "=" { Bit: cost(500, 4), Byte: cost(500, 4), Word: cost(500, 4), Double: cost(500, 4), TextMemory: cost(80_000, 10) }
    AssignByte "B=" { Bit: cost(11_700, 14) }
    AssignWord "W=" { Bit: cost(22_700, 14) }
    AssignDouble "D=" { Bit: cost(44_700, 14) }
    AssignNot "=N" { Bit: U, Byte: U, Word: U, Double: U }
    AssignMinus "=-" { Byte: U, Word: U, Double: U }
    Set "S" { Bit: cost(800, 8) }
    Reset "R" { Bit: cost(800, 8) }
    SetNot "SN" { Bit: cost(800, 8) }
    ResetNot "RN" { Bit: cost(800, 8) }
    And "A" { Bit: U, Byte: U, Word: U, Double: U, Constant: U }
    AndNot "AN" { Bit: cost(900, 8), Byte: cost(900, 8), Word: cost(900, 8), Double: cost(900, 8), Constant: cost(500, 10) }
    Or "O" { Bit: U, Byte: U, Word: U, Double: U, Constant: U }
    OrNot "ON" { Bit: U, Byte: U, Word: U, Double: U, Constant: U }
    Xor "XO" { Bit: U, Byte: U, Word: U, Double: U, Constant: U }
    XorNot "XON" { Bit: cost(900, 8), Byte: cost(900, 8), Word: cost(900, 8), Double: cost(900, 8), Constant: cost(500, 10) }
    Plus "+" { Byte: cost(700, 8), Word: cost(700, 8), Double: cost(700, 4), Constant: cost(500, 6),
        TextMemory: cost(80_000, 10), TextLiteral: cost(80_000, 18), TextReference: cost(80_000, 24) }
    Minus "-" { Byte: cost(700, 8), Word: cost(700, 8), Double: cost(700, 4), Constant: cost(500, 6) }
    Multiply "X" { Byte: cost(4300, 14), Word: cost(4300, 14), Double: cost(3800, 10), Constant: cost(3800, 14) }
    Divide "/" { Byte: cost(7700, 16), Word: cost(7700, 16), Double: cost(7000, 14), Constant: cost(6700, 16) }
    Modulo "MOD" { Byte: cost(8000, 18), Word: cost(8000, 18), Double: cost(7300, 16), Constant: cost(7800, 12) }
    Increment "INC" { Byte: U, Word: U, Double: U }
    IncrementWord "INCW" { None: U }
    IncrementIndex "INCX" { None: U }
    Decrement "DEC" { Byte: U, Word: U, Double: U }
    DecrementWord "DECW" { None: U }
    DecrementIndex "DECX" { None: U }
    Equal "==" { Byte: cost(1200, 6), Word: cost(1200, 6), Double: cost(1200, 6), Constant: cost(500, 8),
        TextMemory: cost(100_000, 12), TextLiteral: cost(100_000, 20), TextReference: cost(100_000, 26) }
    Less "<" { Byte: cost(1200, 6), Word: cost(1200, 6), Double: cost(1200, 6), Constant: cost(500, 8),
        TextMemory: cost(100_000, 12), TextLiteral: cost(100_000, 20), TextReference: cost(100_000, 26) }
    Greater ">" { Byte: cost(1200, 6), Word: cost(1200, 6), Double: cost(1200, 6), Constant: cost(500, 8),
        TextMemory: cost(100_000, 12), TextLiteral: cost(100_000, 20), TextReference: cost(100_000, 26) }
    LessEqual "<=" { Byte: cost(1200, 6), Word: cost(1200, 6), Double: cost(1200, 6), Constant: cost(500, 8),
        TextMemory: cost(100_000, 12), TextLiteral: cost(100_000, 20), TextReference: cost(100_000, 26) }
    GreaterEqual ">=" { Byte: cost(1200, 6), Word: cost(1200, 6), Double: cost(1200, 6), Constant: cost(500, 8),
        TextMemory: cost(100_000, 12), TextLiteral: cost(100_000, 20), TextReference: cost(100_000, 26) }
    NotEqual "<>" { Byte: cost(1200, 6), Word: cost(1200, 6), Double: cost(1200, 6), Constant: cost(500, 8),
        TextMemory: cost(100_000, 12), TextLiteral: cost(100_000, 20), TextReference: cost(100_000, 26) }
    // Brackets: the printed time is that of opening and closing together; Bit stands for a bracket on the
    // logic accumulator, Byte for one on the word accumulator.
    OpenAnd "A[" { None: U, Bit: cost(1200, 6), Byte: cost(1300, 6) }
    OpenAndNot "AN[" { None: U, Bit: cost(1200, 6), Byte: cost(1500, 6) }
    OpenOr "O[" { None: U, Bit: cost(1200, 6), Byte: cost(1300, 6) }
    OpenOrNot "ON[" { None: U, Bit: cost(1200, 6), Byte: cost(1500, 6) }
    OpenXor "XO[" { None: U, Bit: cost(1200, 6), Byte: cost(1500, 6) }
    OpenXorNot "XON[" { None: U, Bit: cost(1500, 8), Byte: cost(1500, 8) }
    OpenPlus "+[" { None: cost(2200, 6) }
    OpenMinus "-[" { None: cost(2100, 6) }
    OpenMultiply "X[" { None: cost(4700, 12) }
    OpenDivide "/[" { None: cost(7500, 16) }
    OpenModulo "MOD[" { None: cost(7500, 14) }
    OpenEqual "==[" { None: cost(800, 6) }
    OpenLess "<[" { None: cost(800, 6) }
    OpenGreater ">[" { None: cost(800, 6) }
    OpenLessEqual "<=[" { None: cost(800, 6) }
    OpenGreaterEqual ">=[" { None: cost(800, 6) }
    OpenNotEqual "<>[" { None: cost(800, 6) }
    Close "]" { None: cost(0, 0) }
    ShiftLeft "<<" { Byte: cost(1000, 6), Word: cost(1000, 6), Double: cost(1000, 6), Constant: cost(600, 8) }
    ShiftRight ">>" { Byte: cost(900, 6), Word: cost(900, 6), Double: cost(900, 6), Constant: cost(500, 8) }
    BitSet "BS" { Byte: cost(800, 6), Word: cost(800, 6), Double: cost(800, 6), Constant: cost(400, 8) }
    BitClear "BC" { Byte: cost(800, 6), Word: cost(800, 6), Double: cost(800, 6), Constant: cost(400, 8) }
    BitTest "BT" { Byte: cost(1100, 8), Word: cost(1100, 8), Double: cost(1100, 8), Constant: cost(500, 0) }
    Push "PS" { Bit: cost(2000, 24), Byte: cost(2000, 26), Word: cost(2000, 26), Double: cost(1800, 22), Constant: cost(1100, 24) }
    Pull "PL" { Bit: cost(1500, 20), Byte: cost(1300, 20), Word: cost(1300, 20), Double: cost(1300, 18) }
    PushLogic "PSL" { None: cost(1000, 20) }
    PushWord "PSW" { None: cost(1100, 20) }
    PullLogic "PLL" { None: cost(1000, 16) }
    PullWord "PLW" { None: cost(1100, 16) }
    PushIndex "PSX" { None: U }
    PullIndex "PLX" { None: U }
    LoadIndex "LX" { None: U }
    StoreIndex "=X" { None: U }
    Overwrite "OVWR" { TextMemory: cost(80_000, 10) }
    Jump "JP" { Label: cost(1000, 8) }
    JumpTrue "JPT" { Label: jump(1300, 500, 12) }
    JumpFalse "JPF" { Label: jump(1300, 500, 12) }
    Call "CM" { Label: cost(2200, 22), Module: cost(2100, 24) }
    CallTrue "CMT" { Label: jump(2500, 500, 26), Module: jump(2400, 500, 28) }
    CallFalse "CMF" { Label: jump(2500, 500, 26), Module: jump(2400, 500, 28) }
    End "EM" { None: cost(3800, 4) }
    EndTrue "EMT" { None: U }
    EndFalse "EMF" { None: U }
    Label "LBL" { Label: cost(0, 0) }
    IfTrue "IFT" { None: U }
    IfFalse "IFF" { None: U }
    Else "ELSE" { None: U }
    EndIf "ENDI" { None: U }
    Repeat "REPEAT" { None: U }
    UntilTrue "UNTILT" { None: U }
    UntilFalse "UNTILF" { None: U }
    WhileTrue "WHILET" { None: U }
    WhileFalse "WHILEF" { None: U }
    EndWhile "ENDW" { None: U }
    Case "CASE" { Byte: cost(3800, 46), Word: cost(3800, 44) }
    EndCase "ENDC" { None: cost(0, 0) }
    Field "KFIELD" { Label: cost(0, 0) }
    EndField "ENDK" { None: cost(0, 0) }
    // A constant takes the four bytes of its value (inferred).
    Constant "K" { Constant: cost(0, 4) }
    Submit "SUBM" { Label: cost(30_000, 10) }
    Reply "RPLY" { Byte: cost(5000, 10), Word: cost(5000, 10), Double: cost(5000, 10) }
    Cancel "CAN" { Byte: cost(40_000, 10), Word: cost(40_000, 10), Double: cost(40_000, 10) }
    Uses "USES" { File: cost(0, 0) }
    Global "GLOBAL" { Label: cost(0, 0) }
    Extern "EXTERN" { Label: cost(0, 0) }
}

/// Commands of the TNC 355 in German letters [000:16189-16202].
pub(crate) const TNC_355: [(&str, Mnemonic); 2] = [("UN", Mnemonic::AndNot), ("U", Mnemonic::And)];

/// Code of one entry of a CASE table, in bytes [000:14541].
pub(crate) const CASE_ENTRY_BYTES: u16 = 4;

impl Mnemonic {
    /// What the form with operands of a class costs.
    pub(crate) fn cost(self, class: Class) -> Option<Cost> {
        self.forms()
            .iter()
            .find(|(candidate, _)| *candidate == class)
            .map(|(_, cost)| *cost)
    }

    /// Whether operands of a class are legal.
    pub(crate) fn takes(self, class: Class) -> bool {
        self.cost(class).is_some()
    }

    /// Whether it opens a bracket.
    pub(crate) fn opens_bracket(self) -> bool {
        self.spelling().ends_with('[')
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::collections::HashSet;

    #[test]
    fn spellings_are_unique() {
        let spellings: HashSet<&str> = Mnemonic::ALL.iter().map(|m| m.spelling()).collect();
        assert_eq!(spellings.len(), Mnemonic::ALL.len());
    }

    #[test]
    fn every_command_of_the_manual_is_there() {
        let manual = "L LN L- LB LW LD = B= W= D= =N =- S R SN RN A AN O ON XO XON + - X / MOD INC INCW INCX DEC DECW \
            DECX == < > <= >= <> A[ AN[ O[ ON[ XO[ XON[ +[ -[ X[ /[ MOD[ ==[ <[ >[ <=[ >=[ <>[ ] << >> BS BC BT PS \
            PL PSL PSW PLL PLW PSX PLX LX =X OVWR JP JPT JPF CM CMT CMF EM EMT EMF LBL IFT IFF ELSE ENDI REPEAT \
            UNTILT UNTILF WHILET WHILEF ENDW CASE ENDC KFIELD ENDK K SUBM RPLY CAN USES GLOBAL EXTERN";
        let known: HashSet<&str> = Mnemonic::ALL.iter().map(|m| m.spelling()).collect();
        for command in manual.split_whitespace() {
            assert!(known.contains(command), "{command}");
        }
        assert_eq!(known.len(), manual.split_whitespace().count());
    }
}
