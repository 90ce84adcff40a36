//! Transfer of files, block by block.

use std::io::{Read, Write};

use super::{Command, ErrorNumber, Telegram};
use bahn_store::{Reading, Writing};

/// Length and command of a telegram, and two bytes that clients leave free (public).
const HEAD: usize = 10;
/// Without the binary flag a zero byte ends a line (public).
const END_OF_LINE: u8 = 0;

/// Flags after the name of a file (public).
pub(super) const BINARY: u8 = 1;
/// Lines of a table replace those of the table that is there.
pub(super) const MERGE: u8 = 2;

/// A file that goes out.
pub(super) struct Sending {
    file: Reading,
    binary: bool,
    /// The last block ended between CR and LF.
    carriage_return: bool,
}

impl Sending {
    pub fn new(file: Reading, binary: bool) -> Sending {
        Sending {
            file,
            binary,
            carriage_return: false,
        }
    }

    /// The next block; `None` after the last one.
    pub fn next(&mut self, block: usize) -> Result<Option<Telegram>, ErrorNumber> {
        let mut data = vec![0; block.saturating_sub(HEAD)];
        loop {
            let read = fill(&mut self.file, &mut data)?;
            data.truncate(read);
            if !self.binary {
                self.lines(&mut data);
            }
            // A block that was the rest of an end of line only.
            if read > 0 && data.is_empty() {
                data.resize(block.saturating_sub(HEAD), 0);
                continue;
            }
            return Ok((read > 0).then(|| Telegram::with(Command(*b"S_FL"), data)));
        }
    }

    /// LF, CR LF and CR become the end of a line.
    fn lines(&mut self, data: &mut Vec<u8>) {
        let mut before = self.carriage_return;
        data.retain_mut(|byte| {
            let stays = !(before && *byte == b'\n');
            before = *byte == b'\r';
            if matches!(*byte, b'\r' | b'\n') {
                *byte = END_OF_LINE;
            }
            stays
        });
        self.carriage_return = before;
    }
}

/// Reads until the buffer is full, or the file has ended.
fn fill(file: &mut Reading, buffer: &mut [u8]) -> Result<usize, ErrorNumber> {
    let mut filled = 0;
    while let Some(rest) = buffer.get_mut(filled..).filter(|rest| !rest.is_empty()) {
        match file.read(rest) {
            Ok(0) => break,
            Ok(read) => filled += read,
            Err(error) if error.kind() == std::io::ErrorKind::Interrupted => {}
            Err(_) => return Err(ErrorNumber::BLOCK_BAD),
        }
    }
    Ok(filled)
}

/// A file that comes in; dropped, nothing of it is left.
pub(super) struct Receiving {
    file: Writing,
    binary: bool,
}

impl Receiving {
    pub fn new(file: Writing, binary: bool) -> Receiving {
        Receiving { file, binary }
    }

    pub fn take(&mut self, data: &[u8]) -> Result<(), ErrorNumber> {
        let written = match self.binary {
            true => self.file.write_all(data),
            false => data
                .split_inclusive(|byte| *byte == END_OF_LINE)
                .try_for_each(|line| match line.strip_suffix(&[END_OF_LINE]) {
                    Some(line) => self
                        .file
                        .write_all(line)
                        .and_then(|()| self.file.write_all(b"\n")),
                    None => self.file.write_all(line),
                }),
        };
        written.map_err(|_| ErrorNumber::BLOCK_NO_SPACE)
    }

    pub fn end(self) -> Result<(), ErrorNumber> {
        self.file.commit().map_err(|error| ErrorNumber::from(&error))
    }
}
