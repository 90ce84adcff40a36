//! Options and help texts of `bahn table`.

use std::path::PathBuf;

use clap::{Args, Subcommand, ValueEnum, ValueHint};

use crate::options::Format;

/// Options of `bahn table`.
#[derive(Args, Debug)]
pub(crate) struct TableOptions {
    #[command(subcommand)]
    pub command: TableCommand,
}

/// What to do with tables.
#[derive(Debug, Subcommand)]
pub(crate) enum TableCommand {
    /// Show a table in columns.
    #[command(after_help = SHOW_EXAMPLES)]
    Show(ShowOptions),
    /// Show all faults of tables.
    #[command(after_help = CHECK_EXAMPLES)]
    Check(CheckOptions),
    /// Change a line of a table.
    #[command(after_help = SET_EXAMPLES)]
    Set(SetOptions),
    /// Write a table in another format.
    #[command(after_help = CONVERT_EXAMPLES)]
    Convert(ConvertOptions),
}

const SHOW_EXAMPLES: &str = "\
Examples:
  bahn table show machines/mill              the tool table, with the columns that MP7266 shows
  bahn table show machines/mill --all        with all columns that it has
  bahn table show tool.t --format json
  bahn table show tool.t --format csv

Of a machine the tables are as its control remembers them: pockets after variable coding, tool lives, what
the PLC wrote. --kind chooses the table: tool, pocket, datum, pallet. The columns of its tool table are those of
MP7266 in their order, those of its pocket table those of MP7267; a list in which all are 0 shows them all.
The kind of a file is that of its ending (.T .TCH .D .P .PNT), else of its frame (BEGIN TOOL .T MM), else of its
columns. JSON: file, kind, unit, rows (line, and a key for each column).";

const CHECK_EXAMPLES: &str = "\
Examples:
  bahn table check tool.t
  bahn table check machines/mill             all tables of the machine, against its parameters
  bahn table check tool.t --format json

A file is checked by itself. The tables of a machine are checked against it, too: the size of the tool table
(MP7260), of the magazine (MP7261), of datum tables and pallet files (MP7226), the pockets beside special tools
(MP7264). JSON: for each file file, kind, rows and faults (line, column, message). Exit codes: 0 no fault,
1 faults, 2 wrong use.";

const SET_EXAMPLES: &str = "\
Examples:
  bahn table set tool.t 1 L=80.45 R2=0.5
  bahn table set tool.t 7 L=110 R=3.4 NAME=\"DRILL D6.8\"     a new line
  bahn table set tool.t 2 --delete

The line is that of the tool, pocket, datum, pallet or point with this number. The rest of the file stays as it
is. The new table is checked first, then it replaces the file in one step: at any moment the file is the old
table or the new one. A machine reads it when it is switched on. Tables that MP7224.1 of their machine protects
are not changed.";

const CONVERT_EXAMPLES: &str = "\
Examples:
  bahn table convert tool.t                  as the control writes it, on standard output
  bahn table convert tool.t --to tsv -o tools-of-mine.tsv
  bahn table convert tool.t --all-columns --to csv -o tools.csv

Formats: control (columns under their names, BEGIN and [END]), tsv, csv. Without --to it is that of the ending
of --output. Lengths of a table in inches become millimetres; columns get the names of the control (CUT. of
later ones is CUT). An existing file is replaced only with --force.";

/// A kind of table.
#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
pub(crate) enum KindOption {
    /// Tool table.
    Tool,
    /// Pocket table.
    Pocket,
    /// Datum table.
    Datum,
    /// Pallet file.
    Pallet,
    /// Point table.
    Point,
}

/// How a table is shown.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, ValueEnum)]
pub(crate) enum ShowFormat {
    /// Columns for people.
    #[default]
    Text,
    /// JSON for programs.
    Json,
    /// Fields with commas between them.
    Csv,
    /// Fields with tabs between them.
    Tsv,
}

/// How a table is written.
#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
pub(crate) enum WriteFormat {
    /// As the files of controls are.
    Control,
    /// Fields with tabs between them.
    Tsv,
    /// Fields with commas between them.
    Csv,
}

/// Options of `bahn table show`.
#[derive(Args, Debug)]
pub(crate) struct ShowOptions {
    /// The table, or the folder of a machine.
    #[arg(value_name = "FILE|DIR", value_hint = ValueHint::AnyPath)]
    pub table: PathBuf,
    /// Kind of the table; of a machine the tool table by default.
    #[arg(long, value_name = "KIND", value_enum)]
    pub kind: Option<KindOption>,
    /// Show all columns, also those that the list of the machine hides.
    #[arg(long)]
    pub all: bool,
    /// How it is shown.
    #[arg(long, value_name = "FORMAT", value_enum, default_value_t)]
    pub format: ShowFormat,
}

/// Options of `bahn table check`.
#[derive(Args, Debug)]
pub(crate) struct CheckOptions {
    /// Tables, or folders of machines.
    #[arg(value_name = "FILE|DIR", required = true, value_hint = ValueHint::AnyPath)]
    pub tables: Vec<PathBuf>,
    /// Kind of the tables, when their names and columns do not tell it.
    #[arg(long, value_name = "KIND", value_enum)]
    pub kind: Option<KindOption>,
    /// How faults are written.
    #[arg(long, value_name = "FORMAT", value_enum, default_value_t)]
    pub format: Format,
}

/// Options of `bahn table set`.
#[derive(Args, Debug)]
pub(crate) struct SetOptions {
    /// File of the table.
    #[arg(value_name = "FILE", value_hint = ValueHint::FilePath)]
    pub table: PathBuf,
    /// Number of the tool, pocket, datum, pallet or point.
    #[arg(value_name = "NUMBER")]
    pub line: String,
    /// Columns with their new values.
    #[arg(value_name = "COLUMN=VALUE", required_unless_present = "delete")]
    pub values: Vec<String>,
    /// Remove the line.
    #[arg(long, conflicts_with = "values")]
    pub delete: bool,
    /// Kind of the table, when its name and columns do not tell it.
    #[arg(long, value_name = "KIND", value_enum)]
    pub kind: Option<KindOption>,
}

/// Options of `bahn table convert`.
#[derive(Args, Debug)]
pub(crate) struct ConvertOptions {
    /// File of the table.
    #[arg(value_name = "FILE", value_hint = ValueHint::FilePath)]
    pub table: PathBuf,
    /// Format; by default that of the ending of --output.
    #[arg(long, value_name = "FORMAT", value_enum)]
    pub to: Option<WriteFormat>,
    /// Write to a file instead of standard output.
    #[arg(long, short, value_name = "FILE", value_hint = ValueHint::FilePath)]
    pub output: Option<PathBuf>,
    /// Take in every column that a control knows.
    #[arg(long)]
    pub all_columns: bool,
    /// Replace the output when it is there.
    #[arg(long)]
    pub force: bool,
    /// Kind of the table, when its name and columns do not tell it.
    #[arg(long, value_name = "KIND", value_enum)]
    pub kind: Option<KindOption>,
}
