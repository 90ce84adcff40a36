//! A number that is being typed.

use bahn_dialogue::Key;

/// Digits, point and sign in the order in which they were typed.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub(crate) struct Entry {
    text: String,
    negative: bool,
}

/// Digits that an entry holds at most.
const DIGITS: usize = 12;

impl Entry {
    /// A number as if it had been typed, without zeros that say nothing.
    pub fn of(value: f64) -> Entry {
        let text = format!("{:.4}", value.abs());
        let text = text.trim_end_matches('0').trim_end_matches('.').to_owned();
        Entry {
            negative: value < 0.0 && text != "0",
            text,
        }
    }

    /// Takes a digit, the point, the sign or CE, which clears it; `false` for any other key and what does not fit.
    pub fn key(&mut self, key: Key) -> bool {
        match key {
            Key::Sign => self.negative = !self.negative,
            Key::Ce if !self.is_empty() => *self = Entry::default(),
            Key::Point if !self.text.contains('.') => self.text.push('.'),
            _ => match key.digit() {
                Some(digit) if self.text.len() < DIGITS => self.text.push(char::from(b'0' + digit)),
                _ => return false,
            },
        }
        true
    }

    /// No digit and no sign was typed.
    pub fn is_empty(&self) -> bool {
        self.text.is_empty() && !self.negative
    }

    /// What stands in the dialogue line.
    pub fn text(&self) -> String {
        match self.negative {
            true => format!("-{}", self.text),
            false => self.text.clone(),
        }
    }

    /// The number; `None` while there is none.
    pub fn value(&self) -> Option<f64> {
        let value: f64 = self.text.parse().ok()?;
        Some(if self.negative { -value } else { value })
    }

    /// A whole number that is not negative.
    pub fn whole(&self) -> Option<u32> {
        if self.negative {
            None
        } else {
            self.text.parse().ok()
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn typed(keys: &[&str]) -> Entry {
        let mut entry = Entry::default();
        for key in keys {
            assert!(Key::from_name(key).is_some_and(|key| entry.key(key)), "{key}");
        }
        entry
    }

    #[test]
    fn a_number_is_typed_with_its_sign_anywhere() {
        assert_eq!(typed(&["1", "2", "POINT", "5", "SIGN"]).value(), Some(-12.5));
        assert_eq!(typed(&["SIGN", "1", "SIGN"]).value(), Some(1.0));
        assert_eq!(typed(&["7", "0"]).whole(), Some(70));
        assert_eq!(typed(&["7", "CE", "1"]).value(), Some(1.0));
        assert_eq!(Entry::default().value(), None);
        let shown = |value| Entry::of(value).text();
        assert_eq!(
            [shown(-12.5), shown(200.0), shown(-0.000_01)],
            ["-12.5", "200", "0"]
        );
        assert!(!Entry::default().key(Key::Ce));
        let mut two_points = typed(&["1", "POINT"]);
        assert!(!two_points.key(Key::Point));
    }
}
