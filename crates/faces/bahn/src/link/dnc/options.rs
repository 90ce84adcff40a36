//! Options and help texts of `bahn link dnc`.

use std::path::PathBuf;

use clap::{Args, Subcommand, ValueHint};

use crate::options::Format;

/// Options of `bahn link dnc`.
#[derive(Args, Debug)]
pub(crate) struct DncOptions {
    #[command(subcommand)]
    pub command: DncCommand,
}

/// The side of a transfer that the command is.
#[derive(Debug, Subcommand)]
pub(crate) enum DncCommand {
    /// Execute a program on a simulated machine while it is transferred.
    #[command(after_help = RUN_EXAMPLES)]
    Run(Box<DncRunOptions>),
    /// Send programs of a folder to controls that execute them while they come.
    #[command(after_help = SEND_EXAMPLES)]
    Send(DncSendOptions),
}

const RUN_EXAMPLES: &str = "\
Examples:
  bahn link dnc run --machine machines/mill --port connect:127.0.0.1:4711 15.H
      Ask the device there for program 15 and execute it as it comes; docs/dnc.md tells what may stand in it.
      With --port serial:/dev/ttyUSB0,mode=ext1,baud=38400 the port is that of this computer, set up by MP5020.0 and
      MP5200.0 to MP5210.0 of the machine; --restarts 3 asks again three times after a broken line.

The operator who stands by is that of `bahn run`, but a programmed stop waits; --confirm-stops confirms it, too. While the
memory of MP7228.1 kByte is full no block is acknowledged. The machine waits for the line without spending time of its own, but for
--realtime: then the path slows down and stands where the line is too slow.

JSON report (--format json): one object in one line: program, completed, blocks (that were acknowledged), executed (blocks), position
(of the workpiece, mm and degrees, by axis letter), message (null, or the one that stands), machining_time_s.

Exit codes: 0 the program has come to its end, 1 a message stands: the line was broken and what had come is executed, the program
has an error, or the device refuses it; 2 wrong use, 130 ended by Ctrl-C.";

const SEND_EXAMPLES: &str = "\
Examples:
  bahn link dnc send --dir parts --port tcp:127.0.0.1:4711 15.H
      Answer the header for program 15, and end when it has arrived. Without a name any program of the folder can be asked for,
      until Ctrl-C; --port serial:/dev/ttyUSB0,mode=fe1,baud=19200 is what stands in for a floppy unit at a real machine.

With names only these programs can be asked for; a header without a name gets the next one by name. When the line drops, one of
tcp:, pty or serial: waits for the next header; one of connect: connects again, tried twice a second for --again seconds. A transfer that was broken off
begins anew with the next header, since controls pass over what they have; --resume begins with BEGIN PGM and the first block that was
not acknowledged.

JSON (--format json): one object in each line: event (begin, progress, end, broken), program, blocks (that are in the machine),
percent; the last one has event done, and blocks of all programs.

Exit codes: 0 all that was named has arrived, 1 the line or the folder does not work, or is not there again; 2 wrong use, 130 ended by Ctrl-C.";

/// Options of `bahn link dnc run`.
#[derive(Args, Debug)]
pub(crate) struct DncRunOptions {
    /// The program, as 15.H.
    #[arg(value_name = "NAME")]
    pub name: String,
    /// Folder of the machine.
    #[arg(long, value_name = "DIR", value_hint = ValueHint::DirPath)]
    pub machine: PathBuf,
    /// The port of the device.
    #[arg(long, value_name = "SPEC")]
    pub port: String,
    /// How the report is written.
    #[arg(long, value_name = "FORMAT", value_enum, default_value_t)]
    pub format: Format,
    /// Press START again so often when the line is broken.
    #[arg(long, value_name = "N", default_value_t = 0)]
    pub restarts: u32,
    /// Start with this block instead of the first: earlier ones are ignored.
    #[arg(long, value_name = "N")]
    pub start_block: Option<u32>,
    /// Single block instead of full sequence.
    #[arg(long)]
    pub single_block: bool,
    /// NC start also after programmed stops.
    #[arg(long)]
    pub confirm_stops: bool,
    /// Begin without what survives power-off, and keep nothing.
    #[arg(long)]
    pub fresh: bool,
    /// One machine parameter instead of that of the list, as 7228.1=10 (repeatable, or several with commas).
    #[arg(long = "mp", value_name = "N=V", value_delimiter = ',')]
    pub mp: Vec<String>,
    /// Keep pace with real time.
    #[arg(long)]
    pub realtime: bool,
}

/// Options of `bahn link dnc send`.
#[derive(Args, Debug)]
pub(crate) struct DncSendOptions {
    /// Programs, as 15.H; without any all of the folder.
    #[arg(value_name = "NAME")]
    pub names: Vec<String>,
    /// Folder of the programs.
    #[arg(long, value_name = "DIR", value_hint = ValueHint::DirPath)]
    pub dir: PathBuf,
    /// The port of the control.
    #[arg(long, value_name = "SPEC")]
    pub port: String,
    /// List of the machine parameters that set EXT1 and EXT2 up, those of the control.
    #[arg(long, value_name = "LIST.mp", value_hint = ValueHint::FilePath)]
    pub parameters: Option<PathBuf>,
    /// How progress is written.
    #[arg(long, value_name = "FORMAT", value_enum, default_value_t)]
    pub format: Format,
    /// A port that connects is tried again for so long when the line has dropped.
    #[arg(long, value_name = "SECONDS", default_value_t = 60)]
    pub again: u64,
    /// Go on with the first block that was not acknowledged when a program is asked for again.
    #[arg(long)]
    pub resume: bool,
}
