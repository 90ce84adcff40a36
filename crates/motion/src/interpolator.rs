//! The path in contour cycles, with overrides and stops that come at any moment.

mod master;
mod recall;

use std::collections::VecDeque;

use bahn_path::{At, AxisSet, ElementSource, LiveData, PathElement, Position, Step, TechnologyFunction};

use crate::drive::{Cut, Cycle, Drive, FunctionOutput, Place, Prepared, State, Stop};
use crate::gate::{Gate, place};
use crate::item::{Item, Output};
use crate::limits::{Dynamics, Limits};
use crate::ramp::{Driven, Ramp};
use crate::ring::Ring;
use master::Coupling;

/// Drives along the path of an [`ElementSource`], contour cycle by contour cycle.
///
/// [`Interpolator::prepare`] reads ahead and may allocate; [`Interpolator::cycle`] spends one contour
/// cycle of time and never does. Both are called in turn, `prepare` as often as there is time for it:
/// where it falls behind, the path comes to a stop at the end of what is known and goes on when more
/// is. At an override that does not change the path runs as a [`Planner`](crate::Planner) plans it.
#[derive(Debug)]
pub struct Interpolator<E> {
    ring: Ring,
    cycle_s: f64,
    /// What the source said last, when that was no element.
    after: After<E>,
    /// Overrides of feed, rapid traverse and spindle, %.
    overrides: [f64; 3],
    rapid_limit_mm_min: f64,
    phase: Phase,
    /// Path speed, mm/s.
    speed: f64,
    /// Way to the end of the current element, mm.
    rest: f64,
    position: Position,
    single_block: bool,
    clamped: AxisSet,
    clamping: AxisSet,
    /// The stop of single block, or for axes that are clamped, is to be looked for.
    seek_stop: bool,
    /// The path stops behind no element before this number.
    sought: u64,
    /// The gate ahead is passed without waiting.
    released: bool,
    /// Functions along the current element up to this length are output, mm.
    output_to: f64,
    outputs: VecDeque<FunctionOutput>,
    /// The current element follows the spindle.
    coupling: Option<Coupling>,
    /// It is run back.
    backward: bool,
}

#[derive(Debug)]
enum After<E> {
    Open,
    Stop(Stop<E>),
    /// The stop was taken.
    Taken,
}

/// How far the current element is executed.
#[derive(Clone, Copy, Debug, PartialEq)]
enum Phase {
    /// Its functions at the start are still to be output.
    Begin,
    /// A gate waits.
    Gate(Gate),
    Move,
    /// Dwell to go, s.
    Dwell(f64),
    /// Its functions at the end are still to be output.
    Finish,
    /// Executed.
    Done,
    /// Executed; single block waits.
    BlockEnd,
    /// Executed, and single block does not wait any more.
    Over,
}

impl<E> Interpolator<E> {
    /// An interpolator with room for `capacity` elements of look-ahead. Overrides come with every
    /// cycle; those of the limits do not matter. No axis has a position yet.
    pub fn new(limits: &Limits, capacity: usize) -> Interpolator<E> {
        let mut dynamics = Dynamics::new(limits);
        dynamics.set_overrides([100.0; 3]);
        Interpolator {
            cycle_s: dynamics.cycle,
            ring: Ring::new(dynamics, capacity),
            after: After::Open,
            overrides: [100.0; 3],
            rapid_limit_mm_min: f64::INFINITY,
            phase: Phase::Done,
            speed: 0.0,
            rest: 0.0,
            position: Position::UNKNOWN,
            single_block: false,
            clamped: AxisSet::EMPTY,
            clamping: AxisSet::EMPTY,
            seek_stop: false,
            sought: 0,
            released: false,
            output_to: 0.0,
            outputs: VecDeque::new(),
            coupling: None,
            backward: false,
        }
    }

    /// Where the path starts; drops what was prepared.
    pub fn set_position(&mut self, position: Position) {
        self.position = position;
        self.clear();
    }

    /// Reads elements from the source while there is room, `budget` at most. It may allocate; outputs
    /// not yet asked for lose their functions.
    pub fn prepare<S>(&mut self, source: &mut S, budget: usize) -> Prepared
    where
        S: ElementSource<Error = E>,
    {
        self.ring.discard();
        let mut left = budget;
        let answer = loop {
            if !matches!(self.after, After::Open) {
                break Prepared::Closed;
            }
            if !self.ring.has_room() {
                break Prepared::Full;
            }
            if left == 0 {
                break Prepared::Budget;
            }
            left -= 1;
            let stop = match source.next() {
                Step::Element(element) => {
                    self.push(element);
                    continue;
                }
                Step::Starved => break Prepared::Starved,
                Step::Barrier(barrier) => Stop::Barrier(barrier),
                Step::End => Stop::End,
                Step::Error(error) => Stop::Error(error),
            };
            self.ring.stop();
            self.seek_stop = true;
            self.after = After::Stop(stop);
        };
        // Room for whatever the elements can output, so that no cycle allocates.
        self.outputs.reserve(self.ring.outputs());
        answer
    }

    fn push(&mut self, element: PathElement) {
        let first = self.ring.current().is_none();
        self.ring.push(element);
        self.seek_stop = true;
        if first {
            self.enter();
        }
    }

    /// Stops at once, without a ramp: the feed enable was withdrawn.
    pub fn halt(&mut self) {
        self.speed = 0.0;
    }

    /// Spends one contour cycle.
    pub fn cycle(&mut self, drive: &Drive) -> Cycle {
        self.take(drive);
        let state = self.spend(drive);
        if let Some(position) = self.following(drive.master.actual_deg) {
            self.position = position;
        } else if matches!(self.phase, Phase::Move)
            && let Some(item) = self.ring.current()
        {
            self.position = position(item, self.rest);
        }
        Cycle {
            position: self.position,
            speed_mm_s: self.speed,
            lead: self.lead(),
            state,
        }
    }

    /// Takes over what has changed in how to drive.
    fn take(&mut self, drive: &Drive) {
        // NaN is no override: the path stands.
        let percent = |percent: f64| if percent > 0.0 { percent } else { 0.0 };
        let overrides = [
            drive.feed_override_percent,
            drive.rapid_override_percent,
            drive.spindle_override_percent,
        ]
        .map(percent);
        if overrides != self.overrides {
            self.overrides = overrides;
            self.ring.set_overrides(overrides);
        }
        if drive.rapid_limit_mm_min != self.rapid_limit_mm_min {
            self.rapid_limit_mm_min = drive.rapid_limit_mm_min;
            self.ring.set_rapid_limit(drive.rapid_limit_mm_min);
        }
        if drive.single_block != self.single_block {
            self.single_block = drive.single_block;
            (self.seek_stop, self.sought) = (true, 0);
        }
        if (drive.clamped, drive.clamping) != (self.clamped, self.clamping) {
            (self.clamped, self.clamping) = (drive.clamped, drive.clamping);
            (self.seek_stop, self.sought) = (true, 0);
        }
        if self.seek_stop {
            self.seek_stop = false;
            let stop = self.block_end();
            self.ring.set_stop(stop);
        }
    }

    /// Number of the element at whose end the path stops for single block or for axes that are clamped,
    /// where it can still come to a standstill.
    fn block_end(&mut self) -> Option<u64> {
        if !self.single_block && self.clamped.union(self.clamping).is_empty() {
            return None;
        }
        let last = self.ring.last()?;
        let mut first = self.sought.max(self.ring.number());
        while first < last && !self.stops_behind(first) {
            first += 1;
        }
        self.sought = first;
        if !self.stops_behind(first) {
            return None;
        }
        let squared = self.speed * self.speed * (1.0 - 1e-9);
        let mut possible = 0.0;
        let mut length = self.rest;
        for (number, item) in (self.ring.number()..).zip(self.ring.ahead()) {
            possible += 2.0 * item.acceleration * length;
            if squared <= possible && (number < first || self.stops_behind(number)) {
                return Some(number.max(first));
            }
            length = self.ring.get(number + 1).map_or(0.0, |next| next.length);
        }
        None
    }

    /// Whether the path is to stop at the end of an element. What is not so stays so, but for the last element: it
    /// depends on the one after it.
    fn stops_behind(&self, number: u64) -> bool {
        let ends = self
            .ring
            .get(number)
            .is_some_and(|item| item.block_end && (self.single_block || moves(&item.element, self.clamping)));
        let next = self.ring.get(number + 1);
        ends || next.is_some_and(|next| moves(&next.element, self.clamped))
    }

    /// Goes along the path until the time of the cycle is spent or the path waits.
    fn spend(&mut self, drive: &Drive) -> State {
        let mut time = self.cycle_s;
        loop {
            if self.ring.current().is_none() {
                return self.at_the_end();
            }
            let waits = match self.phase {
                Phase::Begin => self.begin(drive),
                Phase::Gate(end) => Some(State::Gate(end)),
                Phase::Move => self.drive_along(drive, &mut time),
                // The manual is silent: dwell goes on only while the path is not held (inferred).
                Phase::Dwell(_) if drive.hold => Some(State::Held),
                Phase::Dwell(dwell) if dwell > time => {
                    self.phase = Phase::Dwell(dwell - time);
                    Some(State::Dwell)
                }
                Phase::Dwell(dwell) => {
                    time -= dwell;
                    self.phase = Phase::Finish;
                    None
                }
                Phase::Finish => {
                    self.phase = self.output(Gate::End, Phase::Done);
                    None
                }
                Phase::Done => self.finish(drive),
                Phase::BlockEnd => Some(State::BlockEnd),
                Phase::Over => self.next(),
            };
            if let Some(state) = waits {
                return state;
            }
        }
    }

    /// Outputs the functions before the current element, once it may begin. What it waits for.
    fn begin(&mut self, drive: &Drive) -> Option<State> {
        if self.speed <= 0.0 {
            // Nothing new begins while the path is held.
            if drive.hold {
                return Some(State::Held);
            }
            if self
                .ring
                .current()
                .is_some_and(|item| moves(&item.element, self.clamped))
            {
                return Some(State::Clamped);
            }
        }
        if !self.couple(drive) {
            return Some(State::Master);
        }
        self.phase = self.output(Gate::Start, Phase::Move);
        None
    }

    /// Drives along the current element. What the path does when the time is spent before its end.
    fn drive_along(&mut self, drive: &Drive, time: &mut f64) -> Option<State> {
        if let Some(state) = self.drive_back(drive, *time) {
            return Some(state);
        }
        let hold = drive.hold || drive.back;
        let (limit, exit_squared) = if hold {
            (0.0, 0.0)
        } else {
            (self.ring.feed(), self.ring.exit())
        };
        let item = self.ring.current()?;
        let (along, dwell, end) = (item.along, item.element.dwell_s, item.element.end);
        let ramp = Ramp {
            speed: self.speed,
            rest: self.rest,
            acceleration: item.acceleration,
            limit,
            exit_squared,
        };
        let state = match ramp.drive(*time) {
            Driven::OnTheWay { speed, rest } => {
                (self.speed, self.rest) = (speed, rest);
                let stands = speed <= 0.0 && rest == ramp.rest;
                Some(if stands && hold {
                    State::Held
                } else {
                    State::Moving
                })
            }
            Driven::Arrived { speed, left } => {
                // Rounding must not carry the path over what was found to be possible.
                let cap = self.ring.cap();
                self.speed = if speed * speed > cap { cap.sqrt() } else { speed };
                (self.position, self.rest, *time) = (end, 0.0, left);
                self.phase = if dwell > 0.0 {
                    Phase::Dwell(dwell)
                } else {
                    Phase::Finish
                };
                // The spindle is told the end before the path goes on.
                self.coupling.map(|_| State::Moving)
            }
        };
        if along {
            self.output_along();
        }
        state
    }

    /// Goes on behind the current element, unless the path has to wait there. What it waits for.
    fn finish(&mut self, drive: &Drive) -> Option<State> {
        let item = self.ring.current()?;
        if self.speed <= 0.0 {
            if item.length > 0.0 && !drive.in_position {
                return Some(State::Settling);
            }
            if item.block_end && moves(&item.element, self.clamping) {
                return Some(State::Clamping);
            }
            // Whether the block has ended is known when the next element is, or that none comes.
            if self.single_block && item.block_end {
                self.phase = Phase::BlockEnd;
                return None;
            }
        }
        self.next()
    }

    fn at_the_end(&self) -> State {
        match self.after {
            After::Stop(_) => State::Stopped,
            After::Open | After::Taken => State::Empty,
        }
    }

    /// Goes on to the next element; there may be none.
    fn next(&mut self) -> Option<State> {
        if self.ring.following().is_none() {
            return Some(self.at_the_end());
        }
        let length = self.ring.current().map_or(0.0, |item| item.length);
        let before = self.coupling.map(|coupling| (coupling, length));
        self.ring.advance();
        self.enter();
        self.couple_on(before);
        if self.ring.stop_is_behind() {
            let stop = self.block_end();
            self.ring.set_stop(stop);
        }
        None
    }

    /// Begins the current element.
    fn enter(&mut self) {
        self.phase = Phase::Begin;
        self.rest = self.ring.current().map_or(0.0, |item| item.length);
        self.output_to = f64::NEG_INFINITY;
    }

    /// Outputs the functions at one end of the current element; the phase after it.
    fn output(&mut self, gate: Gate, then: Phase) -> Phase {
        let (place, output) = match (gate, self.ring.current()) {
            (_, None) => return then,
            (Gate::Start, Some(item)) => (Place::Start, item.start),
            (Gate::End, Some(item)) => (Place::End, item.end),
        };
        match output {
            Output::Nothing => then,
            Output::Passing => {
                self.queue(place, false);
                then
            }
            Output::Waiting => {
                let waits = !std::mem::take(&mut self.released);
                self.queue(place, waits);
                if waits { Phase::Gate(gate) } else { then }
            }
        }
    }

    /// Outputs the functions along the current element that were passed.
    fn output_along(&mut self) {
        let Some(item) = self.ring.current() else { return };
        let to = if self.rest > 0.0 {
            item.length - self.rest
        } else {
            f64::INFINITY
        };
        let passed = self.output_to..to;
        for index in 0..item.element.functions().len() {
            let length = self
                .ring
                .current()
                .and_then(|item| item.element.functions().get(index))
                .filter(|function| place(function).is_none())
                .and_then(|function| match function.at {
                    At::Length(length) if length > 0.0 => Some(length.min(f64::MAX)),
                    At::Length(_) => Some(0.0),
                    At::BeforeEnd(lead_s) => Some(self.place_before_end(lead_s)),
                    At::Start | At::End => None,
                });
            if length.is_some_and(|length| passed.contains(&length)) {
                self.queue(Place::Along(index), false);
            }
        }
        self.output_to = to;
    }

    /// The path length of the current element from which its movement still takes a time, s; at the latest
    /// that at which it begins to brake, for in tapping the spindle follows a feed ramp that is flatter than
    /// its own [000:6070].
    fn place_before_end(&self, time_s: f64) -> f64 {
        let Some(item) = self.ring.current() else {
            return 0.0;
        };
        let speed = self.ring.feed().min((item.acceleration * item.length).sqrt());
        let braking = self.braking_s();
        let way = speed * (0.5 * braking + (time_s - braking).max(0.0));
        (item.length - way).max(0.0)
    }

    /// The time in which the current element brakes to a standstill from its feed, s.
    pub fn braking_s(&self) -> f64 {
        self.ring.current().map_or(0.0, |item| {
            self.ring.feed().min((item.acceleration * item.length).sqrt()) / item.acceleration
        })
    }

    fn queue(&mut self, place: Place, waits: bool) {
        if let Some(item) = self.ring.current() {
            self.outputs.push_back(FunctionOutput {
                element: self.ring.number(),
                block: item.element.block,
                sequence: item.element.sequence,
                place,
                waits,
            });
        }
    }

    /// The next functions to be output, in the order of the path. To be asked for until there are no
    /// more after each cycle.
    pub fn next_output(&mut self) -> Option<FunctionOutput> {
        self.outputs.pop_front()
    }

    /// The functions of an output. They are kept until the next [`Interpolator::prepare`], those of
    /// the current element longer.
    pub fn functions(&self, output: &FunctionOutput) -> impl Iterator<Item = &TechnologyFunction> {
        let wanted = output.place;
        let functions = self
            .ring
            .get(output.element)
            .map_or(&[] as &[_], |item| item.element.functions());
        functions
            .iter()
            .enumerate()
            .filter(move |(index, function)| match wanted {
                Place::Start => place(function) == Some(Gate::Start),
                Place::End => place(function) == Some(Gate::End),
                Place::Along(along) => *index == along,
            })
            .map(|(_, function)| function)
    }

    /// The functions for which the path waits are acknowledged. When it does not wait yet, the next
    /// gate is passed at once.
    pub fn release(&mut self) {
        match self.phase {
            Phase::Gate(Gate::Start) => self.phase = Phase::Move,
            Phase::Gate(Gate::End) => self.phase = Phase::Done,
            _ => self.released = true,
        }
    }

    /// Single block: goes on with the next block. Without effect unless the path waits for it.
    pub fn go_on(&mut self) {
        if self.phase == Phase::BlockEnd {
            self.phase = Phase::Over;
        }
    }

    /// Why no more elements come, once in [`State::Stopped`].
    pub fn take_stop(&mut self) -> Option<Stop<E>> {
        let executed = matches!(self.phase, Phase::Done | Phase::Over) && self.ring.following().is_none();
        if !executed || !matches!(self.after, After::Stop(_)) {
            return None;
        }
        match std::mem::replace(&mut self.after, After::Taken) {
            After::Stop(stop) => Some(stop),
            After::Open | After::Taken => None,
        }
    }

    /// Lets the source go on after a barrier.
    pub fn resume<S>(&mut self, source: &mut S, live: LiveData)
    where
        S: ElementSource<Error = E>,
    {
        source.resume(live);
        self.after = After::Open;
    }

    /// Internal stop: drops all that is not executed, wherever the path is, and says where that was.
    /// `None` when all was executed. The next path starts from here.
    pub fn clear(&mut self) -> Option<Cut> {
        let cut = self.ring.current().and_then(|item| {
            let unfinished = !matches!(self.phase, Phase::Done | Phase::BlockEnd | Phase::Over);
            let cut_at = if unfinished {
                Some(item)
            } else {
                self.ring.following()
            };
            cut_at.map(|item| {
                let rest_mm = if unfinished { self.rest } else { item.length };
                Cut {
                    block: item.element.block,
                    sequence: item.element.sequence,
                    covered_mm: item.length - rest_mm,
                    rest_mm,
                    position: self.position,
                }
            })
        });
        self.ring.clear(self.position);
        self.after = After::Open;
        self.phase = Phase::Done;
        (self.speed, self.rest) = (0.0, 0.0);
        self.released = false;
        self.sought = 0;
        self.outputs.clear();
        self.coupling = None;
        self.backward = false;
        cut
    }

    /// Nominal position on the path.
    pub fn position(&self) -> Position {
        self.position
    }

    /// Path speed, mm/s.
    pub fn speed_mm_s(&self) -> f64 {
        self.speed
    }

    /// The element that is executed, or was last.
    pub fn element(&self) -> Option<&PathElement> {
        self.ring.current().map(|item| &item.element)
    }

    /// Path length to the end of that element, mm.
    pub fn rest_mm(&self) -> f64 {
        self.rest
    }

    /// Elements that are prepared and not yet executed, the current one included.
    pub fn ahead(&self) -> usize {
        self.ring.ahead().len()
    }
}

/// The position with so much of an item to go, mm.
fn position(item: &Item, rest: f64) -> Position {
    let PathElement {
        curve, start, end, ..
    } = &item.element;
    let fraction = if item.length > 0.0 {
        (item.length - rest) / item.length
    } else {
        1.0
    };
    curve.position(start, end, fraction)
}

/// Whether an element moves one of the axes.
fn moves(element: &PathElement, axes: AxisSet) -> bool {
    axes.iter().any(|axis| element.moves(axis))
}
