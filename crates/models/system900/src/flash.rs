//! The FLASH: what of parameters and programs is kept without battery, and the functions of q10 [002:403-534].
//!
//! Decision: A parameter is stored with value and status, a cleared one as cleared. Storing replaces what was stored; of
//! programs q10 = 175 replaces all, 176 the cycles. q10 and q11 are commands and are not stored
//!
//! Decision: 262 kBytes are 262144 bytes of programs, without their names. All programs of the NC memory are visible ones
//!
//! Decision: Restoring leaves as it is what is not stored. Nobody is sent each restored parameter: whoever is connected
//! takes all anew
//!
//! Decision: A confirmation in q11 counts once. DLL, NO_DMA and PLC_BIG are kept as switches and do nothing else here
//!
//! Decision: A function that is refused changes nothing, one that is not in the list is refused

mod form;

pub use form::NoFlash;

use std::collections::BTreeMap;

use crate::array::Cell;
use crate::memory::{Memory, Place};
use crate::name::Name;
use crate::numbers::{ACTIVATE, CONFIRMATION, FIRST_RESTORED, FUNCTION};
use crate::programs::Programs;

/// The most parameters that are stored [002:446-447].
pub const STORED_MAX: usize = 14_000;
/// The most bytes of programs that are stored [002:469-470].
pub const STORED_BYTES_MAX: usize = 262_144;

/// A function of q10.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum FlashFunction {
    /// 99: the channel descriptors become active while a file is read.
    Activate,
    /// 120.
    EraseParameters,
    /// 125.
    ErasePrograms,
    /// 170: all that have the bit.
    StoreParameters,
    /// 175: programs and cycles.
    StorePrograms,
    /// 176.
    StoreCycles,
    /// 190: q0 to q999.
    RestoreFirst,
    /// 200: all others.
    RestoreOthers,
    /// 205.
    RestorePrograms,
    /// 500: the directory shows the NC memory.
    ListMemory,
    /// 501: the directory shows the FLASH.
    ListFlash,
    /// 510.
    RemoveDll,
    /// 520.
    RemoveNoDma,
    /// 521.
    SetNoDma,
    /// 530.
    RemovePlcBig,
    /// 531.
    SetPlcBig,
}

impl FlashFunction {
    /// Of a number in q10; `None` for one that is no function.
    pub fn from_number(number: i64) -> Option<FlashFunction> {
        Some(match number {
            ACTIVATE => FlashFunction::Activate,
            120 => FlashFunction::EraseParameters,
            125 => FlashFunction::ErasePrograms,
            170 => FlashFunction::StoreParameters,
            175 => FlashFunction::StorePrograms,
            176 => FlashFunction::StoreCycles,
            190 => FlashFunction::RestoreFirst,
            200 => FlashFunction::RestoreOthers,
            205 => FlashFunction::RestorePrograms,
            500 => FlashFunction::ListMemory,
            501 => FlashFunction::ListFlash,
            510 => FlashFunction::RemoveDll,
            520 => FlashFunction::RemoveNoDma,
            521 => FlashFunction::SetNoDma,
            530 => FlashFunction::RemovePlcBig,
            531 => FlashFunction::SetPlcBig,
            _ => return None,
        })
    }

    /// Whether q11 has to hold its number first [002:503-521].
    fn is_confirmed(self) -> bool {
        use FlashFunction::{RemoveDll, RemoveNoDma, RemovePlcBig, SetNoDma, SetPlcBig};
        matches!(
            self,
            RemoveDll | RemoveNoDma | SetNoDma | RemovePlcBig | SetPlcBig
        )
    }
}

/// Why a function of q10 is refused.
#[derive(Clone, Copy, Debug, PartialEq, Eq, thiserror::Error)]
pub enum FlashError {
    /// It is none.
    #[error("q10: {0} is no function")]
    NoFunction(i64),
    /// A channel is not in HAND.
    #[error("q10: the machine is not in HAND")]
    NotInHand,
    /// It is one for files.
    #[error("q10: 99 acts only while a data file is read")]
    NotReading,
    /// q11 does not hold its number.
    #[error("q10: {0} is executed only if q11 holds {0}")]
    NotConfirmed(i64),
    /// So many parameters are marked.
    #[error("q10: {0} parameters are marked to be stored, and {STORED_MAX} go in")]
    TooManyParameters(usize),
    /// The programs have so many bytes.
    #[error("q10: the programs have {0} bytes, and {STORED_BYTES_MAX} go in")]
    TooManyBytes(usize),
}

/// What the directory of the NC memory shows.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Listing {
    /// The NC memory.
    #[default]
    Memory,
    /// The FLASH.
    Flash,
}

/// Switches of the system that are kept.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Switches {
    /// The CNC DLL was removed, and is not there from the next start on.
    pub no_dll: bool,
    /// NO_DMA.
    pub no_dma: bool,
    /// PLC_BIG.
    pub plc_big: bool,
}

/// What a function works on.
#[derive(Debug)]
pub struct FlashScene<'a> {
    /// The parameters.
    pub memory: &'a mut Memory,
    /// The NC memory.
    pub programs: &'a mut Programs,
    /// All channels are in HAND.
    pub is_in_hand: bool,
    /// A data file is being read.
    pub is_reading: bool,
}

/// The memory that needs no battery. Its functions allocate: none of them runs in a control cycle.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Flash {
    parameters: BTreeMap<Place, Cell>,
    programs: Programs,
    switches: Switches,
    listing: Listing,
}

impl Flash {
    /// Executes the function of a number in q10; how many parameters or programs it was about.
    ///
    /// # Errors
    /// Why it is refused; then nothing has changed.
    pub fn run(&mut self, number: i64, scene: FlashScene<'_>) -> Result<usize, FlashError> {
        let function = FlashFunction::from_number(number).ok_or(FlashError::NoFunction(number))?;
        if function == FlashFunction::Activate {
            return if scene.is_reading {
                Ok(0)
            } else {
                Err(FlashError::NotReading)
            };
        }
        if !scene.is_in_hand {
            return Err(FlashError::NotInHand);
        }
        if function.is_confirmed() {
            if scene.memory.system(CONFIRMATION).whole() != Some(number) {
                return Err(FlashError::NotConfirmed(number));
            }
            scene.memory.set_number(Name::Q(CONFIRMATION), None);
        }
        self.execute(function, scene.memory, scene.programs)
    }

    fn execute(
        &mut self,
        function: FlashFunction,
        memory: &mut Memory,
        programs: &mut Programs,
    ) -> Result<usize, FlashError> {
        match function {
            FlashFunction::Activate => {}
            FlashFunction::EraseParameters => {
                let count = self.parameters.len();
                self.parameters.clear();
                return Ok(count);
            }
            FlashFunction::ErasePrograms => {
                let count = self.programs.count();
                self.programs.clear();
                return Ok(count);
            }
            FlashFunction::StoreParameters => return self.store(memory),
            FlashFunction::StorePrograms => return self.store_programs(programs, false),
            FlashFunction::StoreCycles => return self.store_programs(programs, true),
            FlashFunction::RestoreFirst => return Ok(self.restore(memory, true)),
            FlashFunction::RestoreOthers => return Ok(self.restore(memory, false)),
            FlashFunction::RestorePrograms => return Ok(self.restore_programs(programs)),
            FlashFunction::ListMemory => self.listing = Listing::Memory,
            FlashFunction::ListFlash => self.listing = Listing::Flash,
            FlashFunction::RemoveDll => self.switches.no_dll = true,
            FlashFunction::RemoveNoDma => self.switches.no_dma = false,
            FlashFunction::SetNoDma => self.switches.no_dma = true,
            FlashFunction::RemovePlcBig => self.switches.plc_big = false,
            FlashFunction::SetPlcBig => self.switches.plc_big = true,
        }
        Ok(0)
    }

    /// Stores the parameters of the channels that there are, as far as they are marked [002:443-463].
    fn store(&mut self, memory: &Memory) -> Result<usize, FlashError> {
        let is_there = |place: &Place| match place {
            Place::Q(number) => ![FUNCTION, CONFIRMATION].contains(number),
            Place::OfChannel(channel, ..) => *channel <= memory.channels(),
        };
        let all = memory
            .places()
            .filter(is_there)
            .map(|place| (place, memory.at(place)));
        let marked: BTreeMap<Place, Cell> = all.filter(|(_, cell)| cell.status().is_stored()).collect();
        if marked.len() > STORED_MAX {
            return Err(FlashError::TooManyParameters(marked.len()));
        }
        self.parameters = marked;
        Ok(self.parameters.len())
    }

    fn store_programs(&mut self, programs: &Programs, cycles_alone: bool) -> Result<usize, FlashError> {
        let mut stored = Programs::default();
        let kept = self
            .programs
            .iter()
            .filter(|(name, _)| cycles_alone && !name.is_cycle());
        let new = programs
            .iter()
            .filter(|(name, _)| !cycles_alone || name.is_cycle());
        let mut count = 0;
        for (name, bytes) in kept {
            stored.insert(name, bytes.to_vec());
        }
        for (name, bytes) in new {
            stored.insert(name, bytes.to_vec());
            count += 1;
        }
        if stored.bytes() > STORED_BYTES_MAX {
            return Err(FlashError::TooManyBytes(stored.bytes()));
        }
        self.programs = stored;
        Ok(count)
    }

    /// Writes back q0 to q999, or all others.
    pub(crate) fn restore(&self, memory: &mut Memory, first: bool) -> usize {
        let is_first = |place: Place| place.q().is_some_and(|number| number < FIRST_RESTORED);
        let count = memory.count();
        let is_there = |place: Place| place.q().is_none_or(|number| (number as usize) < count);
        let stored = self.parameters.iter();
        let stored = stored.filter(|(place, _)| is_first(**place) == first && is_there(**place));
        let mut restored = 0;
        for (place, cell) in stored {
            memory.put(*place, *cell);
            restored += 1;
        }
        restored
    }

    /// Writes programs and cycles back.
    pub(crate) fn restore_programs(&self, programs: &mut Programs) -> usize {
        for (name, bytes) in self.programs.iter() {
            programs.insert(name, bytes.to_vec());
        }
        self.programs.count()
    }

    /// How many parameters are stored.
    pub fn parameters(&self) -> usize {
        self.parameters.len()
    }

    /// The programs that are stored.
    pub fn programs(&self) -> &Programs {
        &self.programs
    }

    /// What the directory shows; the NC memory after power-on.
    pub fn listing(&self) -> Listing {
        self.listing
    }

    /// The switches of the system.
    pub fn switches(&self) -> Switches {
        self.switches
    }
}
