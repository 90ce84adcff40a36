//! Axis and interpolation factor of the handwheel [003:1051-1080].

use bahn_dialogue::Key;
use bahn_parameters::MessageId;
use bahn_path::Axis;
use bahn_screen::{Dialogue, Line, Window, WindowKind};
use bahn_tnc::Command;

use crate::entry::Entry;
use crate::page::{Page, Turn, View};
use crate::site::Site;

/// Travel of a turn with interpolation factor 0, mm; each further factor halves it [003:1051-1062].
const TURN_MM: f64 = 20.0;

/// Axis and factor are chosen.
#[derive(Default)]
pub(crate) struct Handwheel {
    entry: Entry,
}

/// Axis and factor as they are.
pub(crate) fn chosen(site: &Site) -> Option<(Axis, u8)> {
    let (index, factor) = site.control().first().handwheel();
    Some((site.axis_of_key(index)?, factor))
}

impl Handwheel {
    fn axis(place: usize, site: &mut Site) -> Turn {
        let (Some(axis), Some((_, factor))) = (site.axis_of_key(place), chosen(site)) else {
            return Turn::Refused;
        };
        match site.command(Command::Handwheel(axis, factor)) {
            true => Turn::Done,
            false => Turn::Refused,
        }
    }

    fn enter(&mut self, site: &mut Site) -> Turn {
        let (Some(factor), Some((axis, _))) = (self.entry.whole(), chosen(site)) else {
            return Turn::Close;
        };
        let factor = u8::try_from(factor).ok().filter(|factor| *factor <= 10);
        self.entry = Entry::default();
        match factor.is_some_and(|factor| site.command(Command::Handwheel(axis, factor))) {
            true => Turn::Done,
            false => Turn::Say(site.message(MessageId::EntryValueIncorrect)),
        }
    }
}

impl Page for Handwheel {
    fn key(&mut self, key: Key, site: &mut Site) -> Turn {
        match key {
            Key::X => Handwheel::axis(0, site),
            Key::Y => Handwheel::axis(1, site),
            Key::Z => Handwheel::axis(2, site),
            Key::Iv => Handwheel::axis(3, site),
            Key::V => Handwheel::axis(4, site),
            Key::Ent => self.enter(site),
            Key::End | Key::Del | Key::NoEnt => Turn::Close,
            key if self.entry.key(key) => Turn::Done,
            _ => Turn::Refused,
        }
    }

    fn soft_keys(&self, site: &Site) -> Vec<Vec<String>> {
        let letters = site.control().axis_letters().take(5);
        let mut keys: Vec<String> = letters.map(String::from).collect();
        keys.resize(7, String::new());
        keys.push(site.words("END"));
        vec![keys]
    }

    fn soft_key(&mut self, _row: usize, place: usize, site: &mut Site) -> Turn {
        match place {
            7 => Turn::Close,
            place => match site.control().snapshot().axes.get(place).map(|axis| axis.index) {
                Some(index) => Handwheel::axis(index, site),
                None => Turn::Refused,
            },
        }
    }

    fn show(&self, site: &Site, _lines: usize) -> View {
        let line = chosen(site).map(|(axis, factor)| Line {
            text: format!(
                "{}   {} {factor}   {:.3} MM/U",
                axis.letter(),
                site.words("INTERPOLATION FACTOR"),
                TURN_MM / f64::from(1_u32 << factor.min(10))
            ),
            current: true,
            ..Line::default()
        });
        let lines: Vec<Line> = line.into_iter().collect();
        View {
            window: Some(Window {
                title: site.words("HANDWHEEL"),
                kind: WindowKind::List,
                total: lines.len(),
                lines,
                first: 0,
            }),
            dialogue: Dialogue {
                prompt: format!("{} =", site.words("INTERPOLATION FACTOR")),
                entry: self.entry.text(),
                open: true,
            },
        }
    }
}
