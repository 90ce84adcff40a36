//! The functions after D: `D00` to `D15` and `D19` calculate, compare and print as FN does; the others define cycles of
//! the machine builder [000:17966-17984].

use bahn_parameters::MessageId::{BlockNotKnown, EntryValueIncorrect, UnexpectedText};

use super::code::end;
use crate::check::ANY_LABEL_MAX;
use crate::parse::cursor::{Cursor, Parsed};
use crate::{Calculation, Condition, CycleBlock, CycleWord, ModalBlock, Modality, Operation, Value};

/// Most items of D15 PRINT [003:4371-4385].
const PRINT_MAX: usize = 6;
/// Value of an operand that a function does not have.
const NO_OPERAND: Value = Value::Number(0.0);

/// The calculations, each with its number.
pub(super) const CALCULATIONS: [(u16, Calculation); 10] = [
    (0, Calculation::Assign),
    (1, Calculation::Add),
    (2, Calculation::Subtract),
    (3, Calculation::Multiply),
    (4, Calculation::Divide),
    (5, Calculation::SquareRoot),
    (6, Calculation::Sine),
    (7, Calculation::Cosine),
    (8, Calculation::Length),
    (13, Calculation::Angle),
];

/// The comparisons, each with its number.
pub(super) const CONDITIONS: [(u16, Condition); 4] = [
    (9, Condition::Equal),
    (10, Condition::NotEqual),
    (11, Condition::Greater),
    (12, Condition::Less),
];

/// `D00 Q5 P01 +60`, `D68 P1+8 P2+40`.
pub(super) fn function(c: &mut Cursor) -> Parsed<Operation> {
    let start = c.position();
    c.advance(1);
    let number = c.required_integer(start, 999, "the number of the function is missing")?;
    if let Some((_, function)) = CALCULATIONS.iter().find(|(code, _)| *code == number) {
        return calculation(c, start, *function);
    }
    if let Some((_, condition)) = CONDITIONS.iter().find(|(code, _)| *code == number) {
        let a = operand(c, start, 1)?;
        let b = operand(c, start, 2)?;
        index(c, start, 3)?;
        let label = c.required_integer(start, ANY_LABEL_MAX, "a label number is missing")?;
        return Ok(Operation::Jump {
            condition: *condition,
            a,
            b,
            label,
        });
    }
    match number {
        14 => Ok(Operation::ErrorNumber(operand(c, start, 1)?)),
        15 => print(c, start),
        19 => {
            let a = operand(c, start, 1)?;
            let b = if end(c) { None } else { Some(operand(c, start, 2)?) };
            Ok(Operation::Plc { a, b })
        }
        68..=99 => machine_builder(c, number),
        _ => c.fault_from(start, BlockNotKnown, "no control here knows this function"),
    }
}

fn calculation(c: &mut Cursor, start: usize, function: Calculation) -> Parsed<Operation> {
    c.skip_blanks();
    if c.peek_upper() != b'Q' {
        return c.number_missing(start, "the Q parameter for the result is missing");
    }
    let target = c.parameter(start)?;
    let a = operand(c, start, 1)?;
    let single = matches!(
        function,
        Calculation::Assign | Calculation::SquareRoot | Calculation::Sine | Calculation::Cosine
    );
    let b = if single { NO_OPERAND } else { operand(c, start, 2)? };
    Ok(Operation::Calculate {
        function,
        target,
        a,
        b,
    })
}

fn print(c: &mut Cursor, start: usize) -> Parsed<Operation> {
    let mut items = vec![operand(c, start, 1)?];
    while !end(c) {
        if items.len() == PRINT_MAX {
            return c.fault_at_word(EntryValueIncorrect, "D15 prints at most six items");
        }
        let next = items.len() as u16 + 1;
        items.push(operand(c, start, next)?);
    }
    Ok(Operation::Print(items.into()))
}

/// The parameters go to Q1, Q2, ...
fn machine_builder(c: &mut Cursor, number: u16) -> Parsed<Operation> {
    let mut words: Vec<CycleWord> = Vec::new();
    while !end(c) {
        let start = c.position();
        let Some(parameter) = p_index(c)? else {
            return c.unexpected();
        };
        let twice = |word: &CycleWord| matches!(word, CycleWord::Assignment(q, _) if *q == parameter);
        if words.iter().any(twice) {
            return c.fault_from(start, UnexpectedText, "this stands twice in the block");
        }
        words.push(CycleWord::Assignment(parameter, c.required_value(start)?));
    }
    let block = CycleBlock {
        number,
        sub: 0,
        words,
    };
    Ok(Operation::Modal(Box::new(ModalBlock {
        code: None,
        modality: Modality::default(),
        operations: [Operation::Cycle(Box::new(block))].into(),
    })))
}

/// `P` and its number, at most two digits; `None` if something else stands here.
pub(super) fn p_index(c: &mut Cursor) -> Parsed<Option<u16>> {
    c.skip_blanks();
    if c.peek_upper() != b'P' || !c.peek_at(1).is_ascii_digit() {
        return Ok(None);
    }
    let mut number = 0;
    let mut digits = 0;
    c.advance(1);
    while digits < 2 && c.peek().is_ascii_digit() {
        number = number * 10 + u16::from(c.peek() - b'0');
        digits += 1;
        c.advance(1);
    }
    Ok(Some(number))
}

/// P with the number that has to come.
fn index(c: &mut Cursor, start: usize, expected: u16) -> Parsed<()> {
    if end(c) {
        return c.fault_from(start, EntryValueIncorrect, format!("P{expected:02} is missing"));
    }
    let word = c.position();
    match p_index(c)? {
        Some(found) if found == expected => Ok(()),
        _ => {
            c.go_to(word);
            c.fault_at_word(EntryValueIncorrect, format!("P{expected:02} is missing"))
        }
    }
}

fn operand(c: &mut Cursor, start: usize, number: u16) -> Parsed<Value> {
    index(c, start, number)?;
    let word = c.position();
    c.required_value(word)
}
