//! A shelf of programs, and its totals.

use bahn_workpiece::Columns;
use serde::{Deserialize, Serialize};

use super::row::{Row, Verdict};

/// Columns that a part of the table is made of: its volume is exact to some tenths of a percent.
pub(super) const COLUMNS: Columns = Columns::About(250_000.0);

/// The table as JSON.
#[derive(Debug, Serialize, Deserialize)]
pub(crate) struct Shelf {
    pub model: String,
    pub totals: Totals,
    pub programs: Vec<Row>,
}

/// What all programs come to.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
#[serde(default)]
pub(crate) struct Totals {
    pub programs: u64,
    /// Run to their end, or to the stop that was wanted.
    pub ok: u64,
    pub errors: u64,
    /// Run by others only.
    pub called: u64,
    /// Broken off by Ctrl-C, or not run at all.
    pub not_run: u64,
    /// Of all programs that were run alone and move.
    pub machining_time_s: f64,
    pub feed_mm: f64,
    pub rapid_mm: f64,
    pub removed_mm3: f64,
    pub warnings: u64,
    /// Programs that are different from the run that was compared with.
    pub changed: u64,
}

impl Totals {
    pub(super) fn of(rows: &[&Row]) -> Totals {
        let mut totals = Totals {
            programs: rows.len() as u64,
            ..Totals::default()
        };
        for row in rows {
            match row.result {
                Verdict::Ok | Verdict::Stopped => totals.ok += 1,
                Verdict::Called => totals.called += 1,
                Verdict::Interrupted | Verdict::NotRun => totals.not_run += 1,
                Verdict::Error | Verdict::Unreadable | Verdict::TimeLimit => totals.errors += 1,
            }
            totals.machining_time_s += row.machining_time_s.unwrap_or_default();
            totals.feed_mm += row.feed_mm;
            totals.rapid_mm += row.rapid_mm;
            totals.removed_mm3 += row.removed_mm3.unwrap_or_default();
            totals.warnings += row.warnings.len() as u64;
            totals.changed += u64::from(!row.changes.is_empty());
        }
        totals
    }
}
