//! What is looked at: a PLC program on its bench, or in the control of a machine.

#[cfg(feature = "terminal")]
use std::time::Duration;

use bahn_exchange::Exchange;
#[cfg(feature = "terminal")]
use bahn_host::Script;
use bahn_host::{Content, Operand};
use bahn_plc::{Machine, Tracer};

use super::bench::Bench;
use super::failure;
use super::halt::Halt;
use super::live::{self, Live};
use super::options::{BenchOptions, MachineOptions, ProgramOptions};
use super::source::Source;
use crate::{Outcome, UsageError, diagnostics};

/// A PLC program that runs.
pub(super) enum Subject {
    Bench(Box<Bench>),
    Machine(Box<Live>),
}

impl Subject {
    /// The program of a main file on the bench, or the machine of a folder; `None` when it is faulty: that was said.
    pub fn open(
        program: &ProgramOptions,
        bench: &BenchOptions,
        machine: &MachineOptions,
        exchange: impl FnOnce() -> Result<Exchange, UsageError>,
    ) -> Result<Option<Subject>, UsageError> {
        if live::is_machine(&program.file) {
            let live = Live::new(program, bench, machine)?;
            return Ok(live.map(|live| Subject::Machine(Box::new(live))));
        }
        if !machine.part.is_empty() {
            return Err(UsageError::new(
                "--part needs the folder of a machine: on the bench no part program runs",
            ));
        }
        let source = Source::compile(program)?;
        let parameters = source.parameters.clone();
        let Some(program) = source.program() else {
            return Ok(None);
        };
        let bench = Bench::new(program, parameters, bench, exchange()?)?;
        Ok(Some(Subject::Bench(Box::new(bench))))
    }

    /// Scans that were started.
    pub fn cycle(&self) -> u64 {
        match self {
            Subject::Bench(bench) => bench.cycle,
            Subject::Machine(live) => live.cycle,
        }
    }

    /// Runs the next scan.
    pub fn scan(&mut self, tracer: Option<&mut dyn Tracer>) -> Result<(), Halt> {
        match self {
            Subject::Bench(bench) => {
                bench.stimulate();
                if bench.has_ended() {
                    return Err(Halt::Ended);
                }
                Ok(bench.scan(tracer)?)
            }
            Subject::Machine(live) => match tracer {
                Some(tracer) => live.scan(Some(tracer)),
                None => live.scan(None),
            },
        }
    }

    pub fn read(&self, operand: Operand) -> Content {
        match self {
            Subject::Bench(bench) => bench.read(operand),
            Subject::Machine(live) => live.read(operand),
        }
    }

    pub fn plc(&self) -> &Machine {
        match self {
            Subject::Bench(bench) => &bench.machine,
            Subject::Machine(live) => live.plc(),
        }
    }

    /// Says why there is no further scan; what the view shows so far is right.
    pub fn say(&self, halt: &Halt) -> Outcome {
        match halt {
            Halt::Plc(error) => failure::print(self.plc().program(), error),
            Halt::Ended => return Outcome::Fine,
            Halt::Fault(what) => diagnostics::print_usage_error(what),
        }
        Outcome::ProgramError
    }

    /// Says what a script on the machine expected in vain.
    pub fn finish(&self) -> Outcome {
        match self {
            Subject::Bench(_) => Outcome::Fine,
            Subject::Machine(live) => live.finish(),
        }
    }
}

/// For the screen.
#[cfg(feature = "terminal")]
impl Subject {
    pub fn cycle_time(&self) -> Duration {
        match self {
            Subject::Bench(bench) => bench.cycle_time(),
            Subject::Machine(live) => live.cycle_time(),
        }
    }

    pub fn script(&self) -> &Script {
        match self {
            Subject::Bench(bench) => bench.play.script(),
            Subject::Machine(live) => live.script(),
        }
    }

    /// Whether a scan was begun line by line and is not over.
    pub fn is_inside(&self) -> bool {
        matches!(self, Subject::Bench(bench) if bench.is_inside())
    }

    /// Sets an operand for the next scan, on the bench at once.
    pub fn set(&mut self, operand: Operand, content: &Content) -> Result<(), String> {
        let bench = match self {
            Subject::Bench(bench) => bench,
            Subject::Machine(live) => return live.set(operand, content),
        };
        operand.write(&mut bench.exchange, content);
        let image = bench.exchange.plc_mut();
        match (operand, content) {
            (Operand::Bit(bit), Content::Number(value)) => image.set_bit(bit, *value != 0),
            (Operand::Number(number), Content::Number(value)) => image.set_number(number, *value),
            _ => {}
        }
        Ok(())
    }

    /// The expectations that did not hold since the last call.
    pub fn take_failures(&mut self) -> Vec<String> {
        match self {
            Subject::Bench(bench) => bench.take_failures().iter().map(ToString::to_string).collect(),
            Subject::Machine(live) => live.take_failures(),
        }
    }

    /// The bench, where a scan can be executed line by line.
    pub fn bench(&mut self) -> Option<&mut Bench> {
        match self {
            Subject::Bench(bench) => Some(bench),
            Subject::Machine(_) => None,
        }
    }

    /// What the machine does besides; empty on the bench.
    pub fn state(&self) -> String {
        match self {
            Subject::Bench(_) => String::new(),
            Subject::Machine(live) => live.state(),
        }
    }
}
