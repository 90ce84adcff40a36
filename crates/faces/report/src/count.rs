//! How many there are, in words.

use std::fmt::Display;

/// `1 error`, `2 errors`.
pub fn count<N: Display + PartialEq + From<u8>>(number: N, what: &str) -> String {
    let plural = if number == N::from(1) { "" } else { "s" };
    format!("{number} {what}{plural}")
}
