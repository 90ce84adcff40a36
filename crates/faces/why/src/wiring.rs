//! What is wired to the inputs and outputs of the PLC, in words: the plant says what each belongs to.

use bahn_host::{Operable, Wired};
use bahn_screen::texts::{self, Language};

/// Parts and functions of [`Wired`] with their words; `{}` is the name of the part.
const KEYS: [(&str, &str, &str); 27] = [
    ("axis.", "ready", "drive of {}: ready"),
    ("axis.", "enable", "drive of {}: enable"),
    ("axis.", "brake_output", "brake of {}"),
    ("axis.", "reference_cam", "reference cam of {}"),
    ("axis.", "pulse_inhibit", "cam of the reference pulse of {}"),
    ("axis.", "limit_minus", "limit switch {}-"),
    ("axis.", "limit_plus", "limit switch {}+"),
    ("spindle", "ready", "spindle: drive ready"),
    ("spindle", "enable", "spindle: enable"),
    ("spindle", "at_speed", "spindle: at speed"),
    ("spindle", "stopped", "spindle: stands"),
    ("spindle.gear", "input", "gear is engaged"),
    ("spindle.gear", "output", "valve of the gear"),
    ("device.", "output", "{}"),
    ("device.", "output_back", "{}, back"),
    ("device.", "on", "{}"),
    ("device.", "hold", "{}"),
    ("device.", "input_first", "{0}: {1}"),
    ("device.", "input_second", "{0}: {2}"),
    ("emergency_stop", "acknowledgement", "control voltage (X42/4)"),
    ("magazine", "in_position", "magazine: in position"),
    ("magazine", "forward", "magazine: forward"),
    ("magazine", "backward", "magazine: backward"),
    ("magazine", "shuttle_full", "magazine: tool in the shuttle"),
    ("magazine", "spindle_full", "magazine: tool in the spindle"),
    ("keys", "", "key {}"),
    ("lamps", "", "lamp {}"),
];

/// What something is that is wired to a plant, in words.
pub fn in_words(wired: &Wired, plant: &dyn Operable, language: Language) -> String {
    let known = KEYS.iter().find(|(part, function, _)| {
        let is_part = match part.ends_with('.') {
            true => wired.part.starts_with(part),
            false => wired.part == *part,
        };
        is_part && (function.is_empty() || *function == wired.function)
    });
    let Some((part, function, words)) = known else {
        return format!("{}: {}", wired.part, wired.function);
    };
    let name = match function.is_empty() {
        true => &wired.function,
        false => wired.part.strip_prefix(part).unwrap_or_default(),
    };
    let devices = plant.devices();
    let device = devices.iter().find(|device| device.name == name);
    let states = device.map_or([""; 2], |device| device.states);
    let text = texts::words(language, words);
    let text = text.replace("{}", name).replace("{0}", name);
    let text = text.replace("{1}", states[0]).replace("{2}", states[1]);
    match wired.opens {
        true => format!("{text} ({})", texts::words(language, "opens")),
        false => text,
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Every text has its German one; those of a table are not found by the test of the texts.
    #[test]
    fn every_text_is_translated() {
        let words = KEYS.iter().map(|(_, _, words)| *words);
        let missing: Vec<_> = words
            .filter(|words| *words != "{}" && !words.starts_with("{0}"))
            .filter(|words| texts::words(Language::German, words) == *words)
            .collect();
        assert!(missing.is_empty(), "{missing:#?}");
    }
}
