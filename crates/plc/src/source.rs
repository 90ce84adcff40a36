//! Where source files come from.

use std::collections::BTreeMap;

/// The source files that a program may link.
pub trait SourceFiles {
    /// The bytes of a file; `None` when there is none of that name. Names are tried as written, in capitals,
    /// and with `.PLC` behind them.
    fn read(&self, name: &str) -> Option<Vec<u8>>;
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

/// Reads a file by one of the spellings of its name; also says under which it was found.
pub(crate) fn find(files: &dyn SourceFiles, name: &str) -> Option<(String, Vec<u8>)> {
    let upper = name.to_ascii_uppercase();
    let spellings = [
        name.to_owned(),
        upper.clone(),
        format!("{name}.PLC"),
        format!("{upper}.PLC"),
    ];
    spellings.into_iter().find_map(|spelling| {
        let bytes = files.read(&spelling)?;
        Some((spelling, bytes))
    })
}

/// Text of a file: UTF-8, or else the Latin alphabet of the control's own files. End characters of tapes
/// and a byte order mark are dropped.
pub(crate) fn decode(bytes: &[u8]) -> String {
    let text = match std::str::from_utf8(bytes) {
        Ok(text) => text.to_owned(),
        Err(_) => bytes.iter().map(|byte| char::from(*byte)).collect(),
    };
    text.trim_start_matches('\u{feff}')
        .trim_end_matches(['\u{1a}', '\0'])
        .to_owned()
}
