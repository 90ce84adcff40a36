//! A channel: operating mode, program run and all that belongs to it. It moves its axes and drives its spindle
//! on the machine side, and has its own window into the memory of the PLC.
//!
//! Decision: A tool change, a datum, a write of module 9094 is on the medium before the next cycle; the strobe of a
//! change waits for it. A change that is broken off did not happen (also `host/src/machine_folder/state.rs`)

pub(crate) mod moves;

use bahn_exchange::signal;
use bahn_interpreter::Rules;
use bahn_kernel::{Axes, AxisUnit, Chain, Feeder, Kinematics, Now, Track, path_limits};
use bahn_parameters::{MessageId, ParameterList};
use bahn_path::Axis;
use bahn_servo::Measured;

use crate::command::{Command, Mode};
use crate::datums::Datums;
use crate::desk::{self, Desk};
use crate::handshake::{Handshakes, Transfer};
use crate::life::{self, LifeCount};
use crate::loops::{self, Permission};
use crate::machine::MachineSide;
use crate::manual_probing::{Answer, ManualProbing, tilted};
use crate::message::Message;
use crate::plc_link::PalletRequest;
use crate::positioning::PlcPositioning;
use crate::probe_command::ProbeCommand;
use crate::programs::Selection;
use crate::run::ProgramRun;
use crate::setup::Remembered;
use crate::site::Site;
use crate::source::{self, Basis, Reading, Source};
use crate::test_run::TestRun;
use crate::tools::Tools;
use crate::{inserted_call, run_command, status, strobes, tables, upkeep};

/// What runs programs on axes of its own: operator's side, run, datums and handshakes.
#[derive(Clone)]
pub(crate) struct Channel {
    number: usize,
    /// Its own list of machine parameters; `None` for that of the machine.
    own_list: Option<ParameterList>,
    pub desk: Desk,
    positioning: PlcPositioning,
    strobes: strobes::Strobes,
    pub handshakes: Handshakes,
    pub datums: Datums,
    pub tools: Tools,
    /// The version of the magazine that the interpreter knows.
    tools_seen: u64,
    /// The interpreter is to know other datums.
    datums_changed: bool,
    /// Of the tool in the spindle.
    life: LifeCount,
    pub run: ProgramRun,
    /// The functions of the TOUCH PROBE menu.
    pub touch: ManualProbing,
    test: Option<TestRun>,
}

/// What a channel is made of.
pub(crate) struct Parts {
    pub number: usize,
    pub own_list: Option<ParameterList>,
    pub kinematics: std::sync::Arc<dyn Kinematics>,
    pub reading: Reading,
}

impl Channel {
    /// A channel at power-on, with what was remembered.
    pub fn new(parts: Parts, remembered: &Remembered, machine: &mut MachineSide) -> Channel {
        let list = parts.own_list.as_ref().unwrap_or(machine.link.list());
        let operation = list.operation_parameters();
        let limits = path_limits(list, machine.core.axes.owned(parts.number), &*parts.kinematics);
        let selection = Selection {
            program: remembered.program.clone(),
            ..Selection::default()
        };
        let source = Source::new(parts.reading, remembered.q.clone());
        let mut channel = Channel {
            number: parts.number,
            own_list: parts.own_list,
            positioning: PlcPositioning::default(),
            strobes: strobes::Strobes::default(),
            handshakes: Handshakes::default(),
            datums: Datums::new(
                remembered,
                operation.datums.datum_for_each_range,
                parts.kinematics,
            ),
            tools: Tools::new(operation.tools, remembered),
            tools_seen: 0,
            datums_changed: false,
            life: LifeCount::default(),
            run: ProgramRun::new(selection, source, Track::new(&limits)),
            touch: ManualProbing::new(remembered.probe),
            test: None,
            desk: Desk::new(operation),
        };
        let mut axes = machine.core.axes.of(channel.number);
        channel.datums.select_range(0, &mut axes);
        let exchange = machine.memory.of_mut(channel.number);
        let axes = machine.core.axes.owned(channel.number);
        status::preset(axes, channel.desk.rules().english, exchange);
        machine.spindles.of(channel.number).preset(exchange);
        channel
    }

    fn list<'a>(&'a self, machine: &'a MachineSide) -> &'a ParameterList {
        self.own_list.as_ref().unwrap_or(machine.link.list())
    }

    pub fn desk(&self) -> &Desk {
        &self.desk
    }

    pub fn number(&self) -> usize {
        self.number
    }

    /// Its kinematics with what is superimposed on it.
    pub fn chain(&self) -> &Chain {
        &self.datums.chain
    }

    /// What movements of this cycle need to know of operator, PLC and faults.
    fn now(&self, machine: &MachineSide) -> Now {
        let mut axes = machine.core.axes.owned(self.number);
        let fault = axes.any(|unit| unit.servo.fault().is_some());
        let probe_mm_min = || self.list(machine).probe().rapid_mm_min;
        let nc = machine.memory.of(self.number).nc();
        self.desk.now(nc, probe_mm_min, machine.facts(fault))
    }

    /// Its run, and what that acts on.
    fn parts<'a>(&'a mut self, machine: &'a mut MachineSide) -> (&'a mut ProgramRun, Site<'a>, Basis<'a>) {
        let now = self.now(machine);
        let site = Site {
            mode: self.desk.mode(),
            now,
            axes: machine.core.axes.of(self.number),
            spindle: machine.spindles.of_mut(self.number),
            tools: &mut self.tools,
            magazine: &machine.magazine,
            chain: &mut self.datums.chain,
            handshakes: &mut self.handshakes,
            positioning: &mut self.positioning,
            exchange: machine.memory.of_mut(self.number),
            messages: machine.messages.of_channel(self.number),
        };
        let basis = Basis {
            list: self.own_list.as_ref().unwrap_or(machine.link.list()),
            link: &machine.link,
            touch: &self.touch,
        };
        (&mut self.run, site, basis)
    }

    /// Shows a message at the block that is executed.
    fn show(&self, message: Message, machine: &mut MachineSide) {
        let block = self.run.running_block();
        machine.messages.of_channel(self.number).show(message, block);
    }

    /// NC stop, or anything that stops like it.
    pub fn stop(&mut self) {
        self.run.stop();
        self.desk.stop();
    }

    /// The control voltage has come: with the first time the control asks for the reference run.
    pub fn loops_closed(&mut self, axes: &mut Axes) {
        self.desk.ask_for_reference(&mut axes.of(self.number));
    }

    /// The loops are opened: nothing moves on.
    pub fn loops_opened(&mut self, machine: &mut MachineSide) {
        self.run.core.part_thread();
        let exchange = machine.memory.of_mut(self.number);
        machine.spindles.of_mut(self.number).open(exchange);
        self.desk.let_go();
        self.positioning.stop();
        self.run.core.track.halt();
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
            loops_closed: machine.core.loops_closed,
            feed_enable: self.desk.panel().feed_enable,
            monitoring_off,
            runs: self.run.progress().goes_on(),
            keeps: machine.has_old_interface(),
        };
        let nc = machine.memory.of(self.number).nc();
        loops::follow(&mut machine.core.axes.of(self.number), nc, permission);
        if nc.bit(signal::NC_STOP_AND_OPEN_LOOPS) {
            self.run.core.part_thread();
            let exchange = machine.memory.of_mut(self.number);
            machine.spindles.of_mut(self.number).open(exchange);
            self.stop();
        }
    }

    /// New faults of loops and spindle stop the channel.
    pub fn take_faults(&mut self, machine: &mut MachineSide) {
        let block = self.run.running_block();
        let axes = machine.core.axes.of(self.number);
        let spindle = machine.spindles.of(self.number);
        if loops::show_faults(&axes, spindle, machine.messages.of_channel(self.number), block) {
            self.run.core.part_thread();
            self.stop();
            // An error with stop ends what the PLC positions [000:4013-4019].
            self.positioning.end_all(machine.memory.of_mut(self.number));
        }
    }

    /// Looks at the stylus, and takes the position of the axes when it is deflected; once in each servo step.
    pub fn watch_probe(&mut self, machine: &MachineSide, measured: &Measured) {
        let nc = machine.memory.of(self.number).nc();
        let guards = nc.bit(signal::NC_STOP_ON_STYLUS_DEFLECTION) && !self.list(machine).probe().on_standby;
        let axes = || machine.core.axes.owned(self.number);
        self.desk
            .watch_stylus(measured, guards, &self.run.probe, || axes().all(AxisUnit::stands));
        self.run.probe.watch(measured, axes(), &self.datums.chain);
    }

    /// The loops are open: neither NC start nor what is turned at the handwheel moves anything when they close.
    pub fn forget_input(&mut self, measured: &Measured) {
        self.desk.forget_input(&measured.operator.handwheel);
    }

    /// A command of the TOUCH PROBE menu.
    fn probe_menu(&mut self, command: ProbeCommand, machine: &mut MachineSide) -> bool {
        let mut touch = self.touch;
        let (leans, barred) = (self.desk.leaning.is_on(), self.run.source.bars_probing());
        let (_, mut site, basis) = self.parts(machine);
        let barred = barred.or_else(|| tilted(command, leans, basis.list, &site.axes));
        let answer = touch.execute(command, basis.list.probe().turn, barred, &mut site);
        self.touch = touch;
        let axes = machine.core.axes.of(self.number);
        let [done, kept] = match answer {
            Answer::Refused => [false; 2],
            Answer::Done => [true, false],
            Answer::Kept => [true; 2],
            Answer::Datum(at) => [self.desk.set_probed(at, &mut self.datums, &axes); 2],
        };
        machine.unsaved |= kept;
        done
    }

    /// Without a run axes that stand count within one turn, and nothing is left to go back to.
    pub fn settle(&mut self, axes: &mut Axes) {
        if !self.run.progress().is_on_its_way() {
            axes.of(self.number).settle();
        }
    }

    /// Tools, handshakes and spindle of a contour cycle. `keeps`: what changes must be stored before its strobe
    /// is reset.
    pub fn follow_plc(&mut self, keeps: bool, machine: &mut MachineSide) {
        let exchange = machine.memory.of_mut(self.number);
        let runs = self.run.is_active() && matches!(self.desk.mode(), Mode::SingleBlock | Mode::FullSequence);
        let counting = life::Counting {
            cycle_us: machine.core.timing.contour_us(),
            runs,
        };
        let (magazine, files) = (&mut machine.magazine, &mut machine.link.files);
        let (life, tools) = (&mut self.life, &mut self.tools);
        machine.unsaved |= life.follow(counting, tools, magazine, exchange, files);
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
            &machine.core.axes.of(self.number),
            machine.memory.of_mut(self.number),
        );
    }

    fn follow_spindle(&mut self, machine: &mut MachineSide) {
        let exchange = machine.memory.of_mut(self.number);
        let spindle = machine.spindles.of_mut(self.number);
        spindle.follow(self.run.core.track.along());
        // In cycle 2 the override of the spindle is off [003:5032].
        let percent = if self.run.core.taps_floating() {
            100.0
        } else {
            self.desk.spindle_percent()
        };
        spindle.cycle(exchange, percent);
        if !spindle.take_wrong_speed() {
            return;
        }
        let message = Message::Plain(MessageId::WrongRpm);
        if let Some(refused) = self.run.core.track.refused() {
            // The run ends before it as soon as the axes stand.
            let messages = machine.messages.of_channel(self.number);
            messages.show(message, Some(refused.block));
            return;
        }
        self.show(message, machine);
        let (run, mut site, _) = self.parts(machine);
        if !run.refuse_block(&mut site) {
            self.stop();
        }
    }

    /// Brings markers and words up to date before a scan.
    pub fn publish(&mut self, measured: &Measured, machine: &mut MachineSide) {
        let (mode, old) = (self.desk.mode(), machine.has_old_interface());
        let exchange = machine.memory.of_mut(self.number);
        self.desk.publish(measured, exchange);
        if old {
            let screen = machine.link.screen().filter(|_| self.test.is_none());
            status::of_old_interface(screen, &self.run, exchange);
        }
        let axes = &mut machine.core.axes.of(self.number);
        status::axes(mode, mode == Mode::Handwheel && !old, axes, exchange);
        status::run(&self.run, !self.handshakes.is_idle(), exchange);
        machine.spindles.of(self.number).publish(exchange);
    }

    /// What modules read of the channel in the next scan.
    pub fn inform(&self, machine: &mut MachineSide) {
        let (axes, link) = (machine.core.axes.owned(self.number), &mut machine.link);
        let spindle = machine.spindles.of(self.number);
        if machine.plc.reads_coordinates {
            status::coordinates(axes, &self.datums.chain, &self.run, self.desk.by_hand(), link);
        }
        status::working_plane(&self.datums.chain, &self.run, self.desk.by_hand().leans, link);
        let executed = self.run.selection.program.as_deref();
        let tested = self.test.as_ref().map(TestRun::program);
        status::items(self.desk.mode(), &self.desk.manual, executed, tested, link);
        link.orienting = spindle.is_orienting();
        link.spindle = spindle.position();
    }

    /// What the PLC asked for in the scan that has ended.
    pub fn after_scan(&mut self, machine: &mut MachineSide) {
        if let Err(code) = self.desk.take_panel(machine.memory.of(self.number)) {
            self.show(Message::PlcMarkers(code), machine);
        }
        let (exchange, magazine) = (machine.memory.of(self.number), &mut machine.magazine);
        self.tools.take_end(magazine, &self.handshakes, exchange);
    }

    /// Takes the strobes that the PLC set in a scan, and resets them.
    pub fn take_strobes(&mut self, machine: &mut MachineSide) {
        let now = self.now(machine);
        let old = machine.has_old_interface();
        let exchange = machine.memory.of_mut(self.number);
        let wanted = self.positioning.follow_strobes(exchange);
        if let Err(code) = wanted.and_then(|wanted| self.strobes.check(wanted, exchange.nc())) {
            self.show(Message::PlcMarkers(code), machine);
            return;
        }
        let mut axes = machine.core.axes.of(self.number);
        let at_strobe = self.handshakes.lets_plc_move(self.desk.rules().axes_wait_at_m);
        let keys = now.axis_keys.iter().any(Option::is_some);
        let may = !self.run.progress().is_running() || at_strobe;
        let free = may && !keys && !now.stop;
        let most = usize::from(machine.model.limits().plc_positioning_axes_max);
        let (nc, numbers) = (exchange.nc(), &machine.plc_parameters);
        self.positioning.take_strobes(nc, numbers, free, most, &axes);
        self.positioning.take_free_rotation(exchange);
        if strobes::take_range(&mut self.datums, &mut axes, exchange) {
            self.run.core.track.range_changed = self.run.is_active();
        }
        if let Some(shift) = strobes::datum_correction(may, self.datums.range(), numbers, exchange) {
            self.datums.correct(shift, &axes);
        }
        if let Some((number, value)) = self.strobes.q_parameter(exchange) {
            self.run.set_q(number, value);
        }
        strobes::take_actual_values(self.desk.mode(), old, &mut axes, exchange.nc());
        // A key waits for the program that is read elsewhere.
        let key = strobes::key(exchange.nc()).filter(|_| !self.run.source.is_handed_over());
        if let Some(command) = key {
            let done = command.is_some_and(|command| self.execute(command, machine));
            strobes::end_key(done, machine.memory.of_mut(self.number));
        }
        let exchange = machine.memory.of_mut(self.number);
        let mut axes = machine.core.axes.of(self.number);
        strobes::take_lubrication(&mut axes, exchange);
        strobes::take_lag_tracking(machine.plc_parameters.tracking_step_mm, &mut axes, exchange.nc());
        let offsets = &mut self.datums.chain.offsets;
        self.tools
            .take_geometry_strobe(&machine.magazine, exchange, offsets);
        let spindle = machine.spindles.of_mut(self.number);
        if let Some(code) = spindle.take_markers(exchange, &machine.plc_parameters) {
            self.show(Message::PlcMarkers(code), machine);
        }
    }

    /// What modules asked for in a scan of the channel, which they take for the only one.
    pub fn take_module_requests(&mut self, machine: &mut MachineSide) {
        let requests = &mut machine.link.requests;
        self.positioning.take_requests(requests);
        self.desk.manual.take_status(std::mem::take(&mut requests.status));
        if let Some(request) = requests.pallet.take_if(|_| !self.run.source.is_handed_over()) {
            self.select_pallet(request, machine);
        }
        if let Some(call) = machine.link.requests.tool_call.take() {
            let (run, mut site, _) = self.parts(machine);
            inserted_call::take(call, run, &mut site);
        }
        let requests = &mut machine.link.requests;
        if std::mem::take(&mut requests.geometry) {
            tables::initialise_geometry(
                &mut self.tools,
                &mut machine.magazine,
                &machine.link.files,
                &mut self.datums.chain.offsets,
            );
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
        self.run.source.set_rules(self.touch.calibrated(Rules::of(list)));
        let operation = list.operation_parameters();
        self.datums.each_range = operation.datums.datum_for_each_range;
        self.desk.set_rules(operation);
        let spindle = machine.spindles.of_mut(self.number);
        spindle.drive.set_parameters(list.spindle_parameters());
        let mut axes = machine.core.axes.of(self.number);
        axes.set_parameters(list);
        self.datums.limit(&mut axes);
        let intervals = axes.iter().map(|unit| unit.parameters.offset_interval_s);
        machine.offsets.set_interval(intervals.last().unwrap_or(0.0));
        self.run.core.track.limits_changed = true;
    }

    /// Its axes are others from now on: the path has their limits, the datum their corrections.
    pub fn take_axes(&mut self, machine: &mut MachineSide) {
        let (list, axes) = (self.list(machine), machine.core.axes.owned(self.number));
        let limits = path_limits(list, axes, self.datums.chain.kinematics());
        self.run.core.track.change_limits(&limits, self.run.is_active());
        let range = self.datums.range();
        self.datums
            .select_range(range, &mut machine.core.axes.of(self.number));
    }

    /// Interprets and plans ahead; may allocate. `datums_changed`: blocks that are read from now on find other
    /// datums in the tables.
    pub fn prepare(&mut self, datums_changed: bool, machine: &mut MachineSide) {
        if self.run.core.track.limits_changed && !self.run.is_active() {
            let list = self.own_list.as_ref().unwrap_or(machine.link.list());
            let axes = machine.core.axes.owned(self.number);
            let limits = path_limits(list, axes, self.datums.chain.kinematics());
            self.run.core.track.take_limits(&limits);
        }
        self.datums_changed |= datums_changed;
        let by_hand = self.desk.is_by_hand() && !self.run.progress().is_on_its_way();
        self.desk.leaning.refresh(by_hand, &mut self.datums.chain);
        if self.run.source.is_handed_over() {
            return self.prepare_test(machine);
        }
        let datums_changed = std::mem::take(&mut self.datums_changed);
        let rules = self.desk.rules().restart;
        let version = machine.magazine.version();
        let tools_changed = std::mem::replace(&mut self.tools_seen, version) != version;
        let (run, mut site, basis) = self.parts(machine);
        run.read_on(&rules, &mut site);
        run.close(&mut site, &basis);
        if let Some(interpreter) = run.source.interpreter_mut() {
            source::renew(interpreter, [tools_changed, datums_changed], &site, &basis);
        }
        run.prepare(&mut site, &basis);
        self.prepare_test(machine);
    }

    fn prepare_test(&mut self, machine: &MachineSide) {
        if let Some(test) = &mut self.test {
            let axes = machine.core.axes.owned(self.number);
            test.prepare(machine.spindles.of(self.number), axes);
        }
    }

    /// Its program, to be read beside the control, and the number of the loan.
    pub fn hand_over_program(&mut self) -> Option<(Feeder, u64)> {
        let runs = self.run.progress().is_on_its_way();
        runs.then(|| self.run.source.hand_over_program()).flatten()
    }

    /// The programs that are read: that of the run, and that of a test run.
    pub fn feeders(&mut self) -> impl Iterator<Item = &mut Feeder> {
        let run = self.run.source.feeder_mut().into_iter();
        run.chain(self.test.as_mut().map(TestRun::feeder))
    }

    /// Executes a command; `false` when it is not possible now.
    pub fn execute(&mut self, command: Command, machine: &mut MachineSide) -> bool {
        let rules = self.desk.rules().restart;
        let probes = self.desk.is_by_hand() && self.run.probe.is_on();
        if self.run.source.is_handed_over() && command.needs_program() || probes && command.needs_axes() {
            return false;
        }
        match command {
            Command::Probe(command) => self.desk.is_by_hand() && self.probe_menu(command, machine),
            Command::Mode(mode) => {
                self.touch.leave();
                let mut axes = machine.core.axes.of(self.number);
                self.desk.choose_mode(mode, self.run.progress(), &mut axes)
            }
            Command::Output(feed) => self
                .desk
                .manual
                .set_step(feed, &machine.core.axes.of(self.number)),
            Command::Pnt(switch) => {
                let probe = self.list(machine).measuring_probe();
                self.desk
                    .switch_pnt(switch.is_on(), probe.filter(|_| !self.run.is_active()))
            }
            Command::WorkingPlane(plane) if !plane.run => {
                self.touch.leave();
                let list = self.own_list.as_ref().unwrap_or(machine.link.list());
                let (axes, chain) = (machine.core.axes.of(self.number), &mut self.datums.chain);
                self.desk.switch_plane(&plane, list, &axes, chain)
            }
            ref entered if entered.is_by_hand() => {
                let axes = &machine.core.axes.of(self.number);
                self.desk.enter(&command, machine.model, axes)
            }
            Command::Datum(axis, value) => self.set_datum(axis, value, machine),
            Command::AxisLimit(axis, range, limits) if !self.run.is_active() => {
                let axes = &mut machine.core.axes.of(self.number);
                let done = self.datums.set_limit(axis, range, limits, axes);
                machine.unsaved |= done;
                done
            }
            Command::Code(code) => {
                self.desk.take_code(code);
                machine.offsets.shown |= desk::enter_code(code, machine.memory.of_mut(self.number));
                machine.oscilloscope.enter_code(code, machine.link.list().model())
            }
            Command::Key(code) => self.desk.press_key(code, machine.memory.of_mut(self.number)),
            Command::Test(name) => {
                let axes = machine.core.axes.iter().map(|unit| unit.axis).collect();
                let (run, site, basis) = self.parts(machine);
                match run.source.feeder_for_test(&name, axes, &site, &basis) {
                    Ok(feeder) => {
                        self.test = Some(TestRun::new(&name, feeder));
                        true
                    }
                    Err(message) => {
                        site.messages.show(message, None);
                        false
                    }
                }
            }
            Command::TestRun(command) => self.test.as_mut().is_some_and(|test| test.execute(command)),
            Command::EndTest => {
                self.test = None;
                true
            }
            command => machine.execute(&command).unwrap_or_else(|| {
                let (run, mut site, basis) = self.parts(machine);
                run_command::execute(command, &rules, run, &mut site, &basis)
            }),
        }
    }

    /// DATUM SET: the actual position becomes a value.
    fn set_datum(&mut self, axis: Axis, value: f64, machine: &mut MachineSide) -> bool {
        let axes = machine.core.axes.of(self.number);
        let done = self.desk.is_by_hand() && self.desk.set_datum(axis, value, &mut self.datums, &axes);
        machine.unsaved |= done;
        done
    }

    /// The test run that was started last.
    pub fn test(&self) -> Option<&TestRun> {
        self.test.as_ref()
    }

    /// What survives power-off of the channel: datums, tool, Q parameters, program.
    pub fn remember(&self) -> Remembered {
        let (tool_length, tool_axis) = self.tools.remembered_geometry(&self.datums.chain.offsets);
        Remembered {
            datums: self.datums.points().map(crate::setup::Position0),
            tool: self.tools.number,
            tool_length,
            tool_axis: Some(tool_axis),
            tool_probe: self.tools.calibration,
            q: self.run.q_values(),
            program: self.run.selection.program.clone(),
            probe: self.touch.memory,
            axis_limits: self.datums.axis_limits().to_vec(),
            ..Remembered::default()
        }
    }
}
