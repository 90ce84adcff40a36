//! `bahn plc diagram`: operands over cycles, with trigger [000:11461-11480].

use std::collections::VecDeque;
use std::io::Write;

use bahn_exchange::Exchange;

use super::drawing::{self, Diagram};
use super::options::DiagramOptions;
use super::subject::Subject;
use crate::files::{self, NewFile};
use crate::options::Format;
use crate::{Outcome, UsageError, console, diagnostics};
use bahn_host::{Assignment, Content, Operand};

/// Operands of a diagram [000:11461].
const OPERANDS_MAX: usize = 16;

/// Runs a program and draws operands.
pub(super) fn command(options: &DiagramOptions) -> Result<Outcome, UsageError> {
    if options.show.len() > OPERANDS_MAX {
        return Err(UsageError::new(format!(
            "a diagram has up to {OPERANDS_MAX} operands"
        )));
    }
    let trigger = options.trigger.as_deref().map(trigger).transpose()?;
    let open = Subject::open(&options.program, &options.bench, &options.machine, || {
        Ok(Exchange::default())
    })?;
    let Some(mut subject) = open else {
        return Ok(Outcome::ProgramError);
    };
    let mut samples = VecDeque::new();
    // The cycle that triggers; without trigger the first.
    let mut triggered = trigger.is_none().then_some(1);
    let is_met = |subject: &Subject| {
        let wanted = trigger.as_ref();
        wanted.is_some_and(|(operand, wanted)| subject.read(*operand) == *wanted)
    };
    // A trigger is an edge: the operand gets its value [000:11461].
    let mut was_met = is_met(&subject);
    let before = options.before.min(options.cycles.saturating_sub(1));
    let mut outcome = Outcome::Fine;
    loop {
        let end = triggered.map_or(options.limit, |cycle: u64| {
            // Fewer cycles lie before an early trigger.
            cycle
                .saturating_sub(before)
                .max(1)
                .saturating_add(options.cycles - 1)
        });
        if subject.cycle() >= end {
            break;
        }
        if let Err(halt) = subject.scan(None) {
            outcome = subject.say(&halt);
            break;
        }
        samples.push_back(
            options
                .show
                .iter()
                .map(|operand| subject.read(*operand))
                .collect(),
        );
        if triggered.is_none() {
            let is_met = is_met(&subject);
            if !std::mem::replace(&mut was_met, is_met) && is_met {
                triggered = Some(subject.cycle());
            } else if samples.len() as u64 > before {
                samples.pop_front();
            }
        }
    }
    if triggered.is_none() && outcome == Outcome::Fine {
        diagnostics::print_line(&format!(
            "the trigger did not come within {} cycles",
            subject.cycle()
        ));
        return Ok(Outcome::ProgramError);
    }
    if let Outcome::ProgramError = subject.finish() {
        outcome = Outcome::ProgramError;
    }
    let diagram = Diagram {
        operands: options.show.clone(),
        first: subject.cycle().saturating_sub(samples.len() as u64) + 1,
        trigger: trigger.and(triggered),
        samples: samples.into(),
    };
    match (&options.svg, options.format) {
        (Some(path), _) => {
            let mut file = NewFile::create(path)?;
            file.write_all(drawing::svg(&diagram).as_bytes())
                .map_err(|error| files::cannot("write", path, &error))?;
            file.finish()?;
        }
        (None, Format::Text) => console::print(&drawing::text(&diagram))?,
        (None, Format::Json) => console::print_json(&Report::new(&diagram))?,
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

/// The diagram as data.
#[derive(Debug, serde::Serialize)]
struct Report<'a> {
    first_cycle: u64,
    trigger_cycle: Option<u64>,
    operands: Vec<Course<'a>>,
}

/// An operand after every cycle.
#[derive(Debug, serde::Serialize)]
struct Course<'a> {
    operand: String,
    values: Vec<&'a Content>,
}

impl Report<'_> {
    fn new(diagram: &Diagram) -> Report<'_> {
        let course = |(index, operand): (usize, &Operand)| Course {
            operand: operand.to_string(),
            values: diagram
                .samples
                .iter()
                .filter_map(|sample| sample.get(index))
                .collect(),
        };
        Report {
            first_cycle: diagram.first,
            trigger_cycle: diagram.trigger,
            operands: diagram.operands.iter().enumerate().map(course).collect(),
        }
    }
}
