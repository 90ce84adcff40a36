//! Data between program and PLC: FN14, FN15, FN19, Q100 to Q107, datum correction, PLC positioning, module
//! 9150, inch programs.

use crate::stand::*;
use bahn_path::ToolShape;
use bahn_tnc::{RunState, Tool};

fn m_functions(lines: &str) -> String {
    format!("{ACKNOWLEDGE_BUT_M}{lines}")
}

/// FN14 ends the run with its text, program and block; after CE the start executes the block again.
#[test]
fn fn14() {
    let mut rig = bench_with(ACKNOWLEDGE, "L X+55 R0 F6000\nFN 14: ERROR = 100\nL X+60");
    rig.start();
    rig.seconds(1.0);
    let messages = rig.messages();
    assert!(
        messages.len() == 1 && messages[0].ends_with("program 1.H block 2"),
        "{messages:?}"
    );
    assert_eq!(rig.control.snapshot().run, RunState::Interrupted);
    near(display(&rig, 'X'), 55.0);
    rig.command("ce");
    rig.start();
    rig.seconds(0.5);
    assert_eq!(rig.messages(), messages);
}

/// FN15: PRINT halts nothing but its block.
#[test]
fn fn15() {
    let mut rig = bench_with(ACKNOWLEDGE, "FN 0: Q1 = +5\nFN 15: PRINT Q1\nL X+60 R0 F6000");
    run(&mut rig, 3.0);
    near(display(&rig, 'X'), 60.0);
}

/// FN19: PLC =+20.25/+100: D280 = 202 500, D284 = 1 000 000 with M2149; M2150 says the unit; the program goes
/// on after M2611 [000:11595-11655].
#[test]
fn fn19() {
    let mut rig = bench_with(
        "       L     M2149\n       A     I20\n       = M2611",
        "FN 19: PLC=+20.25/+100\nL X+60 R0 F6000",
    );
    rig.start();
    rig.seconds(1.0);
    assert!(rig.bit("M2149") && !rig.bit("M2150"));
    assert_eq!((rig.number("D280"), rig.number("D284")), (202_500, 1_000_000));
    near(display(&rig, 'X'), 50.0);
    rig.event("key A press");
    assert_eq!(edges(&mut rig, "M2149 M2611", 0.3), "M2611+ M2149- M2611-");
    rig.until(3.0, "the end", |rig| rig.control.snapshot().ended);
    near(display(&rig, 'X'), 60.0);
}

/// M2248: the PLC inhibits cycle 76 of its EPROM, so that it cannot be defined; nothing moves. One in the program memory
/// it does not inhibit [000:17757-17761] [000:17812-17821].
#[test]
fn the_plc_inhibits_cycles_of_the_eprom() {
    let text = |x: u32| format!("BEGIN PGM 99999976 MM\nDLG-DEF 0\nL X+{x} R0 F6000\nEND PGM 99999976 MM\n");
    let end = |plc: &str, in_memory: bool| {
        let mut build = bench(&format!("{ACKNOWLEDGE}{plc}")).mp("7240=1");
        build = build.program("1.H", "CYCL DEF 76.0 GO\nL IX+1");
        build.programs.0.insert("eprom/99999976".into(), text(60));
        if in_memory {
            build.programs.0.insert("99999976".into(), text(70));
        }
        let mut rig = ready(build);
        rig.start();
        rig.seconds(3.0);
        (display(&rig, 'X').round() as i32, rig.messages())
    };
    let inhibits = "\n       LN    M900\n       =     M2248";
    assert_eq!(end("", false), (61, Vec::new()));
    assert_eq!(end(inhibits, true), (71, Vec::new()));
    let (x, messages) = end(inhibits, false);
    assert_eq!(x, 50);
    assert!(
        messages.len() == 1 && messages[0].contains("FUNCTION NOT AVAILABLE ON THIS CONTROL"),
        "{messages:?}"
    );
}

/// In a program in inches M2150 is 1, X+3 is 76.2 mm and the display of the Q parameter counts in inches.
#[test]
fn inch_program() {
    let mut build = bench(ACKNOWLEDGE);
    let text = "BEGIN PGM 1 INCH\nFN 19: PLC=+1/+2\nL X+3 R0 F200\nL IY+0.5\nEND PGM 1 INCH\n";
    build.programs.0.insert("1.H".into(), text.into());
    let mut rig = ready(build);
    run(&mut rig, 5.0);
    assert!(rig.bit("M2150"));
    near(display(&rig, 'X'), 76.2);
    near(display(&rig, 'Y'), 62.7);
}

/// The PLC writes 12.5 to Q102 during M50. It counts with the next strobe, M51: the block before it still
/// reads 0 [000:11657-11663].
#[test]
fn q_parameters_from_the_plc() {
    let plc = m_functions(
        "
       L     M2045
       AN    M0
       = M1
       L     M2045
       = M0
       L     W260
       == K+50
       A     M1
       IFT
         L     K+125000
         = D528
         L     K+2
         = W516
       ENDI
       L     W260
       == K+50
       A     M1
       S     M2713
       L     M2045
       AN    M2713
       = M2482
",
    );
    let mut rig = bench_with(&plc, "M50\nL X+50 IY+Q102 R0 F6000\nM51\nL IY+Q102");
    rig.start();
    assert_eq!(
        edges(&mut rig, "M2045 M2713 M2482", 0.2),
        "M2045+ M2713+ M2713- M2482+ M2045- M2482- M2045+ M2482+ M2045- M2482-"
    );
    rig.until(3.0, "the end", |rig| rig.control.snapshot().ended);
    near(display(&rig, 'Y'), 62.5);
    assert_eq!(
        rig.control.remember().q.iter().find(|(number, _)| *number == 102),
        Some(&(102, 12.5))
    );
}

/// M20 corrects the datum by +20: X shows 70 instead of 50, nothing moves; the path goes straight on from where
/// the axes stand to the new target [000:8910-8991].
#[test]
fn datum_correction() {
    let plc = m_functions(
        "
       L     M2045
       AN    M0
       = M1
       L     M2045
       = M0
       L     W260
       == K+20
       A     M1
       IFT
         L     K+200000
         = D528
         L     K+0
         = D532
         = D536
       ENDI
       L     W260
       == K+20
       A     M1
       S     M2716
       L     M2045
       AN    M2716
       A     I20
       = M2482
",
    );
    for program in [
        "M20\nL X+100 Y+70 R0 F6000\nL X+50",
        "L X+100 Y+70 R0 F6000 M20\nL X+50",
    ] {
        let mut rig = bench_with(&plc, program);
        let machine = rig.machine_position('X');
        rig.start();
        rig.until(2.0, "the correction", |rig| rig.bit("M2045") && !rig.bit("M2716"));
        rig.seconds(0.2);
        near(display(&rig, 'X'), 70.0);
        near(rig.machine_position('X'), machine);
        rig.event("key A press");
        // A straight line: Y goes 20 mm while X goes 30, in proportion all the time.
        rig.until(3.0, "X+100", |rig| {
            let (x, y) = (nominal(rig, 'X'), nominal(rig, 'Y'));
            assert!(((x - 70.0) * 2.0 - (y - 50.0) * 3.0).abs() < 0.02, "{x} {y}");
            x == 100.0
        });
        rig.until(3.0, "the end", |rig| {
            assert!(rig.control.snapshot().feed_mm_min < 6000.1);
            rig.control.snapshot().ended
        });
        near(display(&rig, 'X'), 50.0);
        near(rig.machine_position('X'), machine - 20.0);
    }
}

/// MP7440 bit 2: the axes do not wait for an M function, so that the PLC may neither correct the datum nor position an axis
/// while it is output [000:7255]. The path goes on as it is programmed, without GROSS POSITIONING ERROR C; the corrections come
/// to nothing, and the position is taken when the program has ended.
#[test]
fn nothing_moves_beside_a_path_that_does_not_wait() {
    let plc = m_functions(
        "
       L     M2045
       AN    M0
       = M1
       L     M2045
       = M0
       L     M1
       IFT
         L     K+200000
         = D528
         L     K+0
         = D532
         = D536
       ENDI
       L     M1
       S     M2716
       L     M2045
       AN    M2716
       = M2482
",
    );
    let program = "L X+60 R0 F6000 M20\nL X+100 M21\nL X+50 Y+70";
    let mut rig = ready(bench(&plc).mp("7440=%00111").program("1.H", program));
    rig.start();
    rig.until(5.0, "the end", |rig| rig.control.snapshot().ended);
    near(display(&rig, 'X'), 50.0);
    near(display(&rig, 'Y'), 70.0);
    assert_eq!(rig.messages(), [""; 0]);

    let moves = plc_moves_z();
    let program = "L X+60 R0 F6000 M70\nL X+70\nL Z+40";
    let mut rig = ready(bench(&moves).mp("7440=%00111").program("1.H", program));
    let z = rig.machine_position('Z');
    rig.start();
    rig.until(3.0, "M70", |rig| rig.bit("M2706"));
    rig.until(3.0, "X+60", |rig| {
        near(rig.machine_position('Z'), z);
        nominal(rig, 'X') >= 60.0
    });
    assert_eq!(rig.messages(), [""; 0]);
}

/// An M function lets the PLC take Z to a position from the machine datum (D536, W564); after it the program goes on
/// from there without a jump, and axes that it does not name stay [000:4005-4088].
#[test]
fn plc_positioning_in_a_strobe() {
    let mut rig = bench_with(&plc_moves_z(), "L X+60 R0 F6000 M70\nL X+70\nL Z+40");
    rig.start();
    rig.until(3.0, "M70", |rig| rig.bit("M2706"));
    rig.until(3.0, "the position", |rig| !rig.bit("M2706"));
    near(rig.machine_position('Z'), 80.0);
    rig.until(3.0, "X+70", |rig| {
        assert!(nominal(rig, 'X') == 70.0 || (rig.machine_position('Z') - 80.0).abs() < 0.006);
        nominal(rig, 'X') == 70.0
    });
    rig.until(3.0, "the end", |rig| {
        assert!(rig.control.snapshot().feed_mm_min < 6000.1);
        rig.control.snapshot().ended
    });
    near(display(&rig, 'Z'), 40.0);
}

/// Module 9150 inserts TOOL CALL 2 during M60: it is executed when M60 is acknowledged, before the next block,
/// which then counts with the length of tool 2 (95 mm instead of 0).
#[test]
fn inserted_tool_call() {
    let plc = m_functions(
        "
       L     M2045
       AN    M0
       = M1
       L     M2045
       = M0
       L     W260
       == K+60
       A     M1
       CMT   INSERT
       L     M2045
       = M2482
       EM
LBL INSERT
       L     K+1
       = B200
       L     K+2
       = W202
       PS    K+0
       PS    K+200
       CM    9150
       PL    B204
",
    );
    let mut rig = bench_with(&plc, "TOOL CALL 0 Z S0\nM60\nL Z+50 R0 F6000");
    let z = rig.machine_position('Z');
    rig.start();
    assert_eq!(
        edges(&mut rig, "M2045 W262 M2046", 0.4),
        "M2045+ M2045- W262=2 M2046+ M2046-"
    );
    rig.until(5.0, "the end", |rig| rig.control.snapshot().ended);
    assert_eq!(rig.control.snapshot().tool, 2);
    near(display(&rig, 'Z'), 50.0);
    near(rig.machine_position('Z'), z + 95.0);
}

/// Without a program module 9150 calls tool 2 without a speed, bit 2 = 0: the speed stays as it is, 800 rpm and the
/// spindle that turns; with bit 2 = 1 it is that of the block, 450 rpm [000:16098-16106].
#[test]
fn an_inserted_call_without_speed_leaves_the_speed() {
    for (bits, rpm) in [(0b001, 800.0), (0b101, 450.0)] {
        let plc = format!(
            "{ACKNOWLEDGE}
       L     I20
       AN    M0
       = M1
       L     I20
       = M0
       L     M1
       CMT   INSERT
       EM
LBL INSERT
       L     K+{bits}
       = B200
       L     K+2
       = W202
       L     K+450000
       = D204
       PS    K+0
       PS    K+200
       CM    9150
       PL    B204
"
        );
        let mut build = bench(&plc).program("1.H", "TOOL CALL 0 Z S800");
        for parameter in ["3510.0=1500", "3210.0=9", "3515.0=1500"] {
            build = build.mp(parameter);
        }
        build.tools = Some([(2, Tool::default())].into());
        let mut rig = ready(build);
        run(&mut rig, 5.0);
        rig.event("key A press");
        rig.seconds(0.5);
        let spindle = rig.control.snapshot().spindle;
        assert_eq!((rig.control.tool(), spindle.programmed_rpm), (2, rpm), "{bits:b}");
    }
}

/// Without a program module 9150 calls a tool at once, but none that is locked, nor one that the table lacks; there is
/// no message [000:16063-16075].
#[test]
fn no_inserted_call_of_a_locked_tool() {
    for (tool, expected) in [(2, 2), (3, 0), (4, 0)] {
        let plc = format!(
            "{ACKNOWLEDGE}
       L     I20
       AN    M0
       = M1
       L     I20
       = M0
       L     M1
       CMT   INSERT
       EM
LBL INSERT
       L     K+1
       = B200
       L     K+{tool}
       = W202
       PS    K+0
       PS    K+200
       CM    9150
       PL    B204
"
        );
        let mut build = bench(&plc).program("1.H", "L X+60 R0 F6000");
        let locked = Tool {
            locked: true,
            ..Tool::default()
        };
        build.tools = Some([(2, Tool::default()), (3, locked)].into());
        let mut rig = ready(build);
        rig.event("key A press");
        rig.seconds(0.5);
        assert_eq!(rig.control.tool(), expected, "tool {tool}");
        assert_eq!(rig.messages(), [""; 0]);
    }
}

/// The programmer is to end the compensation before a PLC positioning [000:4052]; where he does not, the path goes on from where
/// the axes are, without a jump, and an axis that the next block does not name stays, as without compensation. R 3 on the left:
/// after X+80 the strobe stands at the inside corner, X+77 Y+63; the PLC takes X to 72, along which Y goes to 90.
#[test]
fn plc_positioning_in_a_compensated_block() {
    let moves_x = plc_moves_z()
        .replace("D536", "D528")
        .replace("W564", "W560")
        .replace("M2706", "M2704");
    let program = "TOOL CALL 1 Z S0\nL X+60 Y+60 RL F3000\nL X+80 M70\nL Y+90\nL X+100 R0";
    let mut rig = ready(bench("").program("1.H", program));
    let to_machine = rig.machine_position('X') - display(&rig, 'X');
    let target = ((72.0 + to_machine) * 10_000.0).round();
    let mut build = bench(&moves_x.replace("K+800000", &format!("K+{target}"))).program("1.H", program);
    let shape = ToolShape {
        radius: 3.0,
        ..ToolShape::default()
    };
    let tool = Tool {
        shape,
        ..Tool::default()
    };
    build.tools = Some([(1, tool)].into());
    rig = ready(build);
    rig.start();
    rig.until(5.0, "the strobe", |rig| rig.bit("M2704"));
    near(nominal(&rig, 'X'), 77.0);
    near(nominal(&rig, 'Y'), 63.0);
    rig.until(5.0, "the position", |rig| !rig.bit("M2704"));
    near(nominal(&rig, 'X'), 72.0);
    let mut last = [nominal(&rig, 'X'), nominal(&rig, 'Y')];
    while !rig.control.snapshot().ended {
        rig.cycle();
        assert!(rig.control.time_us() < 60_000_000, "no end");
        let now = [nominal(&rig, 'X'), nominal(&rig, 'Y')];
        // 3000 mm/min are 0.15 mm in a contour cycle of 3 ms.
        let way = (now[0] - last[0]).hypot(now[1] - last[1]);
        assert!(way < 0.16, "{last:?} {now:?}");
        if now[1] < 90.0 {
            near(now[0], 72.0);
        }
        last = now;
    }
    near(display(&rig, 'X'), 100.0);
    assert_eq!(rig.messages(), [""; 0]);
}
