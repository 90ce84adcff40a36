//! Any bytes are a lesson for a machine, or errors that name their lines.
//!
//! ```text
//! cargo +nightly fuzz run read_lesson
//! ```

#![no_main]

use std::sync::LazyLock;

use bahn_fuzz as _;
use bahn_machine::Machine;
use bahn_parameters::{ControlModel, ParameterList};
use libfuzzer_sys::fuzz_target;

static STAGE: LazyLock<(Machine, ParameterList)> = LazyLock::new(|| {
    let machine = Machine::from_toml(
        "name = 'one'\n[keys]\nNC_START = 'I1'\n[emergency_stop]\nacknowledgement = 'I3'\n\
         [axis.X]\noutput = '1'\nspeed = 15000\nvolts = 9\nencoder = { input = 'X1', period_um = 20 }",
    )
    .expect("the machine");
    (machine, ParameterList::reference(ControlModel::Tnc415b))
});

fuzz_target!(|bytes: &[u8]| {
    // The text may be UTF-16: it has no more lines than bytes. What is missing is told of line 1.
    let (machine, parameters) = &*STAGE;
    if let Err(lines) = bahn_panel::check_lesson(machine, parameters, bytes) {
        assert!(
            !lines.is_empty()
                && lines
                    .iter()
                    .all(|line| (1..=bytes.len().max(1) as u32).contains(line))
        );
    }
});
