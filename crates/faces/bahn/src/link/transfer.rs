//! `bahn link receive`, `send` and `list`: transfers that begin here, and the device of one that begins elsewhere.

use std::path::{Path, PathBuf};
use std::time::Duration;

use bahn_link::blockwise::{self, DirectoryRequest, Rights, Want};
use bahn_link::{FileType, Files, Protocol, Settings, Spec, drive, peripheral, standard};
use bahn_parameters::{MessageId, ParameterList};
use bahn_store::Store;
use clap::{Args, ValueEnum, ValueHint};

use super::desk::{Answer, Desk, Until};
use super::port::{self, Refused};
use crate::interrupt::Interrupt;
use crate::options::Format;
use crate::{Outcome, UsageError, console};
use bahn_ports::Trace;

/// How long a host waits after EOT whether something more comes *(inferred)*.
const LINGER: Duration = Duration::from_secs(1);

/// The code of the programs that are asked for when nothing is said: a header without a name asks for one type.
const PLAIN_LANGUAGE: char = 'H';

pub(super) const RECEIVE_EXAMPLES: &str = "\
Examples:
  bahn link receive --machine machines/mill --port connect:127.0.0.1:4711,mode=fe2 PART.H
  bahn link receive --machine mill --port serial:/dev/ttyUSB0,mode=fe1,baud=9600 --all --answer yes
  bahn link receive --as host --dir parts --port serial:/dev/ttyUSB0,mode=fe2,baud=9600 --all

With --machine it is the control that reads in: selected files, all files of a type, or those offered, each after a
question. With --as host it is the device to which a control sends: it stores in the folder until the control has sent
EOT and begins nothing more, or the line closes. A file that is there is ERASE/OVERREAD: --answer says whether it is
replaced. Exit codes: 0 the transfer is complete, 1 the control shows a message, which stands word for word in the
output, 2 wrong use. docs/link.md tells of ports, modes and cables.";

pub(super) const SEND_EXAMPLES: &str = "\
Examples:
  bahn link send --machine machines/mill --port connect:127.0.0.1:4711,mode=fe2 CIRCLE.H
  bahn link send --machine machines/mill --port connect:127.0.0.1:4711,mode=fe2 --all
  bahn link send --as host --dir parts --port serial:/dev/ttyUSB0,mode=fe2,baud=9600 PART.H

With --machine it is the control that sends: named files, all programs of both languages or with --type all files of one
type, with --offered each after a question. With --as host it is the device from which a control reads in: it has the
named files of the folder, or all of them. Exit codes: 0 the transfer is complete, 1 the control shows a message, which
stands word for word in the output, 2 wrong use.";

pub(super) const LIST_EXAMPLES: &str = "\
Examples:
  bahn link list --machine machines/mill --port connect:127.0.0.1:4711,mode=fe1
  bahn link list --machine machines/mill --port connect:127.0.0.1:4711,mode=fe2 --format json

The control asks the device for its directory: in mode fe1 by the escape sequence, which tells sectors, too; otherwise by
the first lines of its files. Exit codes: 0 it has come, 1 the control shows a message, 2 wrong use.";

/// Which side of the line is played.
#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
enum Role {
    /// The device of a control.
    Host,
}

/// Options of `bahn link receive` and `send`.
#[derive(Args, Debug)]
pub(crate) struct TransferOptions {
    /// Folder of the machine whose control it is.
    #[arg(long, value_name = "DIR", value_hint = ValueHint::DirPath, conflicts_with_all = ["role", "dir"],
          required_unless_present = "role")]
    machine: Option<PathBuf>,
    /// Play the device instead.
    #[arg(long = "as", id = "role", value_name = "ROLE", value_enum, requires = "dir")]
    role: Option<Role>,
    /// Folder of the device.
    #[arg(long, value_name = "DIR", value_hint = ValueHint::DirPath, requires = "role")]
    dir: Option<PathBuf>,
    /// Machine parameters of the device, for the modes ext1 and ext2.
    #[arg(long, value_name = "FILE", value_hint = ValueHint::FilePath, requires = "role")]
    parameters: Option<PathBuf>,
    /// Port of the other side.
    #[arg(long, value_name = "SPEC")]
    port: String,
    /// Files, with extension.
    #[arg(value_name = "NAME", conflicts_with_all = ["all", "offered"])]
    names: Vec<String>,
    /// All files of the type.
    #[arg(long, conflicts_with = "offered")]
    all: bool,
    /// Each file after a question.
    #[arg(long, conflicts_with = "role")]
    offered: bool,
    /// Code letter of the type of files that --all and --offered mean; without it send means programs of both languages,
    /// receive H.
    #[arg(long = "type", value_name = "CODE")]
    kind: Option<char>,
    /// What is answered to ERASE/OVERREAD and to what is offered.
    #[arg(long, value_name = "WHAT", value_enum, default_value_t)]
    answer: Answer,
    /// Write down what passes.
    #[arg(long, value_name = "FILE", value_hint = ValueHint::FilePath)]
    trace: Option<PathBuf>,
    /// How the outcome is written.
    #[arg(long, value_name = "FORMAT", value_enum, default_value_t)]
    format: Format,
}

/// Options of `bahn link list`.
#[derive(Args, Debug)]
pub(crate) struct ListOptions {
    /// Folder of the machine whose control asks.
    #[arg(long, value_name = "DIR", value_hint = ValueHint::DirPath)]
    machine: PathBuf,
    /// Port of the device.
    #[arg(long, value_name = "SPEC")]
    port: String,
    /// Code letter of the type of files.
    #[arg(long = "type", value_name = "CODE", default_value = "H")]
    kind: char,
    /// Write down what passes.
    #[arg(long, value_name = "FILE", value_hint = ValueHint::FilePath)]
    trace: Option<PathBuf>,
    /// How the outcome is written.
    #[arg(long, value_name = "FORMAT", value_enum, default_value_t)]
    format: Format,
}

pub(super) fn receive(options: &TransferOptions) -> Result<Outcome, UsageError> {
    transfer(options, true)
}

pub(super) fn send(options: &TransferOptions) -> Result<Outcome, UsageError> {
    transfer(options, false)
}

fn transfer(options: &TransferOptions, receives: bool) -> Result<Outcome, UsageError> {
    let plan = Plan {
        port: &options.port,
        kind: kind(options.kind.unwrap_or(PLAIN_LANGUAGE))?,
        offered: options.offered,
        answer: options.answer,
        format: options.format,
        trace: options.trace.as_deref(),
    };
    match (&options.machine, &options.dir) {
        (Some(machine), _) => {
            if options.names.is_empty() && !options.all && !options.offered {
                return Err(UsageError::new("name files, or give --all or --offered"));
            }
            let Some(machine) = port::machine(machine)? else {
                return Ok(Outcome::ProgramError);
            };
            let action = match receives {
                true => Action::Read(wants(options)),
                false => Action::Write(names(&machine.store, options)?),
            };
            run(&machine.list, machine.store, action, &plan)
        }
        (None, Some(dir)) => {
            let store = port::disk(dir)?;
            let list = match port::list(options.parameters.as_deref()) {
                Ok(list) => list,
                Err(Refused) => return Ok(Outcome::ProgramError),
            };
            let rights = Rights {
                gives: !receives,
                takes: receives,
                only: options.names.clone(),
                asks: receives && options.answer != Answer::Yes,
            };
            if !receives {
                names(&store, options)?;
            }
            run(&list, store, Action::Serve(rights), &plan)
        }
        (None, None) => Err(UsageError::new("--machine DIR or --as host --dir DIR is needed")),
    }
}

fn kind(code: char) -> Result<FileType, UsageError> {
    FileType::of_code(code).ok_or_else(|| {
        let mut codes: Vec<char> = FileType::all().map(FileType::code).collect();
        codes.dedup();
        let codes: String = codes.into_iter().collect();
        UsageError::new(format!("--type {code}: no code of a file; they are {codes}"))
    })
}

fn wants(options: &TransferOptions) -> Vec<Want> {
    match (options.all, options.offered) {
        (true, _) => vec![Want::All],
        (_, true) => vec![Want::Offered],
        _ => options.names.iter().cloned().map(Want::Selected).collect(),
    }
}

/// The files that are sent: they must be there.
fn names(store: &Store, options: &TransferOptions) -> Result<Vec<String>, UsageError> {
    let mut store = store.clone();
    for name in &options.names {
        if Files::find(&mut store, name).is_none() {
            return Err(UsageError::new(format!("there is no file {name}")));
        }
    }
    if !options.names.is_empty() {
        return Ok(options.names.clone());
    }
    let all = Files::list(&mut store).into_iter().map(|file| file.name);
    let of_type = |name: &String| {
        let extension = name
            .rsplit_once('.')
            .and_then(|(_, of)| FileType::of_extension(of));
        extension.is_some_and(|kind| match options.kind {
            Some(code) => kind.code() == code.to_ascii_uppercase(),
            None => kind.is_program(),
        })
    };
    Ok(all.filter(of_type).collect())
}

/// How a command does it.
pub(super) struct Plan<'a> {
    /// The port as it is written.
    pub port: &'a str,
    /// Type of the files that have no name yet.
    pub kind: FileType,
    /// Each file is offered before it is sent.
    pub offered: bool,
    pub answer: Answer,
    pub format: Format,
    pub trace: Option<&'a Path>,
}

/// What a command does.
pub(super) enum Action {
    /// The control reads in, one after the other.
    Read(Vec<Want>),
    /// The control sends these files.
    Write(Vec<String>),
    /// The device answers what the control asks.
    Serve(Rights),
}

/// Does it with files, as machine parameters say.
pub(super) fn run(
    list: &ParameterList,
    files: impl Files + Clone + 'static,
    action: Action,
    plan: &Plan<'_>,
) -> Result<Outcome, UsageError> {
    let Ok(spec) = port::spec("--port", plan.port) else {
        return Ok(Outcome::ProgramError);
    };
    let settings = port::settings(list, &spec);
    let (protocols, until): (Vec<Box<dyn Protocol>>, Until) = match action {
        Action::Read(wants) => {
            let read = |want| reading(settings, Box::new(files.clone()), want, plan.kind);
            (wants.into_iter().map(read).collect(), Until::Ended)
        }
        Action::Write(names) => {
            let protocol: Box<dyn Protocol> = match settings.blockwise {
                true => Box::new(blockwise::Writing::new(
                    settings,
                    Box::new(files),
                    names,
                    plan.offered,
                )),
                false => Box::new(standard::Writing::new(
                    settings,
                    Box::new(files),
                    names,
                    plan.offered,
                )),
            };
            (vec![protocol], Until::Ended)
        }
        Action::Serve(rights) => {
            let protocol = peripheral(settings, Box::new(files), rights);
            (vec![protocol], Until::Quiet(LINGER.min(settings.patience)))
        }
    };
    let desk = Desk::new(settings.model, plan.answer, plan.format, until);
    talk(&spec, settings, protocols, desk, plan.trace)
}

fn reading(settings: Settings, files: Box<dyn Files>, want: Want, kind: FileType) -> Box<dyn Protocol> {
    match settings.blockwise {
        true => Box::new(blockwise::Reading::new(settings, files, want, kind)),
        false => Box::new(standard::Reading::new(settings, files, want, kind)),
    }
}

/// Asks for a directory.
pub(super) fn list(options: &ListOptions) -> Result<Outcome, UsageError> {
    let kind = kind(options.kind)?;
    let Some(machine) = port::machine(&options.machine)? else {
        return Ok(Outcome::ProgramError);
    };
    let Ok(spec) = port::spec("--port", &options.port) else {
        return Ok(Outcome::ProgramError);
    };
    let settings = port::settings(&machine.list, &spec);
    let protocol: Box<dyn Protocol> = match settings.asks_directory {
        true => Box::new(DirectoryRequest::new(settings)),
        false => reading(settings, Box::new(machine.store), Want::Directory, kind),
    };
    let desk = Desk::new(settings.model, Answer::No, options.format, Until::Ended);
    talk(&spec, settings, vec![protocol], desk, options.trace.as_deref())
}

/// Opens the port and drives protocols on it, one after the other, until they have ended or one has failed.
pub(super) fn talk(
    spec: &Spec,
    settings: Settings,
    protocols: Vec<Box<dyn Protocol>>,
    mut desk: Desk,
    trace: Option<&Path>,
) -> Result<Outcome, UsageError> {
    let interrupt = Interrupt::on_ctrl_c();
    let mut trace = Trace::open(trace)?;
    let Ok(mut channel) = port::open(spec, &settings) else {
        return Ok(Outcome::ProgramError);
    };
    if !channel.is_ready() {
        // DSR is off [000:16782-16800].
        console::print_line(MessageId::ExtInOutputNotReady.text(settings.model))?;
        return Ok(Outcome::ProgramError);
    }
    for mut protocol in protocols {
        let mut tap = |sent: bool, byte: u8, now: Duration| trace.byte(sent, byte, now);
        drive(
            &mut channel,
            protocol.as_mut(),
            &mut desk,
            &interrupt.flag(),
            &mut tap,
        )
        .map_err(|error| UsageError::new(format!("{}: {error}", spec.line)))?;
        if desk.has_failed() {
            break;
        }
    }
    trace.finish()?;
    desk.finish()
}
