//! A control on the ideal machine.

#![allow(dead_code, reason = "no test needs all of it")]

pub mod list;

use bahn_control900::{Control900, Setup, StandardAnswers, ideal_machine};
use bahn_servo::{Commands, IdealAxes, Measured, Plant, Step};
use bahn_system900::DataFile;

use list::{Line, Lines};

/// Two channels, with X and Y in each: physical axes 1 to 4 of 6000 mm/min, Kv 16, 1000 INC/mm, referenced at once.
pub const TWO_CHANNELS: &str = "q2: 2\nq102: 10000\nq103: 100\nq202: 20000\nq203: 100\nq10: 99\n\
    q110: $01010058\nq111: $02020059\nq210: $01030058\nq211: $02040059\n";

/// An axis of the tests.
pub fn axis(physical: u32) -> String {
    let first = 2000 + 200 * (physical - 1);
    let of = |offset: u32, value: &str| format!("q{}: {value}\n", first + offset);
    [
        of(0, "1"),
        of(4, "6000"),
        of(12, "1000"),
        of(13, "1"),
        of(15, "$01000000"),
        of(20, "16"),
    ]
    .concat()
}

/// A machine with an EMERGENCY STOP button.
#[derive(Clone, Default)]
pub struct Machine {
    pub ideal: IdealAxes,
    pub pressed: bool,
}

impl Plant for Machine {
    fn exchange(&mut self, step: Step, commands: &Commands, measured: &mut Measured) {
        self.ideal.exchange(step, commands, measured);
        measured.control_ready &= !self.pressed;
    }
}

/// A control on its machine.
#[derive(Clone)]
pub struct Rig {
    pub control: Control900,
    pub plant: Machine,
}

impl Rig {
    /// Switched on with the two channels, and more lines of a data file.
    pub fn on(more: &str) -> Rig {
        Rig::answered(more, StandardAnswers::ALL)
    }

    /// The same with some answers.
    pub fn answered(more: &str, answers: StandardAnswers) -> Rig {
        let axes = (1..=4).map(axis).collect::<String>();
        Rig::of(&format!("{TWO_CHANNELS}{axes}{more}"), answers)
    }

    /// Switched on with a data file.
    pub fn of(text: &str, answers: StandardAnswers) -> Rig {
        let file = DataFile::read(text.as_bytes());
        assert!(
            file.is_readable(),
            "{:?}",
            file.faults().iter().map(ToString::to_string).collect::<Vec<_>>()
        );
        Rig::with(
            &file,
            Setup {
                answers,
                ..Setup::default()
            },
        )
    }

    /// Switched on with parameters, and a PLC or answers.
    pub fn with(file: &DataFile, setup: Setup) -> Rig {
        let plant = Machine {
            ideal: ideal_machine(file.memory()),
            pressed: false,
        };
        let mut rig = Rig {
            control: Control900::new(file.memory().clone(), setup),
            plant,
        };
        rig.seconds(0.1);
        rig
    }

    pub fn cycle(&mut self) {
        self.control.prepare();
        self.control.cycle(&mut self.plant);
    }

    pub fn seconds(&mut self, seconds: f64) {
        let end = self.control.now_us() + (seconds * 1e6) as u64;
        while self.control.now_us() < end {
            self.cycle();
        }
    }

    /// Goes on until something is so, 60 s at most.
    pub fn until(&mut self, so: impl Fn(&Rig) -> bool) {
        let end = self.control.now_us() + 60_000_000;
        while !so(self) {
            assert!(
                self.control.now_us() < end,
                "it never came: {:?}",
                self.control.messages()
            );
            self.cycle();
        }
    }

    /// The operator writes.
    pub fn operator(&mut self, name: &str, value: &str) {
        let written = self
            .control
            .write_operator(name.parse().unwrap(), value.parse().unwrap());
        written.unwrap();
    }

    /// The PLC writes.
    pub fn plc(&mut self, name: &str, value: &str) {
        let written = self
            .control
            .write_plc(name.parse().unwrap(), value.parse().unwrap());
        written.unwrap();
    }

    /// What an output gives, V.
    pub fn plant_volts(&self, output: usize) -> f64 {
        self.control.commands().axes[output].volts
    }

    /// What a parameter holds; NaN when it is cleared.
    pub fn read(&self, name: &str) -> f64 {
        let cell = self.control.memory().cell(name.parse().unwrap()).unwrap();
        cell.number().unwrap_or(f64::NAN)
    }

    /// The same, not rounded.
    pub fn exact(&self, name: &str) -> f64 {
        self.control
            .number(name.parse().unwrap())
            .unwrap()
            .unwrap_or(f64::NAN)
    }

    /// A program of a channel in AUTO, sequence, started by the operator.
    pub fn start(&mut self, channel: u8, lines: &[Line]) {
        self.load(channel, lines);
        self.operator(&format!("{channel}:P8683"), "2");
        self.seconds(0.05);
        self.operator(&format!("{channel}:P8682"), "2");
        self.until(|rig| rig.read(&format!("{channel}:P8685")) == 2.0);
    }

    /// A program of channel 1 in the language of the control, started by the operator.
    pub fn start_text(&mut self, text: &str) {
        self.load_text(text);
        self.operator("P8683", "2");
        self.seconds(0.05);
        self.operator("P8682", "2");
        self.until(|rig| rig.read("P8685") == 2.0);
    }

    /// The program of channel 1 in the language of the control.
    pub fn load_text(&mut self, text: &str) {
        let beside = std::sync::Arc::new(bahn_text::MemoryFiles::default());
        let zero = bahn_path::Position::ZERO;
        let program = bahn_interpreter900::Reader900::new("P1000.900", text.as_bytes(), 1, zero, beside);
        self.operator("P8800", "1000");
        self.control.set_program(1, Some(Box::new(program)));
    }

    /// The program of a channel.
    pub fn load(&mut self, channel: u8, lines: &[Line]) {
        self.operator(&format!("{channel}:P8800"), "1000");
        self.control.set_program(channel, Some(Lines::boxed(lines)));
    }

    /// Until the program of a channel is over.
    pub fn until_end(&mut self, channel: u8) {
        self.until(|rig| rig.control.run(channel).1);
    }
}
