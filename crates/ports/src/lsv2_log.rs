//! The log book that hosts ask for: the last keys and messages [000:17526].

use std::collections::VecDeque;
use std::sync::{Mutex, MutexGuard, PoisonError};
use std::time::{SystemTime, UNIX_EPOCH};

use bahn_control::Shown;
use bahn_host::{Next, Notice, Reader, Stamped};
use bahn_link::lsv2::{EVENTS, Event, EventKind};

/// The log book, and where it reads what has happened.
pub struct LogBook {
    notices: Mutex<Reader<Stamped>>,
    events: Mutex<VecDeque<Event>>,
}

impl LogBook {
    /// An empty one that follows the notices of a machine.
    pub fn new(notices: Reader<Stamped>) -> LogBook {
        LogBook {
            notices: Mutex::new(notices),
            events: Mutex::default(),
        }
    }

    fn events(&self) -> MutexGuard<'_, VecDeque<Event>> {
        self.events.lock().unwrap_or_else(PoisonError::into_inner)
    }

    /// Messages that have come up since the last time; `text` is given all of them at once.
    pub fn follow(&self, text: impl FnOnce(Vec<Shown>) -> Vec<String>) {
        let mut notices = self.notices.lock().unwrap_or_else(PoisonError::into_inner);
        let shown: Vec<Shown> = notices
            .by_ref()
            .filter_map(|next| match next {
                Next::Item(Stamped {
                    notice: Notice::Shown(shown),
                    ..
                }) => Some(shown),
                _ => None,
            })
            .collect();
        // Nobody else follows meanwhile, so that events stay in their order.
        if !shown.is_empty() {
            for message in text(shown) {
                self.note(EventKind::Message, message);
            }
        }
    }

    /// Something has happened.
    pub fn note(&self, kind: EventKind, text: String) {
        let now = SystemTime::now().duration_since(UNIX_EPOCH).unwrap_or_default();
        let time = u32::try_from(now.as_secs()).unwrap_or(u32::MAX);
        let mut events = self.events();
        if events.len() == EVENTS {
            events.pop_front();
        }
        events.push_back(Event { time, kind, text });
    }

    /// The last events, the oldest first.
    pub fn all(&self) -> Vec<Event> {
        self.events().iter().cloned().collect()
    }
}
