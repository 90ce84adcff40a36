//! Between the path as it is programmed and the axes: a tilted working plane, the compensation of swivel axes, and an
//! unrolled cylinder surface.
//!
//! Decision: An element of a tilted plane or under M114 has its coordinates in it and a `Placement`, which says where
//! the tool datum is: motion asks it for what the axes do, the control for where they are and whether they stay in
//! their range. Upright ones have none. Files of the path list the coordinates of the plane (also
//! `motion/src/placed.rs`, `kernel/src/kinematics.rs`)

use std::sync::Arc;

use crate::swivel::{Matrix, Swivels, Vector, turn, turn_back};
use crate::{Axis, Curve, Cylinder, PerAxis, Position};

/// Steps in which the travel of the axes on a curved path is examined, degrees.
const STEP_DEG: f64 = 1.0;
/// Steps at most: more turns than that repeat themselves.
const STEPS_MAX: f64 = 720.0;

/// How the path of an element stands in the machine, when not upright: where the tool datum (the spindle nose) is for each
/// of its positions, seen from the workpiece datum. Rotary and parallel axes are those of the path, but for the rotary
/// axis of a cylinder.
///
/// It contains the tool, and for rotary axes the workpiece datum, that were in force when it was made; what makes another
/// of them makes another placement.
#[derive(Clone, Debug, PartialEq)]
pub struct Placement {
    kind: Kind,
    /// Axis and length, mm, of the tool.
    tool: (Axis, f64),
}

#[derive(Clone, Debug, PartialEq)]
enum Kind {
    /// Cycle 19: `nose = origin + rotation · (path + tool)` [000:4250-4264].
    Tilted { rotation: Matrix, origin: Vector },
    /// M114: the tip stays on the path while the head turns [000:4441-4447].
    Compensated {
        swivels: Arc<Swivels>,
        /// Machine positions of the datums of the rotary axes, degrees.
        datum: Position,
    },
    /// Cycle 27: the path lies on the unrolled surface of a cylinder [000:6759-6763].
    Rolled(Cylinder),
}

impl Placement {
    /// The working plane of cycle 19: that of a head at these machine angles, degrees. The `datum` is the machine position
    /// of the workpiece datum, the `shift` that of cycle 7 before cycle 19, mm.
    pub fn tilted(
        swivels: &Swivels,
        angles: &Position,
        [datum, shift]: [&Position; 2],
        tool: (Axis, f64),
    ) -> Placement {
        // Where nobody knows the datum the workpiece lies at that of the machine.
        let datum = main(datum).map(|x| if x.is_nan() { 0.0 } else { x });
        let shift = main(shift);
        let point = swivels.on_table([0, 1, 2].map(|i| datum[i] + shift[i]), angles);
        let offset = swivels.head_offset(angles);
        Placement {
            kind: Kind::Tilted {
                rotation: swivels.head_rotation(angles),
                origin: [0, 1, 2].map(|i| point[i] - datum[i] + offset[i]),
            },
            tool,
        }
    }

    /// The compensation of M114, with the machine position of the workpiece datum.
    pub fn compensated(swivels: Arc<Swivels>, datum: &Position, tool: (Axis, f64)) -> Placement {
        Placement {
            kind: Kind::Compensated {
                swivels,
                datum: *datum,
            },
            tool,
        }
    }

    /// The unrolled surface of a cylinder.
    pub fn rolled(cylinder: Cylinder, tool: (Axis, f64)) -> Placement {
        Placement {
            kind: Kind::Rolled(cylinder),
            tool,
        }
    }

    /// The cylinder whose unrolled surface it is.
    pub fn cylinder(&self) -> Option<&Cylinder> {
        match &self.kind {
            Kind::Rolled(cylinder) => Some(cylinder),
            _ => None,
        }
    }

    /// Axis and length, mm, of the tool that it contains.
    pub fn tool(&self) -> (Axis, f64) {
        self.tool
    }

    /// Whether it is a tilted plane, in which the coordinates are not those of the workpiece.
    pub fn is_tilted(&self) -> bool {
        matches!(self.kind, Kind::Tilted { .. })
    }

    /// Where the tool datum is, seen from the workpiece datum, for a position of the path.
    pub fn to_nose(&self, path: &Position) -> Position {
        let mut nose = *path;
        let tip = main(path);
        let at = match &self.kind {
            Kind::Rolled(cylinder) => return self.add_tool(cylinder.roll(path), 1.0),
            Kind::Tilted { rotation, origin } => {
                let at = turn(rotation, sum(tip, self.tool_vector()));
                sum(*origin, at)
            }
            Kind::Compensated { .. } => sum(tip, self.swing(path)),
        };
        set_main(&mut nose, at);
        nose
    }

    /// The position of the path for that of the tool datum.
    pub fn from_nose(&self, nose: &Position) -> Position {
        let mut path = *nose;
        let at = main(nose);
        let tip = match &self.kind {
            Kind::Rolled(cylinder) => return cylinder.unroll(&self.add_tool(*nose, -1.0)),
            Kind::Tilted { rotation, origin } => {
                let at = turn_back(rotation, sum(at, origin.map(|x| -x)));
                sum(at, self.tool_vector().map(|x| -x))
            }
            Kind::Compensated { .. } => sum(at, self.swing(nose).map(|x| -x)),
        };
        set_main(&mut path, tip);
        path
    }

    /// What a position is called when nothing moves and the path goes on in another placement, with the same tool or
    /// another one.
    pub fn change(from: Option<&Placement>, to: Option<&Placement>, position: &Position) -> Position {
        let Some(either) = from.or(to) else {
            return *position;
        };
        let (axis, length) = either.tool;
        let nose = match from {
            Some(from) => from.to_nose(position),
            None => along(position, axis, length),
        };
        match to {
            Some(to) => to.from_nose(&nose),
            None => along(&nose, axis, -length),
        }
    }

    /// The derivative of the axes where that of the path is `direction`.
    pub fn velocity(&self, at: &Position, direction: &PerAxis<f64>) -> PerAxis<f64> {
        /// So far on both sides the travel of the axes is examined, degrees: rounding and curvature count alike.
        const BESIDE_DEG: f64 = 1e-3;
        let mut axes = *direction;
        let [x, y, z] = [Axis::X, Axis::Y, Axis::Z].map(|axis| direction[axis]);
        let turned = match &self.kind {
            Kind::Rolled(cylinder) => return cylinder.velocity(direction),
            Kind::Tilted { rotation, .. } => turn(rotation, [x, y, z]),
            Kind::Compensated { .. } => {
                let rate = direction[Axis::A]
                    .hypot(direction[Axis::B])
                    .hypot(direction[Axis::C]);
                if rate == 0.0 {
                    return axes;
                }
                let h = BESIDE_DEG / rate;
                let beside = |h: f64| {
                    let mut beside = *at;
                    for axis in [Axis::A, Axis::B, Axis::C] {
                        beside[axis] += h * direction[axis];
                    }
                    self.swing(&beside)
                };
                let (before, after) = (beside(-h), beside(h));
                let swing = [0, 1, 2].map(|i| (after[i] - before[i]) / (2.0 * h));
                sum([x, y, z], swing)
            }
        };
        for (axis, turned) in [Axis::X, Axis::Y, Axis::Z].into_iter().zip(turned) {
            axes[axis] = turned;
        }
        axes
    }

    /// The rotation between the path and the main axes where it is always the same, by rows.
    pub fn rotation(&self) -> Option<&[[f64; 3]; 3]> {
        match &self.kind {
            Kind::Tilted { rotation, .. } => Some(rotation),
            Kind::Compensated { .. } | Kind::Rolled(_) => None,
        }
    }

    /// Whether an axis of the machine moves for a path on which these move.
    pub fn moves(&self, axis: Axis, on_path: impl Fn(Axis) -> bool) -> bool {
        if let Kind::Rolled(cylinder) = &self.kind {
            return on_path(cylinder.moved_by(axis));
        }
        if axis.is_rotary() || axis.main() != Some(axis) {
            return on_path(axis);
        }
        match &self.kind {
            Kind::Tilted { rotation, .. } => {
                let row = rotation.get(axis.index()).copied().unwrap_or_default();
                let mut main = [Axis::X, Axis::Y, Axis::Z].into_iter().zip(row);
                main.any(|(own, share)| share != 0.0 && on_path(own))
            }
            Kind::Compensated { swivels, .. } => on_path(axis) || swivels.head_axes().any(on_path),
            Kind::Rolled(_) => false,
        }
    }

    /// Upper bound of the travel of a main axis for a radian of the swivel axes, mm.
    pub fn reach_mm(&self) -> f64 {
        match &self.kind {
            Kind::Tilted { .. } | Kind::Rolled(_) => 0.0,
            Kind::Compensated { swivels, .. } => swivels.reach_mm(self.tool.1),
        }
    }

    /// The least and greatest positions of the tool datum on a curve; wider by what the travel between two examined places
    /// can bulge.
    pub fn bounds(&self, curve: &Curve, start: &Position, end: &Position) -> [Position; 2] {
        if let Kind::Rolled(cylinder) = &self.kind {
            return cylinder
                .bounds(curve, start, end)
                .map(|corner| self.add_tool(corner, 1.0));
        }
        let turns = match curve {
            Curve::Hold => 0.0,
            Curve::Line => 0.0,
            Curve::Arc(arc) => arc.sweep_deg.abs(),
            Curve::Corner(corner) => corner.circle(start, end).sweep_rad.to_degrees(),
        };
        let (reach, swivels) = match &self.kind {
            Kind::Tilted { .. } | Kind::Rolled(_) => (0.0, 0.0),
            // Around the path and back: both turn at once at worst.
            Kind::Compensated { .. } => (
                self.reach_mm(),
                [Axis::A, Axis::B, Axis::C]
                    .map(|axis| (end[axis] - start[axis]).abs())
                    .into_iter()
                    .filter(|distance| distance.is_finite())
                    .sum(),
            ),
        };
        let steps = ((turns + swivels) / STEP_DEG).ceil().clamp(1.0, STEPS_MAX);
        let radius = match curve {
            Curve::Arc(arc) => {
                let (r0, r1) = arc.radii(start, end);
                r0.max(r1)
            }
            Curve::Corner(corner) => {
                let circle = corner.circle(start, end);
                if circle.sweep_rad > 0.0 {
                    circle.radius_mm
                } else {
                    0.0
                }
            }
            Curve::Hold | Curve::Line => 0.0,
        };
        // A chord of an angle lies r · angle² / 8 inside its arc at most.
        let bulge = |r: f64, deg: f64| r * (deg / steps).to_radians().powi(2) / 8.0;
        let margin = bulge(radius, turns) + bulge(reach, swivels);
        let mut least = self.to_nose(start);
        let mut greatest = least;
        for step in 1..=steps as usize {
            let at = self.to_nose(&curve.position(start, end, step as f64 / steps));
            for axis in Axis::ALL {
                // `f64::min` and `max` pass over NaN.
                least[axis] = least[axis].min(at[axis]);
                greatest[axis] = greatest[axis].max(at[axis]);
            }
        }
        for axis in [Axis::X, Axis::Y, Axis::Z] {
            least[axis] -= margin;
            greatest[axis] += margin;
        }
        [least, greatest]
    }

    /// Whether two elements stand in the same placement.
    pub fn is_same(a: Option<&Arc<Placement>>, b: Option<&Arc<Placement>>) -> bool {
        match (a, b) {
            (None, None) => true,
            (Some(a), Some(b)) => Arc::ptr_eq(a, b),
            _ => false,
        }
    }

    /// From the tip to the tool datum by the compensation, mm.
    fn swing(&self, path: &Position) -> Vector {
        let Kind::Compensated { swivels, datum } = &self.kind else {
            return [0.0; 3];
        };
        let turned = |axis| {
            path[axis]
                + if f64::is_nan(datum[axis]) {
                    0.0
                } else {
                    datum[axis]
                }
        };
        let angles: Position = PerAxis::from_fn(turned).into();
        let tool = turn(&swivels.head_rotation(&angles), self.tool_vector());
        sum(tool, swivels.head_offset(&angles))
    }

    /// A position that is the tool's length away, `sign` times.
    fn add_tool(&self, position: Position, sign: f64) -> Position {
        let mut moved = position;
        set_main(
            &mut moved,
            sum(main(&position), self.tool_vector().map(|x| sign * x)),
        );
        moved
    }

    fn tool_vector(&self) -> Vector {
        let (axis, length) = self.tool;
        [Axis::X, Axis::Y, Axis::Z].map(|main| if Some(main) == axis.main() { length } else { 0.0 })
    }
}

fn along(position: &Position, axis: Axis, distance: f64) -> Position {
    let mut position = *position;
    position[axis] += distance;
    position
}

fn main(position: &Position) -> Vector {
    [Axis::X, Axis::Y, Axis::Z].map(|axis| position[axis])
}

fn set_main(position: &mut Position, values: Vector) {
    for (axis, value) in [Axis::X, Axis::Y, Axis::Z].into_iter().zip(values) {
        position[axis] = value;
    }
}

fn sum(a: Vector, b: Vector) -> Vector {
    [0, 1, 2].map(|i| a[i] + b[i])
}
