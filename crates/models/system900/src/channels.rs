//! Sets of channels, as a byte of a parameter has them: bit 0 is channel 1.

use std::fmt;

use crate::numbers::CHANNELS_MAX;

/// Some of the channels 1 to 8.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
pub struct Channels(u8);

impl Channels {
    /// No channel.
    pub const NONE: Channels = Channels(0);

    /// Of a byte.
    pub fn from_bits(bits: u8) -> Channels {
        Channels(bits)
    }

    /// The byte.
    pub fn bits(self) -> u8 {
        self.0
    }

    /// One channel, from 1 on; none for a number that is no channel.
    pub fn one(channel: u8) -> Channels {
        let is_channel = (1..=CHANNELS_MAX).contains(&channel);
        Channels(if is_channel { 1 << (channel - 1) } else { 0 })
    }

    /// The channels 1 to this one.
    pub fn up_to(channel: u8) -> Channels {
        (1..=channel.min(CHANNELS_MAX)).fold(Channels::NONE, |all, channel| all.and(Channels::one(channel)))
    }

    /// Those of either.
    pub fn and(self, other: Channels) -> Channels {
        Channels(self.0 | other.0)
    }

    /// Whether a channel is one of them.
    pub fn contains(self, channel: u8) -> bool {
        self.0 & Channels::one(channel).0 != 0
    }

    /// Whether there is none.
    pub fn is_empty(self) -> bool {
        self.0 == 0
    }

    /// Their numbers, from 1 on.
    pub fn iter(self) -> impl Iterator<Item = u8> {
        (1..=CHANNELS_MAX).filter(move |channel| self.contains(*channel))
    }
}

/// As `1, 2`; `none` for none.
impl fmt::Display for Channels {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        if self.is_empty() {
            return f.write_str("none");
        }
        for (at, channel) in self.iter().enumerate() {
            let before = if at == 0 { "" } else { ", " };
            write!(f, "{before}{channel}")?;
        }
        Ok(())
    }
}
