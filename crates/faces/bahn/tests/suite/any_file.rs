//! Whatever stands in the files of a machine: it is read, or refused with its place. The targets under `fuzz/`
//! try the same for longer.

use bahn_machine::{Machine, MachineFolder};
use bahn_tnc::{CompensationAssignment, CompensationTable, CorrectionTables};
use proptest::prelude::*;

/// Lines made of what such files are made of, and of anything.
fn text() -> impl Strategy<Value = String> {
    let word = prop_oneof![
        "[TLRPXYZ0-9=;,.+\\[\\]{}\"' -]{0,6}",
        Just("time [s]".to_owned()),
        Just("MM DATUM 0 DIST 16".to_owned()),
        Just("ACTIVE".to_owned()),
        Just("\t".to_owned()),
        "[a-z_]{1,10} = ",
        any::<String>(),
    ];
    let line = prop::collection::vec(word, 0..5).prop_map(|words| words.concat());
    prop::collection::vec(line, 0..12).prop_map(|lines| lines.join("\n"))
}

/// A shipped file with some bytes exchanged.
fn mutated(file: &'static str) -> impl Strategy<Value = String> {
    let changes = prop::collection::vec((any::<prop::sample::Index>(), any::<u8>()), 1..6);
    changes.prop_map(move |changes| {
        let mut bytes = file.as_bytes().to_vec();
        for (at, byte) in changes {
            let at = at.index(bytes.len());
            bytes[at] = byte;
        }
        String::from_utf8_lossy(&bytes).into_owned()
    })
}

/// A file of the shipped mill.
fn mill(file: &str) -> &'static str {
    bahn_machines::MILL.file(file).unwrap()
}

fn tables(text: &str) -> Result<(), TestCaseError> {
    let [datums, pallets] = bahn::check_nc_tables(text);
    for faults in [bahn::check_tool_table(text), datums, pallets]
        .into_iter()
        .filter_map(Result::err)
    {
        let lines = text.lines().count();
        prop_assert!(!faults.is_empty() && faults.iter().all(|line| *line as usize <= lines));
    }
    Ok(())
}

proptest! {
    #![proptest_config(ProptestConfig { failure_persistence: None, ..ProptestConfig::default() })]

    #[test]
    fn any_text(text in text()) {
        tables(&text)?;
        tables(&format!("NR X Y 4\n{text}"))?;
        tables(&format!("NR PGM DATUM\n{text}"))?;
        let lines = text.lines().count();
        for line in [
            CompensationTable::read(&text).err().map(|error| error.line),
            CompensationAssignment::read(&text).err().map(|error| error.line),
            CorrectionTables::read(&text).err().map(|error| error.line),
            CorrectionTables::read(&format!("X OVER X MM DATUM 0 DIST 16\n0 0\n{text}")).err().map(|error| error.line.saturating_sub(2)),
        ].into_iter().flatten() {
            prop_assert!(line <= lines.max(1), "{}", line);
        }
        if let Err(error) = bahn::check_recording(&text) {
            let line: usize = error.split(':').next().unwrap().parse().unwrap();
            prop_assert!((1..=lines.max(1) + 1).contains(&line), "{}", error);
        }
        prop_assert_ne!(bahn::check_state(format!("{text}\n# end, check by hand\n").as_bytes()), Some(false));
        let (_, faults) = MachineFolder::read(&text);
        prop_assert!(faults.iter().all(|fault| fault.span.line >= 1 && fault.span.column >= 1));
    }

    #[test]
    fn damaged_files_of_a_machine(folder in mutated(mill("machine.toml")), plant in mutated(mill("plant.toml")), tools in mutated(mill("tools.tsv"))) {
        let (_, faults) = MachineFolder::read(&folder);
        prop_assert!(faults.iter().all(|fault| fault.span.line >= 1 && fault.span.column >= 1));
        if let Err(faults) = Machine::from_toml(&plant) {
            prop_assert!(!faults.is_empty() && faults.iter().all(|fault| fault.span.line >= 1));
        }
        tables(&tools)?;
    }
}
