//! Operations of a language that says all itself as blocks of DIN/ISO: the blocks of a cycle become one.

use bahn_program::{
    Compensation, CycleBlock, CycleWord, Distance, Feed, Header, ModalBlock, Modality, MotionKind, Operation,
    Unit,
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

/// What is written for operations that make one block.
pub(crate) fn encoded(operations: &[Operation], lengthens: bool) -> Option<Operation> {
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
        other => other.clone(),
    })
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
