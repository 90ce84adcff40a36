//! The channels beside the first one: what each of them ran, how long, how far off its contour.

use bahn_host::{Host, Threads};
use bahn_path::{FeedRate, Position};
use bahn_tnc::{ChannelView, RunState};

use super::deviation::Deviation;
use super::executed::Executed;
use crate::ReportError;
use crate::record::Record;
use crate::test_run::Outputs;

/// Follows a channel beside the first one.
pub(super) struct Beside {
    /// Which one, from 0.
    pub channel: usize,
    executed: Executed,
    pub deviation: Deviation,
    pub threads: Threads,
    /// Time of its program, µs.
    program_us: u64,
}

/// No run is on its way: none was started, it has ended, or a fault has interrupted it.
pub(super) fn is_idle(channel: ChannelView) -> bool {
    channel.run_state() == RunState::Idle || channel.is_broken()
}

impl Beside {
    pub fn new(channel: ChannelView) -> Beside {
        Beside {
            channel: channel.number(),
            executed: Executed::new(channel.number(), None, Outputs::default()),
            deviation: Deviation::new(channel),
            threads: Threads::default(),
            program_us: 0,
        }
    }

    /// Takes a contour cycle.
    pub fn cycle(&mut self, host: &mut Host) -> Result<(), ReportError> {
        let Some(channel) = host.control().channel(self.channel) else {
            return Ok(());
        };
        let running = !is_idle(channel);
        if running {
            self.program_us += u64::from(host.control().cycle_us());
            let feed = channel.element().map(|element| element.feed);
            let contour = matches!(feed, Some(FeedRate::Programmed(_)));
            self.deviation.cycle(channel, contour);
            let cycle_s = f64::from(host.control().cycle_us()) * 1e-6;
            self.threads.cycle(channel, host.plant(), cycle_s);
        } else {
            self.deviation.restart();
            self.threads.end();
        }
        self.executed.cycle(host, running)
    }

    /// Of a run that was broken off: what was executed to the end counts.
    pub fn finish(&mut self, host: &Host) -> Result<(), ReportError> {
        self.threads.end();
        self.executed.finish(host.control())
    }

    /// What was done of its program; it is taken out.
    pub fn take_record(&mut self) -> Record {
        let mut record = std::mem::replace(&mut self.executed.record, Record::new(Position::UNKNOWN));
        record.machining_time_s = self.program_us as f64 * 1e-6;
        record
    }
}
