//! What is said of a conversion.

use std::fmt::Write as _;

use bahn_convert::{Listed, Proof};
use serde::Serialize;

use crate::text::LABEL;
use bahn_text::printable;

/// Entries of a list that are shown; the JSON report has all.
const SHOWN: usize = 20;

/// What is told of one converted program.
#[derive(Clone, Debug, Serialize)]
pub struct Report {
    /// Nothing is refused, and the proof holds where it was wanted.
    pub ok: bool,
    /// Blocks, or lines, of the target.
    pub blocks: u32,
    /// What the target says by its path only.
    pub unrolled: Vec<Listed>,
    /// What the target does not say.
    pub refused: Vec<Listed>,
    /// What the target leaves out since the path does not depend on it.
    pub left_out: Vec<Listed>,
    /// Comments that go on in the next block, since one has so few characters.
    pub wrapped_comments: u32,
    /// Why what is refused was not unrolled, if it was tried.
    pub not_unrolled: Option<String>,
    /// `None` where none was wanted.
    pub proof: Option<Proof>,
    /// The file of the program.
    pub source: String,
    /// `None` when nothing was written.
    pub target: Option<String>,
    /// The name of the language.
    pub to: &'static str,
}

/// What is told of several converted programs.
#[derive(Debug, Serialize)]
pub struct Reports {
    /// Each of them is `ok`.
    pub ok: bool,
    /// The report of each, in the order of conversion.
    pub programs: Vec<Report>,
}

/// The report for people.
pub fn text(report: &Report) -> String {
    let mut text = String::new();
    let mut row = |label: &str, value: &str| {
        // Writing to a string cannot fail.
        let _ = writeln!(text, "{label:<LABEL$}{}", printable(value));
    };
    row("Program", &report.source);
    row("Blocks", &report.blocks.to_string());
    list(&mut row, "Unrolled", &report.unrolled);
    list(&mut row, "Refused", &report.refused);
    if let Some(why) = &report.not_unrolled {
        row("Not unrolled", why);
    }
    list(&mut row, "Left out", &report.left_out);
    if report.wrapped_comments > 0 {
        let what = "longer than a block: they go on in the next one";
        row("Comments", &format!("{} {what}", report.wrapped_comments));
    }
    match &report.proof {
        None => row("Proof", "none was wanted"),
        Some(proof) => self::proof(&mut row, proof),
    }
    match &report.target {
        Some(target) => row("Written", target),
        None => row("Written", "nothing"),
    }
    text
}

fn list(row: &mut impl FnMut(&str, &str), label: &str, listed: &[Listed]) {
    for (index, entry) in listed.iter().take(SHOWN).enumerate() {
        let label = if index == 0 { label } else { "" };
        row(label, &format!("block {}: {}", entry.block, entry.text));
        row("", &format!("  {}", entry.reason));
    }
    if listed.len() > SHOWN {
        row("", &format!("and {} more", listed.len() - SHOWN));
    }
}

fn proof(row: &mut impl FnMut(&str, &str), proof: &Proof) {
    let counted = format!(
        "{} elements, {} functions, {} stops, {} warnings, {:.3} µm apart at most",
        proof.elements, proof.functions, proof.stops, proof.warnings, proof.max_deviation_um
    );
    match &proof.first_difference {
        Some(difference) => {
            row("Proof", &format!("they differ after {counted}"));
            row("", &difference.what);
            for (name, at) in [("source", &difference.source), ("target", &difference.target)] {
                row(
                    "",
                    &format!("{name}: {} block {}: {}", at.program, at.block, at.text),
                );
            }
        }
        None if proof.completed => row("Proof", &format!("the same: {counted}")),
        None => row(
            "Proof",
            &format!("not followed to the end: the same so far, {counted}"),
        ),
    }
    if let Some(message) = &proof.message {
        row("", &format!("both end with {message}"));
    }
}

/// The line of a program among others.
pub fn line(report: &Report) -> String {
    let result = match (&report.proof, report.ok) {
        (_, false) if !report.refused.is_empty() => format!("{} blocks refused", report.refused.len()),
        (Some(proof), false) if proof.first_difference.is_some() => "differs".to_owned(),
        (_, false) => "not proved".to_owned(),
        (Some(proof), true) => match &proof.message {
            None => format!("the same: {} elements", proof.elements),
            Some(message) => format!("the same: {} elements, both end with {message}", proof.elements),
        },
        (None, true) => "without proof".to_owned(),
    };
    let unrolled = if report.unrolled.is_empty() {
        ""
    } else {
        ", unrolled"
    };
    format!("{:<40} {result}{unrolled}", printable(&report.source))
}
