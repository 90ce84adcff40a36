//! What is to be done, and when: bounded, in the order of time, given from any thread.

use std::collections::{BTreeMap, VecDeque};
use std::sync::{Arc, Mutex, MutexGuard, PoisonError};

use bahn_tnc::Command;

use crate::action::{Action, Source};
use crate::error::HostError;

/// Orders that wait at most.
pub(crate) const ORDERS_MAX: usize = 4096;

/// Something to be done.
#[derive(Clone, Debug, PartialEq)]
pub struct Order<C = Command> {
    /// Who wants it done.
    pub source: Source,
    /// The cycle before which it is done.
    pub when: When,
    /// What is done then.
    pub action: Action<C>,
}

/// When something is to be done.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum When {
    /// Before the next cycle.
    Now,
    /// Before the first cycle that begins at this time of the machine or later, µs since power-on.
    At(u64),
}

/// Where orders are given, from any thread.
#[derive(Clone, Debug)]
pub struct Desk<C = Command>(Arc<Mutex<VecDeque<Order<C>>>>);

impl<C> Default for Desk<C> {
    fn default() -> Desk<C> {
        Desk(Arc::default())
    }
}

impl<C> Desk<C> {
    /// Gives an order.
    ///
    /// # Errors
    /// [`HostError::Busy`] when too many wait.
    pub fn give(&self, source: Source, when: When, action: Action<C>) -> Result<(), HostError> {
        let mut orders = self.orders();
        if orders.len() >= ORDERS_MAX {
            return Err(HostError::Busy);
        }
        orders.push_back(Order { source, when, action });
        Ok(())
    }

    /// The order that was given first.
    pub(crate) fn take(&self) -> Option<Order<C>> {
        self.orders().pop_front()
    }

    fn orders(&self) -> MutexGuard<'_, VecDeque<Order<C>>> {
        self.0.lock().unwrap_or_else(PoisonError::into_inner)
    }
}

/// Orders whose time has not come, by time and number.
#[derive(Clone, Debug)]
pub(crate) struct Waiting<C = Command> {
    orders: BTreeMap<(u64, u64), Order<C>>,
    count: u64,
}

impl<C> Default for Waiting<C> {
    fn default() -> Waiting<C> {
        Waiting {
            orders: BTreeMap::new(),
            count: 0,
        }
    }
}

impl<C> Waiting<C> {
    /// Takes an order that was given at `now_us`; `false` when too many wait.
    pub fn add(&mut self, order: Order<C>, now_us: u64) -> bool {
        if self.orders.len() >= ORDERS_MAX {
            return false;
        }
        let time_us = match order.when {
            When::Now => now_us,
            When::At(time_us) => time_us.max(now_us),
        };
        self.count += 1;
        self.orders.insert((time_us, self.count), order);
        true
    }

    /// The next one that is due.
    pub fn due(&mut self, now_us: u64) -> Option<Order<C>> {
        let entry = self.orders.first_entry()?;
        let (time_us, _) = *entry.key();
        (time_us <= now_us).then(|| entry.remove())
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn order(when: When, key: &str) -> Order {
        Order {
            source: Source::Script,
            when,
            action: Action::tap(key),
        }
    }

    #[test]
    fn orders_are_due_in_the_order_of_time_and_of_giving() {
        let mut waiting: Waiting = Waiting::default();
        let given = [
            (When::At(300), "c"),
            (When::Now, "a"),
            (When::At(300), "d"),
            (When::At(50), "b"),
        ];
        for (when, key) in given {
            assert!(waiting.add(order(when, key), 100));
        }
        // What was for 50 is late: it stands after what was given before.
        let mut due = |now| waiting.due(now).map(|order| order.action);
        assert_eq!(due(100), Some(Action::tap("a")));
        assert_eq!(due(100), Some(Action::tap("b")));
        assert_eq!(due(299), None);
        assert_eq!(
            (due(300), due(300)),
            (Some(Action::tap("c")), Some(Action::tap("d")))
        );
        assert_eq!(due(u64::MAX), None);
    }

    #[test]
    fn no_queue_grows_without_bound() {
        let (desk, mut waiting): (Desk, Waiting) = (Desk::default(), Waiting::default());
        for _ in 0..ORDERS_MAX {
            assert_eq!(desk.give(Source::Script, When::Now, Action::tap("a")), Ok(()));
            assert!(waiting.add(order(When::At(1), "a"), 0));
        }
        assert_eq!(
            desk.give(Source::Script, When::Now, Action::tap("a")),
            Err(HostError::Busy)
        );
        assert!(!waiting.add(order(When::Now, "a"), 0));
    }
}
