//! Q parameters between runs, and while a run or a test is interrupted: shown and changed [003:4337-4344].

use bahn_dialogue::Key;
use bahn_parameters::MessageId;
use bahn_screen::{Dialogue, Line, Mark, WindowKind};
use bahn_tnc::{Command, TestCommand};

use crate::entry::Entry;
use crate::page::{Page, Turn, View};
use crate::pages::ask::Later;
use crate::pages::list;
use crate::site::Site;

const SOFT_KEYS: [&str; 3] = ["PAGE UP", "PAGE DOWN", "END"];

/// Values of the Q parameters, to be looked at and changed.
#[derive(Default)]
pub(crate) struct QParameters {
    current: u16,
    entry: Entry,
    goto: Later,
    /// They are those of an interrupted test run.
    tested: bool,
}

impl QParameters {
    /// Those of an interrupted test run [003:4342].
    pub fn of_test() -> QParameters {
        QParameters {
            tested: true,
            ..QParameters::default()
        }
    }

    fn set(&self, value: f64, site: &mut Site) -> bool {
        if !self.tested {
            return site.command(Command::Q(self.current, value));
        }
        let done = site.command(Command::TestRun(TestCommand::Q(self.current, value)));
        if let Some(trial) = site.graphics.tested().filter(|_| done) {
            trial.set_q(self.current, value);
        }
        done
    }

    fn count(site: &Site) -> u16 {
        site.control().model().limits().q_max + 1
    }

    fn go(&mut self, lines: isize, site: &Site) -> Turn {
        let next = list::moved(self.current.into(), lines, QParameters::count(site).into());
        self.current = u16::try_from(next).unwrap_or_default();
        self.entry = Entry::default();
        Turn::Done
    }

    fn enter(&mut self, site: &mut Site) -> Turn {
        let Some(value) = self.entry.value() else {
            return self.go(1, site);
        };
        match self.set(value, site) {
            true => self.go(1, site),
            false => Turn::Say(site.message(MessageId::EntryValueIncorrect)),
        }
    }
}

impl Page for QParameters {
    fn key(&mut self, key: Key, site: &mut Site) -> Turn {
        if let Some(lines) = list::way_of_key(key) {
            return self.go(lines, site);
        }
        match key {
            Key::Ent => self.enter(site),
            Key::Goto => self.goto.ask(site.words("GOTO: NUMBER ="), 4),
            Key::End | Key::Del | Key::NoEnt | Key::Q => Turn::Close,
            key if self.entry.key(key) => Turn::Done,
            _ => Turn::Refused,
        }
    }

    fn soft_keys(&self, site: &Site) -> Vec<Vec<String>> {
        vec![list::soft_keys(&SOFT_KEYS, site)]
    }

    fn soft_key(&mut self, _row: usize, place: usize, site: &mut Site) -> Turn {
        let way = list::way_of(list::name_at(&SOFT_KEYS, place));
        way.map_or(Turn::Close, |lines| self.go(lines, site))
    }

    fn show(&self, site: &Site, lines: usize) -> View {
        let total = usize::from(QParameters::count(site));
        let control = site.control();
        let value_of = |number| match self.tested {
            true => control.tested_q(number),
            false => control.first().q_value(number),
        };
        let line = |place: usize| {
            let number = u16::try_from(place).unwrap_or_default();
            let name = format!("Q{number:<4}= ");
            let current = number == self.current;
            let value = match current && !self.entry.is_empty() {
                true => self.entry.text(),
                false => format!("{:+.4}", value_of(number)),
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
        let cursor = (self.current.into(), total);
        View {
            window: Some(list::window(
                site.words("Q PARAMETERS"),
                WindowKind::Table,
                cursor,
                lines,
                line,
            )),
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
