//! Source files beside the main file, and what the compiler says about them.

use std::path::{Path, PathBuf};

use bahn_plc::{Compilation, Options, ProgramMemory, SourceFiles};
use bahn_text::Diagnostic;

use crate::files;

/// A compiled program with the folder it comes from.
pub struct PlcSource {
    folder: Folder,
    /// What the compiler made of it.
    pub compilation: Compilation,
}

impl PlcSource {
    /// Compiles the main file and what it links. `bytes` is what was read of the main file already: a pipe can be
    /// read only once.
    pub fn compile(file: &Path, bytes: Option<Vec<u8>>, options: Options) -> PlcSource {
        let main = file.file_name().unwrap_or_default().to_string_lossy();
        let folder = Folder {
            folder: file.parent().map(Path::to_owned).unwrap_or_default(),
            main: main.to_string(),
            bytes,
            memory: options.memory,
        };
        let compilation = Compilation::compile(&folder, &main, options);
        PlcSource { folder, compilation }
    }

    /// What keeps the program from running, then what is accepted although the printed rules refuse it; files as they lie
    /// on the disk.
    pub fn faults(&self) -> Vec<Diagnostic> {
        let mut faults = self.compilation.diagnostics();
        for fault in &mut faults {
            let place = self.folder.path(&fault.file);
            let related = fault.related.iter_mut().map(|related| &mut related.file);
            related.for_each(|file| *file = self.folder.path(file));
            fault.file = place;
        }
        faults
    }
}

/// The source files beside the main file, and those in its folder EPROM; names lose folders.
struct Folder {
    folder: PathBuf,
    main: String,
    /// Of the main file, where it was read before.
    bytes: Option<Vec<u8>>,
    memory: ProgramMemory,
}

impl Folder {
    /// Where a file was found.
    fn path(&self, name: &Path) -> PathBuf {
        let (ram, eprom) = (self.folder.join(name), self.folder.join(EPROM).join(name));
        let is_ram = name == Path::new(&self.main) || self.memory == ProgramMemory::Ram && ram.is_file();
        if is_ram { ram } else { eprom }
    }
}

/// The folder that stands for the EPROM.
const EPROM: &str = "EPROM";

impl SourceFiles for Folder {
    fn read(&self, name: &str) -> Option<Vec<u8>> {
        let main = self.bytes.as_ref().filter(|_| name == self.main);
        main.cloned().or_else(|| read_in(&self.folder, name))
    }

    /// The main file runs from wherever it is.
    fn read_eprom(&self, name: &str) -> Option<Vec<u8>> {
        if name == self.main {
            return self.read(name);
        }
        read_in(&self.folder.join(EPROM), name)
    }
}

fn read_in(folder: &Path, name: &str) -> Option<Vec<u8>> {
    let name = name.rsplit(['\\', '/', ':']).next().unwrap_or_default();
    if name.is_empty() || name == "." || name == ".." {
        return None;
    }
    [name.to_owned(), name.to_ascii_lowercase()]
        .iter()
        .map(|name| folder.join(name))
        .find(|path| path.is_file())
        .and_then(|path| files::read_table(&path).ok())
}
