//! What the PLC moves: positioning of NC axes, PLC axes, free rotation [000:4005-4240] [000:6494-6517].

use crate::support::bench::*;
use crate::support::*;
use bahn_path::Axis;
use bahn_tnc::RunState;

/// X to 120 mm, Y to 20 mm, Z to 60 mm of the machine at 1500, 900, 600 mm/min: each by an input. M90 keeps
/// the PLC's wish until it was granted.
const TARGETS: &str = "
       L K+1200000
       = D528
       L K+1500
       = W560
       L K+200000
       = D532
       L K+900
       = W562
       L K+600000
       = D536
       L K+600
       = W564
       L I28
       AN M90
       S M2704
       L I29
       AN M91
       S M2705
       L I30
       AN M92
       S M2706
       LN I28
       R M2704
       L I28
       = M90
       L I29
       = M91
       L I30
       = M92
";

/// The strobe stays while the axis moves and is reset by the NC in position; the target counts from the
/// machine datum, whatever the workpiece datum is, and beyond the software limit [000:4013-4053].
#[test]
fn the_strobe_stays_until_the_position_is_reached() {
    let mut rig = bench(TARGETS).mps("910.0=110").ready();
    rig.command("datum X 1000");
    rig.input("I28", true);
    let edges = rig.edges(3.0, &["M2704", "M2008"]);
    assert_eq!(edges, ["M2704=1", "M2008=0", "M2704=0", "M2008=1"]);
    close(rig.table('X'), 120.0, 0.01);
    assert_eq!(rig.messages(), [""; 0]);
}

/// Several axes at once, each at its own feed; the feed override acts (inferred).
#[test]
fn several_axes_at_once() {
    let mut rig = bench(TARGETS).ready();
    for input in ["I28", "I29", "I30"] {
        rig.input(input, true);
    }
    rig.seconds(0.4);
    for (axis, speed) in [('X', 1500.0), ('Y', -900.0), ('Z', -600.0)] {
        close(rig.speed(axis), speed, 5.0);
    }
    rig.event("override feed 50");
    rig.seconds(0.3);
    close(rig.speed('Y'), -450.0, 5.0);
    rig.event("override feed 100");
    rig.seconds(10.0);
    for (axis, position) in [('X', 120.0), ('Y', 20.0), ('Z', 60.0)] {
        close(rig.table(axis), position, 0.01);
    }
    for strobe in ["M2704", "M2705", "M2706"] {
        assert!(!rig.bit(strobe));
    }
}

/// The PLC breaks off by resetting the strobe: the axis goes down its ramp [000:4013].
#[test]
fn the_plc_breaks_off() {
    let mut rig = bench(TARGETS).ready();
    rig.input("I28", true);
    rig.seconds(0.3);
    rig.input("I28", false);
    rig.seconds(0.5);
    close(rig.speed('X'), 0.0, 1.0);
    assert!(rig.table('X') < 115.0);
}

/// In Manual NC STOP ends it; it does not start while a direction key is pressed [000:4015-4021].
#[test]
fn interlocks_in_manual() {
    let mut rig = bench(TARGETS).ready();
    rig.input("I28", true);
    rig.seconds(0.3);
    rig.event("key NC_STOP tap");
    rig.seconds(0.5);
    assert!(!rig.bit("M2704"));
    close(rig.speed('X'), 0.0, 1.0);
    rig.event("key Z+ press");
    rig.seconds(0.1);
    rig.input("I29", true);
    rig.seconds(0.5);
    close(rig.speed('Y'), 0.0, 1.0);
    assert!(rig.bit("M2705"), "it waits");
    rig.event("key Z+ release");
    rig.seconds(0.5);
    close(rig.speed('Y'), -900.0, 5.0);
}

/// Not before the reference marks are passed [000:4572]: the strobe waits.
#[test]
fn positioning_needs_reference_marks() {
    let mut rig = bench(TARGETS).rig();
    rig.seconds(1.0);
    rig.command("mode manual");
    rig.input("I28", true);
    rig.seconds(1.0);
    close(rig.table('X'), 50.0, 0.01);
    assert!(rig.bit("M2704"));
}

/// A TNC 407 positions three axes at once [000:4011].
#[test]
fn three_axes_of_a_tnc_407() {
    let more = "       L K+300000\n       = D540\n       L K+1200\n       = W566\n       L I31\n       AN M93\n       S M2707\n       L I31\n       = M93\n";
    let mut build = bench(&format!("{TARGETS}{more}"))
        .with(&fourth('V', ""))
        .mps("10=15 50=15 410.3=4 960.3=-100 1340.0=1 1340.1=2 1340.2=3 1340.3=4 1820.3=1 1830.3=100");
    build.model = bahn_parameters::ControlModel::Tnc407;
    let mut rig = build.ready();
    for input in ["I28", "I29", "I30", "I31"] {
        rig.input(input, true);
    }
    rig.seconds(0.5);
    close(rig.speed('V'), 0.0, 1.0);
    rig.until(20.0, "the others are there", |rig| !rig.bit("M2704"));
    rig.seconds(0.5);
    assert!(rig.speed('V').abs() > 1000.0, "one has ended, the fourth begins");
}

/// Two uses of D528 in one PLC cycle: flashing 1R [000:631-633].
#[test]
fn two_uses_of_the_same_words() {
    for strobe in ["M2713", "M2716"] {
        let program =
            format!("{TARGETS}       L I30\n       AN M94\n       S {strobe}\n       L I30\n       = M94\n");
        let mut rig = bench(&program).ready();
        rig.input("I30", true);
        rig.seconds(0.1);
        assert_eq!(rig.messages(), ["ERROR IN PLC-PROGRAM 1R"]);
        assert!(rig.control.snapshot().messages[0].flashing);
    }
}

/// The manual's M70: Z to MP4210.2 at MP4220.2, then the M function is acknowledged [000:4055-4088].
const M70: &str = "
       L M2180
       S M2496        ; M functions decoded
       L M1970
       AN M4
       IFT
       L D776
       = D536
       L W964
       = W564
       ENDI
       L M1970
       AN M4
       S M2706
       S M4
       L M2045        ; all others are done at once
       AN M1970
       = M2482
       L M4
       AN M2706
       S M2482
       LN M2045
       R M4
";

#[test]
fn m70_positions_the_tool_axis() {
    let mut rig = bench(M70)
        .mps("4210.2=30.5 4220.2=1800")
        .program("1.H", "L X+120 Z+80 R0 F3000\nL M70\nL X+60\nL Z+40")
        .ready();
    assert_eq!((rig.number("D776"), rig.number("W964")), (305_000, 1800));
    rig.command("mode full");
    rig.command("select 1.H");
    rig.start();
    let edges = rig.edges(6.0, &["M1970", "M2045", "M2706", "M4", "M2482", "M2010"]);
    let expected = [
        "M2010=0", "M2010=1", // L X+120 Z+80
        "M1970=1", "M2045=1", "M2706=1", "M4=1", "M2010=0", "M2706=0", "M2482=1", "M2010=1", "M1970=0",
        "M2045=0", "M2482=0", "M4=0",
    ];
    let sorted = |edges: &[String]| {
        let mut edges: Vec<String> = edges.to_vec();
        edges.sort();
        edges
    };
    let head: Vec<String> = edges.iter().take(expected.len()).cloned().collect();
    assert_eq!(sorted(&head), sorted(&expected.map(str::to_owned)), "{edges:?}");
    let at = |edge: &str| edges.iter().position(|found| found == edge).unwrap();
    for pair in ["M2045=1", "M2706=1", "M2706=0", "M2482=1", "M2045=0", "M2482=0"].windows(2) {
        assert!(at(pair[0]) < at(pair[1]), "{pair:?} {edges:?}");
    }
    rig.until(30.0, "the end", |rig| rig.control.snapshot().ended);
    rig.settle();
    close(rig.table('X'), 60.0, 0.01);
    close(rig.table('Z'), 40.0, 0.01);
    assert_eq!(rig.messages(), [""; 0]);
}

/// While M70 positions: Z is at MP4210.2 whatever the datum, the run waits; the next block without Z leaves
/// it there.
#[test]
fn the_run_waits_for_the_positioning() {
    let mut rig = bench(M70)
        .mps("4210.2=30 4220.2=600")
        .program("1.H", "L X+20 R0 F3000\nL M70\nL X+5")
        .ready();
    rig.command("datum X 10");
    rig.command("datum Z 0");
    rig.command("mode full");
    rig.command("select 1.H");
    rig.start();
    rig.until(10.0, "Z moves", |rig| rig.speed('Z') < -500.0);
    assert_eq!(rig.control.snapshot().run, RunState::Running);
    close(rig.axis('X').actual, 20.0, 0.01);
    rig.until(60.0, "the end", |rig| rig.control.snapshot().ended);
    rig.settle();
    close(rig.table('Z'), 30.0, 0.01);
    close(rig.axis('X').actual, 5.0, 0.01);
}

/// The manual's tool chain, here on the 4th axis: at the first scan the reference run, with TOOL DEF (tool
/// number = pocket) the pocket (W262 - 1) · 360 / (pockets - 1) of 11 pockets [000:4118-4240].
const CHAIN: &str = "
       L M2180
       S M544
       L M544
       AN M2190
       A M2003
       CMT 40
       L M2047
       R M2484
       CMT 41
       PS K+3
       CM 9122
       PL B236
LBL 40
       PS K+3
       PS K+1800
       PS K+0
       CM 9123
       PL B237
       L B237
       == K+0
       R M544
       EM
LBL 41
       L B236
       BT K+2
       EMT
       L W262
       - K+1
       X K+360000
       = D168
       PS K+3
       PS D168
       PS K+3600
       PS K+0
       CM 9120
       PL B237
       L B237
       == K+0
       S M2484
       EM
";

fn chain(more: &str) -> Rig {
    chain_with(more, "")
}

fn chain_with(more: &str, mps: &str) -> Rig {
    let mut rig = bench(&CHAIN.replace("LBL 40", &format!("{more}\nLBL 40")))
        .with(TABLE)
        .mps("10=15 50=15 60=8 810.3=360 960.3=-90 1010.3=3600 1020.3=1200 1330.3=1800 7480.1=2")
        .mps(mps)
        .program("1.H", "TOOL DEF 4\nL X+60 R0 F3000\nTOOL DEF 11\nL X+50")
        .ready();
    rig.until(30.0, "the chain is referenced", |rig| rig.axis('C').referenced);
    rig.seconds(1.0);
    rig
}

#[test]
fn a_tool_chain_as_plc_axis() {
    let mut rig = chain("");
    assert_eq!(rig.messages(), [""; 0]);
    assert!(!rig.bit("M2139"), "no reference mark is missing");
    close(
        rig.machine_position('C').rem_euclid(360.0),
        rig.table('C').rem_euclid(360.0),
        0.01,
    );
    rig.command("mode full");
    rig.command("select 1.H");
    rig.start();
    rig.until(10.0, "it turns", |rig| rig.number("D168") == 1_080_000);
    assert_eq!(rig.number("W262"), 4);
    rig.until(60.0, "the end", |rig| rig.control.snapshot().ended);
    rig.seconds(8.0);
    // Pocket 11 stands at 360 degrees, which is 0.
    close((rig.table('C') + 180.0).rem_euclid(360.0) - 180.0, 0.0, 0.01);
    assert_eq!(rig.messages(), [""; 0]);
}

/// 9121 stops a PLC axis, 9122 says what it does, 9124 changes its speed [000:15907-16035].
#[test]
fn modules_of_a_plc_axis() {
    let more = "
       L I28
       AN M80
       CMT 50
       L I28
       = M80
       L I29
       CMT 51
       L I30
       CMT 52
LBL 50
       PS K+3
       PS K+3000000
       PS K+600
       PS K+0
       CM 9120
       PL B237
       EM
LBL 51
       PS K+3
       CM 9121
       PL B238
       EM
LBL 52
       PS K+3
       PS K+5000
       CM 9124
       PL B239
       EM
";
    let mut rig = chain(more);
    rig.input("I28", true);
    rig.seconds(0.5);
    let speed = rig.speed('C');
    close(speed.abs(), 600.0, 3.0);
    let bits = rig.number("B236");
    assert_eq!(bits & 0b111, 0b111, "PLC axis, referenced, positioning: {bits:b}");
    assert_eq!(bits >> 3 & 1, i32::from(speed < 0.0));
    rig.event("override feed 50");
    rig.seconds(0.3);
    close(rig.speed('C'), speed, 3.0);
    rig.input("I30", true);
    rig.seconds(0.3);
    close(rig.speed('C'), speed / 2.0, 3.0);
    rig.input("I29", true);
    rig.seconds(0.5);
    close(rig.speed('C'), 0.0, 0.5);
    assert_eq!(rig.number("B236") & 0b111, 0b011);
    // A direction key does nothing.
    rig.event("key IV+ press");
    rig.seconds(0.5);
    close(rig.speed('C'), 0.0, 0.5);
}

/// A PLC axis that does not follow: POSITIONING ERROR, and it comes to a standstill on its ramp, as the machine does
/// [000:5198]. Its order is over, module 9122 says why; CE cancels that, and so does a reference run [000:15979].
#[test]
fn a_plc_axis_with_a_positioning_error_stops() {
    let more = "
       L I28
       AN M80
       CMT 50
       L I28
       = M80
       L I29
       AN M81
       CMT 40
       L I29
       = M81
LBL 50
       PS K+3
       PS K+3000000
       PS K+1200
       PS K+0
       CM 9120
       PL B237
       EM
";
    for by_marks in [false, true] {
        // MP1140: a slow drive is not yet one that does not move as its voltage says.
        let mut rig = chain_with(more, "1140.3=9.9 1710.3=1");
        rig.input("I28", true);
        rig.until(5.0, "full speed", |rig| rig.speed('C').abs() > 1195.0);
        let shows = |rig: &Rig| !rig.messages().is_empty();
        rig.event("fault drive C slow");
        rig.until(1.0, "the message", shows);
        assert_eq!(rig.messages(), ["POSITIONING ERROR C"]);
        let commanded = |rig: &Rig| {
            let mut watch = rig.control.first().watch();
            watch.find(|axis| axis.axis == Axis::C).unwrap().commanded
        };
        let (mut before, mut last) = (commanded(&rig), f64::INFINITY);
        let (mut way, mut cycles) = (0.0, 0);
        while last > 0.0 {
            rig.cycle();
            let step = (commanded(&rig) - before).abs();
            assert!(step < last, "{step} after {last}, {:?}", rig.messages());
            (before, last, way, cycles) = (commanded(&rig), step, way + step, cycles + 1);
            assert!(cycles < 100);
        }
        // 20 degrees in a second, MP1060 = 1 m/s²; what the loop and the interpolation have already is 3 cycles at
        // most.
        let ramp = 20.0 * 20.0 / 2000.0;
        let cycle_s = f64::from(rig.control.cycle_us()) * 1e-6;
        assert!(
            (ramp..ramp + 3.0 * 20.0 * cycle_s).contains(&way),
            "{way}, ramp {ramp}"
        );
        rig.event("repair C");
        rig.seconds(0.3);
        assert_eq!(rig.number("B236") & 0b10111, 0b10011, "stands, with its error");
        assert_eq!(rig.messages(), ["POSITIONING ERROR C"]);
        if by_marks {
            rig.input("I29", true);
            rig.seconds(0.1);
            assert_eq!(rig.number("B236") & 0b10111, 0b00101, "it looks for its mark");
            rig.command("ce");
            rig.until(30.0, "the mark", |rig| rig.number("B236") & 0b10111 == 0b00011);
        } else {
            rig.command("ce");
            rig.seconds(0.1);
            assert_eq!(rig.number("B236") & 0b10111, 0b00011);
            rig.input("I28", false);
            rig.seconds(0.1);
            rig.input("I28", true);
            rig.seconds(10.0);
            close(rig.table('C').rem_euclid(360.0), 300.0, 0.01);
        }
        assert_eq!(rig.messages(), [""; 0]);
    }
}

/// Free rotation of the 4th axis: B518 and B519 with the strobe M2720; W566 times W754; B518 = 0 ends it
/// [000:6494-6517].
#[test]
fn free_rotation() {
    let program = "
       L K+1800
       = W566
       L W494
       = W754
       L I29
       IFT
       L K+8
       = B519
       ELSE
       L K+0
       = B519
       ENDI
       L I28
       IFT
       L K+8
       = B518
       ELSE
       L K+0
       = B518
       ENDI
       L I28
       XO M80
       S M2720
       L I28
       = M80
";
    let mut rig = bench(program)
        .with(TABLE)
        .mps("10=15 50=15 810.3=360 960.3=-90 1010.3=3600 1020.3=1200 1330.3=1800 1340.0=1 1340.1=2 1340.2=3 1340.3=4")
        .ready();
    rig.input("I29", true);
    rig.input("I28", true);
    rig.scan();
    rig.scan();
    assert!(!rig.bit("M2720"), "the NC took it");
    rig.seconds(15.0);
    close(rig.speed('C'), -1800.0, 5.0);
    rig.event("override feed 120");
    rig.seconds(0.5);
    close(rig.speed('C'), -2160.0, 5.0);
    rig.input("I28", false);
    rig.seconds(1.0);
    close(rig.speed('C'), 0.0, 1.0);
    assert_eq!(rig.messages(), [""; 0]);
    // The display runs from 0 to 360, and a program goes on within the turn.
    let shown = rig.axis('C').actual;
    close(shown, rig.table('C').rem_euclid(360.0), 0.01);
    rig.command("mode mdi");
    rig.command(&format!("mdi L C{:+.3} R0 F3600", shown - 1.0));
    let before = rig.table('C');
    rig.start();
    rig.seconds(2.0);
    close(rig.table('C') - before, -1.0, 0.01);
}

/// EMERGENCY STOP ends the rotation and what a PLC axis does; they do not go on by themselves.
#[test]
fn emergency_stop_ends_what_the_plc_moves() {
    let more = "
       L I28
       AN M80
       CMT 50
       L I28
       = M80
LBL 50
       PS K+3
       PS K+3000000
       PS K+600
       PS K+0
       CM 9120
       PL B237
       EM
";
    let mut rig = chain(more);
    rig.input("I28", true);
    rig.seconds(1.0);
    assert!(rig.speed('C').abs() > 500.0);
    rig.event("emergency press");
    rig.seconds(0.5);
    rig.event("emergency release");
    rig.seconds(0.2);
    rig.command("ce");
    rig.seconds(0.1);
    let stands = rig.table('C');
    rig.seconds(1.0);
    close(rig.table('C'), stands, 0.01);
    assert_eq!(rig.number("B236") & 0b111, 0b011, "not positioning");
    assert_eq!(rig.messages(), [""; 0]);
}

/// Bit 1 of module 9122 tells of an NC axis, too, whether it has passed its reference mark: off at power-on, on after
/// the reference run [000:15938-15963].
#[test]
fn module_9122_tells_the_reference_of_nc_axes() {
    let read = "
       PS K+0
       CM 9122
       PL B236
";
    let mut rig = bench(read).rig();
    rig.until(5.0, "the reference run is asked for", |rig| {
        rig.control.snapshot().mode == bahn_tnc::Mode::Reference
    });
    rig.scan();
    assert_eq!(rig.number("B236"), 0);
    rig.start();
    rig.until(60.0, "the mark of X", |rig| rig.axis('X').referenced);
    rig.scan();
    assert_eq!(rig.number("B236"), 0b10);
}
