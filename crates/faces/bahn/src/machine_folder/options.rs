//! Options and help texts of `bahn machine`.

use std::path::PathBuf;

use bahn_parameters::ControlModel;
use clap::{Args, Subcommand, ValueHint};

use crate::options::{Format, model_parser};

/// Options of `bahn machine`.
#[derive(Args, Debug)]
pub(crate) struct MachineFolderOptions {
    #[command(subcommand)]
    pub command: MachineCommand,
}

/// What to do with the folder of a machine.
#[derive(Debug, Subcommand)]
pub(crate) enum MachineCommand {
    /// Write a machine to start from: parameters, PLC program, plant, tools, programs.
    #[command(after_help = NEW_EXAMPLES)]
    New(NewOptions),
    /// Load everything in a folder, and show all faults of all files.
    #[command(after_help = CHECK_EXAMPLES)]
    Check(CheckOptions),
    /// List the terminals of the control and its boards: inputs, outputs, and what is wired to them.
    #[command(after_help = IO_EXAMPLES)]
    Io(IoOptions),
    /// List axes, keys, lamps, things and signals of a machine, and the events and commands of scripts.
    List(ListOptions),
}

const NEW_EXAMPLES: &str = "\
Examples:
  bahn machine new mymill --model tnc407
  bahn machine check mymill
  bahn run INDEX.H --machine mymill
  bahn machine new mytwin --from twin
  bahn machine new loader --model tnc360 --from module-tnc360
  bahn machine new myportal --from portal900

Models of the 400 series start from a mill with rotary table and gear spindle, the TNC 360 from a small mill without, TNC 151 and
TNC 155 from a knee mill with relay cabinet; twin is a portal mill with two channels, module-tnc360 a positioning module that goes
beside a mill, portal900 a portal with two heads and a System 900. The README.md in the folder explains every file and key.";

const CHECK_EXAMPLES: &str = "\
Examples:
  bahn machine check machines/mill
  bahn machine check machines/*/ --format json

The part programs are checked, too, for the control, the parameters and the tools of the machine.

JSON: for each folder: folder, name, model, ok, faults (severity, file, line, column, message, detail), programs
(as `bahn check --format json` has them).
Exit codes: 0 fine, 1 faults, 2 wrong use.";

const IO_EXAMPLES: &str = "\
Examples:
  bahn machine io machines/mill
  bahn machine io machines/mill --format json

The boards are those of `boards` in machine.toml; without it all that the control can have.

JSON: for each terminal: terminal (`X42/4`, on a board `PL1 X4/1`), operand (`I3`, null without one), name (what is
wired to it, null when it is free), kind (digital, relay, bipolar, analogue).
Exit codes: 0 fine, 1 the machine has faults, 2 wrong use.";

/// Options of `bahn machine io`.
#[derive(Args, Debug)]
pub(crate) struct IoOptions {
    /// Folder of the machine.
    #[arg(value_name = "DIR", value_hint = ValueHint::DirPath)]
    pub folder: PathBuf,
    /// How the terminals are written.
    #[arg(long, value_name = "FORMAT", value_enum, default_value_t)]
    pub format: Format,
}

/// Options of `bahn machine new`.
#[derive(Args, Debug)]
pub(crate) struct NewOptions {
    /// The folder; it is made, and must be empty when it is there.
    #[arg(value_name = "DIR", value_hint = ValueHint::DirPath)]
    pub folder: PathBuf,
    /// Control model of the new machine.
    #[arg(long, value_name = "MODEL", default_value_t, ignore_case = true, value_parser = model_parser())]
    pub model: ControlModel,
    /// A shipped machine by its name, instead of the usual one for the model: mill, mill-tnc360, mill-tnc155, dig425,
    /// twin, gantry, portal900.
    #[arg(long, value_name = "MACHINE")]
    pub from: Option<String>,
    /// Name for people; that of the folder without it.
    #[arg(long, value_name = "NAME")]
    pub name: Option<String>,
}

/// Options of `bahn machine check`.
#[derive(Args, Debug)]
pub(crate) struct CheckOptions {
    /// Folders of machines.
    #[arg(value_name = "DIR", required = true, value_hint = ValueHint::DirPath)]
    pub folders: Vec<PathBuf>,
    /// How faults are written.
    #[arg(long, value_name = "FORMAT", value_enum, default_value_t)]
    pub format: Format,
}

/// Options of `bahn machine list`.
#[derive(Args, Debug)]
pub(crate) struct ListOptions {
    /// Folder of the machine.
    #[arg(value_name = "DIR", value_hint = ValueHint::DirPath)]
    pub folder: PathBuf,
}
