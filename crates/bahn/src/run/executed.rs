//! What was executed of the path: the report, the removal and the files that take it element by element.

use std::collections::VecDeque;

use bahn_control::{ChannelView, Control, RunState};
use bahn_host::Host;
use bahn_path::{BlockRef, PathElement};

use super::turning::{ElementId, Turning};
use crate::UsageError;
use crate::cutting::no_workpiece;
use crate::report::{Notice, Record};
use crate::test_run::{Outputs, stop_function};
use bahn_workpiece::Cutting;

/// Follows the path.
pub(super) struct Executed {
    /// Of which channel, from 0.
    channel: usize,
    pub record: Record,
    pub cutting: Option<Cutting>,
    pub outputs: Outputs,
    /// Elements that were prepared and not yet executed.
    ahead: VecDeque<PathElement>,
    turning: Turning,
    /// The element that was executed last, with the way that was left of it.
    last_seen: Option<(ElementId, f64)>,
    last_stop: bool,
}

impl Executed {
    pub fn new(channel: usize, cutting: Option<Cutting>, outputs: Outputs) -> Executed {
        Executed {
            channel,
            record: Record::new(bahn_path::Position::UNKNOWN),
            cutting,
            outputs,
            ahead: VecDeque::new(),
            turning: Turning::default(),
            last_seen: None,
            last_stop: false,
        }
    }

    /// Takes what a cycle has executed; `running` says that a run is on its way.
    pub fn cycle(&mut self, host: &mut Host, running: bool) -> Result<(), UsageError> {
        if running && self.channel == 0 {
            self.turning.cycle(host.control(), host.plant());
        }
        if let Some(dropped) = host.take_dropped_path(self.channel) {
            self.ahead.retain(|element| element.sequence < dropped);
        }
        self.ahead.extend(host.take_path(self.channel));
        for warning in host.take_warnings(self.channel) {
            self.record
                .warn(warning.block, Notice::Program(warning.kind), warning.count);
        }
        let Some(channel) = host.control().channel(self.channel) else {
            return Ok(());
        };
        let all = channel.has_ended();
        if let Some(element) = channel.element() {
            self.last_seen = Some((ElementId::of(element), channel.rest_mm()));
        }
        let current = channel.element().map(|element| element.sequence);
        while let Some(element) = self.ahead.front() {
            if !all && current.is_none_or(|current| element.sequence >= current) {
                break;
            }
            self.take_front(channel)?;
        }
        self.note_stop(channel);
        Ok(())
    }

    /// Of a run that was broken off in a block: what was executed to the end counts, too.
    pub fn finish(&mut self, control: &Control) -> Result<(), UsageError> {
        /// Way that may be left when an element is done.
        const DONE_MM: f64 = 1e-6;
        let Some(((current, rest_mm), channel)) = self.last_seen.zip(control.channel(self.channel)) else {
            return Ok(());
        };
        while let Some(element) = self.ahead.front() {
            let is_current = ElementId::of(element) == current;
            if element.sequence > current.sequence || is_current && rest_mm > DONE_MM {
                break;
            }
            self.take_front(channel)?;
            if is_current {
                break;
            }
        }
        Ok(())
    }

    /// What is written of an element names its program.
    pub fn needs_programs(&self) -> bool {
        !self.outputs.is_empty()
    }

    /// Hands on the next element.
    fn take_front(&mut self, control: ChannelView) -> Result<(), UsageError> {
        let Some(element) = self.ahead.pop_front() else {
            return Ok(());
        };
        self.record.path(&element);
        let spindle = self.turning.take(&element);
        if let Some(cutting) = &mut self.cutting {
            if let Some(spindle) = spindle {
                cutting.see(spindle);
            }
            cutting
                .element(&element, &mut self.record)
                .map_err(no_workpiece)?;
        }
        if let Some(run) = control.interpreter().filter(|_| !self.outputs.is_empty()) {
            self.outputs.element(&element, run, &mut self.record)?;
        }
        Ok(())
    }

    /// Lists programmed stops.
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
    let run = control.interpreter();
    let function = run.zip(block).and_then(|(run, block)| stop_function(run, block));
    function.unwrap_or("programmed stop")
}
