//! What whoever follows a machine reads.

use bahn_tnc::{Control, Snapshot};

use crate::feed::{Feed, Reader};
use crate::notice::{Before, Notice, Stamped};

/// Notices that wait for slow readers.
const NOTICES: usize = 1024;
/// Snapshots that wait for slow readers.
const SNAPSHOTS: usize = 256;

/// The feeds of a machine.
pub(crate) struct Feeds {
    notices: Feed<Stamped>,
    snapshots: Feed<Snapshot>,
    /// Time between two snapshots, µs, and when the next one is due.
    snapshot_us: Option<(u64, u64)>,
}

impl Default for Feeds {
    fn default() -> Feeds {
        Feeds {
            notices: Feed::new(NOTICES),
            snapshots: Feed::new(SNAPSHOTS),
            snapshot_us: None,
        }
    }
}

impl Feeds {
    pub fn notices(&self) -> Reader<Stamped> {
        self.notices.reader()
    }

    pub fn snapshots(&self) -> Reader<Snapshot> {
        self.snapshots.reader()
    }

    /// A snapshot every so many µs from a time on.
    pub fn take_snapshots(&mut self, every_us: u64, now_us: u64) {
        self.snapshot_us = Some((every_us, now_us));
    }

    /// The machine is at another time.
    pub fn reset(&mut self, now_us: u64) {
        if let Some((_, due_us)) = &mut self.snapshot_us {
            *due_us = now_us;
        }
    }

    pub fn tell(&self, time_us: u64, channel: usize, notice: Notice) {
        self.notices.put(|_| Stamped {
            time_us,
            channel,
            notice,
        });
    }

    /// Tells what has changed, and takes a snapshot when one is due; of what is repeated nobody is told.
    pub fn look(&mut self, before: &mut Before, control: &mut Control, repeats: bool) {
        let time_us = control.time_us();
        before.compare(control, |channel, notice| {
            if !repeats {
                self.tell(time_us, channel, notice);
            }
        });
        if let Some((every_us, due_us)) = self.snapshot_us.as_mut().filter(|_| !repeats)
            && time_us >= *due_us
        {
            *due_us = time_us + *every_us;
            self.snapshots.put(|oldest| match oldest {
                Some(oldest) => control.snapshot_again(oldest),
                None => control.snapshot(),
            });
        }
    }
}
