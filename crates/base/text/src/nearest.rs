//! The known word that was probably meant.

/// Longer words are nobody's slip.
const MAX_LENGTH: usize = 64;

/// The known word that differs least from one that is not known, without regard to case: by one character in three at
/// most, counting letters that are missing, too many, others or exchanged. Of two as near the first.
///
/// ```
/// let known = ["MVS_SVS", "MVS_SNS", "MOS"];
/// assert_eq!(bahn_text::nearest("MVS_SSV", known), Some("MVS_SVS"));
/// assert_eq!(bahn_text::nearest("soon", known), None);
/// ```
pub fn nearest<'a>(word: &str, known: impl IntoIterator<Item = &'a str>) -> Option<&'a str> {
    let word: Vec<char> = word.to_uppercase().chars().take(MAX_LENGTH + 1).collect();
    if word.is_empty() || word.len() > MAX_LENGTH {
        return None;
    }
    let most = word.len().div_ceil(3);
    let near = known.into_iter().filter_map(|known| {
        let other: Vec<char> = known.to_uppercase().chars().collect();
        let far = other.len().abs_diff(word.len()) > most;
        let distance = if far { most + 1 } else { distance(&word, &other) };
        (distance <= most && distance < word.len()).then_some((distance, known))
    });
    near.min_by_key(|(distance, _)| *distance).map(|(_, known)| known)
}

/// How many characters are to be put in, taken out, replaced or exchanged with the next one.
fn distance(from: &[char], to: &[char]) -> usize {
    let (mut before, mut last): (Vec<usize>, Vec<usize>) = (Vec::new(), (0..=to.len()).collect());
    for (i, a) in from.iter().enumerate() {
        let mut row = vec![i + 1];
        for (j, b) in to.iter().enumerate() {
            let get = |row: &[usize], at: usize| row.get(at).copied().unwrap_or(usize::MAX - 1);
            let replaced = get(&last, j) + usize::from(a != b);
            let mut least = replaced.min(get(&last, j + 1) + 1).min(get(&row, j) + 1);
            let exchanged = i > 0 && j > 0 && from.get(i - 1) == Some(b) && to.get(j - 1) == Some(a);
            if exchanged {
                least = least.min(get(&before, j - 1) + 1);
            }
            row.push(least);
        }
        (before, last) = (last, row);
    }
    last.last().copied().unwrap_or(usize::MAX)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn slips_are_counted() {
        let count = |from: &str, to: &str| {
            let chars = |text: &str| text.chars().collect::<Vec<_>>();
            distance(&chars(from), &chars(to))
        };
        for (from, to, slips) in [
            ("", "", 0),
            ("abc", "abc", 0),
            ("abc", "", 3),
            ("", "ab", 2),
            ("abc", "acb", 1),
            ("abc", "abcd", 1),
            ("abc", "xbc", 1),
            ("kitten", "sitting", 3),
        ] {
            assert_eq!(count(from, to), slips, "{from} {to}");
        }
    }

    #[test]
    fn what_is_too_different_is_not_meant() {
        assert_eq!(nearest("ovreride", ["override", "reset"]), Some("override"));
        assert_eq!(nearest("x", ["y"]), None);
        assert_eq!(nearest("", ["a"]), None);
        assert_eq!(nearest(&"m".repeat(1000), ["m"]), None);
    }
}
