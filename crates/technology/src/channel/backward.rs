//! The way back along what was executed.

use bahn_motion::Drive;

use super::Channel;

#[derive(Debug, Default)]
pub(super) struct Backward {
    on: bool,
}

impl Backward {
    pub(super) fn is_on(&self) -> bool {
        self.on
    }
}

impl Channel<'_> {
    /// Spends a cycle on the path. Whether it moved.
    pub(super) fn spend(&mut self, mut drive: Drive) -> bool {
        drive.hold |= self.resets();
        self.cycle_path(drive)
    }
}
