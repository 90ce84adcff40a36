//! TCH PROBE: measuring and digitizing.

use bahn_parameters::MessageId::BlockNotKnown;

use super::cursor::{Cursor, Parsed};
use super::cycle::{Scope, holds, numbers, words};
use crate::{CycleBlock, CycleFunction, CycleWord, Operation, Quantity};

/// Probe cycles from this number on belong to later controls.
const FIRST_LATER_PROBE: u16 = 400;

/// `TCH PROBE n.m ...`, in the text of the manual also `TOUCH PROBE` [003:4428] [003:1670].
pub(super) fn probe(c: &mut Cursor) -> Parsed<Option<Operation>> {
    let start = c.position();
    if !((c.keyword("TCH") || c.keyword("TOUCH")) && c.keyword("PROBE")) {
        c.go_to(start);
        return Ok(None);
    }
    let (number, sub) = numbers(c)?;
    if number >= FIRST_LATER_PROBE {
        return c.fault_from(start, BlockNotKnown, "no control here knows this probe cycle");
    }
    let words = match holds(CycleFunction::Probe, number, sub) {
        Some(Quantity::Program) => digitizing_file(c),
        _ => words(c, Scope::Probe)?,
    };
    Ok(Some(Operation::Probe(Box::new(CycleBlock {
        number,
        sub,
        words,
    }))))
}

/// `5.1 PGM NAME: 5007`: the program that takes the digitized points [003:6618].
fn digitizing_file(c: &mut Cursor) -> Vec<CycleWord> {
    let start = c.position();
    let code = c.code();
    match memchr::memchr(b':', code) {
        Some(colon) => c.go_to(start + colon + 1),
        None => {
            c.go_to(start);
            if c.word("PGM") {
                c.word("NAME");
            }
        }
    }
    let name = c.name();
    if name.is_empty() {
        Vec::new()
    } else {
        vec![CycleWord::Text(name)]
    }
}

#[cfg(test)]
mod tests {
    use super::super::test::{fault, operation, q};
    use super::*;
    use crate::Value::Number as N;
    use crate::Word;
    use CycleWord::{AxisDirection, Coordinate, Number, Target};
    use bahn_path::{Axis, Direction};

    fn probe(text: &str) -> (u16, u16, Vec<CycleWord>) {
        match operation(text) {
            Operation::Probe(block) => (block.number, block.sub, block.words),
            other => panic!("{text}: {other:?}"),
        }
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

    #[test]
    fn measuring() {
        let first = (
            0,
            0,
            vec![
                text("REF. PLANE"),
                Target(5),
                AxisDirection(Axis::X, Direction::Minus),
            ],
        );
        assert_eq!(probe("TCH PROBE 0.0 REF. PLANE Q5 X-"), first);
        assert_eq!(
            probe("TOUCH PROBE 0.0 REF.PLANE Q5X-").2.get(1..),
            first.2.get(1..)
        );
        assert_eq!(
            probe("TCH PROBE 0.1 X+5 Y+0 Z-5"),
            (0, 1, vec![at(Axis::X, 5.0), at(Axis::Y, 0.0), at(Axis::Z, -5.0)])
        );
        assert_eq!(
            probe("TCH PROBE 0.1 X+Q1").2,
            [Coordinate(
                Axis::X,
                Word {
                    value: q(1),
                    incremental: false
                }
            )]
        );
    }

    #[test]
    fn digitizing() {
        assert_eq!(probe("TCH PROBE 5.0 RANGE").2, [text("RANGE")]);
        for block in ["PGM NAME: 5007", "PGM NAME:5007", "PGM NAME 5007", "5007"] {
            assert_eq!(
                probe(&format!("TCH PROBE 5.1 {block}")).2,
                [text("5007")],
                "{block}"
            );
        }
        let mut range = vec![CycleWord::Axis(Axis::Z)];
        range.extend([at(Axis::X, 0.0), at(Axis::Y, 0.0), at(Axis::Z, -10.0)]);
        assert_eq!(probe("TCH PROBE 5.2 Z X+0 Y+0 Z-10").2, range);
        assert_eq!(
            probe("TCH PROBE 5.4 HEIGHT: +100").2,
            [text("HEIGHT"), Number(N(100.0))]
        );
        for block in ["DIRECTN: X", "DIRECTN:X"] {
            let words = [text("DIRECTN"), CycleWord::Axis(Axis::X)];
            assert_eq!(probe(&format!("TCH PROBE 6.1 {block}")).2, words, "{block}");
        }
        let values = |words: Vec<CycleWord>| {
            words
                .into_iter()
                .filter(|word| !matches!(word, CycleWord::Text(_)))
                .collect::<Vec<_>>()
        };
        for block in [
            "TRAVEL: 0.5 L.SPAC: 0.2 P.P. INT: 0.8",
            "TRAVEL:0.5 L.SPAC:0.2 P:P.INT:0.8",
        ] {
            let words = values(probe(&format!("TCH PROBE 6.2 {block}")).2);
            assert_eq!(words, [Number(N(0.5)), Number(N(0.2)), Number(N(0.8))], "{block}");
        }
        assert_eq!(
            values(probe("TCH PROBE 7.1 TIME: 200 X+50 Y+0").2),
            [Number(N(200.0)), at(Axis::X, 50.0), at(Axis::Y, 0.0)]
        );
        assert_eq!(
            probe("TCH PROBE 7.2 ORDER Y-/X+").2,
            [
                text("ORDER"),
                AxisDirection(Axis::Y, Direction::Minus),
                AxisDirection(Axis::X, Direction::Plus)
            ]
        );
    }

    #[test]
    fn later_probe_cycles() {
        assert_eq!(
            fault("TCH PROBE 400 BASIC ROTATION Q263=+5"),
            (BlockNotKnown, 1, 13)
        );
        assert_eq!(fault("TCH PROBE").0, bahn_parameters::MessageId::CyclIncomplete);
        assert_eq!(fault("TCHIBO").0, BlockNotKnown);
    }
}
