//! Programs of DIN 66025 and the subroutines beside them.

use std::path::{Path, PathBuf};
use std::sync::Arc;

use bahn_din::Shelf;
use bahn_nc::NcReader;
use bahn_program::Program;
use bahn_reader::Start;

use super::read_program;

/// Whether a file is a program of DIN 66025: it is named `.nc`, and does not begin as one of plain language. Shops name
/// those so, too.
pub fn is_din(path: &Path, bytes: &[u8]) -> bool {
    let plain = || Program::from_bytes("1.H", bytes.to_vec()).begins_with_header();
    is_named(path) && !bytes.trim_ascii().is_empty() && !plain()
}

fn is_named(path: &Path) -> bool {
    path.extension()
        .is_some_and(|ending| ending.eq_ignore_ascii_case("nc"))
}

/// The reader of a program of DIN 66025; `None` for one in a language of the control.
pub fn nc_reader(program: &Program, start: &Start) -> Option<NcReader> {
    let path = Path::new(program.name());
    if !is_named(path) {
        return None;
    }
    let bytes = program.to_bytes();
    is_din(path, &bytes).then(|| {
        let beside = Arc::new(NcFolder::of(path));
        NcReader::new(program.name(), &bytes, start.clone(), beside)
    })
}

/// Subroutines that lie beside a program, or in folders below.
pub struct NcFolder(PathBuf);

impl NcFolder {
    /// The folder of a program.
    pub fn of(program: &Path) -> NcFolder {
        NcFolder(program.parent().unwrap_or(Path::new("")).to_owned())
    }
}

impl Shelf for NcFolder {
    fn text(&self, name: &str) -> Option<(String, Vec<u8>)> {
        let relative = name.replace('\\', "/");
        let inside = relative
            .split('/')
            .all(|part| !part.is_empty() && part != ".." && !part.contains(':'));
        let path = self.0.join(&relative);
        if !inside || !path.is_file() {
            return None;
        }
        let bytes = read_program(&path).ok()??;
        Some((relative, bytes))
    }
}
