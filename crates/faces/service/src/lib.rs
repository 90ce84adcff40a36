//! A machine that is on, as every interface reaches it: one face below all of them.
//!
//! - [`MachineService`] is a handle on a machine that runs, for any thread: its [`State`], the memory of its PLC, its files,
//!   keys and other [`Input`]s, machine parameters, the [`Screen`] as data, [`Events`] since a number;
//! - [`Operated`] is what a page or a terminal needs of a machine of any family, [`Surface`] its keys;
//! - each handle has a [`Role`]: who may only look changes nothing, whatever he asks for;
//! - [`ServiceError`] says why something is not done; what the control says is in its own words;
//! - [`LineFeed`] is what the PLC wants of the data interfaces.
//!
//! An interface is an adapter: it knows its protocol and this room. What is one rule stands here, such as that a program that
//! runs is not replaced, which memory may be written, or who may do what.
//!
//! ```no_run
//! use bahn_service::{Input, Key, Live, MachineService, Role, Station, load};
//!
//! # fn main() -> Result<(), Box<dyn std::error::Error>> {
//! let live = Live::start(Station::power_on(load("machines/mill".as_ref())?)?);
//! let machine = MachineService::of(&live)?;
//! machine.input(Input::Key(Key::Ce))?;
//! println!("{:?}", machine.state()?.mode);
//! let looks = machine.with_role(Role::Look);
//! assert!(looks.input(Input::Key(Key::Ce)).is_err());
//! # Ok(())
//! # }
//! ```
//!
//! Nothing here knows a protocol; the time of an event is the only thing that is taken from a clock.

#![allow(
    rustdoc::broken_intra_doc_links,
    reason = "citations as [000:7188] look like links"
)]
#![cfg_attr(
    test,
    allow(clippy::unwrap_used, clippy::panic, reason = "tests fail by panic")
)]

mod error;
mod files;
mod keys;
mod lines;
mod log;
mod memory;
mod operated;
mod parameters;
mod service;
mod sight;
mod state;
mod tables;

pub use bahn_access::{Role, Tokens, is_secret};
pub use bahn_exchange::{Bit, BitArea, Content, Number, Operand, STRING_LENGTH, STRINGS, Size};
pub use bahn_panel::{
    AxisLine, BeingCut, Breakable, Dialogue, EMERGENCY_STOP, Heading, Input, InputText, Key, KeyAction,
    Language, Line, Live, MessageLine, Picture, PictureError, Press, Refusal, SHORTCUTS, Screen, Shortcut,
    SoftKeys, Star, Station, Status, Stepped, TransferAction, TransferFiles, TransferNews, TransferOrder,
    Window, WindowKind, language_code, language_of_code, load, texts_around,
};
pub use bahn_parameters::{ControlModel, ParameterList};
pub use bahn_path::Axis;
pub use bahn_plc::HostMessage;
pub use bahn_store::{Attributes, Entry, Place, Reading, Store, StoreError};
pub use bahn_tnc::{DataLineOrder, LineEvent, LineSetup, Mode, RunState};
pub use error::ServiceError;
pub use lines::{LineFeed, LineNews};
pub use log::{EVENTS, Event, EventKind, Events};
pub use operated::{Operated, Presses, Surface, SurfaceKey, SurfaceShortcut};
pub use service::{Machine, MachineService, plc_folder};
pub use state::{AxisPosition, Message, RunningBlock, SpindleState, State, Tool};
