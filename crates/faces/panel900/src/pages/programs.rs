//! PROGRAM: the programs of the folder; the one that is chosen becomes P8800 of the channel.

use bahn_host::Programs900;
use bahn_live::Refusal;
use bahn_screen::texts::filled;
use bahn_screen::{Line, Window, WindowKind};
use bahn_system900::ChannelParameter;

use super::{Arrow, LINES, Page};
use crate::sight::{Desk, Sight};

/// Entries of a folder that are looked at.
const LOOKED_AT: usize = 10_000;

/// Where the cursor is.
#[derive(Clone, Copy, Debug, Default)]
pub(crate) struct ProgramsPage {
    row: usize,
}

/// The numbers of the programs of the folder.
fn numbers(sight: &Sight<'_>) -> Vec<i64> {
    let Ok(entries) = std::fs::read_dir(sight.machine.programs()) else {
        return Vec::new();
    };
    let files = entries.take(LOOKED_AT).flatten().map(|entry| entry.path());
    let programs = files.filter(|path| {
        path.extension()
            .is_some_and(|ending| ending.eq_ignore_ascii_case("900"))
    });
    let mut numbers: Vec<i64> = programs.filter_map(|path| Programs900::number(&path)).collect();
    numbers.sort_unstable();
    numbers.dedup();
    numbers
}

impl Page for ProgramsPage {
    fn window(&self, sight: &Sight<'_>) -> Window {
        let numbers = numbers(sight);
        let chosen = sight.whole(ChannelParameter::Program);
        let row = self.row.min(numbers.len().saturating_sub(1));
        let first = row
            .saturating_sub(LINES / 2)
            .min(numbers.len().saturating_sub(LINES));
        let line = |(place, number): (usize, &i64)| {
            let sign = if chosen == Some(*number) { "*" } else { " " };
            Line {
                text: format!("{sign} P{number}"),
                current: place == row,
                marks: Vec::new(),
            }
        };
        Window {
            title: filled(
                sight.words("PROGRAMS, * IN CHANNEL {1}"),
                &[&sight.channel.to_string()],
            ),
            kind: WindowKind::List,
            lines: numbers
                .iter()
                .enumerate()
                .skip(first)
                .take(LINES)
                .map(line)
                .collect(),
            first,
            total: numbers.len(),
        }
    }

    fn has_program(&self) -> bool {
        true
    }

    fn prompt(&self, sight: &Sight<'_>) -> String {
        sight.words("NUMBER OF THE PROGRAM, OR ENT:").to_owned()
    }

    fn go(&mut self, arrow: Arrow, sight: &Sight<'_>) {
        let last = numbers(sight).len().saturating_sub(1);
        match arrow {
            Arrow::Up => self.row = self.row.min(last).saturating_sub(1),
            Arrow::Down => self.row = (self.row + 1).min(last),
            Arrow::Left | Arrow::Right => {}
        }
    }

    fn enter(&mut self, entry: &str, desk: &mut Desk<'_>) -> Result<(), Refusal> {
        let sight = desk.sight();
        let known = numbers(&sight);
        let typed = entry.trim().trim_start_matches(['P', 'p']);
        let number = match typed {
            "" => known.get(self.row).copied(),
            typed => typed.parse().ok(),
        };
        let missing = || Refusal(filled(sight.words("There is no program {1}"), &[typed]));
        let number = number
            .filter(|number| known.contains(number))
            .ok_or_else(missing)?;
        if sight.control().is_on_its_way(sight.channel) {
            let text = sight.words("A program is on its way in channel {1}");
            return Err(Refusal(filled(text, &[&sight.channel.to_string()])));
        }
        self.row = known.iter().position(|known| *known == number).unwrap_or(0);
        desk.press(ChannelParameter::Program, &number.to_string())
    }
}
