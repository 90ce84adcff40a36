//! A TNC that is switched on: what a cycle of it is, beside what every host does.
//!
//! - `setup` puts the control together; `background` and `reading` compute and read on other threads; `digitizing` writes the
//!   programs of scans.
//!
//! Decision: At power-on tools lie in the simulated magazine where the control remembers them: chain and arm are
//! mechanics, which survive by themselves

mod background;
mod digitizing;
mod reading;
mod setup;

use std::sync::Arc;

use bahn_machine::Event;
use bahn_plc::{Tracer, WindowView};
use bahn_reader::Warning;
use bahn_tnc::{Command, Control, Dnc, KeyCode, Programs, Renewed, ServoSampler, Snapshot};

use self::background::Background;
use self::digitizing::{Digitizing, Written};
use self::setup::control_of;
use crate::action::{Action, Answer};
use crate::error::HostError;
use crate::host::{Host, HostFamily};
use crate::hosted::{ByOperator, Executes, HostNotice, Hosted, Prepared};
use crate::journal::Journal;
use crate::machine_folder::{LoadedMachine, State};
use crate::moment::Moment;
use crate::notice::{Before, Notice, Why};
use crate::operable::Operable;
use crate::operator::Operator;
use crate::orders::Waiting;
use crate::power_on::PowerOn;

/// What belongs to a moment of a TNC beside the control.
#[derive(Clone)]
pub struct Aside {
    before: Before,
    /// The list of machine parameters with which the control is to be started anew.
    restart: Option<String>,
    /// What each channel digitizes.
    digitizing: Vec<Digitizing>,
}

/// What the host of a TNC has that belongs to no moment.
pub struct Beside {
    background: Background,
    digitized: Digitized,
    looks: Looks,
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

impl From<HostNotice<Command>> for Notice {
    fn from(notice: HostNotice<Command>) -> Notice {
        match notice {
            HostNotice::Given(source, action, answer) => Notice::Given(source, action, answer),
            HostNotice::Restored => Notice::Restored,
            HostNotice::Fault(what) => Notice::Fault(what),
        }
    }
}

impl Hosted for Control {
    type Command = Command;
    type Notice = Notice;
    type Snapshot = Snapshot;
    type Operator = Operator;
    type Renewed = Renewed;
    type Aside = Aside;
    type Beside = Beside;
    type State = State;

    fn time_us(&self) -> u64 {
        Control::time_us(self)
    }

    fn channels(&self) -> usize {
        Control::channels(self)
    }

    fn keep_path(&mut self) {
        Control::keep_path(self, true);
    }

    fn take_prepared(&mut self, channel: usize) -> Prepared {
        // What is dropped is asked for first.
        Prepared {
            dropped: self.take_dropped_path(channel),
            elements: self.take_path(channel),
        }
    }

    fn executes(&self, channel: usize) -> Option<Executes<'_>> {
        let channel = self.channel(channel)?;
        Some(Executes {
            element: channel.element().map(|element| (element, channel.rest_mm())),
            has_ended: channel.has_ended(),
        })
    }

    fn take_warnings(&mut self, channel: usize) -> Vec<Warning> {
        Control::take_warnings(self, channel)
    }

    fn aside(&self) -> Aside {
        Aside {
            before: Before::default(),
            restart: None,
            digitizing: vec![Digitizing::default(); self.channels()],
        }
    }

    fn snapshot(&self) -> Snapshot {
        Control::snapshot(self)
    }

    fn snapshot_again(&self, earlier: Snapshot) -> Snapshot {
        Control::snapshot_again(self, earlier)
    }

    fn text_in(command: &Command) -> usize {
        match command {
            Command::Dnc(Dnc::Text(text)) => text.len(),
            _ => 0,
        }
    }

    fn stand_by(&self, operator: &mut Operator) -> Option<ByOperator<Control>> {
        let (channel, action, why) = operator.act(self)?;
        let notice = match (&action, why) {
            (Action::Event(Event::Key(key, _), _), Why::Stop | Why::ToolChange) => Some(Notice::Confirmed {
                key: key.clone(),
                why,
            }),
            _ => None,
        };
        Some((channel, action, notice))
    }
}

impl HostFamily for Control {
    fn spend<P: Operable>(host: &mut Host<P>) -> Result<(), HostError> {
        host.cycle_traced(None)
    }

    fn command<P: Operable>(host: &mut Host<P>, channel: usize, command: &Command) -> Answer {
        // What comes of a program that is transferred waits in the control.
        if !matches!(command, Command::Dnc(Dnc::Text(_))) {
            Control::settle(host);
        }
        host.command(channel, command)
    }

    fn take_over<P: Operable>(host: &mut Host<P>, renewed: Renewed) -> bool {
        let starts = host.now.control.starts();
        Control::settle(host);
        let done = host.now.control.renew(renewed);
        if starts != host.now.control.starts() {
            host.forget_background();
        }
        done
    }

    fn settle<P: Operable>(host: &mut Host<P>) {
        host.beside.background.settle(&mut host.now.control);
    }

    /// By real time part programs are read on a thread of their own.
    fn pace<P: Operable>(host: &mut Host<P>) {
        let beside = host.works_beside();
        host.beside.background.read_beside(&mut host.now.control, beside);
    }

    fn begin_again<P: Operable>(host: &mut Host<P>) {
        // What is repeated is read as it comes, so that it is the same.
        host.now.control.read_beside(false);
        // A computation that is on its way belongs to the control that is left.
        host.beside.background = Background::default();
    }

    fn store<P: Operable>(host: &mut Host<P>) -> Result<(), HostError> {
        Control::settle(host);
        match &mut host.state {
            Some(state) => state
                .flush(&host.now.control, &host.now.plant)
                .map_err(|error| HostError::NotStored(error.to_string())),
            None => Ok(()),
        }
    }
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
        let beside = Beside {
            background: Background::default(),
            digitized: Digitized::by(&programs, &power_on),
            looks: Looks::default(),
        };
        let state = power_on.state.take();
        let mut control = control_of(machine, power_on, programs)?;
        control.keep_state(state.is_some());
        let moment = Moment::new(control, plant, operator);
        Ok(Host::switched_on(moment, beside, state))
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
        now.aside = control.aside();
        (now.control, now.operator, now.waiting) = (control, operator, Waiting::default());
        self.beside.digitized.programs = digitized.programs;
        self.state = state;
        self.journal = Journal::default();
        self.forget_background();
        Ok(())
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
        self.beside
            .background
            .prepare(&mut self.now.control, beside, &self.break_off);
        self.now.control.show_plc_window(self.beside.looks.window);
        self.now
            .control
            .cycle_watched(&mut self.now.plant, tracer, sampler);
        self.now.plant.tool_is_called(self.now.control.tool());
        // A message names the program of its block.
        if self.beside.looks.programs || self.now.control.has_news() {
            self.beside.background.settle(&mut self.now.control);
        }
        if let Some(list) = self.now.control.take_restart() {
            self.forget_background();
            self.tell_in(0, Notice::Restart(list.clone()));
            self.now.aside.restart = Some(list);
        }
        let kept = self.keep().and(self.keep_digitized());
        self.tell_changes();
        self.end_cycle();
        kept
    }

    /// Tells what a cycle has changed.
    fn tell_changes(&mut self) {
        let (time_us, repeats) = (self.now.control.time_us(), self.repeats);
        let (now, feeds) = (&mut self.now, &self.feeds);
        now.aside.before.compare(&mut now.control, |channel, notice| {
            if !repeats {
                feeds.tell(time_us, channel, notice);
            }
        });
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
        self.beside.background = Background::default();
        let beside = self.works_beside();
        self.beside.background.read_beside(&mut self.now.control, beside);
    }

    /// Stores what the control waits for at once, everything else now and then.
    fn keep(&mut self) -> Result<(), HostError> {
        let Some(state) = &mut self.state else {
            return Ok(());
        };
        let waits = self.now.control.unsaved().is_some();
        if !self.repeats && (waits || state.is_due()) {
            self.beside.background.settle(&mut self.now.control);
        }
        if self.repeats {
            if waits {
                self.now.control.stored();
            }
            return Ok(());
        }
        if let Err(error) = state.keep(&mut self.now.control, &self.now.plant) {
            self.tell(HostNotice::Fault(error.to_string()));
            return Err(HostError::NotStored(error.to_string()));
        }
        if waits {
            self.tell_in(0, Notice::Stored);
        }
        Ok(())
    }

    /// What is digitized from now on is printed block by block as [`Notice::Printed`], not stored: the interface function PRINT
    /// [003:6554-6557].
    pub fn print_digitized(&mut self, prints: bool) {
        self.beside.digitized.prints = prints;
    }

    /// Takes the points of channels that digitize, and stores a program whose range is scanned.
    fn keep_digitized(&mut self) -> Result<(), HostError> {
        let mut kept = Ok(());
        for number in 0..self.now.aside.digitizing.len() {
            let news = self
                .now
                .control
                .channel(number)
                .map(|channel| channel.digitized());
            let (Some(digitizing), Some(news)) = (self.now.aside.digitizing.get_mut(number), news) else {
                continue;
            };
            let complete = match digitizing
                .follow(news, self.beside.digitized.prints)
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
            let stored = self
                .beside
                .digitized
                .programs
                .get(number)
                .map_or(Ok(()), |programs| {
                    programs.store(&complete.name, &complete.pieces)
                });
            match stored {
                Ok(()) => self.tell_in(number, Notice::Digitized(complete.name, complete.points)),
                Err(error) => {
                    self.tell(HostNotice::Fault(error.clone()));
                    kept = Err(HostError::NotStored(error));
                }
            }
        }
        kept
    }

    /// Takes the key that the PLC has simulated; see [`Control::take_key`].
    pub fn take_key(&mut self) -> Option<KeyCode> {
        self.now.control.take_key()
    }

    /// Tells the PLC whether its window is to be seen; see [`Control::show_plc_window`].
    /// Holds from the next cycle on, also when the control begins anew.
    pub fn show_plc_window(&mut self, view: WindowView) {
        self.beside.looks.window = view;
    }

    /// The list of machine parameters with which the control is to be started anew.
    pub fn restart(&self) -> Option<&str> {
        self.now.aside.restart.as_deref()
    }

    /// What programs have read is there after every cycle, also in real time: their Q parameters, and
    /// [`Control::interpreter`]. A cycle then waits for what is read beside.
    pub fn watch_programs(&mut self) {
        self.beside.looks.programs = true;
    }
}
