//! AXIS LIMIT: the operator allows the axes less than their software limits, in each traverse range [003:7115-7157].

use bahn_dialogue::Key;
use bahn_path::Axis;
use bahn_tnc::Command;

use crate::page::{Page, Turn};
use crate::pages::menu::{Item, Items, Menu};
use crate::pages::number::Number;
use crate::site::Site;

/// What stands there as long as nothing was entered, mm or degrees: no limit [003:7121].
const NONE: [f64; 2] = [-30_000.0, 30_000.0];

/// The page of a traverse range, 1 to 3.
pub(super) fn page(range: u8) -> Box<dyn Page> {
    Box::new(Menu::new(AxisLimits { range }))
}

struct AxisLimits {
    range: u8,
}

impl AxisLimits {
    /// The axis of a line, and whether it is the greatest position.
    fn line(place: usize, site: &Site) -> Option<(Axis, usize)> {
        let letter = site.control().axis_letters().nth(place / 2)?;
        let axis = Axis::from_letter(u8::try_from(letter).ok()?)?;
        Some((axis, place % 2))
    }
}

/// What holds for an axis.
fn limits(axis: Axis, range: u8, site: &Site) -> [f64; 2] {
    let channel = site.control().first();
    let own = channel.axis_limits().iter();
    let mut own = own.filter(|own| own.axis == axis && own.range == range);
    own.next().map_or(NONE, |own| own.limits)
}

/// Sets one of both.
fn set(axis: Axis, range: u8, side: usize, value: f64, site: &mut Site) -> bool {
    let mut limits = limits(axis, range, site);
    if let Some(limit) = limits.get_mut(side) {
        *limit = value;
    }
    let within = limits.iter().all(|limit| (-30_000.0..=30_000.0).contains(limit));
    let wanted = Some(limits).filter(|limits| *limits != NONE);
    within && site.command(Command::AxisLimit(axis, range, wanted))
}

impl Items for AxisLimits {
    fn title(&self, site: &Site) -> String {
        format!("{} {}", site.words("AXIS LIMIT"), self.range)
    }

    fn items(&self, site: &Site) -> Vec<Item> {
        let lines = (0..).map_while(|place| AxisLimits::line(place, site));
        lines
            .map(|(axis, side)| {
                let value = limits(axis, self.range, site)
                    .get(side)
                    .copied()
                    .unwrap_or_default();
                let sign = if side == 0 { '-' } else { '+' };
                Item::new(format!("{}{sign}", axis.letter()), format!("{value:+.3}"))
            })
            .collect()
    }

    fn choose(&mut self, place: usize, site: &mut Site) -> Turn {
        let Some((axis, side)) = AxisLimits::line(place, site) else {
            return Turn::Refused;
        };
        let range = self.range;
        let sign = if side == 0 { '-' } else { '+' };
        let prompt = format!("{} {}{sign} =", site.words("AXIS LIMIT"), axis.letter());
        let ask = Number::ask(prompt, move |value, site| set(axis, range, side, value, site));
        Turn::Open(ask.capturing(move |site| site.captured_reference(axis.letter())))
    }

    /// CAPTURE takes the position over where the axis stands, in coordinates of REF [003:7157].
    fn key(&mut self, place: usize, key: Key, site: &mut Site) -> Turn {
        let Some((axis, side)) = AxisLimits::line(place, site).filter(|_| key == Key::Capture) else {
            return Turn::Refused;
        };
        let value = site.captured_reference(axis.letter());
        match value.is_some_and(|value| set(axis, self.range, side, value, site)) {
            true => Turn::Done,
            false => Turn::Say(site.message(bahn_parameters::MessageId::EntryValueIncorrect)),
        }
    }
}
