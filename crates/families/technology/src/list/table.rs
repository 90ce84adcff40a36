//! The parameters that a list may have, and the synchronisation types: `data/*.tsv`.

use std::collections::HashMap;
use std::sync::LazyLock;

use bahn_path::Synchronisation;

use crate::synch::Synch;

const PARAMETERS: &str = include_str!("../../data/channel-parameters.tsv");
const SYNCH_TYPES: &str = include_str!("../../data/synch-types.tsv");

/// Whose synchronisation a value is.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Owner {
    /// An M function of the channel.
    M,
    /// An H function of the channel.
    H,
    /// A function of a spindle.
    Spindle,
    /// The T word of a tool.
    Tool,
}

impl Owner {
    /// As the tables call it.
    pub fn id(self) -> &'static str {
        match self {
            Owner::M => "m",
            Owner::H => "h",
            Owner::Spindle => "spindle",
            Owner::Tool => "tool",
        }
    }

    /// The name in messages.
    pub(super) fn text(self) -> &'static str {
        match self {
            Owner::M => "an M function",
            Owner::H => "an H function",
            Owner::Spindle => "a spindle",
            Owner::Tool => "the T word",
        }
    }
}

/// What a value is.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Kind {
    /// A synchronisation type, by constants or as a number.
    Synch(Owner),
    /// A whole number within limits.
    Number {
        /// Least value that is accepted.
        min: u32,
        /// Greatest value that is accepted.
        max: u32,
    },
    /// A flag, 0 or 1.
    Flag,
    /// A name of at most so many characters.
    Name {
        /// Length of the text, characters at most.
        max: usize,
    },
    /// Constants `FCT_...`, joined by `|`.
    Functions,
}

impl Kind {
    /// The range for people.
    pub fn range(self) -> String {
        match self {
            Kind::Synch(owner) => {
                let types = SynchRow::all().iter().filter(|row| row.is_for(owner));
                types.map(|row| row.name).collect::<Vec<_>>().join(", ")
            }
            Kind::Number { min, max } => format!("{min} to {max}"),
            Kind::Flag => "0 or 1".to_owned(),
            Kind::Name { max } => format!("a name of at most {max} characters"),
            Kind::Functions => "constants FCT_..., joined by |".to_owned(),
        }
    }
}

/// A parameter that a list may have.
#[derive(Clone, Debug)]
pub struct Definition {
    /// The number in the manual, `P-CHAN-00041`.
    pub id: &'static str,
    /// The name with `[i]` for an index: `spindel[i].m3_synch`.
    pub name: &'static str,
    /// Other names that are read, too.
    pub variants: Vec<&'static str>,
    /// What its value is.
    pub kind: Kind,
    /// First and last of each index.
    pub indices: Vec<(u32, u32)>,
    /// The unit, empty for a number without one.
    pub unit: &'static str,
    /// The value without an entry, for people.
    pub default: &'static str,
    /// Why it has no effect here; empty if it has.
    pub without_effect: &'static str,
    /// What the parameter does.
    pub meaning: &'static str,
    /// Where it is said: `004:54;004:60 (public: ...)`.
    pub source: &'static str,
}

impl Definition {
    /// All, in the order of the table.
    pub fn all() -> &'static [Definition] {
        static ALL: LazyLock<Vec<Definition>> =
            LazyLock::new(|| PARAMETERS.lines().skip(1).filter_map(definition).collect());
        &ALL
    }

    /// The one that a name means in any of its spellings, with or without numbers as indices.
    pub fn named(name: &str) -> Option<&'static Definition> {
        Definition::find(&canonical(pattern(name)).0)
    }

    /// The one with a name in the form of [`pattern`].
    pub(super) fn find(wanted: &str) -> Option<&'static Definition> {
        static NAMES: LazyLock<HashMap<String, &'static Definition>> = LazyLock::new(|| {
            let all = Definition::all().iter();
            all.flat_map(|row| row.names().map(move |name| (pattern(name), row)))
                .collect()
        });
        NAMES.get(wanted).copied()
    }

    /// All names that are read.
    pub fn names(&self) -> impl Iterator<Item = &'static str> + use<'_> {
        std::iter::once(self.name).chain(self.variants.iter().copied())
    }

    /// The name with its indices: `spindel[0].m3_synch`.
    pub(crate) fn name_with(&self, indices: &[u32]) -> String {
        let mut letters = ["[i]", "[j]"].into_iter();
        let mut name = self.name.to_owned();
        for index in indices {
            let Some(letter) = letters.next() else { break };
            name = name.replacen(letter, &format!("[{index}]"), 1);
        }
        name
    }
}

/// A name without its indices and regardless of case: `spindel[].m3_synch`.
pub(super) fn pattern(name: &str) -> String {
    let mut pattern = String::with_capacity(name.len());
    let mut is_index = false;
    for c in name.chars() {
        match c {
            '[' => is_index = true,
            ']' => is_index = false,
            _ if is_index => continue,
            _ => {}
        }
        pattern.push(c.to_ascii_lowercase());
    }
    pattern
}

/// A pattern in the spelling of the table, and whether it is that of a start-up list, where the channel is the first
/// index [004:225]. The word spindle is written in German and in English [004:210-213].
pub(super) fn canonical(pattern: String) -> (String, bool) {
    if let Some(rest) = pattern.strip_prefix("spindle[") {
        return (format!("spindel[{rest}"), false);
    }
    match pattern.strip_prefix("configuration.channel[].") {
        Some(rest) => (format!("configuration.{rest}"), true),
        None => (pattern, false),
    }
}

/// Reads one row; a test proves that every row can be read.
fn definition(line: &'static str) -> Option<Definition> {
    let fields: Vec<&str> = line.split('\t').collect();
    let [
        id,
        name,
        variants,
        kind,
        indices,
        min,
        max,
        unit,
        default,
        without_effect,
        meaning,
        source,
    ] = fields.try_into().ok()?;
    let kind = match kind {
        "synch m" => Kind::Synch(Owner::M),
        "synch h" => Kind::Synch(Owner::H),
        "synch spindle" => Kind::Synch(Owner::Spindle),
        "synch tool" => Kind::Synch(Owner::Tool),
        "number" => Kind::Number {
            min: min.parse().ok()?,
            max: max.parse().ok()?,
        },
        "flag" => Kind::Flag,
        "name" => Kind::Name {
            max: max.parse().ok()?,
        },
        "functions" => Kind::Functions,
        _ => return None,
    };
    let range = |text: &str| {
        let (first, last) = text.split_once('-')?;
        Some((first.parse().ok()?, last.parse().ok()?))
    };
    Some(Definition {
        id,
        name,
        variants: variants.split_whitespace().collect(),
        kind,
        indices: indices.split_whitespace().map(range).collect::<Option<_>>()?,
        unit,
        default,
        without_effect,
        meaning,
        source,
    })
}

/// What a synchronisation type or a bit does.
#[derive(Clone, Debug)]
pub struct SynchRow {
    /// The name of the type or bit, such as `MVS_SNS`.
    pub name: &'static str,
    /// The bits of the value that it sets.
    pub bits: u32,
    /// Whether it is OR-ed to a type.
    pub is_bit: bool,
    /// When the function is output.
    pub output: &'static str,
    /// Where the path waits for it.
    pub wait: &'static str,
    /// What is to be said of it.
    pub meaning: &'static str,
    /// Where it is said.
    pub source: &'static str,
    owners: &'static str,
}

impl SynchRow {
    /// All types, then all bits.
    pub fn all() -> &'static [SynchRow] {
        static ALL: LazyLock<Vec<SynchRow>> =
            LazyLock::new(|| SYNCH_TYPES.lines().skip(1).filter_map(synch_row).collect());
        &ALL
    }

    /// The one of a constant.
    pub fn find(name: &str) -> Option<&'static SynchRow> {
        let mut all = SynchRow::all().iter();
        all.find(|row| row.name.eq_ignore_ascii_case(name))
    }

    /// Whether functions of this kind may have it.
    pub fn is_for(&self, owner: Owner) -> bool {
        self.owners.split_whitespace().any(|known| known == owner.id())
    }
}

fn synch_row(line: &'static str) -> Option<SynchRow> {
    let fields: Vec<&str> = line.split('\t').collect();
    let [name, kind, owners, meaning, source] = fields.try_into().ok()?;
    let of = Synchronisation::named(name);
    Some(SynchRow {
        name,
        bits: Synch::constant(name)?,
        is_bit: kind == "bit",
        output: of.map_or("", |of| of.output().words()),
        wait: of.map_or("", |of| of.wait().words()),
        meaning,
        source,
        owners,
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_row_is_read_and_every_name_is_one() {
        assert_eq!(Definition::all().len(), PARAMETERS.lines().count() - 1);
        assert_eq!(SynchRow::all().len(), SYNCH_TYPES.lines().count() - 1);
        let mut names: Vec<String> = Definition::all()
            .iter()
            .flat_map(|row| row.names().map(pattern))
            .collect();
        let count = names.len();
        names.sort();
        names.dedup();
        assert_eq!(names.len(), count, "a name stands twice");
        for row in Definition::all() {
            assert_eq!(row.name.matches('[').count(), row.indices.len(), "{}", row.name);
            assert!(
                row.source.starts_with("004:") || row.source == "(public)",
                "{}",
                row.name
            );
            assert!(row.meaning.ends_with('.'), "{}", row.name);
        }
    }

    #[test]
    fn all_types_and_bits_are_named() {
        for kind in Synchronisation::all() {
            let row = SynchRow::find(kind.name()).unwrap();
            assert!(!row.is_bit && row.is_for(Owner::M), "{kind}");
            assert!(!row.output.is_empty() && !row.wait.is_empty(), "{kind}");
        }
        let bits = SynchRow::all().iter().filter(|row| row.is_bit);
        assert_eq!(bits.map(|row| row.bits).fold(0, |a, b| a | b), 0x10c2_0000);
        // For M functions only [004:54] [004:57]; those of a spindle [004:159].
        for (name, h, spindle) in [
            ("MVS_SLM", false, true),
            ("MOS_TS", false, false),
            ("MEP_SVS", true, false),
        ] {
            let row = SynchRow::find(name).unwrap();
            assert_eq!(
                (row.is_for(Owner::H), row.is_for(Owner::Spindle)),
                (h, spindle),
                "{name}"
            );
        }
    }

    #[test]
    fn names_have_their_indices() {
        let find = |name: &str| Definition::find(&pattern(name)).unwrap();
        assert_eq!(find("SPINDEL[7].M3_Synch").name_with(&[7]), "spindel[7].m3_synch");
        assert_eq!(
            find("gruppe[0].achse[2].bezeichnung").name_with(&[0, 2]),
            "gruppe[0].achse[2].bezeichnung"
        );
        assert_eq!(find("spdl_anzahl").name_with(&[]), "spdl_anzahl");
    }
}
