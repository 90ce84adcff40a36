//! What a peripheral sends to a control that executes it: programs, line by line, and which block is in the machine.

use std::collections::BTreeMap;
use std::io::{self, BufRead, BufReader, Read};
use std::sync::{Arc, Mutex, MutexGuard, PoisonError};

use crate::files::{Files, Listed, NewFile};
use bahn_store::StoreError;

/// Longest line that is read at once.
const LINE_MAX: u64 = 1 << 16;

/// How far the program is that is sent.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct Progress {
    /// Its name; empty before the first one.
    pub name: String,
    /// Blocks that the machine has acknowledged.
    pub blocks: u64,
    /// Size of the blocks, bytes.
    pub bytes: u64,
    /// Bytes of the file.
    pub size: u64,
}

impl Progress {
    /// How much of the file is in the machine, %.
    pub fn percent(&self) -> f64 {
        match self.size {
            0 => 100.0,
            size => 100.0 * self.bytes as f64 / size as f64,
        }
    }
}

/// Where a [`Spool`] reports its progress.
#[derive(Clone, Debug, Default)]
pub struct Spooled(Arc<Mutex<State>>);

#[derive(Debug, Default)]
struct State {
    progress: Progress,
    /// The line that was handed out last: its acknowledgement lets the next one be read.
    line: u64,
    /// Blocks of programs that were acknowledged when their transfer was broken off.
    broken: BTreeMap<String, u64>,
}

impl Spooled {
    fn state(&self) -> MutexGuard<'_, State> {
        self.0.lock().unwrap_or_else(PoisonError::into_inner)
    }

    /// How far the program is that is sent, or was last.
    pub fn progress(&self) -> Progress {
        self.state().progress.clone()
    }

    /// The program has arrived.
    pub fn arrived(&self, name: &str) {
        let mut state = self.state();
        state.broken.remove(&name.to_ascii_uppercase());
        let size = state.progress.size;
        if state.line > 0 {
            state.progress.blocks += 1;
        }
        (state.progress.bytes, state.line) = (size, 0);
    }

    /// Its transfer was broken off.
    pub fn broken_off(&self) {
        let mut state = self.state();
        let (name, blocks) = (state.progress.name.to_ascii_uppercase(), state.progress.blocks);
        if !name.is_empty() {
            state.broken.insert(name, blocks);
        }
        state.line = 0;
    }
}

/// Programs of other files that are read only, with a look at how far they are.
pub struct Spool {
    files: Box<dyn Files>,
    spooled: Spooled,
    /// After a broken transfer a program begins with its first block and those that were not acknowledged.
    resumes: bool,
}

impl Spool {
    /// A spool of these files; with `resumes` a broken transfer goes on where it was.
    pub fn new(files: Box<dyn Files>, resumes: bool) -> Spool {
        Spool {
            files,
            spooled: Spooled::default(),
            resumes,
        }
    }

    /// Where it reports its progress.
    pub fn spooled(&self) -> Spooled {
        self.spooled.clone()
    }
}

impl Files for Spool {
    fn list(&mut self) -> Vec<Listed> {
        self.files.list()
    }

    fn find(&mut self, name: &str) -> Option<Listed> {
        self.files.find(name)
    }

    fn open(&mut self, name: &str) -> Result<Box<dyn Read + Send>, StoreError> {
        let size = self.files.find(name).map_or(0, |file| file.size);
        let file = self.files.open(name)?;
        let mut state = self.spooled.state();
        let known = state.broken.get(&name.to_ascii_uppercase()).copied();
        state.line = 0;
        state.progress = Progress {
            name: name.to_owned(),
            size,
            ..Progress::default()
        };
        Ok(Box::new(Lines {
            file: BufReader::with_capacity(1 << 16, file),
            spooled: self.spooled.clone(),
            line: Vec::new(),
            at: 0,
            skips: known.filter(|_| self.resumes).unwrap_or_default(),
        }))
    }

    fn create(&mut self, name: &str) -> Result<Box<dyn NewFile>, StoreError> {
        Err(StoreError::Protected(name.to_owned()))
    }
}

/// A program whose lines are read one by one: who reads the next one has an acknowledgement of the last.
struct Lines {
    file: BufReader<Box<dyn Read + Send>>,
    spooled: Spooled,
    line: Vec<u8>,
    at: usize,
    /// Blocks that the machine has, with BEGIN PGM, which it gets again.
    skips: u64,
}

impl Lines {
    fn next_line(&mut self) -> io::Result<()> {
        let Lines {
            file,
            spooled,
            line,
            at,
            skips,
        } = self;
        *at = 0;
        let mut state = spooled.state();
        if state.line > 0 {
            state.progress.blocks += 1;
            state.progress.bytes += line.len() as u64;
        }
        if state.line == 1 {
            while state.progress.blocks < *skips && read(file, line)? {
                state.progress.blocks += 1;
                state.progress.bytes += line.len() as u64;
            }
        }
        let more = read(file, line)?;
        state.line = if more { state.line + 1 } else { 0 };
        Ok(())
    }
}

/// Reads a line; `false` after the last one.
fn read(file: &mut BufReader<Box<dyn Read + Send>>, line: &mut Vec<u8>) -> io::Result<bool> {
    line.clear();
    let count = file.take(LINE_MAX).read_until(b'\n', line)?;
    Ok(count > 0)
}

impl Read for Lines {
    fn read(&mut self, into: &mut [u8]) -> io::Result<usize> {
        if self.at == self.line.len() {
            self.next_line()?;
        }
        let left = self.line.get(self.at..).unwrap_or_default();
        let count = left.len().min(into.len());
        if let (Some(to), Some(from)) = (into.get_mut(..count), left.get(..count)) {
            to.copy_from_slice(from);
        }
        self.at += count;
        Ok(count)
    }
}
