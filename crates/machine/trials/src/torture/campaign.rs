//! A campaign: a machine, its programs, and who tries seeds on it.

use std::fmt::Write as _;
use std::path::Path;
use std::sync::OnceLock;

use bahn_host::{HostError, LoadedMachine, Machine900};
use bahn_text::Diagnostic;
use serde::Serialize;

use super::catalogue::Catalogue;
use super::family::{Bench, Refused, Tried};
use super::plan::{Choice, Happening, Plan, Scene};
use super::rule::Rule;
use super::shrink;
use super::system900::System900;
use super::tnc::Tnc;
use super::trial::Trial;

/// A machine that is tried, and its programs.
pub struct Campaign {
    tried: Box<dyn Tried + Send + Sync>,
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
    /// Takes a machine with a TNC, with all programs of its first channel, or with those that are named. The other channels run
    /// their own.
    ///
    /// # Errors
    /// When the folder of its programs cannot be read.
    pub fn new(machine: LoadedMachine, named: &[String]) -> Result<Campaign, HostError> {
        let programs = match named {
            [] => Tnc::programs(&machine)?,
            named => named.to_vec(),
        };
        let (tnc, catalogue) = Tnc::of(machine)?;
        Ok(Campaign::of(Box::new(tnc), catalogue, programs, named))
    }

    /// Takes a machine with a System 900: its channels run what they start with, or channel 1 runs one of the programs that are
    /// named.
    ///
    /// # Errors
    /// When its plant cannot be copied.
    pub fn of_system900(machine: Machine900, named: &[String]) -> Result<Campaign, HostError> {
        let programs = match named {
            [] => vec![System900::OWN.to_owned()],
            named => named.to_vec(),
        };
        let (system900, catalogue) = System900::of(machine)?;
        Ok(Campaign::of(Box::new(system900), catalogue, programs, named))
    }

    fn of(
        tried: Box<dyn Tried + Send + Sync>,
        catalogue: Catalogue,
        programs: Vec<String>,
        named: &[String],
    ) -> Campaign {
        Campaign {
            tried,
            catalogue,
            programs,
            are_named: !named.is_empty(),
            left_out: OnceLock::new(),
        }
    }

    /// Loads the machine of a folder, of whatever family; the inner `Err` holds every fault of every file.
    ///
    /// # Errors
    /// When there is no such folder, or its programs cannot be read.
    pub fn load(folder: &Path, named: &[String]) -> Result<Result<Campaign, Vec<Diagnostic>>, HostError> {
        if Machine900::is_meant(folder) {
            return Ok(match Machine900::load(folder)? {
                Ok(machine) => Ok(Campaign::of_system900(machine, named)?),
                Err(faults) => Err(faults),
            });
        }
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
        for part in what.split(',').map(str::trim) {
            let known = self.tried.could_happen(part);
            known.map_err(|error| HostError::File(format!("{part}: {error}")))?;
        }
        self.catalogue.also(what);
        Ok(())
    }

    /// The name of the machine.
    pub fn name(&self) -> &str {
        self.tried.name()
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
        let (mut benches, mut scenes, mut left_out) = (Vec::new(), Vec::new(), Vec::new());
        for (number, program) in self.programs.iter().enumerate() {
            match self.tried.bench(program) {
                Ok(bench) => {
                    scenes.push(Scene {
                        program: number,
                        moments: bench.moments_us(),
                        turns: bench.turns(),
                    });
                    benches.push((number, bench));
                }
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
            scenes,
            benches,
        })
    }

    /// What was done as a script: `bahn run` repeats it.
    pub fn script(&self, plan: &Plan, trial: &Trial, folder: &str) -> String {
        let program = self.programs.get(plan.program).map_or("", String::as_str);
        let program = self.tried.named(program);
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
    /// Programs that are tried, by their places among those of the campaign.
    benches: Vec<(usize, Box<dyn Bench>)>,
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
        match benches.find(|(number, _)| *number == plan.program) {
            Some((_, bench)) => bench.run(&self.campaign.catalogue, plan, happenings),
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
