//! What the compiler says of a source file, and the files that belong to it.

use std::ops::Range;
use std::path::{Path, PathBuf};

use bahn_plc::{Compilation, LineOperand, Memories, Options, line_words};
use bahn_text::{Diagnostic, Files, NamedFile, Span, decode, name_alone};

use super::PlcSource;
use crate::language::{Elsewhere, Examined, led_to};
use crate::world::World;

/// Files of a folder that are looked through for the one that links this.
const LOOKED_THROUGH_MAX: usize = 64;
/// Links from the main file down to this one.
const LINKS_MAX: usize = 8;

pub(super) fn examine(source: &PlcSource, world: &World) -> Examined {
    if source.text.text.trim().is_empty() {
        return Examined::default();
    }
    let main = main_of(&source.path, world);
    let compilation = compiled(source, &main, world);
    let faults = compilation.diagnostics().into_iter();
    let mut faults: Vec<Diagnostic> = faults.filter_map(|fault| located(source, &main, fault)).collect();
    faults.sort_by_key(|fault| fault.span);
    Examined {
        faults,
        not_listed: compilation.not_listed,
        complete: true,
        ..Examined::default()
    }
}

fn compiled(source: &PlcSource, main: &Path, world: &World) -> Compilation {
    let folder = main.parent().unwrap_or(Path::new(""));
    let memory = |folder| Folder { folder, world };
    let files = Memories {
        ram: &memory(folder.to_owned()),
        eprom: Some(&memory(folder.join("EPROM"))),
    };
    let mut options = Options::for_model(source.model);
    options.strict = world.settings.strict;
    let name = main.file_name().unwrap_or_default().to_string_lossy();
    Compilation::compile(files, &name, options)
}

/// A fault of this file at its place; one of a linked file where this one links it.
fn located(source: &PlcSource, main: &Path, fault: Diagnostic) -> Option<Diagnostic> {
    let folder = main.parent().unwrap_or(Path::new(""));
    let name = fault.file.to_string_lossy().into_owned();
    let mut fault = Diagnostic {
        file: folder.join(&fault.file),
        ..fault
    };
    if is_same(&fault.file, &source.path) {
        let place = |span: Span| source.text.span(&bytes_at(source, span));
        fault.span = place(fault.span);
        for related in &mut fault.related {
            related.file = PathBuf::new();
            related.span = place(related.span);
        }
        return Some(fault);
    }
    // The main file shows all errors; a linked file only its own.
    let is_main = is_same(main, &source.path);
    is_main.then(|| led_to(fault, source.text.span(&link_to(source, &name))))
}

/// The bytes of a word.
fn bytes_at(source: &PlcSource, span: Span) -> Range<usize> {
    let Some(line) = source.lines.get((span.line as usize).saturating_sub(1)) else {
        let end = source.text.text.len();
        return end..end;
    };
    source
        .text
        .characters(line.bytes.clone(), span.column as usize, span.length as usize)
}

/// The line that links a file, else the first.
fn link_to(source: &PlcSource, name: &str) -> Range<usize> {
    let links = |operand: &LineOperand| matches!(operand, LineOperand::File(file) if same_name(file, name));
    let found = source.words().find(|(_, _, words)| links(&words.operand));
    let first = || source.lines.first().map(|line| line.bytes.clone());
    found
        .map(|(_, _, words)| words.operand_at.clone())
        .or_else(first)
        .unwrap_or_default()
}

/// The main file of the program to which a file belongs: the one that links it, and that nobody links.
fn main_of(path: &Path, world: &World) -> PathBuf {
    let mut main = path.to_owned();
    for _ in 0..LINKS_MAX {
        match linking(&main, world) {
            Some(next) if next != path => main = next,
            _ => break,
        }
    }
    main
}

/// A file of the folder that links a file.
fn linking(path: &Path, world: &World) -> Option<PathBuf> {
    let folder = path.parent()?;
    let own = path.file_name()?.to_string_lossy();
    let sources = world
        .files
        .names(folder)
        .into_iter()
        .filter(|name| name.to_ascii_lowercase().ends_with(".plc") && !name.eq_ignore_ascii_case(&own));
    sources
        .take(LOOKED_THROUGH_MAX)
        .map(|name| folder.join(name))
        .find(|other| {
            let bytes = world.read(other).unwrap_or_default();
            let text = decode(&bytes);
            let mut links = text.lines().filter_map(|line| {
                let code = line.trim();
                let front = code.get(..4)?;
                front.eq_ignore_ascii_case("USES").then(|| code.get(4..))?
            });
            links.any(|name| {
                same_name(
                    name.split([' ', '\t', ';'])
                        .find(|word| !word.is_empty())
                        .unwrap_or_default(),
                    &own,
                )
            })
        })
}

/// Whether USES with one name leads to a file of another: endings may be missing, case does not count.
fn same_name(a: &str, b: &str) -> bool {
    let stem = |name: &str| {
        let name = name
            .rsplit(['\\', '/', ':'])
            .next()
            .unwrap_or_default()
            .to_ascii_lowercase();
        name.strip_suffix(".plc").map(str::to_owned).unwrap_or(name)
    };
    stem(a) == stem(b)
}

fn is_same(a: &Path, b: &Path) -> bool {
    let name = |path: &Path| {
        path.file_name()
            .unwrap_or_default()
            .to_string_lossy()
            .to_ascii_lowercase()
    };
    a.parent() == b.parent() && name(a) == name(b)
}

/// The file that USES names.
pub(super) fn linked(source: &PlcSource, name: &str, world: &World) -> Option<PathBuf> {
    let folder = source.path.parent()?;
    let name = name.rsplit(['\\', '/', ':']).next()?;
    let names = world.files.names(folder);
    let found = names.iter().find(|other| same_name(other, name))?;
    Some(folder.join(found))
}

/// Where another file of the program sets a label.
pub(super) fn label_elsewhere(source: &PlcSource, label: &str, world: &World) -> Option<Elsewhere> {
    let main = main_of(&source.path, world);
    let folder = main.parent()?;
    let compilation = compiled(source, &main, world);
    for file in &compilation.files {
        let path = folder.join(&file.name);
        if is_same(&path, &source.path) {
            continue;
        }
        for (line, text) in file.lines.iter().enumerate() {
            let words = line_words(text, source.model).filter(|words| words.instruction == "LBL");
            if let Some(words) = words.filter(|words| words.operand == LineOperand::Label(label.to_owned())) {
                let number = |at: usize| u32::try_from(at).unwrap_or(u32::MAX);
                return Some(Elsewhere {
                    path,
                    line: number(line),
                    characters: number(words.operand_at.start)..number(words.operand_at.end),
                });
            }
        }
    }
    None
}

/// The source files of a folder, as the editor shows them, else from the disk.
struct Folder<'a> {
    folder: PathBuf,
    world: &'a World,
}

impl Files for Folder<'_> {
    fn read(&self, name: &str) -> Option<NamedFile> {
        let bytes = self
            .world
            .read(&self.world.named(&self.folder, name_alone(name)?)?)?;
        let name = name.to_owned();
        Some(NamedFile { name, bytes })
    }
}
