//! What the execution of part programs reads and writes of a channel: every number that it needs stands here.

use crate::array::Cell;
use crate::descriptor::AxisWord;
use crate::memory::{Memory, Place, SpaceError};
use crate::name::Name;
use crate::numbers::{AXES, AXIS, AXIS_BLOCK, FURTHER_PLANES, PLANES};
use crate::tools::Layout as ToolLayout;
use crate::zero::Layout as ZeroLayout;

/// The four records of a tool [002:1806-1997].
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum ToolBlock {
    /// For the PLC.
    Plc,
    /// The tool in the spindle.
    Spindle,
    /// What the path is computed with.
    Offsetting,
    /// What is loaded when the block is executed.
    RealTime,
}

/// Parameters of each record [002:1806-1864].
const BLOCK_LENGTH: u32 = 50;
/// Places of a record that have a meaning; behind them lie data of the customer.
const MEANT: u32 = 15;

impl ToolBlock {
    fn first(self) -> u32 {
        match self {
            ToolBlock::Plc => 8050,
            ToolBlock::Spindle => 8100,
            ToolBlock::Offsetting => 8150,
            ToolBlock::RealTime => 8200,
        }
    }
}

/// The parameters of a channel as its programs need them.
#[derive(Clone, Copy, Debug)]
pub struct PathData<'a> {
    memory: &'a Memory,
    channel: u8,
}

impl Memory {
    /// What programs of a channel read.
    pub fn path_data(&self, channel: u8) -> PathData<'_> {
        PathData {
            memory: self,
            channel,
        }
    }

    /// Puts back what a place has held.
    pub fn restore(&mut self, place: Place, cell: Cell) {
        self.put(place, cell);
    }

    /// What a block of tool data holds, by its places.
    pub fn tool_block(&self, channel: u8, block: ToolBlock) -> Vec<(Place, Cell)> {
        let places = (0..BLOCK_LENGTH).filter_map(|at| self.place(Name::P(channel, block.first() + at)).ok());
        places.map(|place| (place, self.at(place))).collect()
    }

    /// Copies the record of a tool from the array, or from another block, into a block.
    ///
    /// # Errors
    /// When the block lies nowhere.
    pub fn load_tool(
        &mut self,
        channel: u8,
        from: u32,
        length: u32,
        to: ToolBlock,
    ) -> Result<(), SpaceError> {
        for at in 0..BLOCK_LENGTH {
            let source = Name::P(channel, from.saturating_add(at));
            let cell = match at < length {
                true => self.cell(source)?,
                false => Cell::default(),
            };
            let place = self.place(Name::P(channel, to.first() + at))?;
            let own = self.at(place).status;
            let status = own
                .with_decimals(cell.status.decimals())
                .loaded(cell.status.is_loaded());
            self.put(
                place,
                Cell {
                    status,
                    mantissa: cell.mantissa,
                },
            );
        }
        Ok(())
    }
}

/// One of the sums and feeds that a program asks for by its number.
macro_rules! numbers {
    ($($(#[$doc:meta])* $name:ident = $number:literal;)*) => {
        $($(#[$doc])*
        pub fn $name(&self) -> Option<f64> {
            self.number($number)
        })*
    };
}

impl PathData<'_> {
    fn cell(&self, number: u32) -> Option<Cell> {
        self.memory.cell(Name::P(self.channel, number)).ok()
    }

    fn number(&self, number: u32) -> Option<f64> {
        self.cell(number)?.number()
    }

    fn bits(&self, number: u32) -> i32 {
        self.cell(number).and_then(Cell::bits).unwrap_or(0)
    }

    /// A number that acts when it is not 0.
    fn positive(&self, number: u32) -> Option<f64> {
        self.number(number).filter(|value| *value > 0.0)
    }

    numbers! {
        /// The block that a start begins at, P8801.
        start_block = 8801;
        /// Percentage of programmed feeds, P8818.
        feed_percent = 8818;
        /// From which change of direction, degrees, blocks are inserted at outer corners, P8845; cleared is always, 0 is
        /// 120 degrees [002:4386-4403].
        insertion_deg = 8845;
        /// Exponent of corners, P8851.
        corner_exponent = 8851;
        /// Chamfer of G12, mm, P70.
        chamfer = 70;
        /// Radius of G12, mm, P71.
        rounding = 71;
    }

    /// Feed in place of that of G1, G2, G3, mm/min, P8815.
    pub fn test_feed(&self) -> Option<f64> {
        self.positive(8815)
    }

    /// Feed of G0, mm/min, P8816.
    pub fn rapid_feed(&self) -> Option<f64> {
        self.positive(8816)
    }

    /// Blocks with a stroke are skipped, P8810.
    pub fn skips(&self) -> bool {
        self.number(8810).is_some_and(|value| value != 0.0)
    }

    /// How G0 ends, P8858: 0 exact stop, 1 feed 0, 2 no stop [002:4651-4660].
    pub fn end_of_rapid(&self) -> i32 {
        self.bits(8858)
    }

    /// The condition of M22, P8714.
    pub fn condition(&self) -> bool {
        self.bits(8714) & 0xFF == 1
    }

    /// The greatest error of a circle's radius, mm, P8843: 0.003 where it is 0 or cleared [002:4371-4376].
    pub fn radius_error_max(&self) -> f64 {
        self.positive(8843).unwrap_or(0.003)
    }

    /// The deviation that limits the feed of circles, mm, P8852.
    pub fn circle_deviation(&self) -> Option<f64> {
        self.positive(8852)
    }

    /// The deviation that limits the feed of all movements by the circles through their points, mm, P8857.
    pub fn outline_deviation(&self) -> Option<f64> {
        self.positive(8857)
    }

    /// How the feed changes on convex and on concave arcs, percent, and the radius from which on it does not: P8848, P8849,
    /// P8850.
    pub fn feed_dynamics(&self) -> [f64; 3] {
        [8848, 8849, 8850].map(|number| self.number(number).unwrap_or(0.0))
    }

    /// Kv of a logical axis, P12020; 16 where it is cleared.
    pub fn kv(&self, logical: u8) -> f64 {
        let axis = AXIS_BLOCK * u32::from(logical.saturating_sub(1));
        self.positive(AXIS.0 + axis + 20).unwrap_or(16.0)
    }

    /// How a logical axis turns: the degrees after which it is where it was, and whether G5 to G7 say which way it goes, P12001
    /// and P12041; `None` for an axis that goes the way that is programmed.
    pub fn turn(&self, logical: u8) -> Option<(f64, bool)> {
        let axis = AXIS.0 + AXIS_BLOCK * u32::from(logical.saturating_sub(1));
        let by_word = match self.bits(axis + 1) {
            2 => false,
            3 => true,
            _ => return None,
        };
        Some((self.positive(axis + 41).unwrap_or(360.0), by_word))
    }

    /// The zero point that AUTO begins with, P8830; 53 where it says none.
    pub fn first_zero_point(&self) -> u16 {
        let said = self.positive(8830).unwrap_or(53.0);
        said as u16
    }

    /// Shift of a logical axis by G44, P8000 to P8031.
    pub fn axis_shift(&self, logical: u8) -> f64 {
        let number = 8000 + u32::from(logical.saturating_sub(1));
        self.number(number).unwrap_or(0.0)
    }

    /// The logical axes that are mirrored about the machine position, P8892: bit 0 is the first.
    pub fn mirrored(&self) -> u32 {
        self.bits(8892).cast_unsigned()
    }

    /// G92 is outside of the rotation of G45, P8859 byte 1 bit 1.
    pub fn g92_is_not_turned(&self) -> bool {
        self.bits(8859) & 0b10 != 0
    }

    /// Origin and angle of G45: P160, P161, P163.
    pub fn rotation(&self) -> [f64; 3] {
        [160, 161, 163].map(|number| self.number(number).unwrap_or(0.0))
    }

    /// The logical axes of a plane: 0 to 2 for G17 to G19, q152 to q154, 3 to 5 for G117 to G119, P8840 to P8842.
    pub fn plane(&self, which: u8) -> [u8; 3] {
        let usual = [0x03_02_01, 0x02_01_03, 0x01_03_02];
        let which = u32::from(which);
        let said = match which.checked_sub(3) {
            None => self.memory.descriptor(self.channel).entry(PLANES + which).bits(),
            Some(further) => self.cell(FURTHER_PLANES + further).and_then(Cell::bits),
        };
        let usual = usual.get(which as usize % 3).copied().unwrap_or_default();
        let bits = said.filter(|bits| bits & 0xFF_FFFF != 0).unwrap_or(usual);
        let [first, second, normal, _] = bits.to_le_bytes();
        [first, second, normal]
    }

    /// The axes of the channel: logical number and word.
    pub fn axes(&self) -> impl Iterator<Item = (u8, AxisWord)> {
        let descriptor = self.memory.descriptor(self.channel);
        (1..=AXES).filter_map(move |logical| Some((logical, descriptor.axis(logical)?)))
    }

    /// The letters that name radius and angle while G10 is in force, q150 and q151; X and C where they are cleared.
    pub fn polar_letters(&self) -> [char; 2] {
        let descriptor = self.memory.descriptor(self.channel);
        [(50, 'X'), (51, 'C')].map(|(entry, usual)| {
            let said = descriptor.entry(entry).bits().unwrap_or(0);
            let letter = u8::try_from(said).ok().filter(u8::is_ascii_alphabetic);
            letter.map_or(usual, |letter| char::from(letter).to_ascii_uppercase())
        })
    }

    /// The sum of the shifts of a logical axis at a zero point, group 0 [002:978-1022]; `None` where there is no such
    /// point.
    pub fn zero_shift(&self, point: u16, logical: u8) -> Option<f64> {
        if point == 53 && ZeroLayout::of(self.memory, self.channel).is_none() {
            return Some(0.0);
        }
        let layout = ZeroLayout::of(self.memory, self.channel)?;
        let point = match point {
            53..=59 => u32::from(point - 53),
            _ => {
                let (hundred, rest) = (u32::from(point) / 100, u32::from(point) % 100);
                7 + 6 * hundred.checked_sub(1)? + rest.checked_sub(54)?
            }
        };
        if point >= layout.points {
            return None;
        }
        let axis = u32::from(logical).checked_sub(1)?;
        if axis >= layout.axes {
            return Some(0.0);
        }
        let area = (self.bits(8555).max(1).cast_unsigned() - 1).min(layout.areas.saturating_sub(1));
        let at = ((area * layout.groups * layout.points) + point).checked_mul(layout.axes)?;
        Some(self.number(layout.first + at + axis).unwrap_or(0.0))
    }

    /// The record of a group in the array: its first parameter and its length.
    pub fn tool_record(&self, group: f64) -> Option<(u32, u32)> {
        let layout = ToolLayout::of(self.memory, self.channel)?;
        let mut records = (0..layout.records).map(|record| layout.first + record * layout.length);
        let first = records.find(|first| self.number(*first) == Some(group))?;
        Some((first, layout.length))
    }

    /// The record of the tool in the spindle, where it has this group.
    pub fn spindle_record(&self, group: f64) -> Option<(u32, u32)> {
        let first = ToolBlock::Spindle.first();
        (self.number(first) == Some(group)).then_some((first, BLOCK_LENGTH))
    }

    /// Length and radius that the path is computed with, each with its correction, mm: P8161, P8163, P8160, P8162.
    pub fn offsets(&self) -> [f64; 2] {
        let first = ToolBlock::Offsetting.first();
        let at = |offset: u32| self.number(first + offset).unwrap_or(0.0);
        [at(11) + at(13), at(10) + at(12)]
    }

    /// The tool change of the block in look-ahead, P8049.
    pub fn tool_m_function(&self) -> Name {
        Name::P(self.channel, 8049)
    }

    /// Group of the tool when the block is executed, P8048.
    pub fn tool_group(&self) -> Name {
        Name::P(self.channel, 8048)
    }

    /// What the record for execution gets when the block is executed, by system parameters.
    pub fn real_time_tool(&self, (first, length): (u32, u32)) -> Vec<(u32, Option<f64>)> {
        let of = |at: u32| {
            let to = Name::P(self.channel, ToolBlock::RealTime.first() + at);
            let value = if at < length {
                self.number(first + at)
            } else {
                None
            };
            Some((self.memory.q(to).ok()?, value))
        };
        (0..MEANT).filter_map(of).collect()
    }

    /// Where the programmed speed of a spindle word is shown when it is executed, P8925 to P8932.
    pub fn speed(&self, word: u8) -> Name {
        Name::P(self.channel, 8924 + u32::from(word))
    }

    /// How speeds are meant when it is executed, P8981: 96 or 97.
    pub fn speed_kind(&self) -> Name {
        Name::P(self.channel, 8981)
    }

    /// P30 to P39 of the drilling functions.
    pub fn drilling(&self) -> [Option<f64>; 10] {
        std::array::from_fn(|at| self.number(30 + at as u32))
    }

    /// P100 to P126 of the patterns.
    pub fn pattern(&self) -> [Option<f64>; 27] {
        std::array::from_fn(|at| self.number(100 + at as u32))
    }

    /// Drilling stays in force until G80, P8806 byte 3 bit 0.
    pub fn drilling_is_modal(&self) -> bool {
        self.bits(8806) >> 16 & 1 != 0
    }

    /// Which of the messages 1154 (bit 0) and 1155 (bit 1) are suppressed, P8844.
    pub fn suppressed(&self) -> i32 {
        self.bits(8844)
    }

    /// The spindle that G95 counts, P8860 byte 1: 1 where it is 0.
    pub fn feed_spindle(&self) -> u8 {
        let [first, ..] = self.bits(8860).to_le_bytes();
        first.clamp(1, 8)
    }
}
