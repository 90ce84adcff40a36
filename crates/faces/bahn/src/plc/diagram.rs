//! `bahn plc diagram`: operands over cycles, with trigger [000:11461-11480].

use std::io::Write;

use bahn_exchange::Exchange;
use bahn_report::plc::diagram::{Courses, svg, text};

use super::options::DiagramOptions;
use super::subject;
use crate::files::{self, NewFile};
use crate::options::Format;
use crate::{Outcome, UsageError, console, diagnostics};
use bahn_host::logic_diagram::{DiagramRecorder, OPERANDS_MAX, Trigger};
use bahn_host::{Assignment, Content, Operand};

/// Runs a program and draws operands.
pub(super) fn command(options: &DiagramOptions) -> Result<Outcome, UsageError> {
    if options.show.len() > OPERANDS_MAX {
        return Err(UsageError::new(format!(
            "a diagram has up to {OPERANDS_MAX} operands"
        )));
    }
    let trigger = options.trigger.as_deref().map(trigger).transpose()?;
    let open = subject::open(&options.program, &options.bench, &options.machine, || {
        Ok(Exchange::default())
    })?;
    let Some(mut subject) = open else {
        return Ok(Outcome::ProgramError);
    };
    let size = |cycles: u64| usize::try_from(cycles).unwrap_or(usize::MAX);
    let wanted = trigger.map_or(Trigger::Start, |edge| Trigger::Edge(vec![edge]));
    let read = |operand: Operand| subject.read(operand);
    let extent = (size(options.before), size(options.cycles));
    let mut recorder = DiagramRecorder::new(options.show.clone(), wanted, extent, read).filled();
    let mut outcome = Outcome::Fine;
    while !recorder.is_over() && (recorder.is_triggered() || subject.cycle() < options.limit) {
        if let Err(halt) = subject.scan(None) {
            outcome = subject::say(&subject, &halt);
            break;
        }
        recorder.scan(|operand| subject.read(operand));
    }
    if !recorder.is_triggered() && outcome == Outcome::Fine {
        diagnostics::print_line(&format!(
            "the trigger did not come within {} cycles",
            subject.cycle()
        ));
        return Ok(Outcome::ProgramError);
    }
    if let Outcome::ProgramError = subject::finish(&subject) {
        outcome = Outcome::ProgramError;
    }
    let diagram = recorder.into_diagram();
    match (&options.svg, options.format) {
        (Some(path), _) => {
            let mut file = NewFile::create(path)?;
            file.write_all(svg(&diagram).as_bytes())
                .map_err(|error| files::cannot("write", path, &error))?;
            file.finish()?;
        }
        (None, Format::Text) => console::print(&text(&diagram))?,
        (None, Format::Json) => console::print_json(&Courses::new(&diagram))?,
    }
    Ok(outcome)
}

pub(super) fn trigger(text: &str) -> Result<(Operand, Content), UsageError> {
    match Assignment::parse(text) {
        Ok(Assignment::Operand(operand, content)) => Ok((operand, content)),
        Ok(Assignment::Parameter(_)) => Err(UsageError::new("--trigger takes an operand")),
        Err(error) => Err(UsageError::new(format!("--trigger {text}: {error}"))),
    }
}
