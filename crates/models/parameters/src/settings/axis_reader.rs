//! Reads the values of one axis from the new or the old list.

use crate::{ControlModel, MachineZero, ParameterList};

/// The values of one axis. Where the model lacks the axis, those of the 4th axis.
pub(super) struct AxisReader<'a> {
    list: &'a ParameterList,
    /// Index that was asked for.
    wanted: u8,
    /// Index of the axis whose values are read: the fourth's where the model has no such axis.
    index: u8,
}

/// Index of the 4th axis, the last one that every model has.
const FOURTH: u8 = 3;
/// The sequences of MP59 are the permutations of four axes in alphabetic order [001:1449-1474].
const OLD_AXES: u8 = 4;

impl<'a> AxisReader<'a> {
    pub fn new(list: &'a ParameterList, wanted: u8) -> AxisReader<'a> {
        let exists = wanted < list.model().limits().axes_max;
        let index = if exists { wanted } else { FOURTH };
        AxisReader { list, wanted, index }
    }

    pub fn list(&self) -> &'a ParameterList {
        self.list
    }

    /// The index that answers.
    pub fn index(&self) -> u8 {
        self.index
    }

    /// Whether the model has such an axis.
    pub fn exists(&self) -> bool {
        self.wanted == self.index
    }

    pub fn is_rotary(&self) -> bool {
        self.list
            .axis_letter(self.index)
            .is_some_and(|axis| axis.is_rotary())
    }

    /// One value for each axis in both lists, in the old one with consecutive numbers.
    pub fn value(&self, new: u16, first_old: u16) -> f64 {
        self.new_or(new, || self.old(first_old))
    }

    /// One value for each axis in the new list, one for all in the old one.
    pub fn old_common(&self, new: u16, old: u16) -> f64 {
        self.new_or(new, || self.list.old(old))
    }

    /// One value for all axes in both lists.
    pub fn common(&self, new: u16, old: u16) -> f64 {
        self.list.get_new(new, 0).unwrap_or_else(|| self.list.old(old))
    }

    /// One value for each axis in the new list; another answer on models without it.
    pub fn new_or(&self, new: u16, otherwise: impl FnOnce() -> f64) -> f64 {
        self.list.get_new(new, self.index).unwrap_or_else(otherwise)
    }

    /// A bit for each axis in the new list; another answer on models without it.
    pub fn bit_or(&self, new: u16, otherwise: impl FnOnce() -> bool) -> bool {
        self.list
            .get_new(new, 0)
            .map_or_else(otherwise, |value| super::bit_of(value, self.index.into()))
    }

    /// A bit for each axis in the new list, 0 or 1 under consecutive numbers in the old one.
    pub fn flag(&self, new: u16, first_old: u16) -> bool {
        self.bit_or(new, || self.old(first_old) == 1.0)
    }

    /// The axis' value in the old list, consecutive numbers; 0 on other models.
    pub fn old(&self, first: u16) -> f64 {
        self.list.old(first + u16::from(self.index.min(FOURTH)))
    }

    /// The axis' value in the old list where each axis has two numbers.
    pub fn old_pair(&self, first: u16) -> f64 {
        self.list.old(first + 2 * u16::from(self.index.min(FOURTH)))
    }

    /// MP960, where the model counts M91 from it.
    pub fn machine_datum(&self) -> f64 {
        match self.list.model().limits().machine_zero {
            MachineZero::ScaleDatum => 0.0,
            MachineZero::Mp960 => self.new_or(960, || 0.0),
        }
    }

    /// Display step, mm: MP7290, one for all axes on the TNC 360 (old MP65).
    pub fn display_step(&self) -> f64 {
        const STEPS: [f64; 7] = [0.1, 0.05, 0.01, 0.005, 0.001, 0.0005, 0.0001];
        let list = self.list;
        let fine = match list.model().family() {
            ControlModel::Tnc151 | ControlModel::Tnc155 => list.old(65) == 0.0,
            ControlModel::Tnc360 => list.get(7290, 0) == Some(0.0),
            _ => {
                let step = STEPS.get(self.new_or(7290, || 4.0) as usize).copied();
                return step.unwrap_or(0.001).max(list.model().limits().resolution_mm);
            }
        };
        if fine { 0.001 } else { 0.005 }
    }
}

impl ParameterList {
    /// A value of the new list; `None` on the TNC 151/155, whose numbers mean something else.
    pub(super) fn get_new(&self, number: u16, index: u8) -> Option<f64> {
        (!self.has_old_numbers())
            .then(|| self.get(number, index))
            .flatten()
    }

    /// A value of the old list; 0 on other models.
    pub(super) fn old(&self, number: u16) -> f64 {
        self.has_old_numbers()
            .then(|| self.get(number, 0))
            .flatten()
            .unwrap_or_default()
    }

    /// A bit of a sum of the old list; not set on other models.
    pub(super) fn old_bit(&self, number: u16, bit: u32) -> bool {
        super::bit_of(self.old(number), bit)
    }

    /// Place of an axis in the automatic reference run, from 0: MP1340 (old MP59).
    pub(super) fn reference_place(&self, axis: u8) -> Option<u8> {
        let sequence: Vec<u8> = if self.has_old_numbers() {
            permutation(self.old(59) as usize)
        } else {
            let named = |place| self.get(1340, place).map(|axis| axis as u8);
            // 1 is X; 0 names no axis.
            (0..OLD_AXES + 1)
                .filter_map(named)
                .filter_map(|axis| axis.checked_sub(1))
                .collect()
        };
        sequence
            .iter()
            .position(|named| *named == axis)
            .map(|place| place as u8)
    }
}

/// The permutation of four axes with a number from 0 in alphabetic order.
fn permutation(mut number: usize) -> Vec<u8> {
    let mut left: Vec<u8> = (0..OLD_AXES).collect();
    let mut sequence = Vec::new();
    while !left.is_empty() {
        let rest: usize = (1..left.len()).product();
        sequence.push(left.remove((number / rest).min(left.len() - 1)));
        number %= rest;
    }
    sequence
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::Definition;

    #[test]
    fn mp59_names_the_sequences_of_its_table() {
        // Axes 0 to 3 are X, Y, Z, IV [001:1451-1474].
        for (number, sequence) in [
            (0, [0, 1, 2, 3]),
            (1, [0, 1, 3, 2]),
            (5, [0, 3, 2, 1]),
            (12, [2, 0, 1, 3]),
            (17, [2, 3, 1, 0]),
            (18, [3, 0, 1, 2]),
            (23, [3, 2, 1, 0]),
        ] {
            assert_eq!(permutation(number), sequence, "MP59 = {number}");
        }
    }

    #[test]
    fn every_number_read_here_is_one_of_the_old_list() {
        for number in [12, 252, 253, 257, 242, 245, 163, 159, 186, 234, 192] {
            assert!(
                Definition::find(ControlModel::Tnc155, number, 0).is_some(),
                "MP{number}"
            );
        }
    }
}
