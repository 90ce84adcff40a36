//! What was executed of the path: the report, the removal and the files that take it element by element.

use bahn_host::{ExecutedPath, Host};
use bahn_path::{BlockRef, PathElement};
use bahn_tnc::{ChannelView, Control, RunState};

use super::turning::Turning;
use crate::ReportError;
use crate::record::{Notice, Record};
use crate::test_run::{Outputs, stop_function};
use bahn_workpiece::Cutting;

/// Follows the path that a channel executes.
pub struct Executed {
    /// Of which channel, from 0.
    channel: usize,
    /// What is known of the run.
    pub record: Record,
    /// The part; `None` without graphics.
    pub cutting: Option<Cutting>,
    /// The files that take the path.
    pub outputs: Outputs,
    path: ExecutedPath,
    turning: Turning,
    last_stop: bool,
}

impl Executed {
    /// What a channel executes, from 0, with its part and the files of its path.
    pub fn new(channel: usize, cutting: Option<Cutting>, outputs: Outputs) -> Executed {
        Executed {
            channel,
            record: Record::new(bahn_path::Position::UNKNOWN),
            cutting,
            outputs,
            path: ExecutedPath::of(channel),
            turning: Turning::default(),
            last_stop: false,
        }
    }

    /// Takes what a cycle has executed; `running` says that a run is on its way.
    pub fn cycle(&mut self, host: &mut Host, running: bool) -> Result<(), ReportError> {
        if running && self.channel == 0 {
            self.turning.cycle(host.control(), host.plant());
        }
        self.path.follow(host);
        for warning in host.take_warnings(self.channel) {
            self.record
                .warn(warning.block, Notice::Program(warning.kind), warning.count);
        }
        let Some(channel) = host.control().channel(self.channel) else {
            return Ok(());
        };
        self.hand_on(channel)?;
        self.note_stop(channel);
        Ok(())
    }

    /// Of a run that was broken off in a block: what was executed to the end counts, too.
    pub fn finish(&mut self, control: &Control) -> Result<(), ReportError> {
        self.path.finish();
        control
            .channel(self.channel)
            .map_or(Ok(()), |channel| self.hand_on(channel))
    }

    /// What is written of an element names its program.
    pub fn needs_programs(&self) -> bool {
        !self.outputs.is_empty()
    }

    /// Hands on what is executed.
    fn hand_on(&mut self, control: ChannelView) -> Result<(), ReportError> {
        while let Some(element) = self.path.next() {
            self.element(element, control)?;
        }
        Ok(())
    }

    fn element(&mut self, element: PathElement, control: ChannelView) -> Result<(), ReportError> {
        self.record.path(&element);
        let spindle = self.turning.take(&element);
        if let Some(cutting) = &mut self.cutting {
            if let Some(spindle) = spindle {
                cutting.see(spindle);
            }
            cutting.element(&element, &mut self.record)?;
        }
        if let Some(run) = control.reader().filter(|_| !self.outputs.is_empty()) {
            self.outputs.element(&element, run, &mut self.record)?;
        }
        Ok(())
    }

    /// Notes a programmed stop, once when it begins.
    fn note_stop(&mut self, control: ChannelView) {
        let stopped = control.run_state() == RunState::Stopped;
        if stopped && !self.last_stop {
            let block = control.element().map(|element| element.block);
            let name = stop_name(control, block);
            if let Some(block) = block {
                self.record.stop(block, name);
            }
        }
        self.last_stop = stopped;
    }
}

/// The function of a block that stops the run.
pub(super) fn stop_name(control: ChannelView, block: Option<BlockRef>) -> &'static str {
    let run = control.reader();
    let function = run.zip(block).and_then(|(run, block)| stop_function(run, block));
    function.unwrap_or("programmed stop")
}
