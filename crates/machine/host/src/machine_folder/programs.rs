//! The part programs of a machine.

use std::io::Write;
use std::path::{Path, PathBuf};
use std::sync::Arc;

use bahn_program::Program;
use bahn_reader::{Reader, Start};
use bahn_tnc::Programs;

use crate::HostError;
use crate::files::{self, FileLibrary, Loaded, NewFile};

/// The folder of programs, and the program that was given by its path, with those that lie beside it.
pub struct FolderPrograms {
    /// A name in the folder: programs lie beside their caller.
    caller: String,
    main: Option<Arc<Program>>,
    /// Where digitized programs go, when they do not go into the folder.
    digitized: Option<PathBuf>,
    folder: PathBuf,
    library: FileLibrary,
}

impl FolderPrograms {
    /// The programs of a folder, and a main program from anywhere: a path, or the name of a program in the
    /// folder.
    ///
    /// # Errors
    /// When the program cannot be read.
    pub fn new(folder: &Path, main: Option<&Path>) -> Result<FolderPrograms, HostError> {
        let programs = FolderPrograms::of_folder(folder);
        let Some(main) = main else {
            return Ok(programs);
        };
        let main = load(&absolute(folder), main)?;
        Ok(FolderPrograms {
            library: files::beside(&main),
            main: Some(main),
            ..programs
        })
    }

    /// The programs of a folder, without a main program.
    pub fn of_folder(folder: &Path) -> FolderPrograms {
        FolderPrograms {
            caller: absolute(folder).join("operator").to_string_lossy().into_owned(),
            main: None,
            digitized: None,
            folder: absolute(folder),
            library: FileLibrary::default(),
        }
    }

    /// The same with another folder for digitized programs; a program of the same name there is replaced.
    pub fn with_digitized(mut self, folder: Option<&Path>) -> FolderPrograms {
        self.digitized = folder.map(Path::to_owned);
        self
    }

    /// The name by which the operator selects the main program.
    pub fn main_name(&self) -> Option<&str> {
        self.main.as_ref().map(|main| files::short_name(main))
    }

    /// The main program; `None` where none was named.
    pub fn main(&self) -> Option<&Arc<Program>> {
        self.main.as_ref()
    }
}

fn absolute(folder: &Path) -> PathBuf {
    std::path::absolute(folder).unwrap_or_else(|_| folder.to_owned())
}

fn load(folder: &Path, path: &Path) -> Result<Arc<Program>, HostError> {
    let beside = folder.join(path);
    let path = if !path.exists() && beside.is_file() {
        &beside
    } else {
        path
    };
    match files::load_program(path)? {
        Loaded::Program(program) => Ok(program),
        Loaded::Empty(_) => Err(HostError::new(format!("{}: {}", path.display(), files::EMPTY))),
        Loaded::TooLarge => Err(HostError::new(format!(
            "{}: {}",
            path.display(),
            files::TOO_LARGE
        ))),
    }
}

impl Programs for FolderPrograms {
    fn open(&self, name: &str, caller: &str) -> Result<Option<Arc<Program>>, String> {
        if let Some(main) = self.main.as_ref().filter(|_| self.main_name() == Some(name)) {
            return Ok(Some(Arc::clone(main)));
        }
        let library = &self.library;
        if !caller.is_empty()
            && let Some(program) = library.open(name, caller)?
        {
            return Ok(Some(program));
        }
        let in_folder = library.open(name, &self.caller)?;
        match (in_folder, &self.main) {
            (None, Some(main)) => library.open(name, main.name()),
            (found, _) => Ok(found),
        }
    }

    fn reader(&self, name: &str, start: &Start) -> Result<Option<Box<dyn Reader>>, String> {
        let program = self.open(name, "")?;
        let reader = program.and_then(|program| files::nc_reader(&program, start));
        Ok(reader.map(|reader| -> Box<dyn Reader> { Box::new(reader) }))
    }

    fn name_here(&self, name: &str) -> String {
        self.folder.join(name).to_string_lossy().into_owned()
    }

    fn open_in_eprom(&self, name: &str, caller: &str) -> Result<Option<Arc<Program>>, String> {
        let library = &self.library;
        if !caller.is_empty()
            && let Some(program) = library.open_in_eprom(name, caller)?
        {
            return Ok(Some(program));
        }
        library.open_in_eprom(name, &self.caller)
    }

    fn store(&self, name: &str, pieces: &[Arc<[u8]>]) -> Result<(), String> {
        let folder = self.digitized.as_ref().unwrap_or(&self.folder);
        let path = folder.join(format!("{name}.H"));
        if self.digitized.is_none() && path.exists() {
            return Err(format!("{} is there already", path.display()));
        }
        let write = || {
            let mut file = NewFile::create(&path)?;
            for piece in pieces {
                file.write_all(piece)
                    .map_err(|error| files::cannot("write", &path, &error))?;
            }
            file.finish()
        };
        write().map_err(|error: HostError| error.to_string())
    }
}
