//! Options and help texts of `bahn link`.

use std::net::SocketAddr;
use std::path::PathBuf;

use clap::{Args, Subcommand, ValueHint};

use super::dnc::DncOptions;
use super::lsv2::Lsv2Options;

/// Options of `bahn link`.
#[derive(Args, Debug)]
pub(crate) struct LinkOptions {
    #[command(subcommand)]
    pub command: LinkCommand,
}

/// What to do with the data interfaces.
#[derive(Debug, Subcommand)]
pub(crate) enum LinkCommand {
    /// Switch a machine on and let it answer on its data interfaces until Ctrl-C.
    #[command(after_help = SERVE_EXAMPLES)]
    Serve(ServeOptions),
    /// Execute programs while they are transferred: as the control, or as the computer at the other end.
    Dnc(DncOptions),
    /// Ask a control by LSV/2: files, state, screen.
    #[command(after_help = super::lsv2::EXAMPLES)]
    Lsv2(Lsv2Options),
}

const SERVE_EXAMPLES: &str = "\
Examples:
  bahn link serve --machine machines/mill --lsv2 127.0.0.1:19000
  bahn link serve --machine machines/mill --lsv2 127.0.0.1:19000 --password FILE=steel --identity iTNC530

`ready` stands on standard output when all ports are open. LSV/2 answers this computer without passwords, but for
FILEPLC, which needs 807667; at any other address each level needs one: INSPECT, DIAGNOSTICS, FILE, FILEPLC, DNC,
MONITOR, PLCDEBUG, DATA. The control says that it is BAHN and its model; some clients know a control only by the name
of a real one, which --identity gives them. Exit codes: 0 ended by Ctrl-C, 1 a port is taken, or the machine has
faults, 2 wrong use. docs/lsv2.md tells which telegrams are answered.";

/// Options of `bahn link serve`.
#[derive(Args, Debug)]
pub(crate) struct ServeOptions {
    /// Folder of the machine.
    #[arg(long, value_name = "DIR", value_hint = ValueHint::DirPath)]
    pub machine: PathBuf,
    /// Answer by LSV/2 there.
    #[arg(long, value_name = "ADDR:PORT")]
    pub lsv2: Option<SocketAddr>,
    /// Password of a level of LSV/2.
    #[arg(long = "password", value_name = "LEVEL=TEXT")]
    pub passwords: Vec<String>,
    /// What the control says by LSV/2 that it is.
    #[arg(long, value_name = "TEXT")]
    pub identity: Option<String>,
}
