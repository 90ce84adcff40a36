//! What a peripheral sends: the programs of a folder, one block at a time, whatever their size.

use std::fs::File;
use std::io::{self, BufRead, BufReader};
use std::path::Path;

/// Longest block that is read; a longer line is no program *(inferred)*.
const BLOCK_MAX: usize = 4096;

/// A program that is sent.
#[derive(Debug)]
pub struct Sending {
    reader: BufReader<File>,
    /// The block that the other side has not acknowledged yet.
    current: Option<Vec<u8>>,
    acknowledged: u64,
    bytes: u64,
    size: u64,
}

impl Sending {
    /// Opens a program.
    ///
    /// # Errors
    /// When it cannot be read.
    pub fn open(path: &Path) -> io::Result<Sending> {
        let file = File::open(path)?;
        let size = file.metadata()?.len();
        let mut sending = Sending {
            reader: BufReader::with_capacity(1 << 16, file),
            current: None,
            acknowledged: 0,
            bytes: 0,
            size,
        };
        sending.current = sending.read()?;
        Ok(sending)
    }

    /// The block that is to be sent, without its line end; `None` behind the last one.
    pub fn block(&self) -> Option<&[u8]> {
        self.current.as_deref()
    }

    /// The other side has the block.
    ///
    /// # Errors
    /// When the file cannot be read on.
    pub fn acknowledge(&mut self) -> io::Result<()> {
        if self.current.is_some() {
            self.acknowledged += 1;
            self.current = self.read()?;
        }
        Ok(())
    }

    /// Blocks that the other side has.
    pub fn acknowledged(&self) -> u64 {
        self.acknowledged
    }

    /// How much of the file has been sent, 0 to 100 %.
    pub fn percent(&self) -> f64 {
        let ahead = self.current.as_ref().map_or(0, |block| block.len() as u64);
        match self.size {
            0 => 100.0,
            size => 100.0 * self.bytes.saturating_sub(ahead) as f64 / size as f64,
        }
    }

    /// Passes over blocks that the other side has already, but for BEGIN PGM.
    ///
    /// # Errors
    /// When the file cannot be read on.
    pub fn skip_to(&mut self, acknowledged: u64) -> io::Result<()> {
        while self.acknowledged < acknowledged && self.current.is_some() {
            self.acknowledge()?;
        }
        Ok(())
    }

    /// The next line with text.
    fn read(&mut self) -> io::Result<Option<Vec<u8>>> {
        loop {
            let mut line = Vec::new();
            let mut limited = io::Read::take(&mut self.reader, BLOCK_MAX as u64 + 1);
            let count = limited.read_until(b'\n', &mut line)?;
            if count == 0 {
                return Ok(None);
            }
            if count > BLOCK_MAX {
                return Err(io::Error::new(
                    io::ErrorKind::InvalidData,
                    "a line is longer than any block",
                ));
            }
            self.bytes += count as u64;
            let end = line
                .iter()
                .rposition(|byte| !byte.is_ascii_whitespace() && *byte != 0);
            if let Some(end) = end {
                line.truncate(end + 1);
                return Ok(Some(line));
            }
        }
    }
}
