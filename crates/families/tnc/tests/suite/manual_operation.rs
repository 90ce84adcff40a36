//! MANUAL OPERATION: direction keys, rapid traverse, overrides, limits and ranges, datum, M and S
//! [000:7539-7611] [000:3436-3561] [003:1031-1191].

use crate::support::bench::*;
use bahn_tnc::Command;

/// The axis runs as long as its key is pressed, with MP1020 = 1200 mm/min; two axes at once [003:1031-1041].
/// Both keys of one axis stop it.
#[test]
fn direction_keys() {
    let mut rig = bench("").ready();
    rig.event("key X+ press");
    rig.event("key Y- press");
    rig.seconds(0.5);
    close(rig.speed('X'), 1200.0, 5.0);
    close(rig.speed('Y'), -1200.0, 5.0);
    assert!(
        !rig.bit("M2160") && rig.bit("M2161"),
        "M2160 ff. are the directions"
    );
    assert!(
        !rig.bit("M2128"),
        "in motion only in the automatic modes [000:5386-5397]"
    );
    assert!(rig.bit("M2097"), "the Y key was the last one [000:6459-6464]");
    rig.event("key X- press");
    rig.seconds(0.3);
    close(rig.speed('X'), 0.0, 1.0);
    for key in ["X+", "X-", "Y-"] {
        rig.event(&format!("key {key} release"));
    }
    rig.settle();
    assert!(rig.bit("M2008") && rig.bit("M2009"));
    // 0.5 s at 20 mm/s, and 0.02 s of ramp to come up and to stop.
    close(rig.table('X'), rig.machine_position('X'), 0.01);
}

/// Rapid traverse MP1010 with the key; the override acts on it only with MP7620 bit 2 = 1, and never beyond
/// 100 % [000:10512]. D596 limits it from the PLC [000:4812-4814].
#[test]
fn rapid_traverse() {
    for (mp7620, percent, expected) in [(0, 50, 6000.0), (4, 50, 3000.0), (4, 150, 6000.0)] {
        let mut rig = bench("").mp(&format!("7620={mp7620}")).ready();
        rig.event(&format!("override feed {percent}"));
        rig.event("key RAPID press");
        rig.event("key X- press");
        rig.seconds(0.4);
        close(rig.speed('X'), -expected, 10.0);
    }
    let mut rig = bench("       L K+2000\n       = D596\n").ready();
    rig.event("key RAPID press");
    rig.event("key X- press");
    rig.seconds(0.4);
    close(rig.speed('X'), -2000.0, 10.0);
}

/// The override acts on MP1020, 0 to 150 %; what the PLC writes to W766 counts instead [000:6521-6543].
#[test]
fn feed_override() {
    let mut rig = bench("       L I30\n       IFT\n       L K+30\n       = W766\n       ENDI\n").ready();
    rig.event("key X- press");
    for percent in [150.0, 0.0, 10.0] {
        rig.event(&format!("override feed {percent}"));
        rig.seconds(0.3);
        close(rig.speed('X'), -12.0 * percent, 5.0);
        assert_eq!(rig.number("W494"), percent as i32);
    }
    rig.input("I30", true);
    rig.seconds(0.3);
    close(rig.speed('X'), -360.0, 5.0);
    assert_eq!(rig.number("W494"), 10);
}

/// MP7620 bit 3: non-linear, W766 counts in 1/100 % [000:5583].
#[test]
fn non_linear_override() {
    let mut rig = bench("").mp("7620=8").ready();
    rig.event("override feed 50");
    rig.event("key X- press");
    rig.seconds(0.4);
    // 50 % lies between the steps 49.75 and 50.5.
    assert_eq!(rig.number("W494"), 4975);
    close(rig.speed('X'), -597.0, 5.0);
}

/// M2450 with MP7680 bit 0 = 1: the axis runs on until NC STOP, though M2450 and the key have gone
/// [000:7545-7552].
#[test]
fn latched_keys() {
    let mut rig = bench("").mp("7680=1").ready();
    rig.event("key LATCH press");
    rig.event("key X- press");
    rig.seconds(0.1);
    rig.event("key X- release");
    rig.event("key LATCH release");
    rig.seconds(0.3);
    close(rig.speed('X'), -1200.0, 5.0);
    rig.event("key NC_STOP tap");
    rig.seconds(0.5);
    close(rig.speed('X'), 0.0, 1.0);
    // Without the parameter nothing is latched.
    let mut rig = bench("").mp("7680=0").ready();
    rig.event("key LATCH press");
    rig.event("key X- press");
    rig.seconds(0.1);
    rig.event("key X- release");
    rig.seconds(0.3);
    close(rig.speed('X'), 0.0, 1.0);
}

/// A command marker that equals its complement: flashing, and the machine is off [000:7543-7585].
#[test]
fn complements_must_contradict() {
    for (marker, code) in [("M2464", "1A"), ("M2466", "1C"), ("M2472", "1I"), ("M2541", "2N")] {
        let mut rig = bench(&format!("       L I30\n       R {marker}\n")).ready();
        rig.input("I30", true);
        rig.seconds(0.1);
        assert_eq!(rig.messages(), [format!("ERROR IN PLC-PROGRAM {code}")]);
        assert!(rig.control.snapshot().messages[0].flashing);
        assert!(!rig.bit("M2190"), "no message that CE clears");
        assert!(!rig.axis('X').closed);
    }
}

/// At a software limit the axis stops at the value of MP910 or MP920, with message and marker M2624 ff.;
/// both go when it leaves the limit [000:3522-3534].
#[test]
fn software_limits() {
    let mut rig = bench("").ready();
    for (key, back, axis, marker, limit, text) in [
        ("X+", "X-", 'X', "M2624", 170.0, "LIMIT SWITCH X+"),
        ("Y-", "Y+", 'Y', "M2627", 10.0, "LIMIT SWITCH Y-"),
        ("Z+", "Z-", 'Z', "M2628", 170.0, "LIMIT SWITCH Z+"),
    ] {
        rig.event("key RAPID press");
        rig.event(&format!("key {key} press"));
        rig.seconds(2.5);
        close(rig.table(axis), limit, 0.005);
        assert_eq!(rig.messages(), [text]);
        assert!(rig.bit(marker) && rig.bit("M2190"));
        rig.event(&format!("key {key} release"));
        rig.event(&format!("key {back} press"));
        rig.seconds(0.2);
        assert_eq!(rig.messages(), [""; 0]);
        assert!(!rig.bit(marker));
        rig.event(&format!("key {back} release"));
        rig.settle();
    }
}

/// The manual's range change by an input [000:3538-3561]: one strobe at each edge of I10.
const RANGE: &str = "
       L I10
       AN M556
       S M2816
       R M2817
       S M2824
       S M556
       R M555
       LN I10
       AN M555
       R M2816
       R M2817
       S M2824
       S M555
       R M556
";

#[test]
fn traverse_ranges() {
    let mut rig = bench(RANGE).mps("911.0=120 921.0=90").ready();
    assert!(rig.bit("M555") && !rig.bit("M2824"));
    rig.input("I10", true);
    let edges = rig.edges(0.2, &["M2816", "M2817", "M2824", "M555", "M556"]);
    assert_eq!(edges, ["M2816=1", "M2824=1", "M555=0", "M556=1", "M2824=0"]);
    rig.event("key RAPID press");
    rig.event("key X+ press");
    rig.seconds(2.0);
    close(rig.table('X'), 120.0, 0.005);
    rig.event("key X+ release");
    rig.event("key X- press");
    rig.seconds(2.0);
    close(rig.table('X'), 90.0, 0.005);
    rig.event("key X- release");
    rig.input("I10", false);
    let edges = rig.edges(0.2, &["M2816", "M2817", "M2824", "M555", "M556"]);
    assert_eq!(edges, ["M2816=0", "M2824=1", "M555=1", "M556=0", "M2824=0"]);
    assert_eq!(rig.messages(), [""; 0], "the limit is another one now");
    rig.event("key X+ press");
    rig.seconds(2.0);
    close(rig.table('X'), 170.0, 0.005);
}

/// The third range is M2817 = 1; both markers mean nothing [000:3510-3520].
#[test]
fn third_traverse_range() {
    let program =
        "       L I10\n       = M2816\n       L I11\n       = M2817\n       L I12\n       S M2824\n";
    let mut rig = bench(program).mps("911.0=120 912.0=140").ready();
    for (i10, i11, limit) in [(false, true, 140.0), (true, true, 140.0), (true, false, 120.0)] {
        rig.input("I10", i10);
        rig.input("I11", i11);
        rig.scan();
        rig.input("I12", true);
        rig.scan();
        rig.input("I12", false);
        rig.seconds(0.1);
        assert!(!rig.bit("M2824"));
        if limit == 120.0 {
            rig.event("key X- press");
            rig.seconds(0.5);
            rig.event("key X- release");
            rig.settle();
            // From beyond the new limit only backwards.
            let stands = rig.table('X');
            rig.event("key X+ press");
            rig.seconds(0.3);
            rig.event("key X+ release");
            close(rig.table('X'), stands, 0.005);
            continue;
        }
        rig.event("key RAPID press");
        rig.event("key X+ press");
        rig.seconds(1.5);
        close(rig.table('X'), limit, 0.005);
        rig.event("key X+ release");
        rig.event("key RAPID release");
    }
}

/// DATUM SET: the actual position becomes the value. Each range has its own datum with MP7490 = 1, all the
/// same one with MP7490 = 3 [000:3499-3508].
#[test]
fn datum_for_each_range() {
    for (mp7490, own) in [(0, true), (1, true), (2, false), (3, false)] {
        let mut rig = bench(RANGE).mp(&format!("7490={mp7490}")).ready();
        rig.command("datum X 25.5");
        close(rig.axis('X').actual, 25.5, 0.0005);
        rig.input("I10", true);
        rig.seconds(0.1);
        let position = rig.axis('X').actual;
        close(
            position,
            if own { rig.machine_position('X') } else { 25.5 },
            0.0005,
        );
        rig.command("datum X 7");
        rig.input("I10", false);
        rig.seconds(0.1);
        close(rig.axis('X').actual, if own { 25.5 } else { 7.0 }, 0.0005);
    }
}

/// An axis with a Hirth coupling (MP420, MP430): its datum is rounded to the grid from machine zero [000:8564]. C
/// stands at 31.2 degrees on a grid of 2.5: datum 0 there is at 30 or 32.5, and C shows what is left.
#[test]
fn the_datum_of_a_hirth_coupling() {
    for (stands, value, shown) in [(31.2, 0.0, 1.2), (31.3, 0.0, -1.2), (31.2, 90.0, 91.2)] {
        let axis =
            "10=15 50=15 810.3=0 1010.3=3600 1020.3=1200 1330.3=1800 1340.3=4 1510.3=2 910.3=500 920.3=-500";
        let build = bench("").with(TABLE).mps(axis).mps("420.3=1 430.3=2.5");
        let mut rig = build
            .program("1.H", &format!("L C{stands:+} R0 F3000 M91"))
            .ready();
        rig.run("1.H", 20.0);
        rig.command("mode manual");
        close(rig.machine_position('C'), stands, 0.001);
        rig.command(&format!("datum C {value}"));
        close(rig.axis('C').actual, shown, 0.001);
    }
}

/// MP7295: no datum may be set in this axis [000:6270-6275]; nor in an automatic mode.
#[test]
fn datum_setting_can_be_inhibited() {
    let mut rig = bench("").mp("7295=2").ready();
    rig.command("datum X 1");
    assert!(!rig.control.command("datum Y 1".parse().unwrap()));
    rig.command("mode full");
    assert!(!rig.control.command("datum X 1".parse().unwrap()));
}

/// An M function and a speed that were entered go to the PLC with NC START [003:1103-1111].
#[test]
fn m_and_s_with_nc_start() {
    let mut rig = bench("")
        .mps("3010=3 3510.0=1000 3510.1=3000 3210.0=9 3210.1=9 3515.0=1000 3515.1=3000")
        .ready();
    rig.command("m 8");
    rig.seconds(0.3);
    assert_eq!(rig.number("W260"), 0);
    rig.start();
    let edges = rig.edges(0.4, &["M2045", "M2482", "M2043"]);
    assert_eq!(edges, ["M2045=1", "M2482=1", "M2045=0", "M2482=0"]);
    assert_eq!(rig.number("W260"), 8);
    rig.command("s 2000");
    rig.start();
    let edges = rig.edges(0.4, &["M2045", "M2043", "M2480"]);
    assert_eq!(edges, ["M2043=1", "M2480=1", "M2043=0", "M2480=0"]);
    assert_eq!((rig.number("W256"), rig.number("D356")), (1, 2_000_000));
}

/// S is 0 to 99 999 rpm [003:2180], and there is no M100: both are refused when they are entered.
#[test]
fn m_and_s_that_are_none_are_refused_when_they_are_entered() {
    let mut rig = bench("").ready();
    for refused in [
        Command::Speed(100_000.0),
        Command::Speed(-1.0),
        Command::MFunction(100),
    ] {
        assert!(!rig.control.command(refused.clone()), "{refused}");
    }
    for taken in [Command::Speed(99_999.0), Command::MFunction(99)] {
        assert!(rig.control.command(taken.clone()), "{taken}");
    }
}

/// Leaving the mode while an axis runs: it goes down its ramp.
#[test]
fn leaving_the_mode_stops_the_axes() {
    let mut rig = bench("").ready();
    rig.event("key RAPID press");
    rig.event("key X- press");
    rig.seconds(0.4);
    rig.command("mode full");
    rig.seconds(0.05);
    assert!(rig.speed('X') < -1000.0, "no jump: {}", rig.speed('X'));
    rig.settle();
    close(rig.speed('X'), 0.0, 1.0);
    assert_eq!(rig.messages(), [""; 0]);
}

/// M2552: the actual position of a clamped axis that was pushed becomes its nominal one; only in Manual and
/// Handwheel [000:5423-5434].
#[test]
fn actual_to_nominal_transfer() {
    let program = "       L I30\n       = M2544\n       L I31\n       = M2552\n";
    for (transfer, mode) in [(true, "manual"), (false, "manual"), (true, "full")] {
        let mut rig = bench(program).ready();
        rig.command(&format!("mode {mode}"));
        rig.settle();
        let stood = rig.table('X');
        rig.input("I30", true);
        rig.seconds(0.1);
        assert!(!rig.bit("M2000"));
        // 0.1 mm, less than the standstill limit of 0.2 mm.
        rig.event("force X 0.02");
        rig.until(5.0, "it gives way", |rig| rig.table('X') > stood + 0.1);
        rig.event("force X -0.02");
        rig.until(5.0, "it stands", |rig| rig.speed('X') <= 0.0);
        rig.event("force X 0");
        rig.seconds(0.1);
        let pushed = rig.table('X');
        rig.input("I31", transfer);
        rig.seconds(0.1);
        rig.input("I31", false);
        rig.input("I30", false);
        rig.settle();
        let expected = if transfer && mode == "manual" {
            pushed
        } else {
            stood
        };
        close(rig.table('X'), expected, 0.012);
    }
}

/// An M function of a program changes the range: blocks after it that the range before would have refused
/// are executed, and blocks outside the new one are refused.
#[test]
fn a_program_changes_the_range() {
    let program = "
       L M2180
       S M2496
       L M2045
       AN M80
       IFT
       L M1921
       = M2816
       ENDI
       L M2045
       AN M80
       = M81
       L M1921
       O M1922
       A M81
       S M2824
       L M2045
       = M80
       L M2045
       AN M2824
       = M2482
";
    let mut rig = bench(program)
        .mps("910.0=110 911.0=170")
        .program(
            "1.H",
            "L X+100 R0 F3000\nL M21\nL X+150\nL X+100\nL M22\nL X+105\nL X+150",
        )
        .ready();
    rig.command("mode full");
    rig.command("select 1.H");
    rig.start();
    rig.until(20.0, "beyond 110 in the second range", |rig| {
        rig.table('X') > 149.9
    });
    rig.until(20.0, "back in the first range", |rig| rig.table('X') < 100.1);
    rig.until(20.0, "the last block is refused", |rig| {
        !rig.messages().is_empty()
    });
    assert_eq!(rig.messages(), ["LIMIT SWITCH X+"]);
    rig.settle();
    close(rig.table('X'), 105.0, 0.01);
}

/// A block beyond the limit is refused: message, marker, no movement; CE takes both away.
#[test]
fn a_block_beyond_the_limit() {
    let mut rig = bench("").program("1.H", "L X+120 R0 F3000\nL X+180").ready();
    rig.command("mode full");
    rig.command("select 1.H");
    rig.start();
    rig.until(10.0, "it is refused", |rig| !rig.messages().is_empty());
    assert_eq!(rig.messages(), ["LIMIT SWITCH X+"]);
    rig.scan();
    assert!(rig.bit("M2624"));
    close(rig.table('X'), 120.0, 0.02);
    rig.command("ce");
    rig.scan();
    assert!(!rig.bit("M2624"));
}
