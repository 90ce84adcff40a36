//! Non-linear axis errors are compensated over the positions of their driving axes [000:3770-3887].

use std::collections::BTreeMap;

use bahn_kernel::Axes;
use bahn_servo::ErrorTable;

use bahn_parameters::compensation::{CompensationAssignment, CompensationTable, CorrectionTables};

use crate::plc_link::NcFiles;
use crate::setup::SelectedLine;

/// A column that is active: which axis it corrects, and over which one.
#[derive(Clone, Debug)]
struct Correction {
    driving: usize,
    corrected: usize,
    table: ErrorTable,
}

/// The columns of a line of the assignment.
fn corrections(
    assignment: &CompensationAssignment,
    tables: &BTreeMap<String, CompensationTable>,
    line: usize,
) -> Vec<Correction> {
    let Some(line) = assignment.lines.get(line) else {
        return Vec::new();
    };
    let named = line.iter().enumerate().filter_map(|(driving, name)| {
        let table = tables.get(name.as_ref()?)?;
        Some((driving, table))
    });
    named
        .flat_map(|(driving, table)| {
            table.columns().map(move |(corrected, table)| Correction {
                driving,
                corrected: *corrected,
                table: table.clone(),
            })
        })
        .collect()
}

/// The tables of code number 105 296.
fn old(tables: &CorrectionTables) -> Vec<Correction> {
    let columns = tables.columns();
    columns
        .map(|(corrected, driving, table)| Correction {
            driving,
            corrected,
            table: table.clone(),
        })
        .collect()
}

/// The axis errors that are compensated.
#[derive(Clone, Debug, Default)]
pub(crate) struct Compensation {
    /// The columns of the active line.
    corrections: Vec<Correction>,
    /// The active line of the assignment: it survives power-off [000:15547-15580].
    pub line: Option<usize>,
}

impl Compensation {
    /// A line of the assignment, or none; without any assignment the correction tables of code number 105 296
    /// [000:3887].
    pub fn of(files: &NcFiles, line: Option<usize>) -> Compensation {
        let corrections = match (&files.compensation, line) {
            (Some(assignment), Some(line)) => corrections(assignment, &files.compensation_tables, line),
            (Some(_), None) => Vec::new(),
            (None, _) => files.correction_tables.as_ref().map_or_else(Vec::new, old),
        };
        Compensation { corrections, line }
    }

    /// The line at power-on: that of module 9095 [000:15555], or the one that the file names, when it names another one
    /// than it did then or the selected one is gone.
    pub fn at_power_on(files: &NcFiles, selected: Option<SelectedLine>) -> Compensation {
        let assignment = files.compensation.as_ref();
        let named = assignment.and_then(|assignment| assignment.active);
        let lines = assignment.map_or(0, |assignment| assignment.lines.len());
        let kept = selected.filter(|selected| selected.file == named && selected.line < lines);
        Compensation::of(files, kept.map(|kept| kept.line).or(named))
    }

    /// What module 9095 has selected, when the file names another line.
    pub fn selected(&self, files: &NcFiles) -> Option<SelectedLine> {
        let file = files.compensation.as_ref()?.active;
        let line = self.line.filter(|line| Some(*line) != file)?;
        Some(SelectedLine { line, file })
    }

    /// Corrects each axis with MP730 = 1 by the sum of the tables that have a column for it, over the
    /// positions of their driving axes; a rotary axis counts within one turn [000:3751-3758] [000:3871-3873].
    /// An axis that no table corrects any more is where its encoder says.
    pub fn correct(&self, axes: &mut Axes) {
        for place in 0..axes.count() {
            let error_mm = self.error_mm(axes, place);
            if let Some(unit) = axes.get_mut(place) {
                unit.servo.set_error(error_mm);
            }
        }
    }

    /// The error of an axis where the driving axes stand, mm.
    fn error_mm(&self, axes: &Axes, place: usize) -> f64 {
        let unit = axes.get(place);
        let unit = unit.filter(|unit| unit.parameters.compensation.nonlinear && unit.referenced);
        let Some(corrected) = unit.map(|unit| usize::from(unit.id.number())) else {
            return 0.0;
        };
        let columns = self.corrections.iter();
        let own = columns.filter(|correction| correction.corrected == corrected);
        let error = |correction: &Correction| {
            let mut units = axes.iter();
            let driving = units.find(|unit| usize::from(unit.id.number()) == correction.driving)?;
            let position = driving.servo.actual_mm();
            let position = match driving.parameters.travel.modulo {
                Some(modulo) => position.rem_euclid(modulo.deg),
                None => position,
            };
            driving.referenced.then(|| correction.table.error_mm(position))
        };
        // Added from 0 on, so that no error is no negative zero.
        own.filter_map(error).fold(0.0, |sum, error| sum + error)
    }
}
