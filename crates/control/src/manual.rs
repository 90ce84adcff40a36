//! Manual operation: axis direction keys, jog increment, electronic handwheel.

use bahn_exchange::signal;
use bahn_motion::Aim;
use bahn_parameters::Handwheel;

use crate::axes::{AxisUnit, Mover};
use crate::command::Mode;
use crate::control::Control;
use crate::markers::AXES;
use crate::message::Message;
use crate::panel::Direction;

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
    pub increment_limit: Option<f64>,
    /// Positions that jogging goes to.
    jogging: [Option<f64>; AXES],
    /// Handwheel or jog increment would lead beyond a limit.
    pushed: [Option<Direction>; AXES],
    /// Axis index of the handwheel.
    pub handwheel_axis: usize,
    /// Interpolation factors.
    pub factors: [u8; AXES],
    /// Handwheel count up to which it was followed.
    count: Option<i64>,
    /// Axis index that the handwheel leads, and where to.
    wheel: Option<(usize, f64)>,
    /// Axis key pressed last.
    pub last_key: usize,
    /// M function that was entered and waits for NC start.
    pub m: Option<u16>,
    /// Spindle speed that was entered and waits for NC start, rpm.
    pub s: Option<f64>,
    /// Code number 75 368 shows the offsets.
    pub offsets_shown: bool,
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
            offsets_shown: false,
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

impl Control {
    /// Moves the axes in Manual and Handwheel, and while a run is interrupted with MANUAL OPERATION.
    pub(crate) fn move_manually(&mut self, handwheel_count: i64) {
        if self.stop_given() {
            self.manual.stop();
        }
        let keys = self.keys();
        self.turn_handwheel(handwheel_count);
        for place in 0..self.axes.len() {
            let Some(index) = self.axes.get(place).map(|unit| unit.index) else {
                continue;
            };
            let key = keys.get(index).copied().flatten();
            self.move_by_hand(place, index, key);
        }
    }

    /// The direction keys that count, latched ones included.
    fn keys(&mut self) -> [Option<Direction>; AXES] {
        if self.mode == Mode::Handwheel {
            // The direction keys work in Handwheel, too, unless jogging is on.
            if self.exchange.nc().bit(signal::ENABLE_JOG_INCREMENT) {
                return [None; AXES];
            }
        }
        let mut keys = if self.stop_given() {
            [None; AXES]
        } else {
            self.panel.axis_keys
        };
        for (index, (key, latched)) in keys.iter_mut().zip(&mut self.manual.latched).enumerate() {
            if key.is_some() {
                self.manual.last_key = index;
                if self.panel.memory && self.operation.keys_latched {
                    *latched = *key;
                }
            }
            *key = key.or(*latched);
        }
        keys
    }

    /// Moves one axis by its key, its jog increment or the handwheel.
    fn move_by_hand(&mut self, place: usize, index: usize, key: Option<Direction>) {
        let time = self.cycle_s();
        let feed_percent = self.feed_override.percent();
        let rapid_percent = if self.operation.overrides.on_manual_rapid {
            feed_percent.min(100.0)
        } else {
            100.0
        };
        let rapid = self.panel.rapid;
        let rapid_limit = self.rapid_limit_mm_min();
        let stop = self.stop_given();
        let jog = self.jog_target(place, index);
        let wheel = self.manual.wheel.filter(|(axis, _)| *axis == index);
        let wheel = wheel.map(|(_, target)| target);
        let Some(unit) = self.axes.get_mut(place) else {
            return;
        };
        if !matches!(unit.mover, Mover::None | Mover::Manual) || !unit.is_free() {
            return;
        }
        if !(unit.servo.closed() && unit.enabled) {
            if !stop && (key.is_some() || jog.is_some() || wheel.is_some()) {
                unit.ask_to_unclamp();
            }
            if unit.mover == Mover::Manual && unit.stands() {
                unit.mover = Mover::None;
            }
            return;
        }
        let motion = unit.parameters.motion;
        let (aim, feed) = match (key, jog.or(wheel)) {
            _ if stop => (Aim::Feed(0.0), motion.rapid_mm_min),
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
        unit.drive(time, aim, feed.min(rapid_limit));
        if unit.stands() && unit.mover == Mover::Manual && key.is_none() {
            unit.mover = Mover::None;
        }
        let pushed = self.manual.pushed.get(index).copied().flatten();
        self.note_limit(place, key.or(pushed));
    }

    /// Message and marker at a software limit switch; they go when the axis leaves it (inferred).
    fn note_limit(&mut self, place: usize, wanted: Option<Direction>) {
        let Some(unit) = self.axes.get_mut(place) else {
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
        let index = unit.index;
        if reached.is_some() {
            unit.at_limit = reached;
            if let Some(pushed) = self.manual.pushed.get_mut(index) {
                *pushed = None;
            }
        } else if left.is_some() {
            unit.at_limit = None;
        }
        if let Some(direction) = reached {
            self.show(Message::limit(index, direction), false);
        } else if let Some(direction) = left {
            self.messages.remove(&Message::limit(index, direction));
        }
    }

    /// Where the jog increment leads the axis to.
    fn jog_target(&mut self, place: usize, index: usize) -> Option<f64> {
        let started = self
            .panel
            .jog_started
            .get(index)
            .copied()
            .flatten()
            .filter(|_| self.mode == Mode::Handwheel);
        let increment = match self.manual.increment_limit {
            Some(limit) => self.manual.increment.min(limit),
            None => self.manual.increment,
        };
        let unit = self.axes.get(place)?;
        let (nominal, stands) = (unit.nominal, unit.stands());
        let target = self.manual.jogging.get_mut(index)?;
        if let Some(direction) = started
            && stands
        {
            let (within, pushed) = within(unit, nominal + direction.sign() * increment);
            *target = Some(within);
            if let Some(slot) = self.manual.pushed.get_mut(index) {
                *slot = pushed;
            }
            if let Some(started) = self.panel.jog_started.get_mut(index) {
                *started = None;
            }
        } else if *target == Some(nominal) && stands {
            *target = None;
        }
        *target
    }

    /// Follows the handwheel: its steps move the target of its axis.
    fn turn_handwheel(&mut self, count: i64) {
        let before = self.manual.count.replace(count).unwrap_or(count);
        let index = self.manual.handwheel_axis;
        if self.manual.wheel.is_some_and(|(axis, _)| axis != index) {
            self.manual.wheel = None;
        }
        let slowest = self
            .axes
            .iter()
            .map(|unit| unit.parameters.motion.rapid_mm_min)
            .fold(f64::INFINITY, f64::min);
        let unit = self
            .places
            .get(index)
            .copied()
            .flatten()
            .and_then(|place| self.axes.get(place));
        let there = self.mode == Mode::Handwheel && self.operation.handwheel.kind != Handwheel::None;
        // What is turned while the feed is not enabled moves nothing later.
        let Some(unit) = unit.filter(|unit| there && unit.enabled) else {
            self.manual.wheel = None;
            return;
        };
        let steps = count.wrapping_sub(before);
        let few = steps.unsigned_abs() < u64::from(self.operation.handwheel.threshold);
        if few || self.exchange.nc().bit(signal::SUPPRESS_HANDWHEEL) {
            if steps != 0 && few {
                // A vibration: its steps are counted together with those that follow.
                self.manual.count = Some(before);
            }
        } else if steps != 0 {
            let least = factor_min(slowest);
            let factor = self
                .manual
                .factors
                .get(index)
                .copied()
                .unwrap_or(FACTOR_MAX)
                .max(least)
                .max(self.operation.handwheel.factor_min.first().copied().unwrap_or(0));
            let travel = TRAVEL_MM / f64::from(1u32 << factor.min(FACTOR_MAX));
            let sign = if self.operation.handwheel.positive {
                1.0
            } else {
                -1.0
            };
            let from = self.manual.wheel.map_or(unit.nominal, |(_, target)| target);
            let target = from + sign * steps as f64 / HANDWHEEL_STEPS * travel;
            let (target, pushed) = within(unit, target);
            self.manual.wheel = Some((index, target));
            if let Some(slot) = self.manual.pushed.get_mut(index) {
                *slot = pushed;
            }
        }
        if self.manual.wheel == Some((index, unit.nominal)) && unit.stands() {
            self.manual.wheel = None;
        }
    }

    /// The feed override as it acts on programs: MP7620 bit 0 = 0 takes it away while the rapid traverse key
    /// is pressed [000:10512] [001:3262] [003:7434-7443].
    pub(crate) fn program_override_percent(&self) -> f64 {
        if self.panel.rapid && !self.operation.overrides.on_rapid_key {
            100.0
        } else {
            self.feed_override.percent()
        }
    }

    /// D596: rapid traverse as the PLC limits it, mm/min [000:4812-4814].
    pub(crate) fn rapid_limit_mm_min(&self) -> f64 {
        let nc = self.exchange.nc();
        let by_plc = f64::from(nc.number(signal::RAPID_TRAVERSE_LIMIT).max(0));
        // With a probe in the spindle MP6150 limits it, too [000:7654].
        if nc.bit(signal::NC_STOP_ON_STYLUS_DEFLECTION) {
            by_plc.min(self.link.list().probe().rapid_mm_min)
        } else {
            by_plc
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
