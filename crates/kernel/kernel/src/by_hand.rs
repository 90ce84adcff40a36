//! Single axes by hand: keys, increments and wheels lead them, as far as their software limits.

use bahn_motion::Aim;
use bahn_path::Direction;

use crate::axis::{AxisId, AxisUnit, Mover};
use crate::now::Now;

/// What is wanted of an axis in a cycle.
#[derive(Clone, Copy, Debug, Default)]
pub struct HandMove {
    /// A direction key that counts, with its feed, mm/min.
    pub key: Option<(Direction, f64)>,
    /// Where a jog increment leads it, with the feed of direction keys.
    pub jog: Option<f64>,
    /// Where a wheel leads it, with rapid traverse.
    pub wheel: Option<f64>,
    /// What a direction key puts out in place of a movement: a step of speed, mm/min.
    pub step_mm_min: Option<f64>,
}

/// An axis comes to its software limit, or leaves it.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum AtLimit {
    /// It stands at it.
    Reached(AxisId, Direction),
    /// It stands there no more.
    Left(AxisId, Direction),
}

/// Moves an axis for a cycle. Whether it moves as it is wanted: not without loop or feed enable, nor where something else
/// moves it.
pub fn move_by_hand(unit: &mut AxisUnit, wanted: &HandMove, now: &Now) -> bool {
    if !matches!(unit.mover, Mover::None | Mover::Manual) || !unit.is_free() {
        return false;
    }
    let target = wanted.jog.or(wanted.wheel);
    if !unit.can_be_driven() {
        if !now.stop && (wanted.key.is_some() || target.is_some()) {
            unit.ask_to_unclamp();
        }
        if unit.mover == Mover::Manual && unit.stands() {
            unit.mover = Mover::None;
        }
        return false;
    }
    let step = wanted.step_mm_min.filter(|_| !now.stop);
    if let (Some(feed), Some((direction, _))) = (step, wanted.key)
        && along(unit, direction, feed) != Aim::Feed(0.0)
        && unit.step(direction.sign() * feed)
    {
        unit.mover = Mover::Manual;
        return false;
    }
    unit.end_step();
    let motion = unit.parameters.motion;
    let (aim, feed) = match (wanted.key, target) {
        _ if now.stop => (Aim::Feed(0.0), motion.rapid_mm_min),
        (Some((direction, feed)), _) => (along(unit, direction, feed), feed),
        (None, Some(target)) => {
            let feed = if wanted.jog.is_some() {
                motion.manual_mm_min * now.feed_percent / 100.0
            } else {
                motion.rapid_mm_min
            };
            (Aim::Position(target), feed)
        }
        (None, None) => (Aim::Feed(0.0), motion.rapid_mm_min),
    };
    if aim != Aim::Feed(0.0) || !unit.stands() {
        unit.mover = Mover::Manual;
    }
    unit.drive(now.time_s, aim, feed.min(now.rapid_limit_mm_min));
    if unit.stands() && unit.mover == Mover::Manual && wanted.key.is_none() {
        unit.mover = Mover::None;
    }
    true
}

/// Whether an axis that is `wanted` in a direction stands at its software limit, or has left it (inferred).
pub fn look_at_limit(unit: &mut AxisUnit, wanted: Option<Direction>) -> Option<AtLimit> {
    let reached = unit.limited().and_then(|[least, greatest]| match wanted {
        Some(Direction::Plus) if unit.nominal >= greatest => Some(Direction::Plus),
        Some(Direction::Minus) if unit.nominal <= least => Some(Direction::Minus),
        _ => None,
    });
    if let Some(direction) = reached {
        unit.at_limit = reached;
        return Some(AtLimit::Reached(unit.id, direction));
    }
    let left = unit.at_limit.filter(|at| {
        unit.limits
            .get(usize::from(*at == Direction::Plus))
            .is_none_or(|limit| unit.nominal != *limit)
    })?;
    unit.at_limit = None;
    Some(AtLimit::Left(unit.id, left))
}

/// On in a direction, up to the software limit.
fn along(unit: &AxisUnit, direction: Direction, feed: f64) -> Aim {
    let Some([least, greatest]) = unit.limited() else {
        return Aim::Feed(direction.sign() * feed);
    };
    let (limit, beyond) = match direction {
        Direction::Plus => (greatest, unit.nominal >= greatest),
        Direction::Minus => (least, unit.nominal <= least),
    };
    match limit.is_finite() {
        _ if beyond => Aim::Feed(0.0),
        true => Aim::Position(limit),
        // There is no limit on this side.
        false => Aim::Feed(direction.sign() * feed),
    }
}

/// A target inside the software limits, from outside only towards them; and the limit beyond which it was.
pub fn within(unit: &AxisUnit, target: f64) -> (f64, Option<Direction>) {
    let Some([least, greatest]) = unit.limited() else {
        return (target, None);
    };
    let (least, greatest) = (least.min(unit.nominal), greatest.max(unit.nominal));
    if target > greatest {
        (greatest, Some(Direction::Plus))
    } else if target < least {
        (least, Some(Direction::Minus))
    } else {
        (target, None)
    }
}
