//! First and last block of a program: they have its name, so they change with it.

use std::ops::Range;

use bahn_program::{IsoLanguage, Language, Operation};

/// The text of a new file: a program has its frame, a table its columns.
pub fn new_file(name: &str, inch: bool) -> String {
    let (stem, ending) = name.rsplit_once('.').unwrap_or((name, ""));
    let unit = if inch { "INCH" } else { "MM" };
    match ending.to_ascii_uppercase().as_str() {
        "H" => format!("BEGIN PGM {stem} {unit}\nEND PGM {stem} {unit}\n"),
        "I" => {
            let unit = if inch { "G70" } else { "G71" };
            format!("%{stem} {unit} *\nN99999 %{stem} {unit} *\n")
        }
        "D" => "NR\tX\tY\tZ\t4\t5\tDOC\n0\t0\t0\t0\t0\t0\t\n".to_owned(),
        "P" => "NR\tPGM\tDATUM\tDOC\n".to_owned(),
        "PNT" => "NR\tX\tY\tZ\tDOC\n".to_owned(),
        "T" => "T\tNAME\tL\tR\tR2\tDL\tDR\tDR2\tTL\tRT\tTIME1\tTIME2\tCUR.TIME\tDOC\n".to_owned(),
        _ => String::new(),
    }
}

/// The unit of a file's lengths is asked for.
pub fn has_unit(name: &str) -> bool {
    let name = name.to_ascii_uppercase();
    name.ends_with(".H") || name.ends_with(".I")
}

/// The text of a program under another name.
pub fn renamed(text: &[u8], name: &str) -> Vec<u8> {
    let stem = name.rsplit_once('.').map_or(name, |(stem, _)| stem);
    let is_iso = name.to_ascii_uppercase().ends_with(".I");
    let mut new = Vec::with_capacity(text.len());
    let mut begun = false;
    for line in text.split_inclusive(|byte| *byte == b'\n') {
        let place = match is_iso {
            true => iso_frame_name(line, begun),
            false => frame_name(line),
        };
        begun |= place.is_some();
        match place {
            Some(at) => {
                new.extend_from_slice(line.get(..at.start).unwrap_or_default());
                new.extend_from_slice(stem.as_bytes());
                new.extend_from_slice(line.get(at.end..).unwrap_or_default());
            }
            None => new.extend_from_slice(line),
        }
    }
    new
}

/// Where the name stands in a first or last block.
fn frame_name(line: &[u8]) -> Option<Range<usize>> {
    let number = line
        .iter()
        .take_while(|byte| byte.is_ascii_digit() || **byte == b' ')
        .count();
    let rest = line.get(number..)?;
    let before = [&b"BEGIN PGM "[..], b"END PGM "]
        .into_iter()
        .find(|word| rest.starts_with(word))?
        .len();
    name_at(line, number + before)
}

/// The same in DIN/ISO, where a program is called by its name, too: those of the frame have a unit after it.
fn iso_frame_name(line: &[u8], begun: bool) -> Option<Range<usize>> {
    let text = String::from_utf8_lossy(line);
    let read = IsoLanguage.parse_block(&text).block.operation;
    if !matches!(read, Operation::Begin(_)) && (begun || !matches!(read, Operation::CallProgram(_))) {
        return None;
    }
    let percent = line.iter().position(|byte| *byte == b'%')?;
    let blanks = line
        .get(percent + 1..)?
        .iter()
        .take_while(|byte| **byte == b' ')
        .count();
    name_at(line, percent + 1 + blanks)
}

/// The name that begins at a place.
fn name_at(line: &[u8], start: usize) -> Option<Range<usize>> {
    let length = line
        .get(start..)?
        .iter()
        .take_while(|byte| !byte.is_ascii_whitespace() && **byte != b'*')
        .count();
    (length > 0).then_some(start..start + length)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_program_knows_its_new_name() {
        for (text, expected) in [
            (
                "BEGIN PGM 1 MM\nL X+1\nEND PGM 1 MM\n",
                "BEGIN PGM 2A MM\nL X+1\nEND PGM 2A MM\n",
            ),
            (
                "0 BEGIN PGM OLD INCH P\r\n1 ; END PGM OLD\r\n2 END PGM OLD INCH P",
                "0 BEGIN PGM 2A INCH P\r\n1 ; END PGM OLD\r\n2 END PGM 2A INCH P",
            ),
            (
                // A program that is called keeps its name.
                "%7 G71 *\nN10 %8 *\nN20 G00 X+1 *\nN99 % 7 G71*\n",
                "%2A G71 *\nN10 %8 *\nN20 G00 X+1 *\nN99 % 2A G71*\n",
            ),
        ] {
            let name = if text.starts_with('%') { "2A.I" } else { "2A.H" };
            assert_eq!(String::from_utf8_lossy(&renamed(text.as_bytes(), name)), expected);
        }
        assert_eq!(new_file("2A.H", true), "BEGIN PGM 2A INCH\nEND PGM 2A INCH\n");
    }

    #[test]
    fn new_tables_are_tables() {
        use bahn_host::TableForm;
        for form in TableForm::ALL {
            let name = format!("NEW.{}", form.ending());
            let text = new_file(&name, false);
            assert!(text.is_empty() || form.check(&text).is_ok(), "{name}");
        }
    }
}
