//! The program in another language, with the proof that both do the same.

use std::path::Path;
use std::sync::Arc;
use std::sync::atomic::{AtomicBool, Ordering};
use std::time::Duration;

use bahn_convert::{Language, Options, Proof, convert, gcode, prove};
use bahn_interpreter::{Interpreter, Settings};
use bahn_parameters::ParameterList;
use bahn_path::Axis;
use bahn_program::{FormatOptions, Program};

use super::PartProgram;
use crate::language::{Conversion, Target};
use crate::world::World;
use bahn_reader::Shelf;

/// What conversion and proof may take while the editor waits.
const TIME_MAX: Duration = Duration::from_secs(2);

/// What can be made of a program.
pub(super) fn targets(program: &PartProgram) -> Vec<Target> {
    let other = match program.is_iso() {
        false => Target {
            id: "iso",
            title: "Convert to DIN/ISO",
        },
        true => Target {
            id: "plain",
            title: "Convert to plain language",
        },
    };
    let gcode = Target {
        id: "gcode",
        title: "Convert to G-code for LinuxCNC",
    };
    vec![other, gcode]
}

pub(super) fn converted(program: &PartProgram, target: &str, world: &World) -> Result<Conversion, String> {
    if program.program.refused().is_some() || !program.program.begins_with_header() {
        let [begin, _] = program.language().frames();
        return Err(format!(
            "the text does not begin with {begin}, so it may be no program"
        ));
    }
    let stop = limited();
    match target {
        "iso" => in_blocks(program, Language::Iso, world, &stop),
        "plain" => in_blocks(program, Language::Plain, world, &stop),
        "gcode" => as_gcode(program, world, &stop),
        other => Err(format!("{other} is no language that programs are converted to")),
    }
}

/// A flag that is set when the time is over.
fn limited() -> Arc<AtomicBool> {
    let stop = Arc::new(AtomicBool::new(false));
    let flag = stop.clone();
    std::thread::spawn(move || {
        std::thread::sleep(TIME_MAX);
        flag.store(true, Ordering::Relaxed);
    });
    stop
}

fn run(program: &Arc<Program>, of: &PartProgram, world: &World) -> Interpreter {
    let settings = Settings {
        model: of.model,
        strict: world.settings.strict,
        skip_unknown: world.settings.skip_unknown,
        ..Settings::default()
    };
    Interpreter::new(
        program.clone(),
        settings,
        Arc::new(Shelf::with_main(world.clone(), program)),
    )
}

/// Block by block; what the other language cannot say is a reason not to.
fn in_blocks(
    program: &PartProgram,
    language: Language,
    world: &World,
    stop: &Arc<AtomicBool>,
) -> Result<Conversion, String> {
    let is_iso = |name: &str| {
        let found = world.called(name, &program.path);
        found.is_some_and(|path| {
            path.extension()
                .is_some_and(|ending| ending.eq_ignore_ascii_case("I"))
        })
    };
    let options = Options {
        format: FormatOptions {
            decimal_comma: world.settings.comma,
            iso_step: world.settings.iso_step,
        },
        characters_max: match language {
            Language::Iso => Some(program.model.limits().iso_characters_max),
            Language::Plain => None,
        },
        is_iso: &is_iso,
        ..Options::default()
    };
    let made = convert(&program.program, language, &options);
    if let Some(first) = made.refused.first() {
        return Err(format!(
            "{} blocks cannot be said in that language, first block {}: {} (`bahn convert` unrolls them)",
            made.refused.len(),
            first.block,
            first.reason
        ));
    }
    let path = program.path.with_extension(language.ending());
    let target = Program::from_bytes(path.to_string_lossy(), made.text.as_bytes().to_vec());
    let (source, target) = (
        run(&program.program, program, world),
        run(&Arc::new(target), program, world),
    );
    proved(&prove(source, target, program.model, stop))?;
    Ok(conversion(&path, made.text))
}

fn as_gcode(program: &PartProgram, world: &World, stop: &Arc<AtomicBool>) -> Result<Conversion, String> {
    let list = ParameterList::reference(program.model);
    let rapid = [Axis::X, Axis::Y, Axis::Z].map(|axis| list.rapid_traverse_mm_min(axis));
    let options = gcode::Options {
        model: program.model,
        unit: program.program.unit(),
        comments: true,
        rapid_mm_min: rapid.into_iter().fold(f64::INFINITY, f64::min),
        user_functions: false,
    };
    let run = || run(&program.program, program, world);
    let made = gcode::write(&run, &options, stop);
    if let Some(first) = made.refused.first() {
        return Err(format!(
            "G-code cannot say block {}: {}",
            first.block, first.reason
        ));
    }
    let path = program.path.with_extension("ngc");
    let conversion = conversion(&path, made.text);
    let proof = gcode::prove(&run, &conversion.text, &conversion.file_name, &options, stop);
    proved(&proof)?;
    Ok(conversion)
}

/// Only what is known to do the same is handed out.
fn proved(proof: &Proof) -> Result<(), String> {
    match &proof.first_difference {
        Some(difference) => Err(format!(
            "the converted program would do something else in block {}: {}",
            difference.source.block, difference.what
        )),
        None if !proof.completed => {
            Err("the proof takes too long for an editor: `bahn convert` takes its time".to_owned())
        }
        None => Ok(()),
    }
}

fn conversion(path: &Path, text: String) -> Conversion {
    Conversion {
        file_name: path
            .file_name()
            .unwrap_or_default()
            .to_string_lossy()
            .into_owned(),
        text,
    }
}
