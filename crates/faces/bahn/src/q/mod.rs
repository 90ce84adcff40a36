//! `bahn q`: parameters of a System 900.
//!
//! - `options`: options and help texts;
//! - `source`: data files, alone or of a machine;
//! - `names`: what is said of parameters by their names: `explain`, `map`, `get`, `set`, `diff`;
//! - `check`: the faults of a file;
//! - `channel`: `zero`, `tools`, `m`.

mod channel;
mod check;
mod names;
mod options;
mod source;

pub(crate) use options::QOptions;

use crate::{Outcome, UsageError};
use options::QCommand;

/// Executes a subcommand of `bahn q`.
pub(crate) fn command(options: &QOptions) -> Result<Outcome, UsageError> {
    match &options.command {
        QCommand::Explain(options) => names::explain(options),
        QCommand::Map(options) => names::map(options),
        QCommand::Get(options) => names::get(options),
        QCommand::Set(options) => names::set(options),
        QCommand::Diff(options) => names::diff(options),
        QCommand::Check(options) => check::command(options),
        QCommand::Zero(options) => channel::zero(options),
        QCommand::Tools(options) => channel::tools(options),
        QCommand::M(options) => channel::m(options),
    }
}
