//! Elements that follow the spindle: it is the master of the path instead of time.
//!
//! What the element would do in time, within what axes and spindle can do, is what the spindle is told
//! ([`Lead`]). The axes do not take that position but the one that belongs to the angle where the spindle
//! really is ([`Master`]), also beyond the ends of the element. So whatever the spindle does, from lagging to
//! running out without power, the axes keep to the thread.

use bahn_path::{Position, Thread};

use super::{Interpolator, Phase};
use crate::drive::{Drive, Lead, State};
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
    fn new(thread: &Thread, origin_deg: f64) -> Coupling {
        let sign = if thread.clockwise { 1.0 } else { -1.0 };
        Coupling {
            origin_deg,
            deg_per_mm: sign * 360.0 / thread.pitch_mm,
        }
    }

    fn angle_deg(&self, way_mm: f64) -> f64 {
        self.origin_deg + self.deg_per_mm * way_mm
    }
}

impl<E> Interpolator<E> {
    /// Couples the current element to the spindle that was in the thread before, if it goes on from there.
    pub(super) fn couple_on(&mut self, before: Option<(Coupling, f64)>) {
        let thread = self.ring.current().and_then(|item| item.element.thread());
        self.coupling = match (thread, before) {
            (Some(thread), Some((coupling, length))) if thread.orientation_deg.is_none() => {
                Some(Coupling::new(thread, coupling.angle_deg(length)))
            }
            _ => None,
        };
        self.backward = false;
    }

    /// Couples the current element to the spindle as it stands. `false` when the spindle is not ready.
    pub(super) fn couple(&mut self, drive: &Drive) -> bool {
        let thread = self.ring.current().and_then(|item| item.element.thread());
        if let (Some(thread), None) = (thread, self.coupling) {
            if !drive.master.ready {
                return false;
            }
            self.coupling = Some(Coupling::new(thread, drive.master.nominal_deg));
        }
        true
    }

    /// Couples an element that has begun anew, for spindle and axes were moved meanwhile: this position
    /// belongs to that angle of the spindle, degrees.
    pub fn couple_again(&mut self, position: &Position, angle_deg: f64) {
        let Some((item, coupling)) = self.ring.current().zip(self.coupling.as_mut()) else {
            return;
        };
        let way = way(item, position);
        coupling.origin_deg = angle_deg - coupling.deg_per_mm * way;
        if self.phase == Phase::Move {
            self.rest = (item.length - way).clamp(0.0, item.length);
        }
        self.speed = 0.0;
        self.position = place(item, way);
    }

    /// Whether the path follows the spindle: it has begun an element that does so, and none behind it.
    pub fn is_coupled(&self) -> bool {
        self.coupling.is_some()
    }

    /// What is told the spindle.
    pub(super) fn lead(&self) -> Option<Lead> {
        let (item, coupling) = self.ring.current().zip(self.coupling)?;
        let speed = if self.backward { -self.speed } else { self.speed };
        Some(Lead {
            angle_deg: coupling.angle_deg(item.length - self.rest),
            rpm: coupling.deg_per_mm * speed / DEG_S,
        })
    }

    /// The position that belongs to an angle of the spindle.
    pub(super) fn following(&self, actual_deg: f64) -> Option<Position> {
        let (item, coupling) = self.ring.current().zip(self.coupling)?;
        Some(place(
            item,
            (actual_deg - coupling.origin_deg) / coupling.deg_per_mm,
        ))
    }

    /// Goes back along the current element for a time; `None` when it goes forward.
    pub(super) fn drive_back(&mut self, drive: &Drive, time: f64) -> Option<State> {
        let item = self.ring.current()?;
        let wanted = drive.back && self.coupling.is_some();
        if self.speed <= 0.0 {
            self.backward = wanted;
        }
        if !self.backward {
            return None;
        }
        let covered = Ramp {
            speed: self.speed,
            rest: item.length - self.rest,
            acceleration: item.acceleration,
            limit: if wanted { self.ring.feed() } else { 0.0 },
            exit_squared: 0.0,
        };
        let left = match covered.drive(time) {
            Driven::OnTheWay { speed, rest } => {
                self.speed = speed;
                rest
            }
            Driven::Arrived { .. } => {
                self.speed = 0.0;
                0.0
            }
        };
        self.rest = item.length - left;
        Some(if self.speed > 0.0 {
            State::Moving
        } else {
            State::Held
        })
    }
}

/// The place so far along an item, mm; beyond its ends straight on.
fn place(item: &Item, way: f64) -> Position {
    let (start, end) = (&item.element.start, &item.element.end);
    let fraction = if item.length > 0.0 { way / item.length } else { 0.0 };
    let mut position = *end;
    for axis in start.known().iter() {
        position[axis] = start[axis] + (end[axis] - start[axis]) * fraction;
    }
    position
}

/// How far along an item a position lies, mm.
fn way(item: &Item, position: &Position) -> f64 {
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
