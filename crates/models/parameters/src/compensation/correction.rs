//! Non-linear axis errors: the correction tables of code number 105 296, older than .COM and .CMA [000:3875-3887].
//!
//! Decision: Correction tables of code number 105 296 are one file in the form of .COM: 64 points for each axis, over
//! one axis; a .CMA, even without an active line, puts them out of force

use bahn_servo::ErrorTable;

use super::table::{CompensationError, axis_named, error, lines};
use crate::{PLC_AXIS_NAMES, PerPlcAxis};

/// The correction tables of code number 105 296: one for each axis at most, always with 64 points. Where there is an
/// assignment (.CMA) they do not apply [000:3887].
///
/// The manual shows no form of them, so theirs is that of .COM (inferred): a head line says which axis is corrected over
/// the position of which, with DATUM (mm from the machine datum) and DIST (exponent of two in units of 0.1 µm); then the
/// points 0 to 63, each with its error in mm, positive where the axis travels too far. The errors of neighbours differ by
/// a 64th of the spacing at most.
///
/// ```
/// use bahn_parameters::compensation::CorrectionTables;
/// let mut text = String::from("Z OVER Y MM DATUM -90 DIST 16\n");
/// for point in 0..64 {
///     text += &format!("{point} {}\n", f64::from(point) * 0.01);
/// }
/// let tables = CorrectionTables::read(&text)?;
/// // Point 1 stands at -90 + 2^16 · 0.1 µm = -83.4464 mm.
/// assert_eq!(tables.driving(2), Some(1));
/// assert!((tables.error_mm(2, -83.4464) - 0.01).abs() < 1e-9);
/// // 6.5536 mm / 64 = 0.1024 mm: 0.61 after 0.5 is too much.
/// let wrong = CorrectionTables::read(&text.replace("51 0.51\n", "51 0.61\n")).unwrap_err();
/// assert_eq!(wrong.line, 53);
/// # Ok::<(), bahn_parameters::compensation::CompensationError>(())
/// ```
#[derive(Clone, Debug, Default, PartialEq)]
pub struct CorrectionTables {
    /// By the axis that is corrected.
    tables: PerPlcAxis<Option<Correcting>>,
}

/// The table of an axis, and the axis over whose position it counts.
#[derive(Clone, Debug, PartialEq)]
struct Correcting {
    driving: usize,
    table: ErrorTable,
}

/// A table that is being read.
struct Reading {
    line: usize,
    corrected: usize,
    driving: usize,
    datum_mm: f64,
    exponent: u32,
    spacing_mm: f64,
    entries: Vec<(usize, f64)>,
}

/// The difference of two errors in mm is exact to so much.
const ROUNDING_MM: f64 = 1e-9;

impl CorrectionTables {
    /// Points of each table [000:3885].
    pub const POINTS: usize = 64;

    /// Reads the tables from their text form.
    ///
    /// # Errors
    /// The first line that cannot be read.
    pub fn read(text: &str) -> Result<CorrectionTables, CompensationError> {
        let mut tables = CorrectionTables::default();
        let mut reading: Option<Reading> = None;
        for (line, words) in lines(text) {
            if words.get(1) == Some(&"OVER") {
                tables.take(reading.take())?;
                reading = Some(Reading::begin(line, &words)?);
            } else {
                match &mut reading {
                    Some(reading) => reading.point(line, &words)?,
                    None => return error(line, HEAD),
                }
            }
        }
        tables.take(reading)?;
        Ok(tables)
    }

    /// A table is at its end.
    fn take(&mut self, reading: Option<Reading>) -> Result<(), CompensationError> {
        let Some(reading) = reading else {
            return Ok(());
        };
        if reading.entries.len() < CorrectionTables::POINTS {
            return error(reading.line, "a table has 64 points, 0 to 63");
        }
        let table = ErrorTable::new(reading.datum_mm, reading.exponent, &reading.entries);
        let (Some(place), Some(table)) = (self.tables.get_mut(reading.corrected), table) else {
            return error(reading.line, DIST);
        };
        if place.is_some() {
            return error(reading.line, "an axis has one table only");
        }
        *place = Some(Correcting {
            driving: reading.driving,
            table,
        });
        Ok(())
    }

    /// The axis (index) over whose position the errors of an axis count; `None` without a table.
    pub fn driving(&self, axis: usize) -> Option<usize> {
        Some(self.tables.get(axis)?.as_ref()?.driving)
    }

    /// The error of an axis (index) where the driving axis is at a position, mm.
    pub fn error_mm(&self, axis: usize, position_mm: f64) -> f64 {
        let table = self.tables.get(axis).and_then(Option::as_ref);
        table.map_or(0.0, |own| own.table.error_mm(position_mm))
    }

    /// Its axes by index, with their names.
    pub fn axes(&self) -> impl Iterator<Item = (usize, &'static str)> {
        self.columns()
            .filter_map(|(axis, _, _)| Some((axis, *PLC_AXIS_NAMES.get(axis)?)))
    }

    /// Its tables: corrected axis, driving axis, errors.
    pub fn columns(&self) -> impl Iterator<Item = (usize, usize, &ErrorTable)> {
        let tables = self.tables.iter().enumerate();
        tables.filter_map(|(axis, own)| own.as_ref().map(|own| (axis, own.driving, &own.table)))
    }
}

const HEAD: &str =
    "a table begins with AXIS OVER AXIS MM DATUM mm DIST exponent; the axes are X, Y, Z, 4 and 5";

const DIST: &str = "DIST is 0 to 23";

impl Reading {
    fn begin(line: usize, head: &[&str]) -> Result<Reading, CompensationError> {
        let [corrected, "OVER", driving, "MM", "DATUM", datum, "DIST", exponent] = *head else {
            return error(line, HEAD);
        };
        let axes = (axis_named(corrected), axis_named(driving));
        let (datum_mm, exponent) = (datum.parse::<f64>().ok(), exponent.parse::<u32>().ok());
        let datum_mm = datum_mm.filter(|datum| datum.is_finite());
        let ((Some(corrected), Some(driving)), Some(datum_mm), Some(exponent)) = (axes, datum_mm, exponent)
        else {
            return error(line, HEAD);
        };
        let Some(spacing_mm) = ErrorTable::spacing_mm(exponent) else {
            return error(line, DIST);
        };
        Ok(Reading {
            line,
            corrected,
            driving,
            datum_mm,
            exponent,
            spacing_mm,
            entries: Vec::new(),
        })
    }

    /// A point with its error, in their order.
    fn point(&mut self, line: usize, words: &[&str]) -> Result<(), CompensationError> {
        let [number, value] = *words else {
            return error(line, "a point is its number and its error in mm, as 1 0.005");
        };
        if self.entries.len() == CorrectionTables::POINTS || number.parse() != Ok(self.entries.len()) {
            return error(line, "the points are 0 to 63 in their order");
        }
        let Some(value) = value.parse::<f64>().ok().filter(|value| value.is_finite()) else {
            return error(line, "the value is no number");
        };
        let step_max_mm = self.spacing_mm / CorrectionTables::POINTS as f64 + ROUNDING_MM;
        let before = self.entries.last().map_or(value, |(_, error)| *error);
        if (value - before).abs() > step_max_mm {
            return error(
                line,
                "it differs from the point before by more than a 64th of the spacing",
            );
        }
        self.entries.push((self.entries.len(), value));
        Ok(())
    }
}
