//! Signals over time, as a table whose last column says what happened.

use std::fmt::Write as _;
use std::io::Write as _;
use std::path::{Path, PathBuf};

use bahn_control::{AxisSignal, ChannelSignal, ChannelView, Control, RunState, Signal};
use bahn_host::decimals;

use crate::UsageError;
use crate::files::{self, NewFile};

/// A table being written: a row for each contour cycle, or less often.
pub(super) struct Recording {
    path: PathBuf,
    file: NewFile,
    signals: Vec<ChannelSignal>,
    every_us: u64,
    due_us: u64,
    row: String,
    /// What happened since the last row.
    events: String,
    /// The program was started.
    started: bool,
    /// The block of the main program that is executed.
    block: Option<u32>,
}

impl Recording {
    /// Begins a table; `every_us` of 0 records every contour cycle.
    pub fn create(path: &Path, signals: Vec<ChannelSignal>, every_us: u64) -> Result<Recording, UsageError> {
        let mut recording = Recording {
            path: path.to_owned(),
            file: NewFile::create(path)?,
            signals,
            every_us,
            due_us: 0,
            row: String::with_capacity(256),
            events: String::with_capacity(64),
            started: false,
            block: None,
        };
        recording.row.push_str("time [s]");
        for signal in &recording.signals {
            match unit(&signal.signal) {
                "" => write!(recording.row, ",{signal}"),
                unit => write!(recording.row, ",{signal} [{unit}]"),
            }
            .unwrap_or_default();
        }
        recording.row.push_str(",event");
        recording.write_row()?;
        Ok(recording)
    }

    /// A message came up.
    pub fn message(&mut self, text: &str) {
        self.event(&format!("message {text}"));
    }

    fn event(&mut self, event: &str) {
        if !self.events.is_empty() {
            self.events.push_str("; ");
        }
        self.events
            .extend(event.chars().map(|c| if c.is_control() { ' ' } else { c }));
    }

    /// Notes when the program `started` and which of its blocks is executed.
    fn watch(&mut self, control: &Control, started: bool) {
        if started && !self.started {
            self.started = true;
            self.event("start");
        }
        let element = control
            .element()
            .filter(|_| control.run_state() != RunState::Idle);
        let block = element
            .map(|element| element.block)
            .filter(|block| block.program == 0);
        if let Some(block) = block.map(|block| block.block)
            && self.block.replace(block) != Some(block)
        {
            self.event(&format!("block {block}"));
        }
    }

    /// Takes a row when it is time.
    pub fn cycle(&mut self, control: &Control, started: bool) -> Result<(), UsageError> {
        self.watch(control, started);
        let now = control.time_us();
        if now < self.due_us {
            return Ok(());
        }
        let rows = now.checked_div(self.every_us);
        self.due_us = rows.map_or(0, |rows| (rows + 1) * self.every_us);
        self.row.clear();
        // Writing to a string cannot fail.
        let _ = write!(self.row, "{:.4}", now as f64 * 1e-6);
        for signal in &self.signals {
            let _ = write!(
                self.row,
                ",{}",
                decimals(&signal.signal, observe(control, signal))
            );
        }
        if self.events.contains([',', '"']) {
            let _ = write!(self.row, ",\"{}\"", self.events.replace('"', "\"\""));
        } else {
            let _ = write!(self.row, ",{}", self.events);
        }
        self.events.clear();
        self.write_row()
    }

    pub fn finish(self) -> Result<(), UsageError> {
        Ok(self.file.finish()?)
    }

    fn write_row(&mut self) -> Result<(), UsageError> {
        self.row.push('\n');
        self.file
            .write_all(self.row.as_bytes())
            .map_err(|error| files::cannot("write", &self.path, &error).into())
    }
}

/// What is recorded when nothing else is asked for: speed along the path and of the spindle, position and
/// lag of each axis, the strobe of M functions and its acknowledgement.
pub(super) fn usual_signals(control: &Control) -> Vec<ChannelSignal> {
    let channels = (0..control.channels()).filter_map(|number| control.channel(number));
    let of_channel = |channel: ChannelView| {
        let mut signals = vec![Signal::PathSpeed, Signal::SpindleRpm];
        for letter in channel.axis_letters() {
            signals.push(Signal::Axis(letter, AxisSignal::Actual));
            signals.push(Signal::Axis(letter, AxisSignal::Lag));
        }
        signals.push(Signal::Bit(bahn_exchange::signal::M_FUNCTION_STROBE));
        signals.push(Signal::Bit(bahn_exchange::signal::M_FUNCTION_ACK));
        let channel = channel.number();
        signals
            .into_iter()
            .map(move |signal| ChannelSignal { channel, signal })
    };
    channels.flat_map(of_channel).collect()
}

fn observe(control: &Control, signal: &ChannelSignal) -> f64 {
    let channel = control.channel(signal.channel);
    channel.map_or(0.0, |channel| channel.observe(&signal.signal))
}

/// Unit of a signal; rotary axes have degrees.
pub(super) fn unit(signal: &Signal) -> &'static str {
    let rotary = matches!(signal, Signal::Axis('A' | 'B' | 'C', _));
    match signal.unit() {
        "mm" if rotary => "deg",
        "mm/min" if rotary => "deg/min",
        "degrees" => "deg",
        unit => unit,
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn values_have_the_decimals_of_their_signal() {
        let text = |signal: &str, number: f64| decimals(&signal.parse().unwrap(), number).to_string();
        assert_eq!(text("X.lag", -0.000001), "0.00000");
        assert_eq!(text("X.volts", 9.12345), "9.1235");
        assert_eq!(text("M2045", 1.0), "1");
        assert_eq!(unit(&"C.speed".parse().unwrap()), "deg/min");
    }
}
