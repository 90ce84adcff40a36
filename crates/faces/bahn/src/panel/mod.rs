//! `bahn panel`: the operating panel of a machine that is on.

mod options;
mod shown;
mod system900;

pub(crate) use options::{EXAMPLES, PanelOptions};

use std::io::Write as _;
use std::path::{Path, PathBuf};

use bahn_host::files::NewFile;
use bahn_host::{LoadedMachine, Machine900, PowerOn};
use bahn_panel::{Input, Live, Replay, Station, live_replay};
use bahn_ports::{PanelPorts, RunningPorts};
use bahn_server::{Server, ServerOptions, Tokens};
use bahn_service::MachineService;

use shown::{in_use, in_words, say_page, terminal};

use crate::interrupt::Interrupt;
use crate::{Outcome, UsageError, diagnostics, files, link, machine_folder};

/// Switches the machine on and shows its panel until Ctrl-C.
pub(crate) fn command(options: &PanelOptions) -> Result<Outcome, UsageError> {
    let served = options.address().map(|listen| ServerOptions {
        listen,
        tokens: Tokens {
            operate: options.token.clone(),
            look: options.viewer_token.clone(),
        },
    });
    if let Some(served) = &served {
        served
            .check()
            .map_err(|error| UsageError::new(error.to_string()))?;
    }
    if options.in_the_terminal() {
        terminal::check()?;
    }
    let folder = match &options.machine {
        Some(folder) => folder.clone(),
        None => own_mill()?,
    };
    if Machine900::is_meant(&folder) {
        return system900::command(options, &folder, served);
    }
    let machine: LoadedMachine = match machine_folder::load_to_enter(&folder)? {
        Ok(machine) => machine,
        Err(faults) => {
            diagnostics::print_faults(&faults);
            return Ok(Outcome::ProgramError);
        }
    };
    let name = machine.folder.name.clone();
    let named = [options.rs232.as_ref(), options.rs422.as_ref()];
    let Some(ports) = link::panel_ports(named, &machine.parameters) else {
        return Ok(Outcome::ProgramError);
    };
    let power_on = PowerOn::kept(&machine).map_err(in_use)?;
    diagnostics::print_warnings(&power_on.warnings);
    let mut station = Station::with(machine, power_on)?;
    station
        .input(&Input::Speed(options.speed))
        .map_err(|refusal| UsageError::new(refusal.to_string()))?;
    if let Some(path) = &options.record {
        station.record(path).map_err(UsageError::new)?;
    }
    let interrupt = Interrupt::on_ctrl_c();
    let desk = Desk::open(begin(station, options)?, served, ports, options)?;
    if let Some(server) = &desk.server {
        say_page(options, &name, server);
    }
    let shown = shown::show(options, desk.machine.clone(), &interrupt, || {
        desk.live.has_ended()
    });
    // Whatever became of the terminal, what was done is kept.
    desk.end()?;
    shown.map(|()| Outcome::Fine)
}

/// A station that runs, with its data interfaces, and served or not.
struct Desk {
    live: Live,
    machine: MachineService,
    ports: RunningPorts,
    server: Option<Server>,
}

impl Desk {
    /// What the station has done is kept, also when something of it cannot be opened.
    fn open(
        live: Live,
        served: Option<ServerOptions>,
        ports: PanelPorts,
        options: &PanelOptions,
    ) -> Result<Desk, UsageError> {
        match Desk::serve(&live, served, ports, options) {
            Ok((machine, ports, server)) => Ok(Desk {
                live,
                machine,
                ports,
                server,
            }),
            Err(error) => {
                live.end().map_err(UsageError::new)?;
                Err(error)
            }
        }
    }

    fn serve(
        live: &Live,
        served: Option<ServerOptions>,
        ports: PanelPorts,
        options: &PanelOptions,
    ) -> Result<(MachineService, RunningPorts, Option<Server>), UsageError> {
        let machine = MachineService::of(live).map_err(in_words)?;
        let server = served.map(|served| Server::start(machine.clone(), served));
        let server = server.transpose().map_err(in_words)?;
        let ports = ports.start(&machine, options.print.as_deref())?;
        Ok((machine, ports, server))
    }

    /// Ends; what must survive is on the medium.
    fn end(self) -> Result<(), UsageError> {
        let recorded = self.live.link().with(Station::end_recording);
        recorded
            .map_err(|refusal| UsageError::new(refusal.to_string()))?
            .map_err(UsageError::new)?;
        self.ports.end();
        if let Some(server) = self.server {
            server.end();
        }
        self.live.end().map_err(UsageError::new)
    }
}

/// Lets the station run, after a session that is to be shown.
fn begin(station: Station, options: &PanelOptions) -> Result<Live, UsageError> {
    let Some(path) = &options.replay else {
        return Ok(Live::start(station));
    };
    let replay = Replay::read(path).map_err(UsageError::new)?;
    for difference in replay.differences(&station) {
        diagnostics::print_line(&format!("warning: {difference}"));
    }
    Ok(live_replay(station, replay))
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
