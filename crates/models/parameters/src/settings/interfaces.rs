//! Settings of the data interfaces [000:16975-17105].

use super::bit_of;
use crate::ParameterList;

/// The data interfaces RS-232-C/V.24 and RS-422/V.11.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct InterfaceParameters {
    /// Which of both is inhibited: MP5000 [000:16984-16989].
    pub inhibited: [bool; 2],
    /// How EXT1, EXT2 and EXT3 (that of the PLC) transfer; a control with one interface has one EXT.
    pub formats: [TransferFormat; 3],
    /// Programs are sent with a decimal comma: MP92 of the TNC 151/155 [001:1923].
    pub decimal_comma: bool,
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
    /// Data bits, 7 or 8: bit 0 of MP5020 (MP222).
    pub data_bits: u8,
    /// A block check character is never a control character: bit 1 [000:17015-17017].
    pub printable_check: bool,
    /// RTS stops the transfer: bit 2.
    pub stop_by_rts: bool,
    /// DC3 stops it: bit 3.
    pub stop_by_dc3: bool,
    /// Parity, where one is desired (bit 5): odd or even, bit 4.
    pub odd: Option<bool>,
    /// Half stop bits, 2 to 4: bits 6 and 7.
    pub half_stop_bits: u8,
    /// Blockwise with check characters: MP5030 (MP223).
    pub blockwise: bool,
    /// The characters of the protocols.
    pub characters: ControlCharacters,
}

/// The characters of the protocols that a list may replace [000:17108-17178] [001:1897-1921] [001:2075-2088].
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct ControlCharacters {
    /// Start of text: MP5200, MP5010.0, MP71.
    pub stx: u8,
    /// End of text: MP5201, MP5010.0, MP71.
    pub etx: u8,
    /// Type of file in a header that asks for one, where it is always the same: MP5202, MP5010.1, MP218.
    pub input_type: Option<u8>,
    /// Letter of such a header: MP5203, MP5010.1, MP218.
    pub input: u8,
    /// Type of file in a header that offers one, where it is always the same: MP5204, MP5010.2, MP219.
    pub output_type: Option<u8>,
    /// Letter of such a header: MP5205, MP5010.2, MP219.
    pub output: u8,
    /// Start of a header: MP5206, MP5010.3, MP220.
    pub soh: u8,
    /// End of a block: MP5207, MP5010.3, MP220.
    pub etb: u8,
    /// Transferred well: MP5208, MP5010.4, MP221.
    pub ack: u8,
    /// Transferred badly: MP5209, MP5010.4, MP221.
    pub nak: u8,
    /// End of transmission: MP5210, MP5010.5, MP224.
    pub eot: u8,
}

impl ControlCharacters {
    /// Those of ASCII, as in the modes FE1 and FE2 [000:17113]; the type of a file is that of the file.
    pub const STANDARD: ControlCharacters = ControlCharacters {
        stx: 0x02,
        etx: 0x03,
        input_type: None,
        input: b'E',
        output_type: None,
        output: b'A',
        soh: 0x01,
        etb: 0x17,
        ack: 0x06,
        nak: 0x15,
        eot: 0x04,
    };
}

/// What stands before the number of a program on the TNC 151/155, which knows no other files [001:2080-2083].
const OLD_TYPE: u8 = b'%';

impl ParameterList {
    /// Settings of the data interfaces.
    pub fn interface_parameters(&self) -> InterfaceParameters {
        let inhibited = self.get_new(5000, 0).unwrap_or_default() as u8;
        InterfaceParameters {
            inhibited: [inhibited == 1, inhibited == 2],
            formats: [0, 1, 2]
                .map(|ext| self.transfer_format(if self.model().has_rs_422() { ext } else { 0 })),
            decimal_comma: self.has_old_numbers() && !bit_of(self.get(92, 0).unwrap_or_default(), 0),
        }
    }

    /// The characters of the modes whose settings are fixed.
    pub fn fixed_characters(&self) -> ControlCharacters {
        let of_type = self.has_old_numbers().then_some(OLD_TYPE);
        ControlCharacters {
            input_type: of_type,
            output_type: of_type,
            ..ControlCharacters::STANDARD
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

    /// What a printer is told before a hard copy and before each of its lines: MP226 to 229 and 230 to 233, whose high bytes
    /// go first; the first byte is the number of the others. A control without these parameters has nothing to tell
    /// [001:2157-2206].
    pub fn printer_characters(&self) -> [Vec<u8>; 2] {
        [226_u16, 230].map(|first| {
            let words = (first..first + 4).map(|number| {
                let word = if self.has_old_numbers() {
                    self.get(number, 0)
                } else {
                    None
                };
                word.unwrap_or_default() as u16
            });
            let bytes: Vec<u8> = words.flat_map(u16::to_be_bytes).collect();
            let count = bytes.first().copied().map_or(0, usize::from);
            bytes.into_iter().skip(1).take(count).collect()
        })
    }

    fn transfer_format(&self, ext: u8) -> TransferFormat {
        let bits = self.value((5020, ext), (222, 0));
        let is_set = |bit| bit_of(bits, bit);
        TransferFormat {
            data_bits: if is_set(0) { 8 } else { 7 },
            printable_check: is_set(1),
            stop_by_rts: is_set(2),
            stop_by_dc3: is_set(3),
            odd: is_set(5).then(|| is_set(4)),
            half_stop_bits: match (is_set(6), is_set(7)) {
                (false, false) => 3,
                (true, false) => 4,
                (_, true) => 2,
            },
            blockwise: self.value((5030, ext), (223, 0)) == 1.0,
            characters: self.control_characters(ext),
        }
    }

    /// The characters of an EXT; 0 is the standard [000:17113].
    fn control_characters(&self, ext: u8) -> ControlCharacters {
        let fixed = self.fixed_characters();
        let one = |number: u16| {
            let value = self.get(number, ext).unwrap_or_default() as u8 & 0x7F;
            (value != 0).then_some(value)
        };
        // Two characters in a word, the first one in the low byte [003:7191-7198] [001:1897-1921].
        let two = |new: u8, old: u16| {
            let word = self.value((5010, new), (old, 0)) as u16;
            let [low, high] = word.to_le_bytes().map(|byte| byte & 0x7F);
            ((low != 0).then_some(low), (high != 0).then_some(high))
        };
        let [text, input, output, block, answer, end] = if self.model().has_rs_422() {
            [
                (5201, 5200),
                (5202, 5203),
                (5204, 5205),
                (5207, 5206),
                (5208, 5209),
                (5210, 5210),
            ]
            .map(|(first, second)| (one(first), one(second)))
        } else {
            [(0, 71), (1, 218), (2, 219), (3, 220), (4, 221), (5, 224)].map(|(new, old)| two(new, old))
        };
        ControlCharacters {
            stx: text.1.unwrap_or(fixed.stx),
            etx: text.0.unwrap_or(fixed.etx),
            input_type: input.0.or(fixed.input_type),
            input: input.1.unwrap_or(fixed.input),
            output_type: output.0.or(fixed.output_type),
            output: output.1.unwrap_or(fixed.output),
            soh: block.1.unwrap_or(fixed.soh),
            etb: block.0.unwrap_or(fixed.etb),
            ack: answer.0.unwrap_or(fixed.ack),
            nak: answer.1.unwrap_or(fixed.nak),
            eot: end.0.unwrap_or(fixed.eot),
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
            printable_check: false,
            stop_by_rts: false,
            stop_by_dc3: true,
            odd: Some(false),
            half_stop_bits: 2,
            blockwise: false,
            characters: ControlCharacters::STANDARD,
        };
        let other = TransferFormat {
            half_stop_bits: 4,
            blockwise: true,
            ..printer
        };
        assert_eq!(list.interface_parameters().formats[..2], [printer, other]);
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

    /// The words of the TNC 151/155 [001:2075-2088] [001:1964-1968] and of the TNC 360 [003:7191-7198].
    #[test]
    fn two_characters_in_a_word() {
        let mut old = ParameterList::reference(ControlModel::Tnc155);
        for (number, value) in [
            (71, 515.0),
            (218, 17701.0),
            (219, 16677.0),
            (220, 279.0),
            (221, 5382.0),
            (224, 4.0),
            (222, 168.0),
            (223, 1.0),
        ] {
            old.set(number, 0, value).unwrap();
        }
        let read = old.interface_parameters().formats[0];
        let standard = ControlCharacters {
            input_type: Some(b'%'),
            output_type: Some(b'%'),
            ..ControlCharacters::STANDARD
        };
        assert_eq!(read.characters, standard);
        assert_eq!(
            (read.data_bits, read.stop_by_dc3, read.odd, read.half_stop_bits),
            (7, true, Some(false), 2)
        );
        assert!(read.blockwise && !read.stop_by_rts && !read.printable_check);

        let mut list = ParameterList::reference(ControlModel::Tnc360);
        let nothing = list.interface_parameters().formats[0].characters;
        assert_eq!(nothing, ControlCharacters::STANDARD);
        // `?` and `!` instead of ETX and STX.
        list.set(5010, 0, f64::from(63 + 256 * 33)).unwrap();
        list.set(5010, 1, 17736.0).unwrap();
        let read = list.interface_parameters().formats[1].characters;
        let expected = ControlCharacters {
            stx: b'!',
            etx: b'?',
            input_type: Some(b'H'),
            ..ControlCharacters::STANDARD
        };
        assert_eq!(read, expected);
    }

    /// Each replaces its character in its mode alone [000:17115-17177]: MP5200 STX, MP5201 ETX, MP5202 and MP5203 what asks,
    /// MP5204 and MP5205 what offers, MP5206 SOH, MP5207 ETB, MP5208 ACK, MP5209 NAK, MP5210 EOT.
    #[test]
    fn every_character_is_replaced() {
        let mut list = ParameterList::reference(ControlModel::Tnc425);
        let numbers = [5200, 5201, 5202, 5203, 5204, 5205, 5206, 5207, 5208, 5209, 5210];
        for (number, code) in numbers.into_iter().zip(33_u8..) {
            list.set(number, 1, f64::from(code)).unwrap();
        }
        let formats = list.interface_parameters().formats;
        assert_eq!(formats[0].characters, ControlCharacters::STANDARD);
        let expected = ControlCharacters {
            stx: 33,
            etx: 34,
            input_type: Some(35),
            input: 36,
            output_type: Some(37),
            output: 38,
            soh: 39,
            etb: 40,
            ack: 41,
            nak: 42,
            eot: 43,
        };
        assert_eq!(formats[1].characters, expected);
    }
}
