//! Doing what events say: the hands of the operator, and what breaks.

use crate::axis::{Axis, DriveFault};
use crate::device::DeviceFault;
use crate::encoder::EncoderFault;
use crate::event::{Event, EventError, Fault, KeyAction, Put, input_number};
use crate::machine::{Machine, set};
use crate::magazine::Magazine;
use crate::probe::Probe;
use crate::spindle::Spindle;

impl Machine {
    /// Reads an event and does what it says; [`Event::HELP`] lists the forms, [`Machine::keys`] and the like
    /// the names.
    ///
    /// # Errors
    /// When the text is no event, or names what the machine does not have. Nothing is done then.
    pub fn apply(&mut self, event: &str) -> Result<(), EventError> {
        self.act(&Event::parse(event)?)
    }

    /// Does what an event says.
    ///
    /// # Errors
    /// When it names what the machine does not have. Nothing is done then.
    pub fn act(&mut self, event: &Event) -> Result<(), EventError> {
        self.rests = false;
        match event {
            Event::Key(name, action) => self.key(name, *action)?,
            Event::FeedOverride(percent) => self.panel.operator.feed_override_percent = *percent,
            Event::SpindleOverride(percent) => self.panel.operator.spindle_override_percent = *percent,
            Event::Handwheel(wheel, steps) => {
                if let Some(count) = self.panel.operator.handwheel.counts.get_mut(*wheel) {
                    *count = count.wrapping_add(*steps);
                }
            }
            Event::HandwheelKey(key, action) => self.panel.wheel_key(*key, *action),
            Event::HandwheelSwitch(switch, position) => {
                set(&mut self.panel.operator.handwheel.switches, *switch, *position);
            }
            Event::HandwheelPlug(put) => self.panel.operator.handwheel.connected = *put == Put::In,
            Event::Switch(name, state) => self.switch(name, state)?,
            Event::EmergencyStop(button) => self.chain.button = button.is_pressed(),
            Event::Voltage(supply) => self.chain.supply = supply.is_on(),
            Event::Tool(tool) => {
                if self.tool_probe.is_none() {
                    self.magazine_mut()?;
                }
                self.mechanism.by_hand.insert(*tool);
                if let Some(magazine) = &mut self.mechanism.magazine {
                    magazine.insert(*tool);
                }
            }
            Event::Probe(put) => {
                let angle = self.mechanism.spindle_deg();
                self.probe()?.insert(*put == Put::In, angle);
            }
            Event::Stylus(letter, force) => self.probe()?.push(*letter, *force),
            Event::Analogue(input, volts) => set(&mut self.plc.volts, *input, *volts),
            Event::Temperature(input, celsius) => set(&mut self.plc.temperatures, *input, *celsius),
            Event::Force(letter, force) => self.axis_mut(*letter)?.push(*force),
            Event::Fault(fault) => self.inject(fault)?,
            Event::Repair(what) => self.repair(what)?,
        }
        Ok(())
    }

    /// Presses a key and holds it.
    ///
    /// # Errors
    /// When the panel has no such key.
    pub fn press(&mut self, key: &str) -> Result<(), EventError> {
        self.key(key, KeyAction::Press)
    }

    /// Releases a key.
    ///
    /// # Errors
    /// When the panel has no such key.
    pub fn release(&mut self, key: &str) -> Result<(), EventError> {
        self.key(key, KeyAction::Release)
    }

    fn key(&mut self, name: &str, action: KeyAction) -> Result<(), EventError> {
        self.rests = false;
        if self.panel.act(name, action) {
            return Ok(());
        }
        Err(no("key", name, self.keys()))
    }

    fn switch(&mut self, name: &str, state: &str) -> Result<(), EventError> {
        let Some(device) = self
            .mechanism
            .devices
            .iter_mut()
            .find(|device| device.name == name)
        else {
            return Err(no("thing", name, self.devices().map(|device| device.name)));
        };
        if !device.by_hand() {
            return Err(EventError::NotByHand(name.to_owned()));
        }
        let Some(state) = device.states.iter().position(|own| own == state) else {
            return Err(no("state", state, device.states.iter().map(String::as_str)));
        };
        device.switch(state == 1);
        Ok(())
    }

    fn probe(&mut self) -> Result<&mut Probe, EventError> {
        self.mechanism
            .probe
            .as_mut()
            .ok_or_else(|| no("part", "probe", std::iter::empty()))
    }

    fn magazine_mut(&mut self) -> Result<&mut Magazine, EventError> {
        self.mechanism
            .magazine
            .as_mut()
            .ok_or_else(|| no("part", "magazine", std::iter::empty()))
    }

    /// The letter of a physical axis of a System 900; axes of a TNC have letters alone.
    fn physical_axis(&self, number: u8) -> Result<char, EventError> {
        let axes = &self.mechanism.axes;
        let own = |axis: &&Axis| self.mechanism.numbered && axis.output + 1 == usize::from(number);
        let found = axes.iter().find(own).map(|axis| axis.letter);
        found.ok_or_else(|| EventError::Name {
            what: "axis",
            name: number.to_string(),
            known: axes.iter().map(|axis| axis.letter).collect(),
        })
    }

    fn axis_mut(&mut self, letter: char) -> Result<&mut Axis, EventError> {
        let known: String = self.mechanism.axes.iter().map(|axis| axis.letter).collect();
        self.mechanism
            .axes
            .iter_mut()
            .find(|axis| axis.letter == letter)
            .ok_or_else(|| EventError::Name {
                what: "axis",
                name: letter.to_string(),
                known,
            })
    }

    fn spindle_mut(&mut self) -> Result<&mut Spindle, EventError> {
        self.mechanism
            .spindles
            .first_mut()
            .ok_or_else(|| no("part", "spindle", std::iter::empty()))
    }

    /// Makes something fail.
    ///
    /// # Errors
    /// When the machine does not have it.
    pub(crate) fn inject(&mut self, fault: &Fault) -> Result<(), EventError> {
        self.rests = false;
        match fault {
            Fault::Encoder(letter, kind) => return self.encoder_fault(*letter, Some(*kind)),
            Fault::Motor(letter) => return self.lose_motor(*letter),
            Fault::Drive('S', kind) => self.spindle_mut()?.fault = Some(*kind),
            Fault::Drive(letter, kind) => self.axis_mut(*letter)?.set_drive_fault(Some(*kind)),
            Fault::PhysicalDrive(number) => {
                let letter = self.physical_axis(*number)?;
                self.axis_mut(letter)?.set_drive_fault(Some(DriveFault::Dead));
            }
            Fault::Offset(letter, volts) => self.axis_mut(*letter)?.offset = *volts,
            Fault::Input(input, fault) => {
                self.plc.stick(*input, *fault);
            }
            Fault::Brake(letter) => self.axis_mut(*letter)?.brake_lost = true,
            Fault::Clamp(letter) => self.axis_mut(*letter)?.jammed = true,
            Fault::Device(name, kind) => return self.device_fault(name, Some(*kind)),
            Fault::Relay(kind) => self.chain.fault = Some(*kind),
            Fault::ToolLost => self.magazine_mut()?.lose(),
            Fault::ProbeNotReady => self.probe()?.ready = false,
            Fault::ProbeBattery => self.probe()?.battery_low = true,
            Fault::ProbeEarly => self.probe()?.early = true,
            Fault::BufferBattery => self.memory.battery_low = true,
            Fault::Memory { eprom } => self.memory.defective[usize::from(*eprom)] = true,
        }
        Ok(())
    }

    fn encoder_fault(&mut self, letter: char, kind: Option<EncoderFault>) -> Result<(), EventError> {
        let found = if letter == 'S' {
            self.spindle_mut()?.set_encoder_fault(kind)
        } else {
            self.axis_mut(letter)?.set_encoder_fault(kind)
        };
        if found {
            return Ok(());
        }
        let with_encoder = |axis: &&Axis| axis.counter.is_some();
        let known: Vec<String> = self
            .mechanism
            .axes
            .iter()
            .filter(with_encoder)
            .map(|axis| axis.letter.to_string())
            .collect();
        Err(no(
            "encoder",
            &letter.to_string(),
            known.iter().map(String::as_str),
        ))
    }

    fn lose_motor(&mut self, letter: char) -> Result<(), EventError> {
        if self.axis_mut(letter)?.lose_motor() {
            return Ok(());
        }
        let digital = self
            .mechanism
            .axes
            .iter()
            .filter(|axis| axis.motor_count().is_some());
        let known: Vec<String> = digital.map(|axis| axis.letter.to_string()).collect();
        Err(no(
            "digital drive",
            &letter.to_string(),
            known.iter().map(String::as_str),
        ))
    }

    fn device_fault(&mut self, name: &str, kind: Option<DeviceFault>) -> Result<(), EventError> {
        if name == "gear" {
            self.spindle_mut()?.gear_fault = kind;
            return Ok(());
        }
        if name == "magazine" {
            self.magazine_mut()?.fault = kind;
            return Ok(());
        }
        if let Some(device) = self
            .mechanism
            .devices
            .iter_mut()
            .find(|device| device.name == name)
        {
            device.fault = kind;
            return Ok(());
        }
        Err(no("thing", name, self.devices().map(|device| device.name)))
    }

    /// Repairs one thing, or `all`. Counts that an encoder lost stay lost, a changed offset stays.
    fn repair(&mut self, what: &str) -> Result<(), EventError> {
        if what == "all" {
            let letters: Vec<char> = self.mechanism.axes.iter().map(|axis| axis.letter).collect();
            for letter in letters {
                self.repair_axis(letter)?;
            }
            if !self.mechanism.spindles.is_empty() {
                self.repair("S")?;
                self.repair("gear")?;
            }
            self.mechanism
                .devices
                .iter_mut()
                .for_each(|device| device.fault = None);
            if let Some(magazine) = &mut self.mechanism.magazine {
                magazine.fault = None;
            }
            self.plc.loosen_all();
            self.chain.fault = None;
            self.memory.battery_low = false;
            self.memory.defective = [false; 2];
            if self.mechanism.probe.is_some() {
                self.repair("probe")?;
            }
            return Ok(());
        }
        if let Some(input) = input_number(what) {
            self.plc.loosen(input);
            return Ok(());
        }
        if let (true, Ok(number)) = (self.mechanism.numbered, what.parse()) {
            let letter = self.physical_axis(number)?;
            return self.repair_axis(letter);
        }
        match what {
            "relay" => self.chain.fault = None,
            "battery" => self.memory.battery_low = false,
            "memory" => self.memory.defective = [false; 2],
            "probe" => {
                let probe = self.probe()?;
                probe.ready = true;
                probe.battery_low = false;
                probe.early = false;
                probe.let_go();
            }
            "S" => {
                let spindle = self.spindle_mut()?;
                spindle.fault = None;
                spindle.set_encoder_fault(None);
            }
            _ => {
                let mut letters = what.chars();
                return match (letters.next(), letters.next()) {
                    (Some(letter), None) => self.repair_axis(letter),
                    _ => self.device_fault(what, None),
                };
            }
        }
        Ok(())
    }

    fn repair_axis(&mut self, letter: char) -> Result<(), EventError> {
        let axis = self.axis_mut(letter)?;
        axis.set_drive_fault(None);
        axis.find_motor();
        axis.set_encoder_fault(None);
        axis.brake_lost = false;
        axis.jammed = false;
        Ok(())
    }
}

fn no<'a>(what: &'static str, name: &str, known: impl Iterator<Item = &'a str>) -> EventError {
    let known: Vec<&str> = known.collect();
    EventError::Name {
        what,
        name: name.to_owned(),
        known: if known.is_empty() {
            "none".to_owned()
        } else {
            known.join(", ")
        },
    }
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used, reason = "a test may fail")]
    use crate::clock::Span;
    use bahn_servo::{Commands, Measured, OUTPUTS, Plant, Step};
    use proptest::prelude::*;

    use crate::Machine;

    /// The description of a shipped machine.
    fn shipped(machine: &str) -> String {
        let machines = concat!(env!("CARGO_MANIFEST_DIR"), "/../../../machines");
        std::fs::read_to_string(format!("{machines}/{machine}/plant.toml")).unwrap_or_default()
    }

    /// What happens to a machine, which need not have all of it.
    const EVENTS: &[&str] = &[
        "key X+ tap",
        "key LATCH press",
        "emergency press",
        "emergency release",
        "voltage off",
        "voltage on",
        "switch door open",
        "switch door closed",
        "tool 3",
        "force C 30",
        "force C 0",
        "force Z -5000",
        "force Z 0",
        "fault device shuttle jammed",
        "fault device flood slow",
        "fault device magazine jammed",
        "fault device gear jammed",
        "fault drive X dead",
        "fault brake Z",
        "fault clamp C",
        "fault relay slow 40",
        "fault magazine lost",
        "repair all",
    ];

    /// Event, output that is switched, nominal voltage of all drives, milliseconds until the next.
    type Action = (usize, usize, f64, u32);

    /// A single step, without a tick.
    const STEP: Span = Span {
        steps: 1,
        first: 2,
        each: 5,
    };

    /// What a step without any shortcut does to all axes: for each of them the state and the encoder.
    fn stepped(machine: &Machine) -> String {
        let axes = machine.mechanism.axes.iter().cloned().map(|mut axis| {
            let load = axis.load();
            axis.advance(&load, STEP, 2e-4);
            format!("{axis:?}")
        });
        axes.collect()
    }

    fn run(machine: &mut Machine) -> String {
        let axes = machine.mechanism.axes.iter().cloned().map(|mut axis| {
            axis.run(STEP, 2e-4);
            format!("{axis:?}")
        });
        axes.collect()
    }

    fn is_left_out_without_effect(plant: &str, actions: &[Action]) {
        let mut lazy = Machine::from_toml(plant).unwrap();
        lazy.load_magazine([(1, 1), (2, 2)].into_iter(), 0);
        let mut eager = lazy.clone();
        let mut commands = Commands {
            control_ready: true,
            ..Commands::default()
        };
        commands.outputs[8..=12].fill(true);
        let mut measured = [Measured::default(), Measured::default()];
        let mut from_us = 0;
        for (event, output, volts, milliseconds) in actions {
            let event = EVENTS.get(*event).unwrap();
            assert_eq!(lazy.apply(event).is_ok(), eager.apply(event).is_ok());
            commands.outputs[*output] ^= true;
            commands.axes.iter_mut().for_each(|axis| axis.volts = *volts);
            for _ in 0..*milliseconds {
                let step = Step {
                    from_us,
                    length_us: 1000,
                };
                from_us += 1000;
                eager.rests = false;
                lazy.exchange(step, &commands, &mut measured[0]);
                eager.exchange(step, &commands, &mut measured[1]);
                assert_eq!(measured[0], measured[1], "{event} at {from_us}");
                assert_eq!(stepped(&lazy), run(&mut lazy), "{event} at {from_us}");
            }
            assert!(lazy.devices().eq(eager.devices()) && lazy.magazine() == eager.magazine());
            assert!(lazy.axes().eq(eager.axes()) && lazy.spindles().eq(eager.spindles()));
        }
    }

    proptest! {
        #![proptest_config(ProptestConfig::with_cases(24))]

        /// A machine that looks at everything in each tick, and moves every axis in each step, is the same as one that
        /// leaves out what rests.
        #[test]
        fn what_rests_is_left_out_without_effect(
            actions in prop::collection::vec((0..EVENTS.len(), 0..OUTPUTS / 4, -3.0..3.0, 1u32..60), 1..30),
        ) {
            is_left_out_without_effect(&shipped("mill"), &actions);
            is_left_out_without_effect(&shipped("dig425"), &actions);
        }
    }
}
