//! Light on the part: normals, ambient occlusion, colours.

use super::colouring::Palette;
use super::light::{cross, dot, is_outline, unit};
use super::raycast::{Caster, Face, Hit, Vector};
use crate::part::Part;

/// Reach of the window that smooths the normals of walls, columns: a round wall on square columns has
/// to look round.
const WALL_WINDOW: i64 = 6;

/// Neighbouring columns belong to one surface when their heights differ by less than this many
/// columns: up to some 76 degrees.
const SLOPE_STEP: f64 = 4.0;

/// Rays along each side of a pixel.
pub(super) const SAMPLES: usize = 3;

/// What a ray brings to the eye.
#[derive(Clone, Copy)]
pub(super) struct Seen {
    /// Linear red, green, blue.
    pub light: [f64; 3],
    pub normal: Vector,
    /// Length of the ray.
    pub t: f64,
}

/// Light and material of a 3D view.
pub(super) struct Shader<'a> {
    pub caster: &'a Caster<'a>,
    pub palette: &'a Palette<'a>,
    /// Direction to the middle of the lamp, a unit vector.
    pub lamp: Vector,
    pub to_eye: Vector,
    /// Exaggeration of heights: light sees the part as the eye does.
    pub height_factor: f64,
    /// Millimetres of a pixel.
    pub pixel_mm: f64,
    /// Perpendicular to this axis stand the faces that are seen from the front.
    pub front: usize,
}

impl Shader<'_> {
    /// What the eye receives from a hit. `sample` is the number of the ray within its pixel: each
    /// looks at another place of the lamp and of the sky, together they see all of it.
    pub fn light(&self, point: Vector, hit: &Hit, sample: usize) -> Seen {
        let part = self.caster.part;
        let own = self.normal(point, hit);
        let normal = self.stretched(own);
        if let Some(light) = self.palette.flat(own, self.front) {
            let t = hit.t;
            return Seen { light, normal, t };
        }
        let cell = part.grid.cell();
        let outside = [0, 1, 2].map(|k| point[k] + normal[k] * 0.6 * cell);
        let occlusion = self.openness(outside, normal, sample);
        let lamp = self.lamp_direction(sample);
        let facing = dot(normal, lamp);
        let lit = if facing > 0.0 && !self.in_shadow(point, normal, lamp) {
            facing
        } else {
            0.0
        };
        // The sky is brighter above, and the table throws some light back.
        let ambient = occlusion * (0.40 + 0.12 * normal[2].abs() + 0.06 * normal[2]);
        let half = unit([0, 1, 2].map(|k| lamp[k] + self.to_eye[k]));
        let gloss = if lit > 0.0 {
            dot(normal, half).max(0.0).powi(50) * 0.12
        } else {
            0.0
        };
        let base = self.palette.material(point, hit);
        let light = [0, 1, 2].map(|k| base[k] * (ambient * SKY[k] + 0.74 * lit * SUN[k]) + gloss);
        Seen {
            light,
            normal,
            t: hit.t,
        }
    }

    fn lamp_direction(&self, sample: usize) -> Vector {
        /// Radius of the lamp's disc, as tangent of its angle.
        const LAMP: f64 = 0.08;
        // Places of the lamp in another order than those of the rays in the pixel.
        let place = (sample * 4) % (SAMPLES * SAMPLES);
        let jitter =
            [place % SAMPLES, place / SAMPLES].map(|k| 2.0 * (k as f64 + 0.5) / SAMPLES as f64 - 1.0);
        let side = unit([-self.lamp[1], self.lamp[0], 0.0]);
        let up = cross(self.lamp, side);
        unit([0, 1, 2].map(|k| self.lamp[k] + LAMP * (jitter[0] * side[k] + jitter[1] * up[k])))
    }

    fn in_shadow(&self, point: Vector, normal: Vector, lamp: Vector) -> bool {
        let cell = self.caster.part.grid.cell();
        let mut from = [0, 1, 2].map(|k| point[k] + normal[k] * 1.5 * cell);
        from[2] = point[2] + normal[2] * 1.5 * cell / self.height_factor;
        let direction = [lamp[0], lamp[1], lamp[2] / self.height_factor];
        let top = f64::from(self.caster.part.top());
        from[2] < top && self.caster.cast(from, direction).is_some()
    }

    /// How much of the sky a point sees: horizons in some directions, others for every ray of a pixel.
    fn openness(&self, point: Vector, normal: Vector, sample: usize) -> f64 {
        const DIRECTIONS: usize = 4;
        const STEPS: i32 = 7;
        let part = self.caster.part;
        let cell = part.grid.cell();
        let reach = 0.16 * part.setup.size[0].max(part.setup.size[1]);
        let growth = (reach / (2.0 * cell)).max(1.5).powf(1.0 / f64::from(STEPS - 1));
        let (mut open, mut all) = (0.0, 0.0);
        for k in 0..DIRECTIONS {
            let turn = (k * SAMPLES * SAMPLES + sample) as f64 / (DIRECTIONS * SAMPLES * SAMPLES) as f64;
            let (sin, cos) = (turn * std::f64::consts::TAU).sin_cos();
            // Directions behind a wall do not count.
            let weight = normal[2].max(0.0) + 2.0 * (normal[0] * cos + normal[1] * sin).max(0.0);
            if weight <= 1e-6 {
                continue;
            }
            let mut horizon = 0.0f64;
            let mut distance = 2.0 * cell;
            for _ in 0..STEPS {
                let (x, y) = (point[0] + distance * cos, point[1] + distance * sin);
                let Some((i, j)) = part.grid.cell_at(x, y) else {
                    break;
                };
                let rise = (f64::from(part.height(i, j)) - point[2]) * self.height_factor;
                horizon = horizon.max(rise / distance);
                distance *= growth;
            }
            let sine = horizon / horizon.hypot(1.0);
            open += weight * (1.0 - sine);
            all += weight;
        }
        if all > 0.0 { open / all } else { 1.0 }
    }

    /// Columns over which slopes are seen: some pixels of the picture.
    fn reach(&self) -> usize {
        const PIXELS: f64 = 5.0;
        const MOST: f64 = 12.0;
        (PIXELS * self.pixel_mm / self.caster.part.grid.cell())
            .round()
            .clamp(1.0, MOST) as usize
    }

    fn stretched(&self, n: Vector) -> Vector {
        unit([n[0], n[1], n[2] / self.height_factor])
    }

    fn normal(&self, point: Vector, hit: &Hit) -> Vector {
        let part = self.caster.part;
        match hit.face {
            Face::Bottom => [0.0, 0.0, -1.0],
            Face::Top => top_normal(part, hit.i, hit.j, self.reach()),
            Face::Side(axis) => wall_normal(part, point, hit, axis, self.reach()),
        }
    }
}

/// Normal of the upper surface, seen over `reach` columns so that the steps of a finishing cut are a slope. Of the
/// slopes to both sides the smaller one counts, so that flat floors stay flat beside walls, and slopes are as steep
/// as they are.
fn top_normal(part: &Part, i: usize, j: usize, reach: usize) -> Vector {
    let h = part.height(i, j);
    let at = |i: Option<usize>, j: Option<usize>| {
        let (i, j) = (i?, j?);
        (i < part.grid.nx && j < part.grid.ny).then(|| part.height(i, j))
    };
    // Slopes over some lengths are averaged: one alone would beat with the steps.
    let slope = |step: f64, at: &dyn Fn(isize) -> Option<f32>| {
        let mut sum = 0.0;
        for k in 1..=reach as isize {
            let [a, b] = [at(-k).map(|v| h - v), at(k).map(|v| v - h)];
            let [a, b] = [a.or(b).unwrap_or(0.0), b.or(a).unwrap_or(0.0)];
            let rise = if a * b <= 0.0 {
                0.0
            } else if a.abs() < b.abs() {
                a
            } else {
                b
            };
            sum += f64::from(rise) / (k as f64 * step);
        }
        sum / reach as f64
    };
    let gx = slope(part.grid.dx, &|k| at(i.checked_add_signed(k), Some(j)));
    let gy = slope(part.grid.dy, &|k| at(Some(i), j.checked_add_signed(k)));
    unit([-gx, -gy, 1.0])
}

/// Normal of a wall: away from the material around, at the height of the hit.
fn wall_normal(part: &Part, point: Vector, hit: &Hit, axis: usize, reach: usize) -> Vector {
    let face = face_normal(part, point, hit, axis);
    if is_outline(part, point, axis) {
        return face;
    }
    // A small step is part of a slope.
    let before = [0, 1].map(|k| [hit.i, hit.j][k].wrapping_add_signed(face[k] as isize));
    let step = f64::from(part.height(hit.i, hit.j) - part.height(before[0], before[1]));
    if step < SLOPE_STEP.max(reach as f64) * part.grid.cell() {
        return top_normal(part, hit.i, hit.j, reach);
    }
    let mut sum = [0.0, 0.0];
    for v in -WALL_WINDOW..=WALL_WINDOW {
        for u in -WALL_WINDOW..=WALL_WINDOW {
            let square = (u * u + v * v) as f64;
            let radius = ((WALL_WINDOW + 1) * (WALL_WINDOW + 1)) as f64;
            let (i, j) = (hit.i as i64 + u, hit.j as i64 + v);
            if square > radius || i < 0 || j < 0 || j >= part.grid.ny as i64 {
                continue;
            }
            if f64::from(part.height(i as usize, j as usize)) > point[2] {
                let weight = 1.0 - square / radius;
                sum[0] -= u as f64 * weight;
                sum[1] -= v as f64 * weight;
            }
        }
    }
    let smooth = unit([sum[0], sum[1], 0.0]);
    // Thin walls have material on no side in particular.
    if dot(smooth, face) > 0.05 { smooth } else { face }
}

fn face_normal(part: &Part, point: Vector, hit: &Hit, axis: usize) -> Vector {
    let centre = [
        (hit.i as f64 + 0.5) * part.grid.dx,
        (hit.j as f64 + 0.5) * part.grid.dy,
    ];
    let mut normal = [0.0; 3];
    normal[axis] = if point[axis] < centre[axis] { -1.0 } else { 1.0 };
    normal
}

const SKY: [f64; 3] = [0.94, 0.98, 1.06];
const SUN: [f64; 3] = [1.04, 1.0, 0.94];
