//! What of a System 900 survives power-off: all parameters, which a battery keeps [002:441-446]. The state folder has those that
//! differ from the data file, as a data file.

use std::fs::{self, File};
use std::io::Write as _;
use std::path::{Path, PathBuf};
use std::time::{Duration, Instant};

use bahn_system900::Memory;

use crate::error::HostError;
use crate::files::{self, NewFile};
use crate::kept;

/// Held while a control is on.
const LOCK: &str = "lock";
/// The parameters that differ.
const PARAMETERS: &str = "parameters.q";
/// How often changes are looked for.
const PERIOD: Duration = Duration::from_millis(200);

/// The state folder of a machine that is switched on.
pub struct State900 {
    path: PathBuf,
    /// What the data file has.
    described: Memory,
    /// What stands in the file.
    written: String,
    looked: Instant,
    _lock: File,
}

impl State900 {
    /// Takes the folder for this control alone, and gives what it found there on top of the parameters of the data file.
    ///
    /// # Errors
    /// When the folder cannot be used, another control uses it, or what was kept cannot be read: a machine does not start
    /// with other parameters than it had.
    pub fn open(folder: &Path, described: &Memory) -> Result<(State900, Memory), HostError> {
        fs::create_dir_all(folder).map_err(|error| files::cannot("make", folder, &error))?;
        let [lock_path, path] = [LOCK, PARAMETERS].map(|name| folder.join(name));
        for path in [folder, &lock_path, &path] {
            kept::refuse_link(path)?;
        }
        let lock = kept::open(&lock_path)?.map_or_else(|| kept::make(&lock_path), Ok)?;
        if !kept::lock(&lock, &lock_path)? {
            return Err(HostError::SwitchedOn(folder.display().to_string()));
        }
        files::sweep(folder);
        let (written, memory) = match path.exists() {
            true => remembered(&path, described)?,
            false => (String::new(), described.clone()),
        };
        let state = State900 {
            path,
            described: described.clone(),
            written,
            looked: Instant::now(),
            _lock: lock,
        };
        Ok((state, memory))
    }

    /// Writes what changed, now and then.
    ///
    /// # Errors
    /// When it cannot be written.
    pub fn keep(&mut self, memory: &Memory) -> Result<(), HostError> {
        if self.looked.elapsed() < PERIOD {
            return Ok(());
        }
        self.looked = Instant::now();
        self.flush(memory)
    }

    /// Writes what changed at once: the control is switched off.
    ///
    /// # Errors
    /// When it cannot be written.
    pub fn flush(&mut self, memory: &Memory) -> Result<(), HostError> {
        let text = memory.differing(&self.described);
        if text != self.written {
            let mut file = NewFile::create(&self.path)?;
            let written = file.write_all(text.as_bytes());
            written.map_err(|error| files::cannot("write", &self.path, &error))?;
            file.finish()?;
            self.written = text;
        }
        Ok(())
    }
}

/// What was kept, and the parameters with it.
fn remembered(path: &Path, described: &Memory) -> Result<(String, Memory), HostError> {
    let bytes = files::read_table(path)?;
    let memory = described.with_kept(&bytes).map_err(|fault| {
        HostError::new(format!(
            "{}: {fault}; put the file away, and the machine begins with its data file",
            path.display()
        ))
    })?;
    Ok((String::from_utf8_lossy(&bytes).into_owned(), memory))
}
