//! The axes along the path, contour cycle by contour cycle, and what is output on it.
//!
//! Decision: Where the axes stand elsewhere than the path (datum correction, PLC positioning, tool length), what is
//! not executed is taken back and given again from there; axes that a block does not move stay (also
//! `motion/src/interpolator/recall.rs`)
//!
//! Decision: That the path compensation is to be terminated before a PLC positioning is the programmer's business:
//! after a strobe in a compensated block the path goes on from where the axes are

use std::collections::VecDeque;

use bahn_motion::{FunctionOutput, Interpolator, Limits};
use bahn_path::{Axis, AxisSet, BlockRef, Curve, FeedRate, Function, PathElement, Position, Voltage};

use crate::axes::OwnAxes;
use crate::axis::{AxisUnit, Mover};
use crate::feeder::RunFault;
use crate::kinematics::Chain;
use crate::superimposing::Wheels;
use crate::voltage::Along;

/// Elements of the path that are prepared ahead at most.
pub const LOOK_AHEAD: usize = 512;
/// So near is no other place, mm or degrees.
const SAME_MM: f64 = 1e-6;
/// Outputs of functions that wait at most.
const OUTPUTS: usize = 64;

/// Who takes the functions of the path, once the axes are where the functions act.
pub trait Outputs {
    /// A block gives its functions at a place now; they follow in their order.
    fn begin(&mut self, at: &FunctionOutput);

    /// The block that was begun gives a function. Whether it is taken: one that is not is refused, and its block with it.
    fn output(&mut self, function: &Function) -> bool;

    /// An order for the voltage along the path, by the block with a sequence.
    fn voltage(&mut self, order: Voltage, sequence: u64);
}

/// A block is refused by who takes its functions.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct RefusedBlock {
    /// Program and number of the block.
    pub block: BlockRef,
    /// Its place in the order of execution.
    pub sequence: u64,
}

/// The path of a run with what follows it.
#[derive(Clone, Debug)]
pub struct Track {
    /// The path, sampled in each contour cycle.
    pub path: Interpolator<RunFault>,
    /// Functions on the path that wait for the axes to be in position.
    waiting: VecDeque<FunctionOutput>,
    /// A function was refused: the path goes no farther, and the run ends before its block.
    refused: Option<RefusedBlock>,
    /// Position of the path in the last cycle.
    last: Option<Position>,
    /// The path speed, mm/s.
    speed: f64,
    /// The feed that was programmed last, mm/min.
    feed: f64,
    /// The PLC chose another traverse range: the blocks that are on their way are to be looked at anew.
    pub range_changed: bool,
    /// The limits of the path have changed; they take effect when no program runs.
    pub limits_changed: bool,
}

impl Track {
    /// A path within limits, with nothing on it.
    pub fn new(limits: &Limits) -> Track {
        Track {
            path: Interpolator::new(limits, LOOK_AHEAD),
            waiting: VecDeque::new(),
            refused: None,
            last: None,
            speed: 0.0,
            feed: 0.0,
            range_changed: false,
            limits_changed: false,
        }
    }

    /// A path within other limits, between programs; allocates.
    pub fn take_limits(&mut self, limits: &Limits) {
        self.limits_changed = false;
        self.path = Interpolator::new(limits, LOOK_AHEAD);
    }

    /// Other limits for what is not read yet: those of a run take effect at once, and otherwise with the next one.
    pub fn change_limits(&mut self, limits: &Limits, running: bool) {
        match running {
            true => self.path.set_limits(limits),
            false => self.limits_changed = true,
        }
    }

    /// The path begins where the axes stand, outside the cycle.
    pub fn begin_at(&mut self, here: Position, chain: &Chain) {
        self.path.set_placement(chain.placement().cloned());
        self.path.set_position(here);
    }

    /// Makes room for the functions that wait, outside the cycle.
    pub fn reserve(&mut self) {
        if self.waiting.capacity() == 0 {
            self.waiting.reserve(OUTPUTS);
        }
    }

    /// The path speed, mm/s.
    pub fn speed_mm_s(&self) -> f64 {
        self.speed
    }

    /// How far the path has come, for what follows it.
    pub fn along(&self) -> Along {
        Along {
            sequence: self.path.element().map_or(0, |element| element.sequence),
            part: self.path.part(),
            mm_min: self.speed * 60.0,
        }
    }

    /// The path stands at once: nothing moves the axes any more.
    pub fn halt(&mut self) {
        self.path.halt();
        self.speed = 0.0;
    }

    /// The path moves at a speed, mm/s.
    pub fn set_speed(&mut self, speed_mm_s: f64) {
        self.speed = speed_mm_s;
    }

    /// The path begins somewhere else.
    pub fn forget_position(&mut self) {
        self.last = None;
    }

    /// Nothing waits any more, and nothing moves.
    pub fn break_off(&mut self) {
        self.waiting.clear();
        self.refused = None;
        self.speed = 0.0;
    }

    /// No function waits to be output, and none was refused.
    pub fn has_output_all(&self) -> bool {
        self.waiting.is_empty() && self.refused.is_none()
    }

    /// The block one of whose functions was refused, until the run is broken off.
    pub fn refused(&self) -> Option<RefusedBlock> {
        self.refused
    }

    /// No axis moves along the path.
    pub fn stands(&self, axes: &OwnAxes) -> bool {
        self.path.speed_mm_s() == 0.0
            && axes
                .iter()
                .filter(|unit| unit.mover == Mover::Path)
                .all(AxisUnit::stands)
    }

    /// The axes that the current element moves are held in their loops, have feed enable and are where they shall be. An element
    /// that waits for a clamped axis may do so.
    pub fn is_able(&self, axes: &OwnAxes) -> bool {
        let Some(element) = self.path.element() else {
            return true;
        };
        let stands = self.path.speed_mm_s() == 0.0;
        let able = |unit: &AxisUnit| {
            unit.is_released() && unit.way_back.is_over() && (unit.servo.closed() || stands)
        };
        // Whether the path moves an axis is a longer question, and seldom matters.
        axes.iter()
            .all(|unit| able(unit) || !element.moves_axis(unit.axis))
    }

    /// An axis that the current element moves comes down on its ramp, since its feed is not enabled.
    pub fn ramps_down(&self, axes: &OwnAxes) -> bool {
        let element = self.path.element();
        let moves = |unit: &AxisUnit| element.is_some_and(|element| element.moves_axis(unit.axis));
        axes.iter().any(|unit| unit.ramps_down() && moves(unit))
    }

    /// A block wants a clamped axis: the markers M2008 ff. of its axes fall, and the PLC unclamps them [000:5407].
    pub fn ask_to_unclamp(&self, clamped: AxisSet, axes: &mut OwnAxes) {
        let Some(element) = self.path.element() else {
            return;
        };
        let wants = |axis| element.moves_axis(axis);
        if clamped.iter().any(wants) {
            for unit in axes.iter_mut().filter(|unit| wants(unit.axis)) {
                unit.wait_to_begin();
            }
        }
    }

    /// The axes stand where they are.
    pub fn hold(&self, axes: &mut OwnAxes, time_s: f64) {
        for unit in axes.iter_mut().filter(|unit| unit.mover == Mover::Path) {
            unit.follow(unit.nominal, time_s);
        }
    }

    /// The nominal positions of the axes from that of the path and what the handwheel adds to it.
    pub fn follow(&mut self, position: &Position, axes: &mut OwnAxes, chain: &mut Chain, wheels: &Wheels) {
        let moved = self.last != Some(*position);
        self.last = Some(*position);
        let element = self.path.element();
        if let Some(element) = element {
            chain.place(element.placement.as_ref());
            if let (FeedRate::Programmed(feed), false) = (element.feed, element.curve == Curve::Hold) {
                self.feed = feed;
            }
        }
        let path = chain.without_wheels(position);
        let superimposed = &mut chain.superimposed;
        // In a thread, which the spindle leads, no wheel does.
        let led = moved.then_some(&path);
        superimposed.follow(led, axes.iter(), wheels, self.path.is_coupled());
        let nominal = superimposed.added(path, 1.0);
        let time_s = wheels.time_s;
        for unit in axes.iter_mut() {
            let value = nominal[unit.axis];
            if value.is_nan() || !matches!(unit.mover, Mover::None | Mover::Path) || unit.is_plc_axis() {
                continue;
            }
            unit.servo
                .set_circular(element.is_some_and(|element| is_circular(element, unit.axis)));
            if moved && let Some(left_at) = &mut unit.left_at {
                // CE has taken it over from where it is while the path came to a standstill: it goes back with NC start.
                *left_at = value;
                unit.follow(unit.nominal, time_s);
            } else if moved {
                unit.mover = Mover::Path;
                unit.follow(value, time_s);
            } else if let way = superimposed.way(unit.axis)
                && way != 0.0
            {
                // Only the handwheel leads it, from where it is.
                unit.mover = Mover::Path;
                unit.follow(unit.nominal + way, time_s);
            } else {
                unit.follow(unit.nominal, time_s);
            }
        }
    }

    /// Where the path stands. After the output of a tool call that is where its element ends: the tip stands elsewhere
    /// without a movement.
    pub fn stands_at(&self) -> Position {
        let mut at = self.path.position();
        let element = self.path.element().filter(|element| element.curve == Curve::Hold);
        if let Some(element) = element.filter(|_| self.path.has_begun() && self.waiting.is_empty()) {
            for axis in element.end.known().iter() {
                at[axis] = element.end[axis];
            }
        }
        at
    }

    /// The axes stand elsewhere than the path: the PLC has moved them, corrected the datum or changed the
    /// tool length. The path then goes on from where they are, within the traverse range as it is now.
    pub fn regain(&mut self, axes: &OwnAxes, chain: &Chain) {
        // Axes that were taken over from where an EMERGENCY STOP left them go back to the path with NC start.
        if self.path.is_coupled() || axes.are_away() {
            return;
        }
        // A tool call lets the tip stand elsewhere without a movement.
        let end = match self.path.element() {
            Some(element) if element.curve == Curve::Hold => element.end,
            _ => self.path.position(),
        };
        let at = self.path.position();
        let here = chain.to_path(&axes.programmed_position());
        let differs = |a: f64, b: f64| (a - b).abs() > SAME_MM;
        let elsewhere = axes.iter().map(|unit| unit.axis).any(|axis| {
            differs(here[axis], at[axis]) && (differs(here[axis], end[axis]) || end[axis].is_nan())
        });
        let needed = elsewhere || self.range_changed;
        if !needed || !self.waiting.is_empty() || self.path.speed_mm_s() != 0.0 {
            return;
        }
        self.range_changed = false;
        self.path.recall(here);
        self.last = None;
    }

    /// Outputs the functions of the path in their order, once the axes are in position.
    pub fn output(&mut self, outputs: &mut dyn Outputs, settled: bool) {
        while let Some(output) = self.path.next_output() {
            // After a function that waits there is none before it is acknowledged.
            debug_assert!(self.waiting.len() < OUTPUTS, "the path waits at its gate");
            self.waiting.push_back(output);
            self.output_waiting(outputs, settled);
        }
        self.output_waiting(outputs, settled);
    }

    fn output_waiting(&mut self, outputs: &mut dyn Outputs, settled: bool) {
        while let Some(output) = self.waiting.front().copied() {
            if output.waits && !settled || self.refused.is_some() {
                return;
            }
            self.waiting.pop_front();
            outputs.begin(&output);
            let mut functions = self.path.functions(&output);
            // What comes after a function that is refused does not go out.
            let taken = functions.all(|function| match function.function {
                Function::Voltage(order) => {
                    outputs.voltage(order, output.sequence);
                    true
                }
                _ => outputs.output(&function.function),
            });
            self.refused = (!taken).then_some(RefusedBlock {
                block: output.block,
                sequence: output.sequence,
            });
        }
    }

    /// The feed of the element that is on its way, mm/min, `None` for rapid traverse. Where none is, that which was
    /// programmed last: it holds until another one comes, rapid traverse in its block only [003:2164].
    pub fn programmed_feed(&self) -> Option<f64> {
        let on_its_way = self.path.element().filter(|_| self.path.part() < 1.0);
        match on_its_way.map(|element| element.feed) {
            Some(FeedRate::Programmed(feed)) => Some(feed),
            Some(FeedRate::Rapid) => None,
            None => Some(self.feed),
        }
    }

    /// Another program has its own feed.
    pub fn forget_feed(&mut self) {
        self.feed = 0.0;
    }
}

/// Whether an axis moves on the circle of an element, where reversal peaks are compensated.
fn is_circular(element: &PathElement, axis: Axis) -> bool {
    let cylinder = element
        .placement
        .as_ref()
        .and_then(|placement| placement.cylinder());
    if let Some(cylinder) = cylinder {
        let own = cylinder.moved_by(axis);
        return match &element.curve {
            Curve::Arc(arc) => arc.plane.contains(own),
            Curve::Corner(_) => element.moves(own) && own.main() == Some(own),
            Curve::Line | Curve::Hold => false,
        };
    }
    match &element.curve {
        Curve::Arc(_) | Curve::Corner(_) if element.placement.is_some() => !axis.is_rotary(),
        Curve::Arc(arc) => axis == arc.plane.first || axis == arc.plane.second,
        Curve::Corner(_) => element.moves(axis) && axis.main() == Some(axis),
        Curve::Line | Curve::Hold => false,
    }
}

/// Distance that an axis has to go in an element, mm or degrees.
pub fn distance_to_go(element: &PathElement, unit: &AxisUnit, chain: &Chain) -> f64 {
    let end = chain.to_axes(&element.end)[unit.axis];
    if end.is_finite() { end - unit.nominal } else { 0.0 }
}
