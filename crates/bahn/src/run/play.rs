//! A script while it is played: which lines wait, what did not hold.

use std::collections::{HashMap, HashSet, VecDeque};

use super::listed::FailedExpectation;
use super::script::{Action, Base, Line, Script};
use crate::diagnostics::FileFault;
use crate::junit::{Case, Verdict};

/// A script that is played.
pub(super) struct Play {
    script: Script,
    /// Lines by the time they count from, in their order of time.
    waiting: [VecDeque<Line>; 2],
    /// What did not hold.
    pub failed: Vec<FailedExpectation>,
}

impl Play {
    pub fn new(script: Script) -> Play {
        let lines = |base| {
            let lines = script.lines.iter().filter(|line| line.base == base);
            let mut lines: Vec<Line> = lines.cloned().collect();
            lines.sort_by_key(|line| line.offset_us);
            VecDeque::from(lines)
        };
        Play {
            waiting: [lines(Base::PowerOn), lines(Base::Start)],
            failed: Vec::new(),
            script,
        }
    }

    /// The next line that is due, in the order of time and of the file. `start_us` is when the program was started.
    pub fn due(&mut self, now_us: u64, start_us: Option<u64>) -> Option<Line> {
        let bases = [Some(0), start_us];
        let mut lanes = self.waiting.iter_mut().zip(bases);
        lanes.find_map(|(lines, base)| {
            let passed_us = now_us.saturating_sub(base?);
            let is_due = lines.front()?.offset_us <= passed_us;
            is_due.then(|| lines.pop_front())?
        })
    }

    /// Nothing waits any more that will come: what counts from the start does not when there is none.
    pub fn is_done(&self, started: bool) -> bool {
        let [from_power_on, from_start] = &self.waiting;
        from_power_on.is_empty() && (!started || from_start.is_empty())
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
