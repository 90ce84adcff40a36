//! What the tests of this room share: programs of the repository, runs, and the way there and back.
#![allow(dead_code, reason = "each test uses part of it")]

use std::path::{Path, PathBuf};
use std::sync::Arc;
use std::sync::atomic::AtomicBool;

use bahn_convert::{Converted, Language, Options, Proof, convert, gcode, prove};
use bahn_interpreter::{Interpreter, Programs, Settings};
use bahn_parameters::ControlModel;
use bahn_program::{FormatOptions, Program};

/// The folder of the repository.
pub fn root() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("../../..")
}

/// All programs of the repository with this ending, in a fixed order.
pub fn programs(ending: &str) -> Vec<PathBuf> {
    let mut found = Vec::new();
    for folder in ["examples", "machines", "crates"] {
        collect(&root().join(folder), ending, &mut found);
    }
    found.sort();
    found
}

fn collect(folder: &Path, ending: &str, found: &mut Vec<PathBuf>) {
    let Ok(entries) = std::fs::read_dir(folder) else {
        return;
    };
    for path in entries.filter_map(|entry| Some(entry.ok()?.path())) {
        if path.is_dir() {
            collect(&path, ending, found);
        } else if path.extension().is_some_and(|of| of.eq_ignore_ascii_case(ending)) {
            found.push(path);
        }
    }
}

/// Programs beside a file.
#[derive(Clone)]
pub struct Folder(pub PathBuf);

impl Programs for Folder {
    fn open(&self, name: &str, _caller: &str) -> Result<Option<Arc<Program>>, String> {
        for name in [name.to_owned(), format!("{name}.H"), format!("{name}.I")] {
            let path = self.0.join(&name);
            if let Ok(bytes) = std::fs::read(&path) {
                return Ok(Some(Arc::new(Program::from_bytes(name, bytes))));
            }
        }
        Ok(None)
    }
}

pub fn settings(model: ControlModel) -> Settings {
    Settings {
        model,
        ..Settings::default()
    }
}

/// A run of a program beside others.
pub fn run(program: &Program, settings: &Settings, folder: &Path) -> Interpreter {
    let library = Arc::new(Folder(folder.to_owned()));
    Interpreter::new(Arc::new(program.clone()), settings.clone(), library)
}

/// A program in a language.
pub fn program(text: &str, language: Language) -> Program {
    Program::from_bytes(format!("A.{}", language.ending()), text.as_bytes().to_vec())
}

pub fn options() -> Options<'static> {
    Options {
        format: FormatOptions {
            decimal_comma: false,
            iso_step: 10,
        },
        ..Options::default()
    }
}

/// Into the other language.
pub fn converted(source: &Program, to: Language) -> (Converted, Program) {
    let made = convert(source, to, &options());
    let program = program(&made.text, to);
    (made, program)
}

/// The proof that two programs do the same.
pub fn proof(source: &Program, target: &Program, settings: &Settings, folder: &Path) -> Proof {
    let (one, other) = (run(source, settings, folder), run(target, settings, folder));
    prove(one, other, settings.model, &Arc::new(AtomicBool::new(false)))
}

/// To ISO and back: nothing is refused, and the path is the same each time.
#[track_caller]
pub fn there_and_back(source: &Program, settings: &Settings, folder: &Path) -> Proof {
    let (made, iso) = converted(source, Language::Iso);
    assert!(made.refused.is_empty(), "{}: {:?}", source.name(), made.refused);
    let (back, plain) = converted(&iso, Language::Plain);
    assert!(
        back.refused.is_empty(),
        "{}: {:?}\n{}",
        source.name(),
        back.refused,
        made.text
    );
    let there = proof(source, &iso, settings, folder);
    assert!(there.holds(), "{}: {there:?}\n{}", source.name(), made.text);
    let and_back = proof(source, &plain, settings, folder);
    assert!(and_back.holds(), "{}: {and_back:?}\n{}", source.name(), back.text);
    assert_eq!(there.elements, and_back.elements);
    there
}

/// The program for LinuxCNC of a program, and the proof that it is the same path.
pub fn gcode(source: &Program, settings: &Settings, folder: &Path) -> (gcode::GCode, Proof) {
    gcode_with(source, settings, folder, false)
}

/// [`gcode`], with functions of the machine builder as those of LinuxCNC's user or without.
pub fn gcode_with(
    source: &Program,
    settings: &Settings,
    folder: &Path,
    user_functions: bool,
) -> (gcode::GCode, Proof) {
    let options = gcode::Options {
        model: settings.model,
        unit: source.unit(),
        comments: true,
        rapid_mm_min: 15_000.0,
        user_functions,
    };
    let begin = || run(source, settings, folder);
    let stop = Arc::new(AtomicBool::new(false));
    let made = gcode::write(&begin, &options, &stop);
    let proof = gcode::prove(&begin, &made.text, "A.ngc", &options, &stop);
    (made, proof)
}
