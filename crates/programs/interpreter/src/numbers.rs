//! What the numbers of a program say: Q parameters and units.

use bahn_parameters::{InchFeed, MessageId};
use bahn_path::Axis;
use bahn_program::{Unit, Value};

use crate::error::Fault;
use crate::q_parameters::{QTable, preassigned};
use crate::settings::Settings;
use crate::status::Spindle;

/// The Q parameters, and the units in which a program counts.
#[derive(Clone, Debug)]
pub(crate) struct Numbers {
    pub q: QTable,
    /// Unit of the running program.
    pub unit: Unit,
    /// Millimetres of its length unit.
    pub unit_mm: f64,
    /// Unit of the main program.
    main_unit: Unit,
}

impl Numbers {
    /// Those of a main program in a unit.
    pub fn new(settings: &Settings, unit: Unit) -> Numbers {
        let mut q = QTable::new(usize::from(settings.model.limits().q_max) + 1);
        q.preassign(preassigned::TOOL_AXIS, -1.0);
        q.preassign(preassigned::SPINDLE, Spindle::Undefined.q110());
        q.preassign(preassigned::OVERLAP, settings.rules.overlap);
        q.preassign(preassigned::UNIT, if unit == Unit::Inch { 1.0 } else { 0.0 });
        for &(number, value) in &settings.q_values {
            q.preassign(number, value);
        }
        Numbers {
            q,
            unit,
            unit_mm: unit.mm(),
            main_unit: unit,
        }
    }

    /// A program in this unit goes on.
    pub fn enter(&mut self, unit: Unit) {
        self.unit = unit;
        self.unit_mm = unit.mm();
    }

    /// A length in mm.
    pub fn length(&self, value: Value) -> Result<f64, Fault> {
        Ok(self.q.value(value)? * self.unit_mm)
    }

    /// A feed in mm/min, checked against the range of the control [003:2142-2144].
    pub fn feed(&self, value: Value, settings: &Settings) -> Result<f64, Fault> {
        let feed = self.q.value(value)?;
        let inch_feed = settings.inch_feed();
        let max_mm_min = settings.model.limits().feed_max_mm_min;
        let max = self.unit.feed_max(inch_feed, max_mm_min);
        if !(0.0..=max).contains(&feed) {
            let unit = match (self.unit, inch_feed) {
                (Unit::Mm, _) => "mm/min",
                (Unit::Inch, InchFeed::Whole) => "inch/min",
                (Unit::Inch, InchFeed::Tenths) => "tenths of an inch/min",
            };
            return Err(Fault::new(
                MessageId::EntryValueIncorrect,
                format!("F takes 0 to {max} {unit}"),
            ));
        }
        Ok((feed * self.unit.feed_mm_min(inch_feed)).min(max_mm_min))
    }

    /// Millimetres or degrees of a value for an axis.
    pub fn axis_unit(&self, axis: Axis) -> f64 {
        if axis.is_rotary() { 1.0 } else { self.unit_mm }
    }

    /// Q parameters of the tool in use, in the unit of the main program.
    pub fn preassign_tool(&mut self, length: f64, radius: f64) {
        let unit = self.main_unit_mm();
        self.q.preassign(preassigned::TOOL_RADIUS, radius / unit);
        self.q.preassign(preassigned::TOOL_LENGTH, length / unit);
    }

    /// The Q parameter of the tool axis.
    pub fn preassign_tool_axis(&mut self, axis: Axis) {
        let number = match axis {
            Axis::X => 0.0,
            Axis::Y => 1.0,
            Axis::Z => 2.0,
            Axis::U => 6.0,
            Axis::V => 7.0,
            Axis::W => 8.0,
            Axis::A | Axis::B | Axis::C => -1.0,
        };
        self.q.preassign(preassigned::TOOL_AXIS, number);
    }

    /// Millimetres of the unit of the main program, in which the control shows lengths.
    pub fn main_unit_mm(&self) -> f64 {
        self.main_unit.mm()
    }
}

/// The number, zero for an axis without a position: increments then count from zero (inferred).
pub(crate) fn known(value: f64) -> f64 {
    if value.is_nan() { 0.0 } else { value }
}
