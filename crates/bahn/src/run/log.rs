//! What was done to control and machine, in the form of a script. Its last line holds a check sum, so that a
//! replay tells a log that was damaged, cut off or edited from one that is as it was written.

use std::io::Write;
use std::path::{Path, PathBuf};

use crc32fast::Hasher;

use crate::UsageError;
use crate::diagnostics::printable;
use crate::files::{self, NewFile};

pub(super) struct Log {
    path: PathBuf,
    file: NewFile,
    sum: Hasher,
}

impl Log {
    pub fn create(path: &Path, title: &str) -> Result<Log, UsageError> {
        let mut log = Log {
            path: path.to_owned(),
            file: NewFile::create(path)?,
            sum: Hasher::new(),
        };
        log.write(&format!("; {title}; bahn run --replay repeats it"))?;
        Ok(log)
    }

    /// Notes what was done before the cycle of this time.
    pub fn note(&mut self, time_us: u64, what: &str) -> Result<(), UsageError> {
        self.write(&format!(
            "{}.{:06}: {what}",
            time_us / 1_000_000,
            time_us % 1_000_000
        ))
    }

    pub fn finish(mut self) -> Result<(), UsageError> {
        self.write(&check_line(self.sum.clone()))?;
        Ok(self.file.finish()?)
    }

    fn write(&mut self, line: &str) -> Result<(), UsageError> {
        // A line stays one, whatever the name of a program is.
        let line = printable(line) + "\n";
        self.sum.update(line.as_bytes());
        self.file
            .write_all(line.as_bytes())
            .map_err(|error| files::cannot("write", &self.path, &error).into())
    }
}

/// The last line, a comment, of the lines that were summed up.
fn check_line(sum: Hasher) -> String {
    format!("; check {:08x}", sum.finalize())
}

/// Whether a log is as it was written.
pub(super) fn is_whole(log: &[u8]) -> bool {
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
    use super::*;

    /// Whatever bit flips, wherever the log is cut: it is found.
    #[test]
    fn every_damage_is_found() {
        let path = std::env::temp_dir().join(format!("bahn-log-{}", std::process::id()));
        let mut log = Log::create(&path, "Mill, a\u{1b}\nb.H").unwrap();
        log.note(1_860_000, "key NC_START tap").unwrap();
        log.note(2_000_001, "override feed 50").unwrap();
        log.finish().unwrap();
        let whole = std::fs::read(&path).unwrap();
        std::fs::remove_file(&path).unwrap();
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
