//! The memory of the parameters: where the name of one leads, what it holds, who takes notice of a write.
//!
//! Decision: Without q2 there is one channel, without q3 there are 30000 parameters, the least of both

use crate::array::{Array, Cell, PARAMETERS_MAX, PARAMETERS_MIN};
use crate::descriptor::{Descriptor, WINDOWS};
use crate::lock::Lock;
use crate::name::Name;
use crate::numbers::{
    AXES, AXIS, AXIS_BLOCK, AXIS_OWN, CHANNELS, CHANNELS_MAX, FIXED, FIXED_COUNT, MAPPING_TEST, SHARED,
    SHARED_COUNT,
};
use crate::status::{Receivers, Status};
use crate::value::{Value, ValueError};

/// Where a parameter lies.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub enum Place {
    /// A system parameter: its number.
    Q(u32),
    /// One that each channel has for itself, without a system parameter: channel and logical axis from 1 on, place in
    /// the parameters of the axis [002:8350-8360].
    OfChannel(u8, u8, u32),
}

impl Place {
    /// The number of the system parameter; `None` for one that has none.
    pub fn q(self) -> Option<u32> {
        match self {
            Place::Q(number) => Some(number),
            Place::OfChannel(..) => None,
        }
    }
}

/// Why a name leads nowhere, or a write is refused.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum SpaceError {
    /// The array is shorter.
    #[error("{name} is no parameter: the last one is q{}", count - 1)]
    BeyondArray {
        /// Which.
        name: Name,
        /// How many system parameters there are.
        count: usize,
    },
    /// The channel is not among those of q2.
    #[error("{name}: there is no channel {channel}, q2 is {channels}")]
    NoChannel {
        /// Which.
        name: Name,
        /// Its channel.
        channel: u8,
        /// How many there are.
        channels: u8,
    },
    /// The descriptor says nothing of the block.
    #[error("{name}: q{begin} and q{count} of the channel do not say where it lies")]
    NoBlock {
        /// Which.
        name: Name,
        /// Where the block would begin.
        begin: u32,
        /// How many parameters it would have.
        count: u32,
    },
    /// The block has fewer parameters.
    #[error("{name}: its block has {count} parameters, q{entry}")]
    BeyondBlock {
        /// Which.
        name: Name,
        /// How many it has.
        count: u32,
        /// Where that stands.
        entry: u32,
    },
    /// The channel has no such axis.
    #[error("{name}: logical axis {logical} of channel {channel} is no physical axis, q{entry}")]
    NoAxis {
        /// Which.
        name: Name,
        /// Its channel.
        channel: u8,
        /// Its axis.
        logical: u8,
        /// Where the axis would stand.
        entry: u32,
    },
    /// The number belongs to no block.
    #[error("{0} is no parameter: its number is assigned to nothing")]
    Unassigned(Name),
    /// It is a parameter of the channel alone.
    #[error("{0} exists per channel and has no q number")]
    PerChannel(Name),
    /// The value does not go in.
    #[error("{0}: {1}")]
    Value(Name, ValueError),
    /// A parameter lock that is set locks it.
    #[error("{0} is locked by parameter lock {1}")]
    Locked(Name, u8),
    /// P11308 is given a value that is no unit.
    #[error("{0} is 0 for metric lengths, 1, 2 or 3 for inches")]
    NoUnit(Name),
    /// Another lock that is active closes it.
    #[error("{0} is locked by {1}")]
    Closed(Name, Lock),
}

impl SpaceError {
    /// The same of the name by which somebody called the parameter.
    pub(crate) fn of_name(self, name: Name) -> SpaceError {
        match self {
            SpaceError::Value(_, error) => SpaceError::Value(name, error),
            SpaceError::Locked(_, lock) => SpaceError::Locked(name, lock),
            SpaceError::Closed(_, lock) => SpaceError::Closed(name, lock),
            other => other,
        }
    }

    /// A write that a lock holds back.
    pub(crate) fn of_lock(name: Name, lock: Lock) -> SpaceError {
        match lock {
            Lock::Parameters(lock) => SpaceError::Locked(name, lock),
            lock => SpaceError::Closed(name, lock),
        }
    }
}

/// The parameters of a control.
///
/// ```
/// use bahn_system900::{Memory, Name};
/// let mut memory = Memory::new();
/// for (name, value) in [("q102", "10000"), ("q103", "5000"), ("P7000", "12.5")] {
///     memory.enter(name.parse()?, value.parse()?)?;
/// }
/// // In channel 1, P7000 is the 5000th parameter after the user block that begins at q10000.
/// assert_eq!(memory.q("P7000".parse()?)?, 15_000);
/// assert_eq!(memory.cell(Name::Q(15_000))?.number(), Some(12.5));
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
#[derive(Clone, Debug, PartialEq)]
pub struct Memory {
    array: Array,
    /// Of channel, logical axis and place, in this order.
    of_channels: Array,
}

impl Default for Memory {
    fn default() -> Memory {
        Memory::new()
    }
}

impl Memory {
    /// The least number of parameters, all of them cleared.
    pub fn new() -> Memory {
        let own = AXIS_OWN.len() * usize::from(AXES) * usize::from(CHANNELS_MAX);
        Memory {
            array: Array::new(PARAMETERS_MIN),
            of_channels: Array::new(own),
        }
    }

    /// Without any parameter.
    pub(crate) fn of_nothing() -> Memory {
        Memory {
            array: Array::new(0),
            of_channels: Array::new(0),
        }
    }

    /// How many system parameters there are.
    pub fn count(&self) -> usize {
        self.array.len()
    }

    /// Makes room for so many system parameters, from 30000 to 50000; a number beyond these is the nearest.
    pub fn resize(&mut self, count: usize) {
        self.array.resize(count.clamp(PARAMETERS_MIN, PARAMETERS_MAX));
    }

    /// The channels that there are, q2.
    pub fn channels(&self) -> u8 {
        let said = self.array.get(CHANNELS).whole().unwrap_or(1);
        u8::try_from(said.clamp(1, CHANNELS_MAX.into())).unwrap_or(1)
    }

    pub(crate) fn descriptor(&self, channel: u8) -> Descriptor<'_> {
        Descriptor::of(&self.array, channel)
    }

    /// A system parameter; one that is not there is cleared.
    pub(crate) fn system(&self, number: u32) -> Cell {
        self.array.get(number)
    }

    /// A parameter that all channels share, by its channel number.
    pub(crate) fn shared(&self, number: u32) -> Cell {
        self.array.get(number.saturating_sub(SHARED.0) + SHARED.1)
    }

    /// What the control itself enters: a number without decimals. Nothing else happens with it.
    pub(crate) fn set_at(&mut self, place: Place, number: Option<i32>) {
        let cell = self.at(place);
        let value = number.map_or(Value::Cleared, |number| Value::Decimal {
            digits: number.into(),
            decimals: 0,
        });
        // With the decimals of its status; without them where it would not go in.
        let counted = value.counted(cell.status.decimals());
        let (mantissa, decimals) = counted.unwrap_or((number, 0));
        let status = cell.status.with_decimals(decimals).loaded(mantissa.is_some());
        self.put(
            place,
            Cell {
                mantissa: mantissa.unwrap_or(0),
                status,
            },
        );
    }

    /// The same for a parameter that all channels share.
    pub(crate) fn set_shared(&mut self, number: u32, value: i32) {
        self.set_at(Place::Q(number.saturating_sub(SHARED.0) + SHARED.1), Some(value));
    }

    /// The four bytes of a system parameter, whatever decimals it has.
    pub(crate) fn set_word(&mut self, number: u32, mantissa: i32) {
        let place = Place::Q(number);
        let status = self.at(place).status.loaded(true);
        self.put(place, Cell { mantissa, status });
    }

    /// The same for a name; a parameter that is not there takes nothing.
    pub(crate) fn set_number(&mut self, name: Name, value: Option<i32>) {
        if let Ok(place) = self.place(name) {
            self.set_at(place, value);
        }
    }

    /// Where a name leads now. Descriptors are parameters, too: a change moves the places of a channel.
    ///
    /// # Errors
    /// Why it leads nowhere.
    pub fn place(&self, name: Name) -> Result<Place, SpaceError> {
        let place = match name {
            Name::Q(number) => Place::Q(number),
            Name::P(channel, number) => self.place_of_channel(name, channel, number)?,
        };
        let is_beyond = |number: u32| number as usize >= self.count();
        match place {
            Place::Q(number) if is_beyond(number) => Err(SpaceError::BeyondArray {
                name,
                count: self.count(),
            }),
            place => Ok(place),
        }
    }

    /// The system parameter that a name means now.
    ///
    /// # Errors
    /// Why it means none.
    pub fn q(&self, name: Name) -> Result<u32, SpaceError> {
        self.place(name)?.q().ok_or(SpaceError::PerChannel(name))
    }

    /// [002:671-715] [002:61-111]; numbers between the blocks are nobody's.
    fn place_of_channel(&self, name: Name, channel: u8, number: u32) -> Result<Place, SpaceError> {
        let channels = self.channels();
        if !(1..=channels).contains(&channel) {
            return Err(SpaceError::NoChannel {
                name,
                channel,
                channels,
            });
        }
        let descriptor = self.descriptor(channel);
        let no_block = |entry: u32| SpaceError::NoBlock {
            name,
            begin: descriptor.number(entry),
            count: descriptor.number(entry + 1),
        };
        if (FIXED..FIXED + FIXED_COUNT).contains(&number) {
            let [first, ..] = WINDOWS;
            let begin = descriptor.fixed().ok_or_else(|| no_block(first.entry))?;
            return Ok(Place::Q(begin.saturating_add(number - FIXED)));
        }
        if (SHARED.0..SHARED.0 + SHARED_COUNT).contains(&number) {
            return Ok(Place::Q(number - SHARED.0 + SHARED.1));
        }
        if (AXIS.0..AXIS.0 + AXIS_BLOCK * u32::from(AXES)).contains(&number) {
            return self.place_of_axis(name, channel, number - AXIS.0);
        }
        let mut windows = WINDOWS.iter();
        let window = windows.find(|window| (window.first..window.first + window.most).contains(&number));
        let window = *window.ok_or(SpaceError::Unassigned(name))?;
        let (begin, count) = descriptor.window(window).ok_or_else(|| no_block(window.entry))?;
        let offset = number - window.first;
        match offset < count {
            true => Ok(Place::Q(begin.saturating_add(offset))),
            false => Err(SpaceError::BeyondBlock {
                name,
                count,
                entry: descriptor.number(window.entry + 1),
            }),
        }
    }

    fn place_of_axis(&self, name: Name, channel: u8, at: u32) -> Result<Place, SpaceError> {
        let logical = u8::try_from(at / AXIS_BLOCK + 1).unwrap_or(AXES);
        let offset = at % AXIS_BLOCK;
        let descriptor = self.descriptor(channel);
        let word = descriptor.axis(logical).filter(|word| word.is_there());
        let Some(word) = word else {
            return Err(SpaceError::NoAxis {
                name,
                channel,
                logical,
                entry: descriptor.number(crate::numbers::AXIS_WORDS + u32::from(logical) - 1),
            });
        };
        Ok(match AXIS_OWN.contains(&offset) {
            true => Place::OfChannel(channel, logical, offset),
            false => Place::Q(AXIS.1 + AXIS_BLOCK * (u32::from(word.physical) - 1) + offset),
        })
    }

    /// The name of a place: that of a channel parameter where there is one, of the lowest channel that has it.
    pub fn name_of(&self, place: Place) -> Name {
        let number = match place {
            Place::OfChannel(channel, logical, offset) => {
                let axis = AXIS_BLOCK * (u32::from(logical) - 1);
                return Name::P(channel, AXIS.0 + axis + offset);
            }
            Place::Q(number) => number,
        };
        if (SHARED.1..SHARED.1 + SHARED_COUNT).contains(&number) {
            return Name::P(1, number - SHARED.1 + SHARED.0);
        }
        let channels = 1..=self.channels();
        let of_axes = AXIS.1..AXIS.1 + AXIS_BLOCK * u32::from(AXES);
        let named = channels.into_iter().find_map(|channel| {
            let descriptor = self.descriptor(channel);
            let number = if of_axes.contains(&number) {
                let (axis, offset) = ((number - AXIS.1) / AXIS_BLOCK, (number - AXIS.1) % AXIS_BLOCK);
                let logical = descriptor.logical(u8::try_from(axis + 1).ok()?)?;
                let is_shared = !AXIS_OWN.contains(&offset);
                is_shared.then(|| AXIS.0 + AXIS_BLOCK * (u32::from(logical) - 1) + offset)?
            } else {
                descriptor.named(number)?
            };
            Some(Name::P(channel, number))
        });
        named.unwrap_or(Name::Q(number))
    }

    fn index_of_channel(channel: u8, logical: u8, offset: u32) -> u32 {
        let axis =
            u32::from(channel.saturating_sub(1)) * u32::from(AXES) + u32::from(logical.saturating_sub(1));
        let count = AXIS_OWN.end - AXIS_OWN.start;
        axis * count + offset.saturating_sub(AXIS_OWN.start)
    }

    /// What a place holds.
    pub fn at(&self, place: Place) -> Cell {
        match place {
            Place::Q(number) => self.array.get(number),
            Place::OfChannel(channel, logical, offset) => self
                .of_channels
                .get(Memory::index_of_channel(channel, logical, offset)),
        }
    }

    /// What a parameter holds.
    ///
    /// # Errors
    /// When the name leads nowhere.
    pub fn cell(&self, name: Name) -> Result<Cell, SpaceError> {
        Ok(self.at(self.place(name)?))
    }

    pub(crate) fn put(&mut self, place: Place, cell: Cell) {
        let slot = match place {
            Place::Q(number) => self.array.slot(number as usize),
            Place::OfChannel(channel, logical, offset) => {
                let index = Memory::index_of_channel(channel, logical, offset);
                self.of_channels.slot(index as usize)
            }
        };
        if let Some(slot) = slot {
            *slot = cell;
        }
    }

    /// Writes a value past all locks, as the PLC may [002:358-362]; who takes notice of it.
    ///
    /// # Errors
    /// When the name leads nowhere, or the value does not go in.
    pub fn write(&mut self, name: Name, value: Value) -> Result<Receivers, SpaceError> {
        let place = self.place(name)?;
        let status = self.at(place).status;
        let (mantissa, decimals) = value
            .counted(status.decimals())
            .map_err(|error| SpaceError::Value(name, error))?;
        let status = status.with_decimals(decimals).loaded(mantissa.is_some());
        let mantissa = mantissa.unwrap_or(0);
        self.put(place, Cell { mantissa, status });
        self.test_mapping(name);
        Ok(status.receivers())
    }

    /// A number in P8553 gives its system parameter in P8554; one that has none clears it [002:3453-3457].
    fn test_mapping(&mut self, name: Name) {
        let Name::P(channel, MAPPING_TEST) = name else {
            return;
        };
        let asked = self.cell(name).ok().and_then(Cell::whole);
        let asked = asked.and_then(|number| u32::try_from(number).ok());
        let found = asked.and_then(|number| self.q(Name::P(channel, number)).ok());
        let answer = match found {
            Some(number) => Value::Decimal {
                digits: number.into(),
                decimals: 0,
            },
            None => Value::Cleared,
        };
        // Its neighbour is there as it is.
        let _ = self.write(Name::P(channel, MAPPING_TEST + 1), answer);
    }

    /// Sets the status; a lock does not hold it back [002:358-362]. Whether it is loaded follows from its content.
    ///
    /// # Errors
    /// When the name leads nowhere.
    pub fn set_status(&mut self, name: Name, status: Status) -> Result<(), SpaceError> {
        let place = self.place(name)?;
        let cell = self.at(place);
        let status = status.loaded(cell.status.is_loaded());
        self.put(place, Cell { status, ..cell });
        Ok(())
    }

    /// What the control does when it starts: parameters of channels get the status of the system parameters at
    /// their place [002:8350-8360], and the bit for the operating panel is reset everywhere [002:318-321].
    pub fn start(&mut self) {
        self.array.start();
        for channel in 1..=self.channels() {
            let axes: Vec<_> = self.descriptor(channel).axes().collect();
            for (logical, word) in axes.into_iter().filter(|(_, word)| word.is_there()) {
                for offset in AXIS_OWN {
                    let template = AXIS.1 + AXIS_BLOCK * (u32::from(word.physical) - 1) + offset;
                    let place = Place::OfChannel(channel, logical, offset);
                    let cell = self.at(place);
                    let status = self.array.get(template).status;
                    let status = status.loaded(cell.status.is_loaded());
                    self.put(place, Cell { status, ..cell });
                }
            }
        }
    }

    /// All places that hold something.
    pub fn loaded(&self) -> impl Iterator<Item = Place> {
        self.places().filter(|place| self.at(*place).status.is_loaded())
    }

    /// All places.
    pub(crate) fn places(&self) -> impl Iterator<Item = Place> + use<> {
        let count = u32::try_from(self.count()).unwrap_or(u32::MAX);
        let channels = (1..=CHANNELS_MAX).flat_map(|channel| {
            (1..=AXES).flat_map(move |logical| {
                AXIS_OWN.map(move |offset| Place::OfChannel(channel, logical, offset))
            })
        });
        (0..count).map(Place::Q).chain(channels)
    }

    /// What all places hold.
    pub(crate) fn cells_mut(&mut self) -> impl Iterator<Item = &mut Cell> {
        self.array.cells_mut().chain(self.of_channels.cells_mut())
    }
}
