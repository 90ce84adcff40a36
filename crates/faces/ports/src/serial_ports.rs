//! The serial ports of a machine that answers: RS-232-C and RS-422, each on a thread of its own.

use std::net::{SocketAddr, ToSocketAddrs as _};
use std::path::PathBuf;
use std::sync::atomic::{AtomicBool, Ordering};
use std::sync::{Arc, Mutex, PoisonError};
use std::thread::JoinHandle;
use std::time::Duration;

use bahn_link::blockwise::Rights;
use bahn_link::lsv2::{Device, SerialServer, ServerOptions, Site};
use bahn_link::{
    Attendant, Channel, Line, Passive, PlcHold, Protocol, Settings, SharedPort, Spec, drive, peripheral,
};
use bahn_parameters::interfaces::rates_exclude_each_other;
use bahn_parameters::{ControlModel, MessageId, ParameterList};

use crate::open::{self, Refused};
use crate::plc_lines::PlcPort;
use crate::trace::Trace;
use crate::{PortError, Tell};

/// The interfaces: option, name, and what stands before their lines.
const PORTS: [(&str, &str, &str); 2] = [
    ("--rs232", "RS-232-C", "RS-232: "),
    ("--rs422", "RS-422", "RS-422: "),
];

/// The ports that are named.
pub fn specs(named: [Option<&String>; 2]) -> Result<Vec<(usize, Spec)>, Refused> {
    let mut specs = Vec::new();
    for (number, text) in named.into_iter().enumerate() {
        if let (Some(text), Some((option, ..))) = (text, PORTS.get(number)) {
            specs.push((number, open::spec(option, text)?));
        }
    }
    Ok(specs)
}

/// A port that is open.
pub struct Port {
    /// 0 is RS-232-C, 1 RS-422.
    pub number: usize,
    /// How it is written.
    pub spec: Spec,
    settings: Settings,
    /// What carries its bytes.
    pub channel: Channel,
    /// Where it can be reached from elsewhere.
    reached: Option<SocketAddr>,
    /// As the PLC may have it.
    pub plc: PlcPort,
}

/// The ports as the PLC may have them: RS-232-C and RS-422.
pub fn of_plc(ports: &[Port]) -> [Option<PlcPort>; 2] {
    [0, 1].map(|number| {
        let port = ports.iter().find(|port| port.number == number);
        port.map(|port| port.plc.clone())
    })
}

/// Opens them all, or none.
pub fn open(specs: &[(usize, Spec)], list: &ParameterList, tell: &Tell) -> Result<Vec<Port>, Refused> {
    let bauds: Vec<u32> = specs.iter().filter_map(|(_, spec)| spec.baud).collect();
    if let [one, other] = *bauds
        && rates_exclude_each_other(one, other)
    {
        return Err(Refused {
            message: Some(MessageId::BaudRateNotPossible.text(list.model())),
            why: None,
        });
    }
    let inhibited = list.interface_parameters().inhibited;
    for (number, _) in specs {
        let name = PORTS.get(*number).map_or("", |(_, name, _)| name);
        if inhibited.get(*number) == Some(&true) {
            return Err(Refused::because(&format!("{name} is inhibited by MP5000")));
        }
        if *number > 0 && !list.model().has_rs_422() {
            return Err(Refused::because(&format!(
                "a {} has no {name}",
                list.model().name()
            )));
        }
    }
    let mut ports = Vec::new();
    for (number, spec) in specs {
        let settings = open::settings(list, spec);
        ports.push(Port {
            number: *number,
            spec: spec.clone(),
            settings,
            channel: open::open(spec, &settings, tell)?,
            plc: PlcPort {
                hold: PlcHold::default(),
                mode: spec.mode,
                baud: spec.baud,
                patience: spec.timeout,
            },
            reached: match &spec.line {
                Line::Listen(address) => address.to_socket_addrs().ok().and_then(|mut all| all.next()),
                Line::Connect(_) | Line::Pty(_) | Line::Serial(_) => None,
            },
        });
    }
    Ok(ports)
}

/// Makes who attends a port: for messages of a model, with what stands before its lines, and what follows when a file is
/// stored.
pub type Attendants =
    Arc<dyn Fn(ControlModel, &'static str, Box<dyn FnMut() + Send>) -> Box<dyn Attendant> + Send + Sync>;

/// Who attends the ports.
#[derive(Clone)]
pub struct Attendance {
    /// A file that is there already is asked for before it is replaced.
    pub asks: bool,
    /// Makes who attends a port, one for each.
    pub attendant: Attendants,
    /// Hears of what goes wrong.
    pub tell: Tell,
}

/// Ports that answer; dropped, they are closed.
pub struct Serving {
    stop: Arc<AtomicBool>,
    threads: Vec<JoinHandle<()>>,
    trace: Arc<Mutex<Trace>>,
}

impl Serving {
    /// Lets all ports answer.
    pub fn start(
        ports: Vec<Port>,
        site: &Arc<Site>,
        attendance: &Attendance,
        trace: Option<&PathBuf>,
    ) -> Result<Serving, PortError> {
        let stop = Arc::new(AtomicBool::new(false));
        let trace = Arc::new(Mutex::new(Trace::open(trace.map(PathBuf::as_path))?));
        let mut threads = Vec::new();
        for port in ports {
            let (site, stop, trace) = (Arc::clone(site), Arc::clone(&stop), Arc::clone(&trace));
            let attendance = attendance.clone();
            let name = PORTS.get(port.number).map_or("", |(_, name, _)| name);
            let thread = std::thread::Builder::new()
                .name(name.to_owned())
                .spawn(move || answer_on(port, &site, &attendance, &stop, &trace));
            threads.push(thread.map_err(|error| PortError::Failed(format!("{name}: {error}")))?);
        }
        Ok(Serving { stop, threads, trace })
    }

    /// Closes the ports, and waits until nothing more passes.
    pub fn end(self) -> Result<(), PortError> {
        self.stop.store(true, Ordering::Relaxed);
        for thread in self.threads {
            // What has panicked has told so.
            let _ = thread.join();
        }
        match Arc::try_unwrap(self.trace) {
            Ok(trace) => trace
                .into_inner()
                .unwrap_or_else(PoisonError::into_inner)
                .finish(),
            Err(_) => Ok(()),
        }
    }
}

/// Answers on one port until it is to stop.
fn answer_on(port: Port, site: &Arc<Site>, attendance: &Attendance, stop: &AtomicBool, trace: &Mutex<Trace>) {
    let Port {
        number,
        spec: _,
        settings,
        mut channel,
        reached,
        plc,
    } = port;
    // A machine that is on is there again when its peer is.
    channel.connect_again();
    let (_, name, prefix) = PORTS.get(number).copied().unwrap_or_default();
    let rights = Rights {
        asks: attendance.asks,
        ..Rights::ALL
    };
    let files = Box::new(site.device.store().clone());
    let device = peripheral(settings, files, rights);
    // LSV/2 is for those who would be let in by its own port, too.
    let is_open = reached.is_none_or(|listen| {
        let passwords = site.passwords.clone();
        ServerOptions { listen, passwords }.check().is_ok()
    });
    let mut protocol: Box<dyn Protocol> = match is_open {
        true => Box::new(Passive::new(device, SerialServer::new(site))),
        false => device,
    };
    protocol = Box::new(SharedPort::new(plc.hold, protocol));
    let written = Arc::clone(&site.device);
    let stored = Box::new(move || Device::files_changed(written.as_ref()));
    let mut attendant = (attendance.attendant)(settings.model, prefix, stored);
    let mut tap = |sent: bool, byte: u8, now: Duration| {
        let mut trace = trace.lock().unwrap_or_else(PoisonError::into_inner);
        trace.byte(sent, byte, now);
    };
    if let Err(error) = drive(
        &mut channel,
        protocol.as_mut(),
        attendant.as_mut(),
        stop,
        &mut tap,
    ) {
        (attendance.tell)(&format!("error: {name}: {error}"));
    }
}
