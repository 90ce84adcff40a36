//! The parameters of a control that runs: who may write, what a write does, who hears of it.
//!
//! Decision: A write goes to those whom the status names, and to the PLC also where the table gives the parameter a marker;
//! never back to the one who wrote it. One that goes to the interpolator or runs a routine does so whatever its value was
//! before: clearing P12111 again is a command again. q1 goes to the PLC as the manual says of it
//!
//! Decision: Routines belong to numbers, whatever bit 3 of the status byte 2 says: files seldom give statuses
//!
//! Decision: P11308 takes no value but that of a unit. Active locks follow a write of a switch or definition at once

use crate::array::Cell;
use crate::channels::Channels;
use crate::events::{Event, EventBuffer, Key, Partner};
use crate::locks::{Part, Writer, refusing};
use crate::memory::{Memory, Place, SpaceError};
use crate::messages::MessageKind;
use crate::name::Name;
use crate::numbers::{
    ABSOLUTE, ACKNOWLEDGE, AXES, AXES_OF_SYSTEM, AXIS, AXIS_BLOCK, DIAGNOSIS, FROM_PLC, FUNCTION, KEY,
    LOCK_SWITCHES, MESSAGES, PICTURE, POSITION, REACHED, RELATIVE, SAMPLE_ENTRY, SHARED, TO_PLC, UNIT,
};
use crate::outbox::{News, Outbox, Receiver, Transfer};
use crate::table::row;
use crate::units::Unit;
use crate::value::Value;

/// Parameters below it belong to no channel [002:16-22].
const OF_CHANNELS_FROM: u32 = 10_000;

/// It is not counted [002:6244-6245].
const NOT_DIAGNOSED: Name = Name::Q(1160);

/// A routine of the control that a write asks for, and that is none of the parameters alone.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Routine {
    /// The function of q10.
    Flash(i64),
    /// A message of a channel: kind and number.
    Message(u8, MessageKind, i64),
    /// The messages of a channel are acknowledged, P8508.
    Acknowledge(u8),
}

/// What a parameter of an axis tells the interpolator [002:7795-7815].
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum AxisCommand {
    /// P12110: the position counts as this, mm or degrees; `None` shows the one before again.
    SetPosition(Option<f64>),
    /// P12111: moves by so much, mm or degrees; `None` aborts such a movement.
    MoveBy(Option<f64>),
    /// P12112: moves to there, mm or degrees; `None` aborts such a movement.
    MoveTo(Option<f64>),
}

impl AxisCommand {
    /// That of a write: the physical axis, from 1 on, and what it tells; `None` for other parameters.
    pub fn of(transfer: Transfer) -> Option<(u8, AxisCommand)> {
        let (axis, offset) = of_axis(transfer.place)?;
        let value = transfer.cell.number();
        let command = match offset {
            POSITION => AxisCommand::SetPosition(value),
            RELATIVE => AxisCommand::MoveBy(value),
            ABSOLUTE => AxisCommand::MoveTo(value),
            _ => return None,
        };
        Some((axis, command))
    }
}

/// Physical axis and place among its parameters.
fn of_axis(place: Place) -> Option<(u8, u32)> {
    let at = place.q()?.checked_sub(AXIS.1)?;
    let axis = u8::try_from(at / AXIS_BLOCK + 1).ok()?;
    (axis <= AXES).then_some((axis, at % AXIS_BLOCK))
}

/// Memory, queues and event buffer. A write allocates nothing but the words of a refusal.
///
/// ```
/// use bahn_system900::{Depth, EventBuffer, Memory, News, Receiver, Running, Writer};
/// let mut running = Running::new(Memory::new(), EventBuffer::new(Depth::Short));
/// assert_eq!(running.next(Receiver::Plc), Some(News::All), "after power-on");
/// // P11137 has no marker: the PLC hears nothing of it.
/// running.write(0, Writer::Editor, "P11137".parse()?, "5".parse()?)?;
/// assert_eq!(running.next(Receiver::Plc), None);
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
#[derive(Clone, Debug, PartialEq)]
pub struct Running {
    memory: Memory,
    events: EventBuffer,
    outboxes: [Outbox; 3],
    auto: Channels,
}

impl Running {
    /// That of power-on, after the starting routine.
    pub fn new(memory: Memory, events: EventBuffer) -> Running {
        // The table is read now, not in a control cycle.
        let _ = row(Name::Q(0));
        Running {
            memory,
            events,
            outboxes: [Outbox::new(), Outbox::new(), Outbox::new()],
            auto: Channels::NONE,
        }
    }

    /// What the parameters hold.
    pub fn memory(&self) -> &Memory {
        &self.memory
    }

    /// The memory for a function of the FLASH or a file; all receivers take everything anew.
    pub fn replace(&mut self) -> &mut Memory {
        self.outboxes.iter_mut().for_each(Outbox::restart);
        &mut self.memory
    }

    /// The event buffer.
    pub fn events(&mut self) -> &mut EventBuffer {
        &mut self.events
    }

    /// Records an event that the parameters ask for.
    pub fn record(&mut self, time_ms: u64, event: Event) {
        self.events.record(&self.memory, time_ms, event);
    }

    /// Says which channels are in AUTO: their P8510 locks beside the switches [002:3387-3411].
    pub fn set_auto(&mut self, auto: Channels) {
        if self.auto != auto {
            self.auto = auto;
            self.memory.update_locks(auto);
        }
    }

    /// What a receiver takes next; `None` when it has all.
    pub fn next(&mut self, receiver: Receiver) -> Option<News> {
        self.outboxes.get_mut(index(receiver))?.next()
    }

    /// All parameters that are a receiver's own, and hold something.
    pub fn all(&self, receiver: Receiver) -> impl Iterator<Item = Transfer> {
        let places = self.memory.loaded();
        let own = places.filter(move |place| self.goes_to(*place, receiver));
        own.map(|place| Transfer {
            place,
            cell: self.memory.at(place),
        })
    }

    /// Whether a write of a place goes to a receiver.
    fn goes_to(&self, place: Place, receiver: Receiver) -> bool {
        let receivers = self.memory.at(place).status().receivers();
        match receiver {
            Receiver::Interpolator => receivers.interpolator,
            // As the manual says of it [002:376-379].
            Receiver::Plc if place == Place::Q(AXES_OF_SYSTEM) => true,
            Receiver::Plc => {
                receivers.plc || row(self.memory.name_of(place)).is_some_and(|row| row.plc().next().is_some())
            }
            Receiver::Panel => receivers.panel || receivers.panel_always,
        }
    }

    /// Writes a value as somebody at a time; the routine that the control runs for it.
    ///
    /// # Errors
    /// When the name leads nowhere, a lock holds the write back, or the value does not go in; then nothing has changed.
    pub fn write(
        &mut self,
        time_ms: u64,
        writer: Writer,
        name: Name,
        value: Value,
    ) -> Result<Option<Routine>, SpaceError> {
        let place = self.memory.place(name)?;
        // A parameter does the same by whatever name it is called; a refusal has the name that was said.
        let own = self.memory.name_of(place);
        if own == Name::P(1, UNIT) {
            if let Some(lock) = refusing(&self.memory, writer, Part::Value, own)? {
                return Err(SpaceError::of_lock(name, lock));
            }
            let unit = unit(value).ok_or(SpaceError::NoUnit(name))?;
            self.memory.change_unit(unit)?;
            self.outboxes.iter_mut().for_each(Outbox::restart);
        } else {
            let entered = self.memory.enter_as(writer, own, value);
            entered.map_err(|error| error.of_name(name))?;
        }
        self.sent(time_ms, writer, place);
        Ok(self.routine(time_ms, own, place))
    }

    /// Tells receivers and event buffer of a write.
    fn sent(&mut self, time_ms: u64, writer: Writer, place: Place) {
        let cell = self.memory.at(place);
        let wrote = match writer {
            Writer::Plc => Some(Receiver::Plc),
            Writer::Editor | Writer::Page => Some(Receiver::Panel),
            Writer::Program | Writer::Control => None,
        };
        let named = match place {
            Place::Q(number) if number < OF_CHANNELS_FROM => Name::Q(number),
            _ => self.memory.name_of(place),
        };
        match wrote {
            Some(Receiver::Plc) => {
                self.record(time_ms, Event::Received(Partner::Plc, named, cell));
                self.diagnose(false, named, cell);
            }
            Some(Receiver::Panel) => self.record(time_ms, Event::Received(Partner::Panel, named, cell)),
            _ => {}
        }
        for receiver in Receiver::ALL {
            if wrote == Some(receiver) || !self.goes_to(place, receiver) {
                continue;
            }
            if let Some(outbox) = self.outboxes.get_mut(index(receiver)) {
                outbox.push(Transfer { place, cell });
            }
            match receiver {
                Receiver::Plc => {
                    self.record(time_ms, Event::Sent(Partner::Plc, named, cell));
                    self.diagnose(true, named, cell);
                }
                Receiver::Panel => self.record(time_ms, Event::Sent(Partner::Panel, named, cell)),
                Receiver::Interpolator => {}
            }
        }
        if cell.status().receivers().sample {
            self.record(time_ms, Event::Written(named, cell));
        }
    }

    /// What a write does beside; what is left to the control.
    fn routine(&mut self, time_ms: u64, name: Name, place: Place) -> Option<Routine> {
        let cell = self.memory.at(place);
        let (channel, number) = match name {
            Name::Q(FUNCTION) => return cell.whole().map(Routine::Flash),
            Name::Q(_) => {
                self.clear_reached(time_ms, place, cell);
                return None;
            }
            Name::P(channel, number) => (channel, number),
        };
        match number {
            SAMPLE_ENTRY => self.record(time_ms, Event::Entry(cell)),
            KEY => {
                if let Some(bits) = cell.bits() {
                    self.record(time_ms, Event::Key(Key(bits)));
                }
            }
            // The second half of the name, after the first one.
            PICTURE => self.picture(time_ms),
            ACKNOWLEDGE => return Some(Routine::Acknowledge(channel)),
            number if LOCK_SWITCHES.contains(&number) => self.memory.update_locks(self.auto),
            number => {
                let kind = number
                    .checked_sub(MESSAGES)
                    .and_then(|kind| usize::try_from(kind).ok());
                if let Some(kind) = kind.and_then(|kind| MessageKind::ALL.get(kind)) {
                    let message = cell.whole().filter(|message| *message > 0)?;
                    if let Ok(message) = u16::try_from(message) {
                        self.record(time_ms, Event::Message(channel, message));
                    }
                    return Some(Routine::Message(channel, *kind, message));
                }
                self.clear_reached(time_ms, place, cell);
            }
        }
        None
    }

    /// Another picture is shown: its name stands in two parameters [002:6059-6068].
    fn picture(&mut self, time_ms: u64) {
        let bytes = |number| self.memory.shared(number).bits().unwrap_or(0).to_le_bytes();
        let letters = bytes(PICTURE - 1).into_iter().chain(bytes(PICTURE));
        let mut name = [0; 8];
        for (slot, letter) in name.iter_mut().zip(letters) {
            *slot = letter;
        }
        self.record(time_ms, Event::Picture(name));
    }

    /// Counts an exchange with the PLC while P11280 asks for it, and shows the last one [002:6205-6247].
    fn diagnose(&mut self, to_plc: bool, named: Name, cell: Cell) {
        let (channel, number) = match named {
            Name::Q(number) => (0, number),
            Name::P(channel, number) => (channel, number),
        };
        if self.memory.shared(DIAGNOSIS).whole() != Some(1) || named == NOT_DIAGNOSED {
            return;
        }
        let first = if to_plc { TO_PLC } else { FROM_PLC };
        let count = self.memory.shared(first).whole().unwrap_or(0);
        let count = i32::try_from(count).unwrap_or(0).wrapping_add(1);
        let shown = [count, channel.into(), i32::try_from(number).unwrap_or(0)];
        for (place, value) in (first..).zip(shown) {
            self.memory.set_shared(place, value);
        }
        self.memory.set_number(Name::P(1, first + 3), None);
        if let Some(bits) = cell.bits() {
            self.memory.set_word(first + 3 - SHARED.0 + SHARED.1, bits);
        }
    }

    /// Clearing P12111 or P12112 takes the report back that the position is reached [002:7799-7815].
    fn clear_reached(&mut self, time_ms: u64, place: Place, cell: Cell) {
        let Some((axis, offset @ (RELATIVE | ABSOLUTE))) = of_axis(place) else {
            return;
        };
        if cell.bits().is_none() {
            let reached = Place::Q(AXIS.1 + AXIS_BLOCK * (u32::from(axis) - 1) + offset + REACHED);
            self.memory.set_at(reached, Some(0));
            self.sent(time_ms, Writer::Control, reached);
        }
    }
}

/// The unit that a value of P11308 says.
fn unit(value: Value) -> Option<Unit> {
    match value {
        Value::Cleared => Unit::from_value(None),
        Value::Bits(bits) => Unit::from_value(Some(bits.into())),
        Value::Decimal { digits, decimals: 0 } => Unit::from_value(Some(digits)),
        Value::Decimal { .. } => None,
    }
}

fn index(receiver: Receiver) -> usize {
    match receiver {
        Receiver::Interpolator => 0,
        Receiver::Plc => 1,
        Receiver::Panel => 2,
    }
}
