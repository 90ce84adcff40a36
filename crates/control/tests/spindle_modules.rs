//! Modules of the PLC that turn the spindle and tell where it is: 9171 and 9042 [000:14978-15021] [000:16120-16160].

#[path = "support/gears.rs"]
mod gears;
#[path = "support/stand.rs"]
mod stand;
mod support;

use gears::*;
use stand::*;
use support::Rig;

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

/// Module 9171 with the directions of its table: key B is M04, key C M03, none the shortest path; the angle goes to and
/// fro between 90 degrees and the one of key A's last press.
fn module_by_key() -> String {
    format!(
        "{}
       L     I20
       AN    M0
       = M1
       L     I20
       = M0
       L     K+0
       = W210
       L     I21
       IFT
         L     K-1
         = W210
       ENDI
       L     I22
       IFT
         L     K+1
         = W210
       ENDI
       L     M1
       CMT   TO_AND_FRO
       EM
LBL TO_AND_FRO
       L     K+900000
       -     D204
       = D204
       PS    D204
       PS    K+0
       PS    W210
       CM    9171
       L     M3171
       = M10
",
        with_gear()
    )
}

/// A spindle that stands in position turns to the next one in the direction that is asked for: 0 to 90 degrees and back by
/// the shortest path, with M03 and with M04 [000:16130-16152]. Whatever holds it there, a load in its loop
/// of either sense: the voltage of the loop is no turning. Also when M05 comes in the scan of the call.
#[test]
fn from_one_position_the_spindle_turns_as_the_module_says() {
    for m05 in [false, true] {
        let plc = match m05 {
            false => module_by_key(),
            true => module_by_key().replace(
                "LBL TO_AND_FRO\n",
                "LBL TO_AND_FRO\n       L     M2719\n       S     M2487\n       R     M2485\n       R     M2486\n",
            ),
        };
        let build = diagram(&plc).mps("3440.0=5 3520.1=60 3410.1=0.05");
        let mut rig = ready(build.program("1.H", "TOOL CALL 0 Z S100\nM3\nM5"));
        run(&mut rig, 5.0);
        let angle = |rig: &Rig| rig.machine.spindle().unwrap().angle_deg;
        let orient = |rig: &mut Rig| {
            let before = angle(rig);
            rig.event("key A press");
            rig.until(1.0, "the orientation", |rig| rig.bit("M2712"));
            rig.until(10.0, "its end", |rig| !rig.bit("M2712") && rig.bit("M2007"));
            rig.event("key A release");
            // As soon as it is in its window the next one may come.
            rig.seconds(0.04);
            angle(rig) - before
        };
        // To 90 degrees, in whatever way, and to 0.
        orient(&mut rig);
        orient(&mut rig);
        for (key, ways) in [("", [90.0, -90.0]), ("C", [90.0, 270.0]), ("B", [-270.0, -90.0])] {
            for event in ["press", "release"] {
                if !key.is_empty() {
                    rig.event(&format!("key {key} {event}"));
                }
                if event == "release" {
                    continue;
                }
                rig.seconds(0.05);
                for expected in ways.into_iter().chain(ways) {
                    let way = orient(&mut rig);
                    assert!(
                        (way - expected).abs() < 2.0,
                        "key {key}, M05 {m05}: {way}, not {expected}"
                    );
                }
            }
        }
    }
}

/// A spindle that is not controlled, MP3010 = 3 to 5, is not oriented: module 9171 says so, and M2712 does not stay
/// [000:5444-5472].
#[test]
fn a_spindle_without_position_control_is_not_oriented() {
    for (mp3010, refused) in [("3010=3", true), ("3010=5", true), ("3010=6", false)] {
        let mut rig = ready(diagram(&module_by_key()).mp(mp3010).mp("3440.0=5"));
        rig.event("key A press");
        rig.seconds(0.1);
        assert_eq!(
            (rig.bit("M10"), rig.bit("M2712")),
            (refused, !refused),
            "{mp3010}"
        );
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
    let values = |rig: &support::Rig| [100, 104, 108, 112, 116].map(|at| rig.number(&format!("D{at}")));
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
