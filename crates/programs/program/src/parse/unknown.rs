//! Blocks without the words that nothing here knows.

use bahn_parameters::MessageId::{BlockNotKnown, BlockNotSupported, UnexpectedText};

use super::complete_operation;
use super::cursor::Cursor;
use crate::{InvalidBlock, Operation};

/// Unknown words that are left out of one block; a block with more is passed over as a whole.
const WORDS_MAX: usize = 16;

impl InvalidBlock {
    /// Whether the block has a word that nothing here knows, or that has no place in it.
    pub fn is_unknown(&self) -> bool {
        matches!(
            self.error.message,
            BlockNotKnown | BlockNotSupported | UnexpectedText
        )
    }

    /// The block without its unknown words, and those words. Without an operation the whole block is to be
    /// passed over: its opening word is unknown, or what is left is no block.
    pub fn without_unknown_words(&self) -> (Option<Operation>, String) {
        let mut code = self.text.as_bytes().to_vec();
        let mut words: Vec<String> = Vec::new();
        // Lines joined with `~` are parameters of later cycles: half of them would be another cycle.
        while words.len() < WORDS_MAX && !code.contains(&b'\n') {
            let fault = match complete_operation(&mut Cursor::new(&code), false) {
                Ok(operation) => return (Some(operation), words.join(" ")),
                Err(fault) => fault,
            };
            let (start, end) = (fault.start, fault.end.min(code.len()));
            let is_unknown = matches!(fault.message, BlockNotKnown | BlockNotSupported | UnexpectedText);
            let Some(word) = code.get_mut(start..end).filter(|_| start > 0 && is_unknown) else {
                break;
            };
            words.push(String::from_utf8_lossy(word).trim().to_owned());
            word.fill(b' ');
        }
        (None, self.text.to_string())
    }
}

#[cfg(test)]
mod tests {
    use super::super::test::block;
    use super::*;

    fn read(text: &str) -> (Option<Operation>, String) {
        match block(text).operation {
            Operation::Invalid(invalid) => invalid.without_unknown_words(),
            operation => (Some(operation), String::new()),
        }
    }

    #[test]
    fn unknown_words_are_left_out() {
        let known = block("L X+10 Y+3 R0 F100 M3").operation;
        for (text, words) in [
            ("L X+10 FOO Y+3 R0 F100 M3", "FOO"),
            ("L X+10 Y+3 HUGO12 R0 F100 KEY M3 ;comment", "HUGO12 KEY"),
            ("L X+10 Y+3 R0 F100 M1001 M3", "M1001"),
        ] {
            assert_eq!(read(text), (Some(known.clone()), words.to_owned()), "{text}");
        }
    }

    #[test]
    fn unknown_blocks_are_passed_over() {
        for text in ["APPR LT X+10", "FL X+10 AN+30", "G0 X5 M3", "%1000 G71"] {
            assert_eq!(read(text), (None, text.to_owned()));
        }
        // Something else is wrong with it.
        assert_eq!(read("L FOO X+1..5").0, None);
    }
}
