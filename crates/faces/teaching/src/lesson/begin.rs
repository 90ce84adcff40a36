//! How a lesson begins: nothing is broken, and the machine is where the task begins.

use bahn_host::{Action, AnyPlant, Operable, Source};
use bahn_machine::OperatorKeys;
use bahn_parameters::MessageId;
use bahn_tnc::{Command, Control, Message, Mode};

use super::Driven;
use super::file::{Begin, Lesson};
use super::player::Player;
use crate::drawer::can_be_done;

/// The control is off so long.
const OFF_S: f64 = 2.0;
/// Between two things that are done.
const PAUSE_S: f64 = 0.5;
/// Time at most until the machine is ready, and until everything is prepared.
const READY_S: f64 = 400.0;

/// Brings the machine to where the task begins, as fast as it goes.
///
/// # Errors
/// In words, when it does not get there.
pub(super) fn begin(station: &mut dyn Driven, lesson: &Lesson) -> Result<(), String> {
    if lesson.begin != Begin::Here {
        switch_on(station)?;
    }
    if lesson.begin == Begin::Ready {
        make_ready(station)?;
    }
    let begun_us = now_us(station);
    let mut player = Player::new(&lesson.prepare);
    while !player.is_done() {
        if now_us(station) > begun_us + (READY_S * 1e6) as u64 {
            let open = player.first_open().unwrap_or_default();
            return Err(format!("the lesson could not be prepared: line {open} waits"));
        }
        player.follow(&lesson.prepare, begun_us, station.host())?;
        station.cycle()?;
    }
    Ok(())
}

/// Everything is repaired and let go, and the control is switched off and on.
fn switch_on(station: &mut dyn Driven) -> Result<(), String> {
    act(station, "power off");
    wait(station, OFF_S)?;
    for action in whole(station.host().plant()) {
        act(station, &action);
    }
    wait(station, PAUSE_S)?;
    act(station, "power on");
    wait(station, PAUSE_S)
}

/// What puts a machine into the state of its description, as actions.
fn whole(plant: &AnyPlant) -> Vec<String> {
    let mut actions: Vec<String> = [
        "repair all",
        "emergency release",
        "voltage on",
        "override feed 100",
        "override spindle 100",
        "handwheel plug",
    ]
    .map(str::to_owned)
    .to_vec();
    actions.extend(plant.keys().iter().map(|key| format!("key {key} release")));
    for letter in plant.axis_letters() {
        actions.push(format!("force {letter} 0"));
        actions.push(format!("fault offset {letter} 0"));
    }
    let devices = plant.devices().into_iter();
    let devices = devices.filter_map(|device| Some((device.name, device.state?)));
    actions.extend(devices.map(|(name, state)| format!("switch {name} {state}")));
    // What the PLC moves is not moved by hand.
    actions.retain(|action| can_be_done(plant, action));
    actions
}

/// POWER INTERRUPTED, control voltage, reference marks, then MANUAL OPERATION.
fn make_ready(station: &mut dyn Driven) -> Result<(), String> {
    let end_us = now_us(station) + (READY_S * 1e6) as u64;
    while now_us(station) < end_us {
        let keys = station.machine().folder.operator.clone();
        let control = station.host().control();
        if control.loops_closed() && !control.first().lacks_reference() {
            act(
                station,
                &Action::Command(0, Command::Mode(Mode::Manual)).to_string(),
            );
            return wait(station, PAUSE_S);
        }
        if let Some(action) = next_action(control, &keys) {
            act(station, &action);
        }
        wait(station, 2.0 * PAUSE_S)?;
    }
    Err("the machine does not get ready: it does not pass its reference marks".to_owned())
}

/// What the control asks for.
fn next_action(control: &Control, keys: &OperatorKeys) -> Option<String> {
    let shows = |id: MessageId| {
        let mut shown = control.shown().iter();
        shown.any(|shown| shown.message == Message::Plain(id))
    };
    if shows(MessageId::PowerInterrupted) {
        return Some("ce".to_owned());
    }
    if shows(MessageId::RelayExtDcVoltageMissing) {
        let key = keys.control_voltage.as_ref();
        return key.map(|key| format!("key {key} tap"));
    }
    let runs = control.mode() == Mode::Reference && control.loops_closed() && control.stands();
    runs.then(|| format!("key {} tap", keys.start))
}

fn now_us(station: &mut dyn Driven) -> u64 {
    station.host().control().time_us()
}

fn act(station: &mut dyn Driven, text: &str) {
    // What the machine does not have needs no repair.
    if let Ok(action) = Action::parse(text) {
        let _ = station.host().act(Source::Script, action);
    }
}

fn wait(station: &mut dyn Driven, seconds: f64) -> Result<(), String> {
    let end_us = now_us(station) + (seconds * 1e6) as u64;
    while now_us(station) < end_us {
        station.cycle()?;
    }
    Ok(())
}
