//! A session that is seen again.

use std::path::Path;

use bahn_host::{HostError, files};
use bahn_live::Input;
use crc32fast::Hasher;

use crate::session::{EndLine, FORM, Head, InputLine, screen_sum};
use crate::station::Station;

/// How the file of a session ends.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Ending {
    /// As it was written.
    Whole,
    /// It was cut off: what is there is gone through.
    Cut,
    /// Lines are other ones than were written.
    Changed,
}

/// A session that was recorded.
pub struct Replay {
    head: Head,
    inputs: Vec<(u64, Input)>,
    next: usize,
    end_us: u64,
    ending: Ending,
    screen: Option<String>,
}

impl Replay {
    /// Reads a session.
    ///
    /// # Errors
    /// File and line of the first thing that is none; a torn last line is no error.
    pub fn read(path: &Path) -> Result<Replay, String> {
        let bytes = files::read_table(path).map_err(|error| error.to_string())?;
        Replay::of(&bytes).map_err(|(line, what)| format!("{}:{line}: {what}", path.display()))
    }

    /// The same of bytes; errors with their lines.
    ///
    /// # Errors
    /// Line and words.
    pub fn of(bytes: &[u8]) -> Result<Replay, (usize, String)> {
        let mut lines = bytes.split_inclusive(|byte| *byte == b'\n');
        let first = lines.next().filter(|line| line.ends_with(b"\n"));
        let first = first.ok_or((1, "it does not begin as a session".to_owned()))?;
        let head: Head = serde_json::from_slice(first).map_err(|error| (1, error.to_string()))?;
        if head.session != FORM {
            return Err((1, format!("sessions of form {} are not known", head.session)));
        }
        let mut check = Hasher::new();
        check.update(first);
        let mut replay = Replay {
            head,
            inputs: Vec::new(),
            next: 0,
            end_us: 0,
            ending: Ending::Cut,
            screen: None,
        };
        for (number, line) in (2..).zip(lines) {
            if !line.ends_with(b"\n") {
                break;
            }
            let wrong = |error: String| (number, error);
            if replay.ending != Ending::Cut {
                return Err(wrong("there is something after the end".to_owned()));
            }
            if let Ok(EndLine { t_us, end }) = serde_json::from_slice::<EndLine>(line) {
                let as_written = end.check == format!("{:08x}", check.clone().finalize());
                let complete = as_written && end.inputs == replay.inputs.len() as u64;
                replay.ending = if complete { Ending::Whole } else { Ending::Changed };
                replay.end_us = t_us;
                replay.screen = Some(end.screen);
                continue;
            }
            let read = serde_json::from_slice::<InputLine>(line).map_err(|error| wrong(error.to_string()))?;
            let input = Input::try_from(read.input).map_err(|refusal| wrong(refusal.0))?;
            check.update(line);
            replay.end_us = read.t_us;
            replay.inputs.push((read.t_us, input));
        }
        Ok(replay)
    }

    /// What the session began with.
    pub fn head(&self) -> &Head {
        &self.head
    }

    /// How the file ends.
    pub fn ending(&self) -> Ending {
        self.ending
    }

    /// Inputs that were recorded.
    pub fn len(&self) -> usize {
        self.inputs.len()
    }

    /// The session has no inputs.
    pub fn is_empty(&self) -> bool {
        self.inputs.is_empty()
    }

    /// What of a station is not as it was when the session began, in words; such a session may lead elsewhere.
    pub fn differences(&self, station: &Station) -> Vec<String> {
        let here = Head::of(station.machine(), station.control());
        let pairs = [
            ("machine", &self.head.machine, &here.machine),
            ("model", &self.head.model, &here.model),
            ("version", &self.head.version, &here.version),
            ("what the control had kept", &self.head.kept, &here.kept),
        ];
        let differ = pairs.iter().filter(|(_, then, now)| then != now);
        differ
            .map(|(what, then, now)| format!("{what}: {then} then, {now} now"))
            .collect()
    }

    /// Everything was given, and the time of the end is there.
    pub fn is_over(&self, station: &Station) -> bool {
        self.next == self.inputs.len() && station.control().time_us() >= self.end_us
    }

    /// Gives what is due, and lets a contour cycle pass; `false` when the session is over.
    ///
    /// # Errors
    /// As [`Station::cycle`].
    pub fn cycle(&mut self, station: &mut Station) -> Result<bool, HostError> {
        self.give(station);
        if self.is_over(station) {
            return Ok(false);
        }
        station.cycle()?;
        Ok(true)
    }

    /// Gives what is due now. What was refused then is refused now.
    pub(crate) fn give(&mut self, station: &mut Station) {
        while let Some((time, input)) = self.inputs.get(self.next)
            && *time <= station.control().time_us()
        {
            self.next += 1;
            let _ = station.input(input);
        }
    }

    /// Whether the screen at the end is the one that was seen then; `None` when nobody knows.
    pub fn came_true(&self, station: &mut Station) -> Option<bool> {
        let then = self.screen.as_ref()?;
        Some(*then == screen_sum(station.screen()))
    }
}

/// Reads a session, for fuzzing.
#[doc(hidden)]
pub fn check_session(bytes: &[u8]) -> Result<usize, usize> {
    match Replay::of(bytes) {
        Ok(replay) => Ok(replay.len()),
        Err((line, _)) => Err(line),
    }
}
