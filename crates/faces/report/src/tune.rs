//! The circle test and a stop, before and after.

use bahn_picture::{Anchor, Colour};
use bahn_trials::tuning::{AxisTest, Circle, Tuned};

use crate::scope::Sheet;

const SIZE: (u32, u32) = (1200, 900);
const INK: Colour = [0x22; 3];
const GRID: Colour = [0xdd, 0xe3, 0xea];
const NOMINAL: Colour = [0x9a, 0xa7, 0xb4];
const BEFORE: Colour = [0xe8, 0x9a, 0x1c];
const AFTER: Colour = [0x0b, 0x53, 0x94];
/// Radius of the circles on the sheet, and of it what the greatest error takes, pixels.
const RADIUS: f64 = 190.0;
const ERROR: f64 = 90.0;
/// Least range that is drawn, mm.
const RANGE_MIN_MM: f64 = 1e-4;

/// The picture of a commissioning.
pub fn sheet(tuned: &Tuned, circle: Circle) -> Sheet {
    let mut sheet = Sheet::new(SIZE);
    let greatest = tuned
        .before
        .contour_mm
        .max(tuned.after.contour_mm)
        .max(RANGE_MIN_MM);
    let axes: String = tuned.axes.iter().collect();
    if tuned.axes.len() == 1 {
        reversals(&mut sheet, tuned, circle, greatest);
        stops(&mut sheet, tuned);
        return sheet;
    }
    let title = format!(
        "circle {axes} of {} mm at {} mm/min, errors magnified {:.0} times",
        circle.radius_mm,
        circle.feed_mm_min,
        ERROR / greatest / (RADIUS / circle.radius_mm)
    );
    sheet.text([20.0, 24.0], Anchor::Left, 18.0, INK, &title);
    for (test, centre, colour, name) in [
        (&tuned.before, [310.0, 310.0], BEFORE, "before"),
        (&tuned.after, [890.0, 310.0], AFTER, "after"),
    ] {
        round(&mut sheet, test, centre, ERROR / greatest, colour);
        let text = format!("{name}: contour error {:.2} µm", test.contour_mm * 1e3);
        sheet.text([centre[0], 590.0], Anchor::Centre, 16.0, INK, &text);
    }
    stops(&mut sheet, tuned);
    sheet
}

/// An axis alone: how far it is from its nominal value on its way to and fro, over time.
fn reversals(sheet: &mut Sheet, tuned: &Tuned, circle: Circle, greatest: f64) {
    let axes: String = tuned.axes.iter().collect();
    let title = format!(
        "{axes} by {} to both sides at {}/min: distance from the nominal value, ±{:.2}/1000",
        circle.radius_mm,
        circle.feed_mm_min,
        greatest * 1e3
    );
    sheet.text([20.0, 24.0], Anchor::Left, 18.0, INK, &title);
    for (test, middle, colour, name) in [
        (&tuned.before, 170.0, BEFORE, "before"),
        (&tuned.after, 450.0, AFTER, "after"),
    ] {
        let (min, max) = ([60.0, middle - 110.0], [1160.0, middle + 110.0]);
        sheet.frame(min, max, NOMINAL);
        sheet.line([min[0], middle], [max[0], middle], 1.0, GRID);
        let end = test.points.last().map_or(1.0, |point| point[0]).max(1e-3);
        let points = test.points.iter().map(|[time, way]| {
            let along = min[0] + (max[0] - min[0]) * time / end;
            [along, middle - 100.0 * way / greatest]
        });
        sheet.lines(points.collect(), 1.5, colour);
        let text = format!("{name}: {:.2}/1000", test.contour_mm * 1e3);
        sheet.text([610.0, middle + 132.0], Anchor::Centre, 16.0, INK, &text);
    }
}

fn round(sheet: &mut Sheet, test: &AxisTest, centre: [f64; 2], scale: f64, colour: Colour) {
    let at = |angle_deg: f64, radius: f64| {
        let (sin, cos) = angle_deg.to_radians().sin_cos();
        [centre[0] + radius * cos, centre[1] - radius * sin]
    };
    let ring = |radius: f64| {
        (0..=180)
            .map(|n| at(2.0 * f64::from(n), radius))
            .collect::<Vec<_>>()
    };
    for part in [-1.0, -0.5, 0.5, 1.0] {
        sheet.lines(ring(RADIUS + part * ERROR * 0.7), 1.0, GRID);
    }
    sheet.lines(ring(RADIUS), 2.0, NOMINAL);
    let points = test
        .points
        .iter()
        .map(|[angle, deviation]| at(*angle, RADIUS + deviation * scale * 0.7));
    sheet.lines(points.collect(), 1.5, colour);
}

/// The way left at a stop after rapid traverse, both in one frame.
fn stops(sheet: &mut Sheet, tuned: &Tuned) {
    let (min, max) = ([60.0, 640.0], [1160.0, 870.0]);
    sheet.frame(min, max, NOMINAL);
    let all = || tuned.before.stop.iter().chain(&tuned.after.stop);
    // The last 20 µm show whether it overshoots.
    let range = 0.02_f64;
    let end = all().map(|point| point[0]).fold(0.1, f64::max);
    let middle = 0.5 * (min[1] + max[1]);
    sheet.line([min[0], middle], [max[0], middle], 1.0, GRID);
    let text = format!(
        "way left at a stop of {}, ±20 µm over {end:.2} s",
        tuned.axes.first().copied().unwrap_or('X')
    );
    sheet.text([min[0], 622.0], Anchor::Left, 14.0, INK, &text);
    for (test, colour) in [(&tuned.before, BEFORE), (&tuned.after, AFTER)] {
        let points = test.stop.iter().map(|[time, way]| {
            let part = (way / range).clamp(-1.0, 1.0);
            [
                min[0] + (max[0] - min[0]) * time / end,
                middle - part * 0.5 * (max[1] - min[1]),
            ]
        });
        sheet.lines(points.collect(), 1.5, colour);
    }
}
