//! One line of a list: a name with its indices, and what stands after it.
//!
//! Decision: Start-up lists are read for the first channel; lines of the axis list count after `spindel[i].` only

use super::Place;
use super::table::{Definition, canonical, pattern};

/// A line with a parameter.
#[derive(Debug, PartialEq)]
pub(super) struct Line<'a> {
    /// The name as it is written.
    pub name: &'a str,
    /// Column of the name, from 1 on.
    pub name_column: usize,
    /// What stands after it, without blanks before and after.
    pub value: &'a str,
    /// Column of the value; without one that after the name.
    pub value_column: usize,
}

/// A fault within a line: column, length and message.
pub(super) type Fault = (usize, usize, String);

/// Takes a line apart; `None` for an empty one, a comment, or the marks of lines that are left out [004:123] [004:228].
pub(super) fn split(text: &str) -> Option<Line<'_>> {
    let trimmed = text.trim_start();
    let is_elision = |c: char| matches!(c, ':' | '.' | '…');
    let rest = trimmed.trim_start_matches(is_elision);
    if trimmed.starts_with(['#', ';', '(']) || rest.trim().is_empty() {
        return None;
    }
    let end = end_of_name(trimmed);
    let name = trimmed.get(..end).unwrap_or(trimmed);
    let rest_of_line = trimmed.get(end..).unwrap_or_default();
    let value = rest_of_line.trim_start();
    let name_column = text.chars().count() - trimmed.chars().count() + 1;
    let blanks = rest_of_line.chars().count() - value.chars().count();
    let is_missing = value.is_empty() || value.starts_with(['#', ';']);
    Some(Line {
        name,
        name_column,
        value: if is_missing { "" } else { value.trim_end() },
        value_column: name_column + name.chars().count() + if is_missing { 0 } else { blanks },
    })
}

/// A name ends at a blank that is not within brackets.
fn end_of_name(text: &str) -> usize {
    let mut is_index = false;
    for (at, c) in text.char_indices() {
        match c {
            '[' => is_index = true,
            ']' => is_index = false,
            '#' | ';' => return at,
            _ if c.is_whitespace() && !(is_index && closes(text, at)) => return at,
            _ => {}
        }
    }
    text.len()
}

/// Whether an index goes on after a blank: `m_synch[ 25 ]`.
fn closes(text: &str, at: usize) -> bool {
    let rest = text.get(at..).unwrap_or_default().trim_start();
    let rest = rest.trim_start_matches(|c: char| c.is_ascii_digit());
    rest.trim_start().starts_with(']')
}

/// The parameter that a name means.
pub(super) fn place(line: &Line) -> Result<Place, Fault> {
    let at_name = |message: String| (line.name_column, line.name.chars().count(), message);
    let (wanted, is_start_up) = canonical(pattern(line.name));
    let mut indices = indices(line)?;
    let channel = (is_start_up && !indices.is_empty()).then(|| indices.remove(0).0);
    let definition = Definition::find(&wanted).ok_or_else(|| at_name(unknown(line.name, &wanted)))?;
    for ((index, column, length), (first, last)) in indices.iter().zip(&definition.indices) {
        if !(first..=last).contains(&index) {
            let message = format!("index {} is not within {first} to {last}", shown(*index));
            return Err((*column, *length, message));
        }
    }
    Ok(Place {
        definition,
        indices: indices.into_iter().map(|(index, ..)| index).collect(),
        is_of_other_channel: channel.is_some_and(|channel| channel != 0),
    })
}

/// An index that no list has stands for all that are too large.
fn shown(index: u32) -> String {
    match index {
        u32::MAX => "beyond all numbers".to_owned(),
        index => index.to_string(),
    }
}

/// The indices of a name with column and length.
fn indices(line: &Line) -> Result<Vec<(u32, usize, usize)>, Fault> {
    let mut found = Vec::new();
    let mut rest = line.name;
    let mut column = line.name_column;
    while let Some((before, rest_of_line)) = rest.split_once('[') {
        column += before.chars().count() + 1;
        let Some((inside, after)) = rest_of_line.split_once(']') else {
            let message = format!("{} lacks a closing bracket", line.name);
            return Err((column, 1, message));
        };
        let length = inside.chars().count();
        let digits = inside.trim();
        if digits.is_empty() || !digits.bytes().all(|byte| byte.is_ascii_digit()) {
            return Err((column, length.max(1), format!("`{digits}` is no index")));
        }
        found.push((digits.parse().unwrap_or(u32::MAX), column, length));
        column += length + 1;
        rest = after;
    }
    Ok(found)
}

/// Why nothing has such a name.
fn unknown(name: &str, wanted: &str) -> String {
    let without = wanted.replace("[]", "");
    let mut all = Definition::all().iter();
    let like = all.find(|row| {
        row.names()
            .any(|known| pattern(known).replace("[]", "") == without)
    });
    match like {
        Some(row) if row.indices.is_empty() => format!("{} has no index: `{}`", row.id, row.name),
        Some(row) => {
            let first: Vec<u32> = row.indices.iter().map(|_| 0).collect();
            let example = row.name_with(&first);
            format!(
                "{} has {} index: `{example}`",
                row.id,
                match first.len() {
                    1 => "an",
                    _ => "more than one",
                }
            )
        }
        None => format!("no parameter is called `{name}`"),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn names_and_values_have_their_columns() {
        let line = split("  m_synch[25]   0x2 MVS_SVS  ").unwrap();
        assert_eq!((line.name, line.name_column), ("m_synch[25]", 3));
        assert_eq!((line.value, line.value_column), ("0x2 MVS_SVS", 17));
        let line = split("m_synch[ 25 ]# no value").unwrap();
        assert_eq!(
            (line.name, line.value, line.value_column),
            ("m_synch[ 25 ]", "", 14)
        );
        for nothing in [
            "",
            "  \t",
            "# m_synch[1] 2",
            " ; note",
            ":",
            " ...",
            "…",
            "(remark)",
        ] {
            assert_eq!(split(nothing), None, "{nothing}");
        }
    }

    #[test]
    fn what_no_name_is_is_said_at_its_place() {
        let fault = |text: &str| {
            let line = split(text).unwrap();
            let (column, length, message) = place(&line).map(|place| place.name()).unwrap_err();
            (column, length, message)
        };
        let (column, length, message) = fault(" m_synch[1000] 2");
        assert_eq!((column, length), (10, 4));
        assert_eq!(message, "index 1000 is not within 0 to 999");
        assert!(fault("m_synch[99999999999] 2").2.contains("0 to 999"));
        assert_eq!(fault("m_synch[x] 2"), (9, 1, "`x` is no index".to_owned()));
        assert_eq!(fault("m_synch[-1] 2").0, 9);
        assert_eq!(fault("m_synch[] 2"), (9, 1, "`` is no index".to_owned()));
        assert!(fault("m_synch[2 2").2.contains("closing bracket"));
        assert_eq!(fault("m_synch 2").2, "P-CHAN-00041 has an index: `m_synch[0]`");
        assert!(fault("spindle_m_fct_free[0] 1").2.contains("has no index"));
        assert_eq!(
            fault("m_sync[1] 2"),
            (1, 9, "no parameter is called `m_sync[1]`".to_owned())
        );
    }

    #[test]
    fn spellings_of_the_manual_mean_the_same() {
        for (written, meant) in [
            ("spindle[0].log_achs_no", "spindel[0].log_achs_nr"),
            ("spindel[0].m3_sync", "spindel[0].m3_synch"),
            ("m_default_output_ax_name[38]", "m_default_outp_ax_name[38]"),
            ("main_spdl_gear_change", "main_spindle_gear_change"),
            ("late_sync_ready", "prog_start.late_sync_ready"),
            ("spindel[0].kenngr.achtstyp", "spindel[0].kenngr.achstyp"),
            (
                "configuration.channel[0].path_preparation.function",
                "configuration.path_preparation.function",
            ),
        ] {
            let text = format!("{written} 1");
            let line = split(&text).unwrap();
            assert_eq!(place(&line).unwrap().name(), meant);
        }
    }
}
