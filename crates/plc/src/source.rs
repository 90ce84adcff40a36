//! Where source files come from.

use std::collections::BTreeMap;

/// Where the control takes its PLC program from: MP4010 [000:11896-11903].
#[derive(Clone, Copy, Debug, PartialEq, Eq, Default)]
pub enum ProgramMemory {
    /// Battery-backed memory, MP4010 = 1: what is not there is looked for in the EPROM [000:14618].
    #[default]
    Ram,
    /// MP4010 = 0: files of the RAM must not be linked [000:14616].
    Eprom,
}

/// The source files that a program may link.
pub trait SourceFiles {
    /// The bytes of a file in the RAM; `None` when there is none of that name. Names are tried as written,
    /// in capitals, and with `.PLC` after them.
    fn read(&self, name: &str) -> Option<Vec<u8>>;

    /// The bytes of a file in the EPROM; there is none without one.
    fn read_eprom(&self, name: &str) -> Option<Vec<u8>> {
        let _ = name;
        None
    }
}

/// Source files in memory, by name.
///
/// ```
/// use bahn_plc::MemoryFiles;
/// let files = MemoryFiles::from([("MAIN.PLC", "L I4\n= O2\nEM\n")]);
/// ```
#[derive(Clone, Debug, Default)]
pub struct MemoryFiles(BTreeMap<String, Vec<u8>>);

impl<const N: usize, T: AsRef<[u8]>> From<[(&str, T); N]> for MemoryFiles {
    fn from(files: [(&str, T); N]) -> MemoryFiles {
        let entries = files
            .into_iter()
            .map(|(name, text)| (name.to_owned(), text.as_ref().to_vec()));
        MemoryFiles(entries.collect())
    }
}

impl SourceFiles for MemoryFiles {
    fn read(&self, name: &str) -> Option<Vec<u8>> {
        self.0.get(name).cloned()
    }
}

/// A file that was found under one of the spellings of its name.
pub(crate) struct Found {
    pub(crate) name: String,
    pub(crate) bytes: Vec<u8>,
}

/// Why a file cannot be linked.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Missing {
    /// There is no such file.
    NoFile,
    /// It lies in the RAM, and the program runs from the EPROM.
    InRamOnly,
}

/// Reads a file of the memory that programs run from.
pub(crate) fn find(files: &dyn SourceFiles, memory: ProgramMemory, name: &str) -> Result<Found, Missing> {
    let ram = || spelled(name, |spelling| files.read(spelling));
    let eprom = || spelled(name, |spelling| files.read_eprom(spelling));
    match memory {
        ProgramMemory::Ram => ram().or_else(eprom).ok_or(Missing::NoFile),
        ProgramMemory::Eprom => eprom().ok_or_else(|| match ram() {
            Some(_) => Missing::InRamOnly,
            None => Missing::NoFile,
        }),
    }
}

fn spelled(name: &str, read: impl Fn(&str) -> Option<Vec<u8>>) -> Option<Found> {
    let upper = name.to_ascii_uppercase();
    let spellings = [
        name.to_owned(),
        upper.clone(),
        format!("{name}.PLC"),
        format!("{upper}.PLC"),
    ];
    spellings.into_iter().find_map(|name| {
        let bytes = read(&name)?;
        Some(Found { name, bytes })
    })
}

/// Text of a source file without the end characters of tapes.
pub(crate) fn decode(bytes: &[u8]) -> String {
    let text = bahn_text::decode(bytes);
    text.trim_end_matches(['\u{1a}', '\0']).to_owned()
}

#[cfg(test)]
mod tests {
    use super::decode;

    #[test]
    fn end_characters_of_tapes_are_no_text() {
        assert_eq!(decode(b"\xef\xbb\xbfEM ;T\xc3\xbcr\n\x1a\0\0"), "EM ;Tür\n");
        assert_eq!(
            decode(b"E\0M\0\n\0\x1a\0\0"),
            "EM\n",
            "UTF-16 with half a character"
        );
    }
}
