//! A session as a file: every input with its time, so that it can be seen again.
//!
//! ```text
//! {"session":1,"machine":"Mill, TNC 415 B","model":"tnc415b","version":"0.1.0","kept":"5d0c43f1"}
//! {"t_us":1860000,"input":{"key":"CE"}}
//! {"t_us":93000000,"end":{"inputs":1,"screen":"91ad03b2","check":"0a7be33c"}}
//! ```
//!
//! A line is in the file as soon as the input is taken, and on the medium a second later, whatever happens to station and computer then: a file without its last line, or with a torn one, is a session that was
//! cut off.

use std::fs::{File, OpenOptions};
use std::io::Write;
use std::path::{Path, PathBuf};
use std::time::{Duration, Instant};

use bahn_host::{LoadedMachine, files};
use bahn_live::{Input, InputText};
use bahn_screen::Screen;
use bahn_tnc::Control;
use crc32fast::Hasher;
use serde::{Deserialize, Serialize};

/// The form of the file.
pub(crate) const FORM: u32 = 1;

/// What a session began with.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Head {
    /// The form of the file.
    pub session: u32,
    /// Name of the machine.
    pub machine: String,
    /// Model of the control.
    pub model: String,
    /// Version of Bahn that recorded the session.
    pub version: String,
    /// Check sum of what the control had kept.
    pub kept: String,
}

impl Head {
    /// Of a machine as it is now.
    pub(crate) fn of(machine: &LoadedMachine, control: &Control) -> Head {
        Head {
            session: FORM,
            machine: machine.folder.name.clone(),
            model: control.model().id().to_owned(),
            version: env!("CARGO_PKG_VERSION").to_owned(),
            kept: sum(format!("{:?}", control.remember()).as_bytes()),
        }
    }
}

#[derive(Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub(crate) struct InputLine {
    pub t_us: u64,
    pub input: InputText,
}

#[derive(Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub(crate) struct EndLine {
    pub t_us: u64,
    pub end: End,
}

#[derive(Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub(crate) struct End {
    pub inputs: u64,
    /// Of the last screen.
    pub screen: String,
    /// Of all lines before.
    pub check: String,
}

/// Writes a session. [`crate::Station::record`] makes one.
pub struct Recorder {
    file: File,
    path: PathBuf,
    inputs: u64,
    check: Hasher,
    /// When the first line was written that may not be on the medium.
    unsafe_since: Option<Instant>,
}

/// What was written is on the medium after so long.
const SAFE_AFTER: Duration = Duration::from_secs(1);

impl Recorder {
    /// Begins a file; one that is there stays as it is.
    ///
    /// # Errors
    /// In words, when it is there already or cannot be written.
    pub fn create(path: &Path, head: &Head) -> Result<Recorder, String> {
        let file = OpenOptions::new().append(true).create_new(true).open(path);
        let mut recorder = Recorder {
            file: file.map_err(|error| files::cannot("write", path, &error).to_string())?,
            path: path.to_owned(),
            inputs: 0,
            check: Hasher::new(),
            unsafe_since: None,
        };
        recorder.write(head)?;
        recorder.make_safe()?;
        files::sync_folder(path);
        Ok(recorder)
    }

    /// Notes an input before the cycle of this time.
    ///
    /// # Errors
    /// When it cannot be written.
    pub fn note(&mut self, t_us: u64, input: &Input) -> Result<(), String> {
        self.inputs += 1;
        self.write(&InputLine {
            t_us,
            input: input.into(),
        })
    }

    /// Ends the session with the screen as it is.
    ///
    /// # Errors
    /// When it cannot be written.
    pub fn finish(mut self, t_us: u64, screen: &Screen) -> Result<(), String> {
        let end = End {
            inputs: self.inputs,
            screen: screen_sum(screen),
            check: format!("{:08x}", self.check.clone().finalize()),
        };
        self.write(&EndLine { t_us, end })?;
        self.make_safe()
    }

    /// Puts on the medium what was written a second ago or earlier; to be called in every cycle.
    ///
    /// # Errors
    /// When it cannot be written.
    pub fn keep(&mut self) -> Result<(), String> {
        match self.unsafe_since {
            Some(since) if since.elapsed() >= SAFE_AFTER => self.make_safe(),
            _ => Ok(()),
        }
    }

    /// Everything that was written is on the medium.
    pub(crate) fn is_safe(&self) -> bool {
        self.unsafe_since.is_none()
    }

    /// Puts on the medium what was written.
    ///
    /// # Errors
    /// When it cannot be written.
    fn make_safe(&mut self) -> Result<(), String> {
        if self.is_safe() {
            return Ok(());
        }
        let synced = self.file.sync_data();
        synced.map_err(|error| files::cannot("write", &self.path, &error).to_string())?;
        self.unsafe_since = None;
        Ok(())
    }

    fn write(&mut self, line: &impl Serialize) -> Result<(), String> {
        let mut text = serde_json::to_vec(line).map_err(|error| error.to_string())?;
        text.push(b'\n');
        self.check.update(&text);
        self.unsafe_since.get_or_insert_with(Instant::now);
        let written = self.file.write_all(&text);
        written.map_err(|error| files::cannot("write", &self.path, &error).to_string())
    }
}

/// Check sum of what is to be seen. How many screens there were before depends on who looked, and how far a picture has
/// come on how fast the computer is.
pub(crate) fn screen_sum(screen: &Screen) -> String {
    let seen = Screen {
        serial: 0,
        graphics: None,
        ..screen.clone()
    };
    serde_json::to_vec(&seen).map_or_else(|_| String::new(), |text| sum(&text))
}

fn sum(bytes: &[u8]) -> String {
    format!("{:08x}", crc32fast::hash(bytes))
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used, reason = "a test may fail")]
    use super::*;

    /// What was noted is on the medium a second later, without another input.
    #[test]
    fn a_kill_loses_a_second_at_most() {
        let path = std::env::temp_dir().join(format!("bahn-session-{}.jsonl", std::process::id()));
        let _ = std::fs::remove_file(&path);
        let head = Head {
            session: FORM,
            machine: "Mill".to_owned(),
            model: "tnc415b".to_owned(),
            version: "1".to_owned(),
            kept: "0".to_owned(),
        };
        let mut recorder = Recorder::create(&path, &head).unwrap();
        assert!(recorder.is_safe());
        recorder.note(1000, &Input::Power(bahn_path::Switch::On)).unwrap();
        recorder.keep().unwrap();
        assert!(!recorder.is_safe(), "not every key waits for the medium");
        std::thread::sleep(SAFE_AFTER);
        recorder.keep().unwrap();
        assert!(recorder.is_safe());
        assert_eq!(std::fs::read_to_string(&path).unwrap().lines().count(), 2);
        std::fs::remove_file(&path).unwrap();
    }
}
