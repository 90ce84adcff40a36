//! What people mean by a word: rows of the lists of parameters and types.

use super::{Definition, SynchRow};
use crate::Synch;

/// Rows of parameters, and of types and bits.
pub type Found = (Vec<&'static Definition>, Vec<&'static SynchRow>);

/// What a word means: a parameter by name or number, a type or bit by name, or a value with all its bits; `None` where nothing is
/// called so.
///
/// ```
/// use bahn_technology::list::find;
/// let rows = find("41").map(|(parameters, _)| parameters);
/// assert!(rows.is_some_and(|rows| rows.iter().any(|row| row.id == "P-CHAN-00041")));
/// assert!(find("nothing").is_none());
/// ```
pub fn find(wanted: &str) -> Option<Found> {
    if let Some(parts) = parts(wanted) {
        return Some((Vec::new(), parts));
    }
    if let Some(row) = Definition::named(wanted) {
        return Some((vec![row], Vec::new()));
    }
    let bare = without_indices(wanted);
    let digits = wanted.trim_start_matches(|c: char| !c.is_ascii_digit());
    let number = digits.parse().ok().filter(|_| is_number(wanted));
    let is_meant = |row: &&Definition| {
        let of_id = row.id.rsplit('-').next().and_then(|id| id.parse::<u32>().ok());
        let names = |name: &str| {
            let known = without_indices(name);
            known == bare || known.rsplit('.').next() == Some(bare.as_str())
        };
        (number.is_some() && number == of_id && is_kind(row.id, wanted))
            || row
                .meaning
                .split([' ', '.'])
                .any(|word| word.eq_ignore_ascii_case(wanted) && word.starts_with("P-STUP-"))
            || row.names().any(names)
            || row.default == wanted
    };
    let rows: Vec<&Definition> = Definition::all().iter().filter(is_meant).collect();
    (!rows.is_empty()).then(|| (rows, Vec::new()))
}

/// The type and the bits that a value or an expression of constants is made of.
fn parts(wanted: &str) -> Option<Vec<&'static SynchRow>> {
    let value = |text: &str| {
        let hexadecimal = text.strip_prefix("0x").or(text.strip_prefix("0X"));
        let number = match hexadecimal {
            Some(digits) => u32::from_str_radix(digits, 16).ok(),
            None => text.parse().ok(),
        };
        number.or_else(|| Synch::constant(text))
    };
    let mut terms = wanted.split('|').map(|term| value(term.trim()));
    let bits = terms.try_fold(0_u32, |sum, term| Some(sum | term?))?;
    let synch = Synch::from_bits(bits).ok()?;
    // A bit alone is explained alone.
    let is_bit_alone = SynchRow::all().iter().any(|row| row.is_bit && row.bits == bits);
    let kind = SynchRow::find(synch.kind.name()).filter(|_| !is_bit_alone);
    let flags = SynchRow::all()
        .iter()
        .filter(|row| row.is_bit && bits & row.bits != 0);
    Some(kind.into_iter().chain(flags).collect())
}

/// `41`, `00041`, `P-CHAN-00041`, `chan-41`.
fn is_number(wanted: &str) -> bool {
    let letters = wanted.trim_end_matches(|c: char| c.is_ascii_digit());
    let letters = letters.trim_matches('-').to_ascii_uppercase();
    ["", "P", "CHAN", "P-CHAN", "AXIS", "P-AXIS"].contains(&letters.as_str())
}

/// Whether the number is one of the list that the word names, if it names one.
fn is_kind(id: &str, wanted: &str) -> bool {
    let wanted = wanted.to_ascii_uppercase();
    ["CHAN", "AXIS"]
        .iter()
        .all(|kind| !wanted.contains(kind) || id.contains(kind))
}

/// A name in small letters without what stands in brackets.
fn without_indices(name: &str) -> String {
    let parts = name.split('[').enumerate();
    let kept = parts.map(|(at, part)| match at {
        0 => part,
        _ => part.split_once(']').map_or("", |(_, rest)| rest),
    });
    kept.collect::<String>().to_ascii_lowercase()
}
