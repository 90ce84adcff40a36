//! Text in pictures.

use ab_glyph::{Font, FontRef, PxScale, ScaleFont, point};

use crate::image::{Colour, Image, Label};

/// Where a text lies from its point.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Anchor {
    /// The text begins at the place.
    Left,
    /// Its middle is there.
    Centre,
    /// The text ends at the place.
    Right,
}

fn font() -> Option<FontRef<'static>> {
    FontRef::try_from_slice(epaint_default_fonts::UBUNTU_LIGHT).ok()
}

/// Width of a text, pixels.
pub fn text_width(text: &str, size: f64) -> f64 {
    let Some(font) = font() else { return 0.0 };
    let scaled = font.as_scaled(PxScale::from(size as f32));
    text.chars()
        .map(|c| f64::from(scaled.h_advance(font.glyph_id(c))))
        .sum()
}

impl Image {
    /// Writes a text of a height in pixels; `at` is on its middle line.
    pub fn text(&mut self, at: [f64; 2], anchor: Anchor, size: f64, colour: Colour, text: &str) {
        let Some(font) = font() else { return };
        let scale = PxScale::from(size as f32);
        let scaled = font.as_scaled(scale);
        let width = text_width(text, size);
        let mut x = match anchor {
            Anchor::Left => at[0],
            Anchor::Centre => at[0] - 0.5 * width,
            Anchor::Right => at[0] - width,
        };
        // Half the height of capitals below the middle line.
        const CAPITALS: f64 = 0.62;
        let base = (at[1] + 0.5 * CAPITALS * size).round();
        self.note(Label {
            text: text.to_owned(),
            min: [x, base - CAPITALS * size],
            max: [x + width, base],
        });
        for c in text.chars() {
            let glyph = font.glyph_id(c);
            let advance = f64::from(scaled.h_advance(glyph));
            let placed = glyph.with_scale_and_position(scale, point(x as f32, base as f32));
            if let Some(outline) = font.outline_glyph(placed) {
                let corner = outline.px_bounds().min;
                outline.draw(|dx, dy, share| {
                    let pixel = [corner.x as i64 + i64::from(dx), corner.y as i64 + i64::from(dy)];
                    // A little more ink makes up for the thin strokes of the typeface.
                    let ink = share.clamp(0.0, 1.0).powf(0.75);
                    self.blend(pixel[0], pixel[1], colour, f64::from(ink));
                });
            }
            x += advance;
        }
    }

    /// The longest beginning of a text that fits a width, with an ellipsis when it had to be cut.
    pub fn fitting(text: &str, size: f64, width: f64) -> String {
        if text_width(text, size) <= width {
            return text.to_owned();
        }
        let mut kept: Vec<char> = text.chars().collect();
        while !kept.is_empty() {
            kept.pop();
            let shortened = kept.iter().collect::<String>() + "…";
            if text_width(&shortened, size) <= width {
                return shortened;
            }
        }
        String::new()
    }
}
