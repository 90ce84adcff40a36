//! The parameters of a System 900, as data: the table of what each number means, the memory that holds them, the files that
//! give them values.
//!
//! The face of this room:
//! - [`Name`], [`Value`], [`Status`]: how people write a parameter, what it is given, what its status bytes say;
//! - [`rows`] and [`row`]: the table, [`Row`], with what each parameter does here, [`Effect`], and what a change
//!   [`Needs`];
//! - [`Memory`]: system parameters, and the channel parameters that are places among them;
//! - [`DataFile`]: a file with a line for each parameter, its faults, and its [`Change`]s; [`check`] says what of it does
//!   not go together;
//! - [`Explanation`], [`Mapped`], [`Held`], [`differences`]: what is said of parameters by their names;
//! - [`ZeroPoints`], [`Tools`], [`MFunction`]: what parameters of a channel say together;
//! - [`Traffic`]: what goes between a control that runs, its PLC, its panel and its programs, recorded as [`Event`]s;
//! - [`Marker`], [`Direction`]: what of them is exchanged with the PLC.
//!
//! ```
//! use bahn_system900::{DataFile, check, row};
//!
//! let file = DataFile::read(b"q102: 10000\nq103: 5000\nq110: $01010058\nP12020: 1.5\nP12220: 2\n");
//! assert_eq!(row("q2020".parse()?).map(|row| row.title), Some("Kv factor"));
//! assert_eq!(file.memory().cell("q2020".parse()?)?.number(), Some(1.5));
//! let faults = check(&file).faults;
//! assert_eq!(faults[0].to_string(), "5:1: P12220: logical axis 2 of channel 1 is no physical axis, q111");
//! # Ok::<(), Box<dyn std::error::Error>>(())
//! ```
//!
//! The table is the control: whoever wants to know what a number means asks its row, and no number stands outside of this room.
//! Nothing here moves an axis.

#![allow(
    rustdoc::broken_intra_doc_links,
    reason = "citations as [002:403] look like links"
)]

mod array;
mod axis_block;
mod battery;
mod channel_block;
mod channels;
mod check;
mod descriptor;
mod edit;
mod events;
mod file;
mod flash;
mod live;
mod lock;
mod locks;
mod m_functions;
mod m_table;
mod markers;
mod memory;
mod messages;
mod name;
mod networks;
mod numbered;
mod numbers;
mod path_data;
mod programs;
mod reports;
mod shared_block;
mod shown;
mod slots;
mod start;
mod status;
mod table;
mod tool_blocks;
mod tools;
mod traffic;
mod units;
mod value;
mod zero;

pub use array::{Cell, PARAMETERS_MAX, PARAMETERS_MIN};
pub use axis_block::{AxisBlock, AxisParameter, Connection};
pub use channel_block::ChannelParameter;
pub use channels::Channels;
pub use check::{Channel, ChannelAxis, Checked, check};
pub use descriptor::AxisWord;
pub use edit::Change;
pub use events::{Depth, Event, EventBuffer, Key, Partner, Record};
pub use file::DataFile;
pub use flash::{
    Flash, FlashError, FlashFunction, FlashScene, Listing, NoFlash, STORED_BYTES_MAX, STORED_MAX, Switches,
};
pub use live::Meaning;
pub use lock::Lock;
pub use locks::{Locks, Part, Writer, refusing};
pub use m_functions::{Acts, M_MAX, MFunction, MRule, m_number};
pub use m_table::MTable;
pub use markers::{Direction, Marker, MarkerPart, NoMarker, marker_names};
pub use memory::{Memory, Place, SpaceError};
pub use messages::{
    Message, MessageKind, MessageWord, NamedMessage, Pending, acknowledges_with_mode, named_message,
    named_messages,
};
pub use name::{Name, NoName};
pub use networks::{Together, network, together};
pub use path_data::{PathData, ToolBlock};
pub use programs::{NoProgramName, ProgramName, Programs};
pub use reports::{Difference, Explanation, Flags, Held, Mapped, differences};
pub use shared_block::{CouplingBlock, HandwheelBlock, SharedParameter, SpindleBlock};
pub use shown::{BlockState, BlockWords};
pub use slots::{LOGICAL_AXES, slots};
pub use start::{Reset, waits_for_key};
pub use status::{LOCKS, NoStatus, Receivers, Status};
pub use table::{Effect, Needs, Row, row, rows};
pub use tools::{Tool, Tools};
pub use traffic::Traffic;
pub use units::Unit;
pub use value::{DECIMALS_MAX, Value, ValueError};
pub use zero::{ZeroPoint, ZeroPoints};
