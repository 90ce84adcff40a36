//! Writes on their way to interpolator, PLC and panel, in their order [002:314-328].
//!
//! Decision: Each receiver has a queue of its own. Where more waits than goes in, or after power-on, it takes all parameters
//! that are its own instead of single ones: nobody goes on with half of them

use std::collections::VecDeque;

use crate::array::Cell;
use crate::memory::Place;

/// The most writes that wait for a receiver.
const WAITING_MAX: usize = 1024;

/// Who gets writes.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Receiver {
    /// The interpolator.
    Interpolator,
    /// The PLC.
    Plc,
    /// The operating panel.
    Panel,
}

impl Receiver {
    /// All of them.
    pub const ALL: [Receiver; 3] = [Receiver::Interpolator, Receiver::Plc, Receiver::Panel];
}

/// A write that reached the memory.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Transfer {
    /// Where.
    pub place: Place,
    /// What it holds since then; cleared is a command for some.
    pub cell: Cell,
}

/// What a receiver takes next.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum News {
    /// All that is its own, from the memory.
    All,
    /// One write.
    One(Transfer),
}

/// What waits for one receiver.
#[derive(Debug, PartialEq)]
pub(crate) struct Outbox {
    waiting: VecDeque<Transfer>,
    /// All is to be taken before what waits.
    takes_all: bool,
}

/// A clone has as much room.
impl Clone for Outbox {
    fn clone(&self) -> Outbox {
        let mut clone = Outbox::new();
        clone.waiting.extend(self.waiting.iter().copied());
        clone.takes_all = self.takes_all;
        clone
    }
}

impl Outbox {
    /// That of power-on.
    pub fn new() -> Outbox {
        Outbox {
            waiting: VecDeque::with_capacity(WAITING_MAX),
            takes_all: true,
        }
    }

    /// Everything is to be taken anew.
    pub fn restart(&mut self) {
        self.waiting.clear();
        self.takes_all = true;
    }

    pub fn push(&mut self, transfer: Transfer) {
        if self.waiting.len() < WAITING_MAX {
            self.waiting.push_back(transfer);
        } else {
            self.restart();
        }
    }

    pub fn next(&mut self) -> Option<News> {
        if std::mem::take(&mut self.takes_all) {
            return Some(News::All);
        }
        self.waiting.pop_front().map(News::One)
    }
}
