//! `bahn torture`: the fault campaign. What it does to a machine and what it holds it to is in [`bahn_trials::torture`].

mod crew;
mod options;

pub(crate) use options::{EXAMPLES, TortureOptions};

use std::io::Write as _;
use std::path::{Path, PathBuf};
use std::thread;

use bahn_host::{LoadedMachine, Machine900};
use bahn_report::torture::{CampaignReport, MachineReport, ViolationReport};
use bahn_text::Diagnostic;
use bahn_trials::torture::Campaign;

use crate::interrupt::Interrupt;
use crate::options::Format;
use crate::{Outcome, UsageError, console, diagnostics, files, settings};

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
    let mut report = CampaignReport::default();
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
        report.add(machine?);
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
    report: &mut CampaignReport,
    script: &mut Option<String>,
) -> Result<MachineReport, UsageError> {
    let mut machine = MachineReport::of(campaign);
    let single = options.seeds.end - options.seeds.start == 1;
    let mut folder = folder.display().to_string();
    if !options.mp.is_empty() {
        folder = format!("{folder} --mp {}", options.mp.join(","));
    }
    crew::run(campaign, options.seeds.clone(), jobs, interrupt, |tried| {
        machine.add(&tried.trial);
        let (plan, trial) = tried.least();
        if (single || trial.violation.is_some()) && script.is_none() {
            *script = Some(campaign.script(plan, trial, &folder));
        }
        report.violations.extend(ViolationReport::of(campaign, &tried));
        report.violations.len() < options.most
    })?;
    machine.finish(campaign);
    Ok(machine)
}

fn write(path: &Path, text: &str) -> Result<(), UsageError> {
    let mut file = files::NewFile::create(path)?;
    file.write_all(text.as_bytes())
        .map_err(|error| UsageError::new(format!("cannot write {}: {error}", path.display())))?;
    file.finish()?;
    Ok(())
}

fn print(report: &CampaignReport, options: &TortureOptions) -> Result<(), UsageError> {
    match options.format {
        Format::Json => console::print_json(report),
        Format::Text => console::print(&report.text()),
    }
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
