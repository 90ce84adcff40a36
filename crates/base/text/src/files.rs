//! Files by their names, wherever they lie.
//!
//! Decision: Files that a text names are `Files`, whatever the language; what finds them knows folders, the language
//! knows spellings and endings. Which name of a folder is meant says one rule, `meant`. The RAM and the EPROM of the PLC are two of them. The files of a data interface are
//! others: they are listed, written and streamed (also `plc/src/source.rs`, `link/src/files.rs`)

use std::collections::BTreeMap;

/// Where the files are that a text names: a folder, documents of an editor, texts of a test.
///
/// A name is what the text says (`L sub.nc`, `USES PART.PLC`); the language knows its spellings and endings and asks for
/// each, whoever implements this knows where it lies and what it may not lead to.
pub trait Files: Send + Sync {
    /// The file of a name; `None` when there is none, or it cannot be read.
    fn read(&self, name: &str) -> Option<NamedFile>;
}

/// A file that was found.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct NamedFile {
    /// What reports call it.
    pub name: String,
    /// What is in it.
    pub bytes: Vec<u8>,
}

/// Files in memory, by name.
///
/// ```
/// use bahn_text::{Files, MemoryFiles};
///
/// let files = MemoryFiles::from([("MAIN.PLC", "L I4\n= O2\nEM\n")]);
/// assert_eq!(files.read("MAIN.PLC").unwrap().bytes, b"L I4\n= O2\nEM\n");
/// assert_eq!(files.read("main.plc"), None);
/// ```
#[derive(Clone, Debug, Default)]
pub struct MemoryFiles(BTreeMap<String, Vec<u8>>);

impl<const N: usize, T: AsRef<[u8]>> From<[(&str, T); N]> for MemoryFiles {
    fn from(files: [(&str, T); N]) -> MemoryFiles {
        files.into_iter().collect()
    }
}

impl<'a, T: AsRef<[u8]>> FromIterator<(&'a str, T)> for MemoryFiles {
    fn from_iter<I: IntoIterator<Item = (&'a str, T)>>(files: I) -> MemoryFiles {
        let entries = files
            .into_iter()
            .map(|(name, text)| (name.to_owned(), text.as_ref().to_vec()));
        MemoryFiles(entries.collect())
    }
}

impl Files for MemoryFiles {
    fn read(&self, name: &str) -> Option<NamedFile> {
        let bytes = self.0.get(name)?.clone();
        let name = name.to_owned();
        Some(NamedFile { name, bytes })
    }
}

/// A name with folders (`sub\part.nc`) as a path below the folder where it is looked for; `None` for one that leads
/// elsewhere.
///
/// ```
/// use bahn_text::path_below;
///
/// assert_eq!(path_below("sub\\part.nc").as_deref(), Some("sub/part.nc"));
/// assert_eq!(path_below("../part.nc"), None);
/// assert_eq!(path_below("/part.nc"), None);
/// assert_eq!(path_below("C:part.nc"), None);
/// ```
pub fn path_below(name: &str) -> Option<String> {
    let path = name.replace('\\', "/");
    let is_below = path
        .split('/')
        .all(|part| !part.is_empty() && part != ".." && !part.contains(':'));
    is_below.then_some(path)
}

/// The one of the names of a folder that is meant: the first wanted that is there as it is written; else the first that is
/// there in another case, of several such the first in the order of their names. `has` tells whether there is a file,
/// `there` what lies in the folder.
///
/// ```
/// use bahn_text::meant;
///
/// let there = ["SUB.NC", "sub.nc", "7.h"].map(str::to_owned);
/// let find = |name: &str| {
///     let wanted = [name.to_owned(), format!("{name}.H")];
///     meant(&wanted, |name| there.contains(&name.to_owned()), || there.to_vec())
/// };
/// assert_eq!(find("sub.nc").as_deref(), Some("sub.nc"));
/// assert_eq!(find("Sub.nc").as_deref(), Some("SUB.NC"));
/// assert_eq!(find("7").as_deref(), Some("7.h"));
/// assert_eq!(find("8"), None);
/// ```
pub fn meant(
    wanted: &[String],
    has: impl Fn(&str) -> bool,
    there: impl FnOnce() -> Vec<String>,
) -> Option<String> {
    if let Some(exact) = wanted.iter().find(|name| has(name)) {
        return Some(exact.clone());
    }
    let mut there = there();
    // The same one every time, whatever order the folder has.
    there.sort_unstable();
    wanted.iter().find_map(|name| {
        let lower = name.to_lowercase();
        let mut same = there.iter().filter(|other| other.to_lowercase() == lower);
        same.find(|other| has(other)).cloned()
    })
}

/// A name without its folders; `None` if no file can be meant.
///
/// ```
/// use bahn_text::name_alone;
///
/// assert_eq!(name_alone("PLC:\\OLD\\PART.PLC"), Some("PART.PLC"));
/// assert_eq!(name_alone("OLD/.."), None);
/// ```
pub fn name_alone(name: &str) -> Option<&str> {
    let name = name.rsplit(['\\', '/', ':']).next().unwrap_or_default();
    (!matches!(name, "" | "." | "..")).then_some(name)
}
