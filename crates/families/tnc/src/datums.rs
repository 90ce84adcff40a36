//! The workpiece datums, the traverse range and the datum correction of a channel.
//!
//! Decision: AXIS LIMIT counts from machine zero, as REF shows, in its traverse range; it must leave something of the
//! software limits, and is entered while no program runs

use std::sync::Arc;

use bahn_kernel::{Chain, Kinematics, MAIN, Offsets, OwnAxes};
use bahn_parameters::PerPlcAxis;
use bahn_path::{Axis, Position};

use crate::setup::{AxisLimit, Remembered};

/// A datum that moves less than this stays where it is, mm: rounding.
const NO_DISTANCE_MM: f64 = 1e-9;
/// A datum that is set: a place from machine zero becomes a value, mm or degrees.
#[derive(Clone, Copy, Debug)]
pub(crate) struct NewDatum {
    pub axis: Axis,
    pub at: f64,
    pub value: f64,
}

/// Datums, traverse range and datum correction.
#[derive(Clone, Debug)]
pub(crate) struct Datums {
    /// Machine position of the workpiece datum for each traverse range.
    points: [Position; 3],
    /// Datum correction by the PLC, mm or degrees, by axis index.
    correction: PerPlcAxis<f64>,
    /// Active traverse range, 0 to 2.
    range: usize,
    /// AXIS LIMIT of MOD.
    axis_limits: Vec<AxisLimit>,
    /// Each traverse range has its datum (MP7490).
    pub each_range: bool,
    /// The kinematics with the datum and the tool in force.
    pub chain: Chain,
}

impl Datums {
    /// The datums and the tool that are remembered.
    pub fn new(remembered: &Remembered, each_range: bool, kinematics: Arc<dyn Kinematics>) -> Datums {
        let points = remembered.datums.map(|datum| datum.0);
        let [first, ..] = points;
        let offsets = Offsets {
            datum: first,
            tool_axis: remembered.tool_axis.unwrap_or(Axis::Z),
            tool_length: remembered.tool_length,
        };
        Datums {
            points,
            correction: PerPlcAxis::splat(0.0),
            range: 0,
            axis_limits: remembered.axis_limits.clone(),
            each_range,
            chain: Chain::new(kinematics, offsets),
        }
    }

    /// The datums of all ranges.
    pub fn points(&self) -> [Position; 3] {
        self.points
    }

    /// The active traverse range, 0 to 2.
    pub fn range(&self) -> usize {
        self.range
    }

    /// Makes a traverse range active, with its datum where each has one (MP7490).
    pub fn select_range(&mut self, range: usize, axes: &mut OwnAxes) {
        self.range = range;
        self.limit(axes);
        self.chain.offsets.datum = self.active(axes);
    }

    /// The software limits of the active traverse range, and within them AXIS LIMIT.
    pub fn limit(&self, axes: &mut OwnAxes) {
        for unit in axes.iter_mut() {
            let Some([least, greatest]) = unit.parameters.travel.ranges_mm.get(self.range).copied() else {
                continue;
            };
            let own =
                |limit: &&AxisLimit| limit.axis == unit.axis && usize::from(limit.range) == self.range + 1;
            let [own_least, own_greatest] = self
                .axis_limits
                .iter()
                .find(own)
                .map_or([f64::NEG_INFINITY, f64::INFINITY], |limit| limit.limits);
            unit.limits = [least.max(own_least), greatest.min(own_greatest)];
        }
    }

    /// AXIS LIMIT of an axis in a traverse range 1 to 3, or none; `false` when its limits are no range within the software
    /// limits, or there is no such axis [003:7121-7157].
    pub fn set_limit(&mut self, axis: Axis, range: u8, limits: Option<[f64; 2]>, axes: &mut OwnAxes) -> bool {
        let place = usize::from(range).wrapping_sub(1);
        let travel = axes
            .at(axis)
            .and_then(|unit| unit.parameters.travel.ranges_mm.get(place));
        let fits = |[least, greatest]: [f64; 2]| {
            travel.is_some_and(|[from, to]| least < greatest && least < *to && greatest > *from)
        };
        if travel.is_none() || !limits.is_none_or(fits) {
            return false;
        }
        self.axis_limits
            .retain(|own| own.axis != axis || own.range != range);
        if let Some(limits) = limits {
            self.axis_limits.push(AxisLimit { axis, range, limits });
        }
        self.limit(axes);
        true
    }

    /// AXIS LIMIT of MOD.
    pub fn axis_limits(&self) -> &[AxisLimit] {
        &self.axis_limits
    }

    /// Datum correction by the PLC: each replaces the last one.
    pub fn correct(&mut self, correction: PerPlcAxis<f64>, axes: &OwnAxes) {
        self.correction = correction;
        self.chain.offsets.datum = self.active(axes);
    }

    /// DATUM SET: the actual position becomes a value. `false` for an axis for which that is inhibited.
    pub fn set(&mut self, axis: Axis, value: f64, axes: &OwnAxes) -> bool {
        let unit = axes.at(axis);
        let Some(unit) = unit.filter(|unit| !unit.parameters.travel.datum_inhibited) else {
            return false;
        };
        let offsets = &self.chain.offsets;
        let length = if axis == offsets.tool_axis {
            offsets.tool_length
        } else {
            0.0
        };
        let at = unit.servo.actual_mm() - length;
        self.set_at(NewDatum { axis, at, value }, axes)
    }

    /// A place from machine zero becomes a value. `false` for an axis for which that is inhibited.
    pub fn set_at(&mut self, NewDatum { axis, at, value }: NewDatum, axes: &OwnAxes) -> bool {
        let unit = axes.at(axis);
        let Some(unit) = unit.filter(|unit| !unit.parameters.travel.datum_inhibited) else {
            return false;
        };
        let correction = self.correction.get(unit.index).copied().unwrap_or(0.0);
        let datum = at - value + correction;
        // An axis with a Hirth coupling stands on its grid only: so does its datum [000:8564].
        let grid = unit.parameters.travel.hirth_deg;
        let datum = grid.map_or(datum, |grid| (datum / grid).round() * grid);
        let place = self.place();
        if let Some(points) = self.points.get_mut(place) {
            points[axis] = datum;
        }
        self.chain.offsets.datum = self.active(axes);
        true
    }

    /// DATUM SET in a tilted plane: the datum moves, mm of the machine. `false` where that is inhibited for an axis.
    pub fn shift(&mut self, ways: [f64; 3], axes: &OwnAxes) -> bool {
        let ways = || {
            MAIN.into_iter()
                .zip(ways)
                .filter(|(_, way)| way.abs() > NO_DISTANCE_MM)
        };
        let free = |axis| {
            axes.at(axis)
                .is_some_and(|unit| !unit.parameters.travel.datum_inhibited)
        };
        if !ways().all(|(axis, _)| free(axis)) {
            return false;
        }
        let place = self.place();
        if let Some(points) = self.points.get_mut(place) {
            for (axis, way) in ways() {
                points[axis] += way;
            }
        }
        self.chain.offsets.datum = self.active(axes);
        true
    }

    /// The datum in force with its correction by the PLC.
    fn active(&self, axes: &OwnAxes) -> Position {
        let mut datum = self.points.get(self.place()).copied().unwrap_or(Position::ZERO);
        for unit in axes.iter() {
            // The display rises by the correction: the datum moves the other way [000:8916-8922].
            datum[unit.axis] -= self.correction.get(unit.index).copied().unwrap_or(0.0);
        }
        datum
    }

    fn place(&self) -> usize {
        if self.each_range { self.range } else { 0 }
    }
}
