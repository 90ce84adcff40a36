//! The circle test: how far a recorded circle is from round, as a ballbar shows it.

use serde::Serialize;

use super::table::Table;
use crate::record::tidy;

/// Nominal positions this near the circle belong to it, mm; approach and departure, even tangential ones, leave
/// it within a sample or two.
const BAND: f64 = 0.0005;
/// Circles through three samples that are tried for the one with most samples on it.
const TRIALS: usize = 400;

/// A circle in the plane of two signals.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Circle {
    pub centre: [f64; 2],
    pub radius: f64,
}

/// What a circle test says.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct CircleTest {
    /// The signals of the two axes of the circle.
    pub signals: [String; 2],
    pub centre_mm: [f64; 2],
    /// Radius of the nominal path.
    pub radius_mm: f64,
    /// Greatest deviation outwards and its angle.
    pub outside_mm: f64,
    pub outside_deg: f64,
    /// Greatest deviation inwards (negative) and its angle.
    pub inside_mm: f64,
    pub inside_deg: f64,
    /// Mean deviation of the radius.
    pub mean_mm: f64,
    /// Difference between the greatest and the least radius.
    pub roundness_mm: f64,
    /// Samples on the circle.
    pub samples: usize,
    /// Angle, degrees, and deviation, mm, of each sample in order of time.
    #[serde(skip)]
    pub points: Vec<[f64; 2]>,
}

/// Tests the circle that two axes have described: the nominal path says which circle and when, the actual one
/// how far they were from it.
///
/// # Errors
/// In words, when signals are missing or no circle was described.
pub fn test(table: &Table, axes: [&str; 2]) -> Result<CircleTest, String> {
    let [x, y] = axes;
    let samples = |kind: &str| -> Result<Vec<[f64; 2]>, String> {
        let find = |axis| table.trace(&format!("{axis}.{kind}"));
        let (first, second) = find(x).zip(find(y)).ok_or_else(|| {
            format!(
                "the circle test needs {x}.actual, {y}.actual, {x}.nominal and {y}.nominal in the recording"
            )
        })?;
        Ok(first
            .values
            .iter()
            .zip(&second.values)
            .map(|(x, y)| [*x, *y])
            .collect())
    };
    let (actual, nominal) = (samples("actual")?, samples("nominal")?);
    let circle = fit(&nominal).ok_or_else(|| format!("{x} and {y} describe no circle"))?;
    let points: Vec<[f64; 2]> = nominal
        .iter()
        .zip(&actual)
        .filter(|(nominal, _)| circle.deviation(**nominal).abs() < BAND)
        .map(|(_, actual)| [circle.angle_deg(*actual), circle.deviation(*actual)])
        .collect();
    let by_deviation = |a: &&[f64; 2], b: &&[f64; 2]| a[1].total_cmp(&b[1]);
    let [outside, inside] = [
        points.iter().max_by(by_deviation).copied().unwrap_or_default(),
        points.iter().min_by(by_deviation).copied().unwrap_or_default(),
    ];
    let mean = points.iter().map(|point| point[1]).sum::<f64>() / points.len().max(1) as f64;
    Ok(CircleTest {
        signals: axes.map(|axis| format!("{axis}.actual")),
        centre_mm: circle.centre.map(tidy),
        radius_mm: tidy(circle.radius),
        outside_mm: tidy(outside[1]),
        outside_deg: tidy(outside[0]),
        inside_mm: tidy(inside[1]),
        inside_deg: tidy(inside[0]),
        mean_mm: tidy(mean),
        roundness_mm: tidy(outside[1] - inside[1]),
        samples: points.len(),
        points,
    })
}

impl Circle {
    /// Distance of a point from the circle, positive outside.
    fn deviation(&self, [x, y]: [f64; 2]) -> f64 {
        (x - self.centre[0]).hypot(y - self.centre[1]) - self.radius
    }

    fn angle_deg(&self, [x, y]: [f64; 2]) -> f64 {
        (y - self.centre[1])
            .atan2(x - self.centre[0])
            .to_degrees()
            .rem_euclid(360.0)
    }

    fn through([a, b, c]: [[f64; 2]; 3]) -> Option<Circle> {
        let (bx, by) = (b[0] - a[0], b[1] - a[1]);
        let (cx, cy) = (c[0] - a[0], c[1] - a[1]);
        let d = 2.0 * (bx * cy - by * cx);
        let (bb, cc) = (bx * bx + by * by, cx * cx + cy * cy);
        if d.abs() < 1e-6 * bb.max(cc) {
            return None;
        }
        let (x, y) = ((cy * bb - by * cc) / d, (bx * cc - cx * bb) / d);
        Some(Circle {
            centre: [a[0] + x, a[1] + y],
            radius: x.hypot(y),
        })
    }
}

/// The circle on which most samples lie, then the best one through these (Kåsa: least squares of
/// `x² + y² = 2·a·x + 2·b·y + c`).
fn fit(samples: &[[f64; 2]]) -> Option<Circle> {
    let count = samples.len();
    if count < 12 {
        return None;
    }
    let thin: Vec<[f64; 2]> = samples.iter().step_by(count.div_ceil(2000)).copied().collect();
    let rough = (0..TRIALS)
        .filter_map(|trial| {
            // Three samples a part of the recording apart, wherever the circle lies in it.
            let span = thin.len() / (3 + trial % 7);
            let first = trial * thin.len() / TRIALS;
            let at = |step: usize| thin.get((first + step * span / 3) % thin.len()).copied();
            Circle::through([at(0)?, at(1)?, at(2)?])
        })
        .map(|circle| {
            let on = |point: &&[f64; 2]| circle.deviation(**point).abs() < BAND;
            (thin.iter().filter(on).count(), circle)
        })
        .max_by_key(|(count, _)| *count)
        .filter(|(on, _)| *on >= 12)?
        .1;
    let on = |point: &&[f64; 2]| rough.deviation(**point).abs() < BAND;
    let on: Vec<[f64; 2]> = samples.iter().filter(on).copied().collect();
    least_squares(&on, rough.centre)
}

fn least_squares(samples: &[[f64; 2]], near: [f64; 2]) -> Option<Circle> {
    // Counted from near the centre, so that the sums stay small.
    let count = samples.len() as f64;
    let (mut x, mut y, mut xx, mut yy, mut xy, mut xr, mut yr, mut r) =
        (0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0);
    for sample in samples {
        let (u, v) = (sample[0] - near[0], sample[1] - near[1]);
        let square = u * u + v * v;
        x += u;
        y += v;
        xx += u * u;
        yy += v * v;
        xy += u * v;
        xr += u * square;
        yr += v * square;
        r += square;
    }
    let (a11, a12, a22) = (xx - x * x / count, xy - x * y / count, yy - y * y / count);
    let (b1, b2) = (0.5 * (xr - x * r / count), 0.5 * (yr - y * r / count));
    let determinant = a11 * a22 - a12 * a12;
    if determinant.abs() < 1e-9 * a11.max(a22).powi(2) {
        return None;
    }
    let a = (b1 * a22 - b2 * a12) / determinant;
    let b = (a11 * b2 - a12 * b1) / determinant;
    let radius = (r / count - 2.0 * (a * x + b * y) / count + a * a + b * b).sqrt();
    Some(Circle {
        centre: [near[0] + a, near[1] + b],
        radius,
    })
}

#[cfg(test)]
mod tests {
    use super::super::table::{Kind, Trace};
    use super::*;

    /// A tangential way to the circle around (10, 20), radius 30, and once around; the actual circle is 0.01 mm
    /// larger in X, as two axes of different kv make it an ellipse.
    fn table() -> Table {
        let way = (0..300).map(|n| [40.0, -80.0 + f64::from(n) / 3.0]);
        let round = (0..=720).map(|n| {
            let angle = f64::from(n).to_radians() / 2.0;
            [10.0 + 30.0 * angle.cos(), 20.0 + 30.0 * angle.sin()]
        });
        let nominal: Vec<[f64; 2]> = way.chain(round).collect();
        let actual = nominal
            .iter()
            .map(|[x, y]| [10.0 + (x - 10.0) * (30.01 / 30.0), *y]);
        let actual: Vec<[f64; 2]> = actual.collect();
        let mut traces = Vec::new();
        for (kind, samples) in [("nominal", &nominal), ("actual", &actual)] {
            for (k, axis) in ["X", "Y"].iter().enumerate() {
                traces.push(Trace {
                    name: format!("{axis}.{kind}"),
                    unit: "mm".into(),
                    kind: Kind::Analogue,
                    values: samples.iter().map(|sample| sample[k]).collect(),
                });
            }
        }
        Table {
            times: (0..nominal.len()).map(|n| n as f64 * 0.003).collect(),
            traces,
            ..Table::default()
        }
    }

    #[test]
    fn an_ellipse_against_its_circle() {
        let test = test(&table(), ["X", "Y"]).unwrap();
        assert!((test.centre_mm[0] - 10.0).abs() < 1e-6 && (test.centre_mm[1] - 20.0).abs() < 1e-6);
        assert!((test.radius_mm - 30.0).abs() < 1e-6, "{}", test.radius_mm);
        assert!((test.outside_mm - 0.01).abs() < 1e-6, "{}", test.outside_mm);
        assert!(test.inside_mm.abs() < 1e-6, "{}", test.inside_mm);
        assert!((test.roundness_mm - 0.01).abs() < 1e-6, "{}", test.roundness_mm);
        // Along the circle the mean of 0.01·cos² is a half of it.
        assert!((test.mean_mm - 0.005).abs() < 1e-4, "{}", test.mean_mm);
        assert!(test.outside_deg.rem_euclid(180.0) < 1e-6);
        // The whole circle, and the sample of the way that is as good as on it.
        assert!((721..=723).contains(&test.samples), "{}", test.samples);
    }

    #[test]
    fn a_line_is_no_circle() {
        let mut line = table();
        for trace in &mut line.traces {
            trace.values = (0..line.times.len()).map(|n| n as f64).collect();
        }
        assert!(test(&line, ["X", "Y"]).is_err());
        assert!(test(&line, ["X", "Z"]).unwrap_err().contains("Z.nominal"));
    }
}
