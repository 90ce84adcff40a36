//! The files of a program: found, translated, joined [000:14592-14731].

use std::collections::{HashMap, VecDeque};

use bahn_text::NamedFile;

use super::file::{FileCode, Slot, translate};
use super::labels::Definition;
use super::{Compilation, Options, Place, Reports, time};
use crate::PlcError;
use crate::program::{Label, LabelPlace, Op, PlcProgram, SourceLine, SourceText, Target};
use crate::source::{Memories, Missing, decode, find};

/// Files of a program at most [000:14604].
const FILES_MAX: usize = 64;
/// Global labels of a program at most [000:12010].
const GLOBALS_MAX: usize = 1000;

/// A file with its code.
struct Linked {
    text: SourceText,
    code: FileCode,
}

pub(super) fn compile(files: Memories, main: &str, options: Options) -> Compilation {
    let mut reports = Reports::default();
    let linked = read_all(files, main, options, &mut reports);
    let size_bytes = linked
        .iter()
        .fold(0_u32, |sum, file| sum.saturating_add(file.code.bytes));
    if size_bytes > options.code_bytes_max() {
        let detail = format!(
            "{size_bytes} bytes of code, {} are allowed",
            options.code_bytes_max()
        );
        reports.error((0, main), START, PlcError::ProgramTooLong, &detail);
    }
    let globals = globals(&linked, &mut reports);
    check_externs(&linked, &globals, &mut reports);
    let texts: Vec<SourceText> = linked.iter().map(|file| file.text.clone()).collect();
    let program = reports.errors.is_empty().then(|| PlcProgram {
        size_bytes,
        ..join(linked, &globals)
    });
    Compilation {
        nominal_time: program.as_ref().map_or(0, time::nominal_time),
        program,
        errors: Reports::sorted(reports.errors, &texts),
        warnings: Reports::sorted(reports.warnings, &texts),
        not_listed: reports.not_listed,
        files: texts,
        size_bytes,
    }
}

const START: Place = Place { line: 1, column: 1 };

/// Reads the main file and everything that USES names, each file once.
fn read_all(files: Memories, main: &str, options: Options, reports: &mut Reports) -> Vec<Linked> {
    let mut linked: Vec<Linked> = Vec::new();
    let mut known: Vec<String> = Vec::new();
    let mut wanted = VecDeque::from([(main.to_owned(), 0, main.to_owned(), START)]);
    let mut too_many = false;
    while let Some((name, by, by_name, place)) = wanted.pop_front() {
        let key = key(&name);
        if known.contains(&key) {
            continue;
        }
        let (found, bytes) = match find(files, options.memory, &name) {
            Ok(NamedFile { name, bytes }) => (name, bytes),
            Err(missing) => {
                let detail = match missing {
                    Missing::NoFile => name,
                    Missing::InRamOnly => format!("{name} lies in the RAM, MP4010 = 0 takes the EPROM only"),
                };
                reports.error((by, &by_name), place, PlcError::FileNotFound, &detail);
                known.push(key);
                continue;
            }
        };
        if linked.len() >= FILES_MAX {
            if !too_many {
                reports.error(
                    (by, &by_name),
                    place,
                    PlcError::TooManyFiles,
                    "a program may have 64 files",
                );
            }
            too_many = true;
            continue;
        }
        known.push(key);
        let index = linked.len();
        let lines: Vec<String> = decode(&bytes).lines().map(str::to_owned).collect();
        let code = translate(index, &found, &lines, options, reports);
        for (used, place) in &code.uses {
            wanted.push_back((used.clone(), index, found.clone(), *place));
        }
        linked.push(Linked {
            text: SourceText { name: found, lines },
            code,
        });
    }
    linked
}

/// The same for all spellings of a file's name.
fn key(name: &str) -> String {
    let upper = name.to_ascii_uppercase();
    upper.strip_suffix(".PLC").unwrap_or(&upper).to_owned()
}

/// Names that all files may call, with the file and its instruction.
type Globals = HashMap<String, (usize, usize)>;

fn globals(linked: &[Linked], reports: &mut Reports) -> Globals {
    let mut globals = Globals::new();
    for (file, Linked { text, code }) in linked.iter().enumerate() {
        for (name, place) in &code.globals {
            let Some(Definition::Code(at)) = code.labels.definition(*name) else {
                continue;
            };
            let Some(label) = code.labels.names.get(*name) else {
                continue;
            };
            if globals.insert(label.text.clone(), (file, at)).is_some() {
                reports.error((file, &text.name), *place, PlcError::GlobalTwice, &label.text);
            }
        }
    }
    if let (true, Some(main)) = (globals.len() > GLOBALS_MAX, linked.first()) {
        let detail = format!("{} global labels, {GLOBALS_MAX} are allowed", globals.len());
        reports.error((0, &main.text.name), START, PlcError::TooManyGlobals, &detail);
    }
    globals
}

fn check_externs(linked: &[Linked], globals: &Globals, reports: &mut Reports) {
    for (file, Linked { text, code }) in linked.iter().enumerate() {
        for (name, place) in &code.externs {
            let Some(label) = code.labels.names.get(*name) else {
                continue;
            };
            if !globals.contains_key(&label.text) {
                reports.error(
                    (file, &text.name),
                    *place,
                    PlcError::ExternNotDefined,
                    &label.text,
                );
            }
        }
    }
}

/// Puts the files one after the other and replaces names by places. Without errors every name has one.
fn join(linked: Vec<Linked>, globals: &Globals) -> PlcProgram {
    let (labels, index) = named(&linked);
    let mut program = PlcProgram {
        labels,
        ..PlcProgram::default()
    };
    for (file, linked) in linked.into_iter().enumerate() {
        let Linked { text, mut code } = linked;
        let (start, first_case) = (program.code.len(), program.cases.len());
        for instruction in &mut code.code {
            match &mut instruction.op {
                Op::Jump { target, .. } => *target += start,
                Op::Case { table, .. } => *table += first_case,
                _ => {}
            }
        }
        for fixup in &code.fixups {
            let Some(name) = code.labels.names.get(fixup.name) else {
                continue;
            };
            let home = match code.labels.definition(fixup.name) {
                Some(Definition::Extern) => globals.get(&name.text).map_or(file, |(file, _)| *file),
                _ => file,
            };
            let label = index.get(&(home, name.text.clone()));
            let Some(label) = label.and_then(|label| program.labels.get_mut(*label)) else {
                continue;
            };
            let line = fixup.line;
            label.used.push(SourceLine { file, line });
            let (LabelPlace::Code(at) | LabelPlace::Field(at)) = label.place;
            match fixup.slot {
                Slot::Instruction(index) => {
                    if let Some(instruction) = code.code.get_mut(index) {
                        resolve(&mut instruction.op, at);
                    }
                }
                Slot::CaseEntry { table, entry } => {
                    let entries = code.cases.get_mut(table);
                    if let Some(entry) = entries.and_then(|entries| entries.get_mut(entry)) {
                        *entry = Target::Code(at);
                    }
                }
            }
        }
        program.code.extend(code.code);
        program.fields.extend(code.fields);
        program.cases.extend(code.cases);
        program.files.push(text);
    }
    program
}

/// All labels and fields, and the index of each by file and name.
fn named(linked: &[Linked]) -> (Vec<Label>, HashMap<(usize, String), usize>) {
    let mut labels = Vec::new();
    let mut index = HashMap::new();
    let (mut start, mut first_field) = (0, 0);
    for (file, Linked { code, .. }) in linked.iter().enumerate() {
        for name in &code.labels.names {
            let (place, line) = match name.definition {
                Some((Definition::Code(at), place)) => (LabelPlace::Code(start + at), place.line),
                Some((Definition::Field(field), place)) => {
                    (LabelPlace::Field(first_field + field), place.line)
                }
                Some((Definition::Extern, _)) | None => continue,
            };
            index.insert((file, name.text.clone()), labels.len());
            labels.push(Label {
                name: name.text.clone(),
                defined: SourceLine { file, line },
                place,
                used: Vec::new(),
            });
        }
        start += code.code.len();
        first_field += code.fields.len();
    }
    (labels, index)
}

fn resolve(op: &mut Op, at: usize) {
    match op {
        Op::Jump { target, .. } => *target = at,
        Op::Call { target, .. } | Op::Submit { target } => *target = Target::Code(at),
        Op::LoadField { field } => *field = at,
        _ => {}
    }
}
