//! 3D view: the part as it would lie on the table.

use rayon::prelude::*;

use super::colouring::{Colouring, Palette};
use super::edges::{self, Spot};
use super::plan::fit;
use super::raycast::{Caster, Vector};
use super::scale::{number, round_step};
use super::shade::{SAMPLES, Shader, cross, dot, screen, to_linear, unit};
use super::{Area, INK, Page, way};
use crate::part::Part;
use bahn_picture::Anchor;
use bahn_picture::{Colour, Image, mix};

/// Options of the 3D view.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct View3d {
    /// Where the eye stands about the tool axis, degrees: 0 in front (looking along the second axis),
    /// 90 on the right. The control turns in steps of 90 degrees [003:909-919].
    pub azimuth_deg: f64,
    /// How high the eye stands, degrees over the working plane: 90 looks along the tool axis; negative
    /// values look from below.
    pub elevation_deg: f64,
    /// Heights are drawn this much greater: 1 is true to scale [003:923-927].
    pub height_factor: f64,
    /// What the colours tell.
    pub colouring: Colouring,
    /// The way of the tool is drawn over the part; nothing unless
    /// [`Workpiece::remember_path`](crate::Workpiece::remember_path) was called.
    pub tool_path: bool,
}

impl Default for View3d {
    fn default() -> Self {
        View3d {
            azimuth_deg: 30.0,
            elevation_deg: 38.0,
            height_factor: 1.0,
            colouring: Colouring::Part,
            tool_path: false,
        }
    }
}

impl Part {
    /// The part in parallel projection, shaded, from any angle.
    pub fn view_3d(&self, page: &Page, options: &View3d) -> Image {
        let (mut image, area) = page.start(BACKGROUND_TOP);
        let size = page.text_size();
        let palette = Palette::new(self, options.colouring, 0);
        let legend = palette.legend();
        let beside = legend.as_ref().map_or(0.0, |legend| legend.width(size) + size);
        let free = area.shrunk(2.5 * size, 2.5 * size, 2.5 * size + beside, 4.5 * size);
        let camera = Camera::new(self, options, &free);
        let spots = self.render(&mut image, &area, &camera, &palette, page);
        if let (true, Some(trail)) = (options.tool_path, &self.trail) {
            way::draw(
                &mut image,
                trail,
                |point| camera.project(point),
                &spots,
                &area,
                page,
            );
        }
        if let Some(legend) = legend {
            let room = Area {
                min: [area.max[0] - beside, area.min[1] + size],
                max: [area.max[0], area.max[1] - 4.5 * size],
            };
            legend.draw(&mut image, &room, room.min[1], size);
        }
        camera.triad(
            &mut image,
            self,
            [area.min[0] + 4.2 * size, area.max[1] - 4.0 * size],
            size,
        );
        camera.scale_bar(
            &mut image,
            [area.max[0] - 1.5 * size, area.max[1] - 1.4 * size],
            size,
        );
        let [a, b, c] = self.setup.size.map(|side| {
            number(side, 0.01)
                .trim_end_matches('0')
                .trim_end_matches('.')
                .to_owned()
        });
        let middle = [area.centre()[0], area.max[1] - 1.4 * size];
        image.text(middle, Anchor::Centre, size, INK, &format!("{a} × {b} × {c} mm"));
        image
    }

    fn render(
        &self,
        image: &mut Image,
        area: &Area,
        camera: &Camera,
        palette: &Palette,
        page: &Page,
    ) -> Vec<Spot> {
        let caster = Caster::new(self);
        let shader = Shader {
            caster: &caster,
            palette,
            lamp: camera.lamp(),
            to_eye: camera.forward.map(|v| -v),
            height_factor: camera.height_factor,
            pixel_mm: camera.mm,
        };
        let first = area.min[1] as usize;
        let count = area.size()[1];
        let width = image.width() as usize;
        let mut spots = vec![Spot::BACKGROUND; width * image.height() as usize];
        let rows = image
            .rows_mut()
            .zip(spots.chunks_exact_mut(width))
            .skip(first)
            .enumerate();
        rows.par_bridge().for_each(|(row, (pixels, spots))| {
            if page.is_stopped() {
                return;
            }
            let background = mix(BACKGROUND_TOP, BACKGROUND_BOTTOM, row as f64 / count);
            for (x, (pixel, spot)) in pixels.iter_mut().zip(spots).enumerate() {
                (*pixel, *spot) = pixel_at(camera, &shader, [x, row + first], background);
            }
        });
        edges::draw(image, &spots, page);
        spots
    }
}

/// Colour of a pixel, and what its edges are made from.
fn pixel_at(camera: &Camera, shader: &Shader, [x, y]: [usize; 2], background: Colour) -> (Colour, Spot) {
    let mut seen = [None; SAMPLES * SAMPLES];
    for (k, seen) in seen.iter_mut().enumerate() {
        // Nearly to the borders of the pixel: no edge falls between the rays of neighbours.
        let offset = |k: usize| 0.02 + 0.96 * k as f64 / (SAMPLES - 1) as f64;
        let (u, v) = (offset(k % SAMPLES), offset(k / SAMPLES));
        let (origin, direction) = camera.ray(x as f64 + u, y as f64 + v);
        *seen = shader.caster.cast(origin, direction).map(|hit| {
            let point = [0, 1, 2].map(|k| origin[k] + direction[k] * hit.t);
            shader.light(point, &hit, k)
        });
    }
    if seen.iter().all(Option::is_none) {
        return (background, Spot::BACKGROUND);
    }
    let behind = to_linear(background);
    let mut sum = [0.0; 3];
    for light in seen.iter().map(|seen| seen.map_or(behind, |seen| seen.light)) {
        for (sum, light) in sum.iter_mut().zip(light) {
            *sum += light;
        }
    }
    let colour = screen(sum.map(|value| value / (SAMPLES * SAMPLES) as f64));
    (colour, Spot::new(&seen, camera))
}

/// Parallel projection onto the picture.
pub(super) struct Camera {
    right: Vector,
    up: Vector,
    pub forward: Vector,
    height_factor: f64,
    /// Middle of the blank, heights exaggerated.
    target: Vector,
    /// Pixel of the target.
    centre: [f64; 2],
    /// Millimetres of a pixel.
    pub mm: f64,
}

impl Camera {
    fn new(part: &Part, options: &View3d, area: &Area) -> Camera {
        let finite = |value: f64, otherwise: f64| if value.is_finite() { value } else { otherwise };
        // Whole turns go first: so many times around is the same picture to the last pixel.
        let azimuth = finite(options.azimuth_deg, 0.0).rem_euclid(360.0);
        let (sin_a, cos_a) = azimuth.to_radians().sin_cos();
        let (sin_e, cos_e) = finite(options.elevation_deg, 90.0)
            .clamp(-90.0, 90.0)
            .to_radians()
            .sin_cos();
        let height_factor = finite(options.height_factor, 1.0).clamp(0.01, 100.0);
        let right = [cos_a, sin_a, 0.0];
        let forward = [-sin_a * cos_e, cos_a * cos_e, -sin_e];
        let up = cross(right, forward);
        let size = [
            part.setup.size[0],
            part.setup.size[1],
            part.setup.size[2] * height_factor,
        ];
        let extent = |axis: Vector| (0..3).map(|k| axis[k].abs() * size[k]).sum::<f64>();
        let seen = [extent(right), extent(up)];
        let drawing = fit(seen, area);
        let mm = (seen[0] / drawing.size()[0]).max(seen[1] / drawing.size()[1]);
        Camera {
            right,
            up,
            forward,
            height_factor,
            target: size.map(|s| 0.5 * s),
            centre: drawing.centre(),
            mm,
        }
    }

    /// Origin and direction of the ray through a point of the picture, in the true heights of the part.
    fn ray(&self, x: f64, y: f64) -> (Vector, Vector) {
        let u = (x - self.centre[0]) * self.mm;
        let v = (self.centre[1] - y) * self.mm;
        let far = self.far();
        let mut origin =
            [0, 1, 2].map(|k| self.target[k] + u * self.right[k] + v * self.up[k] - far * self.forward[k]);
        origin[2] /= self.height_factor;
        let mut direction = self.forward;
        direction[2] /= self.height_factor;
        (origin, direction)
    }

    /// Distance of the eye from the target, mm.
    fn far(&self) -> f64 {
        4.0 * self.target.iter().sum::<f64>()
    }

    /// Place of a point of the part in the picture, and its distance from the eye; pixels.
    pub fn project(&self, mut point: Vector) -> Vector {
        point[2] *= self.height_factor;
        let from_target = [0, 1, 2].map(|k| point[k] - self.target[k]);
        [
            self.centre[0] + dot(from_target, self.right) / self.mm,
            self.centre[1] - dot(from_target, self.up) / self.mm,
            (dot(from_target, self.forward) + self.far()) / self.mm,
        ]
    }

    /// The lamp stands on the left of the eye, over it as seen in the picture, and over the part on the
    /// side that is looked at.
    fn lamp(&self) -> Vector {
        let over = if self.forward[2] > 0.0 { -0.75 } else { 0.75 };
        let [r, u, f] = [self.right, self.up, self.forward];
        unit([0, 1, 2].map(|k| -0.62 * r[k] + 0.3 * u[k] - 0.35 * f[k] + [0.0, 0.0, over][k]))
    }

    /// The directions of the axes.
    fn triad(&self, image: &mut Image, part: &Part, at: [f64; 2], size: f64) {
        let colours: [Colour; 3] = [[196, 60, 52], [52, 140, 70], [48, 96, 190]];
        let mut axes: Vec<usize> = vec![0, 1, 2];
        // What points away from the eye is drawn first.
        axes.sort_by(|a, b| self.forward[*b].total_cmp(&self.forward[*a]));
        for k in axes {
            let mut axis = [0.0; 3];
            axis[k] = 1.0;
            let tip = [dot(axis, self.right), -dot(axis, self.up)];
            let point = |length: f64| [at[0] + tip[0] * length * size, at[1] + tip[1] * length * size];
            image.line(at, point(2.2), (size / 8.0).max(1.5), colours[k]);
            image.text(
                point(2.9),
                Anchor::Centre,
                size,
                colours[k],
                &part.axes()[k].to_string(),
            );
        }
    }

    fn scale_bar(&self, image: &mut Image, at: [f64; 2], size: f64) {
        let length = round_step(4.0 * size * self.mm);
        let pixels = length / self.mm;
        let left = [at[0] - pixels, at[1]];
        image.line(left, at, (size / 8.0).max(1.5), INK);
        for end in [left, at] {
            image.line(
                [end[0], end[1] - 0.3 * size],
                [end[0], end[1] + 0.3 * size],
                (size / 10.0).max(1.0),
                INK,
            );
        }
        let text = format!("{} mm", number(length, length));
        image.text(
            [left[0] + 0.5 * pixels, at[1] - 0.9 * size],
            Anchor::Centre,
            0.9 * size,
            INK,
            &text,
        );
    }
}

const BACKGROUND_TOP: Colour = [246, 248, 250];
const BACKGROUND_BOTTOM: Colour = [214, 221, 229];

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{Resolution, Workpiece};
    use bahn_path::{Blank, Plane};

    /// 100 x 100 mm in columns of 0.25 mm, 40 mm thick, with a height over the lower face by the place.
    fn part(height: impl Fn(f64, f64) -> f64) -> Part {
        let blank = Blank {
            plane: Plane::XY,
            min: [0.0; 3],
            max: [100.0, 100.0, 40.0],
        };
        let mut part = Workpiece::new(&blank, Resolution::Millimetres(0.25))
            .unwrap()
            .finished();
        let nx = part.grid.nx;
        for (k, cell) in part.heights.iter_mut().enumerate() {
            let place = |n: usize| (n as f64 + 0.5) * 0.25;
            *cell = height(place(k % nx), place(k / nx)) as f32;
        }
        part
    }

    /// A sphere of 60 mm whose top is at 39 mm, over a floor at 10 mm.
    fn sphere(x: f64, y: f64) -> f64 {
        let square = (x - 50.0).powi(2) + (y - 50.0).powi(2);
        ((3600.0_f64 - square).max(0.0).sqrt() - 21.0).max(10.0)
    }

    /// How many of the 90 x 60 pixels in the middle of the picture carry a line.
    fn lines(part: &Part, elevation_deg: f64) -> usize {
        let page = Page::new(300, 240, "", "").unwrap();
        let options = View3d {
            elevation_deg,
            ..View3d::default()
        };
        let (mut image, area) = page.start(BACKGROUND_TOP);
        let camera = Camera::new(part, &options, &area);
        let palette = Palette::new(part, Colouring::Part, 0);
        let spots = part.render(&mut image, &area, &camera, &palette, &page);
        let weights = edges::weights(&spots, 300, &page);
        (105..165)
            .flat_map(|y| (105..195).map(move |x| y * 300 + x))
            .filter(|at| weights[*at] > 0.1)
            .count()
    }

    #[test]
    fn smooth_surfaces_have_no_lines() {
        for elevation_deg in [25.0, 38.0] {
            let found = lines(&part(sphere), elevation_deg);
            assert_eq!(found, 0, "{elevation_deg}");
        }
    }

    /// A sphere left in steps of 0.5 mm, as a flat mill does.
    #[test]
    fn steps_of_a_finishing_cut_are_no_lines() {
        let steps = part(|x, y| (sphere(x, y) * 2.0).floor() / 2.0);
        for elevation_deg in [25.0, 38.0] {
            let found = lines(&steps, elevation_deg);
            assert_eq!(found, 0, "{elevation_deg}");
        }
    }

    /// An edge that runs across the picture without a gap: at least a pixel in each of the columns.
    #[test]
    fn edges_are_lines() {
        let step = part(|_, y| if y > 50.0 { 40.0 } else { 20.0 });
        let found = lines(&step, 38.0);
        assert!(found >= 90, "{found}");
    }
}
