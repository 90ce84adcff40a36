//! A run as a program for LinuxCNC (RS-274/NGC): what it did, line by line. Cycles, labels and Q parameters are gone, arcs and
//! helices are arcs.
//!
//! `said` is what of a run such a program can say; `write` writes it, `read` reads what was written, for the proof. What the
//! words mean is public: the G and M code reference of LinuxCNC.

mod back;
mod line;
mod options;
mod read;
mod said;
mod text;
mod write;

use std::sync::Arc;
use std::sync::atomic::AtomicBool;

use bahn_interpreter::Interpreter;

use crate::Listed;
use crate::proof::{At, Difference, Proof};
use line::Said;
pub use options::Options;
use read::Reader;
use said::Sayer;

/// A program for LinuxCNC.
#[derive(Clone, Debug)]
pub struct GCode {
    /// The G-code, lines with LF.
    pub text: String,
    /// How many lines it has.
    pub lines: u32,
    /// What it cannot say, each once.
    pub refused: Vec<Listed>,
    /// What it leaves out since the path does not depend on it, each once.
    pub left_out: Vec<Listed>,
    /// The message that the run ended with, if it did not come to its end.
    pub message: Option<String>,
    /// Whether the run was followed to its end.
    pub completed: bool,
}

/// Writes what runs of a program do; `run` begins one. The first run only finds which tools are changed by M06, the others by
/// their call (a control leaves that to the PLC).
pub fn write(run: &dyn Fn() -> Interpreter, options: &Options, stop: &Arc<AtomicBool>) -> GCode {
    let changes = said::tool_changes(run(), options.model, stop);
    let mut sayer = Sayer::new(run(), options, changes, stop);
    let mut writer = write::Writer::new(&sayer, options);
    while let Some((block, said)) = sayer.next() {
        writer.said(&said, || numbered(At::of(sayer.run(), block)));
    }
    let (completed, message) = (sayer.completed(), sayer.message().map(str::to_owned));
    let (refused, left_out) = sayer.into_lists();
    GCode {
        lines: writer.lines(),
        text: writer.finish(),
        refused,
        left_out,
        message,
        completed,
    }
}

/// A block with its number, also where the file does not have it.
fn numbered(at: At) -> String {
    let mut first = at.text.trim_start_matches(['/', ' ']).chars();
    let is_number = match first.next() {
        Some('N' | 'n') => first.next().is_some_and(|c| c.is_ascii_digit()),
        Some(c) => c.is_ascii_digit(),
        None => true,
    };
    match is_number {
        true => at.text,
        false => format!("{} {}", at.block, at.text),
    }
}

/// Reads a text again and compares it with another run.
pub fn prove(
    run: &dyn Fn() -> Interpreter,
    text: &str,
    name: &str,
    options: &Options,
    stop: &Arc<AtomicBool>,
) -> Proof {
    let changes = said::tool_changes(run(), options.model, stop);
    let mut source = Sayer::new(run(), options, changes, stop);
    let mut target = Reader::new(text);
    let mut proof = Proof::new();
    loop {
        let next = source.next();
        let read = target.next();
        let what = match (&next, &read) {
            (_, Err(what)) => Some(what.clone()),
            (None, Ok(None)) => {
                proof.completed = source.completed();
                proof.message = source.message().map(str::to_owned);
                return proof;
            }
            (Some((_, said)), Ok(Some(read))) => same(&mut proof, said, read),
            (None, Ok(Some(_))) => Some("the target goes on".to_owned()),
            (Some(_), Ok(None)) => Some("the target ends".to_owned()),
        };
        if let Some(what) = what {
            let block = next.map(|(block, _)| block).unwrap_or_default();
            proof.first_difference = Some(Difference {
                what,
                source: At::of(source.run(), block),
                target: At {
                    program: name.to_owned(),
                    block: target.line(),
                    line: target.line(),
                    text: target.text().to_owned(),
                },
            });
            return proof;
        }
    }
}

/// Counts what both say, or says what differs.
fn same(proof: &mut Proof, one: &Said, other: &Said) -> Option<String> {
    match said::deviation_mm(one, other) {
        Ok(deviation) => {
            proof.deviates(deviation);
            if deviation > crate::TOLERANCE_MM {
                return Some(format!("the path is {:.3} µm apart", deviation * 1e3));
            }
        }
        Err(what) => return Some(what),
    }
    match one {
        Said::Move { .. } | Said::Thread { .. } => proof.elements += 1,
        Said::Stop { .. } => proof.stops += 1,
        _ => proof.functions += 1,
    }
    None
}
