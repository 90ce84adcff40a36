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
}
