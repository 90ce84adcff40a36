//! What keys of a real keyboard do: one table for all front ends.

use bahn_dialogue::Key;

/// What a key of a real keyboard does.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Press {
    /// A key of the control.
    Key(Key),
    /// A key of the machine operating panel, held as long as the real one; nothing where the machine has no such key.
    Machine(&'static str),
    /// Turns the feed override knob by so many per cent.
    Feed(f64),
    /// Turns the spindle override knob.
    Spindle(f64),
}

/// A line of the table.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Shortcut {
    /// The real key, by its name in a browser: `Enter`, `F1`, `g`.
    pub real: &'static str,
    /// Alt is held down with it.
    pub alt: bool,
    /// Key or knob of the control that it stands for.
    pub press: Press,
}

/// Step of an override knob, % (inferred).
const STEP: f64 = 5.0;

const fn key(real: &'static str, key: Key) -> Shortcut {
    of(real, false, Press::Key(key))
}

const fn alt(real: &'static str, key: Key) -> Shortcut {
    of(real, true, Press::Key(key))
}

const fn machine(real: &'static str, name: &'static str) -> Shortcut {
    of(real, true, Press::Machine(name))
}

const fn of(real: &'static str, alt: bool, press: Press) -> Shortcut {
    Shortcut { real, alt, press }
}

/// The short cuts, beside letters and digits, which are themselves. Every key of the control has one.
pub const SHORTCUTS: &[Shortcut] = &[
    key("F1", Key::Sk1),
    key("F2", Key::Sk2),
    key("F3", Key::Sk3),
    key("F4", Key::Sk4),
    key("F5", Key::Sk5),
    key("F6", Key::Sk6),
    key("F7", Key::Sk7),
    key("F8", Key::Sk8),
    key("PageUp", Key::SkLeft),
    key("PageDown", Key::SkRight),
    key("Enter", Key::Ent),
    key("Insert", Key::NoEnt),
    key("End", Key::End),
    key("Escape", Key::Ce),
    key("Backspace", Key::Ce),
    key("Delete", Key::Del),
    key("ArrowUp", Key::Up),
    key("ArrowDown", Key::Down),
    key("ArrowLeft", Key::Left),
    key("ArrowRight", Key::Right),
    key(".", Key::Point),
    key(",", Key::Point),
    key("-", Key::Sign),
    key("+", Key::Sign),
    key("[", Key::Rl),
    key("]", Key::Rr),
    key("{", Key::RMinus),
    key("}", Key::RPlus),
    alt("1", Key::Manual),
    alt("2", Key::Handwheel),
    alt("3", Key::Mdi),
    alt("4", Key::Single),
    alt("5", Key::Full),
    alt("6", Key::Program),
    alt("7", Key::Test),
    alt("8", Key::Screen),
    alt("n", Key::PgmNr),
    alt("w", Key::ClPgm),
    alt("p", Key::PgmCall),
    alt("e", Key::Ext),
    alt("m", Key::Mod),
    alt("h", Key::Help),
    alt("g", Key::Goto),
    alt("z", Key::Cc),
    alt("x", Key::Cr),
    alt("y", Key::Ct),
    alt("r", Key::Rnd),
    alt("j", Key::Chf),
    alt("f", Key::ToolDef),
    alt("t", Key::ToolCall),
    alt("d", Key::CyclDef),
    alt("c", Key::CyclCall),
    alt("l", Key::LblSet),
    alt("k", Key::LblCall),
    alt("s", Key::Stop),
    alt("q", Key::TouchProbe),
    alt("v", Key::Graphics),
    alt("b", Key::BlkForm),
    alt("u", Key::Magn),
    alt("o", Key::Start),
    alt("i", Key::Iv),
    alt("a", Key::Capture),
    machine("Enter", "NC_START"),
    machine("Backspace", "NC_STOP"),
    machine("0", crate::EMERGENCY_STOP),
    machine("ArrowLeft", "X-"),
    machine("ArrowRight", "X+"),
    machine("ArrowDown", "Y-"),
    machine("ArrowUp", "Y+"),
    machine("PageDown", "Z-"),
    machine("PageUp", "Z+"),
    machine("Delete", "IV-"),
    machine("Insert", "IV+"),
    of("-", true, Press::Feed(-STEP)),
    of("+", true, Press::Feed(STEP)),
    of(",", true, Press::Spindle(-STEP)),
    of(".", true, Press::Spindle(STEP)),
];

/// What a real key does, alone or with Alt.
///
/// ```
/// use bahn_panel::{Key, Press, shortcut};
///
/// assert_eq!(shortcut("Enter", false), Some(Press::Key(Key::Ent)));
/// assert_eq!(shortcut("Enter", true), Some(Press::Machine("NC_START")));
/// assert_eq!(shortcut("x", false), Some(Press::Key(Key::X)));
/// assert_eq!(shortcut("F11", false), None);
/// ```
pub fn shortcut(real: &str, alt: bool) -> Option<Press> {
    let known = SHORTCUTS
        .iter()
        .find(|shortcut| shortcut.alt == alt && shortcut.real.eq_ignore_ascii_case(real));
    if let Some(shortcut) = known {
        return Some(shortcut.press);
    }
    let mut characters = real.chars();
    match (characters.next(), characters.next()) {
        (Some(character), None) if !alt && character.is_ascii_alphanumeric() => {
            Key::of_character(character).map(Press::Key)
        }
        _ => None,
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::collections::HashSet;

    #[test]
    fn every_key_can_be_pressed_and_no_real_key_means_two_things() {
        let mut reached: HashSet<Key> = ('A'..='Z')
            .chain('0'..='9')
            .filter_map(|character| match shortcut(&character.to_string(), false) {
                Some(Press::Key(key)) => Some(key),
                _ => None,
            })
            .collect();
        assert_eq!(reached.len(), 36);
        let mut real = HashSet::new();
        for line in SHORTCUTS {
            assert!(real.insert((line.real, line.alt)), "{line:?}");
            assert_eq!(shortcut(line.real, line.alt), Some(line.press));
            if let Press::Key(key) = line.press {
                reached.insert(key);
            }
        }
        let missing: Vec<_> = Key::ALL.iter().filter(|key| !reached.contains(key)).collect();
        assert!(missing.is_empty(), "{missing:?}");
    }
}
