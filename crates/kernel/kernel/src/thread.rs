//! Tapping: cycle 2 with a floating holder, and cycles 17 and 18, in which the tool axis follows the spindle
//! [000:6047-6145].
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
//!
//! Decision: NC stop acts in cycle 2 when the tool is out of the thread; when EMERGENCY STOP has taken the spindle
//! away there, NC start is refused and INTERNAL STOP leaves the tap to the operator; the spindle stands after cycle
//! 17 (also `interpreter/src/cycles/drilling.rs`)

use bahn_motion::{Lead, Master};
use bahn_path::{At, Axis, AxisSet, OverrideLaw, PathElement, Position, Thread};

use crate::axes::OwnAxes;
use crate::axis::{Mover, Operation};
use crate::kinematics::Chain;
use crate::now::Now;
use crate::spindle::SpindleLoop;
use crate::track::Track;

/// Slower than this a tool axis that follows the spindle counts as standing, mm/s (inferred).
const STANDS_MM_S: f64 = 0.05;

/// Slower than this the spindle counts as standing before a thread begins, rpm (inferred).
const STANDS_RPM: f64 = 2.0;

/// An axis no farther off is where the thread is, mm: what rounding leaves.
const BESIDE_MM: f64 = 1e-6;

/// Axes and spindle of a channel, to be looked at.
#[derive(Clone, Copy)]
pub struct Standing<'a> {
    /// The axes of the channel.
    pub axes: &'a OwnAxes<'a>,
    /// The kinematics with datum and tool.
    pub chain: &'a Chain,
    /// The spindle that threads lead.
    pub spindle: &'a SpindleLoop,
    /// What holds for all movements of this cycle.
    pub now: &'a Now,
}

/// Axes and spindle of a channel, to be led.
pub struct Leading<'a, 'b> {
    /// The axes of the channel.
    pub axes: &'a mut OwnAxes<'b>,
    /// The kinematics with datum and tool.
    pub chain: &'a Chain,
    /// The spindle that threads lead.
    pub spindle: &'a mut SpindleLoop,
    /// What holds for all movements of this cycle.
    pub now: &'a Now,
}

impl Leading<'_, '_> {
    /// The same, to be looked at.
    fn standing(&self) -> Standing<'_> {
        Standing {
            axes: self.axes,
            chain: self.chain,
            spindle: self.spindle,
            now: self.now,
        }
    }
}

/// Which kind of tapping is in force.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Taps {
    /// A tap is in its hole: cycle 2, or a thread that goes back as well.
    pub called: bool,
    /// The path follows the spindle.
    pub rigid: bool,
}

/// What a run keeps of its thread from cycle to cycle.
#[derive(Clone, Copy, Debug, Default)]
pub struct Tapping {
    /// The orientation before the thread was asked for.
    oriented: bool,
    /// The spindle may be led.
    ready: bool,
    /// Spindle and axis came apart in the thread.
    apart: bool,
    /// The axis stands without feed enable in the thread.
    held: bool,
    /// The spindle was taken away while cycle 2 tapped.
    lost: bool,
}

/// A path that follows the spindle.
pub fn is_rigid(element: Option<&PathElement>) -> bool {
    element.is_some_and(|element| element.thread().is_some())
}

/// The element is a tapping of cycle 2: the spindle turns freely in a floating holder.
pub fn is_floating(element: Option<&PathElement>) -> bool {
    matches!(
        element.map(|element| element.override_law),
        Some(OverrideLaw::Tapping { .. })
    )
}

/// What a thread comes to before its spindle is led.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Preparation {
    /// The spindle is still being brought to where the thread begins.
    Waits,
    /// The spindle cannot be led.
    Refused,
}

impl Tapping {
    /// NC stop does not stop the feed of cycle 2 while the spindle turns in the thread: it acts when the tool is
    /// out (inferred). Everything that stops the drives does.
    pub fn runs_out(&self, element: Option<&PathElement>, axes: &OwnAxes, drives_stopped: bool) -> bool {
        let sound = || axes.iter().all(|unit| unit.servo.fault().is_none());
        is_floating(element) && !self.lost && !drives_stopped && sound()
    }

    /// The spindle as the interpolator follows it: where it will be when the axis is at its next position.
    pub fn master(&self, track: &Track, at: &Standing) -> Master {
        let element = track.path.element();
        let moved = at
            .axes
            .iter()
            .find(|unit| element.is_some_and(|element| element.moves_axis(unit.axis)));
        let delay = moved.map_or(0.0, |unit| unit.servo.delay_s());
        let [nominal_deg, actual_deg] = at.spindle.angles_deg(at.now.time_s + delay);
        Master {
            nominal_deg,
            actual_deg,
            ready: self.ready,
        }
    }

    /// The path waits for the spindle: M2499 closed, oriented (M2127), the axes in pre-control [000:6122].
    /// `open`: the PLC keeps the loop of the spindle open.
    pub fn prepare(&mut self, track: &Track, open: bool, at: &mut Leading) -> Preparation {
        let Some(thread) = track.path.element().and_then(PathElement::thread).copied() else {
            return Preparation::Waits;
        };
        if !at.spindle.can_be_led() {
            return Preparation::Refused;
        }
        if open {
            return Preparation::Waits;
        }
        // What EMERGENCY STOP has ended begins anew with NC start.
        let asked = self.oriented && at.spindle.holds_orientation();
        if let Some(angle) = thread.orientation_deg.filter(|_| !asked) {
            at.spindle.orient_shortest(angle);
            self.oriented = true;
            return Preparation::Waits;
        }
        let oriented = thread.orientation_deg.is_none() || at.spindle.is_oriented();
        let methods = at
            .axes
            .iter()
            .all(|unit| unit.has_method(Operation::RigidTapping));
        let stands = at.spindle.actual_rpm().abs() < STANDS_RPM;
        self.ready = oriented && stands && methods;
        Preparation::Waits
    }

    /// What the path wants of the spindle.
    pub fn lead(&mut self, lead: Option<Lead>, spindle: &mut SpindleLoop) {
        spindle.lead(lead.map(|lead| lead.angle_deg));
        if lead.is_some() {
            (self.ready, self.oriented) = (false, false);
        }
    }

    /// Spindle and axis have come apart in the thread: they are coupled again when both stand in their loops.
    pub fn part(&mut self, track: &Track, element: Option<&PathElement>) {
        self.apart |= track.path.is_coupled();
        self.lost |= is_floating(element);
    }

    /// The spindle that cycle 2 needs was taken away: its feed does not go on.
    pub fn has_lost_spindle(&self) -> bool {
        self.lost
    }

    /// The axes cannot move along the path; or they can again, and in a thread wait for their spindle to stand, too. One that
    /// stands where the path has led it goes on; one that ran out without its drive has come apart from the axis
    /// (inferred): to go after it would be a jump.
    pub fn holds(&mut self, track: &mut Track, runs: bool, at: &mut Leading) -> bool {
        if !track.is_able(at.axes) || !self.may_follow(track, at) {
            self.held = track.path.is_coupled();
            return true;
        }
        let thread = track.path.element().and_then(PathElement::thread);
        if let Some(thread) = thread.filter(|_| self.held) {
            self.held = at.spindle.actual_rpm().abs() >= STANDS_RPM;
            let standing = at.standing();
            self.apart |= !self.held && missing_mm(thread, &standing) > window_mm(&standing);
            if !self.held && !self.apart {
                go_after(track, at);
            }
        }
        if self.held {
            return true;
        }
        self.couple(track, runs, at);
        runs && self.apart || !track.is_able(at.axes)
    }

    /// The axes that follow the spindle are held in their loops: one that the PLC has clamped meanwhile would be driven out at
    /// once by all that the spindle has turned. It is asked for, as at the beginning of an element.
    fn may_follow(&self, track: &Track, at: &mut Leading) -> bool {
        if self.apart || !track.path.is_coupled() {
            return true;
        }
        let clamped = at.axes.clamped();
        track.ask_to_unclamp(clamped, at.axes);
        let element = track.path.element();
        !clamped
            .iter()
            .any(|axis| element.is_some_and(|element| element.moves_axis(axis)))
    }

    /// In a thread the path is in position when tool axis and spindle are within MP7150 of its place [000:6128], and
    /// the path is where the spindle is, which it may have stood off. While the two are apart neither is held anywhere: the end of the thread is not
    /// reached.
    pub fn is_in_position(&self, track: &Track, at: &Standing) -> bool {
        let Some(thread) = track.path.element().and_then(PathElement::thread) else {
            return true;
        };
        if self.apart {
            return false;
        }
        let missing = missing_mm(thread, at);
        let window = window_mm(at);
        let axis = at.chain.offsets.tool_axis;
        let [_, now] = at.spindle.angles_deg(0.0);
        let missed = (track.path.position_at(now)[axis] - track.path.position()[axis]).abs();
        let mut axes = at.axes.iter().filter(|unit| unit.mover == Mover::Path);
        missing <= window
            && missed <= STANDS_MM_S * at.now.time_s
            && axes.all(|unit| unit.speed.abs() <= STANDS_MM_S && unit.servo.lag_mm().abs() <= window)
    }

    /// The axis goes where the spindle turns.
    pub fn follows_spindle(&self, track: &Track) -> bool {
        track.path.is_coupled() && !self.held && !self.apart
    }

    /// Couples them as they stand, once they can move again and the spindle does not: the tool axis does not go back to where the path has left
    /// it. A tool that is out of the thread goes back to where that begins: nothing couples it there.
    fn couple(&mut self, track: &mut Track, runs: bool, at: &mut Leading) {
        let sound = at
            .axes
            .iter()
            .all(|unit| unit.servo.fault().is_none() && unit.servo.closed());
        let stands = at.spindle.actual_rpm().abs() < STANDS_RPM;
        if !self.apart || !at.now.loops_closed || !sound || !stands {
            return;
        }
        self.apart = false;
        let Some(element) = track.path.element() else {
            return;
        };
        let tool_axis = at.chain.offsets.tool_axis;
        let mut here = at.axes.programmed_position();
        for unit in at.axes.iter().filter(|unit| unit.is_free()) {
            here[unit.axis] = unit.servo.actual_mm();
        }
        let here = at.chain.to_path(&here);
        let mut place = track.path.position();
        for unit in at.axes.iter().filter(|unit| element.moves_axis(unit.axis)) {
            place[unit.axis] = here[unit.axis];
        }
        place[tool_axis] = place[tool_axis].min(top(element, tool_axis));
        let [_, now] = at.spindle.angles_deg(0.0);
        let own = at.axes.iter().map(|unit| unit.axis);
        let moved: AxisSet = own.filter(|axis| element.moves_axis(*axis)).collect();
        track.path.couple_again(&place, now);
        at.spindle.lead_from_here();
        // In a tilted plane axes that ran on are beside the thread, too. A run that waits for its feed enable only leads
        // them back to it before it goes on, an interrupted one with NC start.
        let nominal = at.chain.to_axes(&track.path.position());
        for unit in at.axes.iter_mut().filter(|unit| moved.contains(unit.axis)) {
            let actual = unit.servo.actual_mm();
            if runs {
                unit.stand(nominal[unit.axis]);
                unit.go_back();
            } else {
                unit.stand(actual);
                let beside = (nominal[unit.axis] - actual).abs() > BESIDE_MM;
                unit.left_at = beside.then_some(nominal[unit.axis]);
            }
        }
    }

    /// Once in each contour cycle: M2048 and M2095, window and ramp [000:6066] [000:6124-6135].
    pub fn follow(&mut self, track: &Track, active: bool, at: &mut Leading) -> Taps {
        let tapped = track.path.element().filter(|_| active);
        let (rigid, floating) = (is_rigid(tapped), is_floating(tapped));
        let taps = tapped
            .and_then(PathElement::thread)
            .is_some_and(|thread| thread.retracts);
        if !rigid {
            *self = Tapping {
                lost: self.lost && floating,
                ..Tapping::default()
            };
            at.spindle.lead(None);
        }
        at.spindle.monitor_movement(beside_max_deg(track, &at.standing()));
        let window = rigid.then(|| window_mm(&at.standing()));
        let element = track.path.element();
        for unit in at.axes.iter_mut() {
            let moves = || element.is_some_and(|element| element.moves_axis(unit.axis));
            let window = window.filter(|_| moves());
            unit.servo.set_window(window);
        }
        let braking = floating.then(|| {
            let brakes = element.is_some_and(|element| {
                let early = |at| matches!(at, At::BeforeEnd(_));
                element.functions().iter().any(|function| early(function.at))
            });
            if brakes { track.path.braking_s() } else { 0.0 }
        });
        at.spindle.set_tapping(braking);
        Taps {
            called: taps || floating,
            rigid,
        }
    }
}

/// The axes stood while their spindle ran on to where it is led: they go after it on their ramps, and the path waits for them
/// (inferred). What one reaches in a cycle is no jump.
fn go_after(track: &Track, at: &mut Leading) {
    let Some(element) = track.path.element() else {
        return;
    };
    let nominal = nominal(track, &at.standing());
    let cycle_s = at.now.time_s;
    for unit in at.axes.iter_mut().filter(|unit| element.moves_axis(unit.axis)) {
        let reached = unit.parameters.motion.acceleration_m_s2 * 1e3 * cycle_s * cycle_s;
        if (nominal[unit.axis] - unit.nominal).abs() > reached {
            unit.stand(nominal[unit.axis]);
            unit.go_back();
        }
    }
}

/// Where the axes of a thread belong with their spindle where it is.
fn nominal(track: &Track, at: &Standing) -> Position {
    let [_, now] = at.spindle.angles_deg(0.0);
    at.chain.to_axes(&track.path.position_at(now))
}

/// The tool that follows the spindle is not yet, or no more, above the thread.
pub fn is_in_thread(track: &Track, at: &Standing) -> bool {
    let axis = at.chain.offsets.tool_axis;
    let Some(element) = track.path.element().filter(|_| track.path.is_coupled()) else {
        return false;
    };
    track.path.position()[axis] < top(element, axis) - window_mm(at)
}

/// Where the tool is out of the thread.
fn top(element: &PathElement, tool_axis: Axis) -> f64 {
    element.start[tool_axis].max(element.end[tool_axis])
}

/// So far the spindle may turn beside what it is led, degrees, before that is a fault: as far as takes the tool axis out of its
/// place by MP1110. In an EMERGENCY STOP it runs out, and where the PLC suppresses the monitoring of the tool axis there is
/// none (inferred).
fn beside_max_deg(track: &Track, at: &Standing) -> Option<f64> {
    let element = track.path.element().filter(|_| track.path.is_coupled())?;
    let unit = at.axes.at(at.chain.offsets.tool_axis)?;
    let monitored = at.now.ready && at.now.loops_closed && unit.servo.is_monitored();
    let pitch = element.thread().filter(|_| monitored)?.pitch_mm;
    Some(unit.parameters.monitoring.standstill_mm / pitch * 360.0)
}

/// How far the spindle is from where it is held, in mm of the thread.
fn missing_mm(thread: &Thread, at: &Standing) -> f64 {
    let [held, now] = at.spindle.angles_deg(0.0);
    (held - now).abs() / 360.0 * thread.pitch_mm
}

/// The axes of the thread have come to a standstill as far as they can: what stands or cannot follow.
pub fn stands(track: &Track, axes: &OwnAxes) -> bool {
    track.path.speed_mm_s() == 0.0
        && axes
            .iter()
            .all(|unit| unit.speed.abs() <= STANDS_MM_S || unit.servo.fault().is_some())
}

/// MP7150; the TNC 151/155 have none, there MP1030 of the tool axis counts (inferred).
fn window_mm(at: &Standing) -> f64 {
    let own = at.spindle.thread_window_mm();
    let axis = at.axes.at(at.chain.offsets.tool_axis);
    if own > 0.0 {
        own
    } else {
        axis.map_or(0.0, |unit| unit.parameters.monitoring.window_mm)
    }
}
