//! The path as far as it is known, and between its elements what is to be done where the path is then.

use std::collections::VecDeque;
use std::sync::Arc;

use bahn_path::Position;

use super::leg::Leg;

/// What is done at a place of the path, one after the other: `T` is the ticket of a function, `O` what a family does beside.
#[derive(Clone, Debug)]
pub enum Action<T, O> {
    /// What executes a function is commanded.
    Command(T),
    /// Output place: a function is output.
    Output(T),
    /// Wait place: the path stands until all of these are done.
    Gate(Box<[T]>),
    /// The path comes to a standstill here in any case, for a function.
    Stand(T),
    /// The path stands for a time, s.
    Dwell(f64),
    /// A programmed block with a motion ends: in single block the path stands here until the next start.
    BlockEnd,
    /// What the family does here.
    Own(O),
}

/// A place of the path and the element after it.
#[derive(Clone, Debug)]
struct Stretch<T, O> {
    actions: Vec<Action<T, O>>,
    leg: Leg,
}

/// Elements that were executed and are kept for backward motion.
const HISTORY: u64 = 10_000;

/// The path as far as it is known. Its places are numbered: place `n` is that before element `n`, the last one is where
/// the path ends as far as it is known.
#[derive(Debug)]
pub struct Places<T, O> {
    /// Number of the first element that is kept.
    first: u64,
    stretches: VecDeque<Stretch<T, O>>,
    /// What is to be done where it ends.
    tail: Vec<Action<T, O>>,
    distance_mm: f64,
    end: Position,
    block: Arc<str>,
    /// Actions that are kept.
    count: usize,
}

impl<T: Copy, O> Places<T, O> {
    /// A path that starts somewhere, with its first element numbered so.
    pub fn new(start: Position, first: u64, distance: f64) -> Places<T, O> {
        Places {
            first,
            stretches: VecDeque::new(),
            tail: Vec::new(),
            distance_mm: distance,
            end: start,
            block: "".into(),
            count: 0,
        }
    }

    /// The place where it ends as far as it is known.
    pub fn last(&self) -> u64 {
        self.first + self.stretches.len() as u64
    }

    fn index(&self, number: u64) -> Option<usize> {
        usize::try_from(number.checked_sub(self.first)?).ok()
    }

    /// An element by its number.
    pub fn leg(&self, number: u64) -> Option<&Leg> {
        self.stretches
            .get(self.index(number)?)
            .map(|stretch| &stretch.leg)
    }

    /// What is to be done at a place.
    pub fn actions(&self, place: u64) -> &[Action<T, O>] {
        let stretch = self.index(place).and_then(|index| self.stretches.get(index));
        match stretch {
            Some(stretch) => &stretch.actions,
            None if place == self.last() => &self.tail,
            None => &[],
        }
    }

    /// The actions of a place, to change them.
    pub fn actions_mut(&mut self, place: u64) -> &mut [Action<T, O>] {
        let last = self.last();
        let index = self.index(place);
        match index.and_then(|index| self.stretches.get_mut(index)) {
            Some(stretch) => &mut stretch.actions,
            None if place == last => &mut self.tail,
            None => &mut [],
        }
    }

    /// How much is done at all places that are kept.
    pub fn count(&self) -> usize {
        self.count
    }

    /// The first element that is kept.
    pub fn first(&self) -> u64 {
        self.first
    }

    /// Where a place lies.
    pub fn position(&self, place: u64) -> Position {
        self.leg(place).map_or(self.end, |leg| leg.start)
    }

    /// The distance along the path to a place, mm.
    pub fn distance(&self, place: u64) -> f64 {
        self.leg(place).map_or(self.distance_mm, |leg| leg.from_mm)
    }

    /// The block that leads to a place.
    pub fn block_before(&self, place: u64) -> Arc<str> {
        let before = place.checked_sub(1).and_then(|before| self.leg(before));
        before.map_or_else(|| self.block.clone(), |leg| leg.block.clone())
    }

    /// Where the path is so far along it, mm, looked for from an element backwards.
    pub fn position_at(&self, distance: f64, from: u64) -> Position {
        let mut number = from.min(self.last());
        while let Some(leg) = number.checked_sub(1).and_then(|before| self.leg(before)) {
            if self.leg(number).is_some_and(|leg| leg.from_mm <= distance) {
                break;
            }
            number -= 1;
            if leg.from_mm <= distance {
                break;
            }
        }
        self.leg(number)
            .map_or(self.end, |leg| leg.place(distance - leg.from_mm))
    }

    /// It ends elsewhere, for axes moved on their own.
    pub fn set_end(&mut self, position: Position) {
        self.end = position;
    }

    /// More is to be done where it ends.
    pub fn push_action(&mut self, action: Action<T, O>) {
        self.count += 1;
        self.tail.push(action);
    }

    /// So many actions where the path ends are done: blocks without a movement may go on for ever.
    pub fn forget_done(&mut self, count: usize) {
        self.count -= self.tail.drain(..count.min(self.tail.len())).len();
    }

    /// Appends an element at the end of the path.
    pub fn push_leg(&mut self, mut leg: Leg) {
        leg.from_mm = self.distance_mm;
        self.distance_mm += leg.length_mm;
        self.end = leg.end;
        self.block = leg.block.clone();
        self.stretches.push_back(Stretch {
            actions: std::mem::take(&mut self.tail),
            leg,
        });
    }

    /// Forgets what lies so far behind a place that nobody goes back to it; the first function that may still be asked for.
    pub fn forget_before(&mut self, place: u64) -> Option<T> {
        while self.first + HISTORY < place
            && let Some(stretch) = self.stretches.pop_front()
        {
            self.first += 1;
            self.count -= stretch.actions.len();
        }
        let first = self.stretches.iter().map(|stretch| &stretch.actions);
        first
            .chain([&self.tail])
            .flatten()
            .find_map(|action| match action {
                Action::Command(id) | Action::Output(id) | Action::Stand(id) => Some(*id),
                Action::Gate(ids) => ids.first().copied(),
                _ => None,
            })
    }
}
