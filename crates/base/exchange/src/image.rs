//! The memory behind the operands.

use crate::address::{BYTES, BYTES_AT};
use crate::{Bit, BitArea, BitRange, Number, Size, signal};

/// Cells of an image; a power of two, so that a masked index needs no check.
pub const CELLS: usize = 8192;
/// String memories S0 to S3 [000:14054].
pub const STRINGS: usize = 4;
/// Characters of a string memory, the end character included [000:14054].
pub const STRING_LENGTH: usize = 128;

/// The cell of the first character of S0.
const STRINGS_AT: usize = (BYTES_AT + BYTES) as usize;
const MASK: usize = CELLS - 1;

/// The memory of all operands: markers, inputs, outputs, timers, counters, bytes and strings.
///
/// ```
/// use bahn_exchange::{Image, Number, Size};
/// let mut image = Image::default();
/// let (b8, b9, w8) = ("B8".parse()?, "B9".parse()?, "W8".parse()?);
/// image.set_number(w8, 0x1234);
/// assert_eq!((image.number(b8), image.number(b9)), (0x12, 0x34), "the address is the high byte");
/// image.set_number(b8, -1);
/// assert_eq!(image.number(w8), 0xff34_u16 as i16 as i32, "operands are signed");
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
#[derive(Clone, PartialEq, Eq)]
pub struct Image {
    /// One cell (0 or 1) for each bit, then the bytes, then the strings.
    cells: Box<[u8; CELLS]>,
}

impl Default for Image {
    /// Everything 0.
    fn default() -> Image {
        Image {
            cells: Box::new([0; CELLS]),
        }
    }
}

impl Image {
    /// The value of a bit operand.
    #[inline]
    pub fn bit(&self, bit: Bit) -> bool {
        self.cells[bit.cell() & MASK] != 0
    }

    /// Sets a bit operand.
    #[inline]
    pub fn set_bit(&mut self, bit: Bit, value: bool) {
        self.cells[bit.cell() & MASK] = value.into();
    }

    /// Whether any marker of a range is set.
    pub fn any(&self, markers: BitRange) -> bool {
        let cells = self.cells.get(markers.cells()).unwrap_or_default();
        cells.iter().fold(0, |any, cell| any | cell) != 0
    }

    /// The value of a number operand, sign-extended [000:12099].
    #[inline]
    pub fn number(&self, number: Number) -> i32 {
        let byte = |offset: usize| self.cells[(number.cell() + offset) & MASK];
        match number.size() {
            Size::Byte => i32::from(byte(0) as i8),
            Size::Word => i32::from(i16::from_be_bytes([byte(0), byte(1)])),
            Size::Double => i32::from_be_bytes([byte(0), byte(1), byte(2), byte(3)]),
        }
    }

    /// Sets a number operand to the low 8, 16 or 32 bits of a value.
    #[inline]
    pub fn set_number(&mut self, number: Number, value: i32) {
        let bytes = value.to_be_bytes();
        let count = usize::from(number.size().bytes());
        for (offset, byte) in bytes.iter().skip(4 - count).enumerate() {
            self.cells[(number.cell() + offset) & MASK] = *byte;
        }
    }

    /// The characters of a string memory, without the end character; empty for a string that does not
    /// exist. A memory without an end character reads as all of it.
    pub fn text(&self, string: usize) -> &[u8] {
        let memory = self.string(string);
        let end = memory.iter().position(|character| *character == 0);
        end.and_then(|end| memory.get(..end)).unwrap_or(memory)
    }

    /// Stores characters and an end character; more than 127 are cut.
    pub fn set_text(&mut self, string: usize, text: &[u8]) {
        if let Some(memory) = self.string_mut(string) {
            let text = text.get(..STRING_LENGTH - 1).unwrap_or(text);
            for (cell, character) in memory.iter_mut().zip(text.iter().chain([&0])) {
                *cell = *character;
            }
        }
    }

    /// All characters of a string memory; empty for a string that does not exist.
    pub fn string(&self, string: usize) -> &[u8] {
        let start = STRINGS_AT.saturating_add(string.saturating_mul(STRING_LENGTH));
        match self.cells.get(start..start.saturating_add(STRING_LENGTH)) {
            Some(memory) if string < STRINGS => memory,
            _ => &[],
        }
    }

    /// All characters of a string memory, to be changed.
    pub fn string_mut(&mut self, string: usize) -> Option<&mut [u8]> {
        if string >= STRINGS {
            return None;
        }
        let start = STRINGS_AT + string * STRING_LENGTH;
        self.cells.get_mut(start..start + STRING_LENGTH)
    }

    /// Erases what power-off keeps, as code number 531 210 does [000:11581].
    pub fn erase_retained(&mut self) {
        for cell in retained_cells() {
            self.cells[cell & MASK] = 0;
        }
    }

    /// The cells themselves, for code that has turned addresses into cells.
    #[inline]
    pub fn cells(&self) -> &[u8; CELLS] {
        &self.cells
    }

    /// The cells themselves, to be changed. Cells of bits hold 0 or 1.
    #[inline]
    pub fn cells_mut(&mut self) -> &mut [u8; CELLS] {
        &mut self.cells
    }
}

impl std::fmt::Debug for Image {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        let set = BitArea::ALL
            .into_iter()
            .flat_map(|area| (0..area.count()).filter_map(move |number| Bit::new(area, number)))
            .filter(|bit| self.bit(*bit));
        let bytes = (0..BYTES)
            .filter_map(|address| Number::new(Size::Byte, address))
            .map(|byte| (byte, self.number(byte)))
            .filter(|(_, value)| *value != 0);
        f.debug_struct("Image")
            .field("set", &set.collect::<Vec<_>>())
            .field("bytes", &bytes.collect::<Vec<_>>())
            .finish_non_exhaustive()
    }
}

/// The cells of M1000-M1999 and B0-B127 [000:11579].
pub(crate) fn retained_cells() -> impl Iterator<Item = usize> {
    let markers = signal::RETAINED_MARKERS.iter().map(Bit::cell);
    let bytes = (0..signal::RETAINED_BYTES.count()).filter_map(|index| signal::RETAINED_BYTES.get(index));
    markers.chain(bytes.map(Number::cell))
}

/// The cells of the inputs.
pub(crate) fn input_cells() -> std::ops::Range<usize> {
    let first = usize::from(BitArea::I.first_cell());
    first..first + usize::from(BitArea::I.count())
}

/// The cells that NC and PLC exchange: all but strings.
pub(crate) const EXCHANGED: usize = STRINGS_AT;

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn words_overlap_big_endian() {
        let mut image = Image::default();
        let at = |size, address| Number::new(size, address).unwrap();
        image.set_number(at(Size::Double, 8), 0x0102_0384);
        assert_eq!(image.number(at(Size::Byte, 8)), 1);
        assert_eq!(image.number(at(Size::Word, 8)), 0x0102);
        assert_eq!(image.number(at(Size::Byte, 11)), 0x84 - 0x100);
        assert_eq!(image.number(at(Size::Word, 10)), 0x0384);
    }

    #[test]
    fn strings_end_with_a_zero_character() {
        let mut image = Image::default();
        image.set_text(1, b"OIL");
        assert_eq!(image.text(1), b"OIL");
        image.set_text(1, &[b'A'; 200]);
        assert_eq!(image.text(1), &[b'A'; 127]);
        image.set_text(4, b"X");
        assert_eq!(image.text(4), b"");
        assert_eq!(image.text(0), b"");
    }
}
