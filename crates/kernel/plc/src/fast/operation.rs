//! The fast form of a program, operation by operation.

use super::bits::{BitStep, IndexedBit};
use super::words::{Destination, Function, IndexedNumber, Order, Source};
use crate::PlcError;
use crate::operand::NumberOperand;
use crate::program::{Arithmetic, Condition, Transform};

/// A program in its fast form.
#[derive(Clone, Debug, Default)]
pub(crate) struct FastProgram {
    pub(super) code: Vec<FastOp>,
    /// For each operation the index of its first instruction.
    pub(super) origin: Vec<u32>,
    /// The strips of bit instructions, one after the other.
    pub(super) steps: Vec<BitStep>,
    pub(super) leaps: Vec<Leap>,
    pub(super) cases: Vec<Vec<CaseEntry>>,
    /// Nominal time of all instructions before an index when no jump is taken, in ns.
    pub(super) time_before: Vec<i64>,
}

/// How the run of the cyclic program ended.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Run {
    /// Nominal time in ns.
    pub(crate) elapsed: u64,
    /// Index of the last jump or call that was executed.
    pub(crate) last_jump: usize,
    /// The error that stopped it, and the index of the instruction.
    pub(crate) end: Result<(), (PlcError, usize)>,
}

/// One operation: one instruction or several fused.
#[derive(Clone, Copy, Debug)]
pub(super) enum FastOp {
    /// Bit instructions, one after the other.
    Bits { first: u32, count: u32 },
    /// WA := function of WA and operand.
    Word { function: Function, operand: Source },
    /// WA := operand; destination := WA.
    Move { from: Source, to: Destination },
    /// WA := function of `load` and operand; destination := WA.
    Compute {
        load: Source,
        function: Function,
        operand: Source,
        to: Destination,
    },
    /// WA := function of `load` and operand.
    LoadWord {
        load: Source,
        function: Function,
        operand: Source,
    },
    /// LA := WA comparison operand.
    Compare { order: Order, operand: Source },
    /// WA := `load`; LA := WA comparison operand.
    LoadCompare {
        load: Source,
        order: Order,
        operand: Source,
    },
    /// LA := bit of WA.
    TestBit { operand: Source },
    /// Multiplication, division, remainder: with error marker.
    Arithmetic { operation: Arithmetic, operand: Source },
    /// Destination := WA.
    Assign { to: Destination, transform: Transform },
    /// Destination := destination + `by`.
    Step { from: Source, to: Destination, by: i8 },
    /// WA := consecutive bits.
    LoadBits { cell: u16, count: u8 },
    /// Consecutive bits := WA.
    AssignBits { cell: u16, count: u8 },
    /// WA := X.
    LoadIndex,
    /// X := WA.
    StoreIndex,
    /// X := X + `by`.
    StepIndex { by: i8 },
    /// Opens a bracket on WA.
    OpenWord { level: u8 },
    /// WA := function of WA before the bracket and WA.
    CloseWord { level: u8, function: Function },
    /// As [`FastOp::Arithmetic`], with WA before the bracket.
    CloseArithmetic { level: u8, operation: Arithmetic },
    /// LA := WA before the bracket, comparison WA.
    CloseCompare { level: u8, order: Order },
    /// LA := gate of LA and operand; a load is a gate that forgets LA.
    GateIndexed { table: u8, operand: IndexedBit },
    /// Operand := LA, inverted or not.
    AssignIndexed { invert: bool, to: IndexedBit },
    /// Operand := `value` when LA is `when`.
    SetIndexed { value: bool, when: bool, to: IndexedBit },
    /// WA := function of WA and operand.
    WordIndexed {
        function: Function,
        operand: IndexedNumber,
    },
    /// LA := WA comparison operand.
    CompareIndexed { order: Order, operand: IndexedNumber },
    /// Destination := WA.
    AssignWordIndexed { to: IndexedNumber, transform: Transform },
    /// Data stack := operand.
    Push { operand: Source },
    /// Data stack := WA.
    PushWord,
    /// Destination := data stack.
    Pull { to: Destination },
    /// WA := data stack.
    PullWord,
    /// An instruction for the reference interpreter.
    Reference { at: u32 },
    /// A jump of [`FastProgram::leaps`].
    Jump { condition: Condition, leap: u32 },
    /// A call of code.
    Call { condition: Condition, leap: u32 },
    /// A call of an internal module, by the reference interpreter; `extra` is what it costs more than not
    /// being called.
    Module {
        condition: Condition,
        at: u32,
        extra: i32,
    },
    /// The end of a module or of the run; `time` is that of all instructions up to and with this one.
    Return { condition: Condition, time: i64 },
    /// Calls the entry of a table of [`FastProgram::cases`].
    Case { number: NumberOperand, table: u32 },
}

/// A transfer of control from one instruction to another.
///
/// While control does not move, the time of the run is the sum before the instruction plus a constant. A
/// leap adds `shift` to the constant: the sum after its start minus the sum before its target.
#[derive(Clone, Copy, Debug)]
pub(super) struct Leap {
    /// Index of the instruction that is the target.
    pub(super) target: u32,
    /// Index of its operation.
    pub(super) to: u32,
    /// Index of the jump or call.
    pub(super) at: u32,
    pub(super) shift: i64,
    /// Time before the target.
    pub(super) before: i64,
    /// Index of the operation after a call.
    pub(super) back: u32,
    /// Time before the instruction after a call.
    pub(super) before_back: i64,
}

/// An entry of a CASE table.
#[derive(Clone, Copy, Debug)]
pub(super) enum CaseEntry {
    /// Index of a leap.
    Code(u32),
    /// An internal module by its number.
    Module(u16),
}
