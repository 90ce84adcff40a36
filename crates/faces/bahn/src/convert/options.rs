//! Options and help texts of `bahn convert`.

use std::path::PathBuf;

use bahn_parameters::ControlModel;
use bahn_report::convert::Target;
use clap::{Args, ValueEnum, ValueHint};

use crate::options::{Format, MachineOptions, RunOptions, model_parser};

pub(crate) const EXAMPLES: &str = "\
Examples:
  bahn convert part.h --to iso
      Write PART in DIN/ISO beside it, part.I, and prove that both do the same.
  bahn convert examples/plate.I --to plain -o plate.H
  bahn convert examples/housing.H --to gcode -o housing.ngc
      The path that it moves, for LinuxCNC: arcs and helices stay arcs, everything else is unrolled.
  bahn convert examples/family.H --to iso --with-calls -o iso
      With the programs that it calls, into a folder.
  bahn convert parts --to iso -o parts-iso --format json
      All programs of a folder; those that are in DIN/ISO already are left out.

Block by block: what a block says is written in the other language, with comments, labels,
calls, Q parameters, cycles and transformations. Calls by file name follow the programs that are
converted with it. What the target cannot say is listed with block, text and reason. If the
program comes to its end, it is then unrolled: written as the path that it moves, in the target
language (--no-unroll keeps its blocks and puts an ERROR block, which no control passes, in
place of each that cannot be said).

Proof: source and target are run side by side, with the same parameters, tools and Q parameters:
every element of the path (kind, start, end, centre, length to 1 um; feed to 0.1 %), every
function, stop and warning, and the message at the end. A target that differs is not written.
Probes answer half way in both. A path that depends on a probe is not written for LinuxCNC.

Files: an input is never replaced, another file only with --replace. Exit codes: 0 converted and
proved, 1 something is refused, differs or is not proved, 2 wrong use.

JSON report (--format json): ok, blocks, unrolled, refused and left_out (block, line, text,
reason; left_out is what the path does not depend on), not_unrolled (why, or null), proof
(elements, functions, stops, warnings, max_deviation_um, message, completed, first_difference: what,
source and target with program, block, line, text; or null), source, target (null when nothing
was written), to. Of several programs: ok, programs.";

/// Options of `bahn convert`.
#[derive(Args, Debug)]
pub(crate) struct ConvertOptions {
    /// The part program, or a folder of them.
    #[arg(value_name = "FILE|FOLDER", value_hint = ValueHint::AnyPath)]
    pub input: PathBuf,
    /// The language to write.
    #[arg(long, value_name = "LANGUAGE", value_enum)]
    pub to: TargetOption,
    /// The file to write, or the folder; beside the input with another ending by default, - for standard output.
    #[arg(long, short, value_name = "OUT", value_hint = ValueHint::AnyPath)]
    pub output: Option<PathBuf>,
    /// Convert the programs that it calls, too; the output is then a folder.
    #[arg(long)]
    pub with_calls: bool,
    /// Replace files that stand there already; never an input.
    #[arg(long)]
    pub replace: bool,
    /// Prove that source and target do the same: the default.
    #[arg(long, overrides_with = "no_prove")]
    pub prove: bool,
    /// Write without proving that source and target do the same.
    #[arg(long)]
    pub no_prove: bool,
    /// Keep the blocks of a program that cannot be said as a whole, with ERROR blocks.
    #[arg(long)]
    pub no_unroll: bool,
    /// G-code without the source blocks as comments.
    #[arg(long)]
    pub no_comments: bool,
    /// G-code with the machine builder's functions M00 to M99 as M100 to M199, which LinuxCNC gives to programs of its
    /// user, instead of stops.
    #[arg(long)]
    pub user_functions: bool,
    /// Step of the block numbers of DIN/ISO programs, 0 writes none; by default MP7220 of a machine or a list that is
    /// given, else 10.
    #[arg(long, value_name = "STEP")]
    pub iso_step: Option<u8>,

    /// Control model whose limits and cycles apply.
    #[arg(long, value_name = "MODEL", default_value_t, ignore_case = true, value_parser = model_parser())]
    pub model: ControlModel,
    /// How the report is written.
    #[arg(long, value_name = "FORMAT", value_enum, default_value_t)]
    pub format: Format,
    #[command(flatten)]
    pub machine: MachineOptions,
    #[command(flatten)]
    pub run: RunOptions,
}

/// A language to write.
#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
pub(crate) enum TargetOption {
    /// HEIDENHAIN plain language.
    Plain,
    /// DIN/ISO.
    Iso,
    /// RS-274/NGC for LinuxCNC.
    Gcode,
}

impl From<TargetOption> for Target {
    fn from(option: TargetOption) -> Target {
        match option {
            TargetOption::Plain => Target::Plain,
            TargetOption::Iso => Target::Iso,
            TargetOption::Gcode => Target::Gcode,
        }
    }
}
