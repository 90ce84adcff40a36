//! The look-ahead of the interpolator: the elements to come and how fast their ends may be passed.
//!
//! Over the ends of the elements lies an envelope of squared speed, made by a pass from the last element
//! backwards, so that braking is always in time. It holds what machine and path allow (rapid traverse of
//! the axes, radial acceleration, corners, stops) and below that what is wanted (programmed feed, overrides,
//! the stop of single block). What is wanted may be lowered at any time, even below the speed of the path.
//! The path then brakes with all that it has, and so stays below the envelope of what is *allowed*: it
//! was below it before, and no path within the acceleration can fall faster.
//!
//! The end of what is known is a stop. Elements that are put behind it only raise the envelope.

use std::collections::VecDeque;

use bahn_path::{Curve, FeedRate, Function, OverrideLaw, PathElement, Position};

use crate::corner::{Corner, Joint};
use crate::gate::{Gate, Gates, place, wait};
use crate::limits::Dynamics;
use crate::motion::Motion;

/// An element whose arc starts farther than this from where the path is gets a line to its start, mm.
const GAP: f64 = 1e-6;

/// The element that is executed, the next one and a line to its start.
const LEAST_CAPACITY: usize = 3;

/// An element with what driving it needs.
#[derive(Debug)]
pub(crate) struct Item {
    pub(crate) element: PathElement,
    /// Path length, mm; 0 when nothing moves.
    pub(crate) length: f64,
    /// Path acceleration, mm/s².
    pub(crate) acceleration: f64,
    /// Greatest path speed with the overrides as they are, mm/s.
    pub(crate) feed: f64,
    /// Greatest squared speed at the end.
    pub(crate) exit: f64,
    /// Squared speed at the end that machine and path allow, whatever comes after it.
    pub(crate) cap: f64,
    /// Where functions are output, and whether the path waits for them.
    pub(crate) start: Output,
    pub(crate) end: Output,
    /// Whether there are functions along the way.
    pub(crate) along: bool,
    /// The last element of its block, as far as is known.
    pub(crate) block_end: bool,
    slowest: f64,
    radial_speed: f64,
}

/// What an element outputs at one of its ends.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Output {
    Nothing,
    /// Functions for which the path does not wait.
    Passing,
    /// Functions of which one at least must be acknowledged.
    Waiting,
}

/// The elements to come, in a ring of fixed capacity.
#[derive(Debug)]
pub(crate) struct Ring {
    dynamics: Dynamics,
    items: VecDeque<Item>,
    capacity: usize,
    /// Number of the first item.
    first: u64,
    /// Index of the item that is executed; those before it are only kept until `discard`.
    current: usize,
    /// Items from this index on have changed since the envelope was made.
    changed: usize,
    /// Where the path ends.
    end: Position,
    /// Joint at which single block stops: number of the item before it.
    stop_at: Option<u64>,
    /// The last motion since a stop. Elements without length leave it as it is.
    last: Option<Motion>,
    /// The joint after `last` is passed whatever its angle.
    any_angle: bool,
    /// Way since the last corner or stop, mm.
    way: f64,
    /// The last corner while the way after it is too short to say how fast it may be passed, and the
    /// number of the item before it.
    corner: Option<(u64, Corner)>,
}

impl Ring {
    /// Room for `capacity` elements, or the least that it works with.
    pub(crate) fn new(dynamics: Dynamics, capacity: usize) -> Ring {
        let capacity = capacity.max(LEAST_CAPACITY);
        Ring {
            dynamics,
            items: VecDeque::with_capacity(capacity),
            capacity,
            first: 0,
            current: 0,
            changed: usize::MAX,
            end: Position::UNKNOWN,
            stop_at: None,
            last: None,
            any_angle: false,
            way: 0.0,
            corner: None,
        }
    }

    /// The item that is executed.
    #[inline]
    pub(crate) fn current(&self) -> Option<&Item> {
        self.items.get(self.current)
    }

    /// The item after it.
    #[inline]
    pub(crate) fn following(&self) -> Option<&Item> {
        self.items.get(self.current + 1)
    }

    /// Number of the item that is executed.
    #[inline]
    pub(crate) fn number(&self) -> u64 {
        self.first + self.current as u64
    }

    /// An item by its number, while it is kept.
    pub(crate) fn get(&self, number: u64) -> Option<&Item> {
        self.items
            .get(usize::try_from(number.checked_sub(self.first)?).ok()?)
    }

    /// Goes on to the next item.
    #[inline]
    pub(crate) fn advance(&mut self) {
        self.current += 1;
    }

    /// Items from the current one on.
    pub(crate) fn ahead(&self) -> impl Iterator<Item = &Item> {
        self.items.range(self.current.min(self.items.len())..)
    }

    /// Takes out the item that is executed and those after it.
    pub(crate) fn take_ahead(&mut self) -> impl Iterator<Item = PathElement> + '_ {
        let from = self.current.min(self.items.len());
        self.items.drain(from..).map(|item| item.element)
    }

    /// Drops the executed items.
    pub(crate) fn discard(&mut self) {
        self.first += self.current as u64;
        self.items.drain(..self.current);
        self.current = 0;
    }

    /// Whether an element fits in, and the line to its start that it may need.
    pub(crate) fn has_room(&self) -> bool {
        self.items.len() + 2 <= self.capacity
    }

    /// Drops everything; the path starts at a position.
    pub(crate) fn clear(&mut self, position: Position) {
        self.first += self.items.len() as u64;
        self.items.clear();
        self.current = 0;
        self.end = position;
        self.stop_at = None;
        self.corner = None;
        self.changed = usize::MAX;
        self.stop();
    }

    /// What is known ends in a stop for good.
    pub(crate) fn stop(&mut self) {
        self.join_stop();
        if let Some(last) = self.items.back_mut() {
            last.block_end = true;
        }
    }

    /// Puts an element at the end of the path. It starts where the path is: axes without a position at
    /// its start move from where they are.
    pub(crate) fn push(&mut self, mut element: PathElement) {
        if let Some(approach) = connect(&self.end, &mut element) {
            self.append(approach);
        }
        self.append(element);
    }

    fn append(&mut self, element: PathElement) {
        let gates = Gates::of(&element);
        let mut motion = Motion::of(&element, &self.dynamics);
        let mut item = Item::new(element, motion.as_ref());
        // Joints are found for the greatest speeds that the machine has; the feed is beside them.
        if let Some(motion) = &mut motion {
            motion.speed = item.greatest(&self.dynamics);
        }
        self.changed = self.changed.min(self.items.len());
        if let Some(last) = self.items.back_mut() {
            last.block_end = last.element.sequence != item.element.sequence;
            self.join(motion.as_ref(), gates.start);
        }
        if let Some(motion) = motion {
            self.way += motion.length;
            self.any_angle = false;
            self.last = Some(motion);
        }
        // M90 is effective in operation with servo lag only [000:5114].
        self.any_angle |=
            item.element.constant_speed && self.dynamics.servo_lag || item.element.tangential_end;
        item.set_feed(&self.dynamics);
        self.end = item.element.end;
        self.items.push_back(item);
        let enough = self
            .corner
            .as_ref()
            .is_some_and(|(_, corner)| corner.knows_enough(self.way));
        if enough || gates.end {
            self.decide();
        }
        if gates.end {
            self.last = None;
        }
    }

    /// Makes the envelope again after elements were put in: once for all of them.
    pub(crate) fn settle(&mut self) {
        let changed = std::mem::replace(&mut self.changed, usize::MAX);
        if changed != usize::MAX {
            self.envelope(changed);
        }
    }

    /// Finds the joint between the last element and the next one.
    fn join(&mut self, next: Option<&Motion>, gate: bool) {
        let number = self.first + self.items.len() as u64 - 1;
        let Some(last) = self.last.as_ref().filter(|_| !gate) else {
            return self.join_stop();
        };
        let Some(next) = next else {
            // Without a length there is no direction: the corner is where the path goes on.
            let cap = last.speed * last.speed;
            return self.set_cap(number, cap);
        };
        let joint = Joint::between(last, next, self.way, self.any_angle, &self.dynamics);
        match joint {
            Joint::Stop => self.join_stop(),
            Joint::Smooth(speed) => self.set_cap(number, speed * speed),
            Joint::Corner(corner) => {
                self.decide();
                self.corner = Some((number, corner));
                self.way = 0.0;
            }
        }
    }

    /// The path stops at the end of the last element.
    fn join_stop(&mut self) {
        self.decide();
        self.last = None;
        self.way = 0.0;
    }

    /// Decides the corner that waits for the way after it. Until then it is a stop, for what comes
    /// after it may raise its speed, and lower it too.
    fn decide(&mut self) {
        if let Some((number, corner)) = self.corner.take() {
            self.set_cap(number, corner.pass_speed(self.way).powi(2));
        }
    }

    /// Sets the cap of an item that is still kept.
    fn set_cap(&mut self, number: u64, cap: f64) {
        let index = number
            .checked_sub(self.first)
            .and_then(|index| usize::try_from(index).ok());
        if let Some(index) = index
            && let Some(item) = self.items.get_mut(index)
        {
            item.cap = cap;
            self.changed = self.changed.min(index);
        }
    }

    /// Other overrides, %: feed, rapid traverse, spindle.
    pub(crate) fn set_overrides(&mut self, percent: [f64; 3]) {
        self.dynamics.set_overrides(percent);
        let dynamics = &self.dynamics;
        let current = self.current.min(self.items.len());
        self.items
            .range_mut(current..)
            .for_each(|item| item.set_feed(dynamics));
        self.envelope(0);
    }

    /// No axis is faster than this from now on, mm/min.
    pub(crate) fn set_rapid_limit(&mut self, limit_mm_min: f64) {
        self.dynamics.set_rapid_limit(limit_mm_min);
        let dynamics = &self.dynamics;
        let current = self.current.min(self.items.len());
        for item in self.items.range_mut(current..) {
            if let Some(motion) = Motion::of(&item.element, dynamics) {
                item.slowest = motion.slowest;
            }
            item.set_feed(dynamics);
        }
        self.envelope(0);
    }

    /// The envelope ends in a stop at the end of an item.
    pub(crate) fn set_stop(&mut self, number: Option<u64>) {
        if self.stop_at != number {
            self.stop_at = number;
            self.envelope(0);
        }
    }

    /// Whether the stop at the end of an item is passed, or there is none.
    pub(crate) fn stop_is_behind(&self) -> bool {
        self.stop_at.is_none_or(|stop| stop < self.number())
    }

    /// Makes the envelope again from the end of the path backwards: down to the item whose cap has
    /// changed and from there until nothing changes any more.
    fn envelope(&mut self, changed: usize) {
        let stop = self.stop_at.and_then(|number| number.checked_sub(self.first));
        // What the item after allows at its start, squared, and its feed.
        let (mut entry, mut feed) = (0.0f64, 0.0f64);
        let current = self.current.min(self.items.len());
        for (index, item) in self.items.iter_mut().enumerate().skip(current).rev() {
            let slowest = item.feed.min(feed);
            let exit = if stop == Some(index as u64) {
                0.0
            } else {
                item.cap.min(slowest * slowest).min(entry)
            };
            if index < changed && exit == item.exit {
                return;
            }
            item.exit = exit;
            entry = exit + 2.0 * item.acceleration * item.length;
            feed = item.feed;
        }
    }
}

impl Item {
    fn new(element: PathElement, motion: Option<&Motion>) -> Item {
        let output = |end: Gate| {
            let mut output = Output::Nothing;
            for function in element.functions() {
                if place(function) == Some(end) {
                    let waits = wait(function).is_some();
                    output = match output {
                        Output::Waiting => output,
                        _ if waits => Output::Waiting,
                        _ => Output::Passing,
                    };
                }
            }
            output
        };
        let (start, end) = (output(Gate::Start), output(Gate::End));
        let along = element
            .functions()
            .iter()
            .any(|function| place(function).is_none());
        Item {
            start,
            end,
            along,
            length: motion.map_or(0.0, |motion| motion.length),
            acceleration: motion.map_or(1.0, |motion| motion.acceleration),
            slowest: motion.map_or(0.0, |motion| motion.slowest),
            radial_speed: motion.map_or(f64::INFINITY, |motion| motion.radial_speed),
            feed: f64::INFINITY,
            exit: 0.0,
            block_end: false,
            cap: 0.0,
            element,
        }
    }

    /// Greatest speed that machine and path allow, mm/s.
    fn greatest(&self, dynamics: &Dynamics) -> f64 {
        dynamics
            .speed(FeedRate::Rapid, OverrideLaw::Disabled, self.slowest)
            .min(self.radial_speed)
    }

    fn set_feed(&mut self, dynamics: &Dynamics) {
        if self.length > 0.0 {
            let element = &self.element;
            self.feed = dynamics
                .speed(element.feed, element.override_law, self.slowest)
                .min(self.radial_speed);
        }
    }

    /// How many outputs the element makes at most.
    pub(crate) fn outputs(&self) -> usize {
        self.element.functions().len()
    }
}

/// Lets an element start where the path is, axis by axis where that is known. An arc must start where
/// it was programmed; when that is elsewhere the answer is a line to there.
fn connect(at: &Position, element: &mut PathElement) -> Option<PathElement> {
    let from_source = element.start;
    // The tip of another tool stands elsewhere in the tool axis, without a movement.
    let tool_axis = element
        .functions()
        .iter()
        .find_map(|output| match &output.function {
            Function::Tool(call) => Some(call.axis),
            _ => None,
        });
    for axis in at.known().iter() {
        if tool_axis == Some(axis) && matches!(element.curve, Curve::Hold) && !from_source[axis].is_nan() {
            continue;
        }
        element.start[axis] = at[axis];
        // What the element does not move stays where it is.
        let stays = match &element.curve {
            Curve::Arc(arc) if axis == arc.plane.first || axis == arc.plane.second => false,
            _ => element.end[axis] == from_source[axis],
        };
        if stays || element.end[axis].is_nan() || matches!(element.curve, Curve::Hold) {
            element.end[axis] = at[axis];
        }
    }
    let Curve::Arc(arc) = &element.curve else {
        return None;
    };
    let mut gap = false;
    for axis in [arc.plane.first, arc.plane.second] {
        if !from_source[axis].is_nan() {
            gap |= (from_source[axis] - element.start[axis]).abs() > GAP;
        }
    }
    if !gap {
        return None;
    }
    let start = element.start;
    for axis in [arc.plane.first, arc.plane.second] {
        if !from_source[axis].is_nan() {
            element.start[axis] = from_source[axis];
        }
    }
    Some(PathElement {
        block: element.block,
        sequence: element.sequence,
        curve: Curve::Line,
        start,
        end: element.start,
        feed: element.feed,
        override_law: element.override_law,
        constant_speed: false,
        tangential_end: false,
        dwell_s: 0.0,
        functions: None,
    })
}
