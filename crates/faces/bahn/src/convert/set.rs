//! Which programs are converted together, and where they go.

use std::collections::HashSet;
use std::path::{Path, PathBuf};

use bahn_program::{CycleWord, Operation, Program};
use bahn_reader::Programs;

use bahn_report::convert::{Job, Target, is_iso};

use super::options::{ConvertOptions, TargetOption};
use crate::files::{self, Loaded};
use crate::{UsageError, shelf};

/// The programs of the command line, each once, those in the target language left out.
pub(super) fn jobs(options: &ConvertOptions) -> Result<Vec<Job>, UsageError> {
    let endings = ["H", "I", "NC"].map(str::to_owned);
    let input = &options.input;
    let folder = input.is_dir();
    let sources = match folder {
        true => shelf::programs(std::slice::from_ref(input), &endings, "")?,
        false => vec![input.clone()],
    };
    let mut jobs = Vec::new();
    for source in sources {
        let below = source.strip_prefix(input).ok().filter(|_| folder);
        let below = below.map_or_else(|| name_of(&source), Path::to_owned);
        add(options, source, &below, &mut jobs)?;
    }
    if !folder && jobs.is_empty() {
        return Err(UsageError::new(format!(
            "{} is in this language already",
            input.display()
        )));
    }
    // The path has what called programs do.
    if options.with_calls && options.to != TargetOption::Gcode {
        add_called(options, &mut jobs)?;
    }
    mark_called(&mut jobs);
    Ok(jobs)
}

fn name_of(path: &Path) -> PathBuf {
    path.file_name().map(PathBuf::from).unwrap_or_default()
}

/// Adds a program with its place `below` the output folder.
fn add(
    options: &ConvertOptions,
    source: PathBuf,
    below: &Path,
    jobs: &mut Vec<Job>,
) -> Result<(), UsageError> {
    let program = match files::load_program(&source)? {
        Loaded::Program(program) => program,
        Loaded::Empty(_) => return Err(UsageError::new(format!("{}: {}", source.display(), files::EMPTY))),
        Loaded::TooLarge => {
            return Err(UsageError::new(format!(
                "{}: {}",
                source.display(),
                files::TOO_LARGE
            )));
        }
    };
    if program.dialect().is_some() {
        // One of a folder is left out, as one in the language that is wanted.
        if options.input.is_dir() {
            return Ok(());
        }
        let why = "a program of DIN 66025 (.nc, .900) has its own axes and functions: it is not converted";
        return Err(UsageError::new(format!("{}: {why}", source.display())));
    }
    let already = match Target::from(options.to) {
        Target::Plain => !is_iso(&program),
        Target::Iso => is_iso(&program),
        Target::Gcode => false,
    };
    if already {
        return Ok(());
    }
    let target = target(options, &source, below);
    jobs.push(Job {
        program,
        source,
        target,
        called: false,
    });
    Ok(())
}

/// Where a program goes.
fn target(options: &ConvertOptions, source: &Path, below: &Path) -> Option<PathBuf> {
    let ending = Target::from(options.to).ending();
    let many = options.input.is_dir() || (options.with_calls && options.to != TargetOption::Gcode);
    match &options.output {
        Some(path) if path.as_os_str() == "-" => None,
        Some(folder) if many || folder.is_dir() => Some(folder.join(below).with_extension(ending)),
        Some(file) => Some(file.clone()),
        None => Some(source.with_extension(ending)),
    }
}

/// Adds what the programs call, and what those call.
fn add_called(options: &ConvertOptions, jobs: &mut Vec<Job>) -> Result<(), UsageError> {
    let mut known: HashSet<String> = jobs.iter().map(|job| job.program.name().to_owned()).collect();
    let mut next = 0;
    while let Some(job) = jobs.get(next) {
        next += 1;
        let caller = job.program.clone();
        let beside = job.source.clone();
        let library = files::beside(&caller);
        for name in called_names(&caller) {
            let Ok(Some(found)) = library.open(&name, caller.name()) else {
                continue;
            };
            if known.insert(found.name().to_owned()) {
                let file = name_of(Path::new(found.name()));
                add(options, beside.with_file_name(&file), &file, jobs)?;
            }
        }
    }
    Ok(())
}

/// The names in CALL PGM and cycle 12.
pub(super) fn called_names(program: &Program) -> Vec<String> {
    let mut names = Vec::new();
    for numbered in program.blocks() {
        for part in numbered.block.operation.parts() {
            match part {
                Operation::CallProgram(name) => names.push(name.to_string()),
                Operation::Cycle(block) if block.number == 12 && block.sub == 1 => {
                    let texts = block.words.iter().filter_map(|word| match word {
                        CycleWord::Text(name) => Some(name.to_string()),
                        _ => None,
                    });
                    names.extend(texts);
                }
                _ => {}
            }
        }
    }
    names
}

fn mark_called(jobs: &mut [Job]) {
    let mut called = HashSet::new();
    for job in jobs.iter().filter(|job| job.is_iso()) {
        let library = files::beside(&job.program);
        for name in called_names(&job.program) {
            if let Ok(Some(found)) = library.open(&name, job.program.name()) {
                called.insert(found.name().to_owned());
            }
        }
    }
    for job in jobs {
        job.called = called.contains(job.program.name());
    }
}

/// Refuses targets that are an input or each other, and such that are there unless they may be replaced.
pub(super) fn keep_inputs(jobs: &[Job], replace: bool) -> Result<(), UsageError> {
    let real = |path: &Path| std::fs::canonicalize(path).unwrap_or_else(|_| path.to_owned());
    let inputs: HashSet<PathBuf> = jobs.iter().map(|job| real(&job.source)).collect();
    let mut taken = HashSet::new();
    for target in jobs.iter().filter_map(|job| job.target.as_deref()) {
        let refused = |why: &str| Err(UsageError::new(format!("{}: {why}", target.display())));
        if inputs.contains(&real(target)) {
            return refused("this file is an input of the command");
        }
        if !taken.insert(target.to_owned()) {
            return refused("two programs would be written to this file");
        }
        let regular = std::fs::metadata(target).is_ok_and(|there| there.is_file());
        if regular && !replace {
            return refused("this file is there already; --replace replaces it");
        }
    }
    Ok(())
}
