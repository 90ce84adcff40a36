//! What whoever follows a machine reads.

use bahn_tnc::Control;

use crate::feed::{Feed, Reader};
use crate::hosted::Hosted;
use crate::notice::Stamped;

/// Notices that wait for slow readers.
const NOTICES: usize = 1024;
/// Snapshots that wait for slow readers.
const SNAPSHOTS: usize = 256;

/// The feeds of a machine.
pub(crate) struct Feeds<C: Hosted = Control> {
    notices: Feed<Stamped<C::Notice>>,
    snapshots: Feed<C::Snapshot>,
    /// Time between two snapshots, µs, and when the next one is due.
    snapshot_us: Option<(u64, u64)>,
}

impl<C: Hosted> Default for Feeds<C> {
    fn default() -> Feeds<C> {
        Feeds {
            notices: Feed::new(NOTICES),
            snapshots: Feed::new(SNAPSHOTS),
            snapshot_us: None,
        }
    }
}

impl<C: Hosted> Feeds<C> {
    pub fn notices(&self) -> Reader<Stamped<C::Notice>> {
        self.notices.reader()
    }

    pub fn snapshots(&self) -> Reader<C::Snapshot> {
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

    pub fn tell(&self, time_us: u64, channel: usize, notice: C::Notice) {
        self.notices.put(|_| Stamped {
            time_us,
            channel,
            notice,
        });
    }

    /// Takes a snapshot when one is due.
    pub fn look(&mut self, control: &C) {
        let time_us = control.time_us();
        if let Some((every_us, due_us)) = &mut self.snapshot_us
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
