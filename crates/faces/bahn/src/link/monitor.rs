//! `bahn link monitor`: what passes over a line, in words.

use std::path::{Path, PathBuf};
use std::sync::atomic::Ordering;
use std::time::Duration;

use bahn_link::{Channel, Characters, Monitor, Spec};
use clap::{Args, ValueHint};

use super::port;
use crate::interrupt::Interrupt;
use crate::{Outcome, UsageError, console};

pub(super) const EXAMPLES: &str = "\
Examples:
  bahn link monitor --trace line.txt
  bahn link monitor tcp:127.0.0.1:4712 connect:127.0.0.1:4711
  bahn link monitor serial:/dev/ttyUSB0,mode=fe2,baud=9600 serial:/dev/ttyUSB1,mode=fe2,baud=9600

Between two ports it passes on what comes and shows it: `>` is what the first port has sent, `<` what the second one has.
From a trace, which the other commands write with --trace, it shows the same. Blocks show their check characters, and
what they should be when they are wrong; telegrams of LSV/2 and text of the standard protocol are told from them. Exit
codes: 0 at the end of the trace or by Ctrl-C, 1 a port cannot be opened or the trace is damaged, 2 wrong use.";

/// How long a direction is quiet before what has begun is shown.
const QUIET: Duration = Duration::from_millis(200);
/// How often each port is looked at.
const LOOK: Duration = Duration::from_millis(1);

/// Options of `bahn link monitor`.
#[derive(Args, Debug)]
pub(crate) struct MonitorOptions {
    /// The two ports between which it stands.
    #[arg(
        value_name = "SPEC",
        num_args = 2,
        required_unless_present = "trace",
        conflicts_with = "trace"
    )]
    ports: Vec<String>,
    /// Show what a trace has written down.
    #[arg(long, value_name = "FILE", value_hint = ValueHint::FilePath)]
    trace: Option<PathBuf>,
}

pub(super) fn command(options: &MonitorOptions) -> Result<Outcome, UsageError> {
    if let Some(trace) = &options.trace {
        return of_trace(trace);
    }
    let mut specs = Vec::new();
    for text in &options.ports {
        match port::spec("SPEC", text) {
            Ok(spec) => specs.push(spec),
            Err(port::Refused) => return Ok(Outcome::ProgramError),
        }
    }
    match <[Spec; 2]>::try_from(specs) {
        Ok(specs) => between(&specs),
        Err(_) => Err(UsageError::new("two ports are needed")),
    }
}

/// What both directions say, line by line.
#[derive(Default)]
struct Shown {
    directions: [Monitor; 2],
    last: usize,
}

impl Shown {
    fn byte(&mut self, way: usize, byte: u8, seconds: f64) -> Result<(), UsageError> {
        if way != self.last {
            self.rest(seconds)?;
            self.last = way;
        }
        match self
            .directions
            .get_mut(way)
            .and_then(|monitor| monitor.byte(byte))
        {
            Some(line) => print(way, &line, seconds),
            None => Ok(()),
        }
    }

    /// Somebody else speaks, or nobody.
    fn rest(&mut self, seconds: f64) -> Result<(), UsageError> {
        let way = self.last;
        match self.directions.get_mut(way).and_then(Monitor::rest) {
            Some(line) => print(way, &line, seconds),
            None => Ok(()),
        }
    }
}

fn print(way: usize, line: &str, seconds: f64) -> Result<(), UsageError> {
    let mark = if way == 0 { '>' } else { '<' };
    console::print(&format!("{seconds:10.3} {mark} {line}\n"))
}

fn of_trace(path: &Path) -> Result<Outcome, UsageError> {
    let text = std::fs::read_to_string(path)
        .map_err(|error| UsageError::new(format!("cannot read {}: {error}", path.display())))?;
    let mut shown = Shown::default();
    let mut last = 0.0;
    for (number, line) in (1..).zip(text.lines()) {
        let Some((seconds, way, bytes)) = row(line) else {
            port::Refused::because(&format!(
                "{}:{number}: no line of a trace: {line}",
                path.display()
            ));
            return Ok(Outcome::ProgramError);
        };
        for byte in bytes {
            shown.byte(way, byte, seconds)?;
        }
        last = seconds;
    }
    shown.rest(last)?;
    Ok(Outcome::Fine)
}

/// A line of a trace: seconds, direction, bytes.
fn row(line: &str) -> Option<(f64, usize, Vec<u8>)> {
    let mut words = line.split_whitespace();
    let seconds = words.next()?.parse().ok()?;
    let way = match words.next()? {
        ">" => 0,
        "<" => 1,
        _ => return None,
    };
    let byte = |word| u8::from_str_radix(word, 16).ok();
    Some((seconds, way, words.map(byte).collect::<Option<_>>()?))
}

fn between(specs: &[Spec; 2]) -> Result<Outcome, UsageError> {
    let interrupt = Interrupt::on_ctrl_c();
    // The characters are those of the ports; nothing is taken away from them.
    let characters = Characters {
        data_bits: 8,
        ..Characters::FIXED
    };
    let mut channels = Vec::new();
    for spec in specs {
        let settings = bahn_link::Settings {
            characters,
            ..port::settings(
                &bahn_parameters::ParameterList::reference(Default::default()),
                spec,
            )
        };
        match port::open(spec, &settings) {
            Ok(channel) => channels.push(channel),
            Err(port::Refused) => return Ok(Outcome::ProgramError),
        }
    }
    let mut shown = Shown::default();
    let mut quiet = Duration::ZERO;
    let stop = interrupt.flag();
    console::print("ready\n")?;
    while !stop.load(Ordering::Relaxed) {
        for way in 0..2 {
            let Ok([from, to]) = channels.get_disjoint_mut([way, 1 - way]) else {
                continue;
            };
            let now = from.now();
            if pass(from, to, |byte| shown.byte(way, byte, now.as_secs_f64()))? {
                quiet = now;
            } else if now > quiet + QUIET {
                shown.rest(now.as_secs_f64())?;
                quiet = now;
            }
        }
    }
    Ok(Outcome::Fine)
}

/// Passes on what has come; `true` when there was something.
fn pass(
    from: &mut Channel,
    to: &mut Channel,
    mut show: impl FnMut(u8) -> Result<(), UsageError>,
) -> Result<bool, UsageError> {
    let failed = |error: std::io::Error| UsageError::new(error.to_string());
    from.wait(LOOK).map_err(failed)?;
    let mut any = false;
    while to.room() > 0
        && let Some(byte) = from.receive()
    {
        any = true;
        show(byte)?;
        to.send(&[byte]);
    }
    if any {
        to.wait(Duration::ZERO).map_err(failed)?;
    }
    Ok(any)
}
