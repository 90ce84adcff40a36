//! Options and help texts of `bahn oem`.

use std::path::PathBuf;

use clap::{Args, Subcommand, ValueHint};

use crate::options::Format;

/// Options of `bahn oem`.
#[derive(Args, Debug)]
pub(crate) struct OemOptions {
    #[command(subcommand)]
    pub command: OemCommand,
}

/// What to do with cycles of the machine builder.
#[derive(Debug, Subcommand)]
pub(crate) enum OemCommand {
    /// List the cycles 68 to 99 of a machine with their dialogue texts.
    #[command(after_help = LIST_EXAMPLES)]
    List(ListOptions),
    /// Write cycles, dialogues, messages and PLC program as S records for an EPROM.
    #[command(after_help = EXPORT_EXAMPLES)]
    Export(ExportOptions),
    /// Verify S records and show, or write, the files that are in them.
    #[command(after_help = IMPORT_EXAMPLES)]
    Import(ImportOptions),
}

const LIST_EXAMPLES: &str = "\
Examples:
  bahn oem list machines/mill
  bahn oem list machines/mill --format json

A cycle is the program 99999968.H to 99999999.H of the program memory, or of the folder eprom in it. Its texts are
the lines of `plc_dialogues` of machine.toml: dialogue n is line n+1, at most 34 characters. Of two with the same number
that of the EPROM counts, with MP7240 = 1 that of the program memory; the other one is said to be hidden. The parameters
of a DLG-DEF cycle count from Q[1 + MP7250]. The marker inhibits the cycle of the EPROM.
JSON: for each cycle number, file, memory, hidden, acts (at_call, at_definition), name, parameters (q, dialogue, text),
inhibit and faults. Exit codes: 0 no fault, 1 faults, 2 wrong use.";

const EXPORT_EXAMPLES: &str = "\
Examples:
  bahn oem export machines/mill EPROM.TXT --output EPROM.S3
  bahn oem export machines/mill EPROM.TXT          checks the list and prints the records

The list is that of the soft key OUTPUT BINARY CODE 0001:
  IDENT  123 456 99
  SIZE 2MB
  LOAD   MAIN.PLC /M
  LOAD   MAIN.ER1
  LOAD   999 999 68.H
IDENT is first; SIZE 2MB takes the larger EPROM; /M names the main file of the PLC program. Files are those of the folder
of the PLC program, of the program memory, of the folder eprom in it and of the folder of the machine, in this order;
upper and lower case are the same. Programs of cycles are checked as `bahn oem list` does. The records are EXORMAX S3;
what lies where in the EPROM is Bahn's own, since no manual says it.";

const IMPORT_EXAMPLES: &str = "\
Examples:
  bahn oem import EPROM.S3                         what is in it
  bahn oem import EPROM.S3 --to eprom              writes the files into a folder that is there

Each record is verified by its length, address and check sum. Files that are there are not replaced without --force.";

/// Options of `bahn oem list`.
#[derive(Args, Debug)]
pub(crate) struct ListOptions {
    /// Folder of the machine.
    #[arg(value_hint = ValueHint::DirPath)]
    pub machine: PathBuf,
    /// How the list is written.
    #[arg(long, value_enum, default_value_t = Format::Text)]
    pub format: Format,
}

/// Options of `bahn oem export`.
#[derive(Args, Debug)]
pub(crate) struct ExportOptions {
    /// Folder of the machine.
    #[arg(value_hint = ValueHint::DirPath)]
    pub machine: PathBuf,
    /// List with IDENT, SIZE and LOAD.
    #[arg(value_hint = ValueHint::FilePath)]
    pub list: PathBuf,
    /// File of the records; without it they are printed.
    #[arg(long, short, value_hint = ValueHint::FilePath)]
    pub output: Option<PathBuf>,
}

/// Options of `bahn oem import`.
#[derive(Args, Debug)]
pub(crate) struct ImportOptions {
    /// File of the records.
    #[arg(value_hint = ValueHint::FilePath)]
    pub records: PathBuf,
    /// Folder for the files.
    #[arg(long, value_hint = ValueHint::DirPath)]
    pub to: Option<PathBuf>,
    /// Replace files that are there.
    #[arg(long, requires = "to")]
    pub force: bool,
}
