//! The words of a line by their kind, for editors: cheap, and independent of whether the line can be read.

use super::line::comments;
use crate::block::number;
use crate::cursor::Cursor;
use crate::line::Glyph;
use crate::words::{Span, SpanKind, each_word, marked, span};

/// The words of a line in their order; blanks, colons and comparisons are none.
pub fn words(text: &str) -> Vec<Span> {
    let characters: Vec<char> = text.chars().collect();
    marked(&characters, &comments(&characters), read)
}

fn read(code: &[Glyph], spans: &mut Vec<Span>) {
    let is_skipped = code.first().is_some_and(|glyph| glyph.character == '/');
    let code = code.get(usize::from(is_skipped)..).unwrap_or_default();
    let (name, rest) = number(code);
    if name.is_some() {
        let digits = code.get(..code.len() - rest.len()).unwrap_or_default();
        let first = digits.iter().position(|glyph| !glyph.character.is_whitespace());
        let digits = digits.get(first.unwrap_or_default()..).unwrap_or_default();
        spans.extend(span(digits, SpanKind::Number));
    }
    each_word(rest, spans, word);
}

/// Takes a word and says what it is; `None` of a character that is none.
fn word(cursor: &mut Cursor) -> Option<SpanKind> {
    let is_value = |c: char| c.is_ascii_digit() || c == '.';
    match cursor.peek()? {
        '0'..='9' | '.' => {
            cursor.take_while(is_value);
            Some(SpanKind::Value)
        }
        '$' => {
            cursor.advance(1);
            cursor.take_while(|c| c.is_ascii_hexdigit());
            Some(SpanKind::Value)
        }
        'G' | 'M' => {
            cursor.advance(1);
            cursor.take_while(is_value);
            Some(SpanKind::Function)
        }
        'P' => {
            cursor.advance(1);
            cursor.take_while(|c| c.is_ascii_digit());
            Some(SpanKind::Variable)
        }
        letter if letter.is_ascii_alphabetic() => {
            cursor.advance(1);
            let mut ahead = cursor.clone();
            let digits = ahead.take_while(|c| c.is_ascii_digit());
            if ahead.peek() == Some(':') {
                cursor.advance(digits.len());
            }
            Some(SpanKind::Address)
        }
        _ => None,
    }
}
