//! Options and help text of `bahn technology`.

use std::path::PathBuf;

use bahn_report::scope::Picture;
use clap::{Args, ValueHint};

use super::machine;
use crate::options::{Format, time_limit};
use crate::scope::picture;

pub(crate) const EXAMPLES: &str = "\
Examples:
  bahn technology glue.nc --channel glue.lis
      Each function is acknowledged its process time after its output.
  bahn technology glue.nc --channel glue.lis --plc slow-valve.txt --image glue.png
  bahn technology laser.nc --channel laser.lis --format json
  bahn technology glue.nc --channel glue.lis --max-time 60
      A run that takes longer ends with the block where it is.
  bahn technology glue.nc --channel glue.lis --plc machines/gantry
      The PLC program of a machine answers, in a window of 128 of its bytes.

Programs are DIN 66025 as a TF5200 reads it; a file may hold several, which run in turn.
Subroutines called with L lie beside their program. Without --parameters G00 runs at 10 m/min,
axes accelerate with 1 m/s2; the list may hold only what is to be changed (`MP1010.0 : 5000`).

PLC script: rules, a line each, and what happens at which time (docs/scripts.md); ; or # begins a comment:
  M25 ack 0.5       acknowledged 0.5 s after its output; 0 is the next cycle
  H5 ack never      X[M7] ack 1       S[M3] ack 0.4     a range before the brackets; without one all
  M26 at 3.0        acknowledged at a time of the run
  M7 nofetch        not even fetched
  default ack 0     what has no line of its own
  spindle S1 ready 0.8     probe X45     override 50 at 1.0
  1.5: override feed 50    2.0: key NC_STOP tap    2.5: key NC_START tap    3: end
  2.0..2.5: hold           4.0: reset    2..3: backward    2..3: simulated    2..3: single
  hold 2.0..2.5            a time may stand behind them, too

JSON: completed, error (null, or code, message, program, block, line), time_s, cycle_s, events (t,
kind output, fetch, acknowledge, stop, go or active, function, value, offset_us, v in mm/min,
target, block, position), waits (function, block, from_s, to_s, position), path_end, diagnostics
(what is wrong in list, script and programs: severity, file, line, column, length, message, help).
Exit codes: 0 completed, 1 not, or longer than --max-time or --max-blocks, 2 wrong use.";

/// Options of `bahn technology`.
#[derive(Args, Debug)]
pub(crate) struct TechnologyOptions {
    /// Programs, run in turn on one channel.
    #[arg(value_name = "PROGRAM", required = true, value_hint = ValueHint::FilePath)]
    pub programs: Vec<PathBuf>,
    /// Channel parameter list: how each function is synchronised.
    #[arg(long, value_name = "LIST", value_hint = ValueHint::FilePath)]
    pub channel: PathBuf,
    /// A script of what the PLC does, or the folder of a machine whose PLC answers; without it every function is
    /// acknowledged its process time after its output.
    #[arg(long, value_name = "SCRIPT|DIR", value_hint = ValueHint::AnyPath)]
    pub plc: Vec<PathBuf>,
    /// First byte of the window in which the PLC of a machine sees the functions.
    #[arg(long, value_name = "BYTE", default_value = "B128", value_parser = machine::window)]
    pub window: u16,
    /// List of machine parameters: rapid traverse, acceleration, corners. It may hold changes only.
    #[arg(long, value_name = "MPLIST", value_hint = ValueHint::FilePath)]
    pub parameters: Option<PathBuf>,
    /// Where the path starts, as X0,Y-5.5.
    #[arg(
        long,
        value_name = "POSITION",
        value_delimiter = ',',
        allow_hyphen_values = true
    )]
    pub start: Vec<String>,
    /// Block of the first file with which the run begins, as N50, also in a subroutine; what is before it is not output.
    #[arg(long, value_name = "BLOCK", value_parser = block)]
    pub from: Option<String>,
    /// Time of the run after which it ends, s.
    #[arg(long, value_name = "S", default_value = "86400", value_parser = time_limit)]
    pub max_time: f64,
    /// Blocks that may be executed; more are taken for an endless run.
    #[arg(long, value_name = "N", default_value_t = 50_000_000, value_parser = clap::value_parser!(u64).range(1..))]
    pub max_blocks: u64,
    /// How the report is written.
    #[arg(long, value_name = "FORMAT", value_enum, default_value_t)]
    pub format: Format,
    /// Draw velocity, outputs, acknowledgements and waits: a file that ends in .svg or .png.
    #[arg(long, value_name = "FILE", value_hint = ValueHint::FilePath, value_parser = picture)]
    pub image: Option<Picture>,
}

/// A block as reports name it: `N50` without leading zeros, `#12` for a line.
fn block(text: &str) -> Result<String, String> {
    let text = text.trim();
    let (sign, digits) = match text.strip_prefix('#') {
        Some(digits) => ("#", digits),
        None => ("N", text.trim_start_matches(['N', 'n'])),
    };
    let number = digits.trim().parse::<u64>();
    number
        .map(|number| format!("{sign}{number}"))
        .map_err(|_| "a block is called by its number, as N50, or by its line, as #12".to_owned())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn blocks_are_called_as_in_reports() {
        for (text, name) in [("N050", "N50"), ("n5", "N5"), (" 7", "N7"), ("#012", "#12")] {
            assert_eq!(block(text).as_deref(), Ok(name));
        }
        assert!(block("N").is_err() && block("M50").is_err() && block("#x").is_err());
    }
}
