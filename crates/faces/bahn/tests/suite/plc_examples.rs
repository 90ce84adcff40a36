//! The example programs under examples/plc/ with their stimuli scripts.

use std::path::Path;

use crate::support::Folder;

#[test]
fn all_examples_meet_their_expectations() {
    let examples = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../../examples/plc");
    let folder = Folder::new();
    let mut count = 0;
    for entry in std::fs::read_dir(&examples).unwrap() {
        let program = entry.unwrap().path();
        if program.extension().is_none_or(|extension| extension != "PLC") {
            continue;
        }
        let script = program.with_extension("txt");
        let text = std::fs::read_to_string(&script).unwrap();
        assert!(
            text.matches("expect").count() >= 4,
            "{} expects little",
            script.display()
        );
        let output = folder
            .command()
            .args(["plc", "run"])
            .arg(&program)
            .arg("--script")
            .arg(&script)
            .output()
            .unwrap();
        let said = String::from_utf8_lossy(&output.stderr);
        assert!(output.status.success(), "{}\n{said}", program.display());
        count += 1;
    }
    assert!(count >= 8, "{count} examples");
}
