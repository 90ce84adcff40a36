//! Cycles in listings: the blocks of one become one block again.

use super::cycle::{Form, IsoCycle, of_blocks};
use super::special::feed_value;
use super::write::{Distances, Output};
use crate::format::number::push_integer;
use crate::{Coordinates, CycleBlock, CycleFunction, CycleWord, Modality, Quantity, Value};

impl Output {
    /// The one block of a cycle from its blocks.
    pub(super) fn cycle(
        &mut self,
        code: Option<u16>,
        function: CycleFunction,
        blocks: &[&CycleBlock],
        modality: Modality,
    ) {
        let Some(first) = blocks.first() else { return };
        let words = || blocks.iter().flat_map(|block| &block.words);
        let Some(cycle) = code
            .and_then(super::cycle::of_code)
            .or_else(|| of_blocks(function, blocks))
        else {
            self.d(first.number);
            for word in words() {
                if let CycleWord::Assignment(number, value) = word {
                    self.p(*number, *value);
                }
            }
            return;
        };
        self.word("G");
        push_integer(&mut self.text, u64::from(cycle.code), 2);
        if let Some(axis) = modality.plane {
            self.plane(axis);
        }
        let mut groups = Distances {
            last: modality.distance,
        };
        match cycle.form {
            Form::Parameters => {
                groups.write(self, |_, _| {});
                self.parameters(&cycle, blocks);
            }
            Form::Letter(letter) => {
                groups.write(self, |_, _| {});
                let address = char::from(letter).to_string();
                let value = words().find_map(feed_value);
                match letter {
                    b'H' => self.signed_word(&address, value),
                    _ => self.unsigned_word(&address, value),
                }
            }
            Form::Shift | Form::Positions => {
                let mut all = Coordinates::default();
                words().for_each(|word| {
                    if let CycleWord::Coordinate(axis, word) = word {
                        all.set(*axis, *word);
                    }
                });
                groups.write(self, |out, group| out.group(&all, modality.open, group));
            }
            _ => {
                groups.write(self, |_, _| {});
                self.listed(&cycle, blocks);
            }
        }
    }

    /// P words by the table of cycles.
    fn parameters(&mut self, cycle: &IsoCycle, blocks: &[&CycleBlock]) {
        let mut taken = Vec::new();
        for ((sub, parameter), number) in cycle.parameters().zip(1..) {
            let own = blocks
                .iter()
                .filter(|block| block.sub == sub)
                .flat_map(|block| &block.words);
            let values: Vec<&CycleWord> = own
                .filter(|word| !matches!(word, CycleWord::Sense(_) | CycleWord::Text(_)))
                .collect();
            let before = taken.iter().filter(|of| **of == sub).count();
            taken.push(sub);
            match values.get(before) {
                Some(CycleWord::Coordinate(axis, word)) => {
                    self.p_index(number);
                    self.text.push(axis.letter());
                    self.signed(word.value);
                }
                Some(word) if !parameter.sign.prints_plus() || parameter.quantity == Quantity::Feed => {
                    feed_value(word)
                        .into_iter()
                        .for_each(|value| self.unsigned_p(number, value));
                }
                Some(word) => feed_value(word)
                    .into_iter()
                    .for_each(|value| self.p(number, value)),
                None => {}
            }
        }
    }

    /// What is written one after the other.
    fn listed(&mut self, cycle: &IsoCycle, blocks: &[&CycleBlock]) {
        let mut number = 1;
        for word in blocks.iter().flat_map(|block| &block.words) {
            match word {
                CycleWord::Axis(axis) => {
                    self.word("");
                    self.text.push(axis.letter());
                }
                CycleWord::Labels(labels) => {
                    for label in labels {
                        self.unsigned_p(number, Value::Number(f64::from(*label)));
                        number += 1;
                    }
                }
                CycleWord::Text(name) if cycle.form == Form::Program => {
                    self.p_index(1);
                    self.text.push_str(name);
                }
                CycleWord::Number(value) => self.unsigned_p(1, *value),
                CycleWord::Assignment(q, value) => {
                    self.word("Q");
                    self.integer(*q);
                    self.text.push('=');
                    self.signed(*value);
                }
                CycleWord::Target(q) => self.unsigned_p(1, Value::Number(f64::from(*q))),
                CycleWord::AxisDirection(axis, direction) => {
                    self.p_index(2);
                    self.text.push(axis.letter());
                    self.text.push(direction.symbol());
                    number = 3;
                }
                CycleWord::Coordinate(axis, word) => {
                    self.p_index(number);
                    self.text.push(axis.letter());
                    self.signed(word.value);
                    number += 1;
                }
                _ => {}
            }
        }
    }
}
