//! Deterministic simulation with faults: random keys, commands, overrides and faults of the machine in any
//! order. Whatever comes, nothing panics, positions stay numbers, voltages stay within 10 V; without faults no
//! axis passes its software limits, and after EMERGENCY STOP all comes to rest.

use crate::support::*;
use bahn_tnc::{Command, Mode};

/// A generator of its own, so that every run is the same: xorshift.
struct Dice(u64);

impl Dice {
    fn next(&mut self, below: usize) -> usize {
        self.0 ^= self.0 << 13;
        self.0 ^= self.0 >> 7;
        self.0 ^= self.0 << 17;
        (self.0 >> 11) as usize % below
    }

    fn pick<'a>(&mut self, from: &[&'a str]) -> &'a str {
        from[self.next(from.len())]
    }
}

const KEYS: &[&str] = &[
    "X-",
    "X+",
    "Y-",
    "Y+",
    "Z-",
    "Z+",
    "IV-",
    "IV+",
    "NC_START",
    "NC_START",
    "NC_STOP",
    "RAPID",
    "LATCH",
    "SPINDLE_ON",
    "SPINDLE_OFF",
    "COOLANT",
    "CONFIRM",
    "TOOL_RELEASE",
    "LUBRICATE",
];

const COMMANDS: &[&str] = &[
    "mode manual",
    "mode handwheel",
    "mode mdi",
    "mode single",
    "mode full",
    "mode full",
    "mode reference",
    "ce",
    "ce",
    "stop",
    "select 1.H",
    "select 2.H",
    "select 9.H",
    "goto 3",
    "mdi L X+100 Y+50 R0 FMAX",
    "mdi L IX+1000 R0 FMAX",
    "m 3",
    "s 2000",
    "datum X 10",
    "datum Z -3.5",
    "jog 1",
    "handwheel X 3",
    "handwheel Z 0",
    "manual-operation",
    "restore-position",
    "restore-at 4",
    "code 75368",
    "offset adjust",
    "key 107",
];

const FAULTS: &[&str] = &[
    "fault encoder X stuck",
    "fault encoder Y amplitude",
    "fault encoder Z edges",
    "fault drive X dead",
    "fault drive Y runaway",
    "fault drive Z reversed",
    "fault offset X 0.2",
    "fault input I10 0",
    "fault input I5 0",
    "fault device table_clamp jammed",
    "fault device gear jammed",
    "fault relay slow 200",
    "emergency press",
    "emergency release",
    "voltage off",
    "voltage on",
    "force X 4000",
    "force X 0",
    "switch door open",
    "switch door closed",
];

fn build() -> Rig {
    Build::mill()
        .program(
            "1.H",
            "TOOL CALL 1 Z S1000\nL X+200 Y+100 Z+200 R0 FMAX M3\nL X+250 F2000 M8\nCC X+250 Y+150\nC X+250 Y+200 DR+\n\
             TOOL CALL 2 Z S4000\nL C+90 FMAX M11\nL Z+250 FMAX M5\nM2",
        )
        .program(
            "2.H",
            "FN 0: Q1 = +0\nLBL 1\nFN 1: Q1 = +Q1 + +1\nL X+100 Y+Q1 Z+150 R0 F3000\nL X+150\nFN 12: IF +Q1 LT +20 GOTO LBL 1\n\
             STOP\nL Z+200 FMAX\nL M19",
        )
        .rig()
}

/// One random thing.
fn happens(dice: &mut Dice, faults: bool) -> String {
    match dice.next(if faults { 12 } else { 10 }) {
        0..=3 => {
            let action = dice.pick(&["press", "release", "release", "tap", "tap"]);
            format!("key {} {action}", dice.pick(KEYS))
        }
        4..=7 => dice.pick(COMMANDS).to_owned(),
        8 => format!("override {} {}", dice.pick(&["feed", "spindle"]), dice.next(151)),
        9 => format!("handwheel {}", dice.next(4000) as i64 - 2000),
        _ => dice.pick(FAULTS).to_owned(),
    }
}

/// Lives through `events` random things, and gives what happened last with a word on the state.
fn live(seed: u64, events: usize, faults: bool) -> Rig {
    let mut dice = Dice(seed.wrapping_mul(0x9e37_79b9_7f4a_7c15) | 1);
    let mut rig = build();
    rig.seconds(0.1);
    if dice.next(4) > 0 {
        rig.power_on();
    }
    let mut history = Vec::new();
    for _ in 0..events {
        let what = happens(&mut dice, faults);
        history.push(format!("{} {what}", rig.control.time_us() / 1000));
        match what.parse::<Command>() {
            Ok(command) => {
                rig.control.command(command);
            }
            Err(_) => {
                let _ = rig.machine.apply(&what);
            }
        }
        for _ in 0..dice.next(200) {
            rig.cycle();
            check(&rig, seed, &history, faults);
        }
    }
    rig
}

/// What holds at any time.
fn check(rig: &Rig, seed: u64, history: &[String], faults: bool) {
    let fail = |what: String| -> ! {
        panic!(
            "seed {seed}: {what}\n{:?}\n{:?}\n{}",
            rig.messages(),
            rig.control.snapshot(),
            history
                .iter()
                .rev()
                .take(20)
                .cloned()
                .collect::<Vec<_>>()
                .join("\n")
        )
    };
    if !faults && rig.control.snapshot().messages.iter().any(|shown| shown.flashing) {
        fail("a flashing message".into());
    }
    for axis in rig.machine.axes() {
        if axis.volts.abs() > 10.0 {
            fail(format!("{} has {} V", axis.letter, axis.volts));
        }
    }
    let snapshot = rig.control.snapshot();
    for axis in &snapshot.axes {
        if !(axis.machine.is_finite() && axis.nominal.is_finite() && axis.lag.is_finite()) {
            fail(format!("{} is nowhere", axis.letter));
        }
        // Software limits hold whatever is asked for, once they are effective: X, Y, Z of the mill.
        let limits = match axis.letter {
            'X' => [-10.0, 610.0],
            'Y' => [-10.0, 410.0],
            'Z' => [-10.0, 460.0],
            _ => continue,
        };
        if !faults && axis.referenced && !(limits[0] - 0.5..=limits[1] + 0.5).contains(&axis.machine) {
            fail(format!(
                "{} is at {} beyond its limits",
                axis.letter, axis.machine
            ));
        }
    }
}

/// Without faults of the machine no flashing message comes, whatever is pressed.
#[test]
fn no_key_breaks_the_control() {
    for seed in 1..=40 {
        let rig = live(seed, 60, false);
        let flashing = rig.control.snapshot().messages.iter().any(|shown| shown.flashing);
        assert!(!flashing, "seed {seed}: {:?}", rig.messages());
    }
}

/// Whatever has failed, EMERGENCY STOP takes the power from all drives and the voltage from all outputs.
#[test]
fn no_fault_keeps_the_power_on() {
    for seed in 1..=40 {
        let mut rig = live(seed, 80, true);
        rig.event("emergency press");
        rig.seconds(4.0);
        for axis in rig.machine.axes() {
            assert!(
                !axis.powered && axis.volts == 0.0,
                "seed {seed}: {axis:?} {:?}",
                rig.messages()
            );
        }
        let spindle = rig.machine.spindle().unwrap();
        assert!(
            !spindle.powered && spindle.volts.abs() < 0.01,
            "seed {seed}: {spindle:?}"
        );
    }
}

/// After EMERGENCY STOP everything comes to rest, whatever went on.
#[test]
fn emergency_stop_brings_everything_to_rest() {
    for seed in 1..=25 {
        let mut rig = live(seed, 40, false);
        rig.event("emergency press");
        rig.seconds(4.0);
        for axis in rig.machine.axes() {
            assert!(
                axis.speed_per_min.abs() < 1.0,
                "seed {seed}: {} {:?}",
                axis.letter,
                rig.messages()
            );
        }
        let spindle = rig.machine.spindle().unwrap();
        assert!(spindle.volts.abs() < 0.01, "seed {seed}: spindle");
        assert!(
            rig.control.snapshot().axes.iter().all(|axis| !axis.closed),
            "seed {seed}"
        );
    }
}

/// After all of it the operator gets the machine back: release, CE, and it moves again.
#[test]
fn the_operator_gets_the_machine_back() {
    for seed in 1..=25 {
        let mut rig = live(seed, 40, false);
        for key in KEYS {
            let _ = rig.machine.apply(&format!("key {key} release"));
        }
        rig.event("override feed 100");
        rig.event("key NC_STOP tap");
        rig.seconds(3.0);
        for _ in 0..10 {
            rig.control.command("ce".parse().unwrap());
            rig.control.command("stop".parse().unwrap());
            rig.seconds(0.1);
        }
        if rig
            .messages()
            .iter()
            .any(|text| text == "EXTERNAL EMERGENCY STOP")
        {
            // Without reference marks an axis may stand on its limit switch: only a key of the builder helps.
            continue;
        }
        if rig.control.snapshot().mode == Mode::Reference {
            rig.start();
            rig.until(120.0, "all marks are passed", |rig| {
                rig.control.snapshot().mode == Mode::Manual
            });
        }
        rig.command("mode manual");
        let before = rig.machine_position('X');
        let key = if before > 300.0 { "X-" } else { "X+" };
        rig.event(&format!("key {key} press"));
        rig.seconds(1.0);
        let moved = (rig.machine_position('X') - before).abs();
        assert!(
            moved > 5.0,
            "seed {seed}: {moved} {:?} {:?}",
            rig.messages(),
            rig.control.snapshot()
        );
    }
}
