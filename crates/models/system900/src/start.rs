//! The starting routine: what it clears, writes back and enters [002:472-478] [002:580-595] [002:954-965] [002:6335-6350].
//!
//! Decision: After `Clear parameter` q0 to q999 come back from the FLASH first, then the others; decimals and
//! inch bits are set where no status was stored. q51 and q53 stay as they were: the user clears them
//!
//! Decision: Feeds of a channel are the parameters from P7000 to P9999 whose unit is mm/min. An axis is a rotary one when its
//! P12001 is loaded and not 0. Tool data have the decimals of q159 from their tenth parameter on, up to the length of a
//! record
//!
//! Decision: q1 counts the physical axes that any channel has, each once

use std::collections::BTreeSet;

use crate::flash::Flash;
use crate::memory::{Memory, Place};
use crate::name::Name;
use crate::numbers::{
    AXES_OF_SYSTEM, AXIS, AXIS_BLOCK, AXIS_OWN, CHANNEL, DECIMALS, DISPLAYS, FIXED, FIXED_COUNT, KEY_SWITCH,
    KIND_OF_AXIS, PARAMETERS, RESET_AT_START, START_INFO, TOOL_LENGTHS, TOOL_VALUES,
};
use crate::programs::Programs;
use crate::status::Status;
use crate::table::rows;
use crate::{tools, zero};

/// Decimals of positions without an entry in q159.
const USUAL_DECIMALS: u8 = 3;

/// What somebody asks the starting routine to clear.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Reset {
    /// `Clear parameter`.
    pub parameters: bool,
    /// `Reset NC memory`.
    pub programs: bool,
}

impl Reset {
    /// Runs the starting routine. A new number of parameters, q3, acts with [`Reset::parameters`] and clears the NC memory
    /// [002:373-385]. It allocates: it is no control cycle.
    pub fn start(self, memory: &mut Memory, programs: &mut Programs, flash: &Flash) {
        let mut clears_programs = self.programs;
        if self.parameters {
            clears_programs |= clear(memory, flash);
        }
        if clears_programs {
            programs.clear();
            flash.restore_programs(programs);
        }
        for (place, was_cleared) in [(0, self.parameters), (2, clears_programs)] {
            memory.set_number(Name::Q(START_INFO + place), Some(was_cleared.into()));
            if was_cleared {
                memory.set_number(Name::Q(START_INFO + place + 1), Some(1));
            }
        }
        for channel in 1..=memory.channels() {
            for number in RESET_AT_START {
                memory.set_number(Name::P(channel, number), None);
            }
        }
        memory.start();
        count_axes(memory);
    }
}

/// Whether the starting routine waits for a key: key switch 1 is open, or it had to clear something [002:5252-5262].
pub fn waits_for_key(memory: &Memory) -> bool {
    let is_set = |number: u32| memory.system(number).whole() == Some(1);
    memory.shared(KEY_SWITCH).whole() != Some(1) || is_set(START_INFO) || is_set(START_INFO + 2)
}

/// Clears all parameters and writes back what is stored; whether there is another number of them.
fn clear(memory: &mut Memory, flash: &Flash) -> bool {
    let sticky = [START_INFO + 1, START_INFO + 3].map(|number| (Place::Q(number), memory.system(number)));
    let before = memory.count();
    for cell in memory.cells_mut() {
        *cell = crate::array::Cell::default();
    }
    flash.restore(memory, true);
    let count = memory
        .system(PARAMETERS)
        .whole()
        .and_then(|count| usize::try_from(count).ok());
    memory.resize(count.unwrap_or(0));
    // Twice: which axes are rotary ones is stored, and what is stored has its own status.
    flash.restore(memory, false);
    set_statuses(memory);
    flash.restore(memory, false);
    for (place, cell) in sticky {
        memory.put(place, cell);
    }
    memory.count() != before
}

/// What the statuses say after parameters were cleared: decimals of positions, and what follows the unit.
fn set_statuses(memory: &mut Memory) {
    for channel in 1..=memory.channels() {
        let decimals = memory.descriptor(channel).entry(DECIMALS).whole();
        let decimals = decimals.and_then(|decimals| u8::try_from(decimals).ok());
        let decimals = decimals
            .filter(|decimals| *decimals > 0)
            .unwrap_or(USUAL_DECIMALS);
        let is_of = |number: u32| Name::P(channel, number);
        if let Some(layout) = zero::Layout::of(memory, channel) {
            let end = u64::from(layout.first)
                .saturating_add(layout.count())
                .min(zero::NUMBERS_END.into());
            for number in u64::from(layout.first)..end {
                let number = u32::try_from(number).unwrap_or(u32::MAX);
                change(memory, is_of(number), |status| {
                    status.with_decimals(decimals).with_length(true)
                });
            }
        }
        if let Some(layout) = tools::Layout::of(memory, channel) {
            let count = u32::try_from(layout.count())
                .unwrap_or(u32::MAX)
                .min(zero::NUMBERS_END);
            for at in (0..count).filter(|at| at % layout.length >= TOOL_VALUES) {
                change(memory, is_of(layout.first.saturating_add(at)), |status| {
                    status.with_decimals(decimals)
                });
            }
        }
        for number in TOOL_LENGTHS.into_iter().flatten() {
            change(memory, is_of(number), |status| status.with_length(true));
        }
        for number in feeds() {
            change(memory, is_of(number), |status| status.with_length(true));
        }
        let axes: Vec<_> = memory.descriptor(channel).axes().collect();
        for (_, word) in axes.into_iter().filter(|(_, word)| word.is_there()) {
            of_axis(
                memory,
                AXIS.1 + AXIS_BLOCK * (u32::from(word.physical) - 1),
                decimals,
            );
        }
    }
}

/// The statuses of a physical axis, which channels take over for their own parameters.
fn of_axis(memory: &mut Memory, begin: u32, decimals: u8) {
    let kind = memory.system(begin + KIND_OF_AXIS).number();
    let is_linear = kind.is_none_or(|kind| kind == 0.0);
    for offset in DISPLAYS {
        let is_own = AXIS_OWN.contains(&offset);
        change(memory, Name::Q(begin + offset), |status| {
            let status = status.with_decimals(decimals);
            if is_own {
                status.with_length(is_linear)
            } else {
                status
            }
        });
    }
}

/// Changes a status; a parameter that is not there has none.
fn change(memory: &mut Memory, name: Name, of: impl Fn(Status) -> Status) {
    if let Ok(cell) = memory.cell(name) {
        let _ = memory.set_status(name, of(cell.status()));
    }
}

/// The feeds of a channel.
fn feeds() -> impl Iterator<Item = u32> {
    let feeds = rows().iter().filter(|row| row.unit.contains("mm/min"));
    let numbers = feeds.flat_map(|row| row.numbers());
    numbers.filter(|number| (FIXED..FIXED + FIXED_COUNT).contains(number))
}

/// Enters how many axes there are, of the system and of each channel [002:376-379] [002:3447-3451].
fn count_axes(memory: &mut Memory) {
    let mut all = BTreeSet::new();
    for channel in 1..=memory.channels() {
        let axes = memory
            .descriptor(channel)
            .axes()
            .filter(|(_, word)| word.is_there());
        let axes: Vec<(u8, u8)> = axes.map(|(logical, word)| (logical, word.physical)).collect();
        let last = axes.iter().map(|(logical, _)| *logical).max().unwrap_or(0);
        let count = i32::try_from(axes.len()).unwrap_or(0);
        for (place, number) in (0..).zip([i32::from(channel), count, last.into()]) {
            memory.set_number(Name::P(channel, CHANNEL + place), Some(number));
        }
        all.extend(axes.into_iter().map(|(_, physical)| physical));
    }
    memory.set_number(Name::Q(AXES_OF_SYSTEM), i32::try_from(all.len()).ok());
}
