//! The path of a channel as it is executed: elements are prepared ahead of the axes, and wait here for them.

use std::collections::VecDeque;

use bahn_path::{PathElement, PerAxis, Position};

use crate::hosted::Prepared;
use crate::{Host, HostFamily, Operable};

/// Distance that may be left of an element that is done, mm.
const DONE_MM: f64 = 1e-6;

/// What tells an element from all others of its run. Axes without a position are equal, too, bit by bit.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct ElementId {
    /// Its place in the run.
    pub sequence: u64,
    ends: [PerAxis<u64>; 2],
}

impl ElementId {
    /// What tells this element from all others of its run.
    pub fn of(element: &PathElement) -> ElementId {
        ElementId {
            sequence: element.sequence,
            ends: [element.start, element.end].map(|position| position.values().map(f64::to_bits)),
        }
    }

    /// Whether it is that of an element.
    pub fn is_of(&self, element: &PathElement) -> bool {
        let is = |bits: &PerAxis<u64>, position: &Position| {
            let mut both = bits.iter().zip(position.values().iter());
            both.all(|(bits, value)| *bits == value.to_bits())
        };
        let [start, end] = &self.ends;
        self.sequence == element.sequence && is(start, &element.start) && is(end, &element.end)
    }
}

/// The elements of a channel that were executed to their end, in their order, as an iterator: after
/// [`ExecutedPath::follow`] it has those of the cycle. The host must [keep the path](Host::keep_path).
#[derive(Debug, Default)]
pub struct ExecutedPath {
    channel: usize,
    /// Prepared and not yet handed out.
    ahead: VecDeque<PathElement>,
    /// So many of them, from the front, are executed.
    done: usize,
    /// The element that was executed last, with the distance that was left of it.
    last_seen: Option<(ElementId, f64)>,
}

impl ExecutedPath {
    /// Of a channel, from 0.
    pub fn of(channel: usize) -> ExecutedPath {
        ExecutedPath {
            channel,
            ..ExecutedPath::default()
        }
    }

    /// Takes what a cycle has prepared, and looks how far the axes are.
    pub fn follow<P: Operable, C: HostFamily>(&mut self, host: &mut Host<P, C>) {
        let Prepared { dropped, elements } = host.take_prepared(self.channel);
        if let Some(dropped) = dropped {
            self.ahead.retain(|element| element.sequence < dropped);
        }
        self.ahead.extend(elements);
        let Some(now) = host.control().executes(self.channel) else {
            return;
        };
        if let Some((element, rest_mm)) = now.element {
            match &mut self.last_seen {
                // Most cycles go on in the element of the one before.
                Some((seen, rest)) if seen.is_of(element) => *rest = rest_mm,
                seen => *seen = Some((ElementId::of(element), rest_mm)),
            }
        }
        self.done = match (now.has_ended, now.element, &self.last_seen) {
            (true, ..) => self.ahead.len(),
            (false, Some(_), Some((current, _))) => self.before(current),
            (false, ..) => 0,
        };
    }

    /// So many stand before an element. A cycle has many of one place in the run.
    fn before(&self, current: &ElementId) -> usize {
        let own = self.ahead.iter();
        let earlier = own
            .clone()
            .take_while(|own| own.sequence < current.sequence)
            .count();
        let same = own
            .skip(earlier)
            .take_while(|own| own.sequence == current.sequence)
            .position(|own| current.is_of(own));
        earlier + same.unwrap_or(0)
    }

    /// Of a run that was broken off in a block: what was executed to the end counts, too, and is handed out next.
    pub fn finish(&mut self) {
        self.done = self.last_seen.as_ref().map_or(0, |(current, rest_mm)| {
            let count = self.before(current);
            let last = self.ahead.get(count);
            let last = last.filter(|element| current.is_of(element));
            count + usize::from(last.is_some() && *rest_mm <= DONE_MM)
        });
    }

    /// Another run begins: what waited is not of it.
    pub fn clear(&mut self) {
        self.ahead.clear();
        self.done = 0;
    }
}

impl Iterator for ExecutedPath {
    type Item = PathElement;

    fn next(&mut self) -> Option<PathElement> {
        self.done = self.done.checked_sub(1)?;
        self.ahead.pop_front()
    }
}
