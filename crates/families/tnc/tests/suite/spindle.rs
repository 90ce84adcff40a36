//! The spindle through the kernel: gears, diagram, S codes, orientation [000:5438-6043].

use crate::stand::*;
use crate::support::Rig;
use bahn_tnc::RunState;

/// Example 12: the diagram of the manual, speed by speed [000:5596-5610].
#[test]
fn diagram_of_the_manual() {
    for (speed, percent, rpm, volts) in [
        (1500, 100, 1500.0, 6.0),
        (1500, 125, 1875.0, 7.5),
        (3000, 100, 3000.0, 8.0),
        (3000, 125, 3375.0, 9.0),
        (3000, 50, 1500.0, 4.0),
        (3000, 20, 1500.0, 4.0),
        (100, 100, 100.0, 1.0),
    ] {
        let program = format!("TOOL CALL 0 Z S{speed}\nM3");
        let mut rig = ready(diagram(&with_gear()).program("1.H", &program));
        rig.event(&format!("override spindle {percent}"));
        run(&mut rig, 5.0);
        rig.seconds(0.5);
        let spindle = rig.control.snapshot().spindle;
        assert!(
            (spindle.volts - volts).abs() < 0.001,
            "S{speed} {percent} %: {spindle:?}"
        );
        near(spindle.nominal_rpm, rpm);
        assert_eq!(spindle.gear, if speed > 1500 { 2 } else { 1 });
        assert_eq!(rig.number("D356"), speed * 1000);
        assert_eq!(rig.number("W320"), rpm as i32);
        assert!(rig.bit("M2042") && rig.bit("M2004") && !rig.bit("M2005"));
    }
}

/// The PLC's override in W764 replaces the potentiometer.
#[test]
fn override_by_the_plc() {
    let plc = format!(
        "{}       L     I20\n       IFT\n         L     K+60\n         = W764\n       ENDI",
        with_gear()
    );
    let mut rig = ready(diagram(&plc).program("1.H", "TOOL CALL 0 Z S1000\nM3"));
    run(&mut rig, 5.0);
    rig.event("key A press");
    rig.seconds(0.5);
    near(rig.control.snapshot().spindle.nominal_rpm, 600.0);
    rig.event("override spindle 120");
    rig.seconds(0.2);
    near(rig.control.snapshot().spindle.nominal_rpm, 600.0);
    assert_eq!(rig.number("W492"), 120);
}

/// Example 14, with its repair: the gear code on outputs O15 to O17, jog left for T13, right for T14 and again
/// while M2043 waits; I5 (here contact A) acknowledges [000:5658-5712].
#[test]
fn gear_change_with_jog() {
    let plc = format!(
        "{SPINDLE}
       L     M2043
       AN    T61
       AN    T62
       AN    T13
       AN    T14
       = M968
       L     M968
       AN    M969
       = T13
       L     M968
       A     M969
       = T14
       L     M968
       XO    M969
       = M969
       L     T61
       = M2490
       L     T62
       = M2491
       L     W256
       B=    O15
       L     M2043
       A     I20
       = M2480
"
    );
    let plc = plc.replace(
        "       L     W256\n       B=    O15\n",
        "       L     W256\n       == K+1\n       = O15\n",
    );
    let build = diagram(&plc).mp("4110.13=10").mp("4110.14=5").mp("3240.2=0.6");
    let mut rig = ready(build.program("1.H", "TOOL CALL 0 Z S3000\nL X+60 R0 F6000"));
    rig.start();
    rig.until(1.0, "the gear strobe", |rig| rig.bit("M2043"));
    assert_eq!(
        (rig.number("W256"), rig.number("D356"), rig.number("D756")),
        (1, 3_000_000, 3_000_000)
    );
    let jog = edges(&mut rig, "M2490 M2491", 0.7);
    // 10 and 5 cycles of 20 ms, with a scan between them.
    assert!(
        jog.starts_with("M2490+ M2490- M2491+ M2491- M2490+ M2490- M2491+ M2491-"),
        "{jog}"
    );
    rig.until(1.0, "jog left", |rig| rig.bit("M2490"));
    rig.seconds(0.1);
    near(rig.control.snapshot().spindle.volts, -0.6);
    assert!(rig.bit("O15"));
    near(display(&rig, 'X'), 50.0);
    rig.event("key A press");
    assert_eq!(edges(&mut rig, "M2043 M2480", 0.2), "M2480+ M2043- M2480-");
    rig.until(2.0, "the end", |rig| rig.control.snapshot().ended);
    rig.seconds(0.5);
    let spindle = rig.control.snapshot().spindle;
    assert_eq!((spindle.gear, spindle.volts), (2, 0.0));
    assert_eq!(rig.number("W256"), 1, "keeps its value");
}

/// M2814: gear 2 and 1500 rpm by the PLC; the NC resets the marker [000:5620-5624].
#[test]
fn gear_and_speed_from_the_plc() {
    let plc = format!(
        "{}
       L     I20
       AN    M0
       = M1
       L     I20
       = M0
       L     M1
       IFT
         L     K+1
         = W256
         L     K+1500000
         = D756
       ENDI
       L     M1
       S     M2814",
        with_gear()
    );
    let mut rig = ready(diagram(&plc).program("1.H", "TOOL CALL 0 Z S1000\nM3"));
    run(&mut rig, 5.0);
    rig.event("key A press");
    assert_eq!(edges(&mut rig, "M2814", 0.3), "M2814+ M2814-");
    rig.seconds(0.3);
    let spindle = rig.control.snapshot().spindle;
    assert_eq!(spindle.gear, 2);
    near(spindle.volts, 4.0);
}

/// MP3010: when the gear or S code goes out, for the calls S1000, S1000, S1200, S3000 [000:5444-5472].
#[test]
fn kinds_of_output() {
    let strobes = |mp3010: u8| {
        let build = diagram(&with_gear()).mp(&format!("3010={mp3010}"));
        let program = "TOOL CALL 1 Z S1000\nTOOL CALL 1 Z S1000\nTOOL CALL 1 Z S1120\nTOOL CALL 1 Z S3150";
        let program = if mp3010 > 2 {
            program.replace("3150", "3000")
        } else {
            program.to_owned()
        };
        let mut rig = ready(build.program("1.H", &program));
        rig.start();
        let edges = edges(&mut rig, "M2043 M2044", 2.0);
        assert!(
            rig.control.snapshot().ended,
            "MP3010 = {mp3010}: {:?}",
            rig.messages()
        );
        [edges.matches("M2043+").count(), edges.matches("M2044+").count()]
    };
    assert_eq!(strobes(0), [0, 0]);
    assert_eq!(strobes(1), [0, 3]);
    assert_eq!(strobes(2), [0, 4]);
    assert_eq!(strobes(3), [1, 0]);
    assert_eq!(strobes(4), [4, 0]);
    assert_eq!(strobes(5), [0, 0]);
    assert_eq!(strobes(6), [1, 0]);
    assert_eq!(strobes(7), [4, 0]);
    assert_eq!(strobes(8), [0, 0]);
}

/// MP3020 = 20802: codes 20 to 80, every second. S1000 is code 80, S1.25 code 22; S1.12 (21) and S2000 (86)
/// are refused with WRONG RPM and M2092, and the block with them; W1008 = 20 [000:5718-5745].
#[test]
fn coded_speed() {
    let start = |speed: &str| {
        let build = diagram(&with_gear()).mp("3010=2").mp("3020=20802");
        let mut rig = ready(build.program("1.H", &format!("TOOL CALL 1 Z S{speed}\nL X+60 R0 F6000")));
        rig.start();
        rig.seconds(1.5);
        rig
    };
    for (speed, code) in [("1000", 80), ("1.25", 22), ("1", 20)] {
        let rig = start(speed);
        assert_eq!(rig.number("W258"), code);
        assert!(rig.control.snapshot().ended && !rig.bit("M2092"));
        assert_eq!(rig.number("W1008"), 20);
    }
    for speed in ["1.12", "2000"] {
        let mut rig = start(speed);
        assert_eq!(rig.messages(), ["WRONG SPINDLE SPEED"], "{speed}");
        assert!(rig.bit("M2092"));
        near(display(&rig, 'X'), 50.0);
        assert_eq!(rig.control.snapshot().run, RunState::Interrupted);
        rig.command("ce");
        rig.start();
        rig.seconds(0.5);
        assert_eq!(rig.messages(), ["WRONG SPINDLE SPEED"], "the same block again");
    }
}

/// MP3030 = 1: the axes do not halt when TOOL CALL gives a speed only; with 0 they do [000:5645-5651].
#[test]
fn speed_without_axis_halt() {
    let halts = |mp3030: &str| {
        let build = diagram(&with_gear()).mp(mp3030).mp("3010=4");
        let mut rig = ready(build.program("1.H", "L X+60 R0 F3000\nTOOL CALL S1200\nL X+70"));
        rig.start();
        rig.until(2.0, "X+55", |rig| nominal(rig, 'X') > 55.0);
        let mut slowest = f64::INFINITY;
        while nominal(&rig, 'X') < 65.0 {
            rig.cycle();
            slowest = slowest.min(rig.control.snapshot().feed_mm_min);
        }
        rig.until(2.0, "the end", |rig| rig.control.snapshot().ended);
        assert_eq!(rig.number("D356"), 1_200_000);
        slowest < 1.0
    };
    assert!(halts("3030=0"));
    assert!(!halts("3030=1"));
}

/// More than one of M2485 to M2487: ERROR IN PLC-PROGRAM 1Q, flashing [000:5496-5498].
#[test]
fn two_directions_are_a_fault() {
    let mut rig = bench_with("       L     I20\n       S     M2485\n       S     M2486", "");
    rig.event("key A press");
    rig.seconds(0.2);
    assert_eq!(rig.messages(), ["ERROR IN PLC-PROGRAM 1Q"]);
    rig.control.command("ce".parse().unwrap());
    assert_eq!(
        rig.messages()[0],
        "ERROR IN PLC-PROGRAM 1Q",
        "it flashes: CE does not clear it"
    );
}

/// M19 orients to the angle of cycle 13 (D592 = $80000000), M20 to MP4210.47; M2482 only when the
/// spindle is in position and M2712 is reset [000:5952-6043].
const ORIENTATION: &str = "
       L     M2719
       S     M2496
       LN    M2045
       R     M12
       R     M2482
       L     M1919
       A     M2045
       AN    M12
       CMT   FROM_CYCLE
       L     M1919
       A     M2045
       S     M12
       L     M1920
       A     M2045
       AN    M12
       CMT   FROM_MP
       L     M1920
       A     M2045
       S     M12
       L     M1919
       O     M1920
       A     M2045
       A     M2007
       AN    M2712
       S     M2482
       L     M2046
       = M2483
       L     M2043
       = M2480
       EM
LBL FROM_CYCLE
       L     K+0
       BS    K+31
       = D592
       L     M2719
       S     M2712
       EM
LBL FROM_MP
       L     D956
       = D592
       L     M2719
       S     M2712
";

/// Example 15 of the manual: both orientations, with the order of edges.
#[test]
fn orientation() {
    let program = "CYCL DEF 13.0 ORIENTATION\nCYCL DEF 13.1 ANGLE 45\nTOOL CALL 0 Z S1000\nM19\nM20";
    let build = diagram(ORIENTATION)
        .mp("4210.47=120")
        .mp("3440.0=5")
        .mp("3520.1=60")
        .mp("3410.1=0.05");
    let mut rig = ready(build.program("1.H", program));
    rig.start();
    rig.until(2.0, "M19", |rig| rig.bit("M1919"));
    let order = edges(&mut rig, "M2712 M2127 M2007 M2045 M2482", 6.0);
    let done = "M2712- M2127- M2007+ M2482+ M2045- M2482-";
    assert_eq!(order, format!("M2127+ {done} M2712+ M2045+ M2127+ M2007- {done}"));
    assert!(rig.control.snapshot().ended, "{order} {:?}", rig.messages());
    assert!(rig.bit("M2408"), "until the PLC resets it");
    // MP3430: the mark of the encoder stands at 90 degrees; the angle of the machine is that of the spindle.
    let angle = rig.machine.spindle().unwrap().angle_deg.rem_euclid(360.0);
    assert!((angle - 120.0).abs() < 1.0, "{angle}");
}

/// M2656 chooses the direction in which a spindle that stands is oriented by M2712, here to 120 degrees from D592 and
/// back to 0: with M04 always down, by the longer way, too. With M2501 it turns at MP3520.0 that way [000:5859]
/// [000:5893-5895].
#[test]
fn direction_of_orientation() {
    let plc = format!(
        "{}
       L     I21
       = M2656
       L     I22
       = M2501
       L     I20
       AN    M0
       = M1
       L     I20
       = M0
       L     M1
       CMT   TO_AND_FRO
       EM
LBL TO_AND_FRO
       L     K+1200000
       -     D592
       = D592
       L     M1
       S     M2712
",
        with_gear()
    );
    let build = diagram(&plc).mps("3440.0=5 3520.0=40 3520.1=60 3410.1=0.05");
    let mut rig = ready(build);
    let angle = |rig: &Rig| {
        rig.machine
            .spindle()
            .map_or(f64::NAN, |spindle| spindle.angle_deg)
    };
    let orient = |rig: &mut Rig| {
        let before = angle(rig);
        rig.event("key A press");
        rig.until(1.0, "the orientation", |rig| rig.bit("M2712"));
        rig.until(10.0, "its end", |rig| !rig.bit("M2712") && rig.bit("M2007"));
        rig.event("key A release");
        rig.seconds(0.2);
        angle(rig) - before
    };
    // The first orientation finds the mark; from then on the spindle stands at 120 and 0 degrees by turns.
    orient(&mut rig);
    for (m04, ways) in [(false, [240.0, 120.0]), (true, [-120.0, -240.0])] {
        rig.event(if m04 { "key B press" } else { "key B release" });
        rig.seconds(0.1);
        for expected in ways {
            let way = orient(&mut rig);
            assert!(
                (way - expected).abs() < 1.0,
                "M2656 = {m04}: {way}, not {expected}"
            );
        }
        rig.event("key C press");
        rig.seconds(3.0);
        // 40 rpm of 1500 rpm at 6 V.
        let volts = rig.control.snapshot().spindle.volts;
        let expected = if m04 { -0.16 } else { 0.16 };
        assert!((volts - expected).abs() < 0.001, "{volts}");
        rig.event("key C release");
        rig.seconds(2.0);
        // Back to where the next way begins: at 120 degrees.
        orient(&mut rig);
        if rig.number("D592") == 0 {
            orient(&mut rig);
        }
    }
}

/// Module 9171 orients to 30 degrees by the shorter way at 50 rpm; M2712 is 1 meanwhile [000:16120-16160].
/// With M2499 = 1 the loop opens as soon as the window is reached [000:5875].
#[test]
fn orientation_by_module() {
    let plc = format!(
        "{}
       L     I20
       AN    M0
       = M1
       L     I20
       = M0
       L     I21
       = M2499
       L     M1
       CMT   ORIENT
       EM
LBL ORIENT
       PS    K+300000
       PS    K+50000
       PS    K+0
       CM    9171
",
        with_gear()
    );
    for opens in [false, true] {
        let build = diagram(&plc).mp("3440.0=5").mp("3520.1=60").mp("3410.1=0.05");
        let mut rig = ready(build.program("1.H", "TOOL CALL 0 Z S1000"));
        run(&mut rig, 2.0);
        if opens {
            rig.event("key B press");
        }
        rig.event("key A press");
        assert_eq!(
            edges(&mut rig, "M2712 M2127 M2007", 5.0),
            "M2712+ M2127+ M2712- M2127- M2007+"
        );
        let angle = rig.machine.spindle().unwrap().angle_deg.rem_euclid(360.0);
        assert!((angle - 30.0).abs() < 1.0, "{angle}");
        assert!(rig.control.snapshot().spindle.volts.abs() < 0.01);
    }
}

/// Module 9042 on the running control, in 1/1000 degree: D100 actual angle, D104 nominal angle, D108 actual angle in
/// the reference system, D112 trailing error, D116 distance to go. The spindle is oriented to 30 degrees by module
/// 9171; with open loop the nominal angle is the actual one and nothing is to go.
#[test]
fn the_plc_reads_the_spindle() {
    let plc = format!(
        "{}
       PS    K+100
       CM    9042
       L     I20
       AN    M0
       = M1
       L     I20
       = M0
       L     M1
       CMT   ORIENT
       EM
LBL ORIENT
       PS    K+300000
       PS    K+5000
       PS    K+1
       CM    9171
",
        with_gear()
    );
    let build = diagram(&plc).mp("3440.0=5").mp("3520.1=60").mp("3410.1=0.05");
    let mut rig = ready(build.program("1.H", "TOOL CALL 0 Z S100\nM3"));
    run(&mut rig, 2.0);
    let values =
        |rig: &crate::support::Rig| [100, 104, 108, 112, 116].map(|at| rig.number(&format!("D{at}")));
    let turn = |thousandths: i32| thousandths.rem_euclid(360_000);
    rig.seconds(0.5);
    let open = values(&rig);
    assert_eq!([open[1], open[2], open[3], open[4]], [open[0], open[0], 0, 0]);
    // From one PLC cycle to the next, 20 ms that begin within a servo step of 0.6 ms.
    rig.seconds(0.02);
    let way = f64::from(turn(values(&rig)[0] - open[0])) / 1000.0;
    let rpm = rig.machine.spindle().unwrap().rpm;
    assert!((way - 6.0 * rpm * 0.02).abs() < 6.0 * rpm * 0.0006, "{way} {rpm}");
    rig.event("key A press");
    let mut left = Vec::new();
    rig.until(5.0, "the orientation", |rig| rig.bit("M2127"));
    while rig.bit("M2127") {
        rig.seconds(0.02);
        let [actual, nominal, _, lag, way] = values(&rig);
        if lag != 0 {
            // Rounded one by one.
            assert!(turn(nominal - actual - lag + 2) <= 4, "{actual} {nominal} {lag}");
            assert!(turn(nominal + way - 30_000 + 2) <= 4, "{nominal} {way}");
            left.push(way);
        }
    }
    assert!(left.len() > 3 && left.is_sorted_by(|a, b| a >= b), "{left:?}");
    assert!(left[0] > 1000, "{left:?}");
    rig.seconds(1.0);
    let [actual, nominal, reference, lag, way] = values(&rig);
    let angle = rig.machine.spindle().unwrap().angle_deg.rem_euclid(360.0);
    assert!(
        (f64::from(actual) / 1000.0 - angle).abs() < 0.1,
        "{actual} {angle}"
    );
    assert!((nominal - 30_000).abs() <= 1 && way == 0, "{nominal} {way}");
    assert!((nominal - actual - lag).abs() <= 1 && reference == actual);
}

/// A program that finds the spindle turning knows it, whoever has switched it on: Q110 is 1 with M4 by hand
/// [003:7614-7619].
#[test]
fn the_program_knows_how_the_spindle_turns() {
    for (m, q110) in [(3, 0.0), (4, 1.0), (5, -1.0)] {
        let build = diagram(&with_gear()).program("1.H", "FN 0: Q1 = +Q110\nL IX+1 R0 F6000");
        let mut rig = ready(build);
        rig.command("mode manual");
        rig.command(&format!("m {m}"));
        rig.start();
        rig.seconds(0.5);
        rig.command("mode full");
        run(&mut rig, 2.0);
        let q = rig.control.remember().q;
        let q1 = q
            .iter()
            .find(|(number, _)| *number == 1)
            .map_or(0.0, |(_, value)| *value);
        assert_eq!(q1, q110, "M{m}");
    }
}

/// M2004 is 1 while the voltage is not on a ramp, M2005 while it is 0 [000:5532-5536] [000:10538]: S3000 are
/// 8 V, at 0.01 V/ms 0.8 s.
#[test]
fn ramp_and_zero() {
    let build = diagram(&with_gear()).mp("3410.0=0.01").mp("3240.1=0");
    let mut rig = ready(build.program("1.H", "TOOL CALL 0 Z S3000\nM3\nSTOP\nM5"));
    rig.start();
    assert_eq!(
        edges(&mut rig, "M2485 M2005 M2004", 1.2),
        "M2485+ M2005- M2004- M2004+"
    );
    rig.start();
    assert_eq!(
        edges(&mut rig, "M2487 M2004 M2005", 1.2),
        "M2487+ M2004- M2004+ M2005+"
    );
}

/// MP31 and MP32 bit 5: amplitude and edges of the spindle's encoder [000:3310-3328]. The message stays, as that
/// of an axis.
#[test]
fn the_encoder_of_the_spindle_is_monitored() {
    for (mp, fault, letter) in [("31", "amplitude", 'A'), ("32", "edges", 'B')] {
        for (bits, found) in [("%000000", false), ("%100000", true)] {
            let build = diagram(&with_gear()).mp(&format!("{mp}={bits}"));
            let mut rig = ready(build.program("1.H", "TOOL CALL 0 Z S1000\nM3\nL X+100 R0 F100"));
            rig.start();
            rig.until(5.0, "X moves", |rig| nominal(rig, 'X') > 50.5);
            rig.event(&format!("fault encoder S {fault}"));
            rig.seconds(0.5);
            let expected = format!("MEASURING SYSTEM S DEFECTIVE {letter}");
            assert_eq!(
                rig.messages() == [expected.as_str()],
                found,
                "{:?}",
                rig.messages()
            );
            if found {
                rig.control.command("ce".parse().unwrap());
                assert_eq!(rig.messages()[0], expected);
                let before = display(&rig, 'X');
                rig.seconds(0.5);
                near(display(&rig, 'X'), before);
            }
        }
    }
}

/// MP7440 bit 2 = 1: the axes do not wait for an M function [000:7303], nor for the orientation that the PLC makes of it; the
/// program ends when the spindle stands at its angle. With bit 2 = 0 they wait.
#[test]
fn the_axes_run_on_while_the_spindle_is_oriented() {
    let program = "CYCL DEF 13.0 ORIENTATION\nCYCL DEF 13.1 ANGLE 45\nTOOL CALL 0 Z S1000\nL X+60 R0 F3000 M19\nL X+120";
    let farthest = |mp7440: &str| {
        let build = diagram(ORIENTATION)
            .mp("3440.0=5")
            .mp("3520.1=60")
            .mp("3410.1=0.05")
            .mp(mp7440);
        let mut rig = ready(build.program("1.H", program));
        rig.start();
        rig.until(5.0, "the orientation", |rig| rig.bit("M2127"));
        rig.until(9.0, "the angle", |rig| !rig.bit("M2127"));
        let farthest = nominal(&rig, 'X');
        rig.until(9.0, "the end", |rig| rig.control.snapshot().ended);
        near(display(&rig, 'X'), 120.0);
        assert_eq!(rig.messages(), [""; 0], "{mp7440}");
        let angle = rig.control.snapshot().spindle.angle_deg.unwrap();
        assert!((angle - 45.0).abs() < 1.0, "{angle}");
        farthest
    };
    near(farthest("7440=%00011"), 60.0);
    let moved = farthest("7440=%00111");
    assert!(moved > 65.0, "{moved}");
}

/// MP7440 speaks of M functions: for the gear range of a TOOL CALL the axes wait with bit 2 = 1, too, until the PLC has
/// acknowledged it [000:5645-5651] [000:7303].
#[test]
fn the_axes_wait_for_the_gear_range() {
    let plc = format!("{SPINDLE}       L     M2043\n       A     I20\n       = M2480\n");
    for mp7440 in ["7440=%00011", "7440=%00111"] {
        let build = diagram(&plc).mp(mp7440).mp("3030=0");
        let mut rig = ready(build.program("1.H", "L X+60 R0 F3000\nTOOL CALL 0 Z S3000\nL X+70"));
        rig.start();
        rig.until(3.0, "the gear strobe", |rig| rig.bit("M2043"));
        rig.seconds(1.0);
        near(display(&rig, 'X'), 60.0);
        rig.event("key A press");
        rig.until(3.0, "the end", |rig| rig.control.snapshot().ended);
        near(display(&rig, 'X'), 70.0);
        assert_eq!(rig.control.snapshot().spindle.gear, 2, "{mp7440}");
    }
}
