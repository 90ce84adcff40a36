//! The table of the parameters: what each number means, a row each, or a row for several of a kind.
//!
//! Decision: A number that a row of another place explains has that row: q1300 that of P11300, P12360 and q2360 that of
//! P12160, q202 that of q102, q913 that of q903. Of several rows for a number the one of the fewest counts

use std::collections::HashMap;
use std::sync::LazyLock;

use serde::Serialize;

use crate::name::Name;
use crate::numbers::{AXES, AXIS, AXIS_BLOCK, DESCRIPTOR, SHARED, SHARED_COUNT};

/// The networks 2 to 4, which are laid out as the first one [002:1325-1350].
const NETWORKS: std::ops::Range<u32> = 910..940;
/// Parameters of a network.
const NETWORK: u32 = 10;
/// Descriptors of channels 2 to 8.
const DESCRIPTORS: std::ops::Range<u32> = 2 * DESCRIPTOR..9 * DESCRIPTOR;

/// What a change needs before it acts.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Needs {
    /// It acts at once.
    Nothing,
    /// The change of the operating mode from HAND to AUTO.
    Mode,
    /// A restart of the control.
    Restart,
    /// A reset with `Clear parameter`.
    Reset,
}

impl Needs {
    const ALL: [Needs; 4] = [Needs::Nothing, Needs::Mode, Needs::Restart, Needs::Reset];

    /// As tables and reports write it.
    pub fn id(self) -> &'static str {
        match self {
            Needs::Nothing => "nothing",
            Needs::Mode => "mode",
            Needs::Restart => "restart",
            Needs::Reset => "reset",
        }
    }

    /// In words for people.
    pub fn words(self) -> &'static str {
        match self {
            Needs::Nothing => "nothing, the change acts at once",
            Needs::Mode => "the change of the operating mode from HAND to AUTO",
            Needs::Restart => "a restart of the control",
            Needs::Reset => "a reset of the control with `Clear parameter`",
        }
    }
}

impl Serialize for Needs {
    fn serialize<S: serde::Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        serializer.serialize_str(self.id())
    }
}

/// What a parameter does here.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Effect {
    /// All that the manual says.
    Acts,
    /// Some of it; [`Row::reason`] says what is not done.
    Partly,
    /// It is read and kept, and does nothing here; [`Row::reason`] says why.
    Stored,
    /// Nothing, since the manual gives it no function.
    None,
}

impl Effect {
    /// All effects, most first.
    pub const ALL: [Effect; 4] = [Effect::Acts, Effect::Partly, Effect::Stored, Effect::None];

    /// As tables and reports write it.
    pub fn id(self) -> &'static str {
        match self {
            Effect::Acts => "acts",
            Effect::Partly => "partly",
            Effect::Stored => "stored",
            Effect::None => "none",
        }
    }
}

/// One row of the table.
#[derive(Clone, Copy, Debug)]
#[non_exhaustive]
pub struct Row {
    /// The parameter, or the first and the last of several: `P12160`, `q110-q141`.
    pub number: &'static str,
    first: Name,
    last: u32,
    /// What kind of parameter it is: scalar, bytes, bits, pointer, status, trigger.
    pub kind: &'static str,
    /// What it is called.
    pub title: &'static str,
    /// What it is for.
    pub meaning: &'static str,
    /// What its values mean.
    pub values: &'static str,
    /// The unit of its value.
    pub unit: &'static str,
    /// What it is without an entry, as the manual says it.
    pub default: &'static str,
    /// The same as a number; `None` where the manual gives none but an example.
    pub default_number: Option<f64>,
    /// Where the manual says it, as `[002:7828-7833]`.
    pub source: &'static str,
    plc: &'static str,
    /// What a change needs.
    pub needs: Needs,
    /// What it does here.
    pub effect: Effect,
    /// Why it does less than all; empty for what acts.
    pub reason: &'static str,
    /// The test that shows what acts, as `system900::one_channel`; empty for what does not.
    pub proof: &'static str,
}

impl Row {
    /// The markers of the PLC that it is exchanged with.
    pub fn plc(&self) -> impl Iterator<Item = &'static str> {
        self.plc.split(", ").filter(|marker| !marker.is_empty())
    }

    /// The numbers that it explains.
    pub(crate) fn numbers(&self) -> impl Iterator<Item = u32> + use<> {
        let (Name::Q(first) | Name::P(_, first)) = self.first;
        first..=self.last
    }

    fn names(&self) -> impl Iterator<Item = Name> {
        let is_q = matches!(self.first, Name::Q(_));
        self.numbers().map(move |number| match is_q {
            true => Name::Q(number),
            false => Name::P(1, number),
        })
    }
}

/// All rows in the order of the manual.
pub fn rows() -> &'static [Row] {
    static ROWS: LazyLock<Vec<Row>> = LazyLock::new(|| {
        let lines = include_str!("../data/parameters.tsv").lines().skip(1);
        lines.filter_map(read).collect()
    });
    &ROWS
}

/// Reads one line; a test proves that every line can be read.
fn read(line: &'static str) -> Option<Row> {
    let mut columns = line.split('\t');
    let mut next = || columns.next();
    let number = next()?;
    let (first, last) = number.split_once('-').unwrap_or((number, number));
    Some(Row {
        number,
        first: first.parse().ok()?,
        last: last.get(1..)?.parse().ok()?,
        kind: next()?,
        title: next()?,
        meaning: next()?,
        values: next()?,
        unit: next()?,
        default: next()?,
        default_number: match next()? {
            "" => None,
            number => Some(number.parse().ok()?),
        },
        source: next()?,
        plc: next()?,
        needs: known(&Needs::ALL, Needs::id, next()?)?,
        effect: known(&Effect::ALL, Effect::id, next()?)?,
        reason: next()?,
        proof: next()?,
    })
}

fn known<T: Copy>(all: &[T], id: fn(T) -> &'static str, word: &str) -> Option<T> {
    all.iter().copied().find(|one| id(*one) == word)
}

/// The row that explains a parameter; `None` for a number without one.
///
/// ```
/// let row = bahn_system900::row("q2360".parse()?).unwrap();
/// assert_eq!((row.number, row.title), ("P12160", "Actual lag"));
/// # Ok::<(), bahn_system900::NoName>(())
/// ```
pub fn row(name: Name) -> Option<&'static Row> {
    static PLACES: LazyLock<HashMap<Name, &'static Row>> = LazyLock::new(|| {
        let mut widest: Vec<&'static Row> = rows().iter().collect();
        widest.sort_by_key(|row| std::cmp::Reverse(row.names().count()));
        let named = widest.iter().flat_map(|row| row.names().map(|name| (name, *row)));
        named.collect()
    });
    let of = |name: Name| PLACES.get(&name).copied();
    let own = match name {
        Name::Q(number) => Name::Q(number),
        Name::P(_, number) => Name::P(1, number),
    };
    like(own).and_then(of).or_else(|| of(own))
}

/// The parameter that explains another one of its kind.
fn like(name: Name) -> Option<Name> {
    let of_axes = |begin: u32| begin..begin + AXIS_BLOCK * u32::from(AXES);
    let of_axis = |at: u32| Name::P(1, AXIS.0 + at % AXIS_BLOCK);
    match name {
        Name::P(_, number) if of_axes(AXIS.0).contains(&number) => Some(of_axis(number - AXIS.0)),
        Name::Q(number) if of_axes(AXIS.1).contains(&number) => Some(of_axis(number - AXIS.1)),
        Name::Q(number) if (SHARED.1..SHARED.1 + SHARED_COUNT).contains(&number) => {
            Some(Name::P(1, number - SHARED.1 + SHARED.0))
        }
        Name::Q(number) if DESCRIPTORS.contains(&number) => Some(Name::Q(DESCRIPTOR + number % DESCRIPTOR)),
        Name::Q(number) if NETWORKS.contains(&number) => {
            Some(Name::Q(NETWORKS.start - NETWORK + number % NETWORK))
        }
        _ => None,
    }
}
