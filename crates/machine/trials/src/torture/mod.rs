//! The fault campaign: the programs of a machine run while random things happen to it, and every contour cycle is held
//! to rules.
//!
//! A seed says everything: the program, the moment of its undisturbed run, and what happens from there on ([`Plan`]). A
//! [`Campaign`] knows a machine; each of its [`Worker`]s, one for a thread, tries seeds one after another, and tells
//! what came of each as a [`Trial`]. Of a seed that breaks a [`Rule`] it finds the few happenings that do it.

mod axes;
mod bench;
mod catalogue;
mod contour;
mod dice;
mod led;
mod medium;
mod messages;
mod plan;
mod recovery;
mod rule;
mod shrink;
mod trial;
mod ways;

use std::fmt::Write as _;
use std::path::Path;
use std::sync::OnceLock;

pub use catalogue::Kind;
pub use plan::{Happening, Plan};
pub use rule::{Rule, Violation};
pub use trial::Trial;

use bahn_host::Action;
use bahn_host::HostError;
use bahn_host::LoadedMachine;
use bahn_text::Diagnostic;
use bench::{Bench, Refused};
use catalogue::Catalogue;
use plan::{Choice, Scene};
use serde::Serialize;

/// A machine that is tried, and its programs.
pub struct Campaign {
    machine: LoadedMachine,
    catalogue: Catalogue,
    programs: Vec<String>,
    /// Programs must be tried because they are named.
    are_named: bool,
    left_out: OnceLock<Vec<LeftOut>>,
}

/// A program of the folder that is not tried.
#[derive(Clone, Debug, PartialEq, Eq, Serialize)]
pub struct LeftOut {
    /// Its file name.
    pub program: String,
    /// What it waits for, undisturbed.
    pub why: String,
}

impl Campaign {
    /// Takes a machine with all programs of its first channel, or with those that are named. The other channels run their own.
    ///
    /// # Errors
    /// When the folder of its programs cannot be read.
    pub fn new(machine: LoadedMachine, named: &[String]) -> Result<Campaign, HostError> {
        let mut programs = named.to_vec();
        if named.is_empty() {
            let others = (1..=machine.channels.len()).filter_map(|other| machine.usual_program(other));
            programs = programs_in(&machine.programs(0))?;
            programs.retain(|name| !others.clone().any(|other| other == name));
        }
        Ok(Campaign {
            catalogue: Catalogue::of(&machine, machine.simulated()?),
            machine,
            programs,
            are_named: !named.is_empty(),
            left_out: OnceLock::new(),
        })
    }

    /// Loads the machine of a folder; the inner `Err` holds every fault of every file.
    ///
    /// # Errors
    /// When there is no such folder, or its programs cannot be read.
    pub fn load(folder: &Path, named: &[String]) -> Result<Result<Campaign, Vec<Diagnostic>>, HostError> {
        Ok(match LoadedMachine::load(folder)? {
            Ok(machine) => Ok(Campaign::new(machine, named)?),
            Err(faults) => Err(faults),
        })
    }

    /// Adds an event of the machine's own to what the PLC does not expect: operands, as a script has them. A marker by which
    /// a copy of the PLC program is made to fail, for example; power-off is to reset it.
    ///
    /// # Errors
    /// When a script could not have it.
    pub fn also(&mut self, what: &str) -> Result<(), HostError> {
        for part in what.split(',') {
            Action::parse(part.trim()).map_err(|error| HostError::File(format!("{part}: {error}")))?;
        }
        self.catalogue.also(what);
        Ok(())
    }

    /// The name of the machine.
    pub fn name(&self) -> &str {
        &self.machine.folder.name
    }

    /// File names of the programs, with those that are left out.
    pub fn programs(&self) -> &[String] {
        &self.programs
    }

    /// Programs that are not tried because undisturbed they wait for what is not there; known with the first [`Worker`].
    pub fn left_out(&self) -> &[LeftOut] {
        self.left_out.get().map_or(&[], Vec::as_slice)
    }

    /// Somebody who tries seeds: every program is run once, undisturbed.
    ///
    /// # Errors
    /// When a program does not come to its end by itself. One that nobody has named and that waits for what is not there is
    /// left out, as long as another one is left.
    pub fn worker(&self) -> Result<Worker<'_>, HostError> {
        let (mut benches, mut left_out) = (Vec::new(), Vec::new());
        for (number, program) in self.programs.iter().enumerate() {
            match Bench::new(&self.machine, number, program) {
                Ok(bench) => benches.push(bench),
                Err(Refused::Fails(error)) => return Err(error),
                Err(Refused::Waits(why)) => left_out.push(LeftOut {
                    program: program.clone(),
                    why,
                }),
            }
        }
        if let Some(LeftOut { program, why }) = left_out.first()
            && (self.are_named || benches.is_empty())
        {
            return Err(HostError::File(format!(
                "{program} does not come to its end undisturbed: it {why}"
            )));
        }
        self.left_out.get_or_init(|| left_out);
        Ok(Worker {
            campaign: self,
            scenes: benches.iter().map(Scene::of).collect(),
            benches,
        })
    }

    /// What was done as a script: `bahn run` repeats it.
    pub fn script(&self, plan: &Plan, trial: &Trial, folder: &str) -> String {
        let program = self.programs.get(plan.program).map_or("", String::as_str);
        let mut text = format!(
            "; seed {} on {}\n; bahn run {program} --machine {folder} --fresh --operator full --script THIS-FILE\n",
            plan.seed,
            self.name()
        );
        if let Some(violation) = &trial.violation {
            let _ = writeln!(
                text,
                "; {} at {:.6}: {}",
                violation.rule.name(),
                violation.time_s,
                violation.values.replace('\n', " ")
            );
        }
        for happening in &trial.done {
            for part in happening.what.split(", ") {
                let _ = writeln!(text, "{:.6}: {part}", happening.time_us as f64 * 1e-6);
            }
        }
        text
    }
}

/// Somebody who tries seeds, made by [`Campaign::worker`].
pub struct Worker<'a> {
    campaign: &'a Campaign,
    benches: Vec<Bench>,
    scenes: Vec<Scene>,
}

impl Worker<'_> {
    /// What a seed says.
    pub fn plan(&self, seed: u64) -> Plan {
        let choice = Choice {
            catalogue: &self.campaign.catalogue,
            scenes: &self.scenes,
        };
        choice.plan(seed)
    }

    /// Runs the plan with all its happenings.
    pub fn run(&mut self, plan: &Plan) -> Trial {
        self.part(plan, &plan.happenings)
    }

    fn part(&mut self, plan: &Plan, happenings: &[Happening]) -> Trial {
        let mut benches = self.benches.iter_mut();
        match benches.find(|bench| bench.number == plan.program) {
            Some(bench) => trial::run(bench, &self.campaign.catalogue, plan, happenings),
            None => Trial::default(),
        }
    }

    /// The plan with the few happenings that break the same rule.
    pub fn shrink(&mut self, plan: &Plan, rule: Rule) -> Plan {
        let happenings = shrink::shrink(&plan.happenings, |part| {
            let violation = self.part(plan, part).violation;
            violation.is_some_and(|violation| violation.rule == rule)
        });
        Plan {
            happenings,
            ..plan.clone()
        }
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
