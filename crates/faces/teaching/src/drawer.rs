//! The teacher's drawer: everything of a machine that can be broken, with the action that breaks it and the one that
//! repairs it. What there is, a copy of the plant says: what cannot be done to it is left out, and of a plant without copy
//! nothing can be broken.

use bahn_exchange::Bit;
use bahn_host::{Action, Operable};
use bahn_parameters::ControlModel;
use bahn_screen::texts::{self, Language};
use bahn_why::wiring;
use serde::Serialize;

/// Something that can be broken.
#[derive(Clone, Debug, PartialEq, Eq, Serialize)]
pub struct Breakable {
    /// Its name in actions: `X`, `S`, `door`, `I21`; on a TNC 151/155 `E21`.
    pub name: String,
    /// Its group in words: axes, things, inputs.
    pub group: String,
    /// What it is, in words.
    pub words: String,
    /// The faults that it can have.
    pub faults: Vec<Breaking>,
    /// The action that makes it whole.
    pub repair: String,
}

/// A fault that something can have.
#[derive(Clone, Debug, PartialEq, Eq, Serialize)]
pub struct Breaking {
    /// The action that brings the fault about, as a script writes it.
    pub action: String,
    /// What happens, in words.
    pub words: String,
}

/// Deeds and their words; `{}` is the name.
type Faults = &'static [(&'static str, &'static str)];

const AXIS: Faults = &[
    ("fault drive {} dead", "the drive gives no power"),
    ("fault drive {} runaway", "the drive runs away"),
    ("fault drive {} reversed", "the motor turns the other way"),
    ("fault drive {} slow", "the drive is too slow"),
    (
        "fault encoder {} amplitude",
        "the signal of the encoder is too small",
    ),
    (
        "fault encoder {} edges",
        "the edges of the encoder follow too closely",
    ),
    ("fault encoder {} stuck", "the encoder counts nothing"),
    ("fault encoder {} marks", "the reference marks are wrong"),
    ("fault encoder {} no-marks", "the reference marks do not come"),
    ("fault encoder {} twice", "the reference marks come twice"),
    ("fault motor {}", "the encoder of the motor counts nothing"),
    ("fault brake {}", "the brake does not hold"),
    ("fault clamp {}", "something holds the axis"),
];
const OFFSET: Faults = &[("fault offset {} 0.05", "the amplifier drifts by 50 mV")];
const FORCE: Faults = &[("force {} 2000", "something pushes the axis")];
const THING: Faults = &[
    ("fault device {} jammed", "it is jammed"),
    ("fault device {} no-feedback", "its switch says nothing"),
    (
        "fault device {} permanent",
        "its switch always says that it is there",
    ),
    ("fault device {} slow", "it is slow"),
];
const INPUT: Faults = &[
    ("fault input {} 0", "the wire is broken: it always reads 0"),
    ("fault input {} 1", "the contact sticks: it always reads 1"),
    ("fault input {} bouncing", "the contact chatters"),
];
const RELAY: Faults = &[
    ("fault relay open", "the relay does not pull in"),
    ("fault relay welded", "the contacts are welded"),
    ("fault relay slow 300", "the relay drops out late"),
];
const PROBE: Faults = &[
    ("fault probe not-ready", "the touch probe does not answer"),
    ("fault probe battery", "the battery of the touch probe is low"),
    ("fault probe early", "the touch probe is always deflected"),
    ("probe push X 4", "a hand pushes the stylus in X"),
];
const BATTERY: Faults = &[("fault battery", "the buffer battery is low")];
const MAGAZINE: Faults = &[("fault magazine lost", "the arm drops its tools")];
const BUTTON: Faults = &[("emergency press", "the EMERGENCY STOP button is pressed")];
const SUPPLY: Faults = &[("voltage off", "the supply of the control voltage is missing")];
const HANDWHEEL: Faults = &[("handwheel unplug", "the handwheel is not plugged in")];

const GROUPS: [&str; 4] = ["axes and spindle", "things", "inputs", "control and supply"];

/// What can be broken at a plant; inputs have the letters of the control.
pub fn of<P: Operable>(plant: &P, model: ControlModel, language: Language) -> Vec<Breakable> {
    let old = model.limits().has_old_numbers();
    let finder = Finder { plant, language };
    let [axes, things, inputs, supply] = GROUPS;
    let in_words = |english| texts::words(language, english);
    let mut found = Vec::new();
    for letter in plant.axis_letters() {
        let name = letter.to_string();
        let words = format!("{} {name}", in_words("axis"));
        found.push(finder.breakable(&name, axes, &words, AXIS, &format!("repair {name}")));
        found.push(finder.breakable(&name, axes, &words, OFFSET, &format!("fault offset {name} 0")));
        found.push(finder.breakable(&name, axes, &words, FORCE, &format!("force {name} 0")));
    }
    found.push(finder.breakable("S", axes, in_words("spindle"), AXIS, "repair S"));
    found.push(finder.breakable("gear", axes, in_words("gear"), THING, "repair gear"));
    for device in plant.devices() {
        let name = device.name;
        found.push(finder.breakable(name, things, name, THING, &format!("repair {name}")));
        if let (true, Some(state)) = (device.by_hand, device.state) {
            found.extend(finder.by_hand(name, state, device.states));
        }
    }
    let repair = "repair magazine";
    found.push(finder.breakable("magazine", things, in_words("magazine"), THING, repair));
    found.push(finder.breakable("magazine", things, in_words("magazine"), MAGAZINE, repair));
    found.push(finder.breakable("probe", things, in_words("touch probe"), PROBE, "repair probe"));
    for wired in plant.wires() {
        let name = &wired.operand;
        let words = wiring::in_words(&wired, plant, language);
        let mut input = finder.breakable(name, inputs, &words, INPUT, &format!("repair {name}"));
        if let Ok(bit) = name.parse::<Bit>() {
            input.name = bit.name(old);
        }
        found.push(input);
    }
    let voltage = in_words("control voltage");
    found.push(finder.breakable("relay", supply, voltage, RELAY, "repair relay"));
    found.push(finder.breakable("voltage", supply, voltage, SUPPLY, "voltage on"));
    let stop = texts::around(language, "EMERGENCY STOP");
    found.push(finder.breakable("emergency", supply, stop, BUTTON, "emergency release"));
    found.push(finder.breakable("battery", supply, in_words("battery"), BATTERY, "repair battery"));
    let handwheel = in_words("handwheel");
    found.push(finder.breakable("handwheel", supply, handwheel, HANDWHEEL, "handwheel plug"));
    found.retain(|breakable| !breakable.faults.is_empty());
    found
}

struct Finder<'a, P> {
    plant: &'a P,
    language: Language,
}

impl<P: Operable> Finder<'_, P> {
    /// What the machine does not have is left out.
    fn breakable(
        &self,
        name: &str,
        group: &'static str,
        words: &str,
        faults: Faults,
        repair: &str,
    ) -> Breakable {
        let breaking = |(action, words): &(&str, &'static str)| {
            let action = action.replace("{}", name);
            can_be_done(self.plant, &action).then(|| Breaking {
                action,
                words: texts::words(self.language, words).to_owned(),
            })
        };
        Breakable {
            name: name.to_owned(),
            group: texts::words(self.language, group).to_owned(),
            words: words.to_owned(),
            faults: faults.iter().filter_map(breaking).collect(),
            repair: repair.to_owned(),
        }
    }

    /// A door that is opened, a lubricant that runs low.
    fn by_hand(&self, name: &str, whole: &str, states: [&str; 2]) -> Option<Breakable> {
        let other = states.into_iter().find(|state| *state != whole)?;
        Some(Breakable {
            name: name.to_owned(),
            group: texts::words(self.language, GROUPS[1]).to_owned(),
            words: name.to_owned(),
            faults: vec![Breaking {
                action: format!("switch {name} {other}"),
                words: other.to_owned(),
            }],
            repair: format!("switch {name} {whole}"),
        })
    }
}

/// Whether a plant has what an action names: it is tried on a copy.
pub(crate) fn can_be_done<P: Operable>(plant: &P, action: &str) -> bool {
    let done = |event| plant.copied().map(|mut copy| copy.operate(event));
    matches!(Action::parse(action), Ok(Action::Event(event, _)) if matches!(done(&event), Some(Ok(()))))
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Every text has its German one; those of a table are not found by the test of the texts.
    #[test]
    fn every_text_is_translated() {
        let tables = [
            AXIS, OFFSET, FORCE, THING, INPUT, RELAY, PROBE, BATTERY, MAGAZINE, BUTTON, SUPPLY, HANDWHEEL,
        ];
        let words = tables
            .iter()
            .flat_map(|table| table.iter().map(|(_, words)| *words));
        let missing: Vec<_> = words
            .chain(GROUPS)
            .filter(|words| texts::words(Language::German, words) == *words)
            .collect();
        assert!(missing.is_empty(), "{missing:#?}");
    }
}
