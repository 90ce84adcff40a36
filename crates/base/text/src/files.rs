//! Files by their names, wherever they lie.
//!
//! Decision: Files that a text names are `Files`, whatever the language; what finds them knows folders, the language
//! knows spellings and endings. The RAM and the EPROM of the PLC are two of them. The files of a data interface are
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

/// The spellings under which a name without its folders lies in a folder: as it is written, then in small letters; none
/// if no file can be meant.
///
/// ```
/// use bahn_text::names_in_folder;
///
/// assert!(names_in_folder("PLC:\\OLD\\PART.PLC").eq(["PART.PLC", "part.plc"]));
/// assert_eq!(names_in_folder("OLD/..").count(), 0);
/// ```
pub fn names_in_folder(name: &str) -> impl Iterator<Item = String> {
    let name = name.rsplit(['\\', '/', ':']).next().unwrap_or_default();
    let is_file = !matches!(name, "" | "." | "..");
    let spellings = is_file.then(|| [name.to_owned(), name.to_ascii_lowercase()]);
    spellings.into_iter().flatten()
}
