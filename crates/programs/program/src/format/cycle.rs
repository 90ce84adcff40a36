//! Cycle and probe blocks in listings.

use super::Output;
use super::path::sense_text;
use crate::cycles::FIRST_PARAMETER_CYCLE;
use crate::{CycleBlock, CycleFunction, CycleParameter, CycleWord, Quantity, Value, cycle_parameters};

/// Whether its numbers are printed without `+` [003:4978] [003:5381] [003:6434].
fn is_unsigned(parameters: &[CycleParameter]) -> bool {
    parameters
        .iter()
        .any(|parameter| parameter.quantity.is_number() && !parameter.sign.prints_plus())
}

impl Output {
    pub(super) fn cycle(&mut self, block: &CycleBlock) {
        self.text.push_str("CYCL DEF ");
        self.integer(u32::from(block.number));
        let first_touches = match block.words.first() {
            Some(CycleWord::Text(text)) => text.starts_with(['.', ',']),
            _ => false,
        };
        if block.number < FIRST_PARAMETER_CYCLE || block.sub != 0 || first_touches {
            self.text.push('.');
            self.integer(u32::from(block.sub));
        }
        let parameters = cycle_parameters(CycleFunction::Definition, block.number, block.sub);
        self.program_word(parameters);
        let unsigned = is_unsigned(parameters);
        self.cycle_words(&block.words, |_| unsigned);
    }

    pub(super) fn probe(&mut self, block: &CycleBlock) {
        self.text.push_str("TCH PROBE ");
        self.integer(u32::from(block.number));
        self.text.push('.');
        self.integer(u32::from(block.sub));
        let parameters = cycle_parameters(CycleFunction::Probe, block.number, block.sub);
        self.program_word(parameters);
        let unsigned = is_unsigned(parameters);
        // An unsigned Q would be the parameter for the result.
        self.cycle_words(&block.words, |value| {
            unsigned && matches!(value, Value::Number(_))
        });
    }

    /// What stands before the name of a program.
    fn program_word(&mut self, parameters: &[CycleParameter]) {
        if let [parameter, ..] = parameters
            && parameter.quantity == Quantity::Program
        {
            self.word(parameter.name);
        }
    }

    fn cycle_words(&mut self, words: &[CycleWord], unsigned: impl Fn(Value) -> bool) {
        for (i, word) in words.iter().enumerate() {
            let before = i.checked_sub(1).and_then(|i| words.get(i));
            if before.is_some_and(|before| needs_separator(before, word)) {
                self.text
                    .push(if matches!(before, Some(CycleWord::AxisDirection(..))) {
                        '/'
                    } else {
                        ':'
                    });
            }
            match word {
                CycleWord::Text(text) => self.word(text),
                CycleWord::Number(value) if unsigned(*value) => self.unsigned_word("", Some(*value)),
                CycleWord::Number(value) => self.signed_word("", Some(*value)),
                CycleWord::Coordinate(axis, word) => {
                    self.word(if word.incremental { "I" } else { "" });
                    self.text.push(axis.letter());
                    self.signed(word.value);
                }
                CycleWord::AxisFactor(axis, value) => {
                    self.unsigned_word(axis.letter().encode_utf8(&mut [0; 4]), Some(*value));
                }
                CycleWord::Centre(axis, value) => {
                    self.word("CC");
                    self.text.push(axis.letter());
                    self.signed(*value);
                }
                CycleWord::Axis(axis) => {
                    self.word("");
                    self.text.push(axis.letter());
                }
                CycleWord::AxisDirection(axis, direction) => {
                    // `Y-/X+`.
                    if !self.text.ends_with('/') {
                        self.word("");
                    }
                    self.text.push(axis.letter());
                    self.text.push(direction.symbol());
                }
                CycleWord::Feed(feed) => self.feed_word(*feed),
                CycleWord::Sense(sense) => self.word(sense_text(*sense)),
                CycleWord::Labels(labels) => {
                    for (i, label) in labels.iter().enumerate() {
                        self.text.push(if i == 0 { ' ' } else { '/' });
                        self.integer(u32::from(*label));
                    }
                }
                CycleWord::Target(number) => {
                    self.word("Q");
                    self.integer(u32::from(*number));
                }
                CycleWord::Assignment(number, value) => {
                    self.word("Q");
                    self.integer(u32::from(*number));
                    self.text.push('=');
                    self.signed(*value);
                }
                CycleWord::M(code) => {
                    self.word("M");
                    self.integer(u32::from(*code));
                }
            }
        }
    }
}

/// Whether two words would read as one without a separator: an axis letter, a short text that may be an
/// address, or a sign, before a value.
fn needs_separator(before: &CycleWord, word: &CycleWord) -> bool {
    let value = matches!(
        word,
        CycleWord::Number(_) | CycleWord::Target(_) | CycleWord::Assignment(..)
    );
    match before {
        CycleWord::Axis(_) => value,
        CycleWord::AxisDirection(..) => value || matches!(word, CycleWord::AxisDirection(..)),
        // In a list of labels a sign is text.
        CycleWord::Text(text) if matches!(word, CycleWord::Labels(_)) => text.ends_with(['+', '-']),
        CycleWord::Text(text) => {
            let last = text.rsplit(' ').next().unwrap_or_default();
            value && (last.len() <= 2 || last.ends_with(['+', '-']))
        }
        _ => false,
    }
}
