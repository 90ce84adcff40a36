//! What every contouring control has in common, whatever family it is of: axes in their loops, and the way of a path from a
//! program to them. It knows no marker of a PLC, no operating mode and no number of a machine parameter.
//!
//! - [`Clock`] orders what happens in servo step and contour cycle; a [`Family`] of controls is what decides in it, and
//!   [`Core`] what it gives to the kernel: axes and circuit.
//! - [`AxisUnit`] is an axis of the machine, [`Axes`] all of them, [`OwnAxes`] those that a channel moves; [`gantry`] couples
//!   slaves to their masters; [`EmergencyStop`] is the circuit that lets them move at all.
//! - [`Feeder`] pulls a program from its [`Reader`](bahn_reader::Reader) and refuses what leaves the traverse range; [`Track`]
//!   moves the axes along the path and says when a function is to be output ([`Outputs`]).
//! - [`Run`] is the run of a program on its track: start, stop, single block, end, [return](Restoration) to the contour. A
//!   [`RunFamily`] says where it acts and takes its functions; its [`Demands`] come as data.
//! - [`probing`] and [`ScanMove`] lead a stylus; [`move_by_hand`], [`Leaning`], [`reference`] and [`Positioning`] single axes.
//!   [`LagWatch`] watches their lag, [`is_within_range`] where they are. [`StylusLead`] and [`probing_speed`] are how fast, [`DriveOffsets`] adjusts those of the drives.
//! - [`block_search`] passes over what stands before the block with which a run begins.
//! - [`gates`] are the places of a path where functions go out and where it waits for them.
//! - [`Kinematics`] is how axes stand when the tool is at a place; a [`Chain`] adds [`Offsets`] and what is
//!   [`Superimposed`] by hand.
//! - [`Progress`] is how far a run is, [`BlockTime`] how fast blocks are read, [`VoltageOutput`] a voltage along the path.
//!
//! ```
//! use std::sync::Arc;
//!
//! use bahn_kernel::{Cartesian, Chain, Offsets};
//! use bahn_path::{Axis, Position};
//!
//! // Datum at machine 100 in X; a tool of 80 mm in Z.
//! let mut datum = Position::ZERO;
//! datum[Axis::X] = 100.0;
//! let offsets = Offsets { datum, tool_axis: Axis::Z, tool_length: 80.0 };
//! let chain = Chain::new(Arc::new(Cartesian), offsets);
//! let axes = chain.to_axes(&Position::ZERO);
//! assert_eq!((axes[Axis::X], axes[Axis::Z]), (100.0, 80.0));
//! assert_eq!(chain.to_path(&axes)[Axis::X], 0.0);
//! ```

mod area;
mod axes;
mod axis;
pub mod block_search;
mod block_time;
mod by_hand;
mod clock;
mod drive_offsets;
mod emergency;
mod feeder;
pub mod gantry;
pub mod gates;
mod kinematics;
mod lag_watch;
mod leaning;
pub mod loops;
mod now;
mod ordered_axis;
mod path_limits;
mod per_channel;
mod positioning;
pub mod probing;
pub mod probing_speed;
mod progress;
pub mod reference;
mod restore;
mod run;
mod run_family;
mod sampling;
mod scanning;
mod spindle;
mod straight;
mod stylus_lead;
mod superimposing;
pub mod thread;
pub mod touched;
mod track;
mod voltage;
mod way_back;

pub use area::is_within_range;
pub use axes::{Axes, OwnAxes, first_ids, machine_position, path_positions, units};
pub use axis::{AxisId, AxisUnit, Coupling, Mover, Operation};
pub use block_time::BlockTime;
pub use by_hand::{AtLimit, HandMove, look_at_limit, move_by_hand, within};
pub use clock::{CircuitOrder, Clock, Core, Family};
pub use drive_offsets::DriveOffsets;
pub use emergency::{Circuit, EmergencyStop};
pub use feeder::{Feeder, RunFault, program_error};
pub use kinematics::{Box2, Cartesian, Chain, Kinematics, Offsets, Shares, along_path};
pub use lag_watch::{LagRule, LagWatch};
pub use leaning::{Leaning, MAIN, Wish};
pub use now::Now;
pub use ordered_axis::AxisOrder;
pub use path_limits::path_limits;
pub use per_channel::PerChannel;
pub use positioning::{Goal, Positioning};
pub use progress::{Progress, RunState};
pub use restore::{Restoration, ScanEnd};
pub use run::{BrokenOff, Came, Run, Started};
pub use run_family::{Acting, Demands, RunFamily};
pub use sampling::{ServoSampler, ServoSignal, ServoView};
pub use scanning::{Felt, ScanMove};
pub use spindle::{SpindleLoop, SpindleWiring};
pub use straight::Straight;
pub use stylus_lead::StylusLead;
pub use superimposing::{Superimposed, Wheels};
pub use thread::{Leading, Preparation, Standing, Tapping, Taps, is_floating, is_rigid};
pub use track::{LOOK_AHEAD, Outputs, RefusedBlock, Track, distance_to_go};
pub use voltage::{Along, VoltageOutput};
pub use way_back::WayBack;
