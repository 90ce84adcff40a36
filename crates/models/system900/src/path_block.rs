//! The parameters by which part programs of a channel are executed: feeds, planes, zero points, tools, cycles.

use crate::array::Cell;
use crate::descriptor::AxisWord;
use crate::memory::Memory;
use crate::name::Name;
use crate::numbered::parameters;
use crate::numbers::{FURTHER_PLANES, PLANES};
use crate::value::Value;
use crate::zero::Layout;

parameters! {
/// A parameter of a channel by which its programs are executed.
PathParameter {
    /// P30: dwell at depth, s [002:1377-1380].
    DrillDwell = 30,
    /// P32: feed of drilling, mm/min.
    DrillFeed = 32,
    /// P33: depth.
    DrillDepth = 33,
    /// P34: plane above the workpiece.
    DrillPlane = 34,
    /// P35: plane to retract to.
    DrillRetract = 35,
    /// P36: number of strokes of G83.
    DrillStrokes = 36,
    /// P38: distance before the last depth at which G83 stops its rapid traverse.
    DrillMargin = 38,
    /// P39: the strokes of G83 become smaller.
    DrillDegressive = 39,
    /// P160: origin of the rotation G45, first axis; P161 is the second.
    RotationOrigin = 160,
    /// P163: angle of the rotation G45, degrees [002:1524-1537].
    RotationAngle = 163,
    /// P8000: shifts of the axes, by logical axes [002:1682-1690].
    AxisShift = 8000,
    /// P8048: group number of the programmed tool [002:1791-1793].
    ToolGroup = 8048,
    /// P8049: M function of the tool change in the block.
    ToolChange = 8049,
    /// P8050: tool for the PLC.
    PlcTool = 8050,
    /// P8100: tool in the spindle.
    SpindleTool = 8100,
    /// P8150: tool with which the path is computed.
    ActiveTool = 8150,
    /// P8200: tool of the executed block.
    RealTimeTool = 8200,
    /// P8555: the work area [002:3459-3463].
    WorkArea = 8555,
    /// P8714: the PLC lets M22 jump [002:3884-3887].
    SkipCondition = 8714,
    /// P8801: the block with which a program starts [002:4157-4158].
    FirstBlock = 8801,
    /// P8810: blocks with `/` are skipped [002:4241-4243].
    BlockSkip = 8810,
    /// P8815: feed of a test in place of programmed ones, mm/min [002:4282-4284].
    TestFeed = 8815,
    /// P8816: rapid traverse, mm/min [002:4286-4292].
    RapidFeed = 8816,
    /// P8818: percentage of programmed feeds [002:4298-4300].
    FeedPercent = 8818,
    /// P8830: the zero point with which a program starts [002:4315-4318].
    ZeroPoint = 8830,
    /// P8843: greatest error of the radius of a circle, mm [002:4371-4376].
    RadiusError = 8843,
    /// P8851: how much a corner slows the path [002:4475-4548].
    CornerDynamics = 8851,
    /// P8852: admissible deviation of a circle, mm [002:4566-4604].
    CircleDynamics = 8852,
    /// P8858: how G0 ends [002:4651-4660].
    RapidEnd = 8858,
    /// P8892: mirrored axes [002:4762-4782].
    Mirror = 8892,
    /// P8934: programmed count of M24, P8935 what is left of it [002:4892-4893].
    LoopCount = 8934,
}
}

/// The tool with which a path is computed.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct PathTool {
    /// Its group, the T number.
    pub group: i64,
    /// Radius with its correction, mm.
    pub radius: f64,
    /// Length with its correction, mm.
    pub length: f64,
}

/// Values of a tool that are copied from record to block [002:1806-1864].
const TOOL_VALUES: u32 = 50;
/// Places in a record: radius, length, and their corrections.
const RADIUS: u32 = 10;
const LENGTH: u32 = 11;
const CORRECTIONS: [u32; 2] = [12, 13];

impl Cell {
    /// What another parameter gets that takes this content.
    pub fn value(self) -> Value {
        match self.bits() {
            None => Value::Cleared,
            Some(bits) if self.status().is_hexadecimal() => Value::Bits(bits),
            Some(bits) => Value::Decimal {
                digits: bits.into(),
                decimals: self.status().decimals(),
            },
        }
    }
}

impl Memory {
    /// The logical axes of a channel with their words.
    pub fn axis_words(&self, channel: u8) -> impl Iterator<Item = (u8, AxisWord)> {
        let axes = self.descriptor(channel).axes();
        axes.filter(|(_, word)| word.is_there())
    }

    /// What a parameter holds by which a channel executes its programs; cleared where it leads nowhere.
    pub fn path(&self, channel: u8, parameter: PathParameter) -> Cell {
        self.path_at(channel, parameter, 0)
    }

    /// The one that comes so many after it.
    pub fn path_at(&self, channel: u8, parameter: PathParameter, after: u32) -> Cell {
        let name = Name::P(channel, parameter.number() + after);
        self.cell(name).unwrap_or_default()
    }

    /// Its number; 0 where it is cleared.
    pub fn path_number(&self, channel: u8, parameter: PathParameter) -> f64 {
        self.path(channel, parameter).number().unwrap_or(0.0)
    }

    /// The logical axes of a plane of G17 to G19 or G117 to G119: abscissa, ordinate, normal; 0 for none
    /// [002:891-934] [002:4319-4366].
    pub fn plane_axes(&self, channel: u8, g: u16) -> [u8; 3] {
        const USUAL: [[u8; 3]; 3] = [[1, 2, 3], [3, 1, 2], [2, 3, 1]];
        let (cell, index) = match g {
            117..=119 => {
                let name = Name::P(channel, FURTHER_PLANES + u32::from(g - 117));
                (self.cell(name).unwrap_or_default(), g - 117)
            }
            _ => {
                let index = g.saturating_sub(17).min(2);
                (self.descriptor(channel).entry(PLANES + u32::from(index)), index)
            }
        };
        let usual = USUAL.get(usize::from(index)).copied().unwrap_or_default();
        match cell.bits().map(i32::to_le_bytes) {
            None | Some([0, 0, 0, _]) => usual,
            Some([first, second, normal, _]) => [first, second, normal],
        }
    }

    /// The shift of a logical axis by a zero point, G53 to G59, G154 and so on: the sum of its groups; `None` where the
    /// channel has no such zero point. G153 shifts nothing.
    pub fn zero_point(&self, channel: u8, g: u16, logical: u8) -> Option<f64> {
        if g == 153 {
            return Some(0.0);
        }
        let Some(layout) = Layout::of(self, channel) else {
            // Without zero points G53 is that of the machine (inferred).
            return (g == 53).then_some(0.0);
        };
        let point = layout.point(g)?;
        let area = self
            .path(channel, PathParameter::WorkArea)
            .whole()
            .unwrap_or(1)
            .max(1);
        let area = u32::try_from(area - 1).ok().filter(|area| *area < layout.areas)?;
        let Some(axis) = u32::from(logical)
            .checked_sub(1)
            .filter(|axis| *axis < layout.axes)
        else {
            return Some(0.0);
        };
        let p = layout.place(area, 0, point, axis);
        self.cell(Name::P(channel, p)).ok()?.number().or(Some(0.0))
    }

    /// A shift of a zero point was written: the sum of its axis is computed anew. Any other parameter is left.
    ///
    /// Decision of the specification: group 0 is what the control adds; a write to it stands until a shift is written.
    pub fn sum_shifts(&mut self, channel: u8, p: u32) {
        let Some(layout) = Layout::of(self, channel).filter(|layout| layout.groups > 1) else {
            return;
        };
        let Some((area, group, point, axis)) = layout.of_parameter(p) else {
            return;
        };
        if group == 0 {
            return;
        }
        let shift = |group| self.cell(Name::P(channel, layout.place(area, group, point, axis)));
        let cells: Vec<Cell> = (1..layout.groups).filter_map(|group| shift(group).ok()).collect();
        let decimals = cells
            .iter()
            .map(|cell| cell.status().decimals())
            .max()
            .unwrap_or(3);
        let sum: f64 = cells.iter().filter_map(|cell| cell.number()).sum();
        let place = self.place(Name::P(channel, layout.place(area, 0, point, axis)));
        if let Ok(place) = place {
            self.store(place, Some(sum), decimals);
        }
    }

    /// The first parameter of the record of a tool group in the array; `None` where no record has it.
    pub fn tool_record(&self, channel: u8, group: i64) -> Option<u32> {
        let layout = crate::tools::Layout::of(self, channel)?;
        let first = |record: u32| layout.first.checked_add(record.checked_mul(layout.length)?);
        let of_group = |p: &u32| {
            let cell = self.cell(Name::P(channel, *p));
            cell.is_ok_and(|cell| cell.whole() == Some(group))
        };
        (0..layout.records).filter_map(first).find(of_group)
    }

    /// Copies a tool from its record, or from one block to another one.
    pub fn copy_tool(&mut self, channel: u8, from: u32, to: PathParameter) {
        let array = crate::tools::Layout::of(self, channel);
        let is_block = (PathParameter::PlcTool.number()..PathParameter::RealTimeTool.number() + TOOL_VALUES)
            .contains(&from);
        let count = match array.filter(|_| !is_block) {
            Some(layout) => layout.length.min(TOOL_VALUES),
            None => TOOL_VALUES,
        };
        for offset in 0..count {
            let own = self.cell(Name::P(channel, from + offset)).unwrap_or_default();
            if let Ok(place) = self.place(Name::P(channel, to.number() + offset)) {
                self.put(place, own);
            }
        }
    }

    /// The tool of a block, as the path is computed with it.
    pub fn tool_of(&self, channel: u8, block: PathParameter) -> PathTool {
        let at = |offset| self.path_at(channel, block, offset).number().unwrap_or(0.0);
        let [radius, length] = CORRECTIONS.map(at);
        PathTool {
            group: self.path(channel, block).whole().unwrap_or(0),
            radius: at(RADIUS) + radius,
            length: at(LENGTH) + length,
        }
    }

    /// Writes a whole number into a parameter of a channel, or clears it, whatever locks there are.
    pub fn set_path(&mut self, channel: u8, parameter: PathParameter, number: Option<i64>) {
        if let Ok(place) = self.place(Name::P(channel, parameter.number())) {
            self.store(place, number.map(|number| number as f64), 0);
        }
    }

    /// Writes a parameter from a part program: a shift of a zero point changes its sum, too.
    ///
    /// # Errors
    /// When the parameter leads nowhere, is locked or cannot hold the value.
    pub fn write_in_program(&mut self, channel: u8, p: u32, value: Value) -> Result<(), crate::SpaceError> {
        self.write(Name::P(channel, p), value)?;
        self.sum_shifts(channel, p);
        Ok(())
    }
}
