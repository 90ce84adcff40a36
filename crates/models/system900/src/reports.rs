//! What is said of parameters by their names: what they mean, where they lie, what they hold, in which two memories differ.
//!
//! Decision: Two memories are compared by names, not by places: where a block lies elsewhere its parameters are the same
//! ones. Status bytes are not compared

use std::collections::BTreeSet;
use std::fmt;

use serde::Serialize;

use crate::array::{Cell, number_or_none};
use crate::memory::{Memory, SpaceError};
use crate::name::Name;
use crate::status::Status;
use crate::table::{Needs, row};

/// What a parameter means.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Explanation {
    /// Which.
    pub name: Name,
    /// The row that explains it.
    pub base: &'static str,
    /// What it is called.
    pub title: &'static str,
    /// What kind of parameter it is.
    pub kind: &'static str,
    /// The unit of its value.
    pub unit: &'static str,
    /// What its values mean.
    pub values: &'static str,
    /// What it is without an entry.
    pub default: &'static str,
    /// The same as a number.
    pub default_number: Option<f64>,
    /// Where the manual says it.
    pub source: &'static str,
    /// What a change needs.
    pub needs: &'static str,
    /// What it does here.
    pub effect: &'static str,
    /// Why it does less than all.
    pub reason: &'static str,
    /// The markers of the PLC that it is exchanged with.
    pub plc: Vec<&'static str>,
    /// What it is for, as people read it.
    #[serde(skip)]
    pub meaning: &'static str,
    /// What a change needs, in words.
    #[serde(skip)]
    pub needs_words: &'static str,
}

impl Explanation {
    /// Of a parameter; `None` for a number without a row.
    pub fn of(name: Name) -> Option<Explanation> {
        let row = row(name)?;
        Some(Explanation {
            name,
            base: row.number,
            title: row.title,
            kind: row.kind,
            unit: row.unit,
            values: row.values,
            default: row.default,
            default_number: row.default_number,
            source: row.source,
            needs: row.needs.id(),
            effect: row.effect.id(),
            reason: row.reason,
            plc: row.plc().collect(),
            meaning: row.meaning,
            needs_words: row.needs.words(),
        })
    }
}

/// Where a parameter lies: its system parameter, or why it has none.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Mapped {
    /// As it was named.
    pub name: String,
    /// The system parameter.
    pub q: Option<u32>,
    /// Why there is none.
    pub error: Option<String>,
}

impl Mapped {
    /// Of a word that should be a name.
    pub fn of(memory: &Memory, word: &str) -> Mapped {
        let (name, found) = match word.parse::<Name>() {
            Ok(name) => (
                name.to_string(),
                memory.q(name).map_err(|error| error.to_string()),
            ),
            Err(error) => (word.trim().to_owned(), Err(error.to_string())),
        };
        Mapped {
            name,
            q: found.as_ref().ok().copied(),
            error: found.err(),
        }
    }
}

/// What a parameter holds.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Held {
    /// Which.
    pub name: Name,
    /// Its system parameter; `None` for one of the channel alone.
    pub q: Option<u32>,
    /// What it counts; `None` when it is cleared.
    pub value: Option<f64>,
    /// As the control shows it.
    pub written: String,
    /// The status bytes.
    pub status: Status,
    /// What they say.
    pub flags: Flags,
}

/// What the status bytes say.
#[derive(Clone, Debug, PartialEq, Eq, Serialize)]
pub struct Flags {
    loaded: bool,
    real_time: bool,
    sync: bool,
    inch: bool,
    fast: bool,
    interpolator: bool,
    plc: bool,
    panel: bool,
    procedure: bool,
    panel_always: bool,
    sample: bool,
    locks: Vec<u8>,
    decimals: u8,
    hex: bool,
    stored: bool,
}

impl Flags {
    /// Of a status.
    pub fn of(status: Status) -> Flags {
        let receivers = status.receivers();
        Flags {
            loaded: status.is_loaded(),
            real_time: status.is_real_time(),
            sync: status.synchronises(),
            inch: status.is_length(),
            fast: status.is_fast(),
            interpolator: receivers.interpolator,
            plc: receivers.plc,
            panel: receivers.panel,
            procedure: receivers.procedure,
            panel_always: receivers.panel_always,
            sample: receivers.sample,
            locks: status.locks().collect(),
            decimals: status.decimals(),
            hex: status.is_hexadecimal(),
            stored: status.is_stored(),
        }
    }

    /// What is set, in words for people.
    fn words(&self) -> String {
        let set = [
            (self.loaded, "loaded"),
            (self.real_time, "real time"),
            (self.sync, "synchronises"),
            (self.inch, "follows the unit"),
            (self.fast, "fast"),
            (self.interpolator, "to the interpolator"),
            (self.plc, "to the PLC"),
            (self.panel, "to the panel"),
            (self.procedure, "runs a procedure"),
            (self.panel_always, "always to the panel"),
            (self.sample, "sampled"),
            (self.hex, "hexadecimal"),
            (self.stored, "stored"),
        ];
        let set = set.iter().filter(|(is_set, _)| *is_set);
        let mut words: Vec<String> = set.map(|(_, word)| (*word).to_owned()).collect();
        words.extend(self.locks.iter().map(|lock| format!("lock {lock}")));
        match self.decimals {
            0 => {}
            1 => words.push("1 decimal".to_owned()),
            decimals => words.push(format!("{decimals} decimals")),
        }
        words.join(", ")
    }
}

impl Held {
    /// Of a parameter.
    ///
    /// # Errors
    /// When the name leads nowhere.
    pub fn of(memory: &Memory, name: Name) -> Result<Held, SpaceError> {
        let place = memory.place(name)?;
        let cell = memory.at(place);
        Ok(Held {
            name,
            q: place.q(),
            value: cell.number(),
            written: cell.written(),
            status: cell.status(),
            flags: Flags::of(cell.status()),
        })
    }
}

/// In a line.
impl fmt::Display for Held {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let q = self.q.map(|q| format!("  q{q}")).unwrap_or_default();
        let flags = match self.flags.words() {
            words if words.is_empty() => words,
            words => format!("  {words}"),
        };
        write!(f, "{}{q}  {}  {}{flags}", self.name, self.written, self.status)
    }
}

/// A parameter that is not the same in two memories.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Difference {
    /// Which.
    pub name: Name,
    /// Its system parameter in the second memory, or in the first, where the second has none.
    pub q: Option<u32>,
    /// What it is in the first; `None` when it is cleared, or not there.
    pub a: Option<f64>,
    /// What it is in the second, likewise.
    pub b: Option<f64>,
    /// What the change needs.
    pub needs: Needs,
}

/// In a line.
impl fmt::Display for Difference {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let [a, b] = [self.a, self.b].map(number_or_none);
        write!(f, "{}  {a} -> {b}", self.name)?;
        match self.needs {
            Needs::Nothing => Ok(()),
            needs => write!(f, "  needs {}", needs.id()),
        }
    }
}

/// The parameters whose values are not the same in two memories, by their names.
pub fn differences(a: &Memory, b: &Memory) -> Vec<Difference> {
    let names =
        |memory: &Memory| -> Vec<Name> { memory.loaded().map(|place| memory.name_of(place)).collect() };
    let all: BTreeSet<Name> = names(a).into_iter().chain(names(b)).collect();
    let value = |memory: &Memory, name| memory.cell(name).ok().and_then(Cell::number);
    let different = all.into_iter().filter_map(|name| {
        let (in_a, in_b) = (value(a, name), value(b, name));
        (in_a != in_b).then(|| Difference {
            name,
            q: b.q(name).or_else(|_| a.q(name)).ok(),
            a: in_a,
            b: in_b,
            needs: row(name).map_or(Needs::Nothing, |row| row.needs),
        })
    });
    different.collect()
}
