//! Non-linear axis errors: a column of a compensation table.

/// The error of one axis over the position of a driving axis [000:3770-3850].
///
/// The points stand 2^exponent times 0.1 µm apart from the start point on. Only kinks are entered; between
/// them the error changes evenly. Before the first and after the last entry it stays what it is there
/// (inferred). An axis' whole error is the sum over all tables that have a column for it.
#[derive(Clone, Debug, PartialEq)]
pub struct ErrorTable {
    start_mm: f64,
    spacing_mm: f64,
    /// Number of the first point.
    first: usize,
    /// One error for each point from there on, mm.
    errors_mm: Vec<f64>,
}

impl ErrorTable {
    /// Greatest exponent of the point spacing: 838.8608 mm [000:3777].
    pub const EXPONENT_MAX: u32 = 23;
    /// Most points of a column [000:3770].
    pub const POINTS_MAX: usize = 256;

    /// A table from its start point (mm from the machine datum), the exponent of its spacing and its
    /// entries: number of the point, error in mm. The entries may come in any order; of two for the same
    /// point the later counts. `None` when the exponent or a number is too large or an entry is no number.
    pub fn new(start_mm: f64, exponent: u32, entries: &[(usize, f64)]) -> Option<ErrorTable> {
        let sound = |&(number, error): &(usize, f64)| number < Self::POINTS_MAX && error.is_finite();
        if !start_mm.is_finite() || !entries.iter().all(sound) {
            return None;
        }
        let mut kinks = [None; Self::POINTS_MAX];
        for &(number, error) in entries {
            kinks[number] = Some(error);
        }
        let mut kinks = kinks
            .iter()
            .enumerate()
            .filter_map(|(number, error)| Some((number, (*error)?)));
        let mut errors_mm = Vec::new();
        let first = kinks.next();
        let (mut at, mut error) = first.unwrap_or_default();
        errors_mm.extend(first.map(|(_, error)| error));
        for (number, next) in kinks {
            let points = (number - at) as f64;
            errors_mm.extend((1..=number - at).map(|point| error + (next - error) * point as f64 / points));
            (at, error) = (number, next);
        }
        Some(ErrorTable {
            start_mm,
            spacing_mm: Self::spacing_mm(exponent)?,
            first: first.unwrap_or_default().0,
            errors_mm,
        })
    }

    /// The distance of two points by its exponent, mm: 2^exponent times 0.1 µm [000:3777]; `None` of one that is too large.
    pub fn spacing_mm(exponent: u32) -> Option<f64> {
        (exponent <= Self::EXPONENT_MAX).then(|| f64::from(1u32 << exponent) * 1e-4)
    }

    /// The error at a position of the driving axis, mm both; a rotary axis gives its position within one
    /// turn [000:3871-3873].
    pub fn error_mm(&self, position_mm: f64) -> f64 {
        let Some(last) = self.errors_mm.len().checked_sub(1) else {
            return 0.0;
        };
        let point = (position_mm - self.start_mm) / self.spacing_mm - self.first as f64;
        let point = point.clamp(0.0, last as f64);
        // A position that is no number casts to 0.
        let (at, part) = (point as usize, point.fract());
        let error = self.errors_mm[at];
        match self.errors_mm.get(at + 1) {
            Some(next) if part > 0.0 => error + (next - error) * part,
            _ => error,
        }
    }

    /// The position of a point, mm.
    pub fn position_mm(&self, number: usize) -> f64 {
        self.start_mm + number as f64 * self.spacing_mm
    }
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used, reason = "a test that unwraps nothing fails")]
    use super::*;

    fn close(a: f64, b: f64) {
        assert!((a - b).abs() < 1e-6, "{a} is not {b}");
    }

    /// The manual's tables [000:3811-3850]: Y over Y and Z over Y from -90, Z over Z from -200.
    fn tables() -> [ErrorTable; 3] {
        let y_of_y = [(0, 0.0), (2, 0.005), (9, 0.01)];
        let sag = [
            -0.01,
            f64::NAN,
            -0.02,
            -0.02,
            -0.025,
            -0.025,
            -0.02,
            -0.02,
            -0.025,
            f64::NAN,
            -0.035,
        ];
        let sag = sag.into_iter().enumerate().chain([(12, -0.035)]);
        let z_of_y: Vec<_> = sag.filter(|(_, error)| !error.is_nan()).collect();
        let z_of_z = [(0, 0.0), (5, 0.005), (7, 0.006), (8, 0.007), (11, 0.01)];
        [
            ErrorTable::new(-90.0, 16, &y_of_y).unwrap(),
            ErrorTable::new(-90.0, 16, &z_of_y).unwrap(),
            ErrorTable::new(-200.0, 16, &z_of_z).unwrap(),
        ]
    }

    #[test]
    fn points_stand_at_the_printed_positions() {
        // 2^16 · 0.1 µm = 6.5536 mm; row 12 at -11.3568 and -121.3568 [000:3785-3850].
        let [y_of_y, _, z_of_z] = tables();
        close(y_of_y.position_mm(12), -11.3568);
        close(z_of_z.position_mm(12), -121.3568);
        // 500 mm need 500/6.5536 = 76.3, so 77 points.
        assert!(y_of_y.position_mm(76) < 410.0 && y_of_y.position_mm(77) > 410.0);
        // 800 mm need 800/6.5536 = 122.1, so 123 points.
        assert!(z_of_z.position_mm(122) < 600.0 && z_of_z.position_mm(123) > 600.0);
    }

    #[test]
    fn between_kinks_the_error_changes_evenly() {
        let [y_of_y, z_of_y, z_of_z] = tables();
        let y = |row| y_of_y.error_mm(y_of_y.position_mm(row));
        // 0.005 in 2 rows; then 0.005 in 7 rows: 0.005 + 3/7 · 0.005 and 0.005 + 6/7 · 0.005.
        close(y(1), 0.0025);
        close(y(5), 0.007_143);
        close(y(8), 0.009_286);
        let z = |row| z_of_y.error_mm(z_of_y.position_mm(row));
        close(z(1), -0.015);
        close(z(9), -0.030);
        close(z(11), -0.035);
        let z = |row| z_of_z.error_mm(z_of_z.position_mm(row));
        close(z(1), 0.001);
        close(z(6), 0.0055);
        close(z(9), 0.008);
        close(z(10), 0.009);
        // At Y -76.8928 and Z -167.232 the sag and the pitch of Z add up: -0.02 + 0.005.
        close(y_of_y.error_mm(-76.8928), 0.005);
        close(z_of_y.error_mm(-76.8928) + z_of_z.error_mm(-167.232), -0.015);
        // Halfway between rows 0 and 1: a quarter of the way to row 2.
        close(y_of_y.error_mm(-90.0 + 3.2768), 0.00125);
    }

    #[test]
    fn outside_the_entries_the_error_stays() {
        let table = ErrorTable::new(0.0, 16, &[(3, 0.002), (1, 0.001)]).unwrap();
        close(table.error_mm(-1e9), 0.001);
        close(table.error_mm(0.0), 0.001);
        close(table.error_mm(2.0 * 6.5536), 0.0015);
        close(table.error_mm(1e9), 0.002);
        assert!(table.error_mm(f64::NAN).is_finite());
        assert_eq!(ErrorTable::new(0.0, 16, &[]).unwrap().error_mm(5.0), 0.0);
    }

    #[test]
    fn wrong_tables_are_refused() {
        assert_eq!(ErrorTable::new(0.0, 24, &[]), None);
        assert_eq!(ErrorTable::new(0.0, 16, &[(256, 0.0)]), None);
        assert_eq!(ErrorTable::new(0.0, 16, &[(0, f64::NAN)]), None);
        close(ErrorTable::new(0.0, 23, &[]).unwrap().position_mm(1), 838.8608);
    }
}
