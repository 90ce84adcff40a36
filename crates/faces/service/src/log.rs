//! The log book: the last keys and messages [000:17526], each with a number.
//!
//! Decision: The log book has all keys of the keyboard, whichever interface presses them, and all messages; a message
//! comes into it within 20 ms, so that its time is right and none is lost while nobody asks

use std::collections::VecDeque;
use std::sync::{Arc, Mutex, MutexGuard, PoisonError};
use std::time::{Duration, SystemTime};

use bahn_host::{Next, Notice, Reader, Stamped};
use bahn_panel::Link;
use bahn_tnc::Shown;

/// Events that are kept.
pub const EVENTS: usize = 1000;
/// So often it is looked whether messages have come up. Notices are kept 1024 long: at a hundred times real time a run whose
/// blocks take a cycle each fills that in 30 ms.
const LOOK: Duration = Duration::from_millis(20);

/// An event of the log book.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Event {
    /// Counts the events since the machine runs, from 1.
    pub number: u64,
    /// Real time at which it happened.
    pub time: SystemTime,
    /// Key or message.
    pub kind: EventKind,
    /// Name of the key, or text of the message.
    pub text: String,
}

/// What the log of a control keeps.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum EventKind {
    /// A key of the keyboard was pressed.
    Key,
    /// A message came up.
    Message,
}

/// What has happened after an event.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Events {
    /// So many before these are not kept any more.
    pub missed: u64,
    /// The others, the oldest first; the number of the last one is what to ask with the next time.
    pub events: Vec<Event>,
}

/// The log book, and where it reads what has happened.
pub(crate) struct Log {
    notices: Mutex<Followed>,
    kept: Mutex<Kept>,
}

/// What was read of the notices.
struct Followed {
    notices: Reader<Stamped>,
    /// Messages whose texts were not there to be had: too many wait for the machine.
    shown: VecDeque<Shown>,
}

#[derive(Default)]
struct Kept {
    events: VecDeque<Event>,
    count: u64,
}

impl Kept {
    fn note(&mut self, kind: EventKind, text: String) {
        if self.events.len() == EVENTS {
            self.events.pop_front();
        }
        self.count += 1;
        self.events.push_back(Event {
            number: self.count,
            time: SystemTime::now(),
            kind,
            text,
        });
    }

    fn since(&self, number: u64) -> Events {
        let after = self.events.iter().filter(|event| event.number > number);
        let events: Vec<Event> = after.cloned().collect();
        let wanted = self.count.saturating_sub(number);
        Events {
            missed: wanted - events.len() as u64,
            events,
        }
    }
}

impl Log {
    /// An empty one that follows the notices of a machine.
    pub fn new(notices: Reader<Stamped>) -> Log {
        Log {
            notices: Mutex::new(Followed {
                notices,
                shown: VecDeque::new(),
            }),
            kept: Mutex::default(),
        }
    }

    /// Follows the machine until nobody has the log any more. Without the thread, which the system may refuse, messages come
    /// into the log book when somebody asks.
    pub fn follow_beside(log: &Arc<Log>, link: Link) {
        let followed = Arc::downgrade(log);
        let _ = std::thread::Builder::new()
            .name("log book".to_owned())
            .spawn(move || {
                while let Some(log) = followed.upgrade() {
                    log.follow(&link);
                    drop(log);
                    std::thread::sleep(LOOK);
                }
            });
    }

    /// Messages that have come up since the last time.
    pub fn follow(&self, link: &Link) {
        // Nobody else follows meanwhile, so that events stay in their order.
        let mut followed = self.notices.lock().unwrap_or_else(PoisonError::into_inner);
        let Followed { notices, shown } = &mut *followed;
        for next in notices {
            if let Next::Item(Stamped {
                notice: Notice::Shown(message),
                ..
            }) = next
            {
                shown.push_back(message);
            }
        }
        if shown.is_empty() {
            return;
        }
        // More than are kept are of no use.
        shown.drain(..shown.len().saturating_sub(EVENTS));
        let asked = shown.clone();
        let texts = link.look(move |station| {
            let text = |shown: &Shown| station.control().shown_text(shown);
            asked.iter().map(text).collect::<Vec<_>>()
        });
        for text in texts.into_iter().flatten() {
            shown.pop_front();
            self.note(EventKind::Message, text);
        }
    }

    /// Appends an event of this kind; the oldest goes where there are too many.
    pub fn note(&self, kind: EventKind, text: String) {
        self.kept().note(kind, text);
    }

    /// What has happened after the event of this number.
    pub fn since(&self, number: u64) -> Events {
        self.kept().since(number)
    }

    fn kept(&self) -> MutexGuard<'_, Kept> {
        self.kept.lock().unwrap_or_else(PoisonError::into_inner)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_oldest_events_go_and_are_counted() {
        let mut kept = Kept::default();
        assert_eq!(kept.since(0).events, []);
        // Three more than are kept.
        for number in 1..=EVENTS + 3 {
            kept.note(EventKind::Key, number.to_string());
        }
        let all = kept.since(0);
        assert_eq!((all.missed, all.events.len()), (3, EVENTS));
        assert_eq!((all.events[0].number, all.events[0].text.as_str()), (4, "4"));
        let last = kept.since(EVENTS as u64 + 1);
        assert_eq!((last.missed, last.events.len()), (0, 2));
        assert_eq!(kept.since(EVENTS as u64 + 3).events, []);
    }
}
