//! Programs of DIN 66025 and the subroutines beside them.

use std::path::{Path, PathBuf};
use std::sync::Arc;

use bahn_nc::NcReader;
use bahn_program::Program;
use bahn_reader::Start;
use bahn_text::{Files, NamedFile};

use super::{below, read_program};

/// Whether a file is a program of DIN 66025: it is named `.nc`, and does not begin as one of plain language. Shops name
/// those so, too.
pub fn is_din(path: &Path, bytes: &[u8]) -> bool {
    !bytes.trim_ascii().is_empty() && Program::from_bytes(path.to_string_lossy(), bytes.to_vec()).is_din()
}

/// The reader of a program of DIN 66025; `None` for one in a language of the control.
pub fn nc_reader(program: &Program, start: &Start) -> Option<NcReader> {
    let bytes = program.is_din().then(|| program.to_bytes())?;
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
