//! The operator's station: a machine that is on, and its panel.
//!
//! Decision: At the operating panel a cycle waits for what programs need to be read and computed, also in real time:
//! sessions and the time line repeat what was, at the price of cycles that come late (also `host/src/host.rs`)

mod chosen;
mod commissioning;
mod teaching;
mod transfers;
mod warm_start;

use std::collections::BTreeMap;
use std::sync::Arc;
use std::sync::atomic::AtomicBool;
use std::sync::mpsc::{Receiver, channel};
use std::time::Duration;

use bahn_dialogue::Key;
use bahn_graphics::{BeingCut, Graphics, Picture};
use bahn_host::{Action, Answer, AnyPlant, Clock, Host, HostError, LoadedMachine, Operable, PowerOn, Source};
use bahn_live::{EMERGENCY_STOP, Input, Passing, Refusal, Steps, StepsEnd, Ticket};
use bahn_machine::KeyAction;
use bahn_parameters::{MessageId, ParameterList};
use bahn_path::Switch;
use bahn_plc::PlcWindow;
use bahn_screen::programs::ProgramMemory;
use bahn_screen::{Layout, Look, MachineState, MessageLine, PlcLine, Screen, colours, texts};
use bahn_teaching::lesson::LessonRun;
use bahn_teaching::timeline::Past;
use bahn_tnc::{Command, Control, Programs};
use bahn_why::{Waits, in_words};

use crate::console::Console;
use crate::inhibit::{self, Simulated};
use crate::plc_mode::PlcMode;
use crate::session::Recorder;
use crate::site::Site;
use crate::to_enter::{Commissioning, operator_of};
use crate::transfer::{TransferOrder, Transfers};
use crate::{pages, status};
use chosen::Chosen;
use warm_start::WarmStart;

/// Lines of the large window, and of one beside it.
const LINES: usize = 16;
/// So often the PLC is told what the screen shows, µs.
const SCREEN_REPORTED_US: u64 = 50_000;
/// Stands in the status window while a logic diagram is recorded [000:11466].
const RECORDING: &str = "PCTR";

/// A machine that is on, and its panel. It has no clock of its own: [`Station::cycle`] is one contour cycle. Its plant is
/// the simulated machine of the folder, or any other one that can be operated.
pub struct Station {
    host: Host<AnyPlant>,
    machine: LoadedMachine,
    programs: Arc<ProgramMemory>,
    chosen: Chosen,
    console: Console,
    passing: Passing,
    supply: Supply,
    study: Study,
    instruments: Instruments,
    /// While the list of machine parameters is entered: what the control kept, which nobody else takes meanwhile.
    commissioning: Option<Commissioning>,
    shown: Screen,
}

/// The supply of the control, as the operator has it.
struct Supply {
    is_on: bool,
    warm_start: WarmStart,
}

/// What is known of the time that has passed, and what is asked of it.
struct Study {
    recorder: Option<Recorder>,
    past: Past,
    waits: Waits,
    lesson: Option<LessonRun>,
}

/// What goes on while other pages are shown.
struct Instruments {
    plc: PlcMode,
    graphics: Graphics,
    transfers: Transfers,
}

impl Station {
    /// Switches on the machine of a folder, simulated.
    ///
    /// # Errors
    /// When it is switched on already, what it kept cannot be read, or its channels do not fit.
    pub fn power_on(machine: LoadedMachine) -> Result<Station, HostError> {
        let power_on = PowerOn::kept(&machine)?;
        Station::with(machine, power_on)
    }

    /// The same with what the control finds.
    ///
    /// # Errors
    /// When the folder describes no simulated machine, or the channels do not fit.
    pub fn with(machine: LoadedMachine, power_on: PowerOn) -> Result<Station, HostError> {
        let plant = power_on.simulated(&machine)?;
        Station::with_plant(machine, plant, power_on)
    }

    /// The same with a plant of one's own in place of the one that the folder describes.
    ///
    /// # Errors
    /// When the channels do not fit.
    pub fn with_plant(
        machine: LoadedMachine,
        plant: impl Operable + Send + Sync + 'static,
        mut power_on: PowerOn,
    ) -> Result<Station, HostError> {
        let programs = Arc::new(ProgramMemory::new(&machine.programs(0)));
        let lost = std::mem::take(&mut power_on.warnings);
        let commissioning = Commissioning::of(&machine, &mut power_on);
        let shared = Arc::clone(&programs) as Arc<dyn Programs>;
        let plant = AnyPlant::new(plant);
        let mut host = Host::with_plant(&machine, plant, power_on, shared, operator_of(&machine))?;
        // Sessions and the time line repeat what was.
        host.be_exact();
        let mut station = Station {
            console: Console::new(host.control().mode(), host.control().model()),
            passing: Passing::default(),
            supply: Supply {
                is_on: true,
                warm_start: WarmStart::default(),
            },
            instruments: Instruments {
                plc: PlcMode::default(),
                graphics: Graphics::new(&mut host),
                transfers: Transfers::default(),
            },
            study: Study {
                recorder: None,
                past: Past::new(&mut host),
                waits: Waits::new(&machine, host.plant()),
                lesson: None,
            },
            commissioning,
            shown: Screen::default(),
            host,
            machine,
            programs,
            chosen: Chosen::default(),
        };
        station.read_settings();
        station.say_lost(lost);
        station.commission();
        Ok(station)
    }

    /// Whoever lets cycles pass waits for [`Station::rest`] himself; nothing waits for long work while this is set, since
    /// something urgent does.
    pub(crate) fn wait_outside(&mut self, urgent: Arc<AtomicBool>) {
        self.host.pace_outside();
        self.host.break_off_by(urgent);
    }

    /// Runs in real time from now on, as fast as the operator chose.
    pub fn run_in_real_time(&mut self) {
        self.passing.in_real_time = true;
        self.instruments.graphics.run_beside();
        self.host.set_clock(self.clock());
    }

    /// How long it is until the next cycle in real time.
    pub(crate) fn rest(&self) -> Duration {
        self.host.rest()
    }

    /// The clock by which the machine runs.
    pub(crate) fn clock(&self) -> Clock {
        self.passing.clock()
    }

    /// Takes what the operator does, and notes it while a session is recorded.
    ///
    /// # Errors
    /// When there is no such key, or it cannot be done.
    pub fn input(&mut self, input: &Input) -> Result<(), Refusal> {
        let now_us = self.host.control().time_us();
        self.record_with(|recorder| recorder.note(now_us, input));
        let taken = self.take(input);
        self.study.past.settle(&self.host);
        taken
    }

    /// Does something with the session that is recorded; one that cannot be written ends, and that is said.
    fn record_with(&mut self, write: impl FnOnce(&mut Recorder) -> Result<(), String>) {
        if let Some(Err(error)) = self.study.recorder.as_mut().map(write) {
            self.console.say(error);
            self.study.recorder = None;
        }
    }

    fn take(&mut self, input: &Input) -> Result<(), Refusal> {
        match input {
            Input::Key(key) => self.key(*key)?,
            Input::Held(key, button) => {
                self.supply
                    .warm_start
                    .hold(*key, *button, self.host.control().time_us());
                if button.is_pressed() {
                    self.key(*key)?;
                }
            }
            Input::Machine(name, action) => return self.machine_key(name, *action),
            Input::Text(text) => {
                let (console, mut site) = self.parts();
                console.text(text, &mut site);
            }
            Input::FeedOverride(percent) => self.knob(0, *percent)?,
            Input::SpindleOverride(percent) => self.knob(1, *percent)?,
            Input::Handwheel(steps) => self.action(&format!("handwheel {steps}"))?,
            Input::HandwheelAxis(axis, factor) => {
                self.action(&format!("handwheel {axis} {factor}"))?;
            }
            Input::Power(supply) => self.power(*supply),
            Input::Speed(factor) => self.set_speed(*factor)?,
            Input::Pause(switch) => self.pause(switch.is_on()),
            Input::Cycles(cycles) => {
                self.ask_for_steps(*cycles);
            }
            Input::GoTo(time_s, branch) => self.go_to_in(*time_s, *branch)?,
            Input::Lesson(name) => self.begin_lesson(name.as_deref())?,
            Input::HandIn => self.hand_in(),
            Input::Action(text) => self.action(text)?,
            Input::Transfer(news) => {
                let language = self.language();
                let (console, mut site) = self.parts();
                if let Some(restore) = transfers::take(news, language, console, &mut site) {
                    self.restore(restore);
                }
            }
        }
        Ok(())
    }

    /// One contour cycle of the machine.
    ///
    /// # Errors
    /// When what survives power-off cannot be written; the machine goes on all the same.
    pub fn cycle(&mut self) -> Result<(), HostError> {
        self.passing.steps.pass();
        // The control begins as after power-on.
        if self.supply.warm_start.is_due(self.host.control()) {
            self.power(Switch::Off);
            self.console.power_off();
            self.instruments.plc.power_off();
            self.power(Switch::On);
        }
        let keys = self.host.control().oscilloscope();
        let sampler = self.instruments.graphics.scope.sampler(keys);
        let cycled = self.instruments.plc.cycle(&mut self.host, sampler);
        self.follow_plc();
        let is_on = !self.host.control().is_off();
        if self.supply.is_on && !is_on {
            self.console.power_off();
            self.instruments.plc.power_off();
        }
        self.supply.is_on = is_on;
        self.instruments.graphics.cycle(&mut self.host);
        if is_on {
            self.chosen.count_time(self.host.control());
        }
        if is_on || self.commissioning.is_some() {
            let (console, mut site) = self.parts();
            match inhibit::simulated(&mut site) {
                Some(Simulated::Key(key)) => console.key(key, &mut site),
                Some(Simulated::SoftKey(name)) => console.soft_key(name, &mut site),
                None => {}
            }
            console.tick(&mut site);
            self.tell_screen();
        }
        self.follow_commissioning();
        self.record_with(Recorder::keep);
        self.study.past.follow(&mut self.host);
        self.study.waits.follow(self.host.control());
        self.follow_lesson();
        self.store_settings();
        cycled
    }

    /// The PLC may ask what the screen shows (module 9035): now and then, since nobody presses keys faster.
    fn tell_screen(&mut self) {
        let control = self.host.control();
        let is_due = control.time_us() % SCREEN_REPORTED_US < u64::from(control.cycle_us());
        if !is_due || self.study.past.looks_back() {
            return;
        }
        let has_plc_window = self.plc_window().is_some();
        let (console, mut site) = self.parts();
        let shown = console.shown(&site, has_plc_window);
        if site.control().first().screen() != Some(shown) {
            site.command(Command::Screen(shown));
        }
    }

    /// The control may have begun anew with a program that was compiled meanwhile.
    fn follow_plc(&mut self) {
        let running = self.host.control().plc().program();
        if !Arc::ptr_eq(running, &self.machine.plc) {
            self.machine.plc = Arc::clone(running);
            self.study.waits = Waits::new(&self.machine, self.host.plant());
        }
    }

    /// Time stands: the operator lets it, and no cycles are asked for.
    pub fn stands(&self) -> bool {
        self.passing.stands()
    }

    /// Cycles that are asked for.
    pub(crate) fn steps(&self) -> &Steps {
        &self.passing.steps
    }

    fn pause(&mut self, paused: bool) {
        self.passing.steps.break_off(StepsEnd::Paused);
        self.set_going(|passing| passing.paused = paused);
    }

    /// The same as [`Input::Cycles`], for whoever waits for them.
    pub(crate) fn begin_steps(&mut self, cycles: u32) -> Ticket {
        let ticket = self.passing.steps.clone().ask(cycles);
        // They can always be asked for.
        let _ = self.input(&Input::Cycles(cycles));
        ticket
    }

    /// So many cycles are to pass.
    fn ask_for_steps(&mut self, cycles: u32) -> Ticket {
        self.set_going(|passing| passing.steps.ask(cycles))
    }

    /// Time that stood is not made up for when it goes on.
    fn set_going<T>(&mut self, what: impl FnOnce(&mut Passing) -> T) -> T {
        let stood = self.stands();
        let done = what(&mut self.passing);
        if stood && !self.stands() {
            self.host.set_clock(self.clock());
        }
        done
    }

    /// Everything is on the medium: the station ends.
    ///
    /// # Errors
    /// [`HostError::NotStored`].
    pub fn store(&mut self) -> Result<(), HostError> {
        self.store_settings();
        self.end_recording().map_err(HostError::NotStored)?;
        self.host.store()
    }

    /// The control of the machine, to be looked at.
    pub fn control(&self) -> &Control {
        self.host.control()
    }

    /// The machine's host, to record, save and go back.
    pub fn host(&mut self) -> &mut Host<AnyPlant> {
        &mut self.host
    }

    /// The machine's folder as it was loaded.
    pub fn machine(&self) -> &LoadedMachine {
        &self.machine
    }

    /// Keys of the keyboard of the control model.
    pub fn keyboard(&self) -> impl Iterator<Item = Key> {
        let model = self.control().model();
        Key::ALL.iter().copied().filter(move |key| key.is_on(model))
    }

    /// Where what the operator wants of the data interfaces arrives from now on. Who takes it says
    /// [`Input::Transfer`] with `connected 0` or `connected 1`, and then what happens.
    pub fn transfer_orders(&mut self) -> Receiver<TransferOrder> {
        let (sender, orders) = channel();
        self.instruments.transfers.connect(sender);
        orders
    }

    /// Part programs and tables were written by somebody else: the control reads them anew.
    pub fn programs_changed(&self) {
        self.programs.was_written();
    }

    /// Names of the keys of the machine operating panel.
    pub fn machine_keys(&self) -> Vec<String> {
        self.host.plant().keys().into_iter().map(str::to_owned).collect()
    }

    /// A program run, interrupted or not, has the file of this name.
    pub fn runs(&self, name: &str) -> bool {
        pages::runs(name, self.control())
    }

    /// So it has, or the machine is not switched on again without the file.
    pub fn needs(&self, name: &str) -> bool {
        pages::is_needed(name, self.control(), &self.machine.folder)
    }

    /// What the graphics show, to be drawn; `None` while the operator does not look at them, and without a part.
    pub fn picture(&mut self) -> Option<Picture> {
        let (console, site) = self.parts();
        let cut = console.subject(console.front())?;
        site.graphics.picture(cut, site.parameters())
    }

    /// The part of the test or the run that the operator looks at, whether he looks at its graphics or not; `None` in
    /// other operating modes, and before anything is cut.
    pub fn being_cut(&mut self) -> Option<BeingCut> {
        let (console, site) = self.parts();
        let cut = console.subject(console.front())?;
        site.graphics.being_cut(cut, site.host.control())
    }

    /// The screen as it is now. Its serial counts on when it is another one.
    pub fn screen(&mut self) -> &Screen {
        let mut screen = match self.supply.is_on || self.commissioning.is_some() {
            true => self.make_screen(),
            false => Screen::default(),
        };
        screen.timeline = self.study.past.shown(&self.host);
        screen.why = in_words(&self.why());
        let language = self.language();
        screen.lesson = self.study.lesson.as_ref().map(|lesson| lesson.line(language));
        screen.machine = self.machine_state();
        screen.time_s = self.host.control().time_us() as f64 / 1e6;
        screen.lamps = self.lamps();
        screen.look = self.look();
        screen.serial = self.shown.serial;
        // Time alone makes no other screen.
        self.shown.time_s = screen.time_s;
        if !self.study.past.looks_back() {
            self.shown.timeline.to_s = screen.timeline.to_s;
            self.shown.timeline.now_s = screen.timeline.now_s;
        }
        if screen != self.shown {
            screen.serial += 1;
            self.shown = screen;
        }
        &self.shown
    }

    fn parts(&mut self) -> (&mut Console, Site<'_>) {
        let site = Site {
            host: &mut self.host,
            machine: &self.machine,
            programs: &self.programs,
            settings: &mut self.chosen.now,
            plc: &mut self.instruments.plc,
            graphics: &mut self.instruments.graphics,
            transfers: &mut self.instruments.transfers,
        };
        (&mut self.console, site)
    }

    fn make_screen(&mut self) -> Screen {
        let messages = self.messages();
        let snapshot = self.host.control().snapshot();
        let mut status = status::of(
            &snapshot,
            self.host.control(),
            self.parameters(),
            &self.chosen.now,
            &self.shown.status,
        );
        status.position_type = texts::translate(self.language(), &status.position_type);
        if self.instruments.plc.records() {
            status.flags.push(RECORDING.to_owned());
        }
        let plc_window = self.plc_window();
        let layout = self.layout();
        let (console, site) = self.parts();
        let front = console.front();
        let view = console.view(front, &site, LINES).unwrap_or_default();
        let graphics = console.subject(front).and_then(|cut| site.graphics.line(cut));
        let beside = match console.split && layout == Layout::Windows {
            true => console.view(front.other(), &site, LINES),
            false => None,
        };
        let headings = console.headings(&site);
        let mode = headings.iter().find(|heading| heading.active);
        Screen {
            mode: mode.map(|heading| heading.title.clone()).unwrap_or_default(),
            soft_keys: console.soft_keys(&site),
            headings,
            dialogue: view.dialogue,
            messages,
            program: view.window.unwrap_or_default(),
            beside: beside.and_then(|view| view.window),
            status,
            plc_window,
            graphics,
            ..Screen::default()
        }
    }

    fn layout(&self) -> Layout {
        let model = self.control().model();
        match (model.has_windows(), model.has_soft_keys()) {
            (true, _) => Layout::Windows,
            (false, true) => Layout::OneColumn,
            (false, false) => Layout::Monochrome,
        }
    }

    fn look(&self) -> Look {
        let list = self.parameters();
        Look {
            layout: self.layout(),
            letters: list.operation_parameters().iso_programs != Some(false),
            language: self.language(),
            colours: colours::all(list),
        }
    }

    fn parameters(&self) -> &ParameterList {
        self.host.control().first().edited_list()
    }

    /// Messages of the control, and those of the panel after them.
    fn messages(&mut self) -> Vec<MessageLine> {
        let language = self.language();
        let control = self.host.control();
        let line = |shown: &bahn_tnc::Shown| MessageLine {
            text: texts::translate(language, &control.shown_text(shown)),
            flashing: shown.flashing,
            place: shown.block.map(|block| {
                let channel = control.channel(shown.channel.unwrap_or(0));
                channel
                    .map_or(block.block, |channel| channel.number_of(block))
                    .to_string()
            }),
        };
        let shown = control.shown().iter().map(line);
        let notes = self.console.notes().iter().map(|note| MessageLine {
            text: note.clone(),
            ..MessageLine::default()
        });
        shown.chain(notes).collect()
    }

    fn plc_window(&self) -> Option<Vec<PlcLine>> {
        let window = self.host.control().plc_window();
        let lines: Vec<_> = (0..PlcWindow::LINES)
            .map(|line| PlcLine {
                text: window.text(line),
                colours: window.line(line).iter().map(|cell| cell.colour).collect(),
                bar: window.bar(line).map(|bar| {
                    [
                        bar.maximum,
                        bar.current,
                        bar.bar_colour.into(),
                        bar.scale_colour.into(),
                    ]
                }),
            })
            .collect();
        let empty = |line: &PlcLine| line.text.trim().is_empty() && line.bar.is_none();
        (!lines.iter().all(empty)).then_some(lines)
    }

    fn lamps(&self) -> BTreeMap<String, bool> {
        let lamps = self.host.plant().lamps().into_iter();
        lamps.map(|(name, lit)| (name.to_owned(), lit)).collect()
    }

    fn machine_state(&self) -> MachineState {
        let plant = self.host.plant();
        MachineState {
            power: self.supply.is_on,
            emergency_stop: plant.stop_chain().pressed,
            knobs: plant.knobs(),
            held: plant.held_keys().into_iter().map(str::to_owned).collect(),
            handwheel: self.handwheel(),
            speed: self.passing.speed(),
            paused: self.passing.paused,
        }
    }

    /// Axis and interpolation factor of the handwheel.
    fn handwheel(&self) -> (char, u8) {
        let control = self.host.control();
        let (index, factor) = control.first().handwheel();
        let snapshot = control.snapshot();
        let axis = snapshot.axes.iter().find(|axis| axis.index == index);
        (axis.map_or('X', |axis| axis.letter), factor)
    }

    /// A key of the keyboard: the PLC may inhibit it, and is told then [000:7319].
    fn key(&mut self, key: Key) -> Result<(), Refusal> {
        let model = self.control().model();
        if !key.is_on(model) {
            let words = texts::around(self.language(), "the {1} has no key {2}");
            return Err(Refusal(texts::filled(words, &[model.name(), key.name()])));
        }
        if !self.supply.is_on && self.commissioning.is_none() {
            return Ok(());
        }
        let (console, mut site) = self.parts();
        // What the key before has brought is there: keys may come faster than cycles.
        console.tick(&mut site);
        if !inhibit::is_inhibited(key, &mut site) {
            console.key(key, &mut site);
        }
        Ok(())
    }

    fn machine_key(&mut self, name: &str, action: KeyAction) -> Result<(), Refusal> {
        if name == EMERGENCY_STOP {
            let pressed = match action {
                KeyAction::Press => true,
                KeyAction::Release => false,
                KeyAction::Tap => !self.host.plant().stop_chain().pressed,
            };
            return self.action(if pressed {
                "emergency press"
            } else {
                "emergency release"
            });
        }
        let verb = match action {
            KeyAction::Press => "press",
            KeyAction::Release => "release",
            KeyAction::Tap => "tap",
        };
        self.study.waits.pressed(name, self.host.control().time_us());
        self.action(&format!("key {name} {verb}"))
    }

    fn knob(&mut self, place: usize, percent: f64) -> Result<(), Refusal> {
        let name = ["feed", "spindle"][place.min(1)];
        self.action(&format!("override {name} {percent}"))
    }

    fn set_speed(&mut self, factor: f64) -> Result<(), Refusal> {
        self.passing.set_speed(factor)?;
        self.host.set_clock(self.clock());
        Ok(())
    }

    fn power(&mut self, supply: Switch) {
        if supply.is_on() && self.try_again() {
            return;
        }
        // A control that is on stays on.
        let _ = self.act(Action::Command(0, Command::Power(supply)));
    }

    fn action(&mut self, text: &str) -> Result<(), Refusal> {
        self.act(Action::parse(text).map_err(|error| Refusal(error.to_string()))?)
    }

    fn act(&mut self, action: Action) -> Result<(), Refusal> {
        // The list is entered before anything goes on.
        if self.commissioning.is_some() && matches!(action, Action::Command(_, Command::Power(_))) {
            return Ok(());
        }
        let answer = self.host.act(Source::Client("panel".to_owned()), action);
        match answer.map_err(|error| Refusal(error.to_string()))? {
            Answer::Done => Ok(()),
            Answer::Refused => Err(self.refusal()),
            Answer::Impossible(why) => Err(Refusal(why)),
        }
    }

    /// The control does not do it now.
    fn refusal(&self) -> Refusal {
        Refusal(MessageId::KeyNonFunctional.text(self.control().model()).into())
    }

    /// What the operator chose is kept as soon as it is another one.
    fn store_settings(&mut self) {
        if let Err(error) = self.chosen.store() {
            self.console.say(error);
        }
    }
}
