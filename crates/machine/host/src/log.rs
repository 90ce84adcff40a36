//! What was done to control and machine, in the form of a script. Its last line holds a check sum, so that a
//! replay tells a log that was damaged, cut off or edited from one that is as it was written.
//!
//! Decision: A log ends with a check sum; a replay of one that is not as it was written is warned of, since logs may
//! be edited

use std::io::{self, Write};
use std::path::{Path, PathBuf};

use crc32fast::Hasher;

use crate::action::Source;
use crate::error::HostError;
use crate::files::{self, NewFile};
use bahn_text::printable;

/// Who is told what is done.
pub trait Sink {
    /// Notes what is done before the cycle of this time, µs since power-on.
    ///
    /// # Errors
    /// When it cannot be written.
    fn note(&mut self, time_us: u64, source: &Source, what: &str) -> Result<(), HostError>;

    /// Nothing more comes.
    ///
    /// # Errors
    /// When it cannot be completed.
    fn finish(&mut self) -> Result<(), HostError>;
}

/// A log that is written.
pub struct Log<W> {
    writer: W,
    sum: Hasher,
}

impl<W: Write> Log<W> {
    /// Begins a log.
    ///
    /// # Errors
    /// When it cannot be written.
    pub fn new(writer: W, title: &str) -> io::Result<Log<W>> {
        let mut log = Log {
            writer,
            sum: Hasher::new(),
        };
        log.write(&format!("; {title}"))?;
        Ok(log)
    }

    /// Notes what is done before the cycle of this time, µs since power-on.
    ///
    /// # Errors
    /// When it cannot be written.
    pub fn note(&mut self, time_us: u64, what: &str) -> io::Result<()> {
        self.write(&format!(
            "{}.{:06}: {what}",
            time_us / 1_000_000,
            time_us % 1_000_000
        ))
    }

    /// Writes the check sum.
    ///
    /// # Errors
    /// When it cannot be written.
    pub fn finish(mut self) -> io::Result<W> {
        self.write(&check_line(self.sum.clone()))?;
        Ok(self.writer)
    }

    fn write(&mut self, line: &str) -> io::Result<()> {
        // A line stays one, whatever the name of a program is.
        let line = printable(line) + "\n";
        self.sum.update(line.as_bytes());
        self.writer.write_all(line.as_bytes())
    }
}

/// A log in a file, which is there when it is complete.
pub struct LogFile {
    path: PathBuf,
    log: Option<Log<NewFile>>,
}

impl LogFile {
    /// Begins a log.
    ///
    /// # Errors
    /// When it cannot be written.
    pub fn create(path: &Path, title: &str) -> Result<LogFile, HostError> {
        let log = Log::new(NewFile::create(path)?, title);
        Ok(LogFile {
            path: path.to_owned(),
            log: Some(log.map_err(|error| files::cannot("write", path, &error))?),
        })
    }
}

impl Sink for LogFile {
    fn note(&mut self, time_us: u64, _: &Source, what: &str) -> Result<(), HostError> {
        let written = self.log.as_mut().map_or(Ok(()), |log| log.note(time_us, what));
        written.map_err(|error| files::cannot("write", &self.path, &error))
    }

    fn finish(&mut self) -> Result<(), HostError> {
        let finished = self.log.take().map(Log::finish).transpose();
        let file = finished.map_err(|error| files::cannot("write", &self.path, &error))?;
        file.map_or(Ok(()), NewFile::finish)
    }
}

/// The last line, a comment, of the lines that were summed up.
fn check_line(sum: Hasher) -> String {
    format!("; check {:08x}", sum.finalize())
}

/// Whether a log is as it was written.
pub fn is_whole(log: &[u8]) -> bool {
    let Some(log) = log.strip_suffix(b"\n") else {
        return false;
    };
    let last = log.iter().rposition(|byte| *byte == b'\n').map_or(0, |at| at + 1);
    let (lines, check) = log.split_at(last);
    let mut sum = Hasher::new();
    sum.update(lines);
    check == check_line(sum).as_bytes()
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used, reason = "a test may fail")]
    use super::*;

    /// Whatever bit flips, wherever the log is cut: it is found.
    #[test]
    fn every_damage_is_found() {
        let mut log = Log::new(Vec::new(), "Mill, a\u{1b}\nb.H").unwrap();
        log.note(1_860_000, "key NC_START tap").unwrap();
        log.note(2_000_001, "override feed 50").unwrap();
        let whole = log.finish().unwrap();
        assert!(is_whole(&whole), "{}", String::from_utf8_lossy(&whole));
        assert_eq!(whole.iter().filter(|byte| **byte == b'\n').count(), 4);
        for at in 0..whole.len() {
            assert!(!is_whole(&whole[..at]), "{at} bytes");
            for bit in 0..8 {
                let mut damaged = whole.clone();
                damaged[at] ^= 1 << bit;
                assert!(!is_whole(&damaged), "bit {bit} of byte {at}");
            }
        }
    }
}
