//! Pictures in a plane: the way of two axes, and the circle test with its deviations magnified.

use bahn_picture::{Anchor, Colour};

use super::circle::CircleTest;
use super::sheet::{Sheet, ticks};
use super::summary::short;
use super::table::Table;

const INK: Colour = [0x22; 3];
const PALE: Colour = [0x55; 3];
const GRID: Colour = [0xdd, 0xe3, 0xea];
const BORDER: Colour = [0x9a, 0xa7, 0xb4];
const NOMINAL: Colour = [0x9a, 0xa7, 0xb4];
const ACTUAL: Colour = [0x0b, 0x53, 0x94];
const OTHER: Colour = [0xe8, 0x9a, 0x1c];

const TOP: f64 = 44.0;
const LEFT: f64 = 90.0;
const BOTTOM: f64 = 60.0;
const RIGHT: f64 = 30.0;
/// Points closer than this, in pixels, are one.
const SAME_PIXEL: f64 = 0.3;

/// The way of two axes with the same scale for both: the nominal path grey, the actual one blue, that of a
/// recording compared with orange. `None` when the recording lacks the signals.
pub fn way(
    table: &Table,
    other: Option<&Table>,
    axes: [&str; 2],
    title: &str,
    size: (u32, u32),
) -> Option<Sheet> {
    let actual = points(table, axes, "actual");
    let nominal = points(table, axes, "nominal");
    let compared = other.and_then(|other| points(other, axes, "actual"));
    let all = [&nominal, &compared, &actual];
    let every = || all.into_iter().flatten().flatten();
    every().next()?;
    let bound =
        |k: usize, pick: fn(f64, f64) -> f64, from: f64| every().map(|point| point[k]).fold(from, pick);
    let min = [0, 1].map(|k| bound(k, f64::min, f64::INFINITY));
    let max = [0, 1].map(|k| bound(k, f64::max, f64::NEG_INFINITY));
    let mut sheet = Sheet::new(size);
    let room = [sheet.width() - LEFT - RIGHT, sheet.height() - TOP - BOTTOM];
    let longest = (0..2).map(|k| (max[k] - min[k]) / room[k]).fold(1e-6, f64::max);
    let scale = 0.94 / longest;
    let middle = [0, 1].map(|k| 0.5 * (min[k] + max[k]));
    let centre = [LEFT + 0.5 * room[0], TOP + 0.5 * room[1]];
    let pixel = |[x, y]: [f64; 2]| {
        [
            centre[0] + (x - middle[0]) * scale,
            centre[1] - (y - middle[1]) * scale,
        ]
    };
    sheet.text([LEFT, 20.0], Anchor::Left, 17.0, [0; 3], title);
    frame(&mut sheet, axes, middle, room, scale, pixel);
    for (samples, colour, width) in [
        (nominal, NOMINAL, 2.4),
        (compared, OTHER, 1.4),
        (actual, ACTUAL, 1.4),
    ] {
        sheet.lines(thinned(samples.into_iter().flatten().map(pixel)), width, colour);
    }
    let note = "grey nominal, blue actual";
    let note = if other.is_some() {
        format!("{note}, orange the recording compared with")
    } else {
        note.to_owned()
    };
    let at = [sheet.width() - RIGHT, 20.0];
    sheet.text(at, Anchor::Right, 13.0, PALE, &note);
    Some(sheet)
}

fn frame(
    sheet: &mut Sheet,
    axes: [&str; 2],
    middle: [f64; 2],
    room: [f64; 2],
    scale: f64,
    pixel: impl Fn([f64; 2]) -> [f64; 2],
) {
    let half = room.map(|room| 0.5 * room / scale);
    let (bottom, right) = (sheet.height() - BOTTOM, sheet.width() - RIGHT);
    for x in ticks(middle[0] - half[0], middle[0] + half[0], 10.0) {
        let at = pixel([x, middle[1]])[0];
        sheet.line([at, TOP], [at, bottom], 1.0, GRID);
        sheet.text([at, bottom + 15.0], Anchor::Centre, 13.0, INK, &short(x));
    }
    for y in ticks(middle[1] - half[1], middle[1] + half[1], 8.0) {
        let at = pixel([middle[0], y])[1];
        sheet.line([LEFT, at], [right, at], 1.0, GRID);
        sheet.text([LEFT - 6.0, at], Anchor::Right, 13.0, INK, &short(y));
    }
    sheet.frame([LEFT, TOP], [right, bottom], BORDER);
    let [x, y] = axes;
    let below = [0.5 * (LEFT + right), bottom + 38.0];
    sheet.text(below, Anchor::Centre, 14.0, INK, &format!("{x}, mm"));
    sheet.text([12.0, TOP + 10.0], Anchor::Left, 14.0, INK, &format!("{y}, mm"));
}

/// The circle test: deviations along the radius, magnified so that `division_mm` of them is one ring.
pub fn circle(test: &CircleTest, division_mm: Option<f64>, title: &str, size: (u32, u32)) -> Sheet {
    /// Rings on either side of the circle.
    const RINGS: f64 = 4.0;
    let greatest = test.outside_mm.max(-test.inside_mm).max(1e-6);
    let division = division_mm.unwrap_or_else(|| round_up(greatest / RINGS));
    let mut sheet = Sheet::new(size);
    let centre = [0.5 * sheet.width(), TOP + 0.5 * (sheet.height() - TOP - 30.0)];
    let outer = 0.5 * (sheet.height() - TOP - 60.0).min(sheet.width() - 300.0);
    let ring = outer / (2.0 * RINGS + 1.0);
    let base = outer - RINGS * ring;
    let at = |radius: f64, angle_deg: f64| {
        let (sin, cos) = angle_deg.to_radians().sin_cos();
        [centre[0] + radius * cos, centre[1] - radius * sin]
    };
    let round = |radius: f64| (0..=180).map(move |n| at(radius, 2.0 * f64::from(n))).collect();
    for step in -4..=4 {
        let radius = base + f64::from(step) * ring;
        let (colour, width) = if step == 0 { (NOMINAL, 2.0) } else { (GRID, 1.0) };
        sheet.lines(round(radius), width, colour);
    }
    let names = test
        .signals
        .each_ref()
        .map(|name| name.trim_end_matches(".actual"));
    for (angle, sign, name) in [
        (0.0, '+', names[0]),
        (90.0, '+', names[1]),
        (180.0, '-', names[0]),
        (270.0, '-', names[1]),
    ] {
        sheet.line(at(0.0, angle), at(outer, angle), 1.0, GRID);
        let label = at(outer + 18.0, angle);
        sheet.text(label, Anchor::Centre, 14.0, INK, &format!("{name}{sign}"));
    }
    // Beyond the sheet a deviation stays at its edge.
    let magnified = |deviation: f64| (base + deviation / division * ring).clamp(0.0, outer + 8.0);
    let samples = test
        .points
        .iter()
        .map(|[angle, deviation]| at(magnified(*deviation), *angle));
    sheet.lines(thinned(samples), 1.6, ACTUAL);
    sheet.text([24.0, 20.0], Anchor::Left, 17.0, [0; 3], title);
    let micrometres = |mm: f64| format!("{} µm", short((mm * 1e4).round() / 10.0));
    let notes = [
        format!("radius {} mm", short(test.radius_mm)),
        format!(
            "centre {} / {}",
            short(test.centre_mm[0]),
            short(test.centre_mm[1])
        ),
        format!("one ring {}", micrometres(division)),
        format!("roundness {}", micrometres(test.roundness_mm)),
        format!(
            "outside {} at {:.0}°",
            micrometres(test.outside_mm),
            test.outside_deg
        ),
        format!(
            "inside {} at {:.0}°",
            micrometres(test.inside_mm),
            test.inside_deg
        ),
        format!("mean {}", micrometres(test.mean_mm)),
    ];
    for (row, note) in notes.iter().enumerate() {
        let at = [24.0, TOP + 16.0 + 20.0 * row as f64];
        sheet.text(at, Anchor::Left, 14.0, INK, note);
    }
    sheet
}

/// The next round number, 1, 2 or 5 and a power of ten.
fn round_up(value: f64) -> f64 {
    let power = 10f64.powf(value.log10().floor());
    let factors = [1.0, 2.0, 5.0].into_iter();
    factors
        .map(|factor| factor * power)
        .find(|round| *round >= value * (1.0 - 1e-9))
        .unwrap_or(10.0 * power)
}

fn points(table: &Table, axes: [&str; 2], kind: &str) -> Option<Vec<[f64; 2]>> {
    let [x, y] = axes.map(|axis| table.trace(&format!("{axis}.{kind}")));
    Some(x?.values.iter().zip(&y?.values).map(|(x, y)| [*x, *y]).collect())
}

/// Without the points that nobody could see.
fn thinned(points: impl Iterator<Item = [f64; 2]>) -> Vec<[f64; 2]> {
    let mut kept: Vec<[f64; 2]> = Vec::new();
    let mut last = None;
    for point in points {
        let far = kept
            .last()
            .is_none_or(|kept: &[f64; 2]| (kept[0] - point[0]).hypot(kept[1] - point[1]) >= SAME_PIXEL);
        if far {
            kept.push(point);
        }
        last = Some(point);
    }
    kept.extend(last);
    kept
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn rings_are_round_numbers() {
        assert_eq!(round_up(0.0011), 0.002);
        assert_eq!(round_up(0.005), 0.005);
        assert!((round_up(0.7) - 1.0).abs() < 1e-12);
    }

    /// The end of a way is drawn even when it is close to the point before.
    #[test]
    fn thinning_keeps_the_ends() {
        let way = (0..1000).map(|n| [f64::from(n) * 0.01, 0.0]);
        let kept = thinned(way);
        assert!(kept.len() < 40);
        assert_eq!((kept[0], kept[kept.len() - 1]), ([0.0, 0.0], [9.99, 0.0]));
    }
}
