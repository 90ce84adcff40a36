//! Vectors of the plane.

use crate::Point2;

pub(super) fn add(a: Point2, b: Point2) -> Point2 {
    [a[0] + b[0], a[1] + b[1]]
}

pub(super) fn sub(a: Point2, b: Point2) -> Point2 {
    [a[0] - b[0], a[1] - b[1]]
}

pub(super) fn scale(a: Point2, factor: f64) -> Point2 {
    [a[0] * factor, a[1] * factor]
}

/// `a + b * factor`.
pub(super) fn along(a: Point2, b: Point2, factor: f64) -> Point2 {
    [a[0] + b[0] * factor, a[1] + b[1] * factor]
}

pub(super) fn dot(a: Point2, b: Point2) -> f64 {
    a[0] * b[0] + a[1] * b[1]
}

/// Positive when `b` points to the left of `a`.
pub(super) fn cross(a: Point2, b: Point2) -> f64 {
    a[0] * b[1] - a[1] * b[0]
}

pub(super) fn length(a: Point2) -> f64 {
    // Faster than `hypot`, which looks after numbers that no coordinate has.
    dot(a, a).sqrt()
}

pub(super) fn distance(a: Point2, b: Point2) -> f64 {
    length(sub(a, b))
}

pub(super) fn middle(a: Point2, b: Point2) -> Point2 {
    [0.5 * (a[0] + b[0]), 0.5 * (a[1] + b[1])]
}

/// Turned left by 90 degrees.
pub(super) fn left(a: Point2) -> Point2 {
    [-a[1], a[0]]
}

/// The vector with length 1; zero when there is no direction.
pub(super) fn unit(a: Point2) -> Point2 {
    let l = length(a);
    if l > 0.0 { scale(a, 1.0 / l) } else { [0.0, 0.0] }
}

/// The vector turned by an angle in radians.
pub(super) fn turned(a: Point2, angle: f64) -> Point2 {
    let (s, c) = angle.sin_cos();
    [a[0] * c - a[1] * s, a[0] * s + a[1] * c]
}

/// Signed angle from `a` to `b`, radians in -pi..=pi.
pub(super) fn angle_between(a: Point2, b: Point2) -> f64 {
    cross(a, b).atan2(dot(a, b))
}
