//! Actual position capture [003:2260-2321].

use bahn_parameters::MessageId::{self, EntryValueIncorrect, KeyNonFunctional};
use bahn_path::Axis;

use crate::Word;
use crate::dialogue::Dialogue;
use crate::editor::{Editor, Open, Reaction};

impl Editor {
    /// Gives the actual position of an axis for the value that is being entered.
    pub fn capture(&mut self, axis: Axis, value: f64) -> Reaction {
        let done = match &mut self.open {
            Open::Dialogue(dialogue) => match dialogue.wants_position() {
                Some(wanted) if wanted.is_none_or(|wanted| wanted == axis) => {
                    dialogue.capture(number_text(value)).map(|()| Reaction::Shown)
                }
                _ => Err(KeyNonFunctional),
            },
            _ => Err(KeyNonFunctional),
        };
        self.reaction(done)
    }

    /// Puts an L block with the actual position of several axes behind the cursor, without radius compensation, feed or
    /// M function [003:2311-2316].
    pub fn capture_block(&mut self, position: &[(Axis, f64)]) -> Reaction {
        let done = match self.open {
            Open::Nothing => self.insert_position(position),
            _ => Err(KeyNonFunctional),
        };
        self.reaction(done)
    }

    fn insert_position(&mut self, position: &[(Axis, f64)]) -> Result<Reaction, MessageId> {
        let dialogue = Dialogue::of_id("L").ok_or(KeyNonFunctional)?;
        let mut line = dialogue.lines.into_iter().next().ok_or(KeyNonFunctional)?;
        let field = line.field_mut(0).ok_or(KeyNonFunctional)?;
        if position.is_empty() || position.len() > field.slot.ask.most(self.setting.model.limits()) {
            return Err(EntryValueIncorrect);
        }
        field.words = position
            .iter()
            .map(|(axis, value)| Word {
                incremental: false,
                address: axis.to_string(),
                value: number_text(*value),
            })
            .collect();
        self.context(None).check(&line, [])?;
        let text = self.block_text(&line)?;
        self.insert(&[text])
    }
}

/// A position as it is entered: without an exponent.
fn number_text(value: f64) -> String {
    let text = format!("{value:.6}");
    let text = text.trim_end_matches('0').trim_end_matches('.');
    match text {
        "-0" => "0".to_owned(),
        text => text.to_owned(),
    }
}
