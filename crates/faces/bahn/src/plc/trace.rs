//! `bahn plc trace`: line, instruction, operand and accumulators per executed line [000:11414-11435].

use bahn_exchange::Exchange;
use bahn_report::plc::{Halt, Trace, up_to_cycle, up_to_trigger};

use super::diagram;
use super::options::TraceOptions;
use super::subject;
use crate::options::Format;
use crate::{Outcome, UsageError, console, diagnostics};

/// Runs up to a cycle and shows its executed lines.
pub(super) fn command(options: &TraceOptions) -> Result<Outcome, UsageError> {
    let trigger = options.trigger.as_deref().map(diagram::trigger).transpose()?;
    let open = subject::open(&options.program, &options.bench, &options.machine, || {
        Ok(Exchange::default())
    })?;
    let Some(mut subject) = open else {
        return Ok(Outcome::ProgramError);
    };
    let mut trace = Trace {
        hex: options.hex,
        ..Trace::default()
    };
    let result = match &trigger {
        Some((operand, wanted)) => {
            let came = up_to_trigger(&mut subject, &mut trace, (*operand, wanted), options.limit);
            if matches!(came, Ok(false)) {
                let cycles = subject.cycle();
                diagnostics::print_line(&format!("the trigger did not come within {cycles} cycles"));
                return Ok(Outcome::ProgramError);
            }
            came.map(drop)
        }
        None => up_to_cycle(&mut subject, &mut trace, options.cycle),
    };
    match options.format {
        Format::Text => console::print(&trace.text())?,
        Format::Json => {
            console::print_json(&trace.lines)?;
            if let Some(more) = trace.more() {
                diagnostics::print_line(&format!("warning: {more}"));
            }
        }
    }
    let outcome = match result {
        Ok(()) => subject::finish(&subject),
        Err(halt) => {
            let outcome = subject::say(&subject, &halt);
            if let (Halt::Ended, None) = (&halt, &trigger) {
                let (ended, wanted) = (subject.cycle(), options.cycle);
                diagnostics::print_line(&format!(
                    "the script has ended the run after cycle {ended}, before {wanted}"
                ));
                return Ok(Outcome::ProgramError);
            }
            outcome
        }
    };
    Ok(outcome)
}
