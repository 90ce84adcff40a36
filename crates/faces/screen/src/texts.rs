//! The words of the screen in the languages of the panel.
//!
//! The key of a text is what it is in English; `texts/*.tsv` have its translation. A language is complete when every
//! text that the panel uses has one, which a test of the panel holds.

use std::collections::{BTreeMap, HashMap};
use std::sync::OnceLock;

use bahn_dialogue::Key;
pub use bahn_dialogue::Tongue as Language;

const GERMAN: &[&str] = &[
    include_str!("../texts/de.tsv"),
    include_str!("../texts/messages-de.tsv"),
    include_str!("../texts/causes-de.tsv"),
    include_str!("../texts/de-teaching.tsv"),
    include_str!("../texts/de-system900.tsv"),
];

/// What stands around the screen, in the page and in the terminal.
const AROUND: &str = include_str!("../texts/de-around.tsv");

/// The code of a language: `en`, `de`.
pub fn language_code(language: Language) -> &'static str {
    match language {
        Language::English => "en",
        Language::German => "de",
    }
}

/// The language of `en` or `de`; `None` of any other code.
pub fn language_of_code(code: &str) -> Option<Language> {
    [Language::English, Language::German]
        .into_iter()
        .find(|language| language_code(*language) == code)
}

/// A text in a language; in English when the language has none for it.
pub fn words(language: Language, english: &'static str) -> &'static str {
    translation(language, english).unwrap_or(english)
}

/// A text that is known at run time only: messages, names of cycles.
pub fn translate(language: Language, english: &str) -> String {
    match translation(language, english) {
        Some(text) => text.to_owned(),
        None => of_axis(language, english).unwrap_or_else(|| english.to_owned()),
    }
}

/// A message with the letter of an axis in place of a #, and with a code after it.
fn of_axis(language: Language, english: &str) -> Option<String> {
    if language == Language::English {
        return None;
    }
    let words: Vec<&str> = english.split(' ').collect();
    let lettered = (0..words.len()).find_map(|place| {
        let mut around = words.clone();
        let letter = std::mem::replace(around.get_mut(place)?, "#");
        // The sign of a direction stands after the letter.
        Some(translation(language, &around.join(" "))?.replace('#', letter))
    });
    lettered.or_else(|| {
        let (before, code) = english.rsplit_once(' ')?;
        let text = translation(language, before).map(str::to_owned);
        Some(format!("{} {code}", text.or_else(|| of_axis(language, before))?))
    })
}

/// What a text is in another language; `None` where the table of the language has it not.
pub fn translation(language: Language, english: &str) -> Option<&'static str> {
    static TABLE: OnceLock<HashMap<&'static str, &'static str>> = OnceLock::new();
    match language {
        Language::English => None,
        Language::German => TABLE.get_or_init(german).get(english).copied(),
    }
}

/// A text that stands around the screen of the control, in a language.
///
/// ```
/// use bahn_screen::texts::{Language, around};
///
/// assert_eq!(around(Language::English, "Machine"), "Machine");
/// assert_eq!(around(Language::German, "Machine"), "Maschine");
/// ```
pub fn around(language: Language, english: &'static str) -> &'static str {
    texts_around(language).get(english).copied().unwrap_or(english)
}

/// A text with values in place of `{1}`, `{2}`.
///
/// ```
/// assert_eq!(bahn_screen::texts::filled("{1} of {2} done", &["2", "3"]), "2 of 3 done");
/// ```
pub fn filled(text: &str, values: &[&str]) -> String {
    (1..).zip(values).fold(text.to_owned(), |text, (place, value)| {
        text.replace(&format!("{{{place}}}"), value)
    })
}

/// All texts around the screen of the control by what they are in English, with the names of the keys.
pub fn texts_around(language: Language) -> &'static BTreeMap<&'static str, &'static str> {
    static TABLES: [OnceLock<BTreeMap<&str, &str>>; 2] = [OnceLock::new(), OnceLock::new()];
    let table = match language {
        Language::English => &TABLES[0],
        Language::German => &TABLES[1],
    };
    table.get_or_init(|| {
        let keys = Key::ALL.iter().map(|key| (key.label(), key.label_in(language)));
        let rows = rows(AROUND).map(|(english, german)| match language {
            Language::English => (english, english),
            Language::German => (english, german),
        });
        keys.chain(rows).collect()
    })
}

/// English and German of each line of a table.
fn rows(table: &'static str) -> impl Iterator<Item = (&'static str, &'static str)> {
    let lines = table.lines().filter(|line| !line.starts_with('#'));
    lines.filter_map(|line| line.split_once('\t'))
}

fn german() -> HashMap<&'static str, &'static str> {
    GERMAN.iter().flat_map(|table| rows(table)).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_message_of_the_control_is_translated() {
        use bahn_parameters::{ControlModel, MessageId};
        for model in ControlModel::ALL {
            for id in MessageId::ALL {
                for text in [id.text(model), id.cause(), id.remedy()] {
                    assert!(translation(Language::German, text).is_some(), "{text}");
                }
            }
        }
        for (english, german) in [
            ("LIMIT SWITCH X+", "ENDSCHALTER X+"),
            ("MEASURING SYSTEM Z DEFECTIVE A", "MESS-SYSTEM Z DEFEKT A"),
            ("GROSS POSITIONING ERROR X A", "GROBER POSITIONIERFEHLER X A"),
            ("ERROR IN PLC-PROGRAM 1Q", "FEHLER IM PLC-PROGRAMM 1Q"),
            ("Coolant is low", "Coolant is low"),
        ] {
            assert_eq!(translate(Language::German, english), german);
            assert_eq!(translate(Language::English, english), english);
        }
    }

    #[test]
    fn each_row_is_a_text_with_its_translation() {
        assert!(GERMAN.iter().flat_map(|table| table.lines()).all(|line| {
            line.starts_with('#') || line.split('\t').filter(|cell| !cell.is_empty()).count() == 2
        }));
    }
}
