//! Settings of the axes: which there are, how fast, how far.

use bahn_path::{Axis, AxisSet};

use super::bit_of;
use crate::{ControlModel, Numbering, ParameterList};

/// The 4th axis' and the 5th axis' index.
const FOURTH: u8 = 3;
const FIFTH: u8 = 4;

impl ControlModel {
    /// The parameters that hold the positive and the negative software limits of an axis, named by its letter or as
    /// `IV`: `MP46`, or one of each traverse range, `MP910.1` [000:3453-3467] [001:3188-3195].
    pub fn limit_parameters(self, axis: &str) -> [Vec<String>; 2] {
        let index = "XYZ".find(|letter| axis.starts_with(letter));
        match self.limits().numbering {
            Numbering::Old => {
                let plus = index.unwrap_or(3) * 2 + 44;
                [plus, plus + 1].map(|number| vec![format!("MP{number}")])
            }
            Numbering::New => {
                let index = index.map_or("3 or .4".to_owned(), |index| index.to_string());
                [910, 920].map(|first: u16| {
                    let ranges = first..first + 3;
                    ranges.map(|number| format!("MP{number}.{index}")).collect()
                })
            }
        }
    }
}

impl ParameterList {
    /// The index of an axis in the list: X, Y, Z, then the 4th and 5th axis with the letters of MP410.3
    /// and MP410.4 (old: axis IV by MP90). `None` when the machine has no such axis (MP10; old: MP72)
    /// [000:3174-3182] [000:3350-3370] [001:1338-1380].
    pub fn axis_index(&self, axis: Axis) -> Option<u8> {
        let index = match axis {
            Axis::X => 0,
            Axis::Y => 1,
            Axis::Z => 2,
            _ if self.letter(FOURTH) == Some(axis) => FOURTH,
            _ if self.letter(FIFTH) == Some(axis) => FIFTH,
            _ => return None,
        };
        let active = if self.has_old_numbers() {
            !bit_of(self.get(72, 0)?, index.into())
        } else {
            bit_of(self.get(10, 0)?, index.into())
        };
        active.then_some(index)
    }

    /// The axes of the machine.
    pub fn axes(&self) -> AxisSet {
        Axis::ALL
            .into_iter()
            .filter(|axis| self.axis_index(*axis).is_some())
            .collect()
    }

    /// Rapid traverse, mm/min or degrees/min: MP1010 (old MP0-3) [000:4836-4841] [001:3144-3147].
    pub fn rapid_traverse_mm_min(&self, axis: Axis) -> f64 {
        self.axis_value(axis, 1010, 0)
    }

    /// Feed rate of manual operation, mm/min or degrees/min: MP1020 (old MP4-7) [000:4848-4853]
    /// [001:3148-3151].
    pub fn manual_feed_mm_min(&self, axis: Axis) -> f64 {
        self.axis_value(axis, 1020, 4)
    }

    /// Acceleration, m/s²: MP1060 (old MP54, one for all axes) [000:4790-4797] [001:1678]. For a rotary
    /// axis 1 m/s² is 1000 degrees/s² (inferred from mm standing for degrees in the list).
    pub fn acceleration_m_s2(&self, axis: Axis) -> f64 {
        self.value((1060, self.like_index(axis)), (54, 0))
    }

    /// Radial acceleration on circles, m/s²: MP1070 (old MP55) [000:5080-5092] [001:1679].
    pub fn radial_acceleration_m_s2(&self) -> f64 {
        self.value((1070, 0), (55, 0))
    }

    /// Greatest change of direction that is passed at constant path speed, degrees: MP7460 (old MP91)
    /// [000:5096-5108] [001:1814-1817].
    pub fn corner_angle_deg(&self) -> f64 {
        self.value((7460, 0), (91, 0))
    }

    /// Whether the automatic modes run with feed pre-control and not with servo lag: MP1390 (old MP60);
    /// both are 0 for pre-control [000:4721-4724] [001:1105-1121]. The TNC 360 has the parameter of the
    /// TNC 407 (inferred).
    pub fn feed_precontrol(&self) -> bool {
        self.value((1390, 0), (60, 0)) == 0.0
    }

    /// Distance from the scale datum to the machine datum, mm or degrees: MP960 [000:6264-6269]; 0 on
    /// controls whose machine zero is the scale datum.
    pub fn machine_datum(&self, axis: Axis) -> f64 {
        match self.model().limits().machine_zero {
            crate::MachineZero::ScaleDatum => 0.0,
            crate::MachineZero::Mp960 => self.get(960, self.like_index(axis)).unwrap_or_default(),
        }
    }

    /// Distance from machine zero to the position that M92 counts from, mm or degrees: MP950
    /// (old MP186-189) [000:6242-6263] [001:1592-1598].
    pub fn m92_datum(&self, axis: Axis) -> f64 {
        self.axis_value(axis, 950, 186)
    }

    /// Software limits of traverse range 1 from machine zero, mm or degrees, least first: MP920 and MP910
    /// (old MP44-51) [000:3453-3467] [001:3188-3195].
    pub fn traverse_range(&self, axis: Axis) -> [f64; 2] {
        let index = self.like_index(axis);
        let old_plus = 44 + 2 * u16::from(index.min(FOURTH));
        [
            self.value((920, index), (old_plus + 1, 0)),
            self.value((910, index), (old_plus, 0)),
        ]
    }

    /// A value that has an index for each axis; in the old list the axes have consecutive numbers.
    fn axis_value(&self, axis: Axis, new: u16, first_old: u16) -> f64 {
        let index = self.like_index(axis);
        self.value((new, index), (first_old + u16::from(index.min(FOURTH)), 0))
    }

    /// The index of an axis, or of the one that it answers like (inferred).
    fn like_index(&self, axis: Axis) -> u8 {
        let main = |axis: Axis| axis.main().and_then(|main| self.axis_index(main));
        let rotary = || {
            let is_rotary = |index: &u8| self.letter(*index).is_some_and(Axis::is_rotary);
            [FOURTH, FIFTH].into_iter().find(is_rotary)
        };
        let index = self
            .axis_index(axis)
            .or_else(|| if axis.is_rotary() { rotary() } else { main(axis) });
        match (index, axis) {
            (Some(index), _) => index,
            (None, Axis::X | Axis::U) => 0,
            (None, Axis::Y | Axis::V) => 1,
            (None, Axis::Z | Axis::W) => 2,
            (None, Axis::A | Axis::B | Axis::C) => FOURTH,
        }
    }

    /// The letter of an axis by its index; `None` for one that the model does not have.
    pub(super) fn axis_letter(&self, index: u8) -> Option<Axis> {
        let exists = index < self.model().limits().axes_max;
        match index {
            0 => Some(Axis::X),
            1 => Some(Axis::Y),
            2 => Some(Axis::Z),
            FOURTH | FIFTH if exists => self.letter(index),
            _ => None,
        }
    }

    /// The letter of the 4th or 5th axis [000:3350-3370] [001:3275].
    fn letter(&self, index: u8) -> Option<Axis> {
        let letter = match (self.has_old_numbers(), index) {
            (true, FOURTH) => self.get(90, 0)?,
            (true, _) => return None,
            (false, _) => self.get(410, index)?,
        };
        const LETTERS: [Axis; 6] = [Axis::A, Axis::B, Axis::C, Axis::U, Axis::V, Axis::W];
        LETTERS.get(letter as usize).copied()
    }
}
