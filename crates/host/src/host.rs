//! A machine that is switched on.

use std::sync::Arc;
use std::sync::atomic::{AtomicBool, Ordering};
use std::time::Duration;

use bahn_control::{
    Cartesian, ChannelSetup, Command, Control, Dnc, KeyCode, Programs, Renewed, ServoSampler, Setup,
    Snapshot, SpindleWiring,
};
use bahn_interpreter::Warning;
use bahn_machine::Machine;
use bahn_path::PathElement;
use bahn_plc::{Tracer, WindowView};

use crate::action::{Action, Answer, Operable, Source};
use crate::background::Background;
use crate::digitizing::{Digitizing, Written};
use crate::error::HostError;
use crate::feed::{Feed, Reader};
use crate::journal::{Given, Journal};
use crate::log::Sink;
use crate::machine_folder::{LoadedChannel, LoadedMachine, State};
use crate::notice::{Before, Notice, Stamped, Why};
use crate::operator::Operator;
use crate::orders::{Desk, Waiting, When};
use crate::pace::{Clock, Lateness, Pace};
use crate::power_on::{ChannelPowerOn, PowerOn, load_magazine};

/// Notices that wait for slow readers.
const NOTICES: usize = 1024;
/// Snapshots that wait for slow readers.
const SNAPSHOTS: usize = 256;

/// Control and plant, driven cycle by cycle, observed, and kept over power-off.
///
/// [`Host::step`] is one contour cycle: what is due is done, the operator acts, the control prepares and spends
/// the cycle, what must survive is stored, and what has changed is told. The same machine and the same actions at
/// the same times give the same bits, but for computations that a [`Clock::Wall`] does not wait for.
pub struct Host<P = Machine> {
    pub(crate) control: Control,
    pub(crate) plant: P,
    pub(crate) operator: Operator,
    pub(crate) waiting: Waiting,
    pub(crate) before: Before,
    pub(crate) restart: Option<String>,
    pub(crate) journal: Journal,
    pub(crate) background: Background,
    /// What each channel digitizes, and where its programs are.
    pub(crate) digitizing: Vec<Digitizing>,
    /// The interface function PRINT: of the interfaces, not of the machine.
    prints: bool,
    programs: Vec<Arc<dyn Programs>>,
    /// Whoever follows looks at what programs have read, in every cycle.
    watched: bool,
    /// How the window of the PLC is to be seen.
    window: WindowView,
    /// What was is repeated: nobody is told, and nothing is stored but in the end.
    pub(crate) repeats: bool,
    /// Also in real time nothing is read or computed beside.
    exact: bool,
    desk: Desk,
    state: Option<State>,
    sink: Option<Box<dyn Sink + Send>>,
    clock: Clock,
    pace: Option<Pace>,
    /// Whoever lets cycles pass waits for the clock.
    paced_outside: bool,
    break_off: Arc<AtomicBool>,
    notices: Feed<Stamped>,
    snapshots: Feed<Snapshot>,
    /// Time between two snapshots, µs, and when the next one is due.
    snapshot_us: Option<(u64, u64)>,
}

impl Host {
    /// Switches on the simulated machine of a folder.
    pub fn new(
        machine: &LoadedMachine,
        power_on: PowerOn,
        programs: Arc<dyn Programs>,
        operator: Operator,
    ) -> Host {
        let mut plant = machine.plant.clone();
        let kept = power_on.mechanics.as_ref();
        let stands = kept.is_some_and(|place| plant.stand_at(place).is_ok());
        if !stands {
            load_magazine(&mut plant, machine, &power_on.remembered);
        }
        Host::with_plant(machine, plant, power_on, programs, operator)
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
    /// and what was given before is forgotten.
    pub fn replace(
        &mut self,
        machine: &LoadedMachine,
        power_on: PowerOn,
        programs: Arc<dyn Programs>,
        operator: Operator,
    ) {
        let mut other = Host::new(machine, power_on, programs, operator);
        other.control.follow_on(&self.control);
        std::mem::swap(&mut self.control, &mut other.control);
        std::mem::swap(&mut self.plant, &mut other.plant);
        std::mem::swap(&mut self.operator, &mut other.operator);
        std::mem::swap(&mut self.programs, &mut other.programs);
        std::mem::swap(&mut self.digitizing, &mut other.digitizing);
        std::mem::swap(&mut self.state, &mut other.state);
        self.before = Before::default();
        self.journal = Journal::default();
        self.waiting = Waiting::default();
        self.restart = None;
        self.forget_background();
    }
}

impl<P: Operable> Host<P> {
    /// Switches on the control of a folder with a plant of one's own.
    pub fn with_plant(
        machine: &LoadedMachine,
        plant: P,
        power_on: PowerOn,
        programs: Arc<dyn Programs>,
        operator: Operator,
    ) -> Host<P> {
        let others = power_on
            .channels
            .iter()
            .map(|channel| Arc::clone(&channel.programs));
        let all_programs: Vec<_> = std::iter::once(Arc::clone(&programs)).chain(others).collect();
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
        let others = channel_setups(machine, power_on.channels);
        // `LoadedMachine::load` refuses what cannot be put together.
        let mut control = match Control::with_channels(setup.clone(), others) {
            Ok(control) => control,
            Err(_) => Control::new(setup),
        };
        control.hand_over_by(machine.hand_overs.clone());
        if power_on.block_time {
            control.set_block_time((block_time_ms * 1e3) as u32);
        }
        control.keep_state(power_on.state.is_some());
        control.defer_work();
        Host {
            control,
            plant,
            operator,
            waiting: Waiting::default(),
            before: Before::default(),
            restart: None,
            journal: Journal::default(),
            background: Background::default(),
            digitizing: vec![Digitizing::default(); all_programs.len()],
            prints: false,
            programs: all_programs,
            watched: false,
            window: WindowView::default(),
            repeats: false,
            exact: false,
            desk: Desk::default(),
            state: power_on.state,
            sink: None,
            clock: Clock::Free,
            pace: None,
            paced_outside: false,
            break_off: Arc::default(),
            notices: Feed::new(NOTICES),
            snapshots: Feed::new(SNAPSHOTS),
            snapshot_us: None,
        }
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
            let now = self.control.time_us();
            self.journal.add(now, Given::Order(order.clone()));
            self.take(order);
        }
        while let Some(order) = self.waiting.due(self.control.time_us()) {
            self.execute(order.source, order.action)?;
        }
        if let Some((channel, action, why)) = self.operator.act(&self.control) {
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
            .prepare(&mut self.control, beside, &self.break_off);
        self.control.show_plc_window(self.window);
        self.control.cycle_watched(&mut self.plant, tracer, sampler);
        self.plant.tool_is_called(self.control.tool());
        // A message names the program of its block.
        if self.watched || self.control.has_news() {
            self.background.settle(&mut self.control);
        }
        if let Some(list) = self.control.take_restart() {
            self.forget_background();
            self.tell(Notice::Restart(list.clone()));
            self.restart = Some(list);
        }
        let kept = self.keep().and(self.keep_digitized());
        self.look();
        if let Some(pace) = self.pace.as_mut().filter(|_| !self.repeats) {
            pace.note(self.control.time_us());
            if !self.paced_outside {
                pace.wait();
            }
        }
        kept
    }

    /// Does something at once, between two cycles.
    ///
    /// # Errors
    /// When the log cannot be written.
    pub fn act(&mut self, source: Source, action: Action) -> Result<Answer, HostError> {
        let now = self.control.time_us();
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
        if !self.waiting.add(order, self.control.time_us()) {
            let answer = Answer::Impossible(HostError::Busy.to_string());
            self.tell(Notice::Given(source, action, answer));
        }
    }

    pub(crate) fn execute(&mut self, source: Source, action: Action) -> Result<Answer, HostError> {
        if let Some(sink) = &mut self.sink {
            sink.note(self.control.time_us(), &source, &action.to_string())?;
        }
        // What comes of a program that is transferred waits in the control.
        let waits = matches!(action, Action::Command(_, Command::Dnc(Dnc::Text(_))));
        if matches!(action, Action::Command(..)) && !waits {
            self.background.settle(&mut self.control);
        }
        let answer = match &action {
            Action::Command(channel, command) => self.command(*channel, command),
            Action::Event(event, _) => match self.plant.operate(event) {
                Ok(()) => Answer::Done,
                Err(what) => Answer::Impossible(what),
            },
        };
        self.tell(Notice::Given(source, action, answer.clone()));
        Ok(answer)
    }

    fn command(&mut self, channel: usize, command: &Command) -> Answer {
        if channel >= self.control.channels() {
            return Answer::Impossible(format!("the machine has no channel {}", channel + 1));
        }
        let before = (self.control.starts(), self.control.is_off());
        let done = self.control.command_to(channel, command.clone());
        if before != (self.control.starts(), self.control.is_off()) {
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
        self.background.read_beside(&mut self.control, beside);
    }

    /// Stores what the control waits for at once, everything else now and then.
    fn keep(&mut self) -> Result<(), HostError> {
        let Some(state) = &mut self.state else {
            return Ok(());
        };
        let waits = self.control.unsaved().is_some();
        if !self.repeats && (waits || state.is_due()) {
            self.background.settle(&mut self.control);
        }
        if self.repeats {
            if waits {
                self.control.stored();
            }
            return Ok(());
        }
        if let Err(error) = state.keep(&mut self.control, &self.plant) {
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
        self.prints = prints;
    }

    /// Takes the points of channels that digitize, and stores a program whose range is scanned.
    fn keep_digitized(&mut self) -> Result<(), HostError> {
        let mut kept = Ok(());
        for number in 0..self.digitizing.len() {
            let news = self.control.channel(number).map(|channel| channel.digitized());
            let (Some(digitizing), Some(news)) = (self.digitizing.get_mut(number), news) else {
                continue;
            };
            let complete = match digitizing.follow(news, self.prints).filter(|_| !self.repeats) {
                Some(Written::Complete(complete)) => complete,
                Some(Written::Printed(blocks)) => {
                    for block in blocks.lines() {
                        self.tell_in(number, Notice::Printed(block.into()));
                    }
                    continue;
                }
                None => continue,
            };
            let stored = self.programs.get(number).map_or(Ok(()), |programs| {
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

    /// Tells what has changed, and takes a snapshot when one is due.
    fn look(&mut self) {
        let time_us = self.control.time_us();
        let (notices, repeats) = (&self.notices, self.repeats);
        self.before.compare(&mut self.control, |channel, notice| {
            if !repeats {
                notices.put(|_| Stamped {
                    time_us,
                    channel,
                    notice,
                });
            }
        });
        if let Some((every_us, due_us)) = self.snapshot_us.as_mut().filter(|_| !repeats)
            && time_us >= *due_us
        {
            *due_us = time_us + *every_us;
            let control = &self.control;
            self.snapshots.put(|oldest| match oldest {
                Some(oldest) => control.snapshot_again(oldest),
                None => control.snapshot(),
            });
        }
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
            let time_us = self.control.time_us();
            self.notices.put(|_| Stamped {
                time_us,
                channel,
                notice,
            });
        }
    }

    /// Stores everything: the machine is switched off, or is where it was before.
    ///
    /// # Errors
    /// [`HostError::NotStored`].
    pub fn store(&mut self) -> Result<(), HostError> {
        self.background.settle(&mut self.control);
        match &mut self.state {
            Some(state) => state
                .flush(&self.control, &self.plant)
                .map_err(|error| HostError::NotStored(error.to_string())),
            None => Ok(()),
        }
    }

    /// The control.
    pub fn control(&self) -> &Control {
        &self.control
    }

    /// Takes the key that the PLC has simulated; see [`Control::take_key`].
    pub fn take_key(&mut self) -> Option<KeyCode> {
        self.control.take_key()
    }

    /// Tells the PLC whether its window is to be seen; see [`Control::show_plc_window`].
    /// Holds from the next cycle on, also when the control begins anew.
    pub fn show_plc_window(&mut self, view: WindowView) {
        self.window = view;
    }

    /// Takes over what an editor has written; see [`Control::renew`]. Who goes back finds what was there then.
    pub fn renew(&mut self, renewed: Renewed) -> bool {
        let now = self.control.time_us();
        self.journal.add(now, Given::Renewed(renewed.clone()));
        self.take_over(renewed)
    }

    pub(crate) fn take_over(&mut self, renewed: Renewed) -> bool {
        let starts = self.control.starts();
        self.background.settle(&mut self.control);
        let done = self.control.renew(renewed);
        if starts != self.control.starts() {
            self.forget_background();
        }
        done
    }

    /// The plant.
    pub fn plant(&self) -> &P {
        &self.plant
    }

    /// The plant, to be changed between two cycles: no log notes that.
    pub fn plant_mut(&mut self) -> &mut P {
        &mut self.plant
    }

    /// The operator who stands by.
    pub fn operator(&self) -> &Operator {
        &self.operator
    }

    /// The list of machine parameters with which the control is to be started anew.
    pub fn restart(&self) -> Option<&str> {
        self.restart.as_deref()
    }

    /// A reader of what happens from now on.
    pub fn notices(&self) -> Reader<Stamped> {
        self.notices.reader()
    }

    /// A reader of the snapshots from now on; see [`Host::take_snapshots`].
    pub fn snapshots(&self) -> Reader<Snapshot> {
        self.snapshots.reader()
    }

    /// Takes a snapshot every so many µs of the machine from now on; 0 is every contour cycle.
    pub fn take_snapshots(&mut self, every_us: u64) {
        self.snapshot_us = Some((every_us, self.control.time_us()));
    }

    /// Runs by another clock from now on. By that on the wall part programs are read on a thread of their own: what a
    /// program needs to be read holds no cycle. It is back for every action, and for what is stored.
    pub fn set_clock(&mut self, clock: Clock) {
        self.clock = clock;
        self.pace = Pace::of(clock, self.control.time_us());
        let beside = self.works_beside();
        self.background.read_beside(&mut self.control, beside);
    }

    /// From now on no cycle waits for real time: whoever lets them pass waits as long as [`Host::rest`] says,
    /// and can do something else meanwhile.
    pub fn pace_outside(&mut self) {
        self.paced_outside = true;
    }

    /// How long it is until the time of the last cycle is over in real time.
    pub fn rest(&self) -> Duration {
        self.pace.as_ref().map_or(Duration::ZERO, Pace::rest)
    }

    /// From now on a cycle waits for what programs need to be read and computed, also in real time: what is
    /// given then at the same times gives the same bits again, at the price of cycles that come late.
    pub fn be_exact(&mut self) {
        self.exact = true;
        self.set_clock(self.clock);
    }

    /// Programs are read, and long computations done, on a thread of their own.
    fn works_beside(&self) -> bool {
        self.pace.is_some() && !self.repeats && !self.exact
    }

    /// The clock begins anew: the machine is at another time.
    pub(crate) fn reset_clock(&mut self) {
        self.set_clock(self.clock);
        if let Some((_, due_us)) = &mut self.snapshot_us {
            *due_us = self.control.time_us();
        }
    }

    /// What programs have read is there after every cycle, also in real time: their Q parameters, and
    /// [`Control::interpreter`]. A cycle then waits for what is read beside.
    pub fn watch_programs(&mut self) {
        self.watched = true;
    }

    /// How well the pace of the wall was kept; `None` where the machine runs freely.
    pub fn lateness(&self) -> Option<Lateness> {
        self.pace.as_ref().map(|pace| pace.lateness)
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
            Some(sink) => sink.note(self.control.time_us(), source, what),
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

    /// It is set.
    pub fn is_broken_off(&self) -> bool {
        self.break_off.load(Ordering::Relaxed)
    }

    /// Keeps the path elements of runs of all channels that begin from now on, for [`Host::take_path`].
    pub fn keep_path(&mut self) {
        self.control.keep_path(true);
    }

    /// The path elements of a channel that were prepared since the last call, in workpiece coordinates.
    pub fn take_path(&mut self, channel: usize) -> Vec<PathElement> {
        self.control.take_path(channel)
    }

    /// The first element that is executed no more, of those that were taken: see [`Control::take_dropped_path`].
    pub fn take_dropped_path(&mut self, channel: usize) -> Option<u64> {
        self.control.take_dropped_path(channel)
    }

    /// The warnings of a channel's interpreter since the last call.
    pub fn take_warnings(&mut self, channel: usize) -> Vec<Warning> {
        self.control.take_warnings(channel)
    }
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
