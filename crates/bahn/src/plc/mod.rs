//! `bahn plc`: the PLC on a desk.
//!
//! - `options`: options and help texts;
//! - `source`: the program, compile errors as rustc prints them;
//! - `bench`: program, memory and stand-in for the control together;
//! - `live`: the program in the control of a machine; `subject`: one of the two;
//! - `check`, `run`, `trace`, `diagram`, `watch`, `list`, `xref`, `signals`: the subcommands.

#[cfg_attr(
    not(feature = "terminal"),
    expect(dead_code, reason = "what steps a program serves the screen alone")
)]
mod bench;
mod check;
mod diagram;
mod drawing;
mod failure;
mod halt;
mod list;
#[cfg_attr(
    not(feature = "terminal"),
    expect(dead_code, reason = "part of it serves the screen alone")
)]
mod live;
mod options;
mod record;
mod retained;
mod run;
mod signals;
mod source;
mod subject;
mod trace;
#[cfg(feature = "terminal")]
mod watch;
mod xref;

pub(crate) use options::PlcOptions;

use crate::{Outcome, UsageError};
use options::PlcCommand;

use retained::retained;

/// Executes a subcommand of `bahn plc`.
pub(crate) fn command(options: &PlcOptions) -> Result<Outcome, UsageError> {
    match &options.command {
        PlcCommand::Check(options) => check::command(options),
        PlcCommand::Run(options) => run::command(options),
        PlcCommand::Trace(options) => trace::command(options),
        PlcCommand::Diagram(options) => diagram::command(options),
        #[cfg(feature = "terminal")]
        PlcCommand::Watch(options) => watch::command(options),
        PlcCommand::List(options) => list::command(options),
        PlcCommand::Xref(options) => xref::command(options),
        PlcCommand::Signals(options) => signals::command(options),
    }
}
