//! The folder of a machine with a System 900 with its PLC program: every fault of `plc` and `window` at its line and column, all at once.

use std::path::{Path, PathBuf};

use bahn_host::Machine900;

const DATA: &str = "q102: 10000\nq103: 1000\nq110: $01010058\nq111: $02020059\nq2000: 1\nq2200: 1\n";

/// A folder of its own, which goes with the test.
struct Folder(PathBuf);

impl Folder {
    fn new(name: &str, window: &str, program: &str) -> Folder {
        let path = std::env::temp_dir().join(format!("bahn-plc900-{name}-{}", std::process::id()));
        let _ = std::fs::remove_dir_all(&path);
        std::fs::create_dir_all(&path).unwrap();
        let folder = Folder(path);
        let toml = format!(
            "name = 'p'\ncontrol = 'system900'\nparameters = 'p.q'\nplc = 'MAIN.PLC'\nwindow = [\n{window}\n]\n"
        );
        for (file, text) in [
            ("machine.toml", toml.as_str()),
            ("p.q", DATA),
            ("MAIN.PLC", program),
        ] {
            std::fs::write(folder.0.join(file), text).unwrap();
        }
        folder
    }

    fn faults(&self) -> Vec<String> {
        let faults = Machine900::load(&self.0).unwrap().err().unwrap_or_default();
        let said = faults.iter().map(|fault| {
            let file = fault.file.file_name().unwrap_or_default().to_string_lossy();
            format!(
                "{file}:{}:{}: {}",
                fault.span.line, fault.span.column, fault.message
            )
        });
        said.collect()
    }
}

impl Drop for Folder {
    fn drop(&mut self) {
        let _ = std::fs::remove_dir_all(&self.0);
    }
}

#[test]
fn all_faults_come_at_once() {
    let window = "\"SAFREK1 = M300\",\n\"SAFREC1 = M301\",\n\"SAFREK2 = M302\",\n\"SAFREK1 = M303\",\n\"KAFR_K1 = M300\",\n\
                  \"REOK_K1 = D4\",\n\"BA_K1 = M4\",\n\"STARTK1 = M2045\",\n\"P500-P503 = D1012\",\n\"P8685 = W6\",\n\"P9 P10\",\n\
                  \"M7-M3 = M400\",\n\"2:M7 = M400\",\n\"AAST_K1 = M310\"";
    let program = "       L     I4\n       = M310\n       L     T5\n       CM    9120\n       L     M2045\n       = M300\n       EM\n";
    let folder = Folder::new("faults", window, program);
    assert_eq!(
        folder.faults(),
        [
            "machine.toml:7:2: `SAFREC1` is no marker of the table, no parameter and no M function; did you mean `SAFREK1`?",
            "machine.toml:8:2: `SAFREK2`: there is no channel 2, they are 1 to 1",
            "machine.toml:9:2: SAFREK1 stands in the window already, at M300",
            "machine.toml:10:12: M300 is taken already, by SAFREK1",
            "machine.toml:11:12: `D4` is no marker of the PLC: REOK_K1 stands at one, M0 to M1999",
            "machine.toml:12:10: `M4` is no double word of the PLC: BA_K1 stands at one, D0 to D1020",
            "machine.toml:13:12: M2045: free markers are M0 to M1999",
            "machine.toml:14:14: P503 would stand at D1024: double words are D0 to D1020",
            "machine.toml:15:10: `W6` is no double word of the PLC: P8685 stands at one, D0 to D1020",
            "machine.toml:16:2: a window has entries as \"SAFREK1 = M300\", \"P8050-P8064 = D200\", \"M3-M9 = M403\"",
            "machine.toml:17:2: M functions are M0 to M999, the lower number first",
            "machine.toml:18:2: there is no channel 2, they are 1 to 1",
            "MAIN.PLC:3:14: T5: timers and counters have their presets in machine parameters of a TNC; count the cycles in a word",
            "MAIN.PLC:4:14: module 9120 asks a TNC: a System 900 has none",
            "MAIN.PLC:5:14: M2045 is a marker of the interface of a TNC; here `window` says which markers are which parameters",
            "MAIN.PLC:2:10: M310 is AAST_K1, which the control gives: the PLC reads it alone",
        ]
    );
}

/// Errors of the compiler stand beside those of the window; a window needs a program.
#[test]
fn errors_of_the_compiler_are_faults() {
    let folder = Folder::new(
        "compiler",
        "\"LUCK1 = M1\"",
        "       L     I4\n       A     W8\n       EM\n",
    );
    let faults = folder.faults();
    assert_eq!(faults.len(), 2, "{faults:?}");
    assert!(faults[0].starts_with("machine.toml:6:2: `LUCK1`"), "{faults:?}");
    assert!(faults[1].starts_with("MAIN.PLC:2:"), "{faults:?}");
    let toml = folder.0.join("machine.toml");
    let text = std::fs::read_to_string(&toml).unwrap();
    std::fs::write(&toml, text.replace("plc = 'MAIN.PLC'", "plc = 'OTHER.PLC'")).unwrap();
    let faults = folder.faults();
    assert!(
        faults.iter().any(|fault| fault.starts_with("machine.toml:4:7:")),
        "{faults:?}"
    );
    std::fs::write(&toml, text.replace("plc = 'MAIN.PLC'", "")).unwrap();
    let faults = folder.faults();
    assert!(
        faults.iter().any(|fault| fault.contains("`plc` names none")),
        "{faults:?}"
    );
}

/// What the program does not name is a warning; with a program no answers are given, unless they are named.
#[test]
fn a_program_takes_the_place_of_the_answers() {
    let folder = Folder::new(
        "fine",
        "\"REOK_K1 = M300\",\n\"KAFR_K1 = M301\"",
        "       L     I3\n       = M300\n       EM\n",
    );
    let machine = Machine900::load(&folder.0)
        .unwrap()
        .unwrap_or_else(|faults| panic!("{faults:?}"));
    let warnings: Vec<String> = machine
        .warnings()
        .iter()
        .map(|warning| warning.message.clone())
        .collect();
    assert!(
        warnings.contains(&"the PLC program does not name M301, KAFR_K1".to_owned()),
        "{warnings:?}"
    );
    assert!(machine.plc.is_some() && !machine.answers().enable);
}

/// The shipped portal has neither faults nor warnings of its PLC.
#[test]
fn the_portal_goes_together() {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../../machines/portal900");
    let machine = Machine900::load(&folder)
        .unwrap()
        .unwrap_or_else(|faults| panic!("{faults:?}"));
    let warnings = machine.warnings();
    assert!(warnings.is_empty(), "{warnings:?}");
}
