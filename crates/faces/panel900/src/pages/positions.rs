//! POSITIONS: the axes in large letters, or all that is known of each; the program beside them.

use bahn_live::Refusal;
use bahn_screen::{Window, WindowKind};
use bahn_system900::AxisParameter;

use super::Page;
use super::list::{Cursor, Table};
use crate::sight::{Desk, Sight};
use crate::status::Positions;

/// Which positions stand in the display, and whether all of them do.
#[derive(Clone, Copy, Debug, Default)]
pub(crate) struct PositionsPage {
    pub positions: Positions,
    details: bool,
}

impl Page for PositionsPage {
    fn window(&self, sight: &Sight<'_>) -> Window {
        if !self.details {
            return Window {
                title: self.positions.title(sight).to_owned(),
                kind: WindowKind::Positions,
                ..Window::default()
            };
        }
        let columns = [
            AxisParameter::DisplayPosition,
            AxisParameter::NominalPosition,
            AxisParameter::ActualPosition,
            AxisParameter::Lag,
            AxisParameter::DeltaPosition,
            AxisParameter::ActualSpeed,
        ];
        let rows = sight.axes().map(|axis| {
            let unit = if sight.turns(axis) { "°" } else { "mm" };
            let sign = if sight.is_referenced(axis) { " " } else { "?" };
            let named = [format!("{sign}{}", axis.name), unit.to_owned()].into_iter();
            let values = columns.map(|parameter| sight.position(sight.of_axis(axis, parameter)));
            named.chain(values).collect()
        });
        let heads = [
            (sight.words("AXIS"), 5),
            ("", 3),
            (sight.words("DISPLAY"), 11),
            (sight.words("NOMINAL"), 11),
            (sight.words("ACTUAL"), 11),
            (sight.words("LAG ERROR"), 10),
            (sight.words("REMAINING"), 11),
            (sight.words("SPEED"), 11),
        ];
        let table = Table {
            title: sight.words("ALL POSITIONS, ? WITHOUT REFERENCE POINT").to_owned(),
            heads: &heads,
            naming: 2,
            rows: rows.collect(),
        };
        let mut window = table.window(Cursor::default());
        // There is nothing to be entered here.
        for line in window.lines.iter_mut().skip(1) {
            line.current = false;
            line.marks.clear();
        }
        window
    }

    fn has_program(&self) -> bool {
        !self.details
    }

    fn prompt(&self, _: &Sight<'_>) -> String {
        String::new()
    }

    fn soft_keys(&self, sight: &Sight<'_>) -> [&'static str; 2] {
        let details = match self.details {
            true => sight.words("LARGE"),
            false => sight.words("DETAILS"),
        };
        [self.positions.next().title(sight), details]
    }

    fn soft_key(&mut self, which: usize, _: &mut Desk<'_>) -> Result<(), Refusal> {
        match which {
            0 => self.positions = self.positions.next(),
            _ => self.details = !self.details,
        }
        Ok(())
    }

    fn enter(&mut self, _: &str, _: &mut Desk<'_>) -> Result<(), Refusal> {
        Ok(())
    }
}
