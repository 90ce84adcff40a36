//! What is probably meant where a block cannot be read.

use std::path::Path;

use bahn_text::Diagnostic;

use crate::command;
use crate::program::{Fault, Program};
use bahn_text::nearest;

impl Fault {
    /// As people and programs get it; `program` is the one it is in, `file` where that lies.
    pub fn diagnostic(&self, program: &Program, file: &Path) -> Diagnostic {
        let wrong = Diagnostic::error(self.span, self.message.as_str());
        self.placed(wrong, program.line(self.span.line), program.cure(self), file)
    }

    /// The diagnostic of a fault in its file, with its line.
    pub(crate) fn placed(
        &self,
        diagnostic: Diagnostic,
        line: &str,
        help: Option<String>,
        file: &Path,
    ) -> Diagnostic {
        diagnostic.in_block(&*self.block).with_help(help).at(file, line)
    }

    /// A number that is meant where a letter stands in it.
    pub(crate) fn meant_number(&self, line: &str) -> Option<String> {
        let line: Vec<char> = line.chars().collect();
        digit(&line, (self.span.column as usize).checked_sub(1)?)
    }
}

impl Program {
    /// What to do about a fault of this file, where that can be guessed: a letter in a number, a bracket that is missing, a
    /// command that is spelt otherwise.
    ///
    /// ```
    /// let program = bahn_din::Program::from_bytes("a.nc", b"G01 F1000 X1O\n");
    /// let fault = &program.faults()[0];
    /// assert_eq!(program.cure(fault).as_deref(), Some("did you mean `X10`?"));
    /// ```
    pub fn cure(&self, fault: &Fault) -> Option<String> {
        let line: Vec<char> = self.line(fault.span.line).chars().collect();
        let at = (fault.span.column as usize).checked_sub(1)?;
        digit(&line, at).or_else(|| bracket(&line)).or_else(|| {
            let words: String = line.get(at..)?.iter().take(fault.span.length as usize).collect();
            let known = nearest(words.strip_prefix('#')?, command::names())?;
            Some(format!("did you mean `#{known}`?"))
        })
    }
}

/// A letter that looks like a digit, within a word of digits.
fn digit(line: &[char], at: usize) -> Option<String> {
    const ALIKE: [(char, char); 5] = [('O', '0'), ('o', '0'), ('l', '1'), ('I', '1'), ('|', '1')];
    let as_digit = |c: char| {
        ALIKE
            .iter()
            .find(|(letter, _)| *letter == c)
            .map(|(_, digit)| *digit)
    };
    let in_word = |c: &char| c.is_ascii_digit() || matches!(c, '.' | '-' | '+') || as_digit(*c).is_some();
    as_digit(*line.get(at)?)?;
    let mut begin = at;
    while begin > 0 && line.get(begin - 1).is_some_and(in_word) {
        begin -= 1;
    }
    let mut end = at;
    while line.get(end).is_some_and(in_word) {
        end += 1;
    }
    let number = line.get(begin..end)?;
    let address = line
        .get(begin.checked_sub(1)?)
        .filter(|c| c.is_ascii_alphabetic())?;
    if !number.iter().any(char::is_ascii_digit) {
        return None;
    }
    let meant: String = number.iter().map(|c| as_digit(*c).unwrap_or(*c)).collect();
    Some(format!("did you mean `{address}{meant}`?"))
}

/// A bracket that is not closed.
fn bracket(line: &[char]) -> Option<String> {
    let mut open = Vec::new();
    for (at, c) in line.iter().enumerate() {
        match c {
            '[' => open.push(at),
            ']' => {
                open.pop();
            }
            ';' | '(' => break,
            _ => {}
        }
    }
    let at = open.first()?;
    Some(format!("`]` is missing for the bracket in column {}", at + 1))
}

#[cfg(test)]
mod tests {
    use crate::program::Program;

    fn cure(text: &str) -> Option<String> {
        let program = Program::from_bytes("a.nc", text.as_bytes());
        let faults = program.faults();
        assert_eq!(faults.len(), 1, "{faults:?}");
        program.cure(&faults[0])
    }

    #[test]
    fn slips_are_guessed() {
        for (text, meant) in [
            ("N10 G01 X1O", "`X10`"),
            ("N10 G01 X1 Y-l2.5", "`Y-12.5`"),
            ("N10 X[M7 Y5", "`]` is missing for the bracket in column 6"),
            ("#EXPL SNY", "`#EXPL SYN`"),
            ("#VECTOR LIMIT NO [VEL=5]", "`#VECTOR LIMIT ON`"),
        ] {
            assert!(
                cure(text).is_some_and(|cure| cure.contains(meant)),
                "{text}: {:?}",
                cure(text)
            );
        }
        assert_eq!(cure("N10 QQ5"), None);
    }
}
