//! What can happen to a TNC and its machine: everything that it has, from its description.

use bahn_host::LoadedMachine;
use bahn_machine::Machine;
use bahn_path::Axis;
use bahn_tnc::HANDWHEEL_STEPS;

use crate::torture::catalogue::{Catalogue, Kind, Mishap};

/// What the handwheel does beside the path of a program that lets it lead these axes so far, mm or degrees (M118): some steps, as
/// far as it may be led, and much farther.
pub(super) fn turns(wheels: impl Iterator<Item = (Axis, f64)>) -> Vec<Mishap> {
    let mut turns = Vec::new();
    for (axis, range) in wheels {
        for ways in [0.1, 1.0, 5.0] {
            // With factor 0 a turn is 20 mm.
            let steps = (range * ways / 20.0 * HANDWHEEL_STEPS).round();
            for (turned, back) in [(steps, -steps), (-steps, steps)] {
                turns.push(Mishap {
                    kind: Kind::Use,
                    what: format!("handwheel {} 0, handwheel {turned:+}", axis.letter()),
                    undone_by: Some(format!("handwheel {back:+}")),
                });
            }
        }
    }
    turns
}

/// What can happen to a machine, simulated.
pub(super) fn catalogue(plant: &Machine, start_keys: &[String]) -> Catalogue {
    let mut found = Finder {
        plant,
        mishaps: Vec::new(),
    };
    for start_key in start_keys {
        found.uses(start_key);
    }
    found.failures();
    let repairs = found.repairs();
    Catalogue::of(&found.mishaps, repairs)
}

/// The key NC start of each channel.
pub(super) fn start_keys(machine: &LoadedMachine) -> Vec<String> {
    let others = machine
        .channels
        .iter()
        .map(|channel| channel.folder.operator.start.clone());
    std::iter::once(machine.folder.operator.start.clone())
        .chain(others)
        .collect()
}

struct Finder<'a> {
    plant: &'a Machine,
    mishaps: Vec<Mishap>,
}

impl Finder<'_> {
    /// Notes what the machine knows.
    fn event(&mut self, kind: Kind, what: &str, undone_by: Option<&str>) {
        if self.plant.clone().apply(what).is_ok() {
            self.command(kind, what, undone_by);
        }
    }

    fn command(&mut self, kind: Kind, what: &str, undone_by: Option<&str>) {
        self.mishaps.push(Mishap {
            kind,
            what: what.to_owned(),
            undone_by: undone_by.map(str::to_owned),
        });
    }

    /// What the operator does, and what goes off.
    fn uses(&mut self, start_key: &str) {
        for percent in [0, 1, 30, 70, 100, 120, 150] {
            self.event(
                Kind::Use,
                &format!("override feed {percent}"),
                Some("override feed 100"),
            );
        }
        for percent in [60, 100, 110] {
            self.event(Kind::Use, &format!("override spindle {percent}"), None);
        }
        for _ in 0..3 {
            self.event(Kind::Use, &format!("key {start_key} tap"), None);
            self.event(Kind::Use, "key NC_STOP tap", None);
        }
        self.event(Kind::Use, "key NC_STOP press", Some("key NC_STOP release"));
        self.event(Kind::Use, "key RAPID press", Some("key RAPID release"));
        for command in [
            "ce",
            "mode manual",
            "mode single",
            "mode full",
            "manual-operation",
            "restore-position",
        ] {
            self.command(Kind::Use, command, None);
        }
        let keys: Vec<String> = self.plant.keys().map(str::to_owned).collect();
        for key in keys.iter().filter(|key| key.ends_with(['+', '-'])) {
            let release = format!("key {key} release");
            self.event(Kind::AxisKey, &format!("key {key} press"), Some(&release));
        }
        self.event(Kind::Emergency, "emergency press", Some("emergency release"));
        self.event(Kind::Emergency, "voltage off", Some("voltage on"));
        self.command(Kind::Power, "power off", Some("power on"));
        for (thing, away, back) in [("door", "open", "closed"), ("lubricant", "low", "full")] {
            let back = format!("switch {thing} {back}");
            self.event(Kind::Thing, &format!("switch {thing} {away}"), Some(&back));
        }
    }

    /// Faults of encoders, drives, motors and devices, each with its repair.
    fn failures(&mut self) {
        let mut axes: Vec<char> = self.plant.axes().map(|axis| axis.letter).collect();
        axes.push('S');
        for axis in axes {
            let repair = format!("repair {axis}");
            for signal in ["amplitude", "edges", "stuck", "marks", "no-marks", "twice"] {
                self.event(
                    Kind::Fault,
                    &format!("fault encoder {axis} {signal}"),
                    Some(&repair),
                );
            }
            for drive in ["dead", "runaway", "reversed", "slow"] {
                self.event(Kind::Fault, &format!("fault drive {axis} {drive}"), Some(&repair));
            }
            self.event(Kind::Fault, &format!("fault motor {axis}"), Some(&repair));
            self.event(Kind::Fault, &format!("fault brake {axis}"), Some(&repair));
            self.event(Kind::Fault, &format!("fault clamp {axis}"), Some(&repair));
            self.event(Kind::Fault, &format!("fault offset {axis} 0.15"), None);
            for newton in [400, 4000] {
                let away = format!("force {axis} 0");
                self.event(Kind::Fault, &format!("force {axis} {newton}"), Some(&away));
            }
        }
        let things: Vec<String> = self
            .plant
            .devices()
            .map(|device| device.name.to_owned())
            .collect();
        for thing in things.iter().map(String::as_str).chain(["gear", "magazine"]) {
            let repair = format!("repair {thing}");
            for how in ["jammed", "no-feedback", "permanent", "slow"] {
                self.event(Kind::Fault, &format!("fault device {thing} {how}"), Some(&repair));
            }
        }
        // What is lost stays lost: the operator takes the tools out, as the PLC's dialogue says.
        self.event(Kind::Fault, "fault magazine lost", None);
        let operands = self.plant.wires().iter().map(|wire| wire.operand.clone());
        let inputs: Vec<String> = operands.filter(|operand| operand.starts_with('I')).collect();
        for input in inputs {
            let repair = format!("repair {input}");
            for level in ["0", "1", "bouncing"] {
                self.event(
                    Kind::Fault,
                    &format!("fault input {input} {level}"),
                    Some(&repair),
                );
            }
        }
        for relay in ["slow 60", "slow 300", "welded", "open"] {
            self.event(Kind::Fault, &format!("fault relay {relay}"), Some("repair relay"));
        }
        for probe in ["not-ready", "battery", "early"] {
            self.event(Kind::Fault, &format!("fault probe {probe}"), Some("repair probe"));
        }
        self.event(Kind::Fault, "fault battery", Some("repair battery"));
        // Both senses of rotation at once; a message that flashes; markers of a key against its complement; M and T
        // functions that are acknowledged early, and an acknowledgement that is taken back.
        for markers in [
            "M2485=1, M2486=1",
            "M2924=1, M2815=1",
            "M2924=1",
            "M2451=1, M2467=1",
            "M2482=1",
            "M2483=1",
            "M2482=0, M2483=0",
        ] {
            self.command(Kind::Plc, markers, Some("M2815=0, M2924=0"));
        }
    }

    /// What puts everything back: nothing is broken, no key is pressed.
    fn repairs(&self) -> Vec<String> {
        let mut repairs = vec![
            "power on".to_owned(),
            "repair all".to_owned(),
            "emergency release".to_owned(),
        ];
        repairs.extend(["voltage on", "override feed 100", "override spindle 100"].map(str::to_owned));
        repairs.extend(self.plant.axes().map(|axis| format!("force {} 0", axis.letter)));
        repairs.extend(
            self.plant
                .axes()
                .map(|axis| format!("fault offset {} 0", axis.letter)),
        );
        repairs.extend(self.plant.keys().map(|key| format!("key {key} release")));
        for state in ["switch door closed", "switch lubricant full"] {
            if self.plant.clone().apply(state).is_ok() {
                repairs.push(state.to_owned());
            }
        }
        repairs.push("M2815=0, M2924=0".to_owned());
        repairs
    }
}
