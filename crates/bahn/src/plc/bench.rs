//! A program on the test bench: memory, stand-in for the control, stimuli.

use std::sync::Arc;
use std::time::Duration;

use bahn_exchange::Exchange;
use bahn_parameters::{ControlModel, ParameterList};
use bahn_plc::{Machine, PlcProgram, RuntimeError, Start, TestNc, Tracer, mirror_parameters};

use super::options::BenchOptions;
use super::script::Script;
use crate::UsageError;
use bahn_host::{Assignment, Content, Operand};

/// A program with all it needs to run.
pub(super) struct Bench {
    pub machine: Machine,
    pub exchange: Exchange,
    pub nc: TestNc,
    pub script: Script,
    /// Cycles that were started.
    pub cycle: u64,
    cycle_time: Duration,
    inside: bool,
}

/// An expectation that does not hold.
#[derive(Clone, Debug, serde::Serialize)]
pub(super) struct Failure {
    pub cycle: u64,
    /// Line of the script.
    pub line: u32,
    pub operand: String,
    pub expected: Content,
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
    /// With the operands of `--set`; `exchange` holds what was retained.
    pub fn new(
        program: Arc<PlcProgram>,
        parameters: ParameterList,
        options: &BenchOptions,
        exchange: Exchange,
    ) -> Result<Bench, UsageError> {
        let script = options.script.as_deref().map(Script::load).transpose()?;
        let mut bench = Bench {
            machine: Machine::new(program, Start::PowerOn),
            exchange,
            cycle_time: cycle_time(parameters.model()),
            nc: TestNc::new(parameters),
            script: script.unwrap_or_default(),
            cycle: 0,
            inside: false,
        };
        mirror_parameters(&bench.nc.parameters, &mut bench.exchange);
        for assignment in set_operands(options)? {
            bench
                .set(&assignment)
                .map_err(|error| UsageError::new(format!("--set {error}")))?;
        }
        bench.check_script()?;
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

    /// Applies the stimuli of the next cycle and counts it.
    fn stimulate(&mut self) {
        self.cycle += 1;
        let stimuli = self.script.cycle(self.cycle).map(|cycle| cycle.set.clone());
        for assignment in stimuli.unwrap_or_default() {
            // Every one was tried before the run.
            let _ = self.set(&assignment);
        }
    }

    /// Runs the next cycle; the stimuli come first.
    pub fn scan(&mut self, tracer: Option<&mut dyn Tracer>) -> Result<(), RuntimeError> {
        self.running()?;
        self.stimulate();
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
            self.stimulate();
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
        self.cycle = 0;
        self.inside = false;
    }

    /// What the control does until the next cycle.
    fn end_cycle(&mut self) {
        self.nc.end_scan();
        self.nc.travel(self.cycle_time.as_secs_f64());
    }

    /// From the start of a cycle to the start of the next one.
    pub fn cycle_time(&self) -> Duration {
        self.cycle_time
    }

    /// The expectations of the last cycle that do not hold.
    pub fn failures(&self) -> Vec<Failure> {
        let cycle = self.script.cycle(self.cycle);
        let expected = cycle.map_or(&[][..], |cycle| &cycle.expect);
        let failed = expected.iter().filter_map(|expected| {
            let found = self.read(expected.operand);
            (found != expected.content).then(|| Failure {
                cycle: self.cycle,
                line: expected.line,
                operand: expected.operand.to_string(),
                expected: expected.content.clone(),
                found,
            })
        });
        failed.collect()
    }

    pub fn read(&self, operand: Operand) -> Content {
        operand.read(self.exchange.plc())
    }

    /// Tries the machine parameters of the script, so that a wrong one is said before the run.
    fn check_script(&self) -> Result<(), UsageError> {
        let mut list = self.nc.parameters.clone();
        for assignment in self.script.cycles().flat_map(|cycle| &cycle.set) {
            if let Assignment::Parameter(text) = assignment {
                assign(&mut list, text).map_err(|error| UsageError::new(format!("script: {error}")))?;
            }
        }
        Ok(())
    }
}

/// The assignments of `--set`.
pub(super) fn set_operands(options: &BenchOptions) -> Result<Vec<Assignment>, UsageError> {
    let mut all = Vec::new();
    for text in &options.set {
        all.extend(
            Assignment::parse_all(text).map_err(|error| UsageError::new(format!("--set {text}: {error}")))?,
        );
    }
    // Machine parameters first: they go to words that may be set, too.
    all.sort_by_key(|assignment| matches!(assignment, Assignment::Operand(..)));
    Ok(all)
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
