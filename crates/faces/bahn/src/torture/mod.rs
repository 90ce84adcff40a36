//! `bahn torture`: the fault campaign. What it does to a machine and what it holds it to is in [`bahn_trials::torture`].

mod crew;
mod options;

pub(crate) use options::{EXAMPLES, TortureOptions};

use std::fmt::Write as _;
use std::io::Write as _;
use std::path::{Path, PathBuf};
use std::thread;

use bahn_host::{LoadedMachine, Machine900};
use bahn_text::Diagnostic;
use bahn_trials::torture::{Campaign, Happening, LeftOut, Rule};
use serde::Serialize;

use crate::interrupt::Interrupt;
use crate::options::Format;
use crate::{Outcome, UsageError, console, diagnostics, files, settings};
use crew::Tried;

/// What is said in the end.
#[derive(Debug, Default, Serialize)]
struct Report {
    machines: Vec<MachineReport>,
    violations: Vec<ViolationReport>,
}

#[derive(Debug, Default, Serialize)]
struct MachineReport {
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

#[derive(Debug, Serialize)]
struct ViolationReport {
    machine: String,
    seed: u64,
    program: String,
    rule: Rule,
    time_s: f64,
    values: String,
    /// The few things that lead to it, as a script has them.
    events: Vec<String>,
}

/// Runs the campaign and reports.
pub(crate) fn command(options: &TortureOptions) -> Result<Outcome, UsageError> {
    let shipped;
    let folders = match options.machine.as_slice() {
        [] => {
            shipped = Shipped::write()?;
            shipped.folders.clone()
        }
        named => named.to_vec(),
    };
    let inputs: Vec<&Path> = folders.iter().map(PathBuf::as_path).collect();
    let outputs: Vec<(&str, &Path)> = options
        .record
        .iter()
        .map(|path| ("--record", path.as_path()))
        .collect();
    files::keep_inputs(&inputs, &outputs)?;
    let jobs = options.jobs.map_or_else(
        || thread::available_parallelism().map_or(1, usize::from),
        usize::from,
    );
    let interrupt = Interrupt::on_ctrl_c();
    let mut report = Report::default();
    let mut script = None;
    for folder in &folders {
        let mut campaign = match load(folder, options)? {
            Ok(campaign) => campaign,
            Err(faults) => {
                diagnostics::print_faults(&faults);
                return Ok(Outcome::ProgramError);
            }
        };
        for event in &options.event {
            campaign.also(event)?;
        }
        let machine = try_machine(
            &campaign,
            folder,
            options,
            jobs,
            &interrupt,
            &mut report,
            &mut script,
        );
        report.machines.push(machine?);
        if interrupt.is_requested() || report.violations.len() >= options.most {
            break;
        }
    }
    if let (Some(path), Some(script)) = (&options.record, &script) {
        write(path, script)?;
    }
    print(&report, options)?;
    Ok(if interrupt.is_requested() {
        Outcome::Interrupted
    } else if report.violations.is_empty() {
        Outcome::Fine
    } else {
        Outcome::ProgramError
    })
}

/// A machine of whatever family; the inner `Err` holds every fault of every file.
fn load(folder: &Path, options: &TortureOptions) -> Result<Result<Campaign, Vec<Diagnostic>>, UsageError> {
    if Machine900::is_meant(folder) {
        if !options.mp.is_empty() {
            return Err(UsageError::new(format!(
                "--mp is for a TNC, and {} has a System 900: --event P8051=1 writes a parameter",
                folder.display()
            )));
        }
        return Ok(Campaign::load(folder, &options.program)?);
    }
    Ok(match LoadedMachine::load(folder)? {
        Ok(mut machine) => {
            settings::assign(&mut machine.parameters, &options.mp)?;
            Ok(Campaign::new(machine, &options.program)?)
        }
        Err(faults) => Err(faults),
    })
}

fn try_machine(
    campaign: &Campaign,
    folder: &Path,
    options: &TortureOptions,
    jobs: usize,
    interrupt: &Interrupt,
    report: &mut Report,
    script: &mut Option<String>,
) -> Result<MachineReport, UsageError> {
    let mut machine = MachineReport {
        machine: campaign.name().to_owned(),
        ..MachineReport::default()
    };
    let single = options.seeds.end - options.seeds.start == 1;
    let mut folder = folder.display().to_string();
    if !options.mp.is_empty() {
        folder = format!("{folder} --mp {}", options.mp.join(","));
    }
    crew::run(campaign, options.seeds.clone(), jobs, interrupt, |tried| {
        machine.seeds += 1;
        machine.machine_s += tried.trial.machine_us as f64 * 1e-6;
        machine.messages += tried.trial.messages.len() as u64;
        machine.went_on += u64::from(tried.trial.went_on);
        let (plan, trial) = tried
            .shrunk
            .as_ref()
            .unwrap_or(&(tried.plan.clone(), tried.trial.clone()))
            .clone();
        if (single || trial.violation.is_some()) && script.is_none() {
            *script = Some(campaign.script(&plan, &trial, &folder));
        }
        report.violations.extend(violation(campaign, &tried));
        report.violations.len() < options.most
    })?;
    machine.left_out = campaign.left_out().to_vec();
    let is_tried = |name: &&String| machine.left_out.iter().all(|left| left.program != **name);
    machine.programs = campaign.programs().iter().filter(is_tried).cloned().collect();
    report.violations.sort_by_key(|violation| violation.seed);
    Ok(machine)
}

fn violation(campaign: &Campaign, tried: &Tried) -> Option<ViolationReport> {
    let whole = tried.trial.violation.as_ref()?;
    let shrunk = tried.shrunk.as_ref();
    let violation = shrunk
        .and_then(|(_, trial)| trial.violation.as_ref())
        .unwrap_or(whole);
    let plan = shrunk.map_or(&tried.plan, |(plan, _)| plan);
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

/// As a script has it.
fn line(happening: &Happening) -> String {
    format!("{:.6}: {}", happening.time_us as f64 * 1e-6, happening.what)
}

fn write(path: &Path, text: &str) -> Result<(), UsageError> {
    let mut file = files::NewFile::create(path)?;
    file.write_all(text.as_bytes())
        .map_err(|error| UsageError::new(format!("cannot write {}: {error}", path.display())))?;
    file.finish()?;
    Ok(())
}

fn print(report: &Report, options: &TortureOptions) -> Result<(), UsageError> {
    if options.format == Format::Json {
        return console::print_json(report);
    }
    let mut text = String::new();
    for violation in &report.violations {
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
    for machine in &report.machines {
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
    let _ = match report.violations.len() {
        0 => writeln!(text, "every rule held"),
        1 => writeln!(text, "1 violation"),
        count => writeln!(text, "{count} violations"),
    };
    console::print(&text)
}

/// The shipped machines in a folder of their own, which goes with it.
struct Shipped {
    root: PathBuf,
    folders: Vec<PathBuf>,
}

impl Shipped {
    fn write() -> Result<Shipped, UsageError> {
        let root = std::env::temp_dir().join(format!("bahn-torture-{}", std::process::id()));
        let mut shipped = Shipped {
            root,
            folders: Vec::new(),
        };
        for machine in bahn_machines::ALL {
            let folder = shipped.root.join(machine.name);
            for (name, text) in machine.files {
                let path = folder.join(name);
                let parent = path.parent().unwrap_or(&folder);
                let written = std::fs::create_dir_all(parent).and_then(|()| std::fs::write(&path, text));
                written
                    .map_err(|error| UsageError::new(format!("cannot write {}: {error}", path.display())))?;
            }
            shipped.folders.push(folder);
        }
        Ok(shipped)
    }
}

impl Drop for Shipped {
    fn drop(&mut self) {
        // It is of no use to anybody.
        let _ = std::fs::remove_dir_all(&self.root);
    }
}
