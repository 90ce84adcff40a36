//! Point tables (.PNT): positions by their numbers [000:6846].

use std::collections::BTreeMap;

use bahn_text::Diagnostic;

use crate::columns::{self, Form};

const FORM: Form = Form {
    needed: &["NR"],
    known: Some(&["NR", "X", "Y", "Z", "FADE", "DOC"]),
    example: "NR X Y Z",
};

/// Reads a point table: X, Y and Z of each point, mm; a coordinate that is not given is `None`.
///
/// # Errors
/// The faults with their lines and columns, up to a limit.
pub fn parse(text: &str) -> Result<BTreeMap<u32, [Option<f64>; 3]>, Vec<Diagnostic>> {
    let mut points = BTreeMap::new();
    columns::read(text, &FORM, |row| {
        let number = row.text("NR");
        let number: u32 = number
            .parse()
            .map_err(|_| row.fault("NR", &format!("`{number}` is no number of a point")))?;
        let mut point = [None; 3];
        for (coordinate, name) in point.iter_mut().zip(["X", "Y", "Z"]) {
            if !matches!(row.text(name), "" | "-") {
                *coordinate = Some(row.number(name)? * row.unit_mm);
            }
        }
        match points.insert(number, point) {
            Some(_) => Err(row.fault("NR", &format!("point {number} is there twice"))),
            None => Ok(()),
        }
    })?;
    Ok(points)
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used, reason = "a test may fail")]
    use super::*;

    #[test]
    fn points_are_read() {
        let points =
            parse("BEGIN HOLES .PNT INCH\nNR  X    Y    Z\n0   +1   +2   -1\n12  -0.5\n[END]\n").unwrap();
        assert_eq!(points[&0], [Some(25.4), Some(50.8), Some(-25.4)]);
        assert_eq!(points[&12], [Some(-12.7), None, None]);
        let faults = parse("NR X\n0 1\n0 2\nx 1\n3 y\n").unwrap_err();
        let places: Vec<_> = faults
            .iter()
            .map(|fault| (fault.span.line, fault.span.column))
            .collect();
        assert_eq!(places, [(3, 1), (4, 1), (5, 3)]);
    }
}
