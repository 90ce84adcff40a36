//! The PLC at the other side of the ranges: a script says what it does, or it does all in its process time.

mod script;

use std::cmp::Reverse;
use std::collections::BinaryHeap;

pub(crate) use script::{After, Reply};
pub use script::{Script, ScriptError};

/// Number of a function in the channel.
type Id = u64;

/// What happens on the other side.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub(crate) enum Deed {
    /// The PLC fetches a function.
    Fetch(Id),
    /// It acknowledges it.
    Acknowledge(Id),
    /// A spindle of the NC confirms it.
    Confirm(Id),
}

/// PLC and spindles, cycle by cycle.
#[derive(Debug)]
pub(crate) struct Plc<'a> {
    script: Option<&'a Script>,
    cycle_s: f64,
    /// What comes, by cycle and in the order in which it was ordered.
    due: BinaryHeap<Reverse<(u64, u64, Deed)>>,
    count: u64,
}

/// What part of a cycle may be rounding.
const ROUNDING: f64 = 1e-6;

/// The first cycle at a time or behind it.
pub(crate) fn cycle_at(time_s: f64, cycle_s: f64) -> u64 {
    (time_s / cycle_s - ROUNDING).ceil().max(0.0) as u64
}

impl<'a> Plc<'a> {
    pub(crate) fn new(script: Option<&'a Script>, cycle_s: f64) -> Plc<'a> {
        Plc {
            script,
            cycle_s,
            due: BinaryHeap::new(),
            count: 0,
        }
    }

    pub(crate) fn script(&self) -> Option<&'a Script> {
        self.script
    }

    fn plan(&mut self, cycle: u64, deed: Deed) {
        self.count += 1;
        self.due.push(Reverse((cycle, self.count, deed)));
    }

    /// The earliest cycle in which something can be over that was ordered in one and takes a time.
    fn behind(&self, cycle: u64, after: After) -> Option<u64> {
        match after {
            After::Seconds(seconds) => Some((cycle + cycle_at(seconds, self.cycle_s)).max(cycle + 1)),
            After::Never => None,
        }
    }

    /// A function is in a range, by whatever name the script calls that, since a cycle.
    pub(crate) fn order(
        &mut self,
        id: Id,
        (names, label): (&[String], &str),
        process_s: f64,
        waits: bool,
        cycle: u64,
    ) {
        let reply = match self.script {
            Some(script) => script.reply(names, label),
            None => Reply::Acknowledge(After::Seconds(process_s)),
        };
        let acknowledged = match reply {
            Reply::NoFetch => return,
            Reply::At(time_s) => Some(cycle_at(time_s, self.cycle_s).max(cycle + 1)),
            Reply::Acknowledge(after) => self.behind(cycle, after),
        };
        self.plan(cycle + 1, Deed::Fetch(id));
        if let Some(acknowledged) = acknowledged.filter(|_| waits) {
            self.plan(acknowledged, Deed::Acknowledge(id));
        }
    }

    /// A spindle of the NC is commanded.
    pub(crate) fn command(&mut self, id: Id, names: &[String], process_s: f64, cycle: u64) {
        let after = match self.script {
            Some(script) => script.ready(names),
            None => After::Seconds(process_s),
        };
        if let Some(confirmed) = self.behind(cycle, after) {
            self.plan(confirmed, Deed::Confirm(id));
        }
    }

    /// What happens in a cycle, one after the other.
    pub(crate) fn next(&mut self, cycle: u64) -> Option<Deed> {
        let Reverse((due, ..)) = self.due.peek()?;
        if *due > cycle {
            return None;
        }
        let Reverse((_, _, deed)) = self.due.pop()?;
        Some(deed)
    }

    /// The cycle of what comes next.
    pub(crate) fn next_cycle(&self) -> Option<u64> {
        self.due.peek().map(|Reverse((cycle, ..))| *cycle)
    }

    /// Only fetches of the functions that were output last are left of what comes.
    pub(crate) fn keep_fetches(&mut self) {
        self.due
            .retain(|Reverse((.., deed))| matches!(deed, Deed::Fetch(_)));
    }

    /// The channel has dropped all open functions.
    pub(crate) fn reset(&mut self) {
        self.due.clear();
    }
}
