//! What is listed of a run: messages, writes that a lock held back, M functions on their way to the PLC.

use bahn_control900::{Control900, Message, Transfer, When};
use bahn_system900::Name;
use serde::Serialize;

/// Entries that are listed of each kind.
const LISTED_MAX: usize = 10_000;

/// A message.
#[derive(Clone, Debug, Serialize)]
pub(super) struct Said900 {
    time_s: f64,
    number: u32,
    channel: u8,
    axis: Option<u8>,
    kind: &'static str,
    text: String,
}

impl Said900 {
    pub fn text(&self) -> String {
        let number = match self.number {
            0 => String::new(),
            number => format!("M{number} "),
        };
        let axis = self.axis.map_or(String::new(), |axis| format!(", axis {axis}"));
        format!(
            "{:9.3} s  {number}{}, channel {}{axis} ({})",
            self.time_s, self.text, self.channel, self.kind
        )
    }
}

/// A write that a lock held back.
#[derive(Clone, Debug, Serialize)]
pub(super) struct Refused900 {
    time_s: f64,
    name: Name,
    lock: String,
}

impl Refused900 {
    pub fn text(&self) -> String {
        format!("{:9.3} s  {}", self.time_s, self.lock)
    }
}

/// An M function on its way to the PLC.
#[derive(Clone, Debug, Serialize)]
pub(super) struct Sent900 {
    t: f64,
    m: u16,
    when: &'static str,
    stop: bool,
    branch: bool,
    block: u32,
    ack_t: Option<f64>,
    taken: bool,
}

impl Sent900 {
    fn of(transfer: &Transfer) -> Sent900 {
        Sent900 {
            t: seconds(transfer.time_us),
            m: transfer.m,
            when: match transfer.when {
                When::Before => "before",
                When::After => "after",
            },
            stop: transfer.stop,
            branch: transfer.branch,
            block: transfer.block,
            ack_t: transfer.ack_us.map(seconds),
            taken: transfer.taken,
        }
    }
}

/// The M functions of a channel, as far as the control keeps them.
pub(super) fn sent(control: &Control900, channel: u8) -> Vec<Sent900> {
    let own = control.transfers().filter(|transfer| transfer.channel == channel);
    own.map(Sent900::of).collect()
}

fn seconds(us: u64) -> f64 {
    us as f64 * 1e-6
}

/// What came up in a run.
#[derive(Default)]
pub(super) struct Listed {
    pub messages: Vec<Said900>,
    pub refused: Vec<Refused900>,
    /// How often the operator went on with a program that waited for him.
    pub confirmed: Vec<f64>,
    pub not_listed: u64,
}

impl Listed {
    pub fn message(&mut self, message: &Message) {
        let said = Said900 {
            time_s: seconds(message.time_us),
            number: message.number,
            channel: message.channel,
            axis: message.axis,
            kind: message.kind.id(),
            text: message.text.to_string(),
        };
        push(&mut self.messages, said, &mut self.not_listed);
    }

    pub fn refuse(&mut self, time_us: u64, name: Name, lock: String) {
        let refused = Refused900 {
            time_s: seconds(time_us),
            name,
            lock,
        };
        push(&mut self.refused, refused, &mut self.not_listed);
    }

    pub fn confirm(&mut self, time_us: u64) {
        push(&mut self.confirmed, seconds(time_us), &mut self.not_listed);
    }
}

fn push<T>(list: &mut Vec<T>, entry: T, not_listed: &mut u64) {
    match list.len() < LISTED_MAX {
        true => list.push(entry),
        false => *not_listed += 1,
    }
}
