//! The kernel: one state machine whose time is a count of microseconds.

use std::sync::Arc;

use bahn_exchange::{Bit, BitArea, Exchange, Image, Number, signal};
use bahn_interpreter::{Done, Work};
use bahn_motion::{Interpolator, Limits as PathLimits};
use bahn_parameters::{ControlModel, InchFeed, MessageId, OperationParameters, PlcParameters, Station};
use bahn_path::{Axis, BlockRef, Position};
use bahn_plc::{Machine, Start, mirror_parameters};
use bahn_servo::{Commands, Measured, Plant, Step, Timing};

use crate::axes::AxisUnit;
use crate::command::{Command, Mode};
use crate::emergency::EmergencyStop;
use crate::feeder::{Offsets, Programs};
use crate::handshake::{Handshakes, Transfer};
use crate::life::LifeCount;
use crate::manual::Manual;
use crate::markers::AXES;
use crate::message::{Message, Messages};
use crate::overrides::Override;
use crate::panel::Panel;
use crate::plc_link::{PalletSelection, PlcLink};
use crate::positioning::Positioning;
use crate::reference::ReferenceRun;
use crate::run::ProgramRun;
use crate::setup::{Checking, Remembered, Setup};
use crate::spindle::SpindleUnit;
use crate::tables::{LoadedDatums, LoadedTables};
use crate::thread::Tapping;
use crate::tools::Tools;
use crate::upkeep::Upkeep;

/// Elements of the path that are prepared ahead at most.
pub(crate) const LOOK_AHEAD: usize = 512;

/// Commands that are kept at most until they are taken.
const LOG_MAX: usize = 100_000;

/// A control with its PLC, axes and programs. The machine comes with every cycle.
///
/// [`Control::prepare`] interprets and plans ahead and may allocate; [`Control::cycle`] spends one contour
/// cycle and does not. Both are called in turn. The same setup, commands and plant give the same bits.
/// A copy goes on from the same state.
#[derive(Clone)]
pub struct Control {
    pub(crate) model: ControlModel,
    pub(crate) timing: Timing,
    pub(crate) operation: OperationParameters,
    pub(crate) plc_parameters: PlcParameters,
    pub(crate) now_us: u64,
    pub(crate) cycles: u64,
    pub(crate) exchange: Exchange,
    pub(crate) link: PlcLink,
    pub(crate) plc: PlcUnit,
    pub(crate) emergency: EmergencyStop,
    pub(crate) messages: Messages,
    pub(crate) panel: Panel,
    /// NC start was pressed and not yet used.
    pub(crate) start_pressed: bool,
    pub(crate) handshakes: Handshakes,
    pub(crate) axes: Vec<AxisUnit>,
    /// The index into `axes` of each axis index.
    pub(crate) places: [Option<usize>; AXES],
    pub(crate) spindle: SpindleUnit,
    pub(crate) feed_override: Override,
    pub(crate) spindle_override: Override,
    pub(crate) mode: Mode,
    /// The loops were closed since the control voltage came on.
    pub(crate) loops_closed: bool,
    pub(crate) manual: Manual,
    pub(crate) reference: ReferenceRun,
    pub(crate) positioning: Positioning,
    pub(crate) run: ProgramRun,
    pub(crate) path: Interpolator<crate::feeder::RunFault>,
    pub(crate) offsets: Offsets,
    /// Machine position of the workpiece datum for each traverse range.
    pub(crate) datums: [Position; 3],
    /// Datum correction by the PLC, mm or degrees.
    pub(crate) correction: [f64; AXES],
    /// Active traverse range, 0 to 2.
    pub(crate) range: usize,
    pub(crate) tools: Tools,
    pub(crate) checking: Checking,
    pub(crate) upkeep: Upkeep,
    pub(crate) stylus: crate::probing::Stylus,
    pub(crate) tapping: Tapping,
    pub(crate) test: Option<crate::test_run::TestRun>,
    /// Tool changes and datums must be stored before their strobe is reset.
    keeps: bool,
    /// What is to be stored has changed since [`Control::stored`].
    pub(crate) unsaved: bool,
    /// Of the tool in the spindle.
    pub(crate) life: LifeCount,
    /// What F counts in a program in inches, when that is not what it counts on the model.
    pub(crate) inch_feed: Option<InchFeed>,
    pub(crate) programs: Arc<dyn Programs>,
    /// Q parameters between runs.
    pub(crate) q: Vec<(u16, f64)>,
    pub(crate) loaded_tables: LoadedTables,
    pub(crate) loaded_datums: LoadedDatums,
    /// The commands, when somebody wants them.
    log: Option<Vec<(u64, Command)>>,
    commands: Commands,
    pub(crate) measured: Measured,
    output_bits: Vec<(usize, Bit)>,
    input_bits: Vec<(usize, Bit)>,
    pub(crate) letters: [char; AXES],
}

/// The PLC and its clock.
#[derive(Clone)]
pub(crate) struct PlcUnit {
    pub machine: Machine,
    pub due_us: u64,
    pub period_us: u64,
    /// Scans that were started.
    pub scans: u64,
}

impl Control {
    /// A control at power-on. The PLC does not run yet, and the loops are open.
    pub fn new(setup: Setup) -> Control {
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
        let axes: Vec<AxisUnit> = (0..AXES)
            .filter_map(|index| {
                let index = u8::try_from(index).ok()?;
                AxisUnit::new(parameters.axis_parameters(index), timing)
            })
            .collect();
        let mut axes = crate::gantry::couple(axes, timing);
        for unit in &mut axes {
            let volts = remembered.offsets_volts.get(unit.index).copied();
            unit.servo.set_offset_compensation(volts.unwrap_or(0.0));
        }
        let parameters_interval_s = axes
            .first()
            .map_or(0.0, |unit| unit.parameters.output.offset_interval_s);
        let mut places = [None; AXES];
        let mut letters = ['X', 'Y', 'Z', '4', '5'];
        for (place, unit) in axes.iter().enumerate() {
            if let (Some(slot), Some(letter)) = (places.get_mut(unit.index), letters.get_mut(unit.index)) {
                *slot = Some(place);
                *letter = unit.axis.letter();
            }
        }
        mirror_parameters(&parameters, &mut exchange);
        let path_limits = path_limits(&parameters, &axes);
        let bits = |area: BitArea, boards: &[(u16, u16)]| {
            let numbers = boards.iter().flat_map(|(first, last)| *first..=*last);
            numbers
                .filter_map(|number| Some((usize::from(number), Bit::new(area, number)?)))
                .collect()
        };
        let datums = remembered.datums.map(|datum| datum.0);
        let [first, ..] = datums;
        let mut control = Control {
            model,
            timing,
            operation,
            plc_parameters: parameters.plc_parameters(),
            now_us: 0,
            cycles: 0,
            exchange,
            spindle: SpindleUnit::new(parameters.spindle_parameters(), timing),
            tools: Tools::new(tools, operation.tools, &remembered),
            checking,
            link: PlcLink::new(parameters, plc_messages, plc_dialogues, files),
            plc: PlcUnit {
                machine: Machine::new(plc, Start::PowerOn),
                due_us: 0,
                period_us: model.limits().plc_cycle_us.into(),
                scans: 0,
            },
            emergency: EmergencyStop::new(model, operation.power_interrupted),
            messages: Messages::default(),
            panel: Panel::default(),
            start_pressed: false,
            handshakes: Handshakes::default(),
            places,
            feed_override: Override::feed(operation.overrides.feed_steps),
            spindle_override: Override::spindle(operation.overrides.spindle_steps),
            mode: Mode::Manual,
            loops_closed: false,
            manual: Manual::default(),
            reference: ReferenceRun::default(),
            positioning: Positioning::default(),
            run: ProgramRun::default(),
            path: Interpolator::new(&path_limits, LOOK_AHEAD),
            offsets: Offsets {
                datum: first,
                tool_axis: remembered.tool_axis.unwrap_or(Axis::Z),
                tool_length: remembered.tool_length,
            },
            datums,
            correction: [0.0; AXES],
            range: 0,
            upkeep: Upkeep::new(parameters_interval_s),
            stylus: crate::probing::Stylus::default(),
            tapping: Tapping::default(),
            test: None,
            keeps: false,
            unsaved: false,
            life: LifeCount::default(),
            inch_feed,
            programs,
            q: remembered.q,
            loaded_tables: LoadedTables::default(),
            loaded_datums: LoadedDatums::default(),
            log: None,
            commands: Commands::default(),
            measured: Measured::default(),
            output_bits: bits(BitArea::O, model.limits().outputs),
            input_bits: bits(BitArea::I, model.limits().inputs),
            letters,
            axes,
        };
        control.link.selected_list = remembered.parameter_list;
        if let Some(name) = remembered.program {
            control.run.selected = Some(name);
        }
        control.link.pallet = PalletSelection {
            line: remembered.pallet_line,
            datum_table: remembered.datum_table,
        };
        control.set_up_datums(&remembered.written_datums);
        control.set_up_tables(&remembered.written);
        control.select_range(0);
        let active = control
            .link
            .files
            .compensation
            .as_ref()
            .and_then(|file| file.active);
        control.activate_compensation(active);
        control.preset_markers();
        if control.operation.power_interrupted {
            control.show(Message::Plain(MessageId::PowerInterrupted), false);
        }
        control
    }

    /// Markers and words with a value at power-on.
    fn preset_markers(&mut self) {
        // They lie among the markers that power-off keeps, but belong to the NC.
        let of_the_nc = [
            &signal::RISING_EDGES,
            &signal::FALLING_EDGES,
            &signal::DECODED_M_FUNCTIONS,
        ];
        for marker in of_the_nc.into_iter().flat_map(|range| range.iter()) {
            if self.exchange.nc().bit(marker) {
                self.exchange.nc_set(marker, false);
            }
        }
        for unit in &self.axes {
            if let Some(marker) = crate::markers::REFERENCE_MISSING.get(unit.index) {
                self.exchange.nc_set(*marker, unit.parameters.controlled);
            }
        }
        self.exchange.nc_set_number(signal::RAPID_TRAVERSE_LIMIT, 300_000);
        self.exchange
            .nc_set(signal::ENGLISH_SELECTED, self.operation.english);
        self.spindle.preset(&mut self.exchange);
    }

    /// Time since power-on, µs.
    pub fn time_us(&self) -> u64 {
        self.now_us
    }

    /// The contour cycle, µs.
    pub fn cycle_us(&self) -> u32 {
        self.timing.contour_us()
    }

    pub(crate) fn cycle_s(&self) -> f64 {
        f64::from(self.timing.contour_us()) * 1e-6
    }

    /// Spends one contour cycle on a machine. It does not allocate unless something out of the ordinary
    /// happens: a message, a fault.
    pub fn cycle(&mut self, plant: &mut dyn Plant) {
        // Somebody may have touched the machine meanwhile.
        self.spend(plant, 0);
        for step in 0..self.timing.steps() {
            self.servo_step(step == 0);
            self.spend(plant, self.timing.step_us());
        }
        self.cycles += 1;
    }

    /// One servo step: a contour cycle begins with the first of its steps, a PLC scan with the first step
    /// at or after its time.
    fn servo_step(&mut self, first: bool) {
        self.emergency.step(self.now_us, self.measured.control_ready);
        self.commands.control_ready = self.emergency.output();
        for unit in &mut self.axes {
            let encoder = self.measured.encoder(unit.parameters.encoder.input.into());
            unit.servo.measure(encoder);
            let drive = self
                .measured
                .drives
                .get(usize::from(unit.parameters.output.output));
            unit.servo.take_drive_fault(drive.map_or(0, |drive| drive.fault));
        }
        self.spindle.measure(&self.measured);
        self.watch_probe();
        if self.plc_runs() && self.now_us >= self.plc.due_us {
            self.scan();
            self.plc.due_us += self.plc.period_us;
        }
        if first {
            self.contour_cycle();
        }
        for unit in &mut self.axes {
            unit.servo.step();
            if let Some(output) = self
                .commands
                .axes
                .get_mut(usize::from(unit.parameters.output.output))
            {
                *output = unit.servo.output();
            }
        }
        self.spindle.output(&mut self.commands);
    }

    /// Lets time pass on the machine, µs.
    fn spend(&mut self, plant: &mut dyn Plant, length_us: u32) {
        let step = Step {
            from_us: self.now_us,
            length_us,
        };
        let before = self.measured.control_ready;
        plant.exchange(step, &self.commands, &mut self.measured);
        if length_us > 0 {
            self.emergency.pass(step, before, &self.measured);
        }
        self.now_us += u64::from(length_us);
    }

    /// The PLC runs from the end of `POWER INTERRUPTED` on [000:7033-7040].
    fn plc_runs(&mut self) -> bool {
        use crate::emergency::Circuit;
        if self.operation.station == Station::WithoutPlc || self.plc.machine.stopped().is_some() {
            return false;
        }
        let runs = !matches!(
            self.emergency.circuit(),
            Circuit::PowerInterrupted | Circuit::Defective
        );
        if runs && self.plc.scans == 0 && self.plc.due_us < self.now_us {
            self.plc.due_us = self.now_us;
        }
        runs
    }

    /// A PLC scan: inputs in, program, outputs out, then what the PLC asks for.
    fn scan(&mut self) {
        for (number, bit) in &self.input_bits {
            let value = self.measured.inputs.get(*number).copied().unwrap_or(false);
            if self.exchange.nc().bit(*bit) != value {
                self.exchange.nc_set(*bit, value);
            }
        }
        self.publish_analogue();
        let operator = self.measured.operator;
        self.feed_override
            .publish(&mut self.exchange, operator.feed_override_percent);
        self.spindle_override
            .publish(&mut self.exchange, operator.spindle_override_percent);
        self.publish();
        self.link.program_running = self.run.is_active();
        self.link.orienting = self.spindle.is_orienting();
        self.link.spindle = self.spindle.position();
        self.plc.scans += 1;
        if let Err(error) = self.plc.machine.scan(&mut self.exchange, &mut self.link) {
            let message = Message::PlcStopped {
                number: error.error.number(),
                file: error.file,
                line: error.line,
            };
            self.show(message, true);
            return;
        }
        self.feed_override.take(&self.exchange);
        self.spindle_override.take(&self.exchange);
        let nc = self.exchange.nc();
        for (number, bit) in &self.output_bits {
            if let Some(output) = self.commands.outputs.get_mut(*number) {
                *output = nc.bit(*bit);
            }
        }
        self.after_scan();
    }

    /// What the PLC asked for in the scan that has ended.
    fn after_scan(&mut self) {
        match self.panel.read(self.exchange.nc()) {
            Ok(panel) => {
                self.start_pressed |= panel.started;
                self.panel = panel;
            }
            Err(code) => self.show(Message::PlcMarkers(code), true),
        }
        let block = self.running_block();
        self.messages.follow_plc(&self.exchange, self.now_us, block);
        self.take_plc_strobes();
        self.take_module_requests();
    }

    /// What is decided once in each contour cycle.
    fn contour_cycle(&mut self) {
        self.follow_circuit();
        self.follow_loops();
        self.take_faults();
        if !self.loops_closed || self.move_axes() {
            self.start_pressed = false;
        }
        // What a tool change leads to is on the medium before the PLC sees its end.
        if let Some(Transfer::ToolCall { more: false, .. }) = self.handshakes.acknowledged(self.exchange.nc())
            && self.tools.is_changing()
        {
            self.tools.inserted(&self.exchange);
        }
        self.count_tool_life();
        if std::mem::take(&mut self.tools.changed) {
            self.mirror_pockets();
            self.unsaved = true;
            self.life.changed = true;
        }
        let waits = self.keeps && self.unsaved;
        if !waits {
            self.tools.end_geometry_strobe(&mut self.exchange);
        }
        if let Some(transfer) = self.handshakes.cycle(&mut self.exchange, !waits) {
            self.acknowledged(transfer);
        }
        self.follow_tapping();
        self.spindle.set_feed(self.run.speed * 60.0);
        // In cycle 2 the override of the spindle is off [003:5032].
        let percent = if self.taps_floating() {
            100.0
        } else {
            self.spindle_override.percent()
        };
        self.spindle.cycle(&mut self.exchange, percent);
        if self.spindle.take_wrong_speed() {
            self.show(Message::Plain(MessageId::WrongRpm), false);
            self.refuse_block();
        }
        for unit in &mut self.axes {
            unit.count();
        }
        self.look_after();
    }

    /// What was acknowledged has its effect now.
    fn acknowledged(&mut self, transfer: Transfer) {
        if let Transfer::Gear { .. } = transfer {
            self.spindle.gear_changed();
        }
    }

    /// Interprets and plans ahead; may allocate. To be called after every cycle.
    pub fn prepare(&mut self) {
        self.prepare_limits();
        self.prepare_restore();
        self.prepare_run();
        self.prepare_test();
    }

    /// Leaves computations that take long, as those of an SL contour, to whoever drives the control: runs that
    /// begin from now on wait for [`Control::finish_work`], while everything else goes on.
    pub fn defer_work(&mut self) {
        self.run.defers = true;
    }

    /// A computation to be done beside.
    pub fn take_work(&mut self) -> Option<Work> {
        let run = self.run.feeder.as_mut();
        let test = self.test.as_mut().map(crate::test_run::TestRun::feeder);
        run.into_iter()
            .chain(test)
            .find_map(|feeder| feeder.interpreter_mut().take_work())
    }

    /// What a computation came to. It has no effect when what needed it was given up.
    pub fn finish_work(&mut self, done: Done) {
        let run = self.run.feeder.as_mut();
        let test = self.test.as_mut().map(crate::test_run::TestRun::feeder);
        if let Some(feeder) = run
            .into_iter()
            .chain(test)
            .find(|feeder| feeder.interpreter().waits_for(&done))
        {
            feeder.interpreter_mut().finish_work(done);
        }
    }

    /// Simulates the block processing time: no more elements of the path are read than the control has time
    /// for, each taking so long, µs. 0 for no time.
    pub fn set_block_time(&mut self, time_us: u32) {
        self.run.block_time.set(time_us);
    }

    /// Gives a command of the operator; it is logged with the time when a log is kept. `false` when it is not
    /// possible now.
    pub fn command(&mut self, command: Command) -> bool {
        if let Some(log) = self.log.as_mut().filter(|log| log.len() < LOG_MAX) {
            log.push((self.now_us, command.clone()));
        }
        let done = self.execute(command);
        if !done {
            self.show(Message::Plain(MessageId::KeyNonFunctional), false);
        }
        done
    }

    /// Keeps the commands from now on, for [`Control::take_command_log`].
    pub fn keep_command_log(&mut self) {
        self.log = Some(Vec::new());
    }

    /// The commands since the last call with their times, µs: given again at these times they repeat the run.
    /// `None` when they were not kept, or were more than fit before they were taken.
    pub fn take_command_log(&mut self) -> Option<Vec<(u64, Command)>> {
        let log = std::mem::take(self.log.as_mut()?);
        (log.len() < LOG_MAX).then_some(log)
    }

    pub(crate) fn show(&mut self, message: Message, flashing: bool) {
        let block = match &message {
            Message::Program(error) => Some(error.block),
            _ => self.running_block(),
        };
        self.show_at(message, flashing, block);
    }

    /// Shows a message that belongs to a block.
    pub(crate) fn show_at(&mut self, message: Message, flashing: bool, block: Option<BlockRef>) {
        self.messages.show(message, flashing, self.now_us, block);
    }

    /// The block that is executed, while a run is on.
    pub(crate) fn running_block(&self) -> Option<BlockRef> {
        let element = self.path.element().filter(|_| self.run.is_active())?;
        Some(element.block)
    }

    /// Sets a marker for the PLC when it changes.
    pub(crate) fn put(&mut self, bit: Bit, value: bool) {
        if self.exchange.nc().bit(bit) != value {
            self.exchange.nc_set(bit, value);
        }
    }

    /// Sets a word for the PLC when it changes.
    pub(crate) fn put_number(&mut self, number: Number, value: i32) {
        if self.exchange.nc().number(number) != value {
            self.exchange.nc_set_number(number, value);
        }
    }

    /// What the NC sees of the PLC's memory.
    pub fn memory(&self) -> &Image {
        self.exchange.nc()
    }

    /// Lets the end of a tool change wait until what survives power-off is stored: whoever calls
    /// [`Control::prepare`] asks [`Control::unsaved`], writes, and says [`Control::stored`].
    pub fn keep_state(&mut self, keep: bool) {
        self.keeps = keep;
    }

    /// What survives power-off when it has changed since it was stored.
    pub fn unsaved(&self) -> Option<Remembered> {
        self.unsaved.then(|| self.remember())
    }

    /// What survives power-off is on the medium.
    pub fn stored(&mut self) {
        self.unsaved = false;
    }

    /// The name of the list of machine parameters that module 9033 has selected: the control is to be started
    /// anew with it.
    pub fn take_restart(&mut self) -> Option<String> {
        std::mem::take(&mut self.run.restart_wanted).then(|| self.link.selected_list.clone())?
    }

    /// What survives power-off, as of now.
    pub fn remember(&self) -> Remembered {
        let offsets = (self.offsets.tool_length, self.offsets.tool_axis);
        let (tool_length, tool_axis) = self.tools.held_geometry().unwrap_or(offsets);
        Remembered {
            datums: self.datums.map(crate::setup::Position0),
            tool: self.tools.number,
            tool_length,
            tool_axis: Some(tool_axis),
            pockets: self.tools.moved(),
            written: self.written_elements(),
            q: self.q_values(),
            offsets_volts: self.offset_volts(),
            parameter_list: self.link.selected_list.clone(),
            program: self.run.selected.clone(),
            pallet_line: self.link.pallet.line,
            datum_table: self.link.pallet.datum_table.clone(),
            written_datums: self.written_datums(),
        }
    }

    /// The exchanged memory, for the journal of retained markers and bytes.
    pub fn exchange(&self) -> &Exchange {
        &self.exchange
    }
}

/// The limits of the path: those of the axes by their letters.
pub(crate) fn path_limits(parameters: &bahn_parameters::ParameterList, axes: &[AxisUnit]) -> PathLimits {
    let of = |value: fn(&AxisUnit) -> f64, otherwise: f64| {
        Axis::ALL.map(|axis| {
            axes.iter()
                .find(|unit| unit.axis == axis)
                .map_or(otherwise, value)
        })
    };
    PathLimits {
        max_feed_mm_min: of(|unit| unit.parameters.motion.rapid_mm_min, 0.0),
        acceleration_m_s2: of(|unit| unit.parameters.motion.acceleration_m_s2, 1.0),
        radial_acceleration_m_s2: parameters.radial_acceleration_m_s2(),
        corner_angle_deg: parameters.corner_angle_deg(),
        servo_lag: !parameters.feed_precontrol(),
        cycle_s: f64::from(Timing::of(parameters.model()).contour_us()) * 1e-6,
        servo_window_s: bahn_motion::SERVO_WINDOW_S,
        spindle: parameters.spindle_parameters().rigid_ramps().map(Into::into),
        feed_override_percent: 100.0,
        rapid_override_percent: 100.0,
    }
}
