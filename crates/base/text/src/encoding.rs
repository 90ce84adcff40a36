//! How the bytes of a file are its text.
//!
//! Decision: A file is UTF-16 where a byte order mark or the zero bytes of its first letters say so, UTF-8 where all
//! of it is, else Latin-1: one rule for programs, tables, lists, scripts, descriptions and PLC sources, since editors
//! and controls write any of them. What is edited is written as it was read

use std::borrow::Cow;

/// The byte order mark.
pub const MARK: char = '\u{feff}';

/// The byte order mark as UTF-8 writes it.
pub const MARK_BYTES: &[u8] = b"\xef\xbb\xbf";

/// What the bytes of a file are written in.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Charset {
    Utf8,
    /// One character for each byte, which loses nothing whatever the code page was.
    Latin1,
    /// The byte of lower value is the first of two.
    Utf16Low,
    Utf16High,
}

/// How a file is written, so that it can be written so again.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Encoding {
    charset: Charset,
    has_mark: bool,
}

impl Encoding {
    /// The text of a file without its byte order mark, and how it is written: UTF-16 where a mark or the zero bytes of
    /// its first letters say so, UTF-8 where all of it is, else Latin-1, the alphabet of the control's own files.
    ///
    /// ```
    /// use bahn_text::Encoding;
    /// let (text, encoding) = Encoding::read(b"; T\xfcr");
    /// assert_eq!(text, "; T\u{fc}r");
    /// assert_eq!(encoding.write("; H\u{f6}he"), b"; H\xf6he");
    /// ```
    pub fn read(bytes: &[u8]) -> (String, Encoding) {
        let (charset, text) = match (utf16_order(bytes), std::str::from_utf8(bytes)) {
            (Some(charset), _) => (charset, from_utf16(bytes, charset)),
            (None, Ok(text)) => (Charset::Utf8, text.to_owned()),
            (None, Err(_)) => {
                let own = bytes.strip_prefix(MARK_BYTES);
                let text = latin(own.unwrap_or(bytes));
                let has_mark = own.is_some();
                let charset = Charset::Latin1;
                return (text, Encoding { charset, has_mark });
            }
        };
        let (text, has_mark) = match text.strip_prefix(MARK) {
            Some(own) => (own.to_owned(), true),
            None => (text, false),
        };
        (text, Encoding { charset, has_mark })
    }

    /// A text in the bytes of such a file; what Latin-1 does not have becomes `?`.
    pub fn write(self, text: &str) -> Vec<u8> {
        let mark = [MARK].into_iter().filter(|_| self.has_mark);
        match self.charset {
            Charset::Latin1 => {
                let mut bytes = if self.has_mark {
                    MARK_BYTES.to_vec()
                } else {
                    Vec::new()
                };
                bytes.extend(text.chars().map(|c| u8::try_from(c).unwrap_or(b'?')));
                bytes
            }
            Charset::Utf8 => mark.chain(text.chars()).collect::<String>().into_bytes(),
            Charset::Utf16Low => utf16(mark, text).flat_map(u16::to_le_bytes).collect(),
            Charset::Utf16High => utf16(mark, text).flat_map(u16::to_be_bytes).collect(),
        }
    }
}

/// The text of a file, as [`Encoding::read`] finds it.
pub fn decode(bytes: &[u8]) -> String {
    Encoding::read(bytes).0
}

/// A text without the byte order mark in front of it.
pub fn without_mark(text: &str) -> &str {
    text.strip_prefix(MARK).unwrap_or(text)
}

/// Text of a part of a file: UTF-8 where the bytes are, else Latin-1.
pub fn utf8_or_latin(bytes: &[u8]) -> Cow<'_, str> {
    match std::str::from_utf8(bytes) {
        Ok(text) => Cow::Borrowed(text),
        Err(_) => Cow::Owned(latin(bytes)),
    }
}

/// A file in UTF-16 as UTF-8; any other file stays as it is.
pub fn as_utf8(bytes: Vec<u8>) -> Vec<u8> {
    match utf16_order(&bytes) {
        Some(charset) => {
            let text = from_utf16(&bytes, charset);
            without_mark(&text).as_bytes().to_vec()
        }
        None => bytes,
    }
}

fn latin(bytes: &[u8]) -> String {
    bytes.iter().copied().map(char::from).collect()
}

/// A byte order mark, or a first line of letters of which each second byte is zero.
fn utf16_order(bytes: &[u8]) -> Option<Charset> {
    match bytes {
        [0xff, 0xfe, ..] => Some(Charset::Utf16Low),
        [0xfe, 0xff, ..] => Some(Charset::Utf16High),
        [a, 0, b, 0, ..] if *a != 0 && *b != 0 => Some(Charset::Utf16Low),
        [0, a, 0, b, ..] if *a != 0 && *b != 0 => Some(Charset::Utf16High),
        _ => None,
    }
}

fn from_utf16(bytes: &[u8], charset: Charset) -> String {
    let units = bytes.chunks(2).map(|pair| {
        // A file that was cut off may end within a unit.
        let pair = [
            pair.first().copied().unwrap_or(0),
            pair.get(1).copied().unwrap_or(0),
        ];
        match charset {
            Charset::Utf16High => u16::from_be_bytes(pair),
            _ => u16::from_le_bytes(pair),
        }
    });
    let characters = char::decode_utf16(units);
    characters
        .map(|c| c.unwrap_or(char::REPLACEMENT_CHARACTER))
        .collect()
}

fn utf16(mark: impl Iterator<Item = char>, text: &str) -> impl Iterator<Item = u16> {
    mark.chain(text.chars()).flat_map(|c| {
        let mut units = [0; 2];
        let length = c.encode_utf16(&mut units).len();
        units.into_iter().take(length)
    })
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    /// Files of editors that save UTF-16, with and without byte order mark, and of the control.
    #[test]
    fn text_is_read_whatever_saved_it() {
        let text = "L I4 ;Tür\n= O2\n";
        let low: Vec<u8> = text.encode_utf16().flat_map(u16::to_le_bytes).collect();
        let high: Vec<u8> = text.encode_utf16().flat_map(u16::to_be_bytes).collect();
        assert_eq!(decode(&low), text);
        assert_eq!(decode(&high), text);
        assert_eq!(decode(&[&[0xff, 0xfe], low.as_slice()].concat()), text);
        assert_eq!(decode(&[&[0xfe, 0xff], high.as_slice()].concat()), text);
        assert_eq!(decode(b"L I4 ;T\xfcr\n"), "L I4 ;Tür\n");
        assert_eq!(decode(b"\xef\xbb\xbfEM\n"), "EM\n");
        assert_eq!(decode(b"\xef\xbb\xbfT\xfcr\n"), "Tür\n", "a mark before Latin-1");
        assert_eq!(decode(b"\xff\xfe\x00\xd8"), "\u{fffd}", "half a character");
        assert_eq!(decode(b"\xff\xfeL\0X"), "LX", "half a unit");
    }

    #[test]
    fn a_part_program_in_utf16_becomes_utf8() {
        assert_eq!(as_utf8(b"\xff\xfeL\0 \0X\x001\0".to_vec()), b"L X1");
        assert_eq!(as_utf8(b"\xfe\xff\0L\0\xf6".to_vec()), "Lö".as_bytes());
        assert_eq!(as_utf8(b"L X1\xf6".to_vec()), b"L X1\xf6");
        assert_eq!(utf8_or_latin(b"H\xf6he"), "Höhe");
    }

    proptest! {
        /// What is written as it was read is the file again: any bytes of single ones, texts in UTF-16.
        #[test]
        fn what_is_read_is_written_again(bytes in prop::collection::vec(1..=255_u8, 0..40)) {
            let is_utf16 = utf16_order(&bytes).is_some();
            let (text, encoding) = Encoding::read(&bytes);
            prop_assert!(is_utf16 || encoding.write(&text) == bytes);
        }

        #[test]
        fn utf16_is_written_again(text in "[aä𝄞\r\n ]{0,40}", high: bool) {
            let marked: String = [MARK].into_iter().chain(text.chars()).collect();
            let order = if high { u16::to_be_bytes } else { u16::to_le_bytes };
            let bytes: Vec<u8> = marked.encode_utf16().flat_map(order).collect();
            let (read, encoding) = Encoding::read(&bytes);
            prop_assert_eq!(&read, &text);
            prop_assert_eq!(encoding.write(&read), bytes);
        }
    }
}
