//! G functions whose words are their own: blank, tools, labels, roundings, and all cycles.

use bahn_parameters::MessageId::{CyclIncomplete, EntryValueIncorrect, UnexpectedText};
use bahn_path::{Axis, Direction};

use super::code::{coordinate, distance, end, g_code, missing, once, plane};
use super::cycle::{Form, IsoCycle, of_code, word_of};
use super::function::p_index;
use crate::check::ANY_LABEL_MAX;
use crate::parse::cursor::{Cursor, Parsed};
use crate::parse::m_function;
use crate::text::to_words;
use crate::{
    Coordinates, CycleBlock, CycleFunction, CycleWord, Distance, Feed, MFunctions, ModalBlock, Modality,
    Operation, Quantity, Value, Word,
};

/// G functions that are no cycles and stand with words of their own.
const OTHERS: [u16; 12] = [24, 25, 26, 27, 29, 30, 31, 38, 51, 79, 98, 99];

/// Whether a G function makes a block of its own kind.
#[inline]
pub(super) fn is_special(code: u16) -> bool {
    OTHERS.contains(&code) || of_code(code).is_some()
}

/// `L1,0` calls a subprogram, `L1,5` repeats a section.
pub(super) fn call(c: &mut Cursor) -> Parsed<Operation> {
    let start = c.position();
    c.advance(1);
    let label = c.required_integer(start, ANY_LABEL_MAX, "a label number from 0 to 65534 is missing")?;
    let mut repeats = None;
    if c.accept(b',') {
        let value = c.required_value(start)?;
        repeats = Some(value).filter(|value| *value != Value::Number(0.0));
    }
    Ok(Operation::CallLabel { label, repeats })
}

/// The words of such a block.
#[derive(Default)]
struct Words {
    modality: Modality,
    coordinates: Coordinates,
    /// Bare letters of axes.
    axes: Vec<Axis>,
    /// R, F, H, S, T and L with a value.
    letters: Vec<(u8, Value)>,
    p: Vec<(u16, P)>,
    assignments: Vec<CycleWord>,
    m: MFunctions,
}

/// What stands after a P.
#[derive(Clone, Debug, PartialEq)]
enum P {
    Value(Value),
    Axis(Axis, Word),
    Direction(Axis, Direction),
    Name(Box<str>),
}

/// Which words a block takes.
#[derive(Clone, Copy)]
struct Takes {
    letters: &'static [u8],
    coordinates: bool,
    axes: bool,
    p: bool,
    name: bool,
    assignments: bool,
    m: bool,
}

const NOTHING: Takes = Takes {
    letters: b"",
    coordinates: false,
    axes: false,
    p: false,
    name: false,
    assignments: false,
    m: false,
};

fn takes(code: u16) -> Takes {
    let letters = |letters| Takes { letters, ..NOTHING };
    let cycle = of_code(code).map(|cycle| cycle.form);
    match (code, cycle) {
        (24..=27, _) => letters(b"RF"),
        (30 | 31, _) | (_, Some(Form::Shift | Form::Positions)) => Takes {
            coordinates: true,
            ..NOTHING
        },
        (38 | 79, _) => Takes { m: true, ..NOTHING },
        (51, _) => letters(b"T"),
        (98, _) => letters(b"L"),
        (99, _) => letters(b"TLR"),
        (_, Some(Form::Letter(b'F'))) => letters(b"F"),
        (_, Some(Form::Letter(b'S'))) => letters(b"S"),
        (_, Some(Form::Letter(_))) => letters(b"H"),
        (_, Some(Form::Axes)) => Takes {
            axes: true,
            ..NOTHING
        },
        (_, Some(Form::Assignments)) => Takes {
            assignments: true,
            ..NOTHING
        },
        (_, Some(Form::Program)) => Takes {
            p: true,
            name: true,
            ..NOTHING
        },
        (_, Some(_)) => Takes { p: true, ..NOTHING },
        _ => NOTHING,
    }
}

/// Reads a block that has this G function, from its beginning.
#[cold]
pub(super) fn special(c: &mut Cursor, code: u16) -> Parsed<Operation> {
    let start = c.position();
    let words = read(c, code, takes(code))?;
    let operation = match code {
        24..=27 => corner(c, start, code, &words)?,
        29 => Operation::CircleCentre(Coordinates::default()),
        30 => Operation::BlankMin(words.coordinates, words.modality.plane),
        31 => Operation::BlankMax(words.coordinates),
        38 => return Ok(Operation::Stop(words.m)),
        51 | 99 => return tool(c, start, &words),
        79 => return Ok(Operation::CycleCall(words.m)),
        98 => return label(c, start, &words),
        _ => {
            let Some(cycle) = of_code(code) else {
                return c.unexpected();
            };
            let blocks = cycle_blocks(c, start, &cycle, &words)?;
            let kind = |block| match cycle.function {
                CycleFunction::Definition => Operation::Cycle(Box::new(block)),
                CycleFunction::Probe => Operation::Probe(Box::new(block)),
            };
            return Ok(modal(code, words.modality, blocks.into_iter().map(kind)));
        }
    };
    let mut modality = words.modality;
    if code == 30 {
        // Its plane is part of it.
        modality.plane = None;
    }
    Ok(modal(code, modality, [operation]))
}

fn modal(code: u16, modality: Modality, operations: impl IntoIterator<Item = Operation>) -> Operation {
    Operation::Modal(Box::new(ModalBlock {
        code: Some(code),
        modality,
        operations: operations.into_iter().collect(),
    }))
}

fn read(c: &mut Cursor, code: u16, takes: Takes) -> Parsed<Words> {
    let mut words = Words::default();
    let mut seen = None;
    while !end(c) {
        let start = c.position();
        let letter = c.peek_upper();
        match letter {
            b'G' => {
                let found = g_code(c)?;
                match found {
                    90 | 91 => words.modality.distance = Some(distance(found)),
                    17..=20 => {
                        let plane = plane(c, start, found)?;
                        once(c, start, &mut words.modality.plane, plane)?;
                    }
                    _ if found == code => once(c, start, &mut seen, code)?,
                    _ => {
                        return c.fault_from(
                            start,
                            UnexpectedText,
                            "this G function has no place in the block",
                        );
                    }
                }
            }
            b'M' if takes.m => m_function(c, &mut words.m)?,
            b'P' if takes.p => p_word(c, takes.name, &mut words)?,
            b'Q' if takes.assignments => assignment(c, start, &mut words.assignments)?,
            _ if takes.letters.contains(&letter) => {
                c.advance(1);
                let value = c.required_value(start)?;
                if words.letters.iter().any(|(found, _)| *found == letter) {
                    return c.fault_from(start, UnexpectedText, "this stands twice in the block");
                }
                words.letters.push((letter, value));
                words.modality.open_angle |= letter == b'H' && words.modality.distance.is_none();
            }
            _ => axis_word(c, takes, &mut words)?,
        }
    }
    Ok(words)
}

/// Coordinates or bare axis letters, as the block takes them.
fn axis_word(c: &mut Cursor, takes: Takes, words: &mut Words) -> Parsed<()> {
    let Some(axis) = Axis::from_letter(c.peek_upper()) else {
        return c.unexpected();
    };
    if takes.coordinates {
        let distance = words.modality.distance;
        return coordinate(
            c,
            axis,
            &mut words.coordinates,
            &mut words.modality.open,
            distance,
        );
    }
    if !takes.axes || words.axes.contains(&axis) {
        return c.unexpected();
    }
    c.advance(1);
    words.axes.push(axis);
    Ok(())
}

fn assignment(c: &mut Cursor, start: usize, assignments: &mut Vec<CycleWord>) -> Parsed<()> {
    let number = c.parameter(start)?;
    if !c.accept(b'=') {
        return c.fault_at_word(EntryValueIncorrect, "= is missing");
    }
    let value = c.required_value(start)?;
    assignments.push(CycleWord::Assignment(number, value));
    Ok(())
}

/// `P01 -2`, `P05 X+80`, `P02 X-`, `P01 NAME`.
fn p_word(c: &mut Cursor, name: bool, words: &mut Words) -> Parsed<()> {
    let start = c.position();
    let Some(number) = p_index(c)? else {
        return c.unexpected();
    };
    if words.p.iter().any(|(found, _)| *found == number) {
        return c.fault_from(start, UnexpectedText, "this stands twice in the block");
    }
    c.skip_blanks();
    let value = if name {
        let text = to_words(c.rest());
        c.advance(c.rest().len());
        P::Name(text)
    } else if let Some(axis) = Axis::from_letter(c.peek_upper()) {
        c.advance(1);
        match (c.peek(), c.peek_at(1)) {
            (sign @ (b'+' | b'-'), next) if !next.is_ascii_digit() && !b".,Qq".contains(&next) => {
                c.advance(1);
                P::Direction(
                    axis,
                    match sign {
                        b'-' => Direction::Minus,
                        _ => Direction::Plus,
                    },
                )
            }
            _ => P::Axis(
                axis,
                Word {
                    value: c.required_value(start)?,
                    incremental: words.modality.distance == Some(Distance::Incremental),
                },
            ),
        }
    } else {
        P::Value(c.required_value(start)?)
    };
    words.p.push((number, value));
    Ok(())
}

impl Words {
    fn letter(&self, letter: u8) -> Option<Value> {
        let found = self.letters.iter().find(|(found, _)| *found == letter);
        found.map(|(_, value)| *value)
    }

    fn p(&self, number: u16) -> Option<&P> {
        let found = self.p.iter().find(|(found, _)| *found == number);
        found.map(|(_, value)| value)
    }
}

/// G24, a chamfer, and G25 to G27, a rounding.
fn corner(c: &mut Cursor, start: usize, code: u16, words: &Words) -> Parsed<Operation> {
    let Some(radius) = words.letter(b'R') else {
        return missing(c, start, "R is missing");
    };
    let feed = words.letter(b'F');
    Ok(match code {
        24 => Operation::Chamfer { length: radius, feed },
        _ => Operation::Rounding { radius, feed },
    })
}

/// G99 defines a tool, G51 announces it.
fn tool(c: &mut Cursor, start: usize, words: &Words) -> Parsed<Operation> {
    let Some(tool) = words.letter(b'T') else {
        return missing(c, start, "the tool number is missing");
    };
    Ok(Operation::ToolDefinition {
        tool,
        length: words.letter(b'L'),
        radius: words.letter(b'R'),
    })
}

fn label(c: &mut Cursor, start: usize, words: &Words) -> Parsed<Operation> {
    match words.letter(b'L') {
        Some(Value::Number(number))
            if number.fract() == 0.0 && (0.0..=f64::from(ANY_LABEL_MAX)).contains(&number) =>
        {
            Ok(Operation::Label(number as u16))
        }
        _ => missing(c, start, "a label number from 0 to 65534 is missing"),
    }
}

/// The blocks of a cycle from the words of its one.
fn cycle_blocks(c: &mut Cursor, start: usize, cycle: &IsoCycle, words: &Words) -> Parsed<Vec<CycleBlock>> {
    let with = |sub: u16, words: Vec<CycleWord>| CycleBlock {
        words,
        ..cycle.block(sub)
    };
    let one = |words: Vec<CycleWord>| vec![with(0, Vec::new()), with(1, words)];
    let coordinate = |(axis, word): (Axis, Word)| CycleWord::Coordinate(axis, word);
    Ok(match cycle.form {
        Form::Letter(letter) => {
            let Some(value) = words.letter(letter) else {
                return c.fault_from(
                    start,
                    CyclIncomplete,
                    format!("{} is missing", char::from(letter)),
                );
            };
            let incremental = words.modality.distance == Some(Distance::Incremental);
            let mut own = vec![CycleWord::Number(value)];
            if letter == b'H' {
                let name = if incremental { "IROT" } else { "ROT" };
                own.insert(0, CycleWord::Text(name.into()));
            }
            one(own)
        }
        Form::Axes => one(words.axes.iter().map(|axis| CycleWord::Axis(*axis)).collect()),
        Form::Shift => {
            let mut blocks = vec![with(0, Vec::new())];
            let words = words.coordinates.iter().map(coordinate);
            blocks.extend((1..).zip(words).map(|(sub, word)| with(sub, vec![word])));
            blocks
        }
        Form::Positions => one(words.coordinates.iter().map(coordinate).collect()),
        Form::TableLine => match words.p(1) {
            Some(P::Value(line)) => one(vec![CycleWord::Text("#".into()), CycleWord::Number(*line)]),
            _ => return c.fault_from(start, CyclIncomplete, "P01 is missing"),
        },
        Form::Labels => one(vec![CycleWord::Labels(labels(c, start, words)?)]),
        Form::Program => match words.p(1) {
            Some(P::Name(name)) if !name.is_empty() => one(vec![CycleWord::Text(name.clone())]),
            _ => return c.fault_from(start, CyclIncomplete, "P01 is missing"),
        },
        Form::Assignments => vec![with(0, words.assignments.clone())],
        Form::Probing => probing(c, start, words)?
            .into_iter()
            .zip(0..)
            .map(|(words, sub)| with(sub, words))
            .collect(),
        Form::Parameters => cycle.blocks(&parameters(c, start, cycle, words)?),
    })
}

/// The words of P01, P02, ... by what the table of cycles says they are.
fn parameters(
    c: &mut Cursor,
    start: usize,
    cycle: &IsoCycle,
    words: &Words,
) -> Parsed<Vec<(u16, CycleWord)>> {
    let mut found = Vec::new();
    let mut last = 0;
    for ((sub, parameter), number) in cycle.parameters().zip(1_u16..) {
        last = number;
        let word = match (parameter.quantity, words.p(number)) {
            (Quantity::Side, Some(P::Axis(axis, word))) => CycleWord::Coordinate(*axis, *word),
            (quantity, Some(P::Value(value))) if quantity != Quantity::Side => word_of(quantity, *value),
            (_, None) if parameter.optional => continue,
            (_, None) => {
                let detail = format!("P{number:02} {} is missing", parameter.name);
                return c.fault_from(start, CyclIncomplete, detail.replace("  ", " "));
            }
            _ => {
                return c.fault_from(
                    start,
                    EntryValueIncorrect,
                    format!("P{number:02} has another value"),
                );
            }
        };
        found.push((sub, word));
    }
    if let Some((number, _)) = words.p.iter().find(|(number, _)| *number == 0 || *number > last) {
        let detail = format!("the cycle has no P{number:02}");
        return c.fault_from(start, UnexpectedText, detail);
    }
    Ok(found)
}

/// The labels of G37 in the order of their P words.
fn labels(c: &mut Cursor, start: usize, words: &Words) -> Parsed<Box<[u16]>> {
    let mut numbered = Vec::new();
    for (number, value) in &words.p {
        match value {
            P::Value(Value::Number(label))
                if label.fract() == 0.0 && (0.0..=f64::from(ANY_LABEL_MAX)).contains(label) =>
            {
                numbered.push((*number, *label as u16));
            }
            _ => return c.fault_from(start, EntryValueIncorrect, format!("P{number:02} is no label")),
        }
    }
    if numbered.is_empty() {
        return c.fault_from(start, CyclIncomplete, "P01 is missing");
    }
    numbered.sort_by_key(|(number, _)| *number);
    Ok(numbered.into_iter().map(|(_, label)| label).collect())
}

/// `G55 P01 10 P02 X- P03 X+5 P04 Y+0 P05 Z-5`: the parameter that takes the result, how the probe moves, and where
/// to.
fn probing(c: &mut Cursor, start: usize, words: &Words) -> Parsed<[Vec<CycleWord>; 2]> {
    let (Some(P::Value(Value::Number(q))), Some(P::Direction(axis, direction))) = (words.p(1), words.p(2))
    else {
        return c.fault_from(
            start,
            CyclIncomplete,
            "P01 and P02 are a Q parameter and an axis with its direction",
        );
    };
    let max = f64::from(crate::check::ANY_Q_MAX);
    if q.fract() != 0.0 || !(0.0..=max).contains(q) {
        return c.fault_from(start, EntryValueIncorrect, "P01 is no Q parameter");
    }
    let mut position = Coordinates::default();
    for (number, value) in words.p.iter().filter(|(number, _)| *number > 2) {
        match value {
            P::Axis(axis, word) if !position.axes().contains(*axis) => position.set(*axis, *word),
            _ => {
                return c.fault_from(
                    start,
                    EntryValueIncorrect,
                    format!("P{number:02} is no coordinate"),
                );
            }
        }
    }
    let position = position
        .iter()
        .map(|(axis, word)| CycleWord::Coordinate(axis, word));
    Ok([
        vec![
            CycleWord::Target(*q as u16),
            CycleWord::AxisDirection(*axis, *direction),
        ],
        position.collect(),
    ])
}

/// Value of F, or of the number without an address, in a cycle word.
pub(super) fn feed_value(word: &CycleWord) -> Option<Value> {
    match word {
        CycleWord::Feed(Feed::Value(value)) | CycleWord::Number(value) => Some(*value),
        _ => None,
    }
}
