//! Plan view: the part from above.

use super::colouring::{Colouring, Palette};
use super::scale::Ruler;
use super::scheme::Pens;
use super::{Area, Page, fit, tool_path};
use crate::part::Part;
use bahn_picture::{Colour, Image};
use rayon::prelude::*;

/// Options of the plan view.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct PlanView {
    /// Number of brightness levels between the upper face and the deepest point; 0 for a continuous
    /// scale. The control has 7 [003:882-883]. A part with few depths has a level for each.
    pub levels: u8,
    /// What the colours tell.
    pub colouring: Colouring,
    /// The tool path is drawn over the part; nothing unless
    /// [`Workpiece::remember_path`](crate::Workpiece::remember_path) was called.
    pub tool_path: bool,
}

impl Default for PlanView {
    fn default() -> Self {
        PlanView {
            levels: 7,
            colouring: Colouring::Depth,
            tool_path: false,
        }
    }
}

impl Part {
    /// The part seen against the tool axis. Unless colours are wanted otherwise brightness tells the height: the
    /// deeper the contour, the darker the image [003:878-882].
    pub fn plan_view(&self, page: &Page, options: &PlanView) -> Image {
        let pens = page.pens();
        let (mut image, area) = page.start(pens.background);
        let size = page.text_size();
        let palette = Palette::new(self, options.colouring, options.levels, page);
        let legend = palette.legend();
        let beside = 3.0 * size;
        let right = beside + legend.as_ref().map_or(0.0, |legend| legend.width(size) + size);
        let inner = area.shrunk(5.0 * size, 2.5 * size, right, 3.5 * size);
        let drawing = fit([self.setup.size[0], self.setup.size[1]], &inner);
        draw_plan(&mut image, self, &drawing, &palette, page);
        if options.tool_path {
            draw_tool_path(&mut image, self, &drawing, page);
        }
        frame(&mut image, &drawing, page);
        rulers(&mut image, self, &drawing, size, pens);
        let room = Area {
            min: [drawing.max[0] + beside, area.min[1] + 0.9 * size],
            max: [area.max[0], area.max[1] - size],
        };
        if let Some(legend) = legend {
            legend.draw(&mut image, &room, drawing.min[1] - 1.6 * size, size, pens);
        }
        image
    }
}

/// Draws the columns of the part from above, second axis upward.
pub(super) fn draw_plan(image: &mut Image, part: &Part, drawing: &Area, palette: &Palette, page: &Page) {
    let [width, height] = drawing.size().map(|side| side as usize);
    let [left, top] = drawing.min.map(|value| value as usize);
    let rows = image.rows_mut().skip(top).take(height).enumerate();
    rows.par_bridge().for_each(|(py, row)| {
        if page.is_stopped() {
            return;
        }
        let pixels = row.iter_mut().skip(left).take(width);
        for (px, pixel) in pixels.enumerate() {
            *pixel = plan_pixel(part, drawing, palette, [px, py]);
        }
    });
}

/// Colour of a pixel of the plan view, by its place in the drawing.
fn plan_pixel(part: &Part, drawing: &Area, palette: &Palette, [px, py]: [usize; 2]) -> Colour {
    /// Samples along each side of a pixel.
    const SAMPLES: usize = 3;
    let [width, height] = drawing.size();
    let [sx, sy] = [part.setup.size[0] / width, part.setup.size[1] / height];
    let mut sum = [0.0; 3];
    for k in 0..SAMPLES * SAMPLES {
        let offset = |k: usize| (k as f64 + 0.5) / SAMPLES as f64;
        let x = (px as f64 + offset(k % SAMPLES)) * sx;
        let y = part.setup.size[1] - (py as f64 + offset(k / SAMPLES)) * sy;
        let colour = match part.grid.cell_at(x, y) {
            Some((i, j)) => palette.column_colour(i, j, px + py),
            None => palette.background(),
        };
        for (sum, part) in sum.iter_mut().zip(colour) {
            *sum += f64::from(part);
        }
    }
    sum.map(|value| (value / (SAMPLES * SAMPLES) as f64).round() as u8)
}

/// Draws the tool path from above: nothing of the part is over the tool.
pub(super) fn draw_tool_path(image: &mut Image, part: &Part, drawing: &Area, page: &Page) {
    let Some(trail) = &part.trail else { return };
    let ([width, height], size) = (drawing.size(), part.setup.size);
    let project = |[x, y, _]: [f64; 3]| {
        [
            drawing.min[0] + width * x / size[0],
            drawing.max[1] - height * y / size[1],
            0.0,
        ]
    };
    tool_path::draw(image, trail, project, &[], drawing, page);
}

pub(super) fn frame(image: &mut Image, drawing: &Area, page: &Page) {
    let Area {
        min: [left, top],
        max: [right, bottom],
    } = *drawing;
    let corners = [
        [left, top],
        [right, top],
        [right, bottom],
        [left, bottom],
        [left, top],
    ];
    image.outline(&corners, page.line_width(), page.pens().ink);
}

pub(super) fn rulers(image: &mut Image, part: &Part, drawing: &Area, size: f64, pens: Pens) {
    let [first, second, _] = part.axes();
    let (min, max) = (part.min(), part.max());
    let [left, right] = part.left_and_right();
    let [from, to] = match left < right {
        true => [drawing.min[0], drawing.max[0]],
        false => [drawing.max[0], drawing.min[0]],
    };
    Ruler {
        name: &first.to_string(),
        low: left.min(right),
        high: left.max(right),
        from,
        to,
        line: drawing.max[1],
        text_size: size,
        pens,
    }
    .below(image);
    Ruler {
        name: &second.to_string(),
        low: min[1],
        high: max[1],
        from: drawing.max[1],
        to: drawing.min[1],
        line: drawing.min[0],
        text_size: size,
        pens,
    }
    .left(image);
}
