//! `bahn plc list`: the program as formatted listing.

use super::options::ListOptions;
use super::source::Source;
use crate::diagnostics::printable;
use crate::{Outcome, UsageError, console};

/// Prints all files of a program with line numbers, commands and comments in columns.
pub(super) fn command(options: &ListOptions) -> Result<Outcome, UsageError> {
    let source = Source::compile(&options.program)?;
    let Some(program) = source.program() else {
        return Ok(Outcome::ProgramError);
    };
    let mut text = String::new();
    for (index, file) in program.files.iter().enumerate() {
        if index > 0 {
            text.push('\n');
        }
        text += &format!("{}\n", file.name);
        text += &listing(&file.lines);
    }
    console::print(&text)?;
    Ok(Outcome::Fine)
}

/// Lines of a file; what stands inside structures and tables is indented.
fn listing(lines: &[String]) -> String {
    let mut depth = 0_usize;
    let mut text = String::new();
    for (index, line) in lines.iter().enumerate() {
        let (code, comment) = split_comment(line);
        let (command, operand) = split_command(code);
        let outside = closes(&command) || command.eq_ignore_ascii_case("ELSE");
        let indent = depth.saturating_sub(outside.into()) * 2;
        let code = if command.eq_ignore_ascii_case("LBL") {
            format!("{command:<5} {operand}")
        } else {
            format!("  {:indent$}{command:<5} {operand}", "")
        };
        let row = format!("{:>5}  {:<30} {}", index + 1, code.trim_end(), comment.trim());
        text += &printable(row.trim_end());
        text.push('\n');
        if closes(&command) {
            depth = depth.saturating_sub(1);
        } else if opens(&command) {
            depth += 1;
        }
    }
    text
}

fn opens(command: &str) -> bool {
    const OPENING: [&str; 7] = ["IFT", "IFF", "REPEAT", "WHILET", "WHILEF", "CASE", "KFIELD"];
    command.ends_with('[') || OPENING.iter().any(|word| command.eq_ignore_ascii_case(word))
}

fn closes(command: &str) -> bool {
    const CLOSING: [&str; 6] = ["ENDI", "UNTILT", "UNTILF", "ENDW", "ENDC", "ENDK"];
    command.starts_with(']') || CLOSING.iter().any(|word| command.eq_ignore_ascii_case(word))
}

/// The command and the operand of a line.
fn split_command(code: &str) -> (String, String) {
    let code = code.trim();
    let (command, operand) = code.split_once(char::is_whitespace).unwrap_or((code, ""));
    (command.to_owned(), operand.trim().to_owned())
}

/// A line before its comment, and the comment with its sign.
pub(super) fn split_comment(line: &str) -> (&str, &str) {
    let mut quoted = false;
    let at = line.find(|character| {
        quoted ^= character == '"';
        character == ';' && !quoted
    });
    line.split_at(at.unwrap_or(line.len()))
}
