//! A function that was programmed, as it goes through the channel.

use std::collections::VecDeque;
use std::sync::Arc;

use bahn_din::Place;
use bahn_path::{Ahead, Axis};

use crate::plc::WindowRange;
use crate::report::Value;
use crate::synch::Synch;

/// Number of an order: they count on in the order of the programs.
pub(crate) type OrderId = u64;

/// Letter of a function.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Letter {
    M,
    H,
    S,
}

/// The range to which a function goes.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum RangeId {
    Channel,
    Axis(Axis),
    Spindle(usize),
}

impl Letter {
    pub(crate) fn byte(self) -> u8 {
        match self {
            Letter::M => b'M',
            Letter::H => b'H',
            Letter::S => b'S',
        }
    }
}

impl RangeId {
    /// How the window of bytes calls it.
    pub(crate) fn in_window(self) -> WindowRange {
        match self {
            RangeId::Channel => WindowRange::Channel,
            RangeId::Axis(axis) => WindowRange::Axis(axis.index()),
            RangeId::Spindle(index) => WindowRange::Spindle(index),
        }
    }
}

#[derive(Clone, Debug)]
pub(crate) struct Order {
    pub(crate) letter: Letter,
    pub(crate) number: u16,
    pub(crate) value: Value,
    pub(crate) synch: Synch,
    /// Where it is output; nowhere when a spindle of the NC alone executes it.
    pub(crate) range: Option<RangeId>,
    /// The spindle of the NC that executes it and confirms.
    pub(crate) spindle: Option<usize>,
    /// Its acknowledgement is waited for.
    pub(crate) waits: bool,
    /// How far ahead of its place it is output.
    pub(crate) lead: Option<Ahead>,
    /// How long PLC or spindle are thought to take, s.
    pub(crate) process_s: f64,
    pub(crate) place: Arc<Place>,
    pub(crate) state: State,
}

/// How far an order has come.
#[derive(Clone, Copy, Debug, Default)]
pub(crate) struct State {
    pub(crate) output: bool,
    pub(crate) fetched: bool,
    pub(crate) acknowledged: bool,
    /// The spindle was commanded, and has confirmed.
    pub(crate) commanded: bool,
    pub(crate) confirmed: bool,
}

impl Order {
    /// Nothing has to be waited for any more.
    pub(crate) fn is_done(&self) -> bool {
        let state = &self.state;
        (self.range.is_none() || !self.waits || state.acknowledged)
            && (self.spindle.is_none() || state.confirmed)
    }

    /// Letter and number: `M25`, `S`.
    pub(crate) fn label(&self) -> String {
        match self.letter {
            Letter::M => format!("M{}", self.number),
            Letter::H => format!("H{}", self.number),
            Letter::S => "S".to_owned(),
        }
    }
}

/// All orders that may still be asked for.
#[derive(Debug, Default)]
pub(crate) struct Orders {
    first: OrderId,
    list: VecDeque<Order>,
}

impl Orders {
    pub(crate) fn push(&mut self, order: Order) -> OrderId {
        self.list.push_back(order);
        self.next() - 1
    }

    /// The number that the next one gets.
    pub(crate) fn next(&self) -> OrderId {
        self.first + self.list.len() as u64
    }

    pub(crate) fn get(&self, id: OrderId) -> Option<&Order> {
        self.list.get(usize::try_from(id.checked_sub(self.first)?).ok()?)
    }

    pub(crate) fn get_mut(&mut self, id: OrderId) -> Option<&mut Order> {
        self.list
            .get_mut(usize::try_from(id.checked_sub(self.first)?).ok()?)
    }

    /// Those that are gone are done.
    pub(crate) fn is_done(&self, id: OrderId) -> bool {
        self.get(id).is_none_or(Order::is_done)
    }

    /// Forgets those before a number that nobody can ask for any more.
    pub(crate) fn forget_before(&mut self, id: OrderId) {
        while self.first < id && self.list.front().is_some_and(Order::is_over) {
            self.list.pop_front();
            self.first += 1;
        }
    }
}

impl Order {
    /// Neither path nor PLC have anything to do with it any more.
    fn is_over(&self) -> bool {
        self.is_done() && (self.range.is_none() || self.state.fetched)
    }
}
