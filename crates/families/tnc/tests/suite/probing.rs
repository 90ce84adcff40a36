//! TCH PROBE in the program on the machine [000:7613-7718].

use crate::stand::*;
use crate::support::*;
use bahn_tnc::RunState;

/// PLC: the probing is enabled while contact A is open, as in the manual's example [000:7696-7704].
fn plc() -> String {
    format!("{ACKNOWLEDGE}       L     M2503\n       AN    I20\n       R     M2503")
}

/// The same, and contact B moves Z up in MANUAL OPERATION (M2018).
fn plc_by_hand() -> String {
    format!(
        "{}\n       L     I21\n       A     M2018\n       = M2460\n       =N M2476",
        plc()
    )
}

/// The solid begins at machine X 80; ball radius 2; touching in +X the ball's centre stands at 78. MP6140 = 5
/// keeps the centre at 75 before.
const PROGRAM: &str = "TCH PROBE 0.0 REF. PLANE Q5 X+\nTCH PROBE 0.1 X+80 Y+50 Z-20\nL X+50 R0 F6000";

fn rig(program: &str) -> Rig {
    rig_of(bench(&plc()), program)
}

fn rig_of(build: Build, program: &str) -> Rig {
    let mut rig = build.mp("6140=5").program("1.H", program).rig();
    rig.power_on();
    rig.seconds(0.3);
    // The spindle is 100 above the end of the ball: with the tip at Z -20 the nose is at machine Z 80.
    rig.datum_at_machine(100.0);
    rig.command("mode full");
    rig.command("select 1.H");
    rig.event("probe insert");
    rig
}

/// M2503 waits for the PLC; then the stylus touches the side at X 80: Q5 is 80 within what the feed of
/// 250 mm/min covers in a servo step (2.5 µm), and the axes go back to the pre-position.
#[test]
fn a_side_is_measured() {
    let mut rig = rig(PROGRAM);
    rig.event("key A press");
    rig.start();
    rig.until(5.0, "the enable", |rig| rig.bit("M2503"));
    rig.seconds(1.0);
    let x = nominal(&rig, 'X');
    assert!(rig.bit("M2503") && !rig.bit("M2025") && !rig.bit("M2026"));
    rig.event("key A release");
    rig.until(5.0, "the touch", |rig| rig.bit("M2025"));
    rig.until(5.0, "the end of probing", |rig| rig.bit("M2026"));
    rig.until(5.0, "the end", |rig| rig.control.snapshot().ended);
    let q5 = rig
        .control
        .remember()
        .q
        .iter()
        .find(|(number, _)| *number == 5)
        .unwrap()
        .1;
    assert!((q5 - 80.0).abs() < 0.004, "{q5}");
    assert!(x < 78.0);
    near(display(&rig, 'X'), 50.0);
    assert_eq!(rig.messages(), [""; 0]);
}

/// Nothing there within MP6130: TOUCH POINT INACCESSIBLE with program and block; after CE the start probes
/// again.
#[test]
fn nothing_to_touch() {
    let mut rig = rig(&PROGRAM.replace("X+80", "X-60"));
    for _ in 0..2 {
        rig.start();
        rig.until(30.0, "the message", |rig| !rig.messages().is_empty());
        assert_eq!(rig.messages(), ["TOUCH POINT INACCESSIBLE program 1.H block 2"]);
        assert_eq!(rig.control.snapshot().run, RunState::Interrupted);
        rig.command("ce");
        rig.seconds(0.3);
    }
}

/// The stylus is deflected at the pre-position already.
#[test]
fn stylus_in_contact() {
    let mut rig = rig(&PROGRAM.replace("X+80", "X+83"));
    rig.start();
    rig.until(10.0, "the message", |rig| !rig.messages().is_empty());
    assert!(
        rig.messages()[0].starts_with("STYLUS ALREADY IN CONTACT"),
        "{:?}",
        rig.messages()
    );
    rig.seconds(0.1);
    assert!(rig.bit("M2023"));
}

/// A probe that is not ready refuses (inferred), and after repair the start goes on with the block.
#[test]
fn probe_not_ready() {
    let mut rig = rig(PROGRAM);
    rig.event("fault probe not-ready");
    rig.start();
    rig.until(10.0, "the message", |rig| !rig.messages().is_empty());
    assert_eq!(rig.messages(), ["PROBE SYSTEM NOT READY"]);
    rig.seconds(0.1);
    assert!(rig.bit("M2022") && !rig.bit("M2503"));
    rig.event("repair probe");
    rig.command("ce");
    run(&mut rig, 20.0);
    assert!(!rig.bit("M2022"));
    near(display(&rig, 'X'), 50.0);
}

/// A low battery is told by M2027 when it is probed, neither before nor where nothing probes; the probing goes on. With a
/// new battery the next probing resets it [000:7688].
#[test]
fn a_low_battery_is_reported_when_it_is_probed() {
    let mut rig = rig(PROGRAM);
    rig.event("fault probe battery");
    rig.seconds(1.0);
    assert!(!rig.bit("M2027"), "nothing probes");
    rig.start();
    rig.until(5.0, "the touch", |rig| rig.bit("M2025"));
    assert!(rig.bit("M2027"));
    rig.until(5.0, "the end", |rig| rig.control.snapshot().ended);
    assert_eq!(rig.messages(), ["EXCHANGE TOUCH PROBE BATTERY"]);
    rig.command("ce");
    rig.event("repair probe");
    rig.seconds(1.0);
    assert!(rig.bit("M2027"), "nothing probes");
    rig.start();
    rig.until(5.0, "it is probed", |rig| !rig.bit("M2027"));
    rig.until(5.0, "the end", |rig| rig.control.snapshot().ended);
}

/// NC stop on the way to the touch: the axes brake, START probes on; internal stop and START probe anew.
#[test]
fn stop_while_probing() {
    for internal in [false, true] {
        let mut rig = rig(PROGRAM);
        rig.start();
        rig.until(5.0, "probing", |rig| {
            nominal(rig, 'X') > 76.5 && rig.control.snapshot().run == RunState::Running
        });
        rig.event("key NC_STOP tap");
        rig.seconds(0.4);
        let x = nominal(&rig, 'X');
        rig.seconds(0.2);
        assert_eq!(
            (nominal(&rig, 'X'), rig.control.snapshot().run),
            (x, RunState::Interrupted)
        );
        if internal {
            rig.command("stop");
        }
        rig.start();
        rig.until(20.0, "the end", |rig| rig.control.snapshot().ended);
        let q5 = rig
            .control
            .remember()
            .q
            .iter()
            .find(|(number, _)| *number == 5)
            .unwrap()
            .1;
        assert!((q5 - 80.0).abs() < 0.004, "{q5}");
    }
}

/// The software limit lies before the side: the way to the touch ends there, with its message at the block,
/// and not 20 mm (MP6130) behind [000:3522].
#[test]
fn the_software_limit_holds_while_probing() {
    let mut rig = rig_of(bench(&plc()).mp("910.0=76.5").mp("6130=20"), PROGRAM);
    rig.start();
    let mut farthest = f64::MIN;
    rig.until(20.0, "the message", |rig| !rig.messages().is_empty());
    for _ in 0..200 {
        farthest = farthest.max(nominal(&rig, 'X'));
        rig.cycle();
    }
    assert_eq!(rig.messages(), ["LIMIT SWITCH X+"]);
    let block = rig.control.shown()[0].block.map(|block| block.block);
    assert_eq!((block, rig.control.run_state()), (Some(2), RunState::Interrupted));
    near(farthest, 76.5);
    rig.seconds(0.1);
    assert!(!rig.bit("M2503") && rig.bit("M2026"), "the probing is over");
}

/// M2502: a stylus that is deflected stops the machine, also where nothing probes; the program goes on when it
/// is free. Without M2502, and with a TS 511 (MP6010 = 1), it goes unnoticed [000:7652].
#[test]
fn a_deflected_stylus_stops_the_machine() {
    let guarded = || bench(&format!("{}\n       L     I21\n       = M2502", plc()));
    let program = "L Z-20 R0 F6000\nL X+70 R0 F6000\nL X+90 R0 F600";
    let mut rig = rig_of(guarded(), program);
    rig.event("key B press");
    rig.start();
    rig.until(20.0, "the stop", |rig| {
        rig.control.run_state() == RunState::Interrupted
    });
    rig.seconds(0.5);
    let x = nominal(&rig, 'X');
    // The ball of 2 mm touches at 78; from 600 mm/min the axis brakes within 0.1 mm.
    assert!((78.0..78.2).contains(&x), "{x}");
    rig.start();
    rig.seconds(0.5);
    near(nominal(&rig, 'X'), x);
    rig.event("probe remove");
    rig.seconds(0.1);
    rig.start();
    rig.until(20.0, "the end", |rig| rig.control.has_ended());
    near(nominal(&rig, 'X'), 90.0);

    let mut unguarded = rig_of(guarded(), program);
    unguarded.start();
    unguarded.until(20.0, "the end", |rig| rig.control.has_ended());
    let mut standby = rig_of(guarded().mp("6010=1"), program);
    standby.event("key B press");
    standby.start();
    standby.until(20.0, "the end", |rig| rig.control.has_ended());
}

/// While M2502 is set nothing is faster than MP6150, whatever is programmed and whoever moves the axis: feed, rapid
/// traverse, the probing itself (MP6120), the return to the contour (MP4220) [000:7654]. Without M2502 the feed is
/// the programmed one.
#[test]
fn a_guarded_probe_limits_every_feed() {
    let plc = format!("{}\n       L     I21\n       = M2502", plc());
    let program = format!("L Z-20 R0 F6000\nL X+70 F6000\nL X+30 FMAX\n{PROGRAM}");
    let build = |program: &str| {
        rig_of(
            bench(&plc)
                .mp("6150=600")
                .mp("6120=3000")
                .mp("7680=%0000110")
                .mp("4220.0=2000"),
            program,
        )
    };
    let fastest = |rig: &mut Rig, until: &dyn Fn(&Rig) -> bool| {
        let axes = ['X', 'Y', 'Z'];
        let mut fastest = 0.0f64;
        let end = rig.control.time_us() + 60_000_000;
        while !until(rig) {
            assert!(rig.control.time_us() < end, "{:?}", rig.control.snapshot());
            let before = axes.map(|axis| nominal(rig, axis));
            rig.cycle();
            for (axis, before) in axes.iter().zip(before) {
                fastest = fastest.max((nominal(rig, *axis) - before).abs() / 0.003 * 60.0);
            }
        }
        fastest
    };
    for guarded in [true, false] {
        let mut rig = build(&program);
        if guarded {
            rig.event("key B press");
        }
        rig.start();
        rig.seconds(0.1);
        let speed = fastest(&mut rig, &|rig| rig.control.has_ended());
        let right = if guarded {
            (speed - 600.0).abs() < 1.0
        } else {
            speed > 6000.0
        };
        assert!(right, "{speed} with M2502 = {guarded}");
    }
    let mut rig = build("L X+70 R0 F6000\nL X+30\nL X+20");
    rig.event("key B press");
    rig.command("restore-at 3");
    rig.seconds(0.3);
    rig.command("restore-position");
    rig.start();
    let speed = fastest(&mut rig, &|rig| (nominal(rig, 'X') - 30.0).abs() < 1e-6);
    assert!((speed - 600.0).abs() < 1.0, "{speed}");
}

/// On the way to the surface the probing is interrupted, and the operator leads the axes away: RESTORE POSITION and NC start bring
/// them back to where the probing was, not to its start, and the next NC start goes on from there. No axis is commanded
/// faster than its rapid traverse of 20 m/min.
#[test]
fn an_interrupted_probing_goes_on_where_it_was() {
    let mut rig = rig_of(bench(&plc_by_hand()).mp("7680=%0000010"), PROGRAM);
    rig.start();
    rig.until(10.0, "it searches", |rig| nominal(rig, 'X') > 76.0);
    rig.event("key NC_STOP tap");
    rig.seconds(0.5);
    let place = |rig: &Rig| ['X', 'Z'].map(|letter| nominal(rig, letter));
    let left = place(&rig);
    let mut before = left;
    let mut follow = |rig: &mut Rig, seconds: f64| {
        for _ in 0..(seconds / 0.003) as u32 {
            rig.cycle();
            let now = place(rig);
            let way = (now[0] - before[0]).abs().max((now[1] - before[1]).abs());
            assert!(
                way <= 20_000.0 / 60.0 * 0.003,
                "a jump from {before:?} to {now:?}"
            );
            before = now;
        }
    };
    rig.command("manual-operation");
    rig.event("key B press");
    follow(&mut rig, 0.5);
    rig.event("key B release");
    follow(&mut rig, 0.5);
    assert!(place(&rig)[1] > left[1] + 5.0, "{left:?} {:?}", place(&rig));
    rig.command("restore-position");
    rig.start();
    follow(&mut rig, 3.0);
    assert_eq!(place(&rig), left);
    rig.start();
    follow(&mut rig, 0.75);
    // The end of the program clears it.
    let q5 = |rig: &Rig| {
        let remembered = rig.control.remember().q;
        let found = remembered.iter().find(|(number, _)| *number == 5);
        found.map(|(_, value)| *value)
    };
    rig.until(20.0, "the touch", |rig| q5(rig).is_some());
    assert!((q5(&rig).unwrap() - 80.0).abs() < 0.004, "{:?}", q5(&rig));
    rig.until(20.0, "the end", |rig| rig.control.snapshot().ended);
    assert_eq!(rig.messages(), [""; 0]);
}
