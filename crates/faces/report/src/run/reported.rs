//! What is told of a run that has ended.

use bahn_parameters::ControlModel;
use bahn_path::Position;
use bahn_tnc::Message;

use super::report::{ChannelReport, ProgramReport, RunReport};
use super::session::{Ended, Session};
use crate::record::{End, ErrorReport, Place, Record};

/// What is told of a run.
pub struct Reported {
    /// What is told as JSON or text.
    pub report: RunReport,
    /// What broke it off.
    pub failure: Option<Box<ErrorReport>>,
    /// The channel, from 0, that broke it off.
    pub failed_in: usize,
}

impl Reported {
    /// Of a session that has `ended` on a machine of this name. `has_program` says that the first channel had one, and
    /// `removed_mm3` what was removed of its part.
    pub fn of(
        session: &mut Session,
        ended: &Ended,
        machine: &str,
        has_program: bool,
        removed_mm3: Option<f64>,
    ) -> Reported {
        let model = session.host.control().model();
        let failed_in = failed_channel(ended);
        let (end, failure) = end_of_first(session, ended);
        let program = program(session, end, ended, failure.as_deref(), has_program, removed_mm3);
        let mut report = RunReport::new(session, program, machine, model);
        report.channels = channels(session, failure.as_deref(), failed_in, model);
        if let Ended::Hangs(what, _) = ended {
            report.waits_for = Some(what.clone());
        }
        Reported {
            report,
            failure,
            failed_in,
        }
    }

    /// The result in words.
    pub fn result(&self) -> &str {
        let message = self.failure.as_ref().map(|error| error.message.as_str());
        message.unwrap_or("completed")
    }
}

/// What became of the program of the first channel.
fn program(
    session: &mut Session,
    end: End,
    ended: &Ended,
    failure: Option<&ErrorReport>,
    has_program: bool,
    removed_mm3: Option<f64>,
) -> ProgramReport {
    let record = &mut session.executed.record;
    let mut record = std::mem::replace(record, Record::new(Position::UNKNOWN));
    record.machining_time_s = session.measured.program_us as f64 * 1e-6;
    let control = session.host.control();
    match control.reader().filter(|_| has_program) {
        Some(run) => ProgramReport::Ran(Box::new(record.report(run, end, removed_mm3, control.model()))),
        None => ProgramReport::Bare {
            completed: *ended == Ended::Completed,
            error: failure.cloned(),
        },
    }
}

/// The channels beside the first one.
fn channels(
    session: &mut Session,
    failure: Option<&ErrorReport>,
    failed_in: usize,
    model: ControlModel,
) -> Vec<ChannelReport> {
    let (beside, host) = (&mut session.beside, &session.host);
    let of = |channel: &mut super::beside::Beside| {
        let error = failure.filter(|_| channel.channel == failed_in).cloned();
        ChannelReport::of(channel, host, error, model)
    };
    beside.iter_mut().filter_map(of).collect()
}

/// How the run of the first channel ended, and what broke the run of all off.
fn end_of_first(session: &Session, ended: &Ended) -> (End, Option<Box<ErrorReport>>) {
    let failure = match ended {
        Ended::Completed | Ended::Interrupted => None,
        Ended::Stopped
        | Ended::TooLong
        | Ended::Broken(_)
        | Ended::Hangs(..)
        | Ended::NotStored(_)
        | Ended::Failed(_)
        | Ended::Restart(_) => Some(Box::new(error(session, ended))),
    };
    // What another channel ended is no fault of the first one.
    let end = match &failure {
        Some(failure) if failed_channel(ended) == 0 => End::Failed(failure.clone()),
        Some(_) if !session.host.control().has_ended() => End::Interrupted,
        None if *ended == Ended::Interrupted => End::Interrupted,
        Some(_) | None => End::Completed,
    };
    (end, failure)
}

/// The channel, from 0, whose message broke the run off.
fn failed_channel(ended: &Ended) -> usize {
    match ended {
        Ended::Broken(Some(shown)) | Ended::Hangs(_, Some(shown)) => shown.channel.unwrap_or(0),
        _ => 0,
    }
}

/// What broke the run off.
fn error(session: &Session, ended: &Ended) -> ErrorReport {
    let channel = session.host.control().channel(failed_channel(ended));
    let run = channel.and_then(|channel| channel.reader());
    let mut at = session.block().unwrap_or_default();
    let shown = match ended {
        Ended::Broken(shown) | Ended::Hangs(_, shown) => shown.as_deref(),
        _ => None,
    };
    if let Some(block) = shown.and_then(|shown| shown.block) {
        at = block;
    }
    let (message, detail) = match ended {
        Ended::Broken(Some(shown)) => {
            let text = session.host.control().shown_text(shown);
            match &shown.message {
                Message::Program(error) => (text, error.detail.clone()),
                other => (text, other.place().unwrap_or_default()),
            }
        }
        Ended::Stopped => (
            "the script ended the run before it was complete".to_owned(),
            String::new(),
        ),
        Ended::Hangs(what, Some(shown)) => (session.host.control().shown_text(shown), what.clone()),
        Ended::TooLong => (
            "the time allowed is over".to_owned(),
            "--max-time allows more".to_owned(),
        ),
        Ended::Hangs(what, None) => ("nothing moves any more".to_owned(), what.clone()),
        Ended::Restart(list) => (
            "the control restarts with other machine parameters".to_owned(),
            format!("module 9033 has selected {list}; the next run begins with it"),
        ),
        Ended::NotStored(what) => (
            "what survives power-off cannot be stored".to_owned(),
            what.clone(),
        ),
        Ended::Failed(what) => ("the run was broken off".to_owned(), what.clone()),
        _ => ("the run was broken off".to_owned(), String::new()),
    };
    let place = run.map(|run| Place::of(run, at));
    let remedy = shown.and_then(|shown| match &shown.message {
        Message::Program(error) => match &error.message {
            bahn_interpreter::Message::Control(id) => Some(id.remedy()),
            bahn_interpreter::Message::Numbered(_) => None,
        },
        Message::Plain(id) | Message::Axis { id, .. } => Some(id.remedy()),
        _ => None,
    });
    ErrorReport {
        message,
        program: place
            .as_ref()
            .map(|place| place.program.clone())
            .unwrap_or_default(),
        block: place.as_ref().map_or(at.block, |place| place.block),
        line: place.map_or(0, |place| place.line),
        detail,
        at,
        remedy,
    }
}
