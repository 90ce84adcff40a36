//! Options and help texts of `bahn run`.

use std::path::{Path, PathBuf};
use std::str::FromStr;

use bahn_host::{Attendance, Observed};
use bahn_system900::Name;
use clap::{Args, ValueHint};

use super::oscilloscope::OscilloscopeOptions;
use crate::UsageError;
use crate::options::{Format, InchFeedOption, OutputOptions, override_percent, seconds};

pub(crate) const EXAMPLES: &str = "\
Examples:
  bahn run BRACKET.H --machine machines/mill
      Switch the machine on, pass the reference marks, run the program; report times, lag, messages.
  bahn run part.h --machine mill --record run.csv --signals X.actual,X.lag,M2045 --every 10
      Record signals, a row every 10 ms; `bahn scope run.csv -o run.svg` draws them.
  bahn run part.h --machine mill --oscilloscope osc.csv --trigger 'X.diff>50' --pre-trigger 25
      The control's oscilloscope: 4096 samples in servo steps, a quarter of them before X lags by 50 µm; `bahn scope`
      draws it. On axes with digital speed controller `output step 300` in a script lets direction keys put out a step.
  bahn run part.h --machine mill --script stop.txt
      What happens at which time, and what is expected, stands in a script.
  bahn run part.h --machine mill --fresh --log run.log
  bahn run part.h --machine mill --fresh --replay run.log
      The second run repeats the first one, bit by bit, when both have --fresh and the same --mp.
  bahn run --machine mill --script jog.txt
      Without a program: power-up, reference run, then the script.
  bahn run SCAN.H --machine mill --fresh --script probe.txt --solid model.stl --digitized .
      TCH PROBE 5 to 7 scan a mesh with the axes and write their program here; without --solid, the part as machined.
      `probe insert` in the script puts the touch probe into the spindle.
  bahn run --machine machines/twin --record twin.csv --signals X.actual,2:X.actual
      Two channels, each with the program that machine.toml names; LEFT.H RIGHT.H before --machine would name them.
  bahn run --machine machines/portal900 --fresh --read P12154 --sample events.txt
      A machine with a System 900: all channels; parameters at the end, and the event buffer.
  bahn run PALLET.H --machine machines/mill --with machines/module-tnc360 --fresh
      A positioning module beside the machine, with a control of its own; docs/positioning-module.md tells of it.

FILE is a path, or a program in the folder of programs of the machine. Where the machine has several channels, the
first FILE is that of the first channel and so on; a channel without stands by.

The operator who stands by (--operator): full confirms programmed stops and tool changes with the keys of
[operator] in machine.toml, and reports it; start ends with the start of the program; absent does nothing.
Without --operator it is full, with --script start, with --replay absent.

Script (--script): lines `TIME: EVENT`. TIME is s since power-on (12.5), since the line before (+2) or since
the program was started (start+3), `+20 cycles` of the control, or a condition: `when X.actual > 50`,
`after message TEXT`; docs/scripts.md tells all of it. Text after ; or # is a comment. Events are those of the machine
(machines/mill/README.md), commands of the control, operands and machine parameters, power, what is expected, and `end`:
  start+2: key NC_STOP tap
  +3: expect run interrupted
  +0: override feed 50
  +0: key NC_START tap
  start+10: M900=1, MP4110.5=200
  start+20: expect X.actual=100±0.01
  +0: expect message \"DOOR IS OPEN\"
A number before a colon is a channel: `+1: 2: mode manual`, `+1: expect 2:X.actual=100`, `when 2: run ended: end`.
With --with a line speaks of the module so: `+1: module: emergency press`, `+1: expect module:X.actual=350`.
`bahn machine list` names all events, commands, keys and lamps.

State: what survives power-off is read from the state folder of the machine and kept there, with where the
simulated mechanics stand; --fresh begins without it and leaves no trace. A tool change is on the medium before its strobe falls. When control.toml there
is damaged nothing is started: the message says what to do.

JSON report (--format json): the fields of `bahn test`; machining_time_s is that of the machine with all
waits. Without a program, or when its run did not begin, only completed and error. machine, model, power_up_s, reference_s; times (what, count, time_s); axes by letter (max_lag,
lag_block, max_deviation, deviation_block; mm, degrees; null where there is none), contour_deviation_mm,
contour_deviation_cause (in words), contour_deviation_block;
threads (program, block, cycle 2, 17 or 18; depth_mm that is commanded, reached_mm by the plant; off_mm, the largest distance
of the tool from where the spindle's angle says, in cycle 2 what the floating holder takes), threads_not_listed after 1000;
plc (max_percent, mean_percent of the nominal time); messages (time_s, text, place, flashing,
program, block); confirmed (time_s, key, why, block); waits_for (null, or what a hanging run waited for);
channels (only where there are several, those beside the first: channel, the fields of `bahn test`, axes,
contour_deviation_mm, _cause, _block, threads); failed_expectations (line, text, actual); test_run (null, or program, completed, message, place of the last
TEST RUN of a script); module (only with --with: machine, model, ready_s, axes with position, referenced, max_lag, characters,
plc_max_percent, plc_mean_percent, messages); realtime (null, or cycles, late_cycles, worst_lateness_ms,
late_by, overrun_cycles, longest_ms).

Exit codes: 0 fine, 1 the program or the machine has an error, the run hangs or takes longer than allowed,
an expectation fails, or the script ends the run before the program is complete or with a flashing message
that it did not expect, 2 wrong use, 130 ended by
Ctrl-C. When files of the machine or the script are faulty, JSON has completed = false and faults (file,
line, column, title, message).";

/// Options of `bahn run`.
#[derive(Args, Debug)]
pub(crate) struct RunMachineOptions {
    /// The part program, or one for each channel; without any the script does everything after the reference run, and
    /// a machine with several channels runs the programs of its machine.toml.
    #[arg(value_name = "FILE", value_hint = ValueHint::FilePath)]
    pub files: Vec<PathBuf>,
    /// Folder of the machine.
    #[arg(long, value_name = "DIR", value_hint = ValueHint::DirPath)]
    pub machine: PathBuf,
    /// Folder of a positioning module ([module] in its machine.toml) that goes along at RS-422 and in the EMERGENCY STOP chain.
    #[arg(long, value_name = "DIR", value_hint = ValueHint::DirPath, conflicts_with_all = ["log", "replay"])]
    pub with: Option<PathBuf>,
    /// How the report is written.
    #[arg(long, value_name = "FORMAT", value_enum, default_value_t)]
    pub format: Format,

    /// Parameters of a System 900 that the report tells, as P12151 or 2:P8685.
    #[arg(long, value_name = "NAME,..", value_delimiter = ',')]
    pub read: Vec<Name>,

    #[command(flatten)]
    pub run: RunControl,
    #[command(flatten)]
    pub recording: RecordingOptions,
    #[command(flatten)]
    pub oscilloscope: OscilloscopeOptions,
    #[command(flatten)]
    pub output: OutputOptions,
}

impl RunMachineOptions {
    /// Files that are read.
    pub fn inputs(&self) -> Vec<&Path> {
        let further = [
            &self.run.script,
            &self.run.replay,
            &self.output.solid,
            &self.output.compare,
        ];
        let all = self.files.iter().chain(further.into_iter().flatten());
        all.map(PathBuf::as_path).collect()
    }

    /// Files that are written, with their options.
    pub fn written(&self) -> Vec<(&'static str, &Path)> {
        let log = self.run.log.iter().map(|path| ("--log", path.as_path()));
        let junit = self.run.junit.iter().map(|path| ("--junit", path.as_path()));
        let sample = self.run.sample.iter().map(|path| ("--sample", path.as_path()));
        let record = self.recording.record.iter();
        let record = record.map(|path| ("--record", path.as_path()));
        let scope = self.oscilloscope.oscilloscope.iter();
        let scope = scope.map(|path| ("--oscilloscope", path.as_path()));
        self.output
            .written()
            .chain(scope)
            .chain(log)
            .chain(junit)
            .chain(record)
            .chain(sample)
            .collect()
    }
}

/// Script, log and operator of the run.
#[derive(Args, Debug)]
#[command(next_help_heading = "Run")]
pub(crate) struct RunControl {
    /// Events at times, and expectations.
    #[arg(long, value_name = "SCRIPT", value_hint = ValueHint::FilePath)]
    pub script: Option<PathBuf>,
    /// Write the expectations of the script as JUnit XML, for build servers.
    #[arg(long, value_name = "OUT.xml", value_hint = ValueHint::FilePath, requires = "script")]
    pub junit: Option<PathBuf>,
    /// Write what was done to control and machine, to be repeated with --replay.
    #[arg(long, value_name = "LOG", value_hint = ValueHint::FilePath)]
    pub log: Option<PathBuf>,
    /// Write the event buffer of a System 900 at the end of the run: P11271 and following say what it records.
    #[arg(long, value_name = "OUT.txt", value_hint = ValueHint::FilePath)]
    pub sample: Option<PathBuf>,
    /// Repeat a run from its log; a log that was damaged, cut off or edited is warned of.
    #[arg(long, value_name = "LOG", value_hint = ValueHint::FilePath, conflicts_with = "script")]
    pub replay: Option<PathBuf>,
    /// What the operator who stands by does.
    #[arg(long, value_name = "WHAT", value_enum)]
    pub operator: Option<AttendanceOption>,
    /// Feed override potentiometer, 0 to 150 %.
    #[arg(long = "override", value_name = "PERCENT", value_parser = override_percent)]
    pub override_percent: Option<f64>,
    /// Single block instead of full sequence.
    #[arg(long)]
    pub single_block: bool,
    /// Start with the block of this number instead of the first; in DIN/ISO and DIN 66025 that which it is programmed with.
    #[arg(long, value_name = "N")]
    pub start_block: Option<u32>,
    /// What F counts in a program in inches, instead of what it counts on the model.
    #[arg(long, value_name = "WHAT", value_enum)]
    pub inch_feed: Option<InchFeedOption>,
    /// Begin without what survives power-off, and keep nothing.
    #[arg(long)]
    pub fresh: bool,
    /// Another tool table of the machine's folder in place of that of machine.toml; nothing of what survives power-off
    /// belongs to it.
    #[arg(long, value_name = "NAME", requires = "fresh")]
    pub tools: Option<String>,
    /// One machine parameter instead of that of the list, as 4310.0=0 (repeatable, or several with commas).
    #[arg(long = "mp", value_name = "N=V", value_delimiter = ',')]
    pub mp: Vec<String>,
    /// Refuse what is otherwise accepted with a warning, such as functions that have no effect here.
    #[arg(long)]
    pub strict: bool,
    /// Pass over words and blocks that nothing here knows, and functions without which the control would
    /// move differently, each with a warning, instead of ending with an error.
    #[arg(long, conflicts_with = "strict")]
    pub skip_unknown: bool,
    /// Simulate the block processing time of the model: the path waits for blocks that are not read yet, from the first
    /// one on.
    #[arg(long)]
    pub block_time: bool,
    /// Keep pace with real time, and report late cycles.
    #[arg(long)]
    pub realtime: bool,
    /// Time of the machine after which the run ends, s.
    #[arg(long, value_name = "S", default_value = "86400", value_parser = seconds)]
    pub max_time: f64,
    /// Time of the machine after which a run hangs in which no axis moves, no dwell runs, and control, PLC and machine come
    /// into no state that is new, s; while a timer of the PLC runs, its longest time besides.
    #[arg(long, value_name = "S", default_value = "60", value_parser = seconds)]
    pub max_wait: f64,
}

/// What the operator who stands by does.
#[derive(Clone, Copy, Debug, PartialEq, Eq, clap::ValueEnum)]
pub(crate) enum AttendanceOption {
    /// Everything: also NC start after programmed stops, and what a tool change waits for.
    Full,
    /// Switches on, passes the reference marks and starts the program; then the script is alone.
    Start,
    /// Nothing: the script does it.
    Absent,
}

impl From<AttendanceOption> for Attendance {
    fn from(option: AttendanceOption) -> Attendance {
        match option {
            AttendanceOption::Full => Attendance::Full,
            AttendanceOption::Start => Attendance::Start,
            AttendanceOption::Absent => Attendance::Absent,
        }
    }
}

impl RunControl {
    /// What the operator does: with a script he starts the program alone, with a log nothing.
    pub fn attendance(&self) -> Attendance {
        let usual = match (&self.replay, &self.script) {
            (Some(_), _) => Attendance::Absent,
            (None, Some(_)) => Attendance::Start,
            (None, None) => Attendance::Full,
        };
        self.operator.map_or(usual, Attendance::from)
    }
}

/// What of the run is recorded, and how often.
#[derive(Args, Debug)]
#[command(next_help_heading = "Recording")]
pub(crate) struct RecordingOptions {
    /// Write signals over time as a table.
    #[arg(long, value_name = "OUT.csv", value_hint = ValueHint::FilePath)]
    pub record: Option<PathBuf>,
    /// What is recorded: X.actual, X.nominal, X.lag, X.speed, X.nominal-speed, X.volts, X.displayed, X.ref, X.distance, X.probed,
    /// X.n-actual, X.n-nominal, X.n-int (digital speed controller), X.table and X.force (what only the plant knows), path.speed,
    /// path.block, path.distance, S.rpm, S.volts, S.angle, output.1 to output.5, output.S, mode, run, tool, probe.length,
    /// probe.radius, probe.angle, probe.touches, probe.circle, Q5, X41/34, X42/4, operands of the PLC like M2045, I4, W260, of
    /// the second channel as 2:X.actual, of the module as module:X.actual; parameters of a System 900, as P12151 or 2:P8685; by
    /// default speeds, positions, lags, and the handshake of M functions. `bahn machine list` says what each is.
    #[arg(long, value_name = "SIGNAL,..", value_delimiter = ',', requires = "record")]
    pub signals: Vec<SignalName>,
    /// Time between two rows, ms; every contour cycle without it.
    #[arg(long, value_name = "MS", requires = "record", value_parser = clap::value_parser!(u32).range(1..))]
    pub every: Option<u32>,
}

impl RecordingOptions {
    /// The signals of a TNC.
    pub fn observed(&self) -> Result<Vec<Observed>, UsageError> {
        let all = self.signals.iter().map(|signal| signal.observed.clone());
        all.collect::<Result<_, String>>().map_err(UsageError::new)
    }

    /// The parameters of a System 900.
    pub fn names(&self) -> Result<Vec<Name>, UsageError> {
        let name = |signal: &SignalName| match signal.name {
            Some(name) => Ok(name),
            None => Err(UsageError::new(format!(
                "--signals {}: a System 900 has parameters, as P12151 or 2:P8685",
                signal.text
            ))),
        };
        self.signals.iter().map(name).collect()
    }
}

/// What is recorded, as it is written: which of it there is, the family of the control says.
#[derive(Clone, Debug)]
pub(crate) struct SignalName {
    text: String,
    /// As a signal of a TNC, or why it is none.
    pub observed: Result<Observed, String>,
    /// As a parameter of a System 900.
    name: Option<Name>,
}

impl FromStr for SignalName {
    type Err = String;

    fn from_str(text: &str) -> Result<SignalName, String> {
        let observed = text
            .parse::<Observed>()
            .map_err(|error| format!("--signals {text}: {error}"));
        let name = text.parse::<Name>().ok();
        if name.is_none() {
            // What is no parameter must be a signal.
            text.parse::<Observed>().map_err(|error| error.to_string())?;
        }
        Ok(SignalName {
            text: text.to_owned(),
            observed,
            name,
        })
    }
}
