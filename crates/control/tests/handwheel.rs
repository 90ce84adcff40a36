//! ELECTRONIC HANDWHEEL: interpolation factors, threshold, jog increment [000:8060-8170] [000:8494-8556].

mod support;

use bahn_control::HANDWHEEL_STEPS;
use support::bench::*;
use support::*;

/// The bench in the mode, with rapid traverse 12 000 so that all factors are there.
fn wheel(instructions: &str) -> Rig {
    let mut rig = bench(instructions)
        .plant("speed = 6000", "speed = 12000")
        .mps("1710.0=8 1720.0=10 7640=2 7650=1 7660=0 7670.0=0 1010.0=12000 1010.1=12000 1010.2=12000")
        .ready();
    rig.command("mode handwheel");
    rig.scan();
    rig
}

/// Turns the wheel and says how far the axis went.
fn turn(rig: &mut Rig, axis: char, steps: f64) -> f64 {
    let from = rig.table(axis);
    rig.event(&format!("handwheel {steps}"));
    rig.seconds(2.0);
    rig.table(axis) - from
}

/// A turn is 20 mm / 2^factor [003:1051-1062].
#[test]
fn factors() {
    let mut rig = wheel("");
    for factor in [0, 1, 2, 5, 10] {
        rig.command(&format!("handwheel X {factor}"));
        let travel = 20.0 / f64::from(1 << factor);
        close(turn(&mut rig, 'X', HANDWHEEL_STEPS), travel, 0.005);
        close(turn(&mut rig, 'X', -HANDWHEEL_STEPS), -travel, 0.005);
    }
    assert!(
        !rig.bit("M2008"),
        "no axis is in position in Handwheel [000:5371-5384]"
    );
    assert_eq!(rig.number("W272"), 2);
}

/// The least factor is that of the slowest axis' rapid traverse, here 6000: factor 1; MP7670 may raise it
/// [000:8075-8094].
#[test]
fn least_factor() {
    for (mp7670, travel) in [(0, 10.0), (3, 2.5)] {
        let mut rig = bench("")
            .mps("7640=2 7650=1 7660=0")
            .mp(&format!("7670.0={mp7670}"))
            .ready();
        rig.command("mode handwheel");
        rig.command("handwheel X 0");
        rig.scan();
        close(turn(&mut rig, 'X', HANDWHEEL_STEPS), travel, 0.005);
    }
}

/// MP7650 = 0: turning right moves negative; MP7660: fewer steps are a vibration; M2826 suppresses
/// [000:8108-8125].
#[test]
fn direction_threshold_and_suppression() {
    let mut rig = bench("       L I30\n       = M2826\n")
        .plant("speed = 6000", "speed = 12000")
        .mps("7640=2 7650=0 7660=10 7670.0=0 1010.0=12000 1010.1=12000 1010.2=12000")
        .ready();
    rig.command("mode handwheel");
    rig.command("handwheel Y 1");
    rig.scan();
    close(turn(&mut rig, 'Y', HANDWHEEL_STEPS), -10.0, 0.005);
    close(turn(&mut rig, 'Y', 9.0), 0.0, 0.001);
    close(turn(&mut rig, 'Y', -9.0), 0.0, 0.001);
    rig.input("I30", true);
    rig.seconds(0.1);
    close(turn(&mut rig, 'Y', HANDWHEEL_STEPS), 0.0, 0.001);
    rig.input("I30", false);
    rig.seconds(0.1);
    close(rig.speed('Y'), 0.0, 1.0);
    close(turn(&mut rig, 'Y', 100.0), -1.0, 0.005);
}

/// Another axis is chosen while the first one still follows: it stops, and the other one does not run off.
#[test]
fn the_axis_changes_while_one_runs() {
    let mut rig = wheel("");
    rig.command("handwheel X 0");
    rig.event("handwheel 3000");
    rig.seconds(0.1);
    let y = rig.table('Y');
    rig.command("handwheel Y 0");
    rig.settle();
    close(rig.speed('X'), 0.0, 1.0);
    close(rig.table('Y'), y, 0.005);
}

/// The wheel leads up to the software limit and no farther.
#[test]
fn the_wheel_stops_at_the_limit() {
    let mut rig = wheel("");
    rig.command("handwheel X 0");
    turn(&mut rig, 'X', 5.0 * HANDWHEEL_STEPS);
    close(rig.table('X'), 170.0, 0.005);
    assert_eq!(rig.messages(), ["LIMIT SWITCH X+"]);
    assert!(rig.bit("M2624"));
    close(turn(&mut rig, 'X', -HANDWHEEL_STEPS), -20.0, 0.005);
    assert_eq!(rig.messages(), [""; 0]);
    assert!(!rig.bit("M2624"));
}

/// What is turned without feed enable is lost.
#[test]
fn the_wheel_without_feed_enable() {
    let mut rig = wheel("");
    rig.event("key NO_FEED press");
    rig.seconds(0.1);
    close(turn(&mut rig, 'X', HANDWHEEL_STEPS), 0.0, 0.001);
    rig.event("key NO_FEED release");
    rig.seconds(1.0);
    close(turn(&mut rig, 'X', 0.0), 0.0, 0.001);
}

/// The jog increment of the manual: enabled in the mode Handwheel, started by the markers of keys that have
/// two contacts [000:8533-8556].
const JOG: &str = "
       L M2052
       = M2498
       R M2512
       R M2513
       S M2528
       S M2529
       S M2530
       S M2531
       S M2532
       S M2533
       S M2534
       S M2535
       S M2536
       S M2537
       L I133
       S M2512
       R M2528
       L I128
       S M2513
       R M2529
";

/// One increment for each press of a key, with the manual feed; a key that is held gives one only
/// [003:1084-1095].
#[test]
fn jog_increment() {
    let mut rig = wheel(JOG);
    rig.command("jog 2.5");
    let from = rig.table('X');
    rig.event("key X+ press");
    rig.seconds(1.0);
    close(rig.table('X') - from, 2.5, 0.005);
    rig.event("key X+ release");
    rig.seconds(0.1);
    rig.event("key X+ tap");
    rig.seconds(1.0);
    close(rig.table('X') - from, 5.0, 0.005);
    rig.event("key X- tap");
    rig.seconds(1.2);
    close(rig.table('X') - from, 2.5, 0.005);
    // A press while the axis still runs counts for nothing.
    rig.command("jog 10");
    rig.event("key X+ tap");
    rig.seconds(0.3);
    rig.event("key X+ tap");
    rig.seconds(1.5);
    close(rig.table('X') - from, 12.5, 0.005);
}

/// An increment beyond the limit ends at it, with the message.
#[test]
fn the_increment_ends_at_the_limit() {
    let mut rig = wheel(JOG);
    rig.command("jog 50");
    for _ in 0..2 {
        rig.event("key X+ tap");
        rig.seconds(4.0);
    }
    close(rig.table('X'), 170.0, 0.005);
    assert_eq!(rig.messages(), ["LIMIT SWITCH X+"]);
}

/// NC STOP ends the increment.
#[test]
fn nc_stop_ends_the_increment() {
    let mut rig = wheel(JOG);
    rig.command("jog 50");
    let from = rig.table('X');
    rig.event("key X- tap");
    rig.seconds(0.5);
    close(rig.speed('X'), -1200.0, 5.0);
    rig.event("key NC_STOP tap");
    rig.seconds(1.0);
    let way = rig.table('X') - from;
    assert!(way < -5.0 && way > -15.0, "{way}");
    close(rig.speed('X'), 0.0, 1.0);
}

/// Module 9036 limits the increment: item 10, 1/10 000 mm; -1 takes the limit away and the last entry
/// stays; -2 makes the smaller of the two the entry [000:8494-8556].
#[test]
fn limit_of_the_increment() {
    let program = format!(
        "{JOG}
       L I30
       CMT 10
       L I31
       CMT 11
       L I28
       CMT 12
LBL 10
       PS K+10
       PS K+15000
       CM 9036
       PL B200
       EM
LBL 11
       PS K+10
       PS K-1
       CM 9036
       PL B200
       EM
LBL 12
       PS K+10
       PS K-2
       CM 9036
       PL B200
       EM
"
    );
    let mut rig = wheel(&program);
    rig.command("jog 4");
    let step = |rig: &mut Rig, input: Option<&str>| {
        if let Some(input) = input {
            rig.input(input, true);
            rig.seconds(0.1);
            rig.input(input, false);
        }
        let from = rig.table('X');
        rig.event("key X- tap");
        rig.seconds(1.0);
        from - rig.table('X')
    };
    close(step(&mut rig, None), 4.0, 0.005);
    close(step(&mut rig, Some("I30")), 1.5, 0.005);
    close(step(&mut rig, Some("I31")), 4.0, 0.005);
    close(step(&mut rig, Some("I30")), 1.5, 0.005);
    close(step(&mut rig, Some("I28")), 1.5, 0.005);
    rig.command("jog 3");
    close(step(&mut rig, None), 3.0, 0.005);
}

/// M2512 = M2528: flashing 2A, but only while M2498 is 1 [000:8500-8525].
#[test]
fn complements_of_the_increment() {
    let mut rig = bench("       L I30\n       = M2498\n").ready();
    rig.seconds(0.1);
    assert_eq!(rig.messages(), [""; 0]);
    rig.input("I30", true);
    rig.seconds(0.1);
    assert_eq!(rig.messages(), ["ERROR IN PLC-PROGRAM 2A"]);
}
