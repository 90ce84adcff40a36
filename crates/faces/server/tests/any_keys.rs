//! Ten thousand random keys through the interface: nothing panics, the screen and the kernel agree, nothing is lost.

#![allow(clippy::unwrap_used, clippy::panic, reason = "tests fail by panic")]

mod support;

use std::time::Duration;

use serde_json::{Value, json};
use support::Panel;

/// Keys of each of two seeds.
const KEYS: usize = 5_000;
/// A viewer who sends more than 400 messages a second is sent away.
const PACE: Duration = Duration::from_micros(2_600);

/// A random generator, xorshift.
struct Dice(u64);

impl Dice {
    fn next(&mut self, below: usize) -> usize {
        self.0 ^= self.0 << 13;
        self.0 ^= self.0 >> 7;
        self.0 ^= self.0 << 17;
        (self.0 >> 11) as usize % below
    }
}

/// The mode that the screen shows by the mode of the kernel.
fn headings(mode: &str) -> &'static [&'static str] {
    match mode {
        "manual" => &["MANUAL OPERATION", "PASS OVER REFERENCE MARKS", "TOUCH PROBE"],
        // By a soft key, as long as marks are to be passed [000:4581].
        "reference" => &["PASS OVER REFERENCE MARKS"],
        "handwheel" => &["ELECTRONIC HANDWHEEL"],
        "mdi" => &["POSITIONING WITH MANUAL DATA INPUT"],
        "single" => &["PROGRAM RUN, SINGLE BLOCK"],
        "full" => &["PROGRAM RUN, FULL SEQUENCE"],
        other => panic!("the mode {other} is not known here"),
    }
}

#[test]
fn five_thousand_keys() {
    hammer(0x5eed_2026);
}

#[test]
fn five_thousand_other_keys() {
    hammer(0x0ddb_a115);
}

fn hammer(seed: u64) {
    let panel = Panel::start();
    panel.until(|screen| screen["messages"][0]["text"] == "POWER INTERRUPTED");
    let station = panel.get("/api/station");
    let names = |list: &Value, field: Option<&str>| -> Vec<String> {
        let entries = list.as_array().unwrap().iter();
        entries
            .map(|entry| {
                field
                    .map_or(entry, |field| &entry[field])
                    .as_str()
                    .unwrap()
                    .to_owned()
            })
            .collect()
    };
    let mut keys = names(&station["keys"], Some("name"));
    keys.extend(names(&station["machine_keys"], None));
    // Soft keys and entries lead deeper than letters.
    for name in ["SK1", "SK2", "SK3", "SK4", "ENT", "END", "CE", "SK_RIGHT"] {
        keys.extend(std::iter::repeat_n(name.to_owned(), 4));
    }
    let mut viewer = panel.viewer("somebody");
    viewer.until("crew", |crew| crew["operates"] == true);
    // Keys are taken between two cycles: the faster time passes, the sooner.
    assert_eq!(panel.give(&json!({"speed": 20})), 200);
    let mut dice = Dice(seed);
    for number in 1..=KEYS {
        let key = &keys[dice.next(keys.len())];
        viewer.send(&json!({ "n": number, "key": key }));
        // Every key is answered: taken, or refused in words.
        viewer.answered(number as u64);
        std::thread::sleep(PACE);
        if number % 250 == 0 {
            agree(&panel);
        }
    }
    agree(&panel);
    // Nothing it did has frozen the station: switched off and on again, it begins as every day.
    for on in [false, true] {
        assert_eq!(panel.give(&json!({ "power": on })), 200);
    }
    panel.until(|screen| {
        let messages = screen["messages"].as_array().unwrap();
        // English or German, whatever the keys have chosen.
        messages.iter().any(|message| {
            ["POWER INTERRUPTED", "STROMUNTERBRECHUNG"].contains(&message["text"].as_str().unwrap())
        })
    });
}

/// The mode and the overrides that the screen shows are those of the kernel.
fn agree(panel: &Panel) {
    let mut tries = 0;
    loop {
        let (screen, snapshot) = (panel.screen(), panel.get("/api/snapshot"));
        let mode = screen["mode"].as_str().unwrap();
        let shown = screen["headings"].as_array().map_or_else(
            || vec![mode.to_owned()],
            |headings| {
                headings
                    .iter()
                    .map(|heading| heading["title"].as_str().unwrap().to_owned())
                    .collect()
            },
        );
        let known = headings(snapshot["mode"].as_str().unwrap());
        if known
            .iter()
            .any(|known| mode == *known || shown.iter().any(|shown| shown == known))
        {
            return;
        }
        tries += 1;
        assert!(
            tries < 50,
            "the screen shows {shown:?}, the kernel is in {}",
            snapshot["mode"]
        );
        std::thread::sleep(Duration::from_millis(40));
    }
}
