//! The directory: a program is chosen by its name [003:981-1001].

use bahn_control::Command;
use bahn_dialogue::Key;
use bahn_parameters::MessageId;

use crate::page::{Page, Turn, View, first_in_sight};
use crate::programs::{Entry, NAME_MAX};
use crate::screen::{Dialogue, Line, Window, WindowKind};
use crate::site::Site;

/// What a program is chosen for.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Purpose {
    /// It is to run.
    Run,
    /// It is to be edited.
    Edit,
    /// It is to be tested.
    Test,
}

/// The directory of the program memory.
pub(crate) struct Directory {
    purpose: Purpose,
    entries: Vec<Entry>,
    current: usize,
    typed: String,
}

impl Directory {
    /// The directory as it is now.
    pub fn new(purpose: Purpose, site: &Site) -> Directory {
        let mut entries = site.programs.list();
        entries.retain(|entry| purpose == Purpose::Edit || is_program(&entry.name));
        Directory {
            purpose,
            entries,
            current: 0,
            typed: String::new(),
        }
    }

    fn choose(&self, site: &mut Site) -> Turn {
        let name = match (self.typed.is_empty(), self.entries.get(self.current)) {
            (true, Some(entry)) => entry.name.clone(),
            (true, None) => return Turn::Refused,
            (false, _) => {
                let name = self.typed.clone();
                if name.contains('.') {
                    name
                } else {
                    format!("{name}.H")
                }
            }
        };
        let there = site.programs.has(&name);
        let chosen = match self.purpose {
            Purpose::Run => {
                let program = name.rsplit_once('.').map_or(name.as_str(), |(name, _)| name);
                there && site.command(Command::Select(program.to_owned()))
            }
            Purpose::Edit => {
                site.settings.edited = Some(name);
                true
            }
            Purpose::Test => {
                site.settings.edited = Some(name);
                there
            }
        };
        match chosen {
            true => Turn::Close,
            false => Turn::Say(site.message(MessageId::ProgramNotFound)),
        }
    }
}

/// A part program.
fn is_program(name: &str) -> bool {
    name.to_ascii_uppercase().ends_with(".H") || name.to_ascii_uppercase().ends_with(".I")
}

impl Page for Directory {
    fn key(&mut self, key: Key, site: &mut Site) -> Turn {
        match key {
            Key::Down => self.current = (self.current + 1).min(self.entries.len().saturating_sub(1)),
            Key::Up => self.current = self.current.saturating_sub(1),
            Key::Ent => return self.choose(site),
            Key::End | Key::Del | Key::NoEnt | Key::PgmNr => return Turn::Close,
            Key::Ce if !self.typed.is_empty() => self.typed.clear(),
            _ => match key.character() {
                Some(character) if self.typed.len() < NAME_MAX => self.typed.push(character),
                _ => return Turn::Refused,
            },
        }
        Turn::Done
    }

    fn show(&self, site: &Site, lines: usize) -> View {
        let first = first_in_sight(self.current, self.entries.len(), lines);
        let shown = self.entries.iter().enumerate().skip(first).take(lines);
        View {
            window: Some(Window {
                title: site.words("PROGRAM DIRECTORY"),
                kind: WindowKind::List,
                lines: shown
                    .map(|(place, entry)| Line {
                        text: format!("{:<20} {:>10}", entry.name, entry.size),
                        current: place == self.current,
                        ..Line::default()
                    })
                    .collect(),
                first,
                total: self.entries.len(),
            }),
            dialogue: Dialogue {
                prompt: site.words("PROGRAM NUMBER ="),
                entry: self.typed.clone(),
                open: true,
            },
        }
    }
}
