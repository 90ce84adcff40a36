//! Opens what is looked at, a PLC program on its bench or in the control of a machine, and says how it ended.

use bahn_exchange::Exchange;
use bahn_report::plc::{Halt, Subject, failure};

use super::live;
use super::options::{BenchOptions, MachineOptions, ProgramOptions};
use super::source::Source;
use crate::{Outcome, UsageError, diagnostics};

/// The program of a main file on the bench, or the machine of a folder; `None` when it is faulty: that was said.
pub(super) fn open(
    program: &ProgramOptions,
    bench: &BenchOptions,
    machine: &MachineOptions,
    exchange: impl FnOnce() -> Result<Exchange, UsageError>,
) -> Result<Option<Subject>, UsageError> {
    if live::is_machine(&program.file) {
        let live = live::live(program, bench, machine)?;
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
    let bench = super::bench::bench(program, parameters, bench, exchange()?)?;
    Ok(Some(Subject::Bench(Box::new(bench))))
}

/// Says why there is no further scan; what the view shows so far is right.
pub(super) fn say(subject: &Subject, halt: &Halt) -> Outcome {
    match halt {
        Halt::Plc(error) => diagnostics::print_fault(&failure(subject.plc().program(), error)),
        Halt::Ended => return Outcome::Fine,
        Halt::Fault(what) => diagnostics::print_usage_error(what),
    }
    Outcome::ProgramError
}

/// Says what a script on the machine expected in vain.
pub(super) fn finish(subject: &Subject) -> Outcome {
    let failures = match subject {
        Subject::Bench(_) => return Outcome::Fine,
        Subject::Machine(live) => live.failures(),
    };
    diagnostics::print_faults(&failures);
    match failures.is_empty() {
        true => Outcome::Fine,
        false => Outcome::ProgramError,
    }
}
