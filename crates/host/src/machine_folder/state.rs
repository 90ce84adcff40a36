//! What survives power-off: the journal of the PLC's memory, and what the control remembers.

use std::fs::{self, File};
use std::io::Write as _;
use std::path::{Path, PathBuf};
use std::time::{Duration, Instant};

use bahn_control::{Control, Remembered};
use bahn_exchange::Exchange;

use super::remembered;
use crate::files::{self, NewFile};
use crate::retained::Retained;
use crate::{HostError, kept};

/// The journal of retained markers and bytes.
const JOURNAL: &str = "plc.mem";
/// What the control remembers, of the first channel and of a further one.
pub(super) fn control_file(channel: usize) -> String {
    match channel {
        0 => "control.toml".to_owned(),
        further => format!("control-{}.toml", further + 1),
    }
}
/// Held while a control is on.
pub(super) const LOCK: &str = "lock";
/// How often changes are looked for that nothing waits for.
const PERIOD: Duration = Duration::from_millis(200);

/// A control is on that uses a state folder; nothing is made where there is none.
pub(super) fn is_in_use(folder: &Path) -> bool {
    let lock = folder.join(LOCK);
    let file = kept::open(&lock).ok().flatten();
    file.is_some_and(|file| kept::lock(&file, &lock) == Ok(false))
}

/// The state folder of a machine that is switched on.
pub struct State {
    journal: Retained,
    /// The file of each channel, and what stands in it.
    files: Vec<(PathBuf, String)>,
    looked: Instant,
    /// Unlocked when the control is switched off.
    _lock: File,
}

/// What a control finds at power-on.
pub struct Found {
    /// Where it keeps what changes.
    pub state: State,
    /// `None` when nothing is there yet.
    pub remembered: Option<Remembered>,
    /// That of the channels beside the first one.
    pub others: Vec<Option<Remembered>>,
    /// Both images with the retained markers and bytes.
    pub exchange: Exchange,
    /// What was lost, in words.
    pub warnings: Vec<String>,
}

impl State {
    /// Opens the folder of a machine with so many channels; it is made when it is missing.
    ///
    /// # Errors
    /// When the folder cannot be used, another control uses it, or what the control remembered cannot be
    /// read: a machine does not start with another datum than it had.
    pub fn open(folder: &Path, channels: usize) -> Result<Found, HostError> {
        fs::create_dir_all(folder).map_err(|error| files::cannot("make", folder, &error))?;
        let [lock_path, journal] = [LOCK, JOURNAL].map(|name| folder.join(name));
        let paths: Vec<PathBuf> = (0..channels.max(1))
            .map(|channel| folder.join(control_file(channel)))
            .collect();
        for path in [folder, &lock_path, &journal]
            .into_iter()
            .chain(paths.iter().map(PathBuf::as_path))
        {
            kept::refuse_link(path)?;
        }
        let lock = kept::open(&lock_path)?.map_or_else(|| kept::make(&lock_path), Ok)?;
        if !kept::lock(&lock, &lock_path)? {
            return Err(HostError::SwitchedOn(folder.display().to_string()));
        }
        let (mut files, mut found) = (Vec::new(), Vec::new());
        for path in paths {
            remove_half_written(folder, &path);
            let (written, remembered) = remembered_in(&path)?.unzip();
            files.push((path, written.unwrap_or_default()));
            found.push(remembered);
        }
        let others = found.split_off(1);
        let remembered = found.pop().flatten();
        let mut warnings = Vec::new();
        if remembered.is_some() && kept::open(&journal)?.is_none() {
            warnings.push(format!(
                "{} is missing: all retained markers and bytes begin with 0",
                journal.display()
            ));
        }
        let journal = Retained::open(&journal)?;
        warnings.extend(journal.damage().map(str::to_owned));
        let exchange = journal.restore();
        Ok(Found {
            state: State {
                journal,
                files,
                looked: Instant::now(),
                _lock: lock,
            },
            remembered,
            others,
            exchange,
            warnings,
        })
    }

    /// It is time to look for changes.
    pub fn is_due(&self) -> bool {
        self.looked.elapsed() >= PERIOD
    }

    /// Writes what changed: at once what the control waits for, everything else now and then.
    ///
    /// # Errors
    /// When it cannot be written.
    pub fn keep(&mut self, control: &mut Control) -> Result<(), HostError> {
        if control.unsaved().is_some() {
            // First what the PLC did when it acknowledged, then what follows from it.
            self.flush(control)?;
            control.stored();
            return Ok(());
        }
        if !self.is_due() {
            return Ok(());
        }
        self.looked = Instant::now();
        self.journal.tick(control.exchange().plc())?;
        self.write(control)
    }

    /// Writes what changed at once: the control is switched off.
    ///
    /// # Errors
    /// When it cannot be written.
    pub fn flush(&mut self, control: &Control) -> Result<(), HostError> {
        self.journal.flush(control.exchange().plc())?;
        self.write(control)
    }

    fn write(&mut self, control: &Control) -> Result<(), HostError> {
        for (number, (path, written)) in self.files.iter_mut().enumerate() {
            let remembered = match control.channel(number).filter(|_| number > 0) {
                Some(channel) => channel.remember(),
                None => control.remember(),
            };
            let text = remembered::write(&remembered);
            if text == *written {
                continue;
            }
            let mut file = NewFile::create(path)?;
            file.write_all(text.as_bytes())
                .map_err(|error| files::cannot("write", path, &error))?;
            file.finish()?;
            *written = text;
        }
        Ok(())
    }
}

/// The text of the file and what it says; `None` when nothing was kept yet. A damaged file is put aside.
fn remembered_in(file: &Path) -> Result<Option<(String, Remembered)>, HostError> {
    if kept::open(file)?.is_none() {
        return match kept::found_aside(file) {
            None => Ok(None),
            Some(aside) => Err(unknown(file, &aside, "it was found damaged")),
        };
    }
    let bytes = files::read_table(file)?;
    match remembered::read(&bytes) {
        Ok(remembered) => Ok(Some((String::from_utf8_lossy(&bytes).into_owned(), remembered))),
        Err(what) => {
            let aside = kept::set_aside(file, &bytes).map_err(|error| files::cannot("keep", file, &error))?;
            fs::remove_file(file).map_err(|error| files::cannot("put aside", file, &error))?;
            files::sync_folder(file);
            Err(unknown(file, &aside, &what))
        }
    }
}

/// Nobody but the operator knows datum and tool now.
fn unknown(file: &Path, aside: &Path, what: &str) -> HostError {
    HostError::new(format!(
        "{}: {what}\ndatums, tool in the spindle, pockets, offsets and Q parameters are not known: the machine is not \
         started\nthe damaged file is kept: {}\nto go on with it, mend it, end it with the line `{}` and give it \
         its name back\nto begin with the datum of machine.toml, remove it",
        file.display(),
        aside.display(),
        remembered::MENDED
    ))
}

/// What a process that was killed was writing is of no use to anybody.
fn remove_half_written(folder: &Path, file: &Path) {
    let name = file.file_name().unwrap_or_default().to_string_lossy();
    let begun = format!(".{name}.");
    let entries = fs::read_dir(folder).into_iter().flatten().flatten();
    for entry in entries {
        let name = entry.file_name();
        let name = name.to_string_lossy();
        if name.starts_with(&begun) && name.ends_with(".tmp") {
            // It is in nobody's way.
            let _ = fs::remove_file(entry.path());
        }
    }
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used, reason = "a test may fail")]
    use super::*;

    fn folder(name: &str) -> PathBuf {
        let folder = std::env::temp_dir().join(format!("bahn-state-{name}-{}", std::process::id()));
        let _ = fs::remove_dir_all(&folder);
        folder
    }

    fn with_tool(tool: u32) -> String {
        remembered::write(&Remembered {
            tool,
            q: vec![(1, 12.5), (100, -3.0)],
            ..Remembered::default()
        })
    }

    /// The supply goes behind any byte of the new file, before its name changes: the machine begins with what was
    /// remembered before, and what is half written goes.
    #[test]
    fn a_power_failure_inside_a_write_keeps_what_was_remembered() {
        let folder = folder("torn");
        drop(State::open(&folder, 1).unwrap());
        let (old, new) = (with_tool(3), with_tool(4));
        fs::write(folder.join("control.toml"), &old).unwrap();
        for written in 0..=new.len() {
            let half = folder.join(".control.toml.4711.tmp");
            fs::write(&half, &new.as_bytes()[..written]).unwrap();
            let found = State::open(&folder, 1).unwrap();
            assert_eq!(found.remembered.unwrap().tool, 3, "{written} bytes");
            assert!(!half.exists() && found.warnings.is_empty(), "{written} bytes");
        }
        // The name changes in one step.
        fs::write(folder.join(".control.toml.4711.tmp"), &new).unwrap();
        fs::rename(folder.join(".control.toml.4711.tmp"), folder.join("control.toml")).unwrap();
        assert_eq!(State::open(&folder, 1).unwrap().remembered.unwrap().tool, 4);
        fs::remove_dir_all(&folder).unwrap();
    }
}
