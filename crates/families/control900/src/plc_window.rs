//! The window of the PLC: which markers and double words are which parameters [002:3606-3816] [002:8015-8640].
//!
//! Decision: A parameter that the control, a program or the operator changes shows in the memory of the PLC at its next cycle, also where
//! the PLC gives it: P8706, which the control takes back with each M function with stop, is a 0 that the PLC program sets to 1 again
//!
//! Decision: `M8` is the marker of M function 8, the one that the manual connects with the block release [002:5488-5491]: it is 1 from its
//! transfer to its acknowledgement, of a flying one for one PLC cycle, of a branch until it is taken or its block is over
//!
//! Decision: Of several markers of one value the one that becomes 1 counts; when the one whose value it is becomes 0, it is 0

use bahn_exchange::{Bit, Exchange, Number};
use bahn_system900::{Cell, ChannelParameter, Direction, Marker, MarkerPart, Meaning, Place};

use crate::answers::bit;
use crate::command;
use crate::machine::Machine;

/// Which markers and double words of the PLC are which parameters.
///
/// ```
/// use bahn_control900::Window900;
/// use bahn_system900::DataFile;
/// let file = DataFile::read(b"q102: 10000\nq103: 5000\nq110: $01010058\n");
/// let release = file.memory().marker("SAFREK1")?;
/// let window = Window900::default().marker(release, "M300".parse()?).function(1, 8, "M408".parse()?);
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
#[derive(Clone, Debug, Default)]
pub struct Window900 {
    bits: Vec<BitEntry>,
    numbers: Vec<NumberEntry>,
    functions: Vec<FunctionEntry>,
    /// Transfers that the PLC has seen.
    seen: u64,
}

#[derive(Clone, Copy, Debug)]
struct BitEntry {
    marker: Marker,
    at: Bit,
    /// What the PLC has.
    last: bool,
}

#[derive(Clone, Copy, Debug)]
struct NumberEntry {
    place: Place,
    direction: Direction,
    at: Number,
    last: i32,
}

/// The marker of an M function.
#[derive(Clone, Copy, Debug)]
struct FunctionEntry {
    channel: u8,
    m: u16,
    at: Bit,
    shown: Shown,
}

/// Why the marker of an M function is 1.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Shown {
    No,
    /// For this cycle.
    Flying,
    /// Until it is acknowledged.
    Stop,
    /// Until it is taken, or its block is over.
    Branch,
}

impl Window900 {
    /// A marker of the table stands there.
    pub fn marker(mut self, marker: Marker, at: Bit) -> Window900 {
        self.bits.push(BitEntry {
            marker,
            at,
            last: false,
        });
        self
    }

    /// A parameter stands there as a whole: the integer of its number.
    pub fn number(mut self, place: Place, direction: Direction, at: Number) -> Window900 {
        self.numbers.push(NumberEntry {
            place,
            direction,
            at,
            last: 0,
        });
        self
    }

    /// An M function of a channel, from 1 on, is shown there.
    pub fn function(mut self, channel: u8, m: u16, at: Bit) -> Window900 {
        self.functions.push(FunctionEntry {
            channel,
            m,
            at,
            shown: Shown::No,
        });
        self
    }

    /// Before a scan: what has changed in the parameters goes to the memory of the PLC.
    pub(crate) fn publish(&mut self, machine: &Machine, exchange: &mut Exchange) {
        for entry in &mut self.bits {
            entry.last = is_so(machine, &entry.marker);
            exchange.nc_put(entry.at, entry.last);
        }
        for entry in &mut self.numbers {
            entry.last = machine.memory.at(entry.place).bits().unwrap_or(0);
            exchange.nc_put_number(entry.at, entry.last);
        }
        for entry in &mut self.functions {
            let channel = usize::from(entry.channel).checked_sub(1);
            let channel = channel.and_then(|k| machine.channels.get(k));
            // Another function may wait since this one was acknowledged.
            let is_open = |entry: &FunctionEntry| machine.transfers.is_open(entry.channel, entry.m);
            let stays = channel.is_some_and(|channel| match entry.shown {
                Shown::No | Shown::Flying => false,
                Shown::Stop => channel.waits_for_m && is_open(entry),
                Shown::Branch => channel.branch.is_some() && is_open(entry),
            });
            if !stays {
                entry.shown = Shown::No;
            }
            for transfer in machine.transfers.since(self.seen) {
                if (transfer.channel, transfer.m) == (entry.channel, entry.m) {
                    entry.shown = match (transfer.branch, transfer.stop) {
                        (true, _) => Shown::Branch,
                        (false, true) => Shown::Stop,
                        (false, false) => Shown::Flying,
                    };
                }
            }
            exchange.nc_put(entry.at, entry.shown != Shown::No);
        }
        self.seen = machine.transfers.count();
    }

    /// After a scan: what the PLC has changed goes to the parameters, and does what it says.
    pub(crate) fn take(&mut self, machine: &mut Machine, exchange: &Exchange) {
        for entry in self
            .bits
            .iter_mut()
            .filter(|entry| entry.marker.direction != Direction::ToPlc)
        {
            let is_on = exchange.nc().bit(entry.at);
            if is_on != std::mem::replace(&mut entry.last, is_on) {
                write_marker(machine, &entry.marker, is_on);
            }
        }
        for entry in self
            .numbers
            .iter_mut()
            .filter(|entry| entry.direction != Direction::ToPlc)
        {
            let number = exchange.nc().number(entry.at);
            if number != std::mem::replace(&mut entry.last, number) {
                machine.memory.store_mantissa(entry.place, number);
                command::notice(machine, entry.place);
            }
        }
    }
}

/// What a marker is now.
fn is_so(machine: &Machine, marker: &Marker) -> bool {
    let cell = machine.memory.at(marker.place);
    match marker.part {
        MarkerPart::Value(values) => has_one_of(cell, values),
        MarkerPart::Request(values) => was_asked(machine, marker.place) && has_one_of(cell, values),
        MarkerPart::Byte(byte) => byte_of(cell, byte) == 1,
        MarkerPart::Word => false,
    }
}

fn has_one_of(cell: Cell, values: &[i32]) -> bool {
    cell.whole()
        .is_some_and(|whole| values.iter().any(|value| i64::from(*value) == whole))
}

fn byte_of(cell: Cell, byte: u8) -> u8 {
    let bytes = cell.bits().unwrap_or(0).to_le_bytes();
    bytes.get(usize::from(byte)).copied().unwrap_or(0)
}

/// P8683 or P8684 was written since the last cycle of the PLC.
fn was_asked(machine: &Machine, place: Place) -> bool {
    let answers = &machine.answers;
    match machine.memory.meaning(place) {
        Meaning::OfChannel(number, ChannelParameter::ModeRequest) => answers.modes & bit(number) != 0,
        Meaning::OfChannel(number, ChannelParameter::StartRequest) => answers.starts & bit(number) != 0,
        _ => false,
    }
}

/// The PLC has set a marker, or reset it.
fn write_marker(machine: &mut Machine, marker: &Marker, is_on: bool) {
    let place = marker.place;
    let cell = machine.memory.at(place);
    match marker.part {
        MarkerPart::Value(values) | MarkerPart::Request(values) => {
            let number = match (is_on, values.first()) {
                (true, Some(value)) => f64::from(*value),
                // Another marker of it has become 1 meanwhile.
                (false, _) if !has_one_of(cell, values) => return,
                _ => 0.0,
            };
            machine.memory.store(place, Some(number), 0);
        }
        MarkerPart::Byte(byte) => {
            let mut bytes = cell.bits().unwrap_or(0).to_le_bytes();
            if let Some(own) = bytes.get_mut(usize::from(byte)) {
                *own = u8::from(is_on);
            }
            machine.memory.store_bits(place, i32::from_le_bytes(bytes));
        }
        MarkerPart::Word => return,
    }
    command::notice(machine, place);
}
