//! Messages of the control, and how they are acknowledged [002:939-948] [002:3330-3420].
//!
//! Decision: Faults of programs and of axes are of high priority: they break the program of their channel off. The circuit of
//! EMERGENCY STOP is a message of the system

use std::borrow::Cow;
use std::fmt;

/// Messages that are kept at most; an older one makes room for a further one.
const KEPT: usize = 256;

/// What a message does.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Kind {
    /// It breaks the programs of all channels off.
    System,
    /// It breaks the program of its channel off.
    High,
    /// It stops the program of its channel.
    Low,
    /// It is shown.
    Display,
}

impl Kind {
    /// As reports write it.
    pub fn id(self) -> &'static str {
        match self {
            Kind::System => "system",
            Kind::High => "high",
            Kind::Low => "low",
            Kind::Display => "display",
        }
    }
}

/// A message of the control.
#[derive(Clone, Debug, PartialEq)]
pub struct Message {
    /// When it came, µs since power-on.
    pub time_us: u64,
    /// Its number; 0 where the manual names none.
    pub number: u32,
    /// Its channel, from 1 on.
    pub channel: u8,
    /// The logical axis that it is about, from 1 on.
    pub axis: Option<u8>,
    /// What it does.
    pub kind: Kind,
    /// What it says.
    pub text: Cow<'static, str>,
    /// It is acknowledged since, µs.
    pub acknowledged_us: Option<u64>,
}

/// `M2001 lag error, channel 1, axis 2`; without a number its text.
impl fmt::Display for Message {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        if self.number > 0 {
            write!(f, "M{} ", self.number)?;
        }
        write!(f, "{}, channel {}", self.text, self.channel)?;
        self.axis.map_or(Ok(()), |axis| write!(f, ", axis {axis}"))
    }
}

/// What the chapter says of its numbers.
pub(crate) fn text_of(number: u32) -> &'static str {
    match number {
        2000 => "emergency position is approached",
        2001 => "lag error",
        2002 => "admissible command value reached",
        2020 => "axis must not be moved",
        2022 => "axis does not come to a standstill",
        1320 => "mode change is locked",
        _ => "message of program or PLC",
    }
}

/// The messages of a control.
#[derive(Clone, Debug, Default)]
pub(crate) struct Messages {
    list: Vec<Message>,
    /// Those that made room for others.
    dropped: usize,
}

impl Messages {
    /// Makes room for all that are kept.
    pub fn reserve(&mut self) {
        if self.list.capacity() < KEPT {
            self.list.reserve(KEPT - self.list.len());
        }
    }

    /// One comes, unless the same is pending; whether it is new.
    pub fn raise(&mut self, message: Message) -> bool {
        let is_same = |other: &Message| {
            other.acknowledged_us.is_none()
                && (other.number, other.channel, other.axis)
                    == (message.number, message.channel, message.axis)
                && other.text == message.text
        };
        if self.list.iter().any(is_same) {
            return false;
        }
        if self.list.len() >= KEPT {
            // The oldest one that is acknowledged makes room, else the oldest one.
            let done = self.list.iter().position(|old| old.acknowledged_us.is_some());
            self.list.remove(done.unwrap_or(0));
            self.dropped += 1;
        }
        self.list.push(message);
        true
    }

    /// Those of a channel are acknowledged, and with them those of the system.
    pub fn acknowledge(&mut self, channel: u8, now_us: u64) {
        let pending = self
            .list
            .iter_mut()
            .filter(|message| message.acknowledged_us.is_none());
        for message in pending.filter(|message| message.channel == channel || message.kind == Kind::System) {
            message.acknowledged_us = Some(now_us);
        }
    }

    /// How many came since power-on.
    pub fn count(&self) -> usize {
        self.list.len() + self.dropped
    }

    /// Those that are kept, the first one first.
    pub fn all(&self) -> &[Message] {
        &self.list
    }

    /// One that nobody has acknowledged breaks the program of a channel off.
    pub fn break_off(&self, channel: u8) -> bool {
        let mut open = self
            .list
            .iter()
            .filter(|message| message.acknowledged_us.is_none());
        open.any(|message| match message.kind {
            Kind::System => true,
            Kind::High => message.channel == channel,
            Kind::Low | Kind::Display => false,
        })
    }

    /// Those of a channel that nobody has acknowledged.
    pub fn pending(&self, channel: u8) -> impl Iterator<Item = &Message> {
        let all = self.list.iter();
        all.filter(move |message| message.channel == channel && message.acknowledged_us.is_none())
    }
}
