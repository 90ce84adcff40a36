//! A PLC program on the bench, cycle by cycle, with stimuli and expectations.

use bahn_host::{Content, Operand, Retained};
use bahn_plc::{ProcessingTime, RuntimeError};
use bahn_text::Diagnostic;
use serde::ser::{Serialize, SerializeMap, Serializer};

use super::bench::{Bench, Failure};
use super::record::Record;
use super::trace::{Line, Trace};
use crate::ReportError;
use crate::count;

/// So many cycles a script waits for a condition after the last thing that it did: a minute of 20 ms.
const CYCLES_IN_VAIN: u64 = 3000;

/// The cycles of a run, and what is written meanwhile.
pub struct Scans {
    /// The program, with what it runs on.
    pub bench: Bench,
    record: Option<Record>,
    retained: Option<Retained>,
    report: Report,
    trace: Trace,
    error: Option<RuntimeError>,
}

impl Scans {
    /// A program on its bench, with the table of its operands and what survives power-off.
    pub fn new(bench: Bench, record: Option<Record>, retained: Option<Retained>) -> Scans {
        Scans {
            bench,
            record,
            retained,
            report: Report::not_run(None),
            trace: Trace::default(),
            error: None,
        }
    }

    /// Runs up to the last of so many cycles, without a number to the end of the script, or to the first error.
    ///
    /// # Errors
    /// When a file cannot be written. It loses neither the others nor the report.
    pub fn run(
        &mut self,
        cycles: Option<u64>,
        is_traced: &dyn Fn(u64) -> bool,
        is_interrupted: &dyn Fn() -> bool,
    ) -> Result<(), ReportError> {
        let mut written = Ok(());
        while !self.is_over(cycles) && !is_interrupted() && written.is_ok() {
            self.trace.cycle = self.bench.cycle + 1;
            let traced = is_traced(self.trace.cycle);
            if let Err(error) = self.bench.scan(traced.then_some(&mut self.trace)) {
                self.report.error = Some(Stop {
                    number: error.error.number(),
                    file: error.file.clone(),
                    line: error.line,
                });
                self.error = Some(error);
                break;
            }
            self.report.cycles += 1;
            written = self
                .record
                .as_mut()
                .map_or(Ok(()), |record| record.cycle(&self.bench));
            if let Some(retained) = &mut self.retained {
                let kept = retained.tick(self.bench.exchange.plc());
                written = written.and(kept.map_err(ReportError::from));
            }
        }
        self.bench.finish();
        self.report.failed_expectations = self.bench.take_failures();
        if let Some(retained) = &mut self.retained {
            let kept = retained.flush(self.bench.exchange.plc());
            written = written.and(kept.map_err(ReportError::from));
        }
        written.and(self.record.take().map_or(Ok(()), Record::finish))
    }

    /// The last cycle has run: the one that was named, or the last one of the script.
    fn is_over(&mut self, cycles: Option<u64>) -> bool {
        if cycles.is_some_and(|cycles| self.bench.cycle >= cycles) {
            return true;
        }
        self.bench.stimulate();
        match cycles {
            Some(_) => self.bench.has_ended(),
            None => self.bench.is_over() || self.bench.waits_in_vain(CYCLES_IN_VAIN),
        }
    }

    /// What has stopped the PLC.
    pub fn error(&self) -> Option<&RuntimeError> {
        self.error.as_ref()
    }

    /// The expectations that did not hold, with their lines of the script.
    pub fn failures(&self) -> Vec<Diagnostic> {
        let script = self.bench.play.script();
        let fault = |failure: &Failure| {
            let found = format!("found {}", failure.found);
            script.failure_of(failure.line, &failure.operand, &failure.to_string(), found)
        };
        self.report.failed_expectations.iter().map(fault).collect()
    }

    /// The report, with the values of operands; `traced` says that executed lines belong to it.
    pub fn into_report(self, shown: &[Operand], traced: bool) -> Report {
        let values = shown.iter().map(|operand| (*operand, self.bench.read(*operand)));
        Report {
            values: Values(values.collect()),
            processing_percent: self.bench.machine.time().into(),
            trace_text: self.trace.text(),
            trace_left_off: traced.then_some(self.trace.left_off),
            trace: traced.then_some(self.trace.lines),
            ..self.report
        }
    }
}

/// What came out of a run.
#[derive(Debug, serde::Serialize)]
pub struct Report {
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
    #[serde(skip)]
    trace_text: String,
}

/// What has stopped the PLC, or kept it from running.
#[derive(Debug, serde::Serialize)]
pub struct Stop {
    /// Number of the PLC error.
    pub number: u8,
    /// Source file in which it stopped.
    pub file: String,
    /// Its line, from 1.
    pub line: u32,
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
    /// What has stopped the PLC, in words.
    pub fn stopped(&self) -> Option<String> {
        self.error.as_ref().map(Stop::to_string)
    }

    /// Of a program that did not run; why.
    pub fn not_run(error: Option<Stop>) -> Report {
        Report {
            cycles: 0,
            values: Values::default(),
            processing_percent: Percent::default(),
            error,
            failed_expectations: Vec::new(),
            trace: None,
            trace_left_off: None,
            trace_text: String::new(),
        }
    }

    /// For people, with the executed lines.
    pub fn text(&self) -> String {
        let values: String = self
            .values
            .0
            .iter()
            .map(|(operand, content)| format!("{operand} = {content}\n"))
            .collect();
        let mut text = self.trace_text.clone() + &values;
        text += &format!(
            "{}, processing time {:.2} %, maximum {:.2} %\n",
            count(self.cycles, "cycle"),
            self.processing_percent.current,
            self.processing_percent.maximum
        );
        text
    }
}
