//! The wiring of a cabinet: contacts of contactors, gears and keys that switch things beside the outputs of the PLC.
//!
//! A contact is named where an output may stand: a thing by its name (closed in its second state), `gear1` to `gear8` (that gear is
//! engaged), `voltage` (the control voltage is on), a key of the panel by its name. They lie behind the outputs that a control has.

use bahn_servo::OUTPUTS;

use crate::mechanism::Mechanism;
use crate::panel::Panel;
use crate::reader::{Coil, Section};

/// Places of the contacts behind the outputs.
const THINGS: std::ops::Range<usize> = 128..160;
const GEARS: std::ops::Range<usize> = 160..168;
const VOLTAGE: usize = 168;
const KEYS: std::ops::Range<usize> = 169..OUTPUTS;

/// Tells the reader the names of all contacts, before anything is wired to them.
pub(crate) fn name_contacts(root: &Section) {
    let mut contacts = Vec::new();
    let named = [("device", THINGS), ("keys", KEYS)];
    for (key, places) in named {
        let names = root.names(key);
        if names.len() > places.len() {
            root.fault_at(key, format!("there are {} at most", places.len()));
        }
        contacts.extend(names.into_iter().zip(places));
    }
    let gears = GEARS.map(|place| (format!("gear{}", place - GEARS.start + 1), place));
    contacts.extend(gears);
    contacts.push(("voltage".to_owned(), VOLTAGE));
    root.reader.know_contacts(contacts);
}

/// Sets all contacts as the things stand.
pub(crate) fn set_contacts(mechanism: &Mechanism, panel: &Panel, voltage: bool, live: &mut [bool; OUTPUTS]) {
    let mut set = |place: usize, closed: bool| {
        if let Some(contact) = live.get_mut(place) {
            *contact = closed;
        }
    };
    for (place, device) in THINGS.zip(&mechanism.devices) {
        set(place, device.is_forth());
    }
    let gear = mechanism
        .spindles
        .first()
        .and_then(|spindle| spindle.state().gear);
    for place in GEARS {
        set(place, gear == Some(place - GEARS.start + 1));
    }
    set(VOLTAGE, voltage);
    for (place, key) in KEYS.zip(&panel.keys) {
        set(place, key.pressed);
    }
}

/// What switches a contactor: it pulls in with any of its branches, and holds itself as long as all contacts of `hold` are closed.
#[derive(Clone, Debug, Default)]
pub(crate) struct Circuit {
    branches: Vec<Vec<Coil>>,
    hold: Vec<Coil>,
}

impl Circuit {
    /// Reads `on = ["A7 and A20", "not K1"]` and `hold = ["voltage", "not A17"]`; `None` without `on`.
    pub fn read(section: &Section) -> Option<Circuit> {
        let series = |(at, text): (usize, &str)| -> Vec<Coil> {
            let terms = text.split(" and ").map(str::trim);
            terms.filter_map(|term| section.contact_at(at, term)).collect()
        };
        let branches: Vec<Vec<Coil>> = section.texts("on").into_iter().map(series).collect();
        let hold = section.texts("hold").into_iter().flat_map(series).collect();
        (!branches.is_empty()).then_some(Circuit { branches, hold })
    }

    /// Whether it is under voltage, when its own contact is closed or not.
    pub fn is_on(&self, closed: bool, live: &[bool; OUTPUTS]) -> bool {
        let all = |contacts: &[Coil]| contacts.iter().all(|contact| contact.is_on(live));
        let holds = closed && !self.hold.is_empty() && all(&self.hold);
        holds || self.branches.iter().any(|branch| all(branch))
    }
}
