//! What `--format json` says of a command that ends before it has a report: the same as is told in words, on standard
//! output, so that whoever asks for JSON always gets some.

use std::ffi::OsString;
use std::sync::atomic::{AtomicBool, Ordering};
use std::sync::{Mutex, PoisonError};

use bahn_text::Diagnostic;
use serde::Serialize;

/// The command is to print JSON.
static WANTED: AtomicBool = AtomicBool::new(false);
/// It is, and nothing has been printed.
static OPEN: AtomicBool = AtomicBool::new(false);
/// What was told meanwhile.
static REPORTED: Mutex<Reported> = Mutex::new(Reported {
    completed: false,
    error: None,
    message: None,
    faults: Vec::new(),
});

#[derive(Debug, Serialize)]
struct Reported {
    /// A command that is refused completes nothing.
    completed: bool,
    /// What is wrong, in words.
    error: Option<String>,
    /// What the control says, when nobody has told more.
    #[serde(skip)]
    message: Option<String>,
    /// Faults of files, 100 at most.
    faults: Vec<FaultReport>,
}

/// A fault of a file.
#[derive(Debug, Serialize)]
struct FaultReport {
    file: String,
    line: u32,
    column: Option<u32>,
    title: String,
    message: String,
}

/// Notes whether JSON is wanted.
pub(crate) fn begin(arguments: &[OsString]) {
    let mut pairs = arguments.iter().zip(arguments.iter().skip(1));
    let apart = pairs.any(|(option, value)| option == "--format" && value == "json");
    let wanted = apart || arguments.iter().any(|argument| argument == "--format=json");
    WANTED.store(wanted, Ordering::Relaxed);
    OPEN.store(wanted, Ordering::Relaxed);
}

/// Whether standard output is to hold JSON and nothing else.
pub(crate) fn json_is_wanted() -> bool {
    WANTED.load(Ordering::Relaxed)
}

/// Something was printed to standard output: a report, or a part of one.
pub(crate) fn has_printed() {
    OPEN.store(false, Ordering::Relaxed);
}

/// A fault of a file was told; so many are kept at most.
pub(crate) fn fault(fault: &Diagnostic, most: usize) {
    if OPEN.load(Ordering::Relaxed) {
        let mut reported = REPORTED.lock().unwrap_or_else(PoisonError::into_inner);
        if reported.faults.len() < most {
            reported.faults.push(FaultReport {
                file: fault.file.display().to_string(),
                line: fault.span.line,
                column: fault.span.columns().map(|(column, _)| column),
                title: fault.message.clone(),
                message: match fault.detail.is_empty() {
                    true => fault.exactly().to_owned(),
                    false => fault.label(),
                },
            });
        }
    }
}

/// What is wrong was told; what was told first counts.
pub(crate) fn error(text: &str) {
    if OPEN.load(Ordering::Relaxed) {
        let mut reported = REPORTED.lock().unwrap_or_else(PoisonError::into_inner);
        let text = text.strip_prefix("error: ").unwrap_or(text);
        reported.error.get_or_insert_with(|| text.to_owned());
    }
}

/// The control has said something.
pub(crate) fn message(text: &str) {
    if OPEN.load(Ordering::Relaxed) {
        let mut reported = REPORTED.lock().unwrap_or_else(PoisonError::into_inner);
        reported.message.get_or_insert_with(|| text.to_owned());
    }
}

/// A command has ended without success: what was told, to go out as JSON when that is wanted and nothing else was printed.
pub(crate) fn end() -> Option<impl Serialize> {
    OPEN.swap(false, Ordering::Relaxed).then(|| {
        let mut reported = REPORTED.lock().unwrap_or_else(PoisonError::into_inner);
        let first = reported.faults.first().map(|fault| fault.title.clone());
        Reported {
            completed: false,
            error: reported.error.take().or(first).or(reported.message.take()),
            message: None,
            faults: std::mem::take(&mut reported.faults),
        }
    })
}
