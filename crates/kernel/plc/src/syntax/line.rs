//! One line: command, operand, comment [000:11496-11504].
//!
//! The manual's own listings are typed loosely: `LBL230`, `OM 500`, `B 128`, `K + 0`, `X[`. Such lines are
//! read, with a note that becomes a warning, or an error in strict checking.

use bahn_parameters::ControlModel;

use super::form::{Class, Mnemonic, TNC_355};
use super::memory::memory_operand;
use super::operand::{LineError, Operand, Scanner, label};
use crate::PlcError;

/// Longest line in characters [000:11940].
const LINE_LENGTH_MAX: usize = 128;

/// A command with its operand.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct Command {
    pub mnemonic: Mnemonic,
    pub operand: Operand,
    /// Where the command begins, in characters from 1.
    pub column: u32,
    pub operand_column: u32,
    /// How the line deviates from the editor's spelling.
    pub notes: Vec<LineError>,
    /// Whether it is written as on the TNC 355.
    pub tnc355: bool,
}

/// Reads a line for a control. `Ok(None)` is an empty line or a comment. A line that is too long is read all the same; the
/// error stands in the notes of the command, or is the error of the line.
pub(crate) fn parse(line: &str, model: ControlModel) -> Result<Option<Command>, LineError> {
    let characters: Vec<char> = line.chars().collect();
    let code = code_part(&characters);
    let start = code.iter().position(|c| !c.is_whitespace());
    let too_long = (characters.len() > LINE_LENGTH_MAX).then(|| {
        let detail = format!("{} characters, {LINE_LENGTH_MAX} are allowed", characters.len());
        LineError::new(PlcError::NoEndOfLine, LINE_LENGTH_MAX, detail)
    });
    let Some(start) = start else {
        return too_long.map_or(Ok(None), Err);
    };
    let mut command = read_command(code, start, model)?;
    command.notes.extend(too_long);
    Ok(Some(command))
}

/// A line of source text before its comment, and the comment with its sign. A semicolon inside quotation marks is text.
pub fn split_comment(line: &str) -> (&str, &str) {
    let mut quoted = false;
    let at = line.find(|character| {
        quoted ^= character == '"';
        character == ';' && !quoted
    });
    line.split_at(at.unwrap_or(line.len()))
}

/// A line of source text without its comment, blanks drawn together.
///
/// ```
/// assert_eq!(bahn_plc::code_of_line("  L   I4   ; door"), "L I4");
/// ```
pub fn code_of_line(line: &str) -> String {
    let code = split_comment(line).0;
    match code.contains('"') {
        true => code.trim().to_owned(),
        false => code.split_whitespace().collect::<Vec<_>>().join(" "),
    }
}

/// What is wrong with a line by itself, as the editor of a control finds it on entry (errors of class E) [000:11925]; it is
/// the compiler that sees how lines belong together.
pub fn check_line(line: &str, model: ControlModel) -> Result<(), PlcError> {
    parse(line, model).map(drop).map_err(|fault| fault.error)
}

/// The line without comment and trailing blanks. A semicolon inside quotation marks is text.
fn code_part(characters: &[char]) -> &[char] {
    let mut quoted = false;
    let mut end = characters.len();
    for (at, character) in characters.iter().enumerate() {
        match character {
            '"' => quoted = !quoted,
            ';' if !quoted => {
                end = at;
                break;
            }
            _ => {}
        }
    }
    let code = characters.get(..end).unwrap_or(characters);
    let end = code
        .iter()
        .rposition(|c| !c.is_whitespace())
        .map_or(0, |last| last + 1);
    code.get(..end).unwrap_or(code)
}

/// Tries every command that the text begins with, the longest first, and takes the first that fits its
/// operand; otherwise reports the error of the one that the text names completely.
fn read_command(code: &[char], start: usize, model: ControlModel) -> Result<Command, LineError> {
    let word_end = code
        .iter()
        .skip(start)
        .position(|c| c.is_whitespace())
        .map_or(code.len(), |length| start + length);
    let mut named: Option<LineError> = None;
    let mut out_of_range: Option<LineError> = None;
    for (mnemonic, spelling, tnc355) in spellings() {
        let Some(end) = match_spelling(code, start, spelling) else {
            continue;
        };
        match read_operand(mnemonic, code, (start, end), tnc355, model) {
            Ok(command) => return Ok(command),
            Err(error) => {
                if end >= word_end && named.is_none() {
                    named = Some(error);
                } else if error.error == PlcError::OperandOutOfRange && out_of_range.is_none() {
                    out_of_range = Some(error);
                }
            }
        }
    }
    Err(named.or(out_of_range).unwrap_or_else(|| {
        let word: String = code.get(start..word_end).unwrap_or_default().iter().collect();
        LineError::new(PlcError::NotACommand, start, format!("`{word}`"))
    }))
}

/// All spellings, the longest first.
fn spellings() -> impl Iterator<Item = (Mnemonic, &'static str, bool)> {
    (1..=6).rev().flat_map(|length| {
        let own = Mnemonic::ALL
            .iter()
            .map(|mnemonic| (*mnemonic, mnemonic.spelling(), false));
        let old = TNC_355
            .iter()
            .map(|(spelling, mnemonic)| (*mnemonic, *spelling, true));
        own.chain(old)
            .filter(move |(_, spelling, _)| spelling.len() == length)
    })
}

/// The end of a spelling in the text; blanks may stand before its symbols, as in `A [` or `= -`.
fn match_spelling(code: &[char], start: usize, spelling: &str) -> Option<usize> {
    let mut at = start;
    for expected in spelling.chars() {
        if at > start && !expected.is_ascii_alphabetic() {
            while code.get(at).is_some_and(|c| c.is_whitespace()) {
                at += 1;
            }
        }
        if code.get(at)?.to_ascii_uppercase() != expected {
            return None;
        }
        at += 1;
    }
    Some(at)
}

fn read_operand(
    mnemonic: Mnemonic,
    code: &[char],
    (start, end): (usize, usize),
    tnc355: bool,
    model: ControlModel,
) -> Result<Command, LineError> {
    let mut scanner = Scanner::new(code, end);
    scanner.skip_blanks();
    let at = scanner.at();
    let mut notes = Vec::new();
    let glued = at == end && scanner.peek().is_some_and(|c| c.is_ascii_alphanumeric());
    let letters = mnemonic.spelling().ends_with(|c: char| c.is_ascii_alphabetic());
    if glued && letters && mnemonic != Mnemonic::Constant {
        let detail = format!("no blank after {}", mnemonic.spelling());
        notes.push(LineError::new(PlcError::NoLimiter, end, detail));
    }
    let (operand, old_letter) = if mnemonic.takes(Class::None) {
        (Operand::None, false)
    } else if mnemonic == Mnemonic::Constant {
        (Operand::Constant(scanner.constant()?), false)
    } else if mnemonic.takes(Class::File) {
        (Operand::File(file_name(&mut scanner)?), false)
    } else if mnemonic.takes(Class::Label) {
        let named = scanner.peek().is_some_and(|c| !c.is_ascii_digit());
        if glued && letters && named {
            return Err(LineError::new(PlcError::NotACommand, start, "no such command"));
        }
        (Operand::Label(label(&mut scanner)?), false)
    } else {
        memory_operand(mnemonic, &mut scanner, model)?
    };
    scanner.skip_blanks();
    if let Some(character) = scanner.peek() {
        let detail = format!("`{character}` after {}", mnemonic.spelling());
        return Err(LineError::new(PlcError::NoLimiter, scanner.at(), detail));
    }
    let tnc355 = tnc355 || old_letter;
    if tnc355 && !has_old_letters(model) {
        let detail = "command or operand letter of the TNC 355";
        notes.push(LineError::new(PlcError::NotACommand, start, detail));
    }
    Ok(Command {
        mnemonic,
        operand,
        column: LineError::new(PlcError::NotACommand, start, "").column,
        operand_column: LineError::new(PlcError::NotACommand, at, "").column,
        notes,
        tnc355,
    })
}

/// Whether the letters of the TNC 355 are those of the control itself: the interface of the TNC 151 and 155 is written with
/// E and A [001:477-482].
pub(crate) fn has_old_letters(model: ControlModel) -> bool {
    model.limits().has_old_numbers()
}

fn file_name(scanner: &mut Scanner) -> Result<String, LineError> {
    let at = scanner.at();
    let name = scanner.take_while(|c| !c.is_whitespace());
    if name.is_empty() {
        return Err(LineError::new(
            PlcError::OperandNotFound,
            at,
            "file name expected",
        ));
    }
    Ok(name)
}

#[cfg(test)]
mod tests {
    use super::*;

    const MODEL: ControlModel = ControlModel::Tnc415b;

    fn read(line: &str) -> Command {
        parse(line, MODEL).unwrap().unwrap()
    }

    fn error(line: &str) -> u8 {
        match parse(line, MODEL) {
            Err(error) => error.error.number(),
            Ok(command) => panic!("{line} is read as {command:?}"),
        }
    }

    fn same(loose: &str, exact: &str) {
        let (loose, exact) = (read(loose), read(exact));
        assert_eq!((loose.mnemonic, loose.operand), (exact.mnemonic, exact.operand));
    }

    #[test]
    fn the_manuals_spellings_are_read() {
        same("LBL230", "LBL 230");
        same("LM 2182", "L M2182");
        same("OM 500", "O M500");
        same("CM0", "CM 0");
        same("  RPLY B 128 ;comment", "RPLY B128");
        same("<> K + 0", "<> K+0");
        same("= -  W8", "=- W8");
        same("A [", "A[");
        same("x[", "X[");
        same("l i4", "L I4");
        same("= B100 [ X ]", "= B100[X]");
        same("L S \"a;b\"", "L S\"a;b\"");
        same("U E4", "A I4");
        same("UN A2", "AN O2");
        same("= Z5", "= C5");
        same("L KF TABLE", "L KF TABLE[X]");
        same("LBL ABCDEFGHIJKLMNOPQ", "LBL ABCDEFGHIJKLMNOP");
        same("CM 015", "CM 15");
        assert!(read("L M5").notes.is_empty() && !read("LBL230").notes.is_empty());
        assert!(parse("   ;nothing", MODEL).unwrap().is_none() && parse("", MODEL).unwrap().is_none());
    }

    #[test]
    fn commands_and_letters_are_distinguished() {
        assert_eq!(read("LW M3200").mnemonic, Mnemonic::LoadWord);
        assert_eq!(read("L W8").mnemonic, Mnemonic::Load);
        assert_eq!(read("LW8").mnemonic, Mnemonic::Load);
        assert_eq!(read("PLW").mnemonic, Mnemonic::PullWord);
        assert_eq!(read("PLW6").mnemonic, Mnemonic::Pull);
        assert_eq!(read("=X").mnemonic, Mnemonic::StoreIndex);
        assert_eq!(read("== K1").mnemonic, Mnemonic::Equal);
        assert_eq!(read("K-100000").operand, Operand::Constant(-100_000));
        assert_eq!(read("L K$FFFFFFFF").operand, Operand::Constant(-1));
        assert_eq!(read("L K$ 38").operand, Operand::Constant(0x38));
        assert_eq!(read("L K-2147483648").operand, Operand::Constant(i32::MIN));
    }

    #[test]
    fn each_error_of_a_line_has_its_number() {
        for (line, number) in [
            ("LOAD M5", 0),
            ("?", 0),
            ("END", 0),
            ("5 L M2", 0),
            ("= K5", 2),
            ("INC M5", 2),
            ("L Q5", 2),
            ("PL K3", 2),
            ("OVWR S\"A\"", 2),
            ("CASE D0", 2),
            ("L", 3),
            ("L M", 3),
            ("= W", 3),
            ("JP", 3),
            ("L K", 3),
            ("L S#E", 3),
            ("USES", 3),
            ("L M3264", 4),
            ("= I32", 4),
            ("L W7", 4),
            ("L D1022", 4),
            ("L K2147483648", 4),
            ("L K$100000000", 4),
            ("L S4", 4),
            ("L S#E1000", 4),
            ("L S#D4096", 4),
            ("JP 512", 4),
            ("W= O100", 4),
            ("LB M3260", 4),
            ("L M99999999999", 4),
            ("OM 9999", 4),
            ("L M5 M6", 5),
            ("EM 5", 5),
            ("L M5[Y]", 5),
            ("] ]", 5),
            ("L S0^Y", 5),
            ("= O2,", 5),
        ] {
            assert_eq!(error(line), number, "{line}");
        }
        assert_eq!(error(&format!(";{}", "x".repeat(128))), 6);
        let long = read(&format!("L M5 ;{}", "x".repeat(128)));
        assert_eq!(long.notes[0].error, PlcError::NoEndOfLine);
    }
}
