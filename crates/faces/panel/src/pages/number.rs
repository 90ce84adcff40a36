//! A question that a number answers, and what is done with it.

use bahn_dialogue::Key;
use bahn_screen::Dialogue;

use crate::entry::Entry;
use crate::page::{Page, Turn, View};
use crate::site::Site;

/// The position that CAPTURE enters.
type Captured = Box<dyn Fn(&Site) -> Option<f64> + Send>;
/// What comes of the number.
type Answer = Box<dyn FnMut(f64, &mut Site) -> Turn + Send>;

/// A question: ENT answers it, END, DEL and NO ENT leave it.
pub(crate) struct Number {
    prompt: String,
    entry: Entry,
    answer: Answer,
    captured: Option<Captured>,
}

impl Number {
    /// Asks for a number that is taken or refused.
    pub fn ask(prompt: String, answer: impl Fn(f64, &mut Site) -> bool + Send + 'static) -> Box<Number> {
        Number::turning(prompt, move |value, site| match answer(value, site) {
            true => Turn::Close,
            false => Turn::Say(site.message(bahn_parameters::MessageId::EntryValueIncorrect)),
        })
    }

    /// Asks for a number that leads on.
    pub fn turning(
        prompt: String,
        answer: impl FnMut(f64, &mut Site) -> Turn + Send + 'static,
    ) -> Box<Number> {
        Box::new(Number {
            prompt,
            entry: Entry::default(),
            answer: Box::new(answer),
            captured: None,
        })
    }

    /// The same with its first digit.
    pub fn beginning(mut self: Box<Self>, digit: Key) -> Box<Number> {
        self.entry.key(digit);
        self
    }

    /// The same with a position that CAPTURE enters.
    pub fn capturing(
        mut self: Box<Self>,
        captured: impl Fn(&Site) -> Option<f64> + Send + 'static,
    ) -> Box<Number> {
        self.captured = Some(Box::new(captured));
        self
    }
}

impl Page for Number {
    fn key(&mut self, key: Key, site: &mut Site) -> Turn {
        match key {
            Key::Ent => match self.entry.value() {
                Some(value) => (self.answer)(value, site),
                None => Turn::Refused,
            },
            Key::End | Key::Del | Key::NoEnt => Turn::Close,
            Key::Capture => match self.captured.as_ref().and_then(|captured| captured(site)) {
                Some(value) => {
                    self.entry = Entry::of(value);
                    Turn::Done
                }
                None => Turn::Refused,
            },
            key if self.entry.key(key) => Turn::Done,
            _ => Turn::Refused,
        }
    }

    fn soft_keys(&self, site: &Site) -> Vec<Vec<String>> {
        vec![vec!["ENT".to_owned(), site.words("END")]]
    }

    fn soft_key(&mut self, _row: usize, place: usize, site: &mut Site) -> Turn {
        self.key(if place == 0 { Key::Ent } else { Key::End }, site)
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
