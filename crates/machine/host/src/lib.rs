//! The host: a machine that is switched on, driven cycle by cycle, observed, and kept over power-off.
//!
//! ```
//! use std::{path::Path, sync::Arc};
//! use bahn_host::{Attendance, FolderPrograms, Host, Job, LoadedMachine, Next, Notice, Operator, PowerOn};
//!
//! # fn main() -> Result<(), Box<dyn std::error::Error>> {
//! let folder = Path::new(concat!(env!("CARGO_MANIFEST_DIR"), "/../../../machines/mill"));
//! let machine = LoadedMachine::load(folder)?.map_err(|faults| faults[0].message.clone())?;
//! let programs = FolderPrograms::new(&folder.join("programs"), Some(Path::new("CIRCLE.H")))?;
//! let job = programs.main_name().map(Job::whole);
//! let operator = Operator::new(Attendance::Full, machine.folder.operator.clone(), job);
//! let mut host = Host::new(&machine, PowerOn::fresh(&machine), Arc::new(programs), operator)?;
//! let mut notices = host.notices();
//! let mut ended = false;
//! while !ended {
//!     host.step()?;
//!     ended = notices.any(|next| matches!(next, Next::Item(stamped) if stamped.notice == Notice::Ended));
//! }
//! # Ok(())
//! # }
//! ```
//!
//! - [`LoadedMachine`] is everything in the folder of a machine, with all faults of all files at once
//!   ([`bahn_text::Diagnostic`]); [`FolderPrograms`] are its part programs;
//! - [`PowerOn`] is what it begins with, [`Host`] the machine that is on: [`Host::step`] is a contour cycle, by
//!   whichever [`Clock`]; its plant is the simulated machine of the folder or whatever is [`Operable`], [`AnyPlant`] where
//!   nobody needs to know which;
//! - a [`Action`] is done at once ([`Host::act`]) or ordered for a time, from any thread ([`Desk`]), by a
//!   [`Source`]; a [`Sink`] logs it; an [`Operator`] stands by; a [`Script`] is [played](Play);
//! - any number of [`Reader`]s follow [`Notice`]s and snapshots; who is slow is told how much he missed;
//! - [`Saved`] is a moment to go back to, a [`Timeline`] many of them: [`Host::replay`] reaches any moment again, also of
//!   another [`Course`] that was kept;
//! - an [`ExecutedPath`] hands out the elements of the path when they are executed;
//! - [`State`] is what survives power-off: it is on the medium before the control goes on;
//! - a [`backup`] is a machine as one text;
//! - [`oem_cycles`] are the cycles of the machine builder, [`eprom`] what of them and of the PLC is put into an EPROM, as
//!   [`s_records`];
//! - [`files`] reads programs and tables and writes files that are whole or not there; [`lists`] and
//!   [`PlcSource`] say where in a file of machine parameters or of a PLC program a fault is.
//!
//! Nothing is printed here: what there is to be said is data, its words are the caller's.

#![allow(
    rustdoc::broken_intra_doc_links,
    reason = "citations as [000:7188] look like links"
)]

mod action;
mod any_plant;
pub mod backup;
mod called;
mod columns;
mod edges;
pub mod eprom;
mod error;
mod executed_path;
mod expectation;
mod feed;
mod feeds;
pub mod files;
mod host;
mod hosted;
mod journal;
mod kept;
mod log;
pub mod logic_diagram;
mod machine_folder;
mod moment;
mod notice;
mod observable;
pub mod oem_cycles;
mod of_module;
mod operable;
mod operator;
mod orders;
pub mod oscilloscope;
mod pace;
mod play;
mod plc_source;
pub mod pocket_table;
pub mod point_table;
mod power_on;
mod retained;
pub mod s_records;
mod saved;
mod script;
mod simulated;
mod system900;
mod table_edit;
mod table_kind;
mod threads;
mod tnc;
pub mod tool_table;

pub use action::{Action, ActionError, Answer, Source};
pub use any_plant::AnyPlant;
/// What a plant takes and answers, for whoever writes one.
pub use bahn_machine::{DeviceState, Event, KeyAction, MagazineState, Mechanics, ModuleFolder};
/// What the times of a script count from.
pub use bahn_script::Base;
pub use columns::{Cell, TextRow, TextTable, canonical};
pub use edges::Edges;
pub use error::HostError;
pub use executed_path::{ElementId, ExecutedPath};
pub use expectation::{Expectation, Presence, Relation, Run, Tested, run_name};
pub use feed::{Next, Reader};
pub use host::{Host, HostFamily};
pub use hosted::{Executes, HostNotice, Hosted, Prepared};
pub use log::{Log, LogFile, Sink, is_whole};
pub use machine_folder::{FolderPrograms, Found, LoadedChannel, LoadedMachine, State, tools_fit};
pub use machine_folder::{read_remembered, write_remembered};
pub use threads::{ThreadCut, Threads};
/// Reads a tool table, for fuzzing; errors name their lines, 0 is the table as a whole.
#[doc(hidden)]
pub fn check_tool_table(text: &str) -> Result<(), Vec<u32>> {
    let faults = |faults: Vec<bahn_text::Diagnostic>| faults.iter().map(|fault| fault.span.line).collect();
    tool_table::parse(text).map(drop).map_err(faults)
}

/// Reads a script for the machine of a description and for the bench of the PLC, for fuzzing; errors name their lines.
#[doc(hidden)]
pub fn check_script(
    machine: &bahn_machine::Machine,
    parameters: &bahn_parameters::ParameterList,
    bytes: &[u8],
) -> [Result<(), Vec<u32>>; 2] {
    [Stage::machine(machine, parameters), Stage::bench(parameters)].map(|stage| {
        let faults =
            |faults: Vec<bahn_text::Diagnostic>| faults.iter().map(|fault| fault.span.line).collect();
        stage
            .script(std::path::Path::new("SCRIPT"), bytes)
            .map(drop)
            .map_err(faults)
    })
}

pub use bahn_exchange::{Assignment, Content, Operand};
#[doc(hidden)]
pub use machine_folder::{check_nc_tables, check_state};
pub use notice::{Notice, Stamped, Why};
pub use observable::{Decimals, MagazineTruth, Observable, Observed, Truth};
pub use operable::{Operable, StopChain, TrueAxis, Wired};
pub use operator::{Attendance, Job, Operator, Phase};
pub use orders::{Desk, Order, When};
pub use pace::{Clock, Late, Lateness};
pub use play::{Case, FailedExpectation, Play, Scripted, Verdict};
pub use plc_source::PlcSource;
pub use power_on::{ChannelPowerOn, PowerOn};
pub use retained::Retained;
pub use saved::{Course, Saved, Timeline};
pub use script::{Line, Script, ScriptAction, Stage};
pub use system900::{
    Action900, By, Command900, Expectation900, Flash900, Host900, IdealMachine, Job900, Machine900,
    Notice900, Operator900, PowerOn900, Programs900, Script900, Stage900, State900, reference_drives,
};
pub use table_edit::{LineChange, delete_line, set_line, with_column};
pub use table_kind::{Content as CellContent, KnownColumn, PlainTable, TableForm};
