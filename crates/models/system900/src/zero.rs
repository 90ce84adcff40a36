//! The zero points of a channel: where each lies [002:978-1144].
//!
//! Decision: The sum, group 0, is what the control adds. A write to a shift computes it anew; a write to the sum itself stands until
//! then

use std::fmt;

use serde::Serialize;

use crate::array::number_or_none;
use crate::memory::{Memory, Place};
use crate::name::Name;
use crate::numbers::ZERO_POINTS;

/// The numbers of channel parameters end here.
pub(crate) const NUMBERS_END: u32 = 40_000;
/// G53 to G59: those that are there always.
const FIRST_POINTS: u32 = 7;
/// G154 to G159, and so on.
const FURTHER_POINTS: u32 = 6;

/// The array of the zero points.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct ZeroPoints {
    /// The first channel parameter; `None` when the channel has no zero points.
    pub first: Option<u32>,
    /// How many parameters there are.
    pub count: u64,
    /// Work areas.
    pub areas: u32,
    /// Groups of each area: the sum, and its shifts.
    pub groups: u32,
    /// Axes of each point.
    pub axes: u32,
    /// Points of each group.
    pub points: u32,
    /// All of them, by their parameters.
    pub cells: Vec<ZeroPoint>,
}

/// One axis of a zero point.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct ZeroPoint {
    /// The work area, from 1 on.
    pub area: u32,
    /// The word that calls it.
    pub point: String,
    /// 0 is the sum, the others are shifts.
    pub group: u32,
    /// The axis, from 1 on.
    pub axis: u32,
    /// The channel parameter.
    pub p: u32,
    /// The system parameter; `None` outside the blocks of the channel.
    pub q: Option<u32>,
    /// What it holds; `None` when it is cleared.
    pub value: Option<f64>,
}

/// The numbers that lay out the array.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) struct Layout {
    pub first: u32,
    pub areas: u32,
    pub groups: u32,
    pub axes: u32,
    pub points: u32,
}

impl Layout {
    /// That of a channel; a cleared number of work areas is 1, of shifts and further points 0. `None` when the channel has
    /// none, or one of the numbers is none.
    pub fn of(memory: &Memory, channel: u8) -> Option<Layout> {
        let descriptor = memory.descriptor(channel);
        let count = |at: u32, otherwise: u32| {
            let entry = descriptor.entry(ZERO_POINTS + at);
            match entry.bits() {
                None => Some(otherwise),
                Some(_) => descriptor.count(ZERO_POINTS + at),
            }
        };
        let layout = Layout {
            first: descriptor.count(ZERO_POINTS)?,
            areas: count(1, 1)?,
            groups: count(2, 0)?.checked_add(1)?,
            axes: count(3, 0)?,
            points: count(4, 0)?
                .checked_mul(FURTHER_POINTS)?
                .checked_add(FIRST_POINTS)?,
        };
        (layout.count() > 0).then_some(layout)
    }

    /// How many parameters there are.
    pub fn count(&self) -> u64 {
        let parts = [self.areas, self.groups, self.points, self.axes];
        parts.into_iter().map(u64::from).fold(1, u64::saturating_mul)
    }

    /// The parameter of an axis of a zero point; everything counts from 0.
    fn place(&self, [area, group, point, axis]: [u32; 4]) -> u32 {
        let at = (area * self.groups + group) * self.points + point;
        self.first + at * self.axes + axis
    }

    /// What a parameter of the array is: area, group, point, axis, from 0; `None` of another one.
    fn of_parameter(&self, p: u32) -> Option<[u32; 4]> {
        let at = p
            .checked_sub(self.first)
            .filter(|at| u64::from(*at) < self.count())?;
        let (at, axis) = (at / self.axes, at % self.axes);
        let (at, point) = (at / self.points, at % self.points);
        Some([at / self.groups, at % self.groups, point, axis])
    }

    fn cell(&self, memory: &Memory, channel: u8, p: u32) -> ZeroPoint {
        let at = p - self.first;
        let (at, axis) = (at / self.axes, at % self.axes);
        let (at, point) = (at / self.points, at % self.points);
        let name = Name::P(channel, p);
        ZeroPoint {
            area: at / self.groups + 1,
            point: point_name(point),
            group: at % self.groups,
            axis: axis + 1,
            p,
            q: memory.q(name).ok(),
            value: memory.cell(name).ok().and_then(|cell| cell.number()),
        }
    }
}

/// The word that calls a point: G53 to G59, then G154 to G159, G254 to G259 and so on.
fn point_name(point: u32) -> String {
    match point.checked_sub(FIRST_POINTS) {
        None => format!("G{}", 53 + point),
        Some(further) => {
            let hundred = further / FURTHER_POINTS + 1;
            format!("G{}", 100 * hundred + 54 + further % FURTHER_POINTS)
        }
    }
}

impl Memory {
    /// The sum of the shifts of an axis, after one of them was written: where it lies, the sum, its decimals. `None` after any
    /// other write.
    pub fn sum_of_shifts(&self, name: Name) -> Option<(Place, f64, u8)> {
        let (channel, p) = name.of_channel()?;
        let layout = Layout::of(self, channel)?;
        let [area, _, point, axis] = layout.of_parameter(p).filter(|[_, group, ..]| *group > 0)?;
        let cell = |group| self.cell(Name::P(channel, layout.place([area, group, point, axis])));
        let shifts = || (1..layout.groups).filter_map(|group| cell(group).ok());
        let decimals = shifts().map(|cell| cell.status().decimals()).max()?;
        let sum = shifts().filter_map(|cell| cell.number()).sum();
        let place = self.place(Name::P(channel, layout.place([area, 0, point, axis])));
        Some((place.ok()?, sum, decimals))
    }
}

impl ZeroPoints {
    /// Those of a channel.
    pub fn of(memory: &Memory, channel: u8) -> ZeroPoints {
        let Some(layout) = Layout::of(memory, channel) else {
            return ZeroPoints {
                first: None,
                count: 0,
                areas: 0,
                groups: 0,
                axes: 0,
                points: 0,
                cells: Vec::new(),
            };
        };
        let end = u64::from(layout.first).saturating_add(layout.count());
        let end = u32::try_from(end).unwrap_or(NUMBERS_END).min(NUMBERS_END);
        ZeroPoints {
            first: Some(layout.first),
            count: layout.count(),
            areas: layout.areas,
            groups: layout.groups,
            axes: layout.axes,
            points: layout.points,
            cells: (layout.first..end)
                .map(|p| layout.cell(memory, channel, p))
                .collect(),
        }
    }
}

/// A line for each.
impl fmt::Display for ZeroPoints {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        for cell in &self.cells {
            let (p, area, point, axis) = (cell.p, cell.area, &cell.point, cell.axis);
            let group = match cell.group {
                0 => "sum".to_owned(),
                group => format!("shift {group}"),
            };
            let value = number_or_none(cell.value);
            writeln!(
                f,
                "P{p:<6} area {area}  {point:<5} {group:<8} axis {axis:<2}  {value}"
            )?;
        }
        Ok(())
    }
}
