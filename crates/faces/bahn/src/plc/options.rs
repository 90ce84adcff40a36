//! Options and help texts of `bahn plc`.

use std::path::{Path, PathBuf};

use bahn_parameters::ControlModel;
use clap::{Args, Subcommand, ValueHint};

use crate::options::{Format, model_parser};
use bahn_host::Operand;

/// Options of `bahn plc`.
#[derive(Args, Debug)]
pub(crate) struct PlcOptions {
    #[command(subcommand)]
    pub command: PlcCommand,
}

/// What to do with a PLC program.
#[derive(Debug, Subcommand)]
pub(crate) enum PlcCommand {
    /// Compile: all errors of all files in one pass, length of the code, nominal time of a cycle.
    #[command(after_help = CHECK_EXAMPLES)]
    Check(CheckOptions),
    /// Run cycle by cycle against inputs from the command line or a script, and check what comes out.
    #[command(after_help = RUN_EXAMPLES)]
    Run(RunOptions),
    /// Show every executed line of one cycle with operand, logic and word accumulator.
    #[command(after_help = TRACE_EXAMPLES)]
    Trace(TraceOptions),
    /// Draw up to 16 operands over up to 1024 cycles.
    #[command(after_help = DIAGRAM_EXAMPLES)]
    Diagram(DiagramOptions),
    /// Watch and set operands while the program runs or is stepped (full screen).
    #[cfg(feature = "terminal")]
    #[command(after_help = WATCH_KEYS)]
    Watch(WatchOptions),
    /// Print the program as formatted listing, with errors below their lines.
    List(ListOptions),
    /// Show where operands and labels are used; which are not, and which are written twice.
    #[command(after_help = XREF_EXAMPLES)]
    Xref(XrefOptions),
    /// List the fixed markers and words with who sets and resets them.
    #[command(after_help = SIGNALS_EXAMPLES)]
    Signals(SignalsOptions),
    /// Print the PLC program that a TNC 151 or TNC 155 is delivered with.
    #[command(after_help = STANDARD_EXAMPLES)]
    Standard(StandardOptions),
}

const STANDARD_EXAMPLES: &str = "\
Examples:
  bahn plc standard
  bahn plc standard -o MAIN.PLC
  bahn plc check MAIN.PLC --model tnc155
      The standard program as a file to begin a program of one's own with.

A machine runs it with plc = \"standard\" in machine.toml; docs/tnc155.md tells its terminals.";

const CHECK_EXAMPLES: &str = "\
Examples:
  bahn plc check MAIN.PLC
  bahn plc check MAIN.PLC --model tnc407 --format json
  bahn plc check MAIN.PLC --parameters machine.MP

JSON: ok, errors and warnings (number, file, line, column, message; a thousand of each at most, then also
not_listed; of a System 900 also machine, what does not go together with its window), size_bytes, nominal_percent (100 % are 5 ms). Files that the program links with USES lie beside the main file, or in a folder EPROM
beside it.
Exit codes: 0 no error, 1 errors, 2 wrong use.";

const RUN_EXAMPLES: &str = "\
Examples:
  bahn plc run MAIN.PLC --set I4=1,W6=100 --show O2,D120
      One cycle with input 4 set.
  bahn plc run MAIN.PLC --cycles 50 --set I4=1,MP4110.2=4 --show O2 --trace 1..2
      Fifty cycles; every executed line of the first two.
  bahn plc run MAIN.PLC --script door.txt --record door.csv --show I4,O2
      Stimuli and expectations from a file; operands after every cycle as a table.

Script (--script): what happens at which time, and what is expected, as for `bahn run`; docs/scripts.md tells all
of it. A cycle is a scan; the first one is 1. A blank stands before the ; or # of a comment:
  cycle 1: I4=1, W6=100          ; set before the first cycle
  cycle 3: expect O2=1, B8=-3    ; so after the third
  0.5: S0=\"OIL\", MP4110.2=4     ; 0.5 s after power-on, or +0.5, +20 cycles after the line before
  when O2=1: I4=0                ; as soon as it is so
  +2 cycles: end
Values are decimal, $2A hexadecimal or \"text\". Without --cycles the run ends with the script; a condition that has
not come true a minute after the last thing that was done has failed.

JSON: cycles, values, processing_percent (current, maximum), error (number, file, line, or null); with
--trace also trace (the first 100000 executed lines) and trace_left_off (how many follow), with failed
expectations also failed_expectations (cycle, line, operand, expected, found).
Exit codes: 0 fine, 1 compile error, run-time error or failed expectation, 2 wrong use, 130 ended by Ctrl-C
(with the report so far).";

const TRACE_EXAMPLES: &str = "\
Examples:
  bahn plc trace MAIN.PLC --set I4=1
  bahn plc trace MAIN.PLC --script door.txt --cycle 3 --hex
  bahn plc trace machines/mill --part CIRCLE.H --trigger M2045=1
      The scan of the running control in which the first M function reaches the PLC.

With the folder of a machine its PLC program runs in the whole control on the simulated machine, as with
`bahn run --fresh`: the operator switches on, passes the reference marks and starts --part; a script speaks to control and
machine. Cycles are the scans since power-on.";

const DIAGRAM_EXAMPLES: &str = "\
Examples:
  bahn plc diagram MAIN.PLC --script door.txt --show I4,T48,O2 --cycles 60
  bahn plc diagram MAIN.PLC --show M100,O2 --trigger O2=1 --cycles 40 --before 10 --svg door.svg
  bahn plc diagram machines/mill --part CIRCLE.H --show M2045,W260,M2482,O12 --trigger M2045=1 --before 5 --cycles 60
      The handshake of the first M function in the running control; `bahn plc trace --help` says more.";

#[cfg(feature = "terminal")]
const WATCH_KEYS: &str = "\
Keys: r run, s stop, c one cycle, l one line, n start the program and the script anew, up and down choose
an operand, enter set it, space turn a bit over, a add operands, d remove one, b set or clear a breakpoint
at a line of the main file, x stop when the chosen operand changes, t show the course of the values instead
of binary numbers, q end. Numbers are shown decimal, hexadecimal and binary.

With the folder of a machine its PLC program runs in the whole control on the simulated machine. Then there are
whole scans only: lines, breakpoints at lines and a new start are on the bench.

Examples:
  bahn plc watch MAIN.PLC --show I4,O2,W8
  bahn plc watch machines/mill --part CIRCLE.H --show M2045,W260,M2482
  bahn plc watch MAIN.PLC --script door.txt --retain door.mem";

const XREF_EXAMPLES: &str = "\
Examples:
  bahn plc xref MAIN.PLC
  bahn plc xref MAIN.PLC --only O,M2045
  bahn plc xref MAIN.PLC --format json";

const SIGNALS_EXAMPLES: &str = "\
Examples:
  bahn plc signals
  bahn plc signals strobe
  bahn plc signals M2045 --format json";

/// The PLC program and what it is translated for.
#[derive(Args, Debug)]
pub(crate) struct ProgramOptions {
    /// The main file; linked files lie beside it. trace, diagram and watch also take the folder of a machine, check, list and
    /// xref that of one with a System 900.
    #[arg(value_name = "MAIN.PLC", value_hint = ValueHint::FilePath)]
    pub file: PathBuf,
    /// Control model that the program is translated for.
    #[arg(long, value_name = "MODEL", default_value_t, ignore_case = true, value_parser = model_parser())]
    pub model: ControlModel,
    /// List of machine parameters that replaces values of the model's reference list. With MP4010 = 0 in
    /// it files are linked from the folder EPROM beside the main file only.
    #[arg(long, value_name = "LIST", value_hint = ValueHint::FilePath)]
    pub parameters: Option<PathBuf>,
    /// Refuse loose spelling, as `LM 4`, that is accepted with a warning otherwise.
    #[arg(long)]
    pub strict: bool,
}

/// What the program runs against.
#[derive(Args, Debug)]
pub(crate) struct BenchOptions {
    /// Operands and machine parameters before the first cycle, as I4=1,W6=100,MP4110.2=4 (repeatable).
    #[arg(long, value_name = "OPERAND=V,..")]
    pub set: Vec<String>,
    /// What happens at which time, and what is expected (docs/scripts.md).
    #[arg(long, value_name = "SCRIPT", value_hint = ValueHint::FilePath)]
    pub script: Option<PathBuf>,
}

/// What the machine does whose folder is looked at.
#[derive(Args, Debug)]
pub(crate) struct MachineOptions {
    /// Part program that the operator runs on the machine: a path, or a program in its folder of programs; one for each
    /// channel, in their order. Without it those of machine.toml.
    #[arg(long, value_name = "FILE", value_hint = ValueHint::FilePath)]
    pub part: Vec<PathBuf>,
}

/// Options of `bahn plc check`.
#[derive(Args, Debug)]
pub(crate) struct CheckOptions {
    #[command(flatten)]
    pub program: ProgramOptions,
    /// How the result is written.
    #[arg(long, value_name = "FORMAT", value_enum, default_value_t)]
    pub format: Format,
}

/// Options of `bahn plc run`.
#[derive(Args, Debug)]
pub(crate) struct RunOptions {
    #[command(flatten)]
    pub program: ProgramOptions,
    #[command(flatten)]
    pub bench: BenchOptions,
    /// Cycles; without it those of the script, or one.
    #[arg(long, value_name = "N")]
    pub cycles: Option<u64>,
    /// File of the non-volatile markers and bytes: read before, written after the run.
    #[arg(long, value_name = "FILE", value_hint = ValueHint::FilePath)]
    pub retain: Option<PathBuf>,
    /// Operands whose values are shown after the run.
    #[arg(long, value_name = "OPERAND,..", value_delimiter = ',')]
    pub show: Vec<Operand>,
    /// Show every executed line of these cycles, all without a range.
    #[arg(long, value_name = "FROM..TO", num_args = 0..=1, default_missing_value = "..")]
    pub trace: Option<CycleRange>,
    /// Write the operands of --show, or else those of the script, after every cycle.
    #[arg(long, value_name = "OUT.csv", value_hint = ValueHint::FilePath)]
    pub record: Option<PathBuf>,
    /// Write the expectations of the script as JUnit XML, for build servers.
    #[arg(long, value_name = "OUT.xml", value_hint = ValueHint::FilePath)]
    pub junit: Option<PathBuf>,
    /// How the result is written.
    #[arg(long, value_name = "FORMAT", value_enum, default_value_t)]
    pub format: Format,
}

impl RunOptions {
    /// Files that are read.
    pub fn inputs(&self) -> Vec<&Path> {
        let all = [&self.bench.script, &self.program.parameters, &self.retain];
        let all = all.into_iter().flatten().map(PathBuf::as_path);
        all.chain([self.program.file.as_path()]).collect()
    }

    /// Files that are written, with their options; --retain goes on with the file that is there.
    pub fn written(&self) -> Vec<(&'static str, &Path)> {
        let all = [("--record", &self.record), ("--junit", &self.junit)];
        all.into_iter()
            .filter_map(|(option, path)| Some((option, path.as_deref()?)))
            .collect()
    }
}

/// Options of `bahn plc trace`.
#[derive(Args, Debug)]
pub(crate) struct TraceOptions {
    #[command(flatten)]
    pub program: ProgramOptions,
    #[command(flatten)]
    pub bench: BenchOptions,
    #[command(flatten)]
    pub machine: MachineOptions,
    /// The cycle that is shown.
    #[arg(long, value_name = "N", default_value_t = 1, value_parser = clap::value_parser!(u64).range(1..))]
    pub cycle: u64,
    /// Show the cycle in which an operand gets a value: O2=1 is its positive edge, O2=0 its negative.
    #[arg(long, value_name = "OPERAND=V", conflicts_with = "cycle")]
    pub trigger: Option<String>,
    /// Cycles after which the trigger is given up.
    #[arg(long, value_name = "N", default_value_t = 100_000, requires = "trigger")]
    pub limit: u64,
    /// Show numbers hexadecimal.
    #[arg(long, conflicts_with = "format")]
    pub hex: bool,
    /// How the result is written.
    #[arg(long, value_name = "FORMAT", value_enum, default_value_t)]
    pub format: Format,
}

/// Options of `bahn plc diagram`.
#[derive(Args, Debug)]
pub(crate) struct DiagramOptions {
    #[command(flatten)]
    pub program: ProgramOptions,
    #[command(flatten)]
    pub bench: BenchOptions,
    #[command(flatten)]
    pub machine: MachineOptions,
    /// The operands, up to 16.
    #[arg(long, value_name = "OPERAND,..", value_delimiter = ',', required = true)]
    pub show: Vec<Operand>,
    /// Cycles that are drawn, up to 1024.
    #[arg(long, value_name = "N", default_value_t = 64, value_parser = clap::value_parser!(u64).range(1..=1024))]
    pub cycles: u64,
    /// Draw from the cycle in which an operand gets a value: O2=1 is its positive edge, O2=0 its negative.
    #[arg(long, value_name = "OPERAND=V")]
    pub trigger: Option<String>,
    /// Cycles that are drawn before the one that triggers.
    #[arg(long, value_name = "N", default_value_t = 0, requires = "trigger")]
    pub before: u64,
    /// Cycles after which the trigger is given up.
    #[arg(long, value_name = "N", default_value_t = 100_000, requires = "trigger")]
    pub limit: u64,
    /// Write the diagram as drawing instead.
    #[arg(long, value_name = "OUT.svg", value_hint = ValueHint::FilePath)]
    pub svg: Option<PathBuf>,
    /// How the diagram is written.
    #[arg(
        long,
        value_name = "FORMAT",
        value_enum,
        default_value_t,
        conflicts_with = "svg"
    )]
    pub format: Format,
}

/// Options of `bahn plc watch`.
#[cfg(feature = "terminal")]
#[derive(Args, Debug)]
pub(crate) struct WatchOptions {
    #[command(flatten)]
    pub program: ProgramOptions,
    #[command(flatten)]
    pub bench: BenchOptions,
    #[command(flatten)]
    pub machine: MachineOptions,
    /// File of the non-volatile markers and bytes: read before, kept while the program runs.
    #[arg(long, value_name = "FILE", value_hint = ValueHint::FilePath)]
    pub retain: Option<PathBuf>,
    /// The operands of the table; without it those of --set and of the script.
    #[arg(long, value_name = "OPERAND,..", value_delimiter = ',')]
    pub show: Vec<Operand>,
}

/// Options of `bahn plc list`.
#[derive(Args, Debug)]
pub(crate) struct ListOptions {
    #[command(flatten)]
    pub program: ProgramOptions,
    /// How the listing is written.
    #[arg(long, value_name = "FORMAT", value_enum, default_value_t)]
    pub format: Format,
}

/// Options of `bahn plc xref`.
#[derive(Args, Debug)]
pub(crate) struct XrefOptions {
    #[command(flatten)]
    pub program: ProgramOptions,
    /// Only operands (M2045) or kinds of operands (O).
    #[arg(long, value_name = "OPERAND,..", value_delimiter = ',')]
    pub only: Vec<String>,
    /// How the result is written.
    #[arg(long, value_name = "FORMAT", value_enum, default_value_t)]
    pub format: Format,
}

/// Options of `bahn plc signals`.
#[derive(Args, Debug)]
pub(crate) struct SignalsOptions {
    /// Only signals with all these words in operand, name or meaning.
    #[arg(value_name = "WORD")]
    pub filter: Vec<String>,
    /// How the list is written.
    #[arg(long, value_name = "FORMAT", value_enum, default_value_t)]
    pub format: Format,
}

/// Options of `bahn plc standard`.
#[derive(Args, Debug)]
pub(crate) struct StandardOptions {
    /// The control model, where there are several programs.
    #[arg(long, value_name = "MODEL", ignore_case = true, value_parser = model_parser())]
    pub model: Option<ControlModel>,
    /// Write it to this file.
    #[arg(short, long, value_name = "FILE", value_hint = ValueHint::FilePath)]
    pub output: Option<PathBuf>,
}

/// Cycles from one to another, both included.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) struct CycleRange {
    pub from: u64,
    pub to: u64,
}

impl CycleRange {
    pub fn contains(self, cycle: u64) -> bool {
        (self.from..=self.to).contains(&cycle)
    }
}

impl std::str::FromStr for CycleRange {
    type Err = String;

    fn from_str(text: &str) -> Result<CycleRange, String> {
        let wrong = || "it takes cycles as 2..5, 2.., ..5 or 2".to_owned();
        let bound = |text: &str, open: u64| match text.trim() {
            "" => Ok(open),
            text => text.parse().map_err(|_| wrong()),
        };
        let range = match text.split_once("..") {
            Some((from, to)) => CycleRange {
                from: bound(from, 1)?,
                to: bound(to.trim_start_matches('='), u64::MAX)?,
            },
            None => {
                let cycle = text.trim().parse().map_err(|_| wrong())?;
                CycleRange {
                    from: cycle,
                    to: cycle,
                }
            }
        };
        if range.from == 0 || range.from > range.to {
            return Err(wrong());
        }
        Ok(range)
    }
}
