//! What comes in the standard protocol: lines, control characters, errors of the device.
//!
//! Decision: Which of DATA CARRIER and DATA MEDIUM: as the table of the error sequences prints it

use bahn_parameters::MessageId;

use crate::protocol::Shown;
use crate::settings::Settings;
use crate::text::LINE_MAX;
use crate::{DC1, DC3};

const ENQ: u8 = 0x05;
const ESC: u8 = 0x1B;
/// Form feed: the end of a line on the TNC 151/155 [001:1176].
const FF: u8 = 0x0C;
const DEL: u8 = 0x7F;

/// Messages of the error sequence ESC 1 n [000:17627-17637].
const ERRORS: [MessageId; 8] = [
    MessageId::TransferredDataIncorrect,
    MessageId::DataCarrierMissing,
    MessageId::DataCarrierWriteProtected,
    MessageId::WrongOperatingMode,
    MessageId::WrongProgramData,
    MessageId::DataCarrierEmpty,
    MessageId::ProgramIncomplete,
    MessageId::MeEndOfTape,
];

/// An item of the character stream.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(super) enum Item {
    /// A line, without its end.
    Line(Vec<u8>),
    /// End of text, ETX.
    Etx,
    /// End of transmission, EOT.
    Eot,
    /// Go on, or begin.
    Dc1,
    /// DC3: sending is to stop.
    Dc3,
    /// ENQ, with which LSV/2 begins.
    Enquiry,
    /// An error of the device, or what should have been one.
    Error(Shown),
}

#[derive(Clone, Copy, Debug, Default)]
enum Escape {
    #[default]
    None,
    /// The character 1 is awaited.
    One,
    /// The number is awaited.
    Number,
}

/// Makes items of bytes.
#[derive(Debug, Default)]
pub(super) struct Items {
    line: Vec<u8>,
    escape: Escape,
}

impl Items {
    /// Whether a line has begun.
    pub fn is_inside(&self) -> bool {
        !self.line.is_empty()
    }

    /// The line that has begun: the last one may have no end.
    pub fn rest(&mut self) -> Option<Vec<u8>> {
        (!self.line.is_empty()).then(|| std::mem::take(&mut self.line))
    }

    /// Takes a byte from the line; the item that it completes.
    pub fn take(&mut self, settings: &Settings, byte: u8) -> Option<Item> {
        let code = |code| Item::Error(Shown::Control(MessageId::TransferredDataIncorrect, Some(code)));
        match std::mem::take(&mut self.escape) {
            Escape::None => {}
            Escape::One if byte == b'1' => {
                self.escape = Escape::Number;
                return None;
            }
            Escape::One => return Some(code('K')),
            Escape::Number => {
                let number = usize::from(byte).checked_sub(usize::from(b'0'));
                let message = number.and_then(|number| ERRORS.get(number));
                return Some(message.map_or(code('L'), |id| Item::Error(Shown::Control(*id, None))));
            }
        }
        let control = &settings.control;
        match byte {
            _ if byte == control.etx => Some(Item::Etx),
            _ if byte == control.eot => Some(Item::Eot),
            DC1 => Some(Item::Dc1),
            DC3 => Some(Item::Dc3),
            ENQ => Some(Item::Enquiry),
            ESC => {
                self.escape = Escape::One;
                None
            }
            b'\n' | FF => Some(Item::Line(std::mem::take(&mut self.line))),
            DEL => None,
            b'\t' | b' '.. if self.line.len() < LINE_MAX => {
                self.line.push(byte);
                None
            }
            // NUL is ignored [000:17252], and so is the CR of CR LF.
            _ => None,
        }
    }
}
