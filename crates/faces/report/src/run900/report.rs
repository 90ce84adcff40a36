//! What is told of a run that has ended.

use std::collections::BTreeMap;

use bahn_control900::Control900;
use bahn_host::{FailedExpectation, Lateness};
use bahn_parameters::ControlModel;
use bahn_path::{Axis, Position};
use bahn_system900::{AxisParameter, Memory, Name, slots};
use serde::Serialize;

use super::executed::Executed;
use super::listed::{Refused900, Said900, Sent900, sent};
use super::session::{Ended900, Session900};
use crate::record::{Axes, End, ErrorReport, Place, Report, tidy};
use crate::text::{self, LABEL, list};

/// What the control is called.
const MODEL: &str = "system900";
const NAME: &str = "SYSTEM 900";

/// What became of the program of a channel.
#[derive(Clone, Debug, Serialize)]
#[serde(untagged)]
enum Program {
    /// It ran, to its end or not.
    Ran(Box<Report>),
    /// There was none, or its run did not begin.
    Bare {
        completed: bool,
        error: Option<ErrorReport>,
    },
}

/// A channel beside the first one.
#[derive(Clone, Debug, Serialize)]
struct Channel {
    /// Its number, from 1.
    channel: u8,
    #[serde(flatten)]
    program: Program,
    m: Vec<Sent900>,
}

/// The report as JSON has it.
#[derive(Clone, Debug, Serialize)]
pub struct RunReport900 {
    #[serde(flatten)]
    program: Program,
    machine: String,
    model: &'static str,
    /// The interpolation cycle, s.
    cycle_s: f64,
    /// When the first program was started, s since power-on.
    start_s: Option<f64>,
    /// The parameters that were asked for, at the end; `None` when they are cleared.
    reads: BTreeMap<String, Option<f64>>,
    refused: Vec<Refused900>,
    m: Vec<Sent900>,
    messages: Vec<Said900>,
    /// When the operator went on with a program that waited for him, s.
    confirmed: Vec<f64>,
    waits_for: Option<String>,
    #[serde(skip_serializing_if = "Vec::is_empty")]
    channels: Vec<Channel>,
    failed_expectations: Vec<FailedExpectation>,
    realtime: Option<Lateness>,
    /// What broke the run off, and in which channel, from 1.
    #[serde(skip)]
    failure: Option<(u8, Box<ErrorReport>)>,
}

impl RunReport900 {
    /// Of a session that has ended on a machine of this name, with the parameters that are read at its end.
    pub fn of(session: &mut Session900, ended: &Ended900, machine: &str, reads: &[Name]) -> RunReport900 {
        let failure = failure(session, ended);
        let control = session.host.control();
        let value = |name: &Name| (name.to_string(), control.number(*name).ok().flatten());
        let reads = reads.iter().map(value).collect();
        let mut programs: Vec<Program> = Vec::new();
        let started = session.started.clone();
        for (executed, started) in session.executed.iter_mut().zip(started) {
            programs.push(program(
                session.host.control(),
                executed,
                started,
                ended,
                failure.as_ref(),
            ));
        }
        let control = session.host.control();
        let mut programs = programs.into_iter();
        let first = programs.next().unwrap_or(Program::Bare {
            completed: false,
            error: None,
        });
        let others = (2u8..)
            .zip(programs)
            .filter(|(_, program)| matches!(program, Program::Ran(_)));
        RunReport900 {
            program: first,
            machine: machine.to_owned(),
            model: MODEL,
            cycle_s: f64::from(control.cycle_us()) * 1e-6,
            start_s: session.start_us.map(|us| us as f64 * 1e-6),
            reads,
            refused: session.listed.refused.clone(),
            m: sent(control, 1),
            messages: session.listed.messages.clone(),
            confirmed: session.listed.confirmed.clone(),
            waits_for: match ended {
                Ended900::Hangs(what) => Some(what.clone()),
                _ => None,
            },
            channels: others
                .map(|(channel, program)| Channel {
                    channel,
                    program,
                    m: sent(control, channel),
                })
                .collect(),
            failed_expectations: session.play.failed.clone(),
            realtime: session.host.lateness(),
            failure,
        }
    }

    /// What broke the run off, and in which channel, from 1.
    pub fn failure(&self) -> Option<(u8, &ErrorReport)> {
        self.failure.as_ref().map(|(channel, error)| (*channel, &**error))
    }

    /// The report for people.
    pub fn text(&self, written: &[String]) -> String {
        let mut text = String::new();
        let mut row = |label: &str, value: &str| {
            text += &format!("{label:<LABEL$}{}\n", bahn_text::printable(value));
        };
        row("Machine", &format!("{}, {NAME}", self.machine));
        match &self.program {
            Program::Ran(report) => text::head(&mut row, report, NAME),
            Program::Bare { error, .. } => row(
                "Result",
                error.as_ref().map_or("completed", |error| error.message.as_str()),
            ),
        }
        if let Some(start_s) = self.start_s {
            row("Before", &format!("{start_s:.1} s until the first program began"));
        }
        list(&mut row, "Messages", &self.messages, Said900::text);
        list(&mut row, "Held back", &self.refused, Refused900::text);
        if !self.confirmed.is_empty() {
            row("Confirmed", &format!("{} programmed stops", self.confirmed.len()));
        }
        if let Program::Ran(report) = &self.program {
            text::body(&mut row, report);
        }
        for channel in &self.channels {
            if let Program::Ran(report) = &channel.program {
                row(&format!("Channel {}", channel.channel), &text::in_a_line(report));
                row("", &format!("at the end {}", report.final_position));
            }
        }
        let reads: Vec<_> = self.reads.iter().collect();
        list(&mut row, "Parameters", &reads, |(name, value)| {
            let value = value.map_or("--".to_owned(), |value| value.to_string());
            format!("{name} = {value}")
        });
        list(&mut row, "Written", written, Clone::clone);
        text
    }
}

/// What became of the program of a channel.
fn program(
    control: &Control900,
    executed: &mut Executed,
    started: bool,
    ended: &Ended900,
    failure: Option<&(u8, Box<ErrorReport>)>,
) -> Program {
    let channel = executed.channel;
    let own = failure
        .filter(|(of, _)| *of == channel)
        .map(|(_, error)| error.clone());
    let end = match own {
        Some(error) => End::Failed(error),
        None if control.run(channel).1 => End::Completed,
        None => End::Interrupted,
    };
    match control.reader(channel).filter(|_| started) {
        Some(run) => {
            let record = executed.take_record();
            let mut report = record.report(run, end, None, ControlModel::default());
            report.final_position = Axes(display(control, channel));
            Program::Ran(Box::new(report))
        }
        None => Program::Bare {
            completed: *ended == Ended900::Completed,
            error: failure.map(|(_, error)| (**error).clone()),
        },
    }
}

/// P12154 of the axes of a channel.
fn display(control: &Control900, channel: u8) -> Position {
    let memory = control.memory();
    let slots = slots(memory, channel);
    let mut position = Position::UNKNOWN;
    for (logical, _) in memory.axes_of(channel) {
        let slot: Option<Axis> = slots.get(usize::from(logical) - 1).copied().flatten();
        let place = Memory::own_place(channel, logical, AxisParameter::DisplayPosition);
        if let (Some(axis), Some(value)) = (slot, memory.at(place).number()) {
            position[axis] = tidy(value);
        }
    }
    position
}

/// What broke the run off.
fn failure(session: &Session900, ended: &Ended900) -> Option<(u8, Box<ErrorReport>)> {
    let open = session.first_open().unwrap_or(1);
    let (channel, message) = match ended {
        Ended900::Completed | Ended900::Interrupted => return None,
        Ended900::Stopped => (open, "the script ended the run".to_owned()),
        Ended900::TooLong => (open, "the run takes longer than --max-time".to_owned()),
        Ended900::Broken(message) => (message.channel, message.to_string()),
        Ended900::BrokenOff(channel) => (*channel, "the program was broken off".to_owned()),
        Ended900::Hangs(what) => (open, format!("nothing moves: {what}")),
        Ended900::Failed(what) => (open, what.clone()),
    };
    Some((channel, Box::new(error(session.host.control(), channel, message))))
}

fn error(control: &Control900, channel: u8, message: String) -> ErrorReport {
    let at = control.executed(channel).map(|(element, _)| element.block);
    let at = control.faulty_block(channel).or(at);
    let place = control
        .reader(channel)
        .zip(at)
        .map(|(run, at)| Place::of(run, at));
    let place = place.unwrap_or_default();
    ErrorReport {
        message,
        program: place.program,
        block: place.block,
        line: place.line,
        detail: String::new(),
        at: at.unwrap_or_default(),
        remedy: None,
    }
}
