//! A shelf of programs, and its totals.

use bahn_parameters::ControlModel;
use bahn_workpiece::Columns;
use serde::{Deserialize, Serialize};

use super::row::{Row, Verdict};

/// Columns that a part of the table is made of: its volume is exact to some tenths of a percent.
pub const COLUMNS: Columns = Columns::About(250_000.0);

/// What a table is about.
#[derive(Clone, Copy, Debug)]
pub struct About {
    /// The control model on which the programs run.
    pub model: ControlModel,
    /// Density of the material, g/cm³, for weights.
    pub density: Option<f64>,
    /// The runs are compared with others.
    pub compared: bool,
}

/// The table as JSON.
#[derive(Debug, Serialize, Deserialize)]
pub struct Shelf {
    /// The control model on which the programs ran.
    pub model: String,
    /// What all come to.
    pub totals: Totals,
    /// What is said of each.
    pub programs: Vec<Row>,
}

/// What all programs come to.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
#[serde(default)]
pub struct Totals {
    /// How many programs there are.
    pub programs: u64,
    /// Run to their end, or to the stop that was wanted.
    pub ok: u64,
    /// Programs with an error.
    pub errors: u64,
    /// Run by others only.
    pub called: u64,
    /// Broken off by Ctrl-C, or not run at all.
    pub not_run: u64,
    /// Of all programs that were run alone and move.
    pub machining_time_s: f64,
    /// Distance in feed, mm.
    pub feed_mm: f64,
    /// Distance in rapid traverse, mm.
    pub rapid_mm: f64,
    /// Volume that was removed, mm³.
    pub removed_mm3: f64,
    /// How many warnings all of them have.
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
