//! A tilted plane by hand: direction keys and handwheel lead the tool along the axes of a tilted working plane, in
//! which the positions are shown and datums are set [000:4256].
//!
//! Decision: 3D ROT by hand is the plane of the swivel axes as they stood when it was switched on, or of the
//! positions that were entered; that for program run is the plane in which each program begins (one of DIN 66025,
//! which has no planes, is refused) until the menu or cycle 19 says something else, whatever MP7300 cancels: it is
//! refused where cycle 19 would be, with a basic rotation, and while a program can go on. Programs are not in the
//! plane by hand, after them it is there again; one axis of the plane moves at a time, also by jog increments, and a
//! datum set in it moves that of the machine along the plane

use std::sync::Arc;

use bahn_motion::{Aim, PointToPoint};
use bahn_parameters::axis::AxisParameters;
use bahn_path::{Axis, Direction, Placement, Position, Swivels};

use crate::axes::OwnAxes;
use crate::axis::{AxisUnit, Mover};
use crate::by_hand::AtLimit;
use crate::kinematics::{Chain, Offsets};
use crate::now::Now;

/// The axes of a plane.
pub const MAIN: [Axis; 3] = [Axis::X, Axis::Y, Axis::Z];
/// An axis with a smaller part in a direction does not move along it.
const NO_PART: f64 = 1e-12;
/// So near a software limit an axis stands at it, mm: positions in the plane are rounded.
const AT_LIMIT_MM: f64 = 1e-6;

/// What the operator wants of the axes of the plane.
#[derive(Clone, Copy, Debug, Default)]
pub struct Wish {
    /// A direction key that counts, with its feed, mm/min.
    pub key: Option<(Direction, f64)>,
    /// What the handwheel was turned, mm.
    pub wheel_mm: f64,
    /// A jog increment that begins, with its sign, mm. Where something moves already it is none, as upright.
    pub jog_mm: Option<f64>,
    /// The feed of jog increments, mm/min.
    pub jog_mm_min: f64,
}

/// The tilted plane in which the operator moves the axes, if it is on.
#[derive(Clone, Debug, Default)]
pub struct Leaning {
    plane: Option<Plane>,
    moving: Option<Moving>,
}

#[derive(Clone, Debug)]
struct Plane {
    swivels: Swivels,
    /// Machine positions of the swivel axes, degrees.
    angles: Position,
    /// It is of this datum and this tool.
    of: Offsets,
    placement: Arc<Placement>,
}

/// A movement along an axis of the plane. Another one begins when it has ended (inferred).
#[derive(Clone, Copy, Debug)]
struct Moving {
    along: usize,
    /// Distance since its begin, mm.
    way: PointToPoint,
    /// Where the handwheel or a jog increment leads.
    target: Option<f64>,
    /// It is a jog increment.
    jogs: bool,
    /// Handwheel or jog increment would lead beyond a limit.
    pushed: Option<Direction>,
}

impl Plane {
    fn new(swivels: Swivels, angles: Position, of: Offsets) -> Plane {
        let tool = (of.tool_axis, of.tool_length);
        let placement = Placement::tilted(&swivels, &angles, [&of.datum, &Position::ZERO], tool);
        Plane {
            swivels,
            angles,
            of,
            placement: Arc::new(placement),
        }
    }
}

impl Leaning {
    /// A tilted plane is chosen: by hand the axes move along it.
    pub fn is_on(&self) -> bool {
        self.plane.is_some()
    }

    /// Machine positions of the swivel axes in the plane, degrees.
    pub fn angles(&self) -> Option<Position> {
        self.plane.as_ref().map(|plane| plane.angles)
    }

    /// Switches it on, in the plane of these positions of the swivel axes, or off; outside the cycle.
    pub fn switch(&mut self, angles: Option<Position>, swivels: Swivels, of: Offsets) {
        self.moving = None;
        self.plane = angles.map(|angles| Plane::new(swivels, angles, of));
    }

    /// The positions by hand are those of the plane, with datum and tool as they are now; outside the cycle.
    pub fn refresh(&mut self, by_hand: bool, chain: &mut Chain) {
        let Some(plane) = &mut self.plane else { return };
        if by_hand && plane.of != chain.offsets {
            *plane = Plane::new(plane.swivels.clone(), plane.angles, chain.offsets);
        }
        if by_hand {
            chain.place(Some(&plane.placement));
        } else if Placement::is_same(chain.placement(), Some(&plane.placement)) {
            chain.place(None);
        }
    }

    /// It is switched off, the axes are shown upright again.
    pub fn leave(chain: &mut Chain) {
        chain.place(None);
    }

    /// By how much the workpiece datum moves, mm of the machine, when it moves by a distance along an axis of the plane; `None`
    /// where nothing is tilted.
    pub fn datum_shift(&self, axis: Axis, way: f64) -> Option<[f64; 3]> {
        let plane = self.plane.as_ref()?;
        let along = MAIN.iter().position(|main| *main == axis)?;
        let rotation = plane.placement.rotation()?;
        let wanted = rotation.map(|row| row.get(along).copied().unwrap_or(0.0) * way);
        // Where the table has turned the workpiece: back to its coordinates.
        let at = |point| plane.swivels.on_table(point, &plane.angles);
        let zero = at([0.0; 3]);
        Some([[1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]].map(|unit| {
            let turned = at(unit);
            let parts = turned.iter().zip(zero).zip(wanted);
            parts
                .map(|((turned, zero), wanted)| (turned - zero) * wanted)
                .sum()
        }))
    }

    /// Moves the main axes for a cycle as the operator wants it.
    pub fn moves(
        &mut self,
        wishes: &[Wish; 3],
        axes: &mut OwnAxes,
        now: &Now,
        report: &mut dyn FnMut(AtLimit),
    ) {
        let Some(rotation) = self.plane.as_ref().and_then(|plane| plane.placement.rotation()) else {
            return;
        };
        let wanted =
            |wish: &Wish| !now.stop && (wish.key.is_some() || wish.wheel_mm != 0.0 || wish.jog_mm.is_some());
        let first = wishes.iter().position(wanted);
        let begin = |along| {
            let target = wishes.get(along).and_then(|wish: &Wish| wish.jog_mm);
            Moving {
                along,
                way: PointToPoint::new(0.0),
                target,
                jogs: target.is_some(),
                pushed: None,
            }
        };
        let Some(mut moving) = self.moving.take().or(first.map(begin)) else {
            return;
        };
        let parts = rotation.map(|row| row.get(moving.along).copied().unwrap_or(0.0));
        let part = |axis: Axis| match parts.get(axis.index()) {
            Some(part) if part.abs() > NO_PART => *part,
            _ => 0.0,
        };
        if !is_able(axes, part) {
            // What moved stands on its ramp or at once, as the loops have it.
            axes.release(|mover| mover == Mover::Manual);
            return;
        }
        let wish = wishes.get(moving.along).copied().unwrap_or_default();
        let ways = [Direction::Minus, Direction::Plus].map(|direction| way_left(axes, direction, part));
        let least = |of: fn(&AxisParameters) -> f64| least_of(axes, part, of);
        let rapid = least(|parameters| parameters.motion.rapid_mm_min).min(now.rapid_limit_mm_min);
        let acceleration = least(|parameters| parameters.motion.acceleration_m_s2);
        let at = moving.way.position();
        let [back, on] = ways.map(|(way, _)| way);
        if wish.wheel_mm != 0.0 {
            moving.target = Some(moving.target.unwrap_or(at) + wish.wheel_mm);
        }
        if let Some(target) = &mut moving.target {
            moving.pushed = match *target {
                target if target > at + on => Some(Direction::Plus),
                target if target < at - back => Some(Direction::Minus),
                _ => moving.pushed,
            };
            *target = target.clamp(at - back, at + on);
        }
        let (aim, feed) = match (wish.key, moving.target) {
            _ if now.stop => (Aim::Feed(0.0), rapid),
            (Some((Direction::Plus, feed)), _) => (towards(at, on, Direction::Plus, feed), feed.min(rapid)),
            (Some((Direction::Minus, feed)), _) => {
                (towards(at, back, Direction::Minus, feed), feed.min(rapid))
            }
            (None, Some(target)) if moving.jogs => (Aim::Position(target), wish.jog_mm_min.min(rapid)),
            (None, Some(target)) => (Aim::Position(target), rapid),
            (None, None) => (Aim::Feed(0.0), rapid),
        };
        let way = moving.way.cycle(now.time_s, aim, feed, acceleration) - at;
        // With the cycle after its last movement the axes stand, too.
        let stands = moving.way.speed_mm_s() == 0.0 && way == 0.0;
        let over =
            stands && (now.stop || wish.key.is_none() && moving.target.is_none_or(|to| moving.way.is_at(to)));
        for unit in axes.iter_mut().filter(|unit| part(unit.axis) != 0.0) {
            unit.mover = if over { Mover::None } else { Mover::Manual };
            unit.follow(unit.nominal + part(unit.axis) * way, now.time_s);
        }
        if wish.key.is_some() {
            (moving.target, moving.jogs, moving.pushed) = (None, false, None);
        }
        if let Some(direction) = wish.key.map(|(direction, _)| direction).or(moving.pushed) {
            let [(_, minus), (_, plus)] = ways;
            let limit = if direction == Direction::Plus { plus } else { minus };
            show_limit(limit.filter(|_| stands), axes, report);
        }
        self.moving = (!over).then_some(moving);
        hide_limits(axes, report);
    }
}

/// The axes with a part in the movement are free to move.
fn is_able(axes: &mut OwnAxes, part: impl Fn(Axis) -> f64) -> bool {
    let (mut able, mut clamped) = (true, false);
    for unit in axes.iter().filter(|unit| part(unit.axis) != 0.0) {
        clamped |= !unit.servo.closed();
        able &= unit.can_be_driven() && unit.is_free() && matches!(unit.mover, Mover::None | Mover::Manual);
    }
    if clamped {
        for unit in axes.iter_mut().filter(|unit| part(unit.axis) != 0.0) {
            unit.wait_to_begin();
        }
    }
    able
}

/// How far the axes may go in a direction of the plane, mm, and the limit that ends it.
fn way_left(
    axes: &OwnAxes,
    direction: Direction,
    part: impl Fn(Axis) -> f64,
) -> (f64, Option<(Axis, Direction)>) {
    let mut least = (f64::INFINITY, None);
    for unit in axes.iter() {
        let along = part(unit.axis) * direction.sign();
        let Some([low, high]) = unit.limited().filter(|_| along != 0.0) else {
            continue;
        };
        let (limit, side) = if along > 0.0 {
            (high, Direction::Plus)
        } else {
            (low, Direction::Minus)
        };
        let way = ((limit - unit.nominal) / along).max(0.0);
        if way < least.0 {
            least = (way, Some((unit.axis, side)));
        }
    }
    least
}

/// The least value of the axes that move, seen along the plane.
fn least_of(axes: &OwnAxes, part: impl Fn(Axis) -> f64, of: fn(&AxisParameters) -> f64) -> f64 {
    let values = axes.iter().filter(|unit| part(unit.axis) != 0.0);
    let values = values.map(|unit| of(&unit.parameters) / part(unit.axis).abs());
    values.fold(f64::INFINITY, f64::min)
}

/// On in a direction, as far as the software limits let it.
fn towards(at: f64, left: f64, direction: Direction, feed: f64) -> Aim {
    if left.is_infinite() {
        Aim::Feed(direction.sign() * feed)
    } else if left < AT_LIMIT_MM {
        Aim::Feed(0.0)
    } else {
        Aim::Position(at + direction.sign() * left)
    }
}

fn is_at_limit(unit: &AxisUnit, direction: Direction) -> bool {
    let [low, high] = unit.limits;
    match direction {
        Direction::Plus => unit.nominal > high - AT_LIMIT_MM,
        Direction::Minus => unit.nominal < low + AT_LIMIT_MM,
    }
}

/// What is reported of the limit at which an axis of the machine stands.
fn show_limit(limit: Option<(Axis, Direction)>, axes: &mut OwnAxes, report: &mut dyn FnMut(AtLimit)) {
    let Some((axis, direction)) = limit else { return };
    for unit in axes.iter_mut().filter(|unit| unit.axis == axis) {
        if is_at_limit(unit, direction) {
            unit.at_limit = Some(direction);
            report(AtLimit::Reached(unit.id, direction));
        }
    }
}

/// They go when the axis leaves it.
fn hide_limits(axes: &mut OwnAxes, report: &mut dyn FnMut(AtLimit)) {
    for unit in axes.iter_mut().filter(|unit| MAIN.contains(&unit.axis)) {
        if let Some(direction) = unit.at_limit.filter(|at| !is_at_limit(unit, *at)) {
            unit.at_limit = None;
            report(AtLimit::Left(unit.id, direction));
        }
    }
}
