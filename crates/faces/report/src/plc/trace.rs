//! Line, instruction, operand and accumulators per executed line [000:11414-11435].

use bahn_host::{Content, Operand};
use bahn_plc::{OperandContent, TraceStep, Tracer, code_of_line};

use super::halt::Halt;
use super::subject::Subject;

/// Lines that are shown at most: what is executed from one cycle to the next has no end.
const LINES_MAX: usize = 100_000;

/// Runs up to a cycle, and traces it.
///
/// # Errors
/// When it does not go on so far.
pub fn up_to_cycle(subject: &mut Subject, trace: &mut Trace, cycle: u64) -> Result<(), Halt> {
    while subject.cycle() < cycle {
        trace.cycle = subject.cycle() + 1;
        let shown = trace.cycle == cycle;
        subject.scan(shown.then_some(trace as &mut dyn Tracer))?;
    }
    Ok(())
}

/// Runs and traces up to the cycle in which an operand gets a value; tells whether it did.
///
/// # Errors
/// When the program does not go on; the end of the script is none.
pub fn up_to_trigger(
    subject: &mut Subject,
    trace: &mut Trace,
    (operand, wanted): (Operand, &Content),
    limit: u64,
) -> Result<bool, Halt> {
    let mut was = subject.read(operand) == *wanted;
    while subject.cycle() < limit {
        trace.lines.clear();
        trace.left_off = 0;
        trace.cycle = subject.cycle() + 1;
        match subject.scan(Some(trace)) {
            Err(Halt::Ended) => break,
            other => other?,
        }
        let is = subject.read(operand) == *wanted;
        if is && !std::mem::replace(&mut was, is) {
            return Ok(true);
        }
        was = is;
    }
    Ok(false)
}

/// The lines that a cycle has executed.
#[derive(Debug, Default)]
pub struct Trace {
    /// The cycle that is being executed.
    pub cycle: u64,
    /// The first of them, at most `LINES_MAX`.
    pub lines: Vec<Line>,
    /// How many were executed after those.
    pub left_off: u64,
    /// Whether numbers of the table are hexadecimal [000:11422].
    pub hex: bool,
}

/// An executed line with what it left behind.
#[derive(Debug, serde::Serialize)]
pub struct Line {
    cycle: u64,
    file: String,
    line: u32,
    instruction: String,
    operand: Option<Shown>,
    logic: u8,
    word: i32,
    index: i32,
    job: Option<u8>,
}

/// The content of an operand.
#[derive(Debug, serde::Serialize)]
#[serde(untagged)]
enum Shown {
    Bit(u8),
    Number(i32),
    Text(String),
}

impl Tracer for Trace {
    fn executed(&mut self, step: &TraceStep<'_>) {
        if self.lines.len() >= LINES_MAX {
            self.left_off += 1;
            return;
        }
        let operand = step.operand().map(|content| match content {
            OperandContent::Bit(bit) => Shown::Bit(bit.into()),
            OperandContent::Number(value) => Shown::Number(value),
            OperandContent::Text(text) => Shown::Text(text.iter().map(|byte| char::from(*byte)).collect()),
        });
        self.lines.push(Line {
            cycle: self.cycle,
            file: step.file().to_owned(),
            line: step.instruction.line,
            instruction: code_of_line(step.text()),
            operand,
            logic: step.registers.logic.into(),
            word: step.registers.word,
            index: step.registers.index,
            job: step.job,
        });
    }
}

impl Trace {
    /// The table for people.
    pub fn text(&self) -> String {
        let mut text = String::new();
        let mut shown = (0, "", None);
        for line in &self.lines {
            let place = (line.cycle, line.file.as_str(), line.job);
            if place != shown {
                let job = line
                    .job
                    .map(|job| format!(", submit job {job}"))
                    .unwrap_or_default();
                text += &format!("cycle {}, {}{job}\n", line.cycle, line.file);
                text += " LINE  INSTRUCTION               OPERAND  LOGIC         WORD\n";
                shown = place;
            }
            let number = |value: i32| match self.hex {
                true => format!("{value:X}h"),
                false => value.to_string(),
            };
            let operand = match &line.operand {
                None => String::new(),
                Some(Shown::Number(value)) => number(*value),
                Some(Shown::Bit(bit)) => bit.to_string(),
                Some(Shown::Text(text)) => format!("\"{text}\""),
            };
            text += &format!(
                "{:>5}  {:<20} {operand:>12}  {:>5}  {:>11}\n",
                line.line,
                line.instruction,
                line.logic,
                number(line.word)
            );
        }
        if let Some(more) = self.more() {
            text += &format!("{more}\n");
        }
        text
    }

    /// What is said when lines are left off.
    pub fn more(&self) -> Option<String> {
        (self.left_off > 0).then(|| {
            format!(
                "{} more lines were executed; {LINES_MAX} are shown at most",
                self.left_off
            )
        })
    }
}
