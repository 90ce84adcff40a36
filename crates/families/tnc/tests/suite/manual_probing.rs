//! The functions of the TOUCH PROBE menu in MANUAL and HANDWHEEL [003:1217-1512].

use crate::stand::*;
use crate::support::*;
use bahn_path::Axis;
use bahn_tnc::{Calibration, RunState};

/// PLC: probing is enabled as soon as the spindle stands in its position; M2499 lets the control orient it.
/// Keys A to D move X and Y.
const ENABLE: &str = "
       L     M2503
       R     M2503
       L     I20
       = M2456
       =N M2472
       L     I21
       = M2457
       =N M2473
       L     I22
       = M2458
       =N M2474
       L     I23
       = M2459
       =N M2475
";

/// The solid of the bench: machine X 80 to 120, Y 0 to 100, Z -50 to 0. The probe is 100 long, its ball has 2 mm.
fn rig(parameters: &[&str]) -> Rig {
    let mut build = bench(&format!("{ACKNOWLEDGE}{ENABLE}"));
    for parameter in ["6120=100", "6130=60", "6150=3000"].iter().chain(parameters) {
        build = build.mp(parameter);
    }
    let mut rig = build.program("1.H", PROGRAM).rig();
    rig.power_on();
    rig.seconds(0.3);
    rig.event("probe insert");
    rig
}

/// Goes to the right and up in the turned system of coordinates.
const PROGRAM: &str = "TOOL CALL 1 Z\nL X+10 Y+0 R0 F3000\nL X+10 Y+20";

fn value(rig: &Rig, signal: &str) -> f64 {
    rig.control.first().observe(&signal.parse().unwrap())
}

/// Positions the axes of the machine with a block of MDI, machine coordinates.
fn go(rig: &mut Rig, block: &str) {
    rig.command("mode mdi");
    rig.command(&format!("mdi {block} R0 F3000 M91"));
    rig.start();
    rig.until(1.0, "the block begins", |rig| {
        rig.control.snapshot().run == RunState::Running
    });
    rig.until(60.0, "the position", |rig| {
        rig.control.snapshot().run == RunState::Idle
    });
    rig.seconds(0.3);
    rig.command("mode manual");
}

/// NC start, until so many touches are there and the axes stand where they started.
fn probe(rig: &mut Rig, touches: f64) {
    rig.start();
    rig.until(60.0, "the touch", |rig| value(rig, "probe.touches") == touches);
    rig.until(10.0, "the end", |rig| rig.bit("M2026"));
    rig.seconds(0.3);
}

/// The upper face of the solid is machine Z 0, 40 mm above the datum of the table: the tip of the probe, 100 mm long,
/// touches it with the spindle at Z 100.
#[test]
fn the_effective_length_is_calibrated() {
    let mut rig = rig(&[]);
    go(&mut rig, "L Z+130");
    go(&mut rig, "L X+100 Y+50");
    rig.command("datum Z 170");
    rig.command("probe length 40");
    probe(&mut rig, 1.0);
    within(value(&rig, "probe.length"), 100.0, 0.002);
    near(rig.machine_position('Z'), 130.0);
    assert_eq!(rig.messages(), [""; 0]);
    // It survives power-off.
    let memory = rig.control.remember().probe;
    within(memory.calibration.unwrap().length_mm, 100.0, 0.002);
    // SURFACE = DATUM counts with it: the face at machine Z 0 becomes +5.
    rig.command("probe surface");
    rig.command("probe direction Z-");
    probe(&mut rig, 1.0);
    within(value(&rig, "Z.probed"), 40.0, 0.002);
    rig.command("probe datum Z 5");
    within(value(&rig, "Z.probed"), 5.0, 1e-9);
    within(rig.control.remember().datums[0].0[Axis::Z], -5.0, 0.002);
}

/// M3 and M5 switch the spindle, which is controlled.
const SPINDLE: &str = "
       L     M1903
       S     M2485
       R     M2487
       L     M1905
       S     M2487
       R     M2485
       L     M2719
       S     M2496
";

/// A bench with solids of its own and a probe that is calibrated: 100 mm long, ball radius 2 mm.
fn bench_on(solids: &str, offset_mm: [f64; 2]) -> Build {
    let mut build = bench(&format!("{ACKNOWLEDGE}{ENABLE}"))
        .plant(
            "[[probe.solid]]\nmin = [80, 0, -50]\nmax = [120, 100, 0]\n",
            solids,
        )
        .program("1.H", PROGRAM);
    for parameter in ["6120=100", "6130=60", "6150=3000"] {
        build = build.mp(parameter);
    }
    build.remembered.probe.calibration = Some(Calibration {
        length_mm: 100.0,
        radius_mm: 2.0,
        offset_mm,
    });
    build
}

/// Power on with the probe inserted, tip at machine Z -20.
fn on(build: Build) -> Rig {
    let mut rig = build.rig();
    rig.power_on();
    rig.seconds(0.3);
    rig.event("probe insert");
    go(&mut rig, "L Z+80");
    rig
}

const BLOCK: &str = "[[probe.solid]]\nmin = [80, 0, -50]\nmax = [120, 100, 0]\n";

/// Sides: the ball touches 2 mm before the face at machine X 80, whose coordinate becomes -7.
#[test]
fn the_datum_is_set_on_a_side() {
    let mut rig = on(bench_on(BLOCK, [0.0; 2]));
    let before = rig.machine_position('X');
    rig.command("datum X 50");
    rig.command("probe surface");
    assert!(value(&rig, "X.probed").is_nan(), "nothing is probed yet");
    // Without a direction there is nothing to probe.
    rig.start();
    rig.seconds(0.2);
    assert_eq!(rig.messages(), ["KEY NON-FUNCTIONAL"]);
    rig.command("ce");
    rig.seconds(0.5);
    rig.command("probe direction X+");
    probe(&mut rig, 1.0);
    near(rig.machine_position('X'), before);
    // X 50 is where the axis stands; the face is at machine X 80.
    near(value(&rig, "X.probed"), 50.0 + 80.0 - before);
    rig.command("probe datum X -7");
    near(display(&rig, 'X'), before - 80.0 - 7.0);
    // No other axis was probed.
    assert!(!rig.control.command("probe datum Y 0".parse().unwrap()));
}

/// The 4th axis V is the slave of X: it goes along while X probes, and the way that finds nothing ends as without it.
#[test]
fn a_slave_goes_along() {
    let slave = [
        "10=%01111",
        "50=%01111",
        "410.3=4",
        "850.3=1",
        "855.3=0.5",
        "860.3=0",
        "1010.3=15000",
    ];
    let with_slave = |build: Build| {
        let plant = "[axis.V]\noutput = \"4\"\nspeed = 15000\nvolts = 9\nstart = 50\n\
                     [axis.V.encoder]\ninput = \"X4\"\nperiod_um = 20\nmark = 52\n[spindle]";
        slave.into_iter().fold(build.plant("[spindle]", plant), Build::mp)
    };
    let mut rig = on(with_slave(bench_on(BLOCK, [0.0; 2])));
    rig.command("probe surface");
    rig.command("probe direction X+");
    probe(&mut rig, 1.0);
    let face = value(&rig, "X.probed") - value(&rig, "X.displayed") + rig.machine_position('X');
    within(face, 80.0, 0.01);
    assert_eq!(rig.messages(), [""; 0]);
    rig.command("probe direction X-");
    rig.start();
    rig.until(60.0, "the message", |rig| !rig.messages().is_empty());
    assert_eq!(rig.messages(), ["TOUCH POINT INACCESSIBLE"]);
    within(rig.machine_position('V'), rig.machine_position('X'), 0.01);
}

/// Nothing there within MP6130; the stylus touches from the beginning; the probe is not ready; its battery is low.
#[test]
fn what_cannot_be_probed_says_why() {
    let mut rig = on(bench_on(BLOCK, [0.0; 2]));
    rig.command("probe surface");
    rig.command("probe direction Y+");
    rig.start();
    rig.until(60.0, "the message", |rig| !rig.messages().is_empty());
    assert_eq!(rig.messages(), ["TOUCH POINT INACCESSIBLE"]);
    rig.command("ce");
    rig.event("fault probe not-ready");
    rig.start();
    rig.seconds(0.3);
    assert_eq!(rig.messages(), ["PROBE SYSTEM NOT READY"]);
    rig.command("ce");
    rig.event("repair probe");
    rig.event("fault probe battery");
    rig.command("probe direction Y-");
    rig.start();
    rig.seconds(0.3);
    assert_eq!(rig.messages(), ["EXCHANGE TOUCH PROBE BATTERY"]);
    // NC stop ends the movement; the axis stands where it is.
    rig.event("key NC_STOP tap");
    rig.seconds(0.5);
    let at = rig.machine_position('Y');
    rig.seconds(0.5);
    near(rig.machine_position('Y'), at);
    rig.command("ce");
    rig.event("repair probe");
    go(&mut rig, "L Y+50");
    go(&mut rig, "L X+79");
    rig.command("probe surface");
    rig.command("probe direction X+");
    rig.start();
    rig.seconds(0.3);
    assert_eq!(rig.messages(), ["STYLUS ALREADY IN CONTACT"]);
}

/// A side that lies at 5° turns the program by 5°: X 10 Y 0 and X 10 Y 20 about the datum at machine X 40 Y 40.
#[test]
fn a_basic_rotation_turns_the_program() {
    let turned = "[[probe.solid]]\nmin = [60, 70, -50]\nmax = [160, 130, 0]\nangle = 5\n";
    let mut rig = on(bench_on(turned, [0.0; 2]));
    go(&mut rig, "L X+70");
    rig.command("probe rotation");
    rig.command("probe direction Y+");
    probe(&mut rig, 1.0);
    by_key(&mut rig, "A", 'X', 110.0);
    probe(&mut rig, 0.0);
    within(value(&rig, "probe.angle"), 5.0, 0.005);
    assert_eq!(rig.messages(), [""; 0]);
    // The same side again, without setting ROTATION ANGLE to 0: the angle between both is 0.
    probe(&mut rig, 1.0);
    by_key(&mut rig, "B", 'X', 70.0);
    probe(&mut rig, 0.0);
    within(value(&rig, "probe.angle"), 0.0, 0.005);
    // The angle that was noted is entered again.
    rig.command("probe angle 5");
    rig.command("probe end");
    for axis in ['X', 'Y'] {
        let at = rig.machine_position(axis);
        rig.command(&format!("datum {axis} {}", at - 40.0));
    }
    rig.command("mode full");
    rig.command("select 1.H");
    run(&mut rig, 60.0);
    let (sin, cos) = 5f64.to_radians().sin_cos();
    near(rig.machine_position('X'), 40.0 + 10.0 * cos - 20.0 * sin);
    near(rig.machine_position('Y'), 40.0 + 10.0 * sin + 20.0 * cos);
    assert_eq!(rig.control.remember().probe.basic_rotation_deg, 5.0);
    // Another tool axis has another working plane.
    rig.command("mode mdi");
    rig.command("mdi TOOL CALL 1 Y");
    rig.start();
    rig.seconds(0.5);
    assert!(
        rig.messages()[0].starts_with("PLANE WRONGLY DEFINED"),
        "{:?}",
        rig.messages()
    );
}

/// Two points that are one give no direction.
#[test]
fn points_too_near_are_an_arithmetical_error() {
    let mut rig = on(bench_on(BLOCK, [0.0; 2]));
    rig.command("probe rotation");
    rig.command("probe direction X+");
    probe(&mut rig, 1.0);
    probe(&mut rig, 0.0);
    assert_eq!(rig.messages(), ["ARITHMETICAL ERROR"]);
    assert_eq!(rig.control.remember().probe.basic_rotation_deg, 0.0);
}

/// The corner at machine X 80 Y 70 of a block that is turned by 5° about it: two touches of the side along X, in the
/// basic rotation, two of the side along Y. It becomes X 0 Y 10.
#[test]
fn the_datum_is_set_in_a_corner() {
    let turned = "[[probe.solid]]\nmin = [80, 70, -50]\nmax = [160, 130, 0]\nangle = 5\n";
    let mut rig = on(bench_on(turned, [0.0; 2]));
    // Nothing to take over yet.
    assert!(!rig.control.command("probe corner reuse".parse().unwrap()));
    rig.command("ce");
    go(&mut rig, "L X+90");
    rig.command("probe rotation");
    rig.command("probe direction Y+");
    probe(&mut rig, 1.0);
    by_key(&mut rig, "A", 'X', 130.0);
    probe(&mut rig, 0.0);
    go(&mut rig, "L X+60");
    go(&mut rig, "L Y+80");
    rig.command("probe corner reuse");
    rig.command("probe direction X+");
    probe(&mut rig, 3.0);
    by_key(&mut rig, "C", 'Y', 110.0);
    probe(&mut rig, 4.0);
    assert_eq!(rig.messages(), [""; 0]);
    let datum = rig.control.remember().datums[0].0;
    near(value(&rig, "X.probed"), 80.0 - datum[Axis::X]);
    near(value(&rig, "Y.probed"), 70.0 - datum[Axis::Y]);
    rig.command("probe datum X 0");
    rig.command("probe datum Y 10");
    near(rig.control.remember().datums[0].0[Axis::X], 80.0);
    near(rig.control.remember().datums[0].0[Axis::Y], 60.0);
}

const RING: &str = "[[probe.ring]]\ncentre = [90, 60]\nradii = [25, 40]\nz = [-50, 0]\n";

/// From within, a little beside its centre, the ring is probed in all four directions by one NC start.
#[test]
fn the_datum_is_set_at_the_centre_of_a_bore() {
    let mut rig = on(bench_on(RING, [0.0; 2]));
    go(&mut rig, "L Z+130");
    go(&mut rig, "L X+93");
    go(&mut rig, "L Y+58");
    go(&mut rig, "L Z+80");
    rig.command("probe circle");
    probe(&mut rig, 4.0);
    within(value(&rig, "probe.circle"), 25.0, 0.005);
    rig.command("probe datum X 8");
    rig.command("probe datum Y 10");
    near(rig.control.remember().datums[0].0[Axis::X], 82.0);
    near(rig.control.remember().datums[0].0[Axis::Y], 50.0);
}

/// A stud is probed from outside, direction by direction.
#[test]
fn the_datum_is_set_at_the_centre_of_a_stud() {
    let stud = "[[probe.ring]]\ncentre = [90, 60]\nradii = [0, 20]\nz = [-50, 0]\n";
    let mut rig = on(bench_on(stud, [0.0; 2]));
    go(&mut rig, "L Y+55");
    rig.command("probe circle");
    rig.command("probe direction X+");
    probe(&mut rig, 1.0);
    by_key(&mut rig, "C", 'Y', 65.0);
    probe(&mut rig, 2.0);
    by_key(&mut rig, "C", 'Y', 90.0);
    by_key(&mut rig, "A", 'X', 85.0);
    rig.command("probe direction Y-");
    probe(&mut rig, 3.0);
    by_key(&mut rig, "A", 'X', 95.0);
    probe(&mut rig, 4.0);
    within(value(&rig, "probe.circle"), 20.0, 0.01);
    let datum = rig.control.remember().datums[0].0;
    near(value(&rig, "X.probed"), 90.0 - datum[Axis::X]);
    near(value(&rig, "Y.probed"), 60.0 - datum[Axis::Y]);
}

/// A probe whose ball stands 0.3 and -0.2 mm beside the spindle, near the middle of the ring of 25 mm; the spindle knows its
/// angle.
fn in_the_ring(parameters: &[&str]) -> Rig {
    in_the_ring_after(true, parameters)
}

/// The same, with a spindle that has turned since power-on, or has not.
fn in_the_ring_after(turned: bool, parameters: &[&str]) -> Rig {
    let mut build = bench_on(RING, [0.0; 2]).plant("radius = 2\n", "radius = 2\noffset = [0.3, -0.2]\n");
    let spindle = [
        "3510.0=1500",
        "3210.0=6",
        "3515.0=1875",
        "3440.0=5",
        "3520.1=60",
        "3410.1=0.05",
    ];
    for parameter in spindle.iter().chain(parameters) {
        build = build.mp(parameter);
    }
    build.plc = build.plc.replacen(
        "       L     M2503\n",
        &format!("{SPINDLE}       L     M2503\n"),
        1,
    );
    let mut rig = on(build);
    go(&mut rig, "L Z+130");
    go(&mut rig, "L X+91");
    go(&mut rig, "L Y+60.5");
    go(&mut rig, "L Z+80");
    if turned {
        // The spindle finds its reference mark.
        for (m, seconds) in [(3, 2.0), (5, 2.0)] {
            rig.command("s 500");
            rig.command(&format!("m {m}"));
            rig.start();
            rig.seconds(seconds);
        }
    }
    rig.event("probe remove");
    rig.event("probe insert");
    rig
}

/// MP6321 = 0: a measuring probe is turned by itself when the ring is probed, probes it again with no other start, and is
/// turned back; with 1 its radius alone is calibrated, and the spindle stays as it is [000:7654]. Without MP6160 it is not
/// turned either.
#[test]
fn a_measuring_probe_finds_its_centre_offset_by_itself() {
    let tm110 = [
        "6200=1",
        "6310=0.5",
        "6330=2",
        "6350=250",
        "6360=250",
        "6361=3000",
    ];
    let cases = [
        (["6321=0", "6160=-1"], true),
        (["6321=1", "6160=-1"], false),
        (["6321=0", "6160=0"], false),
    ];
    for (parameters, turns) in cases {
        let all: Vec<&str> = tm110.into_iter().chain(parameters).collect();
        let mut rig = in_the_ring(&all);
        let before = value(&rig, "S.angle");
        rig.command("probe radius 25");
        rig.start();
        let turned = |rig: &Rig| (value(rig, "S.angle") - before + 180.0).rem_euclid(360.0) - 180.0;
        let mut farthest = 0.0_f64;
        for _ in 0..1000 {
            rig.seconds(0.1);
            farthest = farthest.max(turned(&rig).abs());
        }
        assert_eq!(rig.messages(), [""; 0]);
        let calibration = rig.control.remember().probe.calibration.unwrap();
        let (x, y, angle) = if turns {
            (0.3, -0.2, 180.0)
        } else {
            (0.0, 0.0, 0.0)
        };
        within(calibration.radius_mm, 2.0, 0.01);
        within(calibration.offset_mm[0], x, 0.01);
        within(calibration.offset_mm[1], y, 0.01);
        within(value(&rig, "probe.touches"), 4.0, 0.0);
        within(farthest, angle, 0.5);
        within(turned(&rig), 0.0, 0.5);
    }
}

/// In the ring of 25 mm the ball is found to have 2 mm, and with the probe turned by 180° to stand 0.3 and -0.2 mm
/// beside the spindle; afterwards it stands as before. Without MP6160 it is not turned. The spindle need not have turned
/// before: a turn of 180° has no use for the reference mark.
#[test]
fn radius_and_centre_offset_are_calibrated() {
    for (parameter, has_turned) in [("6160=-1", true), ("6160=-1", false), ("6160=0", true)] {
        let mut rig = in_the_ring_after(has_turned, &[parameter]);
        rig.command("probe radius 25");
        probe(&mut rig, 4.0);
        let calibration = |rig: &Rig| rig.control.remember().probe.calibration.unwrap();
        within(calibration(&rig).radius_mm, 2.0, 0.003);
        let before = value(&rig, "S.angle");
        let turned = rig.control.command("probe turn".parse().unwrap());
        assert_eq!(turned, parameter == "6160=-1", "{parameter}");
        if !turned {
            continue;
        }
        rig.seconds(3.0);
        within((value(&rig, "S.angle") - before).rem_euclid(360.0), 180.0, 0.2);
        probe(&mut rig, 4.0);
        rig.seconds(3.0);
        let [x, y] = calibration(&rig).offset_mm;
        within(x, 0.3, 0.004);
        within(y, -0.2, 0.004);
        within(calibration(&rig).radius_mm, 2.0, 0.003);
        assert_eq!(rig.messages(), [""; 0]);
        // Circle centre with the offset: as the ring stands.
        rig.command("probe circle");
        probe(&mut rig, 4.0);
        let datum = rig.control.remember().datums[0].0;
        within(value(&rig, "X.probed"), 90.0 - datum[Axis::X], 0.01);
        within(value(&rig, "Y.probed"), 60.0 - datum[Axis::Y], 0.01);
    }
}

/// TCH PROBE 0 measures with what was calibrated, also the offset; a rotation that is left in force bars the menu.
#[test]
fn programs_measure_with_the_calibrated_probe() {
    let build = bench_on(BLOCK, [0.3, 0.0])
        .plant("radius = 2\n", "radius = 2\noffset = [0.3, 0]\n")
        .mp("6140=5")
        .mp("7300=0")
        .program(
            "2.H",
            "TOOL CALL 0 Z\nTCH PROBE 0.0 REF. PLANE Q5 X+\nTCH PROBE 0.1 X+80 Y+50 Z-20\nL X+50 R0 F6000\n\
             CYCL DEF 10.0 ROTATION\nCYCL DEF 10.1 ROT +5",
        );
    let mut rig = on(build);
    rig.datum_at_machine(100.0);
    rig.command("mode full");
    rig.command("select 2.H");
    run(&mut rig, 60.0);
    within(value(&rig, "Q5"), 80.0, 0.004);
    rig.seconds(0.1);
    rig.command("mode manual");
    rig.command("probe surface");
    assert_eq!(rig.messages(), ["ROTATION NOT PERMITTED"]);
}

/// Moves an axis by its key beyond a machine position; the function stays chosen.
fn by_key(rig: &mut Rig, key: &str, axis: char, to: f64) {
    let up = rig.machine_position(axis) < to;
    rig.event(&format!("key {key} press"));
    rig.until(60.0, "the position", |rig| {
        let at = rig.machine_position(axis);
        if up { at >= to } else { at <= to }
    });
    rig.event(&format!("key {key} release"));
    rig.seconds(0.5);
}

fn within(actual: f64, expected: f64, window: f64) {
    assert!((actual - expected).abs() <= window, "{actual} is not {expected}");
}
