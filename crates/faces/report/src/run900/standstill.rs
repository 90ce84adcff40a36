//! Whether a machine comes on: nothing moves, and nothing is new.

use bahn_control900::Control900;
use bahn_system900::ChannelParameter;

/// What is looked at beside movement: messages, transfers to the PLC, and block and state of each channel.
type Seen = (usize, usize, Vec<[Option<i64>; 3]>);

/// Since when nothing has come on.
#[derive(Default)]
pub(super) struct Standstill {
    since_us: u64,
    seen: Option<Seen>,
    /// The dwell that is on its way, µs.
    dwell_us: u64,
}

impl Standstill {
    /// Looks at a cycle.
    pub fn cycle(&mut self, control: &Control900) {
        let state = |channel: u8| {
            let parameters = [
                ChannelParameter::ActualBlock,
                ChannelParameter::ProgramState,
                ChannelParameter::WaitsForM,
            ];
            parameters.map(|parameter| control.memory().of_channel(channel, parameter).whole())
        };
        let channels = 1..=control.channels();
        let dwells = channels.clone().filter_map(|channel| control.executed(channel));
        let dwell_s = dwells.map(|(element, _)| element.dwell_s).fold(0.0, f64::max);
        self.dwell_us = (dwell_s * 1e6) as u64;
        let now = (
            control.message_count(),
            control.transfers().count(),
            channels.map(state).collect(),
        );
        if control.moves() || self.seen.as_ref() != Some(&now) {
            (self.since_us, self.seen) = (control.now_us(), Some(now));
        }
    }

    /// Nothing has come on for so long, and the dwell besides.
    pub fn is_longer_than(&self, control: &Control900, wait_us: u64) -> bool {
        control.now_us().saturating_sub(self.since_us) > wait_us + self.dwell_us
    }
}

/// What a machine that does not come on waits for.
pub(super) fn waits_for(control: &Control900, started: bool) -> String {
    let channels = 1..=control.channels();
    let on_its_way = |channel: &u8| control.is_on_its_way(*channel);
    let waiting: Vec<String> = channels
        .clone()
        .filter(on_its_way)
        .map(|channel| of_channel(control, channel))
        .collect();
    if !waiting.is_empty() {
        return waiting.join("; ");
    }
    let memory = control.memory();
    let is = |channel, parameter| memory.of_channel(channel, parameter).whole() == Some(1);
    let closed = channels
        .clone()
        .find(|channel| !is(*channel, ChannelParameter::AxesEnabled));
    if let Some(channel) = closed {
        return format!("the axes of channel {channel} are not enabled, P8701");
    }
    let open = channels
        .clone()
        .find(|channel| !is(*channel, ChannelParameter::Referenced));
    match open {
        Some(channel) => format!("the axes of channel {channel} are not referenced, P8709"),
        None if started => "the program does not start".to_owned(),
        None => "no program was started".to_owned(),
    }
}

fn of_channel(control: &Control900, channel: u8) -> String {
    let memory = control.memory();
    let number = |parameter| memory.of_channel(channel, parameter).whole().unwrap_or(0);
    let block = number(ChannelParameter::ActualBlock);
    let what = match (
        number(ChannelParameter::WaitsForM),
        number(ChannelParameter::ProgramState),
    ) {
        (1.., _) => "an M function waits for P8706",
        (_, 1) => "it is stopped and waits for START",
        _ => "it waits",
    };
    format!("channel {channel}, block {block}: {what}")
}
