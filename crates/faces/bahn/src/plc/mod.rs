//! `bahn plc`: the PLC on a desk.
//!
//! - `options`: options and help texts;
//! - `source`: the program, compile errors as rustc prints them;
//! - `bench`: from options to a program on its bench; `live`: to one in the control of a machine; `subject`: one of the two;
//! - `check`, `run`, `trace`, `diagram`, `watch`, `list`, `xref`, `signals`, `standard`: the subcommands.
//!
//! What runs and is told of it is [`bahn_report::plc`].

mod bench;
mod check;
mod diagram;
mod list;
mod live;
mod options;
mod retained;
mod run;
mod signals;
mod source;
mod standard;
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
        PlcCommand::Standard(options) => standard::command(options),
    }
}
