//! PNT: in POSITIONING WITH MDI the machine moves in the direction in which the stylus of a TM 110 is deflected
//! [000:7907].

use crate::stand::*;
use crate::support::*;
use bahn_servo::Plant;
use bahn_tnc::{Command, RunState};

/// Of the bench: MP6310, mm, and MP6360, mm/min.
const DEPTH: f64 = 0.5;
const FEED: f64 = 600.0;
/// 4 N deflect the stylus of a TM 110 by 1 mm [000:7919].
const NEWTON_PER_MM: f64 = 4.0;

/// A bench whose probe is a TM 110, in POSITIONING WITH MDI, all axes at 50; contact A takes the feed enable of X away.
fn rig_of(mounting: &str, parameters: &[&str]) -> Rig {
    let plc = format!(
        "{ACKNOWLEDGE}       L     I20\n       =     M2467\n       =N    M2451\n       L     M2719\n       S     M2502"
    );
    let build = bench(&plc).plant(
        "radius = 2\n",
        &format!("radius = 2\nmeasuring = true\n{mounting}\n"),
    );
    let usual = [
        "6200=1",
        "6310=0.5",
        "6330=2",
        "6350=200",
        "6360=600",
        "6361=3000",
    ];
    let build = usual
        .iter()
        .chain(parameters)
        .fold(build, |build, mp| build.mp(mp));
    let mut rig = ready(build.program("1.H", "L X+50 R0 F1000"));
    rig.command("mode mdi");
    rig.event("probe insert");
    rig
}

fn rig() -> Rig {
    rig_of("", &[])
}

/// Pushes the stylus so that it is deflected by a way, mm.
fn push(rig: &mut Rig, axis: char, mm: f64) {
    rig.event(&format!("probe push {axis} {}", mm * NEWTON_PER_MM));
}

fn speeds(rig: &Rig) -> [f64; 3] {
    ['X', 'Y', 'Z'].map(|letter| {
        let signal = format!("{letter}.speed").parse().expect("a signal");
        rig.control.observe(&signal)
    })
}

fn moves_at(rig: &Rig, expected: [f64; 3]) {
    for (speed, expected) in speeds(rig).into_iter().zip(expected) {
        assert!(
            (speed - expected).abs() < 0.02 * FEED,
            "{:?} is not {expected}",
            speeds(rig)
        );
    }
}

fn stands(rig: &Rig) {
    assert!(
        speeds(rig).iter().all(|speed| speed.abs() < 1.0),
        "{:?}",
        speeds(rig)
    );
}

fn refused(rig: &mut Rig, command: &str) {
    let command: Command = command.parse().expect("a command");
    assert!(!rig.control.command(command), "{:?}", rig.messages());
}

/// The machine moves in the direction in which the stylus is deflected, however the probe is mounted when MP6320 and MP6322
/// say so; without PNT it does not, and it stands when nobody pushes.
#[test]
fn the_machine_moves_in_the_direction_of_the_deflection() {
    for (mounting, parameters) in [
        ("", &[][..]),
        // Its X counts along -Y of the machine, its Y along Z, its Z along X.
        (
            "mounting = [-2, 3, 1]",
            &["6320=%010", "6322.0=2", "6322.1=0", "6322.2=1"],
        ),
    ] {
        let mut rig = rig_of(mounting, parameters);
        rig.seconds(0.5);
        rig.command("pnt on");
        rig.seconds(0.5);
        stands(&rig);
        for (axis, place, sign) in [('X', 0, 1.0), ('Y', 1, -1.0), ('Z', 2, 1.0)] {
            push(&mut rig, axis, sign * DEPTH);
            rig.seconds(0.5);
            let mut expected = [0.0; 3];
            expected[place] = sign * FEED;
            moves_at(&rig, expected);
            push(&mut rig, axis, 0.0);
            rig.seconds(0.5);
            stands(&rig);
        }
        // 10 mm/s for half a second in each, but for the ramps.
        near_by(display(&rig, 'X'), 55.0);
        near_by(display(&rig, 'Y'), 45.0);
        near_by(display(&rig, 'Z'), 55.0);
        rig.command("pnt off");
        let at = display(&rig, 'X');
        push(&mut rig, 'X', DEPTH);
        rig.seconds(0.5);
        near(display(&rig, 'X'), at);
        assert_eq!(rig.messages(), [""; 0]);
    }
}

fn near_by(actual: f64, expected: f64) {
    assert!((actual - expected).abs() < 0.2, "{actual} is not {expected}");
}

/// A probe that counts the other way leads the machine against the push: MP6320 is to be changed [000:7907].
#[test]
fn a_wrong_counting_direction_shows() {
    let mut rig = rig_of("", &["6320=%001"]);
    rig.command("pnt on");
    push(&mut rig, 'X', DEPTH);
    rig.seconds(0.5);
    moves_at(&rig, [-FEED, 0.0, 0.0]);
}

/// Half as deep it goes half as fast, deeper no faster; aslant as fast along the way as straight; the override acts; a stylus
/// that is hardly deflected leads nothing.
#[test]
fn the_feed_follows_the_depth() {
    let mut rig = rig();
    rig.command("pnt on");
    for (mm, percent, expected) in [
        (DEPTH / 2.0, 100, FEED / 2.0),
        (DEPTH, 100, FEED),
        (3.0 * DEPTH, 100, FEED),
        (DEPTH, 50, FEED / 2.0),
        (0.09, 100, 0.0),
    ] {
        rig.event(&format!("override feed {percent}"));
        push(&mut rig, 'X', mm);
        rig.seconds(0.3);
        moves_at(&rig, [expected, 0.0, 0.0]);
    }
    // Three and four parts of five.
    push(&mut rig, 'X', 3.0 / 5.0);
    push(&mut rig, 'Y', 4.0 / 5.0);
    rig.seconds(0.3);
    moves_at(&rig, [FEED * 3.0 / 5.0, FEED * 4.0 / 5.0, 0.0]);
}

/// It takes the ways of all movements by hand: a software limit stops it with its message, without feed enable it stands.
#[test]
fn limits_and_feed_enable_count() {
    // X stands at 50 of the display, at 2 mm of the machine less: the limit is 3 mm farther.
    let mut rig = rig_of("", &[]);
    let limit = rig.machine_position('X') + 3.0;
    rig.command(&format!("axis-limit X 1 -400 {limit}"));
    rig.command("pnt on");
    push(&mut rig, 'X', DEPTH);
    rig.seconds(1.0);
    assert_eq!(rig.messages(), ["LIMIT SWITCH X+"]);
    near(rig.machine_position('X'), limit);
    push(&mut rig, 'X', -DEPTH);
    rig.seconds(0.3);
    moves_at(&rig, [-FEED, 0.0, 0.0]);
    assert_eq!(rig.messages(), [""; 0], "it goes as the axis leaves it");
    rig.event("key A press");
    rig.seconds(0.3);
    stands(&rig);
    rig.event("key A release");
    rig.seconds(0.3);
    moves_at(&rig, [-FEED, 0.0, 0.0]);
}

/// NC stop, EMERGENCY STOP, another operating mode, changed machine parameters and the key itself end it on the ramp of the
/// axes; nothing moves when they have passed.
#[test]
fn what_stops_axes_ends_it() {
    type Action = fn(&mut Rig);
    let ways: [(&str, Action); 5] = [
        ("the key", |rig| rig.command("pnt off")),
        ("NC stop", |rig| rig.event("key NC_STOP tap")),
        ("mode", |rig| rig.command("mode manual")),
        ("parameters", |rig| rig.command("MP6360=500")),
        ("EMERGENCY STOP", |rig| {
            rig.event("emergency press");
            rig.seconds(0.5);
            rig.event("emergency release");
            rig.seconds(0.5);
            rig.command("ce");
        }),
    ];
    for (name, action) in ways {
        let mut rig = rig();
        rig.command("pnt on");
        push(&mut rig, 'X', DEPTH);
        rig.seconds(0.5);
        moves_at(&rig, [FEED, 0.0, 0.0]);
        action(&mut rig);
        rig.seconds(0.5);
        stands(&rig);
        assert!(!rig.control.first().follows_stylus(), "{name}");
        let at = display(&rig, 'X');
        rig.seconds(0.5);
        near(display(&rig, 'X'), at);
    }
}

/// Farther than MP6330 deflected, or a probe that fails: the message of the probe, and the axes stand [000:7917].
#[test]
fn the_probe_ends_it() {
    type Action = fn(&mut Rig);
    let faults: [(&str, Action); 2] = [
        ("STYLUS DEFLECTION EXCEEDS MAX", |rig| push(rig, 'X', 2.5)),
        ("PROBE SYSTEM NOT READY", |rig| rig.event("fault probe not-ready")),
    ];
    for (message, fails) in faults {
        let mut rig = rig();
        rig.command("pnt on");
        push(&mut rig, 'X', DEPTH);
        rig.seconds(0.5);
        fails(&mut rig);
        rig.seconds(0.5);
        assert!(rig.messages()[0].starts_with(message), "{:?}", rig.messages());
        stands(&rig);
        assert!(!rig.control.first().follows_stylus());
    }
}

/// It is of POSITIONING WITH MDI, with a measuring probe, while no block runs; direction keys and NC start do nothing then,
/// and the next block goes from where the stylus has led the axes.
#[test]
fn where_it_can_be_chosen() {
    let mut rig = rig_of("", &["6200=0"]);
    refused(&mut rig, "pnt on");
    let mut rig = self::rig();
    refused(&mut rig, "pnt off");
    for mode in ["manual", "handwheel", "single", "full"] {
        rig.command(&format!("mode {mode}"));
        refused(&mut rig, "pnt on");
    }
    rig.command("mode mdi");
    rig.command("mdi L IX+2 R0 F1000");
    rig.command("pnt on");
    push(&mut rig, 'X', DEPTH);
    rig.seconds(0.5);
    push(&mut rig, 'X', 0.0);
    rig.seconds(0.5);
    let at = nominal(&rig, 'X');
    rig.start();
    rig.seconds(0.5);
    near(nominal(&rig, 'X'), at);
    rig.command("pnt off");
    rig.start();
    rig.until(1.0, "the block runs", |rig| {
        rig.control.snapshot().run == RunState::Running
    });
    refused(&mut rig, "pnt on");
    rig.until(5.0, "the block ends", |rig| rig.control.snapshot().ended);
    near(nominal(&rig, 'X'), at + 2.0);
}

/// No cycle allocates.
#[test]
fn no_cycle_of_it_allocates() {
    let mut rig = rig();
    rig.command("pnt on");
    rig.cycle();
    push(&mut rig, 'X', DEPTH);
    for _ in 0..200 {
        rig.control.prepare();
        let (control, machine) = (&mut rig.control, &mut rig.machine);
        let allocated = allocation_counter::measure(|| control.cycle(machine as &mut dyn Plant));
        assert_eq!(allocated.count_total, 0);
    }
    moves_at(&rig, [FEED, 0.0, 0.0]);
}
