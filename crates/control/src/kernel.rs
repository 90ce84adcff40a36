//! The kernel: machine side and channels under one clock, a count of microseconds. It orders what happens in a
//! servo step, a contour cycle and a PLC scan, and decides nothing.

use bahn_parameters::MessageId;
use bahn_plc::{Tracer, mirror_parameters};
use bahn_servo::{Commands, Plant, Step};

use crate::axes::{Axes, first_ids, units};
use crate::axis::AxisUnit;
use crate::channel::{Channel, Parts};
use crate::command::Command;
use crate::compensation::Compensation;
use crate::datum_tables::LoadedDatums;
use crate::hand_over::Ordered;
use crate::kinematics::Cartesian;
use crate::machine::{CircuitOrder, MachineParts, MachineSide, PlcUnit};
use crate::magazine::Magazine;
use crate::message::Message;
use crate::per_channel::PerChannel;
use crate::plc_link::{PalletSelection, PlcLink};
use crate::sampling::{ServoSampler, ServoView};
use crate::seam::Seam;
use crate::setup::{ChannelError, ChannelSetup, Remembered, Setup};
use crate::source::Reading;
use crate::spindle::{SpindleUnit, SpindleWiring};
use crate::tables::LoadedTables;

/// What runs while the supply is on.
#[derive(Clone)]
pub(crate) struct Kernel {
    pub now_us: u64,
    pub machine: MachineSide,
    pub channels: PerChannel<Channel>,
    pub seam: Seam,
    /// Tool changes and datums must be stored before their strobe is reset.
    pub keeps: bool,
    /// The axes that the PLC may hand over.
    pub ordered: Vec<Ordered>,
}

fn take_offsets(axes: &mut Axes, channel: usize, remembered: &Remembered) {
    for unit in axes.of(channel).iter_mut() {
        let volts = remembered.offsets_volts.get(unit.index).copied();
        unit.servo.set_offset_compensation(volts.unwrap_or(0.0));
    }
}

impl Kernel {
    /// A kernel of one channel at power-on.
    pub fn new(setup: Setup) -> Kernel {
        let axes = units(&setup.parameters, (0, 0), first_ids());
        Kernel::build(setup, Vec::new(), axes)
    }

    /// A kernel of one channel or several at power-on.
    ///
    /// # Errors
    /// Why the channels cannot be put together.
    pub fn with_channels(setup: Setup, others: Vec<ChannelSetup>) -> Result<Kernel, ChannelError> {
        if others.len() >= ChannelError::CHANNELS_MAX {
            return Err(ChannelError::TooMany);
        }
        let mut axes = units(&setup.parameters, (0, 0), first_ids());
        for (channel, other) in (1..).zip(&others) {
            let of = (channel, other.connectors.into());
            axes.extend(units(&other.parameters, of, other.axes));
        }
        let mut ids = std::collections::BTreeSet::new();
        match axes.iter().find(|unit| !ids.insert(unit.id)) {
            Some(twice) => Err(ChannelError::AxisTwice(twice.id)),
            None => Ok(Kernel::build(setup, others, axes)),
        }
    }

    fn build(setup: Setup, others: Vec<ChannelSetup>, units: Vec<AxisUnit>) -> Kernel {
        let Setup {
            parameters,
            plc,
            plc_messages,
            plc_dialogues,
            tools,
            checking,
            inch_feed,
            functions,
            programs,
            files,
            remembered,
            mut exchange,
        } = setup;
        let model = parameters.model();
        let timing = model.timing();
        let mut axes = Axes::new(units, timing);
        take_offsets(&mut axes, 0, &remembered);
        for (channel, other) in (1..).zip(&others) {
            take_offsets(&mut axes, channel, &other.remembered);
        }
        mirror_parameters(&parameters, &mut exchange);
        let spindle = SpindleUnit::new(SpindleWiring::default(), parameters.spindle_parameters(), timing);
        let mut link = PlcLink::new(parameters.clone(), plc_messages, plc_dialogues, files);
        link.selected_list.clone_from(&remembered.parameter_list);
        link.pallet = PalletSelection {
            line: remembered.pallet_line,
            datum_table: remembered.datum_table.clone(),
        };
        let loaded_datums = LoadedDatums::set_up(&mut link, &remembered.written_datums);
        let mut magazine = Magazine::new(tools, &remembered.pockets);
        let loaded_tables = LoadedTables::set_up(
            &mut magazine,
            &mut link.files,
            &remembered.written,
            parameters.operation_parameters().tools.pockets,
        );
        let compensation = Compensation::at_power_on(&link.files, remembered.compensation_line);
        let parts = MachineParts {
            plc: PlcUnit::new(plc, model),
            link,
            exchange,
            windows: others.iter().map(|other| other.window.clone()).collect(),
            axes,
            compensation,
            spindle,
            magazine,
            loaded_tables,
            loaded_datums,
        };
        let mut machine = MachineSide::new(&parameters, parts);
        let reading = Reading {
            model,
            checking,
            inch_feed,
            functions,
            programs,
        };
        let parts = Parts {
            number: 0,
            own_list: None,
            kinematics: std::sync::Arc::new(Cartesian),
            reading: reading.clone(),
        };
        let first = Channel::new(parts, &remembered, &mut machine);
        let mut channels = PerChannel::new(first, Vec::new());
        for other in others {
            let channel = beside(other, channels.count(), &reading, &mut machine);
            channels.push(channel);
        }
        let mut kernel = Kernel {
            now_us: 0,
            machine,
            channels,
            seam: Seam::default(),
            keeps: false,
            ordered: Vec::new(),
        };
        kernel.show_power_interrupted();
        kernel
    }

    /// Spends a contour cycle on a machine, shows a tracer what the PLC executes in it, and a sampler the axes in each
    /// servo step. While the supply is off, time passes on the machine alone.
    pub fn cycle(
        &mut self,
        is_off: bool,
        plant: &mut dyn Plant,
        mut tracer: Option<&mut (dyn Tracer + '_)>,
        mut sampler: Option<&mut (dyn ServoSampler + '_)>,
    ) {
        if is_off {
            // The outputs are off.
            self.seam.commands = Commands::default();
        }
        // Somebody may have touched the machine meanwhile.
        self.exchange_with(plant, 0);
        for step in 0..self.machine.timing.steps() {
            if !is_off {
                self.servo_step(step == 0, reborrow(&mut tracer));
                if let Some(sampler) = &mut sampler {
                    sampler.sample(self.now_us, &ServoView(&self.machine.axes));
                }
            }
            self.exchange_with(plant, self.machine.timing.step_us());
        }
    }

    /// One servo step: a contour cycle begins with the first of its steps, a PLC scan with the first step
    /// at or after its time.
    fn servo_step(&mut self, first: bool, tracer: Option<&mut (dyn Tracer + '_)>) {
        let machine = &mut self.machine;
        machine.begin_step(self.now_us, &self.seam.measured, &mut self.seam.commands);
        for channel in self.channels.iter_mut() {
            channel.watch_probe(machine, &self.seam.measured);
        }
        if machine.scan_is_due(self.now_us) {
            self.scan(tracer);
        }
        if first {
            self.contour_cycle();
        }
        self.machine.output(&mut self.seam.commands);
    }

    /// Lets time pass on the machine, µs.
    fn exchange_with(&mut self, plant: &mut dyn Plant, length_us: u32) {
        let step = Step {
            from_us: self.now_us,
            length_us,
        };
        let before = self.seam.measured.control_ready;
        let behind_us = self.now_us + u64::from(length_us);
        self.seam.commands.reads_inputs = self.machine.looks_at_inputs(behind_us);
        plant.exchange(step, &self.seam.commands, &mut self.seam.measured);
        if length_us > 0 {
            self.machine.emergency.pass(step, before, &self.seam.measured);
            self.now_us += u64::from(length_us);
            self.machine.messages.set_time(self.now_us);
        }
    }

    /// A PLC scan: inputs in, program, outputs out, then what the PLC asks for.
    fn scan(&mut self, tracer: Option<&mut (dyn Tracer + '_)>) {
        let machine = &mut self.machine;
        machine.read_inputs(&self.seam.measured);
        let operator = self.seam.measured.operator;
        for channel in self.channels.iter_mut() {
            channel.publish(&operator, machine);
        }
        machine.link.program_running = self.channels.iter().any(|channel| channel.run.is_active());
        self.channels.first().inform(machine);
        let block = self.channels.first().run.running_block();
        if !machine.scan(block, tracer) {
            return;
        }
        machine.write_outputs(&mut self.seam.commands);
        for channel in self.channels.iter_mut() {
            channel.after_scan(machine);
        }
        let block = self.channels.first().run.running_block();
        machine.messages.follow_plc(machine.memory.first(), block);
        let first = self.channels.first().number();
        let spindle = machine.spindles.of_mut(first);
        spindle.take_requests(&mut machine.link.requests);
        for channel in self.channels.iter_mut() {
            channel.take_strobes(machine);
        }
        self.take_module_requests();
    }

    /// What modules asked for in a scan.
    fn take_module_requests(&mut self) {
        let machine = &mut self.machine;
        self.channels.first_mut().take_module_requests(machine);
        machine.reset_wanted |= std::mem::take(&mut machine.link.requests.restart);
        if let Some(line) = machine.link.requests.compensation_line.take() {
            machine.compensation = Compensation::of(&machine.link.files, usize::try_from(line).ok());
            machine.unsaved = true;
        }
        if std::mem::take(&mut machine.link.requests.parameters_changed) {
            machine.take_parameters();
            self.channels.first_mut().take_parameters(machine);
        }
    }

    /// What is decided once in each contour cycle.
    fn contour_cycle(&mut self) {
        self.follow_circuit();
        let machine = &mut self.machine;
        let monitoring_off = machine.monitoring_is_off(&self.seam.measured);
        for channel in self.channels.iter_mut() {
            channel.follow_loops(monitoring_off, machine);
        }
        for channel in self.channels.iter_mut() {
            channel.take_faults(machine);
        }
        if machine.loops_closed {
            for channel in self.channels.iter_mut() {
                channel.move_axes(machine, &self.seam.measured);
            }
            let time_s = f64::from(machine.timing.contour_us()) * 1e-6;
            machine.axes.command(time_s);
            for channel in self.channels.iter_mut() {
                channel.settle(&mut machine.axes);
            }
        } else {
            machine.axes.pass();
            for channel in self.channels.iter_mut() {
                channel.forget_input(&self.seam.measured);
            }
        }
        for channel in self.channels.iter_mut() {
            channel.follow_plc(self.keeps, machine);
        }
        for unit in machine.axes.iter_mut() {
            unit.count();
        }
        machine.look_after(&self.seam.measured);
    }

    /// Follows the "control is ready" circuit.
    fn follow_circuit(&mut self) {
        let machine = &mut self.machine;
        let order = machine.follow_circuit(self.channels.first().run.running_block());
        if matches!(order, CircuitOrder::Stop | CircuitOrder::StopSilently) {
            for channel in self.channels.iter_mut() {
                channel.stop();
            }
        }
        match order {
            CircuitOrder::Nothing => {}
            CircuitOrder::CloseLoops => {
                machine.close_loops();
                for channel in self.channels.iter_mut() {
                    channel.loops_closed(&mut machine.axes);
                }
            }
            CircuitOrder::OpenLoops => self.open_loops(),
            CircuitOrder::StopSilently => {
                self.open_loops();
                self.machine.end_silent_stop();
            }
            CircuitOrder::Stop => {
                machine.show_emergency_stop(self.channels.first().run.running_block());
                machine.axes.begin_shutdown();
                let mut stand = true;
                for channel in self.channels.iter_mut() {
                    stand &= channel.end_for_emergency(machine);
                }
                if machine.loops_closed && stand {
                    self.open_loops();
                }
            }
        }
    }

    fn open_loops(&mut self) {
        for channel in self.channels.iter_mut() {
            channel.loops_opened(&mut self.machine);
        }
        self.machine.open_loops();
    }

    /// A command for a channel; `false` when it is not possible now.
    pub fn execute(&mut self, channel: usize, command: Command) -> bool {
        self.channels.of_mut(channel).execute(command, &mut self.machine)
    }

    /// After power-on, if the machine builder wants it so.
    pub fn show_power_interrupted(&mut self) {
        let operation = self.machine.link.list().operation_parameters();
        if operation.power_interrupted {
            let message = Message::Plain(MessageId::PowerInterrupted);
            self.machine.messages.of_machine().show(message, None);
        }
    }

    /// It is the same control that was on before: its time goes on, and whoever drives it does as before.
    pub fn follow_on(&mut self, before: &Kernel) {
        self.now_us = before.now_us;
        self.machine.messages.restart(before.machine.messages.time_us());
        self.machine.link.keep_lines(&before.machine.link);
        self.keeps = before.keeps;
        self.ordered.clone_from(&before.ordered);
        for (new, old) in self.channels.iter_mut().zip(before.channels.iter()) {
            new.run.source.tap = old.run.source.tap;
            new.run.source.defers = old.run.source.defers;
            new.run.block_time.clone_from(&old.run.block_time);
        }
    }

    /// Interprets and plans ahead; may allocate.
    pub fn prepare(&mut self) {
        for ordered in &mut self.ordered {
            ordered.follow(&mut self.channels, &mut self.machine);
        }
        let datums_changed = std::mem::take(&mut self.machine.loaded_datums.changed);
        for channel in self.channels.iter_mut() {
            channel.prepare(datums_changed, &mut self.machine);
        }
    }
}

/// A tracer for one of several scans.
fn reborrow<'a>(tracer: &'a mut Option<&mut (dyn Tracer + '_)>) -> Option<&'a mut (dyn Tracer + 'a)> {
    match tracer {
        Some(tracer) => Some(&mut **tracer),
        None => None,
    }
}

/// A channel beside the first one, with its spindle.
fn beside(setup: ChannelSetup, number: usize, reading: &Reading, machine: &mut MachineSide) -> Channel {
    let parameters = setup.parameters.spindle_parameters();
    let spindle = SpindleUnit::new(setup.spindle, parameters, machine.timing);
    machine.spindles.push(spindle);
    let parts = Parts {
        number,
        own_list: Some(setup.parameters),
        kinematics: setup.kinematics,
        reading: Reading {
            programs: setup.programs,
            ..reading.clone()
        },
    };
    Channel::new(parts, &setup.remembered, machine)
}
