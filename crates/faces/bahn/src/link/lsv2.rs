//! `bahn link lsv2`: a host that asks a control.

use std::fs::File;
use std::io::Write as _;
use std::path::{Path, PathBuf};

use bahn_host::files::NewFile;
use bahn_link::lsv2::{Client, ClientError, Command, Level, RemoteEntry, TcpTransport, Telegram};
use clap::{Args, Subcommand, ValueHint};
use serde_json::json;

use crate::options::Format;
use crate::{Outcome, UsageError, console, diagnostics};

pub(super) const EXAMPLES: &str = "\
Examples:
  bahn link lsv2 ls 127.0.0.1:19000                      what is on TNC:
  bahn link lsv2 ls 127.0.0.1:19000 TNC:/PARTS
  bahn link lsv2 get 127.0.0.1:19000 TNC:/BRACKET.H bracket.h
  bahn link lsv2 put 127.0.0.1:19000 bracket.h TNC:/PARTS/BRACKET.H
  bahn link lsv2 rm 127.0.0.1:19000 TNC:/PARTS/BRACKET.H
  bahn link lsv2 info 127.0.0.1:19000                    versions, program, positions, messages
  bahn link lsv2 screen 127.0.0.1:19000 screen.bmp

Any control with LSV/2 on TCP answers. Files travel as they are, byte for byte; put replaces a file when the new one
has arrived as a whole, get a local one likewise. --password gives the password of a level where one is set. Exit codes:
0 done, 1 the control refuses or does not answer, 2 wrong use.";

/// Options of `bahn link lsv2`.
#[derive(Args, Debug)]
pub(crate) struct Lsv2Options {
    #[command(subcommand)]
    pub command: Lsv2Command,
    /// Password of a level.
    #[arg(long = "password", value_name = "LEVEL=TEXT", global = true)]
    pub passwords: Vec<String>,
    /// How it is written.
    #[arg(long, value_name = "FORMAT", value_enum, default_value_t, global = true)]
    pub format: Format,
}

/// What the control is asked for.
#[derive(Debug, Subcommand)]
pub(crate) enum Lsv2Command {
    /// List the files of a folder.
    Ls {
        /// Address and port of the control.
        #[arg(value_name = "ADDR:PORT")]
        address: String,
        /// The folder; TNC: by default.
        path: Option<String>,
    },
    /// Fetch a file from the control.
    Get {
        /// Address and port of the control.
        #[arg(value_name = "ADDR:PORT")]
        address: String,
        /// The file on the control.
        remote: String,
        /// Where the file is written here.
        #[arg(value_hint = ValueHint::FilePath)]
        local: PathBuf,
    },
    /// Bring a file to the control.
    Put {
        /// Address and port of the control.
        #[arg(value_name = "ADDR:PORT")]
        address: String,
        /// The file here that is sent.
        #[arg(value_hint = ValueHint::FilePath)]
        local: PathBuf,
        /// The file on the control.
        remote: String,
    },
    /// Delete a file on the control.
    Rm {
        /// Address and port of the control.
        #[arg(value_name = "ADDR:PORT")]
        address: String,
        /// The file on the control.
        remote: String,
    },
    /// Say what the control is and what it does.
    Info {
        /// Address and port of the control.
        #[arg(value_name = "ADDR:PORT")]
        address: String,
    },
    /// Fetch its screen as a picture.
    Screen {
        /// Address and port of the control.
        #[arg(value_name = "ADDR:PORT")]
        address: String,
        /// Where the picture is written, BMP.
        #[arg(value_hint = ValueHint::FilePath)]
        local: PathBuf,
    },
}

pub(super) fn command(options: &Lsv2Options) -> Result<Outcome, UsageError> {
    let done = match &options.command {
        Lsv2Command::Ls { address, path } => list(options, address, path.as_deref()),
        Lsv2Command::Get {
            address,
            remote,
            local,
        } => get(options, address, remote, local),
        Lsv2Command::Put {
            address,
            local,
            remote,
        } => put(options, address, local, remote),
        Lsv2Command::Rm { address, remote } => {
            connect(options, address, Some(Level::File)).and_then(|mut client| Ok(client.delete(remote)?))
        }
        Lsv2Command::Info { address } => info(options, address),
        Lsv2Command::Screen { address, local } => screen(options, address, local),
    };
    match done {
        Ok(()) => Ok(Outcome::Fine),
        Err(Failed::Use(error)) => Err(error),
        Err(Failed::Control(text)) => {
            say(options, &text)?;
            Ok(Outcome::ProgramError)
        }
    }
}

/// Why it was not done.
enum Failed {
    Use(UsageError),
    Control(String),
}

impl From<ClientError> for Failed {
    fn from(error: ClientError) -> Failed {
        Failed::Control(error.to_string())
    }
}

impl From<UsageError> for Failed {
    fn from(error: UsageError) -> Failed {
        Failed::Use(error)
    }
}

fn say(options: &Lsv2Options, text: &str) -> Result<(), UsageError> {
    match options.format {
        Format::Json => console::print_json_line(&json!({ "message": text }))?,
        Format::Text => diagnostics::print_line(&format!("error: {text}")),
    }
    Ok(())
}

fn password(options: &Lsv2Options, level: Level) -> Result<Option<&str>, UsageError> {
    let mut found = None;
    for assignment in &options.passwords {
        let (name, text) = assignment
            .split_once('=')
            .ok_or_else(|| UsageError::new(format!("{assignment} is not LEVEL=TEXT")))?;
        let named: Level = name.parse().map_err(UsageError::new)?;
        if named == level {
            found = Some(text);
        }
    }
    Ok(found)
}

fn connect(
    options: &Lsv2Options,
    address: &str,
    level: Option<Level>,
) -> Result<Client<TcpTransport>, Failed> {
    let inspect = password(options, Level::Inspect)?;
    let transport =
        TcpTransport::connect(address).map_err(|error| Failed::Control(format!("{address}: {error}")))?;
    let mut client = Client::open(transport, inspect)?;
    if let Some(level) = level {
        client.log_in(level, password(options, level)?)?;
    }
    Ok(client)
}

/// Files of the PLC need a login of their own.
fn level_of(path: &str) -> Level {
    match path
        .get(..4)
        .is_some_and(|drive| drive.eq_ignore_ascii_case("PLC:"))
    {
        true => Level::FilePlc,
        false => Level::File,
    }
}

fn list(options: &Lsv2Options, address: &str, path: Option<&str>) -> Result<(), Failed> {
    let mut client = connect(options, address, Some(level_of(path.unwrap_or_default())))?;
    let entries = client.list(path)?;
    let text = match options.format {
        Format::Json => format!("{}\n", json!(entries.iter().map(entry).collect::<Vec<_>>())),
        Format::Text => entries.iter().map(line).collect(),
    };
    Ok(console::print(&text)?)
}

fn entry(entry: &RemoteEntry) -> serde_json::Value {
    json!({
        "name": entry.name,
        "size": entry.size,
        "folder": entry.is_folder,
        "protected": entry.protected,
    })
}

fn line(entry: &RemoteEntry) -> String {
    match entry.is_folder {
        true => format!("{:>10}    {}\\\n", "", entry.name),
        false => {
            let mark = if entry.protected { 'P' } else { ' ' };
            format!("{:>10} {mark}  {}\n", entry.size, entry.name)
        }
    }
}

fn get(options: &Lsv2Options, address: &str, remote: &str, local: &Path) -> Result<(), Failed> {
    let mut client = connect(options, address, Some(level_of(remote)))?;
    let mut file = NewFile::create(local).map_err(UsageError::from)?;
    client.get(remote, &mut file)?;
    Ok(file.finish().map_err(UsageError::from)?)
}

fn put(options: &Lsv2Options, address: &str, local: &Path, remote: &str) -> Result<(), Failed> {
    let mut file = File::open(local)
        .map_err(|error| UsageError::from(bahn_host::files::cannot("read", local, &error)))?;
    let mut client = connect(options, address, Some(level_of(remote)))?;
    client.put(&mut file, remote)?;
    Ok(())
}

fn screen(options: &Lsv2Options, address: &str, local: &Path) -> Result<(), Failed> {
    let mut client = connect(options, address, Some(Level::File))?;
    let bytes = client.screen()?;
    let mut file = NewFile::create(local).map_err(UsageError::from)?;
    file.write_all(&bytes).map_err(ClientError::from)?;
    Ok(file.finish().map_err(UsageError::from)?)
}

/// What a control answers to a request about its run; one that it does not know is left out.
fn run(client: &mut Client<TcpTransport>, which: u16) -> Result<Option<Telegram>, ClientError> {
    match client.ask(&Telegram::new(Command(*b"R_RI")).word(which)) {
        Ok(answer) => Ok(Some(answer)),
        Err(ClientError::Device(_)) => Ok(None),
        Err(error) => Err(error),
    }
}

/// Words of `R_RI` 23 and 26 (public).
const EXECUTION: [&str; 5] = [
    "manual operation",
    "manual data input",
    "reference marks",
    "single block",
    "full sequence",
];
const STATES: [&str; 8] = [
    "runs",
    "stopped",
    "finished",
    "cancelled",
    "interrupted",
    "error",
    "error cleared",
    "idle",
];

fn info(options: &Lsv2Options, address: &str) -> Result<(), Failed> {
    let mut client = connect(options, address, Some(Level::Dnc))?;
    let word = |answer: Option<Telegram>, words: &[&str]| {
        let number = answer.and_then(|answer| answer.fields().word())?;
        words.get(usize::from(number)).map(|word| (*word).to_owned())
    };
    let execution = word(run(&mut client, 23)?, &EXECUTION);
    let state = word(run(&mut client, 26)?, &STATES);
    let program = run(&mut client, 24)?.and_then(|answer| {
        let mut fields = answer.fields();
        Some((fields.long()?, fields.string()?))
    });
    let axes = run(&mut client, 22)?
        .map(|answer| axes(&answer))
        .unwrap_or_default();
    let overrides = run(&mut client, 25)?.map(|answer| {
        let mut fields = answer.fields();
        std::iter::from_fn(|| fields.long())
            .map(|hundredths| f64::from(hundredths) / 100.0)
            .collect::<Vec<f64>>()
    });
    let tool = run(&mut client, 51)?.and_then(|answer| answer.fields().long());
    let messages = messages(&mut client)?;
    let versions = client.versions().to_vec();
    let value = json!({
        "control": versions.first(),
        "nc_software": versions.get(1),
        "plc_software": versions.get(2),
        "mode": execution,
        "state": state,
        "block": program.as_ref().map(|(block, _)| block),
        "program": program.as_ref().map(|(_, name)| name),
        "position": axes.iter().cloned().collect::<serde_json::Map<String, serde_json::Value>>(),
        "overrides": overrides,
        "tool": tool,
        "messages": messages,
    });
    let text = match options.format {
        Format::Json => format!("{value}\n"),
        Format::Text => lines(&value),
    };
    Ok(console::print(&text)?)
}

/// Values as text, then letters, as many of each as the second byte says.
fn axes(answer: &Telegram) -> Vec<(String, serde_json::Value)> {
    let mut fields = answer.fields();
    fields.byte();
    let count = usize::from(fields.byte().unwrap_or(0));
    let texts: Vec<String> = std::iter::from_fn(|| fields.string()).take(2 * count).collect();
    let letters = texts.iter().skip(count);
    let number = |text: &String| {
        text.trim()
            .parse::<f64>()
            .map_or(json!(text), |value| json!(value))
    };
    letters
        .zip(&texts)
        .map(|(letter, value)| (letter.clone(), number(value)))
        .collect()
}

/// The messages that are shown.
fn messages(client: &mut Client<TcpTransport>) -> Result<Vec<String>, ClientError> {
    /// More are not asked for.
    const MOST: usize = 100;
    let mut messages = Vec::new();
    let mut which = 27;
    while messages.len() < MOST
        && let Some(answer) = run(client, which)?
    {
        let mut fields = answer.fields();
        let (_, _, _) = (fields.word(), fields.word(), fields.long());
        messages.push(fields.string().unwrap_or_default());
        which = 28;
    }
    Ok(messages)
}

/// One value in a line.
fn lines(value: &serde_json::Value) -> String {
    let Some(object) = value.as_object() else {
        return String::new();
    };
    let word = |value: &serde_json::Value| match value {
        serde_json::Value::String(text) => text.clone(),
        serde_json::Value::Null => "-".to_owned(),
        serde_json::Value::Array(items) => {
            let items: Vec<String> = items
                .iter()
                .map(|item| item.as_str().map_or(item.to_string(), str::to_owned))
                .collect();
            items.join(", ")
        }
        serde_json::Value::Object(items) => {
            let items: Vec<String> = items
                .iter()
                .map(|(name, value)| format!("{name} {value}"))
                .collect();
            items.join("  ")
        }
        other => other.to_string(),
    };
    object
        .iter()
        .map(|(name, value)| format!("{:<13} {}\n", name.replace('_', " "), word(value)))
        .collect()
}
