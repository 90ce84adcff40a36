//! The simulated machine: what the control drives when no real one is there.
//!
//! [`Machine`] is a [`bahn_servo::Plant`] that can be wrong: drives have a time constant, friction and
//! offset, guideways have play, switches stick, encoders fail. It is described by one TOML file
//! ([`Machine::from_toml`]); what an operator does to it comes as [`Event`]s, also as lines of text.
//!
//! [`MachineFolder`] says which file of a machine's folder is what.
//!
//! ```
//! use bahn_machine::Machine;
//! let text = r#"
//!     name = "one axis"
//!     [emergency_stop]
//!     acknowledgement = "I3"
//!     [axis.X]
//!     output = "1"
//!     speed = 15000
//!     volts = 9
//!     encoder = { input = "X1", period_um = 20 }
//!     [keys]
//!     NC_START = "I10"
//! "#;
//! let mut machine = Machine::from_toml(text).map_err(|faults| faults[0].clone())?;
//! machine.apply("key NC_START press")?;
//! machine.advance(10_000);
//! let mut inputs = [false; bahn_servo::INPUTS];
//! machine.inputs(&mut inputs);
//! assert!(inputs[10]);
//! assert!(machine.apply("key NO_SUCH_KEY press").is_err());
//! # Ok::<(), Box<dyn std::error::Error>>(())
//! ```
//!
//! The control sees nothing but the trait. The true state ([`Machine::axis`], [`Machine::spindle`],
//! [`Machine::device`]) is for tests and recordings.
//!
//! Invariant: time passes in fixed steps only, so however [`bahn_servo::Plant::exchange`] is divided the
//! machine is the same, bit by bit; no call of the trait allocates.

mod acting;
mod axis;
mod bipolar;
mod by_hand;
mod cabinet;
mod chain;
mod circuit;
mod clock;
mod current_drive;
mod deviation;
mod device;
mod encoder;
mod equipment;
mod event;
mod folder;
mod folder900;
mod machine;
mod magazine;
mod mechanics;
mod mechanism;
mod noise;
mod panel;
mod plc_side;
mod probe;
mod reader;
mod spindle;
mod tool_probe;

pub use axis::{AxisState, DriveFault};
pub use chain::{ContactFault, Interlock, RelayFault};
pub use device::{DeviceFault, DeviceState};
pub use encoder::EncoderFault;
pub use equipment::{EquipmentFolder, Said};
pub use event::{Button, Event, EventError, Fault, KeyAction, Put};
pub use folder::{ChannelFolder, FunctionFolder, HandOverFolder, MachineFolder, ModuleFolder, OperatorKeys};
pub use folder900::{Answer900, Folder900, Plant900};
pub use machine::Machine;
pub use magazine::MagazineState;
pub use mechanics::{AxisPlace, DevicePlace, MagazinePlace, Mechanics, SpindlePlace};
pub use probe::Solid;
pub use reader::Wire;
pub use spindle::SpindleState;
