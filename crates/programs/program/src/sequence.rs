//! The order of the blocks of a cycle: `n.0`, `n.1`, ... without gaps, up to the last one that the cycle
//! needs [003:7923-7928].

use crate::{CycleBlock, CycleFunction, CycleWord, Operation, Quantity, cycle, cycle_parameters};

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
    /// A block that cannot be read stands before: it may be the one that a next block misses.
    in_doubt: bool,
}

#[derive(Debug)]
struct Open {
    function: CycleFunction,
    number: u16,
    /// Number of block n.0 in the program.
    first_block: u32,
    /// The sub-block that comes next; `None` after a fault, so that it is reported once.
    next: Option<u16>,
}

impl Sequence {
    /// Takes the next block of the program.
    pub(crate) fn next(&mut self, number: u32, operation: &Operation) -> Option<SequenceFault> {
        match operation {
            Operation::Comment(_) => None,
            Operation::Cycle(block) => self.cycle_block(number, CycleFunction::Definition, block),
            Operation::Probe(block) => self.cycle_block(number, CycleFunction::Probe, block),
            // What cannot be read may well be the missing block.
            Operation::Invalid(_) => {
                self.open = None;
                self.in_doubt = true;
                None
            }
            _ => {
                self.in_doubt = false;
                self.close()
            }
        }
    }

    fn cycle_block(
        &mut self,
        number: u32,
        function: CycleFunction,
        block: &CycleBlock,
    ) -> Option<SequenceFault> {
        if block.sub == 0 {
            self.in_doubt = false;
            let fault = self.close();
            self.open = Some(Open {
                function,
                number: block.number,
                first_block: number,
                next: Some(1),
            });
            return fault;
        }
        if self.in_doubt {
            return value_missing(number, function, block);
        }
        let expected = match &mut self.open {
            Some(open) if open.function == function && open.number == block.number => match &mut open.next {
                Some(next) if *next == block.sub => {
                    *next += 1;
                    return value_missing(number, function, block);
                }
                Some(next) => *next,
                None => return None,
            },
            _ => {
                let first_block = number;
                self.open = Some(Open {
                    function,
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
        let last = cycle(open.function, open.number)?.last_block()?;
        if next > last {
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
fn value_missing(number: u32, function: CycleFunction, block: &CycleBlock) -> Option<SequenceFault> {
    let parameters = cycle_parameters(function, block.number, block.sub);
    let only_text = block.words.iter().all(|word| matches!(word, CycleWord::Text(_)));
    let is_name = parameters
        .iter()
        .any(|parameter| parameter.quantity == Quantity::Program);
    let named = is_name && !block.words.is_empty();
    if !only_text || named || parameters.iter().all(|parameter| parameter.optional) {
        return None;
    }
    let detail = format!("{}.{} has no value", block.number, block.sub);
    Some(SequenceFault {
        block: number,
        detail,
    })
}
