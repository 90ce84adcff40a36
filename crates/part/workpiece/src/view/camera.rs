//! From where the part is seen.

use bahn_picture::{Anchor, Colour, Image};

use super::colouring::Colouring;
use super::light::{cross, dot, unit};
use super::raycast::Vector;
use super::scale::{number, round_step};
use super::{Area, fit};
use crate::part::Part;

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
    /// The tool path is drawn over the part; nothing unless
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

/// Parallel projection onto the picture.
pub(super) struct Camera {
    right: Vector,
    up: Vector,
    pub forward: Vector,
    pub height_factor: f64,
    /// Middle of the blank, heights exaggerated.
    target: Vector,
    /// Pixel of the target.
    centre: [f64; 2],
    /// Millimetres of a pixel.
    pub mm: f64,
}

impl Camera {
    pub fn new(part: &Part, options: &View3d, area: &Area) -> Camera {
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
    pub fn ray(&self, x: f64, y: f64) -> (Vector, Vector) {
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
    pub fn lamp(&self) -> Vector {
        let over = if self.forward[2] > 0.0 { -0.75 } else { 0.75 };
        let [r, u, f] = [self.right, self.up, self.forward];
        unit([0, 1, 2].map(|k| -0.62 * r[k] + 0.3 * u[k] - 0.35 * f[k] + [0.0, 0.0, over][k]))
    }

    /// The directions of the axes.
    pub fn triad(&self, image: &mut Image, part: &Part, at: [f64; 2], size: f64) {
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

    pub fn scale_bar(&self, image: &mut Image, at: [f64; 2], size: f64, ink: Colour) {
        let length = round_step(4.0 * size * self.mm);
        let pixels = length / self.mm;
        let left = [at[0] - pixels, at[1]];
        image.line(left, at, (size / 8.0).max(1.5), ink);
        for end in [left, at] {
            image.line(
                [end[0], end[1] - 0.3 * size],
                [end[0], end[1] + 0.3 * size],
                (size / 10.0).max(1.0),
                ink,
            );
        }
        let text = format!("{} mm", number(length, length));
        image.text(
            [left[0] + 0.5 * pixels, at[1] - 0.9 * size],
            Anchor::Centre,
            0.9 * size,
            ink,
            &text,
        );
    }
}
