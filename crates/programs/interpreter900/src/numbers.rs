//! Blocks by their numbers, as the control shows them.

use bahn_path::BlockRef;

use crate::reader::Reader900;

impl Reader900 {
    /// The N of a block; of one without a number its place in the file.
    pub fn number_of(&self, block: BlockRef) -> u32 {
        let Some(file) = self.files.get(block.program.into()) else {
            return block.block;
        };
        let own = file.words.number_in(file.text.line_of(block.block));
        own.unwrap_or(block.block)
    }
}
