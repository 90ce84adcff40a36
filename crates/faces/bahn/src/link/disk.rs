//! `bahn link disk`: a floppy disk unit on a desk.

use std::path::PathBuf;
use std::time::Duration;

use bahn_link::blockwise::Rights;
use bahn_link::{drive, peripheral};
use clap::{Args, ValueHint};

use super::desk::{Answer, Desk, Until};
use super::port;
use crate::interrupt::Interrupt;
use crate::options::Format;
use crate::{Outcome, UsageError, console};
use bahn_ports::Trace;

pub(super) const EXAMPLES: &str = "\
Examples:
  bahn link disk parts --port tcp:127.0.0.1:4711
  bahn link disk parts --port pty:fe401
  bahn link disk parts --port serial:/dev/ttyUSB0,mode=fe1,baud=9600

The folder is the disk of an FE 401: at most 256 files, read, written and listed by a control whose interface is set to
FE. Files without write permission are protected. A control may keep its acknowledgement back as long as it wants, so
programs can be executed from this disk while they are transferred. `ready` stands on standard output when the port is
open. Exit codes: 0 ended by Ctrl-C, 1 the port cannot be opened, 2 wrong use.";

/// Options of `bahn link disk`.
#[derive(Args, Debug)]
pub(crate) struct DiskOptions {
    /// The folder that is the disk.
    #[arg(value_name = "DIR", value_hint = ValueHint::DirPath)]
    dir: PathBuf,
    /// Port at which the disk answers.
    #[arg(long, value_name = "SPEC")]
    port: String,
    /// Machine parameters of the control, for the modes ext1 and ext2.
    #[arg(long, value_name = "FILE", value_hint = ValueHint::FilePath)]
    parameters: Option<PathBuf>,
    /// Write down what passes.
    #[arg(long, value_name = "FILE", value_hint = ValueHint::FilePath)]
    trace: Option<PathBuf>,
}

/// Is a disk until Ctrl-C.
pub(super) fn command(options: &DiskOptions) -> Result<Outcome, UsageError> {
    let store = port::disk(&options.dir)?;
    let Ok(spec) = port::spec("--port", &options.port) else {
        return Ok(Outcome::ProgramError);
    };
    let Ok(list) = port::list(options.parameters.as_deref()) else {
        return Ok(Outcome::ProgramError);
    };
    let settings = port::settings(&list, &spec);
    let interrupt = Interrupt::on_ctrl_c();
    let mut trace = Trace::open(options.trace.as_deref())?;
    let Ok(mut channel) = port::open(&spec, &settings) else {
        return Ok(Outcome::ProgramError);
    };
    console::print("ready\n")?;
    let mut protocol = peripheral(settings, Box::new(store), Rights::ALL);
    let mut desk = Desk::new(settings.model, Answer::Yes, Format::Text, Until::Stopped);
    let mut tap = |sent: bool, byte: u8, now: Duration| trace.byte(sent, byte, now);
    drive(
        &mut channel,
        protocol.as_mut(),
        &mut desk,
        &interrupt.flag(),
        &mut tap,
    )
    .map_err(|error| UsageError::new(format!("{}: {error}", spec.line)))?;
    trace.finish()?;
    Ok(Outcome::Fine)
}
