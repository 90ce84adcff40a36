//! Any bytes are what a control remembers, and are written as they were read, or are refused. They count as
//! mended by hand, so that more than the check sum is tried.
//!
//! ```text
//! cargo +nightly fuzz run read_state
//! ```

#![no_main]

use bahn_fuzz as _;
use libfuzzer_sys::fuzz_target;

fuzz_target!(|bytes: &[u8]| {
    for file in [bytes.to_vec(), [bytes, b"\n# end, check by hand\n"].concat()] {
        assert_ne!(bahn::check_state(&file), Some(false));
    }
});
