//! What a language with G functions leaves to the functions in force: [`Modality`] of a positioning block, and
//! [`ModalBlock`] for blocks that do several things at once.

mod modality;

use crate::{CycleBlock, CycleWord, MFunctions, ModalBlock, Motion, MotionKind, Operation};

pub use modality::{Distance, Modality, PathFunction};

impl PathFunction {
    /// The path function that it stands for; an arc with a radius is [`MotionKind::CircleRadius`] instead.
    #[inline]
    pub const fn kind(self) -> MotionKind {
        match self {
            PathFunction::Rapid | PathFunction::Line => MotionKind::Line,
            PathFunction::Clockwise | PathFunction::CounterClockwise | PathFunction::Arc => {
                MotionKind::Circle
            }
            PathFunction::Tangential => MotionKind::CircleTangential,
            PathFunction::Paraxial => MotionKind::Paraxial,
            PathFunction::PolarRapid | PathFunction::PolarLine => MotionKind::LinePolar,
            PathFunction::PolarClockwise | PathFunction::PolarCounterClockwise | PathFunction::PolarArc => {
                MotionKind::CirclePolar
            }
            PathFunction::PolarTangential => MotionKind::CircleTangentialPolar,
        }
    }
}

impl ModalBlock {
    /// Its operations with the words that the functions in force make incremental.
    pub fn resolved(&self, distance: Distance) -> impl Iterator<Item = Operation> {
        let incremental = distance == Distance::Incremental;
        let modality = self.modality;
        self.operations.iter().map(move |operation| {
            let mut operation = operation.clone();
            if incremental {
                make_incremental(&mut operation, modality);
            }
            operation
        })
    }
}

fn make_incremental(operation: &mut Operation, modality: Modality) {
    match operation {
        Operation::CircleCentre(words) | Operation::BlankMax(words) => words.make_incremental(modality.open),
        Operation::Cycle(block) => make_cycle_incremental(block, modality),
        _ => {}
    }
}

/// A datum shift and a rotation may be incremental.
fn make_cycle_incremental(block: &mut CycleBlock, modality: Modality) {
    for word in &mut block.words {
        match word {
            CycleWord::Coordinate(axis, word) if block.number == 7 && modality.open.contains(*axis) => {
                word.incremental = true;
            }
            CycleWord::Text(text) if block.number == 10 && modality.open_angle => *text = "IROT".into(),
            _ => {}
        }
    }
}

impl Operation {
    /// What a block does, one after the other: mostly itself alone.
    #[inline]
    pub fn parts(&self) -> &[Operation] {
        match self {
            Operation::Modal(block) => &block.operations,
            _ => std::slice::from_ref(self),
        }
    }

    /// The M functions of the block; `None` where its kind takes none.
    pub fn m(&self) -> Option<&MFunctions> {
        self.parts().iter().find_map(|part| match part {
            Operation::Motion(Motion { m, .. })
            | Operation::Stop(m)
            | Operation::Miscellaneous(m)
            | Operation::CycleCall(m) => Some(m),
            _ => None,
        })
    }
}
