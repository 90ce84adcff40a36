//! The campaign on a machine with a TNC.
//!
//! `bench` runs a program undisturbed, `course` is a trial on its way: `axes`, `ways`, `led`, `messages` judge its cycles, `recovery` puts
//! everything back, `medium` breaks what is written at power-off.

mod axes;
mod bench;
mod catalogue;
mod course;
mod led;
mod medium;
mod messages;
mod recovery;
mod ways;

use std::path::Path;

use bahn_host::{Action, HostError, LoadedMachine};

use self::bench::TncBench;
use super::catalogue::{Catalogue, Mishap};
use super::family::{Bench, Refused, Tried};
use super::plan::{Happening, Plan};
use super::trial::Trial;

/// A machine with a TNC.
pub(super) struct Tnc(LoadedMachine);

impl Tnc {
    /// A machine, and what can happen to it.
    ///
    /// # Errors
    /// When its folder describes no simulated machine.
    pub fn of(machine: LoadedMachine) -> Result<(Tnc, Catalogue), HostError> {
        let keys = catalogue::start_keys(&machine);
        let catalogue = catalogue::catalogue(machine.simulated()?, &keys);
        Ok((Tnc(machine), catalogue))
    }

    /// All programs of the first channel but those that other channels run.
    ///
    /// # Errors
    /// When the folder of its programs cannot be read.
    pub fn programs(machine: &LoadedMachine) -> Result<Vec<String>, HostError> {
        let others = (1..=machine.channels.len()).filter_map(|other| machine.usual_program(other));
        let mut programs = programs_in(&machine.programs(0))?;
        programs.retain(|name| !others.clone().any(|other| other == name));
        Ok(programs)
    }
}

impl Tried for Tnc {
    fn name(&self) -> &str {
        &self.0.folder.name
    }

    fn bench(&self, program: &str) -> Result<Box<dyn Bench>, Refused> {
        Ok(Box::new(TncBench::new(&self.0, program)?))
    }

    fn could_happen(&self, what: &str) -> Result<(), String> {
        Action::parse(what).map(drop).map_err(|error| error.to_string())
    }
}

impl Bench for TncBench {
    fn moments_us(&self) -> Vec<u64> {
        self.moments.iter().map(|moment| moment.time_us()).collect()
    }

    fn turns(&self) -> Vec<Mishap> {
        let led = self.led.iter();
        led.flat_map(|led| catalogue::turns(led.wheels())).collect()
    }

    fn run(&mut self, catalogue: &Catalogue, plan: &Plan, happenings: &[Happening]) -> Trial {
        course::run(self, catalogue, plan, happenings)
    }
}

/// The programs of a folder, by name.
fn programs_in(folder: &Path) -> Result<Vec<String>, HostError> {
    let entries =
        std::fs::read_dir(folder).map_err(|error| bahn_host::files::cannot("read", folder, &error))?;
    let names = entries
        .flatten()
        .map(|entry| entry.file_name().to_string_lossy().into_owned());
    let mut names: Vec<String> = names
        .filter(|name| name.ends_with(".H") || name.ends_with(".h"))
        .collect();
    names.sort();
    if names.is_empty() {
        return Err(HostError::File(format!(
            "there is no program in {}",
            folder.display()
        )));
    }
    Ok(names)
}
