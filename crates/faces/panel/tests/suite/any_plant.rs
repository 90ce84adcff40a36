//! A plant that is no simulated machine, at the operator's panel: docs/plant.md, "With the panel".

use std::path::Path;
use std::sync::Arc;

use crate::cross_table::{CrossTable, Folder, folder, load};
use bahn_host::{
    Action, Answer, Attendance, FolderPrograms, HostError, Operable, Operator, Phase, Play, PowerOn, Source,
    Stage,
};
use bahn_panel::{Input, InputText, KeyAction, Station};

/// What stands of an axis on the screen, mm.
fn shown(station: &mut Station, letter: char) -> f64 {
    let axes = station.screen().status.axes.clone();
    let axis = axes.iter().find(|axis| axis.letter == letter).unwrap();
    axis.value.replace(' ', "").parse().unwrap()
}

fn truth(station: &mut Station, letter: char) -> f64 {
    station.host().plant().true_axis(letter).unwrap().position
}

fn wait(station: &mut Station, seconds: f64) {
    let end = station.control().time_us() + (seconds * 1e6) as u64;
    while station.control().time_us() < end {
        station.cycle().unwrap();
    }
}

fn until(station: &mut Station, what: &str, so: impl Fn(&mut Station) -> bool) {
    for _ in 0..600 {
        if so(station) {
            return;
        }
        wait(station, 0.1);
    }
    panic!("{what}: {:#?}", station.screen());
}

fn key(station: &mut Station, name: &str, action: KeyAction) {
    station.input(&Input::Machine(name.to_owned(), action)).unwrap();
}

fn keyboard(station: &mut Station, keys: &str) {
    for key in keys.split_whitespace() {
        let text: InputText = serde_json::from_value(serde_json::json!({ "key": key })).unwrap();
        station.input(&Input::try_from(text).unwrap()).unwrap();
        wait(station, 0.1);
    }
}

/// Switched on, reference marks passed over.
fn ready(name: &str) -> (Folder, Station) {
    let folder = folder(name);
    let machine = load(&folder.0);
    let power_on = PowerOn::fresh(&machine);
    let mut station = Station::with_plant(machine, CrossTable::new(), power_on).unwrap();
    until(&mut station, "POWER INTERRUPTED", |station| {
        !station.screen().messages.is_empty()
    });
    keyboard(&mut station, "CE");
    until(&mut station, "PASS OVER REFERENCE MARKS", |station| {
        let screen = station.screen();
        screen.mode == "PASS OVER REFERENCE MARKS" && screen.messages.is_empty()
    });
    wait(&mut station, 1.0);
    key(&mut station, "NC_START", KeyAction::Tap);
    until(&mut station, "MANUAL OPERATION", |station| {
        station.screen().mode == "MANUAL OPERATION"
    });
    (folder, station)
}

/// The examples that this crate tries are those of the document.
#[test]
fn the_document_is_the_one_that_is_tried() {
    let document = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../../docs/plant.md");
    assert_eq!(
        include_str!("../../docs/plant.md"),
        std::fs::read_to_string(document).unwrap()
    );
}

/// Its folder describes no simulated machine: without a plant nothing is switched on.
#[test]
fn without_a_plant_nothing_is_switched_on() {
    let folder = folder("none");
    let refused = Station::power_on(load(&folder.0)).err();
    let root = folder.0.display().to_string();
    assert_eq!(refused, Some(HostError::NotSimulated(root)));
}

/// What the plant says it has is on the panel, and the drawer has nothing but its EMERGENCY STOP button.
#[test]
fn the_panel_has_what_the_plant_says() {
    let (_folder, mut station) = ready("panel");
    assert_eq!(station.machine_keys(), ["NC_START", "NC_STOP", "X+", "X-"]);
    assert_eq!(station.screen().lamps, [("RUNS".to_owned(), false)].into());
    let drawer = station.drawer();
    let actions: Vec<&str> = drawer
        .iter()
        .flat_map(|breakable| breakable.faults.iter().map(|breaking| breaking.action.as_str()))
        .collect();
    assert_eq!(actions, ["emergency press"]);
    let refused = station.input(&Input::Action("fault drive X dead".to_owned()));
    assert!(refused.is_err_and(|refusal| refusal.0.contains("the cross table has nothing for")));
}

/// A key that is held for a second moves the axis at MP1020, 3000 mm/min, for a second: 50 mm. What it gains when it brakes
/// it lost when it began. A PLC scan of 20 ms at either end is 1 mm.
#[test]
fn a_key_moves_an_axis() {
    let (_folder, mut station) = ready("key");
    let (from, at) = (truth(&mut station, 'X'), shown(&mut station, 'X'));
    key(&mut station, "X+", KeyAction::Press);
    wait(&mut station, 1.0);
    assert_eq!(station.screen().machine.held, ["X+"]);
    key(&mut station, "X+", KeyAction::Release);
    wait(&mut station, 1.0);
    let moved = truth(&mut station, 'X') - from;
    assert!((moved - 50.0).abs() < 2.0, "{moved} mm");
    let seen = shown(&mut station, 'X') - at;
    // The display has three decimals.
    assert!((seen - moved).abs() < 0.001, "{seen} {moved}");
}

/// A program runs, is stopped by EMERGENCY STOP, and the panel says why it does not go on.
#[test]
fn a_program_runs_and_why_says_what_it_waits_for() {
    let (_folder, mut station) = ready("program");
    for axis in ["X", "Y"] {
        station.input(&Input::Action(format!("datum {axis} 0"))).unwrap();
    }
    keyboard(&mut station, "FULL PGM_NR S Q U A R E ENT");
    key(&mut station, "NC_START", KeyAction::Tap);
    wait(&mut station, 0.3);
    assert!(station.screen().lamps["RUNS"]);
    // 4 sides of 30 mm at 3000 mm/min are 2.4 s and their ramps.
    until(&mut station, "the end", |station| {
        station.control().first().has_ended()
    });
    assert_eq!((shown(&mut station, 'X'), shown(&mut station, 'Y')), (0.0, 0.0));

    key(&mut station, "NC_START", KeyAction::Tap);
    wait(&mut station, 1.0);
    key(&mut station, "EMERGENCY_STOP", KeyAction::Press);
    wait(&mut station, 0.5);
    let stopped = truth(&mut station, 'X');
    wait(&mut station, 1.0);
    assert_eq!(truth(&mut station, 'X'), stopped);
    let screen = station.screen();
    assert!(screen.machine.emergency_stop);
    assert!(
        screen
            .why
            .iter()
            .any(|why| why.contains("I3") && why.contains("the EMERGENCY STOP button is pressed")),
        "{:?}",
        screen.why
    );
}

/// A copy of the plant is kept every second: any moment is reached again to the bit, and from there another way.
#[test]
fn the_time_line_goes_back() {
    let (_folder, mut station) = ready("past");
    key(&mut station, "X+", KeyAction::Press);
    wait(&mut station, 0.5);
    let then_s = station.control().time_us() as f64 / 1e6;
    let then = truth(&mut station, 'X');
    wait(&mut station, 1.5);
    key(&mut station, "X+", KeyAction::Release);
    wait(&mut station, 1.0);
    assert!(truth(&mut station, 'X') > then + 50.0);
    station.go_to(then_s).unwrap();
    assert_eq!(truth(&mut station, 'X'), then);
    assert_eq!(station.screen().machine.held, ["X+"]);
    key(&mut station, "X+", KeyAction::Release);
    station.input(&Input::Pause(bahn_panel::Switch::Off)).unwrap();
    wait(&mut station, 1.0);
    assert!(truth(&mut station, 'X') < then + 10.0);
    assert_eq!(station.screen().timeline.branches.len(), 1);
}

/// Another machine takes the place of this one, as its files are by now: the control begins anew, a plant of one's own stays
/// what and where it is. MP1020 is 1500 mm/min now: a key that is held for a second moves the axis by 25 mm.
#[test]
fn the_plant_stays_when_the_machine_is_replaced() {
    let (folder, mut station) = ready("replaced");
    key(&mut station, "X+", KeyAction::Press);
    wait(&mut station, 1.0);
    key(&mut station, "X+", KeyAction::Release);
    wait(&mut station, 1.0);
    let stands = truth(&mut station, 'X');
    let now_us = station.control().time_us();
    let mut machine = load(&folder.0);
    // Both axes stand behind their reference marks and would look for them in vain: MP1340 asks for none.
    let none = (0..5).map(|place| format!("1340.{place}=0"));
    for change in none.chain(["1020.0=1500".to_owned()]) {
        machine.parameters.assign(&change).unwrap();
    }
    let programs = Arc::new(FolderPrograms::of_folder(&machine.programs(0)));
    let mut keys = machine.folder.operator.clone();
    keys.start = "NC_START".to_owned();
    let operator = Operator::new(Attendance::Full, keys, None);
    station
        .host()
        .replace(&machine, PowerOn::fresh(&machine), programs, operator)
        .unwrap();
    assert_eq!(station.control().time_us(), now_us);
    assert_eq!(truth(&mut station, 'X'), stands);
    // The operator who stands by switches on.
    for _ in 0..60_000 {
        if station.host().operator().phase() == Phase::Ready {
            break;
        }
        station.host().step().unwrap();
    }
    assert_eq!(station.host().operator().phase(), Phase::Ready);
    let from = truth(&mut station, 'X');
    let press = |action: &str| Action::parse(&format!("key X+ {action}")).unwrap();
    for action in ["press", "release"] {
        assert_eq!(
            station.host().act(Source::Operator, press(action)).unwrap(),
            Answer::Done
        );
        let end = station.control().time_us() + 1_000_000;
        while station.control().time_us() < end {
            station.host().step().unwrap();
        }
    }
    let moved = truth(&mut station, 'X') - from;
    assert!((moved - 25.0).abs() < 1.0, "{moved} mm");
}

/// What was lost at power-on is said to the operator.
#[test]
fn what_was_lost_is_said() {
    let folder = folder("lost");
    let machine = load(&folder.0);
    let mut power_on = PowerOn::fresh(&machine);
    power_on
        .warnings
        .push("the pockets of the tool table have changed".to_owned());
    let mut station = Station::with_plant(machine, CrossTable::new(), power_on).unwrap();
    let said = &station.screen().messages;
    assert!(
        said.iter()
            .any(|line| line.text == "the pockets of the tool table have changed"),
        "{said:?}"
    );
}

/// A script presses keys and expects; what the plant does not have is found when the script is read.
#[test]
fn a_script_drives_it() {
    let (_folder, mut station) = ready("script");
    let parameters = station.machine().parameters.clone();
    let read = |station: &mut Station, text: &str| {
        let stage = Stage::machine(station.host().plant(), &parameters);
        stage.script(Path::new("S"), text.as_bytes())
    };
    let faults = read(&mut station, "1: key Y+ press\n2: expect lamp DOOR=1").unwrap_err();
    let labels: Vec<String> = faults.iter().map(bahn_text::Diagnostic::words).collect();
    assert_eq!(
        labels,
        [
            "the cross table has no key Y+",
            "the machine has no lamp `DOOR`; there are RUNS"
        ]
    );

    let now_s = station.control().time_us() as f64 / 1e6;
    let text = format!(
        "{now_s}: datum X 0\n+0.1: key X- press\n+1: expect X.actual<-40, X.table<-30\n+0: key X- release\n\
         +1: expect X.speed=0, lamp RUNS=0"
    );
    let mut play = Play::new(read(&mut station, &text).unwrap());
    while !play.is_done() {
        play.follow(station.host()).unwrap();
        station.cycle().unwrap();
    }
    assert!(play.failures().is_empty(), "{:#?}", play.failures());
}

/// A plant that cannot be copied, as real drives: all goes on without a time line, and nothing in the drawer.
struct Real(CrossTable);

impl bahn_servo::Plant for Real {
    fn exchange(
        &mut self,
        step: bahn_servo::Step,
        commands: &bahn_servo::Commands,
        measured: &mut bahn_servo::Measured,
    ) {
        self.0.exchange(step, commands, measured);
    }
}

impl Operable for Real {
    fn operate(&mut self, event: &bahn_host::Event) -> Result<(), String> {
        self.0.operate(event)
    }
}

#[test]
fn a_real_plant_stays_where_it_is() {
    let folder = folder("real");
    let machine = load(&folder.0);
    let power_on = PowerOn::fresh(&machine);
    let mut station = Station::with_plant(machine, Real(CrossTable::new()), power_on).unwrap();
    wait(&mut station, 3.0);
    keyboard(&mut station, "CE");
    assert!(station.drawer().is_empty() && station.machine_keys().is_empty());
    let refused = station.go_to(1.0).unwrap_err();
    assert_eq!(refused.0, HostError::StaysWhereItIs.to_string());
    assert!(station.host().save().is_none());
}
