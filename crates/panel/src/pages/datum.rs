//! DATUM SET: the actual position of an axis becomes a value [003:1157-1182].

use bahn_control::Command;
use bahn_path::Axis;

use crate::page::Turn;
use crate::pages::number::Number;
use crate::settings::PositionType;
use crate::site::Site;

/// Millimetres of an inch.
const INCH_MM: f64 = 25.4;

/// Asks for the datum of the axis of a key; only where actual positions are shown [003:1151-1155].
pub(crate) fn ask(place: usize, site: &Site) -> Turn {
    let Some(axis) = site.axis_of_key(place) else {
        return Turn::Refused;
    };
    if site.settings.position_type != PositionType::Actl {
        return Turn::Refused;
    }
    let prompt = format!("{} {} =", site.words("DATUM SET"), axis.letter());
    Turn::Open(Number::ask(prompt, move |value, site| set(axis, value, site)))
}

fn set(axis: Axis, value: f64, site: &mut Site) -> bool {
    let inch = site.settings.inch && !axis.is_rotary();
    let value = if inch { value * INCH_MM } else { value };
    site.command(Command::Datum(axis, value))
}
