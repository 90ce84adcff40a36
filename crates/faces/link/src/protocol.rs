//! What all protocols have in common: bytes and time in, bytes and events out.

use std::time::Duration;

use bahn_parameters::{ControlModel, MessageId};

use bahn_store::StoreError;

/// What the control shows of a transfer.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum Shown {
    /// A message of the control, with a code after it.
    Control(MessageId, Option<char>),
    /// The text of the device [000:17442-17450], or what the medium says.
    Device(String),
}

impl Shown {
    /// Its text on a control.
    ///
    /// ```
    /// use bahn_link::Shown;
    /// use bahn_parameters::{ControlModel, MessageId};
    ///
    /// let shown = Shown::Control(MessageId::TransferredDataIncorrect, Some('E'));
    /// assert_eq!(shown.text(ControlModel::Tnc415b), "TRANSFERRED DATA INCORRECT E");
    /// ```
    pub fn text(&self, model: ControlModel) -> String {
        match self {
            Shown::Control(id, code) => {
                let code = code.filter(|_| model.has_transfer_codes());
                let code = code.map(|code| format!(" {code}")).unwrap_or_default();
                id.text(model).to_owned() + &code
            }
            Shown::Device(text) => text.clone(),
        }
    }

    /// What the control shows when it cannot store a file.
    pub(crate) fn of_store(error: &StoreError) -> Shown {
        match error {
            StoreError::Protected(_) => Shown::Control(MessageId::ProtectedPgm, None),
            StoreError::DiskFull | StoreError::DirectoryFull => {
                Shown::Control(MessageId::FurtherProgramEntryImpossible, None)
            }
            StoreError::NoFile(_) => Shown::Control(MessageId::ProgramNotFound, None),
            other => Shown::Device(other.to_string()),
        }
    }
}

/// What the operator is asked.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum Question {
    /// ERASE/OVERREAD: is the file of this name replaced [000:17233]?
    Overread(String),
    /// Is the file that the device offers read in [000:17345-17349]?
    Offered(String),
    /// Is this file sent [000:17283-17286]?
    Output(String),
    /// PROTECTED PGM: does the transfer go on with the next file [000:17235]?
    Protected(String),
}

/// An event of a transfer.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum Event {
    /// A file is stored.
    Received(String),
    /// A file has arrived at the other side.
    Sent(String),
    /// A file on the medium of the device, with its sectors when the device lists them.
    Listed(String, Option<u32>),
    /// Free sectors on the medium of the device.
    Free(u32),
    /// The protocol waits for an answer.
    Question(Question),
    /// The control shows a message.
    Message(Shown),
    /// The other side wants to speak LSV/2.
    Enquiry,
    /// The transfer is over.
    Ended(Ended),
}

/// How a transfer has ended.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Ended {
    /// All of it has arrived.
    Complete,
    /// Something is missing.
    Incomplete,
}

impl Ended {
    /// Complete, unless something has failed.
    pub(crate) fn unless(failed: bool) -> Ended {
        if failed {
            Ended::Incomplete
        } else {
            Ended::Complete
        }
    }
}

/// A protocol on one side of a line. It knows no clock and no channel: whoever drives it gives it what comes and what time
/// it is, and sends what it has to send.
pub trait Protocol: Send {
    /// A byte has come.
    fn receive(&mut self, byte: u8, now: Duration);
    /// Advances the clock of the protocol, which ends what it has waited for too long.
    fn clock(&mut self, now: Duration);
    /// When [`Protocol::clock`] is to be called at the latest.
    fn deadline(&self) -> Option<Duration>;
    /// Whether it has something to send.
    fn has_output(&self) -> bool;
    /// Takes what is to be sent, `room` bytes at most; the caller must send all of them.
    fn send(&mut self, room: usize, now: Duration, into: &mut Vec<u8>);
    /// How long it may be left alone, when it has output from elsewhere.
    fn patience(&self) -> Option<Duration> {
        None
    }
    /// A device is connected.
    fn plugged(&mut self, _now: Duration) {}
    /// The cable is pulled.
    fn unplugged(&mut self, now: Duration);
    /// The next event, if there is one.
    fn event(&mut self) -> Option<Event>;
    /// The answer to its question.
    fn answer(&mut self, yes: bool, now: Duration);
    /// The END key: ends a transfer.
    fn end(&mut self, now: Duration);
    /// Whether it waits for the other side to begin something, or for nothing any more.
    fn is_idle(&self) -> bool;
    /// Whether all eight bits of a byte count, whatever the characters of the port are: LSV/2.
    fn is_transparent(&self) -> bool {
        false
    }
    /// Who takes what comes has no room for more, or has room again: the other side is held back by an acknowledgement that is not
    /// given, by DC3 or by RTS.
    fn hold(&mut self, _on: bool) {}
    /// Whether it has stopped the other side: RTS is off.
    fn has_stopped_by_rts(&self) -> bool {
        false
    }
}
