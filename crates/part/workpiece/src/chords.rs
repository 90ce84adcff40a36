//! From path elements to straight movements of the tool tip in the blank.

use bahn_path::{Axis, Curve, PathElement, Position};

use crate::setup::{Local, Setup};

/// Hands the straight movements of an element that come within `reach_mm` of the blank's outline to
/// `emit`. Arcs become chords that keep within `tolerance_mm`. Nothing comes while an axis has no
/// position.
///
/// An axis that gets its first position by the element stands there from the beginning: how the tool
/// came there is not known (inferred).
pub(crate) fn chop(
    element: &PathElement,
    setup: &Setup,
    tolerance_mm: f64,
    reach_mm: f64,
    mut emit: impl FnMut(Local, Local),
) {
    let start = filled(&element.start, &element.end);
    let (Some(from), Some(to)) = (setup.local(&start), setup.local(&element.end)) else {
        return;
    };
    match element.curve {
        Curve::Hold => {}
        Curve::Line => emit(from, to),
        Curve::Arc(_) | Curve::Corner(_) => {
            let (radius, sweep_deg, outward) = match element.curve {
                Curve::Corner(corner) => {
                    let circle = corner.circle(&start, &element.end);
                    if circle.sweep_rad == 0.0 {
                        return emit(from, to);
                    }
                    (circle.radius_mm, circle.sweep_rad.to_degrees(), 0.0)
                }
                Curve::Arc(arc) => {
                    let (r0, r1) = arc.radii(&start, &element.end);
                    (r0.max(r1), arc.sweep_deg, (r1 - r0).abs())
                }
                Curve::Hold | Curve::Line => return,
            };
            let count = chord_count(radius, sweep_deg, tolerance_mm);
            let length = element.curve.linear_length(&start, &element.end) + outward;
            if !length.is_finite() || count == 0 {
                return;
            }
            let place = |k: u64| {
                let t = k as f64 / count as f64;
                setup.local(&element.curve.position(&start, &element.end, t))
            };
            let chord = length / count as f64;
            Chords {
                place,
                chord,
                reach_mm,
                size: setup.size,
                last: (0, from),
            }
            .walk(0, count, &mut emit);
        }
    }
}

/// Walks along the chords of an arc, leaping over runs of them that are out of reach of the blank: an
/// arc of a kilometre costs no more than what of it lies over the blank.
struct Chords<P> {
    /// End of a chord by its number.
    place: P,
    /// Greatest length of a chord.
    chord: f64,
    reach_mm: f64,
    size: Local,
    /// The end that was computed last.
    last: (u64, Local),
}

impl<P: Fn(u64) -> Option<Local>> Chords<P> {
    fn walk(&mut self, first: u64, end: u64, emit: &mut impl FnMut(Local, Local)) {
        if end <= first + 1 {
            let from = if self.last.0 == first {
                Some(self.last.1)
            } else {
                (self.place)(first)
            };
            if let (Some(from), Some(to)) = (from, (self.place)(end)) {
                emit(from, to);
                self.last = (end, to);
            }
            return;
        }
        let middle = first + (end - first) / 2;
        let Some(place) = (self.place)(middle) else { return };
        let outside = |k: usize| (-place[k]).max(place[k] - self.size[k]).max(0.0);
        let farthest = (end - middle) as f64 * self.chord;
        if outside(0).hypot(outside(1)) <= farthest + self.reach_mm {
            self.walk(first, middle, emit);
            self.walk(middle, end, emit);
        }
    }
}

/// Chords of an arc whose middle is not farther from it than the tolerance: sagitta = r (1 - cos(a/2)).
/// 0 for an arc without sweep.
fn chord_count(radius: f64, sweep_deg: f64, tolerance_mm: f64) -> u64 {
    /// Coarsest chord, however small the arc.
    const MOST_DEG: f64 = 30.0;
    /// Helices of more turns than any control takes get coarser chords.
    const MOST_TURNS: f64 = 1000.0;
    if !(radius.is_finite() && sweep_deg.is_finite()) {
        return 0;
    }
    // acos(1 - x) without its loss of digits for small x.
    let half_angle = 2.0 * (0.5 * tolerance_mm / radius.max(tolerance_mm)).sqrt().asin();
    let step_deg = (2.0 * half_angle).to_degrees().min(MOST_DEG);
    let sweep = sweep_deg.abs().min(360.0 * MOST_TURNS);
    (sweep / step_deg).ceil().clamp(1.0, 1e15) as u64
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
