//! What passes over a line, written down: a line of text for each byte that belongs together with the time, `>` for what
//! was sent and `<` for what came.

use std::io::Write as _;
use std::path::Path;
use std::time::Duration;

use bahn_host::files::NewFile;

use crate::PortError;

/// Bytes in a line at most.
const ROW: usize = 32;

/// A trace that is being written, or none.
pub struct Trace {
    file: Option<NewFile>,
    row: Vec<u8>,
    sent: bool,
    since: Duration,
    failed: Option<String>,
}

impl Trace {
    /// Begins a trace; without a path nothing is written.
    ///
    /// # Errors
    /// When the file cannot be created.
    pub fn open(path: Option<&Path>) -> Result<Trace, PortError> {
        let file = path.map(NewFile::create).transpose()?;
        Ok(Trace {
            file,
            row: Vec::new(),
            sent: false,
            since: Duration::ZERO,
            failed: None,
        })
    }

    /// A byte has passed: it was sent, or came, at a time since the line was opened.
    pub fn byte(&mut self, sent: bool, byte: u8, now: Duration) {
        if self.file.is_none() {
            return;
        }
        if sent != self.sent || now != self.since || self.row.len() >= ROW {
            self.flush();
            (self.sent, self.since) = (sent, now);
        }
        self.row.push(byte);
    }

    fn flush(&mut self) {
        if self.row.is_empty() {
            return;
        }
        let bytes: Vec<String> = self.row.drain(..).map(|byte| format!("{byte:02X}")).collect();
        let way = if self.sent { '>' } else { '<' };
        let time = self.since.as_secs_f64();
        if let Some(file) = &mut self.file
            && let Err(error) = writeln!(file, "{time:.6} {way} {}", bytes.join(" "))
        {
            self.failed.get_or_insert(error.to_string());
        }
    }

    /// The trace is whole.
    ///
    /// # Errors
    /// When it could not be written.
    pub fn finish(mut self) -> Result<(), PortError> {
        self.flush();
        if let Some(error) = self.failed {
            return Err(PortError::Failed(format!("cannot write the trace: {error}")));
        }
        if let Some(file) = self.file {
            file.finish()?;
        }
        Ok(())
    }
}
