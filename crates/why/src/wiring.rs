//! What is wired to the inputs and outputs of the PLC, in words: the description of the plant says where each stands.

use bahn_host::{LoadedMachine, files};
use bahn_screen::texts::{self, Language};

/// Something that is wired.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Wired {
    /// The input or output, as `I24`.
    pub operand: String,
    /// The section of the description, as `axis.X`.
    section: String,
    /// Its key there.
    key: String,
    /// A contact that opens.
    opens: bool,
}

/// Keys of the description with their words; `{}` is the name of the section.
const KEYS: [(&str, &str, &str); 24] = [
    ("axis.", "ready", "drive of {}: ready"),
    ("axis.", "enable", "drive of {}: enable"),
    ("axis.", "brake_output", "brake of {}"),
    ("axis.", "reference_cam", "reference cam of {}"),
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

/// What is wired at a machine, in the order of its description.
pub fn of(machine: &LoadedMachine) -> Vec<Wired> {
    let path = machine.root.join(&machine.folder.plant);
    // Without the text there are only numbers.
    let text = files::read_description(&path).unwrap_or_default();
    let text = bahn_text::decode(&text);
    let mut sections: Vec<&str> = Vec::new();
    let mut section = "";
    let lines: Vec<&str> = text.lines().collect();
    for line in &lines {
        if let Some(header) = line.trim().strip_prefix('[') {
            section = header
                .split(']')
                .next()
                .unwrap_or_default()
                .trim_start_matches('[');
        }
        sections.push(section);
    }
    let wired = machine.plant.wires().iter().map(|wire| {
        let at = (wire.span.line as usize).saturating_sub(1);
        let line = lines.get(at).copied().unwrap_or_default();
        let before: String = line.chars().take(wire.span.column as usize).collect();
        let key = line.split('=').next().unwrap_or_default().trim();
        Wired {
            operand: wire.operand.clone(),
            section: sections.get(at).copied().unwrap_or_default().trim().to_owned(),
            key: key.trim_matches('"').to_owned(),
            opens: before.contains("not ") || line.contains(&format!("not {}", wire.operand)),
        }
    });
    wired.collect()
}

impl Wired {
    /// It is a contact of this key of the panel.
    pub fn is_key(&self, name: &str) -> bool {
        self.section == "keys" && self.key == name
    }

    /// The contact opens.
    pub fn opens(&self) -> bool {
        self.opens
    }

    /// What it is, in words.
    pub fn words(&self, machine: &LoadedMachine, language: Language) -> String {
        let known = KEYS.iter().find(|(section, key, _)| {
            let is_section = match section.ends_with('.') {
                true => self.section.starts_with(section),
                false => self.section == *section,
            };
            is_section && (key.is_empty() || *key == self.key)
        });
        let Some((section, key, words)) = known else {
            return format!("{}: {}", self.section, self.key);
        };
        let name = match key.is_empty() {
            true => &self.key,
            false => self.section.strip_prefix(section).unwrap_or_default(),
        };
        let states = machine.plant.device(name).map_or([""; 2], |device| device.states);
        let text = texts::words(language, words);
        let text = text.replace("{}", name).replace("{0}", name);
        let text = text.replace("{1}", states[0]).replace("{2}", states[1]);
        match self.opens {
            true => format!("{text} ({})", texts::words(language, "opens")),
            false => text,
        }
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
