//! The gates of a path: the places where functions go out and where the path waits for them.
//!
//! [`Places`] are the path as far as it is known, with [`Action`]s between its [`Leg`]s; [`Gates`] drive along it, cycle by
//! cycle, and do what is to be done where it is: `act` at the places, `ahead` before them, `backward` on the way back. What a
//! function is, a family says by its [`Functions`]: the gates know its ticket, and what it does at a place beside functions.
//! A [`Window`] keeps the last legs back, so that a place may still be found within one of them.

mod act;
mod ahead;
mod back;
mod backward;
mod drive;
mod functions;
mod held;
mod kept;
mod leads;
mod leg;
mod motion;
mod places;
mod single;
mod window;

use bahn_motion::Limits;
use bahn_path::Position;

pub use functions::{Functions, Moment, Short, Way, Why};
pub use held::{Held, SAME_MM};
pub use leads::Leads;
pub use leg::{Driving, Leg, VectorLimit};
pub use places::{Action, Places};
pub use window::{JointFeed, Planned, Window};

use back::{Again, Back};
use motion::Motion;
use single::SingleBlock;

/// What part of a cycle may be rounding.
const ROUNDING: f64 = 1e-6;

/// The first cycle at a time or after it, s; a cycle takes so long, s.
pub fn cycle_at(time_s: f64, cycle_s: f64) -> u64 {
    (time_s / cycle_s - ROUNDING).ceil().max(0.0) as u64
}

/// What moves along a path, and what is done where that is.
#[derive(Debug)]
pub struct Gates<T, O> {
    cycle_s: f64,
    /// What is known of the path, and may not be split any more.
    pub places: Places<T, O>,
    /// What comes after that.
    pub window: Window<T, O>,
    /// What goes out ahead.
    pub leads: Leads<T>,
    /// Nothing comes after what is known before the path is there.
    pub closed: bool,
    motion: Motion,
    single: SingleBlock,
    /// The path goes back.
    back: Option<Back>,
    again: Again<T>,
    /// The place at which actions are done next, and which of them.
    cursor: (u64, usize),
    /// Places before this one do not stop the path.
    open_to: u64,
    /// The cycle in which a dwell ends.
    dwell: Option<u64>,
}

impl<T: Copy + Ord, O> Gates<T, O> {
    /// A path that begins somewhere, in cycles, s. With `one_by_one` the look-ahead turns to the next place of functions that go
    /// out ahead when it has passed the one before.
    pub fn new(limits: &Limits, cycle_s: f64, start: Position, one_by_one: bool) -> Gates<T, O> {
        let mut window = Window::default();
        window.begin(0.0);
        Gates {
            cycle_s,
            places: Places::new(start, 1, 0.0),
            window,
            leads: Leads::new(one_by_one),
            closed: false,
            motion: Motion::new(limits, start),
            single: SingleBlock::default(),
            back: None,
            again: Again::new(),
            cursor: (1, 0),
            open_to: 1,
            dwell: None,
        }
    }

    /// The path begins anew, somewhere.
    pub fn begin(&mut self, start: Position) {
        let distance = self.distance();
        let first = self.places.last() + 1;
        self.places = Places::new(start, first, distance);
        self.window.begin(distance);
        self.leads.begin(distance);
        self.motion.begin_on(start, first, None);
        (self.cursor, self.open_to) = ((first, 0), first);
        (self.dwell, self.back) = (None, None);
        self.single.all_block_ends();
    }

    /// What was kept for a joint goes on.
    pub fn release(&mut self) {
        self.window.release(&mut self.places);
        self.make_room();
    }

    /// Room for all functions that are known, so that no cycle allocates.
    fn make_room(&mut self) {
        self.again.make_room(self.places.count() + self.leads.count());
    }

    /// An element comes; so many may still be split, and a function that goes out ahead looks back over so many blocks.
    pub fn push(&mut self, leg: Leg, split: usize, blocks: usize) {
        self.leads.block(leg.from_mm, blocks);
        self.window.leg(leg, split, &mut self.places);
        self.make_room();
    }

    /// Nothing is output ahead across the end of what is known.
    pub fn bar(&mut self) {
        self.window.bar();
        self.release();
        self.leads.bar(self.window.distance());
    }

    /// The path stands elsewhere, at the end of what is known: axes went there beside it.
    pub fn stand_at(&mut self, position: Position) {
        self.motion.path.set_position(position);
        self.places.set_end(position);
    }

    /// How far actions are done at the end of what is known.
    pub fn done_at_end(&self) -> usize {
        match self.cursor {
            (place, done) if place == self.places.last() => done,
            _ => 0,
        }
    }

    /// Forgets the actions that are done there: blocks without a movement may go on for ever.
    pub fn forget_done(&mut self) {
        self.places.forget_done(self.done_at_end());
        self.cursor.1 = 0;
    }

    /// All that is known is executed.
    pub fn is_empty(&self) -> bool {
        let last = self.places.last();
        self.motion.reached == last && self.cursor == (last, self.places.actions(last).len())
    }

    /// What lies so far behind that nobody goes back to it is forgotten: the first function that may still be asked for.
    pub fn forget(&mut self) -> Option<T> {
        let first = self.places.forget_before(self.motion.reached);
        let distance = self.places.distance(self.places.first());
        let ahead = self.leads.forget_before(distance);
        first.into_iter().chain(ahead).min()
    }

    /// What stops the path is others now.
    pub fn look_anew(&mut self) {
        self.open_to = self.cursor.0;
    }

    /// In single block the path stops at the end of each programmed block with a motion, as soon as it can.
    pub fn single_block(&mut self, on: bool) {
        if self.single.switch(on) {
            self.look_anew();
        }
        if self.single.is_unseen() {
            let (distance, braking) = (self.distance(), self.motion.path.braking_mm());
            let first = match self.is_backward() {
                true => distance - braking,
                false => distance + braking,
            };
            self.single.see(first);
        }
    }

    /// The operator starts the next block in this cycle, at this time, s. Two in a cycle are one.
    pub fn start(&mut self, at_s: f64) {
        self.single.start(at_s);
    }

    /// A start that nothing has taken, s.
    pub fn take_start(&mut self) -> Option<f64> {
        self.single.take_start()
    }

    /// The cycle in which a dwell ends.
    pub fn dwells_until(&self) -> Option<u64> {
        self.dwell
    }

    /// The place that the path has come to or stands at.
    pub fn reached(&self) -> u64 {
        self.motion.reached
    }

    /// The path stood still in the last cycle.
    pub fn is_still(&self) -> bool {
        self.motion.still
    }

    /// That it stands was reported.
    pub fn stands(&self) -> bool {
        self.motion.stands
    }

    /// It stands because it is held.
    pub fn is_held(&self) -> bool {
        self.motion.held
    }

    /// The path goes back.
    pub fn is_backward(&self) -> bool {
        self.back.is_some()
    }

    /// Distance along the path, mm.
    pub fn distance(&self) -> f64 {
        if let Some(distance) = self.backward_distance() {
            return distance;
        }
        let path = &self.motion.path;
        let Some(element) = path.element() else {
            return self.places.distance(self.motion.reached);
        };
        match self.places.leg(element.sequence) {
            Some(leg) => leg.to() - path.rest_mm(),
            None => self.places.distance(self.motion.reached),
        }
    }

    /// Now, and where the path is.
    pub fn now<F: Functions<Ticket = T, Own = O>>(&self, family: &F) -> Moment {
        let mut position = self.motion.path.position();
        // Before it moves, the path does not know where axes stand that are programmed first.
        let place = self.places.position(self.motion.reached);
        for axis in place.known().iter() {
            position[axis] = position.get(axis).unwrap_or(place[axis]);
        }
        Moment {
            t: family.cycle() as f64 * self.cycle_s,
            position: family.beside(position),
            speed_mm_s: self.motion.speed(),
        }
    }
}
