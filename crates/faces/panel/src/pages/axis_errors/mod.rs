//! The files of non-linear axis errors: compensation tables (.COM), their assignment (.CMA), and the correction tables of
//! code number 105 296 [000:3768-3896]. What is entered is checked, on the medium at once, and acts at once as far as the
//! file is in use.
//!
//! Decision: What is entered into .COM, .CMA and correction tables in use acts at once, and SET ACTIV LINE makes its
//! file the one in use; what cannot be read as a file of its type, or what the machine could not be switched on with,
//! is refused, and such a file is not opened; a column goes when it has no values. INSERT LINE of an assignment makes
//! a line at the cursor, and the active one stays active. Code number 105 296 makes CORRECTION.TAB where there is
//! none

mod assignment;
mod corrections;
mod head;
mod table;
mod text;

use std::path::Path;

use crate::page::Turn;
use text::NEW_HEAD;

pub(crate) use corrections::open as corrections;

/// The editor of a file of the PLC's folder, where its type has one.
pub(crate) fn editor(name: &str, path: &Path) -> Option<Result<Turn, String>> {
    let (_, ending) = name.rsplit_once('.')?;
    match ending.to_uppercase().as_str() {
        "COM" => Some(table::open(name, path)),
        "CMA" => Some(assignment::open(name, path)),
        _ => None,
    }
}

/// What a new file of a type begins with.
pub(crate) fn new_file(name: &str) -> String {
    match name.rsplit_once('.') {
        Some((stem, ending)) if ending.eq_ignore_ascii_case("COM") => format!("{stem} {NEW_HEAD}\n"),
        Some((_, ending)) if ending.eq_ignore_ascii_case("CMA") => "0\n".to_owned(),
        _ => String::new(),
    }
}
