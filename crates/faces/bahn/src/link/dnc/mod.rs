//! `bahn link dnc`: blockwise transfer with execution, as the control and as its peripheral.
//!
//! - `options`: options and help texts; `port`: the port as it is written, opened;
//! - `run`: a machine executes a program while it is transferred; its loop is [`bahn_ports::dnc`], `report` what is said in the
//!   end;
//! - `send`: a folder of programs for a control that does.

mod options;
mod port;
mod report;
mod run;
mod send;

pub(crate) use options::DncOptions;

use crate::{Outcome, UsageError};
use options::DncCommand;

/// Runs one of the commands.
pub(crate) fn command(options: &DncOptions) -> Result<Outcome, UsageError> {
    match &options.command {
        DncCommand::Run(options) => run::command(options),
        DncCommand::Send(options) => send::command(options),
    }
}
