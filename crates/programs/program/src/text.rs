//! Characters of part-program files: blanks, line ends, words.
//!
//! Decision: A CR alone is a blank in a file that has more LF

use bahn_text::{MARK_BYTES, utf8_or_latin};

/// Whether a byte separates words: blank, tab and every other control character, so that NUL padding,
/// Ctrl-Z and ETX at the end of transferred files do no harm.
#[inline]
pub(crate) fn is_blank(byte: u8) -> bool {
    byte <= b' ' || byte == 0x7f
}

/// The bytes without blanks at both ends.
pub(crate) fn trim(bytes: &[u8]) -> &[u8] {
    let Some(start) = bytes.iter().position(|&b| !is_blank(b)) else {
        return &[];
    };
    let end = bytes
        .iter()
        .rposition(|&b| !is_blank(b))
        .map_or(start, |last| last + 1);
    bytes.get(start..end).unwrap_or_default()
}

/// The bytes without blanks and continuation marks at the end.
pub(crate) fn trim_continuation(bytes: &[u8]) -> &[u8] {
    let end = bytes
        .iter()
        .rposition(|&b| !is_blank(b) && b != b'~')
        .map_or(0, |last| last + 1);
    bytes.get(..end).unwrap_or_default()
}

/// Text of names and comments, which loses nothing whatever the code page was.
pub(crate) fn to_text(bytes: &[u8]) -> String {
    utf8_or_latin(bytes).into_owned()
}

/// Number of characters that [`to_text`] would give.
pub(crate) fn character_count(bytes: &[u8]) -> u32 {
    let count = std::str::from_utf8(bytes).map_or(bytes.len(), |text| text.chars().count());
    u32::try_from(count).unwrap_or(u32::MAX)
}

/// [`to_text`] with every run of blanks turned into one space and none at the ends, where a `~` would join
/// the next line.
pub(crate) fn to_words(bytes: &[u8]) -> Box<str> {
    let bytes = trim_continuation(bytes);
    let mut joined = Vec::with_capacity(bytes.len());
    for word in bytes.split(|&b| is_blank(b)).filter(|word| !word.is_empty()) {
        if !joined.is_empty() {
            joined.push(b' ');
        }
        joined.extend_from_slice(word);
    }
    to_text(&joined).into_boxed_str()
}

/// Makes a blank of every CR that stands alone in a file whose lines end otherwise: there it is no line end.
/// With as many of one as of the other nobody knows; both then end lines, and one kind of line end is left, so that
/// an edited file reads the same again. The line end of the file is returned.
pub(crate) fn settle_line_ends(file: &mut [u8]) -> &'static str {
    let lone = |file: &[u8], at: usize| file.get(at + 1) != Some(&b'\n');
    let feeds = memchr::memchr_iter(b'\n', file).count();
    let returns = memchr::memchr_iter(b'\r', file).filter(|&at| lone(file, at));
    let instead = if returns.take(feeds).count() < feeds {
        b' '
    } else {
        b'\n'
    };
    let mut from = 0;
    while feeds > 0
        && let Some(at) = memchr::memchr(b'\r', file.get(from..).unwrap_or_default())
    {
        from += at + 1;
        let is_lone = lone(file, from - 1);
        if let Some(byte) = file.get_mut(from - 1).filter(|_| is_lone) {
            *byte = instead;
        }
    }
    line_end_of(file)
}

/// What ends the first line of a text.
pub(crate) fn line_end_of(text: &[u8]) -> &'static str {
    match memchr::memchr2(b'\n', b'\r', text).map(|at| text.get(at..).unwrap_or_default()) {
        Some([b'\r', b'\n', ..]) => "\r\n",
        Some([b'\r', ..]) => "\r",
        _ => "\n",
    }
}

/// Where the text begins, after a byte-order mark.
pub(crate) fn text_start(file: &[u8]) -> usize {
    if file.starts_with(MARK_BYTES) {
        MARK_BYTES.len()
    } else {
        0
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn text_keeps_every_code_page() {
        assert_eq!(to_text("Höhe".as_bytes()), "Höhe");
        assert_eq!(to_text(b"H\xf6he"), "Höhe");
        assert_eq!(character_count("Höhe".as_bytes()), 4);
        assert_eq!(character_count(b"H\xf6he"), 4);
        assert_eq!(&*to_words(b"  PECK\t  DRILLING "), "PECK DRILLING");
    }

    #[test]
    fn ends_are_trimmed() {
        assert_eq!(trim(b" \t a b \x1a\0"), b"a b");
        assert_eq!(trim(b" \0 "), b"");
        assert_eq!(trim_continuation(b"Q200=2 ~ ~ "), b"Q200=2");
        assert_eq!(trim_continuation(b"~"), b"");
    }

    #[test]
    fn a_lone_return_among_other_line_ends_is_a_blank() {
        let blanked = |text: &str| {
            let mut file = text.as_bytes().to_vec();
            let line_end = settle_line_ends(&mut file);
            (String::from_utf8(file).unwrap(), line_end)
        };
        let settled = |text: &str, line_end| (text.to_owned(), line_end);
        assert_eq!(
            blanked("L X+1\rY+2\nL X+3\n"),
            settled("L X+1 Y+2\nL X+3\n", "\n")
        );
        assert_eq!(
            blanked("L X+1\r\r\nL X+3\r\n"),
            settled("L X+1 \r\nL X+3\r\n", "\r\n")
        );
        assert_eq!(blanked("A\rB\rC\r\n"), settled("A\nB\nC\r\n", "\n"));
        assert_eq!(blanked("A\rB\r"), settled("A\rB\r", "\r"));
    }
}
