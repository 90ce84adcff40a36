//! Source files beside the main file, and what the compiler says about them.

use std::path::{Path, PathBuf};

use bahn_plc::{Compilation, Memories, Options, ProgramMemory};
use bahn_text::{Diagnostic, Files, NamedFile, name_alone};

use crate::files;

/// A compiled program with the folder it comes from.
pub struct PlcSource {
    folder: PathBuf,
    main: String,
    memory: ProgramMemory,
    /// What the compiler made of it.
    pub compilation: Compilation,
}

impl PlcSource {
    /// Compiles the main file and what it links. `bytes` is what was read of the main file already: a pipe can be
    /// read only once.
    pub fn compile(file: &Path, bytes: Option<Vec<u8>>, options: Options) -> PlcSource {
        let main = file.file_name().unwrap_or_default().to_string_lossy();
        let folder = file.parent().map(Path::to_owned).unwrap_or_default();
        let bytes = bytes.or_else(|| read_in(&folder, &main));
        let memory = |folder| Folder {
            folder,
            main: &main,
            bytes: bytes.as_deref(),
        };
        let files = Memories {
            ram: &memory(folder.clone()),
            eprom: Some(&memory(folder.join(EPROM))),
        };
        PlcSource {
            compilation: Compilation::compile(files, &main, options),
            folder,
            main: main.into_owned(),
            memory: options.memory,
        }
    }

    /// The image of a main file in the EPROM, where there is one.
    pub(crate) fn eprom_image(file: &Path) -> Option<PathBuf> {
        let name = file.file_name()?.to_string_lossy();
        files::named(&file.parent()?.join(EPROM), &name)
    }

    /// What keeps the program from running, then what is accepted although the printed rules refuse it; files as they lie
    /// on the disk.
    pub fn faults(&self) -> Vec<Diagnostic> {
        let mut faults = self.compilation.diagnostics();
        for fault in &mut faults {
            let place = self.path(&fault.file);
            let related = fault.related.iter_mut().map(|related| &mut related.file);
            related.for_each(|file| *file = self.path(file));
            fault.file = place;
        }
        faults
    }

    /// Where a file was found.
    fn path(&self, name: &Path) -> PathBuf {
        let (ram, eprom) = (self.folder.join(name), self.folder.join(EPROM).join(name));
        let is_ram = name == Path::new(&self.main) || self.memory == ProgramMemory::Ram && ram.is_file();
        if is_ram { ram } else { eprom }
    }
}

/// The folder that stands for the EPROM.
const EPROM: &str = "EPROM";

/// The source files of a memory.
struct Folder<'a> {
    folder: PathBuf,
    main: &'a str,
    /// Of the main file, which runs from wherever it is.
    bytes: Option<&'a [u8]>,
}

impl Files for Folder<'_> {
    fn read(&self, name: &str) -> Option<NamedFile> {
        let bytes = match name == self.main {
            true => self.bytes.map(<[u8]>::to_vec)?,
            false => read_in(&self.folder, name)?,
        };
        let name = name.to_owned();
        Some(NamedFile { name, bytes })
    }
}

fn read_in(folder: &Path, name: &str) -> Option<Vec<u8>> {
    let path = files::named(folder, name_alone(name)?)?;
    files::read_table(&path).ok()
}
