//! The few happenings that a violation needs: delta debugging over the list of them.

use super::plan::Happening;

/// Trials that one seed is worth at most.
const TRIALS_MAX: usize = 64;

/// The smallest part of a list that still `fails`, as far as it is found by leaving out halves, quarters and so on.
pub(super) fn shrink(
    happenings: &[Happening],
    mut fails: impl FnMut(&[Happening]) -> bool,
) -> Vec<Happening> {
    let mut left = happenings.to_vec();
    let mut parts = 2;
    let mut trials = 0;
    while !left.is_empty() && trials < TRIALS_MAX {
        let length = left.len().div_ceil(parts);
        let mut smaller = None;
        for from in (0..left.len()).step_by(length) {
            let mut without = left.clone();
            without.drain(from..(from + length).min(left.len()));
            trials += 1;
            if fails(&without) {
                smaller = Some(without);
                break;
            }
        }
        match smaller {
            Some(smaller) => {
                left = smaller;
                parts = parts.saturating_sub(1).max(2);
            }
            None if length == 1 => break,
            None => parts = (parts * 2).min(left.len()),
        }
    }
    left
}

#[cfg(test)]
mod tests {
    use super::super::catalogue::Kind;
    use super::*;

    /// Of twelve happenings the fourth and the ninth together make it fail.
    #[test]
    fn what_is_not_needed_goes() {
        let happening = |time_us| Happening {
            time_us,
            kind: Kind::Use,
            what: String::new(),
        };
        let all: Vec<Happening> = (0..12).map(happening).collect();
        let needed = [happening(3), happening(8)];
        let mut trials = 0;
        let left = shrink(&all, |part| {
            trials += 1;
            needed.iter().all(|one| part.contains(one))
        });
        assert_eq!(left, needed);
        assert!(trials < 64, "{trials}");
        assert!(shrink(&all, |_| true).is_empty());
    }
}
