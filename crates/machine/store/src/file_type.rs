//! What kinds of files there are for the data interfaces.

/// A type of file: extension on the medium and code letter in the header of a transfer [000:16890-16941].
///
/// ```
/// use bahn_store::FileType;
///
/// let pallets = FileType::of_extension("p").ok_or("no such type")?;
/// assert_eq!((pallets.code(), pallets.nc_extension()), ('L', "LNC".to_owned()));
/// # Ok::<(), &str>(())
/// ```
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub struct FileType {
    extension: &'static str,
    code: char,
    named_in_first_line: bool,
}

/// Extension, code letter, and whether the file carries its name in its first line [000:16890-16941].
const TYPES: &[(&str, char, bool)] = &[
    ("H", 'H', true),
    ("I", 'D', true),
    ("T", 'T', true),
    ("P", 'L', true),
    ("D", 'N', true),
    ("MP", 'M', false),
    ("COM", 'V', false),
    ("CMA", 'S', false),
    ("PLC", 'P', false),
    ("A", 'A', false),
    ("ER1", 'A', false),
    ("ERE", 'A', false),
    ("DI1", 'A', false),
    ("DIE", 'A', false),
    ("TCH", 'R', true),
    ("HLP", 'J', false),
    ("PNT", 'U', true),
];

impl FileType {
    /// A program in plain language.
    pub const PLAIN: FileType = FileType {
        extension: "H",
        code: 'H',
        named_in_first_line: true,
    };

    /// The types, in the order of the manual.
    pub fn all() -> impl Iterator<Item = FileType> {
        TYPES
            .iter()
            .map(|&(extension, code, named_in_first_line)| FileType {
                extension,
                code,
                named_in_first_line,
            })
    }

    /// The type with an extension, without regard to case.
    pub fn of_extension(extension: &str) -> Option<FileType> {
        FileType::all().find(|kind| kind.extension.eq_ignore_ascii_case(extension))
    }

    /// The type that a code letter becomes on reading: all of the letter `A` become ASCII files [000:16935-16937].
    pub fn of_code(code: char) -> Option<FileType> {
        FileType::all().find(|kind| kind.code == code.to_ascii_uppercase())
    }

    /// Extension of its files, in capitals.
    pub fn extension(self) -> &'static str {
        self.extension
    }

    /// Code letter in headers.
    pub fn code(self) -> char {
        self.code
    }

    /// Extension under which the manufacturer's program for personal computers keeps such files: code letter and `NC`
    /// [000:16927-16931].
    pub fn nc_extension(self) -> String {
        format!("{}NC", self.code)
    }

    /// Whether it is a part program of one of the two languages.
    pub fn is_program(self) -> bool {
        ["H", "I"].contains(&self.extension)
    }

    /// Whether its files carry their name in their first line, so that many can be read at once [000:16939].
    pub fn is_named_in_first_line(self) -> bool {
        self.named_in_first_line
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn codes_and_extensions_lead_to_each_other() {
        for kind in FileType::all() {
            assert_eq!(
                FileType::of_extension(&kind.extension().to_lowercase()),
                Some(kind)
            );
            let read = FileType::of_code(kind.code()).map(FileType::code);
            assert_eq!(read, Some(kind.code()));
        }
        assert_eq!(FileType::of_code('a').map(FileType::extension), Some("A"));
        assert_eq!(FileType::of_extension("EXE"), None);
    }
}
