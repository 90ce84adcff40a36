//! Scripts on the whole machine: power, wires, faults, parameters and operands of the running control, every command.

use std::path::Path;

use crate::support::*;
use bahn_host::{Host, Next, Notice, Play, Stage, Verdict};
use bahn_tnc::{Command, Signal};

/// Machine time in which a script must have come to its end, s.
const PATIENCE_S: f64 = 400.0;

/// Plays a script on the mill; what it expects must hold, and its end must come.
fn play(blocks: &str, script: &str) -> (Host, Vec<Notice>) {
    let machine = machine("mill");
    let stage = Stage::machine(machine.simulated().unwrap(), &machine.parameters);
    let script = stage.script(Path::new("s.txt"), script.as_bytes()).unwrap();
    let mut play = Play::new(script);
    let mut host = mill(blocks);
    let mut notices = host.notices();
    let mut reported = Vec::new();
    let mut started = false;
    loop {
        let ended = play.follow(&mut host).unwrap();
        if ended {
            break;
        }
        host.step().unwrap();
        let control = host.control();
        if !started && control.run_state() == bahn_tnc::RunState::Running {
            started = true;
            play.start(control.time_us());
        }
        assert!(
            control.time_us() as f64 * 1e-6 < PATIENCE_S,
            "{:?}",
            play.expectations()
        );
        reported.extend(notices.by_ref().filter_map(|next| match next {
            Next::Item(stamped) => Some(stamped.notice),
            Next::Missed(_) => None,
        }));
    }
    let failed = play
        .expectations()
        .into_iter()
        .filter(|case| case.verdict != Verdict::Held);
    let failed: Vec<_> = failed.collect();
    assert!(
        failed.is_empty(),
        "{failed:?}\nshown: {:?}",
        host.control().shown()
    );
    (host, reported)
}

fn value(host: &Host, signal: &str) -> f64 {
    host.control().observe(&signal.parse::<Signal>().unwrap())
}

const THERE: &str =
    "TOOL CALL 1 Z S1000\nL Z+50 R0 FMAX M3\nQ7 = 12.5\nL X+0 Y+0 R0 FMAX\nL X+100 F1500\nL X+0";

/// The supply fails in the middle of a movement: the axes stop where friction and brake stop them, the operator switches
/// on again and passes the reference marks, and datum, tool and Q parameters are what they were.
#[test]
fn power_goes_and_comes() {
    let script = "when X.actual > 250: power off\n+0.2: expect run idle, no message\n+2: power on\n\
        +0: expect message \"POWER INTERRUPTED\"\n+25: expect tool=1, M2136=0, run idle\n+0: end\n";
    let (host, _) = play(THERE, script);
    let truth = host.plant().axis('X').unwrap().position;
    assert!((value(&host, "X.actual") - truth).abs() < 0.01, "{truth}");
    let remembered = host.control().remember();
    assert!(remembered.q.contains(&(7, 12.5)), "{:?}", remembered.q);
    assert!(host.control().starts() == 2 && !host.control().is_off());
    // 25 mm/s end within the time constant of the drive, and friction does the rest.
    let (host, _) = play(THERE, "when X.actual > 250: power off\n+2: end\n");
    let truth = host.plant().axis('X').unwrap().position;
    assert!((250.0..251.0).contains(&truth), "{truth}");
    // Switched off nobody answers; switching on twice is nothing.
    let (host, _) = play(
        THERE,
        "1: power off\n+1: mode full\n+0: power off\n+0.5: expect mode manual\n+0: end\n",
    );
    assert!(host.control().is_off());
    assert!(!host.control().loops_closed() && !host.plant().control_voltage());
}

/// What is remembered over power-off is that of the memory of the PLC, too: M1000 is kept, M100 is not.
#[test]
fn power_off_clears_what_is_not_retained() {
    let script = "20: M1100=1, M900=1\n+0.1: expect M1100=1, M900=1\n+0.1: power off\n+1: power on\n+20: expect M1100=1, \
        M900=0\n+0: end\n";
    play("", script);
}

/// A contact of the drive breaks: the PLC sees it and stops the feed.
#[test]
fn wires_break_and_are_mended() {
    let script = "start+4: fault input I5 0\n+0.2: expect M2451=0\n+0: expect message \"DRIVE\"\n\
        +0.5: repair I5\n+0.5: expect M2451=1\n+0: end\n";
    play(THERE, script);
    // The wire of an encoder.
    let script =
        "start+4: fault encoder X amplitude\nafter message MEASURING SYSTEM: expect X.volts=0±0.5\n+0: end\n";
    play(THERE, script);
}

/// What fails is found; a message that flashes is cleared by power-off alone.
#[test]
fn what_fails_inside_is_found() {
    // The position is lost: the message flashes, and the circuit opens.
    let script = "start+4: fault encoder X amplitude\nafter message MEASURING SYSTEM: repair X\n\
        +0.3: expect X41/34=0, X42/4=0\n+0: ce\n+0.1: expect message \"MEASURING SYSTEM\"\n+0: power off\n+1: power on\n\
        +1: expect no message\n+1: expect X42/4=1\n+0: end\n";
    play(THERE, script);
    // The axis runs away: the control clears that without power-off.
    let script = "start+4: fault drive X runaway\nafter message POSITIONING ERROR: repair X\n+0.5: ce\n\
        +0.1: expect no message, X41/34=1\n+0: end\n";
    play(THERE, script);
    // At power-on the control tests that its output takes the voltage away [000:6175-6228].
    let script = "0: fault relay welded\nafter message EMERGENCY STOP DEFECTIVE: repair relay\n\
        +1: expect message \"EMERGENCY STOP DEFECTIVE\"\n+0: power off\n+1: power on\n+20: expect no message, X42/4=1\n\
        +0: end\n";
    play("", script);
}

/// What is wired to the machine is not set from outside: a contact is made to stick.
#[test]
fn inputs_belong_to_the_machine() {
    let machine = machine("mill");
    let stage = Stage::machine(machine.simulated().unwrap(), &machine.parameters);
    let faults = stage.script(Path::new("s.txt"), b"20: I4=1\n").unwrap_err();
    assert!(
        faults[0].message.contains("`fault input I4 1`"),
        "{}",
        faults[0].message
    );
}

/// An operand of the table is set like the PLC menu sets it; what the PLC writes in the next scan counts.
#[test]
fn operands_are_set_from_outside() {
    // M900 is nobody's; the PLC writes O7, a lamp, in every scan.
    let script = "20: M900=1, W900=$FFFE, S3=\"OIL\"\n+0.1: expect M900=1, W900=-2, S3=\"OIL\"\n\
        +0: O7=1\n+0.1: expect O7=0\n+0: end\n";
    play("", script);
}

/// Each class of machine parameters has its reaction [000:10088].
#[test]
fn parameters_change_on_the_running_control() {
    // MP4110 may change while a program runs, MP1710 may not.
    let script = "start+3: MP4110.0=7\n+0.1: expect no message, run running\n+0: MP1710.0=20\n+0.1: expect message \"KEY NON-FUNCTIONAL\"\n\
        +0: ce\n+0.1: end\n";
    play(THERE, script);
    // Without a program it may; MP4210 is a doubleword of the PLC.
    let script = "25: MP1710.0=20, MP4210.0=0.5\n+0.1: expect no message, D768=5000\n+0: end\n";
    play("", script);
    // Reference marks must be traversed again: M2136 is the marker of X.
    let script = "25: expect M2136=0\n+0: MP960.0=25\n+0.1: expect M2136=1, M2137=0\n+0: mode reference\n\
        +1: key NC_START tap\n+30: expect M2136=0\n+0: end\n";
    let (host, _) = play("", script);
    // The machine datum lies 5 mm further in the scale.
    let difference = value(&host, "X.actual") - host.plant().axis('X').unwrap().position;
    assert!((difference.abs() - 5.0).abs() < 0.01, "{difference}");
    // A reset: the control begins anew.
    let script = "25: MP7260=50\n+0: expect message \"POWER INTERRUPTED\"\n+20: expect no message\n+0: end\n";
    let (host, _) = play("", script);
    assert_eq!(host.control().starts(), 2);
}

/// Every command of the control is written in scripts as `bahn machine list` writes it.
#[test]
fn every_command_is_played() {
    let script = "25: mode manual\n+0.1: m 8\n+0.1: s 500\n+0.1: jog 0.5\n+0.1: handwheel X 3\n+0.1: datum X 12.5\n\
        +0.1: tool-life 1 2.5\n+0.1: code 123\n+0.1: key 107\n+0.1: test 1.H\n+0: test-run stop 2\n+0.1: end-test\n+0.1: offset off\n\
        +0.1: mode mdi\n+0.1: mdi L X+50 R0 F2000\n+0.1: key NC_START tap\n+10: expect run ended\n\
        +0.1: mode full\n+0.1: select 1.H\n+0.1: goto 1\n+0.1: key NC_START tap\n+3: key NC_STOP tap\n\
        +0.5: expect run interrupted\n+0: manual-operation\n+0.2: restore-position\n+0.2: stop\n+0.5: expect run idle\n\
        +0.1: restore-at 4\n+0.2: ce\n+0: ce\n+0.1: M900=1\n+0: MP4220.0=70\n+0.1: power off\n+0.1: power on\n+0.5: end\n";
    let (_, reported) = play(THERE, script);
    let words = |command: &Command| command.to_string().split(' ').next().unwrap().to_owned();
    let given: Vec<String> = reported
        .iter()
        .filter_map(|notice| match notice {
            Notice::Given(bahn_host::Source::Script, bahn_host::Action::Command(_, command), _) => {
                Some(words(command))
            }
            _ => None,
        })
        .collect();
    for word in [
        "mode",
        "ce",
        "stop",
        "select",
        "goto",
        "mdi",
        "m",
        "s",
        "datum",
        "tool-life",
        "jog",
        "handwheel",
        "manual-operation",
        "restore-position",
        "restore-at",
        "code",
        "key",
        "test",
        "test-run",
        "end-test",
        "offset",
        "M900=1",
        "MP4220.0=70",
        "power",
    ] {
        assert!(given.iter().any(|own| own == word), "{word} is not in {given:?}");
    }
}
