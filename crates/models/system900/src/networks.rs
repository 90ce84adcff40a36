//! Networks of channels: whose mode changes together, who stops and aborts together, who shows whose messages [002:1272-1350].
//!
//! Decision: A network says something of the channels that its mask names; for others each stands alone. A channel in
//! the masks of several networks goes with the channels of all of them
//!
//! Decision: A message of a channel in a mask is shown in all channels of the mask, and one of another channel in its own

use crate::channels::Channels;
use crate::memory::Memory;
use crate::messages::MessageKind;
use crate::numbers::{NETWORK, NETWORKS, NETWORKS_MAX};

/// In a network: mode, stop, abort, messages of the control, of the PLC.
const MODE: u32 = 3;
const STOP: u32 = 4;
const ABORT: u32 = 5;
const OF_CONTROL: u32 = 8;
const OF_PLC: u32 = 9;

/// What channels do together.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Together {
    /// A write of P8683 is one in all of them.
    Mode,
    /// The stop key of one stops all; a stop by messages, measuring or the end of a program does not.
    Stop,
    /// The abort of one aborts all.
    Abort,
    /// They show a message of this kind of the control.
    Message(MessageKind),
    /// They show a message of the PLC: with high priority or not.
    OfPlc {
        /// With high priority.
        high: bool,
    },
}

impl Together {
    /// In a network: the parameter, and the byte of it, from 0 on.
    fn place(self) -> (u32, usize) {
        match self {
            Together::Mode => (MODE, 0),
            Together::Stop => (STOP, 0),
            Together::Abort => (ABORT, 0),
            Together::Message(kind) => (OF_CONTROL, kind.index()),
            Together::OfPlc { high: true } => (OF_PLC, 0),
            Together::OfPlc { high: false } => (OF_PLC, 1),
        }
    }
}

/// The mask of a network, 1 to 4.
pub fn network(memory: &Memory, network: u32, what: Together) -> Channels {
    if !(1..=NETWORKS_MAX).contains(&network) {
        return Channels::NONE;
    }
    let (entry, byte) = what.place();
    let bits = memory.system(NETWORKS + NETWORK * (network - 1) + entry).bits();
    let bytes = bits.unwrap_or(0).to_le_bytes();
    Channels::from_bits(bytes.get(byte).copied().unwrap_or(0))
}

/// The channels that do something with a channel, itself among them. It acts as soon as a mask is written.
pub fn together(memory: &Memory, channel: u8, what: Together) -> Channels {
    let masks = (1..=NETWORKS_MAX).map(|number| network(memory, number, what));
    let with = masks.filter(|mask| mask.contains(channel));
    with.fold(Channels::one(channel), Channels::and)
}
