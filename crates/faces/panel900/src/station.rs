//! A machine with a System 900 that is on, and its panel.
//!
//! Decision: The panel of a System 900 speaks German where P11130 selects the second language, else English

use std::collections::BTreeMap;
use std::sync::Arc;
use std::sync::atomic::AtomicBool;
use std::time::Duration;

use bahn_host::{
    Action, Answer, AnyPlant, Attendance, Command900, Event, Host, Host900, HostError, Job900, KeyAction,
    Machine900, Operable as _, Operator900, PowerOn900,
};
use bahn_kernel::RunState;
use bahn_live::{EMERGENCY_STOP, Input, Passing, Refusal, Runs, Steps, StepsEnd, Ticket};
use bahn_screen::texts::{Language, words};
use bahn_screen::{Heading, Look, MachineState, MessageLine, Screen};
use bahn_system900::Memory;

use crate::console::Console;
use crate::keys::{CHANNELS, Held, MACHINE};
use crate::sight::{Desk, Sight};
use crate::{state, status, why};

/// While the control is off, inputs are looked for so often.
const OFF: Duration = Duration::from_millis(5);

/// A machine that is on, and its panel. It has no clock of its own: [`Station900::cycle`] is one interpolation cycle.
pub struct Station900 {
    machine: Machine900,
    supply: Supply,
    passing: Passing,
    /// What breaks long work off.
    urgent: Option<Arc<AtomicBool>>,
    console: Console,
    held: Held,
    shown: Screen,
}

/// The supply of the control.
enum Supply {
    On(Box<Host900>),
    /// Off: what the battery keeps, and the machine as it stands.
    Off(Box<Rest>),
}

struct Rest {
    /// What it keeps where no folder does.
    memory: Memory,
    kept: bool,
    plant: Option<AnyPlant>,
}

impl Station900 {
    /// Switches the machine on, fresh or with what it kept, as the function says.
    pub fn switched_on(machine: Machine900, with: impl FnOnce(&Machine900) -> PowerOn900) -> Station900 {
        let power_on = with(&machine);
        Station900::with(machine, power_on)
    }

    /// The same with what the control finds.
    pub fn with(machine: Machine900, power_on: PowerOn900) -> Station900 {
        let plant = machine.plant(&power_on.memory);
        let host = host(power_on, plant);
        Station900 {
            machine,
            supply: Supply::On(Box::new(host)),
            passing: Passing::default(),
            urgent: None,
            console: Console::default(),
            held: Held::default(),
            shown: Screen::default(),
        }
    }

    /// The folder of the machine.
    pub fn machine(&self) -> &Machine900 {
        &self.machine
    }

    /// Its host; `None` while the control is off.
    pub fn host(&self) -> Option<&Host900> {
        match &self.supply {
            Supply::On(host) => Some(host),
            Supply::Off(_) => None,
        }
    }

    /// The names of the keys of its operating panel: those of the control, then plus and minus of each axis.
    pub fn machine_keys(&self) -> Vec<String> {
        let channels = self.machine.checked.channels.iter();
        let mut names: Vec<&str> = Vec::new();
        for axis in channels.flat_map(|channel| &channel.axes) {
            if !axis.name.is_empty() && !names.contains(&axis.name.as_str()) {
                names.push(&axis.name);
            }
        }
        let directions = names
            .iter()
            .flat_map(|name| [format!("{name}-"), format!("{name}+")]);
        MACHINE
            .iter()
            .map(|name| (*name).to_owned())
            .chain(directions)
            .collect()
    }

    /// The numbers behind the screen, as JSON.
    pub fn state_json(&self) -> String {
        let state = self.host().map(|host| state::of(&self.machine, host));
        serde_json::to_string(&state).unwrap_or_default()
    }

    /// Takes what the operator does.
    ///
    /// # Errors
    /// When there is no such key, something holds him back, or this panel has it not.
    pub fn take(&mut self, input: &Input) -> Result<(), Refusal> {
        match input {
            Input::Power(switch) => return self.power(switch.is_on()),
            Input::Speed(factor) => {
                self.passing.set_speed(*factor)?;
                self.set_clock();
                return Ok(());
            }
            Input::Pause(switch) => {
                self.passing.steps.break_off(StepsEnd::Paused);
                self.set_going(|passing| passing.paused = switch.is_on());
                return Ok(());
            }
            Input::Cycles(cycles) => {
                self.set_going(|passing| passing.steps.ask(*cycles));
                return Ok(());
            }
            _ => {}
        }
        let language = self.language();
        let Supply::On(host) = &mut self.supply else {
            return Err(Refusal(words(language, "the control is off").to_owned()));
        };
        let mut desk = Desk {
            machine: &self.machine,
            host,
            channel: self.console.channel,
            language,
        };
        operate(input, &mut self.console, &mut self.held, &mut desk)
    }

    /// One interpolation cycle of the machine; nothing while it is off.
    ///
    /// # Errors
    /// When what survives power-off cannot be written; the machine goes on all the same.
    pub fn cycle(&mut self) -> Result<(), HostError> {
        let Supply::On(host) = &mut self.supply else {
            return Ok(());
        };
        self.passing.steps.pass();
        let cycled = host.step();
        host.drop_path();
        if self.held.is_tapped() {
            self.held.tick(&mut Desk {
                machine: &self.machine,
                host,
                channel: self.console.channel,
                language: Language::default(),
            });
        }
        cycled
    }

    /// The screen as it is now. Its serial counts on when it is another one.
    pub fn screen(&mut self) -> &Screen {
        let mut screen = self.make();
        screen.look = Look {
            letters: true,
            language: self.language(),
            ..Look::default()
        };
        screen.serial = self.shown.serial;
        // Time alone makes no other screen.
        self.shown.time_s = screen.time_s;
        self.shown.timeline.to_s = screen.time_s;
        self.shown.timeline.now_s = screen.time_s;
        screen.timeline = self.shown.timeline.clone();
        if screen != self.shown {
            screen.serial += 1;
            self.shown = screen;
        }
        &self.shown
    }

    fn language(&self) -> Language {
        let memory = match &self.supply {
            Supply::On(host) => host.control().memory(),
            Supply::Off(rest) => &rest.memory,
        };
        match memory.has_second_language() {
            true => Language::German,
            false => Language::English,
        }
    }

    fn make(&mut self) -> Screen {
        let machine = self.machine_state();
        let language = self.language();
        let Supply::On(host) = &self.supply else {
            let why = words(language, "The control is off: switch its supply on").to_owned();
            return Screen {
                machine,
                why: vec![why],
                time_s: self.shown.time_s,
                ..Screen::default()
            };
        };
        let sight = Sight {
            machine: &self.machine,
            host,
            channel: self.console.channel,
            language,
        };
        let (program, beside) = self.console.windows(&sight);
        Screen {
            time_s: host.control().now_us() as f64 / 1e6,
            mode: status::mode_of(&sight, sight.channel).to_owned(),
            headings: headings(&sight),
            dialogue: self.console.dialogue(&sight),
            messages: messages(&sight, self.console.note.as_ref()),
            program,
            beside,
            status: status::of(&sight, self.console.positions.positions),
            soft_keys: self.console.soft_keys(&sight),
            lamps: lamps(&sight),
            machine,
            why: why::of(&sight),
            ..Screen::default()
        }
    }

    fn machine_state(&self) -> MachineState {
        let host = self.host();
        let sight = host.map(|host| Sight {
            machine: &self.machine,
            host,
            channel: self.console.channel,
            language: Language::default(),
        });
        let wheel = sight.and_then(|sight| {
            let wheel = sight.memory().handwheel(1)?;
            let axis = sight.axes().find(|axis| axis.physical == wheel.axis)?;
            axis.name.chars().next()
        });
        MachineState {
            power: host.is_some(),
            emergency_stop: host.is_some_and(|host| host.plant().stop_chain().pressed),
            knobs: sight.map_or([0.0; 2], |sight| status::overrides(&sight)),
            held: self.held.names().to_vec(),
            handwheel: (wheel.unwrap_or('X'), 1),
            speed: self.passing.speed(),
            paused: self.passing.paused,
        }
    }

    fn set_clock(&mut self) {
        let clock = self.passing.clock();
        if let Supply::On(host) = &mut self.supply {
            host.set_clock(clock);
        }
    }

    /// Time that stood is not made up for when it goes on.
    fn set_going<T>(&mut self, what: impl FnOnce(&mut Passing) -> T) -> T {
        let stood = self.passing.stands();
        let done = what(&mut self.passing);
        if stood && !self.passing.stands() {
            self.set_clock();
        }
        done
    }

    fn power(&mut self, on: bool) -> Result<(), Refusal> {
        let said = |error: HostError| Refusal(error.to_string());
        match (&mut self.supply, on) {
            (Supply::On(host), false) => {
                host.store().map_err(said)?;
                let rest = Rest {
                    memory: host.control().memory().clone(),
                    kept: host.is_kept(),
                    plant: host.plant().copied(),
                };
                self.passing.steps.break_off(StepsEnd::Elsewhere);
                self.held = Held::default();
                self.console = Console::default();
                // The folder of its state is free with it.
                self.supply = Supply::Off(Box::new(rest));
            }
            (Supply::Off(rest), true) => {
                let power_on = match rest.kept {
                    true => PowerOn900::kept(&self.machine).map_err(said)?,
                    false => PowerOn900 {
                        memory: rest.memory.clone(),
                        ..PowerOn900::fresh(&self.machine)
                    },
                };
                let plant = rest
                    .plant
                    .take()
                    .unwrap_or_else(|| self.machine.plant(&power_on.memory));
                let mut host = host(power_on, plant);
                if let Some(urgent) = &self.urgent {
                    host.pace_outside();
                    host.break_off_by(Arc::clone(urgent));
                }
                host.set_clock(self.passing.clock());
                self.supply = Supply::On(Box::new(host));
            }
            _ => {}
        }
        Ok(())
    }
}

/// A control at power-on, operated by whoever is at the panel.
fn host(power_on: PowerOn900, plant: AnyPlant) -> Host900 {
    let job = Job900 { single_block: false };
    let operator = Operator900::new(Attendance::Absent, job);
    let mut host = Host::of_system900(power_on, plant, operator);
    host.be_exact();
    host
}

/// What is done to a control that is on.
fn operate(
    input: &Input,
    console: &mut Console,
    held: &mut Held,
    desk: &mut Desk<'_>,
) -> Result<(), Refusal> {
    match input {
        Input::Key(key) => press(key.name(), KeyAction::Tap, console, held, desk),
        Input::Held(key, button) => {
            let action = match button.is_pressed() {
                true => KeyAction::Press,
                false => KeyAction::Release,
            };
            press(key.name(), action, console, held, desk)
        }
        Input::Machine(name, action) => press(name, *action, console, held, desk),
        Input::Text(text) => console.text(text, desk),
        Input::FeedOverride(percent) => {
            let number = status::path_override(&desk.sight());
            turn(number, *percent, desk)
        }
        Input::SpindleOverride(percent) => turn(status::SPINDLE_OVERRIDE, *percent, desk),
        Input::Handwheel(steps) => event(&format!("handwheel 1 {steps}"), desk),
        Input::HandwheelAxis(letter, factor) => handwheel(*letter, *factor, desk),
        Input::Action(text) => action(text, desk),
        Input::GoTo(..) => Err(Refusal("the panel of a System 900 has no time line".to_owned())),
        Input::Lesson(_) | Input::HandIn => {
            Err(Refusal("the panel of a System 900 has no lessons".to_owned()))
        }
        Input::Transfer(_) => Err(Refusal(
            "the panel of a System 900 has no data interfaces".to_owned(),
        )),
        Input::Power(_) | Input::Speed(_) | Input::Pause(_) | Input::Cycles(_) => Ok(()),
    }
}

fn press(
    name: &str,
    action: KeyAction,
    console: &mut Console,
    held: &mut Held,
    desk: &mut Desk<'_>,
) -> Result<(), Refusal> {
    if name == EMERGENCY_STOP {
        let pressed = match action {
            KeyAction::Press => true,
            KeyAction::Release => false,
            KeyAction::Tap => !desk.host.plant().stop_chain().pressed,
        };
        return event(
            if pressed {
                "emergency press"
            } else {
                "emergency release"
            },
            desk,
        );
    }
    let is_of_machine = MACHINE.contains(&name) || (name.len() > 1 && name.ends_with(['+', '-']));
    if is_of_machine {
        let done = held.key(name, action, desk);
        console.note = done.as_ref().err().map(|refusal| refusal.0.clone());
        return done;
    }
    if action == KeyAction::Release {
        return Ok(());
    }
    let before = console.channel;
    let done = console.key(name, desk);
    if console.channel != before {
        // A key that is held moves no axis of another channel.
        held.release_all(desk);
    }
    done.unwrap_or_else(|| Err(Refusal(format!("the panel has no key {name}"))))
}

/// A knob goes to so many %.
fn turn(number: u8, percent: f64, desk: &mut Desk<'_>) -> Result<(), Refusal> {
    let memory = desk.host.control().memory();
    let (name, raw) = (memory.override_name(number), memory.override_raw(number, percent));
    desk.write(name, &raw.to_string())
}

/// Decision: The panel's factor of the handwheel is its multiplier, P11404; with 0 the handwheel does not act, P11402
fn handwheel(letter: char, factor: u8, desk: &mut Desk<'_>) -> Result<(), Refusal> {
    let sight = desk.sight();
    let physical = sight
        .axes()
        .find(|axis| axis.name.starts_with(letter))
        .map(|axis| axis.physical);
    let physical =
        physical.ok_or_else(|| Refusal(format!("channel {} has no axis {letter}", sight.channel)))?;
    let [axis, active, multiplier] = sight.memory().handwheel_names(1);
    desk.write(axis, &physical.to_string())?;
    desk.write(multiplier, &factor.to_string())?;
    desk.write(active, if factor == 0 { "0" } else { "1" })
}

/// A line of a script: parameters, or an event of the machine.
fn action(text: &str, desk: &mut Desk<'_>) -> Result<(), Refusal> {
    if !text.contains('=') {
        return event(text, desk);
    }
    let commands = Command900::parse_all(text).map_err(Refusal)?;
    commands.into_iter().try_for_each(|command| desk.give(command))
}

fn event(text: &str, desk: &mut Desk<'_>) -> Result<(), Refusal> {
    let event = Event::parse(text).map_err(|error| Refusal(error.to_string()))?;
    match desk.act(Action::Event(event, text.to_owned()))? {
        Answer::Done => Ok(()),
        Answer::Refused => Err(Refusal(String::new())),
        Answer::Impossible(why) => Err(Refusal(why)),
    }
}

/// The channels: which mode each is in, and which is shown.
fn headings(sight: &Sight<'_>) -> Vec<Heading> {
    let channels = (1..=sight.control().channels()).zip(CHANNELS);
    let headings = channels.map(|(number, key)| {
        let state = match sight.control().run(number).0 {
            _ if !sight.control().is_on_its_way(number) => "",
            RunState::Running | RunState::Idle => " ▶",
            _ => " ▮▮",
        };
        Heading {
            key: key.to_owned(),
            title: format!(
                "{} {number}  {}{state}",
                sight.words("CHANNEL"),
                status::mode_of(sight, number)
            ),
            active: number == sight.channel,
        }
    });
    headings.collect()
}

/// What nobody has acknowledged, of all channels, and what the panel itself has to say.
fn messages(sight: &Sight<'_>, note: Option<&String>) -> Vec<MessageLine> {
    let channels = 1..=sight.control().channels();
    let pending = channels.flat_map(|channel| sight.control().pending_messages(channel));
    let texts = pending.map(ToString::to_string).chain(note.cloned());
    let lines = texts.map(|text| MessageLine {
        text,
        ..MessageLine::default()
    });
    lines.collect()
}

/// Keys of the control that are lit: the mode, what runs or stands, what is asked for.
fn lamps(sight: &Sight<'_>) -> BTreeMap<String, bool> {
    use bahn_control900::Mode;
    let (control, channel) = (sight.control(), sight.channel);
    let mode = control.mode(channel);
    let (state, _) = control.run(channel);
    let on_its_way = control.is_on_its_way(channel);
    let runs = on_its_way && matches!(state, RunState::Running | RunState::Idle);
    let open = sight.axes().any(|axis| !sight.is_referenced(axis));
    let all = [
        ("HAND", mode == Mode::Hand),
        ("SEQUENCE", mode == Mode::Sequence),
        ("SINGLE", mode == Mode::Single),
        ("START", runs),
        ("STOP", on_its_way && !runs),
        ("RESET", control.pending_messages(channel).next().is_some()),
        ("REFERENCE", open),
        ("STEP", crate::keys::steps(sight)),
    ];
    all.into_iter()
        .map(|(name, lit)| (name.to_owned(), lit))
        .collect()
}

impl Runs for Station900 {
    /// Nobody asks for what happens: the pages show it.
    type Notices = ();

    fn notices(&mut self) {}

    fn wait_outside(&mut self, urgent: Arc<AtomicBool>) {
        if let Supply::On(host) = &mut self.supply {
            host.pace_outside();
            host.break_off_by(Arc::clone(&urgent));
        }
        self.urgent = Some(urgent);
    }

    fn run_in_real_time(&mut self) {
        self.passing.in_real_time = true;
        self.set_clock();
    }

    fn input(&mut self, input: &Input) -> Result<(), Refusal> {
        self.take(input)
    }

    fn begin_steps(&mut self, cycles: u32) -> Ticket {
        let ticket = self.set_going(|passing| passing.steps.ask(cycles));
        if matches!(self.supply, Supply::Off(_)) {
            self.passing.steps.break_off(StepsEnd::Elsewhere);
        }
        ticket
    }

    fn steps(&self) -> &Steps {
        &self.passing.steps
    }

    fn stands(&self) -> bool {
        self.passing.stands() || matches!(self.supply, Supply::Off(_))
    }

    fn rest(&self) -> Duration {
        self.host().map_or(OFF, Host::rest)
    }

    fn cycle(&mut self) -> Result<(), HostError> {
        Station900::cycle(self)
    }

    fn screen(&mut self) -> &Screen {
        Station900::screen(self)
    }

    fn store(&mut self) -> Result<(), HostError> {
        match &mut self.supply {
            Supply::On(host) => host.store(),
            Supply::Off(_) => Ok(()),
        }
    }
}
