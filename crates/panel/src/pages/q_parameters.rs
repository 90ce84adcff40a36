//! Q parameters between runs, and while one is interrupted: shown and changed [003:4337-4344].

use bahn_control::Command;
use bahn_dialogue::Key;
use bahn_parameters::MessageId;

use crate::entry::Entry;
use crate::page::{Page, Turn, View, first_in_sight};
use crate::pages::ask::Later;
use crate::screen::{Dialogue, Line, Mark, Window, WindowKind};
use crate::site::Site;

/// Lines that a page goes.
const PAGE: i32 = 12;

/// The Q parameters.
#[derive(Default)]
pub(crate) struct QParameters {
    current: u16,
    entry: Entry,
    goto: Later,
}

impl QParameters {
    fn count(site: &Site) -> u16 {
        site.control().model().limits().q_max + 1
    }

    fn go(&mut self, lines: i32, site: &Site) -> Turn {
        let last = i32::from(QParameters::count(site)) - 1;
        let next = (i32::from(self.current) + lines).clamp(0, last.max(0));
        self.current = u16::try_from(next).unwrap_or_default();
        self.entry = Entry::default();
        Turn::Done
    }

    fn enter(&mut self, site: &mut Site) -> Turn {
        let Some(value) = self.entry.value() else {
            return self.go(1, site);
        };
        match site.command(Command::Q(self.current, value)) {
            true => self.go(1, site),
            false => Turn::Say(site.message(MessageId::EntryValueIncorrect)),
        }
    }
}

impl Page for QParameters {
    fn key(&mut self, key: Key, site: &mut Site) -> Turn {
        match key {
            Key::Up => self.go(-1, site),
            Key::Down => self.go(1, site),
            Key::Ent => self.enter(site),
            Key::Goto => self.goto.ask(site.words("GOTO: NUMBER ="), 4),
            Key::End | Key::Del | Key::NoEnt | Key::Q => Turn::Close,
            key if self.entry.key(key) => Turn::Done,
            _ => Turn::Refused,
        }
    }

    fn soft_keys(&self, site: &Site) -> Vec<Vec<String>> {
        vec![vec![
            site.words("PAGE UP"),
            site.words("PAGE DOWN"),
            site.words("END"),
        ]]
    }

    fn soft_key(&mut self, _row: usize, place: usize, site: &mut Site) -> Turn {
        match place {
            0 => self.go(-PAGE, site),
            1 => self.go(PAGE, site),
            _ => Turn::Close,
        }
    }

    fn show(&self, site: &Site, lines: usize) -> View {
        let total = usize::from(QParameters::count(site));
        let first = first_in_sight(self.current.into(), total, lines);
        let channel = site.control().first();
        let line = |number: u16| {
            let name = format!("Q{number:<4}= ");
            let current = number == self.current;
            let value = match current && !self.entry.is_empty() {
                true => self.entry.text(),
                false => format!("{:+.4}", channel.q_value(number)),
            };
            let mark = if self.entry.is_empty() {
                Mark::Cursor
            } else {
                Mark::Entry
            };
            Line {
                marks: match current {
                    true => vec![(name.len(), name.len() + value.len(), mark)],
                    false => Vec::new(),
                },
                text: name + &value,
                current,
            }
        };
        let shown = (0..QParameters::count(site)).skip(first).take(lines);
        View {
            window: Some(Window {
                title: site.words("Q PARAMETERS"),
                kind: WindowKind::Table,
                lines: shown.map(line).collect(),
                first,
                total,
            }),
            dialogue: Dialogue {
                prompt: format!("Q{} =", self.current),
                entry: self.entry.text(),
                open: true,
            },
        }
    }

    fn tick(&mut self, site: &mut Site) -> Turn {
        let Some(text) = self.goto.take() else {
            return Turn::Done;
        };
        let number = text
            .parse::<u16>()
            .ok()
            .filter(|number| *number < QParameters::count(site));
        match number {
            Some(number) => {
                self.current = number;
                Turn::Done
            }
            None => Turn::Say(site.message(MessageId::EntryValueIncorrect)),
        }
    }
}
