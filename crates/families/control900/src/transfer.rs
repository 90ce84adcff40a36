//! M functions on their way to the PLC, and what it answers [002:5455-5501].
//!
//! Decision: With the transfer of an M function with stop the control sets P8706 to 0; the next write of another value
//! acknowledges all that wait

use std::collections::VecDeque;

use bahn_path::BlockRef;

/// Transfers that are kept until somebody takes them; the oldest one goes first.
const KEPT: usize = 4096;

/// When a function goes out.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum When {
    /// Before the path of its block.
    Before,
    /// After it.
    After,
}

/// A transfer of an M function to the PLC.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Transfer {
    /// When, µs since power-on.
    pub time_us: u64,
    /// The channel, from 1 on.
    pub channel: u8,
    /// The function.
    pub m: u16,
    /// Before or after the path.
    pub when: When,
    /// The path waits for the acknowledgement.
    pub stop: bool,
    /// The acknowledgement branches.
    pub branch: bool,
    /// The number of the block.
    pub block: u32,
    /// Where a branch leads, the number of a block.
    pub target: Option<u32>,
    /// Where it stands in the programs.
    pub(crate) at: BlockRef,
    /// When it was acknowledged, µs; `None` while it is not, and for those that need not be.
    pub ack_us: Option<u64>,
    /// The branch was taken.
    pub taken: bool,
}

/// The transfers of a control.
#[derive(Clone, Debug, Default)]
pub(crate) struct Transfers {
    list: VecDeque<Transfer>,
    /// Those that nobody has taken in time.
    pub dropped: u64,
}

impl Transfers {
    /// Makes room for all that are kept.
    pub fn reserve(&mut self) {
        if self.list.capacity() < KEPT {
            self.list.reserve(KEPT - self.list.len());
        }
    }

    /// One goes out.
    pub fn push(&mut self, transfer: Transfer) {
        if self.list.len() >= KEPT {
            self.list.pop_front();
            self.dropped += 1;
        }
        self.list.push_back(transfer);
    }

    /// The last ones, the first one first.
    pub fn last(&self, count: usize) -> impl Iterator<Item = &Transfer> {
        self.list.iter().skip(self.list.len().saturating_sub(count))
    }

    /// The last ones of a channel, whose blocks have no number yet, get it.
    pub fn number(&mut self, count: usize, number: impl Fn(BlockRef) -> u32) {
        for transfer in self.list.iter_mut().rev().take(count) {
            transfer.block = number(transfer.at);
        }
    }

    /// How many there were since power-on.
    pub fn count(&self) -> u64 {
        self.list.len() as u64 + self.dropped
    }

    /// Those that went out after there were so many, as far as they are kept.
    pub fn since(&self, count: u64) -> impl Iterator<Item = &Transfer> {
        let new = usize::try_from(self.count().saturating_sub(count)).unwrap_or(KEPT);
        self.list.iter().skip(self.list.len().saturating_sub(new))
    }

    /// The last one of a function of a channel was neither acknowledged nor taken.
    pub fn is_open(&self, channel: u8, m: u16) -> bool {
        let mut latest = self.list.iter().rev();
        let last = latest.find(|transfer| (transfer.channel, transfer.m) == (channel, m));
        last.is_some_and(|transfer| transfer.ack_us.is_none())
    }

    /// Those of a channel that wait are acknowledged.
    pub fn acknowledge(&mut self, channel: u8, now_us: u64) {
        let own = self
            .list
            .iter_mut()
            .rev()
            .filter(|transfer| transfer.channel == channel);
        for transfer in own.filter(|transfer| transfer.stop && !transfer.branch) {
            if transfer.ack_us.is_some() {
                return;
            }
            transfer.ack_us = Some(now_us);
        }
    }

    /// The last branch of a channel is taken.
    pub fn branch(&mut self, channel: u8, now_us: u64) {
        let mut own = self
            .list
            .iter_mut()
            .rev()
            .filter(|transfer| transfer.channel == channel);
        if let Some(transfer) = own.find(|transfer| transfer.branch) {
            (transfer.ack_us, transfer.taken) = (Some(now_us), true);
        }
    }

    /// Those that are kept.
    pub fn iter(&self) -> impl Iterator<Item = &Transfer> {
        self.list.iter()
    }
}
