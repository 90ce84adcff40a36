//! The window of the PLC: which markers and double words are which parameters [002:3606-3816] [002:8015-8640].
//!
//! Decision: A parameter that the control, a program or the operator changes shows in the memory of the PLC at its next cycle, also where
//! the PLC gives it: P8706, which the control takes back with each M function with stop, is a 0 that the PLC program sets to 1 again
//!
//! Decision: `M8` is the marker of M function 8, the one that the manual connects with the block release [002:5488-5491]: it is 1 from its
//! transfer to its acknowledgement, of a flying one for one PLC cycle, of a branch until it is taken or its block is over
//!
//! Decision: Of several markers of one value the one that becomes 1 counts; when the one whose value it is becomes 0, it is 0

use bahn_exchange::{Bit, Number};
use bahn_system900::{Direction, Marker, Place};

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
    pub(crate) bits: Vec<BitEntry>,
    pub(crate) numbers: Vec<NumberEntry>,
    pub(crate) functions: Vec<FunctionEntry>,
    /// Transfers that the PLC has seen.
    pub(crate) seen: u64,
}

#[derive(Clone, Copy, Debug)]
pub(crate) struct BitEntry {
    pub marker: Marker,
    pub at: Bit,
    /// What the PLC has.
    pub last: bool,
}

#[derive(Clone, Copy, Debug)]
pub(crate) struct NumberEntry {
    pub place: Place,
    pub direction: Direction,
    pub at: Number,
    pub last: i32,
}

/// The marker of an M function.
#[derive(Clone, Copy, Debug)]
pub(crate) struct FunctionEntry {
    pub channel: u8,
    pub m: u16,
    pub at: Bit,
    pub shown: Shown,
}

/// Why the marker of an M function is 1.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Shown {
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
}
