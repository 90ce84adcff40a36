//! Operations of a language that says all itself as blocks of DIN/ISO: the blocks of a cycle become one.

use bahn_path::Plane;
use bahn_program::{
    Compensation, CycleBlock, CycleWord, Distance, Feed, Header, ModalBlock, Modality, Motion, MotionKind,
    Operation, Unit, Value, Word,
};

use crate::canonical::without_names;
use crate::lower::ABSOLUTE;

/// Cycles with coordinates or an angle, which G90 or G91 stands before.
const COUNTING: [u16; 3] = [7, 10, 19];

/// Whether a block belongs to the cycle that `open` began.
pub(crate) fn goes_on(open: &[Operation], next: &Operation) -> bool {
    let (Some(first), Some(last)) = (
        open.first().and_then(cycle_block),
        open.last().and_then(cycle_block),
    ) else {
        return false;
    };
    let same = std::mem::discriminant(open.first().unwrap_or(next)) == std::mem::discriminant(next);
    cycle_block(next).is_some_and(|block| same && block.number == first.number && block.sub > last.sub)
}

/// The block of a cycle definition or a probe function.
pub(crate) fn cycle_block(operation: &Operation) -> Option<&CycleBlock> {
    match operation {
        Operation::Cycle(block) | Operation::Probe(block) => Some(block),
        _ => None,
    }
}

/// The planes that a text has chosen up to a block: that of the tool, and that of the last centre.
#[derive(Clone, Copy)]
pub(crate) struct Planes {
    tool: Plane,
    pub centre: Plane,
}

impl Planes {
    /// Before the first block.
    pub fn start() -> Planes {
        Planes {
            tool: Plane::XY,
            centre: Plane::XY,
        }
    }

    /// A centre with two axes names its plane; one where the tool stands lies in that of the tool.
    pub fn take(&mut self, operation: &Operation) {
        match operation {
            Operation::ToolCall { axis: Some(axis), .. } => {
                self.tool = Plane::of_tool_axis(*axis).unwrap_or(self.tool);
            }
            Operation::CircleCentre(centre) => {
                let mut axes = centre.axes().iter();
                self.centre = match (axes.next(), axes.next()) {
                    (Some(first), Some(second)) => Plane::of_axes(first, second).unwrap_or(self.tool),
                    _ => self.tool,
                };
            }
            _ => {}
        }
    }
}

/// What is written for operations that make one block, with the plane of the centre before them.
pub(crate) fn encoded(operations: &[Operation], lengthens: bool, plane: Plane) -> Option<Operation> {
    let first = operations.first()?;
    if let Some(block) = cycle_block(first) {
        let incremental = operations.iter().filter_map(cycle_block).any(is_incremental);
        let modality = match COUNTING.contains(&block.number) && matches!(first, Operation::Cycle(_)) {
            false => Modality::default(),
            true if incremental => Modality {
                distance: Some(Distance::Incremental),
                ..ABSOLUTE
            },
            true => ABSOLUTE,
        };
        return Some(Operation::Modal(Box::new(ModalBlock {
            code: None,
            modality,
            operations: operations.iter().map(without_names).collect(),
        })));
    }
    Some(match first {
        Operation::Begin(header) => Operation::Begin(with_unit(header)),
        Operation::End(header) => Operation::End(with_unit(header)),
        Operation::Motion(motion) if motion.kind == MotionKind::Paraxial => {
            // Without R+ and R- an axis key moves as L does.
            let plain = matches!(motion.compensation, None | Some(Compensation::Off)) && !lengthens;
            let mut motion = motion.clone();
            if plain && motion.feed == Some(Feed::Max) {
                motion.kind = MotionKind::Line;
            }
            Operation::Motion(motion)
        }
        Operation::Motion(motion) if is_bare_circle(motion) => Operation::Motion(full_circle(motion, plane)),
        other => other.clone(),
    })
}

/// A circle without an end ends where it began; in DIN/ISO a block without words only chooses its function.
fn is_bare_circle(motion: &Motion) -> bool {
    motion.kind == MotionKind::Circle && motion.coordinates.is_empty()
}

/// A full circle, to where the tool stands in the axes of its plane.
fn full_circle(motion: &Motion, plane: Plane) -> Motion {
    let mut circle = motion.clone();
    for axis in [plane.first, plane.second] {
        let word = Word {
            value: Value::Number(0.0),
            incremental: true,
        };
        circle.coordinates.set(axis, word);
    }
    circle
}

/// What [`encoded`] comes back as.
pub(crate) fn expected(operations: &[Operation], encoded: &Operation) -> Vec<Operation> {
    match encoded {
        Operation::Modal(_) => operations.to_vec(),
        other => vec![other.clone()],
    }
}

fn is_incremental(block: &CycleBlock) -> bool {
    block.words.iter().any(|word| match word {
        CycleWord::Coordinate(_, word) => word.incremental,
        CycleWord::Text(text) => &**text == "IROT",
        _ => false,
    })
}

/// The frame of an ISO program has a unit, or it would be a call.
fn with_unit(header: &Header) -> Box<Header> {
    Box::new(Header {
        unit: Some(header.unit.unwrap_or(Unit::Mm)),
        ..header.clone()
    })
}
