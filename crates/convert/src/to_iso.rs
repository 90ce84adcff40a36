//! Operations of a language that says all itself as blocks of DIN/ISO: the blocks of a cycle become one.

use bahn_path::{Axis, Plane};
use bahn_program::{
    Compensation, CycleBlock, CycleWord, Distance, Feed, Header, ModalBlock, Modality, Motion, MotionKind,
    Operation, Program, Unit, Value, Word,
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

/// What of a program decides how its blocks are written.
pub(crate) struct Ways {
    /// R+ and R- stand somewhere: an axis key is no line then.
    lengthens: bool,
    /// The working plane, where all its tools have one axis.
    plane: Option<Plane>,
}

impl Ways {
    pub fn of(program: &Program) -> Ways {
        let mut ways = Ways {
            lengthens: false,
            plane: Plane::of_tool_axis(Axis::Z),
        };
        let mut tool_axis = None;
        for numbered in program.blocks() {
            match &numbered.block.operation {
                Operation::Motion(motion) => {
                    ways.lengthens |= matches!(
                        motion.compensation,
                        Some(Compensation::Lengthen | Compensation::Shorten)
                    );
                }
                Operation::ToolCall { axis: Some(axis), .. } => {
                    let same = *tool_axis.get_or_insert(*axis) == *axis;
                    ways.plane = Plane::of_tool_axis(*axis).filter(|_| same && ways.plane.is_some());
                }
                _ => {}
            }
        }
        ways
    }
}

/// What is written for operations that make one block.
pub(crate) fn encoded(operations: &[Operation], ways: &Ways) -> Option<Operation> {
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
            let plain = matches!(motion.compensation, None | Some(Compensation::Off)) && !ways.lengthens;
            let mut motion = motion.clone();
            if plain && motion.feed == Some(Feed::Max) {
                motion.kind = MotionKind::Line;
            }
            Operation::Motion(motion)
        }
        Operation::Motion(motion) if motion.kind == MotionKind::Circle && motion.coordinates.is_empty() => {
            Operation::Motion(full_circle(motion, ways.plane))
        }
        other => other.clone(),
    })
}

/// `C DR+` goes all the way round. A block of DIN/ISO needs words for that: no way in either axis of the plane.
fn full_circle(motion: &Motion, plane: Option<Plane>) -> Motion {
    let mut motion = motion.clone();
    for axis in plane.iter().flat_map(|plane| [plane.first, plane.second]) {
        let stays = Word {
            value: Value::Number(0.0),
            incremental: true,
        };
        motion.coordinates.set(axis, stays);
    }
    motion
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
