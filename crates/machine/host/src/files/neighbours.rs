//! What lies beside a file that is not there: the names that may have been meant.

use std::cmp::Reverse;
use std::fs;
use std::path::Path;

/// Names that are shown.
const SHOWN: usize = 5;
/// Entries of a folder that are looked at.
const LOOKED_AT: usize = 10_000;

/// A line with similar names, or with the first names, of the folder of a path; `None` when it has none.
pub(super) fn of(path: &Path) -> Option<String> {
    let folder = path.parent().filter(|folder| !folder.as_os_str().is_empty());
    let folder = folder.unwrap_or(Path::new("."));
    let Ok(entries) = fs::read_dir(folder) else {
        return Some(format!("\nthere is no folder {}", folder.display()));
    };
    let mut names: Vec<String> = entries
        .take(LOOKED_AT)
        .flatten()
        .map(|entry| {
            let is_folder = entry.file_type().is_ok_and(|kind| kind.is_dir());
            let name = entry.file_name().to_string_lossy().into_owned();
            if is_folder { name + "/" } else { name }
        })
        .filter(|name| !name.starts_with('.'))
        .collect();
    names.sort();
    let wanted = path.file_name()?.to_string_lossy().to_lowercase();
    let mut similar: Vec<(usize, &String)> = names
        .iter()
        .filter_map(|name| Some((likeness(&wanted, &name.to_lowercase())?, name)))
        .collect();
    similar.sort_by_key(|(likeness, _)| Reverse(*likeness));
    let (what, shown, all) = if similar.is_empty() {
        let shown: Vec<&str> = names.iter().take(SHOWN).map(String::as_str).collect();
        ("there is", shown, names.len())
    } else {
        let shown: Vec<&str> = similar
            .iter()
            .take(SHOWN)
            .map(|(_, name)| name.as_str())
            .collect();
        ("similar names there:", shown, similar.len())
    };
    match all.saturating_sub(SHOWN) {
        _ if shown.is_empty() => Some(format!("\n{} is empty", folder.display())),
        0 => Some(format!("\n{what} {}", shown.join(", "))),
        more => Some(format!("\n{what} {} and {more} more", shown.join(", "))),
    }
}

/// How like two names are, the greater the more; `None` when they are not. A name without its ending, or with
/// at most a third of its characters changed, is like another (inferred).
fn likeness(wanted: &str, name: &str) -> Option<usize> {
    /// Longer names differ in more than a slip of the finger.
    const LONGEST: usize = 64;
    const SAME_STEM: usize = 1000;
    let stem = |name: &str| name.rsplit_once('.').map_or(name, |(stem, _)| stem).to_owned();
    if !stem(wanted).is_empty() && stem(wanted) == stem(name) {
        return Some(SAME_STEM);
    }
    let (a, b): (Vec<char>, Vec<char>) = (wanted.chars().collect(), name.chars().collect());
    let longest = a.len().max(b.len());
    if longest > LONGEST {
        return None;
    }
    let changed = distance(&a, &b);
    (3 * changed <= longest).then(|| SAME_STEM - changed)
}

/// Characters to insert, delete or replace.
fn distance(a: &[char], b: &[char]) -> usize {
    let mut row: Vec<usize> = (0..=b.len()).collect();
    for (i, from) in a.iter().enumerate() {
        let mut left = i + 1;
        let mut diagonal = i;
        if let Some(first) = row.first_mut() {
            *first = left;
        }
        for (above, to) in row.iter_mut().skip(1).zip(b) {
            let replaced = diagonal + usize::from(from != to);
            diagonal = *above;
            left = replaced.min(left + 1).min(*above + 1);
            *above = left;
        }
    }
    row.last().copied().unwrap_or_default()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn slips_and_other_endings_are_alike() {
        let chars = |text: &str| text.chars().collect::<Vec<_>>();
        assert_eq!(distance(&chars("kitten"), &chars("sitting")), 3);
        assert_eq!(distance(&[], &chars("ab")), 2);
        assert!(likeness("part.h", "part.nc") > likeness("part.h", "parts.h"));
        assert!(likeness("contuor.h", "contour.h").is_some());
        assert_eq!(likeness("part.h", "bracket.h"), None);
    }
}
