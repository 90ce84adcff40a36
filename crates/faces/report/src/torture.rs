//! What a fault campaign has found, and how it is told.

use std::fmt::Write as _;

use bahn_trials::torture::{Campaign, Happening, LeftOut, Plan, Rule, Trial, Violation};
use serde::Serialize;

/// A seed that is done.
#[derive(Clone, Debug)]
pub struct Tried {
    /// What it says.
    pub plan: Plan,
    /// What came of it.
    pub trial: Trial,
    /// With what is needed only, when a rule did not hold.
    pub shrunk: Option<(Plan, Trial)>,
}

impl Tried {
    /// The control panicked, which breaks a rule, too.
    pub fn panicked(seed: u64, plan: Option<Plan>) -> Tried {
        let plan = plan.unwrap_or(Plan {
            seed,
            program: 0,
            moment: 0,
            happenings: Vec::new(),
            end_us: 0,
        });
        let violation = Violation {
            rule: Rule::Alive,
            time_s: 0.0,
            values: "the control panics".to_owned(),
        };
        let trial = Trial {
            violation: Some(violation),
            done: plan.happenings.clone(),
            ..Trial::default()
        };
        Tried {
            plan,
            trial,
            shrunk: None,
        }
    }

    /// The plan and what came of it, with what is needed only where a rule did not hold.
    pub fn least(&self) -> (&Plan, &Trial) {
        let shrunk = self.shrunk.as_ref();
        shrunk.map_or((&self.plan, &self.trial), |(plan, trial)| (plan, trial))
    }
}

/// What is said in the end.
#[derive(Debug, Default, Serialize)]
pub struct CampaignReport {
    /// Each machine that was tried.
    pub machines: Vec<MachineReport>,
    /// Each seed in which a rule did not hold.
    pub violations: Vec<ViolationReport>,
}

/// What a machine was tried with.
#[derive(Debug, Default, Serialize)]
pub struct MachineReport {
    machine: String,
    /// Those that are tried.
    programs: Vec<String>,
    /// Those that wait for what is not there.
    left_out: Vec<LeftOut>,
    /// Seeds that were tried.
    seeds: u64,
    /// Time of the machine, s.
    machine_s: f64,
    /// Messages that came up.
    messages: u64,
    /// Runs that went on after it.
    went_on: u64,
}

/// A seed in which a rule did not hold.
#[derive(Debug, Serialize)]
pub struct ViolationReport {
    machine: String,
    seed: u64,
    program: String,
    rule: Rule,
    time_s: f64,
    values: String,
    /// The few things that lead to it, as a script has them.
    events: Vec<String>,
}

impl MachineReport {
    /// Nothing was tried yet.
    pub fn of(campaign: &Campaign) -> MachineReport {
        MachineReport {
            machine: campaign.name().to_owned(),
            ..MachineReport::default()
        }
    }

    /// A seed is done.
    pub fn add(&mut self, trial: &Trial) {
        self.seeds += 1;
        self.machine_s += trial.machine_us as f64 * 1e-6;
        self.messages += trial.messages.len() as u64;
        self.went_on += u64::from(trial.went_on);
    }

    /// All seeds are done: which programs were tried is known.
    pub fn finish(&mut self, campaign: &Campaign) {
        self.left_out = campaign.left_out().to_vec();
        let is_tried = |name: &&String| self.left_out.iter().all(|left| left.program != **name);
        self.programs = campaign.programs().iter().filter(is_tried).cloned().collect();
    }
}

impl ViolationReport {
    /// That of a seed; `None` where every rule held.
    pub fn of(campaign: &Campaign, tried: &Tried) -> Option<ViolationReport> {
        let whole = tried.trial.violation.as_ref()?;
        let (plan, trial) = tried.least();
        let violation = trial.violation.as_ref().unwrap_or(whole);
        Some(ViolationReport {
            machine: campaign.name().to_owned(),
            seed: tried.plan.seed,
            program: campaign.programs().get(plan.program).cloned().unwrap_or_default(),
            rule: violation.rule,
            time_s: violation.time_s,
            values: violation.values.clone(),
            events: plan.happenings.iter().map(line).collect(),
        })
    }
}

/// As a script has it.
fn line(happening: &Happening) -> String {
    format!("{:.6}: {}", happening.time_us as f64 * 1e-6, happening.what)
}

impl CampaignReport {
    /// A machine is done; its violations are told in the order of their seeds.
    pub fn add(&mut self, machine: MachineReport) {
        self.violations.sort_by_key(|violation| violation.seed);
        self.machines.push(machine);
    }

    /// As lines for people.
    pub fn text(&self) -> String {
        let mut text = String::new();
        for violation in &self.violations {
            let _ = writeln!(
                text,
                "seed {} ({}, {}) breaks {} at {:.3} s: {}",
                violation.seed,
                violation.machine,
                violation.program,
                violation.rule.name(),
                violation.time_s,
                violation.values
            );
            for event in &violation.events {
                let _ = writeln!(text, "    {event}");
            }
            let _ = writeln!(
                text,
                "  again: --seeds {}..{}",
                violation.seed,
                violation.seed + 1
            );
        }
        for machine in &self.machines {
            let _ = writeln!(
                text,
                "{}: {} seeds of {}, {:.0} s of the machine, {} messages, {} runs went on",
                machine.machine,
                machine.seeds,
                machine.programs.join(", "),
                machine.machine_s,
                machine.messages,
                machine.went_on
            );
            for LeftOut { program, why } in &machine.left_out {
                let _ = writeln!(text, "  left out: {program}, which {why}");
            }
        }
        let _ = match self.violations.len() {
            0 => writeln!(text, "every rule held"),
            1 => writeln!(text, "1 violation"),
            count => writeln!(text, "{count} violations"),
        };
        text
    }
}
