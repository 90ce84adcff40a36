//! What a movement demands of the axes when its path does not stand upright: cycle 19, M114 and cycle 27.

use bahn_path::{Arc, Axis, Curve, Cylinder, PathElement, PerAxis, Placement};

use crate::limits::{Dynamics, MAIN};

/// Derivatives of the axes by the path length, and what of it limits the path.
pub(crate) struct Placed {
    /// At the start and at the end.
    pub(crate) directions: [PerAxis<f64>; 2],
    /// Greatest share of each axis on the whole path, or an upper bound of it.
    pub(crate) share: PerAxis<f64>,
    /// Greatest path speed that the turning of swivel axes allows, mm/s; infinite where none turns.
    pub(crate) speed: f64,
}

impl Placed {
    /// From the derivatives of the path at its ends. `per_square` is its own acceleration at speed 1, across it.
    pub(crate) fn new(
        placement: &Placement,
        element: &PathElement,
        directions: [PerAxis<f64>; 2],
        per_square: f64,
        dynamics: &Dynamics,
    ) -> Placed {
        if let Some(cylinder) = placement.cylinder() {
            return Placed::rolled(cylinder, element, directions, per_square, dynamics);
        }
        let [start, end] = directions;
        let placed = [
            placement.velocity(&element.start, &start),
            placement.velocity(&element.end, &end),
        ];
        // A turned straight line is a straight line.
        let mut share = start.map(f64::abs);
        match placement.rotation() {
            Some(rotation) => {
                for (axis, row) in MAIN.into_iter().zip(rotation) {
                    share[axis] = match &element.curve {
                        Curve::Arc(arc) => on_circle(row, arc, &directions),
                        Curve::Corner(arc) => {
                            let circle = arc.circle(&element.start, &element.end);
                            circle.greatest_share(*row) * length(&start)
                        }
                        _ => placed[0][axis].abs(),
                    };
                }
                Placed {
                    directions: placed,
                    share,
                    speed: f64::INFINITY,
                }
            }
            None => {
                let rate = rate(&start);
                let reach = placement.reach_mm();
                for axis in MAIN {
                    let own = match &element.curve {
                        Curve::Arc(_) | Curve::Corner(_) => length(&start).max(length(&end)),
                        _ => start[axis].abs(),
                    };
                    share[axis] = own + reach * rate;
                }
                Placed {
                    directions: placed,
                    share,
                    speed: swing_speed(per_square, reach * rate * rate, dynamics),
                }
            }
        }
    }

    /// On the unrolled surface of a cylinder: the rotary axis goes in degrees what the path goes around it in mm.
    fn rolled(
        cylinder: &Cylinder,
        element: &PathElement,
        directions: [PerAxis<f64>; 2],
        per_square: f64,
        dynamics: &Dynamics,
    ) -> Placed {
        let [start, end] = directions;
        let mut on_surface = PerAxis::from_fn(|axis| start[axis].abs().max(end[axis].abs()));
        if let Curve::Arc(arc) = &element.curve {
            let plane = [arc.plane.first, arc.plane.second];
            let fastest = directions.map(|d| d[plane[0]].hypot(d[plane[1]]));
            for i in plane {
                on_surface[i] = fastest[0].max(fastest[1]);
            }
        }
        if let Curve::Corner(_) = &element.curve {
            for axis in MAIN {
                on_surface[axis] = length(&start);
            }
        }
        let rotary = cylinder.rotary;
        let across = per_square * cylinder.deg_per_mm.abs();
        let left = dynamics.bound[rotary] - dynamics.acceleration[rotary];
        Placed {
            directions: directions.map(|direction| cylinder.velocity(&direction)),
            share: cylinder.velocity(&on_surface).map(f64::abs),
            speed: if across > 0.0 {
                (left / across).sqrt()
            } else {
                f64::INFINITY
            },
        }
    }
}

/// The greatest share of a main axis in a circle of a turned plane: that where it is tangential to the axis, whether the arc
/// comes there or not, and its share in the straight part of a helix.
fn on_circle(row: &[f64; 3], arc: &Arc, directions: &[PerAxis<f64>; 2]) -> f64 {
    let of = |axis: Axis| row.get(axis.index()).copied().unwrap_or(0.0);
    let plane = [arc.plane.first, arc.plane.second];
    let in_plane = directions.iter().map(|d| d[plane[0]].hypot(d[plane[1]]));
    let fastest = in_plane.fold(0.0, f64::max);
    let straight = MAIN
        .into_iter()
        .filter(|axis| !plane.contains(axis))
        .map(|axis| of(axis) * directions[0][axis]);
    of(plane[0]).hypot(of(plane[1])) * fastest + straight.sum::<f64>().abs()
}

/// Radians of the swivel axes by the path length.
fn rate(direction: &PerAxis<f64>) -> f64 {
    let turns = [Axis::A, Axis::B, Axis::C].map(|axis| direction[axis].abs().to_radians());
    turns.iter().sum()
}

fn length(direction: &PerAxis<f64>) -> f64 {
    MAIN.iter()
        .map(|axis| direction[*axis] * direction[*axis])
        .sum::<f64>()
        .sqrt()
}

/// Turning at a constant rate accelerates the main axes across the path. That comes on top of what they accelerate along
/// it, MP1060: what is left of `sqrt(MP1060² + MP1070²)` is for it.
fn swing_speed(per_square: f64, swing: f64, dynamics: &Dynamics) -> f64 {
    if swing <= 0.0 {
        return f64::INFINITY;
    }
    let left = MAIN.map(|axis| dynamics.bound[axis] - dynamics.acceleration[axis]);
    (left.into_iter().fold(f64::INFINITY, f64::min) / (per_square + swing)).sqrt()
}
