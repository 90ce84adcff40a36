//! Settings of the data interfaces [000:16975-17105].

use super::bit_of;
use crate::ParameterList;

/// The data interfaces RS-232-C/V.24 and RS-422/V.11.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct InterfaceParameters {
    /// Which of both is inhibited: MP5000 [000:16984-16989].
    pub inhibited: [bool; 2],
    /// How EXT1 and EXT2 transfer: MP5020, MP5030.
    pub formats: [TransferFormat; 2],
}

/// Memory for a program that is executed while it is transferred: MP7228 [000:16957-16968].
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct DripFeedMemory {
    /// What must be free for it, bytes: MP7228.0.
    pub min_bytes: u64,
    /// What it takes at most, bytes: MP7228.1, and no more than there is; 0 is all there is (inferred).
    pub max_bytes: u64,
}

impl DripFeedMemory {
    /// Transfer goes on when so much of a full memory is free again, bytes [000:16961].
    pub const RESUMES_BYTES: u64 = 256;

    /// The least that it needs is there.
    pub fn is_enough(&self) -> bool {
        self.min_bytes <= self.max_bytes
    }
}

/// A data format and its protocol [000:17073-17105] [001:1934-1968].
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct TransferFormat {
    /// Data bits, 7 or 8: bit 0 of MP5020.
    pub data_bits: u8,
    /// RTS stops the transfer: bit 2.
    pub stop_by_rts: bool,
    /// DC3 stops it: bit 3.
    pub stop_by_dc3: bool,
    /// Parity, where one is desired (bit 5): odd or even, bit 4.
    pub odd: Option<bool>,
    /// Half stop bits, 2 to 4: bits 6 and 7.
    pub half_stop_bits: u8,
    /// Blockwise with check characters: MP5030.
    pub blockwise: bool,
}

impl ParameterList {
    /// Settings of the data interfaces.
    pub fn interface_parameters(&self) -> InterfaceParameters {
        let inhibited = self.get_new(5000, 0).unwrap_or_default() as u8;
        InterfaceParameters {
            inhibited: [inhibited == 1, inhibited == 2],
            formats: [0, 1].map(|ext| self.transfer_format(ext)),
        }
    }

    /// Memory for programs that are executed while they are transferred. MP7228 counts kByte: chapter 8 of the manual says so,
    /// the list says bytes.
    pub fn drip_feed_memory(&self) -> DripFeedMemory {
        let kbyte = |index| self.get_new(7228, index).unwrap_or_default() as u64 * 1024;
        let there = u64::from(self.model().limits().program_memory_bytes);
        DripFeedMemory {
            min_bytes: kbyte(0),
            max_bytes: Some(kbyte(1)).filter(|max| *max > 0).unwrap_or(there).min(there),
        }
    }

    fn transfer_format(&self, ext: u8) -> TransferFormat {
        let bits = self.get_new(5020, ext).unwrap_or_default();
        let is_set = |bit| bit_of(bits, bit);
        TransferFormat {
            data_bits: if is_set(0) { 8 } else { 7 },
            stop_by_rts: is_set(2),
            stop_by_dc3: is_set(3),
            odd: is_set(5).then(|| is_set(4)),
            half_stop_bits: match (is_set(6), is_set(7)) {
                (false, false) => 3,
                (true, false) => 4,
                (_, true) => 2,
            },
            blockwise: self.get_new(5030, ext) == Some(1.0),
        }
    }
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used, reason = "a test may fail")]
    use super::*;
    use crate::ControlModel;

    /// The printer of the manual: 169 is 8 data bits, stop by DC3, even parity, 1 stop bit [000:17206-17214]; 105 has 2
    /// stop bits [003:7221-7225].
    #[test]
    fn formats_of_the_manual() {
        let mut list = ParameterList::reference(ControlModel::Tnc415b);
        for (index, bits) in [(0, 169.0), (1, 105.0)] {
            list.set(5020, index, bits).unwrap();
        }
        list.set(5030, 1, 1.0).unwrap();
        let printer = TransferFormat {
            data_bits: 8,
            stop_by_rts: false,
            stop_by_dc3: true,
            odd: Some(false),
            half_stop_bits: 2,
            blockwise: false,
        };
        let other = TransferFormat {
            half_stop_bits: 4,
            blockwise: true,
            ..printer
        };
        assert_eq!(list.interface_parameters().formats, [printer, other]);
        for (value, inhibited) in [(0.0, [false, false]), (1.0, [true, false]), (2.0, [false, true])] {
            list.set(5000, 0, value).unwrap();
            assert_eq!(list.interface_parameters().inhibited, inhibited);
        }
    }

    /// MP7228 counts kByte; nothing is more than what the model has.
    #[test]
    fn memory_of_the_drip_feed() {
        let memory = |min: f64, max: f64| {
            let mut list = ParameterList::reference(ControlModel::Tnc407);
            list.set(7228, 0, min).unwrap();
            list.set(7228, 1, max).unwrap();
            list.drip_feed_memory()
        };
        let there = 6000 * 22;
        assert_eq!(
            memory(0.0, 0.0),
            DripFeedMemory {
                min_bytes: 0,
                max_bytes: there
            }
        );
        assert_eq!(
            memory(2.0, 10.0),
            DripFeedMemory {
                min_bytes: 2048,
                max_bytes: 10_240
            }
        );
        assert_eq!(memory(0.0, 1024.0).max_bytes, there);
        assert!(memory(10.0, 10.0).is_enough());
        assert!(!memory(11.0, 10.0).is_enough());
        assert!(!memory(1024.0, 0.0).is_enough());
    }
}
