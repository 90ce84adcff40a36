//! What a running control reads and writes by meaning, not by name: no write here is held back, and none allocates.
//!
//! Decision: What the control writes has the decimals of q159 as a position, three as another length, angle, percentage or
//! voltage, none as a number; a value too great for them loses decimals, not digits

use crate::array::Cell;
use crate::axis_block::AxisParameter;
use crate::channel_block::ChannelParameter;
use crate::memory::{Memory, Place};
use crate::name::Name;
use crate::numbers::{AXES, AXIS, AXIS_BLOCK, AXIS_OWN, FIXED, FIXED_COUNT, LOCK_SWITCHES, SHARED};
use crate::table::row;
use crate::value::DECIMALS_MAX;

/// What a place means to a running control.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Meaning {
    /// A fixed parameter of a channel, from 1 on.
    OfChannel(u8, ChannelParameter),
    /// A parameter of a physical axis, from 1 on.
    OfAxis(u8, AxisParameter),
    /// An override, from 1 on: how its potentiometer stands.
    Override(u8),
    /// A switch of locks, or what it locks.
    Locks,
    /// Nothing that runs a routine.
    Nothing,
}

impl Memory {
    /// The unit of a parameter, as its axis turns or not; empty where the table names none.
    ///
    /// ```
    /// use bahn_system900::DataFile;
    /// let file = DataFile::read(b"q102: 10000\nq103: 5000\nq110: $01010058\nq111: $02020043\nP12001: 0\nP12201: 1\n");
    /// let unit = |name: &str| name.parse().map(|name| file.memory().unit(name));
    /// assert_eq!((unit("P12151")?, unit("P12351")?, unit("P8685")?), ("mm", "degree", ""));
    /// # Ok::<(), bahn_system900::NoName>(())
    /// ```
    pub fn unit(&self, name: Name) -> &'static str {
        let unit = row(name).map_or("", |row| row.unit);
        let turns = self.place(name).ok().and_then(|place| self.axis_of(place));
        let turns = turns.map(|physical| self.of_axis(physical, AxisParameter::Rotary).whole() == Some(1));
        match (unit.split_once(", "), turns) {
            (Some((linear, _)), Some(false)) => linear,
            (Some((_, rotary)), Some(true)) => rotary,
            _ => unit,
        }
    }

    /// The physical axis whose parameter lies at a place.
    fn axis_of(&self, place: Place) -> Option<u8> {
        match place {
            Place::Q(_) => match self.meaning(place) {
                Meaning::OfAxis(physical, _) => Some(physical),
                _ => None,
            },
            Place::OfChannel(channel, logical, _) => {
                let mut axes = self.axes_of(channel);
                axes.find(|(of, _)| *of == logical).map(|(_, physical)| physical)
            }
        }
    }

    /// What a place means.
    pub fn meaning(&self, place: Place) -> Meaning {
        let Place::Q(number) = place else {
            return Meaning::Nothing;
        };
        let (first, last) = (AXIS.1, AXIS.1 + AXIS_BLOCK * u32::from(AXES));
        if (first..last).contains(&number) {
            let physical = u8::try_from((number - first) / AXIS_BLOCK + 1).unwrap_or(AXES);
            let parameter = AxisParameter::of_number((number - first) % AXIS_BLOCK);
            return parameter.map_or(Meaning::Nothing, |parameter| Meaning::OfAxis(physical, parameter));
        }
        if let Some(number) = crate::shared_block::override_at(number) {
            return Meaning::Override(number);
        }
        if LOCK_SWITCHES.contains(&(number.saturating_sub(SHARED.1) + SHARED.0)) {
            return Meaning::Locks;
        }
        let of_channel = (1..=self.channels()).find_map(|channel| {
            let fixed = self.descriptor(channel).fixed()?;
            let offset = number.checked_sub(fixed).filter(|offset| *offset < FIXED_COUNT)?;
            Some(Meaning::OfChannel(
                channel,
                ChannelParameter::of_number(FIXED + offset)?,
            ))
        });
        of_channel.unwrap_or(Meaning::Nothing)
    }

    /// A write runs a routine of the control: a program that writes it does so where the path is, not in the look-ahead.
    pub fn runs_routine(&self, place: Place) -> bool {
        match self.meaning(place) {
            Meaning::OfAxis(_, parameter) => matches!(
                parameter,
                AxisParameter::GoRelative
                    | AxisParameter::GoAbsolute
                    | AxisParameter::GoEmergency
                    | AxisParameter::GoFixed
                    | AxisParameter::Reference
            ),
            Meaning::OfChannel(_, parameter) => matches!(
                parameter,
                ChannelParameter::SystemMessage
                    | ChannelParameter::HighMessage
                    | ChannelParameter::LowMessage
                    | ChannelParameter::DisplayMessage
                    | ChannelParameter::TakeTool
                    | ChannelParameter::OffsetCommand
                    | ChannelParameter::StoreTool
                    | ChannelParameter::BlockFeed
            ),
            Meaning::Override(_) | Meaning::Locks => true,
            Meaning::Nothing => false,
        }
    }

    /// A memory without any parameter, where another one stood: it takes no room.
    pub fn none() -> Memory {
        Memory::of_nothing()
    }

    /// Where a fixed parameter of a channel lies; `None` when its descriptor does not say.
    pub fn channel_place(&self, channel: u8, parameter: ChannelParameter) -> Option<Place> {
        self.channel_place_at(channel, parameter, 0)
    }

    /// Where the one lies that comes so many after it.
    pub fn channel_place_at(&self, channel: u8, parameter: ChannelParameter, after: u32) -> Option<Place> {
        let begin = self.descriptor(channel).fixed()?;
        Some(Place::Q(begin + parameter.number() - FIXED + after))
    }

    /// What a fixed parameter of a channel holds; cleared where there is none.
    pub fn of_channel(&self, channel: u8, parameter: ChannelParameter) -> Cell {
        self.channel_place(channel, parameter)
            .map_or_else(Cell::default, |place| self.at(place))
    }

    /// Stores a number in a fixed parameter of a channel, without decimals.
    pub fn set_channel(&mut self, channel: u8, parameter: ChannelParameter, number: i64) {
        if let Some(place) = self.channel_place(channel, parameter) {
            self.store(place, Some(number as f64), 0);
        }
    }

    /// Where a parameter of a physical axis lies; `None` for those that each channel has for itself.
    pub fn axis_place(physical: u8, parameter: AxisParameter) -> Option<Place> {
        let at = AXIS_BLOCK * u32::from(physical.checked_sub(1)?) + parameter.number();
        (!AXIS_OWN.contains(&parameter.number())).then_some(Place::Q(AXIS.1 + at))
    }

    /// What a parameter of a physical axis holds.
    pub fn of_axis(&self, physical: u8, parameter: AxisParameter) -> Cell {
        Memory::axis_place(physical, parameter).map_or_else(Cell::default, |place| self.at(place))
    }

    /// Stores a number in a parameter of a physical axis.
    pub fn set_axis(&mut self, physical: u8, parameter: AxisParameter, number: f64, decimals: u8) {
        if let Some(place) = Memory::axis_place(physical, parameter) {
            self.store(place, Some(number), decimals);
        }
    }

    /// Where a parameter of a logical axis lies that each channel has for itself.
    pub fn own_place(channel: u8, logical: u8, parameter: AxisParameter) -> Place {
        Place::OfChannel(channel, logical, parameter.number())
    }

    /// Stores a number with decimals, or clears the parameter; what is no number clears it, too.
    pub fn store(&mut self, place: Place, number: Option<f64>, decimals: u8) {
        let before = self.at(place).status;
        let Some(number) = number.filter(|number| number.is_finite()) else {
            let status = before.loaded(false);
            return self.put(place, Cell { mantissa: 0, status });
        };
        let mut decimals = decimals.min(DECIMALS_MAX);
        let mut counted = number * scale(decimals);
        while counted.abs() > f64::from(i32::MAX) && decimals > 0 {
            decimals -= 1;
            counted = number * scale(decimals);
        }
        let status = before.with_decimals(decimals).loaded(true);
        let mantissa = counted.round() as i32;
        self.put(place, Cell { mantissa, status });
    }

    /// Stores a number as a program gives it: decimals are raised to what it needs, at most nine [002:364].
    pub fn store_exact(&mut self, place: Place, number: Option<f64>) {
        let least = self.at(place).status.decimals();
        let needs = |decimals: &u8| {
            let counted = number.unwrap_or(0.0) * scale(*decimals);
            (counted - counted.round()).abs() < 1e-6 * counted.abs().max(1.0)
        };
        let decimals = (least..=DECIMALS_MAX).find(needs).unwrap_or(DECIMALS_MAX);
        self.store(place, number, decimals);
    }

    /// The displays of a channel leave no shifts out: P12157 of its axes is cleared.
    pub fn forget_shifts(&mut self, channel: u8) {
        for logical in 1..=AXES {
            self.store(
                Memory::own_place(channel, logical, AxisParameter::DisplayShift),
                None,
                0,
            );
        }
    }

    /// Stores the integer of a number, of which the decimals that the parameter has stand after the point.
    pub fn store_mantissa(&mut self, place: Place, mantissa: i32) {
        let status = self.at(place).status.loaded(true);
        self.put(place, Cell { mantissa, status });
    }

    /// Stores bits as they are.
    pub fn store_bits(&mut self, place: Place, bits: i32) {
        let status = self.at(place).status.with_decimals(0).loaded(true);
        self.put(
            place,
            Cell {
                mantissa: bits,
                status,
            },
        );
    }
}

/// 10 to the power of so many decimals.
fn scale(decimals: u8) -> f64 {
    const SCALES: [f64; DECIMALS_MAX as usize + 1] = [1e0, 1e1, 1e2, 1e3, 1e4, 1e5, 1e6, 1e7, 1e8, 1e9];
    SCALES.get(usize::from(decimals)).copied().unwrap_or(1.0)
}
