//! Programs of DIN 66025 and the subroutines beside them.

use std::path::{Path, PathBuf};
use std::sync::Arc;

use bahn_nc::NcReader;
use bahn_program::{DinLanguage, Program};
use bahn_reader::Start;
use bahn_text::{Files, NamedFile};

use super::{below, read_program};

/// The dialect of DIN 66025 that a file is in; `None` of one in a language of a TNC. One that is named `.nc` is in none if
/// it begins as a program of plain language: shops name those so, too.
pub fn dialect(path: &Path, bytes: &[u8]) -> Option<DinLanguage> {
    match bytes.trim_ascii().is_empty() {
        true => None,
        false => Program::from_bytes(path.to_string_lossy(), bytes.to_vec()).dialect(),
    }
}

/// The reader of a program that runs by itself; `None` for one that the control reads as its own, and for one of a
/// System 900, which is refused at its blocks.
pub fn nc_reader(program: &Program, start: &Start) -> Option<NcReader> {
    let bytes = match program.dialect()? {
        DinLanguage::Tf5200 => program.to_bytes(),
        DinLanguage::System900 => return None,
    };
    (!bytes.trim_ascii().is_empty()).then(|| {
        let beside = Arc::new(NcFolder::of(Path::new(program.name())));
        NcReader::new(program.name(), &bytes, start.clone(), beside)
    })
}

/// Subroutines that lie beside a program, or in folders below.
pub struct NcFolder(PathBuf);

impl NcFolder {
    /// The folder in which a program lies.
    pub fn of(program: &Path) -> NcFolder {
        NcFolder(program.parent().unwrap_or(Path::new("")).to_owned())
    }
}

impl Files for NcFolder {
    fn read(&self, name: &str) -> Option<NamedFile> {
        let name = below(&self.0, name)?;
        let bytes = read_program(&self.0.join(&name)).ok()??;
        Some(NamedFile { name, bytes })
    }
}
