//! The control as others see it: commands in, state and messages out; and its supply, which makes the TNC anew.
//!
//! Decision: Code number 531 210 of a TNC 151/155 erases the list in the control; the file of the folder, which stands
//! for the list on the machine builder's data medium, stays
//!
//! Decision: After power-off axes that were handed over are those of the channel whose list describes them; the
//! operator passes the reference marks again and starts no program (also `host/src/operator.rs`)

use std::sync::Arc;

use bahn_exchange::{Exchange, Image};
use bahn_interpreter::{Done, Interpreter, Work};
use bahn_kernel::{AxisUnit, Feeder, RunState, ServoSampler, ServoView, path_limits};
use bahn_motion::Limits;
use bahn_parameters::code_numbers::ERASE_MEMORY;
use bahn_parameters::{ControlModel, MessageId, ParameterList, PerPlcAxis};
use bahn_path::{PathElement, Switch};
use bahn_plc::{DataLineOrder, HostMessage, OrderedLines, Tracer};
use bahn_reader::{Reader, Warning};
use bahn_servo::Plant;

use crate::alteration::{self, Altered};
use crate::beside::ReadAhead;
use crate::channel::Channel;
use crate::command::{Command, Mode};
use crate::hand_over::{HandOver, Ordered};
use crate::handshake::Waiting;
use crate::key_code::KeyCode;
use crate::language::OwnLanguage;
use crate::message::{Message, Shown};
use crate::oscilloscope::OscilloscopeKeys;
use crate::renewal::{self, Renewed};
use crate::setup::{ChannelError, ChannelSetup, Remembered, Setup};
use crate::signal::Signal;
use crate::snapshot::Snapshot;
use crate::spindle::SpindleState;
use crate::test_run::{TestReport, TestRun};
use crate::tnc::Tnc;
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
    tnc: Tnc,
    /// The commands with their channels, when somebody wants them.
    log: Option<Vec<(u64, usize, Command)>>,
    supply: Supply,
}

/// The power supply, and what the control is made of when it comes.
#[derive(Clone)]
struct Supply {
    made_of: Arc<(Setup, Vec<ChannelSetup>)>,
    off: bool,
    /// How often the control has begun.
    starts: u32,
    /// Module 9033 has reset the control, and nobody has asked since.
    reset: bool,
}

impl Control {
    /// A control of one channel at power-on. The PLC does not run yet, and the loops are open.
    pub fn new(setup: Setup) -> Control {
        let tnc = Tnc::new(setup.clone());
        Control::around(tnc, (setup, Vec::new()))
    }

    /// A control of several channels at power-on: the first one and those beside it. All run under one clock, with
    /// one PLC and one EMERGENCY STOP.
    ///
    /// # Errors
    /// Why the channels cannot be put together.
    pub fn with_channels(setup: Setup, others: Vec<ChannelSetup>) -> Result<Control, ChannelError> {
        let tnc = Tnc::with_channels(setup.clone(), others.clone())?;
        Ok(Control::around(tnc, (setup, others)))
    }

    fn around(tnc: Tnc, made_of: (Setup, Vec<ChannelSetup>)) -> Control {
        Control {
            tnc,
            log: None,
            supply: Supply {
                made_of: Arc::new(made_of),
                off: false,
                starts: 1,
                reset: false,
            },
        }
    }

    /// Whether the supply is off: time passes on the machine alone.
    pub fn is_off(&self) -> bool {
        self.supply.off
    }

    /// How often the control has begun: at power-on, and by a reset.
    pub fn starts(&self) -> u32 {
        self.supply.starts
    }

    /// Switches the supply off or on. What survives is what [`Control::remember`] and the retained memory of the PLC
    /// hold; the list of machine parameters is that of the editor. Time goes on counting.
    fn switch(&mut self, supply: Switch) -> bool {
        if supply.is_on() != self.supply.off {
            return false;
        }
        if supply.is_on() {
            self.supply.off = false;
            self.supply.starts += 1;
            self.tnc.show_power_interrupted();
        } else {
            let list = self.tnc.machine.link.edited_list().clone();
            self.begin_anew(list);
            self.tnc.machine.messages.forget();
            self.supply.off = true;
        }
        true
    }

    /// Takes over what an editor of the machine builder has written; `false` when that is not possible now.
    pub fn renew(&mut self, renewed: Renewed) -> bool {
        let setup = &mut Arc::make_mut(&mut self.supply.made_of).0;
        match renewal::take(renewed, setup, &mut self.tnc, self.supply.off) {
            Altered::Reset(list) => {
                self.begin_anew(*list);
                self.supply.starts += 1;
                self.tnc.machine.unsaved = true;
                true
            }
            altered => altered == Altered::Done,
        }
    }

    /// Time, messages and connections go on from those of a control that was in its place.
    pub fn follow_on(&mut self, before: &Control) {
        self.tnc.follow_on(&before.tnc);
        self.supply.starts = before.supply.starts + 1;
    }

    /// Code number 531 210 of a TNC 151/155 erases the machine parameters and resets M1000 to M2000 [001:1293-1297]. The
    /// list is the one that a control makes when none is entered, until another is.
    fn erase_list(&mut self, channel: usize) {
        self.tnc.execute(channel, Command::Code(ERASE_MEMORY));
        self.begin_anew(ParameterList::smallest(self.model()));
        self.supply.starts += 1;
        self.tnc.machine.messages.forget();
        let erased = Message::Plain(MessageId::OperatingParametersErased);
        self.tnc.machine.messages.of_machine().show(erased, None);
    }

    /// The TNC begins anew with what it has kept, at the time that it is.
    fn begin_anew(&mut self, parameters: ParameterList) {
        let (mut setup, mut others) = (*self.supply.made_of).clone();
        setup.parameters = parameters;
        setup.remembered = self.remember();
        setup.exchange = self.exchange().clone();
        setup.exchange.reset();
        for (number, other) in (1..).zip(&mut others) {
            if let Some(channel) = self.channel(number) {
                other.remembered = channel.remember();
            }
        }
        // They were put together once.
        if let Ok(tnc) = Tnc::with_channels(setup, others) {
            let before = std::mem::replace(&mut self.tnc, tnc);
            self.tnc.follow_on(&before);
        }
    }

    /// Spends one contour cycle on a machine. It does not allocate unless something out of the ordinary
    /// happens: a message, a fault.
    pub fn cycle(&mut self, plant: &mut dyn Plant) {
        self.cycle_traced(plant, None);
    }

    /// Spends a contour cycle and shows a tracer what the PLC executes in it. A traced scan does what any other one
    /// does, in the reference interpreter.
    pub fn cycle_traced(&mut self, plant: &mut dyn Plant, tracer: Option<&mut (dyn Tracer + '_)>) {
        self.cycle_watched(plant, tracer, None);
    }

    /// As [`Control::cycle_traced`], and shows a sampler the axes in each servo step.
    pub fn cycle_watched(
        &mut self,
        plant: &mut dyn Plant,
        tracer: Option<&mut (dyn Tracer + '_)>,
        sampler: Option<&mut (dyn ServoSampler + '_)>,
    ) {
        self.tnc.cycle(self.supply.off, plant, tracer, sampler);
        if std::mem::take(&mut self.tnc.machine.reset_wanted) {
            let list = self.tnc.machine.link.list().clone();
            self.begin_anew(list);
            self.supply.starts += 1;
            self.supply.reset = true;
            self.tnc.machine.unsaved = true;
        }
    }

    /// What was pressed of the oscilloscope.
    pub fn oscilloscope(&self) -> OscilloscopeKeys {
        self.tnc.machine.oscilloscope
    }

    /// The axes as the last servo step left them.
    pub fn servo_view(&self) -> ServoView<'_> {
        ServoView(&self.tnc.machine.core.axes)
    }

    /// Interprets and plans ahead; may allocate. To be called after every cycle.
    pub fn prepare(&mut self) {
        self.tnc.prepare();
    }

    fn give(&mut self, channel: usize, command: Command) -> bool {
        let done = match (command, self.supply.off) {
            (Command::Power(supply), _) => return self.switch(supply),
            // Nobody is there to say that it is not possible.
            (_, true) => return false,
            (Command::Set(assignment), _) => match alteration::set(&mut self.tnc, channel, &assignment) {
                Altered::Reset(list) => {
                    self.begin_anew(*list);
                    self.supply.starts += 1;
                    true
                }
                altered => altered == Altered::Done,
            },
            (Command::Code(ERASE_MEMORY), false) if self.model().erases_its_list() => {
                self.erase_list(channel);
                return true;
            }
            (Command::DataLine(event), _) => return self.tnc.machine.link.lines.happen(event),
            (command, _) => self.tnc.execute(channel, command),
        };
        done || self.refuse(channel)
    }

    /// Channels that it has; they are numbered from 0.
    pub fn channels(&self) -> usize {
        self.tnc.channels.count()
    }

    /// A channel as of now, by its number from 0.
    pub fn channel(&self, number: usize) -> Option<ChannelView<'_>> {
        let channel = self.tnc.channels.get(number)?;
        Some(ChannelView::new(channel, &self.tnc.machine, &self.tnc.clock))
    }

    /// The first channel as of now.
    pub fn first(&self) -> ChannelView<'_> {
        ChannelView::new(self.tnc.channels.first(), &self.tnc.machine, &self.tnc.clock)
    }

    /// The state of a channel as of now.
    pub fn snapshot_of(&self, channel: usize) -> Option<Snapshot> {
        self.channel(channel).map(|channel| channel.snapshot())
    }

    /// From now on the PLC orders by these markers that axes go to other channels.
    pub fn hand_over_by(&mut self, hand_overs: Vec<HandOver>) {
        self.tnc.ordered = hand_overs.into_iter().map(Ordered::new).collect();
    }

    /// Time since power-on, µs.
    pub fn time_us(&self) -> u64 {
        self.tnc.clock.now_us()
    }

    /// The contour cycle, µs.
    pub fn cycle_us(&self) -> u32 {
        self.tnc.machine.core.timing.contour_us()
    }

    /// Leaves computations that take long, as those of an SL contour, to whoever drives the control: runs that
    /// begin from now on wait for [`Control::finish_work`], while everything else goes on.
    pub fn defer_work(&mut self) {
        for channel in self.tnc.channels.iter_mut() {
            channel.run.source.defers = true;
        }
    }

    /// A computation to be done beside.
    pub fn take_work(&mut self) -> Option<Work> {
        let mut feeders = self.tnc.channels.iter_mut().flat_map(Channel::feeders);
        feeders.find_map(|feeder| feeder.interpreter_mut()?.take_work())
    }

    /// What a computation came to. It has no effect when what needed it was given up.
    pub fn finish_work(&mut self, done: Done) {
        let feeders = self.tnc.channels.iter_mut().flat_map(Channel::feeders);
        let mut interpreters = feeders.filter_map(Feeder::interpreter_mut);
        if let Some(interpreter) = interpreters.find(|interpreter| interpreter.waits_for(&done)) {
            interpreter.finish_work(done);
        }
    }

    /// Part programs are read by [`ReadAhead::read`] alone from now on, wherever it is called, or by
    /// [`Control::prepare`] again.
    pub fn read_beside(&mut self, on: bool) {
        for channel in self.tnc.channels.iter_mut() {
            channel.run.source.read_beside(on);
        }
    }

    /// The program of a channel that wants to be read ahead. Until it is [back](Control::take_back) the cycles go on with
    /// what was read before; commands that need the program are not possible, a clone of the control is without it,
    /// and [`Control::interpreter`] and [`Control::remember`] do not know what it came to.
    pub fn hand_over_reading(&mut self) -> Option<ReadAhead> {
        (0..)
            .zip(self.tnc.channels.iter_mut())
            .find_map(|(channel, owner)| {
                let (feeder, loan) = owner.hand_over_program()?;
                Some(ReadAhead {
                    channel,
                    loan,
                    feeder,
                })
            })
    }

    /// A program is back that was handed over.
    pub fn take_back(&mut self, read: ReadAhead) {
        if read.channel < self.tnc.channels.count() {
            let source = &mut self.tnc.channels.of_mut(read.channel).run.source;
            source.end_loan(read.feeder, read.loan);
        }
    }

    /// Simulates the block processing time: no more elements of the path are read than the control has time
    /// for, each taking so long, µs. 0 for no time.
    pub fn set_block_time(&mut self, time_us: u32) {
        for channel in self.tnc.channels.iter_mut() {
            channel.run.core.block_time.set(time_us);
        }
    }

    /// Gives a command of the operator to the first channel: [`Control::command_to`].
    pub fn command(&mut self, command: Command) -> bool {
        self.command_to(0, command)
    }

    /// Gives a command of the operator to a channel; it is logged with the time when a log is kept. `false` when it is
    /// not possible now, or there is no such channel.
    pub fn command_to(&mut self, channel: usize, command: Command) -> bool {
        if channel >= self.tnc.channels.count() {
            return false;
        }
        if let Some(log) = self.log.as_mut().filter(|log| log.len() < LOG_MAX) {
            log.push((self.tnc.clock.now_us(), channel, command.clone()));
        }
        self.give(channel, command)
    }

    /// A command is not possible now.
    fn refuse(&mut self, channel: usize) -> bool {
        let block = self.tnc.channels.of(channel).run.running_block();
        let refused = Message::Plain(MessageId::KeyNonFunctional);
        self.tnc.machine.messages.of_channel(channel).show(refused, block);
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
        self.tnc
            .channels
            .first_mut()
            .execute(command, &mut self.tnc.machine)
    }

    /// The test run that was started last.
    pub fn test_report(&self) -> Option<TestReport> {
        self.tnc.channels.first().test().map(TestRun::report)
    }

    /// A Q parameter of the test run; 0 without one.
    pub fn tested_q(&self, number: u16) -> f64 {
        let test = self.tnc.channels.first().test();
        test.map_or(0.0, |test| test.q_value(number))
    }

    /// The program of the test run as it stands there, to be gone on with beside: for the graphics. Long computations are
    /// left to whoever drives it when they are here.
    pub fn tested(&self) -> Option<Box<dyn Reader>> {
        self.tnc.channels.first().test().map(TestRun::reader)
    }

    /// The limits within which a path is planned.
    pub fn path_limits(&self) -> Limits {
        let channel = self.tnc.channels.first();
        let axes = self.tnc.machine.core.axes.owned(0);
        path_limits(
            self.first().edited_list(),
            axes,
            channel.datums.chain.kinematics(),
        )
    }

    /// What the NC sees of the PLC's memory.
    pub fn memory(&self) -> &Image {
        self.tnc.machine.memory.first().nc()
    }

    /// The exchanged memory, for the journal of retained markers and bytes.
    pub fn exchange(&self) -> &Exchange {
        self.tnc.machine.memory.first()
    }

    /// Lets the end of a tool change wait until what survives power-off is stored: whoever calls
    /// [`Control::prepare`] asks [`Control::unsaved`], writes, and says [`Control::stored`].
    pub fn keep_state(&mut self, keep: bool) {
        self.tnc.keeps = keep;
    }

    /// What survives power-off when it has changed since it was stored.
    pub fn unsaved(&self) -> Option<Remembered> {
        self.tnc.machine.unsaved.then(|| self.remember())
    }

    /// What survives power-off is on the medium.
    pub fn stored(&mut self) {
        self.tnc.machine.unsaved = false;
    }

    /// The name of the list of machine parameters that module 9033 has selected, when the control was reset for it since
    /// this was asked last.
    pub fn take_restart(&mut self) -> Option<String> {
        let selected = &self.tnc.machine.link.selected_list;
        std::mem::take(&mut self.supply.reset).then(|| selected.clone())?
    }

    /// What survives power-off, as of now.
    pub fn remember(&self) -> Remembered {
        let link = &self.tnc.machine.link;
        Remembered {
            pockets: self.tnc.machine.magazine.moved(),
            written: self.tnc.machine.loaded_tables.written(&link.files),
            offsets_volts: offsets_volts(&self.tnc.machine, 0),
            parameter_list: link.selected_list.clone(),
            pallet_line: link.pallet.line,
            datum_table: link.pallet.datum_table.clone(),
            written_datums: self.tnc.machine.loaded_datums.written(link),
            compensation_line: self.tnc.machine.compensation.selected(&link.files),
            ..self.tnc.channels.first().remember()
        }
    }

    /// The unit of [`Control::offsets_shown`], V: 0.15 mV, 2.44 mV of a TNC 151/155 [000:5016] [001:2577].
    pub fn offset_unit_volts(&self) -> f64 {
        self.tnc.machine.core.timing.offset_unit_volts()
    }

    /// The offsets that code number 75 368 shows while its dialogue is open, by axis index [000:5014-5016].
    pub fn offsets_shown(&self) -> Option<PerPlcAxis<i32>> {
        let axes = self.tnc.machine.core.axes.owned(0);
        let units = by_index(axes, |unit| unit.index, |unit| unit.servo.offset_units());
        self.tnc.machine.offsets.shown.then_some(units)
    }

    /// Texts of the PLC dialogues, from 0.
    pub fn plc_dialogues(&self) -> &[String] {
        self.tnc.machine.link.dialogues()
    }

    /// Texts of the PLC messages, from 0.
    pub fn plc_messages(&self) -> &[String] {
        self.tnc.machine.link.messages()
    }

    /// The line of the compensation assignment that is active: it survives power-off [000:15547-15580].
    pub fn compensation_line(&self) -> Option<usize> {
        self.tnc.machine.compensation.line
    }

    /// The state as of now.
    pub fn snapshot(&self) -> Snapshot {
        Snapshot::of(self.tnc.channels.first(), &self.tnc.machine, None)
    }

    /// The state as of now, in the memory of an earlier one: it does not allocate unless another program or
    /// message is shown.
    pub fn snapshot_again(&self, earlier: Snapshot) -> Snapshot {
        Snapshot::of(self.tnc.channels.first(), &self.tnc.machine, Some(earlier))
    }

    /// Messages came up since the last call of [`Control::take_messages`].
    pub fn has_news(&self) -> bool {
        self.tnc.machine.messages.has_news()
    }

    /// What the PLC wants of the data interfaces since `ordered` was asked last.
    pub fn line_orders(&self, ordered: &mut OrderedLines, tell: impl FnMut(DataLineOrder)) {
        ordered.news(&self.tnc.machine.link.lines.interfaces, tell);
    }

    /// The message of the PLC to a host that waits longest [000:15835-15857].
    pub fn message_to_host(&self) -> Option<&HostMessage> {
        self.tnc.machine.link.lines.host.as_ref()?.outgoing.front()
    }

    /// The messages that came up since the last call, in their order.
    pub fn take_messages(&mut self) -> Vec<Shown> {
        self.tnc.machine.messages.take_news()
    }

    /// What FN15 has printed since the last call, with the channel whose program did so; how many lines more there were
    /// that nobody took in time.
    pub fn take_printed(&mut self, take: impl FnMut((usize, Arc<str>))) -> u32 {
        self.tnc.machine.messages.take_printed(take)
    }

    /// The text of a message that is or was shown, with the number of its channel where there are several.
    pub fn shown_text(&self, shown: &Shown) -> String {
        let text = self.message_text(&shown.message);
        match shown.channel.filter(|_| self.channels() > 1) {
            Some(channel) => format!("{}: {text}", channel + 1),
            None => text,
        }
    }

    /// The text of a message as this control shows it.
    pub fn message_text(&self, message: &Message) -> String {
        let machine = &self.tnc.machine;
        message.text(machine.model, &machine.letters(), machine.link.messages())
    }

    /// Keeps the path elements of runs of all channels that begin from now on, for [`Control::take_path`].
    pub fn keep_path(&mut self, keep: bool) {
        for channel in self.tnc.channels.iter_mut() {
            channel.run.source.tap = keep;
        }
    }

    /// Of what [`Control::take_path`] has handed out so far, the elements from a sequence on are not executed: the tool
    /// is replaced before them. To be asked for before it.
    pub fn take_dropped_path(&mut self, channel: usize) -> Option<u64> {
        let feeder = self.tnc.channels.of_mut(channel).run.source.feeder_mut();
        feeder.and_then(|feeder| feeder.take_dropped())
    }

    /// The path elements of a channel that were prepared since the last call, in workpiece coordinates.
    pub fn take_path(&mut self, channel: usize) -> Vec<PathElement> {
        let feeder = self.tnc.channels.of_mut(channel).run.source.feeder_mut();
        feeder.map(|feeder| feeder.take_tap()).unwrap_or_default()
    }

    /// The warnings of a channel's program since the last call.
    pub fn take_warnings(&mut self, channel: usize) -> Vec<Warning> {
        let reader = self.tnc.channels.of_mut(channel).run.source.reader_mut();
        reader.map(Reader::take_warnings).unwrap_or_default()
    }

    /// Operating mode of the first channel.
    pub fn mode(&self) -> Mode {
        self.tnc.channels.first().desk().mode()
    }

    /// State of the first channel's run.
    pub fn run_state(&self) -> RunState {
        self.tnc.channels.first().run.progress().state()
    }

    /// A fault has interrupted the run: nothing of it is on its way, and NC start tries its block again.
    pub fn is_broken(&self) -> bool {
        self.tnc.channels.first().run.progress().is_broken()
    }

    /// The run came to its end since it was started.
    pub fn has_ended(&self) -> bool {
        self.tnc.channels.first().run.progress().has_ended()
    }

    /// The element of the path that is executed, or was last.
    pub fn element(&self) -> Option<&PathElement> {
        self.tnc.channels.first().run.core.track.path.element()
    }

    /// Path length to the end of that element, mm; below 0 where a thread waits after its end.
    pub fn rest_mm(&self) -> f64 {
        self.tnc.channels.first().run.core.track.path.rest_mm()
    }

    /// The program that runs, or ran last; `None` while it is [handed over](Control::hand_over_reading).
    pub fn reader(&self) -> Option<&dyn Reader> {
        self.tnc.channels.first().run.source.reader()
    }

    /// The same as a program of a TNC; `None` when it is in another language.
    pub fn interpreter(&self) -> Option<&Interpreter> {
        self.tnc.channels.first().run.source.interpreter()
    }

    /// Handshake that the run waits for.
    pub fn waiting(&self) -> Option<Waiting> {
        let nc = self.tnc.machine.memory.first().nc();
        self.tnc.channels.first().handshakes.waiting(nc)
    }

    /// Messages that are shown, the oldest first.
    pub fn shown(&self) -> &[Shown] {
        self.tnc.machine.messages.shown()
    }

    /// Tool in the spindle.
    pub fn tool(&self) -> u32 {
        self.tnc.channels.first().tools.number
    }

    /// The loops are closed: the control voltage is there.
    pub fn loops_closed(&self) -> bool {
        self.tnc.machine.core.loops_closed
    }

    /// Feed override in force, %.
    pub fn feed_override_percent(&self) -> f64 {
        self.tnc.channels.first().desk().feed_percent()
    }

    /// State of the first spindle.
    pub fn spindle(&self) -> SpindleState {
        self.tnc.machine.spindles.first().state()
    }

    /// No axis is commanded to move.
    pub fn stands(&self) -> bool {
        self.tnc.machine.core.axes.iter().all(AxisUnit::stands)
    }

    /// The letters of the axes in the order of their indices.
    pub fn axis_letters(&self) -> impl Iterator<Item = char> {
        self.tnc.machine.core.axes.owned(0).map(|unit| unit.axis.letter())
    }

    /// Nominal processing time of the latest PLC scan, %.
    pub fn plc_percent(&self) -> f64 {
        self.tnc.machine.plc.machine.time().current_percent()
    }

    /// The value of a signal now; an axis that the machine does not have reads 0.
    pub fn observe(&self, signal: &Signal) -> f64 {
        signal.value(self.tnc.channels.first(), &self.tnc.machine, &self.tnc.clock)
    }

    /// Model whose limits and functions the control has.
    pub fn model(&self) -> ControlModel {
        self.tnc.machine.model
    }

    /// Scans of the PLC that were started since the control began.
    pub fn plc_scans(&self) -> u64 {
        self.tnc.machine.plc.scans
    }

    /// The PLC: its program, accumulators, processing times, and the error that stopped it.
    pub fn plc(&self) -> &bahn_plc::Machine {
        &self.tnc.machine.plc.machine
    }

    /// Takes the key of the keyboard that the PLC has simulated and nobody inhibits: it is for whoever has
    /// the keyboard [000:7406-7440].
    pub fn take_key(&mut self) -> Option<KeyCode> {
        self.tnc.channels.first_mut().desk.take_key()
    }

    /// The window of the PLC on the screen [000:6603-6617].
    pub fn plc_window(&self) -> &bahn_plc::PlcWindow {
        &self.tnc.machine.link.window
    }

    /// Whether that window is to be seen, as module 9081 tells the PLC [000:15262-15275].
    pub fn show_plc_window(&mut self, view: bahn_plc::WindowView) {
        self.tnc.machine.link.window_view = view;
    }

    /// The program that is selected for single block and full sequence.
    pub fn selected_program(&self) -> Option<&str> {
        self.tnc.channels.first().run.selection.program.as_deref()
    }
}
