//! A picture and what is drawn on it.

use std::io::{BufRead, Seek, Write};
use std::sync::atomic::{AtomicBool, Ordering};

use thiserror::Error;

/// Red, green, blue.
pub type Colour = [u8; 3];

/// A finished picture, 8 bits each of red, green, blue.
#[derive(Clone, Debug)]
pub struct Image {
    width: u32,
    height: u32,
    pixels: Vec<Colour>,
    labels: Vec<Label>,
}

/// A text of a picture and the rectangle that its letters cover.
#[derive(Clone, Debug, PartialEq)]
pub struct Label {
    /// The text that is drawn.
    pub text: String,
    /// Upper left corner, pixels.
    pub min: [f64; 2],
    /// Lower right corner, pixels.
    pub max: [f64; 2],
}

/// Why a picture could not be written or read.
#[derive(Debug, Error)]
pub enum ImageError {
    /// The PNG could not be written.
    #[error("the picture cannot be written: {0}")]
    Writer(#[from] png::EncodingError),
    /// The work was stopped.
    #[error("stopped")]
    Stopped,
    /// What is read is no picture.
    #[error("no picture that can be read: {0}")]
    Reader(#[from] png::DecodingError),
    /// It has more pixels than any picture here.
    #[error("the picture is too large")]
    TooLarge,
}

/// Pixels of a picture that is read at most.
const PIXELS_MAX: u64 = 100_000_000;

/// Pictures are equal when their pixels are.
impl PartialEq for Image {
    fn eq(&self, other: &Image) -> bool {
        (self.width, self.height, &self.pixels) == (other.width, other.height, &other.pixels)
    }
}

impl Eq for Image {}

impl Image {
    /// Width of the image, pixels.
    pub fn width(&self) -> u32 {
        self.width
    }

    /// Height of the image, pixels.
    pub fn height(&self) -> u32 {
        self.height
    }

    /// The pixels in rows from the top, red green blue.
    pub fn pixels(&self) -> &[[u8; 3]] {
        &self.pixels
    }

    /// Writes the picture as PNG.
    ///
    /// # Errors
    /// When the writer fails.
    pub fn write_png(&self, writer: impl Write) -> Result<(), ImageError> {
        self.write_png_until(writer, &AtomicBool::new(false))
    }

    /// As [`Image::write_png`], row by row until `stop` is set.
    ///
    /// # Errors
    /// When the writer fails, and when it was stopped.
    pub fn write_png_until(&self, writer: impl Write, stop: &AtomicBool) -> Result<(), ImageError> {
        let mut encoder = png::Encoder::new(writer, self.width, self.height);
        encoder.set_color(png::ColorType::Rgb);
        encoder.set_depth(png::BitDepth::Eight);
        encoder.set_compression(png::Compression::Balanced);
        let mut png = encoder.write_header()?;
        let mut rows = png.stream_writer()?;
        for row in self.pixels.chunks((self.width as usize).max(1)) {
            if stop.load(Ordering::Relaxed) {
                return Err(ImageError::Stopped);
            }
            rows.write_all(row.as_flattened())
                .map_err(png::EncodingError::from)?;
        }
        rows.finish()?;
        png.finish()?;
        Ok(())
    }

    /// Reads a PNG; what shines through lies on black.
    ///
    /// # Errors
    /// When it is no PNG, or has more than a hundred million pixels.
    pub fn read_png(reader: impl BufRead + Seek) -> Result<Image, ImageError> {
        let mut decoder = png::Decoder::new(reader);
        decoder.set_transformations(png::Transformations::normalize_to_color8());
        let mut reader = decoder.read_info()?;
        let (width, height) = reader.info().size();
        if u64::from(width) * u64::from(height) > PIXELS_MAX {
            return Err(ImageError::TooLarge);
        }
        let mut bytes = vec![0; reader.output_buffer_size().ok_or(ImageError::TooLarge)?];
        let frame = reader.next_frame(&mut bytes)?;
        let samples = frame.color_type.samples();
        let pixels = bytes.chunks_exact(samples).map(|sample| {
            let share = |value: u8, alpha: u8| (u16::from(value) * u16::from(alpha) / 255) as u8;
            match *sample {
                [grey] => [grey; 3],
                [grey, alpha] => [share(grey, alpha); 3],
                [red, green, blue] => [red, green, blue],
                [red, green, blue, alpha] => [red, green, blue].map(|value| share(value, alpha)),
                _ => [0; 3],
            }
        });
        let pixels: Vec<Colour> = pixels.take(width as usize * height as usize).collect();
        Ok(Image {
            width,
            height,
            pixels,
            labels: Vec::new(),
        })
    }

    /// A picture of one colour; sizes in pixels.
    pub fn new(width: u32, height: u32, colour: Colour) -> Image {
        Image {
            width,
            height,
            pixels: vec![colour; width as usize * height as usize],
            labels: Vec::new(),
        }
    }

    /// The texts in the order of their writing, also those that lie beyond the page.
    pub fn labels(&self) -> &[Label] {
        &self.labels
    }

    pub(crate) fn note(&mut self, label: Label) {
        self.labels.push(label);
    }

    /// Rows of pixels, for those who compute them.
    pub fn rows_mut(&mut self) -> std::slice::ChunksExactMut<'_, Colour> {
        self.pixels.chunks_exact_mut((self.width as usize).max(1))
    }

    /// Mixes a colour into a pixel; outside the picture nothing happens.
    pub fn blend(&mut self, x: i64, y: i64, colour: Colour, share: f64) {
        if x < 0 || y < 0 || x >= i64::from(self.width) || y >= i64::from(self.height) {
            return;
        }
        if let Some(pixel) = self.pixels.get_mut(y as usize * self.width as usize + x as usize) {
            *pixel = mix(*pixel, colour, share);
        }
    }

    /// Fills a rectangle; its borders count to fractions of a pixel.
    pub fn rectangle(&mut self, min: [f64; 2], max: [f64; 2], colour: Colour) {
        let cover =
            |pixel: i64, low: f64, high: f64| ((pixel + 1) as f64).min(high) - (pixel as f64).max(low);
        for y in self.span(min[1], max[1], self.height) {
            for x in self.span(min[0], max[0], self.width) {
                let share = cover(x, min[0], max[0]) * cover(y, min[1], max[1]);
                self.blend(x, y, colour, share.clamp(0.0, 1.0));
            }
        }
    }

    /// Draws a straight line with round ends.
    pub fn line(&mut self, a: [f64; 2], b: [f64; 2], width: f64, colour: Colour) {
        let reach = 0.5 * width + 1.0;
        let delta = [b[0] - a[0], b[1] - a[1]];
        let square = delta[0] * delta[0] + delta[1] * delta[1];
        for y in self.span(a[1].min(b[1]) - reach, a[1].max(b[1]) + reach, self.height) {
            for x in self.span(a[0].min(b[0]) - reach, a[0].max(b[0]) + reach, self.width) {
                let p = [x as f64 + 0.5 - a[0], y as f64 + 0.5 - a[1]];
                let along = if square > 0.0 {
                    (p[0] * delta[0] + p[1] * delta[1]) / square
                } else {
                    0.0
                };
                let t = along.clamp(0.0, 1.0);
                let distance = (p[0] - t * delta[0]).hypot(p[1] - t * delta[1]);
                self.blend(x, y, colour, (0.5 * width + 0.5 - distance).clamp(0.0, 1.0));
            }
        }
    }

    /// Draws a line of dashes, as centre lines and section lines are.
    pub fn dashed(&mut self, a: [f64; 2], b: [f64; 2], pattern: &[f64], width: f64, colour: Colour) {
        let length = (b[0] - a[0]).hypot(b[1] - a[1]);
        let at = |s: f64| [0, 1].map(|k| a[k] + (b[k] - a[k]) * (s / length).min(1.0));
        let mut s = 0.0;
        for (index, dash) in pattern.iter().cycle().enumerate() {
            if s >= length || *dash <= 0.0 {
                break;
            }
            if index % 2 == 0 {
                self.line(at(s), at((s + dash).min(length)), width, colour);
            }
            s += dash;
        }
    }

    /// Draws the outline through points.
    pub fn outline(&mut self, points: &[[f64; 2]], width: f64, colour: Colour) {
        for pair in points.windows(2) {
            if let [a, b] = pair {
                self.line(*a, *b, width, colour);
            }
        }
    }

    /// Draws the outline of a circle; centre, radius and width in pixels.
    pub fn circle(&mut self, centre: [f64; 2], radius: f64, width: f64, colour: Colour) {
        let points: Vec<[f64; 2]> = (0..=64)
            .map(|k| {
                let (sin, cos) = (f64::from(k) * std::f64::consts::TAU / 64.0).sin_cos();
                [centre[0] + radius * cos, centre[1] + radius * sin]
            })
            .collect();
        self.outline(&points, width, colour);
    }

    /// Pixels between two coordinates, kept inside the picture.
    fn span(&self, low: f64, high: f64, size: u32) -> std::ops::Range<i64> {
        let bound = |value: f64| value.clamp(0.0, f64::from(size)) as i64;
        bound(low.floor())..bound(high.ceil())
    }
}

/// A colour between two.
pub fn mix(a: Colour, b: Colour, share: f64) -> Colour {
    let mut mixed = [0; 3];
    for ((m, a), b) in mixed.iter_mut().zip(a).zip(b) {
        *m = (f64::from(a) + (f64::from(b) - f64::from(a)) * share).round() as u8;
    }
    mixed
}
