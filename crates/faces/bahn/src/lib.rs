//! The command line of Bahn: thin, it wires the rooms together.
//!
//! The face of this room is [`run`]: it takes the arguments of the command `bahn` and returns its exit
//! code. `bahn --help` shows the subcommands, `bahn help test` the options of the test run with examples.
//!
//! ```
//! let code = bahn::run(["bahn", "mp", "explain", "1060"].map(Into::into));
//! assert_eq!(code, std::process::ExitCode::SUCCESS);
//! ```
//!
//! Where things are:
//! - `cli`: options and help texts; `settings` turns them into the settings of the other rooms;
//! - `test_run` and `shelf`: programs without a machine, one or many; `cutting`: pictures of the part;
//! - `technology`: programs with functions that the path waits for;
//! - `run`: a program on the simulated machine, `scope` draws what was recorded, `machine_folder` makes and
//!   checks folders of machines;
//! - `convert`: programs in another language, with the proof that they do the same;
//! - `check`, `format`, `explain`, `conformance`, `manual`: the other subcommands; `plc`, `mp` and `table`: the
//!   groups `bahn plc`, `bahn mp`, `bahn table`, `channel` is `bahn channel`, `q` is `bahn q`; `link`: the data interfaces;
//!   `lsp`: the language server;
//! - `torture`: the fault campaign, `faults` the table it holds the control to;
//! - `files`: outputs that replace no input;
//! - `style`: colours; `progress`: how far a run is;
//! - `diagnostics`: errors as rustc prints them; `console`: standard output that may close;
//!   `refused` and `reports`: what cannot be done, as JSON.
//!
//! What is found out and told of programs is [`bahn_report`]: here it is asked for, shown and written.
//!
//! Exit codes: 0 fine, 1 the program has an error, 2 wrong use, 130 ended by Ctrl-C.

mod channel;
mod check;
mod cli;
mod compensate;
mod conformance;
mod console;
mod convert;
mod cutting;
mod diagnostics;
mod explain;
mod faults;
mod files;
mod format;
mod interrupt;
mod link;
mod lsp;
mod machine_folder;
mod manual;
mod mp;
mod oem;
mod options;
mod outcome;
mod panel;
mod plc;
mod progress;
mod q;
mod refused;
mod reports;
mod run;
mod scope;
mod settings;
mod shelf;
mod style;
mod table;
mod technology;
mod test_run;
mod torture;
mod tune;

#[doc(hidden)]
pub use bahn_host::{check_nc_tables, check_script, check_state, check_tool_table};
#[doc(hidden)]
pub use bahn_report::scope::check_recording;

use std::ffi::OsString;
use std::process::ExitCode;

use outcome::{Outcome, UsageError};

/// Executes the command line and prints what it has to say.
///
/// The first argument is the name of the command, as in [`std::env::args_os`].
pub fn run(arguments: impl IntoIterator<Item = OsString>) -> ExitCode {
    let arguments: Vec<OsString> = arguments.into_iter().collect();
    refused::begin(&arguments);
    let outcome = cli::parse(arguments).map_or_else(|outcome| outcome, execute);
    if outcome != Outcome::Fine
        && let Some(reported) = refused::end()
    {
        // Whoever has closed the output knows.
        let _ = console::print_json(&reported);
    }
    outcome.into()
}

/// Executes a command, and tells why it cannot be.
fn execute(command: cli::Command) -> Outcome {
    let result = match command {
        cli::Command::Test(options) => test_run::command(*options, shelf::command),
        cli::Command::Run(options) => run::command(&options),
        cli::Command::Panel(options) => panel::command(&options),
        cli::Command::Scope(options) => scope::command(&options),
        cli::Command::Tune(options) => tune::command(&options),
        cli::Command::Compensate(options) => compensate::command(&options),
        cli::Command::Machine(options) => machine_folder::command(&options),
        cli::Command::Check(options) => check::command(&options),
        cli::Command::Fmt(options) => format::command(&options),
        cli::Command::Convert(options) => convert::command(&options),
        cli::Command::Plc(options) => plc::command(&options),
        cli::Command::Mp(options) => mp::command(&options),
        cli::Command::Channel(options) => channel::command(&options),
        cli::Command::Q(options) => q::command(&options),
        cli::Command::Lsp(options) => lsp::command(&options),
        cli::Command::Technology(options) => technology::command(&options),
        cli::Command::Oem(options) => oem::command(&options),
        cli::Command::Table(options) => table::command(&options),
        cli::Command::Link(options) => link::command(&options),
        cli::Command::Conformance(options) => conformance::command(&options),
        cli::Command::Faults(options) => faults::command(&options),
        cli::Command::Torture(options) => torture::command(&options),
        cli::Command::Explain(options) => explain::command(&options),
        cli::Command::Completions(options) => manual::completions(&options, cli::whole_command()),
        cli::Command::Man(options) => manual::man(&options, cli::whole_command()),
    };
    result.unwrap_or_else(|error| {
        diagnostics::print_usage_error(&error.to_string());
        Outcome::WrongUse
    })
}

impl From<Outcome> for ExitCode {
    fn from(outcome: Outcome) -> ExitCode {
        ExitCode::from(outcome.code())
    }
}
