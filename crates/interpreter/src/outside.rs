//! What a control tells a run from outside, while it goes on.

use std::collections::BTreeMap;
use std::sync::Arc;

use bahn_path::{Axis, Position};
use bahn_program::Value;

use crate::Interpreter;
use crate::settings::{DatumTable, Rules, ToolState};

impl Interpreter {
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

    /// The tools that must not be called, or are replaced, for the blocks that are read from now on.
    pub fn set_barred_tools(&mut self, barred: BTreeMap<u32, ToolState>) {
        self.settings.barred_tools = barred;
    }

    /// The datum table, for the blocks that are read from now on.
    pub fn set_datum_table(&mut self, table: Option<Arc<DatumTable>>) {
        self.settings.datum_table = table;
    }

    /// Sets a Q parameter from outside: the PLC, or the operator.
    pub fn set_q(&mut self, number: u16, value: f64) {
        self.run.q.preassign(number, value);
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
        let unit = self.run.unit_mm;
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
}
