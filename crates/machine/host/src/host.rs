//! A machine that is switched on.
//!
//! Decision: Channels that cannot be put together, or of which some are missing at power-on, are an error and never a
//! machine with fewer of them
//!
//! Decision: Planning ahead and the cycle share the control, and so a thread, in real time, too; contours that take
//! long have one of their own
//!
//! Decision: At power-on tools lie in the simulated magazine where the control remembers them: chain and arm are
//! mechanics, which survive by themselves

use std::sync::Arc;
use std::sync::atomic::{AtomicBool, Ordering};
use std::time::Duration;

use bahn_interpreter::Warning;
use bahn_machine::Machine;
use bahn_path::PathElement;
use bahn_plc::{Tracer, WindowView};
use bahn_tnc::{
    Cartesian, ChannelSetup, Command, Control, Dnc, KeyCode, Programs, Renewed, ServoSampler, Setup,
    Snapshot, SpindleWiring,
};

use crate::action::{Action, Answer, Source};
use crate::background::Background;
use crate::digitizing::{Digitizing, Written};
use crate::error::HostError;
use crate::feed::Reader;
use crate::feeds::Feeds;
use crate::journal::{Given, Journal};
use crate::log::Sink;
use crate::machine_folder::{LoadedChannel, LoadedMachine, State};
use crate::moment::Moment;
use crate::notice::{Before, Notice, Stamped, Why};
use crate::operable::Operable;
use crate::operator::Operator;
use crate::orders::{Desk, Waiting, When};
use crate::pace::{Clock, Lateness, Pacing};
use crate::power_on::{ChannelPowerOn, PowerOn};

/// Control and plant, driven cycle by cycle, observed, and kept over power-off.
///
/// [`Host::step`] is one contour cycle: what is due is done, the operator acts, the control prepares and spends
/// the cycle, what must survive is stored, and what has changed is told. The same machine and the same actions at
/// the same times give the same bits, but for computations that a [`Clock::Wall`] does not wait for.
pub struct Host<P = Machine> {
    pub(crate) now: Moment<P>,
    pub(crate) journal: Journal,
    pub(crate) background: Background,
    digitized: Digitized,
    feeds: Feeds,
    pacing: Pacing,
    looks: Looks,
    /// What was is repeated: nobody is told, and nothing is stored but in the end.
    pub(crate) repeats: bool,
    desk: Desk,
    state: Option<State>,
    sink: Option<Box<dyn Sink + Send>>,
    break_off: Arc<AtomicBool>,
}

/// What becomes of what is digitized.
struct Digitized {
    /// The interface function PRINT: of the interfaces, not of the machine.
    prints: bool,
    /// Where the programs of each channel are.
    programs: Vec<Arc<dyn Programs>>,
}

impl Digitized {
    fn by(first: &Arc<dyn Programs>, power_on: &PowerOn) -> Digitized {
        let others = power_on.channels.iter();
        let others = others.map(|channel| Arc::clone(&channel.programs));
        Digitized {
            prints: false,
            programs: std::iter::once(Arc::clone(first)).chain(others).collect(),
        }
    }
}

/// What whoever follows looks at in every cycle.
#[derive(Default)]
struct Looks {
    /// What programs have read.
    programs: bool,
    /// How the window of the PLC is to be seen.
    window: WindowView,
}

impl Host {
    /// Switches on the simulated machine of a folder.
    ///
    /// # Errors
    /// When the folder describes no simulated machine, or the channels cannot be put together.
    pub fn new(
        machine: &LoadedMachine,
        power_on: PowerOn,
        programs: Arc<dyn Programs>,
        operator: Operator,
    ) -> Result<Host, HostError> {
        let plant = power_on.simulated(machine)?;
        Host::with_plant(machine, plant, power_on, programs, operator)
    }
}

impl<P: Operable> Host<P> {
    /// Switches on the control of a folder with a plant of one's own.
    ///
    /// # Errors
    /// When the channels cannot be put together.
    pub fn with_plant(
        machine: &LoadedMachine,
        plant: P,
        mut power_on: PowerOn,
        programs: Arc<dyn Programs>,
        operator: Operator,
    ) -> Result<Host<P>, HostError> {
        let digitized = Digitized::by(&programs, &power_on);
        let state = power_on.state.take();
        let mut control = control_of(machine, power_on, programs)?;
        control.keep_state(state.is_some());
        Ok(Host {
            now: Moment::new(control, plant, operator),
            journal: Journal::default(),
            background: Background::default(),
            digitized,
            feeds: Feeds::default(),
            pacing: Pacing::default(),
            looks: Looks::default(),
            repeats: false,
            desk: Desk::default(),
            state,
            sink: None,
            break_off: Arc::default(),
        })
    }

    /// Gives back what survives power-off, so that somebody else can take it; nothing is kept from now on.
    pub fn release_state(&mut self) {
        self.state = None;
    }

    /// What survives power-off is kept there from now on.
    pub fn keep_in(&mut self, state: State) {
        self.state = Some(state);
    }

    /// Another machine takes the place of this one, as its files are by now: time goes on, whoever follows and orders stays,
    /// and what was given before is forgotten. A plant that is not described by the files stays what it is.
    ///
    /// # Errors
    /// When the channels cannot be put together; everything stays as it is.
    pub fn replace(
        &mut self,
        machine: &LoadedMachine,
        mut power_on: PowerOn,
        programs: Arc<dyn Programs>,
        operator: Operator,
    ) -> Result<(), HostError> {
        let digitized = Digitized::by(&programs, &power_on);
        let described = power_on.simulated(machine).ok();
        let state = power_on.state.take();
        let mut control = control_of(machine, power_on, programs)?;
        control.keep_state(state.is_some());
        control.follow_on(&self.now.control);
        let now = &mut self.now;
        if let Some(described) = described {
            now.plant.renew(described);
        }
        now.digitizing = vec![Digitizing::default(); control.channels()];
        (now.control, now.operator) = (control, operator);
        (now.before, now.waiting, now.restart) = (Before::default(), Waiting::default(), None);
        self.digitized.programs = digitized.programs;
        self.state = state;
        self.journal = Journal::default();
        self.forget_background();
        Ok(())
    }

    /// One contour cycle: [`Host::begin`] and [`Host::cycle`].
    ///
    /// # Errors
    /// When the log or what survives power-off cannot be written. The machine can go on all the same.
    pub fn step(&mut self) -> Result<(), HostError> {
        self.begin()?;
        self.cycle()
    }

    /// Does what is due before the cycle, and lets the operator act.
    ///
    /// # Errors
    /// When the log cannot be written.
    pub fn begin(&mut self) -> Result<(), HostError> {
        while let Some(order) = self.next_order() {
            let now = self.now.control.time_us();
            self.journal.add(now, Given::Order(order.clone()));
            self.take(order);
        }
        while let Some(order) = self.now.waiting.due(self.now.control.time_us()) {
            self.execute(order.source, order.action)?;
        }
        if let Some((channel, action, why)) = self.now.operator.act(&self.now.control) {
            if let (Action::Event(bahn_machine::Event::Key(key, _), _), Why::Stop | Why::ToolChange) =
                (&action, why)
            {
                let key = key.clone();
                self.tell_in(channel, Notice::Confirmed { key, why });
            }
            self.execute(Source::Operator, action)?;
        }
        Ok(())
    }

    /// Spends a contour cycle, stores what must survive, tells what has changed, and waits for the clock.
    ///
    /// # Errors
    /// [`HostError::NotStored`].
    pub fn cycle(&mut self) -> Result<(), HostError> {
        self.cycle_traced(None)
    }

    /// As [`Host::cycle`], and shows a tracer what the PLC executes.
    ///
    /// # Errors
    /// [`HostError::NotStored`].
    pub fn cycle_traced(&mut self, tracer: Option<&mut (dyn Tracer + '_)>) -> Result<(), HostError> {
        self.cycle_watched(tracer, None)
    }

    /// As [`Host::cycle_traced`], and shows a sampler the axes in each servo step.
    ///
    /// # Errors
    /// [`HostError::NotStored`].
    pub fn cycle_watched(
        &mut self,
        tracer: Option<&mut (dyn Tracer + '_)>,
        sampler: Option<&mut (dyn ServoSampler + '_)>,
    ) -> Result<(), HostError> {
        let beside = self.works_beside();
        self.background
            .prepare(&mut self.now.control, beside, &self.break_off);
        self.now.control.show_plc_window(self.looks.window);
        self.now
            .control
            .cycle_watched(&mut self.now.plant, tracer, sampler);
        self.now.plant.tool_is_called(self.now.control.tool());
        // A message names the program of its block.
        if self.looks.programs || self.now.control.has_news() {
            self.background.settle(&mut self.now.control);
        }
        if let Some(list) = self.now.control.take_restart() {
            self.forget_background();
            self.tell(Notice::Restart(list.clone()));
            self.now.restart = Some(list);
        }
        let kept = self.keep().and(self.keep_digitized());
        let now = &mut self.now;
        self.feeds.look(&mut now.before, &mut now.control, self.repeats);
        if !self.repeats {
            self.pacing.keep(self.now.control.time_us());
        }
        kept
    }

    /// Does something at once, between two cycles.
    ///
    /// # Errors
    /// When the log cannot be written.
    pub fn act(&mut self, source: Source, action: Action) -> Result<Answer, HostError> {
        let now = self.now.control.time_us();
        self.journal
            .add(now, Given::AtOnce(source.clone(), action.clone()));
        self.execute(source, action)
    }

    /// Gives an order; [`Host::desk`] takes them from any thread.
    ///
    /// # Errors
    /// [`HostError::Busy`] when too many wait.
    pub fn order(&self, source: Source, when: When, action: Action) -> Result<(), HostError> {
        self.desk.give(source, when, action)
    }

    /// Where others give orders.
    pub fn desk(&self) -> Desk {
        self.desk.clone()
    }

    /// What was given at the desk. Of the past nobody orders anything more.
    fn next_order(&self) -> Option<crate::orders::Order> {
        if self.repeats { None } else { self.desk.take() }
    }

    /// An order that finds no place among those that wait is answered at once.
    pub(crate) fn take(&mut self, order: crate::orders::Order) {
        let (source, action) = (order.source.clone(), order.action.clone());
        if !self.now.waiting.add(order, self.now.control.time_us()) {
            let answer = Answer::Impossible(HostError::Busy.to_string());
            self.tell(Notice::Given(source, action, answer));
        }
    }

    pub(crate) fn execute(&mut self, source: Source, action: Action) -> Result<Answer, HostError> {
        if let Some(sink) = &mut self.sink {
            sink.note(self.now.control.time_us(), &source, &action.to_string())?;
        }
        // What comes of a program that is transferred waits in the control.
        let waits = matches!(action, Action::Command(_, Command::Dnc(Dnc::Text(_))));
        if matches!(action, Action::Command(..)) && !waits {
            self.background.settle(&mut self.now.control);
        }
        let answer = match &action {
            Action::Command(channel, command) => self.command(*channel, command),
            Action::Event(event, _) => match self.now.plant.operate(event) {
                Ok(()) => Answer::Done,
                Err(what) => Answer::Impossible(what),
            },
        };
        self.tell(Notice::Given(source, action, answer.clone()));
        Ok(answer)
    }

    fn command(&mut self, channel: usize, command: &Command) -> Answer {
        if channel >= self.now.control.channels() {
            return Answer::Impossible(format!("the machine has no channel {}", channel + 1));
        }
        let before = (self.now.control.starts(), self.now.control.is_off());
        let done = self.now.control.command_to(channel, command.clone());
        if before != (self.now.control.starts(), self.now.control.is_off()) {
            self.forget_background();
        }
        match done {
            true => Answer::Done,
            false => Answer::Refused,
        }
    }

    /// What is computed or read in the background belongs to the control that was on before.
    fn forget_background(&mut self) {
        self.background = Background::default();
        let beside = self.works_beside();
        self.background.read_beside(&mut self.now.control, beside);
    }

    /// Stores what the control waits for at once, everything else now and then.
    fn keep(&mut self) -> Result<(), HostError> {
        let Some(state) = &mut self.state else {
            return Ok(());
        };
        let waits = self.now.control.unsaved().is_some();
        if !self.repeats && (waits || state.is_due()) {
            self.background.settle(&mut self.now.control);
        }
        if self.repeats {
            if waits {
                self.now.control.stored();
            }
            return Ok(());
        }
        if let Err(error) = state.keep(&mut self.now.control, &self.now.plant) {
            self.tell(Notice::Fault(error.to_string()));
            return Err(HostError::NotStored(error.to_string()));
        }
        if waits {
            self.tell(Notice::Stored);
        }
        Ok(())
    }

    /// What is digitized from now on is printed block by block as [`Notice::Printed`], not stored: the interface function PRINT
    /// [003:6554-6557].
    pub fn print_digitized(&mut self, prints: bool) {
        self.digitized.prints = prints;
    }

    /// Takes the points of channels that digitize, and stores a program whose range is scanned.
    fn keep_digitized(&mut self) -> Result<(), HostError> {
        let mut kept = Ok(());
        for number in 0..self.now.digitizing.len() {
            let news = self
                .now
                .control
                .channel(number)
                .map(|channel| channel.digitized());
            let (Some(digitizing), Some(news)) = (self.now.digitizing.get_mut(number), news) else {
                continue;
            };
            let complete = match digitizing
                .follow(news, self.digitized.prints)
                .filter(|_| !self.repeats)
            {
                Some(Written::Complete(complete)) => complete,
                Some(Written::Printed(blocks)) => {
                    for block in blocks.lines() {
                        self.tell_in(number, Notice::Printed(block.into()));
                    }
                    continue;
                }
                None => continue,
            };
            let stored = self.digitized.programs.get(number).map_or(Ok(()), |programs| {
                programs.store(&complete.name, &complete.pieces)
            });
            match stored {
                Ok(()) => self.tell_in(number, Notice::Digitized(complete.name, complete.points)),
                Err(error) => {
                    self.tell(Notice::Fault(error.clone()));
                    kept = Err(HostError::NotStored(error));
                }
            }
        }
        kept
    }

    pub(crate) fn tell(&self, notice: Notice) {
        let channel = match &notice {
            Notice::Given(_, Action::Command(channel, _), _) => *channel,
            _ => 0,
        };
        self.tell_in(channel, notice);
    }

    fn tell_in(&self, channel: usize, notice: Notice) {
        if !self.repeats {
            self.feeds.tell(self.now.control.time_us(), channel, notice);
        }
    }

    /// Stores everything: the machine is switched off, or is where it was before.
    ///
    /// # Errors
    /// [`HostError::NotStored`].
    pub fn store(&mut self) -> Result<(), HostError> {
        self.background.settle(&mut self.now.control);
        match &mut self.state {
            Some(state) => state
                .flush(&self.now.control, &self.now.plant)
                .map_err(|error| HostError::NotStored(error.to_string())),
            None => Ok(()),
        }
    }

    /// The control as of now, to be looked at.
    pub fn control(&self) -> &Control {
        &self.now.control
    }

    /// Takes the key that the PLC has simulated; see [`Control::take_key`].
    pub fn take_key(&mut self) -> Option<KeyCode> {
        self.now.control.take_key()
    }

    /// Tells the PLC whether its window is to be seen; see [`Control::show_plc_window`].
    /// Holds from the next cycle on, also when the control begins anew.
    pub fn show_plc_window(&mut self, view: WindowView) {
        self.looks.window = view;
    }

    /// Takes over what an editor has written; see [`Control::renew`]. Who goes back finds what was there then.
    pub fn renew(&mut self, renewed: Renewed) -> bool {
        let now = self.now.control.time_us();
        self.journal.add(now, Given::Renewed(renewed.clone()));
        self.take_over(renewed)
    }

    pub(crate) fn take_over(&mut self, renewed: Renewed) -> bool {
        let starts = self.now.control.starts();
        self.background.settle(&mut self.now.control);
        let done = self.now.control.renew(renewed);
        if starts != self.now.control.starts() {
            self.forget_background();
        }
        done
    }

    /// The plant as of now, to be looked at.
    pub fn plant(&self) -> &P {
        &self.now.plant
    }

    /// The plant, to be changed between two cycles: no log notes that.
    pub fn plant_mut(&mut self) -> &mut P {
        &mut self.now.plant
    }

    /// The operator who stands by.
    pub fn operator(&self) -> &Operator {
        &self.now.operator
    }

    /// The list of machine parameters with which the control is to be started anew.
    pub fn restart(&self) -> Option<&str> {
        self.now.restart.as_deref()
    }

    /// A reader of what happens from now on.
    pub fn notices(&self) -> Reader<Stamped> {
        self.feeds.notices()
    }

    /// A reader of the snapshots from now on; see [`Host::take_snapshots`].
    pub fn snapshots(&self) -> Reader<Snapshot> {
        self.feeds.snapshots()
    }

    /// Takes a snapshot every so many µs of the machine from now on; 0 is every contour cycle.
    pub fn take_snapshots(&mut self, every_us: u64) {
        self.feeds.take_snapshots(every_us, self.now.control.time_us());
    }

    /// Runs by another clock from now on. By that on the wall part programs are read on a thread of their own: what a
    /// program needs to be read holds no cycle. It is back for every action, and for what is stored.
    pub fn set_clock(&mut self, clock: Clock) {
        self.pacing.begin(clock, self.now.control.time_us());
        let beside = self.works_beside();
        self.background.read_beside(&mut self.now.control, beside);
    }

    /// From now on no cycle waits for real time: whoever lets them pass waits as long as [`Host::rest`] says,
    /// and can do something else meanwhile.
    pub fn pace_outside(&mut self) {
        self.pacing.wait_outside();
    }

    /// How long it is until the time of the last cycle is over in real time.
    pub fn rest(&self) -> Duration {
        self.pacing.rest()
    }

    /// From now on a cycle waits for what programs need to be read and computed, also in real time: what is
    /// given then at the same times gives the same bits again, at the price of cycles that come late.
    pub fn be_exact(&mut self) {
        self.pacing.be_exact();
        self.set_clock(self.pacing.clock());
    }

    /// Programs are read, and long computations done, on a thread of their own.
    fn works_beside(&self) -> bool {
        self.pacing.works_beside() && !self.repeats
    }

    /// The clock begins anew: the machine is at another time.
    pub(crate) fn reset_clock(&mut self) {
        self.set_clock(self.pacing.clock());
        self.feeds.reset(self.now.control.time_us());
    }

    /// What programs have read is there after every cycle, also in real time: their Q parameters, and
    /// [`Control::interpreter`]. A cycle then waits for what is read beside.
    pub fn watch_programs(&mut self) {
        self.looks.programs = true;
    }

    /// How well the pace of the wall was kept; `None` where the machine runs freely.
    pub fn lateness(&self) -> Option<Lateness> {
        self.pacing.lateness()
    }

    /// Notes what is done from now on.
    pub fn set_log(&mut self, sink: Box<dyn Sink + Send>) {
        self.sink = Some(sink);
    }

    /// Notes something that is no action.
    ///
    /// # Errors
    /// When the log cannot be written.
    pub fn remark(&mut self, source: &Source, what: &str) -> Result<(), HostError> {
        match &mut self.sink {
            Some(sink) => sink.note(self.now.control.time_us(), source, what),
            None => Ok(()),
        }
    }

    pub(crate) fn is_logged(&self) -> bool {
        self.sink.is_some()
    }

    /// Completes the log.
    ///
    /// # Errors
    /// When it cannot be written.
    pub fn finish_log(&mut self) -> Result<(), HostError> {
        self.sink.take().map_or(Ok(()), |mut sink| sink.finish())
    }

    /// While this is set, nothing waits for a computation that takes long, and nothing that was is repeated.
    pub fn break_off_by(&mut self, flag: Arc<AtomicBool>) {
        self.break_off = flag;
    }

    /// The flag that breaks off is set.
    pub fn is_broken_off(&self) -> bool {
        self.break_off.load(Ordering::Relaxed)
    }

    /// Keeps the path elements of runs of all channels that begin from now on, for [`Host::take_path`].
    pub fn keep_path(&mut self) {
        self.now.control.keep_path(true);
    }

    /// The path elements of a channel that were prepared since the last call, in workpiece coordinates.
    pub fn take_path(&mut self, channel: usize) -> Vec<PathElement> {
        self.now.control.take_path(channel)
    }

    /// The first element that is executed no more, of those that were taken: see [`Control::take_dropped_path`].
    pub fn take_dropped_path(&mut self, channel: usize) -> Option<u64> {
        self.now.control.take_dropped_path(channel)
    }

    /// The warnings of a channel's interpreter since the last call.
    pub fn take_warnings(&mut self, channel: usize) -> Vec<Warning> {
        self.now.control.take_warnings(channel)
    }
}

/// The control of a folder. Channels that do not fit are no machine, and never another one.
fn control_of(
    machine: &LoadedMachine,
    power_on: PowerOn,
    programs: Arc<dyn Programs>,
) -> Result<Control, HostError> {
    let (there, found) = (machine.channels.len(), power_on.channels.len());
    if there != found {
        return Err(HostError::ChannelsMissing(there, found));
    }
    let block_time_ms = power_on.parameters.model().limits().block_time_ms;
    let setup = Setup {
        parameters: power_on.parameters,
        plc: Arc::clone(&machine.plc),
        plc_messages: machine.plc_messages.clone(),
        plc_dialogues: machine.plc_dialogues.clone(),
        tools: machine.tools.clone(),
        checking: power_on.checking,
        inch_feed: power_on.inch_feed,
        functions: machine.functions.clone(),
        programs,
        files: machine.files.clone(),
        remembered: power_on.remembered,
        exchange: power_on.exchange,
    };
    let mut control = Control::with_channels(setup, channel_setups(machine, power_on.channels))?;
    control.hand_over_by(machine.hand_overs.clone());
    if power_on.block_time {
        control.set_block_time((block_time_ms * 1e3) as u32);
    }
    control.defer_work();
    Ok(control)
}

/// The channels beside the first one, as the control takes them.
fn channel_setups(machine: &LoadedMachine, found: Vec<ChannelPowerOn>) -> Vec<ChannelSetup> {
    let channels = machine.channels.iter().zip(found);
    let setup = |(channel, found): (&LoadedChannel, ChannelPowerOn)| {
        // Counted from 0 on the machine, and the spindle is the sixth.
        let connectors = channel.folder.connectors.saturating_sub(1);
        let spindle = usize::from(connectors) + 5;
        ChannelSetup {
            parameters: channel.parameters.clone(),
            axes: channel.axes,
            connectors,
            spindle: SpindleWiring {
                output: spindle,
                input: spindle,
            },
            programs: found.programs,
            kinematics: Arc::new(Cartesian),
            window: channel.window.clone(),
            remembered: found.remembered,
        }
    };
    channels.map(setup).collect()
}
