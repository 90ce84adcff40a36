//! Part programs that are read ahead beside the control: on a thread of whoever drives it.
//!
//! Decision: In real time a program is handed over to a thread that reads it ahead, a thousand blocks at a time;
//! cycles go on with what was read, a command waits until it is back. In simulation time nothing is handed over, so
//! that every run is the same (also `host/src/tnc/reading.rs`)

use bahn_interpreter::Rules;
use bahn_kernel::Feeder;

use crate::language::OwnLanguage;

/// The program of a channel, handed over by [`Control::hand_over_reading`](crate::Control::hand_over_reading) to be read ahead
/// elsewhere. The cycles go on meanwhile with what was read before.
pub struct ReadAhead {
    pub(crate) channel: usize,
    pub(crate) loan: u64,
    pub(crate) feeder: Feeder,
}

impl ReadAhead {
    /// Reads ahead, a thousand blocks or elements at most. [`Control::take_back`](crate::Control::take_back) gives it
    /// back.
    pub fn read(&mut self) {
        self.feeder.read_ahead();
    }
}

/// A program that is handed over, and what it gets when it is back.
#[derive(Clone, Debug)]
pub(crate) struct Loan {
    /// Which loan of the channel it is.
    pub number: u64,
    pub inch: bool,
    /// It is in a language of the control.
    pub of_control: bool,
    /// Q parameters that the PLC has set.
    pub q: Vec<(u16, f64)>,
    /// Machine parameters have changed.
    pub rules: Option<Rules>,
    /// The run was broken off.
    pub broken_off: bool,
}

impl Loan {
    pub fn new(number: u64, feeder: &Feeder) -> Loan {
        Loan {
            number,
            inch: feeder.inch(),
            of_control: feeder.interpreter().is_some(),
            q: Vec::new(),
            rules: None,
            broken_off: false,
        }
    }

    /// Tells it to the program that is back.
    pub fn settle(self, feeder: &mut Feeder) {
        if let Some(rules) = self.rules {
            feeder.set_rules(rules);
        }
        let Some(interpreter) = feeder.interpreter_mut() else {
            return;
        };
        if self.broken_off {
            interpreter.give_up_work();
        }
        for (number, value) in self.q {
            interpreter.set_q(number, value);
        }
    }
}
