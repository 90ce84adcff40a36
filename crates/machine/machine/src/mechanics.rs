//! Where everything of a machine stands: what mechanics keep without power.
//!
//! Speeds, voltages and relays are gone when the power is: a machine that is put where another one stood begins at rest. Faults
//! and what the operator holds (keys, potentiometers, EMERGENCY STOP) are no places, and begin anew (inferred).
//!
//! Decision: Mechanics that are put up again begin at rest; faults, keys and the EMERGENCY STOP button begin anew.
//! Changed pockets of the tables have put the tools there (also `host/src/power_on.rs`)

use serde::{Deserialize, Serialize};

/// Where everything of a machine stands; parts are in the order of the description.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Mechanics {
    /// Positions of the feed axes.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub axis: Vec<AxisPlace>,
    /// Positions of the spindles.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub spindle: Vec<SpindlePlace>,
    /// Things with two states.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub device: Vec<DevicePlace>,
    /// The tool magazine, if there is one.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub magazine: Option<MagazinePlace>,
    /// The tool that was put into the spindle by hand, and the one that was called last.
    #[serde(default)]
    pub by_hand: [u32; 2],
    /// How far the spindle has turned since the touch probe was put into it, degrees; `None` without it.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub probe_deg: Option<f64>,
}

/// Where a feed axis stands, mm or degrees.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct AxisPlace {
    /// The letter of the axis.
    pub letter: char,
    /// Position of the table, mm or degrees.
    pub table: f64,
    /// The motor, behind the play.
    pub motor: f64,
}

/// Where a spindle stands.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct SpindlePlace {
    /// Its angle, turns from 0 to 1.
    pub turn: f64,
    /// The engaged gear range, from 1; 0 between two.
    pub gear: usize,
}

/// Where a thing with two states is.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct DevicePlace {
    /// The name of the device.
    pub name: String,
    /// 0 is its first state, 1 the second.
    pub position: f64,
    /// It goes, or has gone, to the second one.
    pub forth: bool,
}

/// Where the tools of a magazine are; 0 is none.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct MagazinePlace {
    /// Where the chain stands, pockets.
    pub position: f64,
    /// The tool in each pocket, from pocket 1 on.
    pub pockets: Vec<u32>,
    /// The tool in the shuttle.
    pub shuttle: u32,
    /// The tools in the grippers.
    pub arm: [u32; 2],
    /// The tool in the spindle.
    pub spindle: u32,
    /// The arm, not a hand, has changed the tool in the spindle.
    pub has_changed: bool,
}
