//! Messages: their kinds, how parameters hold them, what the numbers mean that the manual names.

use std::sync::LazyLock;

use serde::Serialize;

use crate::memory::Memory;
use crate::name::Name;
use crate::numbers::{ACKNOWLEDGEMENT, CHANNELS_MAX, MESSAGES, PENDING};

/// How much a message stops [002:3368-3371].
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum MessageKind {
    /// It aborts all channels.
    System,
    /// It aborts its channel.
    High,
    /// It stops its channel.
    Low,
    /// It is shown, and stops nothing.
    Display,
}

impl MessageKind {
    /// From the one that stops most.
    pub const ALL: [MessageKind; 4] = [
        MessageKind::System,
        MessageKind::High,
        MessageKind::Low,
        MessageKind::Display,
    ];

    /// As reports write it.
    pub fn id(self) -> &'static str {
        match self {
            MessageKind::System => "system",
            MessageKind::High => "high",
            MessageKind::Low => "low",
            MessageKind::Display => "display",
        }
    }

    /// What it does, in words.
    pub fn words(self) -> &'static str {
        match self {
            MessageKind::System => "aborts all channels",
            MessageKind::High => "aborts the channel",
            MessageKind::Low => "stops the channel",
            MessageKind::Display => "is shown alone",
        }
    }

    /// Its place in the order of [`MessageKind::ALL`].
    pub(crate) fn index(self) -> usize {
        match self {
            MessageKind::System => 0,
            MessageKind::High => 1,
            MessageKind::Low => 2,
            MessageKind::Display => 3,
        }
    }

    /// The parameter of a channel that takes the number of such a message: P8500 to P8503.
    pub fn parameter(self, channel: u8) -> Name {
        Name::P(channel, MESSAGES + self.index() as u32)
    }
}

impl Serialize for MessageKind {
    fn serialize<S: serde::Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        serializer.serialize_str(self.id())
    }
}

/// The word of a message that is shown or was entered: P8509, P11250 to P11259 [002:3379-3384] [002:6018-6034].
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct MessageWord {
    /// The number of the message.
    pub number: u16,
    /// The channel, from 1 on; 0 for none.
    pub channel: u8,
    /// The axis, from 1 on; 0 for none.
    pub axis: u8,
}

impl MessageWord {
    /// Of the four bytes of a parameter.
    pub fn from_bits(bits: i32) -> MessageWord {
        let [low, high, channel, axis] = bits.to_le_bytes();
        MessageWord {
            number: u16::from_le_bytes([low, high]),
            channel,
            axis,
        }
    }

    /// The four bytes.
    pub fn bits(self) -> i32 {
        let [low, high] = self.number.to_le_bytes();
        i32::from_le_bytes([low, high, self.channel, self.axis])
    }
}

/// What of a channel is pending, a byte of q98 or q99 [002:609-628].
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Pending(u8);

impl Pending {
    /// With a message of the control.
    pub fn with(self, kind: MessageKind) -> Pending {
        Pending(self.0 | 1 << kind.index())
    }

    /// With a message of the PLC.
    pub fn with_plc(self, high: bool) -> Pending {
        Pending(self.0 | if high { 1 << 4 } else { 1 << 5 })
    }

    /// Whether a message of the control is pending.
    pub fn has(self, kind: MessageKind) -> bool {
        self.0 & 1 << kind.index() != 0
    }

    /// Whether a message of the PLC is pending.
    pub fn has_plc(self, high: bool) -> bool {
        self.0 & (if high { 1 << 4 } else { 1 << 5 }) != 0
    }

    /// The parameter of a channel and the place of its byte.
    fn place(channel: u8) -> Option<(u32, usize)> {
        let at = u32::from(channel).checked_sub(1)?;
        (channel <= CHANNELS_MAX).then_some((PENDING + at / 4, (at % 4) as usize))
    }

    /// What of a channel is pending.
    pub fn of(memory: &Memory, channel: u8) -> Pending {
        let byte = Pending::place(channel).and_then(|(number, byte)| {
            let bytes = memory.system(number).bits()?.to_le_bytes();
            bytes.get(byte).copied()
        });
        Pending(byte.unwrap_or(0))
    }

    /// Enters it for a channel.
    pub fn enter(self, memory: &mut Memory, channel: u8) {
        let Some((number, byte)) = Pending::place(channel) else {
            return;
        };
        let mut bytes = memory.system(number).bits().unwrap_or(0).to_le_bytes();
        if let Some(slot) = bytes.get_mut(byte) {
            *slot = self.0;
        }
        memory.set_word(number, i32::from_le_bytes(bytes));
    }
}

/// Who acknowledges the messages of the control, q157 [002:939-948]. A write of P8508 always does.
pub fn acknowledges_with_mode(memory: &Memory, channel: u8) -> bool {
    memory.descriptor(channel).entry(ACKNOWLEDGEMENT).whole() != Some(1)
}

/// A message as a channel holds it: P8500 to P8507 [002:3368-3375].
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Message {
    /// Its number.
    pub number: u16,
    /// How much it stops.
    pub kind: MessageKind,
    /// The logical axis that it is about.
    pub axis: Option<u8>,
    /// What its picture shows beside it, three numbers.
    pub information: [Option<i32>; 3],
}

impl Message {
    /// The pending message of a kind in a channel; `None` for none.
    pub fn of(memory: &Memory, channel: u8, kind: MessageKind) -> Option<Message> {
        let whole = |name| memory.cell(name).ok().and_then(|cell| cell.whole());
        let number = u16::try_from(whole(kind.parameter(channel))?).ok()?;
        let beside = |place: u32| whole(Name::P(channel, MESSAGES + place));
        let axis = beside(4).and_then(|axis| u8::try_from(axis).ok());
        (number > 0).then(|| Message {
            number,
            kind,
            axis: axis.filter(|axis| *axis > 0),
            information: [5, 6, 7].map(|place| beside(place).and_then(|number| i32::try_from(number).ok())),
        })
    }

    /// Enters the message in a channel.
    pub fn enter(&self, memory: &mut Memory, channel: u8) {
        memory.set_number(self.kind.parameter(channel), Some(self.number.into()));
        memory.set_number(Name::P(channel, MESSAGES + 4), self.axis.map(i32::from));
        for (place, number) in (5..).zip(self.information) {
            memory.set_number(Name::P(channel, MESSAGES + place), number);
        }
    }

    /// Takes the messages of a channel away, as their acknowledgement does.
    pub fn acknowledge(memory: &mut Memory, channel: u8) {
        for place in 0..8 {
            memory.set_number(Name::P(channel, MESSAGES + place), None);
        }
    }
}

/// A message that the manual names.
#[derive(Clone, Copy, Debug, Serialize)]
#[non_exhaustive]
pub struct NamedMessage {
    /// Its number.
    pub number: u16,
    /// How much it stops (inferred) [002:3368-3371].
    pub kind: MessageKind,
    /// What it says, in words of our own.
    pub title: &'static str,
    /// Why it comes.
    pub cause: &'static str,
    /// What helps.
    pub remedy: &'static str,
    /// Where the manual names it.
    pub source: &'static str,
}

/// All messages that the manual names, by their numbers.
pub fn named_messages() -> &'static [NamedMessage] {
    static MESSAGES: LazyLock<Vec<NamedMessage>> = LazyLock::new(|| {
        let lines = include_str!("../data/messages.tsv").lines().skip(1);
        lines.filter_map(read).collect()
    });
    &MESSAGES
}

/// The message of a number, `M1237`, `m 1237` or `1237`; `None` for one that the manual does not name.
pub fn named_message(word: &str) -> Option<&'static NamedMessage> {
    let word = word.trim();
    let digits = word.strip_prefix(['M', 'm']).unwrap_or(word).trim_start();
    let all = !digits.is_empty() && digits.bytes().all(|digit| digit.is_ascii_digit());
    let number: u16 = digits.parse().ok().filter(|_| all)?;
    named_messages().iter().find(|message| message.number == number)
}

/// Reads one line; a test proves that every line can be read.
fn read(line: &'static str) -> Option<NamedMessage> {
    let mut columns = line.split('\t');
    let mut next = || columns.next();
    Some(NamedMessage {
        number: next()?.strip_prefix('M')?.parse().ok()?,
        kind: {
            let id = next()?;
            MessageKind::ALL.into_iter().find(|kind| kind.id() == id)?
        },
        title: next()?,
        cause: next()?,
        remedy: next()?,
        source: next()?,
    })
}
