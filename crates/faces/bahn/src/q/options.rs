//! Options and help texts of `bahn q`.

use std::path::PathBuf;

use clap::{Args, Subcommand, ValueHint};

use crate::options::Format;

/// Options of `bahn q`.
#[derive(Args, Debug)]
pub(crate) struct QOptions {
    #[command(subcommand)]
    pub command: QCommand,
}

/// What to do with parameters of a System 900.
#[derive(Debug, Subcommand)]
pub(crate) enum QCommand {
    /// Say what parameters mean, what a change needs, and what they do here.
    #[command(after_help = EXPLAIN_EXAMPLES)]
    Explain(ExplainOptions),
    /// Say which system parameters channel parameters are.
    #[command(after_help = MAP_EXAMPLES)]
    Map(NamesOptions),
    /// Show what parameters hold, and what their status bytes say.
    #[command(after_help = GET_EXAMPLES)]
    Get(NamesOptions),
    /// Write a data file with other values; its lines, their order and its comments stay.
    #[command(after_help = SET_EXAMPLES)]
    Set(SetOptions),
    /// Show all faults of a data file with line and column, and the axes of its channels.
    #[command(after_help = CHECK_EXAMPLES)]
    Check(FileOptions),
    /// Show in which parameters two data files differ, and what the change needs.
    #[command(after_help = DIFF_EXAMPLES)]
    Diff(DiffOptions),
    /// List the zero points of a channel.
    #[command(after_help = ZERO_EXAMPLES)]
    Zero(ChannelOptions),
    /// List the tools of a channel.
    #[command(after_help = TOOLS_EXAMPLES)]
    Tools(ChannelOptions),
    /// Show how M functions act; without one all that are defined.
    #[command(after_help = M_EXAMPLES)]
    M(MOptions),
}

const EXPLAIN_EXAMPLES: &str = "\
Examples:
  bahn q explain P12020
  bahn q explain q2360 2:P8251               a number of another axis, and one of channel 2
  bahn q explain P12160 --format json

effect: acts, partly, stored (read and kept, nothing here runs by it) or none (the manual gives no
function). needs: nothing, mode (from HAND to AUTO), restart, reset. JSON: an array of name, base (the
row that explains it), title, kind, unit, values, default, default_number, source, needs, effect,
reason, plc. Exit codes: 0 fine, 1 a number that the manual does not explain, 2 wrong use.";

const MAP_EXAMPLES: &str = "\
Examples:
  bahn q map two-channels.q P7000 2:P7000 P12150
  bahn q map two-channels.q P20000 --format json

JSON: an array of name, q, error. Exit codes: 0 fine, 1 a name that leads nowhere, or a file with
faults, 2 wrong use.";

const GET_EXAMPLES: &str = "\
Examples:
  bahn q get two-channels.q P12020 q102
  bahn q get two-channels.q P1000 --format json

JSON: an array of name, q, value, written, status, flags; the value of a cleared parameter is null.";

const SET_EXAMPLES: &str = "\
Examples:
  bahn q set two-channels.q P12020=2.5 -o faster.q
  bahn q set two-channels.q 'P1000=$1F' P7001=-- --status 'P1000=$30000001' -o changed.q

Values are decimal, $ and up to eight hexadecimal digits (in quotes, as shells read $ otherwise), or --
for a cleared parameter. A value that is refused writes nothing.
JSON: as `bahn q get` of the parameters that were given. Exit codes: 0 fine, 1 a value or a name that
is refused, or a file with faults, 2 wrong use.";

const CHECK_EXAMPLES: &str = "\
Examples:
  bahn q check two-channels.q
  bahn q check two-channels.q --format json

A line of a data file: `NAME: VALUE [STATUS]`, the status as `$` and eight hexadecimal digits. ; and
{ } are comments; blanks and case do not count in names. `q10: 99` stands before the lines of the
channels beyond the first. The last line for a number counts.
JSON: ok, errors and warnings (line, column, message), channels with their axes.
Exit codes: 0 no error, 1 errors, 2 wrong use.";

const DIFF_EXAMPLES: &str = "\
Examples:
  bahn q diff two-channels.q two-channels.q
  bahn q diff two-channels.q changed.q --format json

JSON: an array of name, q, a, b, needs. Exit codes: 0 also with differences, 1 a file with faults, 2
wrong use.";

const ZERO_EXAMPLES: &str = "\
Examples:
  bahn q zero two-channels.q
  bahn q zero two-channels.q --channel 2 --format json";

const TOOLS_EXAMPLES: &str = "\
Examples:
  bahn q tools two-channels.q
  bahn q tools two-channels.q --format json";

const M_EXAMPLES: &str = "\
Examples:
  bahn q m two-channels.q
  bahn q m two-channels.q M7 --format json
  bahn q m two-channels.q --channel 2 M234";

/// Options of `bahn q explain`.
#[derive(Args, Debug)]
pub(crate) struct ExplainOptions {
    /// Parameters, as q102, P7000 or 2:P7000.
    #[arg(value_name = "NAME", required = true)]
    pub names: Vec<String>,
    /// How the result is written.
    #[arg(long, value_name = "FORMAT", value_enum, default_value_t)]
    pub format: Format,
}

/// A data file, and how the result is written.
#[derive(Args, Debug)]
pub(crate) struct FileOptions {
    /// A data file, or the folder of a machine.
    #[arg(value_name = "FILE", value_hint = ValueHint::AnyPath)]
    pub file: PathBuf,
    /// How the result is written.
    #[arg(long, value_name = "FORMAT", value_enum, default_value_t)]
    pub format: Format,
}

/// Options of `bahn q map` and `bahn q get`.
#[derive(Args, Debug)]
pub(crate) struct NamesOptions {
    #[command(flatten)]
    pub file: FileOptions,
    /// Parameters, as q102, P7000 or 2:P7000.
    #[arg(value_name = "NAME", required = true)]
    pub names: Vec<String>,
}

/// Options of `bahn q set`.
#[derive(Args, Debug)]
pub(crate) struct SetOptions {
    #[command(flatten)]
    pub file: FileOptions,
    /// Parameters and their values, as P7000=12.5.
    #[arg(value_name = "NAME=VALUE", required_unless_present = "status")]
    pub values: Vec<String>,
    /// The status of a parameter, as P7000=$03000001 (repeatable).
    #[arg(long, value_name = "NAME=$STATUS")]
    pub status: Vec<String>,
    /// The file that is written.
    #[arg(long, short, value_name = "OUT", required = true, value_hint = ValueHint::FilePath)]
    pub output: PathBuf,
    /// Replace a file that is there.
    #[arg(long)]
    pub force: bool,
}

/// Options of `bahn q diff`.
#[derive(Args, Debug)]
pub(crate) struct DiffOptions {
    /// The first data file, or folder of a machine.
    #[arg(value_name = "A", value_hint = ValueHint::AnyPath)]
    pub a: PathBuf,
    /// The second one.
    #[arg(value_name = "B", value_hint = ValueHint::AnyPath)]
    pub b: PathBuf,
    /// How the result is written.
    #[arg(long, value_name = "FORMAT", value_enum, default_value_t)]
    pub format: Format,
}

/// Options of `bahn q zero` and `bahn q tools`.
#[derive(Args, Debug)]
pub(crate) struct ChannelOptions {
    #[command(flatten)]
    pub file: FileOptions,
    /// The channel.
    #[arg(long, value_name = "N", default_value_t = 1, value_parser = clap::value_parser!(u8).range(1..=8))]
    pub channel: u8,
}

/// Options of `bahn q m`.
#[derive(Args, Debug)]
pub(crate) struct MOptions {
    #[command(flatten)]
    pub of: ChannelOptions,
    /// M functions, as M7; all that are defined.
    #[arg(value_name = "M")]
    pub functions: Vec<String>,
}
