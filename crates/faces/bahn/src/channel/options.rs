//! Options and help texts of `bahn channel`.

use std::path::PathBuf;

use clap::{Args, Subcommand, ValueHint};

use crate::options::Format;

/// Options of `bahn channel`.
#[derive(Args, Debug)]
pub(crate) struct ChannelOptions {
    #[command(subcommand)]
    pub command: ChannelCommand,
}

/// What to do with channel parameters.
#[derive(Debug, Subcommand)]
pub(crate) enum ChannelCommand {
    /// Show all faults of lists with line and column, and what does not go together.
    #[command(after_help = CHECK_EXAMPLES)]
    Check(CheckOptions),
    /// Say what a parameter, a synchronisation type or a value means; without one list all.
    #[command(after_help = EXPLAIN_EXAMPLES)]
    Explain(ExplainOptions),
    /// Write a list to start from: every parameter with what it means.
    #[command(after_help = NEW_EXAMPLES)]
    New(NewOptions),
}

const CHECK_EXAMPLES: &str = "\
Examples:
  bahn channel check glue.lis
  bahn channel check glue.lis --format json

A line of a list is a name and a value: `m_synch[25] 0x00000002 MVS_SVS`. Values are decimal, 0x
hexadecimal, names, or constants joined by |: `PLC_INFO | MVS_SVS`. # and ; begin comments, what
stands after a value is a remark, lines of `:` or `...` stand for lines that are left out.
Spellings of the manual are read alike: spindel and spindle, log_achs_nr and log_achs_no,
main_spindle_gear_change and main_spdl_gear_change, late_sync_ready with and without
`prog_start.`, the forms of start-up lists (`configuration.channel[0].`). Lines of the axis list
may stand after `spindel[i].`. Of two lines for the same parameter the later one counts.

JSON of one list: {\"ok\", \"errors\": [{\"line\", \"column\", \"message\"}], \"warnings\": [...]}, lines
and columns from 1 on; of several lists an array of these with \"file\". Exit codes: 0 no error, 1
errors, 2 wrong use.";

const EXPLAIN_EXAMPLES: &str = "\
Examples:
  bahn channel explain                     all parameters and types in a line each
  bahn channel explain m_synch
  bahn channel explain P-CHAN-00274
  bahn channel explain MVS_SNS
  bahn channel explain 0x00020002          what a value of a list means
  bahn channel explain m_pre_outp --format json";

const NEW_EXAMPLES: &str = "\
Examples:
  bahn channel new -o my.lis
  bahn channel new                           the list on the screen

All lines are commented out: the list is that of a channel without an entry.";

/// Options of `bahn channel check`.
#[derive(Args, Debug)]
pub(crate) struct CheckOptions {
    /// Lists of channel parameters.
    #[arg(value_name = "FILE", required = true, value_hint = ValueHint::FilePath)]
    pub files: Vec<PathBuf>,
    /// How faults are written.
    #[arg(long, value_name = "FORMAT", value_enum, default_value_t)]
    pub format: Format,
}

/// Options of `bahn channel explain`.
#[derive(Args, Debug)]
pub(crate) struct ExplainOptions {
    /// A name, P-CHAN-00041, MVS_SVS or 0x00020002; everything.
    #[arg(value_name = "NAME|ID|VALUE")]
    pub wanted: Option<String>,
    /// How the result is written.
    #[arg(long, value_name = "FORMAT", value_enum, default_value_t)]
    pub format: Format,
}

/// Options of `bahn channel new`.
#[derive(Args, Debug)]
pub(crate) struct NewOptions {
    /// Write to a file instead of standard output.
    #[arg(long, short, value_name = "FILE", value_hint = ValueHint::FilePath)]
    pub output: Option<PathBuf>,
    /// Replace a file that is there.
    #[arg(long, requires = "output")]
    pub force: bool,
}
