//! The mill, switched on.
#![allow(dead_code, reason = "every test file uses its part")]
#![allow(
    clippy::unwrap_used,
    reason = "what fails in the support of tests fails the test"
)]

mod copy;

use std::path::{Path, PathBuf};
use std::sync::Arc;

use bahn_host::{Attendance, Host, Job, LoadedMachine, Operator, PowerOn};
use bahn_program::Program;
use bahn_tnc::Programs;
use copy::copy;

/// Programs from texts.
pub struct Texts(Vec<Arc<Program>>);

impl Texts {
    pub fn new(texts: &[(&str, &str)]) -> Arc<Texts> {
        let program = |(name, blocks): &(&str, &str)| {
            let text = format!("BEGIN PGM 1 MM\n{blocks}\nEND PGM 1 MM\n");
            Arc::new(Program::from_bytes(*name, text.into_bytes()))
        };
        Arc::new(Texts(texts.iter().map(program).collect()))
    }
}

impl Programs for Texts {
    fn open(&self, name: &str, _: &str) -> Result<Option<Arc<Program>>, String> {
        Ok(self.0.iter().find(|program| program.name() == name).cloned())
    }
}

/// A shipped machine.
pub fn machine(name: &str) -> LoadedMachine {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR"))
        .join("../../../machines")
        .join(name);
    LoadedMachine::load(&folder).unwrap().unwrap()
}

/// The mill with a program that the operator starts.
pub fn mill(blocks: &str) -> Host {
    let machine = machine("mill");
    host(&machine, PowerOn::fresh(&machine), blocks)
}

/// A machine with a program that the operator starts.
pub fn host(machine: &LoadedMachine, power_on: PowerOn, blocks: &str) -> Host {
    let operator = Operator::new(
        Attendance::Full,
        machine.folder.operator.clone(),
        Some(Job::whole("1.H")),
    );
    Host::new(machine, power_on, Texts::new(&[("1.H", blocks)]), operator).unwrap()
}

/// Steps for so many seconds of the machine.
pub fn seconds(host: &mut Host, seconds: f64) {
    let end_us = host.control().time_us() + (seconds * 1e6) as u64;
    while host.control().time_us() < end_us {
        host.step().unwrap();
    }
}

/// A folder that is removed in the end, with a copy of a machine in it.
pub struct Copy(PathBuf);

impl Copy {
    pub fn of(name: &str, what: &str) -> Copy {
        let path = std::env::temp_dir().join(format!("bahn-host-{what}-{}", std::process::id()));
        let from = Path::new(env!("CARGO_MANIFEST_DIR"))
            .join("../../../machines")
            .join(name);
        copy(&from, &path);
        Copy(path)
    }

    /// A copy of any machine's folder.
    pub fn of_folder(from: &Path, what: &str) -> Copy {
        let path = std::env::temp_dir().join(format!("bahn-host-{what}-{}", std::process::id()));
        copy(from, &path);
        Copy(path)
    }

    pub fn path(&self) -> &Path {
        &self.0
    }
}

impl Drop for Copy {
    fn drop(&mut self) {
        let _ = std::fs::remove_dir_all(&self.0);
    }
}

/// A copy of the mill that runs its PLC program in the form of the TNC 355, as machines/mill/README.md says.
pub fn old_mill() -> (Copy, LoadedMachine) {
    let copy = Copy::of("mill", "tnc355");
    let edit = |file: &str, edits: &[(&str, &str)]| {
        let path = copy.path().join(file);
        let mut text = std::fs::read_to_string(&path).unwrap();
        for (from, to) in edits {
            assert!(text.contains(from), "{file}: {from}");
            text = text.replacen(from, to, 1);
        }
        std::fs::write(path, text).unwrap();
    };
    edit(
        "machine.toml",
        &[("plc = \"plc/MAIN.PLC\"", "plc = \"plc355/MAIN.PLC\"")],
    );
    edit(
        "parameters.mp",
        &[
            ("MP4210.1 : 0\n", "MP4210.1 : 440\n"),
            ("MP4210.2 : 0\n", "MP4210.2 : 300\n"),
            ("MP4210.3 : 0\n", "MP4210.3 : 100\n"),
            ("MP4210.4 : 0\n", "MP4210.4 : 200\n"),
            ("MP4210.31: 0\n", "MP4210.31: 90\n"),
            ("MP4210.32: 0\n", "MP4210.32: 5\n"),
        ],
    );
    let machine = LoadedMachine::load(copy.path()).unwrap().unwrap();
    (copy, machine)
}
