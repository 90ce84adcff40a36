//! What is seen of the machine: the screen as data, the graphics, what has happened, what can be broken, lessons.

use std::sync::Arc;
use std::time::Duration;

use bahn_panel::{BeingCut, Breakable, Picture, Screen, Station};

use crate::error::ServiceError;
use crate::log::Events;
use crate::service::MachineService;

impl MachineService {
    /// The screen as it was made last; all who show one draw this.
    pub fn screen(&self) -> Arc<Screen> {
        self.shared.link.screen()
    }

    /// Waits for a screen after this serial, at most so long.
    pub fn next_screen(&self, serial: u64, at_most: Duration) -> Arc<Screen> {
        self.shared.link.next_screen(serial, at_most)
    }

    /// The screen of this moment, with what the graphics show when they are looked at.
    ///
    /// # Errors
    /// When the machine has ended, or too many wait.
    pub fn screen_with_picture(&self) -> Result<(Screen, Option<Picture>), ServiceError> {
        self.with(|station| {
            let picture = station.picture();
            (station.screen().clone(), picture)
        })
    }

    /// What the graphics show, to be drawn; `None` while they are not looked at, and without a part.
    ///
    /// # Errors
    /// When the machine has ended, or too many wait.
    pub fn picture(&self) -> Result<Option<Picture>, ServiceError> {
        self.with(Station::picture)
    }

    /// The part of the test or the run that the operator looks at.
    ///
    /// # Errors
    /// When the machine has ended, or too many wait.
    pub fn being_cut(&self) -> Result<Option<BeingCut>, ServiceError> {
        self.with(Station::being_cut)
    }

    /// What has happened after the event of this number; 0 is the beginning. Of a machine that has ended it is what was.
    pub fn events(&self, since: u64) -> Events {
        let log = &self.shared.log;
        log.follow(&self.shared.link);
        log.since(since)
    }

    /// Everything that a teacher can break, and how.
    ///
    /// # Errors
    /// When the machine has ended, or too many wait.
    pub fn drawer(&self) -> Result<Vec<Breakable>, ServiceError> {
        self.look(Station::drawer)
    }

    /// The lessons of the machine's folder: names and titles; one that cannot be read has its faults as title.
    ///
    /// # Errors
    /// When the machine has ended, or too many wait.
    pub fn lessons(&self) -> Result<Vec<(String, String)>, ServiceError> {
        self.look(Station::lessons)
    }
}
