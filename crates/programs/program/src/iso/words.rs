//! Where the words of an ISO block stand, whether it can be read or not.

use super::code::split;
use crate::language::{WordKind, WordSpan};
use crate::text::is_blank;

/// Where the words of a block stand, in their order.
pub(super) fn block_words(line: &[u8]) -> Vec<WordSpan> {
    let (code, comment) = split(line);
    let mut words = Vec::new();
    let mut at = 0;
    let mut front = true;
    while let Some(&byte) = code.get(at) {
        if is_blank(byte) {
            at += 1;
            continue;
        }
        let (kind, address, length) = word(code.get(at..).unwrap_or_default(), front);
        front &= matches!(kind, WordKind::Number | WordKind::Skip);
        words.push(WordSpan {
            kind,
            span: at..at + length,
            value: at + address.min(length)..at + length,
        });
        at += length;
    }
    if !comment.is_empty() {
        let start = line.len() - comment.len();
        words.push(WordSpan {
            kind: WordKind::Comment,
            span: start..line.len(),
            value: start..line.len(),
        });
    }
    words
}

/// Kind of the word at the front of a text, length of its address, and of all of it.
fn word(text: &[u8], front: bool) -> (WordKind, usize, usize) {
    let digits = |from: usize| text.iter().skip(from).take_while(|b| b.is_ascii_digit()).count();
    let letter = text.first().map_or(b' ', u8::to_ascii_uppercase);
    let next = text.get(1).copied().unwrap_or(b' ');
    match letter {
        b'/' if front => (WordKind::Skip, 1, 1),
        b'N' if front && next.is_ascii_digit() => (WordKind::Number, 1, 1 + digits(1)),
        b'0'..=b'9' if front => (WordKind::Number, 0, digits(0)),
        b'%' => (WordKind::Function, 1, text.len()),
        b'G' => (WordKind::Function, 1, (1 + digits(1)).max(1)),
        b'D' if next.is_ascii_digit() => (WordKind::Function, 1, 1 + digits(1)),
        b'P' if next.is_ascii_digit() => {
            let address = 1 + digits(1).min(2);
            (WordKind::Address, address, address + after(text, address))
        }
        b'A'..=b'Z' => {
            let address = text.iter().take_while(|b| b.is_ascii_alphabetic()).count();
            // The last letter of several may belong to a Q parameter: `FQ5`.
            let address = match text.get(address - 1) {
                Some(b'Q' | b'q') if address > 1 => address - 1,
                _ => address,
            };
            (WordKind::Address, address, address + after(text, address))
        }
        _ => {
            let length = text.iter().take_while(|b| !is_blank(**b)).count();
            (WordKind::Value, 0, length.max(1))
        }
    }
}

/// Length of the value after an address, with blanks before it.
fn after(text: &[u8], address: usize) -> usize {
    let rest = text.get(address..).unwrap_or_default();
    let blanks = rest.iter().take_while(|b| is_blank(**b)).count();
    let value = rest.get(blanks..).unwrap_or_default();
    let of_value = |b: u8| b.is_ascii_digit() || matches!(b, b'+' | b'-' | b'.' | b',' | b'=' | b'Q' | b'q');
    let length = value.iter().take_while(|b| of_value(**b)).count();
    if length == 0 { 0 } else { blanks + length }
}
