//! Edges of the 3D view as lines.
//!
//! A line is drawn where the rays of a pixel meet surfaces of other directions or far behind each other, but only
//! where this is more than roughness: seen over some pixels, the surface has to bend or to break off. Steps of a
//! finishing cut and the border of a slope that just turns away stay without dashes.

use super::Page;
use super::camera::Camera;
use super::light::dot;
use super::shade::{SAMPLES, Seen};
use bahn_picture::{Colour, Image, mix};
use rayon::prelude::*;

/// What the lines are made from, for one pixel.
#[derive(Clone, Copy)]
pub(super) struct Spot {
    /// How much of an edge the rays of the pixel see, 0..1.
    edge: f32,
    /// Distance from the eye in pixels; infinite in the background.
    distance: f32,
    /// Sine of the flattest angle at which a ray meets the surface.
    slant: f32,
}

impl Spot {
    pub const BACKGROUND: Spot = Spot {
        edge: 0.0,
        distance: f32::INFINITY,
        slant: 1.0,
    };

    pub fn new(seen: &[Option<Seen>; SAMPLES * SAMPLES], camera: &Camera) -> Spot {
        let middle = seen[SAMPLES * SAMPLES / 2].or_else(|| seen.iter().copied().flatten().next());
        Spot {
            edge: edge(seen, camera) as f32,
            slant: seen
                .iter()
                .flatten()
                .map(|seen| dot(seen.normal, camera.forward).abs() as f32)
                .fold(1.0, f32::min),
            distance: middle.map_or(f32::INFINITY, |seen| (seen.t / camera.mm) as f32),
        }
    }

    pub fn distance(self) -> f32 {
        self.distance
    }
}

/// How much of an edge goes through a pixel, 0..1: most where surfaces share it half and half.
fn edge(seen: &[Option<Seen>; SAMPLES * SAMPLES], camera: &Camera) -> f64 {
    /// Cosine of the angle from which on surfaces meet in an edge.
    const BEND: f64 = 0.8;
    /// From this distance on, seen at right angles, one surface lies behind the other, pixels.
    const BREAK: f64 = 5.0;
    let like = |a: &Seen, b: &Seen| {
        let slant = dot(a.normal, camera.forward)
            .abs()
            .min(dot(b.normal, camera.forward).abs());
        dot(a.normal, b.normal) > BEND && (a.t - b.t).abs() * slant.max(0.05) < BREAK * camera.mm
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

/// Draws the lines, softened over the neighbouring pixels; `spots` are rows of the whole picture.
pub(super) fn draw(image: &mut Image, spots: &[Spot], page: &Page) {
    /// Darkness of the lines.
    const DARKNESS: f64 = 0.4;
    let width = image.width() as usize;
    let weights = weights(spots, width, page);
    for (y, row) in image.rows_mut().enumerate() {
        if page.is_stopped() {
            return;
        }
        for (x, pixel) in row.iter_mut().enumerate() {
            let at = y * width + x;
            let value = |index: Option<usize>| index.and_then(|k| weights.get(k)).copied().unwrap_or(0.0);
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

/// How much of a line goes through each pixel, 0..1.
pub(super) fn weights(spots: &[Spot], width: usize, page: &Page) -> Vec<f32> {
    let weight = |(at, spot): (usize, &Spot)| match spot.edge {
        0.0 => 0.0,
        _ if page.is_stopped() => 0.0,
        edge => edge * relief(spots, width, at),
    };
    spots.par_iter().enumerate().map(weight).collect()
}

/// How much the surface bends or breaks off about a pixel, from 0 to 1: how far the pixel lies off the straight line
/// between its neighbours. A bend does so in proportion to the neighbours' distance, a break right at it only.
fn relief(spots: &[Spot], width: usize, at: usize) -> f32 {
    /// Distances of the neighbours, pixels.
    const REACH: [usize; 3] = [2, 3, 5];
    /// Pixels between which lines fade in, for the farthest neighbours.
    const FADE: [f32; 2] = [5.0, 9.0];
    /// How much slower they fade in at breaks.
    const SLOWER: f32 = 1.0;
    let distance = |index: Option<usize>| {
        index
            .and_then(|k| spots.get(k))
            .map_or(f32::INFINITY, |spot| spot.distance)
    };
    let here = distance(Some(at));
    let across = |step: usize| {
        let [near, middle, far] = REACH.map(|reach| {
            let off = distance(at.checked_sub(reach * step)) + distance(Some(at + reach * step)) - 2.0 * here;
            // Beside the background everything is an edge.
            if off.is_finite() { off.abs() } else { f32::INFINITY }
        });
        if far == f32::INFINITY {
            return near;
        }
        let scaled = |off: f32, reach: usize| off * REACH[2] as f32 / reach as f32;
        let off = scaled(near, REACH[0]).min(scaled(middle, REACH[1])).min(far);
        // 0 for a bend, 1 for a break: a break comes in slowly, where a slope begins to hide what is behind it.
        let sudden = ((near / far.max(f32::MIN_POSITIVE)).min(1.0) - 0.4).max(0.0) / 0.6;
        off / (1.0 + SLOWER * sudden)
    };
    let off = across(1).max(across(width)) / (1.0 + turning_away(spots.get(at)));
    if off == f32::INFINITY {
        return 1.0;
    }
    ((off - FADE[0]) / (FADE[1] - FADE[0])).clamp(0.0, 1.0)
}

/// How much slower lines come in where a slope turns away from the eye, and hides next to nothing at first.
fn turning_away(spot: Option<&Spot>) -> f32 {
    /// Sine of the angle from which on a slope does not turn away.
    const FLAT: f32 = 0.35;
    const MOST: f32 = 8.0;
    let slant = spot.map_or(1.0, |spot| spot.slant);
    MOST * (1.0 - slant / FLAT).max(0.0)
}

const EDGE: Colour = [30, 34, 42];
