//! The listing of a whole program.

use std::fmt;
use std::fmt::Display;

use bahn_text::MARK;

use super::options::FormatOptions;
use crate::lines::lines;
use crate::text::{is_blank, text_start, to_text, trim};
use crate::{NumberedBlock, Program};

/// The normalised listing of a program, to be written anywhere that takes a [`Display`].
///
/// Every block is one line after its number; lines that `~` joined become one. Comments are kept, also the
/// text before BEGIN PGM and after END PGM; annotation after dots is dropped. Blocks that cannot be read
/// stay as they are. Reading the listing gives the same blocks again.
///
/// ```
/// use bahn_program::{FormatOptions, Program, format_program};
///
/// let program = Program::from_bytes("1.H", b"BEGIN PGM 1 MM\nl x5y-10,50r0 f 100m03\nEND PGM 1 MM".to_vec());
/// let listing = format_program(&program, FormatOptions::default()).to_string();
/// assert_eq!(listing, "0 BEGIN PGM 1 MM\n1 L X+5 Y-10.5 R0 F100 M3\n2 END PGM 1 MM\n");
/// ```
pub fn format_program(program: &Program, options: FormatOptions) -> impl Display {
    Listing { program, options }
}

pub(super) struct Listing<'a> {
    pub(super) program: &'a Program,
    pub(super) options: FormatOptions,
}

impl Display for Listing<'_> {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let (leading, trailing) = self.program.around();
        verbatim(f, leading.get(text_start(leading)..).unwrap_or_default())?;
        let language = self.program.language();
        let mut text = String::new();
        for NumberedBlock { number, block, .. } in self.program.blocks() {
            text.clear();
            language.write_line_number(number, &block, self.options, &mut text);
            language.write(&block, self.options, &mut text);
            text.push('\n');
            f.write_str(&text)?;
        }
        let end = trailing
            .iter()
            .rposition(|&b| !is_blank(b))
            .map_or(0, |last| last + 1);
        verbatim(f, trailing.get(..end).unwrap_or_default())
    }
}

/// Writes lines as they are, without blanks at their ends. Empty ones stay: they keep a `~` before them from
/// joining more.
pub(super) fn verbatim(f: &mut fmt::Formatter<'_>, text: &[u8]) -> fmt::Result {
    let blanks = text.iter().take_while(|b| is_blank(**b)).count();
    let text = text.get(blanks..).unwrap_or_default();
    lines(text).map(trim).enumerate().try_for_each(|(index, line)| {
        let line = to_text(line);
        // At the front of a file a byte-order mark would be no text.
        let blank = if index == 0 && line.starts_with(MARK) {
            " "
        } else {
            ""
        };
        writeln!(f, "{blank}{line}")
    })
}
