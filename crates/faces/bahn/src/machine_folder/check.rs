//! `bahn machine check`: everything in a folder, all faults of all files, its part programs included.

use std::path::{Path, PathBuf};

use serde::Serialize;

use bahn_host::{LoadedMachine, Machine900, tool_table};
use bahn_interpreter::{AbsentAxes, Rules, Settings};
use bahn_parameters::ParameterList;
use bahn_text::{Diagnostic, Severity};
use bahn_tnc::datum_shifts;

use super::load;
use super::options::CheckOptions;
use crate::check::{self, Check, CheckReport};
use crate::diagnostics::{self, Item};
use crate::interrupt::Interrupt;
use crate::options::Format;
use crate::reports::{OfFile, Reports};
use crate::{Outcome, UsageError};
use bahn_report::conformance::SYSTEM_900;
use bahn_report::count;

#[derive(Debug, Serialize)]
struct Report {
    folder: String,
    name: Option<String>,
    model: Option<&'static str>,
    ok: bool,
    faults: Vec<Item>,
    /// The part programs, as `bahn check` reports them.
    programs: Vec<OfFile<CheckReport>>,
}

/// Checks folders and prints what is wrong.
pub(super) fn command(options: &CheckOptions) -> Result<Outcome, UsageError> {
    let interrupt = Interrupt::on_ctrl_c();
    let mut reports = Reports::new();
    for folder in &options.folders {
        reports.add(folder, check(folder, options.format, &interrupt));
    }
    reports.end(options.format, |report| !report.ok)
}

fn check(folder: &Path, format: Format, interrupt: &Interrupt) -> Result<Report, UsageError> {
    if Machine900::is_meant(folder) {
        return check_900(folder, format, interrupt);
    }
    let (loaded, faults) = match load(folder)? {
        Ok(machine) => {
            let faults = [machine.refused.as_slice(), machine.warnings.as_slice()].concat();
            (Some(machine), faults)
        }
        Err(faults) => (None, faults),
    };
    let model = loaded.as_ref().map(|machine| machine.parameters.model());
    let what = loaded.as_ref().zip(model);
    let what = what.map(|(machine, model)| format!("{}, {model}", machine.folder.name));
    let programs = || match &loaded {
        Some(machine) => check_programs(machine, format, interrupt),
        None => Vec::new(),
    };
    Ok(Report {
        name: loaded.as_ref().map(|machine| machine.folder.name.clone()),
        model: model.map(|model| model.id()),
        ..report(folder, format, &faults, what, programs)
    })
}

/// The folder of a machine with a System 900.
fn check_900(folder: &Path, format: Format, interrupt: &Interrupt) -> Result<Report, UsageError> {
    let (loaded, faults) = match Machine900::load(folder)? {
        Ok(machine) => {
            let warnings = machine.warnings();
            (Some(machine), warnings)
        }
        Err(faults) => (None, faults),
    };
    let what = loaded.as_ref().map(|machine| {
        let channels = count(machine.checked.channels.len(), "channel");
        format!("{}, System 900 with {channels}", machine.folder.name)
    });
    let programs = || {
        let how = Check {
            settings: Settings::default(),
            format,
        };
        let is_own = |name: &str| name.ends_with(".900");
        let all = loaded
            .iter()
            .flat_map(|machine| programs(&machine.programs(), is_own));
        let checked = all.map(|path| OfFile::reported(&path, check::check(&path, &how, interrupt)));
        checked.collect()
    };
    Ok(Report {
        name: loaded.as_ref().map(|machine| machine.folder.name.clone()),
        model: loaded.as_ref().map(|_| SYSTEM_900),
        ..report(folder, format, &faults, what, programs)
    })
}

/// Prints the faults of a folder and what it is; nothing where it cannot be switched on. Then come its programs.
fn report(
    folder: &Path,
    format: Format,
    faults: &[Diagnostic],
    what: Option<String>,
    programs: impl FnOnce() -> Vec<OfFile<CheckReport>>,
) -> Report {
    let is_error = |fault: &&Diagnostic| fault.severity == Severity::Error;
    let errors = faults.iter().filter(is_error).count();
    let loads = what.is_some();
    if format == Format::Text {
        diagnostics::print_faults(faults);
        diagnostics::print_text(&format!(
            "{}: {}, {}, {}",
            folder.display(),
            what.as_deref().unwrap_or("cannot be switched on"),
            count(errors, "error"),
            count(faults.len() - errors, "warning")
        ));
    }
    let programs = programs();
    Report {
        folder: folder.display().to_string(),
        name: None,
        model: None,
        ok: loads && errors == 0 && programs.iter().all(is_fine),
        faults: faults.iter().map(Item::from).collect(),
        programs,
    }
}

/// Checks the part programs of a machine with its control, parameters and tools.
fn check_programs(
    machine: &LoadedMachine,
    format: Format,
    interrupt: &Interrupt,
) -> Vec<OfFile<CheckReport>> {
    let mut reports = Vec::new();
    let mut folders = Vec::new();
    for (channel, list) in lists(machine).enumerate() {
        let folder = machine.programs(channel);
        // Channels may share a folder; the first of them says how its programs are read.
        if folders.contains(&folder) {
            continue;
        }
        let how = how(machine, list, format);
        for path in programs(&folder, |name| bahn_program::language_of(name).is_some()) {
            reports.push(OfFile::reported(&path, check::check(&path, &how, interrupt)));
            if interrupt.is_requested() {
                return reports;
            }
        }
        folders.push(folder);
    }
    reports
}

/// Whether a program could be read, and has no error.
fn is_fine(program: &OfFile<CheckReport>) -> bool {
    program.report().is_some_and(|report| report.errors == 0)
}

/// The machine parameters of all channels.
fn lists(machine: &LoadedMachine) -> impl Iterator<Item = &ParameterList> + Clone {
    let others = machine.channels.iter().map(|channel| &channel.parameters);
    std::iter::once(&machine.parameters).chain(others)
}

/// How the programs of a channel with these machine parameters are checked.
fn how(machine: &LoadedMachine, list: &ParameterList, format: Format) -> Check {
    let tools = machine.tools.as_ref();
    Check {
        settings: Settings {
            model: list.model(),
            rules: Rules::of(list),
            barred_tools: tool_table::barred(tools.into_iter().flatten()),
            functions: machine.functions.clone(),
            absent: AbsentAxes::of(std::iter::once(list).chain(lists(machine))),
            datum_table: machine
                .datum_table()
                .map(|table| datum_shifts(table, list).into()),
            tools: tools.map(|tools| tools.iter().map(|(number, tool)| (*number, tool.shape)).collect()),
            ..Settings::default()
        },
        format,
    }
}

/// The programs in a folder, by what their names say, in their order; none where it cannot be read.
fn programs(folder: &Path, is_program: impl Fn(&str) -> bool) -> Vec<PathBuf> {
    let entries = std::fs::read_dir(folder).into_iter().flatten().flatten();
    let mut programs: Vec<PathBuf> = entries
        .map(|entry| entry.path())
        .filter(|path| is_program(&path.to_string_lossy()))
        .collect();
    programs.sort();
    programs
}
