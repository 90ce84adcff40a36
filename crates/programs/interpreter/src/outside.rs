//! What a control tells a run from outside, while it goes on.
//!
//! Decision: Tool data that the PLC or the tool probe change count for every TOOL CALL that is read from then on

use std::collections::BTreeMap;
use std::sync::Arc;

use bahn_path::{Axis, BlockRef, Placement, Position};
use bahn_program::{MotionKind, Operation, Value};

use crate::Interpreter;
use crate::checkpoints::{Checkpoint, Kept};
use crate::code::Code;
use crate::contour::Contour;
use crate::settings::{DatumTable, Rules, ToolState, ToolTable};

impl Interpreter {
    /// How the coordinates of the path stand in the machine at the block that comes next, when not upright.
    pub fn placement(&self) -> Option<&Arc<Placement>> {
        self.run.pen.placement.as_ref()
    }

    /// Names of the programs that were called so far, the main program first.
    pub fn program_names(&self) -> impl Iterator<Item = String> + '_ {
        self.code.names()
    }

    /// Machine zero of M91 from the workpiece datum, for the blocks that are read from now on.
    pub fn set_machine_zero(&mut self, zero: Position) {
        self.settings.rules.machine_zero = zero;
    }

    /// Machine parameters were changed by the PLC: their rules count for the blocks that are read from now on. Machine
    /// zero stays.
    pub fn set_rules(&mut self, rules: Rules) {
        let machine_zero = self.settings.rules.machine_zero;
        self.settings.rules = Rules {
            machine_zero,
            ..rules
        };
    }

    /// The tools, and those that must not be called or are replaced, for the blocks that are read from now on.
    pub fn set_tools(&mut self, tools: Option<ToolTable>, barred: BTreeMap<u32, ToolState>) {
        self.settings.tools = tools;
        self.settings.barred_tools = barred;
    }

    /// The datum table, or why there is none, for the blocks that are read from now on.
    pub fn set_datum_table(&mut self, table: Result<Arc<DatumTable>, String>) {
        self.settings.datum_table = table;
    }

    /// Sets a Q parameter from outside: the PLC, or the operator.
    pub fn set_q(&mut self, number: u16, value: f64) {
        self.run.numbers.q.preassign(number, value);
    }

    /// Executes a TOOL CALL that is in no program before the next block: tool number, tool axis, spindle speed
    /// in rpm, and DL and DR in mm; what is `None` stays as it is.
    pub fn insert_tool_call(
        &mut self,
        tool: Option<f64>,
        axis: Option<Axis>,
        speed_rpm: Option<f64>,
        oversize_mm: [f64; 2],
    ) {
        let at = self.run.at.block_ref();
        let current = self.run.modal.tool.map(|tool| f64::from(tool.number));
        let unit = self.run.numbers.unit_mm;
        let result = self.run.tool_call(
            tool.or(current).map(Value::Number),
            axis,
            speed_rpm.map(Value::Number),
            oversize_mm.map(|mm| Some(Value::Number(mm / unit))),
            &self.settings,
        );
        if let Err(fault) = result {
            self.fail(fault, at);
        }
    }

    /// Whether the tool in the spindle may be replaced before the next block: no contour with radius compensation is on
    /// its way (inferred), nothing waits to be handed out, and the block itself calls no tool.
    pub fn may_replace_tool(&mut self, tool: u32) -> bool {
        if keeps_tool(&mut self.code, self.run.at.block_ref()) {
            return false;
        }
        let run = &self.run;
        self.waiting.is_none()
            && self.effort.pending.is_none()
            && run.is_between_contours(tool)
            && run.pen.contour.is_empty()
    }

    /// The first block after a sequence that is read already and [may](Interpreter::may_replace_tool) have the tool
    /// replaced before it, by its own sequence. It is known only when [checkpoints are
    /// kept](Interpreter::keep_checkpoints).
    pub fn next_replacement(&mut self, after: u64, tool: u32) -> Option<u64> {
        let Interpreter { kept, code, .. } = self;
        let mut states = kept.iter().flat_map(Kept::states);
        let found = states.find(|state| {
            state.sequence() > after && state.run.is_between_contours(tool) && !keeps_tool(code, state.at())
        });
        found.map(Checkpoint::sequence)
    }

    /// Replaces the tool in the spindle before the next block, without one (M101), with tool axis and oversizes of the
    /// call before; then the path comes back to where it was. Change and way back count as blocks of their own, to
    /// which a run may go back.
    pub fn replace_tool(&mut self, number: u32) {
        let at = self.run.at.block_ref();
        self.begin_unwritten_block();
        // What is held back is executed already.
        self.run.pen.contour = Contour::default();
        if let Err(fault) = self.run.replace_tool(number, &self.settings) {
            self.fail(fault, at);
        }
    }

    /// The way back after a change of the tool.
    pub(crate) fn come_back(&mut self) {
        self.begin_unwritten_block();
        self.run.come_back();
    }

    fn begin_unwritten_block(&mut self) {
        if let Some(kept) = &mut self.kept {
            kept.keep(&mut self.run, self.position);
        }
        self.run.pen.sequence += 1;
    }
}

/// Whether the tool stays before a block: it goes on from the movement before it, or calls a tool itself.
fn keeps_tool(code: &mut Code, at: BlockRef) -> bool {
    let fetched = code.block(at.program, at.block);
    fetched.is_some_and(|fetched| {
        let mut parts = fetched.block.operation.parts().iter();
        parts.any(|part| refers_back(part) || matches!(part, Operation::ToolCall { tool: Some(_), .. }))
    })
}

/// Whether a block changes or goes on from the movement before it.
fn refers_back(operation: &Operation) -> bool {
    match operation {
        Operation::Rounding { .. } | Operation::Chamfer { .. } => true,
        Operation::Motion(motion) => matches!(
            motion.kind,
            MotionKind::CircleTangential | MotionKind::CircleTangentialPolar
        ),
        _ => false,
    }
}
