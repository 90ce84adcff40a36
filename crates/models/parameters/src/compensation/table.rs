//! Non-linear axis errors: compensation tables (.COM) and their assignment (.CMA) [000:3770-3865].

use std::collections::BTreeMap;

use bahn_servo::ErrorTable;

use super::{CompensationExcess, CompensationSize};
use crate::{PLC_AXIS_NAMES, PerPlcAxis};

/// A compensation table: errors of several axes over the position of the axis that it is assigned to.
///
/// Its text form has a head line with name, unit, DATUM (mm from the machine datum), DIST (exponent of two in
/// units of 0.1 µm) and the dependent axes; then a line for each point that has an entry. Axes are X, Y, Z,
/// 4 and 5.
///
/// ```
/// use bahn_parameters::compensation::CompensationTable;
/// let table = CompensationTable::read(
///     "ACHSE-Y MM DATUM -90 DIST 16 Y Z\n\
///      0 Y=0 Z=-0.01\n\
///      2 Y=0.005 Z=-0.02\n",
/// )?;
/// // Point 1 stands at -90 + 2^16 · 0.1 µm = -83.4464 mm.
/// assert!((table.error_mm(1, -83.4464) - 0.0025).abs() < 1e-9);
/// assert!(CompensationTable::read("A MM DATUM 0 DIST 24 Y\n").is_err());
/// # Ok::<(), bahn_parameters::compensation::CompensationError>(())
/// ```
#[derive(Clone, Debug, Default, PartialEq)]
pub struct CompensationTable {
    columns: Vec<(usize, ErrorTable)>,
    points: usize,
}

/// The assignment: in each line the table of each driving axis. Exactly one line is active, or none.
///
/// ```
/// use bahn_parameters::compensation::CompensationAssignment;
/// let assignment = CompensationAssignment::read("0 Y=ACHSE-Y Z=ACHSE-Z\n1 Z=ACHSE-Z\nACTIVE 0\n")?;
/// assert_eq!(assignment.active, Some(0));
/// assert_eq!(assignment.lines[1][2].as_deref(), Some("ACHSE-Z"));
/// # Ok::<(), bahn_parameters::compensation::CompensationError>(())
/// ```
#[derive(Clone, Debug, Default, PartialEq)]
pub struct CompensationAssignment {
    /// Names of tables by line and axis index.
    pub lines: Vec<PerPlcAxis<Option<String>>>,
    /// The line that is active at power-on.
    pub active: Option<usize>,
}

/// A line of a compensation file cannot be read.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
#[error("line {line}: {what}")]
pub struct CompensationError {
    /// Line, from 1.
    pub line: usize,
    /// What is wrong.
    pub what: &'static str,
}

pub(super) fn error<T>(line: usize, what: &'static str) -> Result<T, CompensationError> {
    Err(CompensationError { line, what })
}

/// Words of each line that is not empty, with its number.
pub(super) fn lines(text: &str) -> impl Iterator<Item = (usize, Vec<&str>)> {
    let lines = (1..).zip(text.lines());
    lines
        .map(|(number, line)| (number, line.split_whitespace().collect::<Vec<_>>()))
        .filter(|(_, words)| !words.is_empty())
}

/// The index of an axis in the lists of the control.
pub(super) fn axis_named(name: &str) -> Option<usize> {
    PLC_AXIS_NAMES
        .iter()
        .position(|known| known.eq_ignore_ascii_case(name))
}

/// `Y=VALUE`: axis index and value.
fn cell(line: usize, word: &str) -> Result<(usize, &str), CompensationError> {
    let found = word
        .split_once('=')
        .and_then(|(name, value)| Some((axis_named(name)?, value)));
    found.map_or_else(|| error(line, "a cell is written axis=value, as Y=0.005"), Ok)
}

impl CompensationTable {
    /// Reads a table from its text form.
    ///
    /// # Errors
    /// The first line that cannot be read.
    pub fn read(text: &str) -> Result<CompensationTable, CompensationError> {
        const HEAD: &str = "the head line is NAME MM DATUM mm DIST exponent AXES";
        let mut lines = lines(text);
        let Some((line, head)) = lines.next() else {
            return error(1, HEAD);
        };
        let [_, unit, datum_word, datum, dist_word, exponent, axes @ ..] = head.as_slice() else {
            return error(line, HEAD);
        };
        let words = unit.eq_ignore_ascii_case("MM") && *datum_word == "DATUM" && *dist_word == "DIST";
        let (Ok(datum), Ok(exponent), true) = (datum.parse::<f64>(), exponent.parse::<u32>(), words) else {
            return error(line, HEAD);
        };
        let mut columns = Vec::new();
        for name in axes {
            match axis_named(name) {
                Some(axis) => columns.push((axis, Vec::new())),
                None => return error(line, "the axes are X, Y, Z, 4 and 5"),
            }
        }
        let mut points = 0;
        for (line, words) in lines {
            let [number, cells @ ..] = words.as_slice() else {
                continue;
            };
            let Some(number) = number
                .parse()
                .ok()
                .filter(|number| *number < ErrorTable::POINTS_MAX)
            else {
                return error(line, "a line begins with the number of its point, 0 to 255");
            };
            points = points.max(number + 1);
            for word in cells {
                let (axis, value) = cell(line, word)?;
                let column = columns.iter_mut().find(|(of, _)| *of == axis);
                match (column, value.parse::<f64>()) {
                    (Some((_, entries)), Ok(value)) if value.is_finite() => entries.push((number, value)),
                    (None, _) => return error(line, "the axis is not in the head line"),
                    _ => return error(line, "the value is no number"),
                }
            }
        }
        let columns = columns
            .into_iter()
            .map(|(axis, entries)| Some((axis, ErrorTable::new(datum, exponent, &entries)?)))
            .collect::<Option<Vec<_>>>();
        match columns {
            Some(columns) => Ok(CompensationTable { columns, points }),
            None => error(line, "DIST is 0 to 23"),
        }
    }

    /// The error of an axis (index) where the driving axis is at a position, mm.
    pub fn error_mm(&self, axis: usize, position_mm: f64) -> f64 {
        let column = self.columns.iter().find(|(of, _)| *of == axis);
        column.map_or(0.0, |(_, table)| table.error_mm(position_mm))
    }

    /// Its columns: axis index and errors.
    pub fn columns(&self) -> impl Iterator<Item = &(usize, ErrorTable)> {
        self.columns.iter()
    }

    /// How large it is.
    pub fn size(&self) -> CompensationSize {
        CompensationSize {
            dependencies: self.columns.len(),
            points: self.points,
        }
    }
}

impl CompensationAssignment {
    /// Reads an assignment from its text form: a line with its number and a cell for each driving axis;
    /// `ACTIVE n` makes one active.
    ///
    /// # Errors
    /// The first line that cannot be read.
    pub fn read(text: &str) -> Result<CompensationAssignment, CompensationError> {
        let mut assignment = CompensationAssignment::default();
        for (line, words) in lines(text) {
            if let ["ACTIVE", number] = words.as_slice() {
                match number.parse() {
                    Ok(number) => assignment.active = Some(number),
                    Err(_) => return error(line, "ACTIVE takes the number of a line"),
                }
                continue;
            }
            let [number, cells @ ..] = words.as_slice() else {
                continue;
            };
            if number.parse() != Ok(assignment.lines.len()) {
                return error(line, "lines are numbered 0, 1, 2 in their order");
            }
            let mut tables: PerPlcAxis<Option<String>> = Default::default();
            for word in cells {
                let (axis, name) = cell(line, word)?;
                if let Some(table) = tables.get_mut(axis) {
                    *table = Some(name.to_owned());
                }
            }
            assignment.lines.push(tables);
        }
        Ok(assignment)
    }

    /// Whether the line that `ACTIVE` of its text names can be active with the tables that there are.
    ///
    /// # Errors
    /// There is no such line, or too much in its tables.
    pub fn check_active(
        &self,
        text: &str,
        tables: &BTreeMap<String, CompensationTable>,
    ) -> Result<(), CompensationError> {
        let Some(active) = self.active else {
            return Ok(());
        };
        let place = lines(text).find(|(_, words)| words.first() == Some(&"ACTIVE"));
        let place = place.map_or(1, |(line, _)| line);
        let Some(line) = self.lines.get(active) else {
            return error(place, "there is no line with this number");
        };
        let sizes = line.iter().flatten().filter_map(|name| tables.get(name));
        let sizes: Vec<CompensationSize> = sizes.map(CompensationTable::size).collect();
        match CompensationExcess::of(&sizes) {
            Some(CompensationExcess::PointsOfDependency) => {
                error(place, "a dependency has more than 256 points")
            }
            Some(CompensationExcess::Dependencies) => {
                error(place, "the tables of this line have more than ten dependencies")
            }
            Some(CompensationExcess::Points) => {
                error(place, "the tables of this line have more than 640 points")
            }
            None => Ok(()),
        }
    }
}
