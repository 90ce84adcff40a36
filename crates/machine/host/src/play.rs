//! A script while it is played: which lines wait, what did not hold.

use std::collections::{HashMap, HashSet, VecDeque};

use bahn_tnc::Command;
use serde::Serialize;

use crate::action::{Action, Answer, Source};
use crate::error::HostError;
use crate::expectation::{Expectation, Presence};
use crate::host::Host;
use crate::of_module::NO_MODULE;
use crate::operable::Operable;
use crate::script::{Line, ScriptAction};
use bahn_script::{Base, Line as AnyLine, Script as AnyScript};
use bahn_text::Diagnostic;

/// An expectation that did not hold.
#[derive(Clone, Debug, Serialize)]
pub struct FailedExpectation {
    /// Its line in the script.
    pub line: u32,
    /// The text of the line.
    pub text: String,
    /// What was so instead.
    pub actual: String,
    /// When, s since power-on.
    pub time_s: f64,
}

/// An expectation with what became of it.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Case {
    /// File and line of the expectation.
    pub place: String,
    /// The expectation as the script writes it.
    pub name: String,
    /// What became of it.
    pub verdict: Verdict,
}

/// What became of an expectation.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum Verdict {
    /// It was so at its time.
    Held,
    /// With what was found instead.
    Failed(String),
    /// The run ended before.
    NotReached,
}

/// What a line of a script does, on a machine of one family or another.
pub trait Scripted: Clone {
    /// What a line expects, or waits for.
    type Expected: Clone;

    /// The line only looks whether something is so.
    fn looks(&self) -> bool;

    /// The text of the message that is expected.
    fn message(expected: &Self::Expected) -> Option<&str>;
}

impl Scripted for ScriptAction {
    type Expected = Expectation;

    fn looks(&self) -> bool {
        matches!(self, ScriptAction::Expect(_))
    }

    fn message(expected: &Expectation) -> Option<&str> {
        match expected {
            Expectation::Message(text, Presence::There) => Some(text),
            _ => None,
        }
    }
}

/// A script that is played.
pub struct Play<A: Scripted = ScriptAction> {
    script: AnyScript<A, A::Expected>,
    /// When what times count from was: power-on, start, and each condition.
    bases: Vec<Option<u64>>,
    /// Lines that wait for their time, by what it counts from, in their order of time.
    waiting: Vec<VecDeque<AnyLine<A, A::Expected>>>,
    /// Lines that wait for their condition.
    watching: Vec<AnyLine<A, A::Expected>>,
    /// Texts of messages that were expected and came.
    expected: Vec<String>,
    /// What did not hold.
    pub failed: Vec<FailedExpectation>,
}

/// `None` when it is so on a machine, or on the module beside it; otherwise what is.
fn check<P: Operable, M: Operable>(
    expectation: &Expectation,
    host: &Host<P>,
    module: Option<&Host<M>>,
) -> Option<String> {
    match (expectation, module) {
        (Expectation::Module(what), Some(module)) => what.check(module.control(), module.plant()),
        _ => expectation.check(host.control(), host.plant()),
    }
}

/// Does something to a machine.
fn act<P: Operable>(action: ScriptAction, host: &mut Host<P>) -> Result<(), HostError> {
    let actions = match action {
        ScriptAction::Do(action) => vec![action],
        ScriptAction::Set(assignments) => {
            let commands = assignments.into_iter().map(Command::Set);
            commands.map(|command| Action::Command(0, command)).collect()
        }
        ScriptAction::Expect(_) | ScriptAction::End | ScriptAction::Module(_) => Vec::new(),
    };
    for action in actions {
        let text = action.to_string();
        if let Answer::Impossible(error) = host.act(Source::Script, action)? {
            return Err(HostError::new(format!("{text}: {error}")));
        }
    }
    Ok(())
}

/// The place of a base among all.
fn place(base: Base) -> usize {
    match base {
        Base::PowerOn => 0,
        Base::Start => 1,
        Base::Condition(number) => 2 + number,
    }
}

impl<A: Scripted> Play<A> {
    /// A script from its beginning.
    pub fn new(script: AnyScript<A, A::Expected>) -> Play<A> {
        let conditions = script.lines.iter().filter(|line| !line.condition.is_empty());
        let mut waiting = vec![VecDeque::new(); 2 + conditions.count()];
        for line in &script.lines {
            if let Some(lines) = waiting.get_mut(place(line.base)) {
                lines.push_back(line.clone());
            }
        }
        for lines in &mut waiting {
            lines
                .make_contiguous()
                .sort_by_key(|line| (line.offset_us, !line.after));
        }
        let mut bases = vec![None; waiting.len()];
        if let Some(power_on) = bases.first_mut() {
            *power_on = Some(0);
        }
        Play {
            script,
            bases,
            waiting,
            watching: Vec::new(),
            expected: Vec::new(),
            failed: Vec::new(),
        }
    }

    /// The program was started.
    pub fn start(&mut self, now_us: u64) {
        if let Some(start) = self.bases.get_mut(place(Base::Start)) {
            *start = Some(now_us);
        }
    }

    /// The next line whose condition `holds` or that is due, in the order of time and of the file.
    pub fn due(
        &mut self,
        now_us: u64,
        holds: impl Fn(&A::Expected) -> bool,
    ) -> Option<AnyLine<A, A::Expected>> {
        loop {
            let is_so = |line: &AnyLine<A, A::Expected>| line.condition.iter().all(&holds);
            if let Some(at) = self.watching.iter().position(is_so) {
                let line = self.watching.remove(at);
                self.came_true(&line, now_us);
                return Some(line);
            }
            let mut lanes = self.waiting.iter_mut().zip(&self.bases);
            let line = lanes.find_map(|(lines, base)| {
                let passed_us = now_us.saturating_sub((*base)?);
                let is_due = lines.front()?.offset_us <= passed_us;
                is_due.then(|| lines.pop_front())?
            })?;
            if line.condition.is_empty() {
                return Some(line);
            }
            self.watching.push(line);
        }
    }

    /// The next line that is due and only looks, without a condition: what it looks at is the cycle that has ended.
    pub fn due_to_look(&mut self, now_us: u64) -> Option<AnyLine<A, A::Expected>> {
        let mut lanes = self.waiting.iter_mut().zip(&self.bases);
        lanes.find_map(|(lines, base)| {
            let passed_us = now_us.saturating_sub((*base)?);
            let line = lines.front()?;
            let looks = line.action.looks() && line.condition.is_empty();
            (looks && line.offset_us <= passed_us).then(|| lines.pop_front())?
        })
    }

    /// The script that is played.
    pub fn script(&self) -> &AnyScript<A, A::Expected> {
        &self.script
    }

    /// The lines after a condition count from now on.
    fn came_true(&mut self, line: &AnyLine<A, A::Expected>, now_us: u64) {
        line.condition.iter().for_each(|condition| self.expect(condition));
        let conditions = self.script.lines.iter().filter(|line| !line.condition.is_empty());
        let number = conditions.take_while(|other| other.number < line.number).count();
        if let Some(base) = self.bases.get_mut(place(Base::Condition(number))) {
            *base = Some(now_us);
        }
    }

    /// Something is as expected.
    pub fn expect(&mut self, expectation: &A::Expected) {
        if let Some(text) = A::message(expectation).filter(|text| !text.is_empty()) {
            self.expected.push(text.to_owned());
        }
    }

    /// Whether a message was expected that has come.
    pub fn has_expected(&self, message: &str) -> bool {
        self.expected.iter().any(|text| message.contains(text.as_str()))
    }

    /// No line waits any more for a time that will come: what counts from the start does not when there is none.
    pub fn is_timed_out(&self) -> bool {
        let mut lanes = self.waiting.iter().zip(&self.bases);
        lanes.all(|(lines, base)| lines.is_empty() || base.is_none())
    }

    /// Nor for a condition.
    pub fn is_done(&self) -> bool {
        self.is_timed_out() && self.watching.is_empty()
    }

    /// The lines whose conditions have not come true.
    pub fn pending(&self) -> impl Iterator<Item = &AnyLine<A, A::Expected>> {
        let lines = self.watching.iter().chain(self.waiting.iter().flatten());
        lines.filter(|line| !line.condition.is_empty())
    }

    /// The run is over: a condition that never came true was expected in vain.
    pub fn finish(&mut self, time_s: f64) {
        let numbers: Vec<u32> = self.pending().map(|line| line.number).collect();
        for number in numbers {
            self.fail(number, "it never came true".to_owned(), time_s);
        }
    }

    /// An expectation of a line did not hold.
    pub fn fail(&mut self, line: u32, actual: String, time_s: f64) {
        self.failed.push(FailedExpectation {
            line,
            text: self.script.line_text(line).trim().to_owned(),
            actual,
            time_s,
        });
    }

    /// All expectations with what became of them.
    pub fn expectations(&self) -> Vec<Case> {
        let expectations = self.script.lines.iter();
        let expectations = expectations.filter(|line| !line.condition.is_empty() || line.action.looks());
        let waiting = self.waiting.iter().flatten().chain(&self.watching);
        let waiting: HashSet<u32> = waiting.map(|line| line.number).collect();
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
    pub fn failures(&self) -> Vec<Diagnostic> {
        let failed = self.failed.iter();
        failed
            .map(|failed| {
                let title = format!("not as expected at {:.3} s", failed.time_s);
                self.script.failure(failed.line, &title, failed.actual.clone())
            })
            .collect()
    }
}

impl Play {
    /// Does what a line says on a machine, or looks; tells whether it ends the run.
    ///
    /// # Errors
    /// When the machine has not what it names, or the log cannot be written.
    pub fn perform<P: Operable>(&mut self, line: Line, host: &mut Host<P>) -> Result<bool, HostError> {
        self.perform_with(line, host, None::<&mut Host<P>>)
    }

    fn perform_with<P: Operable, M: Operable>(
        &mut self,
        line: Line,
        host: &mut Host<P>,
        module: Option<&mut Host<M>>,
    ) -> Result<bool, HostError> {
        match (line.action, module) {
            (ScriptAction::End, _) => return Ok(true),
            (ScriptAction::Expect(expectations), module) => {
                for expectation in &expectations {
                    match check(expectation, host, module.as_deref()) {
                        Some(actual) => {
                            self.fail(line.number, actual, host.control().time_us() as f64 * 1e-6);
                        }
                        None => self.expect(expectation),
                    }
                }
            }
            (ScriptAction::Module(_), None) => return Err(HostError::new(NO_MODULE.to_owned())),
            (ScriptAction::Module(action), Some(module)) => act(*action, module)?,
            (action, _) => act(action, host)?,
        }
        Ok(false)
    }

    /// Plays everything that is due on a machine, in the order of time and of the file; tells whether it ends the run.
    ///
    /// # Errors
    /// As [`Play::perform`].
    pub fn follow<P: Operable>(&mut self, host: &mut Host<P>) -> Result<bool, HostError> {
        self.follow_with(host, None::<&mut Host<P>>)
    }

    /// The same on a machine that may have a positioning module beside it; times are those of the machine.
    ///
    /// # Errors
    /// As [`Play::perform`].
    pub fn follow_with<P: Operable, M: Operable>(
        &mut self,
        host: &mut Host<P>,
        mut module: Option<&mut Host<M>>,
    ) -> Result<bool, HostError> {
        let now = host.control().time_us();
        let mut ends = false;
        loop {
            let holds = |condition: &Expectation| check(condition, host, module.as_deref()).is_none();
            let Some(line) = self.due(now, holds) else {
                return Ok(ends);
            };
            ends |= self.perform_with(line, host, module.as_deref_mut())?;
        }
    }
}
