//! Any bytes open as a journal of retained PLC memory or are refused; what was damaged is whole then, and
//! was set aside before.
//!
//! ```text
//! cargo +nightly fuzz run read_journal
//! ```

#![no_main]

use bahn_exchange::{JOURNAL_LENGTH, MemoryStorage, Retention};
use bahn_fuzz as _;
use libfuzzer_sys::fuzz_target;

fuzz_target!(|bytes: &[u8]| {
    let storage = MemoryStorage {
        content: Some(bytes.to_vec()),
        aside: Vec::new(),
    };
    if let Ok(retention) = Retention::open(storage) {
        let damaged = retention.damage().is_some();
        let storage = retention.into_storage();
        let kept = storage.aside.iter().any(|aside| aside == bytes);
        assert!(!damaged || kept || bytes.iter().all(|byte| *byte == 0));
        let content = storage.content.expect("the journal");
        assert_eq!(content.len(), JOURNAL_LENGTH);
        let again = Retention::open(MemoryStorage {
            content: Some(content),
            aside: Vec::new(),
        });
        assert!(again.is_ok_and(|retention| retention.damage().is_none()));
    }
});
