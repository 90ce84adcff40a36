//! The words of a line by their kind, for editors: cheap, and independent of whether the line can be read.

use crate::block;
use crate::cursor::Cursor;
use crate::expression::{is_function, variable_begins};
use crate::line::{self, Comment, Glyph};

/// A part of a line.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Span {
    /// Column of its first character, from 1.
    pub column: u32,
    /// How many characters it covers.
    pub length: u32,
    /// Comment, number, address, value or the like.
    pub kind: SpanKind,
}

/// Kind of a part of a line.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum SpanKind {
    /// `; ..`, `( .. )`.
    Comment,
    /// Head of a program or subroutine.
    Head,
    /// Number of a block.
    Number,
    /// G, M or H with its number.
    Function,
    /// Letter or word before a value: `X`, `F`, `REV`, `POS`; a call's `L`.
    Address,
    /// Number as a value.
    Value,
    /// Variable or parameter: `V.G.RW`, `P10`.
    Variable,
    /// `#FLUSH WAIT`, `$IF`.
    Command,
    /// `"NAME"`, `'16#1F'`.
    Text,
    /// Function of an expression: `SIN`.
    Calculation,
}

/// The words of a line in their order; blanks, brackets and operators are none.
pub fn words(text: &str) -> Vec<Span> {
    let characters: Vec<char> = text.chars().collect();
    marked(&characters, &line::comments(&characters), |code, spans| {
        if code.first().is_some_and(|glyph| glyph.character == '%') {
            spans.extend(span(code, SpanKind::Head));
        } else {
            read(code, spans);
        }
    })
}

/// The comments of a line and what `read` finds in the code between its first and its last character, in their order.
pub(crate) fn marked(
    characters: &[char],
    comments: &[Comment],
    read: impl Fn(&[Glyph], &mut Vec<Span>),
) -> Vec<Span> {
    let mut spans: Vec<Span> = comments
        .iter()
        .map(|comment| Span {
            column: number(comment.start) + 1,
            length: number(comment.end - comment.start),
            kind: SpanKind::Comment,
        })
        .collect();
    let glyphs = line::without(characters, comments);
    let start = glyphs.iter().position(|glyph| !glyph.character.is_whitespace());
    let end = glyphs.iter().rposition(|glyph| !glyph.character.is_whitespace());
    if let (Some(start), Some(end)) = (start, end) {
        read(glyphs.get(start..=end).unwrap_or_default(), &mut spans);
    }
    spans.sort_by_key(|span| span.column);
    // A command goes on after a comment; what is marked of it ends before.
    let next: Vec<u32> = spans.iter().skip(1).map(|span| span.column).collect();
    for (span, next) in spans.iter_mut().zip(next) {
        span.length = span.length.min(next.saturating_sub(span.column)).max(1);
    }
    spans
}

fn number(index: usize) -> u32 {
    u32::try_from(index).unwrap_or(u32::MAX - 1)
}

/// All of some characters.
pub(crate) fn span(glyphs: &[Glyph], kind: SpanKind) -> Option<Span> {
    let (first, last) = (glyphs.first()?, glyphs.last()?);
    Some(Span {
        column: first.column,
        length: last.column - first.column + 1,
        kind,
    })
}

fn read(code: &[Glyph], spans: &mut Vec<Span>) {
    let (name, rest) = block::number(code);
    if name.is_some() {
        let digits = code.len() - rest.len();
        spans.extend(span(code.get(..digits).unwrap_or_default(), SpanKind::Number));
    }
    each_word(rest, spans, word);
}

/// Marks the words of a code, each taken by `word`; `None` of a character that is none.
pub(crate) fn each_word(
    code: &[Glyph],
    spans: &mut Vec<Span>,
    word: impl Fn(&mut Cursor) -> Option<SpanKind>,
) {
    let mut cursor = Cursor::new(code);
    while !cursor.is_done() {
        let mark = cursor.mark();
        if let Some(kind) = word(&mut cursor) {
            let (column, length) = cursor.span(mark);
            spans.push(Span { column, length, kind });
        }
        if cursor.mark() == mark {
            cursor.advance(1);
        }
    }
}

/// Takes a word and says what it is; `None` of a character that is none.
fn word(cursor: &mut Cursor) -> Option<SpanKind> {
    match cursor.peek()? {
        '#' | '$' => {
            cursor.advance(1);
            let mut end = cursor.mark();
            while !cursor
                .take_while(|c| c.is_ascii_alphabetic() || c == '_')
                .is_empty()
            {
                end = cursor.mark();
                cursor.skip_blanks();
            }
            cursor.go_to(end);
            Some(SpanKind::Command)
        }
        quote @ ('"' | '\'') => {
            cursor.advance(1);
            cursor.take_while(|c| c != quote);
            cursor.advance(1);
            Some(SpanKind::Text)
        }
        '0'..='9' | '.' => {
            cursor.take_while(|c| c.is_ascii_digit() || c == '.');
            Some(SpanKind::Value)
        }
        _ if variable_begins(cursor) => {
            cursor.take_while(|c| c.is_alphanumeric() || matches!(c, '_' | '.' | '[' | ']'));
            Some(SpanKind::Variable)
        }
        letter if letter.is_ascii_alphabetic() => Some(address(cursor, letter)),
        _ => None,
    }
}

fn address(cursor: &mut Cursor, letter: char) -> SpanKind {
    let letters = cursor.letters();
    if is_function(&letters) {
        cursor.advance(letters.len());
        return SpanKind::Calculation;
    }
    // `XP1` and `XV.G.RW` are an address and what its value is read from.
    let glued = letters.len() == 2 && letters.ends_with(['P', 'V']);
    cursor.advance(if glued { 1 } else { letters.len() });
    if letters.len() > 1 {
        return SpanKind::Address;
    }
    match letter {
        'G' | 'M' | 'H' => {
            cursor.take_while(|c| c.is_ascii_digit());
            SpanKind::Function
        }
        'P' => {
            cursor.take_while(|c| c.is_ascii_digit());
            SpanKind::Variable
        }
        _ => SpanKind::Address,
    }
}
