//! The lines of a program that is being written, as a picture.

use bahn_path::Point2;
use bahn_picture::{Anchor, Colour, Image};

use crate::contour::{Kind, Lines};

/// Colours of the interactive graphics: background, contour, subprograms [000:6361-6366].
pub(crate) type LineColours = [Colour; 3];
/// The standard values of MP7363.0 to .2, for a control that has none.
pub(crate) const STANDARD: LineColours = [[0, 0, 0], [255, 255, 255], [0, 255, 0]];
/// The block at the cursor, rapid traverse, and the blank (inferred).
const CURRENT: Colour = [255, 200, 0];
const RAPID: Colour = [110, 110, 130];
const BLANK: Colour = [60, 70, 110];
/// Room around the drawing, pixels.
const MARGIN: f64 = 24.0;
const TITLE: f64 = 16.0;
/// A drawing without extent is shown with so many mm on each side.
const LEAST_MM: f64 = 1.0;

/// Where a point of the plane stands in a picture.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Sheet {
    middle: Point2,
    centre: [f64; 2],
    /// Pixels of a mm.
    scale: f64,
    /// MP7310 + 2: the plane is turned by 90°.
    turned: bool,
}

impl Sheet {
    /// All lines in feed and the blank fill the picture; without them whatever is there.
    pub fn of(lines: &Lines, size: [f64; 2], magn: f64, turned: bool) -> Sheet {
        let turn = |point: Point2| match turned {
            true => [-point[1], point[0]],
            false => point,
        };
        let mut min = [f64::INFINITY; 2];
        let mut max = [f64::NEG_INFINITY; 2];
        let mut add = |point: Point2| {
            let point = turn(point);
            for axis in 0..2 {
                min[axis] = min[axis].min(point[axis]);
                max[axis] = max[axis].max(point[axis]);
            }
        };
        let feeds = lines.strokes.iter().any(|stroke| stroke.kind != Kind::Rapid) || lines.blank.is_some();
        for stroke in lines
            .strokes
            .iter()
            .filter(|stroke| !feeds || stroke.kind != Kind::Rapid)
        {
            add(stroke.from.map(f64::from));
            add(stroke.to.map(f64::from));
        }
        lines.blank.iter().flatten().for_each(|corner| add(*corner));
        if !min[0].is_finite() {
            (min, max) = ([0.0; 2], [0.0; 2]);
        }
        let room = [size[0] - 2.0 * MARGIN, size[1] - 2.0 * MARGIN - TITLE];
        let fit = |axis: usize| room[axis].max(1.0) / (max[axis] - min[axis]).max(2.0 * LEAST_MM);
        Sheet {
            middle: [0.5 * (min[0] + max[0]), 0.5 * (min[1] + max[1])],
            centre: [0.5 * size[0], 0.5 * (size[1] + TITLE)],
            scale: fit(0).min(fit(1)) * magn,
            turned,
        }
    }

    /// The pixel of a point.
    pub fn at(&self, point: Point2) -> [f64; 2] {
        let point = match self.turned {
            true => [-point[1], point[0]],
            false => point,
        };
        [
            self.centre[0] + (point[0] - self.middle[0]) * self.scale,
            self.centre[1] - (point[1] - self.middle[1]) * self.scale,
        ]
    }
}

/// What is drawn one after the other.
#[derive(Clone, Copy)]
enum Layer {
    Rapid,
    Contour,
    Current,
}

/// Draws the lines; those of the current block stand out.
pub(crate) fn draw(
    lines: &Lines,
    sheet: &Sheet,
    size: [u32; 2],
    title: &str,
    current: Option<u32>,
    [background, contour, called]: LineColours,
) -> Image {
    let mut image = Image::new(size[0], size[1], background);
    if let Some([min, max]) = lines.blank {
        let corners = [min, [max[0], min[1]], max, [min[0], max[1]], min];
        let corners = corners.map(|corner| sheet.at(corner));
        image.outline(&corners, 1.0, BLANK);
    }
    // Each layer hides those below it.
    for layer in [Layer::Rapid, Layer::Contour, Layer::Current] {
        for stroke in &lines.strokes {
            let is_current = stroke.block.is_some() && stroke.block == current;
            let (width, colour) = match (layer, stroke.kind) {
                (Layer::Rapid, Kind::Rapid) => (1.0, RAPID),
                (Layer::Contour, Kind::Feed) => (2.0, contour),
                (Layer::Contour, Kind::Called) => (2.0, called),
                (Layer::Current, Kind::Feed) if is_current => (3.0, CURRENT),
                _ => continue,
            };
            let [from, to] = [stroke.from, stroke.to].map(|point| sheet.at(point.map(f64::from)));
            match stroke.kind {
                Kind::Rapid => image.dashed(from, to, &[6.0, 5.0], width, colour),
                _ => image.line(from, to, width, colour),
            }
        }
    }
    image.text([MARGIN, TITLE], Anchor::Left, 13.0, contour, title);
    image
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::contour::Stroke;

    fn stroke(from: [f32; 2], to: [f32; 2], kind: Kind, block: Option<u32>) -> Stroke {
        Stroke {
            from,
            to,
            kind,
            block,
        }
    }

    fn lines() -> Lines {
        Lines {
            blank: Some([[0.0, 0.0], [100.0, 50.0]]),
            strokes: vec![
                stroke([-500.0, 0.0], [10.0, 10.0], Kind::Rapid, Some(1)),
                stroke([10.0, 10.0], [90.0, 10.0], Kind::Feed, Some(2)),
                stroke([90.0, 10.0], [90.0, 40.0], Kind::Feed, Some(3)),
                stroke([90.0, 40.0], [50.0, 40.0], Kind::Called, None),
            ],
            ..Lines::default()
        }
    }

    #[test]
    fn the_plane_fills_the_picture_upright_and_turned() {
        // 100 x 50 mm in 648 x 400 pixels: 600 pixels for 100 mm, 6 pixels for each.
        let sheet = Sheet::of(&lines(), [648.0, 400.0], 1.0, false);
        assert_eq!(sheet.at([0.0, 25.0]), [24.0, 208.0]);
        assert_eq!(sheet.at([100.0, 50.0]), [624.0, 208.0 - 150.0]);
        // Turned by 90 degrees: X points up; 336 pixels for 100 mm.
        let sheet = Sheet::of(&lines(), [648.0, 400.0], 1.0, true);
        let [x, y] = sheet.at([100.0, 25.0]);
        assert!(
            (x - 324.0).abs() < 1e-9 && (y - (208.0 - 168.0)).abs() < 1e-9,
            "{x} {y}"
        );
        // Twice as great about the middle.
        let sheet = Sheet::of(&lines(), [648.0, 400.0], 2.0, false);
        assert_eq!(sheet.at([50.0, 25.0]), [324.0, 208.0]);
        assert_eq!(sheet.at([51.0, 25.0]), [336.0, 208.0]);
    }

    #[test]
    fn each_kind_of_line_has_its_colour() {
        let sheet = Sheet::of(&lines(), [648.0, 400.0], 1.0, false);
        let image = draw(&lines(), &sheet, [648, 400], "PGM 7", Some(3), STANDARD);
        let pixel = |point: Point2| {
            let [x, y] = sheet.at(point);
            image.pixels()[y as usize * 648 + x as usize]
        };
        assert_eq!(pixel([50.0, 10.0]), [255; 3]);
        assert_eq!(pixel([90.0, 25.0]), CURRENT);
        assert_eq!(pixel([70.0, 40.0]), [0, 255, 0]);
        assert_eq!(pixel([30.0, 30.0]), [0; 3]);
    }

    #[test]
    fn a_point_and_nothing_at_all_are_drawn() {
        let point = Lines {
            strokes: vec![stroke([5.0, 5.0], [5.0, 5.0], Kind::Feed, Some(1))],
            ..Lines::default()
        };
        for lines in [Lines::default(), point] {
            let sheet = Sheet::of(&lines, [100.0, 100.0], 1.0, false);
            assert!(sheet.at([5.0, 5.0]).iter().all(|pixel| pixel.is_finite()));
            assert_eq!(draw(&lines, &sheet, [100, 100], "", None, STANDARD).width(), 100);
        }
    }
}
