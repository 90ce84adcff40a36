//! A station in real time: what is recorded there is seen again, and the past is reached while it runs.

use std::time::{Duration, Instant};

use crate::support::Trainee;
use bahn_panel::{Input, InputText, Link, Live, Replay, Screen, Star, live_replay};

fn give(link: &Link, json: &str) {
    let text: InputText = serde_json::from_str(json).unwrap();
    link.input(Input::try_from(text).unwrap()).unwrap();
}

fn until(link: &Link, what: impl Fn(&Screen) -> bool) -> std::sync::Arc<Screen> {
    let end = Instant::now() + Duration::from_secs(60);
    while Instant::now() < end {
        let screen = link.screen();
        if what(&screen) {
            return screen;
        }
        std::thread::sleep(Duration::from_millis(5));
    }
    panic!("{:#?}", link.screen());
}

fn press(link: &Link, keys: &str) {
    for key in keys.split_whitespace() {
        give(link, &format!("{{\"key\":\"{key}\"}}"));
        std::thread::sleep(Duration::from_millis(5));
    }
}

#[test]
fn what_was_done_in_real_time_is_seen_again() {
    let path = std::env::temp_dir().join(format!("bahn-live-{}", std::process::id()));
    let _ = std::fs::remove_file(&path);
    let mut trainee = Trainee::at("mill");
    trainee.station.record(&path).unwrap();
    let (station, folder) = trainee.apart();
    let live = Live::start(station);
    let link = live.link();
    give(&link, r#"{"speed":50.0}"#);
    until(&link, |screen| !screen.messages.is_empty());
    press(&link, "CE");
    until(&link, |screen| {
        screen.mode == "PASS OVER REFERENCE MARKS" && screen.messages.is_empty()
    });
    std::thread::sleep(Duration::from_millis(50));
    press(&link, "NC_START");
    until(&link, |screen| screen.mode == "MANUAL OPERATION");
    press(&link, "FULL PGM_NR C I R C L E ENT NC_START");
    until(&link, |screen| {
        screen.status.star == Star::Steady && screen.status.f == "3000"
    });
    give(&link, r#"{"feed_override":60.0}"#);
    until(&link, |screen| screen.status.star == Star::Off);
    // Back into the run, and on with another override.
    let end_s = link.screen().timeline.to_s;
    give(&link, &format!("{{\"go_to\":{}}}", end_s - 5.0));
    let screen = until(&link, |screen| screen.machine.paused);
    assert!((screen.timeline.now_s - (end_s - 5.0)).abs() < 0.01);
    give(&link, r#"{"feed_override":90.0}"#);
    give(&link, r#"{"pause":false}"#);
    let screen = until(&link, |screen| screen.status.star == Star::Off);
    assert_eq!(screen.timeline.branches.len(), 1);
    give(&link, r#"{"pause":true}"#);
    let end = link.with(|station| station.screen().clone()).unwrap();
    live.end().unwrap();

    let mut replay = Replay::read(&path).unwrap();
    let mut other = Trainee::at("mill");
    while replay.cycle(&mut other.station).unwrap() {}
    let seen = Screen {
        serial: end.serial,
        ..other.station.screen().clone()
    };
    assert_eq!(
        serde_json::to_string(&seen).unwrap(),
        serde_json::to_string(&end).unwrap()
    );
    assert_eq!(replay.came_true(&mut other.station), Some(true));
    // And in real time.
    let (station, second) = Trainee::at("mill").apart();
    let live = live_replay(station, Replay::read(&path).unwrap());
    let link = live.link();
    until(&link, |screen| {
        screen.machine.paused && screen.time_s == end.time_s
    });
    let seen = link.with(|station| station.screen().clone()).unwrap();
    let seen = Screen {
        serial: end.serial,
        ..seen
    };
    assert_eq!(
        serde_json::to_string(&seen).unwrap(),
        serde_json::to_string(&end).unwrap()
    );
    live.end().unwrap();
    std::fs::remove_file(path).unwrap();
    std::fs::remove_dir_all(folder).unwrap();
    std::fs::remove_dir_all(second).unwrap();
}
