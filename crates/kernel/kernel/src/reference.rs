//! The reference run: axis by axis over the reference marks.
//!
//! The flow charts of the four sequences are lost in the manual's text; what is built here is what remains
//! of them and what sister manuals say (inferred) [000:4583-4667]. The cams of the axes are given by their indices.
//!
//! Decision: TNC 151/155: an axis that stands on its cam takes the first mark on its way; with MP69 all that stand on
//! theirs are first backed off with the feed of the run, in the order of MP59, and coded marks need no MP69
//!
//! Decision: TNC 151/155: direction buttons lead an axis over its mark after code number 84 159 alone, with the feed of the
//! run and in the direction of the button, until the mark is found (also `tnc/src/desk.rs`)
//!
//! Decision: TNC 151/155: the mark of an inhibited axis counts under the cams as any other (MP75); until then its display
//! stands at 0

use bahn_motion::Aim;
use bahn_parameters::PerPlcAxis;
use bahn_parameters::axis::InhibitedMark;
use bahn_servo::settings::MarkKind;

use crate::axes::OwnAxes;
use crate::axis::{AxisUnit, Mover};
use crate::gantry;
use crate::now::Now;
use bahn_path::Direction;

/// The cams of the axes, by axis index.
#[derive(Clone, Copy, Debug)]
pub struct Cams {
    /// The reference end position is closed.
    pub end: PerPlcAxis<bool>,
    /// The pulse of the mark is inhibited.
    pub inhibit: PerPlcAxis<bool>,
}

impl Cams {
    /// The end cam of an axis is closed.
    fn holds(&self, unit: &AxisUnit) -> bool {
        self.end.get(unit.index).is_some_and(|cam| *cam)
    }

    /// A mark of an axis counts where the cams are now.
    fn choose(&self, unit: &AxisUnit) -> bool {
        let inhibited = self.inhibit.get(unit.index).is_some_and(|cam| *cam);
        match unit.parameters.reference.kind {
            MarkKind::UnderCam => self.holds(unit) && !inhibited,
            MarkKind::OneMark | MarkKind::DistanceCodedBesideCam => !self.holds(unit),
            MarkKind::DistanceCodedOld | MarkKind::RotaryEncoder | MarkKind::DistanceCoded => true,
        }
    }
}

/// What the direction keys do in the reference run.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum DirectionKeys {
    /// They choose the axis; its direction is that of the machine parameters [000:4563-4566].
    #[default]
    ChooseAxis,
    /// Nothing.
    Dead,
    /// They lead the axis in their direction [001:955].
    Lead,
}

/// What is left of the reference run: the axes seek their marks one after the other.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct ReferenceRun {
    /// NC start was given: the axes follow in the order of their machine parameters.
    automatic: bool,
    /// The axis that runs, by its place, and its step.
    running: Option<(usize, Step)>,
    /// The control has asked for it since power-on.
    asked: bool,
    keys: DirectionKeys,
}

#[derive(Clone, Copy, Debug, PartialEq)]
enum Step {
    /// Back from the cam, so far as it opens, before the axes approach their marks [001:989-995].
    BackOff,
    /// Towards the mark; `reversed` after the cam.
    Seek { reversed: bool },
    /// Back from the cam, slowly, until it opens [`MarkKind::RotaryEncoder`].
    LeaveCam,
    /// The cam is open; the next pulse counts.
    Pulse,
    /// The mark is found: to a standstill, or to the software limit.
    Stop,
}

impl ReferenceRun {
    /// A run in which the direction keys do so.
    pub fn new(keys: DirectionKeys) -> ReferenceRun {
        ReferenceRun {
            keys,
            ..ReferenceRun::default()
        }
    }

    /// The direction keys do something else from now on.
    pub fn set_keys(&mut self, keys: DirectionKeys) {
        self.keys = keys;
    }

    /// Axes are led over their marks, or are to be.
    pub fn is_running(&self) -> bool {
        self.automatic || self.running.is_some()
    }

    /// The run is broken off.
    pub fn abort(&mut self) {
        self.automatic = false;
        self.running = None;
    }

    /// The loops were closed: whether the control now asks for the run, once since power-on.
    pub fn is_asked_for(&mut self, axes: &OwnAxes) -> bool {
        !std::mem::replace(&mut self.asked, true) && is_missing(axes, true)
    }

    /// Moves the axes over their reference marks; whether the run is over.
    pub fn moves(&mut self, axes: &mut OwnAxes, cams: &Cams, now: &Now) -> bool {
        if now.stop {
            self.automatic = false;
        } else if now.start {
            self.automatic = true;
        }
        if self.running.is_none() {
            self.next_axis(axes, cams, now);
        }
        if let Some((place, step)) = self.running {
            let key = self.key_of(place, axes, now);
            let stop = now.stop || !(self.automatic || key.is_some());
            let led = key.filter(|_| self.keys == DirectionKeys::Lead && !self.automatic);
            self.running = run_axis(place, step, (stop, led), axes, cams, now);
        }
        if self.running.is_some() {
            return false;
        }
        // Axes that the machine parameters do not name pass their marks by their keys only [000:4649-4654].
        let over = self.automatic && !is_missing(axes, true) || !is_missing(axes, false);
        if over {
            self.abort();
        }
        over
    }

    /// Chooses the axis that runs next; one that is clamped or has no feed enable is waited for.
    fn next_axis(&mut self, axes: &mut OwnAxes, cams: &Cams, now: &Now) {
        let next = if self.automatic {
            let named = axes.places().filter_map(|place| {
                let unit = axes.get(place).filter(|unit| waits(unit))?;
                Some((!backs_off(unit, cams), unit.parameters.reference.place?, place))
            });
            named.min().map(|(_, _, place)| place)
        } else {
            axes.places()
                .find(|place| self.key_of(*place, axes, now).is_some() && axes.get(*place).is_some_and(waits))
        };
        let Some(place) = next else { return };
        let Some(unit) = axes.get_mut(place) else {
            return;
        };
        unit.ask_to_unclamp();
        if !(unit.can_be_driven() && unit.stands()) {
            return;
        }
        let backs_off = self.automatic && backs_off(unit, cams);
        let cam = cams.holds(unit);
        for unit in axes.all_mut() {
            let slave = unit.coupling.as_ref().is_some_and(|of| of.master == place);
            if slave {
                unit.servo.forget_marks();
            }
        }
        if let Some(unit) = axes.get_mut(place) {
            unit.servo.forget_marks();
            let step = match unit.parameters.reference.kind {
                _ if backs_off => Step::BackOff,
                MarkKind::UnderCam => Step::Seek { reversed: false },
                MarkKind::RotaryEncoder if cam => Step::LeaveCam,
                _ => Step::Seek { reversed: cam },
            };
            self.running = Some((place, step));
        }
    }

    /// The direction key of the axis that is pressed, where it does something.
    fn key_of(&self, place: usize, axes: &OwnAxes, now: &Now) -> Option<Direction> {
        let unit = axes.get(place).filter(|_| self.keys != DirectionKeys::Dead)?;
        now.axis_keys.get(unit.index).copied().flatten()
    }
}

/// An axis whose mark is evaluated has not passed it.
pub fn is_due<'a>(mut axes: impl Iterator<Item = &'a AxisUnit>) -> bool {
    axes.any(|unit| waits(unit) && unit.parameters.reference.place.is_some())
}

/// An axis has not passed its reference mark: any one, or one of those that the machine parameters name. What is asked of
/// an axis that is not controlled the operator does.
fn is_missing(axes: &OwnAxes, named: bool) -> bool {
    let wanted = InhibitedMark::Needed { asked: true };
    let by_hand =
        |unit: &AxisUnit| !unit.parameters.controlled && unit.parameters.reference.inhibited == wanted;
    axes.iter().any(|unit| by_hand(unit) && !unit.referenced)
        || match named {
            true => is_due(axes.iter()),
            false => axes.iter().any(waits),
        }
}

/// An axis stands on its cam and is backed off it before the axes approach their marks [001:993-995].
pub fn backs_off(unit: &AxisUnit, cams: &Cams) -> bool {
    unit.parameters.reference.backs_off && waits(unit) && cams.holds(unit)
}

/// The prompt of the reference run names an axis: it has not passed its mark, and shall.
pub fn is_asked(unit: &AxisUnit) -> bool {
    let asked = match unit.parameters.reference.inhibited {
        InhibitedMark::Needed { asked } => asked,
        InhibitedMark::Zeroes => true,
        InhibitedMark::Preset => false,
    };
    !unit.referenced && !unit.is_plc_axis() && (unit.parameters.controlled || asked)
}

/// One cycle of the run of an axis, which is to stop or is `led` by a key; what comes next.
fn run_axis(
    place: usize,
    step: Step,
    (stop, led): (bool, Option<Direction>),
    axes: &mut OwnAxes,
    cams: &Cams,
    now: &Now,
) -> Option<(usize, Step)> {
    let time = now.time_s;
    let unit = axes.get_mut(place)?;
    let cam = cams.holds(unit);
    if !unit.can_be_driven() {
        unit.mover = Mover::None;
        return None;
    }
    unit.mover = Mover::Reference;
    let reference = unit.parameters.reference;
    let forwards = led.unwrap_or(reference.direction).sign();
    if stop && step != Step::Stop || step == Step::BackOff && !cam {
        unit.drive(time, Aim::Feed(0.0), unit.parameters.motion.rapid_mm_min);
        if !unit.stands() {
            return Some((place, step));
        }
        unit.mover = Mover::None;
        return None;
    }
    let (step, synchronous) = next_step(place, step, cam, axes, cams);
    let unit = axes.get_mut(place)?;
    let (direction, feed) = match step {
        Step::Seek { reversed: false } => (forwards, reference.feed_mm_min),
        Step::Seek { reversed: true } | Step::BackOff => (-forwards, reference.feed_mm_min),
        Step::LeaveCam | Step::Pulse => (-forwards, reference.leaving_mm_min),
        Step::Stop => (0.0, reference.feed_mm_min),
    };
    // The override acts (inferred: only PLC axes are said to run without).
    let feed = (feed * now.feed_percent / 100.0).min(now.rapid_limit_mm_min);
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
    let settled = unit.stands() && unit.servo.in_position();
    if step == Step::Stop && settled && synchronous && outside.is_none() {
        // The next axis starts when the PLC has seen this one in position.
        unit.mover = Mover::None;
        return (!unit.in_position).then_some((place, step));
    }
    Some((place, step))
}

/// What the cam and the marks make of a step, and whether slaves are where they shall be.
fn next_step(place: usize, step: Step, cam: bool, axes: &mut OwnAxes, cams: &Cams) -> (Step, bool) {
    let Some(unit) = axes.get_mut(place) else {
        return (Step::Stop, true);
    };
    let kind = unit.parameters.reference.kind;
    let turned = turn_at_cam(unit, step, kind, cam);
    // Marks do not count before the cam has chosen them, nor while an axis is backed off.
    let choosing = kind == MarkKind::RotaryEncoder && turned != Step::Pulse || turned == Step::BackOff;
    let counts = turned == step && !choosing;
    let mark = unit.servo.take_mark();
    let mark = mark.filter(|_| counts && !unit.referenced && cams.choose(unit));
    if let Some((count, position_mm)) = mark.and_then(|mark| unit.located(mark)) {
        unit.referenced = true;
        let shift = unit.set_datum(count, position_mm);
        gantry::shifted(axes.all_mut(), place, shift);
    }
    let slaves = gantry::reference(axes.all_mut(), place, counts, |unit| {
        kind == MarkKind::OneMark && cams.holds(unit)
    });
    let found = axes.get(place).is_some_and(|unit| unit.referenced) && slaves.found;
    let step = if found { Step::Stop } else { turned };
    (step, slaves.synchronous)
}

/// Axes that are only displayed: the counter is zero on the reference mark [000:4573].
pub fn count_display_axes(axes: &mut OwnAxes, cams: &Cams) {
    let missing = |unit: &&mut AxisUnit| !unit.parameters.controlled && !unit.referenced;
    for unit in axes.iter_mut().filter(missing) {
        let inhibited = unit.parameters.reference.inhibited;
        let mark = unit.servo.take_mark();
        let mark = mark.filter(|_| inhibited == InhibitedMark::Zeroes || cams.choose(unit));
        let at = mark.and_then(|mark| Some((mark.count, mark.scale_mm?)));
        if let Some((count, scale)) = at {
            unit.set_datum(count, scale);
        } else if matches!(inhibited, InhibitedMark::Needed { .. }) {
            unit.set_datum(unit.servo.count(), 0.0);
            unit.stand(0.0);
        }
        unit.referenced = at.is_some() || inhibited == InhibitedMark::Preset;
    }
}

/// An axis that must pass its reference mark by itself.
pub fn waits(unit: &AxisUnit) -> bool {
    !unit.referenced && unit.parameters.controlled && unit.is_free()
}

/// What the cam makes of a step.
fn turn_at_cam(unit: &mut AxisUnit, step: Step, kind: MarkKind, cam: bool) -> Step {
    match (step, kind) {
        // The cam ends the range; the mark lies before it. With old distance-coded marks it is ignored
        // once the axis runs [000:4605].
        (Step::Seek { reversed: false }, MarkKind::OneMark | MarkKind::DistanceCoded) if cam => {
            unit.servo.forget_marks();
            Step::Seek { reversed: true }
        }
        // The cam selects the pulse: the first one after leaving it (inferred).
        (Step::Seek { .. }, MarkKind::RotaryEncoder) if cam => Step::LeaveCam,
        (Step::LeaveCam, _) if !cam => Step::Pulse,
        _ => step,
    }
}
