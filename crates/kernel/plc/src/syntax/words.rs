//! The words of a line, for editors: what they are and where they stand.

use std::ops::Range;

use bahn_parameters::ControlModel;

use super::form::Mnemonic;
use super::line::{parse, split_comment};
use super::operand::{MODULE_NUMBERS, Operand};
use crate::operand::{BitOperand, NumberOperand, TextOperand};

/// A line that holds an instruction; places count characters from 0.
#[derive(Clone, Debug, PartialEq)]
pub struct LineWords {
    /// The instruction, as `L` or `CM`.
    pub instruction: &'static str,
    /// Bytes of the instruction in its line.
    pub instruction_at: Range<usize>,
    /// What it works on.
    pub operand: LineOperand,
    /// Where that stands; empty where there is none.
    pub operand_at: Range<usize>,
}

/// What an instruction works on.
#[derive(Clone, Debug, PartialEq)]
pub enum LineOperand {
    /// Nothing but the accumulators.
    None,
    /// A bit, as `M2045`.
    Bit(BitOperand),
    /// A number, as `W260`.
    Number(NumberOperand),
    /// A constant: `K+54`.
    Constant(i32),
    /// A string, as `S0` or `S"text"`.
    Text(TextOperand),
    /// A field of constants.
    Field(String),
    /// A label of the program.
    Label(String),
    /// A module of the control.
    Module(u16),
    /// Name of a source file, after USES and the like.
    File(String),
}

/// Reads a line for a control; nothing where it holds no instruction, or one that cannot be read.
///
/// ```
/// use bahn_parameters::ControlModel;
/// use bahn_plc::{LineOperand, line_words};
///
/// let words = line_words("  CM  DOOR ; opens", ControlModel::Tnc415b).unwrap();
/// assert_eq!((words.instruction, words.instruction_at), ("CM", 2..4));
/// assert_eq!((words.operand, words.operand_at), (LineOperand::Label("DOOR".into()), 6..10));
/// ```
pub fn line_words(line: &str, model: ControlModel) -> Option<LineWords> {
    let command = parse(line, model).ok()??;
    let code = split_comment(line).0.trim_end();
    let end = code.chars().count();
    let start = (command.column as usize).saturating_sub(1);
    let operand_start = (command.operand_column as usize).saturating_sub(1).min(end);
    let written = |range: Range<usize>| code.chars().skip(range.start).take(range.len());
    let blanks = {
        let instruction: Vec<char> = written(start..operand_start).collect();
        instruction.iter().rev().take_while(|c| c.is_whitespace()).count()
    };
    let has_operand = command.operand != Operand::None;
    Some(LineWords {
        instruction: command.mnemonic.spelling(),
        instruction_at: start..if has_operand { operand_start - blanks } else { end },
        operand: operand_of(command.operand),
        operand_at: if has_operand { operand_start } else { end }..end,
    })
}

fn operand_of(operand: Operand) -> LineOperand {
    match operand {
        Operand::None => LineOperand::None,
        Operand::Bit(bit) => LineOperand::Bit(bit),
        Operand::Number(number) => LineOperand::Number(number),
        Operand::Constant(value) => LineOperand::Constant(value),
        Operand::Text(text) => LineOperand::Text(text),
        Operand::Field(name) => LineOperand::Field(name),
        Operand::File(name) => LineOperand::File(name),
        Operand::Label(name) => {
            let number = name.parse::<u16>().ok();
            match number.filter(|number| MODULE_NUMBERS.contains(&u32::from(*number))) {
                Some(module) => LineOperand::Module(module),
                None => LineOperand::Label(name),
            }
        }
    }
}

/// What an instruction does with one kind of operands: a row of `data/instructions.tsv`.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct InstructionForm {
    /// The instruction, as `L`.
    pub instruction: &'static str,
    /// Which form: logic, word, string, flow and so on.
    pub form: &'static str,
    /// The operands that it takes.
    pub operands: &'static str,
    /// What it does. LA is the logic, WA the word, SA the string accumulator, X the index register.
    pub does: &'static str,
    /// What else it changes, and the errors that it may raise.
    pub conditions: &'static str,
    /// Nominal time in µs, as it is printed; empty where it is not.
    pub time_us: &'static str,
    /// Where the manual prints it, as `[000:12056]`.
    pub source: &'static str,
}

/// All forms of all instructions, in the order of the manual.
pub fn instructions() -> impl Iterator<Item = InstructionForm> {
    let rows = include_str!("../../data/instructions.tsv").lines().skip(1);
    rows.filter_map(|row| {
        let mut columns = row.split('\t');
        let mut next = || columns.next();
        Some(InstructionForm {
            instruction: next()?,
            form: next()?,
            operands: next()?,
            does: next()?,
            conditions: next()?,
            time_us: next()?,
            source: next()?,
        })
    })
}

/// Whether an instruction opens something that another one closes, or closes it: structures, tables, brackets.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Nesting {
    /// It opens what a later one closes: IFT.
    Opens,
    /// It closes what an earlier one has opened: ENDI.
    Closes,
    /// It closes one and opens another: ELSE.
    Both,
    /// It stands for itself.
    Neither,
}

/// What an instruction does to the nesting of the lines after it.
pub fn nesting(instruction: &str) -> Nesting {
    const OPENING: [Mnemonic; 7] = [
        Mnemonic::IfTrue,
        Mnemonic::IfFalse,
        Mnemonic::Repeat,
        Mnemonic::WhileTrue,
        Mnemonic::WhileFalse,
        Mnemonic::Case,
        Mnemonic::Field,
    ];
    const CLOSING: [Mnemonic; 6] = [
        Mnemonic::EndIf,
        Mnemonic::UntilTrue,
        Mnemonic::UntilFalse,
        Mnemonic::EndWhile,
        Mnemonic::EndCase,
        Mnemonic::EndField,
    ];
    let is_one_of = |all: &[Mnemonic]| {
        all.iter()
            .any(|one| one.spelling().eq_ignore_ascii_case(instruction))
    };
    if instruction.eq_ignore_ascii_case(Mnemonic::Else.spelling()) {
        Nesting::Both
    } else if instruction.starts_with(']') || is_one_of(&CLOSING) {
        Nesting::Closes
    } else if instruction.ends_with('[') || is_one_of(&OPENING) {
        Nesting::Opens
    } else {
        Nesting::Neither
    }
}

/// A line of the formatted listing without its comment: labels at the margin, commands after it, deeper in structures.
pub fn listed_code(command: &str, operand: &str, depth: usize) -> String {
    let code = match command.eq_ignore_ascii_case(Mnemonic::Label.spelling()) {
        true => format!("{command:<5} {operand}"),
        false => format!("  {:indent$}{command:<5} {operand}", "", indent = 2 * depth),
    };
    code.trim_end().to_owned()
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::collections::BTreeSet;

    #[test]
    fn every_instruction_has_its_meaning() {
        let known: BTreeSet<&str> = Mnemonic::ALL.iter().map(|one| one.spelling()).collect();
        let explained: BTreeSet<&str> = instructions().map(|form| form.instruction).collect();
        assert_eq!(known, explained);
        for form in instructions() {
            let cited = form.source.starts_with('[') || form.source == "(public)";
            assert!(!form.does.is_empty() && cited, "{form:?}");
        }
    }

    #[test]
    fn words_stand_where_they_are_written() {
        let at = |line: &str| {
            let words = line_words(line, ControlModel::Tnc415b).unwrap();
            (words.instruction_at, words.operand_at, words.operand)
        };
        assert_eq!(at("EM"), (0..2, 2..2, LineOperand::None));
        let (instruction, operand, what) = at("A [");
        assert_eq!((instruction, operand, what), (0..3, 3..3, LineOperand::None));
        let (instruction, operand, what) = at("CM 9036 ; Ü");
        assert_eq!(
            (instruction, operand, what),
            (0..2, 3..7, LineOperand::Module(9036))
        );
        assert!(matches!(at("L S\"Tür;\" ; x"), (_, at, LineOperand::Text(_)) if at == (2..9)));
        assert_eq!(line_words("; L I4", ControlModel::Tnc415b), None);
        assert_eq!(line_words("FOO 7", ControlModel::Tnc415b), None);
    }
}
