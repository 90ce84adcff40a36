//! Programs, a script and an operator on a machine with a System 900: cycle after cycle until the run ends.

use bahn_control900::{Control900, Kind, Message};
use bahn_host::{Action900, AnyPlant, Host, HostError, Next, Notice900, Play, Reader, Source, Stamped};

use super::executed::Executed;
use super::listed::Listed;
use super::recording::Recording900;
use super::standstill::{Standstill, waits_for};
use crate::ReportError;
use crate::follower::Follower;
use crate::run::Patience;
use crate::test_run::Outputs;

/// How a session ended.
#[derive(Clone, Debug, PartialEq)]
pub enum Ended900 {
    /// All programs came to their ends, or the script where there is none.
    Completed,
    /// By `end` of the script.
    Stopped,
    /// The time allowed is over.
    TooLong,
    /// Ctrl-C broke it off.
    Interrupted,
    /// A message broke a program off.
    Broken(Box<Message>),
    /// A program was broken off without a message: by the mode, or P8705.
    BrokenOff(u8),
    /// Nothing comes on any more; what it waits for.
    Hangs(String),
    /// What survives power-off cannot be stored, or a program not be read; why.
    Failed(String),
}

/// A host with those who follow it.
pub struct Session900 {
    /// The machine that is on.
    pub host: Host<AnyPlant, Control900>,
    /// The script that is played on it.
    pub play: Play<Action900>,
    pub(super) executed: Vec<Executed>,
    pub(super) listed: Listed,
    recording: Option<Recording900>,
    patience: Patience,
    notices: Reader<Stamped<Notice900>>,
    /// When the first program was started, µs.
    pub(super) start_us: Option<u64>,
    /// Channels, from 0, whose programs were started.
    pub(super) started: Vec<bool>,
    standstill: Standstill,
    broken_by: Option<Box<Message>>,
    ended: Option<Ended900>,
}

impl Session900 {
    /// A machine that is on, with all that goes along with its run; the files of the path are those of channel 1.
    pub fn new(
        mut host: Host<AnyPlant, Control900>,
        play: Play<Action900>,
        outputs: Outputs,
        recording: Option<Recording900>,
        patience: Patience,
    ) -> Session900 {
        host.keep_path();
        let channels = host.control().channels();
        let mut first = Some(outputs);
        Session900 {
            play,
            executed: (1..=channels)
                .map(|channel| Executed::new(channel, first.take().unwrap_or_default()))
                .collect(),
            listed: Listed::default(),
            recording,
            patience,
            notices: host.notices(),
            start_us: None,
            started: vec![false; usize::from(channels)],
            standstill: Standstill::default(),
            broken_by: None,
            ended: None,
            host,
        }
    }

    /// Runs to the end.
    ///
    /// # Errors
    /// When a file cannot be written, or the machine not do what it is told.
    pub fn run(&mut self, follower: &mut dyn Follower) -> Result<Ended900, ReportError> {
        loop {
            if self.play.follow900(&mut self.host)? {
                self.ended = Some(match self.is_over() {
                    true => self.over(),
                    false => Ended900::Stopped,
                });
            }
            self.host.begin()?;
            self.follow_notices();
            if let Some(ended) = self.ended.take() {
                for executed in &mut self.executed {
                    executed.finish(self.host.control())?;
                }
                self.play.finish(self.host.control().now_us() as f64 * 1e-6);
                self.host.remark(&Source::Script, "end")?;
                return Ok(ended);
            }
            let stored = self.host.cycle();
            self.watch()?;
            match stored {
                Err(HostError::NotStored(what)) => return Ok(Ended900::Failed(what)),
                other => other?,
            }
            let time_s = self.executed.first().map_or(0, |first| first.program_us) as f64 * 1e-6;
            let element = self.host.control().executed(1);
            follower.element(element.map(|(element, _)| element.block.block), time_s);
            if follower.is_interrupted() {
                self.ended = Some(Ended900::Interrupted);
            } else if self.ended.is_none() {
                self.ended = self.end();
            }
        }
    }

    /// Completes all files, also after one that cannot be written.
    ///
    /// # Errors
    /// The first of those.
    pub fn finish_files(&mut self) -> Result<(), ReportError> {
        let recording = self.recording.take().map_or(Ok(()), Recording900::finish);
        let log = self.host.finish_log().map_err(ReportError::from);
        let mut outputs = self.executed.iter_mut().map(|executed| executed.outputs.finish());
        outputs.try_for_each(|written| written).and(recording).and(log)
    }

    /// What the host tells.
    fn follow_notices(&mut self) {
        while let Some(next) = self.notices.next() {
            let Next::Item(stamped) = next else { continue };
            match stamped.notice {
                Notice900::Shown(message) => self.say(message),
                Notice900::Held(name, lock) => self.listed.refuse(stamped.time_us, name, lock),
                Notice900::Confirmed => self.listed.confirm(stamped.time_us),
                Notice900::Fault(what) => self.ended = Some(Ended900::Failed(what)),
                _ => {}
            }
        }
    }

    fn say(&mut self, message: Message) {
        if let Some(recording) = &mut self.recording {
            recording.event(&format!("message {message}"));
        }
        self.listed.message(&message);
        let breaks = matches!(message.kind, Kind::System | Kind::High);
        if breaks && !self.play.has_expected(&message.to_string()) {
            self.broken_by = Some(Box::new(message));
        }
    }

    /// Looks at what the cycle brought.
    fn watch(&mut self) -> Result<(), ReportError> {
        self.follow_notices();
        let control = self.host.control();
        for (channel, started) in (1u8..).zip(&mut self.started) {
            *started |= control.is_on_its_way(channel) || control.run(channel).1;
        }
        if self.start_us.is_none() && self.started.contains(&true) {
            let now = control.now_us();
            self.start_us = Some(now);
            self.play.start(now);
            if let Some(recording) = &mut self.recording {
                recording.event("start");
            }
        }
        for executed in &mut self.executed {
            executed.cycle(&mut self.host)?;
        }
        let control = self.host.control();
        self.standstill.cycle(control);
        self.recording
            .as_mut()
            .map_or(Ok(()), |recording| recording.cycle(control))
    }

    /// Every program that was started is over, and those that wait to be started are none.
    fn is_over(&self) -> bool {
        let control = self.host.control();
        let mut channels = (1u8..).zip(&self.started);
        channels.all(|(channel, started)| match started {
            true => !control.is_on_its_way(channel),
            false => !control.has_program(channel) || !self.host.operator().starts(),
        })
    }

    /// What became of programs that are over.
    fn over(&self) -> Ended900 {
        if let Some(message) = &self.broken_by
            && !self.play.has_expected(&message.to_string())
        {
            return Ended900::Broken(message.clone());
        }
        match self.first_open() {
            Some(channel) => Ended900::BrokenOff(channel),
            None => Ended900::Completed,
        }
    }

    /// The first channel, from 1, whose program was started and has not come to its end.
    pub(super) fn first_open(&self) -> Option<u8> {
        let control = self.host.control();
        let mut started = (1u8..).zip(&self.started).filter(|(_, started)| **started);
        let open = started.find(|(channel, _)| !control.run(*channel).1);
        open.map(|(channel, _)| channel)
    }

    /// Whether the run is at its end.
    fn end(&self) -> Option<Ended900> {
        let control = self.host.control();
        if self.is_over() && !control.moves() && self.play.is_timed_out() {
            return Some(self.over());
        }
        if control.now_us() >= self.patience.time_us {
            return Some(Ended900::TooLong);
        }
        if !self.standstill.is_longer_than(control, self.patience.wait_us) || !self.play.is_timed_out() {
            return None;
        }
        Some(match &self.broken_by {
            Some(message) => Ended900::Broken(message.clone()),
            None => Ended900::Hangs(waits_for(control, self.host.operator().has_started())),
        })
    }
}
