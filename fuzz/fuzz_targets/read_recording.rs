//! Any text is a recording, or an error with its line.
//!
//! ```text
//! cargo +nightly fuzz run read_recording
//! ```

#![no_main]

use bahn_fuzz as _;
use libfuzzer_sys::fuzz_target;

fuzz_target!(|text: &str| {
    if let Err(error) = bahn::check_recording(text) {
        let line: usize = error
            .split(':')
            .next()
            .and_then(|line| line.parse().ok())
            .expect("the line");
        assert!((1..=text.lines().count().max(1) + 1).contains(&line), "{error}");
    }
});
