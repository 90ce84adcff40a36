//! Blocks that are longer than the control takes: 150 characters in DIN/ISO [000:615], 64 on the TNC 151/155
//! [001:1174-1183].
//!
//! Decision: A block of DIN/ISO that is longer than the control takes cannot be read, in a run as in a check

use bahn_parameters::{Limits, MessageId};

use crate::program::{Chunk, Places};
use crate::text::{character_count, to_text};
use crate::{BlockError, InvalidBlock, Operation, Program};

impl Places<'_> {
    /// What is wrong with a block of more characters than `max`.
    pub(crate) fn too_long(&self, block: u32, max: u32) -> Option<BlockError> {
        let raw = self.of(block)?;
        // A character has one byte at least.
        if raw.end - raw.start <= max as usize {
            return None;
        }
        let length = character_count(raw.text(self.piece.text()).bytes);
        (length > max).then(|| BlockError {
            message: MessageId::EntryValueIncorrect,
            line: 0,
            column: max + 1,
            length: length - max,
            detail: format!("a block has at most {max} characters").into(),
            help: None,
        })
    }

    fn text(&self, block: u32) -> Box<str> {
        let text = self
            .of(block)
            .map(|raw| to_text(raw.text(self.piece.text()).bytes));
        text.unwrap_or_default().into()
    }
}

impl Program {
    /// [`Program::decode`] for a control model: a block that is longer than the model takes cannot be read.
    pub fn decode_for(&self, chunk: u32, limits: &Limits) -> Chunk {
        let mut decoded = self.decode(chunk);
        if let Some(max) = self.language().characters_max(limits) {
            self.refuse_long(&mut decoded, max);
        }
        decoded
    }

    /// Puts a block that cannot be read in the place of each that is longer than `max` characters.
    fn refuse_long(&self, chunk: &mut Chunk, max: u32) {
        let mut places: Option<Places<'_>> = None;
        for (number, block) in (chunk.first_block..).zip(&mut chunk.blocks) {
            let here = places.take().filter(|places| places.of(number).is_some());
            places = here.or_else(|| self.places_of(number));
            let Some(places) = &places else { continue };
            if let Some(error) = places.too_long(number, max) {
                let text = places.text(number);
                block.operation = Operation::Invalid(Box::new(InvalidBlock { text, error }));
            }
        }
    }
}
