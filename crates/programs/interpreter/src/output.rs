//! The queue of finished steps.

use std::collections::VecDeque;

use bahn_path::{Barrier, PathElement};

/// What waits to be pulled.
#[derive(Clone, Debug)]
pub(crate) enum Item {
    Element(PathElement),
    Barrier(Barrier),
}

/// Finished elements in order.
#[derive(Clone, Debug, Default)]
pub(crate) struct Output {
    pub queue: VecDeque<Item>,
}

impl Output {
    #[inline]
    pub fn push(&mut self, element: PathElement, barrier: Option<Barrier>) {
        self.queue.push_back(Item::Element(element));
        if let Some(barrier) = barrier {
            self.queue.push_back(Item::Barrier(barrier));
        }
    }

    pub fn barrier(&mut self, barrier: Barrier) {
        self.queue.push_back(Item::Barrier(barrier));
    }
}
