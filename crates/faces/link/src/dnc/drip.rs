//! The control's side of the drip feed.
//!
//! Decision: After a broken line START asks again from the beginning, and the control passes over what it has by
//! count, and looks whether it is the same; a run that nobody goes on with is executed to its last block and has not
//! ended (also `interpreter/src/drip_feed.rs`)

use std::time::Duration;

use super::{Arrival, BlockLine, Machine};

/// How far a transfer is.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum DripState {
    /// Blocks go from the host to the control.
    Running,
    /// The line is broken off: START asks for the program again.
    Broken(String),
    /// The program is complete, or nobody needs more of it.
    Over,
}

/// A program that goes from a line into a machine. It holds one block; what the machine has no room for stays with the
/// other side, which gets no acknowledgement.
#[derive(Debug)]
pub struct Drip {
    name: String,
    state: DripState,
    /// Blocks that the machine has, and what they were.
    taken: u64,
    print: Fingerprint,
    /// Blocks of this transfer, of which the first ones may be known.
    come: u64,
    come_print: Fingerprint,
    waiting: Option<Vec<u8>>,
    /// Blocks that have come after the end of the run.
    after_end: u32,
}

/// Blocks after M2 or M30 that are acknowledged before the transfer is ended: END PGM is among them
/// *(inferred)*.
const AFTER_END_MAX: u32 = 16;

impl Drip {
    /// Asks for a program.
    pub fn start(name: &str, line: &mut dyn BlockLine) -> Drip {
        line.ask_for(name);
        Drip {
            name: name.to_owned(),
            state: DripState::Running,
            taken: 0,
            print: Fingerprint::default(),
            come: 0,
            come_print: Fingerprint::default(),
            waiting: None,
            after_end: 0,
        }
    }

    /// Asks again for a program whose transfer was broken off [003:1680]. The other side sends it from its beginning; what
    /// the machine has is passed over.
    pub fn start_again(&mut self, line: &mut dyn BlockLine) {
        self.state = DripState::Running;
        self.come = 0;
        self.come_print = Fingerprint::default();
        self.waiting = None;
        line.ask_for(&self.name);
    }

    /// How far it is.
    pub fn state(&self) -> &DripState {
        &self.state
    }

    /// Blocks that the machine has taken.
    pub fn blocks(&self) -> u64 {
        self.taken
    }

    /// A block waits for room in the machine.
    pub fn is_held(&self) -> bool {
        self.waiting.is_some()
    }

    /// Hands on what has come, and waits as long as this at most for more. `true` when a block went on.
    pub fn turn(&mut self, line: &mut dyn BlockLine, machine: &mut dyn Machine, at_most: Duration) -> bool {
        if self.state != DripState::Running {
            return false;
        }
        if machine.has_ended() {
            return self.pass_over(line, at_most);
        }
        if self.waiting.is_none() {
            match line.look(at_most) {
                Arrival::Nothing => return false,
                Arrival::Block(block) => self.waiting = Some(block),
                Arrival::End if self.come < self.taken => {
                    // It ends before what the machine has of it: it is another program.
                    self.break_off(ANOTHER, machine);
                    return false;
                }
                Arrival::End => {
                    machine.complete();
                    self.state = DripState::Over;
                    return false;
                }
                Arrival::Broken(message) => {
                    self.break_off(&message, machine);
                    return false;
                }
            }
        }
        self.hand_on(line, machine)
    }

    /// The run has ended: what little comes after it is acknowledged.
    fn pass_over(&mut self, line: &mut dyn BlockLine, at_most: Duration) -> bool {
        let waits = self.waiting.take().is_some();
        let arrival = match waits {
            true => Arrival::Block(Vec::new()),
            false => line.look(at_most),
        };
        match arrival {
            Arrival::Nothing => return false,
            Arrival::Block(_) if self.after_end < AFTER_END_MAX => {
                line.acknowledge();
                self.after_end += 1;
                self.taken += 1;
                return true;
            }
            Arrival::Block(_) => line.give_up(),
            Arrival::End | Arrival::Broken(_) => {}
        }
        self.state = DripState::Over;
        false
    }

    fn hand_on(&mut self, line: &mut dyn BlockLine, machine: &mut dyn Machine) -> bool {
        let known = self.come < self.taken;
        if !known && !machine.wants_more() {
            if let Some(message) = line.watch(Duration::ZERO) {
                self.break_off(&message, machine);
            }
            return false;
        }
        let Some(mut block) = self.waiting.take() else {
            return false;
        };
        self.come_print.add(&block);
        self.come += 1;
        if !known {
            block.extend_from_slice(b"\r\n");
            if !machine.take(&block) {
                line.give_up();
                self.break_off(ANOTHER, machine);
                return false;
            }
            self.taken += 1;
            self.print = self.come_print;
        } else if self.come == self.taken && self.come_print != self.print {
            line.give_up();
            self.break_off(ANOTHER, machine);
            return false;
        }
        line.acknowledge();
        true
    }

    fn break_off(&mut self, message: &str, machine: &mut dyn Machine) {
        self.waiting = None;
        self.state = DripState::Broken(message.to_owned());
        machine.broken();
    }
}

/// What is said when the other side sends something else than before *(inferred)*.
const ANOTHER: &str = "PROGRAM INCOMPLETE";

/// What blocks were, as FNV-1a has it: that nobody goes on with another program.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
struct Fingerprint(u64);

impl Default for Fingerprint {
    fn default() -> Fingerprint {
        Fingerprint(0xCBF2_9CE4_8422_2325)
    }
}

impl Fingerprint {
    fn add(&mut self, block: &[u8]) {
        for byte in block.iter().chain(b"\n") {
            self.0 = (self.0 ^ u64::from(*byte)).wrapping_mul(0x0100_0000_01B3);
        }
    }
}
