//! A channel: operating mode, program run and all that belongs to it. It moves its axes and drives its spindle
//! on the machine side, and has its own window into the memory of the PLC.

use bahn_exchange::{Exchange, signal};
use bahn_interpreter::{Done, Rules, Work};
use bahn_motion::{Aim, Limits as PathLimits};
use bahn_parameters::{MessageId, OperationParameters, ParameterList};
use bahn_path::{Axis, BlockRef};
use bahn_servo::{Gantry, OperatorInputs, Plant, Timing};

use crate::axes::{Axes, OwnAxes};
use crate::axis::{AxisUnit, Mover};
use crate::command::{Command, Mode};
use crate::datums::Datums;
use crate::emergency::Circuit;
use crate::handshake::{Handshakes, Transfer};
use crate::kinematics::{Chain, Kinematics, Offsets};
use crate::life::{self, LifeCount};
use crate::loops::{self, Permission};
use crate::machine::MachineSide;
use crate::manual::{Manual, Reach};
use crate::message::Message;
use crate::overrides::Override;
use crate::panel::Panel;
use crate::plc_link::PalletRequest;
use crate::positioning::{Moving, Positioning};
use crate::probing::{Guarded, Stylus};
use crate::programs::Selection;
use crate::progress::RunState;
use crate::reference::{self, ReferenceRun};
use crate::run::ProgramRun;
use crate::setup::Remembered;
use crate::site::{Now, Site};
use crate::snapshot::{AxisState, Snapshot};
use crate::source::{Basis, Reading, Source};
use crate::test_run::TestRun;
use crate::tools::Tools;
use crate::track::Track;
use crate::{status, strobes, tables, upkeep};

/// Code numbers [000:6928-6947].
const ERASE_MEMORY: u32 = 531_210;
const OFFSET_ADJUSTMENT: u32 = 75_368;
const CODE_84159: u32 = 84_159;
/// Marker of a key = code + this [000:7326-7404].
const KEY_MARKER: u16 = 2796;

/// A channel.
#[derive(Clone)]
pub(crate) struct Channel {
    number: usize,
    operation: OperationParameters,
    /// Its own list of machine parameters; `None` for that of the machine.
    own_list: Option<ParameterList>,
    mode: Mode,
    /// NC start was pressed and not yet used.
    start_pressed: bool,
    panel: Panel,
    feed_override: Override,
    spindle_override: Override,
    manual: Manual,
    reference: ReferenceRun,
    positioning: Positioning,
    pub handshakes: Handshakes,
    chain: Chain,
    datums: Datums,
    pub tools: Tools,
    /// Of the tool in the spindle.
    life: LifeCount,
    stylus: Stylus,
    pub run: ProgramRun,
    test: Option<TestRun>,
}

/// What a channel is made of.
pub(crate) struct Parts {
    pub number: usize,
    pub own_list: Option<ParameterList>,
    pub kinematics: std::sync::Arc<dyn Kinematics>,
    pub tools: Tools,
    pub reading: Reading,
}

impl Channel {
    /// A channel at power-on, with what was remembered.
    pub fn new(parts: Parts, remembered: &Remembered, machine: &mut MachineSide) -> Channel {
        let list = parts.own_list.as_ref().unwrap_or(machine.link.list());
        let operation = list.operation_parameters();
        let limits = path_limits(list, machine.axes.owned(parts.number));
        let datums = remembered.datums.map(|datum| datum.0);
        let [first, ..] = datums;
        let offsets = Offsets {
            datum: first,
            tool_axis: remembered.tool_axis.unwrap_or(Axis::Z),
            tool_length: remembered.tool_length,
        };
        let selection = Selection {
            program: remembered.program.clone(),
            ..Selection::default()
        };
        let source = Source::new(parts.reading, remembered.q.clone());
        let mut channel = Channel {
            number: parts.number,
            own_list: parts.own_list,
            mode: Mode::Manual,
            start_pressed: false,
            panel: Panel::default(),
            feed_override: Override::feed(operation.overrides.feed_steps),
            spindle_override: Override::spindle(operation.overrides.spindle_steps),
            manual: Manual::default(),
            reference: ReferenceRun::default(),
            positioning: Positioning::default(),
            handshakes: Handshakes::default(),
            chain: Chain::new(parts.kinematics, offsets),
            datums: Datums::new(datums, operation.datums.datum_for_each_range),
            tools: parts.tools,
            life: LifeCount::default(),
            stylus: Stylus::default(),
            run: ProgramRun::new(selection, source, Track::new(&limits)),
            test: None,
            operation,
        };
        channel.select_range(0, machine);
        channel.preset(machine);
        channel
    }

    /// Markers and words with a value at power-on.
    fn preset(&self, machine: &mut MachineSide) {
        let MachineSide {
            axes,
            memory,
            spindles,
            ..
        } = machine;
        let exchange = memory.of_mut(self.number);
        // They lie among the markers that power-off keeps, but belong to the NC.
        let of_the_nc = [
            &signal::RISING_EDGES,
            &signal::FALLING_EDGES,
            &signal::DECODED_M_FUNCTIONS,
        ];
        for marker in of_the_nc.into_iter().flat_map(|range| range.iter()) {
            exchange.nc_put(marker, false);
        }
        for unit in axes.owned(self.number) {
            if let Some(marker) = crate::markers::REFERENCE_MISSING.get(unit.index) {
                exchange.nc_set(*marker, unit.parameters.controlled);
            }
        }
        exchange.nc_set_number(signal::RAPID_TRAVERSE_LIMIT, 300_000);
        exchange.nc_set(signal::ENGLISH_SELECTED, self.operation.english);
        spindles.of(self.number).preset(exchange);
    }

    fn list<'a>(&'a self, machine: &'a MachineSide) -> &'a ParameterList {
        self.own_list.as_ref().unwrap_or(machine.link.list())
    }

    pub fn mode(&self) -> Mode {
        self.mode
    }

    pub fn feed_override_percent(&self) -> f64 {
        self.feed_override.percent()
    }

    /// What holds now.
    fn now(&self, machine: &MachineSide) -> Now {
        let nc = machine.memory.of(self.number).nc();
        let feed_percent = self.feed_override.percent();
        // MP7620 bit 0 = 0 takes the feed override away while the rapid traverse key is pressed [000:10512]
        // [001:3262] [003:7434-7443].
        let rapid = self.panel.rapid && !self.operation.overrides.on_rapid_key;
        // D596: rapid traverse as the PLC limits it [000:4812-4814]. With a probe in the spindle MP6150 limits
        // it, too [000:7654].
        let by_plc = f64::from(nc.number(signal::RAPID_TRAVERSE_LIMIT).max(0));
        let rapid_limit_mm_min = if nc.bit(signal::NC_STOP_ON_STYLUS_DEFLECTION) {
            by_plc.min(self.list(machine).probe().rapid_mm_min)
        } else {
            by_plc
        };
        let ready = machine.emergency.circuit() == Circuit::Ready;
        let stop = self.panel.stop
            || self.stylus.stops
            || nc.bit(signal::NC_STOP_AND_OPEN_LOOPS)
            || !ready
            || machine.messages.is_fatal()
            || machine
                .axes
                .owned(self.number)
                .any(|unit| unit.servo.fault().is_some());
        Now {
            time_s: f64::from(machine.timing.contour_us()) * 1e-6,
            us: machine.messages.time_us(),
            mode: self.mode,
            start: self.start_pressed,
            stop,
            stop_pressed: self.panel.stop,
            ready,
            loops_closed: machine.loops_closed,
            feed_percent,
            program_percent: if rapid { 100.0 } else { feed_percent },
            axis_keys: self.panel.axis_keys,
            rapid_limit_mm_min,
        }
    }

    /// Its run, and what that acts on.
    fn parts<'a>(&'a mut self, machine: &'a mut MachineSide) -> (&'a mut ProgramRun, Site<'a>, Basis<'a>) {
        let now = self.now(machine);
        let site = Site {
            now,
            axes: machine.axes.of(self.number),
            spindle: machine.spindles.of_mut(self.number),
            tools: &mut self.tools,
            chain: &mut self.chain,
            handshakes: &mut self.handshakes,
            positioning: &mut self.positioning,
            exchange: machine.memory.of_mut(self.number),
            messages: &mut machine.messages,
        };
        let basis = Basis {
            list: self.own_list.as_ref().unwrap_or(machine.link.list()),
            link: &machine.link,
        };
        (&mut self.run, site, basis)
    }

    /// Shows a message at the block that is executed.
    fn show(&self, message: Message, flashing: bool, machine: &mut MachineSide) {
        machine.messages.show(message, flashing, self.run.running_block());
    }

    /// NC stop, or anything that stops like it.
    pub fn stop(&mut self) {
        self.run.stop();
        self.manual.stop();
        if self.reference.is_running() && self.mode != Mode::Reference {
            self.reference.abort();
        }
    }

    /// Changes the operating mode, and with it the kind of positioning.
    fn set_mode(&mut self, mode: Mode, axes: &mut OwnAxes) {
        if mode == self.mode {
            return;
        }
        if self.mode == Mode::Reference {
            self.reference.abort();
        }
        // What the old mode moved comes to a standstill on its ramp.
        axes.release(|mover| matches!(mover, Mover::Reference | Mover::Manual));
        self.mode = mode;
        self.manual.stop();
    }

    /// The control voltage has come: with the first time the control asks for the reference run.
    pub fn loops_closed(&mut self, axes: &mut Axes) {
        let mut axes = axes.of(self.number);
        if self.reference.is_asked_for(&axes) {
            self.set_mode(Mode::Reference, &mut axes);
        }
    }

    /// The loops are opened: nothing moves on.
    pub fn loops_opened(&mut self, machine: &mut MachineSide) {
        self.run.part_thread();
        machine.spindles.of_mut(self.number).open();
        self.manual.stop();
        self.reference.abort();
        self.positioning.stop();
        self.run.track.path.halt();
    }

    /// What the PLC positions ends with an EMERGENCY STOP; the strobes are reset [000:4013-4019]. Whether the axes
    /// stand.
    pub fn end_for_emergency(&mut self, machine: &mut MachineSide) -> bool {
        self.positioning.end_all(machine.memory.of_mut(self.number));
        self.positioning.stop();
        let (run, site, _) = self.parts(machine);
        run.axes_stand(&site)
    }

    /// Loops, feed enable and faults of a contour cycle.
    pub fn follow_loops(&mut self, monitoring_off: bool, machine: &mut MachineSide) {
        let permission = Permission {
            loops_closed: machine.loops_closed,
            feed_enable: self.panel.feed_enable,
            monitoring_off,
        };
        let nc = machine.memory.of(self.number).nc();
        loops::follow(&mut machine.axes.of(self.number), nc, permission);
        if nc.bit(signal::NC_STOP_AND_OPEN_LOOPS) {
            self.run.part_thread();
            machine.spindles.of_mut(self.number).open();
            self.stop();
        }
    }

    /// New faults of loops and spindle stop the channel.
    pub fn take_faults(&mut self, machine: &mut MachineSide) {
        let block = self.run.running_block();
        let axes = machine.axes.of(self.number);
        let spindle = machine.spindles.of(self.number);
        if loops::show_faults(&axes, spindle, &mut machine.messages, block) {
            self.run.part_thread();
            self.stop();
            // An error with stop ends what the PLC positions [000:4013-4019].
            self.positioning.end_all(machine.memory.of_mut(self.number));
        }
    }

    /// Looks at the stylus, and takes the position of the axes when it is deflected; once in each servo step.
    pub fn watch_probe(&mut self, machine: &MachineSide, plant: &mut dyn Plant) {
        let nc = machine.memory.of(self.number).nc();
        let guards = nc.bit(signal::NC_STOP_ON_STYLUS_DEFLECTION)
            && !self
                .own_list
                .as_ref()
                .unwrap_or(machine.link.list())
                .probe()
                .on_standby;
        let axes = || machine.axes.owned(self.number);
        let (panel, mode) = (&self.panel, self.mode);
        self.stylus.watch(plant, guards, &self.run.probe, || Guarded {
            rest: panel.axis_keys.iter().all(Option::is_none) && axes().all(AxisUnit::stands),
            automatic: mode.is_automatic(),
        });
        self.run.probe.watch(plant, axes(), &self.chain);
    }

    /// Finds the nominal positions of its axes for the end of the contour cycle. NC start is kept as long as the
    /// operating mode waits for axes to come to a standstill.
    pub fn move_axes(&mut self, machine: &mut MachineSide, plant: &mut dyn Plant) {
        let now = self.now(machine);
        let handwheel = plant.operator().handwheel_count;
        let mut axes = machine.axes.of(self.number);
        reference::count_display_axes(&mut axes);
        if self.mode != Mode::Handwheel {
            // What is turned in another mode moves nothing later.
            self.manual.forget_turns(handwheel);
        }
        let automatic = self.mode.is_automatic();
        let rigid = self.run.taps_rigidly();
        let mut ready = true;
        for unit in axes.iter_mut() {
            ready &= unit.choose_method(automatic && !self.reference.is_running(), rigid);
        }
        // What the mode before moved comes to a standstill first.
        let waits = automatic && !ready && !self.run.is_active();
        if !waits {
            self.move_by_mode(handwheel, &now, machine, plant);
        }
        self.move_for_plc(&now, machine);
        let mut axes = machine.axes.of(self.number);
        for unit in axes.iter_mut() {
            if unit.mover == Mover::None && !unit.stands() && unit.coupling.is_none() {
                // Nobody moves it any more: down to a standstill.
                let rapid = unit.parameters.motion.rapid_mm_min;
                unit.drive(now.time_s, Aim::Feed(0.0), rapid);
            }
        }
        self.start_pressed &= waits;
    }

    fn move_by_mode(&mut self, handwheel: i64, now: &Now, machine: &mut MachineSide, plant: &mut dyn Plant) {
        match self.mode {
            Mode::Manual | Mode::Handwheel => {
                if now.start && !now.stop {
                    self.output_entered(machine);
                }
                self.move_manually(handwheel, now, machine);
            }
            Mode::Reference => {
                let mut axes = machine.axes.of(self.number);
                let nc = machine.memory.of(self.number).nc();
                if self.reference.moves(&mut axes, nc, now) {
                    self.set_mode(Mode::Manual, &mut axes);
                }
            }
            Mode::Mdi | Mode::SingleBlock | Mode::FullSequence => {
                let nc = machine.memory.of(self.number).nc();
                let by_hand = self.run.is_operated_manually(nc);
                if by_hand && !self.run.track.path.is_coupled() {
                    self.move_manually(handwheel, now, machine);
                } else {
                    if now.stop {
                        self.stop();
                    } else if now.start {
                        let (run, mut site, _) = self.parts(machine);
                        run.start(&mut site);
                    }
                    let (run, mut site, _) = self.parts(machine);
                    run.moves(&mut site, plant);
                }
                let (run, mut site, _) = self.parts(machine);
                run.move_back(&mut site);
            }
        }
    }

    fn output_entered(&mut self, machine: &mut MachineSide) {
        let mut manual = self.manual;
        let (_, mut site, _) = self.parts(machine);
        manual.output_entered(&mut site);
        self.manual = manual;
    }

    fn move_manually(&mut self, handwheel: i64, now: &Now, machine: &mut MachineSide) {
        let mut reach = Reach {
            axes: &mut machine.axes.of(self.number),
            panel: &mut self.panel,
            rules: &self.operation,
            nc: machine.memory.of(self.number).nc(),
            messages: &mut machine.messages,
            block: self.run.running_block(),
        };
        self.manual.moves(handwheel, &mut reach, now);
    }

    /// Moves what the PLC commands.
    fn move_for_plc(&mut self, now: &Now, machine: &mut MachineSide) {
        let moving = Moving {
            time_s: now.time_s,
            stop: now.stop,
            active: self.run.is_active(),
            restores: self.run.restores(),
            ready: now.ready,
            feed_percent: now.feed_percent,
            rapid_limit_mm_min: now.rapid_limit_mm_min,
        };
        let exchange = machine.memory.of_mut(self.number);
        let mut axes = machine.axes.of(self.number);
        self.positioning.moves(&mut axes, exchange, &moving);
        if self.number == 0 {
            // Modules know the axes of the first channel.
            let statuses = &mut machine.link.plc_axes;
            self.positioning.move_plc_axes(&mut axes, statuses, &moving);
        }
        self.positioning
            .move_rotation(&mut axes, exchange.nc(), &moving);
    }

    /// The loops are closed, but nothing is moved: NC start is not kept.
    pub fn forget_start(&mut self) {
        self.start_pressed = false;
    }

    /// Without a run axes that stand count within one turn, and nothing is left to go back to.
    pub fn settle(&mut self, axes: &mut Axes) {
        if self.run.progress().is_on_its_way() {
            return;
        }
        for unit in axes.of(self.number).iter_mut() {
            unit.left_at = None;
            if unit.mover == Mover::None && unit.stands() {
                unit.wrap();
            }
        }
    }

    /// Tools, handshakes and spindle of a contour cycle. `keeps`: what changes must be stored before its strobe
    /// is reset.
    pub fn follow_plc(&mut self, keeps: bool, machine: &mut MachineSide) {
        let exchange = machine.memory.of_mut(self.number);
        // What a tool change leads to is on the medium before the PLC sees its end.
        if let Some(Transfer::ToolCall { more: false, .. }) = self.handshakes.acknowledged(exchange.nc())
            && self.tools.is_changing()
        {
            self.tools.inserted(exchange);
        }
        let runs = self.run.is_active() && matches!(self.mode, Mode::SingleBlock | Mode::FullSequence);
        let cycle_us = machine.timing.contour_us();
        let counted = self.life.cycle(cycle_us, runs, &mut self.tools, exchange);
        if let Some((tool, minutes)) = counted {
            life::write_life(&mut machine.link.files, tool, minutes);
        }
        if std::mem::take(&mut self.tools.changed) {
            tables::mirror_pockets(&self.tools, &mut machine.link.files);
            machine.unsaved = true;
            self.tools.states_changed = true;
        }
        let waits = keeps && machine.unsaved;
        if !waits {
            self.tools.end_geometry_strobe(exchange);
        }
        let acknowledged = self.handshakes.cycle(exchange, !waits);
        let spindle = machine.spindles.of_mut(self.number);
        if let Some(Transfer::Gear { .. }) = acknowledged {
            spindle.gear_changed();
        }
        let (run, mut site, _) = self.parts(machine);
        run.follow_tapping(&mut site);
        self.follow_spindle(machine);
        upkeep::lubricate(
            &machine.axes.of(self.number),
            machine.memory.of_mut(self.number),
        );
    }

    fn follow_spindle(&mut self, machine: &mut MachineSide) {
        let exchange = machine.memory.of_mut(self.number);
        let spindle = machine.spindles.of_mut(self.number);
        spindle.set_feed(self.run.track.speed_mm_s() * 60.0);
        // In cycle 2 the override of the spindle is off [003:5032].
        let percent = if self.run.taps_floating() {
            100.0
        } else {
            self.spindle_override.percent()
        };
        spindle.cycle(exchange, percent);
        if spindle.take_wrong_speed() {
            self.show(Message::Plain(MessageId::WrongRpm), false, machine);
            let (run, mut site, _) = self.parts(machine);
            if !run.refuse_block(&mut site) {
                self.stop();
            }
        }
    }

    /// Brings markers and words up to date before a scan.
    pub fn publish(&mut self, operator: &OperatorInputs, machine: &mut MachineSide) {
        let exchange = machine.memory.of_mut(self.number);
        self.feed_override
            .publish(exchange, operator.feed_override_percent);
        self.spindle_override
            .publish(exchange, operator.spindle_override_percent);
        status::mode(self.mode, self.manual.last_key(), exchange);
        status::axes(self.mode, &mut machine.axes.of(self.number), exchange);
        status::run(&self.run, !self.handshakes.is_idle(), exchange);
        machine.spindles.of(self.number).publish(exchange);
    }

    /// What modules read of the channel in the next scan.
    pub fn inform(&self, machine: &mut MachineSide) {
        let (run, chain) = (&self.run, &self.chain);
        let (axes, link) = (&machine.axes, &mut machine.link);
        let spindle = machine.spindles.of(self.number);
        status::coordinates(
            axes.owned(self.number),
            |unit| {
                let offset = chain.offsets.of(unit.axis);
                [
                    unit.servo.actual_mm() - offset,
                    unit.nominal - offset,
                    unit.servo.actual_mm(),
                    unit.servo.lag_mm(),
                    run.distance_to_go(unit, chain),
                ]
            },
            link,
        );
        let executed = run.selection.program.as_deref();
        let tested = self.test.as_ref().map(TestRun::program);
        status::items(self.mode, &self.manual, executed, tested, link);
        link.orienting = spindle.is_orienting();
        link.spindle = spindle.position();
    }

    /// What the PLC asked for in the scan that has ended.
    pub fn after_scan(&mut self, machine: &mut MachineSide) {
        let exchange = machine.memory.of_mut(self.number);
        self.feed_override.take(exchange);
        self.spindle_override.take(exchange);
        match self.panel.read(exchange.nc()) {
            Ok(panel) => {
                self.start_pressed |= panel.started;
                self.panel = panel;
            }
            Err(code) => self.show(Message::PlcMarkers(code), true, machine),
        }
    }

    /// Takes the strobes that the PLC set in a scan, and resets them.
    pub fn take_strobes(&mut self, machine: &mut MachineSide) {
        let now = self.now(machine);
        let exchange = machine.memory.of_mut(self.number);
        let wanted = self.positioning.is_wanted(exchange.nc());
        if strobes::is_transfer_doubly_used(wanted, exchange.nc()) {
            self.show(Message::PlcMarkers(*b"1R"), true, machine);
            return;
        }
        let mut axes = machine.axes.of(self.number);
        let offsets = &mut self.chain.offsets;
        let running = self.run.progress().is_running();
        let strobe = self.handshakes.strobe_is_set();
        let keys = self.panel.axis_keys.iter().any(Option::is_some);
        let free = (!running || strobe) && !keys && !now.stop;
        let most = usize::from(machine.model.limits().plc_positioning_axes_max);
        self.positioning.take_strobes(exchange.nc(), free, most, &axes);
        self.positioning.take_free_rotation(exchange);
        if let Some(range) = strobes::range(exchange) {
            if let Some(range) = range {
                self.datums.select_range(range, &mut axes, offsets);
            }
            self.run.track.range_changed = self.run.is_active();
        }
        if let Some(correction) = strobes::datum_correction(strobe || !running, exchange) {
            self.datums.correct(correction, &axes, offsets);
        }
        if let Some((number, value)) = strobes::q_parameter(exchange) {
            self.run.set_q(number, value);
        }
        strobes::take_actual_values(self.mode, &mut axes, exchange.nc());
        if let Some(command) = strobes::key(exchange.nc()) {
            let done = command.is_some_and(|command| self.execute(command, machine));
            strobes::end_key(done, machine.memory.of_mut(self.number));
        }
        let exchange = machine.memory.of_mut(self.number);
        let mut axes = machine.axes.of(self.number);
        strobes::take_lubrication(&mut axes, exchange);
        strobes::take_lag_tracking(machine.plc_parameters.tracking_step_mm, &mut axes, exchange.nc());
        self.tools
            .take_geometry_strobe(exchange, &mut self.chain.offsets);
        let spindle = machine.spindles.of_mut(self.number);
        if let Some(code) = spindle.take_markers(exchange) {
            self.show(Message::PlcMarkers(code), true, machine);
        }
    }

    /// What modules asked for in a scan of the channel, which they take for the only one.
    pub fn take_module_requests(&mut self, machine: &mut MachineSide) {
        let exchange = machine.memory.of_mut(self.number);
        let spindle = machine.spindles.of_mut(self.number);
        let requests = &mut machine.link.requests;
        self.positioning.take_requests(requests);
        if let Some(orientation) = requests.orientation.take() {
            spindle.orient(orientation, exchange);
        }
        if let Some(call) = requests.tool_call.take() {
            self.tools.inserted_call = Some(call);
        }
        if let Some(volts) = requests.spindle_volts.take() {
            spindle.set_plc_volts(volts);
        }
        self.manual.take_status(std::mem::take(&mut requests.status));
        if let Some(request) = requests.pallet.take() {
            self.select_pallet(request, machine);
        }
        let requests = &mut machine.link.requests;
        if std::mem::take(&mut requests.geometry) {
            tables::initialise_geometry(&mut self.tools, &machine.link.files, &mut self.chain.offsets);
            machine.loaded_datums.changed = true;
            machine.unsaved = true;
        }
    }

    /// Module 9090: program and datum table are selected, and are so after power-off.
    fn select_pallet(&mut self, request: PalletRequest, machine: &mut MachineSide) {
        if !self.execute(Command::Select(request.program), machine) {
            return;
        }
        let pallet = &mut machine.link.pallet;
        pallet.line = Some(request.line);
        if request.datum_table.is_some() {
            pallet.datum_table = request.datum_table;
        }
        machine.unsaved = true;
    }

    /// Changed machine parameters take effect now, in a program that runs with the blocks that are not yet read;
    /// those of the path with the next run.
    pub fn take_parameters(&mut self, machine: &mut MachineSide) {
        let list = self.own_list.as_ref().unwrap_or(machine.link.list());
        if let Some(interpreter) = self.run.source.interpreter_mut() {
            interpreter.set_rules(Rules::of(list));
        }
        let overrides = self.operation.overrides;
        self.operation = list.operation_parameters();
        self.datums.each_range = self.operation.datums.datum_for_each_range;
        if self.operation.overrides.feed_steps != overrides.feed_steps {
            self.feed_override = Override::feed(self.operation.overrides.feed_steps);
        }
        if self.operation.overrides.spindle_steps != overrides.spindle_steps {
            self.spindle_override = Override::spindle(self.operation.overrides.spindle_steps);
        }
        let spindle = machine.spindles.of_mut(self.number);
        spindle.set_parameters(list.spindle_parameters());
        let mut interval = 0.0;
        for unit in machine.axes.of(self.number).iter_mut() {
            let Ok(index) = u8::try_from(unit.index) else {
                continue;
            };
            let mut parameters = list.axis_parameters(index);
            if let Some(master) = unit
                .parameters
                .synchronization
                .master
                .filter(|_| unit.coupling.is_some())
            {
                parameters = Gantry::slave_parameters(&parameters, &list.axis_parameters(master));
            }
            unit.set_parameters(parameters);
            if let Some(limits) = parameters.travel.ranges_mm.get(self.datums.range()) {
                unit.limits = *limits;
            }
            interval = parameters.output.offset_interval_s;
        }
        machine.offsets.set_interval(interval);
        self.run.track.limits_changed = true;
    }

    fn select_range(&mut self, range: usize, machine: &mut MachineSide) {
        let mut axes = machine.axes.of(self.number);
        self.datums
            .select_range(range, &mut axes, &mut self.chain.offsets);
    }

    /// Interprets and plans ahead; may allocate. `datums_changed`: blocks that are read from now on find other
    /// datums in the tables.
    pub fn prepare(&mut self, datums_changed: bool, machine: &mut MachineSide) {
        if self.run.track.limits_changed && !self.run.is_active() {
            let list = self.own_list.as_ref().unwrap_or(machine.link.list());
            let limits = path_limits(list, machine.axes.owned(self.number));
            self.run.track.take_limits(&limits);
        }
        let rules = self.operation.restart;
        let (run, mut site, basis) = self.parts(machine);
        run.prepare_restore(&rules, &mut site);
        run.close(&mut site, &basis);
        if std::mem::take(&mut site.tools.states_changed)
            && let Some(interpreter) = run.source.interpreter_mut()
        {
            interpreter.set_barred_tools(site.tools.barred());
        }
        if datums_changed && let Some(interpreter) = run.source.interpreter_mut() {
            interpreter.set_datum_table(basis.link.datums(basis.list));
        }
        run.prepare(&mut site, &basis);
        if let Some(test) = &mut self.test {
            let axes = machine.axes.owned(self.number);
            test.prepare(machine.spindles.of(self.number), axes);
        }
    }

    /// A computation to be done beside.
    pub fn take_work(&mut self) -> Option<Work> {
        let run = self.run.source.feeder_mut().into_iter();
        let test = self.test.as_mut().map(TestRun::feeder);
        run.chain(test)
            .find_map(|feeder| feeder.interpreter_mut().take_work())
    }

    /// What a computation came to; it is given back when nobody here waits for it.
    pub fn finish_work(&mut self, done: Done) -> Option<Done> {
        let run = self.run.source.feeder_mut().into_iter();
        let test = self.test.as_mut().map(TestRun::feeder);
        match run
            .chain(test)
            .find(|feeder| feeder.interpreter().waits_for(&done))
        {
            Some(feeder) => {
                feeder.interpreter_mut().finish_work(done);
                None
            }
            None => Some(done),
        }
    }

    /// Executes a command; `false` when it is not possible now.
    pub fn execute(&mut self, command: Command, machine: &mut MachineSide) -> bool {
        let rules = self.operation.restart;
        match command {
            Command::Mode(mode) => self.choose_mode(mode, &mut machine.axes.of(self.number)),
            Command::Ce => machine.clear_message(),
            Command::InternalStop => {
                let (run, mut site, _) = self.parts(machine);
                run.internal_stop(&mut site)
            }
            Command::Select(name) => {
                let (run, mut site, basis) = self.parts(machine);
                run.select(name, &mut site, &basis)
            }
            Command::Goto(block) => self.run.goto(block),
            Command::Mdi(blocks) => self.run.set_mdi(blocks),
            Command::MFunction(m) => self.enter(Some(m), None),
            Command::Speed(rpm) => self.enter(None, Some(rpm)),
            Command::Datum(axis, value) => self.set_datum(axis, value, machine),
            Command::JogIncrement(mm) => {
                self.manual.increment = mm;
                true
            }
            Command::ToolLife(tool, minutes) => {
                machine.unsaved = true;
                let done = self.tools.set_life(tool, minutes);
                if done {
                    life::write_life(&mut machine.link.files, tool, minutes);
                }
                done
            }
            Command::Handwheel(axis, factor) => {
                let axes = machine.axes.of(self.number);
                let index = axes.at(axis).map(|unit| unit.index);
                index.is_some_and(|index| {
                    self.manual.choose_handwheel(index, factor);
                    true
                })
            }
            Command::ManualOperation => {
                let (run, mut site, _) = self.parts(machine);
                run.manual_operation(&rules, &mut site)
            }
            Command::RestorePosition => {
                let (run, mut site, _) = self.parts(machine);
                run.restore_position(&mut site)
            }
            Command::RestoreAt(block) => {
                let (run, mut site, basis) = self.parts(machine);
                run.restore_at(block, &rules, &mut site, &basis)
            }
            Command::Code(code) => {
                self.enter_code(code, machine);
                true
            }
            Command::Key(code) => {
                press_key(code, machine.memory.of_mut(self.number));
                true
            }
            Command::Test(name) => {
                let (run, site, basis) = self.parts(machine);
                let feeder = run.test_feeder(&name, &site, &basis);
                feeder.is_some_and(|feeder| {
                    self.test = Some(TestRun::new(&name, feeder));
                    true
                })
            }
            Command::EndTest => {
                self.test = None;
                true
            }
            Command::OffsetAdjustment(adjust) => {
                let done = machine.offsets.answer(adjust, &mut machine.axes);
                machine.unsaved |= done;
                done
            }
        }
    }

    fn choose_mode(&mut self, mode: Mode, axes: &mut OwnAxes) -> bool {
        let possible = match self.run.progress().state() {
            _ if mode == self.mode => true,
            _ if !self.run.is_active() => true,
            RunState::Idle => false,
            // Single block ends a full sequence at the end of its block, and back.
            _ => self.mode != Mode::Mdi && matches!(mode, Mode::SingleBlock | Mode::FullSequence),
        };
        let missing = axes
            .iter()
            .any(|unit| !unit.referenced && !unit.is_plc_axis());
        if !possible || mode == Mode::Reference && !missing {
            return false;
        }
        self.set_mode(mode, axes);
        true
    }

    /// M and S are entered in Manual and Handwheel.
    fn enter(&mut self, m: Option<u16>, s: Option<f64>) -> bool {
        let possible = matches!(self.mode, Mode::Manual | Mode::Handwheel);
        if possible {
            self.manual.enter(m, s);
        }
        possible
    }

    /// DATUM SET: the actual position becomes a value.
    fn set_datum(&mut self, axis: Axis, value: f64, machine: &mut MachineSide) -> bool {
        let axes = machine.axes.of(self.number);
        let done = matches!(self.mode, Mode::Manual | Mode::Handwheel)
            && self
                .datums
                .set(axis, value, &axes, &mut self.chain.offsets);
        machine.unsaved |= done;
        done
    }

    /// A code number; the last one stands in D276 for the PLC [000:6928-6947].
    fn enter_code(&mut self, code: u32, machine: &mut MachineSide) {
        let exchange = machine.memory.of_mut(self.number);
        let number = i32::try_from(code).unwrap_or(i32::MAX);
        exchange.nc_put_number(signal::CODE_NUMBER, number);
        match code {
            ERASE_MEMORY => exchange.erase_retained(),
            CODE_84159 => exchange.nc_put(signal::CODE_84159_ENTERED, true),
            OFFSET_ADJUSTMENT => machine.offsets.shown = true,
            _ => {}
        }
    }

    /// The test run that was started last.
    pub fn test(&self) -> Option<&TestRun> {
        self.test.as_ref()
    }

    /// What survives power-off of the channel: datums, tool, Q parameters, program.
    pub fn remember(&self) -> Remembered {
        let offsets = (self.chain.offsets.tool_length, self.chain.offsets.tool_axis);
        let (tool_length, tool_axis) = self.tools.held_geometry().unwrap_or(offsets);
        Remembered {
            datums: self.datums.points().map(crate::setup::Position0),
            tool: self.tools.number,
            tool_length,
            tool_axis: Some(tool_axis),
            pockets: self.tools.moved(),
            q: self.run.q_values(),
            program: self.run.selection.program.clone(),
            ..Remembered::default()
        }
    }

    /// The state as of now.
    pub fn snapshot(&self, time_us: u64, machine: &MachineSide) -> Snapshot {
        let time = machine.plc.machine.time();
        let run = &self.run;
        Snapshot {
            time_us,
            mode: self.mode,
            run: run.progress().state(),
            ended: run.progress().has_ended(),
            program: run.selection.program.clone(),
            block: run.track.path.element().map(|element| element.block),
            axes: machine
                .axes
                .owned(self.number)
                .map(|unit| self.axis_state(unit))
                .collect(),
            feed_mm_min: run.track.speed_mm_s() * 60.0,
            programmed_feed_mm_min: run.track.programmed_feed(),
            feed_override_percent: self.feed_override.percent(),
            spindle_override_percent: self.spindle_override.percent(),
            spindle: machine.spindles.of(self.number).state(),
            tool: self.tools.number,
            messages: machine.messages.shown().to_vec(),
            waiting: self.handshakes.waiting(machine.memory.of(self.number).nc()),
            plc_percent: [time.current_percent(), time.maximum_percent()],
        }
    }

    fn axis_state(&self, unit: &AxisUnit) -> AxisState {
        let offset = self.chain.offsets.of(unit.axis);
        AxisState {
            letter: unit.axis.letter(),
            index: unit.index,
            actual: unit.shown(unit.servo.actual_mm() - offset),
            nominal: unit.shown(unit.nominal - offset),
            machine: unit.shown(unit.servo.actual_mm()),
            lag: unit.lag_mm(),
            max_lag: unit.max_lag,
            distance_to_go: self.run.distance_to_go(unit, &self.chain),
            referenced: unit.referenced,
            closed: unit.servo.closed(),
            enabled: unit.enabled,
            in_position: unit.in_position,
        }
    }

    /// The block that is executed, while a run is on.
    pub fn running_block(&self) -> Option<BlockRef> {
        self.run.running_block()
    }
}

/// A key of the keyboard: inhibited ones only tell the PLC, with M2182 and W274 [000:7319].
fn press_key(code: u8, exchange: &mut Exchange) {
    let marker = bahn_exchange::Bit::new(bahn_exchange::BitArea::M, KEY_MARKER + u16::from(code));
    if marker.is_some_and(|marker| exchange.nc().bit(marker)) {
        exchange.nc_put_number(signal::INHIBITED_KEY_CODE, code.into());
        exchange.nc_set(signal::INHIBITED_KEY_PRESSED, true);
    }
}

/// The limits of a path: those of the axes by their slots.
fn path_limits<'a>(
    parameters: &ParameterList,
    axes: impl Iterator<Item = &'a AxisUnit> + Clone,
) -> PathLimits {
    let of = |value: fn(&AxisUnit) -> f64, otherwise: f64| {
        Axis::ALL.map(|axis| {
            let mut axes = axes.clone();
            axes.find(|unit| unit.axis == axis).map_or(otherwise, value)
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
