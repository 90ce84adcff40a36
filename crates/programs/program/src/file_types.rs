//! Which language a file is written in, by its name.

use crate::bulk::Bulk;
use crate::dialect::DinLanguage;
use crate::iso::IsoLanguage;
use crate::language::{Landmark, Language};
use crate::lines::Lines;
use crate::plain::PlainLanguage;
use crate::text::text_start;

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

/// The language of a file by its name and, where shops name two languages alike, by its text; plain language where
/// neither says it.
pub(crate) fn bulk_language_of(file_name: &str, text: &[u8]) -> &'static dyn Bulk {
    let ending = file_name
        .rsplit_once('.')
        .map(|(_, ending)| ending.to_ascii_uppercase());
    match ending.as_deref() {
        Some("I") => &IsoLanguage,
        Some("NC") if !begins_as_plain(text) => &DinLanguage::Tf5200,
        Some("900") => &DinLanguage::System900,
        _ => &PlainLanguage,
    }
}

/// Whether the first block of a text that is no comment is BEGIN PGM.
fn begins_as_plain(file: &[u8]) -> bool {
    let text = file.get(text_start(file)..).unwrap_or_default();
    let mut lines = Lines::new(text, 1);
    let blocks = std::iter::from_fn(|| PlainLanguage.next_block(&mut lines)).map(|raw| raw.text(text));
    let mut blocks = blocks.skip_while(|block| PlainLanguage.stands_alone(*block));
    let first = blocks.next().and_then(|block| PlainLanguage.landmark(block));
    matches!(first, Some(Landmark::Begin(_)))
}
