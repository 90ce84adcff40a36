//! DATUM SET: the actual position of an axis becomes a value [003:1157-1182].

use bahn_dialogue::Key;
use bahn_path::Axis;
use bahn_screen::Dialogue;
use bahn_tnc::Command;

use crate::page::{Page, Turn, View};
use crate::pages::number::Number;
use crate::settings::PositionType;
use crate::site::Site;
use crate::status;

/// Millimetres of an inch.
const INCH_MM: f64 = 25.4;
/// Steps of an inch are a tenth of those of a mm.
const INCH_STEPS: f64 = 0.1;
/// A number that is so far from a whole step is finer, mm or inches.
const FINER: f64 = 1e-6;

/// Keys of the axes, in the order of their indices.
const KEYS: [Key; 5] = [Key::X, Key::Y, Key::Z, Key::Iv, Key::V];

/// The soft key DATUM SET: an axis key chooses the axis [000:6254].
struct DatumSet;

/// The page of the soft key.
pub(crate) fn page() -> Turn {
    Turn::Open(Box::new(DatumSet))
}

/// The axis of a key, where the machine has it.
pub(crate) fn axis_of(key: Key, site: &Site) -> Option<Axis> {
    let place = KEYS.iter().position(|own| *own == key)?;
    site.axis_of_key(place)
}

/// Asks for the datum of the axis of a key.
pub(crate) fn of_key(key: Key, site: &Site) -> Turn {
    axis_of(key, site).map_or(Turn::Refused, |axis| ask(axis, site))
}

impl Page for DatumSet {
    fn key(&mut self, key: Key, site: &mut Site) -> Turn {
        match key {
            Key::End | Key::Del | Key::NoEnt => Turn::Close,
            key => match of_key(key, site) {
                Turn::Open(page) => Turn::Replace(page),
                other => other,
            },
        }
    }

    fn soft_keys(&self, site: &Site) -> Vec<Vec<String>> {
        let letters = (0..KEYS.len()).map(|place| site.axis_of_key(place));
        let mut keys: Vec<String> = letters
            .map(|axis| axis.map_or_else(String::new, |axis| axis.letter().to_string()))
            .collect();
        keys.extend([String::new(), String::new(), site.words("END")]);
        vec![keys]
    }

    fn soft_key(&mut self, _row: usize, place: usize, site: &mut Site) -> Turn {
        self.key(KEYS.get(place).copied().unwrap_or(Key::End), site)
    }

    fn show(&self, site: &Site, _lines: usize) -> View {
        View {
            window: None,
            dialogue: Dialogue {
                prompt: format!("{} ...", site.words("DATUM SET")),
                open: true,
                ..Dialogue::default()
            },
        }
    }
}

/// Asks for the datum of the axis of a key; only where actual positions are shown [003:1151-1155].
fn ask(axis: Axis, site: &Site) -> Turn {
    if site.settings.position_type != PositionType::Actl {
        return Turn::Refused;
    }
    let prompt = format!("{} {} =", site.words("DATUM SET"), axis.letter());
    Turn::Open(Number::ask(prompt, move |value, site| set(axis, value, site)))
}

fn set(axis: Axis, value: f64, site: &mut Site) -> bool {
    let inch = site.settings.inch && !axis.is_rotary();
    // What is finer than the resolution of the control is no value, as in a block.
    let step = site.parameters().input_step_mm();
    let finer = |step: f64| ((value / step).round() * step - value).abs() > FINER;
    let step = step.map(|step| if inch { step * INCH_STEPS } else { step });
    if !axis.is_rotary() && step.is_some_and(finer) {
        return false;
    }
    let value = if inch { value * INCH_MM } else { value };
    // The display becomes the value, which shows the nose of the spindle with MP7285 = 0.
    let snapshot = site.control().snapshot();
    let own = snapshot.axes.iter().find(|own| own.letter == axis.letter());
    let hidden_mm = own.map_or(0.0, |own| status::hidden_length_mm(own, site.parameters()));
    site.command(Command::Datum(axis, value - hidden_mm))
}
