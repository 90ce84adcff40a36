//! Motion: how fast the path runs and how long it takes.
//!
//! - [`Planner`] pulls path elements from an [`ElementSource`](bahn_path::ElementSource), looks ahead
//!   as far as the braking distance needs, and hands out each element as [`Planned`] with its speed
//!   [`Profile`]; barriers, starvation, end and error come after everything before them, which is then
//!   planned to a stop;
//! - [`Limits`] says what the machine can do: feed limits, accelerations, corners, overrides;
//! - [`AuxiliaryTimes`] says how long tool changes, spindle starts and M functions take;
//! - [`Sampler`] walks the planned path in contour cycles through [`Kinematics`];
//! - [`Interpolator`] does the same online: overrides, NC stop, single block and acknowledgements come at
//!   any moment, and no cycle allocates;
//! - [`PointToPoint`] moves one axis by itself, for jog, reference run and PLC positioning.
//!
//! The rules of planning:
//! - along the path the smallest acceleration (MP1060) of the moving axes is effective, on the rising
//!   and on the falling slope [000:4749];
//! - the speed never exceeds the programmed feed times the override, the rapid traverse of any moving
//!   axis (MP1010), nor on circles `sqrt(radius * MP1070)` [000:5080-5086];
//! - corners up to MP7460, and with M90 in operation with servo lag all corners, are passed at constant
//!   speed, as far as the servo follows the step of velocity ([`SERVO_WINDOW_S`]); the path stops at all
//!   others [000:5094-5114] [003:3421-3461];
//! - a path that follows the spindle accelerates no faster than the spindle (MP3410.3) and stops at both ends;
//! - every axis stays below `sqrt(MP1060² + MP1070²)`, seen in contour cycles; at corners that are passed
//!   its steps of velocity do so, seen in the servo's window.
//!
//! Public faces speak of mm, degrees, s and mm/min; speeds inside a profile are mm/s. Where only rotary
//! axes move, read degrees for mm. One m/s² is 1000 mm/s², and 1000 degrees/s² on a rotary axis
//! (inferred: the manual gives m/s² for all five axes [000:4790-4797]).
//!
//! ```
//! use bahn_motion::{AuxiliaryTimes, Limits, PlannedStep, Planner};
//! # use bahn_path::*;
//! # struct Program(Option<PathElement>);
//! # impl ElementSource for Program {
//! #     type Error = ();
//! #     fn next(&mut self) -> Step<()> { self.0.take().map_or(Step::End, Step::Element) }
//! #     fn resume(&mut self, _: LiveData) {}
//! # }
//! # let mut end = Position::ZERO;
//! # end[Axis::X] = 100.0;
//! # let program = Program(Some(PathElement {
//! #     block: BlockRef::default(), sequence: 1, curve: Curve::Line, start: Position::ZERO, end,
//! #     feed: FeedRate::Programmed(6000.0), override_law: OverrideLaw::Free, constant_speed: false,
//! #     tangential_end: false, end_feed: None, dwell_s: 0.0, placement: None, functions: None,
//! # }));
//! let limits = Limits {
//!     max_feed_mm_min: PerAxis::splat(15_000.0),
//!     acceleration_m_s2: PerAxis::splat(1.0),
//!     radial_acceleration_m_s2: 0.5,
//!     corner_angle_deg: 10.0,
//!     servo_lag: true,
//!     cycle_s: 0.003,
//!     servo_window_s: bahn_motion::SERVO_WINDOW_S,
//!     spindle: Default::default(),
//!     feed_override_percent: 100.0,
//!     rapid_override_percent: 100.0,
//! };
//! // The program is one block: L X+100 F6000, from standstill to standstill.
//! let mut planner = Planner::new(program, &limits, &AuxiliaryTimes::default());
//! let mut time_s = 0.0;
//! while let PlannedStep::Element(planned) = planner.next() {
//!     time_s += planned.duration_s();
//! }
//! // 100 mm at 100 mm/s, and 0.1 s more for the two ramps of 0.1 s.
//! assert!((time_s - 1.1).abs() < 1e-12);
//! ```

mod allowed;
mod braking;
mod clone_within;
mod connect;
mod corner;
mod drive;
mod envelope;
mod gate;
mod interpolator;
mod item;
mod joints;
mod late;
mod limits;
mod motion;
mod placed;
mod planner;
mod point_to_point;
mod profile;
mod ramp;
mod ring;
mod sampler;
mod scan;
mod segments;
mod stretch;
mod times;
mod wanted;
mod window;

pub use corner::SERVO_WINDOW_S;
pub use drive::{Cut, Cycle, Drive, FunctionOutput, Lead, Master, Passed, Place, Prepared, State, Stop};
pub use gate::Gate;
pub use interpolator::Interpolator;
pub use limits::{GEARS, Limits, SpindleGear};
pub use planner::{Planned, PlannedStep, Planner};
pub use point_to_point::{Aim, PointToPoint};
pub use profile::Profile;
pub use sampler::{Identity, Kinematics, Sample, Sampler};
pub use scan::{Scan, ScanStep, Sense};
pub use times::AuxiliaryTimes;
pub use window::MAX_LOOK_AHEAD;
