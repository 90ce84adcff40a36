//! A question that a number answers, and what is done with it.

use bahn_dialogue::Key;

use crate::entry::Entry;
use crate::page::{Page, Turn, View};
use crate::screen::Dialogue;
use crate::site::Site;

/// What is done with the number; `false` when it is refused.
type Answer = Box<dyn Fn(f64, &mut Site) -> bool + Send>;

/// A question: ENT answers it, END, DEL and NO ENT leave it.
pub(crate) struct Number {
    prompt: String,
    entry: Entry,
    answer: Answer,
}

impl Number {
    /// Asks for a number.
    pub fn ask(prompt: String, answer: impl Fn(f64, &mut Site) -> bool + Send + 'static) -> Box<Number> {
        Box::new(Number {
            prompt,
            entry: Entry::default(),
            answer: Box::new(answer),
        })
    }

    /// The same with an answer that stands there already.
    pub fn with(mut self: Box<Number>, text: &str) -> Box<Number> {
        self.entry = Entry::of(text);
        self
    }
}

impl Page for Number {
    fn key(&mut self, key: Key, site: &mut Site) -> Turn {
        match key {
            Key::Ent => match self.entry.value() {
                Some(value) if (self.answer)(value, site) => Turn::Close,
                Some(_) => Turn::Say(site.message(bahn_parameters::MessageId::EntryValueIncorrect)),
                None => Turn::Refused,
            },
            Key::End | Key::Del | Key::NoEnt => Turn::Close,
            key if self.entry.key(key) => Turn::Done,
            _ => Turn::Refused,
        }
    }

    fn show(&self, _site: &Site, _lines: usize) -> View {
        View {
            window: None,
            dialogue: Dialogue {
                prompt: self.prompt.clone(),
                entry: self.entry.text(),
                open: true,
            },
        }
    }
}
