//! Where the words of a plain-language block stand, whether it can be read or not.

use super::cursor::Cursor;
use crate::language::{WordKind, WordSpan};
use crate::lines::{BlockText, Lines};
use crate::text::{is_blank, trim_continuation};

/// How a block opens, longer forms first, and what follows.
const FUNCTIONS: &[(&[&str], After)] = &[
    (&["BEGIN", "PGM"], After::Name),
    (&["BLK", "FORM"], After::Number),
    (&["CALL", "LBL"], After::Words),
    (&["CALL", "PGM"], After::Name),
    (&["CHF"], After::Words),
    (&["CYCLE", "CALL"], After::Words),
    (&["CYCLE", "DEF"], After::Number),
    (&["CYCL", "CALL"], After::Words),
    (&["CYCL", "DEF"], After::Number),
    (&["CC"], After::Path),
    (&["CR"], After::Path),
    (&["CTP"], After::Path),
    (&["CT"], After::Path),
    (&["CP"], After::Path),
    (&["C"], After::Path),
    (&["DLG-CALL"], After::Words),
    (&["DLG-DEF"], After::Words),
    (&["END", "PGM"], After::Name),
    (&["ERROR"], After::Name),
    (&["FN"], After::Number),
    (&["LBL"], After::Words),
    (&["LP"], After::Path),
    (&["L"], After::Path),
    (&["RND"], After::Path),
    (&["STOP"], After::Words),
    (&["TCH", "PROBE"], After::Number),
    (&["TOOL", "CALL"], After::Path),
    (&["TOOL", "DEF"], After::Path),
    (&["TOUCH", "PROBE"], After::Number),
];

/// Words of positioning and tool blocks, which may touch each other: `RLFMAXM3`; longer ones first.
const TOUCHING: &[&str] = &["FMAX", "IPR", "IPA", "PR", "PA", "DL", "DR", "RL", "RR"];

/// What follows the words that open a block.
#[derive(Clone, Copy, PartialEq, Eq)]
enum After {
    /// A number `n.m` that belongs to them, then words.
    Number,
    /// A name up to the end.
    Name,
    /// Words that may touch each other.
    Path,
    /// Words, each after a blank.
    Words,
}

/// Where the words of a block stand, in their order.
pub(crate) fn block_words(text: BlockText<'_>) -> Vec<WordSpan> {
    let mut walk = Walk {
        words: Vec::new(),
        offset: 0,
        after: After::Path,
    };
    let mut lines = Lines::new(text.bytes, 0);
    let mut is_comment = false;
    while let Some((start, end)) = lines.line() {
        let line = lines.bytes(start, end);
        let line = if text.joined {
            trim_continuation(line)
        } else {
            line
        };
        let mut c = Cursor::new(line);
        walk.offset = start;
        if start == 0 {
            walk.front(&mut c);
            is_comment = matches!(c.peek(), b';' | b'*');
        }
        if is_comment {
            c.skip_blanks();
            walk.rest(&mut c, WordKind::Comment);
        } else {
            walk.line(&mut c);
        }
    }
    walk.words
}

struct Walk {
    words: Vec<WordSpan>,
    /// Where the line begins in the block.
    offset: usize,
    after: After,
}

impl Walk {
    fn push(&mut self, kind: WordKind, start: usize, value: usize, end: usize) {
        if start < end {
            self.words.push(WordSpan {
                kind,
                span: self.offset + start..self.offset + end,
                value: self.offset + value..self.offset + end,
            });
        }
    }

    /// Block number and `/` in either order, and what opens the block.
    fn front(&mut self, c: &mut Cursor) {
        for _ in 0..3 {
            c.skip_blanks();
            let start = c.position();
            if c.peek() == b'/' {
                c.advance(1);
                self.push(WordKind::Skip, start, start + 1, start + 1);
                continue;
            }
            let named = c.peek_upper() == b'N' && c.peek_at(1).is_ascii_digit();
            c.advance(usize::from(named));
            let value = c.position();
            while c.peek().is_ascii_digit() {
                c.advance(1);
            }
            self.push(WordKind::Number, start, value, c.position());
        }
        c.skip_blanks();
        let start = c.position();
        let opens = |c: &mut Cursor, words: &[&str]| {
            let found = words.iter().all(|word| c.keyword(word));
            if !found {
                c.go_to(start);
            }
            found
        };
        let Some((_, after)) = FUNCTIONS.iter().find(|(words, _)| opens(c, words)) else {
            return;
        };
        let before_number = c.position();
        let mut number = before_number;
        if *after == After::Number {
            c.skip_blanks();
            number = c.position();
            while matches!(c.peek(), b'0'..=b'9' | b'.' | b',') && !c.at_annotation() {
                c.advance(1);
            }
            if c.position() == number {
                c.go_to(before_number);
                number = before_number;
            }
        }
        self.after = *after;
        self.push(WordKind::Function, start, number, c.position());
    }

    fn line(&mut self, c: &mut Cursor) {
        while !c.at_end() {
            let start = c.position();
            if self.after == After::Name {
                let code = c.code();
                let length = code
                    .iter()
                    .rposition(|&b| !is_blank(b))
                    .map_or(0, |last| last + 1);
                self.push(WordKind::Text, start, start + length, start + length);
                continue;
            }
            if value(c) {
                self.push(WordKind::Value, start, start, c.position());
                continue;
            }
            let letters = self.letters(c);
            if letters == 0 {
                // Operators and separators are no words.
                c.advance(1);
                continue;
            }
            c.advance(letters);
            let end = c.position();
            c.skip_blanks();
            let value_start = c.position();
            let has_value = value(c) || self.is_sign(c, start, end);
            if has_value {
                self.push(WordKind::Address, start, value_start, c.position());
            } else {
                c.go_to(end);
                let kind = match self.after {
                    After::Path => WordKind::Address,
                    _ => WordKind::Text,
                };
                self.push(kind, start, end, end);
            }
        }
        self.rest(c, WordKind::Comment);
    }

    /// Letters of the word at the position.
    fn letters(&self, c: &Cursor) -> usize {
        let rest = c.rest();
        let run = rest
            .iter()
            .take_while(|b| b.is_ascii_alphabetic() || **b >= 0x80)
            .count();
        if self.after != After::Path {
            return run;
        }
        let starts = |word: &&&str| {
            let front = rest.get(..word.len());
            front.is_some_and(|front| front.eq_ignore_ascii_case(word.as_bytes()))
        };
        if let Some(word) = TOUCHING.iter().find(starts) {
            return word.len();
        }
        run
    }

    /// Reads the sign of `R+`, `DR-` or `X-`.
    fn is_sign(&self, c: &mut Cursor, start: usize, end: usize) -> bool {
        let signed = matches!(c.peek(), b'+' | b'-') && c.position() == end && end - start <= 2;
        c.advance(usize::from(signed));
        signed
    }

    fn rest(&mut self, c: &mut Cursor, kind: WordKind) {
        let start = c.position();
        let rest = c.rest();
        let length = rest
            .iter()
            .rposition(|&b| !is_blank(b))
            .map_or(0, |last| last + 1);
        self.push(kind, start, start + length, start + length);
        c.advance(rest.len());
    }
}

/// Reads a number or Q parameter with its sign, rightly written or not; whether there was one.
fn value(c: &mut Cursor) -> bool {
    let start = c.position();
    if matches!(c.peek(), b'+' | b'-') {
        c.advance(1);
        c.skip_blanks();
    }
    if c.peek_upper() == b'Q' && c.peek_at(1).is_ascii_digit() {
        c.advance(1);
    }
    let digits = c.position();
    while matches!(c.peek(), b'0'..=b'9' | b'.' | b',') && !c.at_annotation() {
        c.advance(1);
    }
    let found = c.position() > digits;
    if !found {
        c.go_to(start);
    }
    found
}

#[cfg(test)]
mod tests {
    use super::*;
    use WordKind::{Address, Comment, Function, Number, Skip, Text, Value};

    /// Kind, word and value of each word.
    fn words(text: &str) -> Vec<(WordKind, &str, &str)> {
        let joined = text.contains('\n');
        let block = BlockText {
            bytes: text.as_bytes(),
            joined,
        };
        let found = block_words(block).into_iter();
        found
            .map(|word| (word.kind, &text[word.span], &text[word.value]))
            .collect()
    }

    #[test]
    fn positioning_blocks() {
        let all = [
            (Skip, "/", ""),
            (Number, "12", "12"),
            (Function, "L", ""),
            (Address, "X+10", "+10"),
            (Address, "IY -5,5", "-5,5"),
            (Address, "RL", ""),
            (Address, "F200", "200"),
            (Address, "M3", "3"),
            (Comment, "; up", ""),
        ];
        assert_eq!(words("/12 L X+10 IY -5,5 RL F200 M3 ; up "), all);
        let touching = [
            (Function, "L", ""),
            (Address, "X+Q1", "+Q1"),
            (Address, "Y-2", "-2"),
            (Address, "R0", "0"),
            (Address, "FMAX", ""),
            (Address, "M99", "99"),
        ];
        assert_eq!(words("LX+Q1Y-2R0FMAXM99"), touching);
        let polar = [
            (Number, "N7", "7"),
            (Function, "CP", ""),
            (Address, "IPA+90", "+90"),
            (Address, "DR+", "+"),
            (Address, "RR", ""),
        ];
        assert_eq!(words("N7 CP IPA+90 DR+ RR"), polar);
        let paraxial = [(Address, "X+50", "+50"), (Address, "R-", "-"), (Address, "F", "")];
        assert_eq!(words("X+50 R- F"), paraxial);
    }

    #[test]
    fn other_blocks() {
        let tool = [
            (Function, "TOOL CALL", ""),
            (Value, "5", "5"),
            (Address, "Z", ""),
            (Address, "S1000", "1000"),
            (Address, "DL-0.1", "-0.1"),
        ];
        assert_eq!(words("TOOL CALL 5 Z S1000 DL-0.1"), tool);
        let cycle = [
            (Function, "CYCL DEF 1.1", "1.1"),
            (Text, "SET", ""),
            (Address, "UP-2", "-2"),
        ];
        assert_eq!(words("CYCL DEF 1.1 SET UP-2"), cycle);
        let begin = [(Function, "BEGIN PGM", ""), (Text, "7432 MM", "")];
        assert_eq!(words("BEGIN PGM 7432 MM"), begin);
        let calculation = [
            (Function, "FN1", "1"),
            (Value, "Q5", "Q5"),
            (Value, "+Q2", "+Q2"),
            (Value, "-3", "-3"),
        ];
        assert_eq!(words("FN1: Q5 = +Q2 + -3"), calculation);
        assert_eq!(
            words("12 ; only this"),
            [(Number, "12", "12"), (Comment, "; only this", "")]
        );
        assert_eq!(words(""), []);
    }

    #[test]
    fn joined_lines() {
        let all = [
            (Function, "L", ""),
            (Address, "X+5", "+5"),
            (Comment, "; a", ""),
            (Address, "Y+6", "+6"),
        ];
        assert_eq!(words("L X+5 ; a ~\n  Y+6"), all);
        assert_eq!(words("; a ~\n b"), [(Comment, "; a", ""), (Comment, "b", "")]);
    }
}
