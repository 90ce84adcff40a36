//! `bahn link backup` and `restore`: everything in the folder of a machine as one file.

use std::fs::File;
use std::io::BufReader;
use std::path::{Path, PathBuf};

use bahn_host::backup::{BACKUP_NAME, BackupError, Restore, back_up};
use bahn_host::{HostError, LoadedMachine, files};
use bahn_link::blockwise::Want;
use bahn_link::{FileType, Memory};
use bahn_parameters::{ControlModel, ParameterList};
use clap::{Args, ValueHint};

use super::desk::Answer;
use super::transfer;
use crate::options::Format;
use crate::{Outcome, UsageError, console, diagnostics};

pub(super) const BACKUP_EXAMPLES: &str = "\
Examples:
  bahn link backup --machine machines/mill --output mill.anc
  bahn link backup --machine machines/mill --port connect:127.0.0.1:4711,mode=fe2

All files of the folder with what it keeps over power-off, as one text of printable characters: over a line it is the
file $BACKUP of type A, which the manufacturer's programs store as $BACKUP.ANC. Exit codes: 0 it is complete, 1 the
control shows a message or a file cannot be read, 2 wrong use.";

pub(super) const RESTORE_EXAMPLES: &str = "\
Examples:
  bahn link restore --machine mill-again mill.anc
  bahn link restore --machine machines/mill --port connect:127.0.0.1:4711,mode=fe2

Nothing changes before all of it has come and every check sum is right. Files that the backup does not have stay. The
machine must be off. Exit codes: 0 restored, 1 the backup is damaged or the control shows a message, 2 wrong use.";

/// Options of `bahn link backup`.
#[derive(Args, Debug)]
pub(crate) struct BackupOptions {
    /// Folder of the machine.
    #[arg(long, value_name = "DIR", value_hint = ValueHint::DirPath)]
    machine: PathBuf,
    /// Write it into a file.
    #[arg(long, short, value_name = "FILE", value_hint = ValueHint::FilePath, required_unless_present = "port",
          conflicts_with = "port")]
    output: Option<PathBuf>,
    /// Send it to a device.
    #[arg(long, value_name = "SPEC")]
    port: Option<String>,
}

/// Options of `bahn link restore`.
#[derive(Args, Debug)]
pub(crate) struct RestoreOptions {
    /// Folder of the machine; it is made when it is missing.
    #[arg(long, value_name = "DIR", value_hint = ValueHint::DirPath)]
    machine: PathBuf,
    /// File of the backup.
    #[arg(value_name = "FILE", value_hint = ValueHint::FilePath, required_unless_present = "port", conflicts_with = "port")]
    file: Option<PathBuf>,
    /// Read it in from a device.
    #[arg(long, value_name = "SPEC")]
    port: Option<String>,
}

/// The file of a backup in a transfer.
fn name() -> String {
    format!("{BACKUP_NAME}.A")
}

fn text_type() -> Result<FileType, UsageError> {
    FileType::of_extension("A").ok_or_else(|| UsageError::new("there are no text files"))
}

/// Backs a machine up.
pub(super) fn backup(options: &BackupOptions) -> Result<Outcome, UsageError> {
    let folder = &options.machine;
    if !folder.join("machine.toml").is_file() {
        return Err(UsageError::new(format!(
            "{} is no folder of a machine",
            folder.display()
        )));
    }
    let mut text = String::new();
    let shown = folder.file_name().unwrap_or_default().to_string_lossy();
    let count = back_up(folder, &shown, |line| {
        text.push_str(line);
        text.push('\n');
        Ok(())
    });
    let count = match count {
        Ok(count) => count,
        Err(error) => return damaged(&error),
    };
    if let Some(output) = &options.output {
        files::write_whole(output, text.as_bytes())?;
        console::print(&format!("{count} files\n"))?;
        return Ok(Outcome::Fine);
    }
    let port = options.port.as_deref().unwrap_or_default();
    let memory = Memory::default();
    memory.put(&name(), text);
    let action = transfer::Action::Write(vec![name()]);
    let plan = transfer::Plan {
        port,
        kind: text_type()?,
        offered: false,
        answer: Answer::Yes,
        format: Format::Text,
        trace: None,
    };
    transfer::run(&list_of(folder), memory, action, &plan)
}

pub(super) fn restore(options: &RestoreOptions) -> Result<Outcome, UsageError> {
    let folder = &options.machine;
    std::fs::create_dir_all(folder).map_err(|error| files::cannot("make", folder, &error))?;
    is_off(folder)?;
    let read = match &options.file {
        Some(path) => {
            let file = File::open(path).map_err(|error| files::cannot("read", path, &error))?;
            Restore::read(folder, BufReader::new(file))
        }
        None => {
            let memory = Memory::default();
            let plan = transfer::Plan {
                port: options.port.as_deref().unwrap_or_default(),
                kind: text_type()?,
                offered: false,
                answer: Answer::Yes,
                format: Format::Text,
                trace: None,
            };
            let action = transfer::Action::Read(vec![Want::Selected(name())]);
            let outcome = transfer::run(&list_of(folder), memory.clone(), action, &plan)?;
            match memory.get(&name()).filter(|_| outcome == Outcome::Fine) {
                Some(text) => Restore::read(folder, text.as_bytes()),
                None => return Ok(outcome),
            }
        }
    };
    match read.and_then(Restore::commit) {
        Ok(count) => {
            console::print(&format!("{count} files\n"))?;
            Ok(Outcome::Fine)
        }
        Err(error) => damaged(&error),
    }
}

fn damaged(error: &BackupError) -> Result<Outcome, UsageError> {
    diagnostics::print_line(&format!("error: {error}"));
    Ok(Outcome::ProgramError)
}

/// Nobody has switched the machine on.
fn is_off(folder: &Path) -> Result<(), UsageError> {
    let Ok(Ok(machine)) = LoadedMachine::load(folder) else {
        // Nobody can.
        return Ok(());
    };
    match machine.is_switched_on() {
        true => {
            let state = machine.root.join(&machine.folder.state);
            let error = HostError::SwitchedOn(state.display().to_string());
            Err(UsageError::new(format!("{error}; end what runs it")))
        }
        false => Ok(()),
    }
}

/// The machine parameters of a folder, or those of the usual control where it has none that can be read.
fn list_of(folder: &Path) -> ParameterList {
    match LoadedMachine::load(folder) {
        Ok(Ok(machine)) => machine.parameters,
        _ => ParameterList::reference(ControlModel::default()),
    }
}
