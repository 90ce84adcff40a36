//! `bahn panel`: the operating panel of a machine that is on.

mod options;

pub(crate) use options::{EXAMPLES, PanelOptions};

use std::io::Write as _;
use std::path::{Path, PathBuf};
use std::process::{Command, Stdio};
use std::time::Duration;

use bahn_host::files::NewFile;
use bahn_host::{HostError, LoadedMachine};
use bahn_panel::{Input, Replay, Station};
use bahn_server::{Server, ServerOptions};

use crate::interrupt::Interrupt;
use crate::{Outcome, UsageError, diagnostics, files, machine_folder};

/// How often Ctrl-C is looked for.
const LOOK: Duration = Duration::from_millis(50);

/// A panel goes on with what the machine has kept: only one at a time can.
fn in_use(error: HostError) -> UsageError {
    match error {
        HostError::SwitchedOn(_) => UsageError(format!(
            "{error}; end what runs it, or give another folder with --machine (`bahn machine new` makes one)"
        )),
        other => other.into(),
    }
}

/// Switches the machine on and serves its panel until Ctrl-C.
pub(crate) fn command(options: &PanelOptions) -> Result<Outcome, UsageError> {
    let mut served = ServerOptions {
        listen: options.listen,
        token: options.token.clone(),
        replay: None,
    };
    served
        .check()
        .map_err(|error| UsageError::new(error.to_string()))?;
    let folder = match &options.machine {
        Some(folder) => folder.clone(),
        None => own_mill()?,
    };
    let machine: LoadedMachine = match machine_folder::load(&folder)? {
        Ok(machine) => machine,
        Err(faults) => {
            diagnostics::print_faults(&faults);
            return Ok(Outcome::ProgramError);
        }
    };
    let name = machine.folder.name.clone();
    let mut station = Station::power_on(machine).map_err(in_use)?;
    station
        .input(&Input::Speed(options.speed))
        .map_err(|refusal| UsageError::new(refusal.to_string()))?;
    if let Some(path) = &options.record {
        station.record(path).map_err(UsageError::new)?;
    }
    if let Some(path) = &options.replay {
        served.replay = Some(Replay::read(path).map_err(UsageError::new)?);
    }
    for difference in served
        .replay
        .iter()
        .flat_map(|replay| replay.differences(&station))
    {
        diagnostics::print_line(&format!("warning: {difference}"));
    }
    let interrupt = Interrupt::on_ctrl_c();
    let server = Server::start(station, served).map_err(|error| UsageError::new(error.to_string()))?;
    let address = page_address(&server, options);
    diagnostics::print_text(&format!(
        "{name}: the panel is at {address}; Ctrl-C switches the machine off"
    ));
    if options.open {
        open(&address);
    }
    while !interrupt.is_requested() {
        std::thread::sleep(LOOK);
    }
    let recorded = server.link().with(Station::end_recording);
    recorded
        .map_err(|refusal| UsageError::new(refusal.to_string()))?
        .map_err(UsageError::new)?;
    server.end().map_err(UsageError::new)?;
    Ok(Outcome::Fine)
}

/// Where a browser finds the page, with the token.
fn page_address(server: &Server, options: &PanelOptions) -> String {
    let address = server.address();
    match &options.token {
        Some(token) => format!("http://{address}/?token={token}"),
        None => format!("http://{address}/"),
    }
}

/// Who has no browser opens the page elsewhere.
fn open(address: &str) {
    let opener = if cfg!(target_os = "macos") {
        "open"
    } else {
        "xdg-open"
    };
    let opened = Command::new(opener)
        .arg(address)
        .stdin(Stdio::null())
        .stdout(Stdio::null())
        .stderr(Stdio::null())
        .spawn();
    if opened.is_err() {
        diagnostics::print_text("no browser was found here: open that address in one");
    }
}

/// The folder of the mill that needs no other: written when it is not there, and what is there stays.
fn own_mill() -> Result<PathBuf, UsageError> {
    let variable = |name: &str| {
        std::env::var_os(name)
            .filter(|value| !value.is_empty())
            .map(PathBuf::from)
    };
    let data = variable("XDG_DATA_HOME").or_else(|| Some(variable("HOME")?.join(".local/share")));
    let data = data.ok_or_else(|| {
        UsageError::new("there is no data folder: neither XDG_DATA_HOME nor HOME is set; --machine names one")
    })?;
    let folder = data.join("bahn/mill");
    for (file, text) in bahn_machines::MILL.files {
        let path = folder.join(file);
        if !path.exists() {
            write(&path, text)?;
        }
    }
    Ok(folder)
}

fn write(path: &Path, content: &str) -> Result<(), UsageError> {
    if let Some(folder) = path.parent() {
        std::fs::create_dir_all(folder).map_err(|error| files::cannot("make", folder, &error))?;
    }
    let mut file = NewFile::create(path)?;
    file.write_all(content.as_bytes())
        .map_err(|error| files::cannot("write", path, &error))?;
    Ok(file.finish()?)
}
