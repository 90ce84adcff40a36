//! The compiled form: one [`Op`] per command, operands and labels resolved.

use crate::operand::{BitOperand, NumberOperand, TextOperand, Value};

/// A PLC program that compiled without errors.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct PlcProgram {
    /// All instructions: those of the main file first; the run starts at index 0.
    pub code: Vec<Instruction>,
    /// The files, main file first.
    pub files: Vec<SourceText>,
    /// Constants fields, by the index that [`Op::LoadField`] has.
    pub fields: Vec<Field>,
    /// Jump tables of CASE.
    pub cases: Vec<Vec<Target>>,
    /// Labels and constants fields that the source names, file by file in the order of their first mention.
    pub labels: Vec<Label>,
    /// Length of the code in bytes, as the control counts it.
    pub size_bytes: u32,
}

/// A source file as text.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct SourceText {
    /// Name of the file as the program links it.
    pub name: String,
    /// Its text line by line, without line ends.
    pub lines: Vec<String>,
}

/// A constants field [000:14404-14432].
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Field {
    /// Name after KFIELD.
    pub name: String,
    /// Its constants in their order; X chooses one from 0.
    pub values: Vec<i32>,
}

/// A name of the source: LBL or KFIELD.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Label {
    /// Its name, at most 16 characters, or its number.
    pub name: String,
    /// Where it is defined.
    pub defined: SourceLine,
    /// Instruction or field that it stands for.
    pub place: LabelPlace,
    /// The lines that jump to it, call it, submit it or read from it.
    pub used: Vec<SourceLine>,
}

/// What a label names.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum LabelPlace {
    /// The instruction after an LBL, by its index.
    Code(usize),
    /// A constants field, by its index.
    Field(usize),
}

/// A line of the source.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub struct SourceLine {
    /// Index of the file.
    pub file: usize,
    /// The line, counted from 1.
    pub line: u32,
}

/// One command of the program, with its place in the source.
#[derive(Clone, Debug, PartialEq)]
pub struct Instruction {
    /// Operation with its operands.
    pub op: Op,
    /// Index of its file.
    pub file: u16,
    /// Its line, counted from 1.
    pub line: u32,
    /// Nominal time when it is executed, or when its jump or call is taken, in ns: the upper bound that the
    /// manual prints, 500 ns where it prints none (inferred).
    pub time: u32,
    /// Nominal time when its jump or call is not taken, in ns.
    pub time_skipped: u32,
}

/// What a call goes to.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum Target {
    /// The instruction of this index.
    Code(usize),
    /// An internal module, 9000 to 9255.
    Module(u16),
}

/// When a jump, call or return is executed.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum Condition {
    /// Whatever the logic accumulator is.
    Always,
    /// When the logic accumulator is 1.
    IfTrue,
    /// When the logic accumulator is 0.
    IfFalse,
}

/// How a value is changed while it is loaded or assigned.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum Transform {
    /// It stays as it is.
    Plain,
    /// `LN`, `=N`: one's complement, every bit inverted.
    Not,
    /// `L-`, `=-`: two's complement, the other sign.
    Minus,
}

/// A gate of two values.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum Gate {
    /// `A`: accumulator AND operand.
    And,
    /// `AN`: accumulator AND NOT operand.
    AndNot,
    /// `O`: accumulator OR operand.
    Or,
    /// `ON`: accumulator OR NOT operand.
    OrNot,
    /// `XO`: accumulator XOR operand.
    Xor,
    /// `XON`: NOT (accumulator XOR operand).
    XorNot,
}

/// An arithmetic command; the accumulator stands left.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum Arithmetic {
    /// `+`: sum of accumulator and operand.
    Plus,
    /// `-`: accumulator less operand.
    Minus,
    /// `x`; an overflow sets M3168.
    Multiply,
    /// `/`; division by 0 sets M3169.
    Divide,
    /// `MOD`; division by 0 sets M3170.
    Modulo,
}

/// A comparison; the accumulator stands left.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum Comparison {
    /// `==`: accumulator and operand are equal.
    Equal,
    /// `<`: the accumulator is less.
    Less,
    /// `>`: the accumulator is greater.
    Greater,
    /// `<=`: the accumulator is less or equal.
    LessEqual,
    /// `>=`: the accumulator is greater or equal.
    GreaterEqual,
    /// `<>`: accumulator and operand differ.
    NotEqual,
}

/// Shifts and bit commands on the word accumulator; the operand is the count or the bit number.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum BitOperation {
    /// `<<`: shift to the left by so many bits.
    ShiftLeft,
    /// `>>`: shift to the right by so many bits.
    ShiftRight,
    /// `BS`: the bit of this number becomes 1.
    Set,
    /// `BC`: the bit of this number becomes 0.
    Clear,
}

/// What an instruction does. LA, WA, SA are the logic, word and string accumulators, X the index register.
#[allow(missing_docs, reason = "the variants say what their fields are")]
#[derive(Clone, Debug, PartialEq)]
pub enum Op {
    /// `ENDI`, `REPEAT`: a place only.
    Nop,
    /// LA := operand, or its complement.
    LoadBit { bit: BitOperand, invert: bool },
    /// LA := LA gate operand.
    GateBit { gate: Gate, bit: BitOperand },
    /// Operand := LA, or its complement.
    AssignBit { bit: BitOperand, invert: bool },
    /// `S R SN RN`: operand := `value` when LA is `when`.
    SetBit {
        bit: BitOperand,
        value: bool,
        when: bool,
    },
    /// WA := operand.
    Load { value: Value, transform: Transform },
    /// WA := constant X of a field.
    LoadField { field: usize },
    /// `LB LW LD`: WA := consecutive bits, sign-filled.
    LoadBits { first: BitOperand, count: u8 },
    /// `LX`: WA := X.
    LoadIndex,
    /// WA := WA gate operand, all 32 bits.
    GateWord { gate: Gate, value: Value },
    /// WA := WA operation operand.
    Arithmetic { operation: Arithmetic, value: Value },
    /// WA shifted, or with a bit set or cleared.
    BitOperation { operation: BitOperation, value: Value },
    /// `BT`: LA := bit of WA.
    TestBit { value: Value },
    /// LA := WA comparison operand, over the operand's width.
    Compare { comparison: Comparison, value: Value },
    /// Operand := WA.
    Assign {
        number: NumberOperand,
        transform: Transform,
    },
    /// `B= W= D=`: consecutive bits := WA.
    AssignBits { first: BitOperand, count: u8 },
    /// `=X`: X := WA.
    StoreIndex,
    /// `INC DEC`: operand := operand + `by`.
    StepNumber { number: NumberOperand, by: i8 },
    /// `INCW DECW`: WA := WA + `by`.
    StepWord { by: i8 },
    /// `INCX DECX`: X := X + `by`.
    StepIndex { by: i8 },
    /// Opens a bracket on LA; `level` counts the open brackets outside.
    OpenLogic { level: u8 },
    /// Opens a bracket on WA.
    OpenWord { level: u8 },
    /// LA := LA before the bracket, gate LA.
    CloseLogic { level: u8, gate: Gate },
    /// WA := WA before the bracket, gate WA.
    CloseWord { level: u8, gate: Gate },
    /// WA := WA before the bracket, operation WA.
    CloseArithmetic { level: u8, operation: Arithmetic },
    /// LA := WA before the bracket, comparison WA; 32 bits.
    CloseCompare { level: u8, comparison: Comparison },
    /// `PS` of a bit: 2 bytes.
    PushBit { bit: BitOperand },
    /// `PS` of a number: 4 bytes.
    Push { value: Value },
    /// `PSL`: puts LA on the data stack.
    PushLogic,
    /// `PSW`: puts WA on the data stack.
    PushWord,
    /// `PSX`: puts X on the data stack.
    PushIndex,
    /// `PL` to a bit.
    PullBit { bit: BitOperand },
    /// `PL` to a number.
    Pull { number: NumberOperand },
    /// `PLL`: takes LA from the data stack.
    PullLogic,
    /// `PLW`: takes WA from the data stack.
    PullWord,
    /// `PLX`: takes X from the data stack.
    PullIndex,
    /// SA := text.
    LoadText { text: TextOperand },
    /// SA := SA with text after it.
    AppendText { text: TextOperand },
    /// String memory := SA with its end character.
    AssignText { string: u8, indexed: bool },
    /// Beginning of a string memory := SA.
    OverwriteText { string: u8, indexed: bool },
    /// LA := SA comparison text.
    CompareText {
        comparison: Comparison,
        text: TextOperand,
    },
    /// `JP JPT JPF` and the jumps of structures.
    Jump { condition: Condition, target: usize },
    /// `CM CMT CMF`: calls a module.
    Call { condition: Condition, target: Target },
    /// `EM EMT EMF`: goes back to who called.
    Return { condition: Condition },
    /// Calls the entry of a table of [`PlcProgram::cases`].
    Case { number: NumberOperand, table: usize },
    /// `SUBM`: WA := identifier of the queued job.
    Submit { target: Target },
    /// `RPLY`: WA := state of a job.
    Reply { number: NumberOperand },
    /// `CAN`: takes a submitted job out of the queue.
    Cancel { number: NumberOperand },
}

impl Condition {
    /// Whether it holds for a logic accumulator.
    pub const fn holds(self, logic: bool) -> bool {
        match self {
            Condition::Always => true,
            Condition::IfTrue => logic,
            Condition::IfFalse => !logic,
        }
    }
}

impl Gate {
    /// The gate of two words, bit by bit.
    pub const fn words(self, accumulator: i32, operand: i32) -> i32 {
        match self {
            Gate::And => accumulator & operand,
            Gate::AndNot => accumulator & !operand,
            Gate::Or => accumulator | operand,
            Gate::OrNot => accumulator | !operand,
            Gate::Xor => accumulator ^ operand,
            Gate::XorNot => !(accumulator ^ operand),
        }
    }

    /// The gate of two bits.
    pub const fn bits(self, accumulator: bool, operand: bool) -> bool {
        self.words(accumulator as i32, operand as i32) & 1 != 0
    }
}

impl Transform {
    /// The value as it is loaded or assigned.
    pub const fn apply(self, value: i32) -> i32 {
        match self {
            Transform::Plain => value,
            Transform::Not => !value,
            Transform::Minus => value.wrapping_neg(),
        }
    }
}

impl Comparison {
    /// Whether it holds for an order of left and right.
    pub const fn holds(self, order: std::cmp::Ordering) -> bool {
        match self {
            Comparison::Equal => order.is_eq(),
            Comparison::Less => order.is_lt(),
            Comparison::Greater => order.is_gt(),
            Comparison::LessEqual => order.is_le(),
            Comparison::GreaterEqual => order.is_ge(),
            Comparison::NotEqual => order.is_ne(),
        }
    }
}

impl Arithmetic {
    /// The result, and whether it is correct. Sums wrap; an overflowing product keeps its low 32 bits; a
    /// division by 0 leaves the accumulator; quotients are truncated and remainders have the sign of the
    /// dividend (all inferred) [000:12798-12990].
    pub const fn apply(self, accumulator: i32, operand: i32) -> (i32, bool) {
        match self {
            Arithmetic::Plus => (accumulator.wrapping_add(operand), true),
            Arithmetic::Minus => (accumulator.wrapping_sub(operand), true),
            Arithmetic::Multiply => {
                let (product, overflow) = accumulator.overflowing_mul(operand);
                (product, !overflow)
            }
            Arithmetic::Divide => match operand {
                0 => (accumulator, false),
                _ => {
                    let (quotient, overflow) = accumulator.overflowing_div(operand);
                    (quotient, !overflow)
                }
            },
            Arithmetic::Modulo => match operand {
                0 => (accumulator, false),
                _ => (accumulator.wrapping_rem(operand), true),
            },
        }
    }
}

impl BitOperation {
    /// The result. Counts and bit numbers are taken modulo 32, but 32 itself shifts everything out
    /// (inferred) [000:13489-13523][000:13565].
    pub const fn apply(self, accumulator: i32, operand: i32) -> i32 {
        match self {
            BitOperation::ShiftLeft if operand == 32 => 0,
            BitOperation::ShiftLeft => accumulator.wrapping_shl(operand as u32),
            BitOperation::ShiftRight if operand == 32 => accumulator >> 31,
            BitOperation::ShiftRight => accumulator.wrapping_shr(operand as u32),
            BitOperation::Set => accumulator | bit(operand),
            BitOperation::Clear => accumulator & !bit(operand),
        }
    }
}

/// The mask of a bit number, modulo 32.
pub(crate) const fn bit(number: i32) -> i32 {
    1_i32.wrapping_shl(number as u32)
}

impl PlcProgram {
    /// The text of an instruction's line.
    pub fn line_text(&self, instruction: &Instruction) -> &str {
        let file = self.files.get(usize::from(instruction.file));
        let index = (instruction.line as usize).checked_sub(1);
        file.and_then(|file| file.lines.get(index?))
            .map_or("", String::as_str)
    }

    /// Whether it calls any of these internal modules somewhere.
    pub fn calls_any(&self, modules: &[u16]) -> bool {
        let calls = self.code.iter().filter_map(|instruction| match &instruction.op {
            Op::Call { target, .. } | Op::Submit { target } => Some(target),
            _ => None,
        });
        let mut targets = calls.chain(self.cases.iter().flatten());
        targets.any(|target| matches!(target, Target::Module(number) if modules.contains(number)))
    }

    /// Name of the file of this index; empty where there is none.
    pub fn file_name(&self, file: u16) -> &str {
        self.files
            .get(usize::from(file))
            .map_or("", |file| file.name.as_str())
    }
}
