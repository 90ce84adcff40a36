//! The same setup, machine and commands give the same bits; a recorded log repeats a run.

#![allow(clippy::unwrap_used, reason = "a test may fail")]

mod support;

use bahn_tnc::{Command, Signal};
use support::*;

const PROGRAM: &str = "TOOL CALL 1 Z S1000\nL X+200 Y+100 Z+200 R0 FMAX M3\nL X+250 F2000 M8\nCC X+250 Y+150\n\
                       C X+250 Y+200 DR+\nTOOL CALL 2 Z S3000\nL Z+250 FMAX M5";

fn build() -> Rig {
    Build::mill().program("1.H", PROGRAM).rig()
}

/// A hash over the bits of what can be observed, cycle by cycle.
struct Trail {
    signals: Vec<Signal>,
    hash: u64,
}

impl Trail {
    fn new() -> Trail {
        let names = [
            "X.actual",
            "Y.actual",
            "Z.actual",
            "C.actual",
            "X.lag",
            "Y.volts",
            "Z.speed",
            "S.rpm",
            "S.volts",
            "path.speed",
            "path.block",
            "W256",
            "W260",
            "M2045",
            "M2046",
            "M2482",
            "O13",
            "D356",
        ];
        Trail {
            signals: names.iter().map(|name| name.parse().unwrap()).collect(),
            hash: 0xcbf2_9ce4_8422_2325,
        }
    }

    fn take(&mut self, rig: &Rig) {
        for signal in &self.signals {
            for byte in rig.control.observe(signal).to_bits().to_le_bytes() {
                self.hash = (self.hash ^ u64::from(byte)).wrapping_mul(0x0100_0000_01b3);
            }
        }
    }
}

/// Runs with keys and commands at fixed times; the hash of everything.
fn scripted(seconds: u64) -> (u64, Vec<(u64, usize, Command)>) {
    let mut rig = build();
    rig.control.keep_command_log();
    let mut trail = Trail::new();
    let events: &[(u64, &str)] = &[
        (100, "ce"),
        (2_000, "key NC_START tap"),
        (9_000, "mode full"),
        (9_100, "select 1.H"),
        (9_200, "key NC_START tap"),
        (11_000, "override feed 40"),
        (12_000, "key NC_STOP tap"),
        (13_000, "key NC_START tap"),
        (14_000, "override feed 120"),
    ];
    let mut events = events.iter().peekable();
    for millisecond in (0..seconds * 1000).step_by(3) {
        while let Some((_, text)) = events.next_if(|(at, _)| *at <= millisecond) {
            match text.parse::<Command>() {
                Ok(command) => {
                    rig.control.command(command);
                }
                Err(_) => rig.event(text),
            }
        }
        rig.cycle();
        trail.take(&rig);
    }
    assert!(
        rig.control.snapshot().ended,
        "{:?} {:?}",
        rig.messages(),
        rig.control.snapshot()
    );
    (trail.hash, rig.control.take_command_log().unwrap())
}

/// The number goes into the file of BAHN_TRAIL, too: `make test` compares those of debug and release builds.
#[test]
fn twice_the_same_bits() {
    let (hash, _) = scripted(60);
    assert_eq!(hash, scripted(60).0);
    if let Some(file) = std::env::var_os("BAHN_TRAIL") {
        std::fs::write(file, format!("{hash:016x}\n")).unwrap();
    }
}

#[test]
fn the_log_has_the_commands_with_their_times() {
    let log = scripted(60).1;
    let texts: Vec<String> = log
        .iter()
        .map(|(at, _, command)| format!("{} {command}", at / 1000))
        .collect();
    assert_eq!(texts, ["102 ce", "9000 mode full", "9102 select 1.H"]);
}
