//! Single rules of program run: messages with their block, refusals, stops, what the PLC learns.

use crate::stand::*;
use crate::support::*;
use bahn_tnc::RunState;

/// The blocks that the shown messages name.
fn blocks(rig: &Rig) -> Vec<Option<u32>> {
    let shown = rig.control.shown().iter();
    shown.map(|shown| shown.block.map(|block| block.block)).collect()
}

/// LIMIT SWITCH names the block that it refuses, a message of the PLC the block that runs; a fault interrupts
/// the run: `*` flashes, and the start tries the block again once its cause is gone [003:1578].
#[test]
fn messages_of_a_run_name_its_block() {
    let mut rig = ready(bench(ACKNOWLEDGE).program("1.H", "L X+55 R0 F6000\nL Y+60\nL X+600\nL X+40"));
    rig.start();
    rig.seconds(1.5);
    assert_eq!(
        (rig.messages(), blocks(&rig)),
        (vec!["LIMIT SWITCH X+".to_owned()], vec![Some(3)])
    );
    assert_eq!(rig.control.run_state(), RunState::Interrupted);
    assert!(rig.bit("M2183"), "interrupted");
    // The workpiece is moved: X+600 now lies within the range.
    rig.command("ce");
    rig.command("mode manual");
    rig.command("datum X 500");
    rig.command("mode full");
    rig.start();
    rig.until(5.0, "X+600", |rig| nominal(rig, 'X') == 600.0);
    rig.until(60.0, "the end", |rig| rig.control.has_ended());
    near(display(&rig, 'X'), 40.0);

    let plc = format!("{ACKNOWLEDGE}       L     I20\n       = M2929\n");
    let mut rig = ready(bench(&plc).program("1.H", "L X+55 R0 F6000\nL Y+80 F600\nL X+40"));
    rig.start();
    rig.seconds(1.0);
    rig.event("key A press");
    rig.seconds(0.1);
    assert_eq!(blocks(&rig), [Some(2)]);
}

/// After a fault another program can be chosen at once, and the operator can break the run off.
#[test]
fn a_fault_leaves_the_control_free() {
    for command in ["stop", "goto 1", "select 2.H"] {
        let build = bench(ACKNOWLEDGE).program("1.H", "L X+55 R0 F6000\nL X+600");
        let mut rig = ready(build.program("2.H", "L X+60 R0 F6000"));
        rig.start();
        rig.seconds(1.0);
        rig.command("ce");
        rig.command(command);
        assert_eq!(rig.control.run_state(), RunState::Idle, "{command}");
    }
}

/// FN14 300 to 399 show the texts of the machine's PLC messages, 400 to 483 its dialogues; where it has none
/// the control has its own [003:4352-4367].
#[test]
fn fn14_shows_the_texts_of_the_machine() {
    for (number, text) in [
        (305, "COOLANT LOW"),
        (306, "PLC: ERROR 6"),
        (401, "OPEN THE DOOR?"),
        (7, "ERROR 7"),
    ] {
        let build = bench(ACKNOWLEDGE).program("1.H", &format!("FN 14: ERROR = {number}"));
        let (mut setup, machine) = build.setup();
        setup.plc_messages = vec![String::new(); 5];
        setup.plc_messages.push("COOLANT LOW".to_owned());
        setup.plc_dialogues = vec![String::new(), "OPEN THE DOOR?".to_owned()];
        let mut rig = Rig {
            control: bahn_tnc::Control::new(setup),
            machine,
        };
        rig.power_on();
        rig.command("mode full");
        rig.command("select 1.H");
        rig.start();
        rig.seconds(0.5);
        let expected = format!("{text} program 1.H block 1");
        assert_eq!(rig.messages(), [expected]);
    }
}

/// A block that repeats the coordinate after a datum correction by +20 moves by it: back from 70 to 50
/// [000:8914].
#[test]
fn the_same_coordinate_after_a_datum_correction() {
    let plc = format!(
        "{ACKNOWLEDGE}       L     M2045
       AN    M0
       = M1
       L     M2045
       = M0
       L     M1
       IFT
         L     K+200000
         = D528
       ENDI
       L     M1
       S     M2716
"
    );
    for program in [
        "L X+50 R0 F6000\nM20\nL X+50",
        "L X+50 R0 F6000 M20\nL X+50",
        "L X+50 R0 F6000\nM20\nL IX-20",
    ] {
        let mut rig = ready(bench(&plc).program("1.H", program));
        let machine = rig.machine_position('X');
        near(display(&rig, 'X'), 50.0);
        rig.start();
        rig.until(5.0, "the end", |rig| rig.control.has_ended());
        near(display(&rig, 'X'), 50.0);
        near(rig.machine_position('X'), machine - 20.0);
    }
}

/// M91 needs the reference mark [000:4568-4576]: refused in MDI before it, executed after it.
#[test]
fn machine_coordinates_need_the_reference_marks() {
    let mut rig = bench(ACKNOWLEDGE).rig();
    rig.until(5.0, "the reference run is asked for", |rig| {
        rig.control.mode() == bahn_tnc::Mode::Reference
    });
    rig.command("mode mdi");
    let before = rig.machine_position('X');
    for (block, refused) in [("L X+60 R0 F6000 M91", true), ("L IX+5 R0 F6000", false)] {
        rig.command(&format!("mdi {block}"));
        rig.start();
        rig.seconds(1.0);
        let messages = rig.messages();
        let says = messages
            .iter()
            .any(|text| text.contains("X has not passed its reference mark"));
        assert_eq!(says, refused, "{block}: {messages:?}");
        if refused {
            near(rig.machine_position('X'), before);
            rig.command("ce");
        }
    }
    near(rig.machine_position('X'), before + 5.0);
}

/// M01 is free: it goes to the PLC and stops nothing by itself [000:7080].
#[test]
fn m01_stops_nothing() {
    let mut rig = ready(bench(ACKNOWLEDGE).program("1.H", "L X+60 R0 F6000 M1\nL X+70"));
    rig.start();
    rig.until(2.0, "M1 goes out", |rig| {
        rig.bit("M2045") && rig.number("W260") == 1
    });
    rig.until(3.0, "the end", |rig| rig.control.has_ended());
    near(display(&rig, 'X'), 70.0);
}

/// MP7210 = 1: a programming station with PLC moves no machine; programs are tested all the same [000:6951].
#[test]
fn a_programming_station_moves_nothing() {
    let build = bench(ACKNOWLEDGE).mp("7210=1").program("1.H", "L X+60 R0 F6000");
    let mut rig = build.rig();
    let x = rig.machine.axis('X').unwrap().position;
    rig.seconds(2.0);
    rig.control.command("mode full".parse().unwrap());
    rig.control.command("select 1.H".parse().unwrap());
    rig.start();
    rig.seconds(2.0);
    assert_eq!(rig.machine.axis('X').unwrap().position, x);
    assert!(!rig.control.loops_closed());
    assert!(rig.number("W272") == 5, "the PLC runs");
    assert!(rig.control.test("1.H"));
    rig.seconds(0.1);
    assert_eq!(
        rig.control.test_report().unwrap().state,
        bahn_tnc::TestState::Finished
    );
}

/// MP7620 bit 0: the feed override acts while the rapid traverse key is pressed in program run, or does not
/// [000:10512].
#[test]
fn override_with_the_rapid_key() {
    for (mp, feed) in [("7620=%0000", 3000.0), ("7620=%0001", 1500.0)] {
        let plc = format!("{ACKNOWLEDGE}       L     I14\n       = M2449\n       =N M2465\n");
        let mut rig = ready(bench(&plc).mp(mp).program("1.H", "L X+250 R0 F3000"));
        rig.event("override feed 50");
        rig.start();
        rig.seconds(1.0);
        near(rig.control.snapshot().feed_mm_min, 1500.0);
        rig.event("key RAPID press");
        rig.seconds(0.5);
        near(rig.control.snapshot().feed_mm_min, feed);
        rig.event("key RAPID release");
        rig.seconds(0.5);
        near(rig.control.snapshot().feed_mm_min, 1500.0);
    }
}

/// MP3010 = 4: the gear strobe comes at every TOOL CALL with S, also when it has nothing but S; with 3 only
/// when the gear changes. Coded speeds alike [000:5444-5472].
#[test]
fn gear_strobe_at_each_tool_call_with_s() {
    let strobes = |mp3010: u8| {
        let program = "TOOL CALL 1 Z S1000\nTOOL CALL S1000\nTOOL CALL S1000";
        let plc =
            format!("{ACKNOWLEDGE}       L     M2043\n       = M2480\n       L     M2044\n       = M2481\n");
        let build = bench(&plc).mp(&format!("3010={mp3010}")).mp("3510.0=3000");
        let mut rig = ready(build.program("1.H", program));
        rig.start();
        let edges = edges(&mut rig, "M2043 M2044", 2.0);
        assert!(rig.control.has_ended(), "{:?}", rig.messages());
        [edges.matches("M2043+").count(), edges.matches("M2044+").count()]
    };
    assert_eq!(
        [3, 4, 5, 1, 2].map(strobes),
        [[0, 0], [3, 0], [0, 0], [0, 1], [0, 3]]
    );
}

/// MP3510 is no limit of coded speeds: S4000 goes out as code 92, although the highest gear of the list has
/// less [000:5722]. A speed that an analogue spindle does not have is refused in the program with M2092, and
/// its tool call with it: nothing goes to the PLC [000:5653].
#[test]
fn speeds_that_the_spindle_has() {
    let plc =
        format!("{ACKNOWLEDGE}       L     M2043\n       = M2480\n       L     M2044\n       = M2481\n");
    let bench = |mp3010: &str| bench(&plc).mp(mp3010).mp("3510.1=2000").mp("3515.1=2000");
    let mut rig = ready(bench("3010=2").program("1.H", "TOOL CALL 1 Z S4000"));
    rig.start();
    rig.until(2.0, "the end", |rig| rig.control.has_ended());
    assert_eq!((rig.number("W258"), rig.bit("M2092")), (92, false));

    let mut rig = ready(bench("3010=3").program("1.H", "L X+55 R0 F6000\nTOOL CALL 1 Z S4000"));
    rig.start();
    let edges = edges(&mut rig, "M2046 M2092", 1.0);
    assert_eq!(
        (edges.matches("M2046+").count(), edges.matches("M2092+").count()),
        (0, 1),
        "{edges}"
    );
    assert_eq!(
        (rig.messages(), blocks(&rig)),
        (vec!["WRONG SPINDLE SPEED".to_owned()], vec![Some(2)])
    );
}

/// A test run beside finds a speed that the spindle does not have, as the run would.
#[test]
fn a_test_run_knows_the_spindle() {
    let build = bench(ACKNOWLEDGE).mp("3510.1=2000").mp("3515.1=2000");
    let build = build
        .program("1.H", "L X+60 R0 F600")
        .program("2.H", "L X+60 R0 F600\nTOOL CALL 1 Z S4000");
    let mut rig = ready(build);
    assert!(rig.control.test("2.H"));
    rig.seconds(0.1);
    let report = rig.control.test_report().unwrap();
    let bahn_tnc::TestState::Failed(message) = report.state else {
        panic!("{report:?}")
    };
    assert_eq!(rig.control.message_text(&message), "WRONG SPINDLE SPEED");
    assert_eq!(report.block.block, 2);
}

/// Cycle 13 itself tells the PLC (M2408); whichever M function orients with D592 = $80000000 then orients to
/// its angle, here M70 [000:5853-5865].
#[test]
fn cycle_13_reaches_any_orientation() {
    let plc = format!(
        "{ACKNOWLEDGE}       L     M2043
       = M2480
       L     M2719
       S     M2719
       L     K+0
       BS    K+31
       = D592
       L     W260
       == K+70
       A     M2045
       AN    M5
       S     M2712
       L     M2045
       = M5
"
    );
    let build = bench(&plc)
        .mp("3010=6")
        .mp("3510.0=3000")
        .mp("3520.1=60")
        .mp("3420=20")
        .mp("3440.0=5");
    let program = "TOOL CALL 1 Z S1000\nCYCL DEF 13.0 ORIENTATION\nCYCL DEF 13.1 ANGLE 123\nL X+55 R0 F600\nL X+56 R0 F600 M70\nL X+70";
    let mut rig = ready(build.program("1.H", program));
    rig.start();
    rig.until(3.0, "cycle 13", |rig| rig.bit("M2408"));
    assert!(
        rig.number("W260") != 70 && rig.number("W260") != 19,
        "before any M function"
    );
    rig.until(10.0, "the orientation", |rig| rig.bit("M2007"));
    rig.seconds(1.0);
    let angle = rig.machine.spindle().unwrap().angle_deg.rem_euclid(360.0);
    let from_mark = (angle - 90.0).rem_euclid(360.0);
    assert!(
        (from_mark - 123.0).abs() < 2.0 || (angle - 123.0).abs() < 2.0,
        "{angle}"
    );
}
