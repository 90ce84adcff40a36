//! The PLC of a machine folder beside the run: it sees the functions in a window of its bytes.
//!
//! The whole machine is switched on, with its inputs, outputs and devices; its axes stand at their reference marks, since
//! the path of a run is planned for itself.

use std::path::Path;
use std::sync::Arc;

use bahn_exchange::{Number, Operand, Size};
use bahn_host::{
    Action, Assignment, Attendance, Content, FolderPrograms, Host, Operator, Phase, PowerOn, Source,
};
use bahn_technology::{PlcMemory, WINDOW_BYTES};
use bahn_tnc::Command;

use crate::{UsageError, diagnostics, machine_folder};

/// Bytes that are free for the PLC program [000:11579-11584]: those after them speak with the NC.
const FREE_BYTES: u16 = 256;
/// Longest time from power-on until all reference marks are passed, µs.
const POWER_UP_US: u64 = 600_000_000;

/// A machine that is switched on and ready.
pub(super) struct MachinePlc {
    host: Host,
    /// First byte of the window.
    window: u16,
    /// Time of the machine at which the run begins, µs, and scans before it.
    begin_us: u64,
    begin_scans: u64,
}

impl MachinePlc {
    /// Switches on the machine of a folder, as one that was never on, and has its reference marks passed. `None` when its
    /// files are faulty: that was said.
    ///
    /// # Errors
    /// When there is no such machine, or it does not become ready.
    pub fn new(folder: &Path, window: u16) -> Result<Option<MachinePlc>, UsageError> {
        let machine = match machine_folder::load(folder)? {
            Ok(machine) => machine,
            Err(faults) => {
                diagnostics::print_faults(&faults);
                return Ok(None);
            }
        };
        let programs = Arc::new(FolderPrograms::of_folder(&machine.programs(0)));
        let first = Operator::new(Attendance::Full, machine.folder.operator.clone(), None);
        let operator = machine.channels.iter().fold(first, |operator, channel| {
            operator.with_channel(channel.folder.operator.clone(), None)
        });
        let mut plc = MachinePlc {
            host: Host::new(&machine, PowerOn::fresh(&machine), programs, operator)?,
            window,
            begin_us: 0,
            begin_scans: 0,
        };
        plc.power_up()
            .map_err(|error| UsageError::new(format!("{}: {error}", folder.display())))?;
        Ok(Some(plc))
    }

    /// First byte of the window.
    pub fn window(&self) -> u16 {
        self.window
    }

    fn power_up(&mut self) -> Result<(), String> {
        while self.host.operator().phase() != Phase::Ready {
            self.step()?;
            if self.host.control().time_us() > POWER_UP_US {
                return Err(format!("the machine does not become ready: {}", self.shown()));
            }
        }
        let control = self.host.control();
        (self.begin_us, self.begin_scans) = (control.time_us(), control.plc_scans());
        Ok(())
    }

    /// A cycle of the machine.
    fn step(&mut self) -> Result<(), String> {
        self.host.step().map_err(|error| error.to_string())?;
        match self.host.control().plc().stopped() {
            Some(error) => {
                let (number, text) = (error.error.number(), error.error.text());
                Err(format!(
                    "{}:{}: PLC error {number} {text}",
                    error.file, error.line
                ))
            }
            None => Ok(()),
        }
    }

    /// The messages on its screen.
    fn shown(&self) -> String {
        let control = self.host.control();
        let texts: Vec<String> = control
            .shown()
            .iter()
            .map(|shown| control.shown_text(shown))
            .collect();
        texts.join(", ")
    }

    fn number(&self, at: u16) -> Option<Number> {
        Number::new(Size::Byte, self.window + at)
    }
}

impl PlcMemory for MachinePlc {
    fn run_to(&mut self, time_s: f64) -> Result<u64, String> {
        let to_us = self.begin_us + (time_s * 1e6).round() as u64;
        while self.host.control().time_us() < to_us {
            self.step()?;
        }
        Ok(self.host.control().plc_scans() - self.begin_scans)
    }

    fn read(&self, at: u16) -> u8 {
        let image = self.host.control().exchange().nc();
        self.number(at).map_or(0, |number| image.number(number) as u8)
    }

    fn write(&mut self, at: u16, bytes: &[u8]) {
        for (at, byte) in (at..).zip(bytes) {
            let Some(number) = self.number(at) else { continue };
            let content = Content::Number(i32::from(*byte as i8));
            let set = Command::Set(Assignment::Operand(Operand::Number(number), content));
            // Nothing is logged, so nothing can fail.
            let _ = self.host.act(Source::Script, Action::Command(0, set));
        }
    }
}

/// A window as `B128`: its bytes are free ones.
pub(super) fn window(text: &str) -> Result<u16, String> {
    let last = FREE_BYTES - WINDOW_BYTES;
    let number: Option<Number> = text.trim().to_ascii_uppercase().parse().ok();
    number
        .filter(|number| number.size() == Size::Byte && number.address() <= last && number.address() % 4 == 0)
        .map(Number::address)
        .ok_or_else(|| format!("a window begins at a byte from B0 to B{last}, at every fourth one"))
}
