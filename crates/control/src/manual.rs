//! Manual operation: axis direction keys, jog increment, electronic handwheel.

use bahn_exchange::{Image, signal};
use bahn_motion::Aim;
use bahn_parameters::ControlModel;
use bahn_parameters::operation::{Handwheel, OperationParameters};
use bahn_parameters::technology::Technology;
use bahn_path::BlockRef;
use bahn_plc::JogLimit;

use crate::axes::OwnAxes;
use crate::axis::{AxisUnit, Mover};
use crate::command::Mode;
use crate::markers::AXES;
use crate::message::{Message, Messages};
use crate::now::Now;
use crate::panel::{Direction, Panel};
use crate::plc_link::StatusChanges;
use crate::site::Site;

/// Counting steps of a turn of the handwheel (inferred).
pub const HANDWHEEL_STEPS: f64 = 1000.0;
/// Travel of a turn with interpolation factor 0, mm [000:8071-8094].
const TRAVEL_MM: f64 = 20.0;
/// Highest interpolation factor.
const FACTOR_MAX: u8 = 10;

/// What manual operation remembers.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Manual {
    /// Direction keys that were latched (M2450 with MP7680 bit 0): they count until NC stop [000:7545-7552].
    latched: [Option<Direction>; AXES],
    /// Jog increment, mm.
    pub increment: f64,
    /// Limit of the jog increment by module 9036, mm.
    increment_limit: Option<f64>,
    /// Positions that jogging goes to.
    jogging: [Option<f64>; AXES],
    /// Handwheel or jog increment would lead beyond a limit.
    pushed: [Option<Direction>; AXES],
    /// Axis index of the handwheel.
    handwheel_axis: usize,
    /// Interpolation factors.
    factors: [u8; AXES],
    /// Handwheel count up to which it was followed.
    count: Option<i64>,
    /// Axis index that the handwheel leads, and where to.
    wheel: Option<(usize, f64)>,
    /// Axis key pressed last.
    last_key: usize,
    /// M function that was entered and waits for NC start.
    m: Option<u16>,
    /// Spindle speed that was entered and waits for NC start, rpm.
    s: Option<f64>,
}

impl Default for Manual {
    fn default() -> Manual {
        Manual {
            latched: [None; AXES],
            increment: 0.0,
            increment_limit: None,
            jogging: [None; AXES],
            pushed: [None; AXES],
            handwheel_axis: 0,
            factors: [5; AXES],
            count: None,
            wheel: None,
            last_key: 0,
            m: None,
            s: None,
        }
    }
}

impl Manual {
    /// Counts the handwheel without following it.
    pub fn forget_turns(&mut self, count: i64) {
        self.count = Some(count);
    }

    /// Lets go of everything.
    pub fn stop(&mut self) {
        self.latched = [None; AXES];
        self.jogging = [None; AXES];
        self.pushed = [None; AXES];
        self.wheel = None;
    }

    /// Axis index of the handwheel.
    pub fn handwheel_axis(&self) -> usize {
        self.handwheel_axis
    }

    /// Interpolation factors of the handwheel, by axis index.
    pub fn factors(&self) -> [u8; AXES] {
        self.factors
    }

    /// Index of the axis key that was pressed last.
    pub fn last_key(&self) -> usize {
        self.last_key
    }

    /// The handwheel moves an axis with an interpolation factor.
    pub fn choose_handwheel(&mut self, index: usize, factor: u8) {
        self.handwheel_axis = index;
        if let Some(slot) = self.factors.get_mut(index) {
            *slot = factor;
        }
    }

    /// M and S in Manual and Handwheel: entered here, output with NC start [003:1103-1111].
    pub fn enter(&mut self, m: Option<u16>, s: Option<f64>) {
        self.m = m.or(self.m);
        self.s = s.or(self.s);
    }

    /// NC start in Manual and Handwheel: outputs what was entered.
    pub fn output_entered(&mut self, model: ControlModel, site: &mut Site) {
        if !site.handshakes.is_idle() {
            return;
        }
        if let Some(rpm) = self.s.take() {
            site.speed(rpm, false);
        }
        if let Some(m) = self.m.take()
            && let Some(technology) = Technology::of_m(model, m)
        {
            site.m_by_hand(technology, m);
        }
    }

    /// Module 9036.
    pub fn take_status(&mut self, changes: StatusChanges) {
        for (factor, changed) in self.factors.iter_mut().zip(changes.factors) {
            *factor = changed.unwrap_or(*factor);
        }
        if let Some(axis) = changes.handwheel_axis {
            self.handwheel_axis = axis;
        }
        match changes.jog_limit {
            None => {}
            Some(JogLimit::At(limit)) => self.increment_limit = Some(limit),
            Some(JogLimit::LastIncrement) => self.increment_limit = None,
            Some(JogLimit::SmallerOfLastIncrementAndLimit) => {
                if let Some(limit) = self.increment_limit.take() {
                    self.increment = self.increment.min(limit);
                }
            }
        }
    }
}

/// Least interpolation factor that the rapid traverse of the slowest axis allows [000:8075-8092].
pub(crate) fn factor_min(rapid_mm_min: f64) -> u8 {
    // Rapid traverse from which on factors 0 to 4 are possible.
    const FROM: [f64; 5] = [12_000.0, 6_000.0, 3_000.0, 1_500.0, 750.0];
    let factor = FROM
        .iter()
        .position(|from| rapid_mm_min >= *from)
        .unwrap_or(FROM.len());
    u8::try_from(factor).unwrap_or(FACTOR_MAX)
}

/// What the operator's hands reach.
pub(crate) struct Reach<'a, 'b> {
    pub axes: &'a mut OwnAxes<'b>,
    pub panel: &'a mut Panel,
    pub rules: &'a OperationParameters,
    pub nc: &'a Image,
    pub messages: &'a mut Messages,
    /// The block whose run is interrupted.
    pub block: Option<BlockRef>,
}

impl Manual {
    /// Moves the axes in Manual and Handwheel, and while a run is interrupted with MANUAL OPERATION.
    pub fn moves(&mut self, handwheel_count: i64, reach: &mut Reach, now: &Now) {
        if now.stop {
            self.stop();
        }
        let keys = self.keys(reach, now);
        self.turn_handwheel(handwheel_count, reach, now);
        for place in reach.axes.places() {
            let Some(index) = reach.axes.get(place).map(|unit| unit.index) else {
                continue;
            };
            let key = keys.get(index).copied().flatten();
            self.move_by_hand(place, index, key, reach, now);
        }
    }

    /// The direction keys that count, latched ones included.
    fn keys(&mut self, reach: &Reach, now: &Now) -> [Option<Direction>; AXES] {
        if now.mode == Mode::Handwheel {
            // The direction keys work in Handwheel, too, unless jogging is on.
            if reach.nc.bit(signal::ENABLE_JOG_INCREMENT) {
                return [None; AXES];
            }
        }
        let mut keys = if now.stop {
            [None; AXES]
        } else {
            reach.panel.axis_keys
        };
        for (index, (key, latched)) in keys.iter_mut().zip(&mut self.latched).enumerate() {
            if key.is_some() {
                self.last_key = index;
                if reach.panel.memory && reach.rules.keys_latched {
                    *latched = *key;
                }
            }
            *key = key.or(*latched);
        }
        keys
    }

    /// Moves one axis by its key, its jog increment or the handwheel.
    fn move_by_hand(
        &mut self,
        place: usize,
        index: usize,
        key: Option<Direction>,
        reach: &mut Reach,
        now: &Now,
    ) {
        let feed_percent = now.feed_percent;
        let rapid_percent = if reach.rules.overrides.on_manual_rapid {
            feed_percent.min(100.0)
        } else {
            100.0
        };
        let rapid = reach.panel.rapid;
        let jog = self.jog_target(place, index, reach, now);
        let wheel = self.wheel.filter(|(axis, _)| *axis == index);
        let wheel = wheel.map(|(_, target)| target);
        let Some(unit) = reach.axes.get_mut(place) else {
            return;
        };
        if !matches!(unit.mover, Mover::None | Mover::Manual) || !unit.is_free() {
            return;
        }
        if !(unit.servo.closed() && unit.enabled) {
            if !now.stop && (key.is_some() || jog.is_some() || wheel.is_some()) {
                unit.ask_to_unclamp();
            }
            if unit.mover == Mover::Manual && unit.stands() {
                unit.mover = Mover::None;
            }
            return;
        }
        let motion = unit.parameters.motion;
        let (aim, feed) = match (key, jog.or(wheel)) {
            _ if now.stop => (Aim::Feed(0.0), motion.rapid_mm_min),
            (Some(direction), _) => {
                let feed = if rapid {
                    motion.rapid_mm_min * rapid_percent / 100.0
                } else {
                    motion.manual_mm_min * feed_percent / 100.0
                };
                (along(unit, direction, feed), feed)
            }
            (None, Some(target)) => {
                let feed = if jog.is_some() {
                    motion.manual_mm_min * feed_percent / 100.0
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
        if unit.stands() && unit.mover == Mover::Manual && key.is_none() {
            unit.mover = Mover::None;
        }
        let pushed = self.pushed.get(index).copied().flatten();
        self.note_limit(place, key.or(pushed), reach);
    }

    /// Message and marker at a software limit switch; they go when the axis leaves it (inferred).
    fn note_limit(&mut self, place: usize, wanted: Option<Direction>, reach: &mut Reach) {
        let Some(unit) = reach.axes.get_mut(place) else {
            return;
        };
        let reached = unit.limited().and_then(|[least, greatest]| match wanted {
            Some(Direction::Plus) if unit.nominal >= greatest => Some(Direction::Plus),
            Some(Direction::Minus) if unit.nominal <= least => Some(Direction::Minus),
            _ => None,
        });
        let left = unit.at_limit.filter(|at| {
            unit.limits
                .get(usize::from(*at == Direction::Plus))
                .is_none_or(|limit| unit.nominal != *limit)
        });
        let (index, id) = (unit.index, unit.id);
        if reached.is_some() {
            unit.at_limit = reached;
            if let Some(pushed) = self.pushed.get_mut(index) {
                *pushed = None;
            }
        } else if left.is_some() {
            unit.at_limit = None;
        }
        if let Some(direction) = reached {
            reach.messages.show(Message::limit(id, direction), reach.block);
        } else if let Some(direction) = left {
            reach.messages.remove(&Message::limit(id, direction));
        }
    }

    /// Where the jog increment leads the axis to.
    fn jog_target(&mut self, place: usize, index: usize, reach: &mut Reach, now: &Now) -> Option<f64> {
        let started = reach
            .panel
            .jog_started
            .get(index)
            .copied()
            .flatten()
            .filter(|_| now.mode == Mode::Handwheel);
        let increment = match self.increment_limit {
            Some(limit) => self.increment.min(limit),
            None => self.increment,
        };
        let unit = reach.axes.get(place)?;
        let (nominal, stands) = (unit.nominal, unit.stands());
        let target = self.jogging.get_mut(index)?;
        if let Some(direction) = started
            && stands
        {
            let (within, pushed) = within(unit, nominal + direction.sign() * increment);
            *target = Some(within);
            if let Some(slot) = self.pushed.get_mut(index) {
                *slot = pushed;
            }
            if let Some(started) = reach.panel.jog_started.get_mut(index) {
                *started = None;
            }
        } else if *target == Some(nominal) && stands {
            *target = None;
        }
        *target
    }

    /// Follows the handwheel: its steps move the target of its axis.
    fn turn_handwheel(&mut self, count: i64, reach: &Reach, now: &Now) {
        let before = self.count.replace(count).unwrap_or(count);
        let index = self.handwheel_axis;
        if self.wheel.is_some_and(|(axis, _)| axis != index) {
            self.wheel = None;
        }
        let slowest = reach
            .axes
            .iter()
            .map(|unit| unit.parameters.motion.rapid_mm_min)
            .fold(f64::INFINITY, f64::min);
        let unit = reach.axes.with_index(index);
        let there = now.mode == Mode::Handwheel && reach.rules.handwheel.kind != Handwheel::None;
        // What is turned while the feed is not enabled moves nothing later.
        let Some(unit) = unit.filter(|unit| there && unit.enabled) else {
            self.wheel = None;
            return;
        };
        let steps = count.wrapping_sub(before);
        let few = steps.unsigned_abs() < u64::from(reach.rules.handwheel.threshold);
        if few || reach.nc.bit(signal::SUPPRESS_HANDWHEEL) {
            if steps != 0 && few {
                // A vibration: its steps are counted together with those that follow.
                self.count = Some(before);
            }
        } else if steps != 0 {
            let least = factor_min(slowest);
            let factor = self
                .factors
                .get(index)
                .copied()
                .unwrap_or(FACTOR_MAX)
                .max(least)
                .max(reach.rules.handwheel.factor_min.first().copied().unwrap_or(0));
            let travel = TRAVEL_MM / f64::from(1u32 << factor.min(FACTOR_MAX));
            let sign = if reach.rules.handwheel.positive { 1.0 } else { -1.0 };
            let from = self.wheel.map_or(unit.nominal, |(_, target)| target);
            let target = from + sign * steps as f64 / HANDWHEEL_STEPS * travel;
            let (target, pushed) = within(unit, target);
            self.wheel = Some((index, target));
            if let Some(slot) = self.pushed.get_mut(index) {
                *slot = pushed;
            }
        }
        if self.wheel == Some((index, unit.nominal)) && unit.stands() {
            self.wheel = None;
        }
    }
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
    if beyond {
        Aim::Feed(0.0)
    } else {
        Aim::Position(limit)
    }
}

/// A target inside the software limits, from outside only towards them; and the limit beyond which it was.
fn within(unit: &AxisUnit, target: f64) -> (f64, Option<Direction>) {
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

#[cfg(test)]
mod tests {
    use super::*;

    /// The table of the manual: rapid traverse 12 000 allows factor 0, 80 mm/min only 5 to 10
    /// [000:8075-8092].
    #[test]
    fn least_factor_by_rapid_traverse() {
        for (rapid, factor) in [
            (15_000.0, 0),
            (12_000.0, 0),
            (11_999.0, 1),
            (6_000.0, 1),
            (3_000.0, 2),
            (1_500.0, 3),
            (750.0, 4),
            (80.0, 5),
        ] {
            assert_eq!(factor_min(rapid), factor, "{rapid}");
        }
    }
}
