//! The machines under machines/: everything in a folder can be read, and does what it should.

use std::fs;
use std::path::{Path, PathBuf};
use std::process::Output;

use crate::support::Folder;
use bahn_machine::{Folder900, Machine, MachineFolder};

/// Those with a TNC that run by themselves: a positioning module is tried with its control, a System 900 has tests of its own.
fn machines() -> Vec<(PathBuf, MachineFolder)> {
    let root = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../../machines");
    let mut machines = Vec::new();
    for entry in fs::read_dir(root).unwrap() {
        let path = entry.unwrap().path();
        if !path.is_dir() {
            continue;
        }
        let text = fs::read_to_string(path.join(MachineFolder::FILE)).unwrap();
        if Folder900::named_at(&text).is_some() {
            continue;
        }
        let folder = MachineFolder::from_toml(&text).unwrap();
        if folder.module.is_none() {
            machines.push((path, folder));
        }
    }
    assert!(machines.len() >= 2);
    machines
}

/// Files of a folder with an extension.
fn files(folder: &Path, extension: &str) -> Vec<PathBuf> {
    let entries = fs::read_dir(folder).unwrap();
    let paths = entries.map(|entry| entry.unwrap().path());
    paths
        .filter(|path| path.extension().is_some_and(|own| own == extension))
        .collect()
}

fn said(output: &Output) -> String {
    let text = |bytes: &[u8]| String::from_utf8_lossy(bytes).into_owned();
    text(&output.stderr) + &text(&output.stdout)
}

#[test]
fn the_plants_can_be_built() {
    for (path, folder) in machines() {
        let text = fs::read_to_string(path.join(folder.plant.unwrap())).unwrap();
        let machine = Machine::from_toml(&text).unwrap();
        assert!(folder.datum.iter().all(|(axis, _)| machine.axis(*axis).is_some()));
    }
}

#[test]
fn the_plc_programs_meet_the_expectations_of_their_scripts() {
    // The standard PLC program of a control has its own tests.
    for (path, folder) in machines() {
        let Some(plc) = folder.plc_file() else { continue };
        let scripts = files(&path.join("plc"), "txt");
        assert!(!scripts.is_empty());
        for script in scripts {
            let output = Folder::new()
                .command()
                .args(["plc", "run", "--model", &folder.model, "--parameters"])
                .arg(path.join(&folder.parameters))
                .arg("--script")
                .arg(&script)
                .arg(path.join(plc))
                .output()
                .unwrap();
            assert!(output.status.success(), "{}\n{}", script.display(), said(&output));
        }
    }
}

#[test]
fn every_message_of_the_plc_has_its_text() {
    for (path, folder) in machines() {
        let Some(plc) = folder.plc_file() else { continue };
        let program = fs::read_to_string(path.join(plc)).unwrap();
        let count: usize = program
            .rsplit_once(">= K+")
            .and_then(|(_, rest)| rest.split_whitespace().next()?.parse().ok())
            .unwrap();
        let texts = fs::read_to_string(path.join(folder.plc_messages.unwrap())).unwrap();
        assert_eq!(texts.lines().count(), count);
        // The header line of the screen.
        assert!(texts.lines().all(|text| !text.is_empty() && text.len() <= 40));
    }
}

#[test]
fn the_part_programs_run_without_a_warning() {
    for (path, folder) in machines() {
        let programs = files(&path.join(&folder.programs), "H");
        assert!(!programs.is_empty());
        for program in programs {
            let output = Folder::new()
                .command()
                .args([
                    "test",
                    "--format",
                    "json",
                    "--model",
                    &folder.model,
                    "--parameters",
                ])
                .arg(path.join(&folder.parameters))
                .arg("--tools")
                .arg(path.join(folder.tools.as_deref().unwrap()))
                .arg(&program)
                .output()
                .unwrap();
            assert!(
                output.status.success(),
                "{}\n{}",
                program.display(),
                said(&output)
            );
            let report: serde_json::Value = serde_json::from_slice(&output.stdout).unwrap();
            // What a test run cannot show, feel or keep, it says: a table or head that turns and a tool that leans, a tool probe,
            // points.
            let else_said = |warning: &&serde_json::Value| {
                let message = warning["message"].as_str().unwrap_or_default();
                let turns = ["Gantry", "Twin"]
                    .iter()
                    .any(|name| folder.name.starts_with(name));
                !(turns && message.starts_with("PGM SECTION CANNOT BE SHOWN: ")
                    || message.starts_with("a test run has no tool probe")
                    || message.ends_with("--digitized names a folder"))
            };
            let warnings: Vec<_> = report["warnings"]
                .as_array()
                .unwrap()
                .iter()
                .filter(else_said)
                .collect();
            assert!(warnings.is_empty(), "{}: {warnings:?}", program.display());
        }
    }
}
