//! Where everything of a machine stands: what mechanics keep without power.
//!
//! Speeds, voltages and relays are gone when the power is: a machine that is put where another one stood begins at rest. Faults
//! and what the operator holds (keys, potentiometers, EMERGENCY STOP) are no places, and begin anew (inferred).

use serde::{Deserialize, Serialize};

use crate::axis::Axis;
use crate::device::Device;
use crate::machine::Machine;

/// Where everything of a machine stands; parts are in the order of the description.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Mechanics {
    /// The feed axes.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub axis: Vec<AxisPlace>,
    /// The spindles.
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
    /// Its letter.
    pub letter: char,
    /// The table.
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
    /// Its name.
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

impl Machine {
    /// Where everything stands now.
    pub fn mechanics(&self) -> Mechanics {
        Mechanics {
            axis: self.axes.iter().map(Axis::place).collect(),
            spindle: self.spindles.iter().map(|spindle| spindle.place()).collect(),
            device: self.devices.iter().map(Device::place).collect(),
            magazine: self.magazine.as_ref().map(|magazine| magazine.place()),
            by_hand: self.by_hand.place(),
            probe_deg: self
                .probe
                .as_ref()
                .and_then(|probe| probe.turned_deg(self.spindle_deg())),
        }
    }

    /// Puts everything where it stood, at rest: the machine at power-on. What does not fit leaves all as it was.
    ///
    /// # Errors
    /// In words, what this machine does not have, or cannot be.
    pub fn stand_at(&mut self, mechanics: &Mechanics) -> Result<(), String> {
        self.fits(mechanics)?;
        self.rests = false;
        for (axis, place) in self.axes.iter_mut().zip(&mechanics.axis) {
            axis.stand_at(place);
        }
        for (spindle, place) in self.spindles.iter_mut().zip(&mechanics.spindle) {
            spindle.stand_at(place);
        }
        for (device, place) in self.devices.iter_mut().zip(&mechanics.device) {
            device.stand_at(place);
        }
        if let (Some(magazine), Some(place)) = (&mut self.magazine, &mechanics.magazine) {
            magazine.stand_at(place, &self.devices);
        }
        self.by_hand.stand_at(mechanics.by_hand);
        let angle = self.spindle_deg();
        if let Some(probe) = &mut self.probe {
            probe.insert(
                mechanics.probe_deg.is_some(),
                angle - mechanics.probe_deg.unwrap_or_default(),
            );
        }
        Ok(())
    }

    /// Whether these are places of this machine.
    fn fits(&self, mechanics: &Mechanics) -> Result<(), String> {
        let names = |places: Vec<String>, own: Vec<String>, what: &str| match places == own {
            true => Ok(()),
            false => Err(format!(
                "it has the {what} {}, the machine has {}",
                list(&places),
                list(&own)
            )),
        };
        names(
            mechanics
                .axis
                .iter()
                .map(|axis| axis.letter.to_string())
                .collect(),
            self.axes.iter().map(|axis| axis.letter.to_string()).collect(),
            "axes",
        )?;
        names(
            mechanics
                .device
                .iter()
                .map(|device| device.name.clone())
                .collect(),
            self.devices.iter().map(|device| device.name.clone()).collect(),
            "things",
        )?;
        if mechanics.spindle.len() != self.spindles.len() {
            return Err(format!(
                "it has {} spindles, the machine has {}",
                mechanics.spindle.len(),
                self.spindles.len()
            ));
        }
        let count = |pockets: Option<usize>| pockets.map_or("none".to_owned(), |count| count.to_string());
        let own = self.magazine.as_ref().map(|magazine| magazine.count());
        let places = mechanics.magazine.as_ref().map(|magazine| magazine.pockets.len());
        if own != places {
            return Err(format!(
                "it has a magazine of {} pockets, the machine one of {}",
                count(places),
                count(own)
            ));
        }
        let axes = self.axes.iter().zip(&mechanics.axis);
        let axes = axes.map(|(axis, place)| axis.has(place));
        let spindles = self.spindles.iter().zip(&mechanics.spindle);
        let spindles = spindles.map(|(spindle, place)| spindle.has(place));
        let devices = mechanics.device.iter().map(|device| {
            let there = (0.0..=1.0).contains(&device.position);
            there
                .then_some(())
                .ok_or_else(|| format!("{} stands at {}", device.name, device.position))
        });
        let chain = mechanics.magazine.iter().map(|magazine| {
            let there = (0.0..magazine.pockets.len() as f64).contains(&magazine.position);
            there
                .then_some(())
                .ok_or_else(|| format!("the chain stands at {}", magazine.position))
        });
        axes.chain(spindles).chain(devices).chain(chain).collect()
    }
}

fn list(names: &[String]) -> String {
    match names {
        [] => "none".to_owned(),
        names => names.join(" "),
    }
}
