//! The data interfaces of the operating panel: each on a thread of its own, where a transfer begins when the operator wants
//! it, and the PLC has the line at other times.

use std::sync::atomic::{AtomicBool, Ordering};
use std::sync::mpsc::Receiver;
use std::sync::{Arc, Mutex, MutexGuard, PoisonError};
use std::thread::JoinHandle;
use std::time::Duration;

use bahn_host::LoadedMachine;
use bahn_link::blockwise::{self, DirectoryRequest, Want};
use bahn_link::store::{PLC, Store, StoreError, TNC};
use bahn_link::{
    Attendant, Channel, Event, FileType, Files, Line, Mode, OfKinds, Protocol, Question, Resting, Settings,
    SharedPort, Spec, drive, standard,
};
use bahn_panel::{Input, Link, Live, Station, TransferAction, TransferFiles, TransferNews, TransferOrder};
use bahn_parameters::{ControlModel, MessageId, ParameterList};

use bahn_ports::PlcLines;

use super::port::{self, Refused};
use super::serial_ports::{self, Port};
use crate::{UsageError, diagnostics};

/// How often orders of the panel and of the PLC are looked for.
const LOOK: Duration = Duration::from_millis(10);

/// The interfaces of a machine that is about to be switched on.
pub(crate) struct PanelPorts {
    ports: Vec<Port>,
    memory: Memory,
}

/// The files that the panel transfers: programs with tables, files of the PLC, lists of machine parameters.
#[derive(Clone)]
struct Memory {
    programs: Store,
    plc: Option<Store>,
    lists: Option<Store>,
}

impl Memory {
    fn of(machine: &LoadedMachine) -> Result<Memory, StoreError> {
        let plc = port::plc_folder(machine);
        Ok(Memory {
            programs: Store::of_machine(&machine.programs(0), &plc)?,
            plc: Store::of_drive(PLC, &plc).ok(),
            lists: Store::of_drive(TNC, &machine.root).ok(),
        })
    }

    /// Those among which an order is carried out; each knows its own types alone.
    fn files(&self, files: TransferFiles) -> Box<dyn Files> {
        let Some(kinds) = files.extensions() else {
            return Box::new(self.programs.clone());
        };
        let store = match files {
            TransferFiles::Lists => &self.lists,
            _ => &self.plc,
        };
        match store {
            Some(store) => Box::new(OfKinds::new(store.clone(), kinds)),
            None => Box::new(bahn_link::Memory::default()),
        }
    }
}

impl PanelPorts {
    /// Opens the ports that are named; `None` when one cannot be opened, which is told.
    ///
    /// # Errors
    /// When the machine's folders of files are not there.
    pub(crate) fn open(
        named: [Option<&String>; 2],
        machine: &LoadedMachine,
    ) -> Result<Option<PanelPorts>, UsageError> {
        let memory = Memory::of(machine).map_err(|error| UsageError::new(error.to_string()))?;
        let ports: Result<Vec<Port>, Refused> =
            serial_ports::specs(named).and_then(|specs| serial_ports::open(&specs, &machine.parameters));
        Ok(ports.ok().map(|ports| PanelPorts { ports, memory }))
    }

    /// Connects the panel and the PLC of the machine.
    ///
    /// # Errors
    /// When FN15 is to print at a port that is not open.
    pub(crate) fn connect(
        self,
        station: &mut Station,
        print: Option<&str>,
    ) -> Result<ConnectedPorts, UsageError> {
        let lines = PlcLines::new(station, serial_ports::of_plc(&self.ports), print, port::tell())?;
        Ok(ConnectedPorts {
            orders: station.transfer_orders(),
            lines,
            ports: self.ports,
            memory: self.memory,
        })
    }
}

/// The same with a panel.
pub(crate) struct ConnectedPorts {
    orders: Receiver<TransferOrder>,
    lines: PlcLines,
    ports: Vec<Port>,
    memory: Memory,
}

impl ConnectedPorts {
    /// Lets them run beside the machine.
    ///
    /// # Errors
    /// When the system gives no thread.
    pub(crate) fn start(self, live: &Live) -> Result<RunningPorts, UsageError> {
        let ConnectedPorts {
            orders,
            mut lines,
            ports,
            memory,
        } = self;
        let stop = Arc::new(AtomicBool::new(false));
        let mut desks: [Option<Arc<Desk>>; 2] = [None, None];
        let mut threads = Vec::new();
        for port in ports {
            let desk = Arc::new(Desk::default());
            if let Some(place) = desks.get_mut(port.number) {
                *place = Some(Arc::clone(&desk));
            }
            let worker = Worker {
                link: live.link(),
                memory: memory.clone(),
                stop: Arc::clone(&stop),
                desk,
            };
            threads.push(spawn("interface", move || worker.work(port))?);
        }
        let (link, stopped) = (live.link(), Arc::clone(&stop));
        threads.push(spawn("interfaces", move || {
            lines.begin(&link);
            while !stopped.load(Ordering::Relaxed) {
                lines.carry(&link);
                for order in orders.try_iter() {
                    if let Some(Some(desk)) = desks.get(order.port) {
                        desk.take(order);
                    }
                }
                std::thread::sleep(LOOK);
            }
            desks.iter().flatten().for_each(|desk| desk.close());
        })?);
        Ok(RunningPorts { stop, threads })
    }
}

fn spawn(name: &str, what: impl FnOnce() + Send + 'static) -> Result<JoinHandle<()>, UsageError> {
    let thread = std::thread::Builder::new().name(name.to_owned()).spawn(what);
    thread.map_err(|error| UsageError::new(format!("{name}: {error}")))
}

/// Interfaces that run; they end before the machine does.
pub(crate) struct RunningPorts {
    stop: Arc<AtomicBool>,
    threads: Vec<JoinHandle<()>>,
}

impl RunningPorts {
    /// Ends them; what is being transferred is broken off.
    pub(crate) fn end(self) {
        self.stop.store(true, Ordering::Relaxed);
        for thread in self.threads {
            // What has panicked has told so.
            let _ = thread.join();
        }
    }
}

/// Where orders of the panel wait for the thread of a port.
#[derive(Default)]
struct Desk {
    ordered: Mutex<Ordered>,
    /// Ends what is driven now: the rest before a transfer, or the transfer itself.
    wake: AtomicBool,
}

#[derive(Default)]
struct Ordered {
    transfer: Option<TransferOrder>,
    answer: Option<bool>,
    /// END came before the transfer began.
    broken_off: bool,
    /// The machine is switched off.
    closed: bool,
}

impl Desk {
    fn take(&self, order: TransferOrder) {
        let mut ordered = self.ordered();
        match order.action {
            TransferAction::Answer(yes) => {
                ordered.answer = Some(yes);
                return;
            }
            TransferAction::End => ordered.broken_off = ordered.transfer.is_some(),
            _ => {
                *ordered = Ordered {
                    transfer: Some(order),
                    closed: ordered.closed,
                    ..Ordered::default()
                };
            }
        }
        self.wake.store(true, Ordering::Relaxed);
    }

    /// What the thread of the port carries out next, driven until somebody wakes it. What was broken off before it began ends
    /// at once, and says so.
    fn next(&self) -> Option<TransferOrder> {
        let mut ordered = self.ordered();
        let ends = std::mem::take(&mut ordered.broken_off) || ordered.closed;
        self.wake.store(ends, Ordering::Relaxed);
        ordered.transfer.take()
    }

    fn close(&self) {
        self.ordered().closed = true;
        self.wake.store(true, Ordering::Relaxed);
    }

    fn ordered(&self) -> MutexGuard<'_, Ordered> {
        self.ordered.lock().unwrap_or_else(PoisonError::into_inner)
    }
}

/// The thread of a port.
struct Worker {
    link: Link,
    memory: Memory,
    stop: Arc<AtomicBool>,
    desk: Arc<Desk>,
}

impl Worker {
    fn work(&self, mut port: Port) {
        self.tell(TransferNews::Connected(port.number));
        while !self.stop.load(Ordering::Relaxed) {
            let driven = match self.desk.next() {
                Some(order) => self.transfer(&order, &mut port),
                None => {
                    let mut protocol = SharedPort::new(port.plc.hold.clone(), Box::new(Resting));
                    self.drive(&mut port.channel, &mut protocol, &mut Waiting)
                }
            };
            if let Err(error) = driven {
                diagnostics::print_line(&format!("error: {}: {error}", port.spec.line));
                return;
            }
        }
    }

    fn drive(
        &self,
        channel: &mut Channel,
        protocol: &mut dyn Protocol,
        attendant: &mut dyn Attendant,
    ) -> std::io::Result<()> {
        drive(channel, protocol, attendant, &self.desk.wake, &mut |_, _, _| {})
    }

    /// A transfer from its beginning to its end.
    fn transfer(&self, order: &TransferOrder, port: &mut Port) -> std::io::Result<()> {
        let list = self
            .link
            .look(|station| station.control().first().edited_list().clone());
        let Ok(list) = list else { return Ok(()) };
        let mut carrier = Carrier {
            worker: self,
            model: list.model(),
            ended: false,
        };
        if let Err(message) = self.ready(order, port, &list) {
            carrier.tell(TransferNews::Message(message.text(list.model()).to_owned()));
            carrier.finish();
            return Ok(());
        }
        let protocol = self.protocol(order, settings(order, &port.spec, &list));
        let mut protocol = SharedPort::new(port.plc.hold.clone(), protocol);
        let driven = self.drive(&mut port.channel, &mut protocol, &mut carrier);
        // What was broken off has still something to say.
        while let Some(event) = protocol.event() {
            carrier.event(event);
        }
        carrier.finish();
        driven
    }

    /// The port as it is set up now.
    fn ready(&self, order: &TransferOrder, port: &mut Port, list: &ParameterList) -> Result<(), MessageId> {
        if port.plc.hold.is_assigned() {
            return Err(MessageId::InterfaceAlreadyAssigned);
        }
        if matches!(port.spec.line, Line::Serial(_)) {
            // A real line has the baud rate and the characters of MOD.
            let spec = Spec {
                baud: Some(order.baud),
                ..port.spec.clone()
            };
            let characters = settings(order, &spec, list).characters;
            match Channel::open(&spec, characters) {
                Ok(channel) => (port.channel, port.spec) = (channel, spec),
                Err(_) => return Err(MessageId::ExtInOutputNotReady),
            }
        }
        match port.channel.is_ready() {
            true => Ok(()),
            false => Err(MessageId::ExtInOutputNotReady),
        }
    }

    fn protocol(&self, order: &TransferOrder, settings: Settings) -> Box<dyn Protocol> {
        let files = self.memory.files(order.files);
        let (want, kind) = match &order.action {
            TransferAction::Write(names) | TransferAction::WriteOffered(names) => {
                let asks = matches!(order.action, TransferAction::WriteOffered(_));
                let names = names.clone();
                return match settings.blockwise {
                    true => Box::new(blockwise::Writing::new(settings, files, names, asks)),
                    false => Box::new(standard::Writing::new(settings, files, names, asks)),
                };
            }
            TransferAction::Directory if settings.asks_directory => {
                return Box::new(DirectoryRequest::new(settings));
            }
            TransferAction::ReadAll => (Want::All, None),
            TransferAction::ReadOffered => (Want::Offered, None),
            TransferAction::Read(name) => {
                let extension = name.rsplit_once('.').map_or("", |(_, extension)| extension);
                (Want::Selected(name.clone()), FileType::of_extension(extension))
            }
            _ => (Want::Directory, None),
        };
        let kind = kind
            .or_else(|| FileType::of_extension(order.kind))
            .unwrap_or(FileType::PLAIN);
        match settings.blockwise {
            true => Box::new(blockwise::Reading::new(settings, files, want, kind)),
            false => Box::new(standard::Reading::new(settings, files, want, kind)),
        }
    }

    /// A station that has ended needs no news.
    fn tell(&self, news: TransferNews) {
        let _ = self.link.input(Input::Transfer(news));
    }
}

/// What the list says for the device that the operator has set up.
fn settings(order: &TransferOrder, spec: &Spec, list: &ParameterList) -> Settings {
    let mode = order.mode.parse().unwrap_or(Mode::default());
    Settings::of(list, mode).on(spec.baud, spec.timeout)
}

/// Nobody attends a line that rests: an order wakes it.
struct Waiting;

impl Attendant for Waiting {
    fn event(&mut self, _event: Event) -> Option<bool> {
        None
    }

    fn is_over(&mut self, _connected: bool, _now: Duration) -> bool {
        false
    }
}

/// Carries what happens to the panel, and its answers back.
struct Carrier<'a> {
    worker: &'a Worker,
    model: ControlModel,
    ended: bool,
}

impl Carrier<'_> {
    fn tell(&self, news: TransferNews) {
        self.worker.tell(news);
    }

    /// The panel hears of an end in any case.
    fn finish(self) {
        if !self.ended {
            self.tell(TransferNews::Ended(false));
        }
    }
}

impl Attendant for Carrier<'_> {
    fn event(&mut self, event: Event) -> Option<bool> {
        let news = match event {
            Event::Received(name) => TransferNews::Received(name),
            Event::Sent(name) => TransferNews::Sent(name),
            Event::Listed(name, sectors) => TransferNews::Listed(name, sectors),
            Event::Free(sectors) => TransferNews::Free(sectors),
            Event::Question(Question::Overread(name)) => TransferNews::Overread(name),
            Event::Question(Question::Offered(name)) => TransferNews::Offered(name),
            Event::Question(Question::Output(name)) => TransferNews::Output(name),
            Event::Question(Question::Protected(name)) => TransferNews::Protected(name),
            Event::Message(shown) => TransferNews::Message(shown.text(self.model)),
            Event::Enquiry => return None,
            Event::Ended(complete) => {
                self.ended = true;
                TransferNews::Ended(complete)
            }
        };
        self.tell(news);
        None
    }

    fn answer(&mut self) -> Option<bool> {
        self.worker.desk.ordered().answer.take()
    }

    fn is_over(&mut self, _connected: bool, _now: Duration) -> bool {
        self.ended
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn order(action: TransferAction) -> TransferOrder {
        TransferOrder {
            port: 0,
            mode: "fe1",
            baud: 9600,
            kind: "H",
            files: TransferFiles::Programs,
            action,
        }
    }

    /// END and power-off are not lost, however late the thread of the port looks.
    #[test]
    fn what_is_broken_off_before_it_began_ends_at_once() {
        let desk = Desk::default();
        desk.take(order(TransferAction::ReadAll));
        assert!(desk.next().is_some() && !desk.wake.load(Ordering::Relaxed));
        // While it runs.
        desk.take(order(TransferAction::End));
        assert!(desk.wake.load(Ordering::Relaxed));
        assert!(desk.next().is_none() && !desk.wake.load(Ordering::Relaxed));
        // Before it began.
        desk.take(order(TransferAction::ReadAll));
        desk.take(order(TransferAction::End));
        assert!(desk.next().is_some() && desk.wake.load(Ordering::Relaxed));
        assert!(desk.next().is_none() && !desk.wake.load(Ordering::Relaxed));
        desk.close();
        assert!(desk.next().is_none() && desk.wake.load(Ordering::Relaxed));
    }

    /// What the panel transfers are types of the interface.
    #[test]
    fn types_of_the_panel_are_those_of_the_interface() {
        for files in [TransferFiles::Plc, TransferFiles::Lists] {
            for extension in files.extensions().into_iter().flatten() {
                assert!(FileType::of_extension(extension).is_some(), "{extension}");
            }
        }
    }
}
