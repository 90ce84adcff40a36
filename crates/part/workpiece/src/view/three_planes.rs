//! Projection in three planes: plan view and two sections.

use super::colouring::{Colouring, Palette};
use super::plan::{draw_plan, draw_tool_path, frame};
use super::scale::{Ruler, label_width, number};
use super::scheme::Pens;
use super::{Area, Page, tool_path};
use crate::part::Part;
use bahn_picture::Anchor;
use bahn_picture::{Image, mix};

/// How the views are arranged (ISO 6433) [003:891-892].
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Projection {
    /// First angle, European (MP7310 bit 0 = 0): plan view below the front view, the view from the
    /// left on its right.
    #[default]
    FirstAngle,
    /// Third angle, American (MP7310 bit 0 = 1): plan view above the front view, the view from the
    /// right on its right.
    ThirdAngle,
}

/// Options of the projection in three planes.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ThreePlanes {
    /// Arrangement of the views.
    pub projection: Projection,
    /// Where the sectional planes lie: coordinate on the first axis of the plane perpendicular to it,
    /// and on the second axis, mm; `None` for the middle of the blank [003:893-895].
    pub sections: [Option<f64>; 2],
    /// Brightness levels of the plan view, as in [`PlanView`](super::PlanView).
    pub levels: u8,
    /// What the colours of the plan view tell.
    pub colouring: Colouring,
    /// The tool path is drawn over all three views; nothing unless
    /// [`Workpiece::remember_path`](crate::Workpiece::remember_path) was called.
    pub tool_path: bool,
}

impl Default for ThreePlanes {
    fn default() -> Self {
        ThreePlanes {
            projection: Projection::default(),
            sections: [None; 2],
            levels: 0,
            colouring: Colouring::Depth,
            tool_path: false,
        }
    }
}

impl Part {
    /// Plan view and two sections as in a technical drawing [003:891-895].
    pub fn three_planes(&self, page: &Page, options: &ThreePlanes) -> Image {
        let (mut image, area) = page.start(page.pens().background);
        let size = page.text_size();
        let palette = Palette::new(self, options.colouring, options.levels, page);
        // The sections tell the depths.
        let legend = palette.legend().filter(|_| options.colouring == Colouring::Tool);
        let beside = legend.as_ref().map_or(0.0, |legend| legend.width(size) + size);
        let sheet = Sheet::new(self, page, options, &area.shrunk(0.0, 0.0, beside, 0.0));
        draw_plan(&mut image, self, &sheet.plan, &palette, page);
        sheet.draw_front(&mut image, page);
        sheet.draw_side(&mut image, page);
        if options.tool_path {
            draw_tool_path(&mut image, self, &sheet.plan, page);
            sheet.draw_tool_paths(&mut image, page);
        }
        if let Some(legend) = legend {
            let room = Area {
                min: [area.max[0] - beside, area.min[1] + size],
                max: [area.max[0], area.max[1] - size],
            };
            legend.draw(&mut image, &room, room.min[1], size, page.pens());
        }
        for drawing in [&sheet.plan, &sheet.front, &sheet.side] {
            frame(&mut image, drawing, page);
        }
        sheet.draw_section_lines(&mut image);
        sheet.draw_rulers(&mut image);
        sheet.draw_corner(&mut image);
        image
    }
}

/// Where everything lies on the page.
struct Sheet<'a> {
    part: &'a Part,
    projection: Projection,
    plan: Area,
    front: Area,
    side: Area,
    /// The free quarter beside the plan view.
    corner: Area,
    /// Sections on the first and second axis, mm from the least corner of the blank.
    sections: [f64; 2],
    text_size: f64,
    line_width: f64,
    pens: Pens,
}

impl<'a> Sheet<'a> {
    fn new(part: &'a Part, page: &Page, options: &ThreePlanes, area: &Area) -> Sheet<'a> {
        let size = page.text_size();
        let gap = (3.6 * size).round();
        // Beyond the last number of a ruler stands the name of its axis.
        let name = 0.5 * label_width(part.min()[1], part.max()[1], size) + 1.6 * size;
        let inner = area.shrunk(4.5 * size, 2.4 * size, name, 3.2 * size);
        let [a, b, c] = part.setup.size;
        let room = inner.size();
        // Symbol and positions need their place beside the plan view, however narrow the part is.
        let corner = [CORNER[0] * size, CORNER[1] * size];
        let scale = ((room[0] - gap) / (a + b))
            .min((room[0] - gap - corner[0]) / a)
            .min((room[1] - gap) / (b + c))
            .min((room[1] - gap - corner[1]) / c)
            .max(1e-9);
        let [w, d, h] = [a, b, c].map(|side| (side * scale).round().max(2.0));
        let (wide, tall) = (d.max(corner[0]), d.max(corner[1]));
        let left = (inner.min[0] + 0.5 * (room[0] - gap - w - wide)).round();
        let top = (inner.min[1] + 0.5 * (room[1] - gap - tall - h)).round();
        let right = left + w + gap;
        let (front_top, plan_top) = match options.projection {
            Projection::FirstAngle => (top, top + h + gap),
            Projection::ThirdAngle => (top + tall + gap, top),
        };
        let place = |x: f64, y: f64, width: f64, height: f64| Area {
            min: [x, y],
            max: [x + width, y + height],
        };
        let section = |k: usize| {
            let middle = 0.5 * part.setup.size[k];
            let wanted = options.sections[k].map_or(middle, |s| s - part.setup.min[k]);
            if wanted.is_finite() {
                wanted.clamp(0.0, part.setup.size[k])
            } else {
                middle
            }
        };
        Sheet {
            part,
            projection: options.projection,
            plan: place(left, plan_top, w, d),
            front: place(left, front_top, w, h),
            side: place(right, front_top, d, h),
            corner: place(right, plan_top, wide, tall),
            sections: [section(0), section(1)],
            text_size: size,
            line_width: page.line_width(),
            pens: page.pens(),
        }
    }

    /// Front view: the section at the second axis, looking along it.
    fn draw_front(&self, image: &mut Image, page: &Page) {
        let grid = &self.part.grid;
        let row = ((self.sections[1] / grid.dy) as usize).min(grid.ny - 1);
        self.draw_section(image, &self.front, page, |share, back| {
            let i = ((share * grid.nx as f64) as usize).min(grid.nx - 1);
            (row + back < grid.ny).then(|| self.part.height(i, row + back))
        });
    }

    /// Side view: the section at the first axis, looking along it from the left (first angle) or
    /// against it from the right (third angle).
    fn draw_side(&self, image: &mut Image, page: &Page) {
        let grid = &self.part.grid;
        let column = ((self.sections[0] / grid.dx) as usize).min(grid.nx - 1);
        let row = |share: f64| ((share * grid.ny as f64) as usize).min(grid.ny - 1);
        match self.projection {
            Projection::FirstAngle => self.draw_section(image, &self.side, page, |share, back| {
                (column + back < grid.nx).then(|| self.part.height(column + back, row(1.0 - share)))
            }),
            Projection::ThirdAngle => self.draw_section(image, &self.side, page, |share, back| {
                column.checked_sub(back).map(|i| self.part.height(i, row(share)))
            }),
        }
    }

    /// Draws a section and what is seen behind it. `height(share, back)` is the height at a share of
    /// the drawing's width, so many columns behind the section.
    fn draw_section(
        &self,
        image: &mut Image,
        drawing: &Area,
        page: &Page,
        height: impl Fn(f64, usize) -> Option<f32>,
    ) {
        let [width, tall] = drawing.size();
        let per_mm = tall / self.part.setup.size[2];
        let depth = self.part.grid.nx.max(self.part.grid.ny) as f64;
        for px in 0..width as usize {
            if page.is_stopped() {
                return;
            }
            let x = drawing.min[0] + px as f64;
            let share = (px as f64 + 0.5) / width;
            let pixel = |height: f32| drawing.max[1] - f64::from(height) * per_mm;
            let Some(cut) = height(share, 0) else { continue };
            self.hatch(image, x, pixel(cut), drawing.max[1]);
            let mut seen = cut;
            for back in 1.. {
                let Some(farther) = height(share, back) else { break };
                if farther > seen {
                    let [near, far] = self.pens.farther;
                    let colour = mix(near, far, (back as f64 / depth).sqrt());
                    image.rectangle([x, pixel(farther)], [x + 1.0, pixel(seen)], colour);
                    seen = farther;
                }
            }
        }
        self.contour(image, drawing, |share| height(share, 0));
    }

    /// The tool path in front and side view, also before and behind the sections.
    fn draw_tool_paths(&self, image: &mut Image, page: &Page) {
        let Some(trail) = &self.part.trail else { return };
        let size = self.part.setup.size;
        let up = |view: &Area, z: f64| view.max[1] - view.size()[1] * z / size[2];
        let front = |[x, _, z]: [f64; 3]| {
            let view = &self.front;
            [view.min[0] + view.size()[0] * x / size[0], up(view, z), 0.0]
        };
        tool_path::draw(image, trail, front, &[], &self.front, page);
        let side = |[_, y, z]: [f64; 3]| {
            let (view, share) = (&self.side, y / size[1]);
            let share = match self.projection {
                Projection::FirstAngle => 1.0 - share,
                Projection::ThirdAngle => share,
            };
            [view.min[0] + view.size()[0] * share, up(view, z), 0.0]
        };
        tool_path::draw(image, trail, side, &[], &self.side, page);
    }

    /// Hatching at 45 degrees of the cut face in one column of pixels.
    fn hatch(&self, image: &mut Image, x: f64, top: f64, bottom: f64) {
        if bottom - top < 0.01 {
            return;
        }
        image.rectangle([x, top], [x + 1.0, bottom], self.pens.cut[0]);
        let pitch = (0.75 * self.text_size).max(6.0);
        for y in top.ceil() as i64..bottom as i64 {
            let phase = (x + y as f64).rem_euclid(pitch);
            let distance = (phase - 0.5 * pitch).abs();
            let share = (0.5 * self.line_width + 0.7 - distance).clamp(0.0, 1.0);
            image.blend(x as i64, y, self.pens.cut[1], 0.8 * share);
        }
    }

    /// The line of the cut surface.
    fn contour(&self, image: &mut Image, drawing: &Area, height: impl Fn(f64) -> Option<f32>) {
        let [width, tall] = drawing.size();
        let per_mm = tall / self.part.setup.size[2];
        let points: Vec<[f64; 2]> = (0..width as usize)
            .flat_map(|px| {
                let top = height((px as f64 + 0.5) / width).unwrap_or(0.0);
                let y = drawing.max[1] - f64::from(top) * per_mm;
                let x = drawing.min[0] + px as f64;
                [[x, y], [x + 1.0, y]]
            })
            .collect();
        image.outline(&points, self.line_width, self.pens.ink);
    }

    fn draw_section_lines(&self, image: &mut Image) {
        let [a, b, _] = self.part.setup.size;
        // Not as far as the numbers of the rulers.
        let over = 0.45 * self.text_size;
        let pattern = [
            1.1 * self.text_size,
            0.35 * self.text_size,
            0.2 * self.text_size,
            0.35 * self.text_size,
        ];
        let plan = &self.plan;
        let x = plan.min[0] + plan.size()[0] * self.sections[0] / a;
        let y = plan.max[1] - plan.size()[1] * self.sections[1] / b;
        let side_x = match self.projection {
            Projection::FirstAngle => self.side.max[0] - self.side.size()[0] * self.sections[1] / b,
            Projection::ThirdAngle => self.side.min[0] + self.side.size()[0] * self.sections[1] / b,
        };
        let upright = |x: f64, area: &Area| ([x, area.min[1] - over], [x, area.max[1] + over]);
        let across = ([plan.min[0] - over, y], [plan.max[0] + over, y]);
        for (from, to) in [
            across,
            upright(x, plan),
            upright(x, &self.front),
            upright(side_x, &self.side),
        ] {
            image.dashed(from, to, &pattern, self.line_width, self.pens.section);
        }
    }

    fn draw_rulers(&self, image: &mut Image) {
        let names = self.part.axes().map(|axis| axis.to_string());
        let (min, max) = (self.part.min(), self.part.max());
        let ruler = |k: usize, from: f64, to: f64, line: f64| Ruler {
            name: &names[k],
            low: min[k],
            high: max[k],
            from,
            to,
            line,
            text_size: 0.9 * self.text_size,
            pens: self.pens,
        };
        let (plan, front, side) = (&self.plan, &self.front, &self.side);
        let [left, right] = self.part.left_and_right();
        let [from, to] = match left < right {
            true => [plan.min[0], plan.max[0]],
            false => [plan.max[0], plan.min[0]],
        };
        let across = Ruler {
            low: left.min(right),
            high: left.max(right),
            ..ruler(0, from, to, plan.max[1].max(front.max[1]))
        };
        across.below(image);
        ruler(1, plan.max[1], plan.min[1], plan.min[0]).left(image);
        ruler(2, front.max[1], front.min[1], front.min[0]).left(image);
        let (low, high) = match self.projection {
            Projection::FirstAngle => (side.max[0], side.min[0]),
            Projection::ThirdAngle => (side.min[0], side.max[0]),
        };
        ruler(1, low, high, side.max[1]).below(image);
    }

    /// Symbol of the projection and positions of the sectional planes.
    fn draw_corner(&self, image: &mut Image) {
        let size = self.text_size;
        let centre = self.corner.centre();
        let [first, second, _] = self.part.axes();
        let [across, up] = [0, 1].map(|k: usize| self.part.setup.min[k] + self.sections[k]);
        let lines = [
            format!("{first} {:>10}", number(self.part.across(across), 0.001)),
            format!("{second} {:>10}", number(up, 0.001)),
        ];
        for (k, line) in lines.iter().enumerate() {
            let y = centre[1] + (1.5 + 1.6 * k as f64) * size;
            image.text(
                [centre[0], y],
                Anchor::Centre,
                1.1 * size,
                self.pens.section,
                line,
            );
        }
        self.draw_symbol(image, [centre[0], centre[1] - 1.5 * size], 1.2 * size);
    }

    /// The truncated cone of ISO 6433: its small end is on the left, and it is seen from there. First
    /// angle draws what is seen from the left on the right, third angle on the left.
    fn draw_symbol(&self, image: &mut Image, at: [f64; 2], size: f64) {
        let side = if self.projection == Projection::FirstAngle {
            -1.0
        } else {
            1.0
        };
        let cone = at[0] + 1.6 * side * size;
        let circles = [at[0] - 1.6 * side * size, at[1]];
        let (small, great) = (0.5 * size, size);
        let corners = [
            [cone - size, at[1] - small],
            [cone + size, at[1] - great],
            [cone + size, at[1] + great],
            [cone - size, at[1] + small],
            [cone - size, at[1] - small],
        ];
        image.outline(&corners, self.line_width, self.pens.ink);
        image.circle(circles, small, self.line_width, self.pens.ink);
        image.circle(circles, great, self.line_width, self.pens.ink);
        let axis = [size * 0.6, size * 0.15, size * 0.1, size * 0.15];
        let (a, b) = ([at[0] - 3.0 * size, at[1]], [at[0] + 3.0 * size, at[1]]);
        image.dashed(a, b, &axis, 0.7 * self.line_width, self.pens.faint);
    }
}

/// Least width and height of the quarter with symbol and positions, in heights of the text.
const CORNER: [f64; 2] = [8.5, 8.0];
