//! 3D view: the part as it would lie on the table.

use rayon::prelude::*;

use super::plan::fit;
use super::raycast::{Caster, Vector};
use super::scale::{number, round_step};
use super::shade::{SAMPLES, Seen, Shader, cross, dot, screen, to_linear, unit};
use super::{Area, INK, Page};
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
}

impl Default for View3d {
    fn default() -> Self {
        View3d {
            azimuth_deg: 30.0,
            elevation_deg: 38.0,
            height_factor: 1.0,
        }
    }
}

impl Part {
    /// The part in parallel projection, shaded, from any angle. The skin of the blank and the machined
    /// surfaces have different colours.
    pub fn view_3d(&self, page: &Page, options: &View3d) -> Image {
        let (mut image, area) = page.start(BACKGROUND_TOP);
        let size = page.text_size();
        let camera = Camera::new(
            self,
            options,
            &area.shrunk(2.5 * size, 2.5 * size, 2.5 * size, 4.5 * size),
        );
        self.render(&mut image, &area, &camera, page);
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

    fn render(&self, image: &mut Image, area: &Area, camera: &Camera, page: &Page) {
        let caster = Caster::new(self);
        let shader = Shader {
            caster: &caster,
            lamp: camera.lamp(),
            to_eye: camera.forward.map(|v| -v),
            height_factor: camera.height_factor,
        };
        let first = area.min[1] as usize;
        let count = area.size()[1];
        let width = image.width() as usize;
        let mut edges = vec![0.0f32; width * image.height() as usize];
        let rows = image
            .rows_mut()
            .zip(edges.chunks_exact_mut(width))
            .skip(first)
            .enumerate();
        rows.par_bridge().for_each(|(row, (pixels, edges))| {
            if page.is_stopped() {
                return;
            }
            let background = mix(BACKGROUND_TOP, BACKGROUND_BOTTOM, row as f64 / count);
            for (x, (pixel, edge)) in pixels.iter_mut().zip(edges).enumerate() {
                (*pixel, *edge) = pixel_at(camera, &shader, [x, row + first], background);
            }
        });
        draw_edges(image, &edges);
    }
}

/// Colour of a pixel, and how much of an edge goes through it.
fn pixel_at(camera: &Camera, shader: &Shader, [x, y]: [usize; 2], background: Colour) -> (Colour, f32) {
    let mut seen = [None; SAMPLES * SAMPLES];
    for (k, seen) in seen.iter_mut().enumerate() {
        let offset = |k: usize| (k as f64 + 0.5) / SAMPLES as f64;
        let (u, v) = (offset(k % SAMPLES), offset(k / SAMPLES));
        let (origin, direction) = camera.ray(x as f64 + u, y as f64 + v);
        *seen = shader.caster.cast(origin, direction).map(|hit| {
            let point = [0, 1, 2].map(|k| origin[k] + direction[k] * hit.t);
            shader.light(point, &hit, k)
        });
    }
    if seen.iter().all(Option::is_none) {
        return (background, 0.0);
    }
    let behind = to_linear(background);
    let mut sum = [0.0; 3];
    for light in seen.iter().map(|seen| seen.map_or(behind, |seen| seen.light)) {
        for (sum, light) in sum.iter_mut().zip(light) {
            *sum += light;
        }
    }
    let colour = screen(sum.map(|value| value / (SAMPLES * SAMPLES) as f64));
    (colour, edge(&seen, camera) as f32)
}

/// Draws the edges as lines, softened over the neighbouring pixels.
fn draw_edges(image: &mut Image, edges: &[f32]) {
    /// Darkness of the lines.
    const DARKNESS: f64 = 0.4;
    let width = image.width() as usize;
    for (y, row) in image.rows_mut().enumerate() {
        for (x, pixel) in row.iter_mut().enumerate() {
            let at = y * width + x;
            let value = |index: Option<usize>| index.and_then(|k| edges.get(k)).copied().unwrap_or(0.0);
            let around = value(at.checked_sub(1))
                + value(Some(at + 1))
                + value(at.checked_sub(width))
                + value(Some(at + width));
            let line = f64::from(0.5 * value(Some(at)) + 0.25 * around).min(1.0);
            if line > 0.0 {
                *pixel = mix(*pixel, EDGE, DARKNESS * line);
            }
        }
    }
}

/// How much of an edge goes through a pixel, 0..1: its rays meet surfaces of other directions or far
/// behind each other. Most where they are shared half and half.
fn edge(seen: &[Option<Seen>; SAMPLES * SAMPLES], camera: &Camera) -> f64 {
    /// Cosine of the angle from which on surfaces meet in an edge.
    const BEND: f64 = 0.8;
    let like = |a: &Seen, b: &Seen| {
        let slant = dot(a.normal, camera.forward).abs().max(0.05);
        dot(a.normal, b.normal) > BEND && (a.t - b.t).abs() < 5.0 * camera.mm / slant
    };
    let first = seen.iter().flatten().next();
    let same = seen
        .iter()
        .flatten()
        .filter(|other| first.is_some_and(|first| like(first, other)))
        .count();
    let share = same as f64 / seen.len() as f64;
    (2.5 * share.min(1.0 - share)).min(1.0)
}

/// Parallel projection onto the picture.
struct Camera {
    right: Vector,
    up: Vector,
    forward: Vector,
    height_factor: f64,
    /// Middle of the blank, heights exaggerated.
    target: Vector,
    /// Pixel of the target.
    centre: [f64; 2],
    /// Millimetres of a pixel.
    mm: f64,
}

impl Camera {
    fn new(part: &Part, options: &View3d, area: &Area) -> Camera {
        let finite = |value: f64, otherwise: f64| if value.is_finite() { value } else { otherwise };
        let (sin_a, cos_a) = finite(options.azimuth_deg, 0.0).to_radians().sin_cos();
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
        let far = 4.0 * self.target.iter().sum::<f64>();
        let mut origin =
            [0, 1, 2].map(|k| self.target[k] + u * self.right[k] + v * self.up[k] - far * self.forward[k]);
        origin[2] /= self.height_factor;
        let mut direction = self.forward;
        direction[2] /= self.height_factor;
        (origin, direction)
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

const EDGE: Colour = [30, 34, 42];
const BACKGROUND_TOP: Colour = [246, 248, 250];
const BACKGROUND_BOTTOM: Colour = [214, 221, 229];
