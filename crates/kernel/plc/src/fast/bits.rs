//! Bit instructions as truth tables.
//!
//! Every bit instruction makes of the logic accumulator and one cell a new logic accumulator and a new content
//! of the cell: `A` changes only the one, `=` only the other. So a table of four entries for each says all,
//! and one loop without a branch executes loads, gates, assignments, sets, resets and brackets.

use bahn_exchange::CELLS;

use crate::PlcError;
use crate::operand::BitOperand;
use crate::program::Op;

/// Brackets on the logic accumulator are buffered in the last cells of the image, which no operand has.
const BRACKETS_AT: usize = CELLS - BRACKETS;
const BRACKETS: usize = 16;

/// One bit instruction, as what it makes of bit and LA.
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

/// The cell of the first of consecutive bits; `None` with index, or when the last is after its area.
pub(super) fn consecutive(first: &BitOperand, count: u8) -> Option<u16> {
    let last = first.bit.number() + u16::from(count.checked_sub(1)?);
    let inside = !first.indexed && count <= 32 && count.is_multiple_of(8) && last <= first.bit.area().last();
    u16::try_from(first.bit.cell()).ok().filter(|_| inside)
}

/// Reads consecutive bits, the first one lowest, sign-filled from the last one [000:12186-12223].
/// `count` is a multiple of 8.
#[inline(always)]
pub(super) fn read(cells: &[u8; CELLS], cell: u16, count: u8) -> i32 {
    // The product brings bit 0 of every byte into the highest byte, that of the first byte lowest.
    const GATHER: u64 = 0x0102_0408_1020_4080;
    let bits = cells.get(usize::from(cell)..).unwrap_or(&[]);
    let (octets, _) = bits.as_chunks::<8>();
    let mut value = 0_u32;
    for (place, octet) in (0..count).step_by(8).zip(octets) {
        let byte = u64::from_le_bytes(*octet).wrapping_mul(GATHER) >> 56;
        value |= (byte as u32) << place;
    }
    let unused = 32 - u32::from(count);
    (value << unused) as i32 >> unused
}

/// Writes consecutive bits, the lowest to the first one. `count` is a multiple of 8.
#[inline(always)]
pub(super) fn write(cells: &mut [u8; CELLS], cell: u16, count: u8, value: i32) {
    const EVERY_BYTE: u64 = 0x0101_0101_0101_0101;
    const OWN_BIT: u64 = 0x8040_2010_0804_0201;
    let bits = cells.get_mut(usize::from(cell)..).unwrap_or(&mut []);
    let (octets, _) = bits.as_chunks_mut::<8>();
    for (place, octet) in (0..count).step_by(8).zip(octets) {
        // Every byte keeps its own bit, which a carry brings to bit 7 when it is set.
        let own = (EVERY_BYTE * u64::from((value >> place) as u8)) & OWN_BIT;
        *octet = ((own + 0x7f * EVERY_BYTE) >> 7 & EVERY_BYTE).to_le_bytes();
    }
}

/// A bit operand with index.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) struct IndexedBit {
    /// The cell of number 0 of its area.
    base: u16,
    number: u16,
    /// The highest number of its area.
    last: u16,
}

impl IndexedBit {
    /// `None` for operands without index.
    pub(super) fn of(operand: &BitOperand) -> Option<IndexedBit> {
        let area = operand.bit.area();
        operand.indexed.then_some(IndexedBit {
            base: area.first_cell(),
            number: operand.bit.number(),
            last: area.last(),
        })
    }

    /// The cell that it means; `None` outside its area.
    #[inline(always)]
    fn cell(self, index: i32) -> Option<usize> {
        let number = i32::from(self.number) + i32::from(index as i16);
        let number = u16::try_from(number).ok()?;
        (number <= self.last).then(|| (usize::from(self.base) + usize::from(number)) % CELLS)
    }

    /// Reads are not checked: outside is 0 (inferred) [000:14012-14016].
    #[inline(always)]
    pub(super) fn read(self, cells: &[u8; CELLS], index: i32) -> bool {
        self.cell(index).is_some_and(|cell| cells[cell] != 0)
    }

    #[inline(always)]
    pub(super) fn write(self, cells: &mut [u8; CELLS], index: i32, value: bool) -> Result<(), PlcError> {
        let cell = self.cell(index).ok_or(PlcError::IndexOutOfRange)?;
        cells[cell] = value.into();
        Ok(())
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
        assert_eq!(consecutive(&inputs("I248", false), 8), Some(first + 248));
        assert_eq!(
            consecutive(&inputs("I249", false), 8),
            None,
            "I256 is none of a program"
        );
        assert_eq!(consecutive(&inputs("I0", true), 8), None);
    }

    #[test]
    fn consecutive_bits_are_gathered_and_spread() {
        for (count, value) in [
            (8, 0x5a),
            (8, -0x80),
            (16, 0x1234),
            (32, 0x7654_3210),
            (32, -1),
            (16, -2),
        ] {
            let mut cells = [0; CELLS];
            write(&mut cells, 100, count, value);
            for place in 0..count {
                assert_eq!(
                    cells[100 + usize::from(place)],
                    (value >> place & 1) as u8,
                    "{value:x} {place}"
                );
            }
            assert_eq!((cells[99], cells[100 + usize::from(count)]), (0, 0));
            assert_eq!(read(&cells, 100, count), value);
        }
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
