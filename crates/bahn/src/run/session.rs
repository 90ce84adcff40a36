//! Control and machine, switched on: cycle after cycle until the run ends.

use std::collections::{HashMap, HashSet, VecDeque};

use bahn_control::{Command, Control, Message, RunState, Shown};
use bahn_host::State;
use bahn_machine::{Event, KeyAction, Machine};
use bahn_path::{BlockRef, FeedRate, PathElement};

use super::background::Background;
use super::deviation::Deviation;
use super::expectation::run_name;
use super::listed::{Confirmed, FailedExpectation, Said};
use super::log::Log;
use super::operator::{Deed, Operator, Phase, Why};
use super::pace::Pace;
use super::recording::Recording;
use super::script::{Action, Base, Line, Script};
use super::times::Times;
use super::turning::{ElementId, Turning};
use crate::UsageError;
use crate::cutting::Cutting;
use crate::diagnostics::FileFault;
use crate::files::short_name;
use crate::interrupt::Interrupt;
use crate::junit::{Case, Verdict};
use crate::progress::Progress;
use crate::report::{Notice, Record};
use crate::test_run::{Outputs, stop_function};

/// Keys that are listed as confirmed at most.
const CONFIRMED_MAX: usize = 1000;
/// Messages that are listed at most.
const MESSAGES_MAX: usize = 1000;

/// How a session ended.
#[derive(Clone, Debug, PartialEq)]
pub(super) enum Ended {
    /// The program came to its end, or the script when there is no program.
    Completed,
    /// By `end` of the script.
    Stopped,
    /// The time allowed is over.
    TooLong,
    /// By Ctrl-C.
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

/// What the session writes while it goes on.
pub(super) struct Writers {
    pub recording: Option<Recording>,
    pub log: Option<Log>,
    pub outputs: Outputs,
    pub state: Option<State>,
}

impl Writers {
    /// Completes all files, also behind one that cannot be written.
    ///
    /// # Errors
    /// The first of those.
    pub fn finish(&mut self) -> Result<(), UsageError> {
        let recording = self.recording.take().map_or(Ok(()), Recording::finish);
        let log = self.log.take().map_or(Ok(()), Log::finish);
        self.outputs.finish().and(recording).and(log)
    }
}

/// What is known of a session, while it runs and in the end.
pub(super) struct Session {
    pub control: Control,
    pub machine: Machine,
    pub operator: Operator,
    pub script: Script,
    pub writers: Writers,
    pub record: Record,
    pub cutting: Option<Cutting>,
    pub deviation: Deviation,
    pub times: Times,
    pub messages: Vec<Said>,
    pub confirmed: Vec<Confirmed>,
    pub failed: Vec<FailedExpectation>,
    pub pace: Option<Pace>,
    pub max_time_us: u64,
    pub max_wait_us: u64,
    pub power_up_us: u64,
    pub reference_us: u64,
    pub program_us: u64,
    /// Sum of the nominal times of the PLC, and over how many cycles; the longest.
    pub plc_percent: (f64, u64, f64),
    /// Lines of the script by the time they count from, in their order of time.
    waiting: [VecDeque<Line>; 2],
    /// When the program was started.
    start_us: Option<u64>,
    /// Elements that were prepared and not yet executed.
    ahead: VecDeque<PathElement>,
    turning: Turning,
    /// The element that was executed last, with the way that was left of it.
    last_seen: Option<(ElementId, f64)>,
    moved_us: u64,
    last_stop: bool,
    broken_by: Option<Box<Shown>>,
    background: Background,
    ended: Option<Ended>,
}

/// The parts that a session is made of.
pub(super) struct Parts {
    pub control: Control,
    pub machine: Machine,
    pub operator: Operator,
    pub script: Script,
    pub writers: Writers,
    pub cutting: Option<Cutting>,
    pub realtime: bool,
    pub max_time_s: f64,
    pub max_wait_s: f64,
}

impl Session {
    pub fn new(parts: Parts) -> Session {
        let mut control = parts.control;
        control.keep_path(true);
        control.defer_work();
        let lines = |base| {
            let mut lines: Vec<Line> = parts
                .script
                .lines
                .iter()
                .filter(|l| l.base == base)
                .cloned()
                .collect();
            lines.sort_by_key(|line| line.offset_us);
            VecDeque::from(lines)
        };
        Session {
            waiting: [lines(Base::PowerOn), lines(Base::Start)],
            deviation: Deviation::new(&control),
            record: Record::new(bahn_path::Position::UNKNOWN),
            control,
            machine: parts.machine,
            operator: parts.operator,
            script: parts.script,
            writers: parts.writers,
            cutting: parts.cutting,
            times: Times::default(),
            messages: Vec::new(),
            confirmed: Vec::new(),
            failed: Vec::new(),
            pace: parts.realtime.then(Pace::new),
            max_time_us: (parts.max_time_s * 1e6) as u64,
            max_wait_us: (parts.max_wait_s * 1e6) as u64,
            power_up_us: 0,
            reference_us: 0,
            program_us: 0,
            plc_percent: (0.0, 0, 0.0),
            start_us: None,
            ahead: VecDeque::new(),
            turning: Turning::default(),
            last_seen: None,
            moved_us: 0,
            last_stop: false,
            broken_by: None,
            background: Background::default(),
            ended: None,
        }
    }

    /// Runs to the end.
    pub fn run(&mut self, interrupt: &Interrupt, progress: &mut Progress) -> Result<Ended, UsageError> {
        loop {
            self.follow_script()?;
            if let Some(deed) = self.operator.act(&self.control) {
                self.execute(deed)?;
            }
            if let Some(ended) = self.ended.take() {
                self.take_last()?;
                self.note("end")?;
                return Ok(ended);
            }
            let realtime = self.pace.is_some();
            self.background.prepare(&mut self.control, realtime, interrupt);
            self.control.cycle(&mut self.machine);
            self.watch()?;
            if let Some(list) = self.control.take_restart() {
                return Ok(Ended::Restart(list));
            }
            if let Some(state) = &mut self.writers.state
                && let Err(error) = state.keep(&mut self.control)
            {
                return Ok(Ended::NotStored(error.to_string()));
            }
            if let Some(pace) = &mut self.pace {
                pace.cycle(self.control.time_us());
            }
            let block = self.block().filter(|block| block.program == 0);
            progress.element(block.map(|block| block.block), self.program_us as f64 * 1e-6);
            self.ended = if interrupt.is_requested() {
                Some(Ended::Interrupted)
            } else {
                self.end()
            };
        }
    }

    /// The block that is executed.
    pub fn block(&self) -> Option<BlockRef> {
        self.control.element().map(|element| element.block)
    }

    /// Name of the program of a block.
    pub fn program_name(&self, block: BlockRef) -> String {
        self.control
            .interpreter()
            .and_then(|run| run.program(block.program))
            .map(|program| short_name(program).to_owned())
            .unwrap_or_default()
    }

    /// Everything that is due, in the order of time and of the file.
    fn follow_script(&mut self) -> Result<(), UsageError> {
        let now = self.control.time_us();
        let bases = [Some(0), self.start_us];
        for (place, base) in bases.into_iter().enumerate() {
            let Some(base) = base else { continue };
            while let Some(line) = self.due(place, now.saturating_sub(base)) {
                self.execute_line(line)?;
            }
        }
        Ok(())
    }

    fn due(&mut self, place: usize, passed_us: u64) -> Option<Line> {
        let lines = self.waiting.get_mut(place)?;
        if lines.front()?.offset_us > passed_us {
            return None;
        }
        lines.pop_front()
    }

    fn execute_line(&mut self, line: Line) -> Result<(), UsageError> {
        match line.action {
            Action::End => {
                let done = match self.operator.has_job() {
                    true => self.control.has_ended() && self.is_idle(),
                    false => self.is_idle(),
                };
                self.ended = Some(if done { Ended::Completed } else { Ended::Stopped });
            }
            Action::Command(command) => {
                self.note(&command.to_string())?;
                self.control.command(command);
            }
            Action::Event(event, text) => {
                self.note(&text)?;
                if let Err(error) = self.machine.act(&event) {
                    return Err(UsageError::new(format!("{text}: {error}")));
                }
            }
            Action::Expect(expectation) => {
                if let Some(actual) = expectation.check(&self.control, &self.machine) {
                    self.failed.push(FailedExpectation {
                        line: line.number,
                        text: self.script.line_text(line.number).trim().to_owned(),
                        actual,
                        time_s: self.control.time_us() as f64 * 1e-6,
                    });
                }
            }
        }
        Ok(())
    }

    fn execute(&mut self, deed: Deed) -> Result<(), UsageError> {
        match deed {
            Deed::Command(command) => {
                self.note(&command.to_string())?;
                let refused = !self.control.command(command.clone());
                if refused && !matches!(command, Command::Ce) {
                    let refusal = format!("the control refuses `{command}`");
                    self.ended = Some(Ended::Hangs(refusal, None));
                }
            }
            Deed::Key(key, why) => {
                self.note(&format!("key {key} tap"))?;
                if why != Why::Routine && self.confirmed.len() < CONFIRMED_MAX {
                    let block = self.block();
                    self.confirmed.push(Confirmed {
                        time_s: self.control.time_us() as f64 * 1e-6,
                        key: key.clone(),
                        why: match why {
                            Why::Stop => self.stop_name(block),
                            Why::Routine | Why::ToolChange => "tool change",
                        },
                        block: block.map_or(0, |block| block.block),
                    });
                }
                let event = Event::Key(key.clone(), KeyAction::Tap);
                if let Err(error) = self.machine.act(&event) {
                    return Err(UsageError::new(format!(
                        "the operator cannot press {key} ([operator] in machine.toml): {error}"
                    )));
                }
            }
        }
        Ok(())
    }

    fn stop_name(&self, block: Option<BlockRef>) -> &'static str {
        let run = self.control.interpreter();
        let function = run.zip(block).and_then(|(run, block)| stop_function(run, block));
        function.unwrap_or("programmed stop")
    }

    fn note(&mut self, what: &str) -> Result<(), UsageError> {
        let now = self.control.time_us();
        match &mut self.writers.log {
            Some(log) => log.note(now, what),
            None => Ok(()),
        }
    }

    /// Looks at what the cycle brought.
    fn watch(&mut self) -> Result<(), UsageError> {
        let cycle_us = u64::from(self.control.cycle_us());
        let percent = self.control.plc_percent();
        let (sum, count, longest) = &mut self.plc_percent;
        *sum += percent;
        *count += 1;
        *longest = longest.max(percent);
        match self.operator.phase {
            Phase::PowerUp => self.power_up_us += cycle_us,
            Phase::Reference => self.reference_us += cycle_us,
            Phase::Program | Phase::Ready => {}
        }
        for shown in self.control.take_messages() {
            self.say(&shown);
        }
        let running = !self.is_idle();
        if running && self.start_us.is_none() && self.operator.phase != Phase::PowerUp {
            // What the script gives from the start on counts from here.
            self.start_us = Some(self.control.time_us());
        }
        if running {
            self.program_us += cycle_us;
            self.times.cycle(&self.control);
            self.turning.cycle(&self.control, &self.machine);
            let feed = self.control.element().map(|element| element.feed);
            self.deviation
                .cycle(&self.control, matches!(feed, Some(FeedRate::Programmed(_))));
        } else {
            self.deviation.restart();
        }
        self.take_path()?;
        self.note_stop();
        if !self.control.stands() || self.is_dwelling() {
            self.moved_us = self.control.time_us();
        }
        match &mut self.writers.recording {
            Some(recording) => recording.cycle(&self.control, self.start_us.is_some()),
            None => Ok(()),
        }
    }

    /// A message came up.
    fn say(&mut self, shown: &Shown) {
        let place = match &shown.message {
            Message::Program(error) => Some(error.detail.clone()).filter(|d| !d.is_empty()),
            other => other.place(),
        };
        let idle = self.is_idle();
        // A message of the PLC does not break a run off that has not begun.
        let refused = self.operator.started && !matches!(shown.message, Message::Plc(_));
        if shown.flashing || idle && (self.start_us.is_some() || refused) {
            self.broken_by = Some(Box::new(shown.clone()));
        }
        if let Some(recording) = &mut self.writers.recording {
            recording.message(&self.control.message_text(&shown.message));
        }
        if self.messages.len() < MESSAGES_MAX {
            let program = shown
                .block
                .map(|block| self.program_name(block))
                .unwrap_or_default();
            self.messages.push(Said {
                time_s: shown.time_us as f64 * 1e-6,
                text: self.control.message_text(&shown.message),
                place,
                flashing: shown.flashing,
                block: shown
                    .block
                    .filter(|_| !program.is_empty())
                    .map(|block| block.block),
                program,
            });
        }
    }

    /// Hands on what was executed.
    fn take_path(&mut self) -> Result<(), UsageError> {
        if let Some(dropped) = self.control.take_dropped_path() {
            self.ahead.retain(|element| element.sequence < dropped);
        }
        self.ahead.extend(self.control.take_path());
        for warning in self.control.take_warnings() {
            self.record
                .warn(warning.block, Notice::Program(warning.kind), warning.count);
        }
        let all = self.control.has_ended();
        if let Some(element) = self.control.element() {
            self.last_seen = Some((ElementId::of(element), self.control.rest_mm()));
        }
        let current = self.control.element().map(|element| element.sequence);
        while let Some(element) = self.ahead.front() {
            if !all && current.is_none_or(|current| element.sequence >= current) {
                break;
            }
            self.take_front()?;
        }
        Ok(())
    }

    /// Of a run that was broken off in a block: what was executed to the end counts, too.
    fn take_last(&mut self) -> Result<(), UsageError> {
        /// Way that may be left when an element is done.
        const DONE_MM: f64 = 1e-6;
        let Some((current, rest_mm)) = self.last_seen else {
            return Ok(());
        };
        while let Some(element) = self.ahead.front() {
            let is_current = ElementId::of(element) == current;
            if element.sequence > current.sequence || is_current && rest_mm > DONE_MM {
                break;
            }
            self.take_front()?;
            if is_current {
                break;
            }
        }
        Ok(())
    }

    /// Hands on the next element.
    fn take_front(&mut self) -> Result<(), UsageError> {
        let Some(element) = self.ahead.pop_front() else {
            return Ok(());
        };
        self.record.path(&element);
        let spindle = self.turning.take(&element);
        if let Some(cutting) = &mut self.cutting {
            if let Some(spindle) = spindle {
                cutting.see(spindle);
            }
            cutting.element(&element, &mut self.record)?;
        }
        if let Some(run) = self
            .control
            .interpreter()
            .filter(|_| !self.writers.outputs.is_empty())
        {
            self.writers.outputs.element(&element, run, &mut self.record)?;
        }
        Ok(())
    }

    /// Lists programmed stops.
    fn note_stop(&mut self) {
        let stopped = self.control.run_state() == RunState::Stopped;
        if stopped && !self.last_stop {
            let block = self.block();
            let name = self.stop_name(block);
            if let Some(block) = block {
                self.record.stop(block, name);
            }
        }
        self.last_stop = stopped;
    }

    fn is_dwelling(&self) -> bool {
        self.control.run_state() == RunState::Running
            && self.control.waiting().is_none()
            && self
                .control
                .element()
                .is_some_and(|element| element.dwell_s > 0.0 && !self.waits_too_long(element.dwell_s))
    }

    /// Nothing has moved for the time allowed and a dwell besides.
    fn waits_too_long(&self, dwell_s: f64) -> bool {
        let still = self.control.time_us().saturating_sub(self.moved_us);
        still > self.max_wait_us.saturating_add((dwell_s * 1e6) as u64)
    }

    /// Why the session ends with this cycle.
    fn end(&mut self) -> Option<Ended> {
        let now = self.control.time_us();
        let script_done = self.waiting.iter().all(VecDeque::is_empty)
            || self.start_us.is_none() && self.waiting.first().is_none_or(VecDeque::is_empty);
        if now >= self.max_time_us {
            return Some(Ended::TooLong);
        }
        let fatal = self.control.shown().iter().find(|shown| shown.flashing);
        if let Some(fatal) = fatal.filter(|_| script_done && self.control.stands()) {
            return Some(Ended::Broken(Some(Box::new(fatal.clone()))));
        }
        let idle = self.is_idle();
        match self.operator.phase {
            Phase::Program if self.start_us.is_some() && idle && script_done => {
                return Some(if self.control.has_ended() {
                    Ended::Completed
                } else {
                    Ended::Broken(self.broken_by.take())
                });
            }
            Phase::Program if idle && script_done && self.broken_by.is_some() => {
                return Some(Ended::Broken(self.broken_by.take()));
            }
            Phase::Ready if script_done && idle && self.control.stands() => return Some(Ended::Completed),
            _ => {}
        }
        let still = now.saturating_sub(self.moved_us);
        if !script_done || still <= self.max_wait_us || self.is_dwelling() {
            return None;
        }
        let waits_for = self.waits_for();
        let stopped_by = self.control.shown().last().cloned();
        if let Some(shown) = &stopped_by {
            // Waiting after the message is no machining time.
            let since = shown.time_us.max(self.moved_us);
            let taken = self.times.take_back(now.saturating_sub(since));
            self.program_us = self.program_us.saturating_sub(taken);
        }
        Some(Ended::Hangs(waits_for, stopped_by.map(Box::new)))
    }

    /// No run is on its way: none was started, it has ended, or a fault has interrupted it.
    fn is_idle(&self) -> bool {
        self.control.run_state() == RunState::Idle || self.control.is_broken()
    }

    /// What keeps a run from going on.
    fn waits_for(&self) -> String {
        let mut reasons = Vec::new();
        if let Some(waiting) = self.control.waiting() {
            reasons.push(waiting.to_string());
        }
        if self.control.feed_override_percent() == 0.0 {
            reasons.push("the feed override is 0 %".to_owned());
        }
        match self.control.run_state() {
            RunState::Running | RunState::Idle => {}
            state => reasons.push(format!("the run is {}: NC start goes on", run_name(state))),
        }
        reasons.extend(
            self.control
                .shown()
                .iter()
                .map(|shown| format!("message {}", self.control.message_text(&shown.message))),
        );
        if reasons.is_empty() {
            reasons.push(match self.operator.phase {
                Phase::PowerUp => "the loops are not closed: no control voltage".to_owned(),
                Phase::Reference => "the reference run does not go on".to_owned(),
                Phase::Program | Phase::Ready => "no axis moves, no function is under way".to_owned(),
            });
        }
        reasons.join("; ")
    }

    /// All expectations of the script with what became of them.
    pub fn expectations(&self) -> Vec<Case> {
        let expectations = self.script.lines.iter();
        let expectations = expectations.filter(|line| matches!(line.action, Action::Expect(_)));
        let waiting: HashSet<u32> = self.waiting.iter().flatten().map(|line| line.number).collect();
        let failed: HashMap<u32, &FailedExpectation> =
            self.failed.iter().map(|failed| (failed.line, failed)).collect();
        let cases = expectations.map(|line| Case {
            place: self.script.place(line.number),
            name: self.script.line_text(line.number).trim().to_owned(),
            verdict: match failed.get(&line.number) {
                Some(failed) => Verdict::Failed(failed.actual.clone()),
                None if waiting.contains(&line.number) => Verdict::NotReached,
                None => Verdict::Held,
            },
        });
        cases.collect()
    }

    /// Expectations that failed, at their lines.
    pub fn failures(&self) -> Vec<FileFault> {
        let failed = self.failed.iter();
        failed
            .map(|failed| {
                let title = format!("not as expected at {:.3} s", failed.time_s);
                self.script.failure(failed.line, &title, failed.actual.clone())
            })
            .collect()
    }
}
