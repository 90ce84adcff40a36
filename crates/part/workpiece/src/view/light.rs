//! Directions and light as numbers.

use bahn_picture::Colour;

use super::raycast::Vector;
use crate::part::Part;

/// Whether a wall is the outer side of the blank.
pub(super) fn is_outline(part: &Part, point: Vector, axis: usize) -> bool {
    let tolerance = 1e-6 * part.setup.size[axis];
    point[axis] < tolerance || point[axis] > part.setup.size[axis] - tolerance
}

fn linear(value: u8) -> f64 {
    (f64::from(value) / 255.0).powf(2.2)
}

/// A linear light as a value of the screen.
pub(super) fn screen(light: [f64; 3]) -> Colour {
    light.map(|value| (value.clamp(0.0, 1.0).powf(1.0 / 2.2) * 255.0).round() as u8)
}

pub(super) fn to_linear(colour: Colour) -> [f64; 3] {
    colour.map(linear)
}

pub(super) fn dot(a: Vector, b: Vector) -> f64 {
    a[0] * b[0] + a[1] * b[1] + a[2] * b[2]
}

pub(super) fn cross(a: Vector, b: Vector) -> Vector {
    [
        a[1] * b[2] - a[2] * b[1],
        a[2] * b[0] - a[0] * b[2],
        a[0] * b[1] - a[1] * b[0],
    ]
}

pub(super) fn unit(v: Vector) -> Vector {
    let length = dot(v, v).sqrt();
    if length > 0.0 {
        v.map(|value| value / length)
    } else {
        [0.0, 0.0, 0.0]
    }
}
