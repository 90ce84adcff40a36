//! EMERGENCY STOP is answered at once, whatever else is asked for, and cycles that are asked for hold nothing up.

#![allow(clippy::unwrap_used, clippy::panic, reason = "tests fail by panic")]

mod support;

use std::sync::Arc;
use std::sync::atomic::{AtomicBool, Ordering};
use std::time::{Duration, Instant};

use serde_json::{Value, json};
use support::Panel;

/// EMERGENCY STOP is answered within this time.
const AT_ONCE: Duration = Duration::from_millis(50);

/// How long EMERGENCY STOP takes at best of a few times: what else runs on this computer may take its processors for a
/// moment, what holds the station holds it every time.
fn at_best(panel: &Panel) -> Duration {
    (0..6).map(|_| press(panel)).min().unwrap()
}

/// How long EMERGENCY STOP takes.
fn press(panel: &Panel) -> Duration {
    let begun = Instant::now();
    assert_eq!(panel.give(&json!({"key": "EMERGENCY_STOP"})), 200);
    begun.elapsed()
}

fn answer(panel: &Panel, input: &Value) -> Value {
    let (status, body) = panel.request("POST", "/api/command", &[], &input.to_string());
    assert_eq!(status, 200, "{body}");
    serde_json::from_str(&body).unwrap()
}

fn time_s(panel: &Panel) -> f64 {
    panel.get("/api/snapshot")["t"].as_f64().unwrap()
}

/// A contour cycle of a TNC 415 is 3 ms.
#[test]
fn emergency_stop_comes_between_cycles_that_are_asked_for() {
    let panel = Panel::start();
    panel.to_manual();
    answer(&panel, &json!({"pause": true}));
    let begun_s = time_s(&panel);
    std::thread::scope(|scope| {
        let many = scope.spawn(|| answer(&panel, &json!({"cycles": 100_000})));
        while time_s(&panel) < begun_s + 0.03 {
            std::thread::sleep(Duration::from_millis(5));
        }
        let answered = at_best(&panel);
        assert!(answered < AT_ONCE, "{answered:?}");
        // An odd number of presses leaves the button in, and the machine sees it while cycles pass.
        assert_eq!(panel.give(&json!({"key": "EMERGENCY_STOP", "down": true})), 200);
        panel.until(|screen| screen["machine"]["emergency_stop"] == true);
        // Time stands as soon as somebody lets it; the answer says how far it came.
        answer(&panel, &json!({"pause": true}));
        let stepped = many.join().unwrap();
        let passed = ((time_s(&panel) - begun_s) / 0.003).round();
        assert_eq!(
            (&stepped["ended"], stepped["cycles"].as_f64()),
            (&json!("paused"), Some(passed))
        );
        assert!((10.0..10_000.0).contains(&passed), "{passed}");
    });
    // What is complete says so, and what is more than wait at a time.
    assert_eq!(answer(&panel, &json!({"cycles": 5}))["ended"], "complete");
    assert_eq!(answer(&panel, &json!({"cycles": 5}))["cycles"], 5);
    answer(&panel, &json!({"speed": 100}));
    let most = answer(&panel, &json!({"cycles": 100_000}));
    assert_eq!(
        (&most["ended"], &most["cycles"]),
        (&json!("limit"), &json!(10_000))
    );
}

/// Everybody else asks for what takes longest, at once and again and again.
#[test]
fn emergency_stop_waits_for_no_other_input() {
    let panel = Panel::start();
    panel.to_manual();
    let lessons = panel.get("/api/lessons");
    let names: Vec<_> = lessons
        .as_array()
        .unwrap()
        .iter()
        .map(|lesson| lesson["name"].clone())
        .collect();
    let end = Arc::new(AtomicBool::new(false));
    let (panel, end) = (&panel, &end);
    std::thread::scope(|scope| {
        for place in 0..4 {
            let names = &names;
            scope.spawn(move || {
                for turn in 0.. {
                    let input = match (turn + place) % 4 {
                        0 => json!({"lesson": names[turn % names.len()]}),
                        1 => json!({"go_to": 1.0}),
                        2 => json!({"text": "X".repeat(60_000)}),
                        _ => json!({"pause": false}),
                    };
                    panel.give(&input);
                    if end.load(Ordering::Relaxed) {
                        return;
                    }
                }
            });
        }
        std::thread::sleep(Duration::from_millis(200));
        let answered = at_best(panel);
        end.store(true, Ordering::Relaxed);
        assert!(answered < AT_ONCE, "{answered:?}");
    });
}

/// At a tenth of its speed a cycle of 6 ms of a TNC 360 lasts 60 ms.
#[test]
fn emergency_stop_does_not_wait_for_a_slow_cycle() {
    let panel = Panel::of("mill-tnc360", |_| {});
    answer(&panel, &json!({"speed": 0.1}));
    // Whoever presses as soon as he was answered would wait for a whole cycle each time.
    let mut answered: Vec<_> = (0..11).map(|_| press(&panel)).collect();
    answered.sort();
    assert!(answered[5] < Duration::from_millis(20), "{answered:?}");
}

/// Time that stood is not made up for.
#[test]
fn after_a_pause_time_goes_on_as_fast_as_before() {
    let panel = Panel::start();
    panel.until(|screen| screen["messages"][0]["text"] == "POWER INTERRUPTED");
    answer(&panel, &json!({"pause": true}));
    std::thread::sleep(Duration::from_secs(3));
    for going_on in [json!({"pause": false}), json!({"cycles": 100})] {
        answer(&panel, &json!({"pause": true}));
        std::thread::sleep(Duration::from_millis(1500));
        let (begun, begun_s) = (Instant::now(), time_s(&panel));
        answer(&panel, &going_on);
        std::thread::sleep(Duration::from_millis(300));
        let (passed_s, real_s) = (time_s(&panel) - begun_s, begun.elapsed().as_secs_f64());
        assert!(
            passed_s <= real_s + 0.01,
            "{going_on}: {passed_s} s in {real_s} s"
        );
    }
}
