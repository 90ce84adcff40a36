//! Random inputs by seed: keys, axes, faults and repairs, power, the past and its branches. Nothing panics, the time line
//! stays in order, and the session comes out the same when it is seen again.

use crate::support::Trainee;
use bahn_panel::{Input, InputText, Replay, Screen};

const INPUTS: usize = 300;

/// xorshift.
fn random(seed: &mut u64, below: usize) -> usize {
    *seed ^= *seed << 13;
    *seed ^= *seed >> 7;
    *seed ^= *seed << 17;
    (*seed >> 11) as usize % below
}

const KEYS: &[&str] = &[
    "MANUAL",
    "HANDWHEEL",
    "MDI",
    "SINGLE",
    "FULL",
    "PROGRAM",
    "TEST",
    "CE",
    "ENT",
    "END",
    "NO_ENT",
    "DEL",
    "UP",
    "DOWN",
    "GOTO",
    "X",
    "Y",
    "5",
    "SIGN",
    "POINT",
    "SK1",
    "SK2",
    "SK3",
    "PGM_NR",
    "NC_START",
    "NC_START",
    "NC_STOP",
    "CONFIRM",
    "SPINDLE_ON",
    "MOD",
    "RIGHT",
    "1",
    "EMERGENCY_STOP",
    "SCREEN",
];

/// An input as JSON.
fn input(seed: &mut u64, actions: &[String], screen: &Screen) -> String {
    let kind = random(seed, 20);
    let line = &screen.timeline;
    match kind {
        0..9 => format!("{{\"key\":\"{}\"}}", KEYS[random(seed, KEYS.len())]),
        9 | 10 => {
            let key = ["X+", "X-", "Y+", "Z-", "IV+", "NC_STOP"][random(seed, 6)];
            format!("{{\"key\":\"{key}\",\"down\":{}}}", random(seed, 2) == 0)
        }
        11 => format!("{{\"feed_override\":{}}}", random(seed, 150)),
        12 => format!("{{\"spindle_override\":{}}}", random(seed, 150)),
        13 | 14 => format!("{{\"action\":\"{}\"}}", actions[random(seed, actions.len())]),
        15 => r#"{"action":"repair all"}"#.to_owned(),
        16 => format!("{{\"power\":{}}}", random(seed, 4) != 0),
        17 => r#"{"pause":false}"#.to_owned(),
        18 => {
            let time_s = line.to_s * random(seed, 1100) as f64 / 1000.0;
            format!("{{\"go_to\":{time_s}}}")
        }
        _ => {
            let branch = line
                .branches
                .get(random(seed, 5))
                .map_or(1, |branch| branch.number);
            format!("{{\"go_to\":{},\"branch\":{branch}}}", line.to_s / 2.0)
        }
    }
}

fn session(mut seed: u64) {
    let path = std::env::temp_dir().join(format!("bahn-chaos-{}-{seed}", std::process::id()));
    let _ = std::fs::remove_file(&path);
    let mut trainee = Trainee::at("mill");
    let name = seed;
    let drawer = trainee.station.drawer();
    let mut actions: Vec<String> = drawer
        .iter()
        .flat_map(|breakable| breakable.faults.iter().map(|fault| fault.action.clone()))
        .collect();
    actions.extend(drawer.iter().map(|breakable| breakable.repair.clone()));
    trainee.station.record(&path).unwrap();
    trainee.ready();
    trainee.press("FULL PGM_NR C I R C L E ENT NC_START");
    for number in 0..INPUTS {
        let screen = trainee.screen();
        let line = &screen.timeline;
        assert!(
            line.now_s <= line.to_s && line.branches.len() <= 4,
            "seed {name}, {number}: {line:?}"
        );
        assert!(
            line.marks.is_sorted_by_key(|mark| mark.t),
            "seed {name}, {number}: {line:?}"
        );
        assert_eq!(line.now_s, screen.time_s);
        let text = input(&mut seed, &actions, &screen);
        let read: InputText = serde_json::from_str(&text).unwrap();
        // What is refused is refused.
        let _ = trainee.station.input(&Input::try_from(read).unwrap());
        trainee.wait(random(&mut seed, 40) as f64 / 10.0);
        let _ = trainee.station.why();
    }
    trainee.station.end_recording().unwrap();
    let end = trainee.screen();

    let mut other = Trainee::at("mill");
    let mut replay = Replay::read(&path).unwrap();
    while replay.cycle(&mut other.station).unwrap() {}
    let seen = Screen {
        serial: end.serial,
        ..other.screen()
    };
    assert_eq!(
        serde_json::to_string(&seen).unwrap(),
        serde_json::to_string(&end).unwrap(),
        "seed {name}"
    );
    assert_eq!(replay.came_true(&mut other.station), Some(true));
    std::fs::remove_file(path).unwrap();
}

#[test]
fn random_sessions_are_seen_again() {
    for seed in [3, 1_000_003, 77_777_777] {
        session(seed);
    }
}
