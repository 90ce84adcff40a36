//! From path elements to straight movements of the tool tip in the blank.

use bahn_path::{Axis, Curve, PathElement, Position};

use crate::setup::{Local, Setup};

/// Hands the straight movements of an element to `emit`. Arcs become chords that keep within
/// `tolerance_mm`. Nothing comes while an axis has no position.
///
/// An axis that gets its first position by the element stands there from the beginning: how the tool
/// came there is not known (inferred).
pub(crate) fn chop(
    element: &PathElement,
    setup: &Setup,
    tolerance_mm: f64,
    mut emit: impl FnMut(Local, Local),
) {
    let start = filled(&element.start, &element.end);
    let (Some(from), Some(to)) = (setup.local(&start), setup.local(&element.end)) else {
        return;
    };
    match element.curve {
        Curve::Hold => {}
        Curve::Line => emit(from, to),
        Curve::Arc(arc) => {
            let (r0, r1) = arc.radii(&start, &element.end);
            let count = chord_count(r0.max(r1), arc.sweep_deg, tolerance_mm);
            let mut last = from;
            for k in 1..=count {
                let t = k as f64 / count as f64;
                let Some(next) = setup.local(&element.curve.position(&start, &element.end, t)) else {
                    return;
                };
                emit(last, next);
                last = next;
            }
        }
    }
}

/// Chords of an arc whose middle is not farther from it than the tolerance: sagitta = r (1 - cos(a/2)).
fn chord_count(radius: f64, sweep_deg: f64, tolerance_mm: f64) -> u64 {
    /// Coarsest chord, however small the arc.
    const MOST_DEG: f64 = 30.0;
    if !(radius.is_finite() && sweep_deg.is_finite()) {
        return 0;
    }
    let half_angle = (1.0 - tolerance_mm / radius.max(tolerance_mm)).acos();
    let step_deg = (2.0 * half_angle).to_degrees().min(MOST_DEG);
    (sweep_deg.abs() / step_deg).ceil().max(1.0) as u64
}

fn filled(start: &Position, end: &Position) -> Position {
    let mut filled = *start;
    for axis in Axis::ALL {
        if filled.get(axis).is_none() {
            filled[axis] = end[axis];
        }
    }
    filled
}

/// The part of a straight movement that can reach material: over the outline widened by `margin`, and
/// lower than `top`. `None` when there is none.
pub(crate) fn clip(from: Local, to: Local, size: &Local, margin: f64) -> Option<(Local, Local)> {
    let (mut t0, mut t1) = (0.0f64, 1.0f64);
    let bounds = [
        (-margin, size[0] + margin),
        (-margin, size[1] + margin),
        (f64::NEG_INFINITY, size[2]),
    ];
    for (k, (low, high)) in bounds.into_iter().enumerate() {
        let delta = to[k] - from[k];
        if delta == 0.0 {
            if from[k] <= low || from[k] >= high {
                return None;
            }
            continue;
        }
        let (a, b) = ((low - from[k]) / delta, (high - from[k]) / delta);
        t0 = t0.max(a.min(b));
        t1 = t1.min(a.max(b));
    }
    if t0 >= t1 {
        return None;
    }
    let at = |t: f64| [0, 1, 2].map(|k| from[k] + (to[k] - from[k]) * t);
    Some((
        if t0 > 0.0 { at(t0) } else { from },
        if t1 < 1.0 { at(t1) } else { to },
    ))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn chords_keep_the_tolerance() {
        // r = 10, tolerance 0.05: half angle acos(0.995) = 5.732 deg, chord 11.46 deg, 360 / 11.46 = 31.4.
        assert_eq!(chord_count(10.0, 360.0, 0.05), 32);
        assert_eq!(chord_count(10.0, -90.0, 0.05), 8);
        // A tiny arc still looks round.
        assert_eq!(chord_count(0.001, 360.0, 0.05), 12);
        assert_eq!(chord_count(f64::NAN, 360.0, 0.05), 0);
    }

    #[test]
    fn clip_leaves_what_can_reach_material() {
        let size = [100.0, 50.0, 20.0];
        assert_eq!(
            clip([-50.0, 10.0, 5.0], [150.0, 10.0, 5.0], &size, 5.0),
            Some(([-5.0, 10.0, 5.0], [105.0, 10.0, 5.0]))
        );
        assert_eq!(
            clip([10.0, 10.0, 30.0], [10.0, 10.0, 10.0], &size, 5.0),
            Some(([10.0, 10.0, 20.0], [10.0, 10.0, 10.0]))
        );
        assert_eq!(clip([10.0, 10.0, 21.0], [90.0, 10.0, 20.0], &size, 5.0), None);
        assert_eq!(clip([10.0, 60.0, 1.0], [90.0, 60.0, 1.0], &size, 5.0), None);
        assert_eq!(
            clip([10.0, 10.0, 1.0], [10.0, 10.0, 1.0], &size, 5.0),
            Some(([10.0, 10.0, 1.0], [10.0, 10.0, 1.0]))
        );
    }
}
