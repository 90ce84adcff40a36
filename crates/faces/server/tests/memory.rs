//! Memory of a session of an hour, with four branches of the time line. It takes some minutes:
//! `cargo test -p bahn-server --test memory -- --ignored --nocapture`.

#![allow(clippy::unwrap_used, clippy::panic, reason = "tests fail by panic")]

mod support;

use serde_json::json;
use support::Panel;

/// What a panel may need, KiB.
const MOST: u64 = 100 << 10;
/// An hour in five parts: four branches that are left, and the last.
const PART_S: f64 = 720.0;

#[test]
#[ignore = "takes some minutes"]
fn an_hour_with_four_branches_stays_below_100_mb() {
    let panel = Panel::start();
    panel.to_manual();
    let begun = panel.memory_kib();
    panel.press("FULL");
    panel.choose("BRACKET");
    let now = || panel.get("/api/snapshot")["t"].as_f64().unwrap();
    let mut most = begun;
    for part in 0..5 {
        let from = now();
        assert_eq!(panel.give(&json!({"pause": false})), 200);
        assert_eq!(panel.give(&json!({"speed": 100})), 200);
        while now() < from + PART_S {
            // Whoever works presses keys; the program runs again and again.
            panel.press("NC_START");
            std::thread::sleep(std::time::Duration::from_millis(100));
            most = most.max(panel.memory_kib());
        }
        println!("part {part}: {} s, {} KiB", now(), panel.memory_kib());
        if part < 4 {
            // Back by two minutes, and on from there on another branch.
            assert_eq!(panel.give(&json!({"go_to": now() - 120.0})), 200);
        }
    }
    let branches = panel.screen()["timeline"]["branches"].as_array().unwrap().len();
    println!("{branches} branches; {begun} KiB at the beginning, {most} KiB at most");
    assert_eq!(branches, 4);
    assert!(most < MOST, "{most} KiB");
}
