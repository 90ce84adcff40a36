//! What is wrong with a block.

use bahn_din::Place;

use crate::report::Fault;

/// The number of a message of the control as reports show it.
pub(crate) fn number(code: u32) -> String {
    format!("P-ERR-{code}")
}

/// A fault of a block.
pub(crate) fn at(place: &Place, code: String, message: String) -> Fault {
    Fault {
        code,
        message,
        program: place.program.to_string(),
        block: place.block.to_string(),
        line: place.line,
    }
}

/// A fault with a number of the manuals.
pub(crate) fn numbered(place: &Place, code: u32, message: String) -> Fault {
    at(place, number(code), message)
}

/// A fault for which the manuals have no number: a name of its own.
pub(crate) fn named(place: &Place, name: &str, message: String) -> Fault {
    at(place, name.to_owned(), message)
}
