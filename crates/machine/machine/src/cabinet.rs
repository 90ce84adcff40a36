//! The wiring of a cabinet: contacts of contactors, gears and keys that switch things beside the outputs of the PLC.
//!
//! A contact is named where an output may stand: a thing by its name (closed in its second state), `gear1` to `gear8` (that gear is
//! engaged), `voltage` (the control voltage is on), a key of the panel by its name. They lie behind the outputs that a control has.

use bahn_servo::OUTPUTS;

use crate::mechanism::Mechanism;
use crate::panel::Panel;
use crate::reader::Section;

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
