//! What moves: where everything of a machine stands, and how it is put there.

use crate::axis::Axis;
use crate::by_hand::ByHand;
use crate::device::Device;
use crate::magazine::Magazine;
use crate::mechanics::Mechanics;
use crate::probe::Probe;
use crate::spindle::Spindle;

/// What of a machine moves and stands somewhere.
#[derive(Clone, Debug)]
pub(crate) struct Mechanism {
    /// Its axes have numbers beside their letters: those of their outputs.
    pub numbered: bool,
    pub axes: Vec<Axis>,
    /// That of the control, and those of further channels.
    pub spindles: Vec<Spindle>,
    pub devices: Vec<Device>,
    pub magazine: Option<Magazine>,
    pub by_hand: ByHand,
    pub probe: Option<Probe>,
}

impl Mechanism {
    /// Where everything stands now.
    pub fn places(&self) -> Mechanics {
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

    /// Puts everything where it stood, at rest. What does not fit leaves all as it was.
    pub fn stand_at(&mut self, mechanics: &Mechanics) -> Result<(), String> {
        self.fits(mechanics)?;
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

    /// The angle of the first spindle since power-on, degrees.
    pub fn spindle_deg(&self) -> f64 {
        self.spindles
            .first()
            .map_or(0.0, |spindle| spindle.state().angle_deg)
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
