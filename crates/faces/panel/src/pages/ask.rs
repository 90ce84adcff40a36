//! Questions: one that ENT answers with yes, one that a name answers.

use std::sync::{Arc, Mutex, PoisonError};

use bahn_dialogue::Key;
use bahn_screen::Dialogue;

use crate::page::{Page, Turn, View};
use crate::site::Site;

/// What comes of an answer.
type Answered<T> = Box<dyn FnMut(T, &mut Site) -> Turn + Send>;

/// A question that ENT answers with yes and NO ENT with no: `MM = ENT / INCH = NO ENT`. END and DEL leave it.
pub(crate) struct Choice {
    prompt: String,
    /// The soft keys of yes and no; END stands after them.
    names: [String; 2],
    answered: Answered<bool>,
}

impl Choice {
    /// A question with the soft keys of yes and no; `answered` learns which.
    pub fn ask(
        prompt: String,
        names: [String; 2],
        answered: impl FnMut(bool, &mut Site) -> Turn + Send + 'static,
    ) -> Box<Choice> {
        Box::new(Choice {
            prompt,
            names,
            answered: Box::new(answered),
        })
    }

    /// Something is done when ENT says so; NO ENT leaves it, too.
    pub fn confirm(
        prompt: String,
        name: String,
        mut done: impl FnMut(&mut Site) -> Turn + Send + 'static,
    ) -> Box<Choice> {
        Choice::ask(prompt, [name, String::new()], move |yes, site| match yes {
            true => done(site),
            false => Turn::Close,
        })
    }
}

impl Page for Choice {
    fn key(&mut self, key: Key, site: &mut Site) -> Turn {
        match key {
            Key::Ent => (self.answered)(true, site),
            Key::NoEnt => (self.answered)(false, site),
            Key::End | Key::Del => Turn::Close,
            _ => Turn::Refused,
        }
    }

    fn soft_keys(&self, site: &Site) -> Vec<Vec<String>> {
        let [yes, no] = self.names.clone();
        vec![vec![yes, no, site.words("END")]]
    }

    fn soft_key(&mut self, _row: usize, place: usize, site: &mut Site) -> Turn {
        match place {
            0 => (self.answered)(true, site),
            1 => (self.answered)(false, site),
            _ => Turn::Close,
        }
    }

    fn show(&self, _site: &Site, _lines: usize) -> View {
        View {
            window: None,
            dialogue: Dialogue {
                prompt: self.prompt.clone(),
                ..Dialogue::default()
            },
        }
    }
}

/// An answer that the page below takes when it has the keys again.
#[derive(Clone, Default)]
pub(crate) struct Later(Arc<Mutex<Option<String>>>);

impl Later {
    /// Asks for a text of so many characters at most.
    pub fn ask(&self, prompt: String, longest: usize) -> Turn {
        let place = Later(Arc::clone(&self.0));
        Turn::Open(Name::ask(prompt, longest, move |text, _site| {
            place.set(&text);
            Turn::Close
        }))
    }

    /// The question was answered with this text.
    pub fn set(&self, text: &str) {
        *self.0.lock().unwrap_or_else(PoisonError::into_inner) = Some(text.to_owned());
    }

    /// The answer, if there is one; it is given once.
    pub fn take(&self) -> Option<String> {
        self.0.lock().unwrap_or_else(PoisonError::into_inner).take()
    }
}

/// A question that a text answers: a name, a word to look for.
pub(crate) struct Name {
    prompt: String,
    typed: String,
    longest: usize,
    answered: Answered<String>,
}

impl Name {
    /// Asks for a text of so many characters at most.
    pub fn ask(
        prompt: String,
        longest: usize,
        answered: impl FnMut(String, &mut Site) -> Turn + Send + 'static,
    ) -> Box<Name> {
        Box::new(Name {
            prompt,
            typed: String::new(),
            longest,
            answered: Box::new(answered),
        })
    }

    /// Its first character is typed already.
    pub fn begin(&mut self, key: Key) {
        self.typed.extend(key.character());
    }
}

impl Page for Name {
    fn key(&mut self, key: Key, site: &mut Site) -> Turn {
        match key {
            Key::Ent if !self.typed.is_empty() => return (self.answered)(self.typed.clone(), site),
            Key::End | Key::Del | Key::NoEnt => return Turn::Close,
            Key::Ce if !self.typed.is_empty() => self.typed.clear(),
            Key::Left if !self.typed.is_empty() => drop(self.typed.pop()),
            _ => match key.character() {
                Some(character) if self.typed.len() < self.longest => self.typed.push(character),
                _ => return Turn::Refused,
            },
        }
        Turn::Done
    }

    fn soft_keys(&self, site: &Site) -> Vec<Vec<String>> {
        vec![vec!["ENT".to_owned(), site.words("END")]]
    }

    fn soft_key(&mut self, _row: usize, place: usize, site: &mut Site) -> Turn {
        self.key(if place == 0 { Key::Ent } else { Key::End }, site)
    }

    fn text(&mut self, text: &str, _site: &mut Site) -> Turn {
        let fits = text.is_ascii() && text.len() <= self.longest && !text.contains(char::is_control);
        match fits {
            true => {
                text.clone_into(&mut self.typed);
                Turn::Done
            }
            false => Turn::Refused,
        }
    }

    fn show(&self, _site: &Site, _lines: usize) -> View {
        View {
            window: None,
            dialogue: Dialogue {
                prompt: self.prompt.clone(),
                entry: self.typed.clone(),
                open: true,
            },
        }
    }
}
