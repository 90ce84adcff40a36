//! What the family knows of an axis beside the kernel.

use bahn_kernel::{AxisUnit, LagRule, LagWatch};
use bahn_path::Direction;
use bahn_system900::{AxisBlock, AxisParameter, Connection};

/// Numbers of the messages [002:7044-7127] [002:6893-6903].
const LAG: u32 = 2001;
const VOLTAGE: u32 = 2002;
const BARRED: u32 = 2020;
const STANDSTILL: u32 = 2022;
/// An axis as the family knows it beside the kernel.
#[derive(Clone, Copy, Debug)]
pub(crate) struct AxisPlace {
    /// Its physical number, from 1 on.
    pub physical: u8,
    /// Its channel, from 0 on, and its logical number there, from 1 on; 0 when no channel names it.
    pub channel: u8,
    pub logical: u8,
    /// Its settings.
    pub block: AxisBlock,
}

/// What says that a position is reached.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) struct Report {
    pub parameter: AxisParameter,
    /// It is the one so many after it.
    pub after: u32,
    /// Its bits.
    pub bits: i32,
}

impl Report {
    /// P12191, P12192.
    pub fn reached(after: u32) -> Report {
        Report {
            parameter: AxisParameter::Reached,
            after,
            bits: 1,
        }
    }
}

/// Where a position of the PLC or a step leads.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Goal {
    /// Machine coordinate, mm or degrees.
    pub position: f64,
    /// mm/min.
    pub feed_mm_min: f64,
    /// What says that it is reached: a parameter, the number of one after it, and its bits; nothing for a step by hand.
    pub reports: Option<Report>,
}

/// What leads an axis beside all paths.
#[derive(Clone, Copy, Debug, Default)]
pub(crate) struct Hand {
    pub goal: Option<Goal>,
    /// A direction key, with its feed, mm/min.
    pub key: Option<(Direction, f64)>,
    /// The axis seeks its reference point in a direction.
    pub seeks: Option<Direction>,
    /// The zero pulse counts.
    pub released: bool,
    /// Count of its handwheel in the last cycle, and where the wheel leads.
    pub wheel: Option<(u8, i64, f64)>,
    /// It turns as a spindle.
    pub turns: bool,
    /// It does so as P12134 says.
    pub turns_by_plc: bool,
}

/// What watches an axis.
#[derive(Clone, Copy, Debug, Default)]
pub(crate) struct Watch {
    lag: LagWatch,
    /// The nominal position stands, the axis is not within its exact stop, since so long, s.
    restless_s: f64,
    /// It is too far from its master since so long, s.
    pub apart_s: f64,
}

impl Watch {
    /// The number of the message that an axis deserves.
    pub fn axis(
        &mut self,
        place: &AxisPlace,
        unit: &mut AxisUnit,
        time_s: f64,
        monitored: bool,
    ) -> Option<u32> {
        let block = &place.block;
        if !unit.servo.closed() || !unit.enabled {
            *self = Watch::default();
            return None;
        }
        if block.connection == Connection::Barred && !unit.stands() {
            return Some(BARRED);
        }
        let lag_mm = unit.servo.lag_mm();
        let [least_mm, _] = block.exact_stop_mm;
        if let Some(limit_s) = block.lag_s {
            let rule = LagRule {
                gain_s: block.gain_s,
                feed_forward: block.feed_forward,
                part: block.lag_part,
                least_mm,
                time_s: limit_s,
            };
            if self
                .lag
                .passes(&rule, unit.servo.profile_mm_min() / 60.0, lag_mm, time_s)
            {
                return Some(LAG);
            }
        }
        let restless = unit.stands() && lag_mm.abs() > least_mm;
        self.restless_s = if restless { self.restless_s + time_s } else { 0.0 };
        if self.restless_s > block.standstill_s {
            return Some(STANDSTILL);
        }
        let limit = block.volts_limit.filter(|_| monitored);
        limit.filter(|limit| unit.servo.volts().abs() >= *limit).map(|_| {
            unit.servo.open();
            VOLTAGE
        })
    }
}
