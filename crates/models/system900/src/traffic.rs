//! What goes between a control that runs, its PLC, its panel and its programs: who may write, what a write does to other
//! parameters, what is recorded of it and counted.
//!
//! Decision: A write goes to those whom the status names, and to the PLC also where the table gives the parameter a marker;
//! never back to the one who wrote it. q1 goes to the PLC as the manual says of it
//!
//! Decision: Routines belong to numbers, whatever bit 3 of the status byte 2 says: files seldom give statuses
//!
//! Decision: P11308 takes no value but that of a unit

use crate::array::Cell;
use crate::events::{Depth, Event, EventBuffer, Key, Partner};
use crate::locks::{Part, Writer, refusing};
use crate::memory::{Memory, Place, SpaceError};
use crate::name::Name;
use crate::numbers::{
    ABSOLUTE, AXES, AXES_OF_SYSTEM, AXIS, AXIS_BLOCK, DIAGNOSIS, FROM_PLC, FUNCTION, KEY, PICTURE, REACHED,
    RELATIVE, SAMPLE_ENTRY, SHARED, TO_PLC, UNIT,
};
use crate::table::row;
use crate::units::Unit;
use crate::value::Value;

/// Parameters below it belong to no channel [002:16-22].
const OF_CHANNELS_FROM: u32 = 10_000;

/// It is not counted [002:6244-6245].
const NOT_DIAGNOSED: Name = Name::Q(1160);

/// Physical axis and place among its parameters.
fn of_axis(place: Place) -> Option<(u8, u32)> {
    let at = place.q()?.checked_sub(AXIS.1)?;
    let axis = u8::try_from(at / AXIS_BLOCK + 1).ok()?;
    (axis <= AXES).then_some((axis, at % AXIS_BLOCK))
}

/// The event buffer, and what writes do beside. A write allocates nothing but the words of a refusal.
///
/// ```
/// use bahn_system900::{Memory, Traffic, Writer};
/// let (mut memory, mut traffic) = (Memory::new(), Traffic::new());
/// traffic.write(&mut memory, 1500, Writer::Editor, "P11279".parse()?, "5".parse()?)?;
/// assert_eq!(traffic.events().to_string(), "1 00:00:01,500 P11279: 5\n");
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
#[derive(Clone, Debug, PartialEq)]
pub struct Traffic {
    events: EventBuffer,
}

impl Default for Traffic {
    fn default() -> Traffic {
        Traffic::new()
    }
}

impl Traffic {
    /// Nothing has happened yet.
    pub fn new() -> Traffic {
        // The table is read now, not in a control cycle.
        let _ = row(Name::Q(0));
        Traffic {
            events: EventBuffer::new(Depth::Long),
        }
    }

    /// The event buffer.
    pub fn events(&self) -> &EventBuffer {
        &self.events
    }

    /// Records an event that the parameters ask for.
    pub fn record(&mut self, memory: &Memory, time_ms: u64, event: Event) {
        self.events.record(memory, time_ms, event);
    }

    /// Writes a value as somebody at a time, ms; the number of a function of q10 that is to be executed.
    ///
    /// # Errors
    /// When the name leads nowhere, a lock holds the write back, or the value does not go in; then nothing has changed.
    pub fn write(
        &mut self,
        memory: &mut Memory,
        time_ms: u64,
        writer: Writer,
        name: Name,
        value: Value,
    ) -> Result<Option<i64>, SpaceError> {
        let place = memory.place(name)?;
        // A parameter does the same by whatever name it is called; a refusal has the name that was said.
        let own = memory.name_of(place);
        if own == Name::P(1, UNIT) {
            if let Some(lock) = refusing(memory, writer, Part::Value, own)? {
                return Err(SpaceError::of_lock(name, lock));
            }
            let unit = unit(value).ok_or(SpaceError::NoUnit(name))?;
            memory.change_unit(unit)?;
        } else {
            let entered = memory.enter_as(writer, own, value);
            entered.map_err(|error| error.of_name(name))?;
        }
        self.pass(memory, time_ms, writer, place);
        Ok(self.routine(memory, time_ms, own, place))
    }

    /// Records and counts that somebody has written a place.
    pub fn pass(&mut self, memory: &mut Memory, time_ms: u64, writer: Writer, place: Place) {
        let cell = memory.at(place);
        let named = match place {
            Place::Q(number) if number < OF_CHANNELS_FROM => Name::Q(number),
            _ => memory.name_of(place),
        };
        let receivers = cell.status().receivers();
        match writer {
            Writer::Plc => {
                self.record(memory, time_ms, Event::Received(Partner::Plc, named, cell));
                diagnose(memory, false, named, cell);
            }
            Writer::Editor | Writer::Page => {
                self.record(memory, time_ms, Event::Received(Partner::Panel, named, cell));
            }
            Writer::Program | Writer::Control => {}
        }
        if writer != Writer::Plc && goes_to_plc(memory, place) {
            self.record(memory, time_ms, Event::Sent(Partner::Plc, named, cell));
            diagnose(memory, true, named, cell);
        }
        let at_panel = matches!(writer, Writer::Editor | Writer::Page);
        if !at_panel && (receivers.panel || receivers.panel_always) {
            self.record(memory, time_ms, Event::Sent(Partner::Panel, named, cell));
        }
        if receivers.sample {
            self.record(memory, time_ms, Event::Written(named, cell));
        }
    }

    /// What a write does beside.
    fn routine(&mut self, memory: &mut Memory, time_ms: u64, name: Name, place: Place) -> Option<i64> {
        let cell = memory.at(place);
        let number = match name {
            Name::Q(FUNCTION) => return cell.whole(),
            Name::Q(_) => {
                self.clear_reached(memory, time_ms, place, cell);
                return None;
            }
            Name::P(_, number) => number,
        };
        match number {
            SAMPLE_ENTRY => self.record(memory, time_ms, Event::Entry(cell)),
            KEY => {
                if let Some(bits) = cell.bits() {
                    self.record(memory, time_ms, Event::Key(Key(bits)));
                }
            }
            // The second half of the name, after the first one.
            PICTURE => self.picture(memory, time_ms),
            _ => self.clear_reached(memory, time_ms, place, cell),
        }
        None
    }

    /// Another picture is shown: its name stands in two parameters [002:6059-6068].
    fn picture(&mut self, memory: &Memory, time_ms: u64) {
        let bytes = |number| memory.shared(number).bits().unwrap_or(0).to_le_bytes();
        let letters = bytes(PICTURE - 1).into_iter().chain(bytes(PICTURE));
        let mut name = [0; 8];
        for (slot, letter) in name.iter_mut().zip(letters) {
            *slot = letter;
        }
        self.record(memory, time_ms, Event::Picture(name));
    }

    /// Clearing P12111 or P12112 takes the report back that the position is reached [002:7799-7815].
    fn clear_reached(&mut self, memory: &mut Memory, time_ms: u64, place: Place, cell: Cell) {
        let Some((axis, offset @ (RELATIVE | ABSOLUTE))) = of_axis(place) else {
            return;
        };
        if cell.bits().is_none() {
            let reached = Place::Q(AXIS.1 + AXIS_BLOCK * (u32::from(axis) - 1) + offset + REACHED);
            memory.set_at(reached, Some(0));
            self.pass(memory, time_ms, Writer::Control, reached);
        }
    }
}

/// Whether a write of a place goes to the PLC.
fn goes_to_plc(memory: &Memory, place: Place) -> bool {
    // As the manual says of it [002:376-379].
    place == Place::Q(AXES_OF_SYSTEM)
        || memory.at(place).status().receivers().plc
        || row(memory.name_of(place)).is_some_and(|row| row.plc().next().is_some())
}

/// Counts an exchange with the PLC while P11280 asks for it, and shows the last one [002:6205-6247].
fn diagnose(memory: &mut Memory, to_plc: bool, named: Name, cell: Cell) {
    let (channel, number) = match named {
        Name::Q(number) => (0, number),
        Name::P(channel, number) => (channel, number),
    };
    if memory.shared(DIAGNOSIS).whole() != Some(1) || named == NOT_DIAGNOSED {
        return;
    }
    let first = if to_plc { TO_PLC } else { FROM_PLC };
    let count = memory.shared(first).whole().unwrap_or(0);
    let count = i32::try_from(count).unwrap_or(0).wrapping_add(1);
    let shown = [count, channel.into(), i32::try_from(number).unwrap_or(0)];
    for (place, value) in (first..).zip(shown) {
        memory.set_shared(place, value);
    }
    memory.set_number(Name::P(1, first + 3), None);
    if let Some(bits) = cell.bits() {
        memory.set_word(first + 3 - SHARED.0 + SHARED.1, bits);
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
