//! What each control model's functions do here: the registry that nobody may pass by in silence.
//!
//! One table for each [`Kind`] stands in `data/conformance/`, one line for each function or group of like
//! functions: its name, the models that have it, what it does here ([`Effect`]), whether the real control
//! would move differently without it, what is missing, its citation and the test that proves what acts. A
//! function that a model has no row for does not exist on it.
//!
//! ```
//! use bahn_parameters::ControlModel::{Tnc360, Tnc415b};
//! use bahn_parameters::conformance::{Effect, Kind, find};
//!
//! let tilting = find(Tnc415b, Kind::Cycle, "CYCL DEF 19").unwrap();
//! assert_eq!((tilting.effect, tilting.moves), (Effect::Acts, false));
//! assert!(find(Tnc360, Kind::Cycle, "CYCL DEF 19").is_none());
//! ```

use std::sync::LazyLock;

use crate::{ControlModel, Definition};

/// Kinds of functions, each with a table of its own.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub enum Kind {
    /// M functions by their number: `M3`.
    MFunction,
    /// `CYCL DEF 1`, `TCH PROBE 0`.
    Cycle,
    /// Q parameter functions and formulas: `FN14`, `FORMULA`.
    Fn,
    /// Words and blocks of part programs: `RND`, `DLG-CALL`.
    Word,
    /// `MP1060`: all its indices; `MP3410.2`, `MP3410.0-.1`.
    MachineParameter,
    /// Markers and words of the PLC interface: `M2045`, `W260`.
    Marker,
    /// Internal modules of the PLC: `9036`.
    Module,
    /// Messages by the name of their [`MessageId`](crate::MessageId).
    Message,
}

impl Kind {
    /// All kinds in the order of the registry.
    pub const ALL: [Kind; 8] = [
        Kind::MFunction,
        Kind::Cycle,
        Kind::Fn,
        Kind::Word,
        Kind::MachineParameter,
        Kind::Marker,
        Kind::Module,
        Kind::Message,
    ];

    /// The name used on the command line: `m`, `cycle`, `parameter`.
    pub const fn id(self) -> &'static str {
        match self {
            Kind::MFunction => "m",
            Kind::Cycle => "cycle",
            Kind::Fn => "fn",
            Kind::Word => "word",
            Kind::MachineParameter => "parameter",
            Kind::Marker => "marker",
            Kind::Module => "module",
            Kind::Message => "message",
        }
    }

    /// What the table is headed with.
    pub const fn title(self) -> &'static str {
        match self {
            Kind::MFunction => "M functions",
            Kind::Cycle => "Cycles",
            Kind::Fn => "Functions of Q parameters",
            Kind::Word => "Blocks and words",
            Kind::MachineParameter => "Machine parameters",
            Kind::Marker => "Markers and words of the PLC interface",
            Kind::Module => "Modules of the PLC",
            Kind::Message => "Messages",
        }
    }

    const fn table(self) -> &'static str {
        match self {
            Kind::MFunction => include_str!("../data/conformance/m-functions.tsv"),
            Kind::Cycle => include_str!("../data/conformance/cycles.tsv"),
            Kind::Fn => include_str!("../data/conformance/fn.tsv"),
            Kind::Word => include_str!("../data/conformance/words.tsv"),
            Kind::MachineParameter => include_str!("../data/conformance/machine-parameters.tsv"),
            Kind::Marker => include_str!("../data/conformance/markers.tsv"),
            Kind::Module => include_str!("../data/conformance/modules.tsv"),
            Kind::Message => include_str!("../data/conformance/messages.tsv"),
        }
    }
}

/// What a function does here.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub enum Effect {
    /// All that the manual says.
    Acts,
    /// Some of it; [`Entry::missing`] says what is not done.
    Partly,
    /// Nothing: it is read and passed over.
    None,
}

impl Effect {
    /// All effects, most first.
    pub const ALL: [Effect; 3] = [Effect::Acts, Effect::Partly, Effect::None];

    /// The word of the table: `acts`, `partly`, `none`.
    pub const fn id(self) -> &'static str {
        match self {
            Effect::Acts => "acts",
            Effect::Partly => "partly",
            Effect::None => "none",
        }
    }
}

/// One row of the registry.
#[derive(Clone, Copy, Debug)]
#[non_exhaustive]
pub struct Entry {
    /// Which table it stands in.
    pub kind: Kind,
    /// The function, or a group of them: `M20-M88`, `MP3410.0-.1`.
    pub name: &'static str,
    /// What it does here.
    pub effect: Effect,
    /// Without it the real control moves differently: a program that uses it is refused.
    pub moves: bool,
    /// What is not done; empty for what acts.
    pub missing: &'static str,
    /// Where the manuals say it, as `[000:7080]`.
    pub source: &'static str,
    /// The test that shows what acts, as `control::dwell`; empty for what does not.
    pub proof: &'static str,
    /// The models that have it, as the table says: `all`, `360`, `407-425`.
    pub controls: &'static str,
    models: u8,
    range: Range<'static>,
}

impl Entry {
    /// Whether a model has the function.
    pub fn is_of(&self, model: ControlModel) -> bool {
        self.models & bit(model) != 0
    }

    /// The models that have the function, oldest first.
    pub fn models(&self) -> impl Iterator<Item = ControlModel> {
        let models = self.models;
        ControlModel::FAMILIES
            .into_iter()
            .filter(move |model| models & bit(*model) != 0)
    }

    /// Whether the row is about an object: `M20-M88` is about `M25`.
    pub fn covers(&self, object: &str) -> bool {
        self.range.contains(&Range::read(object))
    }

    /// How many functions of a model the row stands for.
    pub fn count(&self, model: ControlModel) -> usize {
        match self.kind {
            _ if !self.is_of(model) => 0,
            Kind::MachineParameter => Definition::all(model)
                .iter()
                .filter(|definition| self.covers(&definition.id.to_string()))
                .count(),
            Kind::MFunction | Kind::Cycle | Kind::Fn => {
                (self.range.last.0.min(self.range.first.0 + 999) - self.range.first.0) as usize + 1
            }
            Kind::Word | Kind::Marker | Kind::Module | Kind::Message => 1,
        }
    }

    /// The effect in words for people: `has no effect here: tilting`; nothing for what acts.
    pub fn remark(&self) -> Option<String> {
        match self.effect {
            Effect::Acts => None,
            Effect::Partly => Some(format!("acts in part here, without: {}", self.missing)),
            Effect::None => Some(format!("has no effect here: {}", self.missing)),
        }
    }
}

/// The whole registry: kinds in their order, rows as the tables have them.
pub fn all() -> &'static [Entry] {
    static ALL: LazyLock<Vec<Entry>> = LazyLock::new(|| {
        let rows = |kind: Kind| {
            kind.table()
                .lines()
                .skip(1)
                .filter_map(move |line| row(kind, line))
        };
        Kind::ALL.into_iter().flat_map(rows).collect()
    });
    &ALL
}

/// The rows of a model.
pub fn entries(model: ControlModel) -> impl Iterator<Item = &'static Entry> {
    all().iter().filter(move |entry| entry.is_of(model))
}

/// The row that is about an object of a model, `M114` or `MP1060.2`; `None` when the model has no such
/// function.
pub fn find(model: ControlModel, kind: Kind, object: &str) -> Option<&'static Entry> {
    let object = Range::read(object);
    entries(model).find(|entry| entry.kind == kind && entry.range.contains(&object))
}

pub(crate) const fn bit(model: ControlModel) -> u8 {
    1 << model.place()
}

/// Reads one row; a test proves that every row can be read.
fn row(kind: Kind, line: &'static str) -> Option<Entry> {
    let mut columns = line.split('\t');
    let mut next = || columns.next();
    let name = next()?;
    let controls = next()?;
    let models = controls
        .split(' ')
        .map(models)
        .try_fold(0, |all, some| Some(all | some?))?;
    let effect = next()?;
    Some(Entry {
        kind,
        name,
        controls,
        models,
        effect: Effect::ALL.into_iter().find(|known| known.id() == effect)?,
        moves: match next()? {
            "moves" => true,
            "" => false,
            _ => return None,
        },
        missing: next()?,
        source: next()?,
        proof: next()?,
        range: Range::read(name),
    })
}

/// Reads `all`, `360` or `407-425`.
pub(crate) fn models(text: &str) -> Option<u8> {
    let place = |text: &str| {
        let is_named = |model: &ControlModel| model.id().strip_prefix("tnc") == Some(text);
        ControlModel::FAMILIES.iter().position(is_named)
    };
    let (first, last) = match text.split_once('-') {
        _ if text == "all" => (0, ControlModel::FAMILIES.len() - 1),
        Some((first, last)) => (place(first)?, place(last)?),
        None => (place(text)?, place(text)?),
    };
    let named = ControlModel::FAMILIES.get(first..=last)?;
    Some(named.iter().fold(0, |all, model| all | bit(*model)))
}

/// Consecutive objects of a table: letters, then number and index of the first and the last.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) struct Range<'a> {
    letters: &'a str,
    first: (u32, u32),
    last: (u32, u32),
}

impl<'a> Range<'a> {
    /// Reads `M114`, `M20-M88`, `MP1060` with all its indices, `MP3410.2`, `MP3410.0-.1`; anything else stands
    /// for itself.
    pub(crate) fn read(text: &'a str) -> Range<'a> {
        Range::numbered(text).unwrap_or(Range {
            letters: text,
            first: (0, 0),
            last: (u32::MAX, u32::MAX),
        })
    }

    fn numbered(text: &'a str) -> Option<Range<'a>> {
        let digits = text.find(|c: char| c.is_ascii_digit())?;
        let (letters, numbers) = text.split_at_checked(digits)?;
        let (first, last) = match numbers.split_once('-') {
            Some((first, last)) => (first, Some(last)),
            None => (numbers, None),
        };
        let index = |text: Option<&str>, otherwise| text.map_or(Some(otherwise), |text| text.parse().ok());
        let read = |text: &str, otherwise| {
            let (number, index_text) = match text.split_once('.') {
                Some((number, index)) => (number, Some(index)),
                None => (text, None),
            };
            let number: u32 = number.parse().ok()?;
            Some((number, index(index_text, otherwise)?))
        };
        let from = read(first, 0)?;
        let to = match last {
            None => read(first, u32::MAX)?,
            Some(last) => match last.strip_prefix('.') {
                Some(last_index) => (from.0, last_index.parse().ok()?),
                None => read(last.strip_prefix(letters).unwrap_or(last), u32::MAX)?,
            },
        };
        Some(Range {
            letters,
            first: from,
            last: to,
        })
    }

    pub(crate) fn contains(&self, object: &Range<'_>) -> bool {
        self.letters == object.letters && self.first <= object.first && object.first <= self.last
    }
}
