//! The G functions that are cycles: a table of which cycle each is, and how its words become the blocks of that cycle.
//! What a P word stands for follows from the table of cycles: P01, P02, ... are the parameters in the order in which the
//! dialogue asks for them.

use crate::CycleFunction::{self, Definition, Probe};
use crate::{CycleBlock, CycleParameter, CycleWord, Feed, Quantity, Value, cycle};
use bahn_path::Sense;

/// How the words of a cycle are written.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Form {
    /// `P01 -2 P02 -20 ...` in the order of the table of cycles, without the direction.
    Parameters,
    /// One number after a letter of its own: F of G04, H of G73.
    Letter(u8),
    /// Letters of axes alone.
    Axes,
    /// Coordinates, in a block n.1, n.2, ... each.
    Shift,
    /// Coordinates in block n.1.
    Positions,
    /// The line of a datum table after P01.
    TableLine,
    /// P words with a label each.
    Labels,
    /// The name of a program after P01.
    Program,
    /// `Q1=+5` words.
    Assignments,
    /// P words: parameter of the result, axis with direction, position.
    Probing,
}

/// A G function that is a cycle.
#[derive(Clone, Copy, Debug)]
pub(super) struct IsoCycle {
    /// The number after G.
    pub(super) code: u16,
    /// Its kind and number in plain language.
    pub(super) function: CycleFunction,
    pub(super) number: u16,
    /// The direction that the function itself says.
    pub(super) turn: Option<Sense>,
    pub(super) form: Form,
}

const fn row(code: u16, number: u16, form: Form) -> IsoCycle {
    IsoCycle {
        code,
        function: Definition,
        number,
        turn: None,
        form,
    }
}

const fn turning(code: u16, number: u16, turn: Sense) -> IsoCycle {
    IsoCycle {
        turn: Some(turn),
        ..row(code, number, Form::Parameters)
    }
}

/// The table (public: reference cards of the TNC 360 and 426). G53, G80 and G120 to G127 belong to later controls than
/// the TNC 360.
#[rustfmt::skip]
const TABLE: &[IsoCycle] = &[
    row(4, 9, Form::Letter(b'F')),
    row(28, 8, Form::Axes),
    row(36, 13, Form::Letter(b'S')),
    row(37, 14, Form::Labels),
    row(39, 12, Form::Program),
    row(53, 7, Form::TableLine),
    row(54, 7, Form::Shift),
    IsoCycle { function: Probe, ..row(55, 0, Form::Probing) },
    row(56, 15, Form::Parameters),
    row(57, 6, Form::Parameters),
    turning(58, 16, Sense::Clockwise),
    turning(59, 16, Sense::CounterClockwise),
    row(72, 11, Form::Letter(b'F')),
    row(73, 10, Form::Letter(b'H')),
    row(74, 3, Form::Parameters),
    turning(75, 4, Sense::Clockwise),
    turning(76, 4, Sense::CounterClockwise),
    turning(77, 5, Sense::Clockwise),
    turning(78, 5, Sense::CounterClockwise),
    row(80, 19, Form::Positions),
    row(83, 1, Form::Parameters),
    row(84, 2, Form::Parameters),
    row(85, 17, Form::Parameters),
    row(86, 18, Form::Parameters),
    row(120, 20, Form::Assignments),
    row(121, 21, Form::Assignments),
    row(122, 22, Form::Assignments),
    row(123, 23, Form::Assignments),
    row(124, 24, Form::Assignments),
    row(125, 25, Form::Assignments),
    row(127, 27, Form::Assignments),
];

/// The cycle of a G function. From 200 on both have the same number.
pub(super) fn of_code(code: u16) -> Option<IsoCycle> {
    match code {
        200..=299 => Some(row(code, code, Form::Assignments)),
        _ => TABLE.iter().find(|row| row.code == code).copied(),
    }
}

/// The G function whose definition these blocks are, if one is.
pub(super) fn of_blocks(function: CycleFunction, blocks: &[&CycleBlock]) -> Option<IsoCycle> {
    let first = blocks.first()?;
    let words = || blocks.iter().flat_map(|block| &block.words);
    let direction = words().find_map(|word| match word {
        CycleWord::Sense(sense) => Some(*sense),
        _ => None,
    });
    let line = words().any(|word| matches!(word, CycleWord::Number(_)));
    if let Some(alike) = of_code(first.number).filter(|_| first.number >= 200) {
        return Some(alike);
    }
    let mut rows = TABLE.iter().filter(|row| {
        row.function == function
            && row.number == first.number
            && (row.turn.is_none() || row.turn == direction)
    });
    rows.find(|row| row.number != 7 || line == (row.form == Form::TableLine))
        .copied()
}

impl IsoCycle {
    /// The parameters that P words stand for, each with its block, in their order.
    pub(super) fn parameters(&self) -> impl Iterator<Item = (u16, CycleParameter)> + use<> {
        let blocks = cycle(self.function, self.number).map_or(&[][..], |cycle| cycle.blocks);
        (1_u16..).zip(blocks).flat_map(|(sub, parameters)| {
            let asked = parameters
                .iter()
                .filter(|parameter| parameter.quantity != Quantity::Turn);
            asked.map(move |parameter| (sub, *parameter))
        })
    }

    /// A block of it without words.
    pub(super) fn block(&self, sub: u16) -> CycleBlock {
        CycleBlock {
            number: self.number,
            sub,
            words: Vec::new(),
        }
    }

    /// The blocks of the definition from its parameters, with the direction where the table of cycles asks for it.
    pub(super) fn blocks(&self, words: &[(u16, CycleWord)]) -> Vec<CycleBlock> {
        let mut made = vec![self.block(0)];
        let rows = cycle(self.function, self.number).map_or(&[][..], |cycle| cycle.blocks);
        for (sub, parameters) in (1_u16..).zip(rows) {
            let mut block = self.block(sub);
            let mut own = words
                .iter()
                .filter(|(of, _)| *of == sub)
                .map(|(_, word)| word.clone());
            for parameter in *parameters {
                match (parameter.quantity, self.turn) {
                    (Quantity::Turn, Some(turn)) => block.words.push(CycleWord::Sense(turn)),
                    (Quantity::Turn, None) => {}
                    _ => block.words.extend(own.next()),
                }
            }
            made.push(block);
        }
        made
    }
}

/// What a value after a P is in its block.
pub(super) fn word_of(quantity: Quantity, value: Value) -> CycleWord {
    match quantity {
        Quantity::Feed => CycleWord::Feed(Feed::Value(value)),
        _ => CycleWord::Number(value),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// G74 P01 clearance P02 depth P03 peck P04 F P05 X P06 Y P07 F.
    #[test]
    fn p_words_follow_the_dialogue() {
        let asked = |code: u16| -> Vec<&str> {
            let of = of_code(code).unwrap();
            of.parameters().map(|(_, parameter)| parameter.name).collect()
        };
        assert_eq!(asked(74), ["SET UP", "DEPTH", "PECKG", "F", "", "", "F"]);
        assert_eq!(asked(83), ["SET UP", "DEPTH", "PECKG", "DWELL", "F"]);
        assert_eq!(
            asked(57),
            ["SET UP", "DEPTH", "PECKG", "F", "ALLOW", "ANGLE", "F"]
        );
        assert_eq!(asked(59), ["SET UP", "DEPTH", "PECKG", "F", "F"]);
        assert_eq!(
            asked(76),
            ["SET UP", "DEPTH", "PECKG", "F", "", "", "F", "RADIUS"]
        );
    }

    #[test]
    fn every_cycle_of_the_table_is_one() {
        for row in TABLE {
            let known = cycle(row.function, row.number);
            assert!(known.is_some(), "G{}", row.code);
        }
    }
}
