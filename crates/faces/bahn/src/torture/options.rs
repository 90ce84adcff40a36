//! Options of `bahn torture`.

use std::path::PathBuf;

use clap::Args;

use crate::options::Format;

pub(crate) const EXAMPLES: &str = "\
Examples:
  bahn torture --seeds 0..20                          the shipped machines, 20 seeds each
  bahn torture --machine machines/twin --seeds 0..100 --most 1
      Ends with the first seed that breaks a rule.
  bahn torture --machine machines/mill --program BRACKET.H --mp 7480.0=3,4310.0=3 --seeds 0..50
      The mill changes its tools with the magazine.
  bahn torture --machine machines/mill --seeds 0..2 --event M190=1
      A marker by which a copy of the PLC program is made to fail joins what happens.
  bahn torture --machine machines/mill-tnc360 --seeds 31..32 --record seed.txt
      Repeats one seed, and writes what happens in it as a script; bahn run repeats that with its report.
  bahn torture --machine machines/portal900 --seeds 0..15
      A machine with a System 900: all its channels at once.

A seed says everything: the program, the moment of its undisturbed run, what fails, what is pressed, and when. In the end
everything is repaired and the run goes on. docs/torture.md tells what is checked after every contour cycle.
Exit codes: 0 every rule held, 1 one did not, 2 wrong use, 130 ended by Ctrl-C, with the report so far.
JSON: machines (machine, programs, left_out (program, why), seeds, machine_s, messages, went_on) and violations (machine, seed,
program, rule, time_s, values, events).";

/// Options of `bahn torture`.
#[derive(Args, Debug)]
pub(crate) struct TortureOptions {
    /// Folder of a machine, again for several; the shipped machines without it.
    #[arg(long, value_name = "DIR")]
    pub machine: Vec<PathBuf>,
    /// Only these programs of the machine.
    #[arg(long, value_name = "PROGRAM")]
    pub program: Vec<String>,
    /// One machine parameter instead of that of the list, as 4310.0=3 (repeatable, or several with commas).
    #[arg(long = "mp", value_name = "N=V", value_delimiter = ',')]
    pub mp: Vec<String>,
    /// Operands that the PLC program does not expect, as a script has them, again for several: M190=1; on a System 900 a
    /// parameter, plc P8706=1.
    #[arg(long, value_name = "OPERANDS")]
    pub event: Vec<String>,
    /// Seeds from A to below B, for each machine.
    #[arg(long, value_name = "A..B", value_parser = seeds, default_value = "0..1000")]
    pub seeds: std::ops::Range<u64>,
    /// Threads; as many as processors without it.
    #[arg(long, value_name = "N", value_parser = clap::value_parser!(u16).range(1..=1024))]
    pub jobs: Option<u16>,
    /// Ends with so many violations.
    #[arg(long, value_name = "N", default_value_t = 10)]
    pub most: usize,
    /// Writes the script of the first seed that breaks a rule, or of the only one.
    #[arg(long, value_name = "FILE")]
    pub record: Option<PathBuf>,
    /// How the report is written.
    #[arg(long, value_name = "FORMAT", value_enum, default_value_t)]
    pub format: Format,
}

/// Seeds from the first up to, but not with, the last: `0..1000`.
fn seeds(text: &str) -> Result<std::ops::Range<u64>, String> {
    let parts = text.split_once("..");
    let number = |text: &str| text.trim().parse::<u64>().ok();
    let range = parts.and_then(|(from, to)| Some(number(from)?..number(to)?));
    range
        .filter(|range| !range.is_empty())
        .ok_or_else(|| "seeds are written 0..1000: from 0 to below 1000".to_owned())
}
