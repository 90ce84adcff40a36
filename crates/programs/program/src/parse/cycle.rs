//! CYCL DEF and CYCL CALL. Words of cycles vary with the language of the
//! control, so that only numbers and addresses decide [003:3713-3714] [003:4979].

use bahn_parameters::MessageId::{AxisDoubleProgrammed, CyclIncomplete, EntryValueIncorrect};
use bahn_path::{Axis, AxisSet, Direction};

use super::cursor::{Cursor, Parsed, WRITE_A_NUMBER, with_help};
use super::decoration::{begins_value, decoration, ends_word, is_broken_number, is_separator, number_begins};
use super::m_function::m_functions;
use super::path::{feed_word, sense};
use crate::check::ANY_LABEL_MAX;
use crate::cycles::{cycle_parameters, takes_assignments};
use crate::text::to_words;
use crate::{CycleBlock, CycleFunction, CycleWord, Operation, Quantity, Word};

/// `CYCL DEF n.m ...` (also `CYCLE DEF`) and `CYCL CALL`.
pub(super) fn cycle(c: &mut Cursor) -> Parsed<Option<Operation>> {
    let start = c.position();
    if c.keyword("CYCLE") || c.keyword("CYCL") {
        if c.keyword("DEF") {
            return definition(c).map(|block| Some(Operation::Cycle(Box::new(block))));
        }
        if c.keyword("CALL") {
            if !c.at_end() && c.peek_upper() != b'M' {
                // CYCL CALL POS and CYCL CALL PAT of later controls.
                return c.not_known();
            }
            return Ok(Some(Operation::CycleCall(m_functions(c)?)));
        }
    }
    c.go_to(start);
    Ok(None)
}

fn definition(c: &mut Cursor) -> Parsed<CycleBlock> {
    let (number, sub) = numbers(c)?;
    let words = match holds(CycleFunction::Definition, number, sub) {
        // The name of a cycle is decoration, whatever it looks like.
        _ if sub == 0 && !takes_assignments(number) => text_word(c.name()),
        Some(Quantity::Program) => program_name(c),
        Some(Quantity::Labels) => label_list(c)?,
        quantity => words(c, Scope::Cycle(quantity))?,
    };
    Ok(CycleBlock { number, sub, words })
}

/// What the first parameter of a block is.
pub(super) fn holds(function: CycleFunction, number: u16, sub: u16) -> Option<Quantity> {
    let first = cycle_parameters(function, number, sub).first();
    first.map(|parameter| parameter.quantity)
}

/// `n.m`, with blanks anywhere; `n` alone is `n.0`.
pub(super) fn numbers(c: &mut Cursor) -> Parsed<(u16, u16)> {
    c.skip_blanks();
    let start = c.position();
    let Some(number) = c.integer(start)? else {
        return c.fault_at_word(CyclIncomplete, "the number is missing");
    };
    let mut sub = 0;
    let number_end = c.position();
    c.skip_blanks();
    if !c.at_annotation() && (c.accept(b'.') || c.accept(b',')) {
        sub = c.integer(start)?.unwrap_or(u32::MAX);
    } else {
        c.go_to(number_end);
    }
    match (u16::try_from(number), u16::try_from(sub)) {
        (Ok(number), Ok(sub)) => Ok((number, sub)),
        _ => c.fault_from(
            start,
            EntryValueIncorrect,
            "no control has a block of this number",
        ),
    }
}

/// The word list of a decoration.
fn text_word(text: Box<str>) -> Vec<CycleWord> {
    if text.is_empty() {
        Vec::new()
    } else {
        vec![CycleWord::Text(text)]
    }
}

/// `12.1 PGM 50`, `12.1 50`, `12.1 PART.H`.
fn program_name(c: &mut Cursor) -> Vec<CycleWord> {
    c.word("PGM");
    text_word(c.name())
}

/// `14.1 CONTOUR LABEL 1/2/3` [003:5460-5470].
fn label_list(c: &mut Cursor) -> Parsed<Vec<CycleWord>> {
    let mut words = Vec::new();
    let mut text = Vec::new();
    while !c.at_end() && !c.peek().is_ascii_digit() && c.peek() != b'/' {
        if is_separator(c.peek()) {
            c.advance(1);
        } else {
            decoration(c, &mut text);
        }
    }
    words.extend(text_word(to_words(&text)));
    let mut labels = Vec::new();
    while !c.at_end() {
        c.accept(b'/');
        c.skip_blanks();
        let start = c.position();
        labels.push(c.required_integer(start, ANY_LABEL_MAX, "a label number is missing")?);
    }
    if !labels.is_empty() {
        words.push(CycleWord::Labels(labels.into()));
    }
    Ok(words)
}

/// What kind of block words stand in.
#[derive(Clone, Copy, PartialEq, Eq)]
pub(super) enum Scope {
    /// CYCL DEF whose first parameter in the block is this.
    Cycle(Option<Quantity>),
    /// TCH PROBE, where an axis has a direction and `Qn` takes the result.
    Probe,
}

/// The words of a cycle or probe block.
pub(super) fn words(c: &mut Cursor, scope: Scope) -> Parsed<Vec<CycleWord>> {
    let mut words = Vec::new();
    let mut text: Vec<u8> = Vec::new();
    let (mut axes, mut centres) = (AxisSet::EMPTY, AxisSet::EMPTY);
    while !c.at_end() {
        if is_separator(c.peek()) {
            c.advance(1);
            continue;
        }
        // `#3`, `#Q5`: a line of a datum table.
        if scope == Scope::Cycle(Some(Quantity::Shift)) && c.accept(b'#') {
            text.push(b'#');
            continue;
        }
        let start = c.position();
        let Some(word) = address(c, scope)? else {
            let axes_only = matches!(scope, Scope::Cycle(Some(Quantity::Shift | Quantity::AxisFactors)));
            if axes_only || is_broken_number(c) {
                let fault = c.fault_at_word(EntryValueIncorrect, "this is no number");
                return with_help(fault, WRITE_A_NUMBER);
            }
            decoration(c, &mut text);
            continue;
        };
        let Some(word) = word else { continue };
        let once = match word {
            CycleWord::Coordinate(axis, _) | CycleWord::AxisFactor(axis, _) => Some((axis, &mut axes)),
            CycleWord::Centre(axis, _) => Some((axis, &mut centres)),
            _ => None,
        };
        if let Some((axis, programmed)) = once {
            if programmed.contains(axis) {
                return c.fault_from(
                    start,
                    AxisDoubleProgrammed,
                    "the axis has two values in this block",
                );
            }
            programmed.insert(axis);
        }
        words.extend(text_word(to_words(&text)));
        text.clear();
        words.push(word);
    }
    words.extend(text_word(to_words(&text)));
    Ok(words)
}

/// Reads a word with an address, or a number; `Some(None)` for an empty placeholder; `None` for
/// decoration, of which nothing is read.
fn address(c: &mut Cursor, scope: Scope) -> Parsed<Option<Option<CycleWord>>> {
    if scope == Scope::Cycle(Some(Quantity::AxisFactors)) {
        return Ok(scaling_word(c)?.map(Some));
    }
    let start = c.position();
    let letter = c.peek_upper();
    let second = c.peek_at(1).to_ascii_uppercase();
    let found = match (letter, second) {
        (b'0'..=b'9' | b'+' | b'-' | b'.' | b',', _) => {
            if !number_begins(c.rest()) {
                return Ok(None);
            }
            c.value()?.map(CycleWord::Number)
        }
        (b'Q', b'0'..=b'9') => return parameter_word(c, scope).map(Some),
        (b'F', _) if begins_value(c, 1) => {
            c.advance(1);
            feed_word(c)?.map(CycleWord::Feed)
        }
        (b'F', _) if c.word("FMAX") => Some(CycleWord::Feed(crate::Feed::Max)),
        (b'F', _) if ends_word(c, 1) => {
            c.advance(1);
            // `F MAX`, or an empty F.
            return Ok(Some(c.word("MAX").then_some(CycleWord::Feed(crate::Feed::Max))));
        }
        (b'M', b'0'..=b'9') => {
            c.advance(1);
            Some(CycleWord::M(c.required_integer(
                start,
                999,
                "no control here knows this M function",
            )?))
        }
        (b'D', b'R') if matches!(c.peek_at(2), b'+' | b'-' | b'0'..=b'9') || ends_word(c, 2) => {
            c.advance(2);
            Some(CycleWord::Sense(sense(c, start)?))
        }
        (b'I', _) => match Axis::from_letter(second) {
            Some(axis) if begins_value(c, 2) => {
                c.advance(2);
                let value = c.required_value(start)?;
                Some(CycleWord::Coordinate(
                    axis,
                    Word {
                        value,
                        incremental: true,
                    },
                ))
            }
            _ => return Ok(None),
        },
        _ => match Axis::from_letter(letter) {
            Some(axis) => return axis_word(c, start, axis, scope),
            None => return Ok(None),
        },
    };
    Ok(Some(found))
}

/// `X1.4`, the factor of an axis, and `CCX+15`, the centre of it; nothing else stands in cycle 26.
fn scaling_word(c: &mut Cursor) -> Parsed<Option<CycleWord>> {
    let start = c.position();
    let mut after = c.clone();
    let is_centre = after.keyword("CC");
    after.skip_blanks();
    let Some(axis) = Axis::from_letter(after.peek_upper()).filter(|_| begins_value(&after, 1)) else {
        return Ok(None);
    };
    *c = after;
    c.advance(1);
    let value = c.required_value(start)?;
    Ok(Some(match is_centre {
        true => CycleWord::Centre(axis, value),
        false => CycleWord::AxisFactor(axis, value),
    }))
}

/// `X+40`, `X-` or `X`; cycle 8 also takes letters without blanks, `XY`.
fn axis_word(c: &mut Cursor, start: usize, axis: Axis, scope: Scope) -> Parsed<Option<Option<CycleWord>>> {
    if begins_value(c, 1) {
        c.advance(1);
        let value = c.required_value(start)?;
        return Ok(Some(Some(CycleWord::Coordinate(
            axis,
            Word {
                value,
                incremental: false,
            },
        ))));
    }
    let letters = c.rest().iter().take_while(|b| b.is_ascii_alphabetic()).count();
    let all_axes = c
        .rest()
        .iter()
        .take(letters)
        .all(|&b| Axis::from_letter(b).is_some());
    if letters > 1 && !(all_axes && scope == Scope::Cycle(Some(Quantity::Axes))) {
        return Ok(None);
    }
    let direction = match c.peek_at(1) {
        b'+' => Direction::Plus,
        b'-' => Direction::Minus,
        _ if letters > 1 || ends_word(c, 1) => {
            c.advance(1);
            return Ok(Some(Some(CycleWord::Axis(axis))));
        }
        _ => return Ok(None),
    };
    c.advance(2);
    if scope != Scope::Probe {
        return c.number_missing(start, "a number or Q parameter is missing after the sign");
    }
    Ok(Some(Some(CycleWord::AxisDirection(axis, direction))))
}

/// `Q1=+8` assigns, `Q8 =` is an empty assignment [001:3078]; `Q5` alone takes a probe's result, or is the
/// value of a named parameter.
fn parameter_word(c: &mut Cursor, scope: Scope) -> Parsed<Option<CycleWord>> {
    let start = c.position();
    let number = c.parameter(start)?;
    if !c.accept(b'=') {
        return Ok(Some(match scope {
            Scope::Probe => CycleWord::Target(number),
            Scope::Cycle(_) => CycleWord::Number(crate::Value::Q {
                number,
                negative: false,
            }),
        }));
    }
    let after = c.clone();
    let value = c.value()?;
    if value.is_some() && c.accept(b'=') {
        // `Q8 = Q9 =`: what looked like the value is the next assignment.
        *c = after;
        return Ok(None);
    }
    Ok(value.map(|value| CycleWord::Assignment(number, value)))
}

#[cfg(test)]
mod tests {
    use bahn_path::Sense;

    use super::super::test::{fault, m, operation, q};
    use super::*;
    use crate::Feed;
    use crate::Value::Number as N;
    use CycleWord::{Assignment, Axis as AxisLetter, Coordinate, Labels, Number};
    use bahn_parameters::MessageId::BlockNotKnown;

    fn cycle(text: &str) -> CycleBlock {
        match operation(text) {
            Operation::Cycle(block) => *block,
            other => panic!("{text}: {other:?}"),
        }
    }

    fn words_of(text: &str) -> Vec<CycleWord> {
        cycle(text).words
    }

    fn text(text: &str) -> CycleWord {
        CycleWord::Text(text.into())
    }

    fn at(axis: Axis, value: f64) -> CycleWord {
        Coordinate(
            axis,
            Word {
                value: N(value),
                incremental: false,
            },
        )
    }

    fn feed(value: f64) -> CycleWord {
        CycleWord::Feed(Feed::Value(N(value)))
    }

    #[test]
    fn numbers_decide_in_every_spelling() {
        for (text, number, sub) in [
            ("CYCL DEF 1.0 PECKING", 1, 0),
            ("CYCLE DEF 1.0 PECKING", 1, 0),
            ("CYCL DEF9 .0", 9, 0),
            ("CYCL DEF 1 .0", 1, 0),
            ("CYCL DEF 1. 0", 1, 0),
            ("cycl def 17,0", 17, 0),
            ("CYCLDEF5.0", 5, 0),
            ("12 CYCL DEF 7.2 Y+60", 7, 2),
            ("CYCL DEF 13", 13, 0),
            ("CYCL DEF 9.0......dwell", 9, 0),
        ] {
            let block = cycle(text);
            assert_eq!((block.number, block.sub), (number, sub), "{text}");
        }
        assert_eq!(words_of("CYCL DEF 1.0 FORATURA PROF."), [text("FORATURA PROF.")]);
        assert_eq!(words_of("CYCL DEF 69.0 OEMCYCLE 1"), [text("OEMCYCLE 1")]);
        assert_eq!(words_of("CYCL DEF 1.0 X+5 PECK"), [text("X+5 PECK")]);
    }

    #[test]
    fn named_values_in_any_language() {
        for block in [
            "1.1 SET UP -2",
            "1.1 SETUP-2",
            "1.1 ABST-2",
            "1.1 ABST -2,0",
            "1.1 DISTANZA: -2",
        ] {
            let words = words_of(&format!("CYCL DEF {block}"));
            assert_eq!(words.get(1), Some(&Number(N(-2.0))), "{block}");
            assert_eq!(words.len(), 2, "{block}");
        }
        assert_eq!(
            words_of("CYCL DEF 1.2 TIEFE-15"),
            [text("TIEFE"), Number(N(-15.0))]
        );
        assert_eq!(words_of("CYCL DEF 1.2 TIEFE-Q8"), [text("TIEFE"), Number(q(-8))]);
        assert_eq!(
            words_of("CYCL DEF 1.4 V.ZEIT 0"),
            [text("V.ZEIT"), Number(N(0.0))]
        );
        assert_eq!(words_of("CYCL DEF 1.4 DWELL Q5"), [text("DWELL"), Number(q(5))]);
        assert_eq!(
            words_of("CYCL DEF 1.2 PROF.-15"),
            [text("PROF."), Number(N(-15.0))]
        );
        assert_eq!(words_of("CYCL DEF 1.1 -2"), [Number(N(-2.0))]);
        assert_eq!(words_of("CYCL DEF 1.5 F80"), [feed(80.0)]);
        assert_eq!(words_of("CYCL DEF 1.5 F 80"), [feed(80.0)]);
        assert_eq!(words_of("CYCL DEF 1.5 FQ7"), [CycleWord::Feed(Feed::Value(q(7)))]);
        assert_eq!(words_of("CYCL DEF 1.5 F MAX"), [CycleWord::Feed(Feed::Max)]);
        assert_eq!(words_of("CYCL DEF 1.5 F"), []);
    }

    #[test]
    fn pockets_and_slots() {
        assert_eq!(
            words_of("CYCL DEF 3.3 PECKG -5 F80"),
            [text("PECKG"), Number(N(-5.0)), feed(80.0)]
        );
        assert_eq!(words_of("CYCL DEF 3.4 X-50"), [at(Axis::X, -50.0)]);
        let end = [
            feed(100.0),
            CycleWord::Sense(Sense::CounterClockwise),
            text("RADIUS"),
            Number(N(0.0)),
        ];
        assert_eq!(words_of("CYCL DEF 4.6 F100 DR+ RADIUS 0"), end);
        assert_eq!(words_of("CYCL DEF 4.6 F100DR+RADIUS0"), end);
        assert_eq!(
            fault("CYCL DEF 4.6 F100 DR RADIUS 0"),
            (EntryValueIncorrect, 19, 2)
        );
        assert_eq!(fault("CYCL DEF 3.4 X-50 X+4"), (AxisDoubleProgrammed, 19, 3));
    }

    #[test]
    fn contours() {
        let labels = |list: &[u16]| Labels(list.into());
        assert_eq!(
            words_of("CYCL DEF 14.1 CONTOUR LABEL 1/2/3"),
            [text("CONTOUR LABEL"), labels(&[1, 2, 3])]
        );
        assert_eq!(
            words_of("CYCL DEF 14.1 KONTURLABEL1 / 2"),
            [text("KONTURLABEL"), labels(&[1, 2])]
        );
        assert_eq!(words_of("CYCL DEF 14.1 LABEL 4"), [text("LABEL"), labels(&[4])]);
        assert_eq!(
            words_of("CYCL DEF 6.1 SET UP -2 DEPTH -15"),
            [text("SET UP"), Number(N(-2.0)), text("DEPTH"), Number(N(-15.0))]
        );
        assert_eq!(
            words_of("CYCL DEF 6.2 PECKG -8 F100 ALLOW +0"),
            [
                text("PECKG"),
                Number(N(-8.0)),
                feed(100.0),
                text("ALLOW"),
                Number(N(0.0))
            ]
        );
        assert_eq!(
            words_of("CYCL DEF 16.2 PECKG -5 F100 DR- F500"),
            [
                text("PECKG"),
                Number(N(-5.0)),
                feed(100.0),
                CycleWord::Sense(Sense::Clockwise),
                feed(500.0)
            ]
        );
    }

    #[test]
    fn transformations() {
        let incremental = Coordinate(
            Axis::X,
            Word {
                value: N(40.0),
                incremental: true,
            },
        );
        assert_eq!(words_of("CYCL DEF 7.1 IX+40"), [incremental]);
        assert_eq!(
            words_of("CYCL DEF 7.1 X+Q1"),
            [Coordinate(
                Axis::X,
                Word {
                    value: q(1),
                    incremental: false
                }
            )]
        );
        assert_eq!(words_of("CYCL DEF 8.1 X"), [AxisLetter(Axis::X)]);
        for text in ["CYCL DEF 8.1 X Y", "CYCL DEF 8.1 XY"] {
            assert_eq!(
                words_of(text),
                [AxisLetter(Axis::X), AxisLetter(Axis::Y)],
                "{text}"
            );
        }
        assert_eq!(words_of("CYCL DEF 8.1"), []);
        for block in ["ROT+35", "ROT +35", "ROT 35"] {
            assert_eq!(
                words_of(&format!("CYCL DEF 10.1 {block}")),
                [text("ROT"), Number(N(35.0))],
                "{block}"
            );
        }
        assert_eq!(words_of("CYCL DEF 10.1 IROT+35"), [text("IROT"), Number(N(35.0))]);
        assert_eq!(words_of("CYCL DEF 11.1 SCL 0.8"), [text("SCL"), Number(N(0.8))]);
    }

    #[test]
    fn scaling_of_single_axes() {
        use CycleWord::{AxisFactor, Centre};
        let all = [
            AxisFactor(Axis::X, N(1.4)),
            AxisFactor(Axis::Y, q(1)),
            Centre(Axis::X, N(15.0)),
            Centre(Axis::Y, q(-2)),
        ];
        for block in [
            "X1.4 YQ1 CCX+15 CCY-Q2",
            "X+1,4 Y+Q1 CC X15 CCY -Q2",
            "x1.4YQ1ccx15CCY-Q2",
        ] {
            assert_eq!(words_of(&format!("CYCL DEF 26.1 {block}")), all, "{block}");
        }
        for (block, message, column) in [
            ("X1.4 X2", AxisDoubleProgrammed, 20),
            ("X1.4 CCX+1 CCX+2", AxisDoubleProgrammed, 26),
            ("X1.4 CCXO", EntryValueIncorrect, 20),
            ("X1.4 0.6", EntryValueIncorrect, 20),
            ("SCL 0.8", EntryValueIncorrect, 15),
        ] {
            let (found, at, _) = fault(&format!("CYCL DEF 26.1 {block}"));
            assert_eq!((found, at), (message, column), "{block}");
        }
    }

    #[test]
    fn called_programs() {
        for block in ["12.1 PGM 50", "12.1 50", "12.1  pgm 50"] {
            assert_eq!(words_of(&format!("CYCL DEF {block}")), [text("50")], "{block}");
        }
        assert_eq!(words_of("CYCL DEF 12.1 PGM PART.H"), [text("PART.H")]);
        assert_eq!(words_of("CYCL DEF 12.1 PGMPART"), [text("PGMPART")]);
    }

    #[test]
    fn oem_cycles() {
        let values = [
            Assignment(1, N(8.0)),
            Assignment(2, N(40.0)),
            Assignment(3, q(-60)),
        ];
        assert_eq!(words_of("CYCL DEF 68.1 Q1=+8 Q2=+40 Q3=-Q60"), values);
        assert_eq!(words_of("CYCL DEF 68.1 Q1 = +8,000 Q2 = 40Q3=-Q60"), values);
        assert_eq!(
            words_of("CYCL DEF 68.3 Q7 = +100,000 Q8 = Q9 ="),
            [Assignment(7, N(100.0))]
        );
    }

    #[test]
    fn cycles_of_later_controls() {
        let block = cycle("CYCL DEF 200 BOHREN Q200=+2 Q201=-20 Q206=+150");
        assert_eq!((block.number, block.sub), (200, 0));
        assert_eq!(
            block.words,
            [
                text("BOHREN"),
                Assignment(200, N(2.0)),
                Assignment(201, N(-20.0)),
                Assignment(206, N(150.0))
            ]
        );
    }

    #[test]
    fn calls() {
        assert_eq!(operation("CYCL CALL"), Operation::CycleCall(m(&[])));
        assert_eq!(operation("CYCL CALL M3"), Operation::CycleCall(m(&[3])));
        assert_eq!(operation("CYCLE CALL M"), Operation::CycleCall(m(&[])));
        assert_eq!(fault("CYCL CALL POS X+5"), (BlockNotKnown, 11, 3));
        assert_eq!(fault("CYCL DEF"), (CyclIncomplete, 9, 1));
        assert_eq!(fault("CYCL DEF 99999.1").0, EntryValueIncorrect);
        assert_eq!(fault("CYCL").0, BlockNotKnown);
    }
}
