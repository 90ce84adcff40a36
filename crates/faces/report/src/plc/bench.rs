//! A program on the test bench: memory, stand-in for the control, stimuli.

use std::sync::Arc;
use std::time::Duration;

use bahn_exchange::Exchange;
use bahn_parameters::{ControlModel, ParameterList};
use bahn_plc::{Machine, PlcProgram, RuntimeError, Start, TestNc, Tracer, mirror_parameters};

use bahn_host::{
    Assignment, Base, Content, Expectation, Line, Observable, Operand, Play, Relation, Script, ScriptAction,
};
use bahn_tnc::Signal;

/// A program with all it needs to run.
pub struct Bench {
    /// The program that runs.
    pub machine: Machine,
    /// The memory shared with the control.
    pub exchange: Exchange,
    /// What stands in for the control.
    pub nc: TestNc,
    /// The script that is played on it.
    pub play: Play,
    /// Expectations that did not hold since somebody took them.
    failures: Vec<Failure>,
    /// What the script does in the next cycle is done.
    stimulated: bool,
    /// Cycles that were started.
    pub cycle: u64,
    cycle_time: Duration,
    inside: bool,
    /// The script has set something for the next cycle.
    acted: bool,
    /// The cycle for which it did so last.
    acted_at: u64,
    /// The script has ended the run.
    ended: bool,
}

/// An expectation that does not hold.
#[derive(Clone, Debug, serde::Serialize)]
pub struct Failure {
    /// PLC cycle in which it was looked at, counted from the start.
    pub cycle: u64,
    /// Line of the script.
    pub line: u32,
    /// The operand as the script names it: `M100`.
    pub operand: String,
    /// What was expected of it.
    pub expected: Content,
    /// Content of the operand in that cycle.
    pub found: Content,
}

impl std::fmt::Display for Failure {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        write!(
            f,
            "cycle {}: {} expected {}, found {}",
            self.cycle, self.operand, self.expected, self.found
        )
    }
}

impl Bench {
    /// A program with its script; what is `set` is so before the first cycle, and `exchange` holds what was retained.
    ///
    /// # Errors
    /// When something cannot be set; why.
    pub fn new(
        program: Arc<PlcProgram>,
        parameters: ParameterList,
        script: Script,
        set: &[Assignment],
        exchange: Exchange,
    ) -> Result<Bench, String> {
        let mut bench = Bench {
            machine: Machine::new(program, Start::PowerOn),
            exchange,
            cycle_time: cycle_time(parameters.model()),
            nc: TestNc::new(parameters),
            play: Play::new(script),
            failures: Vec::new(),
            stimulated: false,
            cycle: 0,
            inside: false,
            acted: false,
            acted_at: 0,
            ended: false,
        };
        mirror_parameters(&bench.nc.parameters, &mut bench.exchange);
        for assignment in set {
            bench.set(assignment)?;
        }
        Ok(bench)
    }

    /// Sets an operand or a machine parameter from outside.
    pub fn set(&mut self, assignment: &Assignment) -> Result<(), String> {
        match assignment {
            Assignment::Operand(operand, content) => operand.write(&mut self.exchange, content),
            Assignment::Parameter(text) => {
                assign(&mut self.nc.parameters, text)?;
                mirror_parameters(&self.nc.parameters, &mut self.exchange);
            }
        }
        Ok(())
    }

    /// No cycle begins while an error has stopped the PLC.
    fn running(&self) -> Result<(), RuntimeError> {
        self.machine.stopped().map_or(Ok(()), |error| Err(error.clone()))
    }

    /// Time since power-on, µs.
    fn now_us(&self) -> u64 {
        let cycle_us = u64::try_from(self.cycle_time.as_micros()).unwrap_or(u64::MAX);
        self.cycle.saturating_mul(cycle_us)
    }

    /// Everything of the script that is due before the next cycle.
    pub fn stimulate(&mut self) {
        if std::mem::replace(&mut self.stimulated, true) {
            return;
        }
        let now = self.now_us();
        loop {
            let image = self.exchange.plc();
            let holds = |condition: &Expectation| condition.check_memory(image).is_none();
            let Some(line) = self.play.due(now, holds) else {
                return;
            };
            self.perform(line);
        }
    }

    fn perform(&mut self, line: Line) {
        match line.action {
            ScriptAction::Set(assignments) => {
                self.acted = true;
                for assignment in assignments {
                    // Every one was tried before the run.
                    let _ = self.set(&assignment);
                }
            }
            ScriptAction::Expect(expectations) => {
                for expectation in expectations {
                    self.look(line.number, &expectation);
                }
            }
            ScriptAction::End => self.ended = true,
            // Without a machine no script has any.
            ScriptAction::Do(_) | ScriptAction::Module(_) => {}
        }
    }

    fn look(&mut self, line: u32, expectation: &Expectation) {
        let Some(actual) = expectation.check_memory(self.exchange.plc()) else {
            return;
        };
        self.play.fail(line, actual, self.now_us() as f64 * 1e-6);
        self.failures.extend(self.failure(line, expectation));
    }

    fn failure(&self, line: u32, expectation: &Expectation) -> Option<Failure> {
        let (operand, expected) = match expectation {
            Expectation::Value(Observable::Signal(Signal::Bit(bit)), relation, value) => {
                (Operand::Bit(*bit), (relation, *value))
            }
            Expectation::Value(Observable::Signal(Signal::Number(number)), relation, value) => {
                (Operand::Number(*number), (relation, *value))
            }
            Expectation::Text(string, text) => {
                return Some(self.failed(line, Operand::Text(*string), Content::Text(text.clone())));
            }
            _ => return None,
        };
        let expected = match expected {
            (Relation::Equal(_), value) => Content::Number(value as i32),
            (Relation::Less, value) => Content::Text(format!("< {value}")),
            (Relation::Greater, value) => Content::Text(format!("> {value}")),
        };
        Some(self.failed(line, operand, expected))
    }

    fn failed(&self, line: u32, operand: Operand, expected: Content) -> Failure {
        Failure {
            cycle: self.cycle,
            line,
            operand: operand.to_string(),
            expected,
            found: self.read(operand),
        }
    }

    /// The run is over: what has come true by now is looked at, and what has not was expected in vain.
    pub fn finish(&mut self) {
        let now = self.now_us();
        loop {
            let image = self.exchange.plc();
            let holds = |condition: &Expectation| condition.check_memory(image).is_none();
            match self.play.due(now, holds) {
                None => break,
                // Nothing is done for a cycle that does not come.
                Some(line) if matches!(line.action, ScriptAction::Set(_)) => {}
                Some(line) => self.perform(line),
            }
        }
        let mut failures = Vec::new();
        for line in self.play.pending() {
            let image = self.exchange.plc();
            let failed = line
                .condition
                .iter()
                .filter(|condition| condition.check_memory(image).is_some());
            failures.extend(failed.filter_map(|condition| self.failure(line.number, condition)));
        }
        self.failures.extend(failures);
        self.play.finish(now as f64 * 1e-6);
    }

    /// The script wants nothing more, but for what it did before the next cycle.
    pub fn is_over(&self) -> bool {
        self.ended || self.cycle > 0 && self.play.is_done() && !self.acted
    }

    /// The script has ended the run.
    pub fn has_ended(&self) -> bool {
        self.ended
    }

    /// The script waits for nothing but conditions, and nothing was done or came true for so many cycles.
    pub fn waits_in_vain(&self, cycles: u64) -> bool {
        self.play.is_timed_out() && self.cycle.saturating_sub(self.acted_at) > cycles
    }

    /// Runs the next cycle; the stimuli come first.
    pub fn scan(&mut self, tracer: Option<&mut dyn Tracer>) -> Result<(), RuntimeError> {
        self.running()?;
        self.begin_cycle();
        let report = match tracer {
            Some(tracer) => self.machine.scan_traced(&mut self.exchange, &mut self.nc, tracer),
            None => self.machine.scan(&mut self.exchange, &mut self.nc),
        };
        self.end_cycle();
        report.map(|_| ())
    }

    /// Executes the next line of a cycle, and begins one if none was begun; tells whether it is over.
    pub fn step(&mut self, tracer: &mut dyn Tracer) -> Result<bool, RuntimeError> {
        self.running()?;
        if !self.inside {
            self.begin_cycle();
            self.machine.begin(&mut self.exchange, &mut self.nc)?;
            self.inside = true;
        }
        let report = self
            .machine
            .step(&mut self.exchange, &mut self.nc, Some(tracer))
            .inspect_err(|_| self.inside = false)?;
        if report.is_some() {
            self.inside = false;
            self.end_cycle();
        }
        Ok(report.is_some())
    }

    /// Whether a cycle was begun line by line and is not over.
    pub fn is_inside(&self) -> bool {
        self.inside
    }

    /// Starts program and script anew; operands keep their values.
    pub fn restart(&mut self) {
        self.machine.restart(Start::Interruption, &mut self.nc);
        self.play = Play::new(self.play.script().clone());
        self.failures.clear();
        (self.cycle, self.acted_at) = (0, 0);
        (self.inside, self.stimulated, self.acted, self.ended) = (false, false, false, false);
    }

    /// The stimuli come before a cycle.
    fn begin_cycle(&mut self) {
        self.stimulate();
        if std::mem::take(&mut self.acted) {
            self.acted_at = self.cycle;
        }
        self.stimulated = false;
        self.cycle += 1;
    }

    /// What the control does until the next cycle.
    fn end_cycle(&mut self) {
        self.nc.end_scan();
        self.nc.travel(self.cycle_time.as_secs_f64());
        let now = self.now_us();
        while let Some(line) = self.play.due_to_look(now) {
            self.perform(line);
        }
    }

    /// From the start of a cycle to the start of the next one.
    pub fn cycle_time(&self) -> Duration {
        self.cycle_time
    }

    /// The expectations that did not hold since the last call.
    pub fn take_failures(&mut self) -> Vec<Failure> {
        std::mem::take(&mut self.failures)
    }

    /// What an operand holds between two cycles.
    pub fn read(&self, operand: Operand) -> Content {
        operand.read(self.exchange.plc())
    }
}

/// The last cycle of which a script speaks with its time.
pub fn last_cycle(script: &Script, cycle_time: Duration) -> u64 {
    let cycle_us = u64::try_from(cycle_time.as_micros()).unwrap_or(u64::MAX).max(1);
    let cycles = script.lines.iter().filter(|line| line.base == Base::PowerOn);
    let cycles = cycles.map(|line| match line.action {
        ScriptAction::Expect(_) | ScriptAction::End => line.offset_us.div_ceil(cycle_us),
        ScriptAction::Set(_) | ScriptAction::Do(_) | ScriptAction::Module(_) => line.offset_us / cycle_us + 1,
    });
    cycles.max().unwrap_or(0)
}

/// All operands of a script, in the order of their lines.
pub fn operands(script: &Script) -> Vec<Operand> {
    let mut operands = Vec::new();
    let mut add = |operand: Operand| {
        if !operands.contains(&operand) {
            operands.push(operand);
        }
    };
    for line in &script.lines {
        let mut expected = line.condition.iter().collect::<Vec<_>>();
        match &line.action {
            ScriptAction::Expect(expectations) => expected.extend(expectations),
            ScriptAction::Set(assignments) => {
                for assignment in assignments {
                    if let Assignment::Operand(operand, _) = assignment {
                        add(*operand);
                    }
                }
            }
            ScriptAction::Do(_) | ScriptAction::End | ScriptAction::Module(_) => {}
        }
        for expectation in expected {
            match expectation {
                Expectation::Value(Observable::Signal(Signal::Bit(bit)), ..) => add(Operand::Bit(*bit)),
                Expectation::Value(Observable::Signal(Signal::Number(number)), ..) => {
                    add(Operand::Number(*number))
                }
                Expectation::Text(string, _) => add(Operand::Text(*string)),
                _ => {}
            }
        }
    }
    operands
}

/// The PLC cycle time [000:11185].
fn cycle_time(model: ControlModel) -> Duration {
    Duration::from_micros(model.limits().plc_cycle_us.into())
}

fn assign(list: &mut ParameterList, text: &str) -> Result<(), String> {
    list.assign(text)
        .map(drop)
        .map_err(|error| format!("MP{text}: {error}"))
}
