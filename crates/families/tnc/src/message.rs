//! The messages under the operating-mode line.
//!
//! Non-flashing messages are cleared with CE, one after another; flashing ones need switching off
//! [000:6619-6649]. M2190 is 1 while a non-flashing one is shown, M2191 while `EXTERNAL EMERGENCY STOP` is.
//!
//! Decision: Whatever M2815 finds shown of the PLC's messages flashes with it

use std::sync::Arc;

use bahn_exchange::{Exchange, signal};
use bahn_interpreter::ProgramError;
use bahn_kernel::AxisId;
use bahn_parameters::fault::{Clearing, FaultId, Reaction};
use bahn_parameters::{ControlModel, MessageId};
use bahn_path::{BlockRef, Direction};

/// An axis cannot go to another channel.
#[derive(Clone, Copy, Debug, PartialEq, Eq, thiserror::Error)]
pub enum HandOverError {
    /// There is no such axis or no such channel.
    #[error("NO SUCH AXIS OR CHANNEL")]
    Unknown,
    /// A program is on its way in one of the channels, and does not stand at the strobe of an M function, at a
    /// programmed stop or at its end.
    #[error("A PROGRAM IS RUNNING")]
    Running,
    /// The axis moves, or it is coupled to another one.
    #[error("THE AXIS MOVES")]
    Moving,
    /// The channel has an axis of this letter or index.
    #[error("LETTER OR INDEX IS TAKEN")]
    Taken,
}

/// A message of the running control.
#[derive(Clone, Debug, PartialEq)]
pub enum Message {
    /// A message that needs nothing else.
    Plain(MessageId),
    /// A message of one axis, with what stands after it, `A` to `E` or `3F`, where it has one.
    Axis {
        /// Text and class of the message.
        id: MessageId,
        /// Number of the axis ([`AxisId`]); 5 is the spindle.
        axis: u8,
        /// What stands after its text; `None` for nothing.
        letter: Option<&'static str>,
    },
    /// `LIMIT SWITCH` with axis and sign.
    Limit {
        /// Number of the axis ([`AxisId`]).
        axis: u8,
        /// At which end of its traverse range it stands.
        end: Direction,
    },
    /// `ERROR IN PLC-PROGRAM` with the code of the markers that contradict each other.
    PlcMarkers([u8; 2]),
    /// The PLC stopped with a run-time error: its number, file and line.
    PlcStopped {
        /// Error number 50 to 56.
        number: u8,
        /// Source file of the PLC program.
        file: String,
        /// Line of that file, from 1.
        line: u32,
    },
    /// PLC message 0 to 99 (M2924 to M3023).
    Plc(u8),
    /// A fault of the part program.
    Program(Box<ProgramError>),
    /// An axis that the PLC wants to hand over to another channel cannot go *(inferred)*.
    HandOver {
        /// Number of the axis ([`AxisId`]).
        axis: u8,
        /// What keeps it in its channel.
        why: HandOverError,
    },
}

impl Message {
    pub(crate) fn limit(axis: AxisId, end: Direction) -> Message {
        Message::Limit {
            axis: axis.number(),
            end,
        }
    }

    pub(crate) fn axis(id: MessageId, axis: AxisId, letter: Option<&'static str>) -> Message {
        Message::Axis {
            id,
            axis: axis.number(),
            letter,
        }
    }

    /// The text that the model shows, `plc` being the texts of the PLC messages.
    pub fn text(&self, model: ControlModel, letters: &[char], plc: &[String]) -> String {
        let with_axis = |id: MessageId, axis: u8| {
            let letter = letters.get(usize::from(axis)).copied().unwrap_or('S');
            let text = id.text(model);
            if text.contains('#') {
                text.replace('#', letter.encode_utf8(&mut [0; 4]))
            } else {
                format!("{text} {letter}")
            }
        };
        match self {
            Message::Plain(id) => id.text(model).to_owned(),
            Message::Axis { id, axis, letter } => match letter {
                Some(letter) => format!("{} {letter}", with_axis(*id, *axis)),
                None => with_axis(*id, *axis),
            },
            Message::Limit { axis, end } => format!("{}{end}", with_axis(MessageId::LimitSwitch, *axis)),
            Message::PlcMarkers(code) => format!(
                "{} {}",
                MessageId::ErrorInPlcProgram.text(model),
                String::from_utf8_lossy(code)
            ),
            // The error list of the PLC prints the number after it [000:11919].
            Message::PlcStopped { number, .. } => {
                format!("{} {number}", MessageId::ErrorInPlcProgram.text(model))
            }
            Message::Plc(number) => plc
                .get(usize::from(*number))
                .filter(|text| !text.is_empty())
                .cloned()
                .unwrap_or_else(|| format!("PLC: ERROR {number}")),
            Message::Program(error) => error.message.text(model).to_owned(),
            Message::HandOver { axis, why } => {
                let letter = letters.get(usize::from(*axis)).copied().unwrap_or('S');
                format!("AXIS {letter} NOT HANDED OVER: {why}")
            }
        }
    }

    /// Where it comes from, beside the text: program, block and detail; file and line.
    pub fn place(&self) -> Option<String> {
        match self {
            Message::PlcStopped { file, line, .. } => Some(format!("{file} line {line}")),
            Message::Program(error) => {
                let mut place = format!("program {} block {}", error.program, error.block.block);
                if !error.detail.is_empty() {
                    place.push_str(": ");
                    place.push_str(&error.detail);
                }
                Some(place)
            }
            _ => None,
        }
    }

    /// Its row in the table of faults; a message of the PLC as it is without M2815.
    pub fn fault(&self) -> FaultId {
        match self {
            Message::Plain(id) => of_plain(*id),
            Message::Axis { id, letter, .. } => of_axis(*id, *letter),
            Message::Limit { .. } => FaultId::Limit,
            Message::PlcMarkers(_) => FaultId::PlcMarkers,
            Message::PlcStopped { .. } => FaultId::PlcStopped,
            Message::Plc(_) => FaultId::PlcMessage,
            Message::Program(_) => FaultId::Program,
            Message::HandOver { .. } => FaultId::HandOver,
        }
    }

    fn is_emergency_stop(&self) -> bool {
        *self == Message::Plain(MessageId::ExternalEmergencyStop)
    }

    fn plc_number(&self) -> Option<u8> {
        match self {
            Message::Plc(number) => Some(*number),
            _ => None,
        }
    }
}

/// The row of a message that needs nothing else.
fn of_plain(id: MessageId) -> FaultId {
    let of_machine = [
        FaultId::StylusDeflection,
        FaultId::PowerInterrupted,
        FaultId::BufferBattery,
        FaultId::MemoryDefective,
        FaultId::MemoryChecksum,
        FaultId::VoltageMissing,
        FaultId::EmergencyStopDefective,
        FaultId::ExternalEmergencyStop,
        FaultId::EmergencyStopPlc,
        FaultId::Key,
        FaultId::SpindleSpeed,
    ];
    let mut rows = of_machine.into_iter();
    rows.find(|fault| fault.row().message == Some(id))
        .unwrap_or(FaultId::Other)
}

/// The row of a message of an axis.
fn of_axis(id: MessageId, letter: Option<&str>) -> FaultId {
    let of_loops = [
        FaultId::Positioning,
        FaultId::GrossDeviation,
        FaultId::GrossVoltage,
        FaultId::GrossMovement,
        FaultId::GrossStandstill,
        FaultId::GrossOffset,
        FaultId::SpeedController,
        FaultId::EncoderAmplitude,
        FaultId::EncoderEdges,
        FaultId::EncoderMarks,
    ];
    let mut rows = of_loops.into_iter();
    rows.find(|fault| {
        let row = fault.row();
        row.message == Some(id) && row.letter == letter.unwrap_or_default()
    })
    .unwrap_or(FaultId::Other)
}

/// A message with how it is shown.
#[derive(Clone, Debug, PartialEq)]
pub struct Shown {
    /// What the control has to say.
    pub message: Message,
    /// It flashes: only power-off clears it.
    pub flashing: bool,
    /// When it came up, µs since power-on.
    pub time_us: u64,
    /// The block that was executed, or that it refuses.
    pub block: Option<BlockRef>,
    /// The channel that says it, from 0; `None` for the machine as a whole.
    pub channel: Option<usize>,
}

impl Shown {
    /// Its row in the table of faults.
    pub fn fault(&self) -> FaultId {
        match self.message.fault() {
            FaultId::PlcMessage if self.flashing => FaultId::PlcMessageFlashing,
            fault => fault,
        }
    }
}

/// The messages that are shown, and their history.
#[derive(Clone, Debug, Default)]
pub(crate) struct Messages {
    shown: Vec<Shown>,
    /// What came up since somebody asked.
    news: Vec<Shown>,
    /// Time since power-on, µs.
    now_us: u64,
    /// Who shows messages now; `None` for the machine as a whole.
    channel: Option<usize>,
    printed: PrintOut,
}

/// What FN15 has printed since somebody asked: a bounded list that is there before anything is printed.
#[derive(Debug)]
struct PrintOut {
    lines: Vec<Printed>,
    /// Lines that found no place.
    lost: u32,
}

/// A line that FN15 has printed, and the channel whose program did so.
pub type Printed = (usize, Arc<str>);

/// Lines that wait to be taken.
const PRINTED_MAX: usize = 64;

/// A copy has as much place as the original.
impl Clone for PrintOut {
    fn clone(&self) -> PrintOut {
        let mut copy = PrintOut::default();
        copy.lines.extend_from_slice(&self.lines);
        copy.lost = self.lost;
        copy
    }
}

impl Default for PrintOut {
    fn default() -> PrintOut {
        PrintOut {
            lines: Vec::with_capacity(PRINTED_MAX),
            lost: 0,
        }
    }
}

/// News that nobody took are dropped beyond this, the oldest first.
const NEWS_MAX: usize = 10_000;

impl Messages {
    /// Messages come up at this time from now on, µs since power-on.
    pub fn set_time(&mut self, now_us: u64) {
        self.now_us = now_us;
    }

    /// What is shown was shown at this time at first, µs.
    pub fn restart(&mut self, now_us: u64) {
        self.now_us = now_us;
        let shown = self.shown.iter_mut().chain(&mut self.news);
        shown.for_each(|shown| shown.time_us = now_us);
    }

    /// Shows nothing any more.
    pub fn forget(&mut self) {
        self.shown.clear();
        self.news.clear();
    }

    /// Time since power-on, µs.
    pub fn time_us(&self) -> u64 {
        self.now_us
    }

    /// What is shown now comes from a channel.
    pub fn of_channel(&mut self, channel: usize) -> &mut Messages {
        self.channel = Some(channel);
        self
    }

    /// What is shown now comes from the machine as a whole.
    pub fn of_machine(&mut self) -> &mut Messages {
        self.channel = None;
        self
    }

    /// Shows a message; the same one again changes nothing. Whether it flashes is said by its fault.
    pub fn show(&mut self, message: Message, block: Option<BlockRef>) {
        let fault = message.fault();
        self.show_as(fault, message, block);
    }

    fn show_as(&mut self, fault: FaultId, message: Message, block: Option<BlockRef>) {
        let own = self.channel;
        let is_same = |shown: &Shown| {
            let other = shown.channel.zip(own).is_some_and(|(one, other)| one != other);
            shown.message == message && !other
        };
        if self.shown.iter().any(is_same) {
            return;
        }
        let shown = Shown {
            message,
            flashing: fault.row().flashes(),
            time_us: self.now_us,
            block,
            channel: self.channel,
        };
        if self.news.len() >= NEWS_MAX {
            self.news.remove(0);
        }
        self.news.push(shown.clone());
        self.shown.push(shown);
    }

    /// What is shown, the oldest first.
    pub fn shown(&self) -> &[Shown] {
        &self.shown
    }

    /// Something is new since it was taken.
    pub fn has_news(&self) -> bool {
        !self.news.is_empty()
    }

    /// A message is shown that switches "control is ready" off: the control does nothing more.
    pub fn is_fatal(&self) -> bool {
        let fatal = |shown: &Shown| shown.fault().row().reaction == Reaction::ControlReadyOff;
        self.shown.iter().any(fatal)
    }

    pub fn contains(&self, message: &Message) -> bool {
        self.shown.iter().any(|shown| shown.message == *message)
    }

    pub fn take_news(&mut self) -> Vec<Shown> {
        std::mem::take(&mut self.news)
    }

    /// FN15: the path has come to a line that is printed.
    pub fn print(&mut self, line: &Arc<str>) {
        let channel = self.channel.unwrap_or(0);
        match self.printed.lines.len() < PRINTED_MAX {
            true => self.printed.lines.push((channel, Arc::clone(line))),
            false => self.printed.lost += 1,
        }
    }

    /// What was printed since the last call, and how many lines found no place.
    pub fn take_printed(&mut self, mut take: impl FnMut(Printed)) -> u32 {
        self.printed.lines.drain(..).for_each(&mut take);
        std::mem::take(&mut self.printed.lost)
    }

    /// CE: clears the first message that it clears, with the control voltage `back` or not.
    pub fn clear(&mut self, exchange: &mut Exchange, back: bool) -> Option<Message> {
        let may = |shown: &Shown| match shown.fault().row().clearing {
            Clearing::Ce | Clearing::CeOrPlc => true,
            Clearing::CeWithVoltage => back,
            Clearing::Itself | Clearing::PowerOff => false,
        };
        let at = self.shown.iter().position(may)?;
        let message = self.shown.remove(at).message;
        if let Some(marker) = message
            .plc_number()
            .and_then(|n| signal::PLC_MESSAGES.get(n.into()))
        {
            exchange.nc_set(marker, false);
        }
        Some(message)
    }

    /// Takes a message away whose reason is gone.
    pub fn remove(&mut self, message: &Message) {
        self.shown.retain(|shown| shown.message != *message);
    }

    /// After a PLC scan: the PLC's messages by their markers. With M2815 they flash; M2815 alone is
    /// `EMERGENCY STOP PLC` [000:6625-6633].
    pub fn follow_plc(&mut self, exchange: &Exchange, block: Option<BlockRef>) {
        self.channel = None;
        let nc = exchange.nc();
        let flashes = nc.bit(signal::PLC_MESSAGE_FLASHES);
        let fault = match flashes {
            true => FaultId::PlcMessageFlashing,
            false => FaultId::PlcMessage,
        };
        let any = nc.any(signal::PLC_MESSAGES);
        if any {
            let markers = (0..).zip(signal::PLC_MESSAGES.iter());
            for (number, _) in markers.filter(|(_, marker)| nc.bit(*marker)) {
                if flashes {
                    self.flash(&Message::Plc(number));
                }
                self.show_as(fault, Message::Plc(number), block);
            }
        }
        self.shown.retain(|shown| {
            let marker = shown
                .message
                .plc_number()
                .and_then(|n| signal::PLC_MESSAGES.get(n.into()));
            shown.flashing || marker.is_none_or(|marker| nc.bit(marker))
        });
        if flashes && !any {
            self.show(Message::Plain(MessageId::EmergencyStopPlc), block);
        }
    }

    /// A message that is shown begins to flash.
    fn flash(&mut self, message: &Message) {
        let shown = self.shown.iter_mut().filter(|shown| shown.message == *message);
        shown.for_each(|shown| shown.flashing = true);
    }

    /// M2190: a message stands that does not flash; M2191: `EXTERNAL EMERGENCY STOP` does.
    pub fn markers(&self) -> [(bahn_exchange::Bit, bool); 2] {
        [
            (
                signal::CANCELLABLE_MESSAGE_SHOWN,
                self.shown.iter().any(|shown| !shown.flashing),
            ),
            (
                signal::EMERGENCY_STOP_SHOWN,
                self.shown.iter().any(|shown| shown.message.is_emergency_stop()),
            ),
        ]
    }
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used, reason = "a helper that panics fails its test")]
    use super::*;

    const MODEL: ControlModel = ControlModel::Tnc415b;
    const LETTERS: [char; bahn_parameters::PLC_AXES] = ['X', 'Y', 'Z', 'C', 'V'];

    fn id(number: u8) -> AxisId {
        AxisId::new(number).unwrap()
    }

    fn text(message: &Message) -> String {
        message.text(MODEL, &LETTERS, &["TOOL CLAMP OPEN".to_owned(), String::new()])
    }

    #[test]
    fn texts_carry_axis_sign_and_letter() {
        let gross = Message::axis(MessageId::GrossPositioningError, id(3), Some("A"));
        assert_eq!(text(&gross), "GROSS POSITIONING ERROR C A");
        assert_eq!(text(&Message::limit(id(0), Direction::Minus)), "LIMIT SWITCH X-");
        let encoder = Message::axis(MessageId::MeasuringSystemDefective, id(2), Some("B"));
        assert_eq!(text(&encoder), "MEASURING SYSTEM Z DEFECTIVE B");
        assert_eq!(text(&Message::PlcMarkers(*b"1Q")), "ERROR IN PLC-PROGRAM 1Q");
        assert_eq!(text(&Message::Plc(0)), "TOOL CLAMP OPEN");
        assert_eq!(
            text(&Message::Plc(1)),
            "PLC: ERROR 1",
            "an empty line has the default text"
        );
        assert_eq!(text(&Message::Plc(99)), "PLC: ERROR 99");
    }

    fn plc_sets(exchange: &mut Exchange, bit: bahn_exchange::Bit, value: bool) {
        exchange.begin_scan();
        exchange.plc_mut().set_bit(bit, value);
        exchange.end_scan();
    }

    /// CE steps through several PLC messages and resets their markers; the PLC may do so, too
    /// [000:6625-6633].
    #[test]
    fn plc_messages_follow_their_markers() {
        let mut exchange = Exchange::default();
        let mut messages = Messages::default();
        let marker = |number| signal::PLC_MESSAGES.get(number);
        for number in [5, 7] {
            plc_sets(&mut exchange, marker(number).unwrap_or(signal::NC_START), true);
        }
        messages.follow_plc(&exchange, None);
        assert_eq!(messages.shown().len(), 2);
        assert_eq!(messages.clear(&mut exchange, true), Some(Message::Plc(5)));
        exchange.begin_scan();
        assert_eq!(
            marker(5).map(|m| exchange.plc().bit(m)),
            Some(false),
            "NC resets M2929"
        );
        exchange.end_scan();
        plc_sets(&mut exchange, marker(7).unwrap_or(signal::NC_START), false);
        messages.follow_plc(&exchange, None);
        assert!(messages.shown().is_empty());
    }

    /// M2815 acts on a message that is shown, too [000:6625-6633].
    #[test]
    fn m2815_makes_a_shown_message_flash() {
        let mut exchange = Exchange::default();
        let mut messages = Messages::default();
        plc_sets(&mut exchange, signal::PLC_MESSAGES.get(3).unwrap(), true);
        messages.follow_plc(&exchange, None);
        assert!(!messages.is_fatal());
        plc_sets(&mut exchange, signal::PLC_MESSAGE_FLASHES, true);
        messages.follow_plc(&exchange, None);
        assert!(messages.is_fatal());
        assert_eq!(messages.shown().len(), 1);
        assert_eq!(messages.clear(&mut exchange, true), None);
    }

    #[test]
    fn m2815_makes_them_flash() {
        let mut exchange = Exchange::default();
        let mut messages = Messages::default();
        plc_sets(&mut exchange, signal::PLC_MESSAGE_FLASHES, true);
        messages.follow_plc(&exchange, None);
        assert_eq!(
            messages.shown().first().map(|s| text(&s.message)).as_deref(),
            Some("EMERGENCY STOP PLC")
        );
        assert!(messages.is_fatal());
        assert_eq!(messages.clear(&mut exchange, true), None, "CE does not clear it");
    }
}
