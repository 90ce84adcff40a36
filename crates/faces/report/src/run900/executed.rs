//! What was executed of the path of a channel.

use bahn_control900::Control900;
use bahn_host::{ExecutedPath, Host, Operable};
use bahn_path::{PathElement, Position};

use crate::ReportError;
use crate::record::{Notice, Record};
use crate::test_run::Outputs;

/// Follows the path that a channel executes.
pub(super) struct Executed {
    /// Which, from 1 on.
    pub channel: u8,
    pub record: Record,
    pub outputs: Outputs,
    path: ExecutedPath,
    /// Time of its program, µs.
    pub program_us: u64,
}

impl Executed {
    pub fn new(channel: u8, outputs: Outputs) -> Executed {
        Executed {
            channel,
            record: Record::new(Position::UNKNOWN),
            outputs,
            path: ExecutedPath::of(usize::from(channel) - 1),
            program_us: 0,
        }
    }

    /// Takes what a cycle has executed.
    pub fn cycle<P: Operable>(&mut self, host: &mut Host<P, Control900>) -> Result<(), ReportError> {
        if host.control().is_on_its_way(self.channel) {
            self.program_us += u64::from(host.control().cycle_us());
        }
        self.path.follow(host);
        for warning in host.take_warnings(usize::from(self.channel) - 1) {
            let notice = Notice::Program(warning.kind);
            self.record.warn(warning.block, notice, warning.count);
        }
        self.hand_on(host.control())
    }

    /// Of a run that was broken off in a block: what was executed to the end counts, too.
    pub fn finish(&mut self, control: &Control900) -> Result<(), ReportError> {
        self.path.finish();
        self.hand_on(control)
    }

    fn hand_on(&mut self, control: &Control900) -> Result<(), ReportError> {
        while let Some(element) = self.path.next() {
            self.element(&element, control)?;
        }
        Ok(())
    }

    fn element(&mut self, element: &PathElement, control: &Control900) -> Result<(), ReportError> {
        self.record.path(element);
        match control.reader(self.channel) {
            Some(run) if !self.outputs.is_empty() => self.outputs.element(element, run, &mut self.record),
            _ => Ok(()),
        }
    }

    /// What was done of its program; it is taken out.
    pub fn take_record(&mut self) -> Record {
        let mut record = std::mem::replace(&mut self.record, Record::new(Position::UNKNOWN));
        record.machining_time_s = self.program_us as f64 * 1e-6;
        record
    }
}
