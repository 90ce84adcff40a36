//! The order of the blocks of a cycle: `n.0`, `n.1`, ... without gaps, up to the last one that the cycle
//! needs [003:7923-7928].

use crate::{CycleBlock, CycleWord, Operation};

/// Number of the last block that a cycle needs.
const LAST_CYCLE_BLOCKS: &[(u16, u16)] = &[
    (1, 5),
    (2, 4),
    (3, 6),
    (4, 6),
    (5, 5),
    (6, 3),
    (7, 1),
    (8, 1),
    (9, 1),
    (10, 1),
    (11, 1),
    (12, 1),
    (13, 1),
    (14, 1),
    (15, 2),
    (16, 2),
    (17, 3),
];
/// Number of the last block that a probe function needs.
const LAST_PROBE_BLOCKS: &[(u16, u16)] = &[(0, 1), (5, 4), (6, 2), (7, 3)];
/// Cycle 8 without an axis cancels the mirror image [003:6292-6294].
const MIRROR_IMAGE: u16 = 8;

/// A cycle that is not complete.
#[derive(Debug)]
pub(crate) struct SequenceFault {
    pub(crate) block: u32,
    pub(crate) detail: String,
}

/// The cycle whose blocks are being read.
#[derive(Debug, Default)]
pub(crate) struct Sequence {
    open: Option<Open>,
}

#[derive(Debug)]
struct Open {
    probe: bool,
    number: u16,
    /// Block n.0.
    first_block: u32,
    /// The sub-block that comes next; `None` behind a fault, so that it is reported once.
    next: Option<u16>,
}

impl Sequence {
    /// Takes the next block of the program.
    pub(crate) fn next(&mut self, number: u32, operation: &Operation) -> Option<SequenceFault> {
        match operation {
            Operation::Comment(_) => None,
            Operation::Cycle(block) => self.cycle_block(number, false, block),
            Operation::Probe(block) => self.cycle_block(number, true, block),
            // What cannot be read may well be the missing block.
            Operation::Invalid(_) => {
                self.open = None;
                None
            }
            _ => self.close(),
        }
    }

    fn cycle_block(&mut self, number: u32, probe: bool, block: &CycleBlock) -> Option<SequenceFault> {
        if block.sub == 0 {
            let fault = self.close();
            self.open = Some(Open {
                probe,
                number: block.number,
                first_block: number,
                next: Some(1),
            });
            return fault;
        }
        let expected = match &mut self.open {
            Some(open) if open.probe == probe && open.number == block.number => match &mut open.next {
                Some(next) if *next == block.sub => {
                    *next += 1;
                    return value_missing(number, probe, block);
                }
                Some(next) => *next,
                None => return None,
            },
            _ => {
                let first_block = number;
                self.open = Some(Open {
                    probe,
                    number: block.number,
                    first_block,
                    next: None,
                });
                return Some(SequenceFault {
                    block: number,
                    detail: format!("{}.0 is missing", block.number),
                });
            }
        };
        if let Some(open) = &mut self.open {
            open.next = None;
        }
        let detail = format!("{n}.{expected} comes before {n}.{}", block.sub, n = block.number);
        Some(SequenceFault {
            block: number,
            detail,
        })
    }

    /// The cycle ends before a block that is none of its own.
    fn close(&mut self) -> Option<SequenceFault> {
        let open = self.open.take()?;
        let next = open.next?;
        let table = if open.probe {
            LAST_PROBE_BLOCKS
        } else {
            LAST_CYCLE_BLOCKS
        };
        let (_, last) = table.iter().find(|(number, _)| *number == open.number)?;
        if next > *last {
            return None;
        }
        let detail = match last - next {
            0 => format!("{}.{last} is missing", open.number),
            _ => format!("{n}.{next} to {n}.{last} are missing", n = open.number),
        };
        Some(SequenceFault {
            block: open.first_block,
            detail,
        })
    }
}

/// A block of a known cycle that holds nothing but decoration.
fn value_missing(number: u32, probe: bool, block: &CycleBlock) -> Option<SequenceFault> {
    let table = if probe {
        LAST_PROBE_BLOCKS
    } else {
        LAST_CYCLE_BLOCKS
    };
    let known = table.iter().any(|(number, _)| *number == block.number);
    let may_be_text = if probe {
        block.number == 5
    } else {
        matches!(block.number, MIRROR_IMAGE | 12)
    };
    let only_text = block.words.iter().all(|word| matches!(word, CycleWord::Text(_)));
    let empty_name = block.number == 12 && block.words.is_empty();
    if !known || !only_text || (may_be_text && !empty_name) {
        return None;
    }
    let detail = format!("{}.{} has no value", block.number, block.sub);
    Some(SequenceFault {
        block: number,
        detail,
    })
}
