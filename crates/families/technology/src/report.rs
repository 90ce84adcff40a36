//! What a run has come to: events, waits and the end of the path, in the form in which they are written as JSON.

use std::fmt;

use bahn_path::Position;
use serde::ser::SerializeMap;
use serde::{Serialize, Serializer};

/// All that is to be said of a run.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Report {
    /// All programs were executed to their ends.
    pub completed: bool,
    /// Why not, where a block is to blame. A reset, and a path that can never move again, are no error.
    pub error: Option<Fault>,
    /// Time of the run, s.
    pub time_s: f64,
    /// A cycle of path and PLC, s.
    pub cycle_s: f64,
    /// What happened, in the order of time.
    pub events: Vec<Event>,
    /// Where the path stood for a function.
    pub waits: Vec<Wait>,
    /// Of a run from a block: the last state of the functions before it, which were not output.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub skipped: Option<Vec<Skipped>>,
    /// Where the path ends.
    pub path_end: Coordinates,
    /// How each program ended that was begun.
    pub programs: Vec<ProgramEnd>,
    /// What was done otherwise than ordered.
    pub warnings: Vec<Warning>,
    /// The velocity over time and distance, for pictures.
    #[serde(skip)]
    pub samples: Vec<Sample>,
}

/// Why a run ended before its end.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Fault {
    /// `P-ERR-20157`, or a name of its own where the manuals have no number.
    pub code: String,
    /// What is wrong, in words.
    pub message: String,
    /// File of the faulty block, a subroutine too.
    pub program: String,
    /// The block: `N40`, without a number its line, `#12`.
    pub block: String,
    /// Its line in the file, from 1; 0 where none is known.
    pub line: u32,
}

impl fmt::Display for Fault {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let Fault {
            code,
            message,
            program,
            block,
            ..
        } = self;
        write!(f, "{program} {block}: {message} ({code})")
    }
}

impl std::error::Error for Fault {}

/// Something that was done otherwise than ordered.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Warning {
    /// What has happened, in words.
    pub message: String,
    /// File of the block.
    pub program: String,
    /// The block, `N40` or the line `#12`.
    pub block: String,
}

/// Whether and when a program came to its end.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct ProgramEnd {
    /// Name of the file.
    pub program: String,
    /// It was executed to its end.
    pub completed: bool,
    /// When it ended, s.
    pub time_s: f64,
}

/// Something that has happened to a function or to the path.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Event {
    /// The cycle in which the PLC sees it, s.
    pub t: f64,
    /// What happened to the function, or to the path.
    pub kind: EventKind,
    /// Letter and number without leading zeros: `M25`, `H5`, `S`; of `active` the letter alone.
    pub function: Option<String>,
    /// Additive value, speed of `S`, numbers of `active`.
    pub value: Value,
    /// Only of MOS_TS in the range of the channel: `t` less the instant at which the path passed the place, µs.
    pub offset_us: Option<f64>,
    /// Velocity along the path at that time, mm/min.
    pub v: f64,
    /// Range: `channel`, `X`, name of the spindle.
    pub target: Option<String>,
    /// The block of the function, of `stop` and `go` the one whose motion ends or begins.
    pub block: Option<String>,
    /// The place on the path it belongs to; where it belongs to a time, that of the path then.
    pub position: Coordinates,
    /// Of MEP_SVS and MET_SVS with P-CHAN-00212.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub to_go: Option<ToGo>,
    /// Number of the function among all of the run: what becomes of one that is output has the same.
    #[serde(skip)]
    pub order: Option<u64>,
}

/// What reports tell of functions and of the path.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize)]
#[serde(rename_all = "lowercase")]
pub enum EventKind {
    /// A function is placed in a range.
    Output,
    /// The PLC has taken it over.
    Fetch,
    /// The PLC says it is done.
    Acknowledge,
    /// The path comes to a standstill.
    Stop,
    /// The path begins to move.
    Go,
    /// The functions of a letter that are waited for in a range are others.
    Active,
}

/// A value of an event.
#[derive(Clone, Debug, Default, PartialEq, Serialize)]
#[serde(untagged)]
pub enum Value {
    /// The function has no value.
    #[default]
    None,
    /// The additive value of a function.
    Integer(i64),
    /// The speed of an S word, rpm.
    Number(f64),
    /// The numbers of functions that wait.
    Numbers(Vec<u16>),
}

impl Value {
    /// As the doubleword of the window has it: a speed counts 0.001 rpm.
    pub(crate) fn in_window(&self) -> Option<i32> {
        match self {
            Value::Integer(value) => Some((*value).clamp(i32::MIN.into(), i32::MAX.into()) as i32),
            Value::Number(speed) => Some((speed * 1e3).round() as i32),
            Value::None | Value::Numbers(_) => None,
        }
    }
}

/// What is left to the point where a function is waited for that was output ahead [004:81].
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct ToGo {
    /// Distance along the path, 0.1 µm.
    pub path: i64,
    /// Time as planned, µs.
    pub time: i64,
}

/// A function for which the path stood.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Wait {
    /// Whose fetch, acknowledgement or confirmation was missing.
    pub function: String,
    /// The block of the function, `N40` or the line `#12`.
    pub block: String,
    /// Since when the path stood for it, s.
    pub from_s: f64,
    /// The cycle in which it no longer held the path, s; `None` when that never came.
    pub to_s: Option<f64>,
    /// Where the path stood.
    pub position: Coordinates,
    /// Number of the function among all of the run.
    #[serde(skip)]
    pub order: u64,
}

/// A function before the block with which a run began: it was not output.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Skipped {
    /// Letter and number, `S`.
    pub function: String,
    /// Additive value, speed of `S`.
    pub value: Value,
    /// The range or spindle it would have gone to.
    pub target: String,
    /// File of its block.
    pub program: String,
    /// The block of the function, `N40` or the line `#12`.
    pub block: String,
}

/// The path at a moment.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Sample {
    /// Time since the start of the run, s.
    pub t: f64,
    /// Distance along the path, mm.
    pub distance_mm: f64,
    /// Velocity along the path at that time, mm/min.
    pub v: f64,
}

/// A position as reports show it: the axes that have one, by their letters.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Coordinates(pub Position);

impl Serialize for Coordinates {
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        let known = self.0.known();
        let mut map = serializer.serialize_map(Some(known.len()))?;
        for axis in known.iter() {
            map.serialize_entry(&axis.letter(), &rounded(self.0[axis], 1e6))?;
        }
        map.end()
    }
}

/// A number without what binary fractions add to it: to so many parts of one.
pub(crate) fn rounded(value: f64, parts: f64) -> f64 {
    // Adding 0 makes -0 a 0.
    (value * parts).round() / parts + 0.0
}
