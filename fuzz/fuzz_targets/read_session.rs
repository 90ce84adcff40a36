//! Any bytes are a session, whole or cut off, or an error with its line.
//!
//! ```text
//! cargo +nightly fuzz run read_session
//! ```

#![no_main]

use bahn_fuzz as _;
use libfuzzer_sys::fuzz_target;

fuzz_target!(|bytes: &[u8]| {
    let lines = bytes.split(|byte| *byte == b'\n').count();
    match bahn_panel::check_session(bytes) {
        Ok(inputs) => assert!(inputs < lines),
        Err(line) => assert!((1..=lines).contains(&line)),
    }
});
