//! Short ways to say what a program of a System 900 comes to.

#![allow(dead_code, reason = "no test uses all of it")]

use bahn_din::Fault;
use bahn_din::system900::{Program, WordKind};

pub fn program(text: &str) -> Program {
    Program::from_bytes("P1000.900", text.as_bytes())
}

/// The words of a line.
pub fn words(program: &Program, line: u32) -> Vec<WordKind> {
    program
        .words_read(line)
        .into_iter()
        .map(|word| word.kind)
        .collect()
}

/// A fault as `line:column+length block message`.
fn said(fault: &Fault) -> String {
    let span = fault.span;
    format!(
        "{}:{}+{} {} {}",
        span.line, span.column, span.length, fault.block, fault.message
    )
}

pub fn faults(text: &str) -> Vec<String> {
    program(text).findings().faults.iter().map(said).collect()
}

pub fn warnings(text: &str) -> Vec<String> {
    program(text).findings().warnings.iter().map(said).collect()
}
