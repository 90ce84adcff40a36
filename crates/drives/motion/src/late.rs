//! Functions whose acknowledgement the path needs later than where they go out: in time it passes without a stop.
//!
//! Decision: The path plans a stop where a function may still have to be acknowledged, and takes it back when it is:
//! an acknowledgement in time costs nothing

use bahn_path::{At, Function, PathElement, Synchronisation, WaitPlace};

use crate::gate::is_feed;

/// What must be acknowledged before an element begins.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub(crate) struct Awaits {
    /// The functions at the starts of the elements before this number; 0 when there are none.
    pub(crate) before: u64,
    /// Its own functions that go out ahead of it.
    pub(crate) ahead: bool,
}

impl Awaits {
    pub(crate) fn nothing(self) -> bool {
        self == Awaits::default()
    }
}

/// The functions of the path as far as it is known that still have their place to wait ahead of them: each the number
/// after the last element that has one.
#[derive(Clone, Copy, Debug, Default)]
pub(crate) struct Late {
    /// At the end of the block with this sequence.
    block: Option<(u64, u64)>,
    /// Before the next movement with a feed.
    feed: Option<u64>,
    /// Where the program wants it.
    point: Option<u64>,
}

impl Late {
    /// What the next element of the path waits for, which gets this number.
    pub(crate) fn follow(&mut self, element: &PathElement, number: u64) -> Awaits {
        let functions = element.functions();
        let has_ended = |(_, sequence): &(u64, u64)| *sequence != element.sequence;
        let block = self.block.take_if(|block| has_ended(block)).map(|block| block.0);
        let feed = self.feed.take_if(|_| is_feed(element));
        let wanted = functions.iter().any(|one| one.function == Function::Synchronise);
        let point = self.point.take_if(|_| wanted);
        for function in functions {
            match function.synchronisation.wait() {
                WaitPlace::After if function.synchronisation.spans_motion() => {
                    self.block = Some((number + 1, element.sequence));
                }
                WaitPlace::Feed if !is_feed(element) => self.feed = Some(number + 1),
                WaitPlace::Point => self.point = Some(number + 1),
                _ => {}
            }
        }
        let waits_ahead =
            |synchronisation: Synchronisation| synchronisation.is_waited_for() && !synchronisation.is_late();
        Awaits {
            before: block.max(feed).max(point).unwrap_or(0),
            ahead: functions
                .iter()
                .any(|one| matches!(one.at, At::Ahead(_)) && waits_ahead(one.synchronisation)),
        }
    }

    /// Whether there are any.
    pub(crate) fn is_any(&self) -> bool {
        self.block.is_some() || self.feed.is_some() || self.point.is_some()
    }

    /// The path begins anew, while functions that went out may not be acknowledged: what comes next waits for them.
    pub(crate) fn begin(&mut self, number: u64) {
        *self = Late::default();
        self.block = Some((number, u64::MAX));
    }
}
