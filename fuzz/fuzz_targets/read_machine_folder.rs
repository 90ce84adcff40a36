//! Any text is the description of a machine's folder as far as it can be understood, with all faults at their
//! places.
//!
//! ```text
//! cargo +nightly fuzz run read_machine_folder
//! ```

#![no_main]

use bahn_fuzz as _;
use bahn_machine::MachineFolder;
use libfuzzer_sys::fuzz_target;

fuzz_target!(|text: &str| {
    let (_, faults) = MachineFolder::read(text);
    assert!(faults.iter().all(|fault| fault.span.line >= 1 && fault.span.column >= 1));
});
