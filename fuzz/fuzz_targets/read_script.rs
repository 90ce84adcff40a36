//! Any bytes are a script of stimuli for the PLC, or an error that names file and line.
//!
//! ```text
//! cargo +nightly fuzz run read_script
//! ```

#![no_main]

use bahn_fuzz as _;
use libfuzzer_sys::fuzz_target;

fuzz_target!(|bytes: &[u8]| {
    if let Err(error) = bahn::check_script("SCRIPT", bytes) {
        let line = error.strip_prefix("SCRIPT:").and_then(|rest| rest.split(':').next());
        let line: usize = line.and_then(|line| line.parse().ok()).expect("the line");
        assert!((1..=String::from_utf8_lossy(bytes).lines().count()).contains(&line), "{error}");
    }
});
