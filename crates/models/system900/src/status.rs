//! The four status bytes of a parameter [002:232-370].

use std::fmt;
use std::str::FromStr;

use serde::Serialize;

use crate::name::repeated;

/// Bits of the status byte 4 for decimals.
const DECIMALS: u8 = 0b1111;

/// The bit of the status byte 1 for lengths.
const LENGTH: u8 = 1 << 4;

/// Parameter locks that a status names.
pub const LOCKS: u8 = 4;

/// The status of a parameter. Bytes count from 1, bits from 0, as the manual does.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Status([u8; 4]);

/// It is no status.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
#[error("`{0}` is no status: $ and eight hexadecimal digits, as $30020401")]
pub struct NoStatus(String);

/// Who takes notice of a write.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize)]
pub struct Receivers {
    /// The interpolator takes the new value.
    pub interpolator: bool,
    /// The PLC gets it.
    pub plc: bool,
    /// The operating panel shows it, until the next starting routine.
    pub panel: bool,
    /// A routine of the control that the write runs.
    pub procedure: bool,
    /// The operating panel shows it at every write.
    pub panel_always: bool,
    /// The sample buffer records the write.
    pub sample: bool,
}

impl Status {
    /// Of a word whose highest byte is byte 4, as the editor shows it.
    pub fn from_word(word: u32) -> Status {
        Status(word.to_le_bytes())
    }

    fn bit(self, byte: usize, bit: u8) -> bool {
        let byte = byte.checked_sub(1).and_then(|index| self.0.get(index));
        byte.is_some_and(|byte| byte >> bit & 1 != 0)
    }

    /// Holds a value; else it is cleared [002:261-262].
    pub fn is_loaded(self) -> bool {
        self.bit(1, 0)
    }

    /// A write in AUTO takes effect when its block is executed, not in the look-ahead [002:268-273].
    pub fn is_real_time(self) -> bool {
        self.bit(1, 2)
    }

    /// A write stops the look-ahead at the end of its block until it is executed [002:275-280].
    pub fn synchronises(self) -> bool {
        self.bit(1, 3)
    }

    /// Is a length that follows the unit [002:282-290].
    pub fn is_length(self) -> bool {
        self.bit(1, 4)
    }

    /// Goes over the fast channel of the system, of which nobody else sees anything [002:294-296].
    pub fn is_fast(self) -> bool {
        self.bit(1, 7)
    }

    /// Who takes notice of a write [002:314-335].
    pub fn receivers(self) -> Receivers {
        Receivers {
            interpolator: self.bit(2, 0),
            plc: self.bit(2, 1),
            panel: self.bit(2, 2),
            procedure: self.bit(2, 3),
            panel_always: self.bit(2, 6),
            sample: self.bit(2, 7),
        }
    }

    /// The parameter locks, from 1 on, that hold entries back while they are set [002:340-347].
    pub fn locks(self) -> impl Iterator<Item = u8> {
        (1..=LOCKS).filter(move |lock| self.bit(3, lock - 1))
    }

    /// Decimal places that are shown [002:364].
    pub fn decimals(self) -> u8 {
        let [.., format] = self.0;
        format & DECIMALS
    }

    /// Is shown in hexadecimal notation [002:366-367].
    pub fn is_hexadecimal(self) -> bool {
        self.bit(4, 4)
    }

    /// Is kept in the FLASH memory [002:369-370].
    pub fn is_stored(self) -> bool {
        self.bit(4, 5)
    }

    pub(crate) fn loaded(self, loaded: bool) -> Status {
        let [first, rest @ ..] = self.0;
        let [second, third, fourth] = rest;
        Status([first & !1 | u8::from(loaded), second, third, fourth])
    }

    /// As the starting routine leaves it: the bit for the operating panel is reset [002:318-321].
    pub(crate) fn started(self) -> Status {
        let [first, second, third, fourth] = self.0;
        Status([first, second & !0b100, third, fourth])
    }

    /// With or without the inch bit.
    pub(crate) fn with_length(self, is_length: bool) -> Status {
        let [first, rest @ ..] = self.0;
        let [second, third, fourth] = rest;
        Status([
            first & !LENGTH | if is_length { LENGTH } else { 0 },
            second,
            third,
            fourth,
        ])
    }

    pub(crate) fn with_decimals(self, decimals: u8) -> Status {
        let [first, second, third, format] = self.0;
        Status([first, second, third, format & !DECIMALS | decimals.min(DECIMALS)])
    }
}

/// As the editor shows it: `$30020401`.
impl fmt::Display for Status {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "${:08X}", u32::from_le_bytes(self.0))
    }
}

impl Serialize for Status {
    fn serialize<S: serde::Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        serializer.collect_str(self)
    }
}

impl FromStr for Status {
    type Err = NoStatus;

    fn from_str(text: &str) -> Result<Status, NoStatus> {
        let digits = text.trim().strip_prefix('$');
        let digits = digits.filter(|digits| digits.len() == 8);
        let digits = digits.filter(|digits| digits.bytes().all(|digit| digit.is_ascii_hexdigit()));
        let word = digits.and_then(|digits| u32::from_str_radix(digits, 16).ok());
        word.map(Status::from_word)
            .ok_or_else(|| NoStatus(repeated(text.trim())))
    }
}
