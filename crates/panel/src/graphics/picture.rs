//! What is to be seen of a part, drawn by whoever wants it.

use std::sync::Arc;

use bahn_picture::Image;
use bahn_workpiece::{Page, PageError, Part, PlanView, Projection, ThreePlanes, View3d};

use super::stock::Stock;
use crate::screen::GraphicsView;

/// The eye stands so far beside the first of the four directions: two faces are to be seen (inferred) [003:909-919].
const BESIDE_DEG: f64 = 30.0;
/// Heights of a part that is not drawn to scale, as part of its longer side (inferred) [003:923-927].
const STRETCHED: f64 = 0.5;

/// How the operator looks at a part.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Sight {
    /// Quarter turns about the tool axis.
    pub quarter: u8,
    /// Heights are not drawn to scale.
    pub stretched: bool,
    /// Where the sections lie, and the middle of a detail: part of the blank along its first and second axis.
    pub sections: [f64; 2],
    /// How many times greater a detail is drawn.
    pub magn: u8,
}

impl Default for Sight {
    fn default() -> Sight {
        Sight {
            quarter: 0,
            stretched: false,
            sections: [0.5; 2],
            magn: 1,
        }
    }
}

impl Sight {
    /// Where the eye stands about the tool axis.
    pub fn azimuth_deg(&self) -> f64 {
        BESIDE_DEG + 90.0 * f64::from(self.quarter)
    }
}

/// A picture that can be drawn on any thread, of the part as it is then.
pub struct Picture {
    stock: Arc<Stock>,
    program: String,
    time_s: Option<f64>,
    view: GraphicsView,
    sight: Sight,
    projection: Projection,
}

impl Picture {
    pub(super) fn new(
        stock: Arc<Stock>,
        program: &str,
        time_s: Option<f64>,
        view: GraphicsView,
        sight: Sight,
        third_angle: bool,
    ) -> Picture {
        Picture {
            stock,
            program: program.to_owned(),
            time_s,
            view,
            sight,
            projection: match third_angle {
                true => Projection::ThirdAngle,
                false => Projection::FirstAngle,
            },
        }
    }

    /// The part as it is now; `None` before a BLK FORM was executed.
    pub fn part(&self) -> Option<Part> {
        self.stock.part()
    }

    /// Draws it as PNG of so many pixels; `None` without a part.
    ///
    /// # Errors
    /// When there is no picture of this size.
    pub fn png(&self, width: u32, height: u32) -> Result<Option<Vec<u8>>, PageError> {
        let title = format!("PGM {}", self.program);
        let page = Page::new(width, height, &title, &self.note())?;
        let Some(part) = self.part() else { return Ok(None) };
        let mut png = Vec::new();
        // Nothing but memory is written to.
        let written = self.draw(part, &page).write_png(&mut png);
        Ok(written.is_ok().then_some(png))
    }

    /// The same without a title, as rows of pixels from the top: red, green, blue.
    ///
    /// # Errors
    /// When there is no picture of this size.
    pub fn pixels(&self, width: u32, height: u32) -> Result<Option<Vec<[u8; 3]>>, PageError> {
        let page = Page::new(width, height, "", "")?.without_title();
        let drawn = self.part().map(|part| self.draw(part, &page));
        Ok(drawn.map(|image| image.pixels().to_vec()))
    }

    fn draw(&self, part: Part, page: &Page) -> Image {
        let part = self.detail(&part).unwrap_or(part);
        let [min, max] = [part.min(), part.max()];
        let side = |k: usize| max[k] - min[k];
        match self.view {
            GraphicsView::Plan => part.plan_view(page, &PlanView::default()),
            GraphicsView::ThreePlanes => {
                // A detail has its sections in its middle.
                let at = |k: usize| match self.sight.magn {
                    1 => Some(min[k] + self.sight.sections[k] * side(k)),
                    _ => None,
                };
                let options = ThreePlanes {
                    projection: self.projection,
                    sections: [at(0), at(1)],
                    ..ThreePlanes::default()
                };
                part.three_planes(page, &options)
            }
            GraphicsView::Solid => {
                let height_factor = match self.sight.stretched {
                    true => STRETCHED * side(0).max(side(1)) / side(2),
                    false => 1.0,
                };
                let options = View3d {
                    azimuth_deg: self.sight.azimuth_deg(),
                    height_factor,
                    ..View3d::default()
                };
                part.view_3d(page, &options)
            }
        }
    }

    /// Machining time and MAGN, as they stand in the title.
    fn note(&self) -> String {
        let time = self.time_s.map(|time_s| {
            let s = time_s.round() as u64;
            format!("{}:{:02}:{:02}", s / 3600, s / 60 % 60, s % 60)
        });
        let magn = (self.sight.magn > 1).then(|| format!("MAGN {}", self.sight.magn));
        let parts: Vec<_> = magn.into_iter().chain(time).collect();
        parts.join("  ")
    }

    /// The detail that MAGN shows, about the place of the sections.
    fn detail(&self, part: &Part) -> Option<Part> {
        if self.sight.magn <= 1 {
            return None;
        }
        let [min, max] = [part.min(), part.max()];
        let from_to = |k: usize| {
            let side = max[k] - min[k];
            let shown = side / f64::from(self.sight.magn);
            let from = (self.sight.sections[k] * side - 0.5 * shown).clamp(0.0, side - shown);
            (min[k] + from, min[k] + from + shown)
        };
        let (first, second) = (from_to(0), from_to(1));
        part.detail([first.0, second.0], [first.1, second.1])
    }
}
