//! The part at moments along the path: as differences, few enough to be kept however long the path is.

use bahn_workpiece::Part;

use crate::bytes::varint;
use crate::sheet::{Change, Sheet};

/// Moments that are kept at most; half of them when there are more.
const MOST_MOMENTS: usize = 96;
/// Fewer are never kept, unless they do not fit in the page.
const LEAST_MOMENTS: usize = 6;
/// Cells that all moments together may have changed, to bound the memory while the path runs.
const MOST_CHANGED: usize = 16_000_000;
/// Time between the moments at the beginning, s.
const FIRST_STEP_S: f64 = 0.25;

#[derive(Clone, Debug)]
struct Moment {
    time_s: f64,
    /// Changes, sorted by tile.
    changes: Vec<Change>,
}

/// Collects the part at moments that are evenly spread over the machining time.
#[derive(Clone, Debug)]
pub(crate) struct History {
    blank: Sheet,
    now: Sheet,
    moments: Vec<Moment>,
    step_s: f64,
    next_s: f64,
    changed: usize,
}

impl History {
    pub fn new(part: &Part) -> History {
        let blank = Sheet::blank_of(part);
        History {
            now: blank.clone(),
            blank,
            moments: Vec::new(),
            step_s: FIRST_STEP_S,
            next_s: FIRST_STEP_S,
            changed: 0,
        }
    }

    pub fn sheet(&self) -> &Sheet {
        &self.now
    }

    /// Whether it is time for the next moment.
    #[inline]
    pub fn is_due(&self, time_s: f64) -> bool {
        time_s >= self.next_s
    }

    /// Keeps the part as it is at a time.
    pub fn take(&mut self, time_s: f64, part: &Part) {
        self.next_s = time_s + self.step_s;
        let changes = self.now.take(part);
        if changes.is_empty() {
            return;
        }
        self.changed += changes.iter().map(|change| change.cells.len()).sum::<usize>();
        self.moments.push(Moment { time_s, changes });
        while self.moments.len() > MOST_MOMENTS
            || (self.changed > MOST_CHANGED && self.moments.len() > LEAST_MOMENTS)
        {
            self.thin();
            self.step_s *= 2.0;
        }
    }

    /// Leaves every other moment, with what changed since the one before it that is left.
    fn thin(&mut self) {
        let all = std::mem::take(&mut self.moments);
        // The last one stays: that is the part as it is.
        let odd = all.len() % 2;
        let mut earlier: Option<Moment> = None;
        for (number, moment) in all.into_iter().enumerate() {
            match earlier.take() {
                Some(before) => self.moments.push(Moment {
                    time_s: moment.time_s,
                    changes: merged(&before.changes, moment.changes),
                }),
                None if number == 0 && odd == 1 => self.moments.push(moment),
                None => earlier = Some(moment),
            }
        }
        self.changed = self
            .moments
            .iter()
            .flat_map(|moment| &moment.changes)
            .map(|change| change.cells.len())
            .sum();
    }

    /// All moments as bytes: their count; for each its time in ms since the one before, the length of its tiles,
    /// and those.
    pub fn written(&self) -> Vec<u8> {
        let mut sheet = self.blank.clone();
        let mut out = Vec::new();
        varint(&mut out, self.moments.len() as u64);
        let mut before_ms = 0;
        for moment in &self.moments {
            let ms = (moment.time_s * 1000.0).round() as u64;
            varint(&mut out, ms.saturating_sub(before_ms));
            before_ms = ms;
            for change in &moment.changes {
                sheet.apply(change);
            }
            let mut tiles = Vec::new();
            sheet.write(&moment.changes, &mut tiles);
            varint(&mut out, tiles.len() as u64);
            out.extend_from_slice(&tiles);
        }
        out
    }

    /// Leaves half of the moments; `false` when only the last one is there.
    pub fn halve(&mut self) -> bool {
        let can = self.moments.len() > 1;
        if can {
            self.thin();
        }
        can
    }
}

/// Two sorted lists of changes as one.
fn merged(before: &[Change], after: Vec<Change>) -> Vec<Change> {
    let mut both: Vec<Change> = Vec::with_capacity(before.len() + after.len());
    let mut old = before.iter().peekable();
    for new in after {
        while let Some(change) = old.next_if(|change| change.tile < new.tile) {
            both.push(change.clone());
        }
        match old.next_if(|change| change.tile == new.tile) {
            Some(change) => both.push(change.followed_by(&new)),
            None => both.push(new),
        }
    }
    both.extend(old.cloned());
    both
}

#[cfg(test)]
mod tests {
    use super::*;
    use bahn_path::{Axis, Blank, BlockRef, Curve, FeedRate, PathElement, Plane, Position, ToolShape};
    use bahn_workpiece::{Resolution, Workpiece};

    fn down(x: f64, y: f64, z: f64) -> PathElement {
        let at = |z: f64| {
            let mut position = Position::UNKNOWN;
            (position[Axis::X], position[Axis::Y], position[Axis::Z]) = (x, y, z);
            position
        };
        let feed = FeedRate::Programmed(100.0);
        PathElement::new(BlockRef::default(), 0, Curve::Line, [at(1.0), at(z)], feed)
    }

    /// 5000 holes, one each tenth of a second, over and over the same places: what is kept of the moments is the part as it
    /// was then, the last one is the part as it is, and they lie evenly.
    #[test]
    fn the_moments_that_are_kept_are_true() {
        let blank = Blank {
            plane: Plane::XY,
            min: [0.0, 0.0, -10.0],
            max: [60.0, 40.0, 0.0],
        };
        let mut workpiece = Workpiece::new(&blank, Resolution::Millimetres(0.5)).unwrap();
        workpiece.remember_tools();
        let tool = ToolShape {
            radius: 1.5,
            ..ToolShape::default()
        };
        let mut history = History::new(workpiece.part());
        let mut seen: Vec<(f64, Sheet)> = Vec::new();
        let mut last_s = 0.0;
        for hole in 0..5000_u32 {
            let turn = f64::from(hole);
            workpiece.cut(
                &down(turn * 7.3 % 60.0, turn * 3.1 % 40.0, -turn / 500.0),
                &tool,
                Axis::Z,
            );
            last_s = 0.1 * (turn + 1.0);
            if history.is_due(last_s) {
                let mut sheet = Sheet::blank_of(workpiece.part());
                sheet.take(workpiece.part());
                seen.push((last_s, sheet));
                history.take(last_s, workpiece.part());
            }
        }
        history.take(last_s, workpiece.part());
        let count = history.moments.len();
        assert!((MOST_MOMENTS / 2 - 2..=MOST_MOMENTS).contains(&count), "{count}");
        let steps: Vec<f64> = history
            .moments
            .windows(2)
            .map(|pair| pair[1].time_s - pair[0].time_s)
            .collect();
        let longest = steps.iter().copied().fold(0.0, f64::max);
        assert!(
            longest <= 2.5 * last_s / count as f64,
            "{longest} s of {last_s} s"
        );

        for _ in 0..8 {
            let mut sheet = history.blank.clone();
            for moment in &history.moments {
                for change in &moment.changes {
                    sheet.apply(change);
                }
                if let Some((_, then)) = seen.iter().find(|(time_s, _)| *time_s == moment.time_s) {
                    assert!(sheet == *then, "{} s", moment.time_s);
                }
            }
            assert!(sheet == history.now);
            let before = history.moments.len();
            assert_eq!(history.halve(), before > 1);
            assert!(history.moments.len() <= before.div_ceil(2));
        }
        assert_eq!(history.moments.len(), 1);
    }
}
