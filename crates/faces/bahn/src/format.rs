//! `bahn fmt`: the normalised listing of programs.

use std::io::Write;
use std::path::Path;
use std::sync::Arc;

use bahn_din::system900;
use bahn_program::{DinLanguage, FormatOptions, Program, format_program};

use crate::files::{self, Loaded, NewFile};
use crate::options::FmtOptions;
use crate::{Outcome, UsageError, console, diagnostics, settings};
use bahn_text::printable;

/// Prints, writes or compares listings.
pub(crate) fn command(options: &FmtOptions) -> Result<Outcome, UsageError> {
    let mut outcome = Outcome::Fine;
    let iso_step = iso_step(options)?;
    for path in &options.files {
        // Read once: a pipe gives its bytes once.
        let bytes = files::read_program(path)?;
        if let Some(listing) = din(path, bytes.as_deref()) {
            match format_din(path, &listing, bytes.unwrap_or_default(), options)? {
                Outcome::Fine => {}
                other => outcome = other,
            }
            continue;
        }
        let program = load(path, bytes.clone())?;
        let listing = format_program(
            &program,
            FormatOptions {
                decimal_comma: options.comma,
                iso_step,
            },
        );
        if !options.write && !options.check {
            console::print_display(&listing)?;
            continue;
        }
        let listing = listing.to_string();
        let differs = bytes.as_deref() != Some(listing.as_bytes());
        if differs && options.check {
            console::print(&format!("{}\n", printable(&path.to_string_lossy())))?;
            outcome = Outcome::ProgramError;
        }
        if differs && options.write {
            if !program.begins_with_header() {
                // The other files are written all the same.
                let [begin, _] = program.language().frames();
                let reason = format!("it does not begin with {begin}, so it may be no program");
                diagnostics::print_usage_error(&format!("{} stays as it is: {reason}", path.display()));
                outcome = Outcome::WrongUse;
                continue;
            }
            write(path, listing.as_bytes())?;
            diagnostics::print_text(&format!("formatted {}", path.display()));
        }
    }
    Ok(outcome)
}

/// A listing as text, and in the bytes that its file is written in.
struct Listing {
    text: String,
    bytes: Vec<u8>,
}

/// The listing of a file of DIN 66025, if it is one.
fn din(path: &Path, bytes: Option<&[u8]>) -> Option<Listing> {
    let bytes = bytes?;
    let name = path.file_name().unwrap_or_default().to_string_lossy();
    let (text, bytes) = match files::dialect(path, bytes)? {
        DinLanguage::Tf5200 => {
            let program = bahn_din::Program::from_bytes(&name, bytes);
            let listing = program.listing();
            (listing.clone(), program.encoded(&listing))
        }
        DinLanguage::System900 => {
            let program = system900::Program::from_bytes(&name, bytes);
            let listing = program.listing();
            (listing.clone(), program.encoded(&listing))
        }
    };
    Some(Listing { text, bytes })
}

/// Prints, writes or compares the listing of a DIN 66025 program.
fn format_din(
    path: &Path,
    listing: &Listing,
    bytes: Vec<u8>,
    options: &FmtOptions,
) -> Result<Outcome, UsageError> {
    if !options.write && !options.check {
        console::print_display(&listing.text)?;
        return Ok(Outcome::Fine);
    }
    if listing.bytes == bytes {
        return Ok(Outcome::Fine);
    }
    if options.check {
        console::print(&format!("{}\n", printable(&path.to_string_lossy())))?;
        return Ok(Outcome::ProgramError);
    }
    if bytes.contains(&0) {
        // Other things are named .nc or .900, too.
        let reason = "it holds bytes that are no text, so it may be no program";
        diagnostics::print_usage_error(&format!("{} stays as it is: {reason}", path.display()));
        return Ok(Outcome::WrongUse);
    }
    write(path, &listing.bytes)?;
    diagnostics::print_text(&format!("formatted {}", path.display()));
    Ok(Outcome::Fine)
}

/// The step of block numbers in DIN/ISO.
fn iso_step(options: &FmtOptions) -> Result<u8, UsageError> {
    let of_list = || match &options.parameters {
        Some(list) => {
            let list = settings::parameter_list(options.model, Some(list))?;
            Ok(list.operation_parameters().iso_step)
        }
        None => Ok(FmtOptions::ISO_STEP),
    };
    options.iso_step.map_or_else(of_list, Ok)
}

fn load(path: &Path, bytes: Option<Vec<u8>>) -> Result<Arc<Program>, UsageError> {
    match files::as_program(path, bytes) {
        Loaded::Program(program) => Ok(program),
        Loaded::Empty(_) => Err(UsageError::new(format!("{}: {}", path.display(), files::EMPTY))),
        Loaded::TooLarge => Err(UsageError::new(format!(
            "{}: {}",
            path.display(),
            files::TOO_LARGE
        ))),
    }
}

fn write(path: &Path, listing: &[u8]) -> Result<(), UsageError> {
    let mut file = NewFile::create(path)?;
    file.write_all(listing)
        .map_err(|error| files::cannot("write", path, &error))?;
    Ok(file.finish()?)
}
