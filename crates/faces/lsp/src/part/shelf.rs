//! Called programs: as the editor shows them, else from the disk.

use std::collections::HashMap;
use std::path::{Path, PathBuf};
use std::sync::Arc;

use bahn_interpreter::Library;
use bahn_program::Program;

use crate::language::BYTES_MAX;
use crate::world::World;

pub(super) struct Shelf {
    world: World,
    programs: HashMap<PathBuf, Arc<Program>>,
}

impl Shelf {
    /// A shelf with the program that is examined.
    pub(super) fn with(main: &Arc<Program>, world: &World) -> Shelf {
        Shelf {
            world: world.clone(),
            programs: HashMap::from([(PathBuf::from(main.name()), main.clone())]),
        }
    }
}

impl Library for Shelf {
    fn find(&mut self, name: &str, caller: &str) -> Result<Option<Arc<Program>>, String> {
        let Some(path) = self.world.files.called(name, Path::new(caller)) else {
            return Ok(None);
        };
        if let Some(program) = self.programs.get(&path) {
            return Ok(Some(program.clone()));
        }
        let bytes = self.world.read(&path);
        let bytes = bytes.ok_or_else(|| format!("{} cannot be read", path.display()))?;
        if bytes.len() > BYTES_MAX {
            return Err(format!(
                "{} is too large to be looked at while it is edited",
                path.display()
            ));
        }
        let program = Arc::new(Program::from_bytes(path.to_string_lossy().into_owned(), bytes));
        self.programs.insert(path, program.clone());
        Ok(Some(program))
    }
}
