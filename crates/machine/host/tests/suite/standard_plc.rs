//! `plc = "standard"` and MP77: which PLC program a TNC 155 runs; the knee mill with the standard one.

use std::sync::atomic::{AtomicUsize, Ordering};

use crate::support::*;
use bahn_host::{Action, Host, LoadedMachine, PowerOn, Source};

/// A copy of a machine with edited files.
fn edited(name: &str, edits: &[(&str, &str, &str)]) -> (Copy, Result<LoadedMachine, String>) {
    static COPIES: AtomicUsize = AtomicUsize::new(0);
    let number = COPIES.fetch_add(1, Ordering::Relaxed);
    let copy = Copy::of(name, &format!("standard-plc-{number}"));
    for (file, from, to) in edits {
        let path = copy.path().join(file);
        let text = std::fs::read_to_string(&path).unwrap_or_default();
        assert!(text.contains(from), "{file}: {from}");
        std::fs::create_dir_all(path.parent().unwrap()).unwrap();
        let text = if from.is_empty() {
            (*to).to_owned()
        } else {
            text.replacen(from, to, 1)
        };
        std::fs::write(path, text).unwrap();
    }
    let machine = LoadedMachine::load(copy.path()).unwrap();
    let machine = machine.map_err(|faults| faults.iter().map(ToString::to_string).collect());
    (copy, machine)
}

/// The lines of the first file of its PLC program.
fn first_line(machine: &LoadedMachine) -> String {
    let file = machine.plc.files.first().unwrap();
    file.lines.first().cloned().unwrap_or_default()
}

const OWN: (&str, &str, &str) = ("OWN.PLC", "", "; own\n       U     E0\n       =     A0\n");
const IMAGE: (&str, &str, &str) = ("EPROM/OWN.PLC", "", "; image\n       U     E0\n       =     A0\n");
const NAMED: (&str, &str, &str) = ("machine.toml", "plc = \"standard\"", "plc = \"OWN.PLC\"");
const RAM: (&str, &str, &str) = ("parameters.mp", "MP77     : 1", "MP77     : 0");

/// The standard program by its name; with a file of the folder MP77 = 0 is that file, 1 its image in the EPROM, and without one
/// the standard program [001:1831].
#[test]
fn mp77_chooses_the_program() {
    let standard = "; Standard PLC program";
    for (edits, begins) in [
        (vec![], standard),
        (vec![RAM], standard),
        (vec![NAMED, OWN, RAM], "; own"),
        (vec![NAMED, OWN], standard),
        (vec![NAMED, OWN, IMAGE], "; image"),
    ] {
        let (_copy, machine) = edited("mill-tnc155", &edits);
        let line = first_line(&machine.unwrap());
        assert!(line.starts_with(begins), "{edits:?}: {line}");
    }
}

/// The control is delivered with its program whatever is fitted to it: it runs without the option of spindle orientation, whose
/// markers it names. A program of one's own that names them takes the option [001:179-182] [001:3117-3137].
#[test]
fn the_standard_program_takes_no_option() {
    let none = (
        "machine.toml",
        "model = \"tnc155\"",
        "model = \"tnc155\"\noptions = []",
    );
    let (_copy, machine) = edited("mill-tnc155", &[none]);
    assert!(machine.is_ok(), "{:?}", machine.err());
    let names = ("OWN.PLC", "", "       U     E0\n       =     M2527\n");
    let (_copy, machine) = edited("mill-tnc155", &[none, NAMED, names, RAM]);
    let said = machine.err().unwrap();
    assert!(said.contains("spindle-orientation"), "{said}");
}

/// A control without a standard program says so at the line of the key.
#[test]
fn other_controls_have_none() {
    let (_copy, machine) = edited(
        "mill",
        &[("machine.toml", "plc = \"plc/MAIN.PLC\"", "plc = \"standard\"")],
    );
    let said = machine.err().unwrap();
    assert!(
        said.contains("the TNC 415 B has no standard PLC program"),
        "{said}"
    );
}

fn bit(host: &Host, name: &str) -> bool {
    host.control().exchange().plc().bit(name.parse().unwrap())
}

/// An event at the machine.
fn event(host: &mut Host, text: &str) {
    host.act(Source::Script, Action::parse(text).unwrap()).unwrap();
}

/// Steps until something is so.
fn until(host: &mut Host, seconds: f64, so: impl Fn(&Host) -> bool) {
    let end_us = host.control().time_us() + (seconds * 1e6) as u64;
    while !so(host) {
        assert!(
            host.control().time_us() < end_us,
            "{:?}",
            host.control().snapshot()
        );
        host.step().unwrap();
    }
}

const PROGRAM: &str = "TOOL CALL 1 Z S600
L Z+20 R0 F9999 M13
L X+30 Y+20 F1000
TOOL CALL 2 Z S2000
L X+10 M3
L M5
L M30";

/// The cabinet does what the codes say: the gears shift while the spindle swings, coolant and spindle hold themselves after
/// the code, and M30 ends both.
#[test]
fn the_knee_mill_works_by_its_cabinet() {
    let machine = machine("mill-tnc155");
    let mut host = host(&machine, PowerOn::fresh(&machine), PROGRAM);
    let state = |host: &Host, name: &str| host.plant().device(name).unwrap().state.map(str::to_owned);
    until(&mut host, 60.0, |host| bit(host, "A15"));
    assert_eq!(host.plant().spindle().unwrap().gear, Some(1));
    until(&mut host, 5.0, |host| !bit(host, "A15"));
    seconds(&mut host, 1.0);
    assert_eq!(
        ["spindle_contactor", "flood"].map(|name| state(&host, name)),
        ["on", "on"].map(|on| Some(on.to_owned()))
    );
    let rpm = host.plant().spindle().unwrap().rpm;
    assert!((rpm - 600.0).abs() < 5.0, "{rpm}");
    // The second gear: MP70 = 0.2 V swings the motor at 0.2 / 9 * 3000 = 67 rpm, where the teeth find each other.
    until(&mut host, 60.0, |host| bit(host, "A8") && bit(host, "A20"));
    until(&mut host, 10.0, |host| {
        host.plant().spindle().unwrap().gear == Some(2)
    });
    assert!(bit(&host, "A8"), "the code stays until the gear is there");
    let motor = host.plant().spindle().unwrap().motor_rpm.abs();
    assert!(motor < 150.0, "{motor}");
    until(&mut host, 60.0, |host| host.control().snapshot().ended);
    seconds(&mut host, 2.0);
    assert_eq!(
        ["spindle_contactor", "flood"].map(|name| state(&host, name)),
        ["off", "off"].map(|off| Some(off.to_owned()))
    );
    assert_eq!(host.plant().spindle().unwrap().rpm, 0.0);
}

/// A contactor that sticks: E17 never comes, and the code of M13 stays.
#[test]
fn a_contactor_that_sticks_holds_the_code() {
    let machine = machine("mill-tnc155");
    let mut host = host(&machine, PowerOn::fresh(&machine), PROGRAM);
    event(&mut host, "fault device coolant_contactor jammed");
    until(&mut host, 60.0, |host| bit(host, "A18"));
    seconds(&mut host, 30.0);
    assert!(bit(&host, "A18") && !bit(&host, "E17"));
    event(&mut host, "repair coolant_contactor");
    until(&mut host, 2.0, |host| !bit(host, "A18"));
}
