//! What a channel descriptor says: blocks of parameters, axes, planes [002:629-1158].

use crate::array::{Array, Cell};
use crate::numbers::{AXES, AXIS_WORDS, DESCRIPTOR, FIXED_COUNT};

/// A block of parameters that a descriptor places somewhere in the array.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) struct Window {
    /// The first channel parameter.
    pub first: u32,
    /// The most that there may be.
    pub most: u32,
    /// In the descriptor: where it begins, and how many there are in the next one.
    pub entry: u32,
}

/// The three user blocks [002:671-715].
pub(crate) const WINDOWS: [Window; 3] = [
    Window {
        first: 0,
        most: 7000,
        entry: 2,
    },
    Window {
        first: 20_000,
        most: 10_000,
        entry: 4,
    },
    Window {
        first: 30_000,
        most: 10_000,
        entry: 6,
    },
];

/// The word of a logical axis [002:718-825].
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct AxisWord {
    /// Its letter; 0 for none, then no position of it is shown.
    pub letter: u8,
    /// What stands after the letter; 0 for nothing.
    pub extension: u8,
    /// The physical axis, from 1 on; 0 for none.
    pub physical: u8,
    /// The key that chooses it, from 1 on; 0 for none.
    pub key: u8,
}

impl AxisWord {
    fn from_bits(bits: i32) -> AxisWord {
        let [letter, extension, physical, key] = bits.to_le_bytes();
        AxisWord {
            letter,
            extension,
            physical,
            key,
        }
    }

    /// As programs write it: `X`, `Y3`; empty without a letter.
    pub fn name(self) -> String {
        let of = |byte: u8| match byte {
            0 => String::new(),
            1..=9 => byte.to_string(),
            byte => char::from(byte).to_string(),
        };
        match self.letter {
            0 => String::new(),
            letter => of(letter) + &of(self.extension),
        }
    }

    /// Whether there is such a physical axis.
    pub fn is_there(self) -> bool {
        (1..=AXES).contains(&self.physical)
    }
}

/// The descriptor of a channel.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Descriptor<'a> {
    array: &'a Array,
    begin: u32,
}

impl<'a> Descriptor<'a> {
    pub fn of(array: &'a Array, channel: u8) -> Descriptor<'a> {
        let begin = DESCRIPTOR * u32::from(channel);
        Descriptor { array, begin }
    }

    /// The system parameter of an entry.
    pub fn number(&self, entry: u32) -> u32 {
        self.begin + entry
    }

    pub fn entry(&self, entry: u32) -> Cell {
        self.array.get(self.begin + entry)
    }

    /// An entry that is a number of parameters or of a parameter.
    pub fn count(&self, entry: u32) -> Option<u32> {
        u32::try_from(self.entry(entry).whole()?).ok()
    }

    /// Where a user block begins, and how many parameters it has.
    pub fn window(&self, window: Window) -> Option<(u32, u32)> {
        Some((self.count(window.entry)?, self.count(window.entry + 1)?))
    }

    /// Where the fixed parameters begin: after user block 1.
    pub fn fixed(&self) -> Option<u32> {
        let [first, ..] = WINDOWS;
        let (begin, count) = self.window(first)?;
        begin.checked_add(count)
    }

    /// The word of a logical axis, from 1 on; `None` when it is cleared or says nothing.
    pub fn axis(&self, logical: u8) -> Option<AxisWord> {
        let at = u32::from(logical).checked_sub(1)?;
        let word = self.entry(AXIS_WORDS + at).bits()?;
        (logical <= AXES && word != 0).then(|| AxisWord::from_bits(word))
    }

    /// The axes of the channel by their logical numbers.
    pub fn axes(self) -> impl Iterator<Item = (u8, AxisWord)> + 'a {
        (1..=AXES).filter_map(move |logical| Some((logical, self.axis(logical)?)))
    }

    /// The logical number of a physical axis.
    pub fn logical(self, physical: u8) -> Option<u8> {
        let mut axes = self.axes();
        axes.find(|(_, word)| word.physical == physical)
            .map(|(logical, _)| logical)
    }

    /// The channel parameter of a place in the array, of the blocks that are the channel's own.
    pub fn named(&self, place: u32) -> Option<u32> {
        let within = |begin: u32, count: u32| place.checked_sub(begin).filter(|offset| *offset < count);
        let fixed = self.fixed().and_then(|begin| within(begin, FIXED_COUNT));
        let of_window = |window: &Window| {
            let (begin, count) = self.window(*window)?;
            Some(window.first + within(begin, count.min(window.most))?)
        };
        fixed
            .map(|offset| crate::numbers::FIXED + offset)
            .or_else(|| WINDOWS.iter().find_map(of_window))
    }
}
