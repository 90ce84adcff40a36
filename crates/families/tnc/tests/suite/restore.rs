//! Return to the contour and block scan [000:6765-6832].

use crate::stand::*;
use crate::support::*;
use bahn_tnc::RunState;

/// Contact A moves X in positive direction, B Z, while MANUAL OPERATION is on (M2018).
fn plc() -> String {
    format!(
        "{ACKNOWLEDGE}
       L     I20
       A     M2018
       = M2456
       =N M2472
       L     I21
       A     M2018
       = M2460
       =N M2476
"
    )
}

fn restore_rig(parameters: &str, program: &str) -> Rig {
    ready(
        bench(&plc())
            .mp(&format!("7680={parameters}"))
            .program("1.H", program),
    )
}

const RETURN: &str = "%0000010";
const SCAN: &str = "%0000110";

/// In the midst of a block the operator moves X and Z away; RESTORE POSITION and NC start bring them back to
/// the contour at MP4220 (2000 mm/min), X before Z, for Z goes down; the next NC start goes on with the block.
#[test]
fn return_to_the_contour() {
    let mut rig = restore_rig(RETURN, "TOOL CALL 0 Z S0\nL X+80 R0 F3000\nL X+90");
    rig.start();
    rig.until(3.0, "block 2", |rig| nominal(rig, 'X') > 60.0);
    rig.event("key NC_STOP tap");
    rig.seconds(0.5);
    let (x, z) = (nominal(&rig, 'X'), nominal(&rig, 'Z'));
    assert!(
        !rig.control.command("restore-position".parse().unwrap()),
        "nothing to restore"
    );
    rig.command("ce");
    rig.command("manual-operation");
    rig.seconds(0.1);
    assert!(rig.bit("M2018"));
    for key in ["A", "B"] {
        rig.event(&format!("key {key} press"));
        rig.seconds(0.5);
        rig.event(&format!("key {key} release"));
        rig.seconds(0.5);
    }
    assert!(nominal(&rig, 'X') > x + 10.0 && nominal(&rig, 'Z') > z + 10.0);
    rig.command("restore-position");
    rig.seconds(0.1);
    assert!(!rig.bit("M2018") && rig.bit("M2019"));
    let away = nominal(&rig, 'X');
    rig.seconds(0.5);
    assert_eq!(nominal(&rig, 'X'), away, "NC start moves them");
    rig.start();
    rig.until(5.0, "X is back", |rig| nominal(rig, 'X') == x);
    assert!(nominal(&rig, 'Z') > z + 5.0, "Z comes last");
    rig.until(5.0, "Z is back", |rig| !rig.bit("M2019"));
    assert_eq!((nominal(&rig, 'X'), nominal(&rig, 'Z')), (x, z));
    rig.seconds(0.5);
    assert_eq!(
        (nominal(&rig, 'X'), rig.control.snapshot().run),
        (x, RunState::Interrupted)
    );
    rig.start();
    rig.until(5.0, "the end", |rig| rig.control.snapshot().ended);
    near(display(&rig, 'X'), 90.0);
    near(display(&rig, 'Z'), z);
}

/// MP7680 bit 1 = 0: no return to the contour; bit 2 = 0: no block scan.
#[test]
fn without_the_functions() {
    let mut rig = restore_rig("%0000000", "L X+80 R0 F3000");
    assert!(!rig.control.command("restore-at 1".parse().unwrap()));
    rig.start();
    rig.until(3.0, "block 1", |rig| nominal(rig, 'X') > 60.0);
    rig.event("key NC_STOP tap");
    rig.seconds(0.5);
    assert!(!rig.control.command("manual-operation".parse().unwrap()));
}

/// A program that does not open is not scanned: the control says why, as it does at NC start.
#[test]
fn a_program_that_is_not_there_is_said() {
    let mut rig = restore_rig(SCAN, PROGRAM);
    rig.command("select 2.H");
    rig.command("restore-at 2");
    rig.seconds(0.1);
    assert_eq!(rig.messages(), ["PROGRAM NOT FOUND"]);
    assert!(!rig.bit("M2059"), "no block scan");
    rig.command("ce");
    rig.command("select 1.H");
    rig.command("restore-at 6");
    rig.seconds(0.1);
    assert!(rig.bit("M2059") && rig.messages().is_empty());
}

const PROGRAM: &str =
    "TOOL CALL 2 Z S1000\nFN 0: Q1 = +30\nL X+80 Y+60 R0 F3000 M3\nL X+90 M8\nL X+Q1\nL Y+20";

/// RESTORE AT 6: the functions before block 6 go to the PLC with M2059 = 1, no axis moves; RESTORE POSITION and
/// NC start bring the axes to where block 6 begins (X 30, Y 60), the tool axis last; then the run goes on.
#[test]
fn block_scan() {
    let mut rig = restore_rig(SCAN, PROGRAM);
    let (x, y) = (nominal(&rig, 'X'), nominal(&rig, 'Y'));
    rig.command("restore-at 6");
    let mut codes = Vec::new();
    let mut before = false;
    for _ in 0..300 {
        rig.cycle();
        let strobe = rig.bit("M2045");
        if strobe && !before {
            codes.push(rig.number("W260"));
            assert!(rig.bit("M2059"));
        }
        before = strobe;
    }
    assert_eq!(codes, [3, 8]);
    assert_eq!(rig.control.snapshot().tool, 2);
    assert_eq!((nominal(&rig, 'X'), nominal(&rig, 'Y')), (x, y));
    rig.command("restore-position");
    rig.seconds(0.1);
    assert!(!rig.bit("M2059") && rig.bit("M2019"));
    rig.start();
    rig.until(10.0, "the contour", |rig| !rig.bit("M2019"));
    near(display(&rig, 'X'), 30.0);
    near(display(&rig, 'Y'), 60.0);
    rig.seconds(0.3);
    rig.start();
    rig.until(5.0, "the end", |rig| rig.control.snapshot().ended);
    near(display(&rig, 'X'), 30.0);
    near(display(&rig, 'Y'), 20.0);
    assert_eq!(rig.messages(), [""; 0]);
}

/// MP7680 bit 3: the scan stops at STOP until NC start (0) or passes it (1).
#[test]
fn stop_in_the_scan() {
    let program = PROGRAM.replace("L X+90 M8", "STOP\nL X+90 M8");
    let mut rig = restore_rig(SCAN, &program);
    rig.command("restore-at 7");
    rig.seconds(1.0);
    assert_eq!(rig.number("W260"), 3, "before STOP");
    rig.start();
    rig.seconds(1.0);
    assert_eq!(rig.number("W260"), 8);
    let mut rig = restore_rig("%0001110", &program);
    rig.command("restore-at 7");
    rig.seconds(1.0);
    assert_eq!(rig.number("W260"), 8);
}

/// MP7680 bit 5: the scan starts at the cursor (0), or at the begin of the program (1).
#[test]
fn start_of_the_scan() {
    for (parameters, tool) in [("%0000110", 0), ("%0100110", 2)] {
        let mut rig = restore_rig(parameters, PROGRAM);
        rig.command("goto 3");
        rig.command("restore-at 5");
        rig.seconds(1.0);
        assert_eq!(rig.control.snapshot().tool, tool, "{parameters}");
    }
}

/// MP7680 bit 4: dwell times run in the scan (0), or are passed (1).
#[test]
fn dwell_in_the_scan() {
    let program = "CYCL DEF 9.0 DWELL TIME\nCYCL DEF 9.1 DWELL 3\nM8\nL X+60 R0 F3000";
    for (parameters, seen) in [("%0000110", false), ("%0010110", true)] {
        let mut rig = restore_rig(parameters, program);
        rig.command("restore-at 4");
        rig.seconds(1.0);
        assert_eq!(rig.number("W260") == 8, seen, "{parameters}");
        rig.seconds(3.0);
        assert_eq!(
            rig.number("W260"),
            8,
            "{:?} {:?}",
            rig.messages(),
            rig.control.snapshot()
        );
    }
}

/// A block that does not come ends the scan; INTERNAL STOP ends it, too: M2059 is reset.
#[test]
fn ends_of_the_scan() {
    let mut rig = restore_rig(SCAN, PROGRAM);
    rig.command("restore-at 60");
    rig.seconds(1.0);
    assert_eq!(rig.messages(), ["SELECTED BLOCK NOT ADDRESSED"]);
    assert!(!rig.bit("M2059"));
    rig.command("ce");
    rig.command("restore-at 6");
    rig.seconds(1.0);
    assert!(
        rig.bit("M2059"),
        "{:?} {:?}",
        rig.messages(),
        rig.control.snapshot()
    );
    rig.command("stop");
    rig.seconds(0.1);
    assert!(!rig.bit("M2059"));
    assert_eq!(rig.control.snapshot().run, RunState::Idle);
}

/// MP951.2 with MP7450 bit 2: after TOOL CALL the scan takes Z as standing at the tool change position, machine
/// 150; the block found has no Z, so Z returns there.
#[test]
fn tool_change_position_in_the_scan() {
    for (axes, z) in [("%00100", 150.0), ("%00000", f64::NAN)] {
        let build = bench(&plc())
            .mp(&format!("7680={SCAN}"))
            .mp("951.2=150")
            .mp(&format!("7450={axes}"));
        let mut rig = ready(build.program("1.H", PROGRAM));
        let before = rig.machine_position('Z');
        rig.command("restore-at 6");
        rig.seconds(1.0);
        rig.command("restore-position");
        rig.start();
        rig.seconds(0.3);
        rig.until(20.0, "the contour", |rig| !rig.bit("M2019"));
        near(rig.machine_position('Z'), if z.is_nan() { before } else { z });
        near(display(&rig, 'X'), 30.0);
    }
}
