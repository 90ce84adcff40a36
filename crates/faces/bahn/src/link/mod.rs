//! `bahn link`: the data interfaces.
//!
//! - `options`: options and help texts;
//! - `port`: ports as they are written, opened and set up; `desk`: who attends a transfer;
//! - `transfer`: `receive`, `send` and `list`; `disk`: a floppy disk unit; `monitor`: what passes over a line;
//! - `dnc`: programs that are executed while they are transferred, from both sides;
//! - `backup`: all of a machine as one file; `print`: a picture on a printer;
//! - `serve`: a machine that answers on its interfaces, `serial_ports` the serial ones;
//! - `lsv2`: a host that asks a control by LSV/2.
//!
//! What a machine that is on does at its interfaces is [`bahn_ports`].

mod backup;
mod desk;
mod disk;
mod dnc;
mod lsv2;
mod monitor;
mod options;
mod port;
mod print;
mod serial_ports;
mod serve;
mod transfer;

pub(crate) use options::LinkOptions;

use bahn_parameters::ParameterList;
use bahn_ports::PanelPorts;

use crate::{Outcome, UsageError};
use options::LinkCommand;

/// Executes a subcommand of `bahn link`.
pub(crate) fn command(options: &LinkOptions) -> Result<Outcome, UsageError> {
    match &options.command {
        LinkCommand::Serve(options) => serve::command(options),
        LinkCommand::Receive(options) => transfer::receive(options),
        LinkCommand::Send(options) => transfer::send(options),
        LinkCommand::List(options) => transfer::list(options),
        LinkCommand::Disk(options) => disk::command(options),
        LinkCommand::Monitor(options) => monitor::command(options),
        LinkCommand::Dnc(options) => dnc::command(options),
        LinkCommand::Backup(options) => backup::backup(options),
        LinkCommand::Restore(options) => backup::restore(options),
        LinkCommand::Print(options) => print::command(options),
        LinkCommand::Lsv2(options) => lsv2::command(options),
    }
}

/// The data interfaces of a panel; `None` when one cannot be opened: why is printed.
pub(crate) fn panel_ports(named: [Option<&String>; 2], list: &ParameterList) -> Option<PanelPorts> {
    let opened = PanelPorts::open(named, list, port::tell());
    opened.map_err(port::Refused::from).ok()
}
