//! What the interpolator gets, and what it answers.

use bahn_path::{AxisSet, Barrier, BlockRef, Position};

use crate::gate::Gate;

/// How the path is to be driven in a cycle.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Drive {
    /// Feed override, 0 to 150 % [003:1135-1145].
    pub feed_override_percent: f64,
    /// Override of rapid traverse, %; more than 100 % is without effect as MP1010 limits.
    pub rapid_override_percent: f64,
    /// Programmed feeds that the override moves freely count as rapid traverse: the rapid button of a TNC 151/155
    /// [001:465-469].
    pub rapid: bool,
    /// Override of the spindle, %, as it acts on its speed: for elements that follow the spindle.
    pub spindle_override_percent: f64,
    /// The spindle, for elements that follow it.
    pub master: Master,
    /// An element that follows the spindle goes back, to its start.
    pub back: bool,
    /// No axis is faster than this, mm/min, nor than its rapid traverse MP1010 [000:4812-4814].
    pub rapid_limit_mm_min: f64,
    /// NC stop: the path brakes to a standstill, wherever that is, and goes on when this ends.
    pub hold: bool,
    /// The path stops at the end of each block and waits for [`Interpolator::go_on`](crate::Interpolator::go_on).
    pub single_block: bool,
    /// The path stops as in single block after the last block before the one with this sequence, if it still can.
    pub stop_before: Option<u64>,
    /// All functions that went out are acknowledged: what is not stops the path where it is
    /// [late](bahn_path::Synchronisation::MvsSns).
    pub acknowledged: bool,
    /// The axes are in position (MP1030): where the path stops, the next element waits for it
    /// [000:5302-5318].
    pub in_position: bool,
    /// Axes that are clamped: an element that moves one of them does not begin [000:5407].
    pub clamped: AxisSet,
    /// Axes that are to be clamped: the path waits at the end of a block that moved one of them
    /// [000:5407].
    pub clamping: AxisSet,
}

impl Default for Drive {
    fn default() -> Self {
        Drive {
            feed_override_percent: 100.0,
            rapid_override_percent: 100.0,
            rapid: false,
            spindle_override_percent: 100.0,
            master: Master::default(),
            back: false,
            rapid_limit_mm_min: f64::INFINITY,
            hold: false,
            single_block: false,
            stop_before: None,
            acknowledged: true,
            in_position: true,
            clamped: AxisSet::EMPTY,
            clamping: AxisSet::EMPTY,
        }
    }
}

/// The spindle as the master of a path. Its angles count on over full turns, degrees, positive as M03.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Master {
    /// Where it is held while it stands: a path that begins to follow it counts from here.
    pub nominal_deg: f64,
    /// Where it will be at the end of the cycle.
    pub actual_deg: f64,
    /// It may be led: an element that begins to follow it waits until then.
    pub ready: bool,
}

/// What a path that follows the spindle wants of it for the end of a cycle.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Lead {
    /// Nominal angle on the scale of [`Master`], degrees.
    pub angle_deg: f64,
    /// Nominal speed, rpm; positive as M03.
    pub rpm: f64,
}

/// Where the path is after a cycle.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Cycle {
    /// Nominal position on the path.
    pub position: Position,
    /// Path speed at the end of the cycle, mm/s.
    pub speed_mm_s: f64,
    /// What the spindle is to do that the path follows.
    pub lead: Option<Lead>,
    /// What the path does.
    pub state: State,
}

/// What the path does at the end of a cycle.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum State {
    /// It moves, or would with an override that is not 0.
    Moving,
    /// It stands because of [`Drive::hold`].
    Held,
    /// It stands for the dwell of an element.
    Dwell,
    /// It stands until [`Interpolator::release`](crate::Interpolator::release).
    Gate(Gate),
    /// It stands at the end of a block until [`Interpolator::go_on`](crate::Interpolator::go_on) (single block).
    BlockEnd,
    /// It stands at the end of an element until the axes are in position.
    Settling,
    /// It stands before an element that waits for functions until they are [acknowledged](Drive::acknowledged).
    Awaiting,
    /// It stands before an element that moves one of [`Drive::clamped`].
    Clamped,
    /// It stands before an element that follows the spindle until that is [ready](Master::ready).
    Master,
    /// It stands at the end of a block that moved one of [`Drive::clamping`].
    Clamping,
    /// All elements are executed; [`Interpolator::prepare`](crate::Interpolator::prepare) may bring more.
    Empty,
    /// All elements are executed and the source has said why no more come: [`Interpolator::take_stop`](crate::Interpolator::take_stop).
    Stopped,
}

/// Functions to be output to the PLC or the spindle now.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct FunctionOutput {
    /// Number of the element, see [`Interpolator::functions`](crate::Interpolator::functions).
    pub element: u64,
    /// The block of the element.
    pub block: BlockRef,
    /// Its count of executed blocks.
    pub sequence: u64,
    /// Which of its functions.
    pub place: Place,
    /// The path stands until [`Interpolator::release`](crate::Interpolator::release).
    pub waits: bool,
}

/// The place on an element where functions are output.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Place {
    /// All functions before the movement.
    Start,
    /// The function of this index among all of the element, in the midst of the movement.
    Along(usize),
    /// All functions after the movement.
    End,
}

/// Why no more elements come, once all before are executed.
#[allow(
    clippy::large_enum_variant,
    reason = "one at a time, and no cycle allocates: a scan goes with its barrier"
)]
#[derive(Clone, Debug, PartialEq)]
pub enum Stop<E> {
    /// The source waits for live data: [`Interpolator::resume`](crate::Interpolator::resume).
    Barrier(Barrier),
    /// The program has ended.
    End,
    /// The program cannot go on.
    Error(E),
}

/// What [`Interpolator::prepare`](crate::Interpolator::prepare) has come to.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Prepared {
    /// The budget is used up.
    Budget,
    /// There is no room for more elements.
    Full,
    /// The source has nothing yet.
    Starved,
    /// The source waits, has ended or failed: see [`Stop`].
    Closed,
}

/// The place on the path where an internal stop has cut it.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Cut {
    /// The block of the element.
    pub block: BlockRef,
    /// Its count of executed blocks: names the checkpoint before it.
    pub sequence: u64,
    /// Path length of the element that was covered, mm.
    pub covered_mm: f64,
    /// Path length that was left, mm.
    pub rest_mm: f64,
    /// Nominal position, mm or degrees.
    pub position: Position,
}

/// The end of an element that the path came to in a cycle.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Passed {
    /// Its count of executed blocks.
    pub sequence: u64,
    /// So long before the end of the cycle, s.
    pub left_s: f64,
    /// Path speed there, mm/s.
    pub speed_mm_s: f64,
}
