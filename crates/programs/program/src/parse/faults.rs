//! All that is wrong with a block: the word at a fault is taken out, and the rest is read again.

use std::ops::Range;

use super::cursor::{Cursor, Fault};
use super::words::block_words;
use super::{complete_operation, decoration_only, located, prefix, read_block};
use crate::language::{WordKind, WordSpan};
use crate::lines::BlockText;
use crate::text::is_blank;
use crate::{Block, BlockError, Operation};

/// Most faults of one block that are named.
const FAULTS_MAX: usize = 16;

/// The faults of a block in the order in which they are found. What is only missing because another word is
/// wrong is no fault of its own.
pub(crate) fn faults(text: BlockText<'_>, may_begin: bool) -> Vec<BlockError> {
    // Lines joined with `~` are parameters of later cycles: half of them would be another cycle.
    if text.joined {
        let mut block = Block::EMPTY;
        read_block(text, may_begin, &mut block);
        return match block.operation {
            Operation::Invalid(invalid) => vec![invalid.error],
            _ => Vec::new(),
        };
    }
    language_faults(text.bytes, &block_words(text), |line| {
        let mut c = Cursor::new(line);
        prefix(&mut c);
        let start = c.position();
        if decoration_only(&mut c).is_some() {
            return None;
        }
        let fault = complete_operation(&mut c, may_begin).err()?;
        Some((start, fault))
    })
}

/// The faults of a line of any language, which says what is wrong first, and where the code begins.
pub(crate) fn language_faults(
    text: &[u8],
    words: &[WordSpan],
    first: impl Fn(&[u8]) -> Option<(usize, Box<Fault>)>,
) -> Vec<BlockError> {
    let mut line = text.to_vec();
    let mut found = Vec::new();
    let mut taken: Vec<Range<usize>> = Vec::new();
    while found.len() < FAULTS_MAX {
        let Some((code_start, fault)) = first(&line) else {
            break;
        };
        let end = fault.end.min(line.len());
        let start = fault.start.min(end);
        // What lies over the opening words or where a word was taken out is a follow-up.
        let opens = |word: &&WordSpan| matches!(word.kind, WordKind::Function | WordKind::Number);
        let front = words.iter().take_while(opens).map(|word| word.span.end).max();
        let covered = line.get(start..end).unwrap_or_default();
        let is_new = start >= front.unwrap_or_default() && covered.iter().any(|&byte| !is_blank(byte));
        if !found.is_empty() && (!is_new || taken.iter().any(|out| start < out.end && out.start < end)) {
            break;
        }
        found.push(located(&fault, 0, text, start, end));
        let word = words
            .iter()
            .find(|word| word.span.start <= start && start < word.span.end);
        // Without what opens it the block would be another one.
        let Some(word) = word.filter(|word| !opens(word) && start > code_start) else {
            break;
        };
        let out = word.span.start..end.max(word.span.end);
        match line.get_mut(out.clone()) {
            Some(word) => word.fill(b' '),
            None => break,
        }
        taken.push(out);
    }
    found
}

#[cfg(test)]
mod tests {
    use super::*;
    use bahn_parameters::MessageId::{self, *};

    /// Message and covered text of each fault.
    fn all(text: &str) -> Vec<(MessageId, &str)> {
        let block = BlockText {
            bytes: text.as_bytes(),
            joined: text.contains('\n'),
        };
        let covered = |fault: &BlockError| {
            let start = fault.column as usize - 1;
            &text[start..start + fault.length as usize]
        };
        let found = faults(block, false);
        found
            .iter()
            .map(|fault| (fault.message, covered(fault)))
            .collect()
    }

    #[test]
    fn each_wrong_word_is_a_fault() {
        assert_eq!(all("L X+10 Y+5 R0 FMAX"), []);
        assert_eq!(
            all("12 L X+1..5 FOO Y+2 Y+3 M3 ; c"),
            [
                (EntryValueIncorrect, "+1..5"),
                (BlockNotKnown, "FOO"),
                (AxisDoubleProgrammed, "Y+3"),
            ]
        );
        assert_eq!(all("; L X+1..5"), []);
    }

    #[test]
    fn follow_ups_are_no_faults() {
        // Without its radius RND is incomplete, but that is not what is wrong.
        assert_eq!(all("RND R1..2"), [(EntryValueIncorrect, "1..2")]);
        assert_eq!(all("FOO X+1..2"), [(BlockNotKnown, "FOO")]);
        assert_eq!(all("L X+1 ~\nYnan Z1..2").len(), 1);
    }
}
