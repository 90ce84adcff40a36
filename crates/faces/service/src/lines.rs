//! The PLC at the data interfaces, and what the operator wants of them.

use std::sync::mpsc::Receiver;
use std::sync::{Arc, PoisonError};

use bahn_host::{Next, Notice, Reader, Stamped};
use bahn_panel::{Input, TransferOrder};
use bahn_plc::HostMessage;
use bahn_tnc::{Command, DataLineEvent, DataLineOrder, HostEvent, LineEvent};

use crate::error::ServiceError;
use crate::service::MachineService;

/// What is wanted of the data interfaces.
#[derive(Clone, Debug, PartialEq)]
pub enum LineNews {
    /// The PLC wants something of a line.
    Order(DataLineOrder),
    /// FN15 has printed a line of text [003:4371-4397].
    Printed(Arc<str>),
    /// So many notices of the machine went by before they were read.
    Missed(u64),
}

/// What is wanted of the data interfaces since the machine runs; it ends where there is nothing new, and goes on when there is.
pub struct LineFeed(Reader<Stamped>);

impl Iterator for LineFeed {
    type Item = LineNews;

    fn next(&mut self) -> Option<LineNews> {
        self.0.by_ref().find_map(|next| match next {
            Next::Missed(count) => Some(LineNews::Missed(count)),
            Next::Item(Stamped { notice, .. }) => match notice {
                Notice::Line(order) => Some(LineNews::Order(order)),
                Notice::Printed(line) => Some(LineNews::Printed(line)),
                _ => None,
            },
        })
    }
}

impl MachineService {
    /// What is wanted of the data interfaces.
    pub fn line_feed(&self) -> LineFeed {
        LineFeed(self.shared.notices.clone())
    }

    /// Something has happened at a line, 0 RS-232-C or 1 RS-422.
    ///
    /// # Errors
    /// When the control does not want it now, or the machine has ended.
    pub fn tell_line(&self, line: usize, event: LineEvent) -> Result<(), ServiceError> {
        self.happen(DataLineEvent::Line(line, event))
    }

    /// What is digitized is printed as FN15 prints, or stays a program of the memory.
    ///
    /// # Errors
    /// When the machine has ended, or too many wait.
    pub fn print_digitized(&self, at_port: bool) -> Result<(), ServiceError> {
        self.operates()?;
        self.with(move |station| station.host().print_digitized(at_port))
    }

    /// Where what the operator wants of the data interfaces arrives from now on. Who takes it gives
    /// [`Input::Transfer`] with what happens.
    ///
    /// # Errors
    /// When the machine has ended, or too many wait.
    pub fn transfer_orders(&self) -> Result<Receiver<TransferOrder>, ServiceError> {
        self.operates()?;
        self.with(bahn_panel::Station::transfer_orders)
    }

    /// Whether a host is there that takes messages of the PLC (modules 9110 and 9111).
    pub fn host_is_there(&self, is_there: bool) {
        let event = match is_there {
            true => HostEvent::Connected,
            false => HostEvent::Disconnected,
        };
        // A machine that has ended has no host.
        let _ = self.happen(DataLineEvent::Host(event));
    }

    /// A message of a host to the PLC.
    ///
    /// # Errors
    /// When its buffer is full, or the machine has ended.
    pub fn to_plc(&self, message: HostMessage) -> Result<(), ServiceError> {
        self.happen(DataLineEvent::Host(HostEvent::Message(message)))
    }

    /// Takes the next message of the PLC to a host.
    pub fn take_plc_message(&self) -> Option<HostMessage> {
        let _one_takes_it = self
            .shared
            .messages
            .lock()
            .unwrap_or_else(PoisonError::into_inner);
        let message = self.look(|station| station.control().message_to_host().cloned());
        let message = message.ok()??;
        self.happen(DataLineEvent::Host(HostEvent::Taken)).ok()?;
        Some(message)
    }

    fn happen(&self, event: DataLineEvent) -> Result<(), ServiceError> {
        self.operates()?;
        self.give(Input::Action(Command::DataLine(event).to_string()))
    }
}
