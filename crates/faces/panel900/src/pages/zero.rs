//! ZERO POINTS: the points of a work area with the values of their axes, a group at a time; 0 is the sum [002:978-1144].

use bahn_live::Refusal;
use bahn_screen::Window;
use bahn_screen::texts::filled;
use bahn_system900::{Name, ZeroPoint, ZeroPoints};

use super::list::{Cursor, Table};
use super::{Arrow, Page};
use crate::sight::{Desk, Sight};

/// Area, group and cursor.
#[derive(Clone, Copy, Debug)]
pub(crate) struct ZeroPage {
    /// From 1 on.
    area: u32,
    /// 0 is the sum; shifts are entered.
    group: u32,
    cursor: Cursor,
}

impl Default for ZeroPage {
    fn default() -> ZeroPage {
        ZeroPage {
            area: 1,
            group: 1,
            cursor: Cursor::default(),
        }
    }
}

/// The points of an area and a group: each with its axes.
fn points(zero: &ZeroPoints, area: u32, group: u32) -> Vec<Vec<&ZeroPoint>> {
    let own = zero
        .cells
        .iter()
        .filter(|cell| cell.area == area && cell.group == group);
    let own: Vec<_> = own.collect();
    let axes = usize::try_from(zero.axes).unwrap_or(1).max(1);
    own.chunks(axes).map(<[_]>::to_vec).collect()
}

impl ZeroPage {
    /// Within what the channel has: another channel may have fewer.
    fn within(self, zero: &ZeroPoints) -> (u32, u32) {
        (
            self.area.min(zero.areas.max(1)),
            self.group.min(zero.groups.saturating_sub(1)),
        )
    }

    fn cell(self, sight: &Sight<'_>) -> Option<ZeroPoint> {
        let zero = ZeroPoints::of(sight.memory(), sight.channel);
        let (area, group) = self.within(&zero);
        let points = points(&zero, area, group);
        let row = points.get(self.cursor.row)?;
        row.get(self.cursor.column).map(|cell| (*cell).clone())
    }
}

impl Page for ZeroPage {
    fn window(&self, sight: &Sight<'_>) -> Window {
        let zero = ZeroPoints::of(sight.memory(), sight.channel);
        let (area, group) = self.within(&zero);
        let points = points(&zero, area, group);
        let names: Vec<String> = (1..=zero.axes)
            .map(|logical| {
                let axis = sight.axes().find(|axis| u32::from(axis.logical) == logical);
                axis.map_or_else(|| format!("({logical})"), |axis| axis.name.clone())
            })
            .collect();
        let mut heads = vec![("", 5)];
        heads.extend(names.iter().map(|name| (name.as_str(), 11)));
        let rows = points.iter().map(|point| {
            let name = point.first().map(|cell| cell.point.clone()).unwrap_or_default();
            let written = |cell: &&ZeroPoint| {
                let held = sight.memory().cell(Name::P(sight.channel, cell.p));
                held.map(bahn_system900::Cell::written).unwrap_or_default()
            };
            std::iter::once(name).chain(point.iter().map(written)).collect()
        });
        let group = match group {
            0 => sight.words("SUM").to_owned(),
            group => format!("{} {group}", sight.words("SHIFT")),
        };
        let [channel, area] = [u32::from(sight.channel), area].map(|number| number.to_string());
        let table = Table {
            title: filled(
                sight.words("ZERO POINTS, CHANNEL {1}, AREA {2}, {3}"),
                &[&channel, &area, &group],
            ),
            heads: &heads,
            naming: 1,
            rows: rows.collect(),
        };
        table.window(self.cursor)
    }

    fn prompt(&self, sight: &Sight<'_>) -> String {
        self.cell(sight).map_or_else(
            || sight.words("THE CHANNEL HAS NO ZERO POINTS").to_owned(),
            |cell| format!("{} {} =", cell.point, Name::P(sight.channel, cell.p)),
        )
    }

    fn soft_keys(&self, sight: &Sight<'_>) -> [&'static str; 2] {
        [sight.words("NEXT AREA"), sight.words("SUM OR SHIFT")]
    }

    fn soft_key(&mut self, which: usize, desk: &mut Desk<'_>) -> Result<(), Refusal> {
        let zero = ZeroPoints::of(desk.sight().memory(), desk.channel);
        let (area, group) = self.within(&zero);
        match which {
            0 => self.area = area % zero.areas.max(1) + 1,
            _ => self.group = (group + 1) % zero.groups.max(1),
        }
        Ok(())
    }

    fn go(&mut self, arrow: Arrow, sight: &Sight<'_>) {
        let zero = ZeroPoints::of(sight.memory(), sight.channel);
        let [rows, columns] = [zero.points, zero.axes].map(|count| usize::try_from(count).unwrap_or(0));
        self.cursor.go(arrow, rows, columns);
    }

    fn enter(&mut self, entry: &str, desk: &mut Desk<'_>) -> Result<(), Refusal> {
        let cell = self.cell(&desk.sight());
        match cell {
            Some(cell) if !entry.trim().is_empty() => desk.write(Name::P(desk.channel, cell.p), entry),
            _ => Ok(()),
        }
    }
}
