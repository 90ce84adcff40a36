//! What the control looks after beside the movements: offsets of the drives, lubrication, axis errors,
//! machine parameters that the PLC changed.

use bahn_interpreter::Rules;
use bahn_motion::Interpolator;
use bahn_plc::mirror_parameters;
use bahn_servo::{Gantry, OffsetInterval};

use crate::compensation::Correction;
use crate::control::{Control, LOOK_AHEAD, path_limits};
use crate::markers::{AXES, LUBRICATION_PULSE};
use crate::message::Message;
use crate::overrides::Override;
use crate::panel::Direction;

/// What is looked after.
#[derive(Clone, Debug)]
pub(crate) struct Upkeep {
    /// When the offsets are adjusted next (MP1220).
    interval: OffsetInterval,
    /// The compensation tables of the active line.
    pub corrections: Vec<Correction>,
    /// The active line of the assignment.
    pub line: Option<usize>,
    /// The PLC chose another traverse range: the blocks that are on their way are to be looked at anew.
    pub range_changed: bool,
    /// The limits of the path have changed; they take effect when no program runs.
    limits_changed: bool,
}

impl Upkeep {
    pub fn new(offset_interval_s: f64) -> Upkeep {
        Upkeep {
            interval: OffsetInterval::new(offset_interval_s),
            corrections: Vec::new(),
            line: None,
            range_changed: false,
            limits_changed: false,
        }
    }
}

impl Control {
    /// Once in each contour cycle.
    pub(crate) fn look_after(&mut self) {
        self.lubricate();
        self.adjust_cyclically();
        self.correct_axes();
        self.leave_limits();
    }

    /// A path within the limits as they are now, between programs; allocates.
    pub(crate) fn prepare_limits(&mut self) {
        if self.upkeep.limits_changed && !self.run.is_active() {
            self.upkeep.limits_changed = false;
            self.path = Interpolator::new(&path_limits(self.link.list(), &self.axes), LOOK_AHEAD);
        }
    }

    /// M2624 ff. of a block that was refused goes with its message, unless the axis stands at the limit.
    fn leave_limits(&mut self) {
        for unit in &mut self.axes {
            let Some(direction) = unit.at_limit else { continue };
            let limit = unit
                .limits
                .get(usize::from(direction == Direction::Plus))
                .copied();
            let message = Message::limit(unit.index, direction);
            if limit != Some(unit.nominal) && !self.messages.contains(&message) {
                unit.at_limit = None;
            }
        }
    }

    /// The way of each axis beyond MP4060: it asks for lubrication [000:3575-3577].
    fn lubricate(&mut self) {
        for unit in &self.axes {
            let Some(limit) = unit.parameters.travel.lubrication_mm else {
                continue;
            };
            if unit.travelled > limit
                && let Some(pulse) = LUBRICATION_PULSE.get(unit.index)
                && !self.exchange.nc().bit(*pulse)
            {
                self.exchange.nc_set(*pulse, true);
            }
        }
    }

    /// The cyclic offset adjustment: all axes stand in their loops, the spindle is off. An axis with
    /// integral factor does without [000:5012] [000:5022-5037].
    fn adjust_cyclically(&mut self) {
        let spindle_off = self.spindle.state().volts == 0.0;
        let permitted = spindle_off
            && self
                .axes
                .iter()
                .filter(|unit| unit.parameters.controlled)
                .all(|unit| unit.servo.closed() && unit.stands() && unit.servo.in_position());
        if !self.upkeep.interval.pass(self.timing.contour_us(), permitted) {
            return;
        }
        for unit in &mut self.axes {
            if unit.parameters.controlled && unit.parameters.output.integral_factor == 0.0 {
                unit.servo.adjust_offset();
            }
        }
    }

    /// Answers to code number 75 368: compensates the offsets of the axes, or switches the automatic
    /// adjustment off [000:5014-5020].
    pub(crate) fn adjust_offsets(&mut self, adjust: bool) -> bool {
        if !std::mem::take(&mut self.manual.offsets_shown) {
            return false;
        }
        for unit in &mut self.axes {
            if adjust {
                unit.servo.compensate_offset();
            } else {
                unit.servo.set_offset_compensation(0.0);
            }
        }
        if !adjust {
            self.upkeep.interval = OffsetInterval::new(0.0);
        }
        self.unsaved = true;
        true
    }

    /// The compensated offsets, V.
    pub(crate) fn offset_volts(&self) -> [f64; AXES] {
        let mut volts = [0.0; AXES];
        for unit in &self.axes {
            if let Some(slot) = volts.get_mut(unit.index) {
                *slot = unit.servo.offset_compensation_volts();
            }
        }
        volts
    }

    /// The offsets that code number 75 368 shows while its dialogue is open, by axis index, in units of
    /// 0.15 mV [000:5014-5016].
    pub fn offsets_shown(&self) -> Option<[i32; AXES]> {
        let mut units = [0; AXES];
        for unit in &self.axes {
            if let Some(slot) = units.get_mut(unit.index) {
                *slot = unit.servo.offset_units();
            }
        }
        self.manual.offsets_shown.then_some(units)
    }

    /// Module 9031 changed machine parameters: they take effect now, in a program that runs with the blocks that are
    /// not yet read; those of the path with the next run.
    pub(crate) fn take_changed_parameters(&mut self) {
        if !std::mem::take(&mut self.link.requests.parameters_changed) {
            return;
        }
        let list = self.link.list();
        mirror_parameters(list, &mut self.exchange);
        if let Some(feeder) = &mut self.run.feeder {
            feeder.interpreter_mut().set_rules(Rules::of(list));
        }
        self.plc_parameters = list.plc_parameters();
        let overrides = self.operation.overrides;
        self.operation = list.operation_parameters();
        if self.operation.overrides.feed_steps != overrides.feed_steps {
            self.feed_override = Override::feed(self.operation.overrides.feed_steps);
        }
        if self.operation.overrides.spindle_steps != overrides.spindle_steps {
            self.spindle_override = Override::spindle(self.operation.overrides.spindle_steps);
        }
        self.spindle.set_parameters(list.spindle_parameters());
        let mut interval = 0.0;
        for unit in &mut self.axes {
            let Ok(index) = u8::try_from(unit.index) else {
                continue;
            };
            let mut parameters = list.axis_parameters(index);
            if let Some(master) = unit
                .parameters
                .synchronization
                .master
                .filter(|_| unit.coupling.is_some())
            {
                parameters = Gantry::slave_parameters(&parameters, &list.axis_parameters(master));
            }
            unit.set_parameters(parameters);
            if let Some(limits) = parameters.travel.ranges_mm.get(self.range) {
                unit.limits = *limits;
            }
            interval = parameters.output.offset_interval_s;
        }
        self.upkeep.interval = OffsetInterval::new(interval);
        self.upkeep.limits_changed = true;
    }
}
