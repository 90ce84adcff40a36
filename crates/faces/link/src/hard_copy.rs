//! The hard copy of the graphics on a matrix printer, as the TNC 155 makes it [001:2157-2206].
//!
//! Machine parameters 226 to 229 are the characters that set the printer up, 230 to 233 those before each line, in words whose
//! high byte goes first; the first byte is their number. A line is eight rows of dots, a byte for each column with the upper
//! dot in its highest bit *(inferred)*.
//!
//! Decision: In a hard copy the upper dot is the highest bit; a picture becomes 512 dots wide, greys are dots of
//! sixteen, what shines is black

use bahn_parameters::ParameterList;

/// Rows of a printed line.
const ROWS: usize = 8;
/// Dots of a line: those of the printer of the manual [001:2170].
const WIDTH: usize = 512;
/// Order in which the dots of a square of four by four become black: a grey is so many of sixteen.
const ORDER: [[u8; 4]; 4] = [[0, 8, 2, 10], [12, 4, 14, 6], [3, 11, 1, 9], [15, 7, 13, 5]];

/// How a printer is spoken to.
///
/// ```
/// use bahn_link::HardCopy;
/// use bahn_parameters::{ControlModel, ParameterList};
///
/// // The values of the manual for a TI OMNI 800: ESC A 8, and LF ESC N 00 02 before each line.
/// let mut list = ParameterList::reference(ControlModel::Tnc155);
/// for (number, value) in [(226, 795.0), (227, 16_648.0), (230, 1290.0), (231, 6990.0), (232, 2.0)] {
///     list.set(number, 0, value)?;
/// }
/// let printer = HardCopy::of(&list);
/// // A picture of one bright dot at its upper left, as broad as a line: the dot is printed, the dark ground is paper.
/// let bytes = printer.print(512, 8, |x, y| if (x, y) == (0, 0) { 255 } else { 0 });
/// assert_eq!(bytes[..9], [0x1B, b'A', 8, 0x0A, 0x1B, b'N', 0, 2, 0x80]);
/// assert_eq!((bytes.len(), bytes[9..].iter().max()), (3 + 5 + 512, Some(&0)));
/// # Ok::<(), bahn_parameters::ParameterError>(())
/// ```
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct HardCopy {
    setup: Vec<u8>,
    line: Vec<u8>,
}

impl HardCopy {
    /// What the machine parameters say; a control without them has nothing to say to a printer.
    pub fn of(list: &ParameterList) -> HardCopy {
        let [setup, line] = list.printer_characters();
        HardCopy { setup, line }
    }

    /// Whether the printer is described.
    pub fn is_set_up(&self) -> bool {
        !self.line.is_empty()
    }

    /// The bytes that print a picture of so many columns and rows, whose brightness is asked for by column and row. It is made
    /// as broad as a line; what shines on the screen is black on the paper.
    pub fn print(&self, width: usize, height: usize, brightness: impl Fn(usize, usize) -> u8) -> Vec<u8> {
        let mut bytes = self.setup.clone();
        if width == 0 || height == 0 {
            return bytes;
        }
        let rows = (height * WIDTH).div_ceil(width);
        let is_black = |x: usize, y: usize| {
            let from = (x * width / WIDTH, y * width / WIDTH);
            let shade = ORDER[y % 4][x % 4];
            from.1 < height && u16::from(brightness(from.0, from.1)) * 16 > u16::from(shade) * 255
        };
        for top in (0..rows).step_by(ROWS) {
            bytes.extend_from_slice(&self.line);
            bytes.extend((0..WIDTH).map(|x| {
                let dots = (0..ROWS).map(|row| u8::from(is_black(x, top + row)));
                dots.fold(0, |byte, dot| byte << 1 | dot)
            }));
        }
        bytes
    }
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used, reason = "a test may fail")]
    use super::*;
    use bahn_parameters::ControlModel;

    fn printer() -> HardCopy {
        HardCopy {
            setup: b"\x1bA\x08".to_vec(),
            line: b"\n\x1bN\x00\x02".to_vec(),
        }
    }

    /// MP226, MP227, MP228, MP229 set up, MP230, MP231, MP232, MP233 stand before a line.
    #[test]
    fn no_printer_is_none() {
        let mut list = ParameterList::reference(ControlModel::Tnc155);
        for number in 226..=233 {
            list.set(number, 0, 0.0).unwrap();
        }
        assert!(!HardCopy::of(&list).is_set_up());
        for (number, value) in
            (226..=233).zip([0x0741, 0x4243, 0x4445, 0x4647, 0x0361, 0x6263, 0x6465, 0x6667])
        {
            list.set(number, 0, f64::from(value)).unwrap();
        }
        let printer = HardCopy::of(&list);
        assert_eq!(
            (printer.setup.as_slice(), printer.line.as_slice()),
            (&b"ABCDEFG"[..], &b"abc"[..])
        );
        // More characters than there are places for.
        list.set(230, 0, f64::from(0xFF0A_u16)).unwrap();
        assert_eq!(HardCopy::of(&list).line.len(), 7);
    }

    /// 256 columns become 512: a dot is two by two; 20 rows are 40, in 5 lines.
    #[test]
    fn a_picture_is_as_broad_as_a_line() {
        let bytes = printer().print(256, 20, |x, y| u8::from((x, y) == (255, 19)) * 255);
        assert_eq!(bytes.len(), 3 + 5 * (5 + 512));
        let last = &bytes[bytes.len() - 512..];
        assert_eq!(last[510..], [0b0000_0011; 2]);
        assert!(last[..510].iter().all(|byte| *byte == 0));
        assert_eq!(printer().print(0, 5, |_, _| 0), b"\x1bA\x08");
    }

    /// Half the brightness is half of the dots.
    #[test]
    fn greys_are_dots() {
        let bytes = printer().print(512, 8, |_, _| 128);
        let black: u32 = bytes[8..].iter().map(|byte| byte.count_ones()).sum();
        // Nine of sixteen: 128 · 16 = 2048 is more than 0 to 8 times 255, at most 2040.
        assert_eq!(black, 512 * 8 / 16 * 9);
    }
}
