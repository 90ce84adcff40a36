//! ELECTRONIC HANDWHEEL: interpolation factors, threshold, jog increment [000:8060-8170] [000:8494-8556].

use crate::support::bench::*;
use crate::support::*;
use bahn_tnc::HANDWHEEL_STEPS;

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

/// What is turned while the loops are open moves nothing when they close.
#[test]
fn the_wheel_in_an_emergency_stop() {
    let mut rig = wheel("");
    rig.event("emergency press");
    rig.seconds(0.5);
    let from = rig.table('X');
    rig.event(&format!("handwheel {HANDWHEEL_STEPS}"));
    rig.seconds(0.5);
    rig.event("emergency release");
    rig.seconds(0.3);
    rig.command("ce");
    rig.until(2.0, "the loops are closed", |rig| rig.bit("M2000"));
    rig.seconds(1.0);
    close(rig.table('X') - from, 0.0, 0.01);
    assert_eq!(rig.messages(), [""; 0]);
}

/// The inputs I160 to I175 that are set, by their numbers.
fn inputs(rig: &mut Rig) -> Vec<u16> {
    rig.seconds(0.1);
    (160..176)
        .filter(|number| rig.bit(&format!("I{number}")))
        .collect()
}

/// The bench with another handwheel.
fn kind(parameters: &str) -> Rig {
    let mut rig = bench("")
        .plant("speed = 6000", "speed = 12000")
        .mps("1710.0=8 1720.0=10 7650=1 7660=0 7670.0=0 1010.0=12000 1010.1=12000 1010.2=12000")
        .mps(parameters)
        .ready();
    rig.command("mode handwheel");
    rig.scan();
    rig
}

/// The highlighted axis, M2096 ff., and the one that the wheel leads.
fn highlight_and_symbol(rig: &mut Rig) -> [usize; 2] {
    rig.scan();
    let last = ["M2096", "M2097", "M2098"].map(|marker| rig.bit(marker));
    assert_eq!(last.iter().filter(|on| **on).count(), 1, "{last:?}");
    let highlight = last.iter().position(|on| *on).unwrap();
    [highlight, rig.control.first().handwheel().0]
}

/// Axis keys of the keyboard move the highlight (M2096 ff.), those of the handwheel its symbol; with MP7640 = 2 either moves
/// both [000:6425] [000:6459-6464] [000:8139-8157]. Key 108 is Y, 107 Z [000:7500-7535].
#[test]
fn axis_keys_of_keyboard_and_handwheel() {
    for (kind_of, by_keyboard, by_wheel) in [(1, [1, 0], [1, 2]), (2, [1, 1], [2, 2]), (3, [1, 0], [1, 2])] {
        let mut rig = kind(&format!("7640={kind_of}"));
        assert_eq!(highlight_and_symbol(&mut rig), [0, 0]);
        rig.command("key 108");
        assert_eq!(highlight_and_symbol(&mut rig), by_keyboard, "MP7640 = {kind_of}");
        rig.event("handwheel key Z tap");
        rig.seconds(0.1);
        assert_eq!(highlight_and_symbol(&mut rig), by_wheel, "MP7640 = {kind_of}");
        rig.command("axis-key X");
        assert_eq!(highlight_and_symbol(&mut rig)[0], 0);
    }
    // In a program run it highlights nothing.
    let mut rig = kind("7640=2");
    rig.command("mode full");
    rig.command("key 107");
    assert_eq!(highlight_and_symbol(&mut rig), [0, 0]);
    // An inhibited key only tells the PLC.
    rig.command("mode manual");
    rig.command("M2904=1");
    rig.command("key 108");
    assert_eq!(highlight_and_symbol(&mut rig), [0, 0]);
    assert!(rig.bit("M2182"));
}

/// MP7640 and MP7645.0 say which keys are inputs of the PLC [000:8153-8186] [000:8257-8302].
#[test]
fn keys_go_where_mp7640_says() {
    let keys = |parameters: &str, pressed: &[&str]| {
        let mut rig = kind(parameters);
        for key in pressed {
            rig.event(&format!("handwheel key {key} press"));
        }
        inputs(&mut rig)
    };
    assert_eq!(keys("7640=1", &["+", "-", "RAPID", "X"]), [160, 161, 162]);
    assert_eq!(keys("7640=3", &["RAPID"]), [162]);
    assert_eq!(
        keys("7640=4 7645.0=0", &["X", "1", "5", "-", "+"]),
        [164, 168, 169, 170]
    );
    assert_eq!(keys("7640=4 7645.0=1", &["X", "IV", "+"]), [160, 163, 170]);
    assert_eq!(
        keys("7640=6 7645.0=0", &["X", "+", "A", "B", "C"]),
        [173, 174, 175]
    );
    let all = [
        "X", "IV", "Y", "V", "Z", "CAPTURE", "SLOW", "MEDIUM", "FAST", "-", "+", "A",
    ];
    let expected = [160, 161, 162, 163, 164, 167, 168, 169, 170, 171, 172, 173];
    assert_eq!(keys("7640=6 7645.0=1", &all), expected);
    assert_eq!(keys("7640=0", &["X", "+", "A"]), [0; 0]);
}

/// The axis keys of an HR 330 choose the axis of the wheel; + and - move it with the manual feed, with the
/// rapid traverse key at rapid traverse. With MP7640 = 3 they are the PLC's [000:8124-8151].
#[test]
fn an_hr_330() {
    let mut rig = kind("7640=1");
    rig.command("handwheel X 1");
    rig.command("handwheel Y 1");
    rig.event("handwheel key X tap");
    rig.seconds(0.3);
    close(turn(&mut rig, 'X', HANDWHEEL_STEPS), 10.0, 0.005);
    rig.event("handwheel key - press");
    rig.seconds(0.5);
    close(rig.speed('X'), -1200.0, 5.0);
    rig.event("handwheel key RAPID press");
    rig.seconds(0.3);
    assert!(rig.speed('X') < -3000.0, "{}", rig.speed('X'));
    rig.event("handwheel key - release");
    rig.settle();
    // In another mode they move nothing.
    rig.command("mode manual");
    rig.event("handwheel key + press");
    rig.seconds(0.3);
    close(rig.speed('X'), 0.0, 1.0);

    let mut rig = kind("7640=3");
    rig.event("handwheel key + press");
    rig.seconds(0.3);
    close(rig.speed('X'), 0.0, 1.0);
}

/// SLOW, MEDIUM and FAST of an HR 410: the factors of MP7670 and, in percent of MP1020 = 1200, the feeds of MP7671
/// [000:8292-8304].
#[test]
fn speeds_of_the_hr_410() {
    let mut rig = kind("7640=6 7645.0=0 7670.0=4 7670.1=2 7670.2=1 7671.0=10 7671.1=50 7671.2=200");
    rig.event("handwheel key Y tap");
    for (key, travel, feed) in [
        ("SLOW", 1.25, 120.0),
        ("MEDIUM", 5.0, 600.0),
        ("FAST", 10.0, 2400.0),
    ] {
        rig.event(&format!("handwheel key {key} tap"));
        rig.seconds(0.3);
        close(turn(&mut rig, 'Y', HANDWHEEL_STEPS), travel, 0.005);
        rig.event("handwheel key - press");
        rig.seconds(0.4);
        close(rig.speed('Y'), -feed, 5.0);
        rig.event("handwheel key - release");
        rig.settle();
    }
}

/// Three HR 150 at an HRA 110: the first is X, the second Y, the third what S2 or MP7645.1 says; all at once. S1 and
/// S2 work with 0 V logic [000:8310-8385].
#[test]
fn three_wheels() {
    let mut rig = kind("7640=5 7645.0=1 7645.1=4 7645.2=0");
    for axis in ['X', 'Y', 'Z'] {
        rig.command(&format!("handwheel {axis} 3"));
    }
    rig.event("handwheel S1 3");
    rig.event("handwheel S2 3");
    let expected: Vec<u16> = (160..176).filter(|input| ![162, 170].contains(input)).collect();
    assert_eq!(inputs(&mut rig), expected);
    let from = ['X', 'Y', 'Z'].map(|axis| rig.table(axis));
    rig.event("handwheel 1 1000");
    rig.event("handwheel 2 -1000");
    rig.event("handwheel 3 2000");
    rig.seconds(2.0);
    for ((axis, from), way) in ['X', 'Y', 'Z'].into_iter().zip(from).zip([2.5, -2.5, 5.0]) {
        close(rig.table(axis) - from, way, 0.005);
    }
    // Position 1 of S2 is X: the third wheel leads it, too; Z is let go.
    rig.event("handwheel S2 1");
    rig.seconds(0.1);
    let from = rig.table('X');
    rig.event("handwheel 3 1000");
    rig.seconds(2.0);
    close(rig.table('X') - from, 2.5, 0.005);
}

/// HANDWHEEL? when MP7640 names one and none is plugged in [000:8069]; what is turned then moves nothing.
#[test]
fn a_handwheel_that_is_not_there() {
    let mut rig = kind("7640=2");
    rig.command("handwheel X 1");
    assert_eq!(rig.messages(), [""; 0]);
    rig.event("handwheel unplug");
    close(turn(&mut rig, 'X', HANDWHEEL_STEPS), 0.0, 0.001);
    assert_eq!(rig.messages(), ["HANDWHEEL?"]);
    rig.event("handwheel plug");
    rig.seconds(0.1);
    assert_eq!(rig.messages(), [""; 0]);
    close(turn(&mut rig, 'X', HANDWHEEL_STEPS), 10.0, 0.005);
    let mut rig = kind("7640=0");
    rig.event("handwheel unplug");
    rig.seconds(0.1);
    assert_eq!(rig.messages(), [""; 0]);
}

/// MP7641 = 1: the factor is the PLC's; the axis may be chosen with the factor that it has [000:8108-8111].
#[test]
fn the_factor_is_the_plcs() {
    let mut rig = kind("7640=2 7641=1");
    assert!(!rig.control.command("handwheel Y 2".parse().unwrap()));
    rig.command("ce");
    rig.command("handwheel Y 5");
    close(turn(&mut rig, 'Y', HANDWHEEL_STEPS), 0.625, 0.005);
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
