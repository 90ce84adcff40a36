//! Names of called programs: which file of a folder they mean.

use std::path::{Path, PathBuf};

use bahn_program::FILE_TYPES;

/// The file that CALL PGM with this name means in a folder, called from a file with some ending: the name as
/// written, then with `.H`, `.I` and the ending of the caller. Case does not matter, but the name as it is
/// written goes before others.
pub(crate) fn find(folder: &Path, name: &str, caller: &Path) -> Option<PathBuf> {
    let ending = caller.extension().and_then(|ending| ending.to_str());
    let names = candidates(name, ending.unwrap_or_default());
    let exact = names
        .iter()
        .map(|name| folder.join(name))
        .find(|path| path.is_file());
    exact.or_else(|| in_any_case(folder, &names))
}

fn in_any_case(folder: &Path, names: &[String]) -> Option<PathBuf> {
    let folder = if folder.as_os_str().is_empty() {
        Path::new(".")
    } else {
        folder
    };
    let mut there: Vec<String> = std::fs::read_dir(folder)
        .ok()?
        .filter_map(|entry| entry.ok()?.file_name().into_string().ok())
        .collect();
    // The same one every time, whatever order the folder has.
    there.sort_unstable();
    names.iter().find_map(|name| {
        let same = |other: &&String| other.to_lowercase() == name.to_lowercase();
        there
            .iter()
            .filter(same)
            .map(|other| folder.join(other))
            .find(|path| path.is_file())
    })
}

/// A file of a folder by its name: as it is written, else in any case.
pub fn named(folder: &Path, name: &str) -> Option<PathBuf> {
    let exact = folder.join(name);
    match exact.is_file() {
        true => Some(exact),
        false => in_any_case(folder, &[name.to_owned()]),
    }
}

/// File names of a called program. Later controls write folders (`TNC:\PARTS\7.H`): only the name counts,
/// everything lies in one folder here.
fn candidates(name: &str, callers_ending: &str) -> Vec<String> {
    let name = name.trim().rsplit(['\\', '/', ':']).next().unwrap_or_default();
    if name.is_empty() || name == "." || name == ".." {
        return Vec::new();
    }
    let mut names = vec![name.to_owned()];
    names.extend(FILE_TYPES.iter().map(|of| format!("{name}.{}", of.extension)));
    if !callers_ending.is_empty() {
        names.push(format!("{name}.{callers_ending}"));
    }
    names
}

/// The file that a call of a program means, beside the calling one.
pub fn called_program(name: &str, caller: &Path) -> Option<PathBuf> {
    find(caller.parent().unwrap_or(Path::new("")), name, caller)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn called_names_get_endings_and_lose_folders() {
        assert_eq!(candidates("7", ""), ["7", "7.H", "7.I"]);
        assert_eq!(candidates("7", "nc"), ["7", "7.H", "7.I", "7.nc"]);
        assert_eq!(candidates(r"TNC:\PARTS\7.H", ""), ["7.H", "7.H.H", "7.H.I"]);
        assert!(candidates("..", "H").is_empty() && candidates("/", "").is_empty());
    }
}
