//! Signals over time, as a table whose last column says what happened.

use std::fmt::Write as _;
use std::io::Write as _;
use std::path::{Path, PathBuf};

use bahn_host::{Edges, Host, Observable, Observed, Operand};
use bahn_parameters::ControlModel;
use bahn_plc::Tracer;
use bahn_tnc::{AxisSignal, ChannelView, Control, RunState, Signal};

use crate::ReportError;
use bahn_host::files::{self, NewFile};

/// A table being written: a row for each contour cycle, or less often.
pub struct Recording {
    path: PathBuf,
    file: NewFile,
    signals: Vec<Observed>,
    /// What the control calls them.
    names: Vec<String>,
    /// Operands of the PLC among them, inside its scans.
    edges: Edges,
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
    /// Begins a table in the words of a control; `every_us` of 0 records every contour cycle.
    pub fn create(
        path: &Path,
        signals: Vec<Observed>,
        every_us: u64,
        model: ControlModel,
    ) -> Result<Recording, ReportError> {
        let mut recording = Recording {
            path: path.to_owned(),
            file: NewFile::create(path)?,
            edges: Edges::of(signals.iter().filter_map(operand)),
            names: signals.iter().map(|signal| signal.name(model)).collect(),
            signals,
            every_us,
            due_us: 0,
            row: String::with_capacity(256),
            events: String::with_capacity(64),
            started: false,
            block: None,
        };
        recording.row.push_str("time [s]");
        for (signal, name) in recording.signals.iter().zip(&recording.names) {
            match signal.what.unit() {
                "" => write!(recording.row, ",{name}"),
                unit => write!(recording.row, ",{name} [{unit}]"),
            }
            .unwrap_or_default();
        }
        recording.row.push_str(",event");
        recording.write_row()?;
        Ok(recording)
    }

    /// Who looks into the scans of the PLC.
    pub fn tracer(&mut self) -> Option<&mut (dyn Tracer + '_)> {
        match self.edges.is_empty() {
            true => None,
            false => Some(&mut self.edges),
        }
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
    pub fn cycle(&mut self, host: &Host, module: Option<&Host>, started: bool) -> Result<(), ReportError> {
        let control = host.control();
        self.watch(control, started);
        let mut pulses = String::new();
        for (pulsed, count) in self.edges.take_pulses() {
            let named = |(signal, _): &(&Observed, &String)| operand(signal) == Some(pulsed);
            let name = self.signals.iter().zip(&self.names).find(named);
            let name = name.map_or("", |(_, name)| name);
            let separator = if pulses.is_empty() { "" } else { "; " };
            let _ = match count {
                1 => write!(pulses, "{separator}{name} pulse"),
                count => write!(pulses, "{separator}{name} pulse x{count}"),
            };
        }
        if !pulses.is_empty() {
            self.event(&pulses);
        }
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
            let of = match signal.module {
                true => module,
                false => Some(host),
            };
            let value = of.map_or(0.0, |of| signal.value(of.control(), of.plant()));
            let _ = write!(self.row, ",{}", signal.what.decimals(value));
        }
        if self.events.contains([',', '"']) {
            let _ = write!(self.row, ",\"{}\"", self.events.replace('"', "\"\""));
        } else {
            let _ = write!(self.row, ",{}", self.events);
        }
        self.events.clear();
        self.write_row()
    }

    /// The table is whole.
    pub fn finish(self) -> Result<(), ReportError> {
        Ok(self.file.finish()?)
    }

    fn write_row(&mut self) -> Result<(), ReportError> {
        self.row.push('\n');
        self.file
            .write_all(self.row.as_bytes())
            .map_err(|error| files::cannot("write", &self.path, &error).into())
    }
}

/// What is recorded when nothing else is asked for: speed along the path and of the spindle, position and
/// lag of each axis, the strobe of M functions and its acknowledgement.
pub fn usual_signals(control: &Control) -> Vec<Observed> {
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
        signals.into_iter().map(move |signal| Observed {
            module: false,
            channel,
            what: Observable::Signal(signal),
        })
    };
    channels.flat_map(of_channel).collect()
}

/// The operand of the PLC that a signal is.
fn operand(signal: &Observed) -> Option<Operand> {
    if signal.channel > 0 || signal.module {
        // The scan knows the memory of its PLC, not what stands where in the window of a channel.
        return None;
    }
    match &signal.what {
        Observable::Signal(Signal::Bit(bit)) => Some(Operand::Bit(*bit)),
        Observable::Signal(Signal::Number(number)) => Some(Operand::Number(*number)),
        _ => None,
    }
}
