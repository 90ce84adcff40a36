//! Any text is the description of a machine or faults with their places; any lines behind a `%%%` are events
//! that are done or refused, and the machine runs on.
//!
//! ```text
//! cargo +nightly fuzz run machine
//! ```

#![no_main]

use bahn_fuzz as _;
use bahn_machine::Machine;
use libfuzzer_sys::fuzz_target;

fuzz_target!(|text: &str| {
    let (description, events) = text.split_once("%%%").unwrap_or((text, ""));
    match Machine::from_toml(description) {
        Err(faults) => assert!(faults.iter().all(|fault| fault.span.line >= 1 && fault.span.column >= 1)),
        Ok(mut machine) => {
            machine.set_control_ready(true);
            for event in events.lines().take(100) {
                let _ = machine.apply(event);
                machine.set_nominal(0, 5.0);
                machine.advance(5_000);
            }
            assert!(machine.axes().all(|axis| axis.position.is_finite()));
        }
    }
});
