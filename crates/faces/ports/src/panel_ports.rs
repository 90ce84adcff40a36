//! The data interfaces of the operating panel: each on a thread of its own, where a transfer begins when the operator wants
//! it, and the PLC has the line at other times.
//!
//! Decision: At a panel the interfaces rest between transfers: what a device begins there is not heard, but for the
//! PLC that has the line

use std::sync::atomic::{AtomicBool, Ordering};
use std::sync::{Arc, Mutex, MutexGuard, PoisonError};
use std::thread::JoinHandle;
use std::time::Duration;

use bahn_link::blockwise::{self, DirectoryRequest, Want};
use bahn_link::{
    Attendant, Channel, Ended, Event, FileType, Files, Line, OfKinds, Protocol, Question, Resting, Settings,
    SharedPort, Spec, drive, standard,
};
use bahn_parameters::{ControlModel, MessageId, ParameterList};
use bahn_service::{Input, MachineService, TransferAction, TransferFiles, TransferNews, TransferOrder};

use crate::open::Refused;
use crate::serial_ports::{self, Port};
use crate::{PlcLines, PortError, Tell};

/// How often orders of the panel and of the PLC are looked for.
const LOOK: Duration = Duration::from_millis(10);

/// The interfaces of a machine with a panel that is about to be switched on.
pub struct PanelPorts {
    ports: Vec<Port>,
    tell: Tell,
}

/// The files among which an order is carried out; of those of the PLC and of lists each knows its own types alone.
fn files_of(machine: &MachineService, files: TransferFiles) -> Box<dyn Files> {
    let store = machine.store_of(files).ok().flatten().cloned();
    match (store, files.extensions()) {
        (Some(store), None) => Box::new(store),
        (Some(store), Some(kinds)) => Box::new(OfKinds::new(store, kinds)),
        (None, _) => Box::new(bahn_link::Memory::default()),
    }
}

impl PanelPorts {
    /// Opens the ports that are named, RS-232-C and RS-422; lines for people go to `tell`.
    ///
    /// # Errors
    /// When one is not written as a port, or cannot be opened.
    pub fn open(
        named: [Option<&String>; 2],
        list: &ParameterList,
        tell: Tell,
    ) -> Result<PanelPorts, Refused> {
        let ports = serial_ports::open(&serial_ports::specs(named)?, list, &tell)?;
        Ok(PanelPorts { ports, tell })
    }

    /// Connects the panel and the PLC of a machine that runs, and lets the interfaces run beside it.
    ///
    /// # Errors
    /// When FN15 is to print at a port that is not open, or the system gives no thread.
    pub fn start(self, machine: &MachineService, print: Option<&str>) -> Result<RunningPorts, PortError> {
        let PanelPorts { ports, tell } = self;
        let mut lines = PlcLines::new(machine, serial_ports::of_plc(&ports), print, Arc::clone(&tell))?;
        let orders = machine.transfer_orders()?;
        let stop = Arc::new(AtomicBool::new(false));
        let mut desks: [Option<Arc<Desk>>; 2] = [None, None];
        let mut threads = Vec::new();
        for port in ports {
            let desk = Arc::new(Desk::default());
            if let Some(place) = desks.get_mut(port.number) {
                *place = Some(Arc::clone(&desk));
            }
            let worker = Worker {
                machine: machine.clone(),
                stop: Arc::clone(&stop),
                desk,
                tell: Arc::clone(&tell),
            };
            threads.push(spawn("interface", move || worker.work(port))?);
        }
        let stopped = Arc::clone(&stop);
        threads.push(spawn("interfaces", move || {
            lines.begin();
            while !stopped.load(Ordering::Relaxed) {
                lines.carry();
                for order in orders.try_iter() {
                    if let Some(Some(desk)) = desks.get(order.port) {
                        desk.take(order);
                    }
                }
                std::thread::sleep(LOOK);
            }
            desks.iter().flatten().for_each(|desk| desk.end());
        })?);
        Ok(RunningPorts { stop, threads })
    }
}

fn spawn(name: &str, what: impl FnOnce() + Send + 'static) -> Result<JoinHandle<()>, PortError> {
    let thread = std::thread::Builder::new().name(name.to_owned()).spawn(what);
    thread.map_err(|error| PortError::Failed(format!("{name}: {error}")))
}

/// Interfaces that run; they end before the machine does.
pub struct RunningPorts {
    stop: Arc<AtomicBool>,
    threads: Vec<JoinHandle<()>>,
}

impl RunningPorts {
    /// Ends them; what is being transferred is broken off.
    pub fn end(self) {
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
    /// END was pressed since the transfer was ordered.
    ended: bool,
}

impl Desk {
    fn take(&self, order: TransferOrder) {
        let mut ordered = self.ordered();
        match order.action {
            TransferAction::Answer(yes) => {
                ordered.answer = Some(yes);
                return;
            }
            TransferAction::End => ordered.ended = true,
            _ => {
                *ordered = Ordered {
                    transfer: Some(order),
                    ..Ordered::default()
                };
            }
        }
        self.end();
    }

    /// The transfer that begins now; without one the line rests. END that came before it could begin breaks it off at once.
    fn begin(&self) -> Option<TransferOrder> {
        let mut ordered = self.ordered();
        let transfer = ordered.transfer.take();
        let ended = std::mem::take(&mut ordered.ended);
        self.wake.store(ended && transfer.is_some(), Ordering::Relaxed);
        transfer
    }

    fn end(&self) {
        self.wake.store(true, Ordering::Relaxed);
    }

    fn ordered(&self) -> MutexGuard<'_, Ordered> {
        self.ordered.lock().unwrap_or_else(PoisonError::into_inner)
    }
}

/// The thread of a port.
struct Worker {
    machine: MachineService,
    stop: Arc<AtomicBool>,
    desk: Arc<Desk>,
    tell: Tell,
}

impl Worker {
    fn work(&self, mut port: Port) {
        self.tell(TransferNews::Connected(port.number));
        loop {
            let order = self.desk.begin();
            // Whoever stops wakes after that: it is seen here, or ends what is driven.
            if self.stop.load(Ordering::Relaxed) {
                return;
            }
            let driven = match order {
                Some(order) => self.transfer(&order, &mut port),
                None => {
                    let mut protocol = SharedPort::new(port.plc.hold.clone(), Box::new(Resting));
                    self.drive(&mut port.channel, &mut protocol, &mut Waiting)
                }
            };
            if let Err(error) = driven {
                (self.tell)(&format!("error: {}: {error}", port.spec.line));
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
        let Ok(list) = self.machine.parameters() else {
            return Ok(());
        };
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
        let files = files_of(&self.machine, order.files);
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
        let _ = self.machine.input(Input::Transfer(news));
    }
}

/// What the list says for the device that the operator has set up.
fn settings(order: &TransferOrder, spec: &Spec, list: &ParameterList) -> Settings {
    Settings::of(list, order.mode).on(spec.baud, spec.timeout)
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
            self.tell(TransferNews::Incomplete);
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
            Event::Ended(ended) => {
                self.ended = true;
                match ended {
                    Ended::Complete => TransferNews::Complete,
                    Ended::Incomplete => TransferNews::Incomplete,
                }
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
    use bahn_link::Mode;

    use super::*;

    fn order(action: TransferAction) -> TransferOrder {
        TransferOrder {
            port: 0,
            action,
            files: TransferFiles::Programs,
            mode: Mode::Fe1,
            baud: 9600,
            kind: "H",
        }
    }

    /// On a computer that is busy END comes before the thread of the port has taken the transfer.
    #[test]
    fn an_end_that_comes_before_the_transfer_is_not_lost() {
        let desk = Desk::default();
        let is_ended = || desk.wake.load(Ordering::Relaxed);
        desk.take(order(TransferAction::ReadAll));
        desk.take(order(TransferAction::End));
        assert!(desk.begin().is_some() && is_ended());
        // It ends no other one: neither the rest that follows nor the next transfer.
        assert!(desk.begin().is_none() && !is_ended());
        desk.take(order(TransferAction::End));
        desk.take(order(TransferAction::ReadAll));
        assert!(desk.begin().is_some() && !is_ended());
        desk.take(order(TransferAction::End));
        assert!(is_ended());
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
