//! A character on the line: its bits, and how long it takes.

use std::time::Duration;

use bahn_parameters::interfaces::TransferFormat;

/// Stops the other side: XOFF [000:17045-17050].
pub const DC3: u8 = 0x13;
/// Starts it again: XON.
pub const DC1: u8 = 0x11;
/// Characters that may still come after a DC3 [000:17045-17050].
pub const AFTER_DC3: usize = 12;

/// Parity of a character [000:16636-16665].
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Parity {
    /// The bits that are 1, with that of the parity, are even in number.
    Even,
    /// The number of ones with the parity bit is odd.
    Odd,
}

/// The frame of a character: start bit, data bits, parity, stop bits [000:16628-16636].
///
/// ```
/// use std::time::Duration;
/// use bahn_link::Characters;
///
/// // 7 data bits, no parity, 2 stop bits at 300 baud are 30 characters a second [000:16686-16690].
/// let characters = Characters { data_bits: 7, parity: None, half_stop_bits: 4 };
/// assert_eq!(characters.time(300) * 30, Duration::from_nanos(33_333_333) * 30);
/// ```
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Characters {
    /// Data bits of a character, 7 or 8.
    pub data_bits: u8,
    /// `None` when it is not desired.
    pub parity: Option<Parity>,
    /// 2 to 4: one and a half stop bits are 3.
    pub half_stop_bits: u8,
}

impl Characters {
    /// 7 data bits, even parity, 1 stop bit: ME, FE1 and FE2 [000:17226-17227] [001:1183]; that FE has the parity of ME
    /// *(inferred)* from what is said of the parity of the check character [000:17394].
    pub const FIXED: Characters = Characters {
        data_bits: 7,
        parity: Some(Parity::Even),
        half_stop_bits: 2,
    };

    /// Those of a freely configurable mode: bits of MP5020 (MP222).
    pub(crate) fn of_format(format: &TransferFormat) -> Characters {
        Characters {
            data_bits: format.data_bits,
            parity: format.odd.map(|odd| if odd { Parity::Odd } else { Parity::Even }),
            half_stop_bits: format.half_stop_bits,
        }
    }

    /// How long one takes at a baud rate.
    pub fn time(&self, baud: u32) -> Duration {
        let half_bits = 2 * (1 + u64::from(self.data_bits) + u64::from(self.parity.is_some()))
            + u64::from(self.half_stop_bits);
        Duration::from_nanos(half_bits * 500_000_000 / u64::from(baud.max(1)))
    }

    /// The part of a byte that a character carries on a channel without UART: with 7 data bits bit 7 is lost.
    #[inline]
    pub fn mask(&self, byte: u8) -> u8 {
        if self.data_bits == 7 { byte & 0x7F } else { byte }
    }
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used, reason = "a test may fail")]
    use bahn_parameters::{ControlModel, ParameterList};

    use super::*;

    /// The values of the manuals: 168 [001:1954-1968], 169 [000:17206-17214], 105 [003:7221-7225].
    #[test]
    fn bits_of_mp5020() {
        let even = Some(Parity::Even);
        for (bits, data_bits, parity, half_stop_bits, stop_by_dc3, character_bits) in [
            (168.0, 7, even, 2, true, 10),
            (169.0, 8, even, 2, true, 11),
            (105.0, 8, even, 4, true, 12),
            (0.0, 7, None, 3, false, 0),
            (49.0, 8, Some(Parity::Odd), 3, false, 0),
        ] {
            let mut list = ParameterList::reference(ControlModel::Tnc415b);
            list.set(5020, 0, bits).unwrap();
            let format = list.interface_parameters().formats[0];
            let characters = Characters::of_format(&format);
            let expected = Characters {
                data_bits,
                parity,
                half_stop_bits,
            };
            assert_eq!(characters, expected, "{bits}");
            assert_eq!(format.stop_by_dc3, stop_by_dc3, "{bits}");
            if character_bits > 0 {
                assert_eq!(
                    characters.time(1000),
                    Duration::from_millis(character_bits),
                    "{bits}"
                );
            }
        }
        // Half a stop bit more is half a bit.
        let longer = Characters {
            half_stop_bits: 3,
            ..Characters::FIXED
        };
        assert_eq!(
            longer.time(1000) - Characters::FIXED.time(1000),
            Duration::from_micros(500)
        );
        assert_eq!(
            (
                longer.mask(0xFF),
                Characters {
                    data_bits: 8,
                    ..longer
                }
                .mask(0xFF)
            ),
            (0x7F, 0xFF)
        );
    }
}
