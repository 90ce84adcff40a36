//! Programs and subroutines from files.

use std::path::{Path, PathBuf};
use std::sync::Arc;

use bahn_din::{BlockFault, Command, Decoder, Program, Section, Shelf, Step, Unit, Variables};
use bahn_path::Position;
use bahn_technology::{Blocks, Fault, Programs};

use crate::{UsageError, files};

/// The code of a block that cannot be read or executed, for which the manuals have no number.
const UNREADABLE: &str = "block";

/// The programs of a run in turn; a file may hold several.
pub(super) struct Files {
    programs: Vec<Main>,
}

/// A program with the file it stands in.
struct Main {
    program: Arc<Program>,
    section: Section,
    shelf: Arc<Folder>,
}

impl Files {
    pub fn read(paths: &[PathBuf]) -> Result<Files, UsageError> {
        let mut programs = Vec::new();
        for path in paths {
            let program = Arc::new(Program::from_bytes(&file_name(path), &read(path)?));
            let shelf = Arc::new(Folder::of(path));
            let before = programs.len();
            programs.extend(program.mains().map(|section| Main {
                program: program.clone(),
                section: section.clone(),
                shelf: shelf.clone(),
            }));
            if programs.len() == before {
                return Err(UsageError::new(format!(
                    "{} holds no program that can be run",
                    path.display()
                )));
            }
        }
        Ok(Files { programs })
    }

    /// What a picture is called.
    pub fn title(&self) -> String {
        let mut names: Vec<&str> = self.programs.iter().map(|main| &**main.program.name()).collect();
        names.dedup();
        names.join(", ")
    }
}

fn read(path: &Path) -> Result<Vec<u8>, UsageError> {
    let bytes = files::read_program(path)?;
    bytes.ok_or_else(|| UsageError::new(format!("{} is too large", path.display())))
}

/// A file as reports call it.
fn file_name(path: &Path) -> String {
    let name = path.file_name().unwrap_or(path.as_os_str());
    name.to_string_lossy().into_owned()
}

impl Programs for Files {
    fn count(&self) -> usize {
        self.programs.len()
    }

    fn name(&self, index: usize) -> String {
        let main = self.programs.get(index);
        main.map_or_else(String::new, |main| main.program.name().to_string())
    }

    fn open(&self, index: usize, start: &Position) -> Result<Box<dyn Blocks + '_>, Fault> {
        let Some(main) = self.programs.get(index) else {
            return Err(Fault {
                code: UNREADABLE.to_owned(),
                message: "there is no such program".to_owned(),
                program: String::new(),
                block: String::new(),
            });
        };
        let shelf: Arc<dyn Shelf> = main.shelf.clone();
        let decoder = Decoder::new(main.program.clone(), &main.section, *start, shelf);
        Ok(Box::new(Decoded(decoder)))
    }
}

/// A program on its way.
struct Decoded(Decoder);

impl Blocks for Decoded {
    fn next(&mut self, variables: &mut dyn Variables) -> Result<Option<Unit>, Fault> {
        match self.0.next(variables) {
            Step::Unit(unit) => Ok(Some(*unit)),
            Step::Fault(fault) => Err(at_its_block(fault)),
            Step::End => Ok(None),
        }
    }

    fn skip_to(
        &mut self,
        block: &str,
        variables: &mut dyn Variables,
    ) -> Result<(Position, Vec<Command>), Fault> {
        let found = self.0.skip_to(block, variables).map_err(at_its_block)?;
        Ok((found.position, found.commands))
    }
}

fn at_its_block(fault: BlockFault) -> Fault {
    Fault {
        code: UNREADABLE.to_owned(),
        message: fault.message,
        program: fault.place.program.to_string(),
        block: fault.place.block.to_string(),
    }
}

/// The folder of a program, where its subroutines lie.
struct Folder(PathBuf);

impl Folder {
    fn of(program: &Path) -> Folder {
        let parent = program.parent().filter(|folder| !folder.as_os_str().is_empty());
        Folder(parent.unwrap_or(Path::new(".")).to_owned())
    }

    /// The file of a name without regard to case, if there is none written so. Names lead nowhere else.
    fn find(&self, name: &str) -> Option<PathBuf> {
        if name.is_empty() || name.contains(['/', '\\', '\0']) || name == ".." {
            return None;
        }
        let path = self.0.join(name);
        if path.is_file() {
            return Some(path);
        }
        let entries = std::fs::read_dir(&self.0).ok()?;
        let mut alike: Vec<PathBuf> = entries
            .filter_map(|entry| Some(entry.ok()?.path()))
            .filter(|path| path.is_file() && file_name(path).eq_ignore_ascii_case(name))
            .collect();
        alike.sort();
        alike.into_iter().next()
    }
}

impl Shelf for Folder {
    fn text(&self, name: &str) -> Option<(String, Vec<u8>)> {
        let path = self.find(name)?;
        let bytes = files::read_program(&path).ok()??;
        Some((file_name(&path), bytes))
    }
}
