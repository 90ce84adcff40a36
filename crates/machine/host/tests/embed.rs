//! The example of how a machine is embedded does what it says.
#![allow(clippy::unwrap_used, reason = "a test may fail")]

#[path = "../examples/embed.rs"]
mod embed;

use std::path::Path;

#[test]
fn the_example_stops_and_goes_on() {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../../machines/mill");
    let mut out = Vec::new();
    embed::run(&folder, Path::new("CIRCLE.H"), &mut out).unwrap();
    let text = String::from_utf8(out).unwrap();
    let lines: Vec<&str> = text.lines().collect();
    let time_of = |what: &str| {
        let line = lines.iter().find(|line| line.contains(what)).unwrap();
        line.split(' ').next().unwrap().parse::<f64>().unwrap()
    };
    let (started, stopped) = (time_of("Running"), time_of("Interrupted"));
    // The key is scanned, and the axes brake.
    assert!((2.0..2.5).contains(&(stopped - started)), "{text}");
    let again = lines.iter().filter(|line| line.contains("Running")).count();
    assert_eq!(again, 2, "{text}");
    assert!(lines.last().unwrap().ends_with("the program has ended"), "{text}");
}

/// Sixty lines are enough.
#[test]
fn the_example_is_short() {
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("examples/embed.rs");
    assert!(std::fs::read_to_string(path).unwrap().lines().count() <= 60);
}
