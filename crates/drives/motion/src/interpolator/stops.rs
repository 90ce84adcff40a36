//! Where single block, axes that are clamped, a block to stop before and late acknowledgements stop the path.

use bahn_path::AxisSet;

use crate::drive::Drive;
use crate::item::Item;
use crate::ring::Ring;

#[derive(Clone, Debug)]
pub(super) struct Stops {
    single_block: bool,
    before: Option<u64>,
    clamped: AxisSet,
    clamping: AxisSet,
    acknowledged: Acknowledged,
    /// The next stop is to be looked for.
    wanted: bool,
    /// The path stops after no element before this number.
    sought: u64,
}

/// How far the functions of the path are acknowledged.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub(super) struct Acknowledged {
    /// Those at the starts of elements before this number.
    pub(super) starts: u64,
    /// Those that go out ahead of elements before this number.
    pub(super) ahead: u64,
}

impl Default for Stops {
    fn default() -> Stops {
        Stops {
            single_block: false,
            before: None,
            clamped: AxisSet::EMPTY,
            clamping: AxisSet::EMPTY,
            acknowledged: Acknowledged::default(),
            wanted: false,
            sought: 0,
        }
    }
}

impl Stops {
    /// Takes over how to drive. Whether the next stop is to be looked for.
    pub(super) fn take(&mut self, drive: &Drive) -> bool {
        let now = (
            drive.single_block,
            drive.stop_before,
            drive.clamped,
            drive.clamping,
        );
        if now != (self.single_block, self.before, self.clamped, self.clamping) {
            (self.single_block, self.before, self.clamped, self.clamping) = now;
            (self.wanted, self.sought) = (true, 0);
        }
        std::mem::take(&mut self.wanted)
    }

    /// So much is acknowledged now.
    pub(super) fn acknowledge(&mut self, now: Acknowledged) {
        if now != self.acknowledged {
            self.acknowledged = now;
            (self.wanted, self.sought) = (true, 0);
        }
    }

    /// There are more elements, or it is known that no more come.
    pub(super) fn seek(&mut self) {
        self.wanted = true;
    }

    /// The elements are others.
    pub(super) fn forget(&mut self) {
        self.sought = 0;
        self.acknowledged = Acknowledged::default();
    }

    /// Number of the next element at whose end the path stops, where it can still come to a standstill at a speed,
    /// mm/s, with so much of the current one to go, mm.
    pub(super) fn next(&mut self, ring: &Ring, speed: f64, rest: f64) -> Option<u64> {
        let by_block = self.single_block || self.before.is_some();
        if !by_block && !ring.awaits() && self.clamped.union(self.clamping).is_empty() {
            return None;
        }
        let last = ring.last()?;
        let mut first = self.sought.max(ring.number());
        while first < last && !self.stops_after(ring, first) {
            first += 1;
        }
        self.sought = first;
        if !self.stops_after(ring, first) {
            return None;
        }
        let (possible, _) = ring.standstill(speed * speed * (1.0 - 1e-9), rest);
        (possible.max(first)..=last).find(|number| self.stops_after(ring, *number))
    }

    /// Whether the path is to stop at the end of an element. What is not so stays so, but for the last element: it
    /// depends on the one after it.
    fn stops_after(&self, ring: &Ring, number: u64) -> bool {
        let next = ring.get(number + 1);
        let ends = |item: &Item| self.is_block_end(item, next) || self.is_to_be_clamped(item);
        ring.get(number).is_some_and(ends)
            || next.is_some_and(|next| self.is_clamped(next) || self.is_awaited(next, number + 1))
    }

    /// The path stops after it in single block, or before the block that is next.
    pub(super) fn is_block_end(&self, item: &Item, next: Option<&Item>) -> bool {
        let is_before = |sequence| {
            item.element.sequence < sequence && next.is_some_and(|next| next.element.sequence >= sequence)
        };
        item.block_end && (self.single_block || self.before.is_some_and(is_before))
    }

    /// An axis that it moves is clamped.
    pub(super) fn is_clamped(&self, item: &Item) -> bool {
        moves(item, self.clamped)
    }

    /// A function is not acknowledged that the element with this number waits for.
    pub(super) fn is_awaited(&self, item: &Item, number: u64) -> bool {
        item.awaits.before > self.acknowledged.starts
            || item.awaits.ahead && number >= self.acknowledged.ahead
    }

    /// An axis that its block moved is to be clamped after it.
    pub(super) fn is_to_be_clamped(&self, item: &Item) -> bool {
        item.block_end && moves(item, self.clamping)
    }
}

/// Whether an element moves one of the axes.
fn moves(item: &Item, axes: AxisSet) -> bool {
    axes.iter().any(|axis| item.element.moves_axis(axis))
}
