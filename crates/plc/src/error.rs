//! The PLC's errors 0 to 56 [000:11915-12048].

use std::fmt;

macro_rules! errors {
    ($($number:literal $id:ident $when:literal $text:literal;)+) => {
        /// An error of a PLC program. Numbers, detection times and texts are in the table of this file;
        /// 1 and 46 to 49 are spare.
        #[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
        pub enum PlcError {
            $(
                #[doc = concat!("Error ", $number, ", detected ", $when, ": ", $text, ".")]
                $id = $number,
            )+
        }

        impl PlcError {
            /// All errors in the order of their numbers.
            pub const ALL: &[PlcError] = &[$(PlcError::$id),+];

            /// What it says.
            pub const fn text(self) -> &'static str {
                match self { $(PlcError::$id => $text,)+ }
            }

            const fn when(self) -> &'static str {
                match self { $(PlcError::$id => $when,)+ }
            }
        }
    };
}

errors! {
    0 NotACommand "E S C" "not a valid command";
    2 InvalidOperandType "E S C" "invalid operand type";
    3 OperandNotFound "E S C" "operand not found";
    4 OperandOutOfRange "E S C" "operand not in acceptable range";
    5 NoLimiter "E S C" "no limiter after command";
    6 NoEndOfLine "E S C" "no end of line found";
    7 LabelNotDefined "S C" "label not defined";
    8 NoEndOfBlock "S C" "no end of block found";
    9 ProgramTooLong "S C" "program too long (RAM overflow)";
    10 AssignmentInBracket "S C" "assignment to a parenthesis";
    11 BracketsTooDeep "S C" "parenthesis nesting too deep";
    12 JumpInChain "S C" "jump in a gating chain";
    13 CloseWithoutOpen "S C" "close parenthesis with no open parenthesis";
    14 LabelInBracket "S C" "label within a parenthesis";
    15 LabelInChain "S C" "label within a gating chain";
    16 JumpInBracket "S C" "jump within a parenthesis";
    17 BracketOpenAtEnd "S C" "parenthesis opened at end of block";
    18 LabelDefinedTwice "S C" "label defined twice";
    19 NoWordAssignment "S C" "no word assignment";
    20 NoLogicAssignment "S C" "no logic assignment";
    21 WordNotLoaded "S C" "word accumulator not loaded";
    22 LogicNotLoaded "S C" "logic accumulator not loaded";
    23 NothingLoadedAtBracket "S C" "accumulators not loaded with open parenthesis";
    24 WrongBracketResult "S C" "wrong type of parenthesis result";
    25 ConditionNotLoaded "S C" "conditional jump with invalid logic accumulator";
    26 EndOutsideTable "S C" "ENDC/ENDK outside a CASE/KFIELD instruction";
    27 WrongCommandInTable "S C" "wrong command within CASE table/KFIELD";
    28 TooManyCases "S C" "too many table entries in CASE";
    29 EmptyTable "S C" "blank CASE instruction/KFIELD";
    30 StringNotLoaded "S C" "string accumulator not loaded";
    31 StringInBracket "S C" "string instruction within parentheses";
    32 NoStringAssignment "S C" "no string assignment";
    33 LinkNotAtStart "S C" "GLOBAL/EXTERN not at start of file";
    34 TooManyFiles "(S) C" "too many modules";
    35 FileNotFound "(S) C" "file not found";
    36 FileTooLong "S C" "file too long";
    37 TooManyLabels "S C" "too many local labels";
    38 TooManyGlobals "C" "too many global labels";
    39 ExternNotDefined "C" "external label not defined";
    40 ExternInCase "S C" "external label in CASE instruction";
    41 ExternInJump "S C" "external label in JP instruction";
    42 GlobalTwice "(S) C" "global label defined twice";
    43 WrongStructure "S C" "wrong instruction structure";
    44 StructureOpen "S C" "structure open at end of file";
    45 GlobalInMain "S C" "GLOBAL instruction in main file";
    50 NestingTooDeep "R" "nesting too deep";
    51 StackUnderflow "R" "stack underflow";
    52 StackOverflow "R" "stack overflow";
    53 TimeOut "R" "time out";
    54 CaseOutOfRange "R" "CASE out of range";
    55 ModuleNotDefined "R" "subprogram not defined";
    56 IndexOutOfRange "R" "index error";
}

/// When an error is found [000:11927-11934].
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub enum Detection {
    /// While the line is edited; it stays unformatted.
    Editing,
    /// In the syntax check of soft key COMPILE.
    SyntaxCheck,
    /// Perhaps in the syntax check, otherwise by the compiler.
    MaybeSyntaxCheck,
    /// By the compiler, also at power-on.
    Compiler,
    /// At run time.
    RunTime,
}

impl PlcError {
    /// The number that the control shows.
    pub const fn number(self) -> u8 {
        self as u8
    }

    /// The times at which it can be found.
    pub fn detection(self) -> impl Iterator<Item = Detection> {
        self.when().split(' ').filter_map(|class| match class {
            "E" => Some(Detection::Editing),
            "S" => Some(Detection::SyntaxCheck),
            "(S)" => Some(Detection::MaybeSyntaxCheck),
            "C" => Some(Detection::Compiler),
            "R" => Some(Detection::RunTime),
            _ => None,
        })
    }
}

impl fmt::Display for PlcError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{} {}", self.number(), self.text())
    }
}

/// An error or a warning of the compiler, with its place. A warning carries the number of the error that
/// it would be if the rule were not narrowed for the manual's own listings.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Diagnostic {
    /// Which error.
    pub error: PlcError,
    /// The file, as the program names it.
    pub file: String,
    /// The line, counted from 1.
    pub line: u32,
    /// The character of the line, counted from 1.
    pub column: u32,
    /// What is wrong here; begins with the text of the error.
    pub message: String,
}

impl fmt::Display for Diagnostic {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(
            f,
            "{}:{}:{}: error {}: {}",
            self.file,
            self.line,
            self.column,
            self.error.number(),
            self.message
        )
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_table_has_all_numbers_but_the_spare_ones() {
        let numbers: Vec<u8> = PlcError::ALL.iter().map(|error| error.number()).collect();
        let expected: Vec<u8> = (0..=56).filter(|n| *n != 1 && !(46..=49).contains(n)).collect();
        assert_eq!(numbers, expected);
        for error in PlcError::ALL {
            assert_eq!(
                error.number() >= 50,
                error.detection().eq([Detection::RunTime]),
                "{error}"
            );
        }
    }
}
