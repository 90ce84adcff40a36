//! The name of a machine parameter.

use std::fmt;

use crate::ControlModel;

/// The name of a machine parameter: `MP1010.0`, `MP7410`, or `MP0` on a TNC 151.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub struct ParameterId {
    /// The number after `MP`: 10 to 7690, on a TNC 151/155 0 to 263.
    pub number: u16,
    /// The index after the point; a parameter with one value only has none.
    pub index: Option<u8>,
}

impl ParameterId {
    /// Whether it says which axes a machine has, or what they are called: MP10 and MP410 [000:3174-3182, 3350-3370],
    /// MP72 and MP90 of the TNC 151/155 [001:1388-1390].
    pub fn says_axes(self, model: ControlModel) -> bool {
        match model.family() {
            ControlModel::Tnc151 | ControlModel::Tnc155 => matches!(self.number, 72 | 90),
            _ => matches!(self.number, 10 | 410),
        }
    }
}

impl fmt::Display for ParameterId {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "MP{}", self.number)?;
        self.index.map_or(Ok(()), |index| write!(f, ".{index}"))
    }
}

/// Reads `1010.0`, `MP7410` or `mp 7410`.
pub(crate) fn parse_id(text: &str) -> Option<ParameterId> {
    let digits = match text.get(..2) {
        Some(prefix) if prefix.eq_ignore_ascii_case("MP") => text[2..].trim_start(),
        _ => text,
    };
    let only_digits = |text: &str| !text.is_empty() && text.bytes().all(|byte| byte.is_ascii_digit());
    let (number, index) = match digits.split_once('.') {
        Some((number, index)) => (number, Some(index)),
        None => (digits, None),
    };
    if !only_digits(number) || !index.is_none_or(only_digits) {
        return None;
    }
    let index = match index {
        Some(index) => Some(index.parse().ok()?),
        None => None,
    };
    Some(ParameterId {
        number: number.parse().ok()?,
        index,
    })
}
