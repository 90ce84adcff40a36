//! Tapping: cycle 2 with a floating holder, and cycle 17, in which the tool axis follows the spindle
//! [000:6047-6141].
//!
//! In a thread the path leads the spindle, and the tool axis goes where the angle of the spindle says
//! ([`Interpolator`](bahn_motion::Interpolator)). NC stop brakes both together; NC start goes on. What brings
//! the two apart, EMERGENCY STOP or POSITIONING ERROR, couples them anew as they stand afterwards: the tool
//! sits in the thread, so nothing is forced (inferred). Then NC start goes on cutting, and MANUAL OPERATION
//! with the axis key away from the workpiece leads the tool out of the thread (inferred; so later controls). INTERNAL
//! STOP would part them for good: it is refused until the tool is out (inferred).
//!
//! In cycle 2 nothing couples them. When the spindle was taken away in the hole, NC start would pull at a tap that does
//! not turn: it is refused, and INTERNAL STOP leaves the tap to the operator, who turns it out by hand with M03 or M04
//! and the axis key (inferred).

use bahn_exchange::signal;
use bahn_motion::{Lead, Master};
use bahn_parameters::MessageId;
use bahn_path::{At, OverrideLaw, PathElement};

use crate::axes::Mover;
use crate::control::Control;
use crate::emergency::Circuit;
use crate::message::Message;
use crate::panel::Direction;
use crate::run::Resume;

/// Slower than this a tool axis that follows the spindle counts as standing, mm/s (inferred).
const STANDS_MM_S: f64 = 0.05;

/// Slower than this the spindle counts as standing before a thread begins, rpm (inferred).
const STANDS_RPM: f64 = 2.0;

/// What tapping remembers.
#[derive(Clone, Copy, Debug, Default)]
pub(crate) struct Tapping {
    /// The orientation before the thread was asked for.
    oriented: bool,
    /// The spindle may be led.
    ready: bool,
    /// Spindle and axis came apart in the thread.
    apart: bool,
    /// The spindle was taken away while cycle 2 tapped.
    lost: bool,
}

impl Control {
    /// The element that is executed, while a run is.
    fn tapping_element(&self) -> Option<&PathElement> {
        self.path.element().filter(|_| self.run.is_active())
    }

    /// A path that follows the spindle is executed, or begins.
    pub(crate) fn taps_rigidly(&self) -> bool {
        self.tapping_element()
            .is_some_and(|element| element.thread().is_some())
    }

    /// Cycle 2 taps.
    pub(crate) fn taps_floating(&self) -> bool {
        let law = self.tapping_element().map(|element| element.override_law);
        matches!(law, Some(OverrideLaw::Tapping { .. }))
    }

    /// NC stop does not stop the feed of cycle 2 while the spindle turns in the thread: it acts when the tool is
    /// out (inferred). Everything that stops the drives does.
    pub(crate) fn runs_out_of_thread(&self) -> bool {
        self.taps_floating()
            && !self.tapping.lost
            && self.emergency.circuit() == Circuit::Ready
            && !self.exchange.nc().bit(signal::NC_STOP_AND_OPEN_LOOPS)
            && !self.messages.is_fatal()
            && self.axes.iter().all(|unit| unit.servo.fault().is_none())
    }

    /// The spindle as the interpolator follows it: where it will be when the axis is at its next position.
    pub(crate) fn master(&self) -> Master {
        let element = self.path.element();
        let moved = self
            .axes
            .iter()
            .find(|unit| element.is_some_and(|element| element.moves(unit.axis)));
        let delay = moved.map_or(0.0, |unit| unit.servo.delay_s());
        let [nominal_deg, actual_deg] = self.spindle.angles_deg(self.cycle_s() + delay);
        Master {
            nominal_deg,
            actual_deg,
            ready: self.tapping.ready,
        }
    }

    /// The path is led back, or on, out of the thread: MANUAL OPERATION and the axis key plus of the tool axis.
    pub(crate) fn way_out(&self) -> [bool; 2] {
        if !self.manual_operation_is_on() {
            return [false; 2];
        }
        let axis = self.offsets.tool_axis;
        let unit = self.axes.iter().find(|unit| unit.axis == axis);
        let key = unit.and_then(|unit| self.panel.axis_keys.get(unit.index).copied().flatten());
        let ascends = self
            .path
            .element()
            .is_some_and(|element| element.end[axis] > element.start[axis]);
        let wanted = key == Some(Direction::Plus) && !self.stop_given();
        [wanted && !ascends, wanted && ascends]
    }

    /// The path waits for the spindle: M2499 closed, oriented (M2127), the axes in pre-control [000:6122].
    pub(crate) fn prepare_thread(&mut self) {
        let Some(thread) = self.path.element().and_then(PathElement::thread).copied() else {
            return;
        };
        if !self.spindle.can_be_led() {
            // No manual names the message of a spindle without analogue output or encoder (inferred).
            self.show(Message::Plain(MessageId::WrongRpm), false);
            let block = self.path.element().map_or(0, |element| element.sequence);
            self.abort_run(Resume::Block(block));
            return;
        }
        if self.exchange.nc().bit(signal::OPEN_SPINDLE_LOOP) {
            return;
        }
        if let Some(angle) = thread.orientation_deg.filter(|_| !self.tapping.oriented) {
            self.spindle.orient_for_thread(angle);
            self.tapping.oriented = true;
            return;
        }
        let oriented = thread.orientation_deg.is_none() || self.spindle.is_oriented();
        let methods = self.axes.iter().all(|unit| unit.has_method(true, true));
        let stands = self.spindle.state().actual_rpm.abs() < STANDS_RPM;
        self.tapping.ready = oriented && stands && methods;
    }

    /// What the path wants of the spindle.
    pub(crate) fn lead_spindle(&mut self, lead: Option<Lead>) {
        self.spindle.lead(lead.map(|lead| lead.angle_deg));
        if lead.is_some() {
            (self.tapping.ready, self.tapping.oriented) = (false, false);
        }
    }

    /// Spindle and axis have come apart in the thread: they are coupled again when both stand in their loops.
    pub(crate) fn part_thread(&mut self) {
        self.tapping.apart |= self.path.is_coupled();
        self.tapping.lost |= self.taps_floating();
    }

    /// The spindle that cycle 2 needs was taken away: its feed does not go on.
    pub(crate) fn has_lost_spindle(&self) -> bool {
        self.tapping.lost
    }

    /// The tool that follows the spindle is not yet, or no more, above the thread.
    pub(crate) fn is_in_thread(&self) -> bool {
        let axis = self.offsets.tool_axis;
        let Some(element) = self.path.element().filter(|_| self.path.is_coupled()) else {
            return false;
        };
        let out = element.start[axis].max(element.end[axis]);
        self.path.position()[axis] < out - self.thread_window()
    }

    /// Couples them as they stand, once they can move again. The tool axis does not go back to where the path
    /// has left it.
    pub(crate) fn couple_thread(&mut self) {
        let sound = self
            .axes
            .iter()
            .all(|unit| unit.servo.fault().is_none() && unit.servo.closed());
        if !self.tapping.apart || !self.loops_closed || !sound {
            return;
        }
        self.tapping.apart = false;
        let Some(element) = self.path.element() else {
            return;
        };
        for unit in self.axes.iter_mut().filter(|unit| element.moves(unit.axis)) {
            unit.left_at = None;
            unit.stand(unit.servo.actual_mm());
        }
        let mut here = self.path.position();
        let machine = self.offsets.to_path(&self.machine_position());
        for unit in self.axes.iter().filter(|unit| element.moves(unit.axis)) {
            here[unit.axis] = machine[unit.axis];
        }
        let [_, now] = self.spindle.angles_deg(0.0);
        self.path.couple_again(&here, now);
    }

    /// In a thread the path is in position when tool axis and spindle are within MP7150 of its place [000:6128].
    pub(crate) fn thread_in_position(&self) -> bool {
        let Some(thread) = self.path.element().and_then(PathElement::thread) else {
            return true;
        };
        let [held, now] = self.spindle.angles_deg(0.0);
        let missing = (held - now).abs() / 360.0 * thread.pitch_mm;
        let window = self.thread_window();
        let axes = self.axes.iter().filter(|unit| unit.mover == Mover::Path);
        axes.fold(missing <= window, |there, unit| {
            there && unit.speed.abs() <= STANDS_MM_S && unit.servo.lag_mm().abs() <= window
        })
    }

    /// MP7150; the TNC 151/155 have none, there MP1030 of the tool axis counts (inferred).
    fn thread_window(&self) -> f64 {
        let own = self.spindle.thread_window_mm();
        let axis = self.axes.iter().find(|unit| unit.axis == self.offsets.tool_axis);
        if own > 0.0 {
            own
        } else {
            axis.map_or(0.0, |unit| unit.parameters.monitoring.window_mm)
        }
    }

    /// The axes of the thread have come to a standstill as far as they can: what stands or cannot follow.
    pub(crate) fn thread_stands(&self) -> bool {
        self.path.speed_mm_s() == 0.0
            && self
                .axes
                .iter()
                .all(|unit| unit.speed.abs() <= STANDS_MM_S || unit.servo.fault().is_some())
    }

    /// Once in each contour cycle: M2048 and M2095, window and ramp [000:6066] [000:6124-6135].
    pub(crate) fn follow_tapping(&mut self) {
        let (rigid, floating) = (self.taps_rigidly(), self.taps_floating());
        self.put(signal::TAPPING_CALLED, rigid || floating);
        self.put(signal::RIGID_TAPPING_ACTIVE, rigid);
        if !rigid {
            self.tapping = Tapping {
                lost: self.tapping.lost && floating,
                ..Tapping::default()
            };
            self.spindle.lead(None);
        }
        let window = rigid.then(|| self.thread_window());
        let element = self.path.element();
        for unit in &mut self.axes {
            let moves = element.is_some_and(|element| element.moves(unit.axis));
            unit.servo.set_window(window.filter(|_| moves));
        }
        let braking = floating.then(|| {
            let brakes = element.is_some_and(|element| {
                let early = |at| matches!(at, At::BeforeEnd(_));
                element.functions().iter().any(|function| early(function.at))
            });
            if brakes { self.path.braking_s() } else { 0.0 }
        });
        self.spindle.set_tapping(braking);
    }
}
