//! The PLC of a running machine at the ports: its orders go to them, what comes over them goes to it.

use std::time::Duration;

use bahn_control::{DataLineEvent, DataLineOrder, LineEvent};
use bahn_host::{Next, Notice, Reader, Stamped};
use bahn_link::{Mode, PlcHold, Settings};
use bahn_panel::{Input, Link, Station};
use bahn_parameters::ParameterList;

use crate::diagnostics;

/// A port as the PLC may have it.
#[derive(Clone)]
pub(super) struct PlcPort {
    /// Its hold on the port.
    pub hold: PlcHold,
    /// What the operator has set up.
    pub mode: Mode,
    /// Baud rate of the port, if it has one.
    pub baud: Option<u32>,
    /// Time of a dead device.
    pub patience: Duration,
}

/// The two interfaces, RS-232-C and RS-422; one that has no port is never ready.
pub(super) struct PlcLines {
    notices: Reader<Stamped>,
    ports: [Option<PlcPort>; 2],
}

impl PlcLines {
    /// The lines of a machine that is about to run.
    pub fn new(station: &mut Station, ports: [Option<PlcPort>; 2]) -> PlcLines {
        PlcLines {
            notices: station.host().notices(),
            ports,
        }
    }

    /// The control learns the baud rates of the modes that are set up.
    pub fn begin(&self, link: &Link) {
        for (line, port) in self.ports() {
            if let Some(baud) = port.baud {
                tell(link, line, LineEvent::ModeBaud(baud));
            }
        }
    }

    /// Carries on what has happened since the last call.
    pub fn carry(&mut self, link: &Link) {
        let mut orders = Vec::new();
        for next in self.notices.by_ref() {
            match next {
                Next::Item(stamped) => {
                    if let Notice::Line(order) = stamped.notice {
                        orders.push(order);
                    }
                }
                Next::Missed(count) => {
                    diagnostics::print_line(&format!("{count} notices of the machine went by unseen"));
                }
            }
        }
        for order in orders {
            self.obey(order, link);
        }
        for (line, port) in self.ports() {
            for event in port.hold.take_events() {
                tell(link, line, event);
            }
        }
    }

    fn obey(&self, order: DataLineOrder, link: &Link) {
        let (DataLineOrder::Assigned { line, .. }
        | DataLineOrder::Send { line, .. }
        | DataLineOrder::Taken { line }) = order;
        let Some(port) = self.ports.get(line).and_then(Option::as_ref) else {
            return;
        };
        match order {
            DataLineOrder::Assigned { setup, .. } => {
                let list = setup.and_then(|setup| Some((setup, list(link)?)));
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
}

/// The machine parameters as they are now.
fn list(link: &Link) -> Option<ParameterList> {
    link.look(|station| station.control().first().edited_list().clone())
        .ok()
}

/// The control is told what happens at a line; one that has ended needs it no more, and what it refuses it does not want.
fn tell(link: &Link, line: usize, event: LineEvent) {
    let event = DataLineEvent::Line(line, event);
    let _ = link.input(Input::Deed(event.to_string()));
}
