//! `bahn convert`: programs in another language, with the proof that they do the same.
//!
//! - `options`: options and help; `set`: which programs, and where they go; `library`: what a converted program calls;
//! - `report`: what is said of it; here: one program after the other.

mod library;
mod options;
mod set;

use std::io::Write as _;
use std::path::Path;
use std::sync::Arc;
use std::time::Duration;

use bahn_convert::{Language, Listed, Options, Proof, convert, gcode, prove, prove_unrolled, unroll};
use bahn_interpreter::{Interpreter, Library, NoLibrary, Settings};
use bahn_parameters::ParameterList;
use bahn_path::Axis;
use bahn_program::{FormatOptions, Program};
use bahn_report::convert::{Report, Reports};
use bahn_report::{Stop, convert as told, text};

pub(crate) use options::{ConvertOptions, EXAMPLES};

use crate::files::{self, FileLibrary, NewFile};
use crate::interrupt::Interrupt;
use crate::options::{FmtOptions, Format};
use crate::settings::{self, Equipment};
use crate::{Outcome, UsageError, console, diagnostics, progress};
use library::{Converted, TargetLibrary};
use set::Job;

/// Converts, proves, writes and reports.
pub(crate) fn command(options: &ConvertOptions) -> Result<Outcome, UsageError> {
    let jobs = set::jobs(options)?;
    set::keep_inputs(&jobs, options.replace)?;
    let equipment = Equipment::of(options.model, &options.machine)?;
    let interrupt = Interrupt::on_ctrl_c();
    let bench = Bench {
        settings: settings::interpreter(&equipment, &options.run)?,
        list: equipment.list,
        options,
    };
    let (made, library) = bench.in_blocks(&jobs);
    let many = jobs.len() > 1 || options.input.is_dir();
    let bar = many.then(|| progress::of_programs(jobs.len()));
    let limit = options.run.time_limit.map(Duration::from_secs_f64);
    let mut reports = Vec::new();
    for (job, made) in jobs.iter().zip(made) {
        if interrupt.is_requested() {
            break;
        }
        let stop = interrupt.stop_of_one(limit);
        let report = bench.finish(job, made, &library, &stop);
        stop.run_is_over();
        reports.push(report?);
        if let Some(bar) = &bar {
            bar.inc(1);
        }
    }
    if let Some(bar) = bar {
        bar.finish_and_clear();
    }
    let ok = reports.iter().all(|report| report.ok);
    say(reports, many, options)?;
    Ok(match (interrupt.is_requested(), ok) {
        (true, _) => Outcome::Interrupted,
        (false, true) => Outcome::Fine,
        (false, false) => Outcome::ProgramError,
    })
}

fn say(mut reports: Vec<Report>, many: bool, options: &ConvertOptions) -> Result<(), UsageError> {
    let ok = reports.iter().all(|report| report.ok);
    let text = match (options.format, many) {
        (Format::Json, true) => text::json(&Reports {
            ok,
            programs: reports,
        })?,
        (Format::Json, false) => match reports.pop() {
            Some(report) => text::json(&report)?,
            None => String::new(),
        },
        (Format::Text, true) => {
            let mut text: String = reports.iter().map(|report| told::line(report) + "\n").collect();
            let good = reports.iter().filter(|report| report.ok).count();
            text += &format!("{good} of {} programs are converted and proved\n", reports.len());
            text
        }
        (Format::Text, false) => reports.iter().map(told::text).collect(),
    };
    // What is converted goes to standard output itself.
    if options.output.as_deref() == Some(Path::new("-")) {
        diagnostics::print_text(text.trim_end());
        return Ok(());
    }
    console::print(&text)
}

/// What programs run on, and how they are written.
struct Bench<'a> {
    settings: Settings,
    list: ParameterList,
    options: &'a ConvertOptions,
}

/// A text that was made of a program.
struct Made {
    text: String,
    blocks: u32,
    unrolled: Vec<Listed>,
    refused: Vec<Listed>,
    left_out: Vec<Listed>,
    wrapped: u32,
    not_unrolled: Option<String>,
    proof: Option<Proof>,
}

impl Bench<'_> {
    /// All programs block by block, as they are called by each other; `None` for those that become G-code.
    fn in_blocks(&self, jobs: &[Job]) -> (Vec<Option<bahn_convert::Converted>>, Converted) {
        let mut library = Converted::default();
        let Some(language) = self.options.to.language() else {
            return (jobs.iter().map(|_| None).collect(), library);
        };
        let mut made = Vec::new();
        for job in jobs {
            let converted = self.blocks_of(job, jobs, language);
            let target = target_program(job, self.options.to.ending(), &converted.text);
            library.add(&job.program, Arc::new(target));
            made.push(Some(converted));
        }
        (made, library)
    }

    fn blocks_of(&self, job: &Job, jobs: &[Job], language: Language) -> bahn_convert::Converted {
        let find = |name: &str| {
            let mut library = FileLibrary::with_main(&job.program);
            library.find(name, job.program.name()).ok().flatten()
        };
        let ending = language.ending();
        let renamed = |name: &str| {
            let (before, old) = name.rsplit_once('.')?;
            let found = find(name)?;
            let converted = jobs.iter().any(|job| job.program.name() == found.name());
            let named = files::extension(Path::new(found.name())).eq_ignore_ascii_case(old);
            (converted && named).then(|| format!("{before}.{ending}"))
        };
        let is_iso = |name: &str| find(name).is_some_and(|found| set::is_iso(&found));
        let options = Options {
            format: self.format(),
            characters_max: match language {
                Language::Iso => Some(self.list.model().limits().iso_characters_max),
                Language::Plain => None,
            },
            called: job.called,
            renamed: &renamed,
            is_iso: &is_iso,
        };
        convert(&job.program, language, &options)
    }

    fn format(&self) -> FormatOptions {
        let machine = &self.options.machine;
        let given = machine.folder.is_some() || machine.parameters.is_some() || !machine.mp.is_empty();
        FormatOptions {
            decimal_comma: false,
            iso_step: self.options.iso_step.unwrap_or_else(|| match given {
                true => self.list.operation_parameters().iso_step,
                false => FmtOptions::ISO_STEP,
            }),
        }
    }

    fn run(&self, program: &Arc<Program>) -> Interpreter {
        let library: Box<dyn Library + Send> = Box::new(FileLibrary::with_main(program));
        Interpreter::new(program.clone(), self.settings.clone(), library)
    }

    /// Proves what was made of a program, and writes it.
    fn finish(
        &self,
        job: &Job,
        blocks: Option<bahn_convert::Converted>,
        library: &Converted,
        stop: &Stop,
    ) -> Result<Report, UsageError> {
        let made = match blocks {
            Some(blocks) => {
                if blocks.refused.is_empty() || self.options.no_unroll {
                    self.proved_blocks(job, blocks, library, stop)
                } else {
                    self.unrolled(job, &blocks, stop).unwrap_or_else(|why| Made {
                        not_unrolled: Some(why),
                        ..self.proved_blocks(job, blocks, library, stop)
                    })
                }
            }
            None => self.gcode(job, stop),
        };
        let proved = made.proof.as_ref().is_none_or(Proof::holds);
        let differs = made.refused.is_empty()
            && made
                .proof
                .as_ref()
                .is_some_and(|proof| proof.first_difference.is_some());
        let mut target = None;
        if !differs {
            write(job, &made.text)?;
            target = Some(match &job.target {
                Some(path) => path.display().to_string(),
                None => "-".to_owned(),
            });
        }
        Ok(Report {
            ok: made.refused.is_empty() && proved,
            blocks: made.blocks,
            unrolled: made.unrolled,
            refused: made.refused,
            left_out: made.left_out,
            wrapped_comments: made.wrapped,
            not_unrolled: made.not_unrolled,
            proof: made.proof,
            source: job.source.display().to_string(),
            target,
            to: self.options.to.name(),
        })
    }

    fn proved_blocks(
        &self,
        job: &Job,
        blocks: bahn_convert::Converted,
        library: &Converted,
        stop: &Stop,
    ) -> Made {
        let target = Arc::new(target_program(job, self.options.to.ending(), &blocks.text));
        let proof = (!self.options.no_prove).then(|| {
            let calls = Box::new(TargetLibrary::new(library.clone()));
            let run = Interpreter::new(target, self.settings.clone(), calls);
            prove(self.run(&job.program), run, self.list.model(), &stop.flag())
        });
        Made {
            text: blocks.text,
            blocks: blocks.blocks,
            unrolled: Vec::new(),
            refused: blocks.refused,
            left_out: Vec::new(),
            wrapped: blocks.wrapped,
            not_unrolled: None,
            proof,
        }
    }

    /// The path of a program whose blocks cannot all be said.
    ///
    /// # Errors
    /// Why a path cannot say it either.
    fn unrolled(&self, job: &Job, blocks: &bahn_convert::Converted, stop: &Stop) -> Result<Made, String> {
        let (model, flag) = (self.list.model(), stop.flag());
        let define_tools = self.settings.tools.is_none();
        let plain = unroll(self.run(&job.program), model, define_tools, &flag)?;
        let language = self.options.to.language().unwrap_or(Language::Plain);
        let plain_program = target_program(job, Language::Plain.ending(), &plain);
        let (text, count) = match language {
            Language::Plain => (plain, plain_program.block_count()),
            Language::Iso => {
                let options = Options {
                    format: self.format(),
                    ..Options::default()
                };
                let made = convert(&plain_program, language, &options);
                if let Some(first) = made.refused.first() {
                    return Err(format!("{}: {}", first.text, first.reason));
                }
                (made.text, made.blocks)
            }
        };
        let target = Arc::new(target_program(job, language.ending(), &text));
        let run = Interpreter::new(target, self.settings.clone(), Box::new(NoLibrary));
        // What is unrolled is proved whether that is wanted or not: only so is it known to be the whole.
        let proof = prove_unrolled(self.run(&job.program), run, model, &flag);
        if !proof.holds() {
            let what = proof.first_difference.map(|difference| difference.what);
            return Err(what.unwrap_or_else(|| "the run was not followed to its end".to_owned()));
        }
        Ok(Made {
            text,
            blocks: count,
            unrolled: blocks.refused.clone(),
            refused: Vec::new(),
            left_out: Vec::new(),
            wrapped: 0,
            not_unrolled: None,
            proof: Some(proof),
        })
    }

    fn gcode(&self, job: &Job, stop: &Stop) -> Made {
        let axes = [Axis::X, Axis::Y, Axis::Z];
        let rapid = axes.map(|axis| self.list.rapid_traverse_mm_min(axis));
        let options = gcode::Options {
            model: self.list.model(),
            unit: job.program.unit(),
            comments: !self.options.no_comments,
            rapid_mm_min: rapid.into_iter().fold(f64::INFINITY, f64::min),
            user_functions: self.options.user_functions,
        };
        let run = || self.run(&job.program);
        let made = gcode::write(&run, &options, &stop.flag());
        let name = job
            .target
            .as_deref()
            .and_then(Path::file_name)
            .unwrap_or_default();
        let proof = (!self.options.no_prove).then(|| {
            let name = name.to_string_lossy();
            gcode::prove(&run, &made.text, &name, &options, &stop.flag())
        });
        Made {
            text: made.text,
            blocks: made.lines,
            unrolled: Vec::new(),
            refused: made.refused,
            left_out: made.left_out,
            wrapped: 0,
            not_unrolled: None,
            proof,
        }
    }
}

/// The program of a text, by the name that its file will have.
fn target_program(job: &Job, ending: &str, text: &str) -> Program {
    let path = match &job.target {
        Some(target) => target.clone(),
        None => job.source.with_extension(ending),
    };
    // Its language is that of the ending, whatever the file is called.
    let named = path.with_extension(ending);
    let name = std::path::absolute(&named).unwrap_or(named);
    Program::from_bytes(name.to_string_lossy(), text.as_bytes().to_vec())
}

fn write(job: &Job, text: &str) -> Result<(), UsageError> {
    let Some(path) = &job.target else {
        return console::print_bytes(text.as_bytes());
    };
    if let Some(folder) = path.parent().filter(|folder| !folder.as_os_str().is_empty()) {
        std::fs::create_dir_all(folder).map_err(|error| files::cannot("write", folder, &error))?;
    }
    let mut file = NewFile::create(path)?;
    file.write_all(text.as_bytes())
        .map_err(|error| files::cannot("write", path, &error))?;
    Ok(file.finish()?)
}
