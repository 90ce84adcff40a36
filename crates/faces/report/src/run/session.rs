//! A program, a script and an operator on a machine: cycle after cycle until the run ends.

use bahn_exchange::signal::{self, SignalOperand};
use bahn_host::{
    Action, Answer, Host, HostError, LoadedMachine, Next, Notice, Phase, Play, Reader, Source, Stamped,
    run_name,
};
use bahn_machine::Event;
use bahn_panel::{Language, Waits, in_words};
use bahn_path::{BlockRef, PathElement};
use bahn_tnc::{ChannelView, Command, Message, RunState, Shown, Waiting};
use bahn_workpiece::Part;

use super::beside::{Beside, is_idle};
use super::executed::Executed;
use super::listed::Listed;
use super::measured::Measured;
use super::module::ModuleRun;
use super::recording::Recording;
use super::scoped::Scoped;
use super::standstill::Standstill;
use super::table::Table;
use crate::ReportError;
use crate::follower::Follower;

/// How a session ended.
#[derive(Clone, Debug, PartialEq)]
pub enum Ended {
    /// The program came to its end, or the script when there is no program.
    Completed,
    /// By `end` of the script.
    Stopped,
    /// The time allowed is over.
    TooLong,
    /// Ctrl-C broke it off.
    Interrupted,
    /// A message broke the run off.
    Broken(Option<Box<Shown>>),
    /// Nothing moves any more; what it waits for, and the message that stopped it.
    Hangs(String, Option<Box<Shown>>),
    /// Module 9033 selected a list of machine parameters: the control resets.
    Restart(String),
    /// What survives power-off cannot be stored; why.
    NotStored(String),
    /// A file of the run cannot be written, or what the script wants cannot be done; why.
    Failed(String),
}

/// How long a session may take.
#[derive(Clone, Copy, Debug)]
pub struct Patience {
    /// Time of the machine, µs.
    pub time_us: u64,
    /// Without any movement, µs.
    pub wait_us: u64,
}

/// A host with those who follow it.
pub struct Session {
    /// The machine that is on.
    pub host: Host,
    /// The script that is played on it.
    pub play: Play,
    pub(super) executed: Executed,
    /// The channels beside the first one.
    pub(super) beside: Vec<Beside>,
    pub(super) measured: Measured,
    pub(super) listed: Listed,
    recording: Option<Recording>,
    /// The oscilloscope of the control.
    pub oscilloscope: Option<Scoped>,
    /// What lies on the table of the machine.
    pub table: Table,
    /// The positioning module beside it.
    pub module: Option<ModuleRun>,
    patience: Patience,
    notices: Reader<Stamped>,
    /// When the program was started.
    start_us: Option<u64>,
    standstill: Standstill,
    /// What the machine waits for.
    pub waits: Option<Waits>,
    broken_by: Option<Box<Shown>>,
    ended: Option<Ended>,
}

impl Session {
    /// A machine that is on, with all that goes along with its run.
    pub fn new(
        mut host: Host,
        play: Play,
        executed: Executed,
        recording: Option<Recording>,
        patience: Patience,
    ) -> Session {
        host.keep_path();
        Session {
            play,
            executed,
            beside: (1..host.control().channels())
                .filter_map(|number| host.control().channel(number))
                .map(Beside::new)
                .collect(),
            measured: Measured::new(host.control()),
            listed: Listed::default(),
            recording,
            oscilloscope: None,
            table: Table::default(),
            module: None,
            patience,
            notices: host.notices(),
            start_us: None,
            standstill: Standstill::default(),
            waits: None,
            broken_by: None,
            ended: None,
            host,
        }
    }

    /// Runs to the end.
    ///
    /// # Errors
    /// When a file cannot be written, or the machine not do what it is told.
    pub fn run(
        &mut self,
        follower: &mut dyn Follower,
        machine: &LoadedMachine,
    ) -> Result<Ended, ReportError> {
        loop {
            self.follow_script()?;
            self.host.begin()?;
            self.follow_notices(follower)?;
            if let Some(ended) = self.ended.take() {
                self.measured.threads.end();
                self.executed.finish(self.host.control())?;
                for channel in &mut self.beside {
                    channel.finish(&self.host)?;
                }
                self.play.finish(self.host.control().time_us() as f64 * 1e-6);
                self.host.remark(&Source::Script, "end")?;
                return Ok(ended);
            }
            let tracer = self.recording.as_mut().and_then(Recording::tracer);
            let started = self.start_us.is_some() || self.host.operator().phase() == Phase::Ready;
            let keys = self.host.control().oscilloscope();
            let scope = self.oscilloscope.as_mut();
            let sampler = scope.map(|scope| scope.sampler(started, keys));
            let stored = self.host.cycle_watched(tracer, sampler);
            if let Some(module) = &mut self.module {
                module.cycle(&mut self.host)?;
            }
            self.watch(follower)?;
            if let Some(list) = self.host.restart() {
                return Ok(Ended::Restart(list.to_owned()));
            }
            match stored {
                Err(HostError::NotStored(what)) => return Ok(Ended::NotStored(what)),
                other => other?,
            }
            let block = self.block().filter(|block| block.program == 0);
            let time_s = self.measured.program_us as f64 * 1e-6;
            follower.element(block.map(|block| block.block), time_s);
            self.ended = if follower.is_interrupted() {
                Some(Ended::Interrupted)
            } else {
                self.end(machine)
            };
        }
    }

    /// Completes all files, also after one that cannot be written.
    ///
    /// # Errors
    /// The first of those.
    pub fn finish_files(&mut self, follower: &mut dyn Follower) -> Result<(), ReportError> {
        let recording = self.recording.take().map_or(Ok(()), Recording::finish);
        let log = self.host.finish_log().map_err(ReportError::from);
        let scope = self.oscilloscope.take();
        let scope = scope.map_or(Ok(()), |scope| scope.finish(&mut |line| follower.say(line)));
        self.executed.outputs.finish().and(recording).and(scope).and(log)
    }

    /// The part as the run has left it; it is taken out.
    pub fn take_part(&mut self) -> Option<Part> {
        let cutting = self.executed.cutting.take()?;
        cutting.finish(&mut self.executed.record)
    }

    /// The block that is executed.
    pub(super) fn block(&self) -> Option<BlockRef> {
        self.host.control().element().map(|element| element.block)
    }

    /// Everything that is due, in the order of time and of the file.
    fn follow_script(&mut self) -> Result<(), ReportError> {
        let module = self.module.as_mut().map(|beside| &mut beside.module.host);
        if self.play.follow_with(&mut self.host, module)? {
            self.ended = Some(self.ended_by_script());
        }
        Ok(())
    }

    /// What `end` of the script makes of the run: a flashing message that it did not expect breaks it off.
    fn ended_by_script(&self) -> Ended {
        let control = self.host.control();
        let ended = self.all_ended();
        if !ended || !self.is_idle() {
            return Ended::Stopped;
        }
        let text = |shown: &Shown| control.shown_text(shown);
        let mut flashing = control.shown().iter().filter(|shown| shown.flashing);
        let unexpected = flashing.find(|shown| !self.play.has_expected(&text(shown)));
        unexpected.map_or(Ended::Completed, |shown| {
            Ended::Broken(Some(Box::new(shown.clone())))
        })
    }

    /// What the host tells.
    fn follow_notices(&mut self, follower: &mut dyn Follower) -> Result<(), ReportError> {
        while let Some(next) = self.notices.next() {
            let Next::Item(stamped) = next else { continue };
            match stamped.notice {
                Notice::Shown(shown) => self.say(shown),
                Notice::Confirmed { key, why } => {
                    let control = self.host.control();
                    if let Some(channel) = control.channel(stamped.channel) {
                        self.listed.confirm(channel, control.time_us(), key, why);
                    }
                }
                Notice::Digitized(name, points) => {
                    follower.say(&format!("{points} points are digitized: PGM {name}"));
                }
                Notice::Given(Source::Operator, action, answer) => self.follow_operator(action, answer)?,
                _ => {}
            }
        }
        Ok(())
    }

    /// Without what the operator wants to do the run does not go on.
    fn follow_operator(&mut self, action: Action, answer: Answer) -> Result<(), ReportError> {
        match (action, answer) {
            (Action::Command(_, command), Answer::Refused) if command != Command::Ce => {
                let refusal = format!("the control refuses `{command}`");
                self.ended = Some(Ended::Hangs(refusal, None));
            }
            (Action::Event(Event::Key(key, _), _), Answer::Impossible(error)) => {
                return Err(ReportError::new(format!(
                    "the operator cannot press {key} ([operator] in machine.toml): {error}"
                )));
            }
            _ => {}
        }
        Ok(())
    }

    /// Looks at what the cycle brought.
    fn watch(&mut self, follower: &mut dyn Follower) -> Result<(), ReportError> {
        self.follow_notices(follower)?;
        let running = !is_idle(self.host.control().first());
        let phase = self.host.operator().phase();
        // A program without a block begins and ends within one cycle.
        let any = !self.is_idle() || phase == Phase::Program && self.all_ended();
        if any && self.start_us.is_none() && phase != Phase::PowerUp {
            // What the script gives from the start on counts from here.
            let now = self.host.control().time_us();
            self.start_us = Some(now);
            self.play.start(now);
        }
        let (control, plant) = (self.host.control(), self.host.plant());
        self.measured.cycle(control, plant, phase, running);
        self.executed.cycle(&mut self.host, running)?;
        self.table.cycle(&mut self.host, self.executed.cutting.as_mut());
        for channel in &mut self.beside {
            channel.cycle(&mut self.host)?;
        }
        let control = self.host.control();
        if let Some(waits) = &mut self.waits {
            waits.follow(control);
        }
        let moves =
            !control.stands() || self.is_dwelling() || self.module.as_ref().is_some_and(ModuleRun::moves);
        self.standstill.cycle(&self.host, moves);
        match &mut self.recording {
            Some(recording) => {
                let module = self.module.as_ref().map(|beside| &beside.module.host);
                recording.cycle(&self.host, module, self.start_us.is_some())
            }
            None => Ok(()),
        }
    }

    /// A message came up.
    fn say(&mut self, shown: Shown) {
        // A message of the PLC does not break a run off that has not begun.
        let refused = self.host.operator().has_started() && !matches!(shown.message, Message::Plc(_));
        let control = self.host.control();
        let idle = match shown.channel.and_then(|number| control.channel(number)) {
            Some(channel) => is_idle(channel),
            None => self.is_idle(),
        };
        let breaks_off = shown.flashing || idle && (self.start_us.is_some() || refused);
        if let Some(recording) = &mut self.recording {
            recording.message(&control.shown_text(&shown));
        }
        self.listed.message(control, &shown);
        if breaks_off {
            self.broken_by = Some(Box::new(shown));
        }
    }

    fn channels(&self) -> impl Iterator<Item = ChannelView<'_>> {
        let control = self.host.control();
        (0..control.channels()).filter_map(|number| control.channel(number))
    }

    fn is_dwelling(&self) -> bool {
        self.channels().any(|channel| {
            let dwells =
                |element: &PathElement| element.dwell_s > 0.0 && !self.waits_too_long(element.dwell_s);
            channel.run_state() == RunState::Running
                && channel.waiting().is_none()
                && channel.element().is_some_and(dwells)
        })
    }

    /// Nothing has moved for the time allowed and a dwell besides.
    fn waits_too_long(&self, dwell_s: f64) -> bool {
        let still = self
            .host
            .control()
            .time_us()
            .saturating_sub(self.standstill.since_us());
        still > self.patience.wait_us.saturating_add((dwell_s * 1e6) as u64)
    }

    /// Why the session ends with this cycle.
    fn end(&mut self, machine: &LoadedMachine) -> Option<Ended> {
        let now = self.host.control().time_us();
        let still = self
            .standstill
            .is_longer_than(&self.host, machine, self.patience.wait_us);
        let waited = still && !self.is_dwelling();
        // What nothing moves for any more does not come.
        let script_done = self.play.is_done() || waited && self.play.is_timed_out();
        if now >= self.patience.time_us {
            return Some(Ended::TooLong);
        }
        let fatal = self.host.control().shown().iter().find(|shown| shown.flashing);
        if let Some(fatal) = fatal.filter(|_| script_done && self.host.control().stands()) {
            return Some(Ended::Broken(Some(Box::new(fatal.clone()))));
        }
        let idle = self.is_idle();
        match self.host.operator().phase() {
            Phase::Program if self.start_us.is_some() && idle && script_done => {
                return Some(if self.all_ended() {
                    Ended::Completed
                } else {
                    Ended::Broken(self.broken_by.take())
                });
            }
            Phase::Program if idle && script_done && self.broken_by.is_some() => {
                return Some(Ended::Broken(self.broken_by.take()));
            }
            Phase::Ready if script_done && idle && self.host.control().stands() => {
                return Some(Ended::Completed);
            }
            _ => {}
        }
        if !script_done || !waited {
            return None;
        }
        let waits_for = self.waits_for(machine);
        let stopped_by = self.host.control().shown().last().cloned();
        if let Some(shown) = &stopped_by {
            // Waiting after the message is no machining time.
            let since = shown.time_us.max(self.standstill.since_us());
            self.measured.take_back(now.saturating_sub(since));
        }
        Some(Ended::Hangs(waits_for, stopped_by.map(Box::new)))
    }

    /// No run is on its way: none was started, it has ended, or a fault has interrupted it.
    fn is_idle(&self) -> bool {
        self.channels().all(is_idle)
    }

    /// The programs of all channels that had one have come to their end.
    fn all_ended(&self) -> bool {
        let control = self.host.control();
        let mut jobs = self.host.operator().channels_with_job();
        jobs.all(|number| control.channel(number).is_some_and(|channel| channel.has_ended()))
    }

    /// What keeps a run from going on.
    fn waits_for(&self, machine: &LoadedMachine) -> String {
        let mut reasons = Vec::new();
        for channel in self.channels() {
            let number = match self.beside.is_empty() {
                true => String::new(),
                false => format!("{}: ", channel.number() + 1),
            };
            if let Some(waiting) = channel.waiting() {
                reasons.push(format!("{number}{waiting}{}", meaning(waiting)));
            }
            if channel.feed_override_percent() == 0.0 {
                reasons.push(format!("{number}the feed override is 0 %"));
            }
            match channel.run_state() {
                RunState::Running | RunState::Idle => {}
                state => reasons.push(format!(
                    "{number}the run is {}: NC start goes on",
                    run_name(state)
                )),
            }
        }
        reasons.extend(
            self.host
                .control()
                .shown()
                .iter()
                .map(|shown| format!("message {}", self.host.control().shown_text(shown))),
        );
        if let Some(waits) = self.waits.as_ref().filter(|_| reasons.is_empty()) {
            let found = waits.reasons(&self.host, machine, Language::English);
            reasons.extend(in_words(&found));
        }
        if reasons.is_empty() {
            reasons.push(match self.host.operator().phase() {
                Phase::PowerUp => "the loops are not closed: no control voltage".to_owned(),
                Phase::Reference => "the reference run does not go on".to_owned(),
                Phase::Program | Phase::Ready => self.standing_block(),
            });
        }
        reasons.join("; ")
    }

    /// Where a run stands of which nothing says what it waits for.
    fn standing_block(&self) -> String {
        let block = self.block().map_or("no block".to_owned(), |block| {
            format!("block {}", self.host.control().first().number_of(block))
        });
        format!("{block} is executed, and nothing of control, PLC and machine changes")
    }
}

/// What the marker that the PLC is to set or reset means.
fn meaning(waiting: Waiting) -> String {
    let (Waiting::Acknowledge(pair) | Waiting::AcknowledgeReset(pair)) = waiting;
    let signal = signal::named(SignalOperand::Bit(pair.acknowledge));
    signal.map_or(String::new(), |signal| format!(" ({})", signal.function))
}
