//! Parameters that a block writes: now, or when the path comes to them.

use bahn_din::system900::{Block, Value};
use bahn_path::{At, Function, Synchronisation, TechnologyFunction};
use bahn_system900::{Cell, Memory, Name, Place, Value as Written};

use crate::refusal::Refusal;

/// What a block orders beside its motion.
#[derive(Clone, Debug, Default)]
pub(crate) struct Ordered {
    /// In the order of output.
    pub functions: Vec<TechnologyFunction>,
    /// The look-ahead stops at the end of the block until it is executed.
    pub waits: bool,
}

impl Ordered {
    /// Puts a function at the start of the block.
    pub fn at_start(&mut self, function: Function, synchronisation: Synchronisation) {
        self.functions
            .push(TechnologyFunction::new(function, At::Start, synchronisation));
    }

    /// A parameter that is written when the block is executed.
    pub fn write_later(&mut self, memory: &Memory, name: Name, value: Option<f64>) -> Result<(), Refusal> {
        let q = memory.q(name)?;
        self.at_start(Function::Write { q, value }, Synchronisation::Mos);
        Ok(())
    }
}

/// Cells as they were, so that a run that goes back finds them again.
pub(crate) type Journal = Vec<(Place, Cell)>;

/// Writes a parameter of the look-ahead.
pub(crate) fn write(
    memory: &mut Memory,
    journal: Option<&mut Journal>,
    name: Name,
    value: Written,
) -> Result<(), Refusal> {
    let mut journal = journal;
    let mut keep = |memory: &Memory, place: Place| {
        if let Some(journal) = &mut journal {
            journal.push((place, memory.at(place)));
        }
    };
    keep(memory, memory.place(name)?);
    memory.write(name, value)?;
    // A shift of a zero point counts in the sum of its axis.
    if let Some((place, sum, decimals)) = memory.sum_of_shifts(name) {
        keep(memory, place);
        memory.store(place, Some(sum), decimals);
    }
    Ok(())
}

/// What a cell gives to another parameter.
fn content(cell: Cell) -> Written {
    match cell.bits() {
        None => Written::Cleared,
        Some(bits) => Written::Decimal {
            digits: bits.into(),
            decimals: cell.status().decimals(),
        },
    }
}

/// Takes the writes of a block; whether there were any.
pub(crate) fn take(
    block: &Block,
    memory: &mut Memory,
    channel: u8,
    mut journal: Option<&mut Journal>,
    ordered: &mut Ordered,
) -> Result<bool, Refusal> {
    let mut any = false;
    for (parameter, value) in block.writes() {
        let name = Name::P(channel, parameter.number().into());
        let (place, status) = (memory.place(name)?, memory.cell(name)?.status());
        let written = match value {
            None => Written::Cleared,
            Some(Value::Number(number)) => Written::Decimal {
                digits: number.mantissa.into(),
                decimals: number.decimals,
            },
            Some(Value::Content(from)) => content(memory.cell(Name::P(channel, from.number().into()))?),
        };
        ordered.waits |= status.synchronises();
        // A command of the control is given where the path is, as a real-time parameter is written.
        let is_later = status.is_real_time() || memory.runs_routine(place);
        match place.q().filter(|_| is_later) {
            Some(q) => {
                let value = match written {
                    Written::Decimal { digits, decimals } => {
                        Some(digits as f64 / 10f64.powi(decimals.into()))
                    }
                    Written::Bits(bits) => Some(bits.into()),
                    Written::Cleared => None,
                };
                ordered.at_start(Function::Write { q, value }, Synchronisation::Mos);
            }
            None => {
                write(memory, journal.as_deref_mut(), name, written)?;
                any = true;
            }
        }
    }
    Ok(any)
}
