//! Which block sets which label.

use crate::rope::Rope;

/// Most repeated labels that are kept to be reported.
const MAX_REPEATED: usize = 1000;
const NO_BLOCK: u32 = u32::MAX;

/// The labels of a program.
#[derive(Clone, Debug, Default)]
pub(crate) struct Labels {
    /// Block of the first LBL of each number, [`NO_BLOCK`] where there is none.
    first: Vec<u32>,
    /// Further LBL blocks of a number that is set already: label and block.
    repeated: Vec<(u16, u32)>,
}

impl Labels {
    pub(crate) fn of(rope: &Rope) -> Labels {
        let mut labels = Labels::default();
        for (index, piece) in rope.pieces().iter().enumerate() {
            let (first, _) = rope.start(index);
            for &(label, block) in &piece.labels {
                labels.set(label, first + block);
            }
        }
        labels
    }

    fn set(&mut self, label: u16, block: u32) {
        let slot = usize::from(label);
        if self.first.len() <= slot {
            self.first.resize(slot + 1, NO_BLOCK);
        }
        match self.first.get_mut(slot) {
            Some(first) if *first == NO_BLOCK => *first = block,
            _ if self.repeated.len() < MAX_REPEATED => self.repeated.push((label, block)),
            _ => {}
        }
    }

    /// Number of the block that sets a label first; `None` where none does.
    pub(crate) fn block(&self, label: u16) -> Option<u32> {
        self.first
            .get(usize::from(label))
            .copied()
            .filter(|&block| block != NO_BLOCK)
    }

    /// All labels with their blocks, in ascending order.
    pub(crate) fn all(&self) -> impl Iterator<Item = (u16, u32)> {
        (0..=u16::MAX)
            .zip(self.first.iter().copied())
            .filter(|&(_, block)| block != NO_BLOCK)
    }

    pub(crate) fn repeated(&self) -> &[(u16, u32)] {
        &self.repeated
    }
}
