//! `bahn link serve`: a machine that is on and answers on its data interfaces.

use std::io::Write as _;
use std::sync::Arc;
use std::time::Duration;

use bahn_host::{HostError, PowerOn};
use bahn_link::lsv2::{OpenPort, Passwords, ServerOptions, Site};
use bahn_ports::serial_ports::{Attendance, Port, Serving};
use bahn_ports::{MachineDevice, PlcLines};
use bahn_service::{Live, MachineService, Station};

use super::desk::{Answer, Desk, Until};
use super::options::ServeOptions;
use super::port::tell;
use super::serial_ports;
use crate::interrupt::Interrupt;
use crate::options::Format;
use crate::{Outcome, UsageError, diagnostics, machine_folder};

/// How often Ctrl-C is looked for, and what the PLC wants of its lines.
const LOOK: Duration = Duration::from_millis(10);

/// Switches the machine on and answers until Ctrl-C.
pub(super) fn command(options: &ServeOptions) -> Result<Outcome, UsageError> {
    let (lsv2, passwords) = lsv2_options(options)?;
    let Ok(specs) = serial_ports::specs([options.rs232.as_ref(), options.rs422.as_ref()]) else {
        return Ok(Outcome::ProgramError);
    };
    let machine = match machine_folder::load(&options.machine)? {
        Ok(machine) => machine,
        Err(faults) => {
            diagnostics::print_faults(&faults);
            return Ok(Outcome::ProgramError);
        }
    };
    let Ok(ports) = serial_ports::open(&specs, &machine.parameters) else {
        return Ok(Outcome::ProgramError);
    };
    let lsv2 = match lsv2.map(|options| open(&options)).transpose() {
        Ok(lsv2) => lsv2,
        Err(error) => {
            diagnostics::print_line(&format!("error: {error}"));
            return Ok(Outcome::ProgramError);
        }
    };
    let power_on = PowerOn::kept(&machine).map_err(|error| match error {
        HostError::SwitchedOn(_) => UsageError::new(format!("{error}; end what runs it")),
        other => other.into(),
    })?;
    diagnostics::print_warnings(&power_on.warnings);
    let station = Station::with(machine, power_on)?;
    let interrupt = Interrupt::on_ctrl_c();
    let live = Live::start(station);
    let opened = Opened {
        ports,
        lsv2,
        passwords,
    };
    let answered = answer(&live, opened, options, &interrupt);
    // Whatever became of the ports, what must survive is kept.
    live.end().map_err(UsageError::new)?;
    answered.map(|()| Outcome::Fine)
}

/// The ports of the machine, which are open.
struct Opened {
    ports: Vec<Port>,
    lsv2: Option<OpenPort>,
    passwords: Passwords,
}

/// Answers until Ctrl-C, or until the machine has ended.
fn answer(
    live: &Live,
    opened: Opened,
    options: &ServeOptions,
    interrupt: &Interrupt,
) -> Result<(), UsageError> {
    let Opened {
        ports,
        lsv2,
        passwords,
    } = opened;
    let machine = MachineService::of(live).map_err(in_words)?;
    let of_plc = serial_ports::of_plc(&ports);
    let mut lines = PlcLines::new(&machine, of_plc, options.print.as_deref(), tell())?;
    let device = MachineDevice::new(&machine, options.identity.as_deref()).map_err(in_words)?;
    let site = Arc::new(Site::new(Arc::new(device), passwords));
    let server = lsv2.map(|port| port.serve(Arc::clone(&site))).transpose();
    let server = server.map_err(in_words)?;
    let serving = Serving::start(ports, &site, &attendance(options.answer), options.trace.as_ref())?;
    // Whoever has closed the output knows.
    let _ = writeln!(std::io::stdout(), "ready").and_then(|()| std::io::stdout().flush());
    lines.begin();
    while !interrupt.is_requested() && !live.has_ended() {
        lines.carry();
        std::thread::sleep(LOOK);
    }
    drop(server);
    serving.end()?;
    Ok(())
}

fn in_words(error: impl std::fmt::Display) -> UsageError {
    UsageError::new(error.to_string())
}

/// Who attends the ports, and answers what is asked there.
fn attendance(answer: Answer) -> Attendance {
    Attendance {
        asks: answer != Answer::Yes,
        attendant: Arc::new(move |model, name, stored| {
            let desk = Desk::new(model, answer, Format::Text, Until::Stopped);
            Box::new(desk.of_port(name).when_stored(stored))
        }),
        tell: tell(),
    }
}

/// Where LSV/2 answers, and to whom.
fn lsv2_options(options: &ServeOptions) -> Result<(Option<ServerOptions>, Passwords), UsageError> {
    let mut passwords = Passwords::default();
    for assignment in &options.passwords {
        passwords.set(assignment).map_err(UsageError::new)?;
    }
    let Some(listen) = options.lsv2 else {
        return Ok((None, passwords));
    };
    let options = ServerOptions {
        listen,
        passwords: passwords.clone(),
    };
    options.check().map_err(UsageError::new)?;
    Ok((Some(options), passwords))
}

fn open(options: &ServerOptions) -> Result<OpenPort, String> {
    OpenPort::open(options).map_err(|error| format!("LSV/2 at {}: {error}", options.listen))
}
