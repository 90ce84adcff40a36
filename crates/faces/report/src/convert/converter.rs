//! Programs in another language, each with the proof that it does the same.

use std::path::{Path, PathBuf};
use std::sync::Arc;

use bahn_convert::{Language, Listed, Options, Proof, convert, gcode, prove, prove_unrolled, unroll};
use bahn_host::files;
use bahn_interpreter::{Interpreter, NoPrograms, Programs, Settings};
use bahn_parameters::ParameterList;
use bahn_path::Axis;
use bahn_program::{FormatOptions, Program};

use super::library::{Converted, TargetLibrary};
use super::report::Report;
use crate::Stop;

/// A language to write.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Target {
    /// HEIDENHAIN plain language.
    Plain,
    /// DIN/ISO.
    Iso,
    /// RS-274/NGC for LinuxCNC.
    Gcode,
}

impl Target {
    /// The language of the control, if it is one.
    pub fn language(self) -> Option<bahn_convert::Language> {
        match self {
            Target::Plain => Some(bahn_convert::Language::Plain),
            Target::Iso => Some(bahn_convert::Language::Iso),
            Target::Gcode => None,
        }
    }

    /// What the names of its files end with.
    pub fn ending(self) -> &'static str {
        self.language().map_or("ngc", bahn_convert::Language::ending)
    }

    /// Its name in reports.
    pub fn name(self) -> &'static str {
        match self {
            Target::Plain => "plain",
            Target::Iso => "iso",
            Target::Gcode => "gcode",
        }
    }
}

/// A program and where it goes.
pub struct Job {
    /// The program that is to be converted.
    pub program: Arc<Program>,
    /// As people gave it.
    pub source: PathBuf,
    /// `None` for standard output.
    pub target: Option<PathBuf>,
    /// Another program of the set, in DIN/ISO, calls it.
    pub called: bool,
}

impl Job {
    /// Whether it is in DIN/ISO.
    pub fn is_iso(&self) -> bool {
        is_iso(&self.program)
    }
}

/// Whether a program is in DIN/ISO.
pub fn is_iso(program: &Program) -> bool {
    extension(Path::new(program.name())) == "i"
}

/// What a name ends with after its last dot, in small letters; empty without one.
fn extension(path: &Path) -> String {
    path.extension()
        .unwrap_or_default()
        .to_string_lossy()
        .to_ascii_lowercase()
}

/// What programs run on, and how they are written.
pub struct Converter {
    /// How programs are interpreted.
    pub settings: Settings,
    /// The machine parameters under which source and target run.
    pub list: ParameterList,
    /// The language that is written.
    pub to: Target,
    /// Step of the block numbers of DIN/ISO programs, 0 writes none.
    pub iso_step: u8,
    /// What cannot be said in blocks is said by its path.
    pub unrolls: bool,
    /// A proof is wanted.
    pub proves: bool,
    /// G-code has the source blocks as comments.
    pub comments: bool,
    /// G-code has the machine builder's functions as functions of LinuxCNC's user.
    pub user_functions: bool,
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

impl Converter {
    /// All programs block by block, as they are called by each other; `None` for those that become G-code.
    pub fn in_blocks(&self, jobs: &[Job]) -> (Vec<Option<bahn_convert::Converted>>, Converted) {
        let mut library = Converted::default();
        let Some(language) = self.to.language() else {
            return (jobs.iter().map(|_| None).collect(), library);
        };
        let mut made = Vec::new();
        for job in jobs {
            let converted = self.blocks_of(job, jobs, language);
            let target = target_program(job, self.to.ending(), &converted.text);
            library.add(&job.program, Arc::new(target));
            made.push(Some(converted));
        }
        (made, library)
    }

    fn blocks_of(&self, job: &Job, jobs: &[Job], language: Language) -> bahn_convert::Converted {
        let find = |name: &str| {
            let library = files::beside(&job.program);
            library.open(name, job.program.name()).ok().flatten()
        };
        let ending = language.ending();
        let renamed = |name: &str| {
            let (before, old) = name.rsplit_once('.')?;
            let found = find(name)?;
            let converted = jobs.iter().any(|job| job.program.name() == found.name());
            let named = extension(Path::new(found.name())).eq_ignore_ascii_case(old);
            (converted && named).then(|| format!("{before}.{ending}"))
        };
        let is_iso = |name: &str| find(name).is_some_and(|found| is_iso(&found));
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
        FormatOptions {
            decimal_comma: false,
            iso_step: self.iso_step,
        }
    }

    fn run(&self, program: &Arc<Program>) -> Interpreter {
        let beside = Arc::new(files::beside(program));
        Interpreter::new(program.clone(), self.settings.clone(), beside)
    }

    /// Proves what was made of a program: what is told of it, and the text for its file; none when it does something else.
    pub fn finish(
        &self,
        job: &Job,
        blocks: Option<bahn_convert::Converted>,
        library: &Converted,
        stop: &Stop,
    ) -> (Report, Option<String>) {
        let made = match blocks {
            Some(blocks) => {
                if blocks.refused.is_empty() || !self.unrolls {
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
        let target = (!differs).then(|| match &job.target {
            Some(path) => path.display().to_string(),
            None => "-".to_owned(),
        });
        let report = Report {
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
            to: self.to.name(),
        };
        (report, (!differs).then_some(made.text))
    }

    fn proved_blocks(
        &self,
        job: &Job,
        blocks: bahn_convert::Converted,
        library: &Converted,
        stop: &Stop,
    ) -> Made {
        let target = Arc::new(target_program(job, self.to.ending(), &blocks.text));
        let proof = self.proves.then(|| {
            let calls = Arc::new(TargetLibrary::new(library.clone()));
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
        let language = self.to.language().unwrap_or(Language::Plain);
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
        let run = Interpreter::new(target, self.settings.clone(), Arc::new(NoPrograms));
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
            comments: self.comments,
            rapid_mm_min: rapid.into_iter().fold(f64::INFINITY, f64::min),
            user_functions: self.user_functions,
        };
        let run = || self.run(&job.program);
        let made = gcode::write(&run, &options, &stop.flag());
        let name = job
            .target
            .as_deref()
            .and_then(Path::file_name)
            .unwrap_or_default();
        let proof = self.proves.then(|| {
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
