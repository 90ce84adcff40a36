//! The call of a module: its parameters on the data stack, and what comes of it.

use bahn_exchange::{Image, Number, Size, signal};

use super::address;
use crate::run::{DataStack, Text};
use crate::{Nc, PlcError, TextFile};

/// How a call ended.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Outcome {
    /// The module did its work: M3171 becomes 0.
    Done,
    /// The module refused or failed: M3171 becomes 1.
    Failed,
    /// M3171 keeps its value.
    Untouched,
}

impl Outcome {
    /// Done, or failed where it is not.
    pub(super) fn of(done: bool) -> Outcome {
        if done { Outcome::Done } else { Outcome::Failed }
    }
}

/// A call of a module: what it may reach.
pub(crate) struct Call<'a> {
    pub(crate) image: &'a mut Image,
    pub(crate) stack: &'a mut DataStack,
    pub(crate) nc: &'a mut dyn Nc,
    /// Whether a submit job calls; many modules may be called from there only.
    pub(crate) from_submit: bool,
}

impl Call<'_> {
    /// Pulls the arguments; they are given in the order of the manual, in which the program pushed them.
    pub(super) fn arguments<const N: usize>(&mut self) -> Result<[i32; N], PlcError> {
        let mut arguments = [0; N];
        for argument in arguments.iter_mut().rev() {
            *argument = self.stack.pull()?;
        }
        Ok(arguments)
    }

    /// Pushes a result. With several, the one that the program pulls first is pushed last. A module that
    /// failed pushes its results all the same, so that the program's PL find something: 0 (inferred).
    pub(super) fn result(&mut self, value: i32) -> Result<(), PlcError> {
        self.stack.push(value)
    }

    /// Pushes the result of a module, 0 when it failed.
    pub(super) fn result_or_failed(&mut self, value: Option<i32>) -> Result<Outcome, PlcError> {
        self.result(value.unwrap_or(0))?;
        Ok(Outcome::of(value.is_some()))
    }

    /// Pushes an error code; 0 means done.
    pub(super) fn code(&mut self, code: i32) -> Result<Outcome, PlcError> {
        self.result(code)?;
        Ok(Outcome::of(code == 0))
    }

    /// Whether an NC program runs and no strobe is active: some modules work during the strobes only,
    /// once a program was started [000:14897][000:15556].
    pub(super) fn runs_without_strobe(&self) -> bool {
        const STROBES: [bahn_exchange::Bit; 6] = [
            signal::M_FUNCTION_STROBE,
            signal::GEAR_STROBE,
            signal::S_STROBE,
            signal::TOOL_CALL_STROBE,
            signal::TOOL_DEF_STROBE,
            signal::FN19_STROBE,
        ];
        self.nc.program_running() && !STROBES.iter().any(|strobe| self.image.bit(*strobe))
    }

    /// A machine parameter in force; 0 when the model does not have it (inferred).
    pub(super) fn parameter(&self, number: u16, index: u8) -> f64 {
        self.nc.parameters().get(number, index).unwrap_or(0.0)
    }

    /// A string with its end found; `None` for a wrong number and for a memory without end character.
    pub(super) fn text(&self, string: i32) -> Option<Text> {
        let string = usize::try_from(string).ok()?;
        self.image.string(string).contains(&0).then_some(())?;
        self.image.text(string).try_into().ok()
    }

    /// Stores a string; false for a wrong number and for a text of more than 127 characters.
    pub(super) fn set_text(&mut self, string: i32, text: &[u8]) -> bool {
        match string_number(string) {
            Some(string) if text.len() < bahn_exchange::STRING_LENGTH => {
                self.image.set_text(string, text);
                true
            }
            _ => false,
        }
    }

    /// A text as it is shown and sent: references to lines of the message and dialogue files are replaced.
    /// A line that the file does not have becomes `@` [000:14079-14084].
    pub(super) fn resolved(&self, text: &[u8]) -> Vec<u8> {
        let mut resolved = Vec::new();
        let mut rest = text;
        while let Some((&first, after)) = rest.split_first() {
            rest = after;
            match reference(first, after) {
                Some((file, line, length)) => {
                    let text = self.nc.text_line(file, line);
                    resolved.extend(text.unwrap_or_else(|| b"@".to_vec()));
                    rest = after.get(length..).unwrap_or_default();
                }
                None => resolved.push(first),
            }
        }
        resolved
    }

    /// Bytes of the word memory; `None` when they do not lie inside it, the first address does not, or they
    /// are more than a string has characters.
    pub(super) fn bytes(&self, first: i32, length: i32) -> Option<Text> {
        let inside = first < address::BYTES && address::fits(first, length, address::BYTES);
        let few = usize::try_from(length).is_ok_and(|length| length <= bahn_exchange::STRING_LENGTH);
        (inside && few).then_some(())?;
        let byte = |address| Some(self.image.number(address::operand(Size::Byte, address)?) as u8);
        (first..first + length).map(byte).collect()
    }

    /// Writes bytes into the word memory; false when there is no room, or the first address is outside.
    pub(super) fn set_bytes(&mut self, first: i32, bytes: &[u8]) -> bool {
        let length = i32::try_from(bytes.len()).unwrap_or(i32::MAX);
        if first >= address::BYTES || !address::fits(first, length, address::BYTES) {
            return false;
        }
        for (address, byte) in (first..).zip(bytes) {
            if let Some(number) = address::operand(Size::Byte, address) {
                self.image.set_number(number, i32::from(*byte));
            }
        }
        true
    }

    /// Writes doublewords one after the other; false when the first address is not divisible by 4 or
    /// there is no room for all.
    pub(super) fn set_doubles(&mut self, first: i32, values: &[i32]) -> bool {
        let length = i32::try_from(4 * values.len()).unwrap_or(i32::MAX);
        let fits = first < address::BYTES && address::fits(first, length, address::BYTES);
        if first % 4 != 0 || !fits {
            return false;
        }
        for (address, value) in (first..).step_by(4).zip(values) {
            if let Some(number) = self.double(address) {
                self.image.set_number(number, *value);
            }
        }
        true
    }

    /// A doubleword by its address.
    pub(super) fn double(&self, address: i32) -> Option<Number> {
        address::operand(Size::Double, address)
    }
}

/// The number of a string memory.
pub(super) fn string_number(string: i32) -> Option<usize> {
    usize::try_from(string)
        .ok()
        .filter(|string| *string < bahn_exchange::STRINGS)
}

/// The reference that begins here: file, line, and characters after its first one. Line numbers have
/// three digits, from 1000 on four; so four are taken unless the first one is 0 (inferred).
pub(super) fn reference(first: u8, after: &[u8]) -> Option<(TextFile, u16, usize)> {
    const SUBSTITUTE: u8 = 0x1a;
    let (SUBSTITUTE, [letter, digits @ ..]) = (first, after) else {
        return None;
    };
    let file = match letter {
        b'E' => TextFile::Messages,
        b'D' => TextFile::Dialogues,
        _ => return None,
    };
    let most = if digits.first() == Some(&b'0') { 3 } else { 4 };
    let count = digits
        .iter()
        .take(most)
        .take_while(|digit| digit.is_ascii_digit())
        .count();
    let line = std::str::from_utf8(digits.get(..count)?).ok()?.parse().ok()?;
    (count >= 3).then_some((file, line, count + 1))
}
