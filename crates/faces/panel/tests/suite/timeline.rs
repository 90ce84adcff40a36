//! Back to any moment since power-on, and from there another way.

use crate::support::Trainee;
use bahn_panel::{MarkKind, Refusal, Screen, Star};

/// What is to be seen of the control and its machine; the time line itself has more moments later.
fn seen(screen: &Screen) -> String {
    let screen = Screen {
        serial: 0,
        timeline: Default::default(),
        machine: Default::default(),
        ..screen.clone()
    };
    serde_json::to_string(&screen).unwrap()
}

#[test]
fn every_moment_is_reached_again() {
    let mut trainee = Trainee::at("mill");
    trainee.ready();
    trainee.press("FULL PGM_NR C I R C L E ENT NC_START");
    let mut moments = Vec::new();
    for _ in 0..8 {
        trainee.wait(0.7);
        let time_s = trainee.screen().time_s;
        moments.push((time_s, seen(&trainee.screen())));
    }
    trainee.give(r#"{"key":"EMERGENCY_STOP","down":true}"#).wait(1.0);
    trainee.give(r#"{"feed_override":33.0}"#);
    let end_s = trainee.screen().time_s;
    for place in [3, 0, 7, 5, 1] {
        let (time_s, then) = &moments[place];
        trainee.station.go_to(*time_s).unwrap();
        let screen = trainee.screen();
        assert_eq!(seen(&screen), *then, "moment {place}");
        let line = &screen.timeline;
        assert_eq!((line.now_s, line.to_s), (*time_s, end_s));
        assert!(screen.machine.paused && !screen.machine.emergency_stop);
        assert_eq!(screen.machine.knobs[0], 100.0);
        assert!(line.branches.is_empty());
    }
    // The end is there as it was, with the knob that was turned last.
    trainee.station.go_to(1e9).unwrap();
    let screen = trainee.screen();
    assert_eq!((screen.timeline.now_s, screen.timeline.to_s), (end_s, end_s));
    assert!(screen.machine.emergency_stop);
    assert_eq!(screen.machine.knobs[0], 33.0);
    assert!(
        screen
            .messages
            .iter()
            .any(|message| message.text == "EXTERNAL EMERGENCY STOP")
    );
}

#[test]
fn what_happened_has_its_marks() {
    let mut trainee = Trainee::at("mill");
    trainee.ready();
    trainee.press("FULL PGM_NR C I R C L E ENT NC_START").wait(2.0);
    trainee.press("NC_STOP").wait(2.0).press("NC_START");
    trainee.until(300.0, |screen| screen.status.star == Star::Off);
    trainee.give(r#"{"action":"switch door open"}"#).wait(2.0);
    let line = trainee.screen().timeline;
    let marks: Vec<(MarkKind, &str)> = line
        .marks
        .iter()
        .map(|mark| (mark.kind, mark.text.as_str()))
        .filter(|(kind, _)| *kind != MarkKind::Message)
        .collect();
    assert_eq!(
        marks,
        [
            (MarkKind::Start, "CIRCLE"),
            (MarkKind::Stop, "CIRCLE"),
            (MarkKind::End, "CIRCLE"),
            (MarkKind::Action, "switch door open"),
        ]
    );
    let messages = line.marks.iter().filter(|mark| mark.kind == MarkKind::Message);
    let messages: Vec<&str> = messages.map(|mark| mark.text.as_str()).collect();
    assert_eq!(messages.first(), Some(&"POWER INTERRUPTED"));
    assert_eq!(messages.last(), Some(&"DOOR IS OPEN"));
    assert!(line.marks.is_sorted_by_key(|mark| mark.t));
    // Of the past all marks stay, of another way those before it.
    let all = line.marks.len();
    let stop_s = line
        .marks
        .iter()
        .find(|mark| mark.kind == MarkKind::Stop)
        .unwrap()
        .t;
    trainee.station.go_to(stop_s - 0.5).unwrap();
    assert_eq!(trainee.screen().timeline.marks.len(), all);
    trainee.wait(0.1);
    let marks = trainee.screen().timeline.marks;
    assert!(marks.len() < all && marks.iter().all(|mark| mark.t < stop_s));
    assert!(marks.iter().any(|mark| mark.kind == MarkKind::Start));
}

#[test]
fn another_way_is_a_branch() {
    let mut trainee = Trainee::at("mill");
    trainee.ready();
    let fork_s = trainee.screen().time_s;
    let move_axis = |trainee: &mut Trainee, key: &str| {
        trainee
            .give(&format!("{{\"key\":\"{key}\",\"down\":true}}"))
            .wait(1.0);
        trainee
            .give(&format!("{{\"key\":\"{key}\",\"down\":false}}"))
            .wait(0.5);
    };
    move_axis(&mut trainee, "X+");
    let first = seen(&trainee.screen());
    let first_s = trainee.screen().time_s;
    // Looking does not make a branch: keys that only turn pages do not, either.
    trainee.station.go_to(fork_s).unwrap();
    trainee.give(r#"{"key":"SCREEN"}"#).give(r#"{"key":"SCREEN"}"#);
    assert!(trainee.screen().timeline.branches.is_empty());
    assert_eq!(trainee.screen().timeline.to_s, first_s);
    // Another axis: the first way is kept.
    trainee.give(r#"{"pause":false}"#);
    move_axis(&mut trainee, "Y+");
    let second = seen(&trainee.screen());
    assert_ne!(first, second);
    let branches = trainee.screen().timeline.branches;
    assert_eq!(branches.len(), 1);
    assert_eq!((branches[0].from_s, branches[0].to_s), (fork_s, first_s));
    // Back to its end, and to the end of the second.
    let end = |trainee: &mut Trainee, number: u32| {
        trainee.give(&format!("{{\"go_to\":1000000,\"branch\":{number}}}"));
        seen(&trainee.screen())
    };
    assert_eq!(end(&mut trainee, branches[0].number), first);
    let number = trainee.screen().timeline.branches[0].number;
    assert_eq!(end(&mut trainee, number), second);
    let refusal = trainee.station.input(&bahn_panel::Input::GoTo(1.0, Some(77)));
    assert_eq!(refusal, Err(Refusal("there is no branch 77".to_owned())));
    assert_eq!(seen(&trainee.screen()), second);
    // Four ways are kept at most, the oldest goes.
    for _ in 0..6 {
        trainee.station.go_to(fork_s).unwrap();
        trainee.wait(0.2);
    }
    let branches = trainee.screen().timeline.branches;
    assert_eq!(branches.len(), 4);
    assert!(branches.is_sorted_by_key(|branch| branch.number));
}

/// Power-off and power-on lie on the line as everything else, and modes have their pages again.
#[test]
fn the_line_leads_over_power_off() {
    let mut trainee = Trainee::at("mill");
    trainee.ready();
    trainee.press("MDI").wait(0.5);
    let (mdi_s, mdi) = (trainee.screen().time_s, seen(&trainee.screen()));
    assert_eq!(trainee.screen().mode, "POSITIONING WITH MANUAL DATA INPUT");
    trainee.give(r#"{"power":false}"#).wait(2.0);
    let off_s = trainee.screen().time_s;
    assert!(!trainee.screen().machine.power);
    trainee.give(r#"{"power":true}"#).wait(3.0);
    assert_eq!(trainee.messages(), ["POWER INTERRUPTED"]);
    trainee.station.go_to(mdi_s).unwrap();
    assert_eq!(seen(&trainee.screen()), mdi);
    trainee.station.go_to(off_s).unwrap();
    assert!(!trainee.screen().machine.power);
    trainee.station.go_to(0.0).unwrap();
    assert_eq!(trainee.screen().timeline.now_s, 0.0);
}

/// What a quarter of an hour leaves behind: the number of states grows no more long before.
#[test]
fn a_long_session_is_kept_in_little_memory() {
    let mut trainee = Trainee::at("mill");
    trainee.ready();
    let measured = allocation_counter::measure(|| {
        for minute in 0..15 {
            trainee
                .give(&format!("{{\"feed_override\":{}}}", 50 + minute))
                .wait(60.0);
        }
    });
    let line = trainee.screen().timeline;
    assert!(line.to_s > 900.0);
    let started = std::time::Instant::now();
    trainee.station.go_to(450.0).unwrap();
    println!(
        "a quarter of an hour: {} bytes, back to its middle in {:?}",
        measured.bytes_current,
        started.elapsed()
    );
    // Turned once a minute, from a few seconds on.
    assert_eq!(trainee.screen().machine.knobs[0], 50.0 + 7.0);
    assert!(measured.bytes_current < 40_000_000, "{measured:?}");
}

/// All ways together stay below 80 MB.
#[test]
fn saved_states_are_small() {
    let mut trainee = Trainee::at("mill");
    trainee.ready();
    trainee.press("FULL PGM_NR B R A C K E T ENT NC_START").wait(20.0);
    let mut saved = None;
    let started = std::time::Instant::now();
    let measured = allocation_counter::measure(|| saved = trainee.station.host().save());
    let took = started.elapsed();
    drop(saved);
    println!("a saved state: {} bytes, {took:?}", measured.bytes_current);
    // What the line keeps: 128 states of the way that is gone, 64 of each of the four that were left.
    assert!(
        measured.bytes_current * (128 + 4 * 64) < 80_000_000,
        "{measured:?}"
    );
}
