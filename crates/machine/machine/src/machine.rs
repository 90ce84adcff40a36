//! The whole machine.

use std::sync::Arc;

use bahn_servo::{Commands, Encoder, INPUTS, Measured, OUTPUTS, Plant, Probe as Touch, Step};
use bahn_text::Diagnostic;

use crate::axis::{Axis, AxisState};
use crate::by_hand::ByHand;
use crate::cabinet;
use crate::chain::{Chain, Interlock};
use crate::clock::{Clock, TICK_US};
use crate::device::{Device, DeviceState};
use crate::magazine::{Magazine, MagazineState};
use crate::mechanics::Mechanics;
use crate::mechanism::Mechanism;
use crate::panel::Panel;
use crate::plc_side::PlcSide;
use crate::probe::{Probe, Solid};
use crate::reader::{Reader, Section, Wire};
use crate::spindle::{Spindle, SpindleState};
use crate::tool_probe::ToolProbe;

/// What is wrong with the memory of the control: its battery, its RAM, its EPROMs with their checksum.
#[derive(Clone, Copy, Debug, Default)]
pub(crate) struct ControlMemory {
    pub battery_low: bool,
    /// RAM; EPROMs and checksum.
    pub defective: [bool; 2],
}

/// A simulated machine, described by a TOML file. The same description and the same calls give the
/// same machine, bit by bit.
///
/// ```
/// use bahn_machine::Machine;
/// let text = r#"
///     name = "one axis"
///     [emergency_stop]
///     acknowledgement = "I3"
///     [axis.X]
///     output = "1"
///     speed = 15000
///     volts = 9
///     encoder = { input = "X1", period_um = 20 }
/// "#;
/// let mut machine = Machine::from_toml(text).map_err(|faults| faults[0].clone())?;
/// machine.set_control_ready(true);
/// machine.advance(20_000);
/// machine.set_nominal(0, 0.9);
/// machine.advance(1_000_000);
/// // 1500 mm/min for a second are 25 mm: 1250 signal periods of 1024 steps.
/// assert!((machine.encoder(0).count - 1250 * 1024).abs() <= 1);
/// # Ok::<(), bahn_text::Diagnostic>(())
/// ```
#[derive(Clone, Debug)]
pub struct Machine {
    name: String,
    clock: Clock,
    pub(crate) mechanism: Mechanism,
    /// The axes X, Y, Z of the probe among the axes.
    probe_axes: [Option<usize>; 3],
    pub(crate) chain: Chain,
    pub(crate) panel: Panel,
    /// The place of the key of the control voltage.
    voltage_key: Option<usize>,
    pub(crate) tool_probe: Option<ToolProbe>,
    pub(crate) plc: PlcSide,
    /// Nothing has moved in the last tick and nobody has acted since: contacts, relays and things stay as they are.
    pub(crate) rests: bool,
    /// What is wrong with the memory of the control.
    pub(crate) memory: ControlMemory,
    wires: Vec<Wire>,
}

impl Machine {
    /// Builds a machine from its description; `machines/mill/plant.toml` explains every key.
    ///
    /// # Errors
    /// All faults of the description, in its order.
    pub fn from_toml(text: &str) -> Result<Machine, Vec<Diagnostic>> {
        Machine::described(Reader::new(text))
    }

    /// The same of a machine with a System 900: output n and encoder Xn are those of physical axis n, its encoders are counted in
    /// quarters of a period, and an axis has any letter but S and says with `turns` whether it turns.
    ///
    /// # Errors
    /// All faults of the description, in its order.
    pub fn with_numbered_axes(text: &str) -> Result<Machine, Vec<Diagnostic>> {
        let mut reader = Reader::new(text);
        reader.numbered = true;
        Machine::described(reader)
    }

    fn described(reader: Reader) -> Result<Machine, Vec<Diagnostic>> {
        let table = reader.parse();
        let mut machine = Machine::read(Section::root(&reader, &table));
        machine.wires = reader.wires();
        let faults = reader.faults();
        if faults.is_empty() {
            Ok(machine)
        } else {
            Err(faults)
        }
    }

    fn read(root: Section) -> Machine {
        cabinet::name_contacts(&root);
        let step_us = root.number("step_us", 10.0..=1000.0).unwrap_or(200.0) as u32;
        if !TICK_US.is_multiple_of(step_us.max(1)) {
            root.fault_at("step_us", "step_us divides 1000".to_owned());
        }
        let step_s = f64::from(step_us) * 1e-6;
        let seed = root.number("seed", 0.0..=1e15).unwrap_or(0.0) as u64;
        let axes: Vec<Axis> = root
            .named_sections("axis")
            .into_iter()
            .filter_map(|(name, section)| Axis::read(&name, section, step_s, seed))
            .collect();
        let devices: Vec<Device> = root
            .named_sections("device")
            .into_iter()
            .map(|(name, section)| Device::read(name, section))
            .collect();
        // Read in this order: wires are counted in it.
        let spindles = root.one_or_more("spindle").into_iter();
        let spindles = spindles
            .map(|section| Spindle::read(section, step_s, seed))
            .collect();
        let chain = Chain::read(&root);
        let magazine = root.section("magazine");
        let magazine = magazine.map(|section| Magazine::read(section, &devices));
        let panel = Panel::read(&root);
        let probe = root.section("probe").map(Probe::read);
        let mechanism = Mechanism {
            numbered: root.reader.numbered,
            axes,
            spindles,
            devices,
            magazine,
            by_hand: ByHand::default(),
            probe,
        };
        let index = |letter| mechanism.axes.iter().position(|axis| axis.letter == letter);
        let mut machine = Machine {
            name: root.text("name").unwrap_or("machine").to_owned(),
            clock: Clock::new(step_us),
            probe_axes: ['X', 'Y', 'Z'].map(index),
            chain,
            voltage_key: None,
            panel,
            tool_probe: root.section("tool_probe").map(ToolProbe::read),
            plc: PlcSide::read(&root),
            rests: false,
            memory: ControlMemory::default(),
            wires: Vec::new(),
            mechanism,
        };
        let key = machine.chain.key();
        machine.voltage_key = key.and_then(|key| machine.panel.place(key));
        machine.check(&root);
        root.finish();
        machine
    }

    /// What only shows when all parts are known.
    fn check(&self, root: &Section) {
        if self.mechanism.axes.is_empty() {
            root.fault("a machine has at least one axis: [axis.X]".to_owned());
        }
        for (place, axis) in self.mechanism.axes.iter().enumerate() {
            for other in self.mechanism.axes.iter().take(place) {
                let input = |axis: &Axis| axis.counter.as_ref().map(|counter| counter.input);
                if other.output == axis.output {
                    root.fault_at(
                        "axis",
                        format!("{} and {} share an output", other.letter, axis.letter),
                    );
                }
                if input(other).is_some() && input(other) == input(axis) {
                    root.fault_at(
                        "axis",
                        format!("{} and {} share an encoder input", other.letter, axis.letter),
                    );
                }
            }
        }
        for clamped in self.mechanism.devices.iter().filter_map(|device| device.clamps) {
            if !self.mechanism.axes.iter().any(|axis| axis.letter == clamped) {
                root.fault_at("device", format!("there is no axis {clamped} to clamp"));
            }
        }
        if let Some(key) = self.chain.key().filter(|key| self.panel.place(key).is_none()) {
            root.fault_at("emergency_stop", format!("there is no key `{key}` in [keys]"));
        }
    }

    /// What is wired to inputs and outputs of the PLC, in the order in which it is read: the seeds of the fault campaign count
    /// on it.
    pub fn wires(&self) -> &[Wire] {
        &self.wires
    }

    /// Fits it to the terminals of a control: which outputs lose their voltage with EMERGENCY STOP, unless the description
    /// says it itself, and which are bipolar, pair by pair. Whether the description speaks of bipolar outputs that are not
    /// there is the answer.
    pub fn fit(&mut self, switched: impl Fn(usize) -> bool, bipolar: &[usize]) -> bool {
        self.chain.fit(switched);
        let outputs: Vec<&str> = self.wires.iter().map(|wire| wire.operand.as_str()).collect();
        let is_wired = |output: usize| outputs.contains(&format!("O{output}").as_str());
        self.plc.fit(bipolar, is_wired) && bipolar.is_empty()
    }

    /// The name in the description.
    pub fn name(&self) -> &str {
        &self.name
    }

    /// Time since power-on, µs.
    pub fn time_us(&self) -> u64 {
        self.clock.time_us
    }

    /// The names of the keys.
    pub fn keys(&self) -> impl Iterator<Item = &str> {
        self.panel.keys.iter().map(|key| key.name.as_str())
    }

    /// The keys that are held; one that is tapped is let go by itself.
    pub fn held_keys(&self) -> impl Iterator<Item = &str> {
        let held = self.panel.keys.iter().filter(|key| key.is_held());
        held.map(|key| key.name.as_str())
    }

    /// The potentiometers of feed and spindle, %.
    pub fn knobs(&self) -> [f64; 2] {
        let operator = &self.panel.operator;
        [operator.feed_override_percent, operator.spindle_override_percent]
    }

    /// The EMERGENCY STOP button is in.
    pub fn emergency_stop_is_pressed(&self) -> bool {
        self.chain.button
    }

    /// The supply of the control voltage is there.
    pub fn has_supply(&self) -> bool {
        self.chain.supply
    }

    /// The names of the lamps.
    pub fn lamps(&self) -> impl Iterator<Item = &str> {
        self.panel.lamps.iter().map(|(name, _)| name.as_str())
    }

    /// Whether a lamp is lit.
    pub fn lamp(&self, name: &str) -> Option<bool> {
        self.panel.lamp(name, &self.plc.live)
    }

    /// Where everything stands now.
    pub fn mechanics(&self) -> Mechanics {
        self.mechanism.places()
    }

    /// Puts everything where it stood, at rest: the machine at power-on. What does not fit leaves all as it was.
    ///
    /// # Errors
    /// In words, what this machine does not have, or cannot be.
    pub fn stand_at(&mut self, mechanics: &Mechanics) -> Result<(), String> {
        self.mechanism.stand_at(mechanics)?;
        self.rests = false;
        Ok(())
    }

    /// The true state of all axes, in the order of the description.
    pub fn axes(&self) -> impl Iterator<Item = AxisState> {
        self.mechanism.axes.iter().map(Axis::state)
    }

    /// The true state of one axis.
    pub fn axis(&self, letter: char) -> Option<AxisState> {
        self.axes().find(|axis| axis.letter == letter)
    }

    /// Where the table of an axis stands, mm or degrees.
    pub fn position(&self, letter: char) -> Option<f64> {
        let mut axes = self.mechanism.axes.iter();
        axes.find(|axis| axis.letter == letter).map(|axis| axis.table)
    }

    /// The true state of the spindle, or of the first one.
    pub fn spindle(&self) -> Option<SpindleState> {
        self.spindles().next()
    }

    /// The true state of all spindles, in the order of the description.
    pub fn spindles(&self) -> impl Iterator<Item = SpindleState> {
        self.mechanism.spindles.iter().map(Spindle::state)
    }

    /// The state of all things with two states.
    pub fn devices(&self) -> impl Iterator<Item = DeviceState<'_>> {
        self.mechanism.devices.iter().map(Device::state)
    }

    /// The state of one of them.
    pub fn device(&self, name: &str) -> Option<DeviceState<'_>> {
        self.devices().find(|device| device.name == name)
    }

    /// Where the tools of the magazine are; `None` without one.
    pub fn magazine(&self) -> Option<MagazineState<'_>> {
        let magazine = self.mechanism.magazine.as_ref()?;
        Some(magazine.state(&self.mechanism.devices))
    }

    /// The tools lie in the magazine as its operator has put them there: pocket and tool, and the tool in the spindle.
    pub fn load_magazine(&mut self, tools: impl Iterator<Item = (u16, u32)>, spindle: u32) {
        self.rests = false;
        if let Some(magazine) = &mut self.mechanism.magazine {
            magazine.load(tools, spindle);
        }
        self.mechanism.by_hand.insert(spindle);
    }

    /// A tool was called and its change is confirmed: unless the magazine has changed it, who stands at the machine has.
    pub fn tool_is_called(&mut self, tool: u32) {
        self.rests &= !self.mechanism.by_hand.called(tool);
    }

    /// Number of the tool in the spindle, whether magazine or operator has put it there.
    fn tool_in_spindle(&self) -> u32 {
        match &self.mechanism.magazine {
            Some(magazine) if magazine.has_changed => magazine.tool_in_spindle(),
            _ => self.mechanism.by_hand.tool(),
        }
    }

    /// The relay of the EMERGENCY STOP chain has closed: the control voltage is on.
    pub fn control_voltage(&self) -> bool {
        self.chain.voltage()
    }

    /// What it puts into the EMERGENCY STOP chain of another machine.
    pub fn interlock(&self) -> Interlock {
        let limits_clear = !self.chain.watches_limits() || self.limit_switches_clear();
        self.chain.interlock(limits_clear)
    }

    /// Another machine is in its EMERGENCY STOP chain, with contacts that stand so from now on. The chain opens `delay_ms`
    /// after the other control is not ready, and `input` is 1 while the other has control voltage.
    pub fn couple(&mut self, other: Interlock, delay_ms: u32, input: Option<usize>) {
        self.chain.couple(other, delay_ms, input);
    }

    /// The probe is a tool, too, on some machines.
    fn hold_probe(&mut self) {
        if self.mechanism.probe.is_none() {
            return;
        }
        let (tool, angle) = (self.tool_in_spindle(), self.mechanism.spindle_deg());
        if let Some(probe) = &mut self.mechanism.probe {
            probe.is_held(tool, angle);
        }
    }

    /// Contacts, relays and things: once in a millisecond. `limits_clear`: no limit switch is actuated then.
    fn tick(&mut self, limits_clear: bool) {
        self.rests &= !self.panel.advance();
        self.hold_probe();
        let key = self.voltage_key.is_some_and(|place| self.panel.pressed(place));
        let switches = self.chain.advance(limits_clear, key);
        if self.rests && !switches {
            return;
        }
        self.plc.live = self.chain.live(&self.plc.outputs);
        let voltage = self.chain.voltage();
        cabinet::set_contacts(&self.mechanism, &self.panel, voltage, &mut self.plc.live);
        let mut moves = false;
        for device in &mut self.mechanism.devices {
            moves |= device.advance(&self.plc.live);
        }
        if let Some(magazine) = &mut self.mechanism.magazine {
            moves |= magazine.advance(&self.plc.live, &mut self.mechanism.devices);
        }
        for axis in &mut self.mechanism.axes {
            moves |= axis.set_power(voltage, self.chain.control_ready, &self.plc.live);
            axis.clamped = self
                .mechanism
                .devices
                .iter()
                .any(|device| device.clamps == Some(axis.letter) && device.is_forth());
        }
        for spindle in &mut self.mechanism.spindles {
            spindle.set_power(voltage, &self.plc.live);
            moves |= spindle.shift(&self.plc.live);
        }
        self.rests = !moves;
    }
}

impl Plant for Machine {
    fn exchange(&mut self, step: Step, commands: &Commands, measured: &mut Measured) {
        self.take_nominals(commands);
        self.set_outputs(&commands.outputs);
        self.set_control_ready(commands.control_ready);
        measured.control_ready_changed_at = self.pass(step.length_us);
        self.read_encoders(measured);
        measured.control_ready = self.control_ready();
        if commands.reads_inputs {
            self.inputs(&mut measured.inputs);
        }
        measured.operator = self.panel.operator;
        measured.probe = self.touch_probe();
        measured.tool_probe = self.tool_probe();
        measured.buffer_battery_low = self.memory.battery_low;
        measured.memory_defective = self.memory.defective;
        measured.volts = self.plc.volts;
        measured.temperatures = self.plc.temperatures;
    }
}

impl Machine {
    /// The voltage of each drive: by the drives, of which there are fewer than connectors.
    fn take_nominals(&mut self, commands: &Commands) {
        let volts = |output: usize| {
            commands
                .axes
                .get(output)
                .map_or(0.0, |command| limited(command.volts))
        };
        for axis in &mut self.mechanism.axes {
            axis.volts = volts(axis.output);
        }
        for spindle in &mut self.mechanism.spindles {
            spindle.volts = volts(spindle.output);
        }
    }

    /// What the encoders answer; inputs without encoder stay as they are.
    fn read_encoders(&mut self, measured: &mut Measured) {
        let again = !std::mem::take(&mut self.clock.moved_on);
        for axis in &mut self.mechanism.axes {
            let input = axis.counter.as_ref().map(|counter| counter.input);
            if let Some(read) = input.and_then(|input| measured.encoders.get_mut(input)) {
                axis.read_encoder(again, read);
            }
            if axis.has_motor_encoder()
                && let Some(motor) = measured.motors.get_mut(axis.output)
            {
                *motor = axis.motor_count();
            }
        }
        for spindle in &mut self.mechanism.spindles {
            let input = spindle.counter.as_ref().map(|counter| counter.input);
            if let Some(read) = input.and_then(|input| measured.encoders.get_mut(input)) {
                spindle.read_encoder(again, read);
            }
        }
    }
}

/// A nominal value as a converter puts it out, V.
fn limited(volts: f64) -> f64 {
    if volts.is_finite() {
        volts.clamp(-10.0, 10.0)
    } else {
        0.0
    }
}

/// The plug connectors one by one, for whoever tries the machine without a control.
impl Machine {
    /// Lets time pass with everything as last set, in µs.
    pub fn advance(&mut self, micros: u32) {
        self.pass(micros);
    }

    /// Lets time pass; after how many µs the acknowledgement "control is ready" changed first.
    fn pass(&mut self, micros: u32) -> Option<u32> {
        let (before, mut changed_at) = (self.control_ready(), None);
        self.clock.add(micros);
        while let Some(span) = self.clock.next_span(self.ticks_at_once()) {
            let mut clear = u32::MAX;
            for axis in &mut self.mechanism.axes {
                clear &= axis.run(span, self.clock.step_s);
            }
            for spindle in &mut self.mechanism.spindles {
                spindle.run(span.steps, self.clock.step_s);
            }
            for tick in 0..span.ticks() {
                self.tick(clear >> tick & 1 != 0);
                if changed_at.is_none() && self.control_ready() != before {
                    changed_at = Some(micros.saturating_sub(self.clock.pending_us()));
                }
            }
        }
        changed_at
    }

    /// How many ticks each axis may go through before another part looks: all in which contacts, relays and things stay as they
    /// are, whatever the axes do. Most of the time that is so.
    fn ticks_at_once(&self) -> u32 {
        let rests = self.rests && !self.panel.is_tapped() && !self.plc.has_faults();
        match rests {
            true => self.chain.steady_ms().clamp(1, u32::BITS),
            false => 1,
        }
    }

    /// Sets a nominal value output, V.
    pub fn set_nominal(&mut self, output: usize, volts: f64) {
        let volts = limited(volts);
        for axis in self
            .mechanism
            .axes
            .iter_mut()
            .filter(|axis| axis.output == output)
        {
            axis.volts = volts;
        }
        for spindle in self
            .mechanism
            .spindles
            .iter_mut()
            .filter(|spindle| spindle.output == output)
        {
            spindle.volts = volts;
        }
    }

    /// Reads an encoder input.
    pub fn encoder(&mut self, input: usize) -> Encoder {
        let mut read = Encoder::default();
        let at = |counter: &Option<crate::encoder::Counter>| {
            counter.as_ref().is_some_and(|counter| counter.input == input)
        };
        if let Some(axis) = self.mechanism.axes.iter_mut().find(|axis| at(&axis.counter)) {
            axis.read_encoder(false, &mut read);
        } else if let Some(spindle) = self
            .mechanism
            .spindles
            .iter_mut()
            .find(|spindle| at(&spindle.counter))
        {
            spindle.read_encoder(false, &mut read);
        }
        read
    }

    /// Reads the PLC inputs.
    pub fn inputs(&self, inputs: &mut [bool; INPUTS]) {
        inputs.fill(false);
        self.panel.set_inputs(inputs);
        self.chain.set_inputs(inputs);
        for axis in &self.mechanism.axes {
            axis.set_inputs(inputs);
        }
        for spindle in &self.mechanism.spindles {
            spindle.set_inputs(inputs);
        }
        for device in &self.mechanism.devices {
            device.set_inputs(inputs);
        }
        if let Some(magazine) = &self.mechanism.magazine {
            magazine.set_inputs(inputs);
        }
        self.plc.set_inputs(inputs);
        self.plc.set_stuck(inputs, self.clock.time_us);
    }

    /// Sets the PLC outputs.
    pub fn set_outputs(&mut self, outputs: &[bool; OUTPUTS]) {
        if self.plc.outputs != *outputs {
            self.plc.outputs = *outputs;
            self.rests = false;
        }
    }

    /// The PLC outputs as they were set last.
    pub fn outputs(&self) -> &[bool; OUTPUTS] {
        &self.plc.outputs
    }

    /// Switches the output X41/34 "control is ready".
    pub fn set_control_ready(&mut self, on: bool) {
        self.rests &= self.chain.control_ready == on;
        self.chain.control_ready = on;
    }

    /// The acknowledgement at X42/4.
    pub fn control_ready(&self) -> bool {
        self.plc.acknowledged(&self.chain, self.clock.time_us)
    }

    /// No limit switch of an axis is actuated.
    pub fn limit_switches_clear(&self) -> bool {
        self.mechanism.axes.iter().all(Axis::limits_clear)
    }

    /// The tool probe; none is never ready. It knows the tool that the magazine or a hand has put into the spindle.
    pub fn tool_probe(&self) -> Touch {
        let Some(probe) = &self.tool_probe else {
            return Touch::default();
        };
        let deflected = self
            .probe_place()
            .is_some_and(|place| probe.deflected(self.tool_in_spindle(), place, || self.spindle()));
        Touch {
            deflected,
            ready: probe.ready,
            deflection_mm: [0.0; 3],
            battery_low: false,
        }
    }

    /// Where the axes X, Y and Z stand, which both probes need.
    fn probe_place(&self) -> Option<[f64; 3]> {
        let [x, y, z] = self.probe_axes;
        let at = |place: Option<usize>| Some(self.mechanism.axes.get(place?)?.table);
        Some([at(x)?, at(y)?, at(z)?])
    }

    /// The touch probe; none is never ready.
    pub fn touch_probe(&self) -> Touch {
        let Some(probe) = &self.mechanism.probe else {
            return Touch::default();
        };
        if !probe.inserted {
            return Touch {
                battery_low: probe.battery_low,
                ..Touch::default()
            };
        }
        let place = self.probe_place();
        let deflected =
            place.is_some_and(|place| probe.deflected(place, self.mechanism.spindle_deg())) || probe.early;
        Touch {
            deflected,
            ready: probe.ready,
            battery_low: probe.battery_low,
            deflection_mm: place.map_or([0.0; 3], |place| {
                probe.deflection(place, self.mechanism.spindle_deg())
            }),
        }
    }

    /// The radius of the ball of the touch probe, mm; `None` without one.
    pub fn probe_radius_mm(&self) -> Option<f64> {
        self.mechanism.probe.as_ref().map(Probe::radius_mm)
    }

    /// Puts a solid on the table that the touch probe can touch, in place of the last one, or takes it away.
    pub fn put_on_table(&mut self, solid: Option<Arc<dyn Solid>>) {
        if let Some(probe) = &mut self.mechanism.probe {
            probe.put(solid);
        }
    }
}

pub(crate) fn set<T>(list: &mut [T], index: usize, value: T) {
    if let Some(place) = list.get_mut(index) {
        *place = value;
    }
}
