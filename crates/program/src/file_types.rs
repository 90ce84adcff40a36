//! Which language a file is written in, by its name.

use crate::bulk::Bulk;
use crate::iso::IsoLanguage;
use crate::language::Language;
use crate::plain::PlainLanguage;

/// A type of files that hold part programs.
#[derive(Clone, Copy, Debug)]
pub struct FileType {
    /// Ending of the file's name, in capitals.
    pub extension: &'static str,
    /// The language; `None` for one that nobody here reads yet.
    pub language: Option<&'static dyn Language>,
}

/// The types of part programs in the order in which a called program is looked for: HEIDENHAIN plain language and
/// ISO [000:6872-6873].
pub const FILE_TYPES: &[FileType] = &[
    FileType {
        extension: "H",
        language: Some(&PlainLanguage),
    },
    FileType {
        extension: "I",
        language: Some(&IsoLanguage),
    },
];

/// The language of the file type that a file's name ends with.
///
/// ```
/// assert_eq!(bahn_program::language_of("7432.h").unwrap().name(), "HEIDENHAIN plain language");
/// assert!(bahn_program::language_of("TOOL.T").is_none());
/// ```
pub fn language_of(file_name: &str) -> Option<&'static dyn Language> {
    let (_, extension) = file_name.rsplit_once('.')?;
    let of_name = |file_type: &&FileType| file_type.extension.eq_ignore_ascii_case(extension);
    FILE_TYPES.iter().find(of_name)?.language
}

/// The language of a file by its name; plain language where the name does not say.
pub(crate) fn bulk_language_of(file_name: &str) -> &'static dyn Bulk {
    match file_name.rsplit_once('.') {
        Some((_, extension)) if extension.eq_ignore_ascii_case("I") => &IsoLanguage,
        _ => &PlainLanguage,
    }
}
