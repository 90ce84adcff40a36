//! What the operator has chosen, kept over power-off.

use std::path::{Path, PathBuf};

use bahn_tnc::{Control, RunState};

use crate::settings::Settings;

/// µs of a minute.
const MINUTE_US: u64 = 60_000_000;

/// The settings, and what of them is on the medium.
#[derive(Default)]
pub(super) struct Chosen {
    pub now: Settings,
    stored: Settings,
    folder: PathBuf,
    /// Less than a minute of each machine time, µs.
    timers_us: [u64; 3],
}

impl Chosen {
    /// What was kept in a folder; what of it cannot be read is told.
    pub fn read(&mut self, folder: &Path) -> Option<String> {
        folder.clone_into(&mut self.folder);
        let (settings, unread) = Settings::read(folder);
        self.stored = settings.clone();
        self.now = settings;
        unread
    }

    /// Keeps it as soon as it is another one.
    ///
    /// # Errors
    /// In words, when it cannot be written; it is not tried again before the next change.
    pub fn store(&mut self) -> Result<(), String> {
        if self.now == self.stored {
            return Ok(());
        }
        self.stored = self.now.clone();
        self.now.write(&self.folder)
    }

    /// Counts the machine times by a cycle; they are kept in whole minutes.
    pub fn count_time(&mut self, control: &Control) {
        let runs = control.run_state() == RunState::Running;
        let turns = control.spindle().actual_rpm.abs() >= 1.0;
        let cycle_us = u64::from(control.cycle_us());
        let counters = self.timers_us.iter_mut().zip(&mut self.now.timers_min);
        for ((us, minutes), counts) in counters.zip([true, runs, turns]) {
            *us += if counts { cycle_us } else { 0 };
            if *us >= MINUTE_US {
                *us -= MINUTE_US;
                *minutes += 1;
            }
        }
    }
}
