//! Modules 9070 and 9071: strings [000:15200-15245].

use super::{Call, Outcome, string_number};
use crate::PlcError;
use crate::run::Text;

/// Longest number that 9070 copies [000:15213].
const NUMBER_MAX: usize = 79;

/// 9070: copies the first number of a string; the result is the offset of the character after it.
pub(super) fn copy_number(call: &mut Call<'_>) -> Result<Outcome, PlcError> {
    let [source, destination] = call.arguments()?;
    let found = call.text(source).and_then(|text| {
        let start = (0..text.len()).find(|start| text.get(*start..).and_then(number_length).is_some())?;
        let length = text.get(start..).and_then(number_length)?;
        let number = Text::try_from(text.get(start..start + length)?).ok()?;
        (length <= NUMBER_MAX).then_some((number, start + length))
    });
    let found = found.filter(|_| string_number(destination).is_some());
    if let Some((number, _)) = &found {
        call.set_text(destination, number);
    }
    call.result_or_failed(found.and_then(|(_, end)| i32::try_from(end).ok()))
}

/// 9071: the characters before the end character.
pub(super) fn length(call: &mut Call<'_>) -> Result<Outcome, PlcError> {
    let [source] = call.arguments()?;
    let length = call.text(source).and_then(|text| i32::try_from(text.len()).ok());
    call.result_or_failed(length)
}

/// Characters of the number at the start of a text: perhaps a sign, digits, perhaps comma or point with
/// digits. A number begins with a digit, and a comma that no digit follows is none of its places (inferred).
pub(super) fn number_length(text: &[u8]) -> Option<usize> {
    let digits = |from: usize| {
        let rest = text.get(from..).unwrap_or_default();
        rest.iter()
            .take_while(|character| character.is_ascii_digit())
            .count()
    };
    let sign = usize::from(matches!(text.first(), Some(b'+' | b'-')));
    let before = digits(sign);
    if before == 0 {
        return None;
    }
    let point = sign + before;
    let after = match text.get(point) {
        Some(b'.' | b',') => digits(point + 1),
        _ => 0,
    };
    Some(if after > 0 { point + 1 + after } else { point })
}
