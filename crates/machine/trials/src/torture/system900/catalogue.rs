//! What can happen to a System 900 and its machine: what the operator and the PLC write, and what the plant has.

use bahn_host::{AnyPlant, Event, Machine900, Operable};
use bahn_system900::{ChannelParameter, Memory};

use crate::torture::catalogue::{Catalogue, Kind, Mishap};

/// Raw values of an override; cleared is 100 % [002:6414-6426].
const OVERRIDES: [u8; 4] = [0, 40, 130, 255];
/// Devices, and what else of a described plant can fail.
const FAILURES: [&str; 4] = ["jammed", "no-feedback", "permanent", "slow"];

/// What can happen to a machine.
pub(super) fn catalogue(machine: &Machine900) -> Catalogue {
    let mut found = Finder {
        memory: machine.parameters.memory(),
        plant: machine.plant(machine.parameters.memory()),
        mishaps: Vec::new(),
        repairs: vec!["repair all".to_owned()],
    };
    for channel in 1..=found.memory.channels() {
        found.channel(channel);
    }
    found.machine();
    found.axes();
    Catalogue::of(&found.mishaps, found.repairs)
}

struct Finder<'a> {
    memory: &'a Memory,
    plant: AnyPlant,
    mishaps: Vec<Mishap>,
    repairs: Vec<String>,
}

impl Finder<'_> {
    fn put(&mut self, kind: Kind, what: String, undone_by: Option<String>) {
        self.mishaps.push(Mishap {
            kind,
            what,
            undone_by,
        });
    }

    /// What the plant knows.
    fn event(&mut self, kind: Kind, what: String, undone_by: Option<&str>) {
        let known = Event::parse(&what).is_ok_and(|event| {
            let tried = self.plant.copied();
            tried.is_some_and(|mut plant| plant.operate(&event).is_ok())
        });
        if known {
            self.put(kind, what, undone_by.map(str::to_owned));
        }
    }

    fn name(&self, channel: u8, parameter: ChannelParameter) -> Option<String> {
        let place = self.memory.channel_place(channel, parameter)?;
        Some(self.memory.name_of(place).to_string())
    }

    /// What the operator and the PLC write for a channel.
    fn channel(&mut self, channel: u8) {
        use ChannelParameter as P;
        let of_operator = [
            (P::StartKey, "1", 3),
            (P::StartKey, "2", 3),
            (P::ModeRequest, "1", 1),
            (P::ModeRequest, "2", 1),
            (P::ModeRequest, "4", 1),
            (P::Acknowledge, "1", 2),
            (P::Abort, "1", 1),
            (
                P::Emergency,
                "1",
                usize::from(self.has_emergency_program(channel)),
            ),
        ];
        for (parameter, value, times) in of_operator {
            if let Some(name) = self.name(channel, parameter) {
                for _ in 0..times {
                    self.put(Kind::Use, format!("{name}={value}"), None);
                }
            }
        }
        // Enables that go and come, and an M function that is acknowledged though none waits, or too early.
        let of_plc = [
            (P::LoopsEnabled, "0", Some("1")),
            (P::AxesEnabled, "0", Some("1")),
            (P::SafetyStop, "1", Some("0")),
            (P::BlockRelease, "1", None),
            (P::BlockRelease, "2", None),
            (P::AxisLock, "$3", Some("0")),
        ];
        for (parameter, value, back) in of_plc {
            if let Some(name) = self.name(channel, parameter) {
                let back = back.map(|back| format!("plc {name}={back}"));
                self.repairs.extend(back.clone());
                self.put(Kind::Plc, format!("plc {name}={value}"), back);
            }
        }
    }

    /// Somebody who calls an emergency program that is not named is told so.
    fn has_emergency_program(&self, channel: u8) -> bool {
        let program = self
            .memory
            .of_channel(channel, ChannelParameter::EmergencyProgram);
        program.whole().is_some_and(|number| number > 0)
    }

    /// What belongs to the machine as a whole.
    fn machine(&mut self) {
        for number in 1..=2 {
            let place = self.memory.override_place(number);
            let name = place.map(|place| self.memory.name_of(place).to_string());
            for (name, raw) in name.iter().flat_map(|name| OVERRIDES.map(|raw| (name, raw))) {
                let back = format!("{name}=--");
                self.put(Kind::Use, format!("{name}={raw}"), Some(back));
            }
            self.repairs.extend(name.map(|name| format!("{name}=--")));
        }
        self.event(
            Kind::Emergency,
            "emergency press".to_owned(),
            Some("emergency release"),
        );
        self.event(Kind::Emergency, "voltage off".to_owned(), Some("voltage on"));
        for back in ["emergency release", "voltage on"] {
            let event = Event::parse(back);
            if event.is_ok_and(|event| self.plant.operate(&event).is_ok()) {
                self.repairs.push(back.to_owned());
            }
        }
        for number in 1..=3 {
            for steps in [-400, -20, 20, 400] {
                self.event(Kind::AxisKey, format!("handwheel {number} {steps}"), None);
            }
        }
    }

    /// Drives, encoders and devices fail.
    fn axes(&mut self) {
        for channel in 1..=self.memory.channels() {
            let axes: Vec<u8> = self
                .memory
                .axes_of(channel)
                .map(|(_, physical)| physical)
                .collect();
            for physical in axes {
                let repair = format!("repair {physical}");
                self.event(Kind::Fault, format!("fault drive {physical} dead"), Some(&repair));
            }
        }
        let letters: Vec<char> = self.plant.axis_letters();
        for letter in letters {
            let repair = format!("repair {letter}");
            for signal in ["stuck", "amplitude", "twice"] {
                self.event(
                    Kind::Fault,
                    format!("fault encoder {letter} {signal}"),
                    Some(&repair),
                );
            }
            for drive in ["dead", "runaway", "slow"] {
                self.event(
                    Kind::Fault,
                    format!("fault drive {letter} {drive}"),
                    Some(&repair),
                );
            }
        }
        let devices: Vec<String> = self
            .plant
            .devices()
            .into_iter()
            .map(|device| device.name.to_owned())
            .collect();
        for device in devices {
            let repair = format!("repair {device}");
            for how in FAILURES {
                self.event(Kind::Fault, format!("fault device {device} {how}"), Some(&repair));
            }
        }
    }
}
