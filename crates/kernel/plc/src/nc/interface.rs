//! Data interfaces and the connection to a host, as buffers between modules and the world.

use std::collections::VecDeque;

/// Who has an interface.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum InterfaceUser {
    /// Input and output of programs by the operator.
    Nc,
    /// The PLC, which has assigned it to itself.
    Plc,
}

/// One of the two serial interfaces. The control moves characters between its buffers and the line.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct DataInterface {
    /// Who has it; `None` while it is free.
    pub user: Option<InterfaceUser>,
    /// The other side is ready.
    pub ready: bool,
    /// It was when somebody gave the interface back.
    pub was_ready: bool,
    /// Baud rate in force; 0 before it was ever used.
    pub baud: u32,
    /// Baud rate of the operating mode that the operator chose.
    pub mode_baud: u32,
    /// Characters to be sent; the control takes them from the front.
    pub transmit: Vec<u8>,
    /// An error occurred while sending.
    pub transmit_error: bool,
    /// Received characters, without end character.
    pub receive: Vec<u8>,
    /// The end character of what was received has come.
    pub received: bool,
    /// An error occurred while receiving.
    pub receive_error: bool,
    /// ETX was received: the other side does not want more.
    pub end_of_text: bool,
    /// Characters are being received.
    pub receiving: bool,
    /// Data format and protocol are those of the operating mode that the operator chose, not of MP5xxx.2.
    pub format_of_mode: bool,
    /// How often the PLC has got it, so that whoever has the line sees that it begins anew.
    pub assigned: u32,
    /// How many texts were begun to be sent.
    pub begun: u32,
    /// How many received texts the PLC has taken.
    pub taken: u32,
}

impl DataInterface {
    /// Gives it to the PLC, initialised and receiving [000:15611].
    pub(crate) fn assign_to_plc(&mut self, baud: u32, format_of_mode: bool) {
        *self = DataInterface {
            user: Some(InterfaceUser::Plc),
            ready: self.ready,
            was_ready: self.was_ready,
            baud,
            mode_baud: self.mode_baud,
            receiving: true,
            format_of_mode,
            assigned: self.assigned.wrapping_add(1),
            begun: self.begun,
            taken: self.taken,
            ..DataInterface::default()
        };
    }

    /// Takes it from the PLC and stops receiving [000:15640]. The control does so, too, when the PLC
    /// program is compiled anew [000:15616].
    pub fn release(&mut self) {
        self.user = None;
        self.was_ready = self.ready;
        self.receiving = false;
    }

    /// Gives it to the operator's input and output, at the rate of the operating mode that was chosen.
    pub fn assign_to_nc(&mut self) {
        self.user = Some(InterfaceUser::Nc);
        self.baud = self.mode_baud;
    }

    /// Whether the other side is ready, as 9102 tells it: without a user, whether it was when the last one gave the
    /// interface back [000:15665].
    pub(crate) fn ready_as_reported(&self) -> bool {
        match self.user {
            Some(_) => self.ready,
            None => self.was_ready,
        }
    }

    /// Begins to send; false when the last text is not sent yet, or the other side is not ready (inferred).
    pub(crate) fn start_transmission(&mut self, text: &[u8]) -> bool {
        if !self.transmit.is_empty() {
            return false;
        }
        if !self.ready {
            self.transmit_error = true;
            return false;
        }
        self.transmit.extend_from_slice(text);
        self.begun = self.begun.wrapping_add(1);
        true
    }

    /// Empties the receive buffer.
    pub(crate) fn clear_received(&mut self) {
        self.receive.clear();
        self.received = false;
        self.taken = self.taken.wrapping_add(1);
    }
}

/// A connection by LSV/2.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct HostLink {
    /// Messages to the host; the control takes them from the front and sends `M PC<msg.l>`.
    pub outgoing: VecDeque<HostMessage>,
    /// Messages from the host, the oldest first.
    pub incoming: VecDeque<HostMessage>,
}

impl HostLink {
    /// Messages that wait to be sent at most (inferred).
    pub const CAPACITY: usize = 16;
}

/// A message between PLC and host.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum HostMessage {
    /// A number of 32 bits.
    Double(i32),
    /// A string, its bytes.
    Text(Vec<u8>),
}
