//! The kernel: machine side and channels under one clock, a count of microseconds. It orders what happens in a
//! servo step, a contour cycle and a PLC scan, and decides nothing.

use std::sync::Arc;

use bahn_exchange::{Exchange, Image};
use bahn_interpreter::{Done, Work};
use bahn_parameters::MessageId;
use bahn_plc::{Tracer, mirror_parameters};
use bahn_servo::{Commands, Plant, Step, Timing};

use crate::axes::{Axes, first_ids, units};
use crate::axis::AxisUnit;
use crate::beside::ReadAhead;
use crate::channel::{Channel, Parts};
use crate::command::Command;
use crate::compensation::Compensation;
use crate::datum_tables::LoadedDatums;
use crate::hand_over::{HandOver, Ordered};
use crate::kinematics::Cartesian;
use crate::machine::{CircuitOrder, MachineParts, MachineSide, PlcUnit};
use crate::magazine::Magazine;
use crate::markers::AXES;
use crate::message::Message;
use crate::per_channel::PerChannel;
use crate::plc_link::{PalletSelection, PlcLink};
use crate::seam::Seam;
use crate::setup::{ChannelError, ChannelSetup, Remembered, Setup};
use crate::snapshot::Snapshot;
use crate::source::Reading;
use crate::spindle::{SpindleUnit, SpindleWiring};
use crate::tables::LoadedTables;
use crate::test_run::{TestReport, TestRun};
use crate::upkeep::by_index;
use crate::view::{ChannelView, offsets_volts};

/// Commands that are kept at most until they are taken.
const LOG_MAX: usize = 100_000;

/// A control with its PLC, axes and programs. The machine comes with every cycle.
///
/// [`Control::prepare`] interprets and plans ahead and may allocate; [`Control::cycle`] spends one contour
/// cycle and does not. Both are called in turn. The same setup, commands and plant give the same bits; a clone goes on
/// as the control would have done.
#[derive(Clone)]
pub struct Control {
    pub(crate) now_us: u64,
    pub(crate) machine: MachineSide,
    pub(crate) channels: PerChannel<Channel>,
    pub(crate) seam: Seam,
    /// Tool changes and datums must be stored before their strobe is reset.
    pub(crate) keeps: bool,
    /// The axes that the PLC may hand over.
    pub(crate) ordered: Vec<Ordered>,
    /// The commands with their channels, when somebody wants them.
    pub(crate) log: Option<Vec<(u64, usize, Command)>>,
    pub(crate) supply: Supply,
}

fn take_offsets(axes: &mut Axes, channel: usize, remembered: &Remembered) {
    for unit in axes.of(channel).iter_mut() {
        let volts = remembered.offsets_volts.get(unit.index).copied();
        unit.servo.set_offset_compensation(volts.unwrap_or(0.0));
    }
}

/// The power supply, and what the control is made of when it comes.
#[derive(Clone)]
pub(crate) struct Supply {
    pub made_of: Arc<(Setup, Vec<ChannelSetup>)>,
    pub off: bool,
    /// How often the control has begun.
    pub starts: u32,
}

impl Control {
    /// A control of one channel at power-on. The PLC does not run yet, and the loops are open.
    pub fn new(setup: Setup) -> Control {
        let axes = units(&setup.parameters, (0, 0), first_ids());
        Control::build(setup, Vec::new(), axes)
    }

    /// A control of several channels at power-on: the first one and those beside it. All run under one clock, with
    /// one PLC and one EMERGENCY STOP.
    ///
    /// # Errors
    /// Why the channels cannot be put together.
    pub fn with_channels(setup: Setup, others: Vec<ChannelSetup>) -> Result<Control, ChannelError> {
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
            None => Ok(Control::build(setup, others, axes)),
        }
    }

    fn build(setup: Setup, others: Vec<ChannelSetup>, units: Vec<AxisUnit>) -> Control {
        let made_of = Arc::new((setup.clone(), others.clone()));
        let Setup {
            parameters,
            plc,
            plc_messages,
            plc_dialogues,
            tools,
            checking,
            inch_feed,
            programs,
            files,
            remembered,
            mut exchange,
        } = setup;
        let model = parameters.model();
        let timing = Timing::of(model);
        let operation = parameters.operation_parameters();
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
        let loaded_tables = LoadedTables::set_up(&mut magazine, &mut link.files, &remembered.written);
        let parts = MachineParts {
            plc: PlcUnit::new(plc, model),
            link,
            exchange,
            windows: others.iter().map(|other| other.window.clone()).collect(),
            axes,
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
        if operation.power_interrupted {
            machine
                .messages
                .show(Message::Plain(MessageId::PowerInterrupted), false, None);
        }
        Control {
            now_us: 0,
            machine,
            channels,
            seam: Seam::default(),
            keeps: false,
            ordered: Vec::new(),
            log: None,
            supply: Supply {
                made_of,
                off: false,
                starts: 1,
            },
        }
    }

    /// Channels that it has; they are numbered from 0.
    pub fn channels(&self) -> usize {
        self.channels.count()
    }

    /// A channel as of now, by its number from 0.
    pub fn channel(&self, number: usize) -> Option<ChannelView<'_>> {
        let channel = self.channels.get(number)?;
        Some(ChannelView::new(channel, &self.machine, &self.seam))
    }

    /// The first channel as of now.
    pub fn first(&self) -> ChannelView<'_> {
        ChannelView::new(self.channels.first(), &self.machine, &self.seam)
    }

    /// The state of a channel as of now.
    pub fn snapshot_of(&self, channel: usize) -> Option<Snapshot> {
        self.channel(channel).map(|channel| channel.snapshot())
    }

    /// From now on the PLC orders by these markers that axes go to other channels.
    pub fn hand_over_by(&mut self, hand_overs: Vec<HandOver>) {
        self.ordered = hand_overs.into_iter().map(Ordered::new).collect();
    }

    /// Time since power-on, µs.
    pub fn time_us(&self) -> u64 {
        self.now_us
    }

    /// The contour cycle, µs.
    pub fn cycle_us(&self) -> u32 {
        self.machine.timing.contour_us()
    }

    /// Spends one contour cycle on a machine. It does not allocate unless something out of the ordinary
    /// happens: a message, a fault.
    pub fn cycle(&mut self, plant: &mut dyn Plant) {
        self.cycle_traced(plant, None);
    }

    /// Spends a contour cycle and shows a tracer what the PLC executes in it. A traced scan does what any other one
    /// does, in the reference interpreter.
    pub fn cycle_traced(&mut self, plant: &mut dyn Plant, mut tracer: Option<&mut (dyn Tracer + '_)>) {
        if self.supply.off {
            // The outputs are off.
            self.seam.commands = Commands::default();
        }
        // Somebody may have touched the machine meanwhile.
        self.exchange_with(plant, 0);
        for step in 0..self.machine.timing.steps() {
            if !self.supply.off {
                self.servo_step(step == 0, reborrow(&mut tracer));
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
        let block = self.channels.first().running_block();
        if !machine.scan(block, tracer) {
            return;
        }
        machine.write_outputs(&mut self.seam.commands);
        for channel in self.channels.iter_mut() {
            channel.after_scan(machine);
        }
        let block = self.channels.first().running_block();
        machine.messages.follow_plc(machine.memory.first(), block);
        for channel in self.channels.iter_mut() {
            channel.take_strobes(machine);
        }
        self.take_module_requests();
    }

    /// What modules asked for in a scan.
    fn take_module_requests(&mut self) {
        let machine = &mut self.machine;
        self.channels.first_mut().take_module_requests(machine);
        machine.restart_wanted |= std::mem::take(&mut machine.link.requests.restart);
        if let Some(line) = machine.link.requests.compensation_line.take() {
            machine.compensation = Compensation::of(&machine.link.files, usize::try_from(line).ok());
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
            machine.axes.command();
            for channel in self.channels.iter_mut() {
                channel.settle(&mut machine.axes);
            }
        } else {
            for channel in self.channels.iter_mut() {
                channel.forget_start();
            }
        }
        for channel in self.channels.iter_mut() {
            channel.follow_plc(self.keeps, machine);
        }
        for unit in machine.axes.iter_mut() {
            unit.count();
        }
        machine.look_after();
    }

    /// Follows the "control is ready" circuit.
    fn follow_circuit(&mut self) {
        let machine = &mut self.machine;
        let order = machine.follow_circuit(self.channels.first().running_block());
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
                machine.show_emergency_stop(self.channels.first().running_block());
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

    /// Interprets and plans ahead; may allocate. To be called after every cycle.
    pub fn prepare(&mut self) {
        for ordered in &mut self.ordered {
            ordered.follow(&mut self.channels, &mut self.machine);
        }
        let datums_changed = std::mem::take(&mut self.machine.loaded_datums.changed);
        for channel in self.channels.iter_mut() {
            channel.prepare(datums_changed, &mut self.machine);
        }
    }

    /// Leaves computations that take long, as those of an SL contour, to whoever drives the control: runs that
    /// begin from now on wait for [`Control::finish_work`], while everything else goes on.
    pub fn defer_work(&mut self) {
        for channel in self.channels.iter_mut() {
            channel.run.source.defers = true;
        }
    }

    /// A computation to be done beside.
    pub fn take_work(&mut self) -> Option<Work> {
        let mut feeders = self.channels.iter_mut().flat_map(Channel::feeders);
        feeders.find_map(|feeder| feeder.interpreter_mut().take_work())
    }

    /// What a computation came to. It has no effect when what needed it was given up.
    pub fn finish_work(&mut self, done: Done) {
        let mut feeders = self.channels.iter_mut().flat_map(Channel::feeders);
        if let Some(feeder) = feeders.find(|feeder| feeder.interpreter().waits_for(&done)) {
            feeder.interpreter_mut().finish_work(done);
        }
    }

    /// Part programs are read by [`ReadAhead::read`] alone from now on, wherever it is called, or by
    /// [`Control::prepare`] again.
    pub fn read_beside(&mut self, on: bool) {
        for channel in self.channels.iter_mut() {
            channel.run.source.read_beside(on);
        }
    }

    /// The program of a channel that wants to be read ahead. Until it is [back](Control::take_back) the cycles go on with
    /// what was read before; commands that need the program are not possible, a clone of the control is without it,
    /// and [`Control::interpreter`] and [`Control::remember`] do not know what it came to.
    pub fn lend_reading(&mut self) -> Option<ReadAhead> {
        (0..).zip(self.channels.iter_mut()).find_map(|(channel, lender)| {
            let (feeder, loan) = lender.lend()?;
            Some(ReadAhead {
                channel,
                loan,
                feeder,
            })
        })
    }

    /// A program is back that was lent.
    pub fn take_back(&mut self, read: ReadAhead) {
        if read.channel < self.channels.count() {
            let source = &mut self.channels.of_mut(read.channel).run.source;
            source.end_loan(read.feeder, read.loan);
        }
    }

    /// Simulates the block processing time: no more elements of the path are read than the control has time
    /// for, each taking so long, µs. 0 for no time.
    pub fn set_block_time(&mut self, time_us: u32) {
        for channel in self.channels.iter_mut() {
            channel.run.block_time.set(time_us);
        }
    }

    /// Gives a command of the operator to the first channel: [`Control::command_to`].
    pub fn command(&mut self, command: Command) -> bool {
        self.command_to(0, command)
    }

    /// Gives a command of the operator to a channel; it is logged with the time when a log is kept. `false` when it is
    /// not possible now, or there is no such channel.
    pub fn command_to(&mut self, channel: usize, command: Command) -> bool {
        if channel >= self.channels.count() {
            return false;
        }
        if let Some(log) = self.log.as_mut().filter(|log| log.len() < LOG_MAX) {
            log.push((self.now_us, channel, command.clone()));
        }
        self.give(channel, command)
    }

    fn give(&mut self, channel: usize, command: Command) -> bool {
        match (command, self.supply.off) {
            (Command::Power(on), _) => self.switch(on),
            // Nobody is there to say that it is not possible.
            (_, true) => false,
            (Command::Set(assignment), _) => {
                let done = self.set(channel, &assignment);
                done || self.refuse(channel)
            }
            (command, _) => {
                let done = self.channels.of_mut(channel).execute(command, &mut self.machine);
                done || self.refuse(channel)
            }
        }
    }

    /// A command is not possible now.
    fn refuse(&mut self, channel: usize) -> bool {
        let block = self.channels.of(channel).running_block();
        let refused = Message::Plain(MessageId::KeyNonFunctional);
        self.machine
            .messages
            .of_channel(channel)
            .show(refused, false, block);
        false
    }

    /// Keeps the commands from now on, for [`Control::take_command_log`].
    pub fn keep_command_log(&mut self) {
        self.log = Some(Vec::new());
    }

    /// The commands since the last call with their times, µs, and channels: given again they repeat the run.
    /// `None` when they were not kept, or were more than fit before they were taken.
    pub fn take_command_log(&mut self) -> Option<Vec<(u64, usize, Command)>> {
        let log = std::mem::take(self.log.as_mut()?);
        (log.len() < LOG_MAX).then_some(log)
    }

    /// TEST RUN of a program, from its first block; the machine goes on with what it does. Errors are in
    /// [`Control::test_report`]. `false` when there is no such program.
    pub fn test(&mut self, name: &str) -> bool {
        let command = Command::Test(name.to_owned());
        self.channels.first_mut().execute(command, &mut self.machine)
    }

    /// Breaks a test run off, or clears its result.
    pub fn end_test(&mut self) {
        self.channels
            .first_mut()
            .execute(Command::EndTest, &mut self.machine);
    }

    /// The test run that was started last.
    pub fn test_report(&self) -> Option<TestReport> {
        self.channels.first().test().map(TestRun::report)
    }

    /// What the NC sees of the PLC's memory.
    pub fn memory(&self) -> &Image {
        self.machine.memory.first().nc()
    }

    /// The exchanged memory, for the journal of retained markers and bytes.
    pub fn exchange(&self) -> &Exchange {
        self.machine.memory.first()
    }

    /// Lets the end of a tool change wait until what survives power-off is stored: whoever calls
    /// [`Control::prepare`] asks [`Control::unsaved`], writes, and says [`Control::stored`].
    pub fn keep_state(&mut self, keep: bool) {
        self.keeps = keep;
    }

    /// What survives power-off when it has changed since it was stored.
    pub fn unsaved(&self) -> Option<Remembered> {
        self.machine.unsaved.then(|| self.remember())
    }

    /// What survives power-off is on the medium.
    pub fn stored(&mut self) {
        self.machine.unsaved = false;
    }

    /// The name of the list of machine parameters that module 9033 has selected: the control is to be started
    /// anew with it.
    pub fn take_restart(&mut self) -> Option<String> {
        let selected = &self.machine.link.selected_list;
        std::mem::take(&mut self.machine.restart_wanted).then(|| selected.clone())?
    }

    /// What survives power-off, as of now.
    pub fn remember(&self) -> Remembered {
        let link = &self.machine.link;
        Remembered {
            pockets: self.machine.magazine.moved(),
            written: self.machine.loaded_tables.written(&link.files),
            offsets_volts: offsets_volts(&self.machine, 0),
            parameter_list: link.selected_list.clone(),
            pallet_line: link.pallet.line,
            datum_table: link.pallet.datum_table.clone(),
            written_datums: self.machine.loaded_datums.written(link),
            ..self.channels.first().remember()
        }
    }

    /// The offsets that code number 75 368 shows while its dialogue is open, by axis index, in units of
    /// 0.15 mV [000:5014-5016].
    pub fn offsets_shown(&self) -> Option<[i32; AXES]> {
        let axes = self.machine.axes.owned(0);
        let units = by_index(axes, |unit| unit.index, |unit| unit.servo.offset_units());
        self.machine.offsets.shown.then_some(units)
    }

    /// The line of the compensation assignment that is active: it survives power-off [000:15547-15580].
    pub fn compensation_line(&self) -> Option<usize> {
        self.machine.compensation.line
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
