//! Rulers along a drawing, and lengths in words.

use super::scheme::Pens;
use bahn_picture::Image;
use bahn_picture::{Anchor, text_width};

/// A round step (1, 2, 5 times a power of ten) of at least `least`.
pub(super) fn round_step(least: f64) -> f64 {
    let decade = 10f64.powf(least.max(1e-9).log10().floor());
    [1.0, 2.0, 5.0]
        .into_iter()
        .map(|f| f * decade)
        .find(|step| *step >= least)
        .unwrap_or(10.0 * decade)
}

/// A length with the decimals that the step needs, and a true minus sign.
pub(super) fn number(value: f64, step: f64) -> String {
    let decimals = (-step.log10().floor()).clamp(0.0, 4.0) as usize;
    let text = format!("{:.decimals$}", value.abs());
    let is_zero = text.chars().all(|c| c == '0' || c == '.');
    match (is_zero, value < 0.0) {
        (true, _) => "0".to_owned(),
        (false, true) => format!("−{text}"),
        (false, false) => text,
    }
}

/// Width of the numbers that a ruler of some ten marks carries, pixels.
pub(super) fn label_width(low: f64, high: f64, size: f64) -> f64 {
    let step = round_step(0.1 * (high - low));
    text_width(&number(low, step), size).max(text_width(&number(high, step), size))
}

/// A ruler: coordinates `low..high` lie between two pixels of one direction.
pub(super) struct Ruler<'a> {
    pub name: &'a str,
    pub low: f64,
    pub high: f64,
    /// Pixel of `low` and `high`.
    pub from: f64,
    pub to: f64,
    /// Pixel of the line in the other direction.
    pub line: f64,
    pub text_size: f64,
    pub pens: Pens,
}

impl Ruler<'_> {
    fn step(&self, room: f64) -> f64 {
        let per_pixel = (self.high - self.low) / (self.to - self.from).abs().max(1.0);
        round_step(room * per_pixel)
    }

    fn marks(&self, step: f64) -> impl Iterator<Item = (f64, f64)> {
        let first = (self.low / step - 1e-9).ceil();
        let last = (self.high / step + 1e-9).floor();
        let count = if last >= first {
            (last - first) as u32 + 1
        } else {
            0
        };
        let (low, high, from, to) = (self.low, self.high, self.from, self.to);
        (0..count).map(move |k| {
            let value = (first + f64::from(k)) * step;
            (value, from + (to - from) * (value - low) / (high - low))
        })
    }

    /// Draws the ruler below a drawing.
    pub fn below(&self, image: &mut Image) {
        let size = self.text_size;
        // Smaller steps have more decimals.
        let widest = |step: f64| {
            text_width(&number(self.low, step), size).max(text_width(&number(self.high, step), size))
        };
        let rough = self.step(widest(1.0) + 2.0 * size);
        let step = self.step(widest(rough) + size).max(rough);
        let end = self.from.max(self.to);
        let mut name = end + 0.6 * size;
        for (value, x) in self.marks(step) {
            let text = number(value, step);
            name = name.max(x + 0.5 * text_width(&text, size) + 0.5 * size);
            image.line([x, self.line], [x, self.line + 0.4 * size], 1.0, self.pens.faint);
            image.text(
                [x, self.line + 1.15 * size],
                Anchor::Centre,
                size,
                self.pens.ink,
                &text,
            );
        }
        image.text(
            [name, self.line + 1.15 * size],
            Anchor::Left,
            1.15 * size,
            self.pens.ink,
            self.name,
        );
    }

    /// Draws the ruler on the left of a drawing.
    pub fn left(&self, image: &mut Image) {
        let size = self.text_size;
        let step = self.step(2.5 * size);
        let widest = self
            .marks(step)
            .map(|(value, _)| text_width(&number(value, step), size))
            .fold(1.0, f64::max);
        // Long numbers are written smaller, so that they stay on the page.
        let room = self.line - 0.9 * size;
        let text_size = size * (room / widest).min(1.0);
        for (value, y) in self.marks(step) {
            image.line([self.line - 0.4 * size, y], [self.line, y], 1.0, self.pens.faint);
            image.text(
                [self.line - 0.7 * size, y],
                Anchor::Right,
                text_size,
                self.pens.ink,
                &number(value, step),
            );
        }
        let end = self.from.min(self.to) - 1.1 * size;
        image.text(
            [self.line - 0.7 * size, end],
            Anchor::Right,
            1.15 * size,
            self.pens.ink,
            self.name,
        );
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn steps_are_round() {
        assert_eq!(round_step(0.7), 1.0);
        assert_eq!(round_step(13.0), 20.0);
        assert_eq!(round_step(50.0), 50.0);
        assert_eq!(number(-0.0, 1.0), "0");
        assert_eq!(number(2.5, 0.5), "2.5");
        assert_eq!(number(-40.0, 20.0), "−40");
    }
}
