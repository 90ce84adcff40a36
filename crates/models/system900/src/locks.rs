//! Locks: switches choose definitions, definitions make locks active, active locks hold writers back [002:5235-5417].
//!
//! Decision: P8510 counts its bytes as P11010 does, 1 and 3, where the manual prints 0 and 2. Active locks are those of the
//! system: P8510 of every channel in AUTO counts
//!
//! Decision: A program is held back by parameter locks as the operator is, the PLC and the control are not. Editing locks
//! hold back who edits at the panel: its parameter editor by the lock of values and that of the data which a parameter
//! belongs to, a page for such data by the latter alone. A status is held back by its editing lock and by no other

use crate::channels::Channels;
use crate::lock::Lock;
use crate::memory::{Memory, SpaceError};
use crate::name::Name;
use crate::numbers::{
    ACTIVE_LOCKS, AUTO_LOCKS, AXES, AXIS, AXIS_BLOCK, COUPLING_BLOCK, COUPLINGS, COUPLINGS_MAX,
    LOCK_DEFINITIONS, SPINDLES, SWITCHES,
};
use crate::programs::ProgramName;
use crate::status::{LOCKS, Receivers, Status};
use crate::value::Value;
use crate::{tools, zero};

/// What of the definitions P8510 has: parameters, programs, cycles.
const OF_AUTO: u32 = 0x0003_000F;

/// The places of key switches 1 to 4 and software switch 1 in their block, and of their definitions.
const SWITCH_PLACES: [u32; 5] = [0, 1, 2, 3, 8];

/// Some of the locks.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Locks(u32);

impl Locks {
    /// Whether a lock is one of them.
    pub fn has(self, lock: Lock) -> bool {
        self.0 & 1 << lock.bit() != 0
    }

    /// What the switches choose, and P8510 of the channels in AUTO beside them.
    pub fn chosen(memory: &Memory, auto: Channels) -> Locks {
        let of_switch = |place: u32| {
            let is_closed = memory.shared(SWITCHES + place).whole() == Some(1);
            let bits = memory.shared(LOCK_DEFINITIONS + place).bits().unwrap_or(0);
            if is_closed { bits.cast_unsigned() } else { 0 }
        };
        let of_auto = |channel: u8| {
            let bits = memory.cell(Name::P(channel, AUTO_LOCKS)).ok();
            bits.and_then(|cell| cell.bits()).unwrap_or(0).cast_unsigned() & OF_AUTO
        };
        let switches = SWITCH_PLACES.iter().map(|place| of_switch(*place));
        Locks(
            switches
                .chain(auto.iter().map(of_auto))
                .fold(0, |all, some| all | some),
        )
    }

    /// Those that are active, P11020 to P11049.
    pub fn active(memory: &Memory) -> Locks {
        let active = Lock::ALL.iter().filter(|lock| memory.is_locked(**lock));
        Locks(active.fold(0, |all, lock| all | 1 << lock.bit()))
    }
}

/// Who writes a parameter.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Writer {
    /// The operator in the parameter editor.
    Editor,
    /// The operator at a page for axes, zero points or tools.
    Page,
    /// A part program.
    Program,
    /// The PLC.
    Plc,
    /// The control itself.
    Control,
}

/// What of a parameter is written.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Part {
    /// Its value.
    Value,
    /// Its status.
    Status,
}

/// The lock that holds a write back; `None` when nothing does. The one rule for all who write [002:340-362]
/// [002:5312-5365].
///
/// # Errors
/// When the name leads nowhere.
pub fn refusing(memory: &Memory, writer: Writer, part: Part, name: Name) -> Result<Option<Lock>, SpaceError> {
    let status = memory.cell(name)?.status();
    let is_active = |lock: &Lock| memory.is_locked(*lock);
    if matches!(writer, Writer::Plc | Writer::Control) {
        return Ok(None);
    }
    let at_panel = matches!(writer, Writer::Editor | Writer::Page);
    if part == Part::Status {
        return Ok(Some(Lock::Statuses).filter(|lock| at_panel && is_active(lock)));
    }
    let of_status = status.locks().map(Lock::Parameters).find(is_active);
    if of_status.is_some() || !at_panel {
        return Ok(of_status);
    }
    let of_editor = (writer == Writer::Editor).then_some(Lock::Values);
    let editing = of_editor.into_iter().chain(of_data(memory, name)).find(is_active);
    Ok(editing)
}

/// The editing lock of the data that a parameter belongs to.
fn of_data(memory: &Memory, name: Name) -> Option<Lock> {
    let name = match name {
        Name::Q(_) => memory.name_of(memory.place(name).ok()?),
        named => named,
    };
    let (channel, number) = match name {
        Name::P(channel, number) => (channel, number),
        Name::Q(number) => return is_of_axes(number + AXIS.0 - AXIS.1).then_some(Lock::Axes),
    };
    let blocks = [COUPLINGS, SPINDLES].map(|first| first..first + COUPLING_BLOCK * COUPLINGS_MAX);
    if is_of_axes(number) || blocks.iter().any(|block| block.contains(&number)) {
        return Some(Lock::Axes);
    }
    let is_within = |(first, count): (u32, u64)| {
        let offset = number.checked_sub(first);
        offset.is_some_and(|offset| u64::from(offset) < count)
    };
    let zero = zero::Layout::of(memory, channel).map(|layout| (layout.first, layout.count()));
    let tools = tools::Layout::of(memory, channel).map(|layout| (layout.first, layout.count()));
    if zero.is_some_and(is_within) {
        return Some(Lock::ZeroPoints);
    }
    tools.is_some_and(is_within).then_some(Lock::Tools)
}

fn is_of_axes(number: u32) -> bool {
    (AXIS.0..AXIS.0 + AXIS_BLOCK * u32::from(AXES)).contains(&number)
}

impl Memory {
    /// Enters a value as an operator does in the parameter editor; who takes notice of it.
    ///
    /// # Errors
    /// When the name leads nowhere, the value does not go in, or an active lock holds the entry back.
    pub fn enter(&mut self, name: Name, value: Value) -> Result<Receivers, SpaceError> {
        self.enter_as(Writer::Editor, name, value)
    }

    /// Writes a value as somebody; who takes notice of it.
    ///
    /// # Errors
    /// When the name leads nowhere, the value does not go in, or an active lock holds the write back.
    pub fn enter_as(&mut self, writer: Writer, name: Name, value: Value) -> Result<Receivers, SpaceError> {
        match refusing(self, writer, Part::Value, name)? {
            Some(lock) => Err(SpaceError::of_lock(name, lock)),
            None => self.write(name, value),
        }
    }

    /// Sets a status as somebody.
    ///
    /// # Errors
    /// When the name leads nowhere, or the editing lock of statuses holds it back.
    pub fn enter_status(&mut self, writer: Writer, name: Name, status: Status) -> Result<(), SpaceError> {
        match refusing(self, writer, Part::Status, name)? {
            Some(lock) => Err(SpaceError::of_lock(name, lock)),
            None => self.set_status(name, status),
        }
    }

    /// Sets or resets a parameter lock, 1 to 4; others are none. The next change of a switch or mode chooses anew.
    pub fn set_lock(&mut self, lock: u8, set: bool) {
        if (1..=LOCKS).contains(&lock) {
            self.set_shared(ACTIVE_LOCKS + Lock::Parameters(lock).bit(), i32::from(set));
        }
    }

    /// Whether a lock is active.
    pub fn is_locked(&self, lock: Lock) -> bool {
        self.shared(ACTIVE_LOCKS + lock.bit()).whole() == Some(1)
    }

    /// Makes active what switches and P8510 choose: at each change of a switch or its definition, and of the mode of a
    /// channel [002:5370-5376].
    pub fn update_locks(&mut self, auto: Channels) {
        let chosen = Locks::chosen(self, auto);
        for lock in Lock::ALL {
            self.set_shared(ACTIVE_LOCKS + lock.bit(), i32::from(chosen.has(lock)));
        }
    }

    /// Whether an active lock keeps a program or cycle as it is.
    pub fn is_program_locked(&self, name: ProgramName) -> bool {
        self.is_locked(match name {
            ProgramName::Program(_) => Lock::Programs,
            ProgramName::Cycle(_) => Lock::Cycles,
        })
    }
}
