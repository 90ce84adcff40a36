//! The word under the cursor.

use std::ops::Range;

/// The run of letters, digits and the given signs around a byte; nothing between words.
pub(crate) fn word_at(text: &str, offset: usize, signs: &str) -> Option<Range<usize>> {
    let is_word = |c: &char| c.is_alphanumeric() || signs.contains(*c);
    let before = text.get(..offset)?;
    let after = text.get(offset..)?;
    let start = offset
        - before
            .chars()
            .rev()
            .take_while(is_word)
            .map(char::len_utf8)
            .sum::<usize>();
    let end = offset
        + after
            .chars()
            .take_while(is_word)
            .map(char::len_utf8)
            .sum::<usize>();
    (start < end).then_some(start..end)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn words_reach_to_the_blanks_around_them() {
        let text = "L Türe=W260";
        let at = |offset| word_at(text, offset, "").map(|range| &text[range]);
        assert_eq!((at(3), at(text.len())), (Some("Türe"), Some("W260")));
        assert_eq!(word_at("a  b", 2, ""), None);
        assert_eq!(word_at("MP10.2", 1, "."), Some(0..6));
    }
}
