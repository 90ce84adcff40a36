//! The PLC at the other side of the ranges: a script says what it does, it does all in its process time, or a real one reads
//! and answers in a window of bytes.
//!
//! Decision: A function that path and PLC meet within a cycle is seen at its end; fetch and acknowledgement come one
//! cycle later at the earliest, the path goes in that cycle

mod output;
mod said;
mod script;
mod verbs;
mod window;

use std::cmp::Reverse;
use std::collections::BinaryHeap;

pub(crate) use bahn_kernel::gates::cycle_at;
pub(crate) use output::WindowRange;
pub use script::Script;
pub(crate) use script::{After, Reply};
use window::Window;
pub use window::{PlcMemory, WINDOW_BYTES};

use output::Id;
pub(crate) use output::{Answer, Output};

/// What happens on the other side.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub(crate) enum Reaction {
    /// The PLC fetches a function.
    Fetch(Id),
    /// The PLC acknowledges it.
    Acknowledge(Id),
    /// A spindle of the NC confirms it.
    Confirm(Id),
}

/// PLC and spindles, cycle by cycle.
pub(crate) struct Plc<'a> {
    script: Option<&'a Script>,
    /// The PLC that answers instead of the script.
    window: Option<Window<'a>>,
    cycle_s: f64,
    /// What comes, by cycle and in the order in which it was ordered.
    due: BinaryHeap<Reverse<(u64, u64, Reaction)>>,
    count: u64,
}

impl<'a> Plc<'a> {
    pub(crate) fn new(
        script: Option<&'a Script>,
        memory: Option<&'a mut (dyn PlcMemory + 'a)>,
        cycle_s: f64,
    ) -> Plc<'a> {
        Plc {
            script,
            window: memory.map(Window::new),
            cycle_s,
            due: BinaryHeap::new(),
            count: 0,
        }
    }

    pub(crate) fn script(&self) -> Option<&'a Script> {
        self.script
    }

    fn plan(&mut self, cycle: u64, reaction: Reaction) {
        self.count += 1;
        self.due.push(Reverse((cycle, self.count, reaction)));
    }

    /// The earliest cycle in which something can be over that was ordered in one and takes a time.
    fn earliest_cycle(&self, cycle: u64, after: After) -> Option<u64> {
        match after {
            After::Seconds(seconds) => Some((cycle + cycle_at(seconds, self.cycle_s)).max(cycle + 1)),
            After::Never => None,
        }
    }

    /// A function is in a range since a cycle.
    pub(crate) fn order(&mut self, output: &Output<'_>, cycle: u64) {
        if let Some(window) = &mut self.window {
            window.put(output);
            return;
        }
        let reply = match self.script {
            Some(script) => script.reply(output.names, output.label),
            None => Reply::Acknowledge(After::Seconds(output.process_s)),
        };
        let acknowledged = match reply {
            Reply::NoFetch => return,
            Reply::At(time_s) => Some(cycle_at(time_s, self.cycle_s).max(cycle + 1)),
            Reply::Acknowledge(after) => self.earliest_cycle(cycle, after),
        };
        self.plan(cycle + 1, Reaction::Fetch(output.id));
        if let Some(acknowledged) = acknowledged.filter(|_| output.waits) {
            self.plan(acknowledged, Reaction::Acknowledge(output.id));
        }
    }

    /// A spindle of the NC is commanded.
    pub(crate) fn command(&mut self, id: Id, names: &[String], process_s: f64, cycle: u64) {
        let after = match self.script {
            Some(script) => script.ready(names),
            None => After::Seconds(process_s),
        };
        if let Some(confirmed) = self.earliest_cycle(cycle, after) {
            self.plan(confirmed, Reaction::Confirm(id));
        }
    }

    /// A cycle begins: the PLC beside the channel goes on to it.
    pub(crate) fn begin(&mut self, cycle: u64) {
        let Plc {
            window: Some(window),
            due,
            count,
            cycle_s,
            ..
        } = self
        else {
            return;
        };
        window.look(cycle, *cycle_s, |id, answer| {
            *count += 1;
            let reaction = match answer {
                Answer::Fetched => Reaction::Fetch(id),
                Answer::Acknowledged => Reaction::Acknowledge(id),
            };
            due.push(Reverse((cycle, *count, reaction)));
        });
    }

    /// What happens in a cycle, one after the other.
    pub(crate) fn next(&mut self, cycle: u64) -> Option<Reaction> {
        let Reverse((due, ..)) = self.due.peek()?;
        if *due > cycle {
            return None;
        }
        let Reverse((_, _, reaction)) = self.due.pop()?;
        Some(reaction)
    }

    /// The cycle of what comes next, when nothing has happened for some cycles.
    pub(crate) fn next_cycle(&self, cycle: u64, quiet: u64) -> Option<u64> {
        let due = self.due.peek().map(|Reverse((cycle, ..))| *cycle);
        let window = self.window.as_ref();
        let asked = window.filter(|window| window.may_answer(quiet, self.cycle_s));
        due.into_iter().chain(asked.map(|_| cycle + 1)).min()
    }

    /// What was output before this cycle, and is not fetched, the PLC had the time to fetch.
    pub(crate) fn fetched_before(&self, cycle: u64) -> u64 {
        self.window.as_ref().map_or(cycle, Window::fetched_before)
    }

    /// Only fetches of the functions that were output last are left of what comes.
    pub(crate) fn keep_fetches(&mut self) {
        self.due
            .retain(|Reverse((.., reaction))| matches!(reaction, Reaction::Fetch(_)));
        if let Some(window) = &mut self.window {
            window.end();
        }
    }

    /// The channel has dropped all open functions.
    pub(crate) fn reset(&mut self) {
        self.due.clear();
        if let Some(window) = &mut self.window {
            window.reset();
        }
    }

    /// Why the PLC beside the channel does not run any more.
    pub(crate) fn take_fault(&mut self) -> Option<String> {
        self.window.as_mut().and_then(Window::take_fault)
    }
}
