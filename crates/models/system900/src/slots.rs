//! Which place of a path each logical axis of a channel has.
//!
//! Decision: A logical axis with a letter alone is the axis of the path with this letter; others, those with an extension
//! or another letter, get the free ones in the order U V W A B C X Y Z. A path has nine axes; no program moves others, nor
//! those without a letter

use bahn_path::{Axis, AxisSet};

use crate::memory::Memory;
use crate::numbers::AXES;

/// Logical axes of a channel.
pub const LOGICAL_AXES: usize = AXES as usize;

/// What axes without a letter of their own on the path get.
const FREE: &[Axis] = &[
    Axis::U,
    Axis::V,
    Axis::W,
    Axis::A,
    Axis::B,
    Axis::C,
    Axis::X,
    Axis::Y,
    Axis::Z,
];

/// The place of each logical axis of a channel, by its number less 1.
pub fn slots(memory: &Memory, channel: u8) -> [Option<Axis>; LOGICAL_AXES] {
    let mut slots = [None; LOGICAL_AXES];
    let mut taken = AxisSet::EMPTY;
    let words = || {
        let axes = memory.descriptor(channel).axes();
        axes.filter(|(_, word)| word.is_there())
            .map(|(logical, word)| (usize::from(logical) - 1, word))
    };
    let named = || words().filter(|(_, word)| word.letter != 0);
    for (index, word) in named().filter(|(_, word)| word.extension == 0) {
        let axis = Axis::from_letter(word.letter).filter(|axis| !taken.contains(*axis));
        if let (Some(axis), Some(slot)) = (axis, slots.get_mut(index)) {
            taken.insert(axis);
            *slot = Some(axis);
        }
    }
    for (index, _) in named() {
        let free = FREE.iter().copied().find(|axis| !taken.contains(*axis));
        if let (Some(axis), Some(slot @ None)) = (free, slots.get_mut(index)) {
            taken.insert(axis);
            *slot = Some(axis);
        }
    }
    slots
}

impl Memory {
    /// The axes of a channel: logical number, physical number.
    pub fn axes_of(&self, channel: u8) -> impl Iterator<Item = (u8, u8)> {
        let axes = self.descriptor(channel).axes();
        axes.filter(|(_, word)| word.is_there())
            .map(|(logical, word)| (logical, word.physical))
    }
}
