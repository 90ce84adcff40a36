//! The byte window: functions stand in the memory of a PLC program, which answers there.
//!
//! What a PLC of TF5200 sees in its ranges is in another manual [004:93]; a PLC of a TNC has bytes, words and doublewords
//! with the highest byte first [000:11577]. So each function takes a slot of 16 bytes (inferred):
//!
//! | byte | | written by |
//! |---|---|---|
//! | 0 | letter: `M` 77, `H` 72, `S` 83; 0 the slot is free | channel |
//! | 1 | 1 fetched, 2 acknowledged; 0 is new | PLC |
//! | 2 | range: 0 channel, from 1 on the axes, from 64 on the spindles | channel |
//! | 3 | bit 0 the path waits for the acknowledgement, bit 1 there is a value, bit 2 the time is that of MOS_TS | channel |
//! | 4, 5 | number | channel |
//! | 6, 7 | counts the functions of the run | channel |
//! | 8 to 11 | additive value, speed in 0.001 rpm | channel |
//! | 12 to 15 | process time, or the time since the path was at the place, µs | channel |
//!
//! Decision: The PLC of a machine folder sees the functions of all ranges in eight slots of 16 free bytes, B128 to
//! B255 or where `--window` says, and answers in each; it is given up after 60 s without an answer while the path
//! stands (also `bahn/src/technology/machine.rs`)

use std::collections::VecDeque;

use super::{Answer, Id, Output};

/// Bytes of a slot.
const SLOT: usize = 16;
/// Functions that the window takes at a time.
const SLOTS: usize = 8;
/// Bytes of the window: eight functions at a time.
pub const WINDOW_BYTES: u16 = (SLOT * SLOTS) as u16;

/// Where the PLC answers in its slot, and what.
const ANSWER: u16 = 1;
const FETCHED: u8 = 1;
const ACKNOWLEDGED: u8 = 2;

/// So many functions are counted.
const COUNTED: Id = 1 << 15;

/// While the path stands, an answer of a PLC is waited for so long, s.
const PATIENCE_S: f64 = 60.0;
/// So often the PLC runs through after the end of the path.
const RUNS_AFTER: u64 = 2;

/// A PLC that runs beside the channel, and the bytes in which both see the functions.
pub trait PlcMemory {
    /// Lets the PLC go on to a time of the run, s. Returns how often it has run through up to now.
    ///
    /// # Errors
    /// Why it cannot.
    fn run_to(&mut self, time_s: f64) -> Result<u64, String>;

    /// A byte of the window, from 0 on, as the PLC has left it.
    fn read(&self, at: u16) -> u8;

    /// Writes bytes of the window: the PLC sees them when it runs through next.
    fn write(&mut self, at: u16, bytes: &[u8]);
}

/// A function that stands in the window or waits for a slot.
#[derive(Clone, Copy, Debug)]
struct Standing {
    id: Id,
    bytes: [u8; SLOT],
    waits: bool,
    fetched: bool,
}

impl Standing {
    fn new(output: &Output<'_>) -> Standing {
        let time_us = output.offset_us.unwrap_or(output.process_s * 1e6);
        let kind = u8::from(output.waits)
            | u8::from(output.value.is_some()) << 1
            | u8::from(output.offset_us.is_some()) << 2;
        let [n1, n0] = output.number.to_be_bytes();
        let [c1, c0] = ((output.id % COUNTED) as u16).to_be_bytes();
        let [v3, v2, v1, v0] = output.value.unwrap_or_default().to_be_bytes();
        let [t3, t2, t1, t0] = (time_us.round() as i32).to_be_bytes();
        Standing {
            id: output.id,
            bytes: [
                output.letter,
                0,
                output.range.number(),
                kind,
                n1,
                n0,
                c1,
                c0,
                v3,
                v2,
                v1,
                v0,
                t3,
                t2,
                t1,
                t0,
            ],
            waits: output.waits,
            fetched: false,
        }
    }
}

/// The window, from the side of the channel.
pub(crate) struct Window<'a> {
    memory: &'a mut dyn PlcMemory,
    slots: [Option<Standing>; SLOTS],
    /// Functions that no slot was free for.
    queue: VecDeque<Standing>,
    /// How often the PLC has run through, and the cycle in which that was seen.
    runs: u64,
    run_seen: u64,
    /// The path has ended: so often the PLC runs through.
    end: Option<u64>,
    /// It does not run any more, and why: that is reported once.
    stopped: bool,
    fault: Option<String>,
}

impl<'a> Window<'a> {
    pub(crate) fn new(memory: &'a mut dyn PlcMemory) -> Window<'a> {
        memory.write(0, &[0; SLOT * SLOTS]);
        Window {
            memory,
            slots: [None; SLOTS],
            queue: VecDeque::new(),
            runs: 0,
            run_seen: 0,
            end: None,
            stopped: false,
            fault: None,
        }
    }

    /// A function is output.
    pub(crate) fn put(&mut self, output: &Output<'_>) {
        self.queue.push_back(Standing::new(output));
        self.fill();
    }

    /// Functions come into free slots.
    fn fill(&mut self) {
        for (at, slot) in (0..).step_by(SLOT).zip(&mut self.slots) {
            if slot.is_none()
                && let Some(next) = self.queue.pop_front()
            {
                self.memory.write(at, &next.bytes);
                *slot = Some(next);
            }
        }
    }

    /// Lets the PLC go on to a cycle, and returns what it has answered since, in the order of output.
    pub(crate) fn look(&mut self, cycle: u64, cycle_s: f64, mut tell: impl FnMut(Id, Answer)) {
        if self.stopped {
            return;
        }
        let runs = match self.memory.run_to(cycle as f64 * cycle_s) {
            Ok(runs) => runs,
            Err(fault) => {
                (self.stopped, self.fault) = (true, Some(fault));
                return;
            }
        };
        if runs == self.runs {
            return;
        }
        (self.runs, self.run_seen) = (runs, cycle);
        let mut order: [usize; SLOTS] = std::array::from_fn(|index| index);
        order.sort_by_key(|index| {
            self.slots
                .get(*index)
                .and_then(|slot| slot.map(|standing| standing.id))
        });
        for index in order {
            let at = (index * SLOT) as u16;
            let Some(slot) = self.slots.get_mut(index) else {
                continue;
            };
            let Some(standing) = slot else { continue };
            let answer = self.memory.read(at + ANSWER);
            let acknowledged = standing.waits && answer & ACKNOWLEDGED != 0;
            // Who acknowledges has fetched.
            if answer & (FETCHED | ACKNOWLEDGED) != 0 && !std::mem::replace(&mut standing.fetched, true) {
                tell(standing.id, Answer::Fetched);
            }
            if acknowledged {
                tell(standing.id, Answer::Acknowledged);
            }
            if acknowledged || standing.fetched && !standing.waits {
                self.memory.write(at, &[0; SLOT]);
                *slot = None;
            }
        }
        self.fill();
    }

    /// What was output before this cycle the PLC could have fetched.
    pub(crate) fn fetched_before(&self) -> u64 {
        self.run_seen
    }

    /// Whether an answer may still come, when nothing else has happened for some cycles.
    pub(crate) fn may_answer(&self, quiet: u64, cycle_s: f64) -> bool {
        let standing = || self.slots.iter().flatten().chain(&self.queue);
        match self.end {
            _ if self.stopped => false,
            Some(end) => self.runs < end && standing().any(|standing| !standing.fetched),
            None => standing().next().is_some() && quiet as f64 * cycle_s < PATIENCE_S,
        }
    }

    /// The path has ended: what was output last is still fetched.
    pub(crate) fn end(&mut self) {
        self.end = Some(self.runs + RUNS_AFTER);
    }

    /// Drops all that stands in it: the PLC sees free slots.
    pub(crate) fn reset(&mut self) {
        self.queue.clear();
        self.slots = [None; SLOTS];
        self.memory.write(0, &[0; SLOT * SLOTS]);
    }

    /// Why the PLC does not run any more.
    pub(crate) fn take_fault(&mut self) -> Option<String> {
        self.fault.take()
    }
}
