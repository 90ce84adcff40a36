//! What the soft keys offer.

use crate::dialogue::Dialogue;
use crate::field::{Ask, TABLE_LINE};
use crate::prompt::text_of;
use crate::{Setting, Tongue};

/// What a soft key does.
#[derive(Clone, Debug, PartialEq)]
pub(crate) enum Soft {
    /// Answers the open question with a text.
    Answer(String),
    /// A function of the editor.
    Function(Function),
}

/// Functions of the editor beside the keys of the control.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Function {
    Mark,
    Unmark,
    Copy,
    Cut,
    Paste,
    Find,
    Undo,
    Redo,
    Text,
    Comment,
    Skip,
    Number,
}

/// M functions that are offered; any other is entered as a number.
const M_FUNCTIONS: &[&str] = &[
    "0", "2", "3", "4", "5", "6", "8", "9", "13", "14", "30", "89", "90", "91", "92", "99", "93", "94", "97",
    "98",
];

/// Lines of datum tables in the registry of the models.
const TABLE_WORD: &str = "CYCL DEF # (line of a datum table)";

/// Characters that the alpha keyboard lacks, a blank first.
const CHARACTERS: &[&str] = &[
    " ", "+", "=", "*", "/", "(", ")", ":", ";", ",", "#", "^", "_", "\"",
];

/// Soft keys in a row.
pub(crate) const ROW: usize = 8;

/// A soft key with its text.
pub(crate) type Labelled = (String, Soft);

/// The soft keys for a question.
pub(crate) fn answers(ask: Ask, address: &str, setting: &Setting) -> Vec<Labelled> {
    let labelled = |label: String, value: &str| (label, Soft::Answer(value.to_owned()));
    match ask {
        Ask::Choice(choices) => {
            let values = choices.iter().map(|choice| choice.value);
            values
                .map(|value| labelled(format!("{address}{value}"), value))
                .collect()
        }
        Ask::Feed { max: true } => {
            let rapid = setting.rapid();
            vec![labelled(format!("F {rapid}"), &rapid)]
        }
        Ask::Coordinates { table: true, .. } if setting.has(TABLE_WORD) => {
            vec![labelled(TABLE_LINE.to_owned(), TABLE_LINE)]
        }
        Ask::M => {
            let all = M_FUNCTIONS.iter();
            all.map(|number| labelled(format!("M{number}"), number)).collect()
        }
        Ask::Name | Ask::Text => characters(CHARACTERS, setting.tongue),
        _ => Vec::new(),
    }
}

/// Characters that soft keys offer while a block of DIN/ISO is entered: those of words that not every keyboard has.
pub(crate) const ISO_CHARACTERS: &[&str] = &[
    "G", "M", "F", "S", "T", "R", "H", "D", "L", "P", "Q", "I", "J", "K", "%", ";", " ", "+", "=", ",", "/",
    "N", "E", "O",
];

/// The soft keys that write characters.
pub(crate) fn characters(characters: &[&str], tongue: Tongue) -> Vec<Labelled> {
    let labelled = |character: &&str| {
        let label = match *character {
            " " => text_of("soft blank", tongue),
            character => character,
        };
        (label.to_owned(), Soft::Answer((*character).to_owned()))
    };
    characters.iter().map(labelled).collect()
}

/// The soft keys of a dialogue.
pub(crate) fn of_dialogue(dialogue: &Dialogue, setting: &Setting) -> Vec<Labelled> {
    let field = dialogue.current();
    field.map_or_else(Vec::new, |field| {
        answers(field.slot.ask, field.slot.address, setting)
    })
}

/// The soft keys while nothing is open.
pub(crate) fn of_program(marked: bool, numbered: bool, tongue: Tongue) -> Vec<Labelled> {
    use Function::{Comment, Copy, Cut, Find, Mark, Number, Paste, Redo, Skip, Text, Undo, Unmark};
    let mark = if marked {
        ("soft unmark", Unmark)
    } else {
        ("soft mark", Mark)
    };
    let all = [
        mark,
        ("soft copy", Copy),
        ("soft cut", Cut),
        ("soft paste", Paste),
        ("soft find", Find),
        ("soft undo", Undo),
        ("soft redo", Redo),
        ("soft text", Text),
        ("soft skip", Skip),
        ("soft comment", Comment),
        ("soft number", Number),
    ];
    let all = all
        .into_iter()
        .filter(|(_, function)| numbered || *function != Number);
    all.map(|(id, function)| (text_of(id, tongue).to_owned(), Soft::Function(function)))
        .collect()
}
