//! Path elements: what the interpreter hands to motion.

use std::sync::Arc;

use crate::{Axis, Characteristic, Curve, Placement, Plane, Position, Sense, Switch, Synchronisation};

/// Where in the programs a movement comes from.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub struct BlockRef {
    /// Index of the program in the run's list of programs; 0 is the main program.
    pub program: u16,
    /// Block number of the normalised listing; BEGIN PGM is 0.
    pub block: u32,
}

/// How fast the path is programmed to run.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum FeedRate {
    /// Rapid traverse (FMAX): as fast as the axes allow.
    Rapid,
    /// Feed along the path of the tool centre, mm/min (degrees/min when only rotary axes move).
    Programmed(f64),
}

impl FeedRate {
    /// The same, but no faster along the path than a limit, mm/min; infinite without one.
    pub fn up_to(self, limit_mm_min: f64) -> FeedRate {
        match self {
            FeedRate::Rapid if limit_mm_min.is_infinite() => FeedRate::Rapid,
            FeedRate::Rapid => FeedRate::Programmed(limit_mm_min),
            FeedRate::Programmed(feed) => FeedRate::Programmed(feed.min(limit_mm_min)),
        }
    }
}

/// What the overrides may do to an element, and with it what leads its path.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub enum OverrideLaw {
    /// The feed override acts fully.
    #[default]
    Free,
    /// Tapping with a floating holder: the feed override acts only between these percentages (MP7110), that
    /// of the spindle not at all [000:6094-6098] [003:5032].
    Tapping {
        /// Lowest effective override, %.
        from_percent: f64,
        /// Highest effective override, %.
        to_percent: f64,
    },
    /// The path follows the spindle (rigid tapping): the feed override has no effect, that of the spindle
    /// acts [003:5106] [000:6122].
    Spindle(Thread),
    /// The overrides have no effect.
    Disabled,
}

/// A path that follows the angle of the spindle.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Thread {
    /// Distance along the path for a turn of the spindle, mm; positive.
    pub pitch_mm: f64,
    /// How the spindle turns along the path: clockwise as with M03.
    pub spindle: Sense,
    /// The spindle is oriented to this angle, degrees, before the path begins; otherwise it goes on from
    /// where it is: from the thread before, if there is one.
    pub orientation_deg: Option<f64>,
    /// The tool comes back out of the thread the way it went in: rigid tapping, not thread cutting.
    pub retracts: bool,
}

/// One movement: geometry, feed and the functions that go out with it. Immutable once made.
#[derive(Clone, Debug, PartialEq)]
pub struct PathElement {
    /// The block that programmed it; the call block for the movements of a cycle.
    pub block: BlockRef,
    /// Count of executed blocks up to and with this one: names the checkpoint before it.
    pub sequence: u64,
    /// Shape between `start` and `end`.
    pub curve: Curve,
    /// Start; an axis that has no position yet is NaN.
    pub start: Position,
    /// End. An axis that gets its first position by this element has it here only; it adds no length.
    pub end: Position,
    /// Feed rate of the path.
    pub feed: FeedRate,
    /// What the overrides may do.
    pub override_law: OverrideLaw,
    /// Constant path speed is kept over the corner at the *end* of the element whatever its angle
    /// (M90) [003:3439-3457].
    pub constant_speed: bool,
    /// The path continues without a corner check at the end: the joint is tangential by construction
    /// (rounding, transition arc).
    pub tangential_end: bool,
    /// The greatest feed at the end of the element, mm/min, where the path goes on, whatever the override is.
    pub end_feed: Option<f64>,
    /// Time the element takes in addition to its movement (dwell), s.
    pub dwell_s: f64,
    /// How its coordinates stand in the machine, when not upright: cycle 19, M114.
    pub placement: Option<Arc<Placement>>,
    /// Functions that go out with the element, in the order of output.
    pub functions: Option<Box<[TechnologyFunction]>>,
}

impl PathElement {
    /// A movement from a start to an end by itself: the feed override acts, corners are checked, no function goes out.
    #[inline]
    pub fn new(
        block: BlockRef,
        sequence: u64,
        curve: Curve,
        [start, end]: [Position; 2],
        feed: FeedRate,
    ) -> PathElement {
        PathElement {
            block,
            sequence,
            curve,
            start,
            end,
            feed,
            override_law: OverrideLaw::Free,
            constant_speed: false,
            tangential_end: false,
            end_feed: None,
            dwell_s: 0.0,
            placement: None,
            functions: None,
        }
    }

    /// Path length that the feed rate refers to, see [`Curve::length`].
    pub fn length(&self) -> f64 {
        self.curve.length(&self.start, &self.end)
    }

    /// Whether an axis moves.
    pub fn moves(&self, axis: Axis) -> bool {
        let (from, to) = (self.start[axis], self.end[axis]);
        match &self.curve {
            Curve::Hold => false,
            Curve::Line => to.is_finite() && from != to,
            Curve::Arc(arc) => {
                to.is_finite() && (from != to || axis == arc.plane.first || axis == arc.plane.second)
            }
            // Where an axis stands at the corner as at both ends, it stands on the whole corner.
            Curve::Corner(arc) => {
                let at_corner = arc.corner.get(axis.index()).copied();
                to.is_finite() && (from != to || at_corner.is_some_and(|corner| corner != from))
            }
        }
    }

    /// Whether an axis of the machine moves: with a placement those are others than on the path.
    pub fn moves_axis(&self, axis: Axis) -> bool {
        match &self.placement {
            None => self.moves(axis),
            Some(placement) => placement.moves(axis, |own| self.moves(own)),
        }
    }

    /// How the path follows the spindle.
    pub fn thread(&self) -> Option<&Thread> {
        match &self.override_law {
            OverrideLaw::Spindle(thread) if self.curve != Curve::Hold => Some(thread),
            _ => None,
        }
    }

    /// The functions that go out with the element.
    pub fn functions(&self) -> &[TechnologyFunction] {
        self.functions.as_deref().unwrap_or_default()
    }
}

/// A function output to the PLC or the spindle with the place on the path where it happens.
#[derive(Clone, Debug, PartialEq)]
pub struct TechnologyFunction {
    /// The function that is output.
    pub function: Function,
    /// Where on the element.
    pub at: At,
    /// Whether axes wait for the acknowledgement.
    pub synchronisation: Synchronisation,
    /// What it orders the spindle to do.
    pub spindle: Option<SpindleOrder>,
}

impl TechnologyFunction {
    /// A function that orders nothing of the spindle.
    pub fn new(function: Function, at: At, synchronisation: Synchronisation) -> TechnologyFunction {
        TechnologyFunction {
            function,
            at,
            synchronisation,
            spindle: None,
        }
    }
}

/// What a function orders the spindle to do [003:7463-7475].
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum SpindleOrder {
    /// Turn clockwise: M3, M13.
    Clockwise,
    /// Turn counter-clockwise: M4, M14.
    CounterClockwise,
    /// The spindle stops: M5.
    Stop,
    /// Stop, for the run stops or ends there: M0, M2, M6, M30.
    StopWithRun,
}

impl SpindleOrder {
    /// Turns the spindle in this sense.
    pub fn turn(sense: Sense) -> SpindleOrder {
        match sense {
            Sense::Clockwise => SpindleOrder::Clockwise,
            Sense::CounterClockwise => SpindleOrder::CounterClockwise,
        }
    }
}

/// What acts in the control when the path comes to it, and never reaches the PLC.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum ControlFunction {
    /// M105 chooses the second set of kv and reversal peaks, M106 the first [000:7251-7305].
    SecondServoSet(Switch),
    /// M101: a tool whose life is over is replaced while it works; M102: no longer [000:9175].
    ReplaceWornTools(Switch),
    /// M107: also by a larger one; M108: no longer [000:9177].
    TakeLargerTools(Switch),
}

/// Place of a function on its element.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum At {
    /// Before the movement of its element.
    Start,
    /// After the movement of its element.
    End,
    /// At a path length from the start, mm.
    Length(f64),
    /// So long before the end of the movement, s.
    BeforeEnd(f64),
    /// Ahead of the start of the movement, while the path before it is executed [004:81-90].
    Ahead(Ahead),
}

/// How far ahead of its place a function goes out.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Ahead {
    /// By a distance along the path, mm.
    Distance(f64),
    /// By a time, s.
    Time(f64),
}

impl Ahead {
    /// Whether a function goes out now whose place is so far ahead on the path, mm. `time_to` says how long the path takes to
    /// it, s, when that is not longer than asked for.
    ///
    /// ```
    /// use bahn_path::Ahead;
    /// assert!(Ahead::Distance(5.0).is_due(4.9, |_| None));
    /// // 4 mm at 10 mm/s.
    /// assert!(Ahead::Time(0.5).is_due(4.0, |_| Some(4.0 / 10.0)));
    /// assert!(!Ahead::Time(0.3).is_due(4.0, |_| Some(4.0 / 10.0)));
    /// ```
    pub fn is_due(self, to_go_mm: f64, time_to: impl FnOnce(f64) -> Option<f64>) -> bool {
        match self {
            _ if to_go_mm <= 0.0 => true,
            Ahead::Distance(lead_mm) => to_go_mm <= lead_mm,
            Ahead::Time(lead_s) => time_to(lead_s).is_some_and(|time_s| time_s <= lead_s),
        }
    }
}

/// The functions that a program can output.
#[derive(Clone, Debug, PartialEq)]
pub enum Function {
    /// Miscellaneous function M of the PLC.
    M(u16),
    /// What acts in the control: M101, M102, M105 to M108.
    Control(ControlFunction),
    /// Tool call: tool data, tool axis and spindle speed.
    Tool(ToolCall),
    /// Pre-selection of the next tool (TOOL DEF with a tool table) [003:1931-1933].
    NextTool(u32),
    /// Spindle speed alone, rpm (TOOL CALL S).
    SpindleSpeed(f64),
    /// Oriented spindle stop at an angle, degrees (M19) [003:6500-6528].
    SpindleOrientation(f64),
    /// Cycle 13: the angle, degrees, that the spindle is oriented to by whichever M function does so
    /// [000:5853-5865].
    OrientationAngle(f64),
    /// Programmed stop: STOP, M0, M1, M6 where it stops.
    Stop,
    /// FN15: PRINT, the finished output line [003:4371-4385].
    Print(Arc<str>),
    /// M200 to M204: what output S gives from here on [000:9841-9909].
    Voltage(Voltage),
    /// M118: how far the handwheel may lead each axis to either side of the path, mm or degrees; 0 not at all
    /// [000:742].
    Superimpose(Position),
    /// FN19: PLC, one or two values already in the unit of the control model [003:4387-4395].
    Plc([Option<f64>; 2]),
    /// What waits for a place of the program ([`Synchronisation::MvsSlp`]) is to be acknowledged here [004:75].
    Synchronise,
    /// The blank of the graphics (BLK FORM).
    Blank(Blank),
    /// A parameter of a System 900 that is written when the path comes to it [002:268-273].
    Write {
        /// The system parameter.
        q: u32,
        /// What it gets; `None` clears it.
        value: Option<f64>,
    },
    /// The sum of the shifts of a logical axis of a System 900, which its display leaves out from here on [002:8346-8348].
    Shift {
        /// The axis, from 1.
        logical: u8,
        /// How far, mm or degrees.
        by: f64,
    },
    /// An M function of a System 900 whose acknowledgement ends the movement of its block and jumps [002:5484-5491].
    Branch {
        /// Its number.
        m: u16,
        /// The block to jump to, of the program that it stands in, as [`BlockRef::block`] counts.
        target: u32,
    },
    /// M26 of a System 900: a signal ends the movement of its block, and the program goes on after it [002:3717-3727].
    Residual,
}

/// What output S gives for a laser or a water jet until the next one, 0 to 9.999 V [000:9841-9909].
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Voltage {
    /// M200: a voltage, V.
    Fixed(f64),
    /// M201: from the voltage before to this one, V, along the movement of the block.
    Along(f64),
    /// M202: by the velocity.
    ByVelocity(Characteristic),
    /// M203: from the voltage before to this one, V, in a time.
    Ramp {
        /// At its end, V.
        volts: f64,
        /// How long it takes, s.
        time_s: f64,
    },
    /// M204: a voltage for a time, then 0 V.
    Pulse {
        /// As long as it lasts, V.
        volts: f64,
        /// Duration of the dwell, s.
        time_s: f64,
    },
}

/// A tool call as it reaches motion, workpiece and PLC.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ToolCall {
    /// Tool number 0..254.
    pub tool: u32,
    /// Axis along which the tool lies.
    pub axis: Axis,
    /// Programmed spindle speed, rpm.
    pub speed_rpm: f64,
    /// Length, radii and point of the tool.
    pub shape: ToolShape,
    /// No block calls it: the life of the tool before is over (M101) [000:9175].
    pub at_end_of_life: bool,
}

/// Geometry of a tool.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct ToolShape {
    /// Length compensation value L, mm.
    pub length: f64,
    /// Radius R, mm.
    pub radius: f64,
    /// Corner radius R2, mm: 0 flat end, equal to `radius` ball end.
    pub corner_radius: f64,
    /// Angle of the point of a drill, degrees: 0 none. The length is that to the tip of the point.
    pub point_angle_deg: f64,
    /// The oversizes that it contains.
    pub oversize: Oversize,
}

/// DL, DR, DR2 of the tool table, mm [000:9014-9016].
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Oversize {
    /// DL: of the length.
    pub length: f64,
    /// DR: of the radius.
    pub radius: f64,
    /// DR2: of the corner radius.
    pub corner_radius: f64,
}

impl ToolShape {
    /// Sharper points count as no point (inferred), degrees.
    pub const POINT_ANGLE_MIN_DEG: f64 = 5.0;
}

/// The blank of BLK FORM: a cuboid with sides parallel to the axes [003:2105-2121].
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Blank {
    /// Working plane, from the tool axis named in BLK FORM 0.1.
    pub plane: Plane,
    /// Least corner X, Y, Z, mm.
    pub min: [f64; 3],
    /// Greatest corner X, Y, Z, mm.
    pub max: [f64; 3],
}
