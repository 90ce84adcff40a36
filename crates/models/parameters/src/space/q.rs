//! System parameters q and channel parameters P of a System 900 [002:12-210].
//!
//! The q parameters are one array. The P parameters of a channel are places in it, which the channel's descriptor gives:
//! the same P of two channels mostly is another q.

use std::fmt;

use super::{Content, ParameterSpace};

/// The least number of system parameters, q3 [002:384-385].
pub const PARAMETERS_MIN: usize = 30_000;
/// The greatest number: the introduction counts up to 50000 [002:3].
const PARAMETERS_MAX: usize = 50_000;
/// Channels, each with a descriptor from q100, q200, ... on [002:629-661].
const CHANNELS: u8 = 8;
/// Axes of a channel, and physical ones [002:718-825].
const AXES: u32 = 32;
/// Parameters of an axis [002:68-111].
const AXIS_BLOCK: u32 = 200;
/// Words of the status byte 4 for decimals.
const DECIMALS: u8 = 0b1111;

/// The name of a parameter: `q102`, or `2:P7000` for P7000 of channel 2; `P7000` alone is of channel 1.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub enum QName {
    /// System parameter: its number.
    Q(u32),
    /// Channel parameter: channel from 1 on, number.
    P(u8, u32),
}

impl fmt::Display for QName {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            QName::Q(number) => write!(f, "q{number}"),
            QName::P(channel, number) => write!(f, "{channel}:P{number}"),
        }
    }
}

/// Why a name or an entry is refused.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum QError {
    /// It is no name of a parameter.
    #[error("`{0}` is no parameter: q102, P7000, 2:P7000")]
    NoName(String),
    /// The array or the descriptor of the channel has no place for it.
    #[error("{0} is no parameter of this system")]
    Unknown(QName),
    /// The value is no number, `$` number or `--`.
    #[error("{0}: `{1}` is no number")]
    NotANumber(QName, String),
    /// The value has more than four bytes.
    #[error("{0}: {1} does not go into four bytes")]
    TooGreat(QName, String),
    /// A parameter lock that is set locks it.
    #[error("{0} is locked by parameter lock {1}")]
    Locked(QName, u8),
}

/// The four status bytes of a parameter [002:253-370].
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct QStatus(pub [u8; 4]);

impl QStatus {
    /// As the editor shows it, byte 4 first: `$30020401`.
    pub fn from_word(word: u32) -> QStatus {
        QStatus(word.to_le_bytes())
    }

    /// Bit of a byte, counted as the manual does: bytes from 1, bits from 0.
    fn bit(self, byte: usize, bit: u8) -> bool {
        let byte = byte.checked_sub(1).and_then(|index| self.0.get(index));
        byte.is_some_and(|byte| byte >> bit & 1 != 0)
    }

    /// Holds a value; else it is cleared [002:261-262].
    pub fn is_loaded(self) -> bool {
        self.bit(1, 0)
    }

    /// A write in AUTO takes effect when the block is executed, not in the look-ahead [002:268-273].
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

    /// Who is told of a write [002:314-335].
    pub fn receivers(self) -> Receivers {
        Receivers {
            interpolator: self.bit(2, 0),
            plc: self.bit(2, 1),
            panel: self.bit(2, 2) || self.bit(2, 6),
            procedure: self.bit(2, 3),
            sample: self.bit(2, 7),
        }
    }

    /// The first parameter lock, 1 to 4, that locks it while it is set [002:340-347].
    pub fn lock(self, set: [bool; 4]) -> Option<u8> {
        (0u8..4)
            .zip(set)
            .find(|(lock, is_set)| *is_set && self.bit(3, *lock))
            .map(|(lock, _)| lock + 1)
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

    /// Is kept without power [002:369-370].
    pub fn is_stored(self) -> bool {
        self.bit(4, 5)
    }

    fn set_loaded(&mut self, loaded: bool) {
        let [first, ..] = &mut self.0;
        *first = *first & !1 | u8::from(loaded);
    }
}

/// Who is told of a write.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Receivers {
    /// The interpolator takes the new value.
    pub interpolator: bool,
    /// The PLC is told.
    pub plc: bool,
    /// The operating panel shows the new value.
    pub panel: bool,
    /// A routine of the control that the write runs.
    pub procedure: bool,
    /// The sample buffer records the write.
    pub sample: bool,
}

/// The parameters of a System 900: four bytes and four status bytes each.
#[derive(Clone, Debug, PartialEq)]
pub struct QParameters {
    values: Vec<i32>,
    status: Vec<QStatus>,
    locks: [bool; 4],
}

impl QParameters {
    /// So many cleared system parameters, the number of q3. `None` for less than [`PARAMETERS_MIN`] or more than 50000.
    pub fn new(count: usize) -> Option<QParameters> {
        (PARAMETERS_MIN..=PARAMETERS_MAX)
            .contains(&count)
            .then(|| QParameters {
                values: vec![0; count],
                status: vec![QStatus::default(); count],
                locks: [false; 4],
            })
    }

    /// The system parameter that a name means now. Descriptors are parameters, too: a change moves the places of a
    /// channel.
    ///
    /// # Errors
    /// [`QError::Unknown`] when there is none.
    pub fn place(&self, name: QName) -> Result<usize, QError> {
        let place = match name {
            QName::Q(number) => Some(number),
            QName::P(channel, number) => self.place_of_channel(channel, number),
        };
        place
            .and_then(|place| usize::try_from(place).ok())
            .filter(|place| *place < self.values.len())
            .ok_or(QError::Unknown(name))
    }

    /// [002:671-715] [002:61-111]; numbers between the blocks are nobody's.
    fn place_of_channel(&self, channel: u8, number: u32) -> Option<u32> {
        if !(1..=CHANNELS).contains(&channel) {
            return None;
        }
        let descriptor = 100 * u32::from(channel);
        let entry = |offset: u32| {
            self.word(descriptor + offset)
                .and_then(|word| u32::try_from(word).ok())
        };
        let block = |begin: u32, count: u32, first: u32| {
            let offset = number - first;
            (offset < entry(count)?).then_some(entry(begin)?.checked_add(offset)?)
        };
        match number {
            0..=6999 => block(2, 3, 0),
            7000..=9999 => entry(2)?.checked_add(entry(3)?)?.checked_add(number - 7000),
            11_000..=11_999 => Some(number - 10_000),
            12_000..=18_399 => {
                let (logical, offset) = ((number - 12_000) / AXIS_BLOCK, (number - 12_000) % AXIS_BLOCK);
                let [_, _, physical, _] = self.word(descriptor + 10 + logical)?.to_le_bytes();
                let physical = u32::from(physical);
                (1..=AXES)
                    .contains(&physical)
                    .then(|| 2000 + AXIS_BLOCK * (physical - 1) + offset)
            }
            20_000..=29_999 => block(4, 5, 20_000),
            30_000..=39_999 => block(6, 7, 30_000),
            _ => None,
        }
    }

    /// What a system parameter holds; `None` when it is cleared or not there.
    fn word(&self, number: u32) -> Option<i32> {
        let place = usize::try_from(number).ok()?;
        self.status.get(place).filter(|status| status.is_loaded())?;
        self.values.get(place).copied()
    }

    /// The status of a parameter.
    ///
    /// # Errors
    /// [`QError::Unknown`] when there is none.
    pub fn status(&self, name: QName) -> Result<QStatus, QError> {
        let place = self.place(name)?;
        Ok(self.status.get(place).copied().unwrap_or_default())
    }

    /// Sets the status; a lock does not hold it back [002:358-362]. Whether it is loaded follows from its content.
    ///
    /// # Errors
    /// [`QError::Unknown`] when there is no such parameter.
    pub fn set_status(&mut self, name: QName, status: QStatus) -> Result<(), QError> {
        let place = self.place(name)?;
        if let Some(slot) = self.status.get_mut(place) {
            let loaded = slot.is_loaded();
            *slot = status;
            slot.set_loaded(loaded);
        }
        Ok(())
    }

    /// Sets or resets a parameter lock, 1 to 4; others are none.
    pub fn set_lock(&mut self, lock: u8, set: bool) {
        let index = usize::from(lock).checked_sub(1);
        if let Some(slot) = index.and_then(|index| self.locks.get_mut(index)) {
            *slot = set;
        }
    }

    /// Writes a value, or clears with `None`, past all locks, as the PLC may [002:358-362]; who is told of it.
    ///
    /// # Errors
    /// [`QError::Unknown`] when there is no such parameter.
    pub fn write(&mut self, name: QName, value: Option<i32>) -> Result<Receivers, QError> {
        let place = self.place(name)?;
        if let (Some(slot), Some(status)) = (self.values.get_mut(place), self.status.get_mut(place)) {
            *slot = value.unwrap_or(0);
            status.set_loaded(value.is_some());
        }
        Ok(self.status.get(place).copied().unwrap_or_default().receivers())
    }

    /// What a parameter counts as it is shown: its decimals are after the point.
    fn scale(status: QStatus) -> f64 {
        10f64.powi(status.decimals().into())
    }

    fn read(&self, name: QName, text: &str) -> Result<Option<i32>, QError> {
        let text = text.trim();
        if text == "--" {
            return Ok(None);
        }
        let no_number = || QError::NotANumber(name, text.to_owned());
        let too_great = || QError::TooGreat(name, text.to_owned());
        if let Some(digits) = text.strip_prefix('$') {
            if digits.is_empty() || !digits.chars().all(|digit| digit.is_ascii_hexdigit()) {
                return Err(no_number());
            }
            // Eight digits are the bits, whatever sign they are.
            let bits = u32::from_str_radix(digits, 16).map_err(|_| too_great())?;
            return Ok(Some(i32::from_le_bytes(bits.to_le_bytes())));
        }
        let is_decimal = |text: &str| {
            text.chars()
                .all(|c| c.is_ascii_digit() || matches!(c, '+' | '-' | '.'))
        };
        let number: f64 = Some(text)
            .filter(|text| is_decimal(text))
            .and_then(|text| text.parse().ok())
            .ok_or_else(no_number)?;
        let counted = (number * QParameters::scale(self.status(name)?)).round();
        if !(f64::from(i32::MIN)..=f64::from(i32::MAX)).contains(&counted) {
            return Err(too_great());
        }
        Ok(Some(counted as i32))
    }
}

impl ParameterSpace for QParameters {
    type Name = QName;
    type Error = QError;

    fn name(&self, text: &str) -> Result<QName, QError> {
        let no_name = || QError::NoName(text.to_owned());
        let digits = |digits: &str| {
            let all = !digits.is_empty() && digits.chars().all(|digit| digit.is_ascii_digit());
            all.then(|| digits.parse::<u32>().ok())
                .flatten()
                .ok_or_else(no_name)
        };
        let name = match text.trim().split_once(['P', 'p']) {
            Some(("", number)) => QName::P(1, digits(number)?),
            Some((channel, number)) => {
                let channel = channel
                    .trim_start_matches(['K', 'k'])
                    .strip_suffix(':')
                    .ok_or_else(no_name)?;
                QName::P(
                    digits(channel)?.try_into().map_err(|_| no_name())?,
                    digits(number)?,
                )
            }
            None => {
                let number = text.trim().strip_prefix(['q', 'Q']).ok_or_else(no_name)?;
                QName::Q(digits(number.trim())?)
            }
        };
        self.place(name).map(|_| name)
    }

    /// The system parameters; the others are places in them.
    fn names(&self) -> impl Iterator<Item = QName> {
        (0u32..).zip(&self.values).map(|(number, _)| QName::Q(number))
    }

    fn content(&self, name: QName) -> Result<Content, QError> {
        let status = self.status(name)?;
        let value = self.values.get(self.place(name)?).copied().unwrap_or_default();
        Ok(match status.is_loaded() {
            true => Content::Number(f64::from(value) / QParameters::scale(status)),
            false => Content::Cleared,
        })
    }

    fn written(&self, name: QName) -> Result<String, QError> {
        let status = self.status(name)?;
        let value = self.values.get(self.place(name)?).copied().unwrap_or_default();
        Ok(match self.content(name)? {
            Content::Cleared => "--".to_owned(),
            Content::Number(_) if status.is_hexadecimal() => format!("${value:X}"),
            Content::Number(number) => format!("{number:.*}", usize::from(status.decimals())),
        })
    }

    fn enter(&mut self, name: QName, value: &str) -> Result<(), QError> {
        let value = self.read(name, value)?;
        if let Some(lock) = self.status(name)?.lock(self.locks) {
            return Err(QError::Locked(name, lock));
        }
        self.write(name, value).map(|_| ())
    }
}
