//! The fixed markers and words by name.
//!
//! Names and meaning stand in `data/signals.tsv` [000:10534-10968]; the constants below are made from it,
//! so that code says [`M_FUNCTION_STROBE`] and not 2045. [`all`] lists them with who sets and resets them.

use crate::{Bit, BitArea, BitRange, ByteRange, Number, Size};

include!(concat!(env!("OUT_DIR"), "/signals.rs"));

/// What a signal occupies.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum SignalOperand {
    /// A single marker.
    Bit(Bit),
    /// One byte, word or doubleword.
    Number(Number),
    /// Markers that follow one another.
    Bits(BitRange),
    /// Bytes that follow one another.
    Bytes(ByteRange),
}

impl std::fmt::Display for SignalOperand {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        match self {
            SignalOperand::Bit(bit) => bit.fmt(f),
            SignalOperand::Number(number) => number.fmt(f),
            SignalOperand::Bits(range) => match (range.get(0), range.get(range.count().saturating_sub(1))) {
                (Some(first), Some(last)) => write!(f, "{first}-{last}"),
                _ => Ok(()),
            },
            SignalOperand::Bytes(range) => match (range.get(0), range.get(range.count().saturating_sub(1))) {
                (Some(first), Some(last)) => write!(f, "{first}-{last}"),
                _ => Ok(()),
            },
        }
    }
}

/// One row of the table. Texts are empty where the manual says nothing.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[non_exhaustive]
pub struct Signal {
    /// Its name, as `M_FUNCTION_STROBE`.
    pub name: &'static str,
    /// The markers or bytes that the signal occupies.
    pub operand: SignalOperand,
    /// The meaning of the signal.
    pub function: &'static str,
    /// Who sets it: `NC`, `PLC`, `NC;PLC`.
    pub set_by: &'static str,
    /// Who resets it: NC, PLC, or nobody.
    pub reset_by: &'static str,
    /// Its part in a handshake: strobe, acknowledgement, level, status.
    pub role: &'static str,
    /// Meaning of the values.
    pub values: &'static str,
    /// Whether it belongs to the marker interface of the TNC 355 [000:16206-16293].
    pub tnc355: bool,
    /// The words that replace it where it is there for the TNC 355 only.
    pub replaced_by: &'static str,
    /// Conditions under which it acts, and contradictions of the manual.
    pub notes: &'static str,
    /// Where the manual prints it, as `[000:10573]`.
    pub source: &'static str,
}

impl Signal {
    /// Whether the NC sets or reads it: markers that only the TNC 355 has are listed to be known [000:16442-16500].
    pub fn has_function(&self) -> bool {
        self.role != TNC_355_ONLY
    }
}

/// The role of a marker that the manual lists as not implemented.
const TNC_355_ONLY: &str = "TNC 355 only";

/// All signals: markers by number, then bytes and words by address.
pub fn all() -> &'static [Signal] {
    TABLE
}

/// The signal that an operand alone has.
pub fn named(operand: SignalOperand) -> Option<&'static Signal> {
    TABLE.iter().find(|signal| signal.operand == operand)
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::collections::HashSet;

    #[test]
    fn the_table_names_every_signal_once() {
        let mut names = HashSet::new();
        for signal in all() {
            assert!(names.insert(signal.name), "{} twice", signal.name);
            assert!(
                !signal.function.is_empty() && signal.source.starts_with('['),
                "{}",
                signal.name
            );
            let legal = match signal.operand {
                SignalOperand::Bit(bit) => bit.is_listed(),
                SignalOperand::Number(number) => Number::new(number.size(), number.address()).is_some(),
                SignalOperand::Bits(range) => range.iter().all(Bit::is_listed),
                SignalOperand::Bytes(range) => range
                    .get(range.count() - 1)
                    .is_some_and(|last| Number::new(Size::Byte, last.address()).is_some()),
            };
            assert!(legal, "{}", signal.name);
        }
        assert!(names.len() > 580, "{}", names.len());
    }

    #[test]
    fn names_stand_for_the_numbers_of_the_manual() {
        assert_eq!(M_FUNCTION_STROBE.to_string(), "M2045");
        assert_eq!(M_FUNCTION_ACK.to_string(), "M2482");
        assert_eq!(FN19_FIRST_VALUE.to_string(), "D280");
        assert_eq!(
            DECODED_M_FUNCTIONS.get(3).map(|bit| bit.to_string()).as_deref(),
            Some("M1903")
        );
        let strobe = named(SignalOperand::Bit(FN19_STROBE)).unwrap();
        assert_eq!(
            (strobe.set_by, strobe.reset_by, strobe.role),
            ("NC", "NC", "NC strobe")
        );
    }
}
