//! Shapes on a coarse grid: they touch, coincide and are tangent to each other far more often than
//! drawings do.
#![allow(dead_code, reason = "every test binary uses a part")]

use bahn_path::Sense;
use bahn_path::region::{Contour, Region, Segment};
use proptest::prelude::*;

/// Rectangles, circles, slots, L shapes, quarter-rounded plates and notched discs on a 1 mm grid.
pub fn shape() -> impl Strategy<Value = Contour> {
    let place = (0..8i32, 0..8i32).prop_map(|(x, y)| [f64::from(x), f64::from(y)]);
    (place, 1..8i32, 1..8i32, 1..4i32, 0..7u8, any::<bool>()).prop_map(|([x, y], w, h, r, kind, turned)| {
        let (w, h, r) = (f64::from(w), f64::from(h), f64::from(r));
        let contour = match kind {
            0 => Contour::rectangle([x, y], [x + w, y + h]),
            1 => Contour::circle([x, y], r, 90.0, Sense::CounterClockwise),
            2 => Contour::start_at([x, y - r])
                .line_to([x + w, y - r])
                .arc_to([x + w, y], [x + w, y + r], Sense::CounterClockwise)
                .line_to([x, y + r])
                .arc_to([x, y], [x, y - r], Sense::CounterClockwise),
            3 => Contour::polygon(&[
                [x, y],
                [x + w + 1.0, y],
                [x + w + 1.0, y + 1.0],
                [x + 1.0, y + 1.0],
                [x + 1.0, y + h + 1.0],
                [x, y + h + 1.0],
            ]),
            // A plate with one corner rounded by a quarter circle.
            4 => Contour::start_at([x, y])
                .line_to([x + w + r, y])
                .line_to([x + w + r, y + h])
                .arc_to([x + w, y + h], [x + w, y + h + r], Sense::CounterClockwise)
                .line_to([x, y + h + r])
                .line_to([x, y]),
            // A plate with a concave quarter circle cut out of a corner.
            5 => Contour::start_at([x, y])
                .line_to([x + w + r, y])
                .line_to([x + w + r, y + h])
                .arc_to([x + w + r, y + h + r], [x + w, y + h + r], Sense::Clockwise)
                .line_to([x, y + h + r])
                .line_to([x, y]),
            _ => Contour::polygon(&[[x, y], [x + w, y + 1.0], [x + 1.0, y + h + 1.0]]),
        };
        if turned { contour.reversed() } else { contour }
    })
}

/// A region of up to three shapes, united or cut out of each other.
pub fn region() -> impl Strategy<Value = Region> {
    (shape(), prop::collection::vec((shape(), any::<bool>()), 0..3)).prop_map(|(first, more)| {
        more.iter()
            .fold(Region::from_contour(&first), |region, (contour, cut)| {
                let other = Region::from_contour(contour);
                if *cut {
                    region.difference(&other)
                } else {
                    region.union(&other)
                }
            })
    })
}

/// The contour turned about the origin and shifted: coordinates that rounding touches everywhere.
pub fn turned(contour: &Contour, angle_deg: f64, shift: f64) -> Contour {
    let (sin, cos) = angle_deg.to_radians().sin_cos();
    let place = |p: [f64; 2]| {
        [
            p[0] * cos - p[1] * sin + shift,
            p[0] * sin + p[1] * cos - 0.7 * shift,
        ]
    };
    let segments = contour.segments().iter().map(|segment| match *segment {
        Segment::Line { from, to } => Segment::line(place(from), place(to)),
        Segment::Arc {
            from,
            to,
            centre,
            sweep_deg,
        } => Segment::Arc {
            from: place(from),
            to: place(to),
            centre: place(centre),
            sweep_deg,
        },
    });
    Contour::from_segments(segments).unwrap_or_else(|| contour.clone())
}

/// The contour with all its points moved by less than `by`, arcs rebuilt through their moved ends.
pub fn jittered(contour: &Contour, by: f64, seed: u64) -> Contour {
    let mut state = seed | 1;
    let mut random = move || {
        state ^= state << 13;
        state ^= state >> 7;
        state ^= state << 17;
        (state >> 11) as f64 / (1u64 << 53) as f64 - 0.5
    };
    let mut last = contour.start();
    let count = contour.segments().len();
    let segments: Vec<Segment> = contour
        .segments()
        .iter()
        .enumerate()
        .map(|(index, segment)| {
            let to = segment.to();
            let moved = [to[0] + by * random(), to[1] + by * random()];
            let to = if index + 1 == count {
                contour.start()
            } else {
                moved
            };
            let from = std::mem::replace(&mut last, to);
            match *segment {
                Segment::Line { .. } => Segment::line(from, to),
                Segment::Arc {
                    centre, sweep_deg, ..
                } => Segment::arc(from, to, centre, Sense::of_sweep(sweep_deg)),
            }
        })
        .collect();
    Contour::from_segments(segments).unwrap_or_else(|| contour.clone())
}
