//! Bit instructions as truth tables.
//!
//! Every bit instruction makes of the logic accumulator and one cell a new logic accumulator and a new content
//! of the cell: `A` changes only the one, `=` only the other. So a table of four entries for each says all,
//! and one loop without a branch executes loads, gates, assignments, sets, resets and brackets.

use bahn_exchange::CELLS;

use crate::operand::BitOperand;
use crate::program::Op;

/// Brackets on the logic accumulator are buffered in the last cells of the image, which no operand has.
const BRACKETS_AT: usize = CELLS - BRACKETS;
const BRACKETS: usize = 16;

/// One bit instruction.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) struct BitStep {
    cell: u16,
    /// Bit `2 * content + LA` is the new LA, bit `4 + 2 * content + LA` the new content.
    table: u8,
}

impl BitStep {
    /// The step of an instruction; `None` for all but bit instructions without index.
    pub(super) fn of(op: &Op) -> Option<BitStep> {
        let cell_of = |bit: &BitOperand| (!bit.indexed).then(|| bit.bit.cell());
        match op {
            Op::LoadBit { bit, invert } => BitStep::new(cell_of(bit)?, |_, cell| (cell != *invert, cell)),
            Op::GateBit { gate, bit } => BitStep::new(cell_of(bit)?, |la, cell| (gate.bits(la, cell), cell)),
            Op::AssignBit { bit, invert } => BitStep::new(cell_of(bit)?, |la, _| (la, la != *invert)),
            Op::SetBit { bit, value, when } => BitStep::new(cell_of(bit)?, |la, cell| {
                (la, if la == *when { *value } else { cell })
            }),
            Op::OpenLogic { level } => BitStep::new(bracket(*level)?, |la, _| (la, la)),
            Op::CloseLogic { level, gate } => {
                BitStep::new(bracket(*level)?, |la, outside| (gate.bits(outside, la), outside))
            }
            _ => None,
        }
    }

    /// `rule` makes of LA and content the new LA and the new content.
    fn new(cell: usize, rule: impl Fn(bool, bool) -> (bool, bool)) -> Option<BitStep> {
        let states = [(false, false), (true, false), (false, true), (true, true)];
        let table = states.into_iter().enumerate().fold(0, |table, (at, (la, cell))| {
            let (la, cell) = rule(la, cell);
            table | u8::from(la) << at | u8::from(cell) << (4 + at)
        });
        let cell = u16::try_from(cell).ok()?;
        Some(BitStep { cell, table })
    }
}

fn bracket(level: u8) -> Option<usize> {
    let level = usize::from(level);
    (level < BRACKETS).then_some(BRACKETS_AT + level)
}

/// Executes steps; takes and gives the logic accumulator.
#[inline(always)]
pub(super) fn run(steps: &[BitStep], cells: &mut [u8; CELLS], logic: bool) -> bool {
    let mut logic = u32::from(logic);
    for step in steps {
        let cell = &mut cells[usize::from(step.cell) % CELLS];
        let content = u32::from(*cell);
        let result = u32::from(step.table)
            .wrapping_shr(content + content)
            .wrapping_shr(logic);
        logic = result & 1;
        *cell = (result >> 4) as u8 & 1;
    }
    logic != 0
}

/// The cell of the first of consecutive bits; `None` with index, or when the last is behind its area.
pub(super) fn consecutive(first: &BitOperand, count: u8) -> Option<u16> {
    let last = first.bit.number() + u16::from(count.checked_sub(1)?);
    let inside = !first.indexed && count <= 32 && last <= first.bit.area().last();
    u16::try_from(first.bit.cell()).ok().filter(|_| inside)
}

/// Reads consecutive bits, the first one lowest, sign-filled from the last one [000:12186-12223].
#[inline(always)]
pub(super) fn read(cells: &[u8; CELLS], cell: u16, count: u8) -> i32 {
    let bits = cells.iter().skip(cell.into()).take(count.into());
    let value = bits.rev().fold(0_u32, |value, bit| value << 1 | u32::from(*bit));
    let unused = 32 - u32::from(count);
    (value << unused) as i32 >> unused
}

/// Writes consecutive bits, the lowest to the first one.
#[inline(always)]
pub(super) fn write(cells: &mut [u8; CELLS], cell: u16, count: u8, value: i32) {
    let bits = cells.iter_mut().skip(cell.into()).take(count.into());
    for (place, bit) in bits.enumerate() {
        *bit = (value >> place) as u8 & 1;
    }
}

/// Leaves the cells that no operand has as they were.
pub(super) fn clear_brackets(cells: &mut [u8; CELLS]) {
    for cell in cells.iter_mut().skip(BRACKETS_AT) {
        *cell = 0;
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::program::Gate;

    #[test]
    fn a_table_holds_the_truth_of_its_gate() {
        let bit = BitOperand {
            bit: "M7".parse().unwrap(),
            indexed: false,
        };
        let gates = [
            Gate::And,
            Gate::AndNot,
            Gate::Or,
            Gate::OrNot,
            Gate::Xor,
            Gate::XorNot,
        ];
        let mut cells = [0; CELLS];
        for (gate, la, content) in gates.into_iter().flat_map(|gate| {
            [
                (gate, false, false),
                (gate, false, true),
                (gate, true, false),
                (gate, true, true),
            ]
        }) {
            cells[bit.bit.cell()] = content.into();
            let step = BitStep::of(&Op::GateBit { gate, bit }).unwrap();
            assert_eq!(run(&[step], &mut cells, la), gate.bits(la, content));
            assert_eq!(
                cells[bit.bit.cell()],
                u8::from(content),
                "a gate leaves its operand"
            );
        }
    }

    #[test]
    fn consecutive_bits_end_with_their_area() {
        let inputs = |name: &str, indexed| BitOperand {
            bit: name.parse().unwrap(),
            indexed,
        };
        let first = bahn_exchange::BitArea::I.first_cell();
        assert_eq!(consecutive(&inputs("I0", false), 32), Some(first));
        assert_eq!(consecutive(&inputs("I247", false), 8), Some(first + 247));
        assert_eq!(
            consecutive(&inputs("I248", false), 8),
            None,
            "I255 is none of a program"
        );
        assert_eq!(consecutive(&inputs("I0", true), 8), None);
    }

    #[test]
    fn set_is_conditional_and_leaves_the_accumulator() {
        let bit = BitOperand {
            bit: "O3".parse().unwrap(),
            indexed: false,
        };
        let set = BitStep::of(&Op::SetBit {
            bit,
            value: true,
            when: true,
        });
        let mut cells = [0; CELLS];
        assert!(!run(&[set.unwrap()], &mut cells, false));
        assert_eq!(cells[bit.bit.cell()], 0);
        assert!(run(&[set.unwrap()], &mut cells, true));
        assert_eq!(cells[bit.bit.cell()], 1);
    }
}
