//! What is to be seen of a part, drawn by whoever wants it.

use std::sync::{Arc, Mutex};

use bahn_dialogue::FigurePart;
use bahn_parameters::machining::GraphicsSettings;
use bahn_picture::{Image, ImageError};
use bahn_workpiece::{Page, PageError, Part, PlanView, Projection, Scheme, ThreePlanes, View3d};

use crate::contour::{Lines, lock};
use crate::drawing::{LineColours, Sheet, draw};
use crate::figure;
use crate::part_view::PartView;
use crate::scope::{Curves, ScopeColours};
use crate::stock::Stock;

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

/// A picture that can be drawn on any thread.
pub struct Picture(Kind);

enum Kind {
    /// Of the part as it is when it is drawn.
    Part(PartPicture),
    /// Of the lines of a program that is being written.
    Lines(LinesPicture),
    /// Of a cycle, with the id of the prompt that is open.
    Cycle(u16, Vec<&'static FigurePart>, &'static str),
    /// Of the curves of the oscilloscope.
    Curves(Curves, ScopeColours),
}

struct LinesPicture {
    lines: Arc<Mutex<Lines>>,
    title: String,
    current: Option<u32>,
    magn: u8,
    turned: bool,
    colours: LineColours,
}

struct PartPicture {
    stock: Arc<Stock>,
    program: String,
    time_s: Option<f64>,
    view: PartView,
    sight: Sight,
    projection: Projection,
    /// MP7310 + 2, MP236 + 2: the plane is turned by 90°.
    turned: bool,
    colours: Option<Scheme>,
}

/// Why a picture cannot be drawn.
#[derive(Debug, thiserror::Error)]
pub enum PictureError {
    /// A part has no picture of this size.
    #[error(transparent)]
    Page(#[from] PageError),
    /// It cannot be written.
    #[error(transparent)]
    Image(#[from] ImageError),
    /// Drawings are no smaller.
    #[error("drawings have at least {0} x {1} pixels")]
    TooSmall(u32, u32),
}

/// The smallest drawing, pixels.
const LEAST: (u32, u32) = (160, 120);

impl Picture {
    pub(crate) fn of_part(
        stock: Arc<Stock>,
        program: &str,
        time_s: Option<f64>,
        view: PartView,
        sight: Sight,
        settings: GraphicsSettings,
    ) -> Picture {
        Picture(Kind::Part(PartPicture {
            stock,
            program: program.to_owned(),
            time_s,
            view,
            sight,
            turned: settings.plane_rotated,
            projection: match settings.third_angle {
                true => Projection::ThirdAngle,
                false => Projection::FirstAngle,
            },
            colours: None,
        }))
    }

    /// A part in the colours of the control, where it has some.
    pub(crate) fn in_colours(mut self, colours: Option<Scheme>) -> Picture {
        if let Kind::Part(picture) = &mut self.0 {
            picture.colours = colours;
        }
        self
    }

    pub(crate) fn of_curves(curves: Curves, colours: ScopeColours) -> Picture {
        Picture(Kind::Curves(curves, colours))
    }

    pub(crate) fn of_lines(
        lines: Arc<Mutex<Lines>>,
        title: &str,
        current: Option<u32>,
        magn: u8,
        turned: bool,
        colours: LineColours,
    ) -> Picture {
        Picture(Kind::Lines(LinesPicture {
            lines,
            title: title.to_owned(),
            current,
            magn,
            turned,
            colours,
        }))
    }

    /// The drawing of a cycle; `None` for one that has none.
    pub(crate) fn of_cycle(cycle: u16, asked: &'static str) -> Option<Picture> {
        let parts = bahn_dialogue::figure(cycle)?;
        Some(Picture(Kind::Cycle(cycle, parts, asked)))
    }

    /// The part as it is now; `None` before a BLK FORM was executed, and of a drawing.
    pub fn part(&self) -> Option<Part> {
        match &self.0 {
            Kind::Part(picture) => picture.stock.part(),
            Kind::Lines(_) | Kind::Cycle(..) | Kind::Curves(..) => None,
        }
    }

    /// Draws it as PNG of so many pixels; `None` without a part.
    ///
    /// # Errors
    /// When there is no picture of this size.
    pub fn png(&self, width: u32, height: u32) -> Result<Option<Vec<u8>>, PictureError> {
        let Some(image) = self.image(width, height, true)? else {
            return Ok(None);
        };
        let mut png = Vec::new();
        image.write_png(&mut png)?;
        Ok(Some(png))
    }

    /// The same, a part without its title, as rows of pixels from the top: red, green, blue.
    ///
    /// # Errors
    /// When there is no picture of this size.
    pub fn pixels(&self, width: u32, height: u32) -> Result<Option<Vec<[u8; 3]>>, PictureError> {
        let image = self.image(width, height, false)?;
        Ok(image.map(|image| image.pixels().to_vec()))
    }

    fn image(&self, width: u32, height: u32, titled: bool) -> Result<Option<Image>, PictureError> {
        let size = [width, height];
        match &self.0 {
            Kind::Part(picture) => Ok(picture.draw(size, titled)?),
            _ if width < LEAST.0 || height < LEAST.1 => Err(PictureError::TooSmall(LEAST.0, LEAST.1)),
            Kind::Lines(picture) => Ok(Some(picture.draw(size))),
            Kind::Cycle(cycle, parts, asked) => {
                let title = format!("CYCL DEF {cycle}");
                Ok(Some(figure::draw(parts, asked, size, &title)))
            }
            Kind::Curves(curves, colours) => Ok(Some(curves.draw(width, height, colours))),
        }
    }
}

impl LinesPicture {
    fn draw(&self, size: [u32; 2]) -> Image {
        let lines = lock(&self.lines);
        let sheet = Sheet::of(&lines, size.map(f64::from), f64::from(self.magn), self.turned);
        draw(&lines, &sheet, size, &self.title, self.current, self.colours)
    }
}

impl PartPicture {
    fn draw(&self, [width, height]: [u32; 2], titled: bool) -> Result<Option<Image>, PageError> {
        let title = format!("PGM {}", self.program);
        let mut page = Page::new(width, height, &title, &self.note())?;
        if let Some(colours) = self.colours {
            page = page.in_colours(colours);
        }
        if !titled {
            page = page.without_title();
        }
        let Some(part) = self.stock.part() else {
            return Ok(None);
        };
        // The eye goes round a solid; of the other views the part is turned.
        let turned = self.turned && self.view != PartView::Solid;
        let part = if turned { part.turned() } else { part };
        let part = self.detail(&part).unwrap_or(part);
        let [min, max] = [part.min(), part.max()];
        let side = |k: usize| max[k] - min[k];
        let image = match self.view {
            PartView::Plan => part.plan_view(&page, &PlanView::default()),
            PartView::ThreePlanes => {
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
                part.three_planes(&page, &options)
            }
            PartView::Solid => {
                let height_factor = match self.sight.stretched {
                    true => STRETCHED * side(0).max(side(1)) / side(2),
                    false => 1.0,
                };
                let options = View3d {
                    azimuth_deg: self.sight.azimuth_deg() - if self.turned { 90.0 } else { 0.0 },
                    height_factor,
                    ..View3d::default()
                };
                part.view_3d(&page, &options)
            }
        };
        Ok(Some(image))
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
