//! Where source files come from.

use bahn_text::{Files, NamedFile};

/// Where the control takes its PLC program from: MP4010 [000:11896-11903].
#[derive(Clone, Copy, Debug, PartialEq, Eq, Default)]
pub enum ProgramMemory {
    /// Battery-backed memory, MP4010 = 1: what is not there is looked for in the EPROM [000:14618].
    #[default]
    Ram,
    /// MP4010 = 0: files of the RAM must not be linked [000:14616].
    Eprom,
}

/// The source files that a program may link. Names are tried as written, in capitals, and with `.PLC` after them.
#[derive(Clone, Copy)]
pub struct Memories<'a> {
    /// Those of the RAM.
    pub ram: &'a dyn Files,
    /// Those of the EPROM, where there is one.
    pub eprom: Option<&'a dyn Files>,
}

impl<'a, F: Files> From<&'a F> for Memories<'a> {
    /// A RAM alone.
    fn from(ram: &'a F) -> Memories<'a> {
        Memories { ram, eprom: None }
    }
}

/// Why a file cannot be linked.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Missing {
    /// There is no such file.
    NoFile,
    /// It lies in the RAM, and the program runs from the EPROM.
    InRamOnly,
}

/// Reads a file of the memory that programs run from; its name is the spelling under which it was found.
pub(crate) fn find(files: Memories, memory: ProgramMemory, name: &str) -> Result<NamedFile, Missing> {
    let ram = || spelled(name, files.ram);
    let eprom = || spelled(name, files.eprom?);
    match memory {
        ProgramMemory::Ram => ram().or_else(eprom).ok_or(Missing::NoFile),
        ProgramMemory::Eprom => eprom().ok_or_else(|| match ram() {
            Some(_) => Missing::InRamOnly,
            None => Missing::NoFile,
        }),
    }
}

fn spelled(name: &str, files: &dyn Files) -> Option<NamedFile> {
    let upper = name.to_ascii_uppercase();
    let spellings = [
        name.to_owned(),
        upper.clone(),
        format!("{name}.PLC"),
        format!("{upper}.PLC"),
    ];
    spellings.iter().find_map(|name| files.read(name))
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
