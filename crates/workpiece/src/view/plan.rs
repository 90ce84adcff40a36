//! Plan view: the deeper, the darker.

use super::scale::{Ruler, number, round_step};
use super::{Area, FAINT, INK, Page};
use crate::part::Part;
use bahn_picture::Anchor;
use bahn_picture::{Colour, Image, mix};

/// Options of the plan view.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct PlanView {
    /// Number of brightness levels between the upper face and the deepest point; 0 for a continuous
    /// scale. The control has 7 [003:882-883].
    pub levels: u8,
}

impl Default for PlanView {
    fn default() -> Self {
        PlanView { levels: 7 }
    }
}

impl Part {
    /// The part seen against the tool axis. Brightness tells the height: the deeper the contour, the
    /// darker the image [003:878-882].
    pub fn plan_view(&self, page: &Page, options: &PlanView) -> Image {
        let (mut image, area) = page.start(BACKGROUND);
        let size = page.text_size();
        let inner = area.shrunk(5.0 * size, 2.5 * size, 9.5 * size, 3.5 * size);
        let shade = DepthShade::new(self, options.levels);
        let drawing = fit([self.setup.size[0], self.setup.size[1]], &inner);
        draw_plan(&mut image, self, &drawing, &shade);
        frame(&mut image, &drawing, page);
        rulers(&mut image, self, &drawing, size);
        let legend = Area {
            min: [drawing.max[0] + 2.2 * size, drawing.min[1]],
            max: [
                drawing.max[0] + 3.8 * size,
                (drawing.min[1] + 22.0 * size).min(drawing.max[1]),
            ],
        };
        shade.legend(&mut image, self, &legend, size);
        image
    }
}

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

/// Draws the columns of the part from above, second axis upward.
pub(super) fn draw_plan(image: &mut Image, part: &Part, drawing: &Area, shade: &DepthShade) {
    /// Samples along each side of a pixel.
    const SAMPLES: usize = 3;
    let [width, height] = drawing.size();
    let [sx, sy] = [part.setup.size[0] / width, part.setup.size[1] / height];
    let steps = (SAMPLES * SAMPLES) as f64;
    for py in 0..height as usize {
        for px in 0..width as usize {
            let mut sum = [0.0; 3];
            for k in 0..SAMPLES * SAMPLES {
                let offset = |k: usize| (k as f64 + 0.5) / SAMPLES as f64;
                let x = (px as f64 + offset(k % SAMPLES)) * sx;
                let y = part.setup.size[1] - (py as f64 + offset(k / SAMPLES)) * sy;
                let colour = match part.grid.cell_at(x, y) {
                    Some((i, j)) => shade.at(part, i, j, px + py),
                    None => BACKGROUND,
                };
                for (sum, part) in sum.iter_mut().zip(colour) {
                    *sum += f64::from(part);
                }
            }
            let colour = sum.map(|value| (value / steps).round() as u8);
            image.blend(
                drawing.min[0] as i64 + px as i64,
                drawing.min[1] as i64 + py as i64,
                colour,
                1.0,
            );
        }
    }
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
    image.outline(&corners, page.line_width(), INK);
}

fn rulers(image: &mut Image, part: &Part, drawing: &Area, size: f64) {
    let [first, second, _] = part.axes();
    let (min, max) = (part.min(), part.max());
    Ruler {
        name: &first.to_string(),
        low: min[0],
        high: max[0],
        from: drawing.min[0],
        to: drawing.max[0],
        line: drawing.max[1],
        text_size: size,
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
    }
    .left(image);
}

/// Colours by depth between the upper face and the deepest point that is not cut through (inferred).
pub(super) struct DepthShade {
    /// Heights over the lower face, mm.
    top: f32,
    deepest: f32,
    levels: u8,
}

impl DepthShade {
    pub fn new(part: &Part, levels: u8) -> DepthShade {
        let top = part.top();
        let deepest = part
            .heights
            .iter()
            .copied()
            .filter(|h| *h > 0.0)
            .fold(top, f32::min);
        DepthShade { top, deepest, levels }
    }

    /// Colour of a column; `stripe` counts pixels along a diagonal, for the hatching of holes.
    fn at(&self, part: &Part, i: usize, j: usize, stripe: usize) -> Colour {
        let height = part.height(i, j);
        if height <= 0.0 {
            return if stripe % 8 < 2 {
                THROUGH_STRIPE
            } else {
                BACKGROUND
            };
        }
        let colour = self.colour(height);
        // A line of shadow where a wall stands, so that neighbours of one level do not run together.
        let wall = 6.0 * part.grid.cell() as f32;
        let higher = |i: usize, j: usize| part.height(i, j) > height + wall;
        let edge = higher(i + 1, j)
            || higher(i, j + 1)
            || (i > 0 && higher(i - 1, j))
            || (j > 0 && higher(i, j - 1));
        if edge { mix(colour, INK, 0.4) } else { colour }
    }

    fn colour(&self, height: f32) -> Colour {
        let range = f64::from(self.top - self.deepest);
        let depth = if range > 0.0 {
            f64::from(self.top - height) / range
        } else {
            0.0
        };
        let share = if self.levels == 0 {
            depth
        } else {
            self.level(depth) / f64::from(self.levels.max(2) - 1)
        };
        gradient(share)
    }

    /// The upper face alone is level 0; the rest of the depth is shared among the other levels.
    fn level(&self, depth: f64) -> f64 {
        let rest = f64::from(self.levels.max(2) - 1);
        if depth <= 1e-6 {
            0.0
        } else {
            (depth * rest - 1e-6).ceil().clamp(1.0, rest)
        }
    }

    /// The scale of heights: one field for each level or one for each row of pixels.
    fn legend(&self, image: &mut Image, part: &Part, area: &Area, size: f64) {
        /// Labels of a scale.
        const LABELS: u32 = 7;
        let Area {
            min: [left, top],
            max: [right, bottom],
        } = *area;
        let range = f64::from(self.top - self.deepest);
        let pixels = (bottom - top).max(1.0) as u32;
        let fields = match self.levels {
            _ if range <= 0.0 => 1,
            0 => pixels,
            levels => u32::from(levels.max(2)).min(pixels),
        };
        // Few fields are not taller than on a scale of seven.
        let tall = (bottom - top) / f64::from(fields.max(LABELS));
        let title = format!("{} mm", part.axes()[2]);
        image.text([left, top - 1.2 * size], Anchor::Left, size, INK, &title);
        let digits = round_step(range / 100.0).min(0.1);
        let every = if self.levels == 0 {
            (fields - 1) as f64 / f64::from(LABELS - 1)
        } else {
            f64::from(fields.div_ceil(20))
        };
        let mut next_label = 0.0;
        for k in 0..fields {
            let share = f64::from(k) / f64::from((fields - 1).max(1));
            let y = [f64::from(k), f64::from(k + 1)].map(|k| (top + k * tall).round());
            image.rectangle([left, y[0]], [right, y[1]], gradient(share));
            if f64::from(k) + 0.5 > next_label {
                let text = number(part.max()[2] - range * share, digits);
                let at = [right + 0.6 * size, 0.5 * (y[0] + y[1])];
                image.text(at, Anchor::Left, size, INK, &text);
                next_label += every.max(1.0);
            }
        }
        let end = (top + f64::from(fields) * tall).round();
        image.outline(
            &[[left, top], [right, top], [right, end], [left, end], [left, top]],
            1.0,
            FAINT,
        );
        if part.heights.iter().any(|height| *height <= 0.0) {
            self.legend_of_holes(image, [left, end + 1.2 * size], right - left, size);
        }
    }

    fn legend_of_holes(&self, image: &mut Image, [left, top]: [f64; 2], side: f64, size: f64) {
        for y in 0..side as i64 {
            for x in 0..side as i64 {
                image.blend(left as i64 + x, top as i64 + y, hatched((x + y) as usize), 1.0);
            }
        }
        let (right, bottom) = (left + side, top + side);
        image.outline(
            &[
                [left, top],
                [right, top],
                [right, bottom],
                [left, bottom],
                [left, top],
            ],
            1.0,
            FAINT,
        );
        image.text(
            [right + 0.6 * size, top + 0.5 * side],
            Anchor::Left,
            size,
            INK,
            "through",
        );
    }
}

/// Hatching where nothing is left, by the count of pixels along a diagonal.
fn hatched(stripe: usize) -> Colour {
    if stripe % 8 < 2 {
        THROUGH_STRIPE
    } else {
        BACKGROUND
    }
}

/// From the light skin of the blank to a dark, deep blue: even steps of brightness.
fn gradient(share: f64) -> Colour {
    const STOPS: [Colour; 5] = [
        [236, 239, 242],
        [174, 199, 222],
        [107, 152, 192],
        [52, 99, 145],
        [20, 46, 84],
    ];
    let place = share.clamp(0.0, 1.0) * (STOPS.len() - 1) as f64;
    let k = (place as usize).min(STOPS.len() - 2);
    mix(STOPS[k], STOPS[k + 1], place - k as f64)
}

const BACKGROUND: Colour = [252, 252, 250];
const THROUGH_STRIPE: Colour = [224, 168, 120];

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{Resolution, Workpiece};
    use bahn_path::{Blank, Plane};

    fn brightness(colour: Colour) -> u32 {
        colour.into_iter().map(u32::from).sum()
    }

    /// 7 mm thick; one column each at 7 (untouched), 6.9, 4, 1 and 0 (through).
    fn part() -> Part {
        let blank = Blank {
            plane: Plane::XY,
            min: [0.0; 3],
            max: [5.0, 1.0, 7.0],
        };
        let mut part = Workpiece::new(&blank, Resolution::Millimetres(1.0))
            .unwrap()
            .finished();
        part.heights.copy_from_slice(&[7.0, 6.9, 4.0, 1.0, 0.0]);
        part
    }

    #[test]
    fn deeper_is_darker() {
        for levels in [0, 7] {
            let shade = DepthShade::new(&part(), levels);
            let colours = [7.0, 6.9, 4.0, 1.0].map(|h| brightness(shade.colour(h)));
            assert!(colours.windows(2).all(|pair| pair[0] > pair[1]), "{colours:?}");
        }
    }

    /// The deepest point that is left is 6 mm deep; the upper face alone is the first of 7 levels, so
    /// each of the others holds 1 mm.
    #[test]
    fn seven_levels() {
        let shade = DepthShade::new(&part(), 7);
        let level = |depth: f64| shade.level(depth / 6.0);
        assert_eq!(
            [0.0, 0.1, 1.0, 1.1, 5.5, 6.0].map(level),
            [0.0, 1.0, 1.0, 2.0, 6.0, 6.0]
        );
    }
}
