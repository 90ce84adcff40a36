//! Names of files: which file of a folder on the disk they mean.
//!
//! Decision: A name that a program, a subroutine or a PLC program is called by means the file that is written so, else one that
//! differs in its case only; subroutines of `.nc` programs lie beside their program or in folders below, and lead nowhere
//! else (also `text/src/files.rs`)

use std::path::{Path, PathBuf};

use bahn_text::{meant, path_below};

/// The names of what lies in a folder.
pub(crate) fn names_in(folder: &Path) -> Vec<String> {
    let folder = match folder.as_os_str().is_empty() {
        true => Path::new("."),
        false => folder,
    };
    let entries = std::fs::read_dir(folder).into_iter().flatten();
    let names = entries.filter_map(|entry| entry.ok()?.file_name().into_string().ok());
    names.collect()
}

/// A file of a folder by its name: as it is written, else in any case.
pub fn named(folder: &Path, name: &str) -> Option<PathBuf> {
    let has = |name: &str| folder.join(name).is_file();
    let found = meant(&[name.to_owned()], has, || names_in(folder))?;
    Some(folder.join(found))
}

/// A file of a folder, or of one below it, by a name with its folders, as `sub\\part.nc`; the name under which it was found.
pub fn below(folder: &Path, name: &str) -> Option<String> {
    let path = path_below(name)?;
    let (within, name) = path.rsplit_once('/').unwrap_or(("", &path));
    let found = named(&folder.join(within), name)?;
    let found = found.file_name()?.to_str()?;
    Some(match within {
        "" => found.to_owned(),
        within => format!("{within}/{found}"),
    })
}
