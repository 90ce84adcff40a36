//! What is sent to the browser for each key.

/// A key as the protocol wants it.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(crate) struct Key {
    /// `KeyboardEvent.key`, such as `a` or `Enter`.
    pub key: String,
    /// `KeyboardEvent.code`: where it is on the keyboard.
    pub code: String,
    /// The old number of the key.
    pub number: u32,
    /// What it types; empty for keys that type nothing.
    pub text: String,
}

/// Keys that have a name: name, number, what they type.
const NAMED: [(&str, u32, &str); 31] = [
    ("Backspace", 8, ""),
    ("Tab", 9, ""),
    ("Enter", 13, "\r"),
    ("Shift", 16, ""),
    ("Control", 17, ""),
    ("Alt", 18, ""),
    ("Escape", 27, ""),
    ("PageUp", 33, ""),
    ("PageDown", 34, ""),
    ("End", 35, ""),
    ("Home", 36, ""),
    ("ArrowLeft", 37, ""),
    ("ArrowUp", 38, ""),
    ("ArrowRight", 39, ""),
    ("ArrowDown", 40, ""),
    ("Insert", 45, ""),
    ("Delete", 46, ""),
    ("Meta", 91, ""),
    ("ContextMenu", 93, ""),
    ("F1", 112, ""),
    ("F2", 113, ""),
    ("F3", 114, ""),
    ("F4", 115, ""),
    ("F5", 116, ""),
    ("F6", 117, ""),
    ("F7", 118, ""),
    ("F8", 119, ""),
    ("F9", 120, ""),
    ("F10", 121, ""),
    ("F11", 122, ""),
    ("F12", 123, ""),
];

/// Signs with their key on a keyboard of the United States: sign, code, number.
const SIGNS: [(char, &str, u32); 12] = [
    (' ', "Space", 32),
    (',', "Comma", 188),
    ('.', "Period", 190),
    ('/', "Slash", 191),
    ('-', "Minus", 189),
    ('+', "Equal", 187),
    ('=', "Equal", 187),
    (';', "Semicolon", 186),
    ('\'', "Quote", 222),
    ('[', "BracketLeft", 219),
    (']', "BracketRight", 221),
    ('?', "Slash", 191),
];

impl Key {
    /// A key by its name in the browser, or the one that types a character.
    pub fn named(name: &str) -> Key {
        if let Some((name, number, text)) = NAMED.iter().find(|(known, ..)| *known == name) {
            return Key {
                key: (*name).to_owned(),
                code: match *name {
                    "Shift" | "Control" | "Alt" | "Meta" => format!("{name}Left"),
                    name => name.to_owned(),
                },
                number: *number,
                text: (*text).to_owned(),
            };
        }
        let typed = name.chars().next().unwrap_or(' ');
        let upper = typed.to_ascii_uppercase();
        let (code, number) = match upper {
            'A'..='Z' => (format!("Key{upper}"), u32::from(upper)),
            '0'..='9' => (format!("Digit{upper}"), u32::from(upper)),
            _ => SIGNS
                .iter()
                .find(|(sign, ..)| *sign == typed)
                .map_or((String::new(), 0), |(_, code, number)| {
                    ((*code).to_owned(), *number)
                }),
        };
        Key {
            key: name.to_owned(),
            code,
            number,
            text: name.to_owned(),
        }
    }

    /// What a key held down adds to others.
    pub fn modifier(&self) -> u32 {
        match self.key.as_str() {
            "Alt" => 1,
            "Control" => 2,
            "Meta" => 4,
            "Shift" => 8,
            _ => 0,
        }
    }
}

#[cfg(test)]
mod tests {
    use super::Key;

    #[test]
    fn keys_are_those_of_a_keyboard() {
        let seen = |name: &str| {
            let key = Key::named(name);
            (key.code, key.number, key.text)
        };
        assert_eq!(seen("Enter"), ("Enter".into(), 13, "\r".into()));
        assert_eq!(seen("Shift"), ("ShiftLeft".into(), 16, String::new()));
        assert_eq!(seen("q"), ("KeyQ".into(), 81, "q".into()));
        assert_eq!(seen("7"), ("Digit7".into(), 55, "7".into()));
        assert_eq!(seen("+"), ("Equal".into(), 187, "+".into()));
        // What is on no keyboard is typed all the same.
        assert_eq!(seen("\u{e4}"), (String::new(), 0, "\u{e4}".into()));
    }
}
