//! Elements that follow the spindle: it is the master of the path instead of time.
//!
//! What the element would do in time, within what axes and spindle can do, is the command to the spindle
//! ([`Lead`]). The axes do not take that position but the one that belongs to the angle where the spindle
//! really is ([`Master`]), also beyond the ends of the element. So whatever the spindle does, from lagging to
//! running out without power, the axes keep to the thread.
//!
//! Decision: In a thread (cycle 17) the path leads the spindle in its loop, and the tool axis goes where the
//! spindle's angle says; after EMERGENCY STOP both are coupled anew as they stand; an axis that stood without feed
//! enable or loop while its spindle came to where it is led keeps to its thread and goes after it on its ramp, with
//! no NC start, as from where it ran on without feed enable; MANUAL OPERATION with the axis key leads the tool out;
//! INTERNAL STOP is refused until then (also `kernel/src/thread.rs`)

use bahn_path::{Position, Thread};

use crate::drive::Lead;
use crate::item::Item;
use crate::ramp::{Driven, Ramp};

/// Degrees per second of one rpm.
const DEG_S: f64 = 6.0;

/// Which angle of the spindle belongs to which place on the current element.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Coupling {
    /// Angle at the start of the element, degrees.
    origin_deg: f64,
    /// Its change by the path length, degrees/mm.
    deg_per_mm: f64,
}

impl Coupling {
    pub(super) fn new(thread: &Thread, origin_deg: f64) -> Coupling {
        // The angle of the spindle grows with M03.
        let sign = -thread.spindle.sign();
        Coupling {
            origin_deg,
            deg_per_mm: sign * 360.0 / thread.pitch_mm,
        }
    }

    /// The element after one of this length goes on in the thread, if it does not begin its own.
    pub(super) fn go_on(&self, length: f64, next: Option<&Thread>) -> Option<Coupling> {
        let thread = next.filter(|thread| thread.orientation_deg.is_none())?;
        Some(Coupling::new(thread, self.angle_deg(length)))
    }

    /// The angle that belongs to a place so far along the element, mm.
    fn angle_deg(&self, distance_mm: f64) -> f64 {
        self.origin_deg + self.deg_per_mm * distance_mm
    }

    /// The command to the spindle so far along the element, mm, at a speed, mm/s, negative backwards.
    pub(super) fn lead(&self, distance_mm: f64, speed: f64) -> Lead {
        Lead {
            angle_deg: self.angle_deg(distance_mm),
            rpm: self.deg_per_mm * speed / DEG_S,
        }
    }

    /// The position that belongs to an angle of the spindle.
    pub(super) fn position(&self, item: &Item, actual_deg: f64) -> Position {
        place(item, (actual_deg - self.origin_deg) / self.deg_per_mm)
    }

    /// From now on this position belongs to that angle of the spindle, degrees. How far along the element it lies,
    /// mm, and where that is.
    pub(super) fn renew(&mut self, item: &Item, position: &Position, angle_deg: f64) -> (f64, Position) {
        let distance = distance(item, position);
        self.origin_deg = angle_deg - self.deg_per_mm * distance;
        (distance, place(item, distance))
    }
}

/// Goes back along an element for a time, not faster than a limit, mm/s: the speed and the distance that is covered then. Before the
/// start of the element it stays where it is.
pub(super) fn go_back(item: &Item, speed: f64, covered: f64, limit: f64, time: f64) -> (f64, f64) {
    let ramp = Ramp {
        speed,
        rest: covered,
        acceleration: item.acceleration,
        limit,
        exit_squared: 0.0,
    };
    match ramp.drive(time) {
        Driven::OnTheWay { speed, rest } => (speed, rest),
        Driven::Arrived { .. } => (0.0, covered.min(0.0)),
    }
}

/// The place so far along an item, mm; beyond its ends straight on.
fn place(item: &Item, distance: f64) -> Position {
    let (start, end) = (&item.element.start, &item.element.end);
    let fraction = if item.length > 0.0 {
        distance / item.length
    } else {
        0.0
    };
    let mut position = *end;
    for axis in start.known().iter() {
        position[axis] = start[axis] + (end[axis] - start[axis]) * fraction;
    }
    position
}

/// How far along an item a position lies, mm.
fn distance(item: &Item, position: &Position) -> f64 {
    let (start, end) = (&item.element.start, &item.element.end);
    let along = start
        .known()
        .iter()
        .filter(|axis| position.get(*axis).is_some())
        .map(|axis| (position[axis] - start[axis]) * (end[axis] - start[axis]))
        .sum::<f64>();
    if item.length > 0.0 {
        along / item.length
    } else {
        0.0
    }
}
