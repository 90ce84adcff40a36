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

/// Text of a file: UTF-8, UTF-16 where a byte order mark or the zero bytes of its letters say so, or else the
/// Latin alphabet of the control's own files. End characters of tapes and a byte order mark are dropped.
pub(crate) fn decode(bytes: &[u8]) -> String {
    let text = match (utf16_order(bytes), std::str::from_utf8(bytes)) {
        (Some(order), _) => utf16(bytes, order),
        (None, Ok(text)) => text.to_owned(),
        (None, Err(_)) => bytes.iter().map(|byte| char::from(*byte)).collect(),
    };
    text.trim_start_matches('\u{feff}')
        .trim_end_matches(['\u{1a}', '\0'])
        .to_owned()
}

/// Which byte of a character of UTF-16 comes first.
#[derive(Clone, Copy)]
enum Order {
    Low,
    High,
}

/// A byte order mark, or a first line of letters of which each second byte is zero.
fn utf16_order(bytes: &[u8]) -> Option<Order> {
    match bytes {
        [0xff, 0xfe, ..] => Some(Order::Low),
        [0xfe, 0xff, ..] => Some(Order::High),
        [a, 0, b, 0, ..] if *a != 0 && *b != 0 => Some(Order::Low),
        [0, a, 0, b, ..] if *a != 0 && *b != 0 => Some(Order::High),
        _ => None,
    }
}

fn utf16(bytes: &[u8], order: Order) -> String {
    let units = bytes.chunks(2).map(|pair| {
        let pair = [
            pair.first().copied().unwrap_or(0),
            pair.get(1).copied().unwrap_or(0),
        ];
        match order {
            Order::Low => u16::from_le_bytes(pair),
            Order::High => u16::from_be_bytes(pair),
        }
    });
    let characters = char::decode_utf16(units);
    characters
        .map(|c| c.unwrap_or(char::REPLACEMENT_CHARACTER))
        .collect()
}

#[cfg(test)]
mod tests {
    use super::decode;

    /// Files of editors that save UTF-16, with and without byte order mark, and of the control.
    #[test]
    fn text_is_read_whatever_saved_it() {
        let text = "L I4 ;Tür\n= O2\n";
        let low: Vec<u8> = text.encode_utf16().flat_map(u16::to_le_bytes).collect();
        let high: Vec<u8> = text.encode_utf16().flat_map(u16::to_be_bytes).collect();
        assert_eq!(decode(&low), text);
        assert_eq!(decode(&high), text);
        assert_eq!(decode(&[&[0xff, 0xfe], low.as_slice()].concat()), text);
        assert_eq!(decode(&[&[0xfe, 0xff], high.as_slice(), &[0]].concat()), text);
        assert_eq!(decode(b"L I4 ;T\xfcr\n"), "L I4 ;Tür\n");
        assert_eq!(decode(b"\xef\xbb\xbfEM\n\x1a\0\0"), "EM\n");
        assert_eq!(decode(b"\xff\xfe\x00\xd8"), "\u{fffd}", "half a character");
    }
}
