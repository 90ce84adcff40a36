//! A plant that is no simulated machine, seen over HTTP.

#![allow(clippy::unwrap_used, clippy::panic, reason = "tests fail by panic")]

#[path = "../../panel/tests/cross_table/mod.rs"]
mod cross_table;
mod support;

use bahn_host::{Operable, PowerOn};
use bahn_panel::Station;
use bahn_server::Tokens;
use cross_table::{CrossTable, folder, load};
use serde_json::{Value, json};
use support::Panel;

fn actual(panel: &Panel, letter: &str) -> f64 {
    let snapshot = panel.get("/api/snapshot");
    let axes = snapshot["axes"].as_array().unwrap();
    let is_meant = |axis: &&Value| axis["letter"] == letter;
    axes.iter().find(is_meant).unwrap()["actual"].as_f64().unwrap()
}

/// The page has the keys of the plant, a key moves its axis, and where it stands is told: the reference mark at 2 mm is 0.
#[test]
fn a_key_of_the_page_moves_any_plant() {
    let folder = folder("server");
    let machine = load(&folder.0);
    let power_on = PowerOn::fresh(&machine);
    let station = Station::with_plant(machine, CrossTable::new(), power_on).unwrap();
    let panel = Panel::over(station, folder.0.clone(), Tokens::default());
    let keys = panel.get("/api/station")["machine_keys"].clone();
    assert_eq!(keys, json!(["NC_START", "NC_STOP", "X+", "X-"]));

    panel.until(|screen| screen["messages"][0]["text"] == "POWER INTERRUPTED");
    panel.press("CE");
    panel.until(|screen| screen["mode"] == "PASS OVER REFERENCE MARKS" && screen["messages"] == json!([]));
    panel.wait(1.0);
    assert_eq!(panel.give(&json!({ "key": "NC_START" })), 200);
    panel.until(|screen| screen["mode"] == "MANUAL OPERATION");

    let before = actual(&panel, "X");
    assert_eq!(panel.give(&json!({ "key": "X+", "down": true })), 200);
    panel.until(|screen| screen["machine"]["held"] == json!(["X+"]) && actual(&panel, "X") > before + 1.0);
    assert_eq!(panel.give(&json!({ "key": "X+", "down": false })), 200);
    panel.wait(1.0);
    let truth = panel.at_the_machine(|station| station.host().plant().true_axis('X').unwrap().position);
    let after = actual(&panel, "X");
    assert!(after > before, "{before} {after}");
    assert!((after - (truth - 2.0)).abs() < 0.001, "{after} {truth}");
}
