//! The path in contour cycles, with overrides and stops that come at any moment.
//!
//! Decision: Axes that followed the spindle, and were moved when the drives were taken away, go on from where they
//! stand: what is left of the thread is driven again, though its end was output, and beyond an end of it they go back
//! on the ramp of the spindle; a tool that is out of the thread goes back to where that begins. They are coupled when
//! the spindle stands. In a tilted plane NC start leads them back beside the thread first; a run that waited for its
//! feed enable does so itself (also `kernel/src/thread.rs`)
//!
//! Decision: Dwell is interrupted by NC stop; it comes before the functions at the end of its block

mod ahead;
mod master;
mod outputs;
mod phase;
mod recall;
mod standing;
mod stops;
mod view;

use std::sync::Arc;

use bahn_path::{ElementSource, LiveData, PathElement, Placement, Position, Step, TechnologyFunction};

use crate::clone_within::clone_within;
use crate::drive::{Cut, Cycle, Drive, FunctionOutput, Place, Prepared, State, Stop};
use crate::gate::Gate;
use crate::item::Output;
use crate::limits::{Dynamics, Limits};
use crate::ramp::{Driven, Ramp};
use crate::ring::Ring;
use ahead::Ahead;
use master::Coupling;
use outputs::Outputs;
use phase::Phase;
use recall::Executed;
use standing::{Led, Standing};
use stops::{Acknowledged, Stops};

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
    overrides: Overrides,
    phase: Phase,
    at: Standing,
    stops: Stops,
    gates: Gates,
    outputs: Outputs,
    ahead: Ahead,
    led: Led,
    /// How far the first element was executed that is taken back and still to be given again.
    recalled: Option<Executed>,
}

clone_within!(Interpolator<E> {
    ring,
    cycle_s,
    after,
    overrides,
    phase,
    at,
    stops,
    gates,
    outputs,
    ahead,
    led,
    recalled,
});

/// How fast the path may be, as it was said last.
#[derive(Clone, Copy, Debug)]
struct Overrides {
    /// Of feed, rapid traverse and spindle, %.
    percent: [f64; 3],
    /// Programmed feeds count as rapid traverse.
    rapid: bool,
    rapid_limit_mm_min: f64,
}

/// What is so of the places where functions are output.
#[derive(Clone, Copy, Debug, Default)]
struct Gates {
    /// The one ahead is passed without waiting.
    released: bool,
    /// The functions at the end of the current element are output; what is left of it is a distance alone.
    end_is_output: bool,
}

#[allow(
    clippy::large_enum_variant,
    reason = "one at a time, and no cycle allocates: a scan goes with its barrier"
)]
#[derive(Clone, Debug)]
enum After<E> {
    Open,
    Stop(Stop<E>),
    /// The stop was taken.
    Taken,
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
            overrides: Overrides {
                percent: [100.0; 3],
                rapid: false,
                rapid_limit_mm_min: f64::INFINITY,
            },
            phase: Phase::Done,
            at: Standing::default(),
            stops: Stops::default(),
            gates: Gates::default(),
            outputs: Outputs::with_capacity(capacity),
            ahead: Ahead::default(),
            led: Led::default(),
            recalled: None,
        }
    }

    /// Where the path starts; drops what was prepared.
    pub fn set_position(&mut self, position: Position) {
        self.at.position = position;
        self.clear();
    }

    /// The path so far, and with it the [position](Interpolator::set_position), stands in this placement.
    pub fn set_placement(&mut self, placement: Option<Arc<Placement>>) {
        self.at.placement = placement;
        self.clear();
    }

    /// Reads elements from the source while there is room, `budget` at most. It may allocate; outputs
    /// not yet asked for lose their functions. What was [recalled](Interpolator::recall) comes first: until it is
    /// taken nothing is read.
    pub fn prepare<S>(&mut self, source: &mut S, budget: usize) -> Prepared
    where
        S: ElementSource<Error = E>,
    {
        if self.recalled.is_some() {
            return Prepared::Starved;
        }
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
            self.stops.seek();
            self.after = After::Stop(stop);
        };
        // Room for whatever the elements can output, so that no cycle allocates.
        let ends = self.ring.ahead().len();
        self.outputs.reserve(self.ring.outputs(), ends);
        answer
    }

    fn push(&mut self, element: PathElement) {
        let first = self.ring.current().is_none();
        self.ring.push(element);
        if let Some((number, item)) = self.ring.last().zip(self.ring.back()) {
            self.ahead.push(&item.element, number);
        }
        self.stops.seek();
        if first {
            self.enter();
        }
    }

    /// Stops at once, without a ramp: the feed enable was withdrawn.
    pub fn halt(&mut self) {
        self.at.speed = 0.0;
    }

    /// Spends one contour cycle.
    pub fn cycle(&mut self, drive: &Drive) -> Cycle {
        self.take(drive);
        self.outputs.begin_cycle();
        let state = self.spend(drive);
        if let Some(item) = self.ring.current() {
            if let Some(coupling) = &self.led.coupling {
                self.at.position = coupling.position(item, drive.master.actual_deg);
            } else if matches!(self.phase, Phase::Move) {
                self.at.go_along(item);
            }
        }
        self.put_ahead();
        Cycle {
            position: self.at.position,
            speed_mm_s: self.at.speed,
            lead: self.led.lead(self.ring.current(), &self.at),
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
        if overrides != self.overrides.percent {
            self.overrides.percent = overrides;
            self.ring.set_overrides(overrides);
        }
        if drive.rapid != self.overrides.rapid {
            self.overrides.rapid = drive.rapid;
            self.ring.set_all_rapid(drive.rapid);
        }
        if drive.rapid_limit_mm_min != self.overrides.rapid_limit_mm_min {
            self.overrides.rapid_limit_mm_min = drive.rapid_limit_mm_min;
            self.ring.set_rapid_limit(drive.rapid_limit_mm_min);
        }
        if drive.acknowledged && self.ring.awaits() {
            let begun = !matches!(self.phase, Phase::Begin);
            self.stops.acknowledge(Acknowledged {
                starts: self.ring.number() + u64::from(begun),
                ahead: self
                    .ahead
                    .first()
                    .or(self.ring.last().map(|last| last + 1))
                    .unwrap_or(0),
            });
        }
        if self.stops.take(drive) {
            self.seek_stop();
        }
    }

    /// Looks for the next place where single block or axes that are clamped stop the path.
    fn seek_stop(&mut self) {
        let stop = self.stops.next(&self.ring, self.at.speed, self.at.rest);
        self.ring.set_stop(stop);
    }

    /// Outputs the functions whose elements come near.
    fn put_ahead(&mut self) {
        if !self.ahead.is_empty() {
            self.ahead
                .put(&self.ring, self.at.speed, self.at.rest, &mut self.outputs);
        }
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
                    self.gates.end_is_output = true;
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
        self.put_ahead();
        if self.at.speed <= 0.0 {
            // Nothing new begins while the path is held.
            if drive.hold {
                return Some(State::Held);
            }
            let number = self.ring.number();
            let item = self.ring.current()?;
            if self.stops.is_clamped(item) {
                return Some(State::Clamped);
            }
            if self.stops.is_awaited(item, number) {
                return Some(State::Awaiting);
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
        if let Some(state) = self.drive_in(drive, *time) {
            return Some(state);
        }
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
        let sequence = item.element.sequence;
        let ramp = Ramp {
            speed: self.at.speed,
            rest: self.at.rest,
            acceleration: item.acceleration,
            limit,
            exit_squared,
        };
        let state = match ramp.drive(*time) {
            Driven::OnTheWay { speed, rest } => {
                (self.at.speed, self.at.rest) = (speed, rest);
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
                self.at.speed = if speed * speed > cap { cap.sqrt() } else { speed };
                (self.at.position, self.at.rest, *time) = (end, 0.0, left);
                self.phase = match self.gates.end_is_output {
                    true => Phase::Done,
                    false if dwell > 0.0 => Phase::Dwell(dwell),
                    false => Phase::Finish,
                };
                if !self.gates.end_is_output {
                    self.outputs.pass(sequence, left, self.at.speed);
                }
                // The spindle gets the end before the path goes on.
                self.led.coupling.map(|_| State::Moving)
            }
        };
        if along && let Some(item) = self.ring.current() {
            let feed = self.ring.feed();
            self.outputs.along(item, self.ring.number(), self.at.rest, feed);
        }
        state
    }

    /// Couples the current element to the spindle as it stands. `false` when the spindle is not ready.
    fn couple(&mut self, drive: &Drive) -> bool {
        let thread = self.ring.current().and_then(|item| item.element.thread());
        if let (Some(thread), None) = (thread, self.led.coupling) {
            if !drive.master.ready {
                return false;
            }
            self.led.coupling = Some(Coupling::new(thread, drive.master.nominal_deg));
        }
        true
    }

    /// Goes back along the current element for a time; `None` when it goes forward.
    fn drive_back(&mut self, drive: &Drive, time: f64) -> Option<State> {
        let item = self.ring.current()?;
        let wanted = drive.back && self.led.coupling.is_some();
        if self.at.speed <= 0.0 {
            self.led.backward = wanted;
        }
        if !self.led.backward {
            return None;
        }
        let limit = if wanted { self.ring.feed() } else { 0.0 };
        let (speed, covered) = master::go_back(item, self.at.speed, item.length - self.at.rest, limit, time);
        (self.at.speed, self.at.rest) = (speed, item.length - covered);
        Some(if speed > 0.0 { State::Moving } else { State::Held })
    }

    /// Goes back for a time to the end of the current element, beyond which spindle and axis have come to stand; `None` when
    /// it is not beyond.
    fn drive_in(&mut self, drive: &Drive, time: f64) -> Option<State> {
        let item = self.ring.current()?;
        if self.at.rest >= 0.0 {
            return None;
        }
        self.led.backward = true;
        let held = drive.hold && !drive.back;
        let limit = if held { 0.0 } else { self.ring.feed() };
        let (speed, beyond) = master::go_back(item, self.at.speed, -self.at.rest, limit, time);
        (self.at.speed, self.at.rest) = (speed, 0.0 - beyond);
        Some(if speed > 0.0 || !held {
            State::Moving
        } else {
            State::Held
        })
    }

    /// Goes on after the current element, unless the path has to wait there. What it waits for.
    fn finish(&mut self, drive: &Drive) -> Option<State> {
        let item = self.ring.current()?;
        if self.at.speed <= 0.0 {
            if item.length > 0.0 && !drive.in_position {
                return Some(State::Settling);
            }
            if self.stops.is_to_be_clamped(item) {
                return Some(State::Clamping);
            }
            // Whether the block has ended is known when the next element is, or that none comes.
            if self.stops.is_block_end(item, self.ring.following()) {
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
        self.ring.advance();
        self.enter();
        let thread = self.ring.current().and_then(|item| item.element.thread());
        self.led.go_on(length, thread);
        if self.ring.stop_is_passed() {
            self.seek_stop();
        }
        None
    }

    /// Begins the current element.
    fn enter(&mut self) {
        self.phase = Phase::Begin;
        self.gates.end_is_output = false;
        self.at.enter(self.ring.current());
        self.outputs.begin();
    }

    /// Outputs the functions at one end of the current element; the phase after it.
    fn output(&mut self, gate: Gate, then: Phase) -> Phase {
        let Some(item) = self.ring.current() else {
            return then;
        };
        let (place, output) = match gate {
            Gate::Start => (Place::Start, item.start),
            Gate::End => (Place::End, item.end),
        };
        if output == Output::Nothing {
            return then;
        }
        let waits = output == Output::Waiting && !std::mem::take(&mut self.gates.released);
        self.outputs.put(item, self.ring.number(), place, waits);
        if waits { Phase::Gate(gate) } else { then }
    }

    /// The time in which the current element brakes to a standstill from its feed, s.
    pub fn braking_s(&self) -> f64 {
        let item = self.ring.current();
        item.map_or(0.0, |item| item.braking_s(self.ring.feed()))
    }

    /// The next functions to be output, in the order of the path. To be asked for until there are no
    /// more after each cycle.
    pub fn next_output(&mut self) -> Option<FunctionOutput> {
        self.outputs.next()
    }

    /// The functions of an output. They are kept until the next [`Interpolator::prepare`], those of
    /// the current element longer.
    pub fn functions(&self, output: &FunctionOutput) -> impl Iterator<Item = &TechnologyFunction> {
        let item = self.ring.get(output.element);
        outputs::at(
            output.place,
            item.map_or(&[] as &[_], |item| item.element.functions()),
        )
    }

    /// The functions for which the path waits are acknowledged. When it does not wait yet, the next
    /// gate is passed at once.
    pub fn release(&mut self) {
        match self.phase {
            Phase::Gate(Gate::Start) => self.phase = Phase::Move,
            Phase::Gate(Gate::End) if self.at.rest != 0.0 => self.phase = Phase::Move,
            Phase::Gate(Gate::End) => self.phase = Phase::Done,
            _ => self.gates.released = true,
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

    /// Why no more elements come after those that are known, as long as that was not taken.
    pub fn stop(&self) -> Option<&Stop<E>> {
        match &self.after {
            After::Stop(stop) => Some(stop),
            After::Open | After::Taken => None,
        }
    }

    /// Why the path ends with the current element; `None` when it does not, or that is not known yet.
    pub fn stop_after_this(&self) -> Option<&Stop<E>> {
        self.stop().filter(|_| self.ring.following().is_none())
    }

    /// What comes from now on is planned within other limits; what was read already keeps its own. Overrides stay.
    pub fn set_limits(&mut self, limits: &Limits) {
        self.ring
            .set_limits(limits, self.overrides.percent, self.overrides.rapid_limit_mm_min);
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
            let unfinished = !self.phase.is_executed();
            let cut_at = if unfinished {
                Some(item)
            } else {
                self.ring.following()
            };
            cut_at.map(|item| {
                let rest_mm = if unfinished { self.at.rest } else { item.length };
                Cut {
                    block: item.element.block,
                    sequence: item.element.sequence,
                    covered_mm: item.length - rest_mm,
                    rest_mm,
                    position: self.at.position,
                }
            })
        });
        self.ring.clear(self.at.position, self.at.placement.clone());
        self.after = After::Open;
        self.phase = Phase::Done;
        self.at.stay();
        self.gates.released = false;
        self.stops.forget();
        self.outputs.clear();
        self.ahead.clear();
        self.led = Led::default();
        self.recalled = None;
        cut
    }

    /// Takes back what is not executed, for the axes stand elsewhere: the path goes on from a position to
    /// where each of the elements leads, once they are [taken](Interpolator::take_recalled) and given again. The rest
    /// of the element that was cut comes without the functions that are output already. The path must stand.
    pub fn recall(&mut self, position: Position) {
        let executed = Executed {
            number: self.ring.number(),
            late: self.ring.is_late(),
            phase: self.phase,
            length: self.ring.current().map_or(0.0, |item| item.length),
            rest: self.at.rest,
            output_to: self.outputs.to(),
        };
        let recalled = self.recalled.or(Some(executed));
        if self.recalled.is_none() {
            self.ring.set_aside();
        }
        self.at.position = position;
        let ahead = std::mem::take(&mut self.ahead);
        self.clear();
        (self.recalled, self.ahead) = (recalled, ahead);
        if recalled.is_some_and(|executed| executed.late) {
            self.ring.await_all();
        }
    }

    /// What was recalled since it was asked for last, for the source to give it again before all else; there may be
    /// nothing left. It may allocate.
    pub fn take_recalled(&mut self) -> Option<Vec<PathElement>> {
        let executed = self.recalled.take()?;
        let ahead = std::mem::take(&mut self.ahead);
        let elements = self.ring.take_aside();
        let mut elements = elements.zip(executed.number..).map(|(mut element, number)| {
            ahead.remainder(&mut element, number);
            element
        });
        let first = elements.next().and_then(|first| executed.remainder(first));
        Some(first.into_iter().chain(elements).collect())
    }

    /// Couples an element that has begun anew, for spindle and axes were moved meanwhile: this position
    /// belongs to that angle of the spindle, degrees.
    pub fn couple_again(&mut self, position: &Position, angle_deg: f64) {
        let Some((item, coupling)) = self.ring.current().zip(self.led.coupling.as_mut()) else {
            return;
        };
        let (distance, place) = coupling.renew(item, position, angle_deg);
        // Beyond its ends, too: the command to the spindle begins where it stands.
        let rest = item.length - distance;
        // Its end was reached in nominal values alone, the axis that follows the spindle is elsewhere.
        let ended = matches!(self.phase, Phase::Dwell(_) | Phase::Finish) || self.phase.is_executed();
        if ended && rest != 0.0 {
            self.phase = Phase::Move;
        }
        self.at.rest = rest;
        (self.at.speed, self.at.position) = (0.0, place);
    }

    /// Whether the path follows the spindle: it has begun an element that does so, and none after it.
    pub fn is_coupled(&self) -> bool {
        self.led.coupling.is_some()
    }
}
