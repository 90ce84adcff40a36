//! The report of a run on the machine: that of a test run, and what only a machine can tell.

use std::collections::BTreeMap;

use bahn_host::{FailedExpectation, Host, Lateness, Threads};
use bahn_parameters::ControlModel;
use bahn_path::Axis;
use bahn_tnc::{ChannelView, TestReport, TestState};
use serde::Serialize;

use super::beside::Beside;
use super::deviation::Deviation;
use super::listed::{Confirmed, Said};
use super::module::{ModuleReport, ModuleRun};
use super::session::Session;
use super::threads::Thread;
use super::times::Share;
use crate::record::{End, ErrorReport, Report, tidy};
use crate::text::{self, LABEL, list};

/// What an axis did, mm or degrees.
#[derive(Clone, Debug, Serialize)]
struct AxisReport {
    max_lag: f64,
    lag_block: Option<u32>,
    max_deviation: Option<f64>,
    deviation_block: Option<u32>,
}

impl AxisReport {
    fn text(&self, letter: char) -> String {
        let axis = u8::try_from(letter).ok().and_then(Axis::from_letter);
        let unit = if axis.is_some_and(Axis::is_rotary) {
            "°"
        } else {
            "mm"
        };
        let deviation = self.max_deviation.map(|deviation| {
            let block = at(self.deviation_block);
            format!(", off the contour {:.1} µm{block}", deviation * 1e3)
        });
        let (lag, block) = (self.max_lag, at(self.lag_block));
        format!("{letter} {lag:.4} {unit}{block}{}", deviation.unwrap_or_default())
    }
}

#[derive(Clone, Debug, Serialize)]
struct PlcReport {
    /// Nominal processing time: 100 % are 5 ms.
    max_percent: f64,
    mean_percent: f64,
}

/// What a TEST RUN beside the machine came to.
#[derive(Clone, Debug, Serialize)]
struct TestRunReport {
    program: String,
    completed: bool,
    message: Option<String>,
    place: Option<String>,
}

impl TestRunReport {
    fn of(session: &Session, report: TestReport) -> TestRunReport {
        let message = match &report.state {
            TestState::Failed(message) => Some(message),
            TestState::Running | TestState::Interrupted | TestState::Finished => None,
        };
        TestRunReport {
            program: report.program,
            completed: report.state == TestState::Finished,
            message: message.map(|message| session.host.control().message_text(message)),
            place: message.and_then(|message| message.place()),
        }
    }
}

impl TestRunReport {
    fn text(&self) -> String {
        let result = match (&self.message, self.completed) {
            (Some(message), _) => message,
            (None, true) => "completed",
            (None, false) => "not completed",
        };
        let place = self.place.as_ref().map(|place| format!(": {place}"));
        format!("{}: {result}{}", self.program, place.unwrap_or_default())
    }
}

/// What became of the program.
#[derive(Clone, Debug, Serialize)]
#[serde(untagged)]
pub enum ProgramReport {
    /// It ran, to its end or not.
    Ran(Box<Report>),
    /// There was none, or its run did not begin.
    Bare {
        completed: bool,
        error: Option<ErrorReport>,
    },
}

/// The report as JSON has it.
#[derive(Clone, Debug, Serialize)]
pub struct RunReport {
    #[serde(flatten)]
    pub(super) program: ProgramReport,
    machine: String,
    model: &'static str,
    power_up_s: f64,
    reference_s: f64,
    times: Vec<Share>,
    axes: BTreeMap<char, AxisReport>,
    contour_deviation_mm: f64,
    /// Why it arose, in words.
    contour_deviation_cause: Option<String>,
    contour_deviation_block: Option<u32>,
    threads: Vec<Thread>,
    threads_not_listed: u64,
    plc: PlcReport,
    messages: Vec<Said>,
    confirmed: Vec<Confirmed>,
    pub(super) waits_for: Option<String>,
    /// The channels beside the first one.
    #[serde(skip_serializing_if = "Vec::is_empty")]
    pub(super) channels: Vec<ChannelReport>,
    failed_expectations: Vec<FailedExpectation>,
    test_run: Option<TestRunReport>,
    /// The positioning module beside the machine.
    #[serde(skip_serializing_if = "Option::is_none")]
    module: Option<ModuleReport>,
    realtime: Option<Lateness>,
}

impl RunReport {
    pub(super) fn new(
        session: &Session,
        program: ProgramReport,
        machine: &str,
        model: ControlModel,
    ) -> RunReport {
        let seconds = |us: u64| us as f64 * 1e-6;
        let plc = session.measured.plc;
        let cause = session.measured.deviation.cause;
        let first = session.host.control().first();
        RunReport {
            machine: machine.to_owned(),
            model: model.id(),
            power_up_s: seconds(session.measured.power_up_us),
            reference_s: seconds(session.measured.reference_us),
            times: session.measured.times.shares(),
            axes: axes(&session.measured.deviation, first),
            contour_deviation_mm: tidy(session.measured.deviation.max_mm),
            contour_deviation_cause: cause.map(|(cause, _)| cause.to_string()),
            contour_deviation_block: cause
                .and_then(|(_, block)| block)
                .map(|block| first.number_of(block)),
            threads: named(&session.measured.threads, first),
            threads_not_listed: session.measured.threads.not_listed,
            plc: PlcReport {
                max_percent: tidy(plc.longest()),
                mean_percent: tidy(plc.mean()),
            },
            messages: session.listed.messages.clone(),
            confirmed: session.listed.confirmed.clone(),
            waits_for: None,
            channels: Vec::new(),
            failed_expectations: session.play.failed.clone(),
            test_run: session
                .host
                .control()
                .test_report()
                .map(|report| TestRunReport::of(session, report)),
            module: session.module.as_ref().map(ModuleRun::report),
            realtime: session.host.lateness(),
            program,
        }
    }

    /// The report for people.
    pub fn text(&self, model: ControlModel, result: &str, written: &[String]) -> String {
        let mut text = String::new();
        let mut row = |label: &str, value: &str| {
            text += &format!("{label:<LABEL$}{}\n", bahn_text::printable(value));
        };
        row(
            "Machine",
            &format!("{}, {}", self.machine, model.to_string().to_uppercase()),
        );
        match &self.program {
            ProgramReport::Ran(report) => text::head(&mut row, report, &model.to_string().to_uppercase()),
            ProgramReport::Bare { .. } => row("Result", result),
        }
        row(
            "Before",
            &format!(
                "power-up {:.1} s, reference run {:.1} s",
                self.power_up_s, self.reference_s
            ),
        );
        list(&mut row, "Time for", &self.times, |share| {
            let times = if share.count == 1 { "time" } else { "times" };
            format!(
                "{:<16}{:>9.1} s  {} {times}",
                share.what, share.time_s, share.count
            )
        });
        let axes: Vec<_> = self.axes.iter().collect();
        list(&mut row, "Largest lag", &axes, |(letter, axis)| {
            axis.text(**letter)
        });
        if let Some(cause) = &self.contour_deviation_cause {
            row(
                "Off the contour",
                &format!(
                    "{:.1} µm{}: {cause}",
                    self.contour_deviation_mm * 1e3,
                    at(self.contour_deviation_block)
                ),
            );
        }
        threads(&mut row, &self.threads, self.threads_not_listed);
        row(
            "PLC",
            &format!(
                "{:.1} % of the nominal time, longest scan {:.1} %",
                self.plc.mean_percent, self.plc.max_percent
            ),
        );
        list(&mut row, "Messages", &self.messages, Said::text);
        list(&mut row, "Confirmed", &self.confirmed, Confirmed::text);
        if let ProgramReport::Ran(report) = &self.program {
            text::body(&mut row, report);
        }
        for channel in &self.channels {
            channel.text(&mut row);
        }
        self.module.iter().for_each(|module| module.text(&mut row));
        if let Some(test) = &self.test_run {
            row("Test run", &test.text());
        }
        if let Some(lateness) = &self.realtime {
            row(
                "Real time",
                &format!(
                    "{} cycles, {} late, the worst by {:.3} ms; the longest took {:.3} ms of the processor, {} more than \
                     their time",
                    lateness.cycles,
                    lateness.late_cycles,
                    lateness.worst_lateness_ms,
                    lateness.longest_ms,
                    lateness.overrun_cycles
                ),
            );
            list(&mut row, "Late by", &late_by(lateness), Clone::clone);
        }
        list(&mut row, "Written", written, Clone::clone);
        text
    }
}

/// How many cycles were how late.
fn late_by(lateness: &Lateness) -> Vec<String> {
    let counted = lateness.late_by.iter().filter(|late| late.cycles > 0);
    let words = counted.map(|late| match late.at_most_ms {
        Some(most) => format!("up to {most} ms: {} cycles", late.cycles),
        None => format!("more: {} cycles", late.cycles),
    });
    words.collect()
}

/// A channel beside the first one.
#[derive(Clone, Debug, Serialize)]
pub struct ChannelReport {
    /// Its number, from 1.
    channel: usize,
    #[serde(flatten)]
    program: ProgramReport,
    axes: BTreeMap<char, AxisReport>,
    contour_deviation_mm: f64,
    contour_deviation_cause: Option<String>,
    contour_deviation_block: Option<u32>,
    threads: Vec<Thread>,
    threads_not_listed: u64,
}

impl ChannelReport {
    /// What became of the program of a channel; `None` when there was none. `error` is what has ended the whole run,
    /// when it came from this channel.
    pub(super) fn of(
        beside: &mut Beside,
        host: &Host,
        error: Option<ErrorReport>,
        model: ControlModel,
    ) -> Option<ChannelReport> {
        let channel = host.control().channel(beside.channel)?;
        let run = channel.reader()?;
        let end = match error {
            Some(error) => End::Failed(Box::new(error)),
            None if channel.has_ended() => End::Completed,
            None => End::Interrupted,
        };
        let program = beside.take_record().report(run, end, None, model);
        let deviation = &beside.deviation;
        let cause = deviation.cause;
        Some(ChannelReport {
            channel: beside.channel + 1,
            program: ProgramReport::Ran(Box::new(program)),
            axes: axes(deviation, channel),
            contour_deviation_mm: tidy(deviation.max_mm),
            contour_deviation_cause: cause.map(|(cause, _)| cause.to_string()),
            contour_deviation_block: cause
                .and_then(|(_, block)| block)
                .map(|block| channel.number_of(block)),
            threads: named(&beside.threads, channel),
            threads_not_listed: beside.threads.not_listed,
        })
    }

    fn text(&self, row: &mut impl FnMut(&str, &str)) {
        let ProgramReport::Ran(report) = &self.program else {
            return;
        };
        row(&format!("Channel {}", self.channel), &text::in_a_line(report));
        row("", &format!("at the end {}", report.final_position));
        if let Some(cause) = &self.contour_deviation_cause {
            let (microns, block) = (self.contour_deviation_mm * 1e3, at(self.contour_deviation_block));
            row("", &format!("off the contour {microns:.1} µm{block}: {cause}"));
        }
        threads(row, &self.threads, self.threads_not_listed);
        for warning in &report.warnings {
            row("", &format!("block {}: {}", warning.block, warning.message));
        }
    }
}

fn named(threads: &Threads, channel: ChannelView) -> Vec<Thread> {
    let done = threads.done.iter();
    done.map(|cut| Thread::of(cut, channel)).collect()
}

/// The threads of a channel.
fn threads(row: &mut impl FnMut(&str, &str), threads: &[Thread], not_listed: u64) {
    list(row, "Threads", threads, Thread::text);
    if not_listed > 0 {
        row("", &format!("{not_listed} more threads are not listed"));
    }
}

/// What the axes of a channel did.
fn axes(deviation: &Deviation, channel: ChannelView) -> BTreeMap<char, AxisReport> {
    let axes = deviation.axes.iter().map(|axis| {
        let linear = axis.is_linear();
        let deviation_block = axis.deviation_block.filter(|_| linear);
        let report = AxisReport {
            max_lag: tidy(axis.max_lag),
            lag_block: axis.lag_block.map(|block| channel.number_of(block)),
            max_deviation: linear.then(|| tidy(axis.max_deviation)),
            deviation_block: deviation_block.map(|block| channel.number_of(block)),
        };
        (axis.letter, report)
    });
    axes.collect()
}

fn at(block: Option<u32>) -> String {
    block.map_or(String::new(), |block| format!(" in block {block}"))
}
