//! An editor that is operated by names of keys.
#![allow(dead_code, reason = "each test uses what it needs")]
#![allow(
    clippy::unwrap_used,
    clippy::panic,
    reason = "a helper that panics fails its test"
)]

use std::sync::Arc;

use bahn_dialogue::{Editor, Key, Reaction, Setting};
use bahn_parameters::{ControlModel, MessageId, ParameterList};
use bahn_program::{FormatOptions, Program, format_program};

pub fn setting(model: ControlModel) -> Setting {
    let mut setting = Setting::of(&ParameterList::reference(model));
    setting.tongue = bahn_dialogue::Tongue::English;
    setting.decimal_comma = false;
    setting
}

pub fn program(blocks: &str) -> Arc<Program> {
    let text = format!("BEGIN PGM 7 MM\n{blocks}\nEND PGM 7 MM\n");
    Arc::new(Program::from_bytes("7.H", text.into_bytes()))
}

pub struct Desk {
    pub editor: Editor,
}

impl Desk {
    /// An empty program of the TNC 360.
    pub fn new() -> Desk {
        Desk::with("", ControlModel::Tnc360)
    }

    pub fn with(blocks: &str, model: ControlModel) -> Desk {
        Desk {
            editor: Editor::new(program(blocks), setting(model)),
        }
    }

    /// Presses keys; numbers are written as such (`12.5`, `-3`), what the last key did.
    pub fn press(&mut self, keys: &str) -> Reaction {
        let mut last = Reaction::Shown;
        for key in keys_of(keys) {
            last = self.editor.key(key);
        }
        last
    }

    /// Presses keys, none of which may be refused.
    pub fn enter(&mut self, keys: &str) {
        for key in keys_of(keys) {
            let reaction = self.editor.key(key);
            assert!(
                !matches!(reaction, Reaction::Refused(_)),
                "{key} of {keys}: {reaction:?}"
            );
        }
    }

    pub fn refuses(&mut self, keys: &str, message: MessageId) {
        assert_eq!(self.press(keys), Reaction::Refused(message), "{keys}");
        assert_eq!(self.editor.message(), Some(message));
    }

    pub fn prompt(&self) -> String {
        self.editor
            .view(0, 0)
            .question
            .map_or_else(String::new, |question| question.prompt)
    }

    /// The text between BEGIN and END.
    pub fn blocks(&self) -> Vec<String> {
        let program = self.editor.program();
        (1..program.block_count() - 1)
            .map(|block| program.text_of(block))
            .collect()
    }

    pub fn listing(&self) -> String {
        format_program(self.editor.program(), FormatOptions::default()).to_string()
    }
}

/// Names of keys, and numbers.
pub fn keys_of(text: &str) -> Vec<Key> {
    let mut keys = Vec::new();
    for name in text.split_whitespace() {
        let number = name
            .trim_start_matches('-')
            .starts_with(|c: char| c.is_ascii_digit() || c == '.');
        if number {
            keys.extend(name.chars().map(|c| Key::of_character(c).unwrap()));
        } else {
            keys.push(Key::from_name(name).unwrap_or_else(|| panic!("no key {name}")));
        }
    }
    keys
}
