//! What a value means: reads the column of values and bits.

/// A possible value or bit of a parameter.
struct Choice<'a> {
    key: Key,
    text: &'a str,
}

#[derive(Clone, Copy, PartialEq)]
enum Key {
    /// `bit2 ..`: number of the bit, 0 for the rightmost.
    Bit(u32),
    /// `0=..`: the text stands for this value.
    Value(f64),
    /// `+4 ..`: the text stands for all values that contain this power of 2.
    Summand(u64),
}

/// What a value means by the items of the column: the value's own words, or those of its bits, one item each. Empty for a
/// quantity.
pub(crate) fn of_value(values: &str, value: f64) -> Vec<String> {
    let choices: Vec<Choice> = values.split(';').filter_map(choice).collect();
    let of_value = |wanted: f64| {
        let found = choices.iter().find(|choice| choice.key == Key::Value(wanted));
        found.map(|choice| choice.text)
    };
    let bits = value as u64;
    let mut meaning: Vec<String> = choices
        .iter()
        .filter_map(|choice| match choice.key {
            Key::Bit(bit) => Some(bit_meaning(choice.text, bits >> bit & 1 == 1, &of_value)),
            Key::Summand(summand) => (bits & summand == summand).then(|| choice.text.to_owned()),
            Key::Value(_) => None,
        })
        .collect();
    let has_bits = choices.iter().any(|choice| matches!(choice.key, Key::Bit(_)));
    let has_summands = choices.iter().any(|choice| matches!(choice.key, Key::Summand(_)));
    // Without the summands, what is left is a value of its own.
    let rest = choices.iter().fold(bits, |rest, choice| match choice.key {
        Key::Summand(summand) => rest & !summand,
        _ => rest,
    });
    let own = if has_summands {
        of_value(rest as f64)
    } else {
        of_value(value)
    };
    if let (false, Some(text)) = (has_bits, own) {
        meaning.insert(0, text.to_owned());
    }
    meaning
}

/// The items of the column of values and bits, as the list prints them.
pub(crate) fn items(values: &'static str) -> impl Iterator<Item = &'static str> {
    values.split(';').map(str::trim).filter(|item| !item.is_empty())
}

/// What a bit means: its name with `0=..` and `1=..` of its own or of the whole parameter.
fn bit_meaning<'a>(text: &'a str, set: bool, of_value: &impl Fn(f64) -> Option<&'a str>) -> String {
    let states = text
        .strip_prefix("0=")
        .map(|rest| ("", rest))
        .or_else(|| text.split_once(" 0="));
    let own = states.and_then(|(name, rest)| {
        let (zero, one) = rest.split_once(" 1=")?;
        Some((name, if set { one } else { zero }))
    });
    match own {
        Some(("", state)) => state.to_owned(),
        Some((name, state)) => format!("{name}: {state}"),
        // Of some bits only what they switch on has a name.
        None if text.starts_with("1=") => {
            let (name, state) = (text.trim_start_matches("1="), if set { "yes" } else { "no" });
            format!("{name}: {state}")
        }
        None => {
            let plain = if set { "1" } else { "0" };
            format!("{text}: {}", of_value(f64::from(u8::from(set))).unwrap_or(plain))
        }
    }
}

/// Reads `bit0 X axis`, `0=off`, `0 = off` or `+4 override`.
fn choice(item: &str) -> Option<Choice<'_>> {
    let item = item.trim();
    let item = item.strip_prefix("bit sum:").unwrap_or(item).trim_start();
    if let Some(rest) = item.strip_prefix("bit") {
        let (number, text) = rest.trim_start().split_once(' ')?;
        return Some(Choice {
            key: Key::Bit(number.parse().ok()?),
            text: text.trim(),
        });
    }
    if let Some(rest) = item.strip_prefix('+') {
        let (number, text) = rest.split_once(' ')?;
        return Some(Choice {
            key: Key::Summand(number.parse().ok()?),
            text: text.trim_start_matches(['=', ' ']).trim_end(),
        });
    }
    let (number, text) = item.split_once('=')?;
    Some(Choice {
        key: Key::Value(number.trim().parse().ok()?),
        text: text.trim(),
    })
}

#[cfg(test)]
mod tests {
    use crate::{ControlModel, Definition};

    fn meaning(model: ControlModel, number: u16, value: f64) -> Vec<String> {
        Definition::find(model, number, 0).unwrap().meaning(value)
    }

    #[test]
    fn values_bits_and_sums_are_said_in_words() {
        use ControlModel::{Tnc155, Tnc360, Tnc415b};
        assert_eq!(meaning(Tnc415b, 1390, 1.0), ["servo lag"]);
        assert_eq!(
            meaning(Tnc415b, 1040, 0b10.into()),
            [
                "X axis: positive",
                "Y axis: negative",
                "Z axis: positive",
                "4th axis: positive",
                "5th axis: positive"
            ]
        );
        assert_eq!(
            meaning(Tnc415b, 7690, 0b10.into()),
            ["RAM test: test", "EPROM test: no test"]
        );
        assert_eq!(meaning(Tnc415b, 7310, 0b0001.into())[0], "3-plane view: American");
        assert_eq!(
            meaning(Tnc360, 7440, 5.0),
            ["no program stop with M06", "no axis stop with M functions"]
        );
        assert_eq!(meaning(Tnc155, 92, 3.0), ["point", "English dialogue"]);
        assert_eq!(meaning(Tnc415b, 7420, 2.0)[1], "clear first then channel");
        assert_eq!(meaning(Tnc415b, 1010, 5000.0), [""; 0], "a quantity");
        assert_eq!(
            meaning(Tnc415b, 5020, 0b100.into())[2..4],
            ["stop by RTS: yes", "stop by DC3: no"]
        );
    }

    #[test]
    fn ranges_are_written_as_the_values_are() {
        let range = |number| {
            Definition::find(ControlModel::Tnc415b, number, 0)
                .unwrap()
                .range_text()
                .unwrap()
        };
        assert_eq!(range(1060), ["0.001", "5"]);
        assert_eq!(range(7440), ["%00000", "%11111"]);
        assert_eq!(range(7351), ["$0000000", "$03F3F3F"]);
    }
}
