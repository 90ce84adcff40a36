//! The event buffer: keys, messages, transfers, blocks and M functions with their times, as the control prints them
//! [002:6064-6198].
//!
//! Decision: Events are numbered from power-on; of those that no longer go in the oldest is lost, and the numbers show the
//! gap. Times are hours, minutes, seconds, milliseconds since power-on, or of the clock that the caller has
//!
//! Decision: A change of the picture is always recorded, as keys are. A parameter below q10000 belongs to no channel: K0,
//! as the example has it, and is recorded when channel 1 asks for it
//!
//! Decision: A key has its number, a function key F and its number; the manual has their names in a drawing alone

use std::collections::VecDeque;
use std::fmt;

use crate::array::Cell;
use crate::memory::Memory;
use crate::name::Name;
use crate::numbers::{SAMPLING, SAMPLING_OF_CHANNELS};
use crate::programs::ProgramName;

/// How many events a buffer keeps [002:6086-6087].
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Depth {
    /// 100 of them.
    Short,
    /// 2000 of them.
    Long,
}

impl Depth {
    /// How many these are.
    pub fn records(self) -> usize {
        match self {
            Depth::Short => 100,
            Depth::Long => 2000,
        }
    }
}

/// With whom a parameter is exchanged.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Partner {
    /// The PLC.
    Plc,
    /// The operating panel.
    Panel,
}

/// The word of a key, P11260 [002:6040-6056].
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Key(pub i32);

/// What happened.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Event {
    /// Power came.
    Boot,
    /// Another picture is shown: P11261 and P11262.
    Picture([u8; 8]),
    /// A key was pressed or released.
    Key(Key),
    /// A parameter went out.
    Sent(Partner, Name, Cell),
    /// A parameter came in.
    Received(Partner, Name, Cell),
    /// A message came: channel, 0 for none, and number.
    Message(u8, u16),
    /// A block began: channel, program, block.
    Block(u8, ProgramName, u32),
    /// An M function went out to the PLC.
    Function {
        /// The channel.
        channel: u8,
        /// Its number.
        m: u16,
        /// Its place among the M functions of the block, from 0 on.
        place: u8,
        /// The block that it branches to; `None` without branch.
        branch: Option<u32>,
    },
    /// The end of a block was reported to the PLC, and its acknowledgement is waited for: channel.
    EndOfBlock(u8),
    /// The PLC released the next block: channel, P8706.
    Release(u8, Cell),
    /// A parameter that is sampled was written.
    Written(Name, Cell),
    /// An entry over P11279.
    Entry(Cell),
}

/// An event with number and time.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Record {
    /// Its number, from 1 on.
    pub number: u64,
    /// When, in ms.
    pub time_ms: u64,
    /// What.
    pub event: Event,
}

/// The last events. Nothing is allocated after it has been made.
///
/// ```
/// use bahn_system900::{Depth, Event, EventBuffer, ProgramName};
/// let mut events = EventBuffer::new(Depth::Short);
/// events.push(0, Event::Boot);
/// events.push(8445, Event::Block(1, ProgramName::Program(1000), 10));
/// assert_eq!(
///     events.to_string(),
///     "1 00:00:00,000 ======== system boot =============\n2 00:00:08,445 PROG: K1 P1000 N10\n"
/// );
/// ```
#[derive(Debug, PartialEq)]
pub struct EventBuffer {
    records: VecDeque<Record>,
    depth: usize,
    pushed: u64,
}

/// A clone has room for as many events.
impl Clone for EventBuffer {
    fn clone(&self) -> EventBuffer {
        let mut records = VecDeque::with_capacity(self.depth);
        records.extend(self.records.iter().copied());
        EventBuffer {
            records,
            depth: self.depth,
            pushed: self.pushed,
        }
    }
}

impl EventBuffer {
    /// An empty one.
    pub fn new(depth: Depth) -> EventBuffer {
        let depth = depth.records();
        EventBuffer {
            records: VecDeque::with_capacity(depth),
            depth,
            pushed: 0,
        }
    }

    /// Records an event.
    pub fn push(&mut self, time_ms: u64, event: Event) {
        if self.records.len() == self.depth {
            self.records.pop_front();
        }
        self.pushed += 1;
        self.records.push_back(Record {
            number: self.pushed,
            time_ms,
            event,
        });
    }

    /// Records an event that the parameters ask for.
    pub fn record(&mut self, memory: &Memory, time_ms: u64, event: Event) {
        if event.is_wanted(memory) {
            self.push(time_ms, event);
        }
    }

    /// What it keeps, the oldest first.
    pub fn records(&self) -> impl Iterator<Item = &Record> {
        self.records.iter()
    }

    /// How many events it keeps.
    pub fn count(&self) -> usize {
        self.records.len()
    }

    /// As the control puts it out at a date and time, with head and end [002:6106-6144].
    pub fn output(&self, date: &str, time_ms: u64) -> String {
        let time = Time(time_ms / 1000 * 1000).to_string();
        let time = time.split(',').next().unwrap_or_default();
        let head = format!("SAMPLE DATA\n\nOutput:\nDATE: {date}\nTime: {time}\n\n#    hh:mm:ss,ms  cmd\n\n");
        format!("{head}{self}\nSAMPLE END\n")
    }
}

/// A line for each event.
impl fmt::Display for EventBuffer {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        self.records.iter().try_for_each(|record| writeln!(f, "{record}"))
    }
}

impl fmt::Display for Record {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{} {} {}", self.number, Time(self.time_ms), self.event)
    }
}

/// A time in ms.
struct Time(u64);

impl fmt::Display for Time {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let Time(ms) = *self;
        let (seconds, minutes, hours) = (ms / 1000, ms / 60_000, ms / 3_600_000);
        write!(
            f,
            "{hours:02}:{:02}:{:02},{:03}",
            minutes % 60,
            seconds % 60,
            ms % 1000
        )
    }
}

impl Event {
    /// Whether the parameters ask for it: P11270 stops all, P11271 and so on ask for more than keys, messages and entries
    /// [002:6074-6084] [002:6169-6195].
    pub fn is_wanted(&self, memory: &Memory) -> bool {
        if memory.shared(SAMPLING).whole() == Some(1) {
            return false;
        }
        let (channel, bit) = match *self {
            Event::Boot | Event::Picture(_) | Event::Key(_) | Event::Message(..) | Event::Entry(_) => {
                return true;
            }
            Event::Sent(Partner::Plc, name, _) | Event::Received(Partner::Plc, name, _) => (owner(name), 0),
            Event::Sent(Partner::Panel, name, _) | Event::Received(Partner::Panel, name, _) => {
                (owner(name), 1)
            }
            Event::Written(name, _) => (owner(name), 2),
            Event::Function { channel, .. } | Event::EndOfBlock(channel) | Event::Release(channel, _) => {
                (channel, 4)
            }
            Event::Block(channel, ..) => (channel, 8),
        };
        let asked = memory.shared(SAMPLING_OF_CHANNELS + u32::from(channel.max(1)) - 1);
        (1..=8).contains(&channel.max(1)) && asked.bits().unwrap_or(0) >> bit & 1 != 0
    }
}

/// The channel of a parameter; 0 for one of the system.
fn owner(name: Name) -> u8 {
    name.of_channel().map_or(0, |(channel, _)| channel)
}

/// A parameter as records name it.
struct Named(Name);

impl fmt::Display for Named {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self.0 {
            Name::Q(number) => write!(f, "K0 q{number}"),
            Name::P(channel, number) => write!(f, "K{channel} P{number}"),
        }
    }
}

impl fmt::Display for Key {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let [key, pressed, _, kind] = self.0.to_le_bytes();
        match kind {
            0 if key.is_ascii_graphic() => write!(f, "KEY \"{}\"", char::from(key))?,
            0 => write!(f, "KEY {key}")?,
            1 => write!(f, "F-KEY F{key}")?,
            2 => write!(f, "C-KEY {key}")?,
            _ => write!(f, "T-KEY {key}")?,
        }
        // Keys of the control alone are recorded when they are let go, too.
        f.write_str(if kind == 2 && pressed == 0 {
            " released"
        } else {
            ""
        })
    }
}

impl fmt::Display for Event {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let partner = |partner: &Partner| match partner {
            Partner::Plc => "PLC",
            Partner::Panel => "OP",
        };
        match self {
            Event::Boot => f.write_str("======== system boot ============="),
            Event::Picture(letters) => {
                f.write_str("PICTURE: ")?;
                let mut letters = letters.iter().filter(|letter| letter.is_ascii_graphic());
                letters.try_for_each(|letter| write!(f, "{}", char::from(*letter)))
            }
            Event::Key(key) => write!(f, "{key}"),
            Event::Sent(to, name, cell) => {
                write!(
                    f,
                    "PARA CNC --> {} {}: {}",
                    partner(to),
                    Named(*name),
                    cell.written()
                )
            }
            Event::Received(from, name, cell) => {
                write!(
                    f,
                    "PARA CNC <-- {} {}: {}",
                    partner(from),
                    Named(*name),
                    cell.written()
                )
            }
            Event::Message(channel, number) => write!(f, "K{channel} message: M{number}"),
            Event::Block(channel, program, block) => write!(f, "PROG: K{channel} {program} N{block}"),
            Event::Function {
                channel,
                m,
                place,
                branch,
            } => {
                write!(f, "K{channel} M{m} --> PLC, NR in the block:{place}, ")?;
                match branch {
                    Some(block) => write!(f, "branch to N{block}"),
                    None => f.write_str("without branch"),
                }
            }
            Event::EndOfBlock(channel) => {
                write!(
                    f,
                    "K{channel} END OF BLOCK CNC --> PLC, CNC WAITS for acknowledgement"
                )
            }
            Event::Release(channel, cell) => write!(f, "K{channel} CNC <-- PLC SAFRE: {}", cell.written()),
            Event::Written(name, cell) => write!(f, "{}: {}", Named(*name), cell.written()),
            Event::Entry(cell) => write!(f, "P11279: {}", cell.written()),
        }
    }
}
