//! Synchronized axes: the 4th axis V is the slave of X [000:4451-4539].

use crate::support::bench::*;
use crate::support::*;
use bahn_tnc::Mode;

fn gantry(more: &str) -> Build {
    bench("")
        .with(&fourth('V', more))
        .mps("10=15 50=15 410.3=4 960.3=-100 850.3=1 855.3=0.5 860.3=0 1340.0=1 1340.1=2 1340.2=3 1340.3=0")
}

/// The slave moves with its master, by keys and in a program; its own key does nothing; M2131 and M2163 are
/// not set for it [000:4519-4539].
#[test]
fn the_slave_follows() {
    let mut rig = gantry("").program("1.H", "L X+20 Y+20 R0 F3000\nL X+120").ready();
    close(rig.table('V'), rig.table('X'), 0.001);
    rig.event("key RAPID press");
    rig.event("key X- press");
    let mut apart: f64 = 0.0;
    for _ in 0..200 {
        rig.cycle();
        apart = apart.max((rig.table('X') - rig.table('V')).abs());
    }
    assert!(rig.speed('V') < -5900.0);
    assert!(apart < 0.05, "{apart}");
    assert!(rig.bit("M2160") && !rig.bit("M2163"));
    rig.event("key X- release");
    rig.event("key IV+ press");
    rig.seconds(0.5);
    close(rig.speed('V'), 0.0, 1.0);
    rig.event("key IV+ release");
    rig.command("mode full");
    rig.command("select 1.H");
    rig.start();
    rig.until(10.0, "X moves up", |rig| rig.speed('X') > 2000.0);
    assert!(rig.bit("M2128") && !rig.bit("M2131"));
    rig.until(20.0, "the end", |rig| rig.control.snapshot().ended);
    rig.settle();
    close(rig.table('V'), 120.0, 0.01);
    close(rig.axis('V').machine, rig.axis('X').machine, 0.005);
    assert_eq!(rig.messages(), [""; 0]);
}

/// The nominal value displayed for the slave axis indicates the nominal value of the master axis [000:4523], wherever the
/// datum of the slave lies.
#[test]
fn the_nominal_value_of_the_slave_is_that_of_its_master() {
    let mut rig = gantry("").ready();
    for datum in ["datum X 30", "datum V 500"] {
        rig.control.command(datum.parse().unwrap());
    }
    rig.event("key RAPID press");
    rig.event("key X- press");
    rig.seconds(0.4);
    let [master, slave] = ['X', 'V'].map(|letter| rig.axis(letter).nominal);
    assert!(master < 30.0, "{master}");
    assert_eq!(slave, master);
}

/// The slave cannot be moved independently [000:4519], by a program neither; nor can an axis of the PLC (MP60).
#[test]
fn no_program_moves_the_slave() {
    for (build, reason) in [
        (gantry(""), "V follows its master (MP850)"),
        (
            gantry("").mps("850.3=0 60=%01000"),
            "the PLC alone moves V (MP60)",
        ),
    ] {
        let program = "L X+60 Y+60 R0 F3000\nL X+70 V+80\nL X+90";
        let mut rig = build.program("1.H", program).ready();
        rig.command("mode full");
        rig.command("select 1.H");
        rig.start();
        rig.until(20.0, "the message", |rig| !rig.messages().is_empty());
        let message = &rig.messages()[0];
        assert!(
            message.starts_with("WRONG AXIS PROGRAMMED")
                && message.contains("block 2")
                && message.contains(reason),
            "{message}"
        );
        rig.settle();
        close(rig.axis('X').machine, 60.0, 0.005);
    }
}

/// A block scan leads the master back to the contour, and the slave beside it.
#[test]
fn the_slave_returns_to_the_contour() {
    let program = "L X+60 Y+60 R0 F3000\nL X+100\nL Y+80\nL X+120";
    let mut rig = gantry("").mps("7680=6").program("1.H", program).ready();
    rig.command("mode full");
    rig.command("select 1.H");
    rig.command("restore-at 4");
    rig.seconds(0.5);
    rig.command("restore-position");
    rig.seconds(0.1);
    assert!(rig.bit("M2019"));
    rig.start();
    rig.until(10.0, "the contour", |rig| !rig.bit("M2019"));
    close(rig.axis('X').machine, 100.0, 0.005);
    close(rig.table('V'), rig.table('X'), 0.01);
    rig.start();
    rig.until(10.0, "the end", |rig| rig.control.snapshot().ended);
    rig.settle();
    close(rig.axis('X').machine, 120.0, 0.005);
    close(rig.table('V'), rig.table('X'), 0.01);
    assert_eq!(rig.messages(), [""; 0]);
}

/// MP860 = 0: the positions at switch-on are synchronous, only the master has a mark [000:4492-4496].
#[test]
fn the_master_alone_passes_its_mark() {
    let mut rig = gantry("")
        .plant(
            "start = 50\nreference_cam = { range = [180, 200], input = \"I4\" }",
            "start = 50.3\nreference_cam = { range = [180, 200], input = \"I4\" }",
        )
        .rig();
    rig.until(5.0, "the reference run is asked for", |rig| {
        rig.control.snapshot().mode == Mode::Reference
    });
    rig.scan();
    assert!(rig.bit("M2136") && rig.bit("M2139"));
    rig.power_on();
    rig.settle();
    assert!(!rig.bit("M2139"));
    // The 0.3 mm at switch-on are how they belong together.
    close(rig.table('V') - rig.table('X'), 0.3, 0.005);
    close(rig.axis('V').machine, rig.axis('X').machine, 0.005);
    assert_eq!(rig.messages(), [""; 0]);
}

/// MP860 = 1: both cross their marks and have the same value there; the slave drives out what is left
/// [000:4497-4504].
#[test]
fn both_pass_their_marks() {
    let mut rig = gantry("")
        .mps("860.3=1")
        .plant(
            "start = 50\nreference_cam = { range = [180, 200], input = \"I4\" }",
            "start = 52\nreference_cam = { range = [180, 200], input = \"I4\" }",
        )
        .rig();
    rig.power_on();
    rig.settle();
    assert_eq!(rig.messages(), [""; 0]);
    for letter in ['X', 'V'] {
        assert!(rig.axis(letter).referenced);
        close(rig.machine_position(letter), rig.table(letter), 0.005);
    }
    close(rig.table('V'), rig.table('X'), 0.01);
}

/// The slave's mark comes after the master's: the master goes on until it is found.
#[test]
fn the_mark_of_the_slave_comes_later() {
    let mut rig = gantry("")
        .mps("860.3=1")
        .plant(
            "start = 50\nreference_cam = { range = [180, 200], input = \"I4\" }",
            "start = 46\nreference_cam = { range = [180, 200], input = \"I4\" }",
        )
        .rig();
    rig.power_on();
    rig.settle();
    assert_eq!(rig.messages(), [""; 0]);
    assert!(rig.table('X') > 104.0, "{}", rig.table('X'));
    close(rig.table('V'), rig.table('X'), 0.01);
    close(rig.machine_position('V'), rig.table('V'), 0.005);
}

/// Farther apart than MP855 = 0.5 mm: flashing GROSS POSITIONING ERROR of the slave, A [000:4490]; the
/// difference shows as its lag.
#[test]
fn apart() {
    let mut rig = gantry("brake = 1")
        .mps("1140.0=10 1140.3=10 1110.0=30 1110.3=30 1710.3=30 1720.3=30")
        .ready();
    rig.event("key X- press");
    rig.seconds(0.3);
    rig.event("fault drive V dead");
    rig.until(1.0, "the difference is seen", |rig| !rig.messages().is_empty());
    assert_eq!(rig.messages(), ["GROSS POSITIONING ERROR V A"]);
    close(rig.axis('V').lag.abs(), 0.5, 0.1);
    rig.settle();
    close(rig.speed('X'), 0.0, 1.0);
    assert!(rig.control.snapshot().messages[0].flashing);
}

/// EMERGENCY STOP and on again: still together.
#[test]
fn after_an_emergency_stop() {
    let mut rig = gantry("").ready();
    rig.event("key X- press");
    rig.seconds(0.3);
    rig.event("emergency press");
    rig.event("key X- release");
    rig.seconds(0.5);
    rig.event("emergency release");
    rig.seconds(0.2);
    rig.command("ce");
    rig.settle();
    rig.event("key X- press");
    rig.seconds(0.5);
    rig.event("key X- release");
    rig.settle();
    assert_eq!(rig.messages(), [""; 0]);
    close(rig.table('V'), rig.table('X'), 0.01);
}

/// MP1350 = 2 for both, with one end position switch: the master's marker leads, each takes the first pulse
/// after it [000:4502-4504].
#[test]
fn one_end_position_switch() {
    let mut rig = gantry("")
        .mps("860.3=1 1350.0=2 1350.3=2 1331.0=300 960.0=-170 960.3=-170 910.0=190")
        .plant(
            "input = \"X1\"\nperiod_um = 20\nmark = 100",
            "input = \"X1\"\nperiod_um = 20\nmarks_every = 10\nmarks_from = 0",
        )
        .plant(
            "input = \"X4\"\nperiod_um = 20\nmark = 100",
            "input = \"X4\"\nperiod_um = 20\nmarks_every = 10\nmarks_from = 0",
        )
        .plant(
            "start = 50\nreference_cam = { range = [180, 200], input = \"I4\" }",
            "start = 49.6\nreference_cam = { range = [180, 200], input = \"I4\" }",
        )
        .rig();
    rig.power_on();
    rig.settle();
    assert_eq!(rig.messages(), [""; 0]);
    for letter in ['X', 'V'] {
        close(rig.machine_position(letter), rig.table(letter), 0.005);
    }
    close(rig.table('V'), rig.table('X'), 0.01);
}

/// Whatever keys, overrides, stops and EMERGENCY STOPs come in whatever order: master and slave stay
/// together, and at the end the master can be moved with its slave.
#[test]
fn together_whatever_comes() {
    const EVENTS: [&str; 16] = [
        "key X- press",
        "key X- release",
        "key X+ press",
        "key X+ release",
        "key RAPID press",
        "key RAPID release",
        "key NC_STOP tap",
        "key NC_START tap",
        "key NO_FEED press",
        "key NO_FEED release",
        "key IV+ press",
        "key IV+ release",
        "emergency press",
        "emergency release",
        "override feed 30",
        "override feed 120",
    ];
    const COMMANDS: [&str; 7] = [
        "ce",
        "mode manual",
        "mode handwheel",
        "mode full",
        "mode mdi",
        "stop",
        "mdi L X+60 F3000",
    ];
    for seed in 1..=8u64 {
        let mut rig = gantry("")
            .plant("[axis.X]", "[axis.X]\nbrake = 1")
            .plant("[axis.V]", "[axis.V]\nbrake = 1")
            .ready();
        let mut dice = seed;
        let mut next = |below: u64| {
            dice = dice
                .wrapping_mul(6_364_136_223_846_793_005)
                .wrapping_add(1_442_695_040_888_963_407);
            (dice >> 33) % below
        };
        for _ in 0..150 {
            if next(4) == 0 {
                let command = COMMANDS[next(COMMANDS.len() as u64) as usize];
                rig.control.command(command.parse().unwrap());
            } else {
                rig.event(EVENTS[next(EVENTS.len() as u64) as usize]);
            }
            rig.seconds(next(20) as f64 / 40.0);
            let apart = (rig.table('X') - rig.table('V')).abs();
            assert!(apart < 0.3, "seed {seed}: {apart} {:?}", rig.messages());
            assert!(
                !rig.control.snapshot().messages.iter().any(|shown| shown.flashing),
                "seed {seed}: {:?}",
                rig.messages()
            );
        }
        for event in EVENTS.iter().filter(|event| event.ends_with("release")) {
            rig.event(event);
        }
        rig.settle();
        for _ in 0..6 {
            rig.control.command("ce".parse().unwrap());
            rig.seconds(0.1);
        }
        rig.control.command("stop".parse().unwrap());
        rig.control.command("mode manual".parse().unwrap());
        rig.control.command("ce".parse().unwrap());
        rig.control.command("ce".parse().unwrap());
        rig.settle();
        let key = if rig.table('X') > 100.0 { "X-" } else { "X+" };
        rig.event(&format!("key {key} press"));
        rig.seconds(0.5);
        assert!(
            rig.speed('X').abs() > 300.0,
            "seed {seed}: {:?} {:?}",
            rig.messages(),
            rig.control.snapshot()
        );
        close(rig.speed('V'), rig.speed('X'), 5.0);
    }
}
