//! Which programs: files, folders with everything in them, names on standard input.

use std::collections::HashSet;
use std::ffi::OsStr;
use std::fs;
use std::io::{self, BufRead};
use std::path::{Path, PathBuf};

use crate::{UsageError, files};

/// Folders in folders; deeper ones are no shelf of programs.
const DEEPEST: usize = 64;

/// The programs in the order of the command line, each once; those of a folder by name. `remedy` is said where there are
/// none.
pub(crate) fn programs(
    named: &[PathBuf],
    endings: &[String],
    remedy: &str,
) -> Result<Vec<PathBuf>, UsageError> {
    let mut found = Vec::new();
    for path in named {
        if path.as_os_str() == "-" {
            for line in io::stdin().lock().lines() {
                let line =
                    line.map_err(|error| UsageError::new(format!("cannot read standard input: {error}")))?;
                let line = line.trim_end_matches('\r');
                if !line.trim().is_empty() {
                    add(Path::new(line), endings, &mut found)?;
                }
            }
            continue;
        }
        if let Err(error) = fs::metadata(path) {
            return Err(files::cannot("read", path, &error).into());
        }
        add(path, endings, &mut found)?;
    }
    let mut seen = HashSet::new();
    found.retain(|path| seen.insert(path.clone()));
    if found.is_empty() {
        return Err(UsageError::new(format!(
            "there is no program with the ending {}{remedy}",
            endings.join(" or ")
        )));
    }
    Ok(found)
}

fn add(path: &Path, endings: &[String], found: &mut Vec<PathBuf>) -> Result<(), UsageError> {
    if !path.is_dir() {
        found.push(path.to_owned());
        return Ok(());
    }
    folder(path, endings, DEEPEST, found)
}

/// Everything in a folder. Links to folders are not followed: they may lead in a circle.
fn folder(path: &Path, endings: &[String], deep: usize, found: &mut Vec<PathBuf>) -> Result<(), UsageError> {
    let cannot = |error: io::Error| files::cannot("read", path, &error);
    let mut entries: Vec<fs::DirEntry> = fs::read_dir(path).and_then(Iterator::collect).map_err(cannot)?;
    entries.sort_by_key(fs::DirEntry::file_name);
    for entry in entries {
        let inner = entry.path();
        let is_folder = entry.file_type().map_err(cannot)?.is_dir();
        if is_folder && deep > 0 {
            folder(&inner, endings, deep - 1, found)?;
        } else if !is_folder && has_ending(&inner, endings) && inner.is_file() {
            found.push(inner);
        }
    }
    Ok(())
}

fn has_ending(path: &Path, endings: &[String]) -> bool {
    let ending = path.extension().and_then(OsStr::to_str).unwrap_or_default();
    endings
        .iter()
        .any(|wanted| wanted.trim().trim_start_matches('.').eq_ignore_ascii_case(ending))
}
