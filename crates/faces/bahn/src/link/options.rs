//! Options and help texts of `bahn link`.

use std::net::SocketAddr;
use std::path::PathBuf;

use clap::{Args, Subcommand, ValueHint};

use super::backup::{BackupOptions, RestoreOptions};
use super::desk::Answer;
use super::disk::DiskOptions;
use super::dnc::DncOptions;
use super::lsv2::Lsv2Options;
use super::monitor::MonitorOptions;
use super::print::PrintOptions;
use super::transfer::{ListOptions, TransferOptions};

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
    /// Read files in as a control does, or store what a control sends.
    #[command(after_help = super::transfer::RECEIVE_EXAMPLES)]
    Receive(TransferOptions),
    /// Send files as a control does, or give a control what it reads in.
    #[command(after_help = super::transfer::SEND_EXAMPLES)]
    Send(TransferOptions),
    /// Ask a device for its directory, as a control does.
    #[command(after_help = super::transfer::LIST_EXAMPLES)]
    List(ListOptions),
    /// Be a floppy disk unit: a folder as its disk.
    #[command(after_help = super::disk::EXAMPLES)]
    Disk(DiskOptions),
    /// Show what passes over a line.
    #[command(after_help = super::monitor::EXAMPLES)]
    Monitor(MonitorOptions),
    /// Execute programs while they are transferred: as the control, or as the computer at the other end.
    Dnc(DncOptions),
    /// Back up all files of a machine as one.
    #[command(after_help = super::backup::BACKUP_EXAMPLES)]
    Backup(BackupOptions),
    /// Restore a machine from such a file.
    #[command(after_help = super::backup::RESTORE_EXAMPLES)]
    Restore(RestoreOptions),
    /// Print a picture as the TNC 155 prints its graphics.
    #[command(after_help = super::print::EXAMPLES)]
    Print(PrintOptions),
    /// Ask a control by LSV/2: files, state, screen.
    #[command(after_help = super::lsv2::EXAMPLES)]
    Lsv2(Lsv2Options),
}

const SERVE_EXAMPLES: &str = "\
Examples:
  bahn link serve --machine machines/mill --lsv2 127.0.0.1:19000
  bahn link serve --machine mill --lsv2 127.0.0.1:19000 --password FILE=steel --identity iTNC530
  bahn link serve --machine machines/mill --rs232 tcp:127.0.0.1:4713,mode=fe2 --answer yes
  bahn link serve --machine mill --rs232 pty:rs232,mode=ext1,baud=9600 --rs422 tcp:127.0.0.1:4714

`ready` stands on standard output when all ports are open. LSV/2 answers this computer without passwords, but for
FILEPLC, which needs 807667; at any other address each level needs one: INSPECT, DIAGNOSTICS, FILE, FILEPLC, DNC,
MONITOR, PLCDEBUG, DATA. The control says that it is BAHN and its model; some clients know a control only by the name
of a real one, which --identity gives them. A serial port obeys what arrives: it gives and stores files by the protocol
of its mode, and ENQ between transfers begins LSV/2 (docs/link.md). Exit codes: 0 ended by Ctrl-C, 1 a port is taken, or the machine has
faults, 2 wrong use. docs/lsv2.md tells which telegrams are answered.";

/// Options of `bahn link serve`.
#[derive(Args, Debug)]
pub(crate) struct ServeOptions {
    /// Folder of the machine.
    #[arg(long, value_name = "DIR", value_hint = ValueHint::DirPath)]
    pub machine: PathBuf,
    /// Let RS-232-C/V.24 answer there.
    #[arg(long, value_name = "SPEC")]
    pub rs232: Option<String>,
    /// Let RS-422/V.11 answer there.
    #[arg(long, value_name = "SPEC")]
    pub rs422: Option<String>,
    /// What is answered to ERASE/OVERREAD when a file comes by a serial port.
    #[arg(long, value_name = "WHAT", value_enum, default_value_t)]
    pub answer: Answer,
    /// Where FN15 prints: rs232, rs422, or a file to which lines are added. At a port digitizing prints, too.
    #[arg(long, value_name = "WHERE")]
    pub print: Option<String>,
    /// Write down what passes over the serial ports.
    #[arg(long, value_name = "FILE", value_hint = ValueHint::FilePath)]
    pub trace: Option<PathBuf>,
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
