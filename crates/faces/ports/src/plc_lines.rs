//! The PLC of a running machine at the ports: its orders go to them, what comes over them goes to it; what its programs
//! print goes where it is wanted.

use std::fs::File;
use std::io::{self, Write as _};
use std::path::PathBuf;
use std::time::Duration;

use bahn_link::{Mode, PlcHold, Settings};
use bahn_service::{DataLineOrder, LineEvent, LineFeed, LineNews, MachineService};

use crate::{PortError, Tell};

/// A port as the PLC may have it.
#[derive(Clone)]
pub struct PlcPort {
    /// By what the PLC takes the port and gives it back.
    pub hold: PlcHold,
    /// What the operator has set up.
    pub mode: Mode,
    /// Baud rate of the port, if it has one.
    pub baud: Option<u32>,
    /// Time of a dead device.
    pub patience: Duration,
}

/// The two interfaces, RS-232-C and RS-422; one that has no port is never ready.
pub struct PlcLines {
    machine: MachineService,
    feed: LineFeed,
    ports: [Option<PlcPort>; 2],
    printer: Option<Printer>,
    tell: Tell,
}

/// Where the texts of FN15 go.
enum Printer {
    /// To the device at a port.
    Port(PlcHold),
    /// Lines are added to a file.
    File(PathBuf),
}

impl Printer {
    fn print(&self, line: &str, tell: &Tell) {
        let printed = match self {
            Printer::Port(hold) => match hold.print(line) {
                true => Ok(()),
                false => Err(io::Error::other("the printer is too slow")),
            },
            Printer::File(path) => File::options()
                .create(true)
                .append(true)
                .open(path)
                .and_then(|mut file| writeln!(file, "{line}")),
        };
        if let Err(error) = printed {
            tell(&format!("`{line}` is not printed: {error}"));
        }
    }
}

impl PlcLines {
    /// The lines of a machine that runs.
    ///
    /// # Errors
    /// When FN15 is to print at a port that is not open, or the machine does not answer.
    pub fn new(
        machine: &MachineService,
        ports: [Option<PlcPort>; 2],
        print: Option<&str>,
        tell: Tell,
    ) -> Result<PlcLines, PortError> {
        let at = |number: usize, name: &'static str| match ports.get(number).and_then(Option::as_ref) {
            Some(port) => Ok(Printer::Port(port.hold.clone())),
            None => Err(PortError::NoPrinter(name)),
        };
        let printer = match print {
            None => None,
            Some("rs232") => Some(at(0, "rs232")?),
            Some("rs422") => Some(at(1, "rs422")?),
            Some(path) => Some(Printer::File(path.into())),
        };
        // Into a file only FN15 prints: what is digitized stays a program of the memory.
        let at_port = matches!(printer, Some(Printer::Port(_)));
        machine.print_digitized(at_port)?;
        Ok(PlcLines {
            machine: machine.clone(),
            feed: machine.line_feed(),
            ports,
            printer,
            tell,
        })
    }

    /// The control learns the baud rates of the modes that are set up.
    pub fn begin(&self) {
        for (line, port) in self.ports() {
            if let Some(baud) = port.baud {
                self.tell_line(line, LineEvent::ModeBaud(baud));
            }
        }
    }

    /// Carries on what has happened since the last call.
    pub fn carry(&mut self) {
        let mut orders = Vec::new();
        for news in self.feed.by_ref() {
            match news {
                LineNews::Order(order) => orders.push(order),
                LineNews::Printed(line) => {
                    if let Some(printer) = &self.printer {
                        printer.print(&line, &self.tell);
                    }
                }
                LineNews::Missed(count) => {
                    (self.tell)(&format!("{count} notices of the machine went by unseen"));
                }
            }
        }
        for order in orders {
            self.obey(order);
        }
        for (line, port) in self.ports() {
            for event in port.hold.take_events() {
                self.tell_line(line, event);
            }
        }
    }

    fn obey(&self, order: DataLineOrder) {
        let (DataLineOrder::Assigned { line, .. }
        | DataLineOrder::Send { line, .. }
        | DataLineOrder::Taken { line }) = order;
        let Some(port) = self.ports.get(line).and_then(Option::as_ref) else {
            return;
        };
        match order {
            DataLineOrder::Assigned { setup, .. } => {
                let list = setup.and_then(|setup| Some((setup, self.machine.parameters().ok()?)));
                let settings = list.map(|(setup, list)| {
                    let settings = match setup.of_mode {
                        true => Settings::of(&list, port.mode),
                        false => Settings::of_plc(&list),
                    };
                    settings.on(port.baud, port.patience)
                });
                port.hold.assign(settings);
            }
            DataLineOrder::Send { text, .. } => port.hold.transmit(&text),
            DataLineOrder::Taken { .. } => port.hold.taken(),
        }
    }

    fn ports(&self) -> impl Iterator<Item = (usize, &PlcPort)> {
        let ports = self.ports.iter().enumerate();
        ports.filter_map(|(line, port)| Some((line, port.as_ref()?)))
    }

    /// The control is told what happens at a line; one that has ended needs it no more, and what it refuses it does not want.
    fn tell_line(&self, line: usize, event: LineEvent) {
        let _ = self.machine.tell_line(line, event);
    }
}
