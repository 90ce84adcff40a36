//! The reference run: axis by axis over the reference marks.
//!
//! The flow charts of the four sequences are lost in the manual's text; what is built here is what remains
//! of them and what sister manuals say (inferred) [000:4583-4667]. The cam of each axis is the marker M2556
//! ff. that the PLC copies from its input.

use bahn_motion::Aim;
use bahn_parameters::ReferenceType;

use crate::axes::{AxisUnit, Mover};
use crate::command::Mode;
use crate::control::Control;
use crate::markers::REFERENCE_CAM;

/// The reference run.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub(crate) struct ReferenceRun {
    /// NC start was given: the axes follow in the order of MP1340.
    automatic: bool,
    /// The axis that runs, by its place, and its step.
    running: Option<(usize, Step)>,
}

#[derive(Clone, Copy, Debug, PartialEq)]
enum Step {
    /// Towards the mark; `reversed` after the cam.
    Seek { reversed: bool },
    /// Back from the cam, slowly, until it opens [`ReferenceType::RotaryEncoder`].
    LeaveCam,
    /// The cam is open; the next pulse counts.
    Pulse,
    /// The mark is found: to a standstill, or to the software limit.
    Stop,
}

impl ReferenceRun {
    pub fn is_running(&self) -> bool {
        self.automatic || self.running.is_some()
    }

    /// The run is broken off.
    pub fn abort(&mut self) {
        *self = ReferenceRun::default();
    }
}

impl Control {
    /// Moves the axes in PASS OVER REFERENCE MARKS.
    pub(crate) fn move_reference(&mut self) {
        if self.stop_given() {
            self.reference.automatic = false;
        } else if self.start_pressed {
            self.reference.automatic = true;
        }
        self.count_display_axes();
        if self.reference.running.is_none() {
            self.next_reference_axis();
        }
        if let Some((place, step)) = self.reference.running {
            let stop = self.stop_given() || !(self.reference.automatic || self.key_of(place));
            self.reference.running = self.run_reference(place, step, stop);
        }
        let missing = self
            .axes
            .iter()
            .any(|unit| !unit.referenced && !unit.is_plc_axis() && unit.parameters.controlled);
        if !missing && self.reference.running.is_none() {
            self.reference.abort();
            self.set_mode(Mode::Manual);
        }
    }

    /// A direction key of the axis is pressed: the operator chooses the order [000:4563-4566].
    fn key_of(&self, place: usize) -> bool {
        self.axes
            .get(place)
            .and_then(|unit| self.panel.axis_keys.get(unit.index))
            .is_some_and(Option::is_some)
    }

    fn next_reference_axis(&mut self) {
        let waiting = |unit: &AxisUnit| {
            !unit.referenced
                && !unit.is_plc_axis()
                && unit.parameters.controlled
                && unit.servo.closed()
                && unit.enabled
                && unit.parameters.synchronization.master.is_none()
        };
        let next = if self.reference.automatic {
            let named = self.axes.iter().enumerate().filter(|(_, unit)| waiting(unit));
            named
                .filter_map(|(place, unit)| Some((unit.parameters.reference.place?, place)))
                .min()
                .map(|(_, place)| place)
        } else {
            (0..self.axes.len())
                .find(|place| self.key_of(*place) && self.axes.get(*place).is_some_and(waiting))
        };
        let Some(place) = next else {
            self.reference.automatic = false;
            return;
        };
        let cam = self.cam(place);
        if let Some(unit) = self.axes.get_mut(place) {
            unit.servo.forget_marks();
            let step = match unit.parameters.reference.kind {
                ReferenceType::RotaryEncoder if cam => Step::LeaveCam,
                _ => Step::Seek { reversed: cam },
            };
            self.reference.running = Some((place, step));
        }
    }

    /// The cam of an axis is closed.
    fn cam(&self, place: usize) -> bool {
        self.axes
            .get(place)
            .and_then(|unit| REFERENCE_CAM.get(unit.index))
            .is_some_and(|marker| self.exchange.nc().bit(*marker))
    }

    /// One cycle of the run of an axis; what comes next.
    fn run_reference(&mut self, place: usize, step: Step, stop: bool) -> Option<(usize, Step)> {
        let (time, cam) = (self.cycle_s(), self.cam(place));
        let rapid_limit = self.rapid_limit_mm_min();
        let percent = self.feed_override.percent();
        let unit = self.axes.get_mut(place)?;
        if !(unit.servo.closed() && unit.enabled) {
            unit.mover = Mover::None;
            return None;
        }
        unit.mover = Mover::Reference;
        let reference = unit.parameters.reference;
        let forwards = if reference.negative { -1.0 } else { 1.0 };
        if stop && step != Step::Stop {
            unit.drive(time, Aim::Feed(0.0), unit.parameters.motion.rapid_mm_min);
            if !unit.stands() {
                return Some((place, step));
            }
            unit.mover = Mover::None;
            return None;
        }
        let step = next_step(unit, step, cam);
        let (direction, feed) = match step {
            Step::Seek { reversed: false } => (forwards, reference.feed_mm_min),
            Step::Seek { reversed: true } => (-forwards, reference.feed_mm_min),
            Step::LeaveCam | Step::Pulse => (-forwards, reference.leaving_mm_min),
            Step::Stop => (0.0, reference.feed_mm_min),
        };
        // The override acts (inferred: only PLC axes are said to run without).
        let feed = (feed * percent / 100.0).min(rapid_limit);
        let outside = unit.limited().and_then(|[least, greatest]| {
            let inside = unit.nominal.clamp(least, greatest.max(least));
            (inside != unit.nominal).then_some(inside)
        });
        let aim = match (step, outside) {
            // Found beyond the software limit: the axis returns to it.
            (Step::Stop, Some(limit)) if unit.stands() || unit.nominal != limit => Aim::Position(limit),
            _ => Aim::Feed(direction * feed),
        };
        let slowing = step == Step::Stop && matches!(aim, Aim::Feed(_));
        let greatest = if slowing {
            unit.parameters.motion.rapid_mm_min
        } else {
            feed
        };
        unit.drive(time, aim, greatest);
        if step == Step::Stop && unit.stands() && outside.is_none() {
            unit.mover = Mover::None;
            return None;
        }
        Some((place, step))
    }

    /// Axes that are only displayed: the counter is zero on the reference mark [000:4573].
    fn count_display_axes(&mut self) {
        for unit in self.axes.iter_mut().filter(|unit| !unit.parameters.controlled) {
            if let Some(mark) = unit.servo.take_mark() {
                unit.set_datum(mark.count, mark.scale_mm.unwrap_or(0.0));
                unit.referenced = true;
            }
        }
    }
}

/// What the cam and the marks make of a step.
fn next_step(unit: &mut AxisUnit, step: Step, cam: bool) -> Step {
    let kind = unit.parameters.reference.kind;
    let mark = unit.servo.take_mark();
    let step = match (step, kind) {
        // The cam ends the range; the mark lies before it.
        (Step::Seek { reversed: false }, ReferenceType::OneMark | ReferenceType::DistanceCoded) if cam => {
            unit.servo.forget_marks();
            return Step::Seek { reversed: true };
        }
        // The cam selects the pulse: the first one after leaving it (inferred).
        (Step::Seek { .. }, ReferenceType::RotaryEncoder) => {
            return if cam { Step::LeaveCam } else { step };
        }
        (Step::LeaveCam, _) => return if cam { step } else { Step::Pulse },
        _ => step,
    };
    // Marks under the cam do not count with one mark: it must lie outside.
    if step == Step::Stop || (cam && kind == ReferenceType::OneMark) {
        return step;
    }
    let Some((count, scale_mm)) = mark.and_then(|mark| Some((mark.count, mark.scale_mm?))) else {
        return step;
    };
    unit.set_datum(count, scale_mm - unit.parameters.travel.machine_datum_mm);
    unit.referenced = true;
    Step::Stop
}
