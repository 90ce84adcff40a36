//! A sheet of shapes, written as SVG or as PNG.

use std::fmt::Write;
use std::io::Write as _;
use std::path::{Path, PathBuf};

use bahn_host::files::{self, NewFile};
use bahn_picture::{Anchor, Colour, Image};

use crate::ReportError;

/// Half the height of capitals, as a share of the size of a text.
const HALF_CAPITALS: f64 = 0.31;

/// What is drawn. Places are pixels from the upper left corner.
enum Shape {
    Area {
        min: [f64; 2],
        max: [f64; 2],
        colour: Colour,
    },
    Frame {
        min: [f64; 2],
        max: [f64; 2],
        colour: Colour,
    },
    Lines {
        points: Vec<[f64; 2]>,
        width: f64,
        colour: Colour,
        dashed: bool,
    },
    Text {
        at: [f64; 2],
        anchor: Anchor,
        size: f64,
        colour: Colour,
        text: String,
    },
}

/// Shapes in the order in which they are drawn, on white.
pub struct Sheet {
    width: u32,
    height: u32,
    shapes: Vec<Shape>,
}

impl Sheet {
    /// An empty sheet of this width and height, pixels.
    pub fn new((width, height): (u32, u32)) -> Sheet {
        Sheet {
            width,
            height,
            shapes: Vec::new(),
        }
    }

    /// Width in pixels.
    pub fn width(&self) -> f64 {
        f64::from(self.width)
    }

    /// Height in pixels.
    pub fn height(&self) -> f64 {
        f64::from(self.height)
    }

    /// A filled rectangle.
    /// A filled rectangle between two corners.
    pub fn area(&mut self, min: [f64; 2], max: [f64; 2], colour: Colour) {
        self.shapes.push(Shape::Area { min, max, colour });
    }

    /// The border of a rectangle between two corners.
    pub fn frame(&mut self, min: [f64; 2], max: [f64; 2], colour: Colour) {
        self.shapes.push(Shape::Frame { min, max, colour });
    }

    /// A line from one place to another.
    pub fn line(&mut self, a: [f64; 2], b: [f64; 2], width: f64, colour: Colour) {
        self.lines(vec![a, b], width, colour);
    }

    /// The same as `line`, but dashed.
    pub fn dashed(&mut self, a: [f64; 2], b: [f64; 2], width: f64, colour: Colour) {
        self.shapes.push(Shape::Lines {
            points: vec![a, b],
            width,
            colour,
            dashed: true,
        });
    }

    /// Lines from place to place.
    pub fn lines(&mut self, points: Vec<[f64; 2]>, width: f64, colour: Colour) {
        self.shapes.push(Shape::Lines {
            points,
            width,
            colour,
            dashed: false,
        });
    }

    /// A text whose middle line goes through `at`.
    /// A text at a place, `size` pixels high.
    pub fn text(&mut self, at: [f64; 2], anchor: Anchor, size: f64, colour: Colour, text: &str) {
        let text = text.chars().map(|c| if c.is_control() { ' ' } else { c });
        self.shapes.push(Shape::Text {
            at,
            anchor,
            size,
            colour,
            text: text.collect(),
        });
    }

    /// The sheet as an SVG document.
    pub fn svg(&self) -> String {
        let (width, height) = (self.width, self.height);
        let mut svg = format!(
            "<svg xmlns=\"http://www.w3.org/2000/svg\" width=\"{width}\" height=\"{height}\" viewBox=\"0 0 {width} \
             {height}\" font-family=\"Ubuntu, Helvetica, Arial, sans-serif\">\n\
             <rect width=\"100%\" height=\"100%\" fill=\"white\"/>\n"
        );
        for shape in &self.shapes {
            // Writing to a string cannot fail.
            let _ = shape.svg(&mut svg);
        }
        svg + "</svg>\n"
    }

    /// The sheet as pixels on white.
    pub fn image(&self) -> Image {
        let mut image = Image::new(self.width, self.height, [255; 3]);
        for shape in &self.shapes {
            shape.paint(&mut image);
        }
        image
    }
}

impl Shape {
    fn svg(&self, svg: &mut String) -> std::fmt::Result {
        match self {
            Shape::Area { min, max, colour } => writeln!(
                svg,
                "<rect x=\"{:.1}\" y=\"{:.1}\" width=\"{:.1}\" height=\"{:.1}\" fill=\"{}\"/>",
                min[0],
                min[1],
                max[0] - min[0],
                max[1] - min[1],
                hex(*colour)
            ),
            Shape::Frame { min, max, colour } => writeln!(
                svg,
                "<rect x=\"{:.1}\" y=\"{:.1}\" width=\"{:.1}\" height=\"{:.1}\" fill=\"none\" stroke=\"{}\"/>",
                min[0],
                min[1],
                max[0] - min[0],
                max[1] - min[1],
                hex(*colour)
            ),
            Shape::Lines {
                points,
                width,
                colour,
                dashed,
            } => {
                svg.push_str("<polyline points=\"");
                for (index, [x, y]) in points.iter().enumerate() {
                    let blank = if index == 0 { "" } else { " " };
                    write!(svg, "{blank}{x:.1},{y:.1}")?;
                }
                let dashes = if *dashed { " stroke-dasharray=\"6 4\"" } else { "" };
                writeln!(
                    svg,
                    "\" fill=\"none\" stroke=\"{}\" stroke-width=\"{width}\" stroke-linejoin=\"round\"{dashes}/>",
                    hex(*colour)
                )
            }
            Shape::Text {
                at,
                anchor,
                size,
                colour,
                text,
            } => {
                let anchor = match anchor {
                    Anchor::Left => "start",
                    Anchor::Centre => "middle",
                    Anchor::Right => "end",
                };
                writeln!(
                    svg,
                    "<text x=\"{:.1}\" y=\"{:.1}\" text-anchor=\"{anchor}\" fill=\"{}\" font-size=\"{size}\">{}</text>",
                    at[0],
                    at[1] + HALF_CAPITALS * size,
                    hex(*colour),
                    escaped(text)
                )
            }
        }
    }

    fn paint(&self, image: &mut Image) {
        match self {
            Shape::Area { min, max, colour } => image.rectangle(*min, *max, *colour),
            Shape::Frame { min, max, colour } => {
                let corners = [*min, [max[0], min[1]], *max, [min[0], max[1]], *min];
                image.outline(&corners, 1.0, *colour);
            }
            Shape::Lines {
                points,
                width,
                colour,
                dashed: false,
            } => image.outline(points, *width, *colour),
            Shape::Lines {
                points,
                width,
                colour,
                dashed: true,
            } => {
                for pair in points.windows(2) {
                    if let [a, b] = pair {
                        image.dashed(*a, *b, &[6.0, 4.0], *width, *colour);
                    }
                }
            }
            Shape::Text {
                at,
                anchor,
                size,
                colour,
                text,
            } => image.text(*at, *anchor, *size, *colour, text),
        }
    }
}

fn hex([red, green, blue]: Colour) -> String {
    format!("#{red:02x}{green:02x}{blue:02x}")
}

fn escaped(text: &str) -> String {
    text.replace('&', "&amp;")
        .replace('<', "&lt;")
        .replace('>', "&gt;")
}

/// Round values between two, `count` of them or fewer.
pub fn ticks(from: f64, to: f64, count: f64) -> Vec<f64> {
    let span = (to - from).max(1e-9);
    let rough = span / count.max(1.0);
    let power = 10f64.powf(rough.log10().floor());
    let step = [1.0, 2.0, 5.0, 10.0]
        .into_iter()
        .map(|factor| factor * power)
        .find(|step| *step >= rough)
        .unwrap_or(10.0 * power);
    let first = (from / step).ceil() as i64;
    let last = (to / step).floor() as i64;
    (first..=last.min(first + 100))
        .map(|number| number as f64 * step)
        .collect()
}

/// A drawing by the end of its name.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum Picture {
    /// `.svg`: lines that scale.
    Svg(PathBuf),
    /// `.png`: pixels.
    Png(PathBuf),
}

impl Picture {
    /// That of a file; `None` when its name ends otherwise.
    pub fn of(path: PathBuf) -> Option<Picture> {
        match path.extension()?.to_ascii_lowercase().to_str()? {
            "svg" => Some(Picture::Svg(path)),
            "png" => Some(Picture::Png(path)),
            _ => None,
        }
    }

    /// Where it is written.
    pub fn path(&self) -> &Path {
        let (Picture::Svg(path) | Picture::Png(path)) = self;
        path
    }
}

/// Writes a sheet as its name says.
///
/// # Errors
/// When the file cannot be written.
pub fn write(sheet: &Sheet, picture: &Picture) -> Result<(), ReportError> {
    let path = picture.path();
    let mut bytes = Vec::new();
    match picture {
        Picture::Svg(_) => bytes = sheet.svg().into_bytes(),
        Picture::Png(_) => sheet
            .image()
            .write_png(&mut bytes)
            .map_err(|error| ReportError::new(format!("{}: {error}", path.display())))?,
    }
    let mut file = NewFile::create(path)?;
    file.write_all(&bytes)
        .map_err(|error| files::cannot("write", path, &error))?;
    Ok(file.finish()?)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn ticks_are_round() {
        assert_eq!(ticks(0.0, 10.0, 5.0), [0.0, 2.0, 4.0, 6.0, 8.0, 10.0]);
        assert_eq!(ticks(-0.3, 0.3, 3.0), [-0.2, 0.0, 0.2]);
        assert!(ticks(5.0, 5.0, 4.0).len() < 3);
    }

    /// Both forms show the same: a red line of 3 pixels is red in the middle of its way.
    #[test]
    fn a_sheet_is_svg_and_image() {
        let mut sheet = Sheet::new((100, 50));
        sheet.line([10.0, 25.5], [90.0, 25.5], 3.0, [200, 0, 0]);
        sheet.text([50.0, 10.0], Anchor::Centre, 12.0, [0; 3], "A & B\u{1b}");
        let svg = sheet.svg();
        assert!(svg.contains("points=\"10.0,25.5 90.0,25.5\"") && svg.contains("#c80000"));
        assert!(svg.contains(">A &amp; B </text>"), "{svg}");
        let image = sheet.image();
        assert_eq!(image.pixels()[25 * 100 + 50], [200, 0, 0]);
        assert_eq!(image.pixels()[40 * 100 + 50], [255, 255, 255]);
    }
}
