//! Any bytes are a PLC source: compiling never panics, every error has its place, and there is a program
//! exactly when there is no error. A zero byte separates the main file from a second one.
//!
//! ```text
//! cargo +nightly fuzz run compile_plc
//! ```

#![no_main]

use bahn_fuzz as _;
use bahn_parameters::ControlModel;
use bahn_plc::{Compilation, MemoryFiles, Options};
use libfuzzer_sys::fuzz_target;

fuzz_target!(|bytes: &[u8]| {
    let (main, second) = match bytes.iter().position(|byte| *byte == 0) {
        Some(end) => (&bytes[..end], &bytes[end + 1..]),
        None => (bytes, &[][..]),
    };
    let files = MemoryFiles::from([("MAIN.PLC", main), ("SECOND.PLC", second)]);
    let tolerant = Options::for_model(ControlModel::Tnc407);
    for options in [tolerant, tolerant.strict()] {
        let compilation = Compilation::compile(&files, "MAIN.PLC", options);
        assert_eq!(compilation.program.is_some(), compilation.errors.is_empty());
        for report in compilation.errors.iter().chain(&compilation.warnings) {
            assert!(report.span.line >= 1 && report.span.column >= 1, "{report:?}");
        }
        if let Some(program) = compilation.program {
            assert!(
                !program
                    .code
                    .iter()
                    .any(|instruction| program.file_name(instruction.file).is_empty())
            );
        }
    }
});
