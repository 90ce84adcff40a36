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
    /// Sorted by tile.
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
