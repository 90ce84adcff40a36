//! `bahn plc run`: cycle by cycle, with stimuli and expectations.

use std::path::Path;

use bahn_exchange::Exchange;
use bahn_host::{Operand, Retained};
use bahn_report::junit;
use bahn_report::plc::{Bench, Record, Report, Scans, Stop, failure, last_cycle, operands};

use super::bench::bench;
use super::live;
use super::options::RunOptions;
use super::source::Source;
use crate::interrupt::Interrupt;
use crate::options::Format;
use crate::{Outcome, UsageError, console, diagnostics, files};

/// Runs a program and shows what came out.
pub(super) fn command(options: &RunOptions) -> Result<Outcome, UsageError> {
    refuse_machine(&options.program.file)?;
    files::keep_inputs(&options.inputs(), &options.written())?;
    let source = Source::compile(&options.program)?;
    let first_error = source.compilation.errors.first().map(|fault| Stop {
        number: fault.error.number(),
        file: fault.file.clone(),
        line: fault.span.line,
    });
    let parameters = source.parameters.clone();
    let Some(program) = source.program() else {
        if options.format == Format::Json {
            console::print_json(&Report::not_run(first_error))?;
        }
        return Ok(Outcome::ProgramError);
    };
    let retained = super::retained(options.retain.as_deref())?;
    let exchange = retained
        .as_ref()
        .map_or_else(Exchange::default, Retained::restore);
    let bench = bench(program, parameters, &options.bench, exchange)?;
    let record = options
        .record
        .as_deref()
        .map(|path| Record::create(path, recorded(options, &bench)))
        .transpose()?;

    let last = last_cycle(bench.play.script(), bench.cycle_time());
    if let Some(cycles) = options.cycles.filter(|cycles| *cycles < last) {
        diagnostics::print_line(&format!(
            "warning: the script goes on to cycle {last}, the run ends with cycle {cycles}"
        ));
    }
    let mut scans = Scans::new(bench, record, retained);
    let interrupt = Interrupt::on_ctrl_c();
    let is_traced = |cycle| options.trace.is_some_and(|range| range.contains(cycle));
    let ran = scans.run(options.cycles, &is_traced, &|| interrupt.is_requested());
    let mut written = ran.map_err(UsageError::from);
    if let Some(error) = scans.error() {
        diagnostics::print_fault(&failure(scans.bench.machine.program(), error));
    }
    diagnostics::print_faults(&scans.failures());
    let fine = scans.error().is_none() && scans.bench.play.failed.is_empty();
    let expectations = scans.bench.play.expectations();
    let report = scans.into_report(&options.show, options.trace.is_some());
    if let Some(path) = &options.junit {
        let suite = options.program.file.to_string_lossy();
        let cases = junit::write(path, &suite, &expectations, report.stopped().as_deref());
        written = written.and(cases.map_err(UsageError::from));
    }
    match options.format {
        Format::Json => console::print_json(&report)?,
        Format::Text => console::print(&report.text())?,
    }
    written.map(|()| match fine {
        true if interrupt.is_requested() => Outcome::Interrupted,
        true => Outcome::Fine,
        false => Outcome::ProgramError,
    })
}

/// The folder of a machine is no program.
fn refuse_machine(path: &Path) -> Result<(), UsageError> {
    if !live::is_machine(path) {
        return Ok(());
    }
    Err(UsageError::new(format!(
        "{} is a folder: `bahn run --machine` runs a machine, `bahn plc trace`, `diagram` and `watch` look at its PLC",
        path.display()
    )))
}

/// The columns of `--record`.
fn recorded(options: &RunOptions, bench: &Bench) -> Vec<Operand> {
    if options.show.is_empty() {
        operands(bench.play.script())
    } else {
        options.show.clone()
    }
}
