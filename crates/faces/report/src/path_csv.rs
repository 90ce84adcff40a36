//! The tool path as a table: one row for each executed element.

use std::io::{self, Write};

use bahn_path::{Axis, Curve, FeedRate, PathElement};

use bahn_host::files::NewFile;

const HEADER: &str =
    "program,block,kind,feed_mm_min,X,Y,Z,A,B,C,U,V,W,centre_X,centre_Y,centre_Z,sweep_deg\n";

/// Writes rows as they come.
pub struct PathTable {
    file: NewFile,
    row: Vec<u8>,
}

impl PathTable {
    pub fn new(mut file: NewFile) -> io::Result<PathTable> {
        file.write_all(HEADER.as_bytes())?;
        Ok(PathTable {
            file,
            row: Vec::with_capacity(256),
        })
    }

    /// Writes the row of an element of a program, with what reports call its block; an element that holds still has
    /// none.
    pub fn element(&mut self, element: &PathElement, program: &str, block: u32) -> io::Result<()> {
        let mut corner = None;
        let (kind, arc) = match (&element.curve, element.feed) {
            (Curve::Hold, _) => return Ok(()),
            (Curve::Line, FeedRate::Rapid) => ("rapid", None),
            (Curve::Line, FeedRate::Programmed(_)) => ("line", None),
            (Curve::Arc(arc), _) => ("arc", Some(arc)),
            (Curve::Corner(arc), _) => {
                corner = Some(arc.circle(&element.start, &element.end));
                ("arc", None)
            }
        };
        self.row.clear();
        push_text(&mut self.row, program);
        write!(self.row, ",{block},{kind},")?;
        if let FeedRate::Programmed(feed) = element.feed {
            push_number(&mut self.row, feed);
        }
        for axis in Axis::ALL {
            self.row.push(b',');
            push_number(&mut self.row, element.end[axis]);
        }
        let centre = |axis: Axis| {
            if let Some(circle) = &corner {
                return circle.centre()?.get(axis.index()).copied();
            }
            let arc = arc?;
            let [first, second] = arc.centre;
            let lies_on = |of: Axis| of.main() == Some(axis);
            if lies_on(arc.plane.first) {
                Some(first)
            } else if lies_on(arc.plane.second) {
                Some(second)
            } else {
                None
            }
        };
        let values = [Axis::X, Axis::Y, Axis::Z]
            .map(centre)
            .into_iter()
            .chain([match &corner {
                // In no plane of two axes there is a sense; start, centre and end tell the way: the shorter one.
                Some(circle) => Some(circle.sweep_rad.to_degrees()),
                None => arc.map(|arc| arc.sweep_deg),
            }]);
        for value in values {
            self.row.push(b',');
            push_number(&mut self.row, value.unwrap_or(f64::NAN));
        }
        self.row.push(b'\n');
        self.file.write_all(&self.row)
    }

    pub fn into_file(self) -> NewFile {
        self.file
    }
}

/// A field of text; quoted where it must be.
fn push_text(row: &mut Vec<u8>, text: &str) {
    if text.contains(['"', ',', '\n', '\r']) {
        row.push(b'"');
        row.extend_from_slice(text.replace('"', "\"\"").as_bytes());
        row.push(b'"');
    } else {
        row.extend_from_slice(text.as_bytes());
    }
}

/// A number with up to nine decimals and no exponent; nothing for NaN. Much faster than formatting, which
/// finds the shortest digits: a table has millions of numbers.
pub fn push_number(out: &mut Vec<u8>, value: f64) {
    const DECIMALS: usize = 9;
    const SCALE: u64 = 1_000_000_000;
    if value.is_nan() {
        return;
    }
    let scaled = (value.abs() * SCALE as f64).round();
    if scaled >= u64::MAX as f64 {
        // Beyond any machine; an axis reaches 100 000 mm.
        out.extend_from_slice(format!("{value:.0}").as_bytes());
        return;
    }
    let scaled = scaled as u64;
    if value < 0.0 && scaled > 0 {
        out.push(b'-');
    }
    push_integer(out, scaled / SCALE);
    let mut fraction = scaled % SCALE;
    if fraction == 0 {
        return;
    }
    let mut digits = [b'0'; DECIMALS];
    for digit in digits.iter_mut().rev() {
        *digit = b'0' + (fraction % 10) as u8;
        fraction /= 10;
    }
    let length = digits
        .iter()
        .rposition(|digit| *digit != b'0')
        .map_or(0, |last| last + 1);
    out.push(b'.');
    out.extend_from_slice(digits.get(..length).unwrap_or_default());
}

fn push_integer(out: &mut Vec<u8>, mut number: u64) {
    let start = out.len();
    loop {
        out.push(b'0' + (number % 10) as u8);
        number /= 10;
        if number == 0 {
            break;
        }
    }
    if let Some(digits) = out.get_mut(start..) {
        digits.reverse();
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn number(value: f64) -> String {
        let mut out = Vec::new();
        push_number(&mut out, value);
        String::from_utf8(out).unwrap()
    }

    #[test]
    fn numbers_have_up_to_nine_decimals_and_no_exponent() {
        for (value, text) in [
            (0.0, "0"),
            (-0.0, "0"),
            (-1e-12, "0"),
            (30.000000000000004, "30"),
            (-12.5, "-12.5"),
            (0.000_000_001, "0.000000001"),
            (99_999.999_9, "99999.9999"),
            (1e7, "10000000"),
            (1e300, &format!("{:.0}", 1e300)),
            (f64::NAN, ""),
        ] {
            assert_eq!(number(value), text);
        }
    }

    #[test]
    fn names_are_quoted_where_they_must_be() {
        let text = |name: &str| {
            let mut out = Vec::new();
            push_text(&mut out, name);
            String::from_utf8(out).unwrap()
        };
        assert_eq!(text("7.H"), "7.H");
        assert_eq!(text("a,\"b\".H"), "\"a,\"\"b\"\".H\"");
    }
}
