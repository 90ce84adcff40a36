//! Rings that any number of readers follow, each at its own pace: who is slow loses what is old and is told how
//! much.

use std::collections::VecDeque;
use std::sync::{Arc, Mutex, MutexGuard, PoisonError};

/// Where a reader goes on.
#[derive(Clone, Debug, PartialEq)]
pub enum Next<T> {
    /// So many were overwritten before they were read.
    Missed(u64),
    /// The next one that was not read yet.
    Item(T),
}

#[derive(Debug)]
struct Ring<T> {
    items: VecDeque<T>,
    most: usize,
    /// Items that were ever put in.
    count: u64,
}

/// A ring that is written.
#[derive(Debug)]
pub(crate) struct Feed<T>(Arc<Mutex<Ring<T>>>);

impl<T: Clone> Feed<T> {
    /// A ring for at most so many items, and at least one.
    pub fn new(most: usize) -> Feed<T> {
        let most = most.max(1);
        Feed(Arc::new(Mutex::new(Ring {
            items: VecDeque::with_capacity(most),
            most,
            count: 0,
        })))
    }

    /// Puts in what `make` makes; once the ring is full it is given the oldest item, whose memory it can use.
    pub fn put(&self, make: impl FnOnce(Option<T>) -> T) {
        let mut ring = lock(&self.0);
        let oldest = if ring.items.len() == ring.most {
            ring.items.pop_front()
        } else {
            None
        };
        let item = make(oldest);
        ring.items.push_back(item);
        ring.count += 1;
    }

    /// A reader of what comes from now on.
    pub fn reader(&self) -> Reader<T> {
        Reader {
            next: lock(&self.0).count,
            ring: Arc::clone(&self.0),
        }
    }
}

/// Follows a ring, on any thread.
#[derive(Debug)]
pub struct Reader<T> {
    ring: Arc<Mutex<Ring<T>>>,
    /// Number of the item that is read next.
    next: u64,
}

/// The items that were not read yet, and how many were missed before them; it ends where there is nothing new and goes
/// on when there is.
impl<T: Clone> Iterator for Reader<T> {
    type Item = Next<T>;

    fn next(&mut self) -> Option<Next<T>> {
        let ring = lock(&self.ring);
        let first = ring.count - ring.items.len() as u64;
        if let Some(missed) = first.checked_sub(self.next).filter(|missed| *missed > 0) {
            self.next = first;
            return Some(Next::Missed(missed));
        }
        let place = usize::try_from(self.next - first).ok()?;
        let item = ring.items.get(place)?.clone();
        self.next += 1;
        Some(Next::Item(item))
    }
}

impl<T: Clone> Reader<T> {
    /// The latest item; everything before it is passed over.
    pub fn latest(&mut self) -> Option<T> {
        let ring = lock(&self.ring);
        let fresh = self.next < ring.count;
        self.next = ring.count;
        ring.items.back().filter(|_| fresh).cloned()
    }
}

impl<T> Clone for Reader<T> {
    fn clone(&self) -> Reader<T> {
        Reader {
            ring: Arc::clone(&self.ring),
            next: self.next,
        }
    }
}

fn lock<T>(ring: &Mutex<Ring<T>>) -> MutexGuard<'_, Ring<T>> {
    ring.lock().unwrap_or_else(PoisonError::into_inner)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn all(reader: &mut Reader<u32>) -> Vec<Next<u32>> {
        reader.collect()
    }

    #[test]
    fn readers_go_at_their_own_pace_and_get_what_they_missed() {
        use Next::{Item, Missed};
        let feed = Feed::new(3);
        let mut early = feed.reader();
        (0..2).for_each(|item| feed.put(|_| item));
        let (mut late, mut slow) = (feed.reader(), early.clone());
        assert_eq!(all(&mut early), [Item(0), Item(1)]);
        assert_eq!(all(&mut late), []);
        (2..7).for_each(|item| feed.put(|_| item));
        // 4, 5, 6 are there: early misses 2 and 3, slow 0 and 1 besides.
        assert_eq!(all(&mut early), [Missed(2), Item(4), Item(5), Item(6)]);
        assert_eq!(all(&mut late), [Missed(2), Item(4), Item(5), Item(6)]);
        assert_eq!(slow.next(), Some(Missed(4)));
        assert_eq!((slow.latest(), slow.latest(), slow.next()), (Some(6), None, None));
    }

    #[test]
    fn a_full_ring_hands_back_its_oldest_item() {
        let feed = Feed::new(2);
        let mut given = Vec::new();
        for item in 0..4 {
            feed.put(|oldest| {
                given.push(oldest);
                item
            });
        }
        assert_eq!(given, [None, None, Some(0), Some(1)]);
    }
}
