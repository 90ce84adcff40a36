//! Options and help texts of `bahn mp`.

use std::path::PathBuf;

use bahn_parameters::ControlModel;
use clap::{Args, Subcommand, ValueHint};

use crate::options::{Format, model_parser};

/// Options of `bahn mp`.
#[derive(Args, Debug)]
pub(crate) struct MpOptions {
    #[command(subcommand)]
    pub command: MpCommand,
}

/// What to do with machine parameters.
#[derive(Debug, Subcommand)]
pub(crate) enum MpCommand {
    /// Show all faults of lists, as the control does when its editor is left, and what does not go together.
    #[command(after_help = CHECK_EXAMPLES)]
    Check(CheckOptions),
    /// List parameters with value, range, unit and name.
    #[command(after_help = LIST_EXAMPLES)]
    List(ListOptions),
    /// Say what a parameter means, what it may be, what a change needs, and what it is in a list.
    #[command(after_help = EXPLAIN_EXAMPLES)]
    Explain(ExplainOptions),
    /// Show in which parameters two lists differ, what the values mean and what the change needs.
    #[command(after_help = DIFF_EXAMPLES)]
    Diff(DiffOptions),
    /// Write a complete list to start from, or complete one.
    #[command(after_help = NEW_EXAMPLES)]
    New(NewOptions),
}

const CHECK_EXAMPLES: &str = "\
Examples:
  bahn mp check mill.mp
  bahn mp check machines/mill-tnc155         list of a machine; all lists (*.mp) of a folder
  bahn mp check --partial changes.mp         a list that holds changes only
  bahn mp check mill.mp --format json

A line of a list: `MP1060.0 : 1.5   ;comment`. Values are decimal, %binary or $hexadecimal; lines
that start with ; or * are comments. Faults have the numbers of the control's editor:
  0 No MP number found      1 Invalid MP number    2 No separator \";\" found
  3 Entry value incorrect   4 MP doubly defined    5 MP not defined   6 MP can not be stored
The control refuses a list that has faults. A list without any entry is that which the control
makes by itself. The list of a machine (machine.toml beside it) may leave parameters out: they
have the values of the reference list; what takes an option or a software that the machine has not
is an error. The control model is that of --model, otherwise that of the machine in whose folder
the list lies (machine.toml), otherwise the one named in the comments at the beginning of the list
(`TNC 415 B`), otherwise tnc415b.

JSON: for each file file, model, entries, without_effect, acting_partly, errors and warnings (number,
text, parameter, line, column, length, detail). Exit codes: 0 no error, 1 errors, 2 wrong use.";

const LIST_EXAMPLES: &str = "\
Examples:
  bahn mp list                       all parameters of a TNC 415 B, values of its reference list
  bahn mp list acceleration          those with a word in name or group
  bahn mp list 1060 33               those whose number is 1060 or 33..
  bahn mp list --user --model tnc360
      Those that the operator may change, code number 123.
  bahn mp list --list mill.mp --changed
      What mill.mp sets apart from the list that the control makes by itself.
  bahn mp list --without-effect      what is read and does nothing here, or only part of it";

const EXPLAIN_EXAMPLES: &str = "\
Examples:
  bahn mp explain 1060
  bahn mp explain MP7440 --list mill.mp
  bahn mp explain 60 --model tnc155 --format json";

const DIFF_EXAMPLES: &str = "\
Examples:
  bahn mp diff old.mp new.mp
  bahn mp diff mill.mp               against the reference list of its control
  bahn mp diff old.mp new.mp --format json

Parameters that a list does not define have the value of the list that the control makes by itself;
in the list of a machine (machine.toml beside it) that of the reference list.
Exit codes: 0 no difference, 1 differences, 2 wrong use or a list with faults.";

const NEW_EXAMPLES: &str = "\
Examples:
  bahn mp new --model tnc360 -o mill.mp      the documented reference list, completed
  bahn mp new --reference-only               without the parameters that have the smallest value
  bahn mp new --smallest                     the list that the control makes by itself
  bahn mp new --from mill.mp -o mill.mp      complete mill.mp; its lines stay as they are";

/// Options of `bahn mp check`.
#[derive(Args, Debug)]
pub(crate) struct CheckOptions {
    /// Lists, or folders with lists (*.mp).
    #[arg(value_name = "FILE|DIR", required = true, value_hint = ValueHint::AnyPath)]
    pub files: Vec<PathBuf>,
    /// Control model; by default the one that the list names.
    #[arg(long, value_name = "MODEL", ignore_case = true, value_parser = model_parser())]
    pub model: Option<ControlModel>,
    /// Let parameters be missing: the list holds changes only.
    #[arg(long)]
    pub partial: bool,
    /// How faults are written.
    #[arg(long, value_name = "FORMAT", value_enum, default_value_t)]
    pub format: Format,
}

/// Which values are shown.
#[derive(Args, Debug)]
pub(crate) struct ValueOptions {
    /// Control model; by default the one that the list names, otherwise tnc415b.
    #[arg(long, value_name = "MODEL", ignore_case = true, value_parser = model_parser())]
    pub model: Option<ControlModel>,
    /// The list whose values are shown; by default the reference list of the model.
    #[arg(long, value_name = "LIST", value_hint = ValueHint::FilePath)]
    pub list: Option<PathBuf>,
    /// How the result is written.
    #[arg(long, value_name = "FORMAT", value_enum, default_value_t)]
    pub format: Format,
}

/// Options of `bahn mp list`.
#[derive(Args, Debug)]
pub(crate) struct ListOptions {
    /// Begin of a number, or words of name and group; all of them.
    #[arg(value_name = "NUMBER|WORD")]
    pub wanted: Vec<String>,
    #[command(flatten)]
    pub values: ValueOptions,
    /// Only those that the operator may change, code number 123.
    #[arg(long)]
    pub user: bool,
    /// Only those whose value is not that of the list that the control makes by itself.
    #[arg(long)]
    pub changed: bool,
    /// Only those that have no effect here, or only part of it.
    #[arg(long)]
    pub without_effect: bool,
}

/// Options of `bahn mp explain`.
#[derive(Args, Debug)]
pub(crate) struct ExplainOptions {
    /// The parameter, as 1060, 1060.2 or MP7440.
    #[arg(value_name = "NUMBER")]
    pub number: String,
    #[command(flatten)]
    pub values: ValueOptions,
}

/// Options of `bahn mp diff`.
#[derive(Args, Debug)]
pub(crate) struct DiffOptions {
    /// The first list.
    #[arg(value_name = "A", value_hint = ValueHint::FilePath)]
    pub a: PathBuf,
    /// The second list; by default the reference list of the control, which then is the first.
    #[arg(value_name = "B", value_hint = ValueHint::FilePath)]
    pub b: Option<PathBuf>,
    /// Control model; by default the one that the first list names.
    #[arg(long, value_name = "MODEL", ignore_case = true, value_parser = model_parser())]
    pub model: Option<ControlModel>,
    /// How the result is written.
    #[arg(long, value_name = "FORMAT", value_enum, default_value_t)]
    pub format: Format,
}

/// Options of `bahn mp new`.
#[derive(Args, Debug)]
pub(crate) struct NewOptions {
    /// Control model; with --from by default the one that the list names, otherwise tnc415b.
    #[arg(long, value_name = "MODEL", ignore_case = true, value_parser = model_parser())]
    pub model: Option<ControlModel>,
    /// Write to a file instead of standard output.
    #[arg(long, short, value_name = "FILE", value_hint = ValueHint::FilePath)]
    pub output: Option<PathBuf>,
    /// Only what the reference list gives a reason for.
    #[arg(long, conflicts_with_all = ["smallest", "from"])]
    pub reference_only: bool,
    /// The list that the control makes by itself: a programming station, smallest values.
    #[arg(long, conflicts_with = "from")]
    pub smallest: bool,
    /// Complete this list.
    #[arg(long, value_name = "LIST", value_hint = ValueHint::FilePath)]
    pub from: Option<PathBuf>,
}
