//! Which locks are active: key switches, the software switch, and the locks of AUTO [002:5273-5417].
//!
//! Decision: A switch that is closed, 1, sets the locks of its definition; several add up

use crate::channel_block::ChannelParameter;
use crate::memory::{Memory, Place};
use crate::numbers::SHARED;
use crate::status::LOCKS;

/// The switches with their definitions: keys 1 to 4, software [002:5244-5270] [002:5318-5365].
const SWITCHES: [(u32, u32); 5] = [
    (11_000, 11_010),
    (11_001, 11_011),
    (11_002, 11_012),
    (11_003, 11_013),
    (11_008, 11_018),
];
/// Active parameter locks, memory locks, editing locks: the first of each [002:5380-5417].
const PARAMETER_LOCKS: u32 = 11_020;
const MEMORY_LOCKS: u32 = 11_036;
const EDIT_LOCKS: u32 = 11_044;
const MEMORY_COUNT: u8 = 2;
const EDIT_COUNT: u8 = 6;

/// A parameter that all channels share.
fn shared(number: u32) -> Place {
    Place::Q(number - SHARED.0 + SHARED.1)
}

/// A place is a switch, or the definition of one.
pub(crate) fn is_switch(number: u32) -> bool {
    let is = |named: u32| shared(named).q() == Some(number);
    SWITCHES
        .iter()
        .any(|(switch, definition)| is(*switch) || is(*definition))
}

impl Memory {
    /// Sets the locks as the switches stand and the channels of a set, bit 0 the first, are in AUTO.
    pub fn follow_locks(&mut self, automatic: u8) {
        let mut active = [0u8; 4];
        let mut add = |bits: Option<i32>| {
            for (all, byte) in active.iter_mut().zip(bits.unwrap_or(0).to_le_bytes()) {
                *all |= byte;
            }
        };
        for (switch, definition) in SWITCHES {
            if self.at(shared(switch)).whole() == Some(1) {
                add(self.at(shared(definition)).bits());
            }
        }
        for channel in (1..=self.channels()).filter(|channel| automatic >> (channel - 1) & 1 != 0) {
            add(self.of_channel(channel, ChannelParameter::AutomaticLocks).bits());
        }
        let [parameters, _, memories, edits] = active;
        for lock in 0..LOCKS {
            self.set_lock(lock + 1, parameters >> lock & 1 != 0);
        }
        for (first, count, bits) in [
            (PARAMETER_LOCKS, LOCKS, parameters),
            (MEMORY_LOCKS, MEMORY_COUNT, memories),
            (EDIT_LOCKS, EDIT_COUNT, edits),
        ] {
            for at in 0..count {
                let place = shared(first + u32::from(at));
                self.store(place, Some(f64::from(bits >> at & 1)), 0);
            }
        }
    }
}
