//! The PLC's source files beside the main file, as text: read and written whole or not at all.
//!
//! Decision: The editor of PLC files keeps their letters (UTF-8, or the control's Latin ones) and ends of lines, and
//! reads a file again that somebody else has written meanwhile

use std::fs;
use std::path::{Path, PathBuf};

use bahn_host::files;
use bahn_parameters::MessageId;
use bahn_screen::programs::is_name;
use bahn_text::Encoding;

use crate::pages::description;
use crate::pages::external::Own;
use crate::site::Site;
use crate::transfer::TransferFiles;

/// What EXT transfers: the files of the PLC.
pub(super) const FILES: Own = Own {
    files: TransferFiles::Plc,
    names: transferable,
    named: |name, _| named_at_interface(name),
};

/// Bytes of a source file at most.
const SIZE_MAX: u64 = 4 << 20;

/// A source file.
#[derive(Debug)]
pub(super) struct Source {
    path: PathBuf,
    /// Its lines, without what ends them.
    pub lines: Vec<String>,
    encoding: Encoding,
    ending: &'static str,
    /// What lies on the medium, as far as is known here.
    stored: Vec<u8>,
}

/// Why a file is not written.
#[derive(Debug, PartialEq, Eq)]
pub(super) enum NotWritten {
    /// Somebody else has written it since it was read.
    Changed,
    /// It is protected.
    Protected,
    /// In words: the medium does not do it.
    Words(String),
}

impl Source {
    /// Reads a file of the folder by its name.
    ///
    /// # Errors
    /// In words.
    pub fn read(name: &str, site: &Site) -> Result<Source, String> {
        let known = list(site).iter().any(|own| own == name);
        let path = folder(site).join(name);
        match known {
            true => Source::open(path),
            false => Err(format!("{name} is no file of the PLC program")),
        }
    }

    fn open(path: PathBuf) -> Result<Source, String> {
        let stored = files::read_table(&path).map_err(|error| error.to_string())?;
        if stored.contains(&0) {
            return Err(format!("{} is no text of single bytes", path.display()));
        }
        let (text, encoding) = Encoding::read(&stored);
        let ending = if text.contains("\r\n") { "\r\n" } else { "\n" };
        let lines = text.lines().map(str::to_owned).collect();
        Ok(Source {
            path,
            lines,
            encoding,
            ending,
            stored,
        })
    }

    fn bytes(&self) -> Vec<u8> {
        let mut text = self.lines.join(self.ending);
        if !text.is_empty() {
            text.push_str(self.ending);
        }
        self.encoding.write(&text)
    }

    /// Writes what has changed, whole or not at all.
    ///
    /// # Errors
    /// [`NotWritten`]; the file is what it was.
    pub fn write(&mut self) -> Result<(), NotWritten> {
        let words = |error: bahn_host::HostError| NotWritten::Words(error.to_string());
        let bytes = self.bytes();
        if bytes == self.stored {
            return Ok(());
        }
        if is_protected(&self.path) {
            return Err(NotWritten::Protected);
        }
        if files::read_table(&self.path).map_err(words)? != self.stored {
            return Err(NotWritten::Changed);
        }
        files::write_whole(&self.path, &bytes).map_err(words)?;
        self.stored = bytes;
        Ok(())
    }

    /// Reads it again.
    ///
    /// # Errors
    /// In words.
    pub fn renew(&mut self) -> Result<(), String> {
        *self = Source::open(self.path.clone())?;
        Ok(())
    }
}

/// The folder of the main file.
fn folder(site: &Site) -> PathBuf {
    let main = site.machine.root.join(&site.machine.folder.plc);
    main.parent().map(Path::to_owned).unwrap_or_default()
}

/// The entry of machine.toml that names the main file.
pub(super) const MAIN: &str = "plc";

/// The main file of the machine's program: COMPILE may have made another one of it since the machine was loaded.
pub(super) fn main_file(site: &Site) -> String {
    let path = description::value(MAIN, site).unwrap_or_else(|| site.machine.folder.plc.clone());
    path.rsplit('/').next().unwrap_or(&path).to_owned()
}

/// How `machine.toml` names a file of the folder.
pub(super) fn named(name: &str, site: &Site) -> String {
    let folder = site.machine.folder.plc.rsplit_once('/');
    folder.map_or_else(|| name.to_owned(), |(folder, _)| format!("{folder}/{name}"))
}

/// The type of programs.
const PROGRAM: &str = "PLC";
/// Binary code of EPROMs, which no interface knows [000:11335-11350].
const BINARY: &str = "BIN";
/// The letters of types at the interface, of those that have one of their own there [000:16895-16913] [000:3867-3869].
const LETTERS: [(&str, &str); 4] = [("P", PROGRAM), ("S", "CMA"), ("V", "COM"), ("J", "HLP")];

fn ending(name: &str) -> &str {
    name.rsplit_once('.').map_or("", |(_, ending)| ending)
}

/// Whether an ending is one of the types that data interfaces know.
fn is_known(ending: &str) -> bool {
    let mut types = TransferFiles::Plc.extensions().into_iter().flatten();
    types.any(|own| own.eq_ignore_ascii_case(ending))
}

/// Whether a file is a PLC program, or a part of one, by its name: what is no text, list, table or binary code.
pub(super) fn is_source(name: &str) -> bool {
    let ending = ending(name);
    let is = |kind: &str| kind.eq_ignore_ascii_case(ending);
    is(PROGRAM) || !(is_known(ending) || is(BINARY))
}

/// The files that data interfaces transfer.
pub(super) fn transferable(site: &Site) -> Vec<String> {
    let names = list(site).into_iter();
    names.filter(|name| is_known(ending(name))).collect()
}

/// A file by the name that is entered for a transfer: programs need no type, and a letter stands for its type.
pub(super) fn named_at_interface(name: &str) -> String {
    let Some((stem, ending)) = name.rsplit_once('.') else {
        return format!("{name}.{PROGRAM}");
    };
    let mut letters = LETTERS.iter();
    let own = letters.find(|(letter, _)| letter.eq_ignore_ascii_case(ending));
    own.map_or_else(|| name.to_owned(), |(_, own)| format!("{stem}.{own}"))
}

/// Where a main file lies; its name comes from [`list`].
pub(super) fn path(name: &str, site: &Site) -> PathBuf {
    folder(site).join(name)
}

/// Writes a file of the folder, whether there is one of this name or not.
///
/// # Errors
/// In words.
pub(super) fn replace(name: &str, text: &str, site: &Site) -> Result<(), String> {
    write(name, text.as_bytes(), site)
}

/// The same with any bytes.
///
/// # Errors
/// In words.
pub(super) fn write(name: &str, bytes: &[u8], site: &Site) -> Result<(), String> {
    files::write_whole(&folder(site).join(name), bytes).map_err(|error| error.to_string())
}

/// Erases a file of the folder.
///
/// # Errors
/// In words: it is protected, or the medium does not do it.
pub(super) fn erase(name: &str, site: &Site) -> Result<(), String> {
    let path = path(name, site);
    if is_protected(&path) {
        return Err(site.message(MessageId::ProtectedPgm));
    }
    fs::remove_file(&path).map_err(|error| error.to_string())?;
    files::sync_folder(&path);
    Ok(())
}

/// Writes a new file of the folder.
///
/// # Errors
/// In words, when there is one of this name, or the medium does not take it.
pub(super) fn create(name: &str, bytes: &[u8], site: &Site) -> Result<(), String> {
    let path = folder(site).join(name);
    if !is_name(name) || path.exists() {
        return Err(site.message(MessageId::EntryValueIncorrect));
    }
    files::write_whole(&path, bytes).map_err(|error| error.to_string())
}

/// Copies a file of the folder to a new one.
///
/// # Errors
/// In words.
pub(super) fn copy(old: &str, new: &str, site: &Site) -> Result<(), String> {
    let bytes = files::read_table(&path(old, site)).map_err(|error| error.to_string())?;
    create(new, &bytes, site)
}

/// Gives a file another name.
///
/// # Errors
/// In words: it is protected, or there is one of this name.
pub(super) fn rename(old: &str, new: &str, site: &Site) -> Result<(), String> {
    let (from, to) = (path(old, site), path(new, site));
    if is_protected(&from) {
        return Err(site.message(MessageId::ProtectedPgm));
    }
    if !is_name(new) || to.exists() {
        return Err(site.message(MessageId::EntryValueIncorrect));
    }
    fs::rename(from, to).map_err(|error| error.to_string())
}

/// Protects a file of the folder, or no more: nobody may write it.
///
/// # Errors
/// In words.
pub(super) fn protect(name: &str, on: bool, site: &Site) -> Result<(), String> {
    let path = path(name, site);
    let set = || {
        let mut allowed = fs::metadata(&path)?.permissions();
        allowed.set_readonly(on);
        fs::set_permissions(&path, allowed)
    };
    set().map_err(|error: std::io::Error| error.to_string())
}

/// Whether a file is protected.
pub(super) fn is_protected(path: &Path) -> bool {
    fs::metadata(path).is_ok_and(|about| about.permissions().readonly())
}

/// The files of the program's folder by name: plain files that are not hidden and not too long. Links lead out of it and are none.
pub(super) fn list(site: &Site) -> Vec<String> {
    let Ok(entries) = fs::read_dir(folder(site)) else {
        return Vec::new();
    };
    let names = entries.flatten().filter_map(|entry| {
        let about = fs::symlink_metadata(entry.path()).ok()?;
        let name = entry.file_name().into_string().ok()?;
        let fits = about.is_file() && about.len() <= SIZE_MAX && !name.starts_with('.');
        fits.then_some(name)
    });
    let mut names: Vec<String> = names.collect();
    names.sort();
    names
}
