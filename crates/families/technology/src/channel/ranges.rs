//! The ranges of the interface to the PLC: one of the channel, one of each axis and of each spindle.
//!
//! A function that is output takes a slot until it is fetched, one that is waited for until it is acknowledged. Nothing is
//! output to a range while a function stands in it that the PLC has not fetched in its cycle [004:204] (inferred).

use super::order::{Letter, OrderId, Orders, RangeId};

/// Slots for the functions of a range, as many as the lists of active functions show [004:150] (inferred).
pub(crate) const SLOTS: usize = 12;

#[derive(Debug)]
struct Range {
    id: RangeId,
    /// How programs and scripts call it: the first is that of reports.
    names: Vec<String>,
    /// Functions that take a slot.
    slots: Vec<OrderId>,
    /// Those of them that are not fetched, and the cycle in which they were output.
    unfetched: Vec<(OrderId, u64)>,
    /// Late functions that are not acknowledged.
    late: Vec<OrderId>,
    /// M and H functions that are waited for, in order of output; whether the list was changed.
    active: [(Vec<(OrderId, u16)>, bool); 2],
}

/// All ranges that were used.
#[derive(Debug, Default)]
pub(crate) struct Ranges {
    list: Vec<Range>,
    /// Functions that the PLC has not fetched.
    unfetched: usize,
}

/// The letters that have lists of active functions.
pub(crate) const ACTIVE: [(Letter, &str); 2] = [(Letter::M, "M"), (Letter::H, "H")];

impl Ranges {
    /// A range is used, which is called so.
    pub(crate) fn open(&mut self, id: RangeId, names: impl FnOnce() -> Vec<String>) {
        if !self.list.iter().any(|range| range.id == id) {
            self.list.push(Range {
                id,
                names: names(),
                slots: Vec::with_capacity(SLOTS),
                unfetched: Vec::with_capacity(SLOTS),
                late: Vec::new(),
                active: Default::default(),
            });
        }
    }

    fn get(&self, id: RangeId) -> Option<&Range> {
        self.list.iter().find(|range| range.id == id)
    }

    fn get_mut(&mut self, id: RangeId) -> Option<&mut Range> {
        self.list.iter_mut().find(|range| range.id == id)
    }

    /// How a range is called.
    pub(crate) fn names(&self, id: RangeId) -> &[String] {
        self.get(id).map_or(&[], |range| &range.names)
    }

    /// Its name in reports.
    pub(crate) fn name(&self, id: RangeId) -> &str {
        self.names(id).first().map_or("channel", String::as_str)
    }

    /// The function for which nothing can be output to a range now.
    pub(crate) fn blocked(&self, id: RangeId, cycle: u64) -> Option<OrderId> {
        let range = self.get(id)?;
        let old = range.unfetched.iter().find(|(_, output)| *output < cycle);
        let full = || range.slots.first().filter(|_| range.slots.len() >= SLOTS);
        old.map(|(id, _)| id).or_else(full).copied()
    }

    /// Whether anything was not fetched in its cycle, or might fill a range.
    pub(crate) fn any_blocked(&self, cycle: u64) -> bool {
        let blocked = |range: &Range| {
            range.slots.len() >= SLOTS || range.unfetched.iter().any(|(_, output)| *output < cycle)
        };
        self.list.iter().any(blocked)
    }

    /// A function is output. `false` when its range has more late ones than it can take.
    pub(crate) fn output(&mut self, id: OrderId, orders: &mut Orders, cycle: u64) -> bool {
        let Some((order, range)) = orders
            .get_mut(id)
            .and_then(|order| order.range.map(|range| (order, range)))
        else {
            return true;
        };
        order.state.output = true;
        let (late, waits) = (order.synch.kind.is_late() && order.waits, order.waits);
        let letter = ACTIVE.iter().position(|(letter, _)| *letter == order.letter);
        let number = order.number;
        self.unfetched += 1;
        let Some(range) = self.get_mut(range) else {
            return true;
        };
        range.slots.push(id);
        range.unfetched.push((id, cycle));
        if late {
            range.late.push(id);
        }
        if let Some((list, changed)) = letter.and_then(|letter| range.active.get_mut(letter))
            && waits
        {
            list.push((id, number));
            *changed = true;
        }
        range.late.len() <= SLOTS
    }

    /// The PLC fetches a function. Late ones, and those that nobody waits for, leave their slot.
    pub(crate) fn fetch(&mut self, id: OrderId, orders: &mut Orders) {
        let Some(order) = orders.get_mut(id) else {
            return;
        };
        order.state.fetched = true;
        let leaves = !order.waits || order.synch.kind.is_late();
        if let Some(range) = order.range.and_then(|range| self.get_mut(range)) {
            let before = range.unfetched.len();
            range.unfetched.retain(|(one, _)| *one != id);
            let fetched = before - range.unfetched.len();
            if leaves {
                range.slots.retain(|one| *one != id);
            }
            self.unfetched -= fetched;
        }
    }

    /// The PLC acknowledges a function.
    pub(crate) fn acknowledge(&mut self, id: OrderId, orders: &mut Orders) {
        let Some(order) = orders.get_mut(id) else {
            return;
        };
        order.state.acknowledged = true;
        if let Some(range) = order.range.and_then(|range| self.get_mut(range)) {
            range.slots.retain(|one| *one != id);
            range.late.retain(|one| *one != id);
            for (list, changed) in &mut range.active {
                let before = list.len();
                list.retain(|(one, _)| *one != id);
                *changed |= list.len() != before;
            }
        }
    }

    /// Drops what is open in all of them.
    pub(crate) fn reset(&mut self) {
        self.unfetched = 0;
        for range in &mut self.list {
            range.slots.clear();
            range.unfetched.clear();
            range.late.clear();
            for (list, changed) in &mut range.active {
                *changed |= !list.is_empty();
                list.clear();
            }
        }
    }

    /// The lists of active functions that have changed since they were asked for: range, letter, numbers.
    pub(crate) fn changed(&mut self, mut tell: impl FnMut(&str, &'static str, Vec<u16>)) {
        for range in &mut self.list {
            for ((list, changed), (_, letter)) in range.active.iter_mut().zip(ACTIVE) {
                if std::mem::take(changed) {
                    let numbers = list.iter().take(SLOTS).map(|(_, number)| *number);
                    let name = range.names.first().map_or("channel", String::as_str);
                    tell(name, letter, numbers.collect());
                }
            }
        }
    }
}
