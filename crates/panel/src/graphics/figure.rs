//! The drawing of a cycle beside its dialogue, in which the word that is asked for stands out.

use bahn_dialogue::{FIGURE_SIZE, FigurePart, Shape};
use bahn_picture::{Anchor, Colour, Image, text_width};

const BACKGROUND: Colour = [0, 0, 0];
const PART: Colour = [200, 205, 215];
const PATH: Colour = [90, 140, 110];
const DIMENSION: Colour = [110, 150, 200];
const ASKED: Colour = [255, 200, 0];
/// Room around the sheet, pixels.
const MARGIN: f64 = 20.0;
const TITLE: f64 = 20.0;
/// Length of an arrow head and lines of a circle.
const HEAD: f64 = 2.2;
const LINES: u32 = 48;

/// Where the sheet lies in a picture.
#[derive(Clone, Copy)]
struct Sheet {
    corner: [f64; 2],
    scale: f64,
}

impl Sheet {
    fn of(size: [f64; 2]) -> Sheet {
        let room = [size[0] - 2.0 * MARGIN, size[1] - 2.0 * MARGIN - TITLE];
        let scale = (room[0] / FIGURE_SIZE[0]).min(room[1] / FIGURE_SIZE[1]).max(0.1);
        let rest = |axis: usize| room[axis] - scale * FIGURE_SIZE[axis];
        Sheet {
            corner: [MARGIN + 0.5 * rest(0), size[1] - MARGIN - 0.5 * rest(1)],
            scale,
        }
    }

    fn at(&self, point: [f64; 2]) -> [f64; 2] {
        [
            self.corner[0] + point[0] * self.scale,
            self.corner[1] - point[1] * self.scale,
        ]
    }
}

/// Draws a cycle; what belongs to the prompt stands out.
pub(super) fn draw(parts: &[&FigurePart], asked: &str, size: [u32; 2], title: &str) -> Image {
    let mut image = Image::new(size[0], size[1], BACKGROUND);
    let sheet = Sheet::of(size.map(f64::from));
    // What is asked for lies above the rest.
    for above in [false, true] {
        for part in parts.iter().filter(|part| part.ids.contains(&asked) == above) {
            self::part(&mut image, &sheet, part, above);
        }
    }
    image.text([MARGIN, TITLE], Anchor::Left, 14.0, PART, title);
    image
}

fn part(image: &mut Image, sheet: &Sheet, part: &FigurePart, asked: bool) {
    let colour = |own: Colour| if asked { ASKED } else { own };
    let width = if asked { 3.0 } else { 1.4 };
    let label_at = match &part.shape {
        Shape::Outline(points) => {
            let points: Vec<_> = points.iter().map(|point| sheet.at(*point)).collect();
            image.outline(&points, 2.0, colour(PART));
            return;
        }
        Shape::Path(points) => {
            for pair in points.windows(2) {
                if let [from, to] = pair {
                    image.dashed(sheet.at(*from), sheet.at(*to), &[7.0, 5.0], 1.2, colour(PATH));
                }
            }
            return;
        }
        Shape::Circle(centre, radius) => {
            arc(image, sheet, *centre, *radius, 1.0, 2.0, colour(PART));
            return;
        }
        Shape::Dimension(from, to) => {
            arrow(image, sheet, *from, *to, width, colour(DIMENSION));
            arrow(image, sheet, *to, *from, width, colour(DIMENSION));
            beside(*from, *to)
        }
        Shape::Arrow(from, to) => {
            arrow(image, sheet, *from, *to, width, colour(DIMENSION));
            beside(*from, *to)
        }
        Shape::Turn(centre, radius) => {
            arc(image, sheet, *centre, *radius, 0.25, width, colour(DIMENSION));
            let end = [centre[0], centre[1] + radius];
            arrow(
                image,
                sheet,
                [end[0] + HEAD, end[1]],
                end,
                width,
                colour(DIMENSION),
            );
            let middle = radius * std::f64::consts::FRAC_1_SQRT_2 + 2.0;
            [centre[0] + middle, centre[1] + middle]
        }
        Shape::Text(at) => [at[0] - 4.0, at[1]],
    };
    let size = if asked { 16.0 } else { 12.0 };
    let [x, y] = sheet.at(label_at);
    // Nothing runs through words.
    let end = x + text_width(part.label, size);
    image.rectangle([x - 1.0, y - 0.5 * size], [end + 1.0, y + 0.5 * size], BACKGROUND);
    image.text([x, y], Anchor::Left, size, colour(DIMENSION), part.label);
}

/// Where the label of a line stands: to the right of its middle, above a level one.
fn beside(from: [f64; 2], to: [f64; 2]) -> [f64; 2] {
    let middle = [0.5 * (from[0] + to[0]), 0.5 * (from[1] + to[1])];
    let level = (to[0] - from[0]).abs() > (to[1] - from[1]).abs();
    match level {
        true => [middle[0] - 2.0, middle[1] + 2.5],
        false => [middle[0] + 1.2, middle[1]],
    }
}

fn arc(
    image: &mut Image,
    sheet: &Sheet,
    centre: [f64; 2],
    radius: f64,
    turn: f64,
    width: f64,
    colour: Colour,
) {
    let at = |line: u32| {
        let angle = std::f64::consts::TAU * turn * f64::from(line) / f64::from(LINES);
        sheet.at([centre[0] + radius * angle.cos(), centre[1] + radius * angle.sin()])
    };
    for line in 0..LINES {
        image.line(at(line), at(line + 1), width, colour);
    }
}

fn arrow(image: &mut Image, sheet: &Sheet, from: [f64; 2], to: [f64; 2], width: f64, colour: Colour) {
    image.line(sheet.at(from), sheet.at(to), width, colour);
    let length = (to[0] - from[0]).hypot(to[1] - from[1]).max(1e-9);
    let along = [(to[0] - from[0]) / length, (to[1] - from[1]) / length];
    for side in [-0.4, 0.4] {
        let back = [along[0] + side * along[1], along[1] - side * along[0]];
        let barb = [to[0] - HEAD * back[0], to[1] - HEAD * back[1]];
        image.line(sheet.at(to), sheet.at(barb), width, colour);
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_word_that_is_asked_for_stands_out() {
        // 500 x 405 pixels: 4.6 pixels for each unit of the sheet. The depth of pecking is at x = 80, y = 10 to 40.
        let parts = bahn_dialogue::figure(1).unwrap();
        let size = [500, 405];
        let sheet = Sheet::of(size.map(f64::from));
        let near = |is: f64, wanted: f64| assert!((is - wanted).abs() < 1e-9, "{is}");
        near(sheet.scale, 4.6);
        near(sheet.corner[0], 20.0);
        near(sheet.corner[1], 385.0);
        let [x, y] = [20 + (80.0 * 4.6) as usize, 385 - (30.0 * 4.6) as usize];
        let pixel = |asked: &str| draw(&parts, asked, size, "").pixels()[y * 500 + x];
        assert_eq!(pixel("cycle 1 DEPTH"), ASKED);
        assert_ne!(pixel("cycle SET UP"), ASKED);
        assert_ne!(pixel("cycle SET UP"), BACKGROUND);
    }
}
