//! What is looked at: a PLC program on its bench, or in the control of a machine.

use std::time::Duration;

use bahn_host::{Content, Operand, Script};
use bahn_plc::{Machine, Tracer};

use super::bench::Bench;
use super::halt::Halt;
use super::live::Live;

/// A PLC program that runs.
pub enum Subject {
    /// Alone, on a bench in place of the control.
    Bench(Box<Bench>),
    /// In the control of a machine.
    Machine(Box<Live>),
}

impl Subject {
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

    /// The content of an operand.
    pub fn read(&self, operand: Operand) -> Content {
        match self {
            Subject::Bench(bench) => bench.read(operand),
            Subject::Machine(live) => live.read(operand),
        }
    }

    /// The program that runs.
    pub fn plc(&self) -> &Machine {
        match self {
            Subject::Bench(bench) => &bench.machine,
            Subject::Machine(live) => live.plc(),
        }
    }

    /// From the start of a scan to the start of the next one.
    pub fn cycle_time(&self) -> Duration {
        match self {
            Subject::Bench(bench) => bench.cycle_time(),
            Subject::Machine(live) => live.cycle_time(),
        }
    }

    /// What happens at which time.
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
