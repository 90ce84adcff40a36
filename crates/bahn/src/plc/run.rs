//! `bahn plc run`: cycle by cycle, with stimuli and expectations.

use std::path::Path;

use bahn_exchange::Exchange;
use bahn_host::Retained;
use bahn_plc::ProcessingTime;
use bahn_report::junit;
use serde::ser::{Serialize, SerializeMap, Serializer};

use super::bench::{self, Bench, Failure};
use super::failure;
use super::live;
use super::options::RunOptions;
use super::record::Record;
use super::source::Source;
use super::trace::{Line, Trace};
use crate::diagnostics::{self, PRINTED_MAX};
use crate::interrupt::Interrupt;
use crate::options::Format;
use crate::{Outcome, UsageError, console, files};
use bahn_host::{Content, Operand};

/// So many cycles a script waits for a condition behind the last thing that it did: a minute of 20 ms.
const CYCLES_IN_VAIN: u64 = 3000;

/// Runs a program and shows what came out.
pub(super) fn command(options: &RunOptions) -> Result<Outcome, UsageError> {
    refuse_machine(&options.program.file)?;
    files::keep_inputs(&options.inputs(), &options.written())?;
    let source = Source::compile(&options.program)?;
    let first_error = source.compilation.errors.first().map(|fault| Stop {
        number: fault.error.number(),
        file: fault.file.clone(),
        line: fault.line,
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
    let bench = Bench::new(program, parameters, &options.bench, exchange)?;
    let record = options
        .record
        .as_deref()
        .map(|path| Record::create(path, recorded(options, &bench)))
        .transpose()?;

    let last = bench::last_cycle(bench.play.script(), bench.cycle_time());
    if let Some(cycles) = options.cycles.filter(|cycles| *cycles < last) {
        diagnostics::print_line(&format!(
            "warning: the script goes on to cycle {last}, the run ends with cycle {cycles}"
        ));
    }
    let mut scans = Scans {
        bench,
        record,
        retained,
        report: Report::not_run(None),
        trace: Trace::default(),
    };
    let interrupt = Interrupt::on_ctrl_c();
    let mut written = scans.run(options, &interrupt);
    scans.print_failures();
    let Scans {
        bench,
        mut report,
        trace,
        ..
    } = scans;
    if let Some(path) = &options.junit {
        let stopped = report.error.as_ref().map(Stop::to_string);
        let suite = options.program.file.to_string_lossy();
        let cases = junit::write(path, &suite, &bench.play.expectations(), stopped.as_deref());
        written = written.and(cases.map_err(UsageError::from));
    }
    report.values = Values(
        options
            .show
            .iter()
            .map(|operand| (*operand, bench.read(*operand)))
            .collect(),
    );
    report.processing_percent = bench.machine.time().into();
    let fine = report.error.is_none() && bench.play.failed.is_empty();
    match options.format {
        Format::Json => {
            report.trace_left_off = options.trace.map(|_| trace.left_off);
            report.trace = options.trace.map(|_| trace.lines);
            console::print_json(&report)?;
        }
        Format::Text => console::print(&(trace.text() + &report.text()))?,
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

/// The cycles of a run, and what is written meanwhile.
struct Scans {
    bench: Bench,
    record: Option<Record>,
    retained: Option<Retained>,
    report: Report,
    trace: Trace,
}

impl Scans {
    /// Runs up to the last cycle, or to the first error.
    ///
    /// # Errors
    /// When a file cannot be written. It loses neither the others nor the report.
    fn run(&mut self, options: &RunOptions, interrupt: &Interrupt) -> Result<(), UsageError> {
        let mut written = Ok(());
        while !self.is_over(options) && !interrupt.is_requested() && written.is_ok() {
            self.trace.cycle = self.bench.cycle + 1;
            let traced = options
                .trace
                .is_some_and(|range| range.contains(self.trace.cycle));
            if let Err(error) = self.bench.scan(traced.then_some(&mut self.trace)) {
                failure::print(self.bench.machine.program(), &error);
                self.report.error = Some(Stop {
                    number: error.error.number(),
                    file: error.file,
                    line: error.line,
                });
                break;
            }
            self.report.cycles += 1;
            written = self
                .record
                .as_mut()
                .map_or(Ok(()), |record| record.cycle(&self.bench));
            if let Some(retained) = &mut self.retained {
                let kept = retained.tick(self.bench.exchange.plc());
                written = written.and(kept.map_err(UsageError::from));
            }
        }
        self.bench.finish();
        self.report.failed_expectations = self.bench.take_failures();
        if let Some(retained) = &mut self.retained {
            let kept = retained.flush(self.bench.exchange.plc());
            written = written.and(kept.map_err(UsageError::from));
        }
        written.and(self.record.take().map_or(Ok(()), Record::finish))
    }

    /// The last cycle has run: that of `--cycles`, or the last one of the script.
    fn is_over(&mut self, options: &RunOptions) -> bool {
        if options.cycles.is_some_and(|cycles| self.bench.cycle >= cycles) {
            return true;
        }
        self.bench.stimulate();
        match options.cycles {
            Some(_) => self.bench.has_ended(),
            None => self.bench.is_over() || self.bench.waits_in_vain(CYCLES_IN_VAIN),
        }
    }

    /// Prints the expectations that did not hold, with their lines of the script.
    fn print_failures(&self) {
        let failures = &self.report.failed_expectations;
        for failure in failures.iter().take(PRINTED_MAX) {
            let title = failure.to_string();
            let found = format!("found {}", failure.found);
            let script = self.bench.play.script();
            let fault = script.failure_of(failure.line, &failure.operand, &title, found);
            diagnostics::print_fault(&fault);
        }
        diagnostics::print_rest(failures.len().saturating_sub(PRINTED_MAX));
    }
}

/// The columns of `--record`.
fn recorded(options: &RunOptions, bench: &Bench) -> Vec<Operand> {
    if options.show.is_empty() {
        bench::operands(bench.play.script())
    } else {
        options.show.clone()
    }
}

#[derive(Debug, serde::Serialize)]
struct Report {
    /// Cycles that ran to their end.
    cycles: u64,
    values: Values,
    processing_percent: Percent,
    error: Option<Stop>,
    #[serde(skip_serializing_if = "Vec::is_empty")]
    failed_expectations: Vec<Failure>,
    #[serde(skip_serializing_if = "Option::is_none")]
    trace: Option<Vec<Line>>,
    #[serde(skip_serializing_if = "Option::is_none")]
    trace_left_off: Option<u64>,
}

#[derive(Debug, serde::Serialize)]
struct Stop {
    number: u8,
    file: String,
    line: u32,
}

impl std::fmt::Display for Stop {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        write!(f, "{}:{}: PLC error {}", self.file, self.line, self.number)
    }
}

#[derive(Debug, Default, serde::Serialize)]
struct Percent {
    current: f64,
    maximum: f64,
}

impl From<ProcessingTime> for Percent {
    fn from(time: ProcessingTime) -> Percent {
        Percent {
            current: time.current_percent(),
            maximum: time.maximum_percent(),
        }
    }
}

/// Operands in the order of `--show`.
#[derive(Debug, Default)]
struct Values(Vec<(Operand, Content)>);

impl Serialize for Values {
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        let mut map = serializer.serialize_map(Some(self.0.len()))?;
        for (operand, content) in &self.0 {
            map.serialize_entry(&operand.to_string(), content)?;
        }
        map.end()
    }
}

impl Report {
    fn not_run(error: Option<Stop>) -> Report {
        Report {
            cycles: 0,
            values: Values::default(),
            processing_percent: Percent::default(),
            error,
            failed_expectations: Vec::new(),
            trace: None,
            trace_left_off: None,
        }
    }

    fn text(&self) -> String {
        let mut text: String = self
            .values
            .0
            .iter()
            .map(|(operand, content)| format!("{operand} = {content}\n"))
            .collect();
        let plural = if self.cycles == 1 { "" } else { "s" };
        text += &format!(
            "{} cycle{plural}, processing time {:.2} %, maximum {:.2} %\n",
            self.cycles, self.processing_percent.current, self.processing_percent.maximum
        );
        text
    }
}
