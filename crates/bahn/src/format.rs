//! `bahn fmt`: the normalised listing of programs.

use std::io::Write;
use std::path::Path;
use std::sync::Arc;

use bahn_program::{FormatOptions, Program, format_program};

use crate::cli::FmtOptions;
use crate::files::{self, Loaded, NewFile};
use crate::{Outcome, UsageError, console, diagnostics};

/// Prints, writes or compares listings.
pub(crate) fn command(options: &FmtOptions) -> Result<Outcome, UsageError> {
    let mut outcome = Outcome::Fine;
    for path in &options.files {
        let program = load(path)?;
        let listing = format_program(
            &program,
            FormatOptions {
                decimal_comma: options.comma,
            },
        );
        if !options.write && !options.check {
            console::print_display(&listing)?;
            continue;
        }
        let listing = listing.to_string();
        let differs = files::read_program(path)? != listing.as_bytes();
        if differs && options.check {
            console::print(&format!("{}\n", path.display()))?;
            outcome = Outcome::ProgramError;
        }
        if differs && options.write {
            write(path, &listing)?;
            diagnostics::print_line(&format!("formatted {}", path.display()));
        }
    }
    Ok(outcome)
}

fn load(path: &Path) -> Result<Arc<Program>, UsageError> {
    match files::load_program(path)? {
        Loaded::Program(program) => Ok(program),
        Loaded::Empty(_) => Err(UsageError::new(format!("{}: {}", path.display(), files::EMPTY))),
        Loaded::TooLarge => Err(UsageError::new(format!(
            "{}: {}",
            path.display(),
            files::TOO_LARGE
        ))),
    }
}

fn write(path: &Path, listing: &str) -> Result<(), UsageError> {
    let mut file = NewFile::create(path)?;
    file.write_all(listing.as_bytes())
        .map_err(|error| files::cannot("write", path, &error))?;
    file.finish()
}
