//! The M functions of a channel as they act: what is defined meanwhile takes effect with the change from HAND to AUTO
//! [002:2088-2089] [002:5519-5521].

use crate::m_functions::{M_MAX, MFunction, MRule, RESTART, bits_of};
use crate::memory::Memory;

/// The definitions of all M functions of a channel.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct MTable(Vec<u8>);

impl MTable {
    /// As they are defined now.
    pub fn of(memory: &Memory, channel: u8) -> MTable {
        let mut table = MTable(vec![0; usize::from(M_MAX) + 1]);
        table.read(memory, channel);
        table
    }

    /// Takes the definitions over; allocates nothing.
    pub fn read(&mut self, memory: &Memory, channel: u8) {
        for (m, bits) in (0..).zip(&mut self.0) {
            *bits = bits_of(memory, channel, m);
        }
    }

    /// A function goes out in the simulation of a restart: bit 5.
    pub fn restarts(&self, m: u16) -> bool {
        let bits = self.0.get(usize::from(m)).copied().unwrap_or(0);
        bits & RESTART != 0
    }

    /// How a function acts.
    pub fn rule(&self, m: u16) -> MRule {
        let bits = self.0.get(usize::from(m)).copied().unwrap_or(0);
        MFunction::rule(m, bits)
    }
}
