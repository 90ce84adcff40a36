//! Addresses of operands [000:11552-11567].

use std::fmt;
use std::str::FromStr;

/// Where the areas lie in the cells of an [`Image`](crate::Image): one cell for each bit operand, one for
/// each byte.
const AREAS: [(BitArea, u16, u16); 5] = [
    (BitArea::M, 0, MARKERS),
    (BitArea::I, 3264, 256),
    (BitArea::O, 3520, 128),
    (BitArea::T, 3648, 96),
    (BitArea::C, 3744, 128),
];

/// The directory prints M0 to M3023; the manual itself uses M3168-M3172 and M3200-M3263
/// [000:12888][000:16313-16322].
const MARKERS: u16 = 3264;
/// The cell of B0.
pub(crate) const BYTES_AT: u16 = 3872;
/// Bytes of the word memory [000:11571].
pub(crate) const BYTES: u16 = 1024;

/// A kind of operand of one bit.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub enum BitArea {
    /// Markers, 0 or 1.
    M,
    /// PLC inputs, 0 or 1.
    I,
    /// PLC outputs, 0 or 1.
    O,
    /// Timer: T0-T47 start, T48-T95 running.
    T,
    /// Counter: C0-C31 set, C48-C79 contents, C96-C127 count pulse release.
    C,
}

impl BitArea {
    /// All areas of single bits.
    pub const ALL: [BitArea; 5] = [BitArea::M, BitArea::I, BitArea::O, BitArea::T, BitArea::C];

    /// The letter that programs use.
    pub const fn letter(self) -> char {
        match self {
            BitArea::M => 'M',
            BitArea::I => 'I',
            BitArea::O => 'O',
            BitArea::T => 'T',
            BitArea::C => 'C',
        }
    }

    /// The letter that programs of the TNC 151, 155 and 355 use [000:16189-16202].
    pub const fn old_letter(self) -> char {
        match self {
            BitArea::I => 'E',
            BitArea::O => 'A',
            BitArea::C => 'Z',
            area => area.letter(),
        }
    }

    /// The area of a letter; E, A and Z are those of inputs, outputs and counters on the TNC 151, 155 and 355
    /// [000:16189-16202].
    ///
    /// ```
    /// use bahn_exchange::{Bit, BitArea};
    /// assert_eq!(BitArea::of_letter('E'), Some(BitArea::I));
    /// assert_eq!("A7".parse::<Bit>()?.to_string(), "O7");
    /// # Ok::<(), Box<dyn std::error::Error>>(())
    /// ```
    pub const fn of_letter(letter: char) -> Option<BitArea> {
        Some(match letter {
            'M' => BitArea::M,
            'I' | 'E' => BitArea::I,
            'O' | 'A' => BitArea::O,
            'T' => BitArea::T,
            'C' | 'Z' => BitArea::C,
            _ => return None,
        })
    }

    /// The first number after the area.
    pub const fn count(self) -> u16 {
        AREAS[self as usize].2
    }

    /// The ranges of numbers that a program may name, both ends included. The directory's inputs, outputs
    /// and counters have gaps between the boards [000:11556-11567]; a PL 410 adds I127 and I255 [000:2477-2496], the handwheel I160-I175 and
    /// O96-O111 [000:8276-8281], and O31 is the output "control is ready".
    pub const fn ranges(self) -> &'static [(u16, u16)] {
        match self {
            BitArea::M => &[(0, MARKERS - 1)],
            BitArea::I => &[(0, 31), (64, 127), (128, 152), (160, 175), (192, 255)],
            BitArea::O => &[(0, 30), (32, 62), (64, 94), (96, 111)],
            BitArea::T => &[(0, 95)],
            BitArea::C => &[(0, 31), (48, 79), (96, 127)],
        }
    }

    /// The highest number that the directory lists.
    pub const fn last(self) -> u16 {
        match self {
            BitArea::M => MARKERS - 1,
            BitArea::I => 255,
            BitArea::O => 111,
            BitArea::T => 95,
            BitArea::C => 127,
        }
    }

    /// The cell of number 0.
    pub const fn first_cell(self) -> u16 {
        AREAS[self as usize].1
    }
}

/// The address of a bit operand, as `M2045`.
#[derive(Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub struct Bit {
    area: BitArea,
    number: u16,
}

impl Bit {
    /// The operand of a number, also in the gaps between the input and output boards; `None` beyond the end
    /// of the area.
    pub const fn new(area: BitArea, number: u16) -> Option<Bit> {
        if number < area.count() {
            Some(Bit { area, number })
        } else {
            None
        }
    }

    /// For the table of signals, whose numbers a test checks.
    pub(crate) const fn fixed(area: BitArea, number: u16) -> Bit {
        Bit { area, number }
    }

    /// The kind of operand.
    pub const fn area(self) -> BitArea {
        self.area
    }

    /// The number after the letter.
    pub const fn number(self) -> u16 {
        self.number
    }

    /// Whether the directory lists it, so that a program may name it.
    pub fn is_listed(self) -> bool {
        self.area
            .ranges()
            .iter()
            .any(|(first, last)| (*first..=*last).contains(&self.number))
    }

    /// The cell of an [`Image`](crate::Image) that holds it.
    pub const fn cell(self) -> usize {
        (self.area.first_cell() + self.number) as usize
    }
}

impl Bit {
    /// Its name with the letters that a control has: E, A and Z on the TNC 151, 155 and 355 [000:16189-16202].
    ///
    /// ```
    /// use bahn_exchange::{Bit, BitArea};
    /// # fn main() -> Result<(), Box<dyn std::error::Error>> {
    /// let completed: Bit = "I17".parse()?;
    /// assert_eq!((completed.name(true), completed.name(false)), ("E17".to_owned(), "I17".to_owned()));
    /// # Ok(())
    /// # }
    /// ```
    pub fn name(self, old: bool) -> String {
        match old {
            true => format!("{}{}", self.area.old_letter(), self.number),
            false => self.to_string(),
        }
    }
}

impl fmt::Display for Bit {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{}{}", self.area.letter(), self.number)
    }
}

impl fmt::Debug for Bit {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        fmt::Display::fmt(self, f)
    }
}

/// The width of a number operand.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub enum Size {
    /// `B`, a byte of 8 bits.
    Byte,
    /// `W`, a word of 16 bits.
    Word,
    /// `D`, a doubleword of 32 bits.
    Double,
}

impl Size {
    /// All sizes of numbers.
    pub const ALL: [Size; 3] = [Size::Byte, Size::Word, Size::Double];

    /// Bytes that it takes.
    pub const fn bytes(self) -> u16 {
        match self {
            Size::Byte => 1,
            Size::Word => 2,
            Size::Double => 4,
        }
    }

    /// The letter that programs use.
    pub const fn letter(self) -> char {
        match self {
            Size::Byte => 'B',
            Size::Word => 'W',
            Size::Double => 'D',
        }
    }

    /// The low bits of a value, sign-extended [000:12099].
    pub const fn truncate(self, value: i32) -> i32 {
        match self {
            Size::Byte => value as i8 as i32,
            Size::Word => value as i16 as i32,
            Size::Double => value,
        }
    }
}

/// The address of a byte, word or doubleword, as `W260`. All three share one memory of 1024 bytes; the
/// address is that of the highest byte [000:11571-11577].
#[derive(Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub struct Number {
    size: Size,
    address: u16,
}

impl Number {
    /// The operand of an address; `None` when it is not a multiple of the size, or beyond the end of the
    /// memory.
    pub const fn new(size: Size, address: u16) -> Option<Number> {
        if address < BYTES && address.is_multiple_of(size.bytes()) {
            Some(Number { size, address })
        } else {
            None
        }
    }

    /// For the table of signals, whose addresses a test checks.
    pub(crate) const fn fixed(size: Size, address: u16) -> Number {
        Number { size, address }
    }

    /// The width of the number that is addressed.
    pub const fn size(self) -> Size {
        self.size
    }

    /// The number after the letter.
    pub const fn address(self) -> u16 {
        self.address
    }

    /// The cell of an [`Image`](crate::Image) that holds its highest byte.
    pub const fn cell(self) -> usize {
        (BYTES_AT + self.address) as usize
    }
}

impl fmt::Display for Number {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{}{}", self.size.letter(), self.address)
    }
}

impl fmt::Debug for Number {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        fmt::Display::fmt(self, f)
    }
}

/// A text that is no address of the wanted kind.
#[derive(Clone, Copy, Debug, PartialEq, Eq, thiserror::Error)]
#[error("no such operand")]
pub struct NoSuchOperand;

impl FromStr for Bit {
    type Err = NoSuchOperand;

    fn from_str(text: &str) -> Result<Bit, NoSuchOperand> {
        let (letter, number) = split(text)?;
        let area = BitArea::of_letter(letter);
        area.and_then(|area| Bit::new(area, number)).ok_or(NoSuchOperand)
    }
}

impl FromStr for Number {
    type Err = NoSuchOperand;

    fn from_str(text: &str) -> Result<Number, NoSuchOperand> {
        let (letter, address) = split(text)?;
        let size = Size::ALL.into_iter().find(|size| size.letter() == letter);
        size.and_then(|size| Number::new(size, address))
            .ok_or(NoSuchOperand)
    }
}

fn split(text: &str) -> Result<(char, u16), NoSuchOperand> {
    let mut characters = text.trim().chars();
    let letter = characters.next().ok_or(NoSuchOperand)?.to_ascii_uppercase();
    let digits = characters.as_str().trim_start();
    if digits.bytes().all(|digit| digit.is_ascii_digit()) {
        Ok((letter, digits.parse().map_err(|_| NoSuchOperand)?))
    } else {
        Err(NoSuchOperand)
    }
}

/// Consecutive markers with one meaning.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct BitRange {
    first: u16,
    count: u16,
}

impl BitRange {
    pub(crate) const fn fixed(first: u16, count: u16) -> BitRange {
        BitRange { first, count }
    }

    /// So many consecutive markers, of which the first is given; none in another area.
    ///
    /// ```
    /// use bahn_exchange::{BitRange, signal};
    /// let codes = BitRange::from_marker(signal::GEAR_CODE_BIT_1, 3);
    /// assert_eq!(codes.get(2), Some(signal::GEAR_CODE_BIT_3));
    /// ```
    pub const fn from_marker(first: Bit, count: u16) -> BitRange {
        let count = if matches!(first.area(), BitArea::M) {
            count
        } else {
            0
        };
        BitRange {
            first: first.number(),
            count,
        }
    }

    /// The number of markers in the range.
    pub const fn count(self) -> u16 {
        self.count
    }

    /// The marker of an index, counted from 0.
    pub const fn get(self, index: u16) -> Option<Bit> {
        if index < self.count {
            Some(Bit::fixed(BitArea::M, self.first + index))
        } else {
            None
        }
    }

    /// The cells of its markers, which follow each other.
    pub(crate) fn cells(self) -> std::ops::Range<usize> {
        let first = usize::from(BitArea::M.first_cell() + self.first);
        first..first + usize::from(self.count)
    }

    /// The markers of the range, by rising number.
    pub fn iter(self) -> impl Iterator<Item = Bit> {
        (0..self.count).filter_map(move |index| self.get(index))
    }
}

/// Consecutive bytes with one meaning.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct ByteRange {
    first: u16,
    count: u16,
}

impl ByteRange {
    pub(crate) const fn fixed(first: u16, count: u16) -> ByteRange {
        ByteRange { first, count }
    }

    /// The number of bytes in the range.
    pub const fn count(self) -> u16 {
        self.count
    }

    /// The byte of an index, counted from 0.
    pub const fn get(self, index: u16) -> Option<Number> {
        if index < self.count {
            Some(Number::fixed(Size::Byte, self.first + index))
        } else {
            None
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn areas_lie_one_after_the_other() {
        let mut next = 0;
        for area in BitArea::ALL {
            assert_eq!(area.first_cell(), next, "{area:?}");
            next += area.count();
        }
        assert_eq!(next, BYTES_AT);
        for area in BitArea::ALL {
            assert_eq!(area.ranges().last().map(|range| range.1), Some(area.last()));
        }
    }

    #[test]
    fn the_directory_has_gaps() {
        let listed = |text: &str| text.parse::<Bit>().is_ok_and(Bit::is_listed);
        for name in [
            "M0", "M3263", "I31", "I64", "I152", "I175", "I127", "I255", "O30", "O111", "T95", "C127",
        ] {
            assert!(listed(name), "{name}");
        }
        for name in [
            "I32", "I153", "I191", "I256", "O31", "O63", "C32", "C80", "M3264", "T96",
        ] {
            assert!(!listed(name), "{name}");
        }
    }

    #[test]
    fn words_lie_at_even_addresses() {
        assert!("W8".parse::<Number>().is_ok() && "W 1022".parse::<Number>().is_ok());
        for name in ["W7", "D6", "B1024", "W1024", "D1022", "X1", "W", "W-1", ""] {
            assert!(name.parse::<Number>().is_err(), "{name}");
        }
    }
}
