//! What programs of this control have that programs in other languages have not, of a feeder: tools, machine parameters of
//! the interpreter.

use bahn_interpreter::{AbsentAxes, Interpreter, Rules};
use bahn_kernel::{AxisUnit, Chain, Feeder, program_error};
use bahn_parameters::MessageId;
use bahn_path::{Axis, AxisSet, BlockRef};
use bahn_plc::ToolCallBlock;
use bahn_reader::{ProgramError, Reader};

use crate::tools::inserted_axis;

/// The error of a block that would move an axis that the channel does not have, or not for programs.
pub(crate) fn absent(
    axis: Axis,
    unit: Option<&AxisUnit>,
    block: BlockRef,
    run: Option<&dyn Reader>,
) -> ProgramError {
    let only = AxisSet::EMPTY.with(axis);
    let mut reasons = AbsentAxes::default();
    match unit {
        None => reasons.missing = only,
        Some(unit) if unit.is_plc_axis() => reasons.plc = only,
        Some(_) => reasons.slaves = only,
    }
    let why = reasons.reason(only).unwrap_or_default();
    program_error(MessageId::WrongAxisProgrammed, why, block, run)
}

/// The error of a program into which the PLC inserts a TOOL CALL and that has no tools.
pub(crate) fn without_tools(block: BlockRef, run: Option<&dyn Reader>) -> ProgramError {
    let why = "module 9150 inserts a TOOL CALL: a program in this language has no tools";
    program_error(MessageId::BlockNotSupported, why.to_owned(), block, run)
}

/// The error of a program that is to begin at a block in the plane of 3D ROT, or of the program before, and knows none: it
/// would run upright.
pub(crate) fn without_planes(block: u32, run: &dyn Reader) -> ProgramError {
    let why = "3D ROT for program run is on: a program in this language does not run in a tilted plane";
    let block = BlockRef { program: 0, block };
    program_error(MessageId::BlockNotSupported, why.to_owned(), block, Some(run))
}

/// A feeder whose program may be one in the language of the control.
pub(crate) trait OwnLanguage {
    /// The program as one of a TNC; `None` when it is in another language.
    fn interpreter(&self) -> Option<&Interpreter>;

    /// The program as one of a TNC; `None` when it is in another language.
    fn interpreter_mut(&mut self) -> Option<&mut Interpreter>;

    /// The rules of machine parameters, for the blocks that are read from now on.
    fn set_rules(&mut self, rules: Rules);

    /// Inserts a TOOL CALL of module 9150 before the next block.
    fn insert(&mut self, call: &ToolCallBlock);

    /// The first block that was read after a sequence before which the tool may be replaced.
    fn next_replacement(&mut self, after: u64, tool: u32) -> Option<u64>;

    /// Replaces the tool before such a block: what was read from there on is read again. With the kinematics and offsets of
    /// where the path stands.
    fn replace_tool_before(&mut self, sequence: u64, tool: u32, chain: &Chain);

    /// Replaces the tool in the spindle before the next block, if it may be.
    fn replace_tool(&mut self, worn: u32, tool: u32);
}

impl OwnLanguage for Feeder {
    fn interpreter(&self) -> Option<&Interpreter> {
        Interpreter::of(self.reader())
    }

    fn interpreter_mut(&mut self) -> Option<&mut Interpreter> {
        Interpreter::of_mut(self.reader_mut())
    }

    fn set_rules(&mut self, rules: Rules) {
        let common = rules.machine;
        match self.interpreter_mut() {
            Some(interpreter) => interpreter.set_rules(rules),
            None => self.reader_mut().set_machine_rules(common),
        }
    }

    fn insert(&mut self, call: &ToolCallBlock) {
        let axis = call.axis.and_then(inserted_axis);
        let tool = call.tool.map(f64::from);
        let oversize = [call.length_oversize, call.radius_oversize];
        if let Some(interpreter) = self.interpreter_mut() {
            interpreter.insert_tool_call(tool, axis, call.speed, oversize);
        }
    }

    fn next_replacement(&mut self, after: u64, tool: u32) -> Option<u64> {
        self.interpreter_mut()?.next_replacement(after, tool)
    }

    fn replace_tool_before(&mut self, sequence: u64, tool: u32, chain: &Chain) {
        self.read_again_from(sequence, chain);
        if let Some(interpreter) = self.interpreter_mut() {
            interpreter.replace_tool(tool);
        }
    }

    fn replace_tool(&mut self, worn: u32, tool: u32) {
        if self.is_drained()
            && let Some(interpreter) = self.interpreter_mut()
            && interpreter.may_replace_tool(worn)
        {
            interpreter.replace_tool(tool);
        }
    }
}
