//! A line without its comments.
//!
//! Decision: `{` opens a comment that ends with `}` or with its line, since the listing of [002:1646-1655] prints one
//! that nothing closes; `;` opens one to the end of the line

use crate::line::{self, Comment, Glyph};

/// The comments of a line.
pub(super) fn comments(line: &[char]) -> Vec<Comment> {
    let mut found = Vec::new();
    let mut at = 0;
    while let Some(character) = line.get(at) {
        let end = match character {
            ';' => line.len(),
            '{' => {
                let rest = line.get(at..).unwrap_or_default();
                let closed = rest.iter().position(|c| *c == '}');
                closed.map_or(line.len(), |length| at + length + 1)
            }
            _ => {
                at += 1;
                continue;
            }
        };
        found.push(Comment { start: at, end });
        at = end;
    }
    found
}

/// The characters of a line without its comments.
pub(super) fn glyphs(line: &str) -> Vec<Glyph> {
    let characters: Vec<char> = line.chars().collect();
    line::without(&characters, &comments(&characters))
}

/// Whether nothing but comments and blanks stands in a line.
pub(super) fn is_blank(glyphs: &[Glyph]) -> bool {
    glyphs.iter().all(|glyph| glyph.character.is_whitespace())
}
