//! Actual position capture [003:2260-2321].

use bahn_parameters::MessageId::{self, EntryValueIncorrect, KeyNonFunctional};
use bahn_path::Axis;

use crate::dialogue::Dialogue;
use crate::editor::{Editor, Open};
use crate::{Reaction, Wanted, Word};

impl Editor {
    /// Gives the actual position of an axis, mm or degrees, for the value that is being entered or highlighted.
    pub fn capture(&mut self, axis: Axis, value: f64) -> Reaction {
        let fits =
            |wanted: Option<Wanted>| wanted == Some(Wanted::Axis(axis)) || wanted == Some(Wanted::ToolAxis);
        let value = self.position_text(axis, value);
        let done = match &mut self.open {
            Open::Dialogue(dialogue) if fits(dialogue.wants_position()) => dialogue.capture(value),
            Open::Highlight(highlight)
                if fits(highlight.wants_position()) && !self.program.is_protected() =>
            {
                highlight.capture(value)
            }
            Open::Entry(entry) if entry.axis() == Some(axis) && !self.program.is_protected() => {
                entry.capture(&value)
            }
            _ => Err(KeyNonFunctional),
        };
        let done = done.map(|()| Reaction::Shown);
        self.reaction(done)
    }

    /// Puts an L block with the actual position of several axes, mm or degrees, after the cursor, without radius
    /// compensation, feed or M function [003:2311-2316].
    pub fn capture_block(&mut self, position: &[(Axis, f64)]) -> Reaction {
        let done = match self.open {
            Open::Nothing => self.insert_position(position),
            _ => Err(KeyNonFunctional),
        };
        self.reaction(done)
    }

    fn insert_position(&mut self, position: &[(Axis, f64)]) -> Result<Reaction, MessageId> {
        if self.is_iso() {
            let words = position
                .iter()
                .map(|(axis, value)| (*axis, self.position_text(*axis, *value)));
            return match position.is_empty() {
                true => Err(EntryValueIncorrect),
                false => self.iso_position(&words.collect::<Vec<_>>()),
            };
        }
        let dialogue = Dialogue::of_id("L", &self.setting).ok_or(KeyNonFunctional)?;
        let texts = position
            .iter()
            .map(|(axis, value)| (*axis, self.position_text(*axis, *value)));
        let texts: Vec<_> = texts.collect();
        let mut line = dialogue.lines.into_iter().next().ok_or(KeyNonFunctional)?;
        let field = line.field_mut(0).ok_or(KeyNonFunctional)?;
        if position.is_empty() || position.len() > field.slot.ask.most(self.setting.model.limits()) {
            return Err(EntryValueIncorrect);
        }
        field.words = texts
            .into_iter()
            .map(|(axis, value)| Word {
                incremental: false,
                address: axis.to_string(),
                value,
            })
            .collect();
        self.context(None).check(&line, [])?;
        let text = self.block_text(&line)?;
        self.insert(&[text])
    }

    /// A position in the unit of the program and its input steps, as it can be entered [003:7825].
    fn position_text(&self, axis: Axis, value: f64) -> String {
        let unit = self.program.unit();
        let steps = self.setting.steps(unit);
        let (value, step) = match axis.is_rotary() {
            true => (value, steps.angle()),
            false => (value / unit.mm(), steps.length()),
        };
        number_text((value / step).round() * step)
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
