//! The page of a picture: its size, title and frame.

use std::sync::Arc;
use std::sync::atomic::{AtomicBool, Ordering};

use bahn_picture::{Anchor, Colour, Image};
use thiserror::Error;

use super::scheme::{Pens, Scheme};

/// The sheet that a view is drawn on: its size and what its title line says.
#[derive(Clone, Debug)]
pub struct Page {
    pub(super) width: u32,
    pub(super) height: u32,
    pub(super) title: String,
    pub(super) note: String,
    pub(super) is_bare: bool,
    pub(super) scheme: Option<Scheme>,
    pub(super) stop: Arc<AtomicBool>,
}

/// A page that cannot be drawn.
#[derive(Clone, Copy, Debug, Error, PartialEq, Eq)]
#[error("a picture has from {min} x {min} to {max} x {max} pixels", min = Page::MIN_SIDE, max = Page::MAX_SIDE)]
pub struct PageError;

impl Page {
    /// Shortest side of a picture, pixels.
    pub const MIN_SIDE: u32 = 200;
    /// Longest side of a picture, pixels.
    pub const MAX_SIDE: u32 = 8000;

    /// A page of a size in pixels. The title line shows `title` on the left, usually the name of the
    /// program, and `note` on the right.
    ///
    /// # Errors
    /// When a side is shorter than [`Page::MIN_SIDE`] or longer than [`Page::MAX_SIDE`].
    pub fn new(width: u32, height: u32, title: &str, note: &str) -> Result<Page, PageError> {
        let sides = Page::MIN_SIDE..=Page::MAX_SIDE;
        if !(sides.contains(&width) && sides.contains(&height)) {
            return Err(PageError);
        }
        Ok(Page {
            width,
            height,
            title: title.to_owned(),
            note: note.to_owned(),
            is_bare: false,
            scheme: None,
            stop: Arc::default(),
        })
    }

    /// A page of 1000 x 800 pixels.
    pub fn standard(title: &str, note: &str) -> Page {
        Page {
            width: 1000,
            height: 800,
            title: title.to_owned(),
            note: note.to_owned(),
            is_bare: false,
            scheme: None,
            stop: Arc::default(),
        }
    }

    /// The same page without a title line.
    pub fn without_title(mut self) -> Page {
        self.is_bare = true;
        self
    }

    /// The same page in other colours than our own.
    pub fn in_colours(mut self, scheme: Scheme) -> Page {
        self.scheme = Some(scheme);
        self
    }

    /// What lines and words are drawn with.
    pub(super) fn pens(&self) -> Pens {
        Pens::of(self.scheme)
    }

    /// The same page; what is drawn on it is given up, and is no picture, once the flag is set.
    pub fn stopped_by(mut self, stop: Arc<AtomicBool>) -> Page {
        self.stop = stop;
        self
    }

    /// Whether the picture is given up.
    pub(super) fn is_stopped(&self) -> bool {
        self.stop.load(Ordering::Relaxed)
    }

    /// Size of ordinary text, pixels: it grows with the page.
    pub(super) fn text_size(&self) -> f64 {
        (f64::from(self.width.min(self.height)) / 50.0).clamp(9.0, 60.0)
    }

    /// Width of thin lines, pixels.
    pub(super) fn line_width(&self) -> f64 {
        (self.text_size() / 13.0).max(1.0)
    }

    /// Draws the title line; returns the picture and the free rectangle below the line.
    pub(super) fn start(&self, background: Colour) -> (Image, Area) {
        let background = self.scheme.map_or(background, |own| own.background);
        let mut image = Image::new(self.width, self.height, background);
        let whole = Area {
            min: [0.0, 0.0],
            max: [f64::from(self.width), f64::from(self.height)],
        };
        if self.is_bare {
            return (image, whole);
        }
        let size = self.text_size();
        let width = f64::from(self.width);
        let bar = (2.4 * size).round();
        let own = self.scheme.map(|own| own.title);
        let [background, words, values] = own.unwrap_or([TITLE_BACKGROUND, TITLE_TEXT, TITLE_NOTE]);
        image.rectangle([0.0, 0.0], [width, bar], background);
        let inner = width - 2.0 * size;
        let note = Image::fitting(&self.note, size, 0.6 * inner);
        let note_width = bahn_picture::text_width(&note, size);
        let title = Image::fitting(&self.title, 1.15 * size, inner - note_width - size);
        image.text([size, 0.5 * bar], Anchor::Left, 1.15 * size, words, &title);
        image.text([width - size, 0.5 * bar], Anchor::Right, size, values, &note);
        let below = Area {
            min: [0.0, bar],
            ..whole
        };
        (image, below)
    }
}

/// A rectangle of the picture, pixels.
#[derive(Clone, Copy, Debug)]
pub(super) struct Area {
    pub(super) min: [f64; 2],
    pub(super) max: [f64; 2],
}

impl Area {
    pub(super) fn shrunk(&self, left: f64, top: f64, right: f64, bottom: f64) -> Area {
        let min = [self.min[0] + left, self.min[1] + top];
        let max = [
            (self.max[0] - right).max(min[0] + 1.0),
            (self.max[1] - bottom).max(min[1] + 1.0),
        ];
        Area { min, max }
    }

    pub(super) fn size(&self) -> [f64; 2] {
        [self.max[0] - self.min[0], self.max[1] - self.min[1]]
    }

    pub(super) fn centre(&self) -> [f64; 2] {
        [
            0.5 * (self.min[0] + self.max[0]),
            0.5 * (self.min[1] + self.max[1]),
        ]
    }
}

pub(super) const TITLE_BACKGROUND: Colour = [38, 50, 66];

pub(super) const TITLE_TEXT: Colour = [255, 255, 255];

pub(super) const TITLE_NOTE: Colour = [190, 205, 222];

/// The largest rectangle with the proportions of `size` in an area, in its middle.
pub(super) fn fit(size: [f64; 2], area: &Area) -> Area {
    let room = area.size();
    let scale = (room[0] / size[0]).min(room[1] / size[1]);
    let centre = area.centre();
    let half = [0.5 * scale * size[0], 0.5 * scale * size[1]];
    // Whole pixels keep the frame crisp.
    let min = [(centre[0] - half[0]).round(), (centre[1] - half[1]).round()];
    Area {
        min,
        max: [(min[0] + 2.0 * half[0]).round(), (min[1] + 2.0 * half[1]).round()],
    }
}
