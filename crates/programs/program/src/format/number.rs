//! Numbers in listings: the shortest decimal that reads back as the same value, never with an exponent.

use crate::Value;

/// Most decimals that the fast way tries; part programs have up to four, angles and factors up to six.
const MAX_DECIMALS: u32 = 6;
/// Integers below 2^53 are exact in an `f64`.
const MAX_EXACT_INTEGER: f64 = 9_007_199_254_740_992.0;

/// Writes a value with its sign, also `+`.
pub(crate) fn push_signed(text: &mut String, value: Value, comma: bool) {
    match value {
        Value::Number(number) => {
            if number >= 0.0 {
                text.push('+');
            }
            push_number(text, number, comma);
        }
        Value::Q { number, negative } => {
            text.push(if negative { '-' } else { '+' });
            push_parameter(text, number);
        }
    }
}

/// Writes a value with `-` only.
pub(crate) fn push_unsigned(text: &mut String, value: Value, comma: bool) {
    match value {
        Value::Number(number) => push_number(text, number, comma),
        Value::Q { number, negative } => {
            if negative {
                text.push('-');
            }
            push_parameter(text, number);
        }
    }
}

fn push_parameter(text: &mut String, number: u16) {
    text.push('Q');
    push_integer(text, u64::from(number), 1);
}

/// Writes an integer with at least so many digits.
pub(crate) fn push_integer(text: &mut String, mut integer: u64, min_digits: u32) {
    let mut digits = [b'0'; 20];
    let mut count = 0;
    for digit in digits.iter_mut().rev() {
        if integer == 0 && count >= min_digits {
            break;
        }
        *digit = b'0' + (integer % 10) as u8;
        integer /= 10;
        count += 1;
    }
    let written = digits.get(digits.len() - count as usize..).unwrap_or_default();
    text.extend(written.iter().map(|&digit| char::from(digit)));
}

fn push_number(text: &mut String, number: f64, comma: bool) {
    let Some((integer, decimals)) = scaled(number.abs()) else {
        let written = format!("{number}");
        text.push_str(&if comma { written.replace('.', ",") } else { written });
        return;
    };
    if number < 0.0 {
        text.push('-');
    }
    let unit = 10_u64.pow(decimals);
    push_integer(text, integer / unit, 1);
    if decimals > 0 {
        text.push(if comma { ',' } else { '.' });
        push_integer(text, integer % unit, decimals);
    }
}

/// The number as an integer of the fewest decimals that give it exactly, if a few do. Up to 15 digits there
/// is only one such decimal, so it is the shortest.
fn scaled(magnitude: f64) -> Option<(u64, u32)> {
    let mut power = 1.0;
    for decimals in 0..=MAX_DECIMALS {
        let integer = (magnitude * power).round();
        if integer >= MAX_EXACT_INTEGER {
            return None;
        }
        if integer / power == magnitude {
            return Some((integer as u64, decimals));
        }
        power *= 10.0;
    }
    None
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    fn signed(number: f64) -> String {
        let mut text = String::new();
        push_signed(&mut text, Value::Number(number), false);
        text
    }

    #[test]
    fn numbers_are_minimal_and_signed() {
        for (number, text) in [
            (0.0, "+0"),
            (-0.0, "+0"),
            (5.0, "+5"),
            (-10.5, "-10.5"),
            (0.05, "+0.05"),
            (100.001, "+100.001"),
            (0.000001, "+0.000001"),
            (0.0000001, "+0.0000001"),
            (1e15, "+1000000000000000"),
            (1.0 / 3.0, "+0.3333333333333333"),
        ] {
            assert_eq!(signed(number), text);
        }
        let mut text = String::new();
        push_unsigned(&mut text, Value::Number(-1.0 / 3.0), true);
        push_unsigned(&mut text, Value::Number(2.5), true);
        push_unsigned(
            &mut text,
            Value::Q {
                number: 5,
                negative: true,
            },
            true,
        );
        assert_eq!(text, "-0,33333333333333332,5-Q5");
    }

    proptest! {
        #[test]
        fn the_fast_way_is_the_shortest_decimal(n in -1_000_000_000_i64..1_000_000_000, decimals in 0..8) {
            let number = n as f64 / 10_f64.powi(decimals);
            let mut text = String::new();
            push_number(&mut text, number, false);
            prop_assert_eq!(text, format!("{}", number));
        }
    }
}
