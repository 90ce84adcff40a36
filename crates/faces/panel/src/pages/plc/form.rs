//! How a line of a PLC program is set: in columns, as its editor does it, and without.
//!
//! Decision: A line of a PLC program that is left without an error has its operand in column 8 and its comment in
//! column 19 after its own blanks

/// Columns of operand and comment after the instruction [000:4155-4199].
const OPERAND: usize = 7;
const COMMENT: usize = 18;

/// Code and comment of a line; a semicolon in a string begins none.
fn parts(line: &str) -> (&str, &str) {
    let mut quoted = false;
    let at = line.char_indices().find(|(_, character)| {
        quoted ^= *character == '"';
        *character == ';' && !quoted
    });
    at.map_or((line, ""), |(at, _)| line.split_at(at))
}

/// A line in columns: instruction, operand, comment. Blanks before the instruction stay, as the manual's listings have
/// them, and so does a line that is a comment alone (inferred).
pub(super) fn formatted(line: &str) -> String {
    let (code, comment) = parts(line);
    let indent = code.len() - code.trim_start().len();
    let plain = unformatted(code);
    if plain.is_empty() {
        return line.trim_end().to_owned();
    }
    let (instruction, operand) = plain.split_once(' ').unwrap_or((&plain, ""));
    let code = format!("{instruction:<width$} {operand}", width = OPERAND - 1);
    let code = match comment {
        "" => code.trim_end().to_owned(),
        comment => format!("{:<width$} {comment}", code.trim_end(), width = COMMENT - 1),
    };
    format!("{}{}", " ".repeat(indent), code.trim_end())
}

/// A line without what sets its words in columns: single blanks, but for those of a string and of a comment (inferred).
pub(super) fn unformatted(line: &str) -> String {
    let (code, comment) = parts(line);
    let parts = code.split('"').enumerate().map(|(place, part)| match place % 2 {
        1 => part.to_owned(),
        _ => {
            let mut plain = part.split_whitespace().collect::<Vec<_>>().join(" ");
            if part.starts_with(char::is_whitespace) && place > 0 {
                plain.insert(0, ' ');
            }
            if part.ends_with(char::is_whitespace) && !plain.ends_with(' ') {
                plain.push(' ');
            }
            plain
        }
    });
    let code = parts.collect::<Vec<_>>().join("\"");
    format!("{}{comment}", code.trim_start()).trim_end().to_owned()
}

#[cfg(test)]
mod tests {
    use super::*;

    /// [000:4155-4160] in their columns, the constants of [000:14415-14430] with the blanks before them.
    #[test]
    fn a_line_is_set_in_the_columns_of_the_manual() {
        for (typed, set) in [
            (
                "L M2185 ;1ST PLC SCAN AFTER",
                "L      M2185      ;1ST PLC SCAN AFTER",
            ),
            (
                "S  M544  ;ACTIVATE REF TRAVERSE",
                "S      M544       ;ACTIVATE REF TRAVERSE",
            ),
            ("L   M544", "L      M544"),
            ("L KF VALUESFIELD[X]", "L      KF VALUESFIELD[X]"),
            ("      K+10", "      K+10"),
            ("      = W0", "      =      W0"),
            ("EM", "EM"),
            ("LBL FIRST_SCAN", "LBL    FIRST_SCAN"),
            ("L S\"A;  B\" ;x", "L      S\"A;  B\"   ;x"),
            ("; a  comment", "; a  comment"),
            ("", ""),
        ] {
            assert_eq!(formatted(typed), set);
            assert_eq!(formatted(set), set);
        }
    }
}
