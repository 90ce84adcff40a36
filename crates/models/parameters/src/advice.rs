//! What a machine parameter does, for those who set it: what happens when it is too small or too large, and
//! which other parameters belong to it.

use std::sync::OnceLock;

use crate::{ControlModel, Definition};

/// What the parameters of the TNC 407/415/425 do, and what too small and too large values cause.
const TNC_4XX: &str = include_str!("../data/meanings.tsv");
/// The user parameters of the TNC 360; its other ones are those of the TNC 407.
const TNC_360: &str = include_str!("../data/meanings-tnc360.tsv");
/// Those of the TNC 151/155, with their own numbers from 0 to 263.
const TNC_15X: &str = include_str!("../data/meanings-tnc151-155.tsv");

/// What a commissioning engineer wants to know of a number.
#[derive(Clone, Debug, PartialEq, Eq)]
#[non_exhaustive]
pub struct Advice {
    /// The number, without index.
    pub number: u16,
    /// What the parameter does.
    pub does: &'static str,
    /// What happens when it is too small; empty where there is no such thing.
    pub too_small: &'static str,
    /// What happens when it is too large.
    pub too_large: &'static str,
    /// Parameters of the model that belong to it.
    pub related: Vec<u16>,
}

impl Advice {
    /// All numbers of a model in ascending order.
    pub fn all(model: ControlModel) -> &'static [Advice] {
        static LISTS: [OnceLock<Vec<Advice>>; ControlModel::FAMILIES.len()] =
            [const { OnceLock::new() }; ControlModel::FAMILIES.len()];
        LISTS[model.place()].get_or_init(|| list(model.family()))
    }

    /// What is known of a number of a model.
    pub fn of(model: ControlModel, number: u16) -> Option<&'static Advice> {
        let all = Advice::all(model);
        let at = all.binary_search_by_key(&number, |advice| advice.number).ok()?;
        all.get(at)
    }
}

/// Rows of the model's own table, and the rest from that of its family, for the numbers that it has.
fn list(model: ControlModel) -> Vec<Advice> {
    let (own, family) = match model.family() {
        ControlModel::Tnc151 | ControlModel::Tnc155 => (TNC_15X, ""),
        ControlModel::Tnc360 => (TNC_360, TNC_4XX),
        _ => (TNC_4XX, ""),
    };
    let mut numbers: Vec<u16> = Definition::all(model).iter().map(|row| row.id.number).collect();
    numbers.dedup();
    let exists = |number: &u16| numbers.binary_search(number).is_ok();
    let mut rows: Vec<Advice> = rows(own).chain(rows(family)).collect();
    rows.retain(|advice| exists(&advice.number));
    // Stable: of two rows of a number the model's own comes first.
    rows.sort_by_key(|advice| advice.number);
    rows.dedup_by_key(|advice| advice.number);
    for advice in &mut rows {
        advice.related.retain(|number| exists(number));
    }
    rows
}

/// The rows of a table, one for each number.
fn rows(table: &'static str) -> impl Iterator<Item = Advice> {
    table.lines().skip(1).flat_map(|line| {
        let mut columns = line.split('\t');
        let mut next = || columns.next().unwrap_or_default();
        let (numbers, does, too_small, too_large) = (next(), next(), next(), next());
        let related: Vec<u16> = self::numbers(next()).collect();
        self::numbers(numbers).map(move |number| Advice {
            number,
            does,
            too_small,
            too_large,
            related: related.clone(),
        })
    })
}

/// Reads `1060,1070` and `94-109`; a test proves that all can be read.
fn numbers(text: &'static str) -> impl Iterator<Item = u16> {
    text.split(',').flat_map(|part| {
        let (first, last) = part.split_once('-').unwrap_or((part, part));
        let range = first.parse::<u16>().ok().zip(last.parse().ok());
        range.into_iter().flat_map(|(first, last)| first..=last)
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    const TABLES: [(&str, ControlModel); 3] = [
        (TNC_4XX, ControlModel::Tnc425),
        (TNC_360, ControlModel::Tnc360),
        (TNC_15X, ControlModel::Tnc155),
    ];

    /// Every number of every control has a row; rows of numbers that no control has would be dead.
    #[test]
    fn every_number_has_a_meaning() {
        for model in ControlModel::ALL {
            for row in Definition::all(model) {
                let advice = Advice::of(model, row.id.number);
                let does = advice.map_or("", |advice| advice.does);
                assert!(
                    does.len() > 20 && does.ends_with('.'),
                    "{} of {model}: {does}",
                    row.id
                );
            }
        }
        for (table, _) in TABLES {
            for advice in rows(table) {
                let known = ControlModel::ALL.iter().any(|model| {
                    Definition::all(*model)
                        .iter()
                        .any(|row| row.id.number == advice.number)
                });
                assert!(known, "MP{}", advice.number);
            }
        }
        let of_15x = rows(TNC_15X).count();
        assert_eq!(of_15x, 264, "MP0 to MP263, each once");
    }

    /// No number stands twice in a table, and what is too small or too large is said in pairs.
    #[test]
    fn rows_are_whole() {
        for (table, _) in TABLES {
            let mut seen = Vec::new();
            for line in table.lines().skip(1) {
                assert_eq!(line.split('\t').count(), 5, "{line}");
            }
            for advice in rows(table) {
                assert!(!seen.contains(&advice.number), "MP{} twice", advice.number);
                seen.push(advice.number);
                assert_eq!(
                    advice.too_small.is_empty(),
                    advice.too_large.is_empty(),
                    "MP{}",
                    advice.number
                );
            }
        }
    }

    /// Related parameters exist in the list of the family, none is its own relative, and each number that is
    /// more than a leftover of old software has one.
    #[test]
    fn related_numbers_exist() {
        let numbers_of = |family: &[ControlModel]| -> Vec<u16> {
            let all = family.iter().flat_map(|model| Definition::all(*model));
            all.map(|row| row.id.number).collect()
        };
        use ControlModel::{Tnc155, Tnc360, Tnc407, Tnc415b, Tnc425};
        let families: [(&str, &[ControlModel]); 3] = [
            (TNC_4XX, &[Tnc407, Tnc415b, Tnc425, Tnc360]),
            (TNC_360, &[Tnc360]),
            (TNC_15X, &[Tnc155]),
        ];
        for (table, family) in families {
            let known = numbers_of(family);
            for advice in rows(table) {
                for number in &advice.related {
                    assert!(known.contains(number), "MP{}: MP{number}", advice.number);
                }
                let leftover = advice.does.ends_with("Leave it as the list has it.")
                    || advice.does.ends_with("Leave it.");
                assert!(leftover || !advice.related.is_empty(), "MP{}", advice.number);
            }
        }
    }

    /// Parameters of servo and feed, which are found by trying: each says what too small and too large do.
    /// Bits, polarities and choices have no such thing.
    #[test]
    fn servo_and_feed_parameters_say_what_too_small_and_too_large_do() {
        let quantity = |row: &&Definition| !row.unit.is_empty() && row.values.is_empty();
        for model in [ControlModel::Tnc407, ControlModel::Tnc425, ControlModel::Tnc360] {
            let servo = Definition::all(model)
                .iter()
                .filter(|row| (1000..2000).contains(&row.id.number) || row.unit.contains("mm/min"))
                .filter(|row| !(3000..5000).contains(&row.id.number))
                .filter(quantity);
            for row in servo {
                let advice = Advice::of(model, row.id.number);
                assert!(
                    advice.is_some_and(|advice| !advice.too_small.is_empty()),
                    "{}",
                    row.id
                );
            }
        }
        let servo = Definition::all(ControlModel::Tnc155).iter().filter(|row| {
            let named = ["m/min", "m/s^2", "V", "mm"]
                .iter()
                .any(|unit| row.unit.starts_with(unit));
            named && !(126..=156).contains(&row.id.number) && !(186..=189).contains(&row.id.number)
        });
        for row in servo.filter(quantity) {
            let advice = Advice::of(ControlModel::Tnc155, row.id.number);
            assert!(
                advice.is_some_and(|advice| !advice.too_small.is_empty()),
                "{}",
                row.id
            );
        }
    }

    /// The TNC 360 has rows of its own and those of its family; what it lacks is not named.
    #[test]
    fn models_know_their_own_parameters() {
        use ControlModel::{Tnc155, Tnc360, Tnc415b, Tnc425};
        let related = |model, number| Advice::of(model, number).unwrap().related.clone();
        assert!(related(Tnc425, 210).contains(&1950) && !related(Tnc415b, 210).contains(&1950));
        assert!(
            !related(Tnc415b, 330).contains(&340),
            "MP340 is one of the TNC 407"
        );
        assert!(Advice::of(Tnc360, 1060).is_some() && Advice::of(Tnc360, 5010).is_some());
        assert!(Advice::of(Tnc155, 54).is_some() && Advice::of(Tnc155, 1060).is_none());
        assert_ne!(Advice::of(Tnc155, 10), Advice::of(Tnc415b, 10));
    }
}
