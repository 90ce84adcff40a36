//! What a block orders, as the decoder hands it on.

use std::fmt;
use std::sync::Arc;

use bahn_path::{Axis, Curve, FeedRate, Position, Switch};

/// One executed block. What stands in it happens in this order: commands, functions before the motion, motion,
/// functions after it, the end of the program; which functions come before and which after says their type in the
/// channel, not the language.
#[derive(Clone, Debug, PartialEq)]
pub struct Unit {
    /// Place of its block.
    pub place: Place,
    /// What it moves; `None` of a block without coordinates.
    pub motion: Option<Motion>,
    /// M and H functions and spindle words in the order of the text.
    pub functions: Vec<Function>,
    /// Commands of the channel in the order of the text.
    pub commands: Vec<Command>,
    /// Time the path stands after the motion (G04), s.
    pub dwell_s: f64,
    /// The main program ends after this block (M02, M30, or the end of its text).
    pub ends: bool,
}

/// Where a block stands.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Place {
    /// Name of the file.
    pub program: Arc<str>,
    /// Its programmed number as text, `N40` without leading zeros; without one its line, `#12`.
    pub block: Arc<str>,
    /// Line in the file, from 1.
    pub line: u32,
}

/// A motion of the path.
#[derive(Clone, Debug, PartialEq)]
pub struct Motion {
    /// Shape between begin and end.
    pub curve: Curve,
    /// Where the block before has led the path, mm.
    pub begin: Position,
    /// Start, where the axes stand, mm: `begin` unless they were [moved](crate::Decoder::relocate).
    pub start: Position,
    /// Where its path ends, mm.
    pub end: Position,
    /// G00: as fast as the axes allow.
    pub rapid: bool,
    /// Feed of G01, G02, G03, mm/min.
    pub feed_mm_min: f64,
}

impl Motion {
    /// How fast it is programmed.
    pub fn feed(&self) -> FeedRate {
        match self.rapid {
            true => FeedRate::Rapid,
            false => FeedRate::Programmed(self.feed_mm_min),
        }
    }
}

/// A technology function as it is programmed [004:102-108].
#[derive(Clone, Debug, PartialEq)]
pub struct Function {
    /// M or H function with its number, or spindle word.
    pub kind: Kind,
    /// Its additive value (`M52=-345`).
    pub value: Option<i32>,
    /// The range it is addressed to explicitly (`X[M7]`); without, parameters decide.
    pub target: Option<Target>,
    /// Column of the word in its line, from 1.
    pub column: u32,
}

/// Kind of a function.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Kind {
    /// M function by its number.
    M(u16),
    /// H function by its number.
    H(u16),
    /// Spindle speed, rpm: `S1000`, `S2[REV1000]`.
    S(f64),
}

/// The range a function is addressed to.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum Target {
    /// An axis of the path.
    Axis(Axis),
    /// A spindle by the name it is programmed with: `S`, `S2`.
    Spindle(Arc<str>),
}

/// What a block commands beside motion and functions.
#[derive(Clone, Debug, PartialEq)]
pub enum Command {
    /// `#EXPL SYN`: here MVS_SLP functions are synchronised [004:75].
    ExplicitSynchronisation,
    /// `#FLUSH`, `#FLUSH WAIT` or the reading of a synchronous V.E. variable: nothing is output ahead across it
    /// [004:126].
    Flush {
        /// Decoding goes on when all that is decoded is executed.
        wait: bool,
    },
    /// `#CHANNEL SET [M_PRE_OUTPUT [..]]`: how the next Micro Joint is driven [004:138].
    MicroJoint {
        /// `E=`: path velocity at its start, mm/min.
        entry_mm_min: Option<f64>,
        /// `F=`: feed within it, mm/min.
        feed_mm_min: Option<f64>,
        /// `VECTOR_LIMIT_OFF`: the limits of `#VECTOR LIMIT` do not act within it.
        vector_limit_off: bool,
    },
    /// `#VECTOR LIMIT ON [VEL= ACC= DEC=]`, `OFF` with none of them [004:144].
    VectorLimit {
        /// Greatest path velocity, mm/min.
        velocity_mm_min: Option<f64>,
        /// Greatest acceleration along the path, mm/s².
        acceleration_mm_s2: Option<f64>,
        /// Greatest deceleration along the path, mm/s².
        deceleration_mm_s2: Option<f64>,
    },
    /// G108 begins (on), G107 ends (off) the measurement of edge banding [004:69].
    EdgeBanding(Switch),
    /// Tool radius compensation is on from here on (G41, G42) or off (G40).
    RadiusCompensation(Switch),
    /// An axis moves on its own (`X[INDP ..]`) [004:108].
    Independent(Independent),
    /// A spindle order without M function, e.g. `S2[POS=90]` beside M19.
    Spindle(SpindleOrder),
}

/// Motion of an axis on its own.
#[derive(Clone, Debug, PartialEq)]
pub struct Independent {
    /// Axis that moves on its own.
    pub axis: Axis,
    /// Where it goes, mm.
    pub end: f64,
    /// G00: as fast as the axis allows.
    pub rapid: bool,
    /// Its own feed, mm/min.
    pub feed_mm_min: f64,
}

/// Words of a spindle bracket that order no function.
#[derive(Clone, Debug, PartialEq)]
pub struct SpindleOrder {
    /// Name as programmed: `S2`.
    pub spindle: Arc<str>,
    /// `POS=`: angle at which it stops, degrees.
    pub position_deg: Option<f64>,
}

/// A variable of the channel, as written: `V.G.M_FCT[100].SYNCH`.
#[derive(Clone, Debug, PartialEq, Eq, Hash)]
pub struct Variable {
    /// Name in capitals without index: `V.G.M_FCT[].SYNCH`, `V.G.RW`.
    pub name: Arc<str>,
    /// Index, where there is one.
    pub index: Option<u32>,
}

impl fmt::Display for Variable {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self.index {
            Some(index) => f.write_str(&self.name.replace("[]", &format!("[{index}]"))),
            None => f.write_str(&self.name),
        }
    }
}

/// Whose number a function has.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum FunctionLetter {
    /// An M function, `M80`.
    M,
    /// An H function, `H5`.
    H,
}

impl FunctionLetter {
    /// The letter of a function; `None` for any other one.
    pub(crate) fn of(letter: char) -> Option<FunctionLetter> {
        match letter {
            'M' => Some(FunctionLetter::M),
            'H' => Some(FunctionLetter::H),
            _ => None,
        }
    }
}

/// Who keeps the variables of the channel. It is asked while blocks are decoded, in their order.
pub trait Variables {
    /// Its value. An error is said of the block: why it cannot be read.
    fn read(&mut self, variable: &Variable) -> Result<f64, String>;

    /// Gives it a value. An error is said of the block: why it cannot be written.
    fn write(&mut self, variable: &Variable, value: f64) -> Result<(), String>;

    /// Whether a function has a synchronisation type (`EXIST[M80]`).
    fn exists(&self, letter: FunctionLetter, number: u16) -> bool;
}
