//! The text of files as it goes over a line: lines without their ends, and what first and last lines say.

use std::io::{self, BufRead, BufReader, Read, Write};

use crate::files::NewFile;
use crate::{Characters, FileType};
use bahn_store::StoreError;

/// Bytes of a line at most; a longer one goes as several. Blocks have 150 characters at most [000:615], lines of tables more.
pub(crate) const LINE_MAX: usize = 1000;

/// What the first line of a file says of it.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(crate) struct Beginning {
    /// Name of the file, without extension.
    pub name: String,
    /// Type of file, when the line names it.
    pub kind: Option<FileType>,
}

/// Reads a first line: `0 BEGIN PGM 15 MM`, `%15 G71`, `BEGIN 15 .T MM`.
pub(crate) fn beginning(line: &[u8]) -> Option<Beginning> {
    let line = std::str::from_utf8(line).ok()?.trim();
    if let Some(rest) = line.strip_prefix('%') {
        let name = rest.split_whitespace().next().unwrap_or_default();
        return of_name(name, FileType::of_extension("I"));
    }
    let mut words = line
        .trim_start_matches(|c: char| c.is_ascii_digit())
        .split_whitespace();
    if words.next() != Some("BEGIN") {
        return None;
    }
    match words.next()? {
        "PGM" => of_name(words.next()?, FileType::of_extension("H")),
        name => {
            let (stem, kind) = name.split_once('.').unwrap_or((name, ""));
            let after = words.next().and_then(|word| word.strip_prefix('.'));
            of_name(stem, FileType::of_extension(after.unwrap_or(kind)))
        }
    }
}

fn of_name(name: &str, kind: Option<FileType>) -> Option<Beginning> {
    is_name(name.as_bytes()).then(|| Beginning {
        name: name.to_ascii_uppercase(),
        kind,
    })
}

/// Whether a line is the last one of a program: `9 END PGM 15 MM`, `N9999 %15 G71`.
pub(crate) fn is_end(line: &[u8]) -> bool {
    let Ok(line) = std::str::from_utf8(line) else {
        return false;
    };
    let line = line.trim();
    let mut words = line
        .trim_start_matches(|c: char| c.is_ascii_digit())
        .split_whitespace();
    let is_plain = (words.next(), words.next()) == (Some("END"), Some("PGM"));
    let iso = line.strip_prefix('N').map(|rest| {
        rest.trim_start_matches(|c: char| c.is_ascii_digit())
            .trim_start()
            .starts_with('%')
    });
    is_plain || iso == Some(true)
}

/// Whether this is a name: 1 to 16 letters, digits and `$ _ # -` [000:6847-6853] [000:17482].
pub(crate) fn is_name(name: &[u8]) -> bool {
    (1..=16).contains(&name.len())
        && name
            .iter()
            .all(|byte| byte.is_ascii_alphanumeric() || b"$_#-".contains(byte))
}

/// A file that is being sent, line by line.
pub(crate) struct Source {
    lines: BufReader<Box<dyn Read + Send>>,
    characters: Characters,
    decimal_comma: bool,
}

impl Source {
    pub fn new(file: Box<dyn Read + Send>, characters: Characters, decimal_comma: bool) -> Source {
        Source {
            lines: BufReader::new(file),
            characters,
            decimal_comma,
        }
    }

    /// The next line as it goes over the line: without its end and without control characters; what seven bits do not hold
    /// is a question mark.
    pub fn next(&mut self) -> io::Result<Option<Vec<u8>>> {
        let mut line = Vec::new();
        let read = (&mut self.lines)
            .take(LINE_MAX as u64)
            .read_until(b'\n', &mut line)?;
        if read == 0 {
            return Ok(None);
        }
        while matches!(line.last(), Some(b'\n' | b'\r' | 0x0C)) {
            line.pop();
        }
        for byte in &mut line {
            let fits = *byte == b'\t' || (*byte >= b' ' && *byte != 0x7F);
            if !fits || self.characters.mask(*byte) != *byte {
                *byte = b'?';
            }
        }
        if self.decimal_comma {
            with_comma(&mut line);
        }
        Ok(Some(line))
    }
}

/// Decimal points of the words of a block become commas, those of comments and of `BLK FORM 0.1` stay [001:1923].
fn with_comma(line: &mut [u8]) {
    let comment = line.iter().position(|byte| *byte == b';').unwrap_or(line.len());
    for at in 1..comment {
        let is_point = line.get(at) == Some(&b'.');
        let before = line.get(..at).unwrap_or_default();
        let digits = before
            .iter()
            .rev()
            .take_while(|byte| byte.is_ascii_digit())
            .count();
        let word = before.iter().rev().nth(digits);
        let of_word = word.is_some_and(|byte| byte.is_ascii_alphabetic() || b"+-".contains(byte));
        if is_point && digits > 0 && of_word && line.get(at + 1).is_some_and(u8::is_ascii_digit) {
            line[at] = b',';
        }
    }
}

/// A file that is being received, line by line.
pub(crate) struct Taking {
    pub name: String,
    file: Box<dyn NewFile>,
    /// It is a program: it begins with its BEGIN block and is whole with its END block only.
    is_program: bool,
    begun: bool,
    ended: bool,
}

/// Why a file is not stored.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(crate) enum Unstored {
    /// The program has no END block.
    Incomplete,
    /// The medium does not take it.
    Store(StoreError),
}

impl Taking {
    pub fn new(name: &str, file: Box<dyn NewFile>) -> Taking {
        let extension = name.rsplit_once('.').map_or("", |(_, extension)| extension);
        Taking {
            name: name.to_owned(),
            file,
            is_program: ["H", "I"].iter().any(|of| of.eq_ignore_ascii_case(extension)),
            begun: false,
            ended: false,
        }
    }

    /// Takes a line. Comments before a program are not stored [000:17188].
    pub fn line(&mut self, line: &[u8]) -> Result<(), Unstored> {
        if self.is_program {
            self.begun |= beginning(line).is_some();
            if !self.begun || self.ended {
                return Ok(());
            }
            self.ended = is_end(line);
        }
        let written = self
            .file
            .write_all(line)
            .and_then(|()| self.file.write_all(b"\n"));
        written.map_err(|error| {
            Unstored::Store(match error.kind() {
                io::ErrorKind::StorageFull | io::ErrorKind::FileTooLarge => StoreError::DiskFull,
                _ => StoreError::Medium(error.to_string()),
            })
        })
    }

    /// Whether its END block is there, so that nothing follows.
    pub fn is_ended(&self) -> bool {
        self.ended
    }

    /// Stores the file, whole, under its name.
    pub fn commit(self) -> Result<(), Unstored> {
        if self.is_program && !self.ended {
            return Err(Unstored::Incomplete);
        }
        self.file.commit().map_err(Unstored::Store)
    }
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used, reason = "a test may fail")]
    use super::*;

    #[test]
    fn first_and_last_lines() {
        for (line, name, extension) in [
            ("0 BEGIN PGM 1 MM", "1", "H"),
            ("BEGIN PGM bracket INCH", "BRACKET", "H"),
            ("%100 G71 *", "100", "I"),
            ("BEGIN TOOL .T MM", "TOOL", "T"),
            ("BEGIN PAL.P", "PAL", "P"),
        ] {
            let expected = Beginning {
                name: name.into(),
                kind: FileType::of_extension(extension),
            };
            assert_eq!(beginning(line.as_bytes()), Some(expected), "{line}");
        }
        for line in [
            "",
            "1 L X+1",
            "BEGIN",
            "0 BEGIN PGM",
            "0 BEGIN PGM A/B MM",
            "; BEGIN PGM 1 MM",
        ] {
            assert_eq!(beginning(line.as_bytes()), None, "{line}");
        }
        for line in [
            "26 END PGM 1 MM",
            "END PGM 1 MM",
            "N99999 %1 G71 *",
            "N99999%1 G71",
        ] {
            assert!(is_end(line.as_bytes()), "{line}");
        }
        for line in ["%1 G71", "N10 G0", "END", "0 BEGIN PGM END MM", "1 END"] {
            assert!(!is_end(line.as_bytes()), "{line}");
        }
    }

    #[test]
    fn lines_as_they_go() {
        let source = |text: &[u8], data_bits, comma| {
            let characters = Characters {
                data_bits,
                ..Characters::FIXED
            };
            let mut source = Source::new(Box::new(io::Cursor::new(text.to_vec())), characters, comma);
            std::iter::from_fn(move || source.next().unwrap()).collect::<Vec<_>>()
        };
        assert_eq!(
            source(b"1\r\n\n\x02\t\xE4\n3", 7, false),
            [&b"1"[..], b"", b"?\t?", b"3"]
        );
        assert_eq!(source(b"\xE4\n", 8, false), [b"\xE4"]);
        assert_eq!(
            source(&[b'A'; 1500], 7, false)
                .iter()
                .map(Vec::len)
                .collect::<Vec<_>>(),
            [1000, 500]
        );
        let block = b"1 BLK FORM 0.1 Z X+0.5 Y-12.25 F1.5 ; 0.5 X+1.5\n";
        assert_eq!(
            source(block, 7, true),
            [b"1 BLK FORM 0.1 Z X+0,5 Y-12,25 F1,5 ; 0.5 X+1.5"]
        );
    }
}
