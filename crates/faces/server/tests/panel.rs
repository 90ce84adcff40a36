//! The interface of docs/panel-api.md, over real connections.

#![allow(clippy::unwrap_used, clippy::panic, reason = "tests fail by panic")]

mod support;

use serde_json::json;
use support::{Panel, position};

#[test]
fn the_screen_has_its_fields_and_keys_change_it() {
    let panel = Panel::start();
    let screen = panel.until(|screen| screen["messages"][0]["text"] == "POWER INTERRUPTED");
    for field in [
        "mode",
        "dialogue",
        "messages",
        "program",
        "status",
        "soft_keys",
        "plc_window",
        "lamps",
    ] {
        assert!(screen.get(field).is_some(), "{field}");
    }
    panel.to_manual();
    assert_eq!(panel.give(&json!({"feed_override": 80})), 200);
    panel.until(|screen| screen["status"]["overrides"][0] == 80.0);
    let snapshot = panel.get("/api/snapshot");
    assert_eq!(
        (&snapshot["mode"], &snapshot["axes"][0]["referenced"]),
        (&json!("manual"), &json!(true))
    );
    // A key that is held, until it is let go.
    let stood = position(&panel.screen(), "X");
    assert_eq!(panel.give(&json!({"key": "X+", "down": true})), 200);
    panel.until(|screen| position(screen, "X") > stood + 0.5 && screen["status"]["f"] != "0");
    assert_eq!(panel.give(&json!({"key": "X+", "down": false})), 200);
    // It has run out after a second, and stands.
    panel.wait(1.0);
    let stands = position(&panel.screen(), "X");
    panel.wait(1.0);
    let moved = position(&panel.screen(), "X") - stands;
    assert!(moved.abs() < 0.01, "{moved}");
}

#[test]
fn what_is_wrong_is_said() {
    let panel = Panel::start();
    for (body, status) in [
        ("{\"key\":\"NO_SUCH\"}", 409),
        ("{\"kee\":\"ENT\"}", 400),
        ("{}", 400),
        ("[]", 400),
        ("{\"speed\":1000}", 409),
        ("{\"action\":\"fault drive Q off\"}", 409),
    ] {
        let (answered, text) = panel.request("POST", "/api/command", &[], body);
        assert_eq!(answered, status, "{body}: {text}");
        assert!(text.contains("\"ok\":false") && text.contains("error"), "{text}");
    }
}

/// `/api/drawer`, `/api/lessons`, `/api/graphics.png`: what they say, and what they say when there is nothing.
#[test]
fn drawer_lessons_and_picture_are_served() {
    let panel = Panel::start();
    let drawer = panel.get("/api/drawer");
    let drawer = drawer.as_array().unwrap();
    assert!(drawer.iter().any(|thing| thing["name"] == "X"));
    for thing in drawer {
        assert!(
            thing["group"].is_string() && thing["words"].is_string(),
            "{thing}"
        );
        let faults = thing["faults"].as_array().unwrap();
        assert!(
            !faults.is_empty() && faults.iter().all(|way| way["words"].is_string()),
            "{thing}"
        );
        // What it offers can be done.
        assert_eq!(
            panel.give(&json!({"action": faults[0]["action"]})),
            200,
            "{thing}"
        );
        assert_eq!(panel.give(&json!({"action": thing["repair"]})), 200, "{thing}");
    }
    let lessons = panel.get("/api/lessons");
    for lesson in lessons.as_array().unwrap() {
        let name = lesson["name"].as_str().unwrap();
        let text = panel.file(&format!("lessons/{name}.lesson"));
        assert!(text.contains(lesson["title"].as_str().unwrap()), "{lesson}");
    }

    // Nothing is looked at.
    assert_eq!(panel.request("GET", "/api/graphics.png", &[], "").0, 204);
    let panel = Panel::start();
    panel.to_manual();
    panel.press("TEST");
    panel.press("GRAPHICS");
    assert_eq!(
        panel.request("GET", "/api/graphics.png", &[], "").0,
        204,
        "nothing was cut"
    );
    let picture = |size: &str| {
        let (status, headers, body) = panel.bytes(&format!("/api/graphics.png?{size}"));
        (status, headers.contains("image/png"), body)
    };
    panel.choose("BRACKET");
    panel.press("START");
    panel.until(|screen| screen["graphics"]["progress"] == 1.0);
    for (width, height) in [(640_u32, 480_u32), (900, 700)] {
        let (status, is_png, body) = picture(&format!("width={width}&height={height}"));
        assert!(status == 200 && is_png);
        // The head of a PNG has its size.
        let number = |at: usize| u32::from_be_bytes(body[at..at + 4].try_into().unwrap());
        assert_eq!(
            (&body[1..4], number(16), number(20)),
            (&b"PNG"[..], width, height)
        );
    }
    assert_eq!(picture("width=1&height=1").0, 400);
    assert_eq!(picture("width=many").0, 400);
}

#[test]
fn nobody_comes_in_who_should_not() {
    let panel = Panel::start();
    let key = "{\"key\":\"CE\"}";
    let status = |headers: &[(&str, &str)]| panel.request("POST", "/api/key", headers, key).0;
    assert_eq!(status(&[]), 200);
    assert_eq!(status(&[("Origin", "http://example.com")]), 403);
    assert_eq!(status(&[("Host", "example.com")]), 403);
    let own = format!("http://{}", panel.address);
    assert_eq!(status(&[("Origin", &own)]), 200);
    let large = format!("{{\"text\":\"{}\"}}", "X".repeat(100_000));
    assert_eq!(panel.request("POST", "/api/key", &[], &large).0, 413);
    for path in [
        "/web/../Cargo.toml",
        "/web/%2e%2e%2fCargo.toml",
        "/etc/passwd",
        "/web/none.js",
    ] {
        assert_eq!(panel.request("GET", path, &[], "").0, 404, "{path}");
    }
}

#[test]
fn one_operates_and_hands_over_and_no_key_is_lost() {
    let panel = Panel::start();
    panel.until(|screen| screen["messages"][0]["text"] == "POWER INTERRUPTED");
    let mut anna = panel.viewer("anna");
    anna.until("crew", |crew| crew["operates"] == true);
    let mut ben = panel.viewer("ben");
    ben.until("crew", |crew| crew["operates"] == false);
    ben.send(&json!({"n": 1, "key": "CE"}));
    ben.until("refused", |why| why == "somebody else operates");
    // Her connection breaks before she knows that her key was taken: she sends it again, and it counts once.
    anna.send(&json!({"n": 1, "key": "PROGRAM"}));
    drop(anna);
    let mut anna = panel.viewer("anna");
    anna.until("taken", |number| number == 1 || number == 0);
    anna.send(&json!({"n": 1, "key": "PROGRAM"}));
    anna.send(&json!({"n": 2, "key": "PGM_NR"}));
    anna.until("taken", |number| number == 2);
    panel.until(|screen| screen["mode"] == "PROGRAMMING AND EDITING" && screen["program"]["kind"] == "list");
    // Hand-over.
    ben.send(&json!({"operate": true}));
    anna.until("crew", |crew| crew["asks"] == "ben");
    anna.send(&json!({"hand_over": true}));
    ben.until("crew", |crew| crew["operates"] == true);
    ben.send(&json!({"n": 2, "key": "MANUAL"}));
    ben.until("taken", |number| number == 2);
    anna.until("header", |header| header[0] != "PROGRAMMING AND EDITING");
}

#[test]
fn more_viewers_than_there_is_room_for_are_sent_away() {
    let panel = Panel::start();
    let viewers: Vec<_> = (0..32)
        .map(|number| panel.viewer(&format!("viewer-{number}")))
        .collect();
    let url = format!("ws://{}/ws?name=one-more", panel.address);
    assert!(tungstenite::connect(&url).is_err());
    drop(viewers);
    let mut tries = 0;
    while tungstenite::connect(&url).is_err() {
        tries += 1;
        assert!(tries < 100);
        std::thread::sleep(std::time::Duration::from_millis(50));
    }
}
