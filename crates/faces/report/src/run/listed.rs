//! What a session lists for its report.

use bahn_host::Why;
use bahn_path::BlockRef;
use bahn_tnc::{ChannelView, Control, Message, Shown};
use serde::Serialize;

use super::executed::stop_name;
use crate::text::clock;
use bahn_host::files::short_name;

/// Keys that are listed as confirmed at most.
const CONFIRMED_MAX: usize = 1000;
/// Messages that are listed at most.
const MESSAGES_MAX: usize = 1000;

/// A message of the control.
#[derive(Clone, Debug, Serialize)]
pub(super) struct Said {
    pub time_s: f64,
    pub text: String,
    pub place: Option<String>,
    pub flashing: bool,
    /// The program that ran; empty when none did.
    pub program: String,
    pub block: Option<u32>,
}

impl Said {
    pub fn text(&self) -> String {
        let block = self
            .block
            .map(|block| format!(", {} block {block}", self.program));
        let place = self.place.as_ref().map(|place| format!(": {place}"));
        let place = block.unwrap_or_default() + &place.unwrap_or_default();
        format!("{} {}{place}", clock(self.time_s), self.text)
    }
}

/// A key that the operator pressed because the run waited for him.
#[derive(Clone, Debug, Serialize)]
pub(super) struct Confirmed {
    pub time_s: f64,
    pub key: String,
    pub why: &'static str,
    pub block: u32,
}

impl Confirmed {
    pub fn text(&self) -> String {
        let Confirmed { why, key, block, .. } = self;
        format!("{} {why} with {key}, block {block}", clock(self.time_s))
    }
}

/// What a report lists one by one.
#[derive(Default)]
pub(super) struct Listed {
    pub messages: Vec<Said>,
    pub confirmed: Vec<Confirmed>,
}

impl Listed {
    /// A message came up.
    pub fn message(&mut self, control: &Control, shown: &Shown) {
        if self.messages.len() >= MESSAGES_MAX {
            return;
        }
        let place = match &shown.message {
            Message::Program(error) => Some(error.detail.clone()).filter(|detail| !detail.is_empty()),
            other => other.place(),
        };
        let channel = control.channel(shown.channel.unwrap_or(0));
        let program = shown
            .block
            .zip(channel)
            .map(|(block, channel)| program_name(channel, block));
        let program = program.unwrap_or_default();
        let block = shown.block.filter(|_| !program.is_empty());
        self.messages.push(Said {
            time_s: shown.time_us as f64 * 1e-6,
            text: control.shown_text(shown),
            place,
            flashing: shown.flashing,
            block: block.map(|block| channel.map_or(block.block, |channel| channel.number_of(block))),
            program,
        });
    }

    /// The operator pressed a key because the run waited for him.
    pub fn confirm(&mut self, control: ChannelView, time_us: u64, key: String, why: Why) {
        if self.confirmed.len() >= CONFIRMED_MAX {
            return;
        }
        let block = control.element().map(|element| element.block);
        self.confirmed.push(Confirmed {
            time_s: time_us as f64 * 1e-6,
            key,
            why: match why {
                Why::Stop => stop_name(control, block),
                Why::Routine | Why::ToolChange => "tool change",
            },
            block: block.map_or(0, |block| control.number_of(block)),
        });
    }
}

/// Name, without folders, of the program that a block stands in; empty where nobody knows it.
pub(super) fn program_name(control: ChannelView, block: BlockRef) -> String {
    control
        .reader()
        .and_then(|run| run.program(block.program))
        .map(|program| short_name(program).to_owned())
        .unwrap_or_default()
}
