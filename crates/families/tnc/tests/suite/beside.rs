//! What goes on beside the run: test run, what survives power-off.

use crate::support::*;
use bahn_tnc::{RunState, TestState};

/// While one program runs, another one is tested; its error names the block and moves nothing.
#[test]
fn a_test_run_beside_the_run() {
    let mut rig = Build::mill()
        .program(
            "1.H",
            "TOOL CALL 1 Z S1000\nL X+200 Y+100 Z+200 R0 F2000 M3\nL X+250\nL Z+250 FMAX M5",
        )
        .program("2.H", "L X+10 R0 F100\nL X+20\nCALL LBL 7")
        .program("3.H", "LBL 1\nL IX+1 R0 F100\nL IX-1\nCALL LBL 1 REP 5000")
        .rig();
    rig.power_on();
    rig.command("mode full");
    rig.command("select 1.H");
    rig.start();
    rig.until(30.0, "it runs", |rig| rig.control.snapshot().feed_mm_min > 0.0);
    assert!(!rig.control.test("9.H"), "there is none");
    assert_eq!(rig.messages(), ["PROGRAM NOT FOUND"]);
    rig.command("ce");
    assert!(rig.control.test("2.H"));
    rig.seconds(0.1);
    let report = rig.control.test_report().unwrap();
    let TestState::Failed(message) = &report.state else {
        panic!("{report:?}")
    };
    assert_eq!(rig.control.message_text(message), "LABEL NUMBER NOT ALLOCATED");
    assert_eq!(
        message.place().unwrap().split(':').next(),
        Some("program 2.H block 3")
    );
    assert_eq!(
        rig.control.snapshot().run,
        RunState::Running,
        "the machine goes on"
    );
    assert!(rig.control.test("3.H"));
    rig.until(5.0, "it is tested", |rig| {
        rig.control.test_report().unwrap().state == TestState::Finished
    });
    // Label, two lines and the call, once and 5000 times again.
    assert_eq!(rig.control.test_report().unwrap().blocks, 4 * 5001);
    rig.until(60.0, "the run ends", |rig| rig.control.snapshot().ended);
    assert_eq!(rig.messages(), [""; 0]);
}

/// The tool in the spindle is stored before M2046 falls; then the PLC may see the end of the change.
#[test]
fn a_tool_change_is_stored_before_its_strobe_falls() {
    let mut rig = Build::mill()
        .program("1.H", "TOOL CALL 2 Z S1000\nL X+200 R0 F2000")
        .rig();
    rig.control.keep_state(true);
    rig.power_on();
    rig.command("mode full");
    rig.command("select 1.H");
    rig.start();
    rig.until(5.0, "the strobe", |rig| rig.bit("M2046"));
    rig.until(20.0, "the PLC acknowledges", |rig| rig.bit("M2483"));
    rig.seconds(2.0);
    assert!(rig.bit("M2046") && rig.bit("M2483"), "waits for the medium");
    let remembered = rig.control.unsaved().unwrap();
    assert_eq!((remembered.tool, remembered.tool_length), (2, 95.0));
    rig.control.stored();
    rig.until(1.0, "the strobe falls", |rig| !rig.bit("M2046"));
    assert_eq!(rig.control.unsaved(), None);
    rig.until(60.0, "the run ends", |rig| rig.control.snapshot().ended);
}
