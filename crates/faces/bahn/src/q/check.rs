//! `bahn q check`: the faults of a data file.

use bahn_system900::{Channel, check};
use bahn_text::Diagnostic;
use serde::Serialize;

use super::options::FileOptions;
use super::source;
use crate::channel::Report;
use crate::options::Format;
use crate::{Outcome, UsageError, console, diagnostics};
use bahn_report::count;

#[derive(Serialize)]
struct Checked<'a> {
    #[serde(flatten)]
    report: Report,
    channels: &'a [Channel],
}

/// Checks a file and shows what is wrong.
pub(super) fn command(options: &FileOptions) -> Result<Outcome, UsageError> {
    let (file, path) = source::read(&options.file)?;
    let checked = check(&file);
    let errors = checked.errors().count();
    match options.format {
        Format::Json => {
            let at = |fault: &Diagnostic| fault.clone().at(&path, "");
            let faults: Vec<Diagnostic> = checked.faults.iter().map(at).collect();
            let report = Report::new(&faults);
            let channels = &checked.channels;
            console::print_json(&Checked { report, channels })?;
        }
        Format::Text => {
            source::show(checked.faults.iter(), &file, &path);
            for Channel { channel, axes } in &checked.channels {
                let axes: Vec<String> = axes
                    .iter()
                    .map(|axis| format!("{} ({})", axis.name, axis.physical))
                    .collect();
                console::print(&format!("channel {channel}: {}\n", axes.join(" ")))?;
            }
            diagnostics::print_text(&format!(
                "{}: {}, {}, {}",
                path.display(),
                count(file.entries(), "parameter"),
                count(errors, "error"),
                count(checked.faults.len() - errors, "warning"),
            ));
        }
    }
    Ok(if errors == 0 {
        Outcome::Fine
    } else {
        Outcome::ProgramError
    })
}
