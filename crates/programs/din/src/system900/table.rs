//! The words of the language with what is known of each: `data/system900.tsv`.

use std::sync::OnceLock;

/// What is known of a word, or of several G functions in one row.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Meaning {
    /// The word as rows name it: `G41`, `G71-G75`, `M24`, `F`.
    pub word: &'static str,
    /// Which words they are.
    pub part: Part,
    /// What it is called.
    pub title: &'static str,
    /// Unit of its value; empty without one.
    pub unit: &'static str,
    /// What it does and how it is written, beyond its title; may be empty.
    pub rule: &'static str,
    /// Where the manual says so, else `(inferred)`.
    pub source: &'static str,
    /// G functions of one group exclude each other in a block.
    groups: &'static str,
}

/// Kind of a word.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Part {
    /// A letter before a value.
    Address,
    /// A G function of the control.
    Function,
    /// A G function that calls a cycle which the machine builder writes.
    MakerCycle,
    /// A G function that the manual names in a list and explains nowhere.
    NamedOnly,
    /// An M function of the control itself.
    Switch,
}

/// All rows in the order of the table.
pub fn meanings() -> &'static [Meaning] {
    &table().rows
}

/// The row of a G function; `None` of one that is not read.
pub fn g_function(number: u16) -> Option<&'static Meaning> {
    let row = table().g_functions.get(usize::from(number)).copied().flatten()?;
    meanings().get(row)
}

/// The row of an M function of the control itself; `None` of those that a machine defines.
pub fn m_function(number: u16) -> Option<&'static Meaning> {
    let is_it = |row: &&Meaning| row.part == Part::Switch && row.word.get(1..) == Some(&*number.to_string());
    meanings().iter().find(is_it)
}

impl Meaning {
    /// A group that both belong to, so that one of them counts in a block.
    pub(super) fn shares_group(&self, other: &Meaning) -> bool {
        let mut own = self.groups.split(',').filter(|group| !group.is_empty());
        own.any(|group| other.groups.split(',').any(|others| others == group))
    }

    /// The numbers of its G functions.
    fn numbers(&self) -> impl Iterator<Item = u16> {
        let number = |word: &str| word.strip_prefix('G')?.parse::<u16>().ok();
        let ranges = self.word.split(' ').filter_map(move |word| {
            let (first, last) = word.split_once('-').unwrap_or((word, word));
            Some(number(first)?..=number(last)?)
        });
        ranges.flatten()
    }
}

struct Table {
    rows: Vec<Meaning>,
    /// The row of each G function by its number.
    g_functions: Vec<Option<usize>>,
}

fn table() -> &'static Table {
    static TABLE: OnceLock<Table> = OnceLock::new();
    TABLE.get_or_init(|| {
        let lines = include_str!("../../data/system900.tsv").lines().skip(1);
        let rows: Vec<Meaning> = lines.filter_map(row).collect();
        let mut g_functions = vec![None; 1000];
        for (index, row) in rows.iter().enumerate() {
            for number in row.numbers() {
                if let Some(place) = g_functions.get_mut(usize::from(number)) {
                    *place = Some(index);
                }
            }
        }
        Table { rows, g_functions }
    })
}

fn row(line: &'static str) -> Option<Meaning> {
    let mut columns = line.split('\t');
    let mut next = || columns.next();
    let word = next()?;
    let part = match next()? {
        "address" => Part::Address,
        "G" => Part::Function,
        "cycle" => Part::MakerCycle,
        "named" => Part::NamedOnly,
        "M" => Part::Switch,
        _ => return None,
    };
    let groups = next()?;
    Some(Meaning {
        word,
        part,
        groups,
        title: next()?,
        unit: next()?,
        rule: next()?,
        source: next()?,
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_row_is_complete() {
        let lines = include_str!("../../data/system900.tsv").lines().count() - 1;
        assert_eq!(meanings().len(), lines);
        for row in meanings() {
            assert!(!row.title.is_empty(), "{}", row.word);
            let is_cited = row.source.starts_with("[002:") || row.source == "(inferred)";
            assert!(is_cited, "{}: {}", row.word, row.source);
        }
    }

    /// 61 zero points beside G153: G53 to G59, and six each from 154, 254 .. 954.
    #[test]
    fn ranges_are_whole() {
        let zero_points = (0..1000).filter(|g| g_function(*g).is_some_and(|row| row.groups == "zero point"));
        assert_eq!(zero_points.count(), 7 + 9 * 6 + 1);
        assert_eq!(g_function(73).map(|row| row.part), Some(Part::MakerCycle));
        assert_eq!(
            (g_function(70), g_function(82), g_function(1000)),
            (None, None, None)
        );
        assert_eq!(m_function(24).map(|row| row.title), Some("Loop"));
        assert_eq!(m_function(3), None);
    }
}
