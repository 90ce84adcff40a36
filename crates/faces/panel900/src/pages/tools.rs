//! TOOLS: the records of the tool array, with what of them is entered [002:1146-1260].

use bahn_live::Refusal;
use bahn_screen::Window;
use bahn_screen::texts::filled;
use bahn_system900::{Cell, Name, Tools};

use super::list::{Cursor, Table};
use super::{Arrow, Page};
use crate::sight::{Desk, Sight};

/// Where in a record the columns lie: group, number, place, life, radius, length, their offsets, quadrant.
const OFFSETS: [u32; 9] = [0, 1, 2, 8, 10, 11, 12, 13, 14];

/// What the columns are called, and how wide they are; the first one numbers the records.
fn heads(sight: &Sight<'_>) -> [(&'static str, usize); 10] {
    [
        ("", 3),
        (sight.words("T"), 5),
        (sight.words("NUMBER"), 6),
        (sight.words("PLACE"), 5),
        (sight.words("LIFE"), 5),
        (sight.words("RADIUS"), 9),
        (sight.words("LENGTH"), 9),
        ("DR", 7),
        ("DL", 7),
        (sight.words("QUADR"), 5),
    ]
}

/// The cursor.
#[derive(Clone, Copy, Debug, Default)]
pub(crate) struct ToolsPage {
    cursor: Cursor,
}

impl ToolsPage {
    fn name(self, sight: &Sight<'_>) -> Option<(u32, Name)> {
        let tools = Tools::of(sight.memory(), sight.channel);
        let tool = tools.records.get(self.cursor.row)?;
        let offset = OFFSETS
            .get(self.cursor.column)
            .filter(|offset| **offset < tools.length)?;
        Some((tool.record, Name::P(sight.channel, tool.p + offset)))
    }
}

impl Page for ToolsPage {
    fn window(&self, sight: &Sight<'_>) -> Window {
        let tools = Tools::of(sight.memory(), sight.channel);
        let heads = heads(sight);
        let rows = tools.records.iter().map(|tool| {
            let cells = OFFSETS.map(|offset| {
                let cell = sight.memory().cell(Name::P(sight.channel, tool.p + offset));
                cell.map(Cell::written).unwrap_or_default()
            });
            std::iter::once(tool.record.to_string()).chain(cells).collect()
        });
        let table = Table {
            title: filled(sight.words("TOOLS, CHANNEL {1}"), &[&sight.channel.to_string()]),
            heads: &heads,
            naming: 1,
            rows: rows.collect(),
        };
        table.window(self.cursor)
    }

    fn prompt(&self, sight: &Sight<'_>) -> String {
        match self.name(sight) {
            Some((record, name)) => {
                let column = heads(sight)
                    .get(self.cursor.column + 1)
                    .map_or("", |(head, _)| head);
                format!("{} {record}, {column} {name} =", sight.words("RECORD"))
            }
            None => sight.words("THE CHANNEL HAS NO TOOLS").to_owned(),
        }
    }

    fn go(&mut self, arrow: Arrow, sight: &Sight<'_>) {
        let tools = Tools::of(sight.memory(), sight.channel);
        self.cursor.go(arrow, tools.records.len(), OFFSETS.len());
    }

    fn enter(&mut self, entry: &str, desk: &mut Desk<'_>) -> Result<(), Refusal> {
        let name = self.name(&desk.sight());
        match name {
            Some((_, name)) if !entry.trim().is_empty() => desk.write(name, entry),
            _ => Ok(()),
        }
    }
}
