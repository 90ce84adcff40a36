//! A plant that is no simulated machine: two ideal axes with a few keys, as `docs/plant.md` tells how one is written; and
//! the folder of its control, which describes no simulated machine.
#![allow(
    clippy::unwrap_used,
    clippy::panic,
    reason = "what fails in a helper fails the test"
)]
#![allow(dead_code, reason = "each test file uses a part of it")]

use std::path::{Path, PathBuf};

use bahn_host::{Event, KeyAction, LoadedMachine, Operable, StopChain, TrueAxis, Wired};
use bahn_servo::{Commands, IdealAxes, Measured, Plant, Step};

/// Counting steps of a millimetre: 1024 in 20 µm (MP330).
const STEPS_MM: f64 = 51_200.0;
/// The keys with their inputs; the contact of NC_STOP opens.
const KEYS: [(&str, usize); 4] = [("NC_START", 10), ("NC_STOP", 11), ("X+", 12), ("X-", 13)];
/// The acknowledgement of the EMERGENCY STOP chain, X42/4.
const ACKNOWLEDGEMENT: usize = 3;
/// So long a tapped key is down, µs.
const TAP_US: u32 = 100_000;

/// Two axes that stand where they are told to, an operating panel of four keys and a lamp, an EMERGENCY STOP button.
#[derive(Clone)]
pub struct CrossTable {
    axes: IdealAxes,
    pressed: bool,
    lit: bool,
    /// For how long each key is still down, µs; `None` until it is let go.
    down: [Option<u32>; KEYS.len()],
}

impl CrossTable {
    /// At rest, each axis 2 mm before its reference mark.
    pub fn new() -> CrossTable {
        let mut axes = IdealAxes::default();
        for mark in axes.marks.iter_mut().take(2) {
            *mark = Some((2.0 * STEPS_MM) as i64);
        }
        CrossTable {
            axes,
            pressed: false,
            lit: false,
            down: [Some(0); KEYS.len()],
        }
    }

    fn is_down(&self, key: usize) -> bool {
        self.down[key] != Some(0)
    }
}

impl Plant for CrossTable {
    fn exchange(&mut self, step: Step, commands: &Commands, measured: &mut Measured) {
        for (place, (name, input)) in KEYS.iter().enumerate() {
            self.axes.inputs[*input] = self.is_down(place) != (*name == "NC_STOP");
        }
        self.axes.exchange(step, commands, measured);
        measured.control_ready &= !self.pressed;
        measured.inputs[ACKNOWLEDGEMENT] = measured.control_ready;
        self.lit = commands.outputs[0];
        for left in self.down.iter_mut().flatten() {
            *left = left.saturating_sub(step.length_us);
        }
    }
}

impl Operable for CrossTable {
    fn operate(&mut self, event: &Event) -> Result<(), String> {
        match event {
            Event::Key(name, action) => {
                let place = KEYS.iter().position(|(key, _)| key == name);
                let place = place.ok_or_else(|| format!("the cross table has no key {name}"))?;
                self.down[place] = match action {
                    KeyAction::Press => None,
                    KeyAction::Release => Some(0),
                    KeyAction::Tap => Some(TAP_US),
                };
            }
            Event::EmergencyStop(button) => self.pressed = button.is_pressed(),
            Event::FeedOverride(percent) => self.axes.operator.feed_override_percent = *percent,
            other => return Err(format!("the cross table has nothing for {other:?}")),
        }
        Ok(())
    }

    fn copied(&self) -> Option<CrossTable> {
        Some(self.clone())
    }

    fn keys(&self) -> Vec<&str> {
        KEYS.iter().map(|(name, _)| *name).collect()
    }

    fn held_keys(&self) -> Vec<&str> {
        let held = KEYS.iter().zip(&self.down).filter(|(_, down)| down.is_none());
        held.map(|((name, _), _)| *name).collect()
    }

    fn lamps(&self) -> Vec<(&str, bool)> {
        vec![("RUNS", self.lit)]
    }

    fn knobs(&self) -> [f64; 2] {
        [self.axes.operator.feed_override_percent, 100.0]
    }

    fn stop_chain(&self) -> StopChain {
        StopChain {
            pressed: self.pressed,
            ..StopChain::default()
        }
    }

    fn wires(&self) -> Vec<Wired> {
        let wired = KEYS.iter().map(|(name, input)| Wired {
            operand: format!("I{input}"),
            part: "keys".to_owned(),
            function: (*name).to_owned(),
            opens: *name == "NC_STOP",
        });
        wired.collect()
    }

    fn axis_letters(&self) -> Vec<char> {
        vec!['X', 'Y']
    }

    fn true_axis(&self, letter: char) -> Option<TrueAxis> {
        let place = self.axis_letters().iter().position(|own| *own == letter)?;
        Some(TrueAxis {
            position: self.axes.count(place) as f64 / STEPS_MM,
            force: 0.0,
        })
    }
}

/// A folder that is removed in the end.
pub struct Folder(pub PathBuf);

impl Drop for Folder {
    fn drop(&mut self) {
        let _ = std::fs::remove_dir_all(&self.0);
    }
}

const MACHINE: &str =
    "name = \"Cross table\"\nmodel = \"tnc415b\"\nparameters = \"parameters.mp\"\nplc = \"MAIN.PLC\"\n";

/// Lists of machine parameters have what differs from the reference list.
const PARAMETERS: &str = "
MP10 : %00011
MP30 : 0
MP40 : %00011
MP50 : %00011
MP330.0 : 20
MP330.1 : 20
MP910.0 : +500
MP910.1 : +500
MP920.0 : -500
MP920.1 : -500
MP1010.0 : 15000
MP1010.1 : 15000
MP1020.0 : 3000
MP1020.1 : 3000
MP1050.0 : 9
MP1050.1 : 9
MP1060.0 : 1
MP1060.1 : 1
MP1350.0 : 1
MP1350.1 : 1
MP4060.0 : 0
MP4060.1 : 0
MP7212 : 0
MP7230 : 1
MP7290.0 : 4
MP7290.1 : 4
";

/// Feed enable with the control voltage, the keys, all functions acknowledged.
const PLC: &str = "
       L     M2719
       SN    M2719
       L     M2719
       S     M2465
       S     M2466
       S     M2474
       S     M2475
       S     M2476
       S     M2477
       S     M2478
       S     M2479
       S     M2540
       S     M2541
       L     I3
       = M2451
       =N M2467
       L     I10
       = M2448
       =N M2464
       L     I11
       = M2488
       L     I12
       = M2456
       =N M2472
       L     I13
       = M2457
       =N M2473
       L     M2184
       = O0
       L     M2045
       = M2482
       L     M2043
       = M2480
       L     M2044
       = M2481
       L     M2046
       = M2483
       L     M2047
       = M2484
       L     M2149
       = M2611
       EM
";

/// The folder of its control, with a program SQUARE.H.
pub fn folder(name: &str) -> Folder {
    let folder = std::env::temp_dir().join(format!("bahn-cross-table-{name}-{}", std::process::id()));
    std::fs::create_dir_all(folder.join("programs")).unwrap();
    let square = "BEGIN PGM SQUARE MM\nL X+30 Y+0 R0 F3000\nL Y+30\nL X+0\nL Y+0\nEND PGM SQUARE MM\n";
    for (file, text) in [
        ("machine.toml", MACHINE),
        ("parameters.mp", PARAMETERS),
        ("MAIN.PLC", PLC),
        ("programs/SQUARE.H", square),
    ] {
        std::fs::write(folder.join(file), text).unwrap();
    }
    Folder(folder)
}

pub fn load(folder: &Path) -> LoadedMachine {
    bahn_panel::load(folder).unwrap_or_else(|faults| panic!("{faults}"))
}
