//! Synchronisation of a function: its type, a row of [`Synchronisation`] [004:54-57], and the bits that are OR-ed to it.
//!
//! `data/synch-types.tsv` has whose each of both may be, and its citation.
//!
//! Decision: `FAW_SYNCH` alone is `MOS` with it; `BWD_SYNCH` and `FWD_SYNCH` alone are an error, since they say when
//! a type counts (also `technology/src/channel/resolve.rs`)

use std::fmt;

use bahn_path::Synchronisation;

/// Name and value of each bit that is OR-ed to a type [004:51] [004:54] [004:207].
const BITS: [(&str, u32); 4] = [
    ("PLC_INFO", Synch::PLC_INFO),
    ("BWD_SYNCH", Synch::BACKWARD),
    ("FWD_SYNCH", Synch::FORWARD),
    ("FAW_SYNCH", Synch::FLUSH_AND_WAIT),
];

/// The name of what is no function; the manual prints it with two letters exchanged, too [004:204].
const NOT_VALID: [&str; 2] = ["NOT_VALID", "NOT_VAILD"];

/// A type and the bits with it.
///
/// ```
/// use bahn_path::Synchronisation;
/// use bahn_technology::Synch;
/// let synch = Synch::from_bits(0x0002_0004)?;
/// assert_eq!(synch.kind, Synchronisation::MvsSns);
/// assert!(synch.plc_info && !synch.backward);
/// assert_eq!(synch.to_string(), "PLC_INFO | MVS_SNS");
/// assert!(Synch::from_bits(0x6).is_err());
/// # Ok::<(), bahn_technology::SynchError>(())
/// ```
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub struct Synch {
    /// When the function is output, and who waits for its acknowledgement.
    pub kind: Synchronisation,
    /// `PLC_INFO`: M functions of an NC spindle go to the PLC, too, and are waited for [004:159].
    pub plc_info: bool,
    /// `BWD_SYNCH`: waited for as `MVS_SVS` while the path is run backward [004:54].
    pub backward: bool,
    /// `FWD_SYNCH`: waited for as its type says in simulated forward motion [004:54].
    pub forward: bool,
    /// `FAW_SYNCH`: decoding holds at the end of its block until the channel has run empty [004:54]; without a type the function
    /// is output all the same, and not waited for (inferred).
    pub flush_and_wait: bool,
}

/// Why a value is no synchronisation type.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[non_exhaustive]
pub enum SynchError {
    /// `NOT_VALID`, -1: not a function.
    NotValid,
    /// Bits that stand for nothing.
    UnknownBits(u32),
    /// `BWD_SYNCH` or `FWD_SYNCH` without a type: they say when a type counts [004:54] [004:207].
    NoType(&'static str),
    /// More than one type; a function has one (inferred).
    SeveralTypes(Synchronisation, Synchronisation),
}

impl fmt::Display for SynchError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            SynchError::NotValid => write!(f, "NOT_VALID is no synchronisation type"),
            SynchError::UnknownBits(bits) => write!(f, "no synchronisation type has the bits 0x{bits:08X}"),
            SynchError::NoType(bit) => {
                write!(
                    f,
                    "{bit} needs a type beside it, as MVS_SVS | {bit}: alone nothing is output"
                )
            }
            SynchError::SeveralTypes(a, b) => {
                write!(f, "two synchronisation types, {a} and {b}: a function has one")
            }
        }
    }
}

impl std::error::Error for SynchError {}

impl From<Synchronisation> for Synch {
    fn from(kind: Synchronisation) -> Synch {
        Synch {
            kind,
            ..Synch::default()
        }
    }
}

impl Synch {
    /// The bit `PLC_INFO`, found in `0x00020002` [004:51].
    pub const PLC_INFO: u32 = 0x0002_0000;
    /// The bit `BWD_SYNCH` [004:207].
    pub const BACKWARD: u32 = 0x0040_0000;
    /// The bit `FWD_SYNCH` [004:207].
    pub const FORWARD: u32 = 0x0080_0000;
    /// The bit `FAW_SYNCH` [004:207].
    pub const FLUSH_AND_WAIT: u32 = 0x1000_0000;

    /// The value of `NOT_VALID`, -1 as an unsigned number.
    pub const NOT_VALID: u32 = u32::MAX;

    /// What a number means, in a list as well as written to `V.G.M_FCT[n].SYNCH`.
    ///
    /// # Errors
    /// When it is no type, or more than one.
    pub fn from_bits(value: u32) -> Result<Synch, SynchError> {
        if value == Synch::NOT_VALID {
            return Err(SynchError::NotValid);
        }
        let known = |bits: u32, more: u32| bits | more;
        let flags = BITS.iter().map(|(_, bit)| *bit).fold(0, known);
        let all = Synchronisation::all()
            .map(Synchronisation::bits)
            .fold(flags, known);
        if value & !all != 0 {
            return Err(SynchError::UnknownBits(value & !all));
        }
        let mut kinds = Synchronisation::all().filter(|kind| value & kind.bits() != 0);
        let kind = kinds.next().unwrap_or_default();
        if let Some(second) = kinds.next() {
            return Err(SynchError::SeveralTypes(kind, second));
        }
        let direction = [("BWD_SYNCH", Synch::BACKWARD), ("FWD_SYNCH", Synch::FORWARD)];
        let of_direction = direction.iter().find(|(_, bit)| value & bit != 0);
        // PLC_INFO and FAW_SYNCH say themselves that the function is output.
        let is_output = value & (Synch::PLC_INFO | Synch::FLUSH_AND_WAIT) != 0;
        if let Some((bit, _)) = of_direction.filter(|_| kind == Synchronisation::NoSynch && !is_output) {
            return Err(SynchError::NoType(bit));
        }
        Ok(Synch {
            kind,
            plc_info: value & Synch::PLC_INFO != 0,
            backward: value & Synch::BACKWARD != 0,
            forward: value & Synch::FORWARD != 0,
            flush_and_wait: value & Synch::FLUSH_AND_WAIT != 0,
        })
    }

    /// The number that means it.
    pub fn bits(self) -> u32 {
        let bit = |is_set: bool, bit: u32| if is_set { bit } else { 0 };
        self.kind.bits()
            | bit(self.plc_info, Synch::PLC_INFO)
            | bit(self.backward, Synch::BACKWARD)
            | bit(self.forward, Synch::FORWARD)
            | bit(self.flush_and_wait, Synch::FLUSH_AND_WAIT)
    }

    /// The value of a constant, a type or a bit, without regard to case.
    pub fn constant(name: &str) -> Option<u32> {
        if NOT_VALID.iter().any(|known| known.eq_ignore_ascii_case(name)) {
            return Some(Synch::NOT_VALID);
        }
        let types = Synchronisation::all().map(|kind| (kind.name(), kind.bits()));
        types
            .chain(BITS)
            .find(|(known, _)| known.eq_ignore_ascii_case(name))
            .map(|(_, bits)| bits)
    }
}

/// As lists have it: `PLC_INFO | MVS_SVS`.
impl fmt::Display for Synch {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let bits = self.bits();
        let flag = |name: &str| BITS.iter().any(|(known, bit)| *known == name && bits & bit != 0);
        if flag("PLC_INFO") {
            write!(f, "PLC_INFO | ")?;
        }
        write!(f, "{}", self.kind)?;
        for (name, _) in BITS.iter().filter(|(name, _)| *name != "PLC_INFO" && flag(name)) {
            write!(f, " | {name}")?;
        }
        Ok(())
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Every type with every set of bits goes through number and text.
    #[test]
    fn values_are_read_back() {
        for kind in Synchronisation::all() {
            for bits in 0..16 {
                let synch = Synch {
                    kind,
                    plc_info: bits & 1 != 0,
                    backward: bits & 2 != 0,
                    forward: bits & 4 != 0,
                    flush_and_wait: bits & 8 != 0,
                };
                let alone = kind == Synchronisation::NoSynch && matches!(bits, 2 | 4 | 6);
                let bit = if bits & 2 != 0 { "BWD_SYNCH" } else { "FWD_SYNCH" };
                let known = if alone {
                    Err(SynchError::NoType(bit))
                } else {
                    Ok(synch)
                };
                assert_eq!(Synch::from_bits(synch.bits()), known);
                let text = synch.to_string();
                let read = text.split('|').map(|name| Synch::constant(name.trim()));
                let sum = read.map(Option::unwrap).fold(0, |sum, bits| sum | bits);
                assert_eq!(sum, synch.bits(), "{text}");
            }
        }
    }

    #[test]
    fn wrong_values_are_named() {
        assert_eq!(Synch::from_bits(u32::MAX), Err(SynchError::NotValid));
        assert_eq!(Synch::from_bits(0x12), Err(SynchError::UnknownBits(0x10)));
        let two = SynchError::SeveralTypes(Synchronisation::MvsSvs, Synchronisation::MvsSns);
        assert_eq!(Synch::from_bits(0x6), Err(two));
        assert_eq!(Synch::constant("not_vaild"), Some(Synch::NOT_VALID));
        assert_eq!(Synch::constant("MVS"), None);
    }
}
