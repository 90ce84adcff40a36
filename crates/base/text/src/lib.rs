//! Texts of files, whatever their language: how bytes are text ([`decode`], [`Encoding`]), where its lines are
//! ([`LineIndex`]), a place in it ([`Span`]), what is wrong there ([`Diagnostic`], as [`render`] shows it to people), and where
//! the files are that it names ([`Files`]). Nothing here knows what a text means.
//!
//! ```
//! use bahn_text::{Diagnostic, Span, decode, render};
//!
//! let text = decode(b"MP10 : 1\nMP11 = T\xfcr\n");
//! let wrong = Diagnostic::error(Span::word(2, 6, "MP11 = T\u{fc}r"), "no value").in_text("MY.MP", &text);
//! assert_eq!(wrong.to_string(), "MY.MP:2:6: no value");
//! assert!(render(&wrong, false).ends_with("\n2 | MP11 = T\u{fc}r\n  |      ^"));
//! ```

mod diagnostic;
mod encoding;
mod escapes;
mod files;
mod lines;
mod nearest;
mod printable;
mod render;
mod span;

pub use diagnostic::{Diagnostic, Related, Severity};
pub use encoding::{Encoding, MARK, MARK_BYTES, as_utf8, decode, utf8_or_latin, without_mark};
pub use escapes::{quoted, unescaped};
pub use files::{Files, MemoryFiles, NamedFile, meant, name_alone, path_below};
pub use lines::LineIndex;
pub use nearest::nearest;
pub use printable::{printable, printable_lines};
pub use render::render;
pub use span::Span;
