//! Why the axes left the contour: what the nominal path and the lags of that moment show.
//!
//! The kinds and limits below are *(inferred)*; the manual names the effects: corners and lag [000:4721-4726],
//! equal kv factors [000:4880-4900], spikes at reversal [000:3655-3690].
//!
//! Decision: Why the axes left the contour is read from the nominal path and the lags of that moment: corner, curve,
//! reversal, acceleration along the path, unequal kv, in this order

use std::fmt;

/// Direction changes at one point of the path from which it is a corner, degrees.
const CORNER_DEGREES: f64 = 5.0;
/// ... and how many times larger than those beside it: an arc bends everywhere alike.
const CORNER_RATIO: f64 = 4.0;
/// A turn beyond this is a way back, no corner, degrees.
const REVERSAL_DEGREES: f64 = 170.0;
/// Part of the path speed by which it changes within the window in a phase of acceleration.
const ACCELERATION_PART: f64 = 0.05;
/// Ratio of kv factors from which they are unequal.
const KV_RATIO: f64 = 1.03;
/// Part of the path speed from which an axis takes part in the movement.
const MOVING_PART: f64 = 0.1;
/// Contour cycles before the nearest point whose bends still show in the lags.
const NEAR: usize = 32;
/// Largest radius that counts as a curve, mm.
const RADIUS_MAX: f64 = 5000.0;

/// What is known of the moment of a deviation. Vectors are in the order of the letters.
pub(super) struct Moment<'a> {
    pub letters: &'a [char],
    /// Nominal points of the contour cycles before and after the nearest one, the newest last, mm.
    pub path: &'a [[f64; 3]],
    /// Index of the nearest of them.
    pub nearest: usize,
    /// From the nearest point to the actual position, mm.
    pub across: [f64; 3],
    /// Nominal less actual position, mm.
    pub lag: [f64; 3],
    /// Nominal speeds of the axes, mm/min.
    pub speed: [f64; 3],
    /// Speed along the path at the beginning of the window and now, mm/min.
    pub path_speed: [f64; 2],
}

/// Why the axes left the contour.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) enum Cause {
    /// A corner, cut or overshot because the axes lag.
    Corner { degrees: f64, lag_mm: f64 },
    /// Acceleration across the path: on a curve the axes run inside by their lag.
    Curve { radius_mm: f64, speed: f64, lag_mm: f64 },
    /// Friction or backlash: the axis turned round.
    Reversal { axis: char },
    /// Acceleration or braking along the path.
    Acceleration { from: f64, to: f64 },
    /// Two axes follow with unequal kv factors, (m/min)/mm.
    Kv { axes: [char; 2], kv: [f64; 2] },
    /// Path and lags show nothing; the axis deviates most.
    Disturbance { axis: char },
}

impl Moment<'_> {
    /// The cause that path and lags show. What shapes the path comes first, since it shapes the lags too.
    pub fn cause(&self) -> Cause {
        let deviation = length(self.across);
        let lag_mm = length(self.lag);
        if let Some(degrees) = self.corner() {
            return Cause::Corner { degrees, lag_mm };
        }
        let [from, to] = self.path_speed;
        let radius_mm = self.radius();
        let curve = Cause::Curve {
            radius_mm,
            speed: to,
            lag_mm,
        };
        // Who lags by L on a circle runs inside by L²/2r.
        if lag_mm * lag_mm / (2.0 * radius_mm) >= 0.5 * deviation {
            return curve;
        }
        let worst = self.worst_axis();
        if self.reverses(worst) {
            return Cause::Reversal {
                axis: self.letter(worst),
            };
        }
        if (to - from).abs() > ACCELERATION_PART * from.max(to) {
            return Cause::Acceleration { from, to };
        }
        if let Some(unequal) = self.unequal_kv() {
            return unequal;
        }
        if radius_mm < RADIUS_MAX {
            return curve;
        }
        Cause::Disturbance {
            axis: self.letter(worst),
        }
    }

    /// The path that shapes the lags of the moment.
    fn near(&self) -> &[[f64; 3]] {
        let from = self.nearest.saturating_sub(NEAR);
        self.path.get(from..).unwrap_or_default()
    }

    /// The sharpest corner nearby, degrees.
    fn corner(&self) -> Option<f64> {
        let ways: Vec<[f64; 3]> = self
            .near()
            .windows(2)
            .filter_map(|pair| match pair {
                [from, to] => Some(difference(*to, *from)),
                _ => None,
            })
            .filter(|way| length(*way) > 1e-9)
            .collect();
        let turns: Vec<f64> = ways
            .windows(2)
            .map(|pair| match pair {
                [one, other] => angle(*one, *other),
                _ => 0.0,
            })
            .collect();
        // A corner lies between two points of the path: its turn is that of one or of two neighbours.
        let sharp = turns.windows(2).enumerate().filter_map(|(at, pair)| {
            let own: f64 = pair.iter().sum();
            let beside = [at.checked_sub(1), Some(at + 2)].into_iter().flatten();
            let beside = beside.filter_map(|at| turns.get(at)).copied().reduce(f64::max)?;
            let is_corner = (CORNER_DEGREES..=REVERSAL_DEGREES).contains(&own) && own > CORNER_RATIO * beside;
            is_corner.then_some(own)
        });
        sharp.max_by(f64::total_cmp)
    }

    /// Radius of the path about the nearest point, infinite on a line.
    fn radius(&self) -> f64 {
        let path = self.near();
        let (Some(first), Some(last)) = (path.first(), path.last()) else {
            return f64::INFINITY;
        };
        let middle = path.get(path.len() / 2).unwrap_or(first);
        let (one, other) = (difference(*middle, *first), difference(*last, *middle));
        let turn = angle(one, other).to_radians();
        if turn < 1e-4 {
            return f64::INFINITY;
        }
        // Half the way bends by the angle between two chords.
        (length(one) + length(other)) / 2.0 / turn
    }

    fn worst_axis(&self) -> usize {
        let axes = self.across.iter().enumerate();
        let worst = axes.max_by(|(_, a), (_, b)| a.abs().total_cmp(&b.abs()));
        worst.map_or(0, |(axis, _)| axis)
    }

    /// Whether an axis turned round and has not followed yet: since then its nominal position went no farther
    /// than its lag and the deviation show.
    fn reverses(&self, axis: usize) -> bool {
        let mut values = self
            .path
            .iter()
            .rev()
            .filter_map(|point| point.get(axis).copied());
        let Some(now) = values.next() else {
            return false;
        };
        // Backwards from now to the turn, and past it.
        let mut farthest = now;
        let turned = values.any(|value| {
            let side = (farthest - now).signum();
            let comes_back = farthest != now && (farthest - value) * side > 1e-7;
            if !comes_back && (value - now).abs() > (farthest - now).abs() {
                farthest = value;
            }
            comes_back
        });
        let of = |vector: &[f64; 3]| vector.get(axis).copied().unwrap_or_default().abs();
        turned && (farthest - now).abs() <= 2.0 * of(&self.lag).max(of(&self.across))
    }

    /// The axes with the largest and the smallest kv factor, if these differ.
    fn unequal_kv(&self) -> Option<Cause> {
        let least = MOVING_PART * length(self.speed);
        let factors = self.letters.iter().zip(self.speed).zip(self.lag);
        let mut factors: Vec<(char, f64)> = factors
            .filter(|((_, speed), lag)| speed.abs() > least && *lag != 0.0)
            // mm/min by mm: thousandths of (m/min)/mm.
            .map(|((letter, speed), lag)| (*letter, speed / lag / 1000.0))
            .collect();
        factors.sort_by(|(_, a), (_, b)| b.total_cmp(a));
        let ((most, kv_most), (fewest, kv_fewest)) = (*factors.first()?, *factors.last()?);
        let unequal = kv_fewest > 0.0 && kv_most > KV_RATIO * kv_fewest;
        unequal.then_some(Cause::Kv {
            axes: [most, fewest],
            kv: [kv_most, kv_fewest],
        })
    }

    fn letter(&self, axis: usize) -> char {
        self.letters.get(axis).copied().unwrap_or('?')
    }
}

impl fmt::Display for Cause {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Cause::Corner { degrees, lag_mm } => {
                write!(f, "corner of {degrees:.0}°, passed with a lag of {lag_mm:.3} mm")
            }
            Cause::Curve {
                radius_mm,
                speed,
                lag_mm,
            } => write!(
                f,
                "acceleration across the path: radius {radius_mm:.1} mm at {speed:.0} mm/min with a lag of {lag_mm:.3} mm"
            ),
            Cause::Reversal { axis } => write!(f, "friction or backlash at the reversal of {axis}"),
            Cause::Acceleration { from, to } if to < from => {
                write!(f, "braking along the path, from {from:.0} to {to:.0} mm/min")
            }
            Cause::Acceleration { from, to } => {
                write!(f, "acceleration along the path, from {from:.0} to {to:.0} mm/min")
            }
            Cause::Kv {
                axes: [a, b],
                kv: [kv_a, kv_b],
            } => write!(
                f,
                "unequal kv: {a} follows with {kv_a:.2}, {b} with {kv_b:.2} (m/min)/mm"
            ),
            Cause::Disturbance { axis } => write!(
                f,
                "a disturbance of {axis}: no corner, reversal, acceleration or difference of kv"
            ),
        }
    }
}

fn difference([a, b, c]: [f64; 3], [d, e, f]: [f64; 3]) -> [f64; 3] {
    [a - d, b - e, c - f]
}

fn length([a, b, c]: [f64; 3]) -> f64 {
    (a * a + b * b + c * c).sqrt()
}

/// Angle between two directions, degrees; 0 where one has none.
fn angle([a, b, c]: [f64; 3], [d, e, f]: [f64; 3]) -> f64 {
    let across = length([b * f - c * e, c * d - a * f, a * e - b * d]);
    across.atan2(a * d + b * e + c * f).to_degrees()
}

#[cfg(test)]
mod tests {
    use super::*;

    fn moment<'a>(path: &'a [[f64; 3]], across: [f64; 3], lag: [f64; 3], speed: [f64; 3]) -> Moment<'a> {
        Moment {
            letters: &['X', 'Y', 'Z'],
            path,
            nearest: 0,
            across,
            lag,
            speed,
            path_speed: [1000.0; 2],
        }
    }

    /// A corner bends at one point, an arc everywhere.
    #[test]
    fn corners_are_distinguished_from_arcs() {
        let corner = [
            [0.0; 3],
            [1.0, 0.0, 0.0],
            [2.0, 0.0, 0.0],
            [3.0, 0.0, 0.0],
            [3.0, 1.0, 0.0],
        ];
        let cause = moment(&corner, [-0.1, 0.1, 0.0], [0.5, 0.0, 0.0], [0.0; 3]).cause();
        assert!(
            matches!(cause, Cause::Corner { degrees, .. } if (degrees - 90.0).abs() < 1e-9),
            "{cause}"
        );
        // Ten points of a circle of radius 5, 8 degrees apart.
        let arc: Vec<[f64; 3]> = (0..10)
            .map(|i| f64::from(i) * 8_f64.to_radians())
            .map(|phi| [5.0 * phi.cos(), 5.0 * phi.sin(), 0.0])
            .collect();
        // L = 1 mm: 1/(2*5) = 0.1 mm inside.
        let cause = moment(&arc, [-0.1, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 1000.0, 0.0]).cause();
        assert!(
            matches!(cause, Cause::Curve { radius_mm, .. } if (radius_mm - 5.0).abs() < 0.1),
            "{cause}"
        );
    }

    /// On a line 1000 mm/min with 0.5 mm of lag are a kv of 2, with 0.625 mm of 1.6.
    #[test]
    fn unequal_lags_are_unequal_factors() {
        let line = [[0.0; 3], [1.0, 1.0, 0.0], [2.0, 2.0, 0.0]];
        let speed = [1000.0, 1000.0, 0.0];
        let cause = moment(&line, [0.06, -0.06, 0.0], [0.5, 0.625, 0.0], speed).cause();
        assert_eq!(
            cause.to_string(),
            "unequal kv: X follows with 2.00, Y with 1.60 (m/min)/mm"
        );
        let equal = moment(&line, [0.0, 0.01, 0.0], [0.5, 0.5, 0.0], speed).cause();
        assert_eq!(equal, Cause::Disturbance { axis: 'Y' });
        let faster = Moment {
            path_speed: [200.0, 800.0],
            ..moment(&line, [0.0, 0.01, 0.0], [0.5, 0.6, 0.0], speed)
        };
        assert_eq!(
            faster.cause(),
            Cause::Acceleration {
                from: 200.0,
                to: 800.0
            }
        );
    }

    /// X goes 1 mm on and back again while Y goes on: no corner beyond 170 degrees is one.
    #[test]
    fn a_way_back_is_a_reversal() {
        let path = [[0.0; 3], [1.0, 0.01, 0.0], [0.99, 0.02, 0.0]];
        let stuck = moment(&path, [0.01, 0.0, 0.0], [-0.01, 0.0, 0.0], [1000.0, 10.0, 0.0]);
        assert_eq!(stuck.cause(), Cause::Reversal { axis: 'X' });
        // 1 mm after the turn an axis that lags by 0.01 mm has followed.
        let path = [[0.0; 3], [1.0, 0.01, 0.0], [0.0, 0.02, 0.0]];
        let moved = moment(&path, [0.01, 0.0, 0.0], [-0.01, 0.0, 0.0], [1000.0, 10.0, 0.0]);
        assert_ne!(moved.cause(), Cause::Reversal { axis: 'X' });
    }
}
