//! A session is recorded, and seen again on another machine of its kind.

use std::path::PathBuf;

use crate::support::Trainee;
use bahn_panel::{Ending, Replay, Screen, Station};

/// Moments that are compared.
const MOMENTS: u64 = 20;

/// What is to be seen; how many screens there were before depends on who looked.
fn seen(screen: &Screen) -> String {
    let screen = Screen {
        serial: 0,
        ..screen.clone()
    };
    serde_json::to_string(&screen).unwrap()
}

fn file(name: &str) -> PathBuf {
    let path = std::env::temp_dir().join(format!("bahn-session-{}-{name}", std::process::id()));
    let _ = std::fs::remove_file(&path);
    path
}

/// The reference run, a datum, wrong keys, an axis by hand, overrides, a fault, a run with a stop, and the past.
fn session(trainee: &mut Trainee) {
    trainee.ready();
    trainee.press("X").number("-12.5").press("ENT RL CE");
    trainee.give(r#"{"key":"Y+","down":true}"#).wait(0.7);
    trainee.give(r#"{"key":"Y+","down":false}"#).wait(0.5);
    trainee.press("FULL PGM_NR C I R C L E ENT NC_START").wait(2.0);
    trainee.give(r#"{"feed_override":42.5}"#).wait(1.0);
    trainee.give(r#"{"action":"switch door open"}"#).wait(2.0);
    trainee.give(r#"{"action":"switch door closed"}"#).wait(2.0);
    trainee.press("NC_START").wait(1.0);
    let here = trainee.screen().time_s;
    trainee.give(&format!("{{\"go_to\":{}}}", here - 1.75));
    trainee.give(r#"{"pause":false}"#).give(r#"{"speed":10.0}"#);
    trainee.give(r#"{"feed_override":100.0}"#).wait(3.0);
    trainee.press("NC_STOP").wait(1.0);
}

#[test]
fn a_session_is_seen_again() {
    let path = file("again");
    let mut trainee = Trainee::at("mill");
    trainee.station.record(&path).unwrap();
    session(&mut trainee);
    let end = seen(trainee.station.screen());
    let end_us = trainee.station.control().time_us();
    trainee.station.end_recording().unwrap();

    // The screens in between are those of another machine that is shown the same; two of them agree.
    let mut moments = Vec::new();
    for round in 0..2 {
        let mut other = Trainee::at("mill");
        let mut replay = Replay::read(&path).unwrap();
        assert_eq!(replay.ending(), Ending::Whole);
        assert!(replay.differences(&other.station).is_empty());
        let mut cycles = 0u64;
        let mut place = 0;
        while replay.cycle(&mut other.station).unwrap() {
            cycles += 1;
            if !cycles.is_multiple_of(end_us / 3000 / MOMENTS) {
                continue;
            }
            let screen = seen(other.station.screen());
            if round == 0 {
                moments.push(screen);
            } else {
                assert_eq!(screen, moments[place], "moment {place}");
                place += 1;
            }
        }
        assert!(moments.len() >= MOMENTS as usize, "{}", moments.len());
        assert_eq!(seen(other.station.screen()), end);
        assert_eq!(replay.came_true(&mut other.station), Some(true));
    }
    std::fs::remove_file(path).unwrap();
}

/// The screens of the session itself, at twenty moments of it, are those of the replay.
#[test]
fn the_screens_of_a_session_are_those_of_its_replay() {
    let path = file("screens");
    let mut trainee = Trainee::at("mill");
    trainee.station.record(&path).unwrap();
    let mut screens = Vec::new();
    let look = |trainee: &mut Trainee, screens: &mut Vec<(u64, String)>| {
        trainee.wait(0.503);
        let time = trainee.station.control().time_us();
        screens.push((time, seen(trainee.station.screen())));
    };
    trainee.ready();
    trainee.press("FULL PGM_NR C I R C L E ENT NC_START");
    for moment in 0..MOMENTS {
        match moment {
            5 => drop(trainee.give(r#"{"spindle_override":77.7}"#)),
            8 => drop(trainee.press("NC_STOP")),
            11 => drop(trainee.press("NC_START")),
            14 => drop(trainee.give(r#"{"key":"EMERGENCY_STOP","down":true}"#)),
            17 => drop(
                trainee
                    .give(r#"{"key":"EMERGENCY_STOP","down":false}"#)
                    .press("CE"),
            ),
            _ => {}
        }
        look(&mut trainee, &mut screens);
    }
    // Killed: the file has no end.
    drop(trainee);
    let mut other = Trainee::at("mill");
    let mut replay = Replay::read(&path).unwrap();
    assert_eq!(replay.ending(), Ending::Cut);
    for (time, screen) in &screens {
        while other.station.control().time_us() < *time {
            // After the last input the machine goes on by itself.
            if !replay.cycle(&mut other.station).unwrap() {
                other.station.cycle().unwrap();
            }
        }
        assert_eq!(seen(other.station.screen()), *screen, "at {time} µs");
    }
    std::fs::remove_file(path).unwrap();
}

#[test]
fn damage_is_reported_and_a_torn_line_is_left_out() {
    let path = file("torn");
    let mut trainee = Trainee::at("mill");
    trainee.station.record(&path).unwrap();
    assert!(trainee.station.record(&path).is_err(), "the file stays as it is");
    trainee.wait(1.0).press("CE").wait(1.0).press("NC_START");
    trainee.station.end_recording().unwrap();
    let whole = std::fs::read(&path).unwrap();
    let lines: Vec<&[u8]> = whole.split_inclusive(|byte| *byte == b'\n').collect();
    // Head, two keys, end.
    assert_eq!(lines.len(), 4);
    assert_eq!(Replay::of(&whole).unwrap().ending(), Ending::Whole);
    // Wherever it is cut after the head, what is whole is there.
    for length in lines[0].len()..whole.len() {
        let replay = Replay::of(&whole[..length]).unwrap();
        let complete = lines[1..3].iter().scan(lines[0].len(), |sum, line| {
            *sum += line.len();
            Some(*sum)
        });
        let inputs = complete.filter(|end| *end <= length).count();
        assert_eq!((replay.len(), replay.ending()), (inputs, Ending::Cut), "{length}");
    }
    // A line that was left out, or is another one.
    let without = [lines[0], lines[2], lines[3]].concat();
    assert_eq!(Replay::of(&without).unwrap().ending(), Ending::Changed);
    let text = String::from_utf8(whole.clone())
        .unwrap()
        .replace("\"CE\"", "\"RL\"");
    assert_eq!(Replay::of(text.as_bytes()).unwrap().ending(), Ending::Changed);
    let text = text.replace("\"RL\"", "RL");
    assert_eq!(Replay::of(text.as_bytes()).map(|_| ()).unwrap_err().0, 2);
    std::fs::remove_file(path).unwrap();
}

/// A session of another machine does not pass for one of this machine.
#[test]
fn another_machine_is_another_one() {
    let path = file("other");
    let mut trainee = Trainee::at("mill");
    trainee.station.record(&path).unwrap();
    trainee.station.end_recording().unwrap();
    let other = Trainee::at("mill-tnc360");
    let differences = Replay::read(&path).unwrap().differences(&other.station);
    assert!(differences[0].starts_with("machine: "), "{differences:?}");
    assert!(
        differences
            .iter()
            .any(|line| line == "model: tnc415b then, tnc360 now")
    );
    // What was kept since is said, too.
    trainee.ready().press("X").number("5").press("ENT");
    let station: &Station = &trainee.station;
    let differences = Replay::read(&path).unwrap().differences(station);
    assert_eq!(differences.len(), 1, "{differences:?}");
    assert!(differences[0].starts_with("what the control had kept"));
    std::fs::remove_file(path).unwrap();
}
