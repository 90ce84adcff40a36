//! PASS OVER REFERENCE MARKS: the four kinds, their order and what the PLC sees [000:4543-4691].

use crate::support::bench::*;
use crate::support::*;
use bahn_tnc::Mode;

/// Power-on until the control asks for the reference run.
fn asked(build: Build) -> Rig {
    let mut rig = build.rig();
    rig.until(5.0, "the reference run is asked for", |rig| {
        rig.control.snapshot().mode == Mode::Reference
    });
    rig.scan();
    rig
}

fn done(rig: &mut Rig) {
    rig.until(40.0, "the reference run ends", |rig| {
        rig.control.snapshot().mode == Mode::Manual
    });
    rig.settle();
}

/// A bench on which only X is there: its kind, its marks and its place at power-on.
fn only_x(kind: u8, marks: &str, start: f64) -> Build {
    bench("")
        .mps("10=1 50=1 1340.0=1 1340.1=0 1340.2=0")
        .mp(&format!("1350.0={kind}"))
        .plant(
            "travel = [0, 200]\nstart = 50\nreference_cam = { range = [180, 200], input = \"I0\" }",
            &format!(
                "travel = [0, 200]\nstart = {start}\nreference_cam = {{ range = [180, 200], input = \"I0\" }}"
            ),
        )
        .plant(
            "input = \"X1\"\nperiod_um = 20\nmark = 100",
            &format!("input = \"X1\"\nperiod_um = 20\n{marks}"),
        )
}

/// Least and greatest place of the table until the run ends, and where it stands then.
fn way(rig: &mut Rig) -> [f64; 3] {
    let [least, greatest] = rig.way_to_mark();
    close(rig.machine_position('X'), rig.table('X'), 0.001);
    [least, greatest, rig.table('X')]
}

/// W272 = 7; the axes go one after the other in the order of MP1340, here Y, Z, X: M2008 ff. falls as the
/// axis starts, M2136 ff. falls at its mark, M2008 ff. rises as it stands; then W272 = 1 [000:4669-4687].
#[test]
fn start_passes_all_marks_in_the_order_of_mp1340() {
    let mut rig = asked(bench("").mps("1340.0=2 1340.1=3 1340.2=1"));
    assert_eq!(rig.number("W272"), 7);
    for marker in ["M2136", "M2137", "M2138", "M2000", "M2008", "M2009", "M2010"] {
        assert!(rig.bit(marker), "{marker}");
    }
    rig.start();
    let edges = rig.edges(6.0, &["M2008", "M2009", "M2010", "M2136", "M2137", "M2138"]);
    assert_eq!(
        edges,
        [
            "M2009=0", "M2137=0", "M2009=1", "M2010=0", "M2138=0", "M2010=1", "M2008=0", "M2136=0", "M2008=1"
        ]
    );
    assert_eq!(rig.number("W272"), 1);
    for letter in ['X', 'Y', 'Z'] {
        close(rig.machine_position(letter), rig.table(letter), 0.001);
    }
}

/// The operator chooses the order with the direction keys; the direction is MP1320's, whichever key it is.
/// Releasing the key stops the axis [000:4563-4566].
#[test]
fn axis_keys_choose_the_order() {
    let mut rig = asked(bench(""));
    rig.event("key X- press");
    rig.seconds(0.5);
    assert!(
        rig.table('X') > 60.0,
        "positive as MP1320 says: {}",
        rig.table('X')
    );
    rig.event("key X- release");
    rig.settle();
    let stands = rig.table('X');
    assert!(!rig.axis('X').referenced);
    rig.seconds(0.2);
    assert_eq!(rig.speed('X').round(), 0.0);
    close(rig.table('X'), stands, 0.01);
    for key in ["X-", "Z+", "Y+"] {
        rig.event(&format!("key {key} press"));
        rig.seconds(3.0);
        rig.event(&format!("key {key} release"));
        rig.scan();
    }
    assert_eq!(rig.number("W272"), 1, "all marks are passed: the mode is left");
    assert_eq!(rig.messages(), [""; 0]);
}

/// NC STOP stops the run; START goes on with it.
#[test]
fn nc_stop_interrupts_the_run() {
    let mut rig = asked(bench(""));
    rig.start();
    rig.seconds(0.6);
    assert!(rig.speed('Z') > 1000.0);
    rig.event("key NC_STOP tap");
    rig.seconds(1.0);
    assert_eq!(rig.speed('Z').round(), 0.0);
    assert_eq!(rig.number("W272"), 7);
    rig.seconds(2.0);
    assert!(rig.bit("M2138"), "it does not go on by itself");
    rig.start();
    done(&mut rig);
}

/// Without feed enable nothing moves; with it the run goes on where it was.
#[test]
fn the_run_waits_for_feed_enable() {
    let mut rig = asked(bench(""));
    rig.event("key NO_FEED press");
    rig.start();
    rig.seconds(1.0);
    close(rig.table('Z'), 50.0, 0.01);
    rig.event("key NO_FEED release");
    done(&mut rig);
}

/// MP1350 = 1: the first mark outside the cam. From 50 up to the mark at 100 and a stop after it.
#[test]
fn one_mark() {
    let [least, greatest, stands] = way(&mut asked(only_x(1, "mark = 100", 50.0)));
    close(least, 50.0, 0.01);
    // 3000 mm/min are brought to rest at 1 m/s² in 1.25 mm; the lag of 1.5 mm is still in front of it.
    assert!(greatest > 100.0 && greatest < 103.0, "{greatest}");
    close(stands, greatest, 0.01);
}

/// The mark lies behind: the cam closes at 180, the axis reverses and finds it at 100.
#[test]
fn one_mark_after_the_start() {
    let [_, greatest, stands] = way(&mut asked(only_x(1, "mark = 100", 120.0)));
    assert!(greatest > 180.0 && greatest < 184.0, "{greatest}");
    assert!(stands < 100.0 && stands > 97.0, "{stands}");
}

/// Already on the cam: at once against MP1320. A mark under the cam does not count.
#[test]
fn one_mark_from_the_cam() {
    let [_, greatest, stands] = way(&mut asked(only_x(1, "marks_every = 90\nmarks_from = 100", 195.0)));
    close(greatest, 195.0, 0.01);
    assert!(
        stands < 100.0 && stands > 97.0,
        "190 is under the cam, 100 counts: {stands}"
    );
}

/// MP1320 bit 0 = 1: negative direction.
#[test]
fn negative_direction() {
    let [least, greatest, _] = way(&mut asked(only_x(1, "mark = 100", 120.0).mps("1320=1")));
    close(greatest, 120.0, 0.01);
    assert!(least > 97.0 && least < 100.0, "{least}");
}

/// MP1350 = 3: two successive marks, at most 20 mm of way, and the position is known. The zero mark of the
/// scale stands at 0, MP960 = 0.
#[test]
fn distance_coded_marks() {
    let build = only_x(3, "marks_coded = 20\nmarks_from = 0", 50.0).mps("960.0=0");
    let [least, greatest, _] = way(&mut asked(build));
    close(least, 50.0, 0.01);
    assert!(greatest < 50.0 + 20.0 + 3.0, "{greatest}");
}

/// A scratched scale has a second mark 20 periods, 0.4 mm, after each. After 50.06 the pair would stand at (960 + 1 - 1) ·
/// 500 - 20 + 20 periods of 20 µm = 9600 mm, far outside of 10 to 170: with MP30 the scale is defective, without it the pair
/// does not count, and the next sound one, 60 and 70.08, does (inferred).
#[test]
fn doubled_marks_are_refused() {
    let build = only_x(3, "marks_coded = 20\nmarks_from = 0", 50.0).mps("960.0=0");
    let mut rig = asked(build.mps("30=1"));
    rig.event("fault encoder X twice");
    rig.start();
    rig.until(8.0, "the doubled mark", |rig| !rig.messages().is_empty());
    assert_eq!(rig.messages(), ["MEASURING SYSTEM X DEFECTIVE C"]);
    assert!(rig.table('X') < 52.0 && !rig.axis('X').referenced);

    let build = only_x(3, "marks_coded = 20\nmarks_from = 0", 50.0).mps("960.0=0");
    let mut rig = asked(build.mps("30=0"));
    rig.event("fault encoder X twice");
    rig.start();
    rig.until(8.0, "after the doubled mark", |rig| rig.table('X') > 55.0);
    assert!(!rig.axis('X').referenced);
    rig.event("repair X");
    done(&mut rig);
    assert_eq!(rig.messages(), [""; 0]);
    close(rig.machine_position('X'), rig.table('X'), 0.001);
    assert!((70.0..75.0).contains(&rig.table('X')), "{}", rig.table('X'));
}

/// The cam closes before two marks were passed: the axis reverses and counts anew.
#[test]
fn distance_coded_marks_near_the_cam() {
    let build = only_x(3, "marks_coded = 20\nmarks_from = 0", 178.0).mps("960.0=0");
    let [_, greatest, stands] = way(&mut asked(build));
    assert!(greatest > 180.0 && greatest < 184.0, "{greatest}");
    // The software limit is 170: the way back ends inside.
    assert!(stands <= 170.0 && stands > 150.0, "{stands}");
}

/// MP1350 = 0, the old kind: a cam that closes during the run is ignored; found beyond the software limit
/// (170), the axis returns to it by itself [000:4605].
#[test]
fn old_distance_coded_marks_beyond_the_limit() {
    let build = only_x(0, "marks_coded = 20\nmarks_from = 0", 165.0)
        .mps("960.0=0")
        .plant("travel = [0, 200]\nstart = 165", "travel = [0, 240]\nstart = 165");
    let [_, greatest, stands] = way(&mut asked(build));
    assert!(greatest > 172.0, "{greatest}");
    close(stands, 170.0, 0.01);
}

/// On the cam at the start: against MP1320.
#[test]
fn old_distance_coded_marks_from_the_cam() {
    let build = only_x(0, "marks_coded = 20\nmarks_from = 0", 195.0).mps("960.0=0");
    let [_, greatest, stands] = way(&mut asked(build));
    close(greatest, 195.0, 0.01);
    assert!(stands < 170.01, "within the limits: {stands}");
}

/// MP1350 = 2: one pulse each turn of the ballscrew, 10 mm. Onto the cam at 180 with MP1330, back from it
/// with MP1331; the first pulse after the cam counts: 170 [000:4622].
#[test]
fn one_pulse_each_turn() {
    for start in [50.0, 183.0] {
        let build =
            only_x(2, "marks_every = 10\nmarks_from = 0", start).mps("960.0=-170 1331.0=300 910.0=190");
        let mut rig = asked(build);
        let [_, greatest, stands] = way(&mut rig);
        assert!(greatest > 180.0 && greatest < 185.0, "{greatest}");
        // 300 mm/min leave a lag of 0.15 mm.
        close(stands, 169.85, 0.2);
    }
}

/// Marks are passed with the feed MP1330 times the override; NC STOP is no start.
#[test]
fn feed_of_the_run() {
    let mut rig = asked(bench(""));
    rig.start();
    rig.seconds(0.6);
    close(rig.speed('Z'), 3000.0, 10.0);
    rig.event("override feed 50");
    rig.seconds(0.3);
    close(rig.speed('Z'), 1500.0, 10.0);
}

/// Before the marks are passed the axes may be moved without limits, and D528 positions nothing; the
/// software limit 170 holds afterwards [000:4568-4573].
#[test]
fn limits_hold_after_the_marks() {
    let mut rig = asked(bench(""));
    rig.command("mode manual");
    rig.event("key RAPID press");
    rig.event("key X+ press");
    rig.seconds(1.4);
    assert!(rig.table('X') > 172.0, "{}", rig.table('X'));
    rig.event("key X+ release");
    rig.event("key X- press");
    rig.seconds(1.0);
    rig.event("key X- release");
    rig.event("key RAPID release");
    rig.settle();
    rig.command("mode reference");
    rig.start();
    done(&mut rig);
    rig.event("key RAPID press");
    rig.event("key X+ press");
    rig.seconds(3.0);
    close(rig.table('X'), 170.0, 0.01);
    assert_eq!(rig.messages(), ["LIMIT SWITCH X+"]);
}

/// An axis that is only displayed (MP50 = 0) needs no run: its counter is zero on the mark [000:4573].
#[test]
fn display_axis() {
    let build = bench("").mps("10=15 50=7 410.3=4").with(&fourth('V', ""));
    let mut rig = build.ready();
    assert!(rig.bit("M2139") && !rig.axis('V').referenced);
    // Somebody turns it by hand.
    rig.event("force V 0.5");
    rig.until(60.0, "its mark passes", |rig| rig.axis('V').referenced);
    rig.scan();
    assert!(!rig.bit("M2139"));
    let axis = rig.axis('V');
    close(axis.machine, rig.table('V') - 100.0, 0.02);
}

/// An axis that MP1340 does not name is not referenced automatically [000:4649-4654].
#[test]
fn an_axis_without_place_in_mp1340() {
    let mut rig = asked(bench("").mps("1340.0=1 1340.1=2 1340.2=0"));
    rig.start();
    done(&mut rig);
    assert!(rig.axis('Y').referenced && !rig.axis('Z').referenced);
}

/// Another mode is chosen before the marks are passed [000:4581]: no program starts, in full sequence, in single block or
/// after a block scan; what MP1340 does not name is not waited for.
#[test]
fn no_program_starts_before_the_marks_are_passed() {
    let program = "L X+60 Y+60 R0 F3000\nL X+70";
    let mut rig = asked(bench("").program("1.H", program));
    let before = ['X', 'Y', 'Z'].map(|axis| rig.table(axis));
    for mode in ["full", "single"] {
        rig.command(&format!("mode {mode}"));
        rig.command("select 1.H");
        rig.start();
        rig.seconds(1.0);
        assert_eq!(rig.messages(), ["KEY NON-FUNCTIONAL"], "{mode}");
        assert_eq!(rig.control.run_state(), bahn_tnc::RunState::Idle);
        rig.command("ce");
    }
    assert!(!rig.control.command("restore-at 2".parse().unwrap()));
    assert_eq!(rig.messages(), ["KEY NON-FUNCTIONAL"]);
    rig.command("ce");
    for (axis, place) in ['X', 'Y', 'Z'].into_iter().zip(before) {
        close(rig.table(axis), place, 0.01);
    }
    rig.command("mode reference");
    rig.start();
    done(&mut rig);
    rig.command("mode full");
    rig.command("select 1.H");
    rig.start();
    rig.until(20.0, "the end", |rig| rig.control.snapshot().ended);
    assert_eq!(rig.messages(), [""; 0]);

    let mut rig = asked(
        bench("")
            .mps("1340.0=1 1340.1=2 1340.2=0")
            .program("1.H", program),
    );
    rig.start();
    done(&mut rig);
    rig.command("mode full");
    rig.command("select 1.H");
    rig.start();
    rig.until(20.0, "the end", |rig| rig.control.snapshot().ended);
    assert!(!rig.axis('Z').referenced);
}

/// Leaving the mode early stops the axis on its ramp; PASS OVER REFERENCE goes on later [000:4581].
#[test]
fn leaving_the_run_early() {
    let mut rig = asked(bench(""));
    rig.start();
    rig.seconds(0.5);
    rig.command("mode manual");
    rig.seconds(0.5);
    close(rig.speed('Z'), 0.0, 1.0);
    assert!(rig.bit("M2138"));
    rig.command("mode reference");
    rig.seconds(0.5);
    close(rig.speed('Z'), 0.0, 1.0);
    rig.start();
    done(&mut rig);
    assert_eq!(rig.messages(), [""; 0]);
    assert!(
        !rig.control.command("mode reference".parse().unwrap()),
        "nothing is missing"
    );
}

/// EMERGENCY STOP during the run: the axis stops; after CE START goes on.
#[test]
fn emergency_stop_during_the_run() {
    let mut rig = asked(bench(""));
    rig.start();
    rig.seconds(0.5);
    rig.event("emergency press");
    rig.seconds(0.5);
    rig.event("emergency release");
    rig.seconds(0.1);
    rig.command("ce");
    rig.seconds(0.5);
    close(rig.speed('Z'), 0.0, 1.0);
    assert_eq!(rig.number("W272"), 7);
    rig.start();
    done(&mut rig);
    close(rig.machine_position('Z'), rig.table('Z'), 0.001);
}
