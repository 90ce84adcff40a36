//! What the view of a PLC program shows.

use bahn_host::{Operand, Retained};
use bahn_plc::{TraceStep, Tracer};
use bahn_report::plc::Subject;

use super::entry::Entry;
use bahn_report::plc::{Breakpoints, Trend};

/// What `bahn plc watch` shows, and what was typed.
pub(super) struct Watch {
    pub(super) subject: Subject,
    pub(super) operands: Vec<Operand>,
    pub(super) chosen: usize,
    pub(super) running: bool,
    pub(super) entry: Option<Entry>,
    pub(super) message: String,
    pub(super) last: LastInstruction,
    pub(super) breakpoints: Breakpoints,
    /// It was stopped before the first line, so that the next cycle passes it.
    pub(super) held: bool,
    pub(super) trend: Trend,
    pub(super) retained: Option<Retained>,
}

/// The instruction that was executed last, by its index.
#[derive(Default)]
pub(super) struct LastInstruction(pub(super) Option<usize>);

impl Tracer for LastInstruction {
    fn executed(&mut self, step: &TraceStep<'_>) {
        self.0 = Some(step.at);
    }
}
