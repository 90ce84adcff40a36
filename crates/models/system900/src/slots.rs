//! Which place of a path each logical axis of a channel has.
//!
//! Decision: A path has nine axes. A logical axis whose name is one of their letters, without an extension, has its place;
//! those with other names take what is left in their order, rotary ones A, B, C first, others X, Y, Z, U, V, W. Further axes
//! have none: no program moves them along a path

use bahn_path::{Axis, AxisSet};

use crate::axis_block::AxisBlock;
use crate::memory::Memory;
use crate::numbers::AXES;

/// Logical axes of a channel.
pub const LOGICAL_AXES: usize = AXES as usize;

/// The place of each logical axis of a channel, by its number less 1.
pub fn slots(memory: &Memory, channel: u8) -> [Option<Axis>; LOGICAL_AXES] {
    let mut slots = [None; LOGICAL_AXES];
    let mut taken = AxisSet::EMPTY;
    let words = || {
        let axes = memory.descriptor(channel).axes();
        axes.filter(|(_, word)| word.is_there())
            .map(|(logical, word)| (usize::from(logical) - 1, word))
    };
    for (index, word) in words().filter(|(_, word)| word.extension == 0) {
        let axis = Axis::from_letter(word.letter).filter(|axis| !taken.contains(*axis));
        if let (Some(axis), Some(slot)) = (axis, slots.get_mut(index)) {
            taken.insert(axis);
            *slot = Some(axis);
        }
    }
    for (index, word) in words() {
        let Some(slot) = slots.get_mut(index).filter(|slot| slot.is_none()) else {
            continue;
        };
        let is_rotary = AxisBlock::of(memory, word.physical).is_rotary;
        let free = |axis: &Axis| !taken.contains(*axis);
        let fitting = Axis::ALL
            .into_iter()
            .filter(free)
            .find(|axis| axis.is_rotary() == is_rotary);
        if let Some(axis) = fitting.or_else(|| Axis::ALL.into_iter().find(free)) {
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
