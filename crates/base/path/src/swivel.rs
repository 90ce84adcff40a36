//! The geometry of machines with swivel axes: a chain of shifts and rotations, MP7510 to MP7592.
//!
//! The links of a head lead from the tool datum outwards, to where no free rotary axis is left before the machine; those of
//! a table from the centre of its first axis, as seen from the workpiece, outwards. With all free axes at 0 the head holds
//! the tool as a machine without swivel axes does [000:4258-4264].
//!
//! Decision: Tables turn against the sense of their axes; fixed rotations turn the coordinate system of the links
//! behind them; what M114 compensates is the head alone

use crate::frame::sin_cos_deg;
use crate::{Axis, Position};

/// A vector in space, mm.
pub(crate) type Vector = [f64; 3];
/// A rotation in space, by rows.
pub(crate) type Matrix = [Vector; 3];

/// That of no rotation.
pub(crate) const UPRIGHT: Matrix = [[1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]];

/// One link: a paraxial shift, a rotation of the coordinate system, or a free rotary axis [000:4278-4301].
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Link {
    /// X, Y or Z of a shift; A, B or C of a rotation: MP75x0.
    pub axis: Axis,
    /// It belongs to a tilting table, not to a swivel head: MP75x1 bit 0.
    pub table: bool,
    /// The dimension counts from the machine datum, not from the link before: MP75x1 bit 1.
    pub absolute: bool,
    /// Shift, mm, or angle, degrees; 0 on a rotation is a free axis: MP75x2.
    pub dimension: f64,
}

impl Link {
    /// Whether it is an axis that turns.
    pub fn is_free(&self) -> bool {
        self.axis.is_rotary() && self.dimension == 0.0
    }
}

/// The swivel axes of a machine.
///
/// ```
/// use bahn_path::{Axis, Link, Position, Swivels};
///
/// // A head that swivels about B, 200 mm above the tool datum.
/// let head = |axis, dimension| Link { axis, table: false, absolute: false, dimension };
/// let swivels = Swivels::new([head(Axis::Z, 200.0), head(Axis::B, 0.0)]);
/// let mut angles = Position::ZERO;
/// angles[Axis::B] = 90.0;
/// // The tool datum has gone from below the axis to beside it.
/// let [x, _, z] = swivels.head_offset(&angles);
/// assert!((x - 200.0).abs() < 1e-9 && (z + 200.0).abs() < 1e-9);
/// ```
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Swivels {
    head: Vec<Link>,
    table: Vec<Link>,
    /// Tool directions of the head with all axes at 0, seen from the machine.
    upright: Matrix,
    /// From the tool datum to the last centre of the head with all axes at 0, mm.
    extent: Vector,
}

impl Swivels {
    /// The chain of these links.
    pub fn new(links: impl IntoIterator<Item = Link>) -> Swivels {
        let (table, head): (Vec<Link>, Vec<Link>) = links.into_iter().partition(|link| link.table);
        let mut swivels = Swivels {
            head,
            table,
            upright: UPRIGHT,
            extent: [0.0; 3],
        };
        let (at, turned) = swivels.walk_head(&Position::ZERO);
        swivels.upright = turned;
        swivels.extent = turn_back(&turned, at).map(|x| -x);
        swivels
    }

    /// The rotary axes that turn.
    pub fn free_axes(&self) -> impl Iterator<Item = Axis> + '_ {
        let links = self.head.iter().chain(&self.table);
        links.filter(|link| link.is_free()).map(|link| link.axis)
    }

    /// Those of the head.
    pub(crate) fn head_axes(&self) -> impl Iterator<Item = Axis> + '_ {
        self.head
            .iter()
            .filter(|link| link.is_free())
            .map(|link| link.axis)
    }

    /// How the head has turned the tool, by rows.
    pub fn head_rotation(&self, angles: &Position) -> [[f64; 3]; 3] {
        let (_, turned) = self.walk_head(angles);
        product(&transposed(&self.upright), &turned)
    }

    /// By how much the main axes must move, mm, so that the tool datum stays where it is when the head turns from 0 to
    /// these angles.
    pub fn head_offset(&self, angles: &Position) -> [f64; 3] {
        let (at, _) = self.walk_head(angles);
        let now = turn_back(&self.upright, at);
        // `at` is the tool datum seen from the last centre: the centre stands the other way from it.
        [0, 1, 2].map(|i| -now[i] - self.extent[i])
    }

    /// Upper bound of the distance between the tip of a tool and any axis of the head, mm.
    pub fn reach_mm(&self, tool_length_mm: f64) -> f64 {
        let shifts = self.head.iter().filter(|link| !link.axis.is_rotary());
        shifts.map(|link| link.dimension.abs()).sum::<f64>() + tool_length_mm.abs()
    }

    /// Where a point that is fixed to the table stands when its axes have turned from 0 to these angles, machine
    /// coordinates, mm. The names of its axes are those of the tool's movement: the table itself turns the other way
    /// [000:3334-3344].
    pub fn on_table(&self, point: [f64; 3], angles: &Position) -> [f64; 3] {
        let mut at = point;
        self.walk_table(|axis, centre, basis| {
            let turned = rotation(about(axis), -known(angles[axis]));
            // About an axis of the coordinate system that fixed rotations have turned.
            let turned = product(&product(basis, &turned), &transposed(basis));
            let to = turn(&turned, difference(at, *centre));
            at = [0, 1, 2].map(|i| centre[i] + to[i]);
        });
        at
    }

    /// How far from the centre of a rotary axis the tip of the tool is, mm, with the machine positions of the main axes
    /// and of the rotary axes at `axes`; the tool leads from its tip by `tool`, mm, to the tool datum. `None` for an axis
    /// whose centre is not described.
    pub fn radius_mm(&self, axis: Axis, axes: &Position, tool: [f64; 3]) -> Option<f64> {
        if self.head_axes().any(|own| own == axis) {
            let mut radius = None;
            let down = tool.map(|x| -x);
            self.walk_head_from(down, axes, |free, at| {
                if free == axis {
                    radius = Some(beside(at, unit(about(axis))));
                }
            });
            return radius;
        }
        let nose = [Axis::X, Axis::Y, Axis::Z].map(|axis| axes[axis]);
        let datum = difference(nose, self.head_offset(axes));
        let tip = difference(datum, turn(&self.head_rotation(axes), tool));
        let (point, direction) = self.table_axis(axis, axes)?;
        Some(beside(difference(tip, point), direction))
    }

    /// A point on a rotary axis of the table, mm, and its direction, with the axes that carry it at `axes`: machine
    /// coordinates and the sense of the tool's movement about the workpiece.
    pub fn table_axis(&self, axis: Axis, axes: &Position) -> Option<([f64; 3], [f64; 3])> {
        let mut line: Option<(Vector, Vector)> = None;
        self.walk_table(|free, centre, basis| {
            if free == axis {
                line = Some((*centre, turn(basis, unit(about(axis)))));
            } else if let Some((point, direction)) = &mut line {
                // Those outside of it carry it.
                let turned = rotation(about(free), -known(axes[free]));
                let turned = product(&product(basis, &turned), &transposed(basis));
                let to = turn(&turned, difference(*point, *centre));
                *point = [0, 1, 2].map(|i| centre[i] + to[i]);
                *direction = turn(&turned, *direction);
            }
        });
        line
    }

    /// Shows each free axis of the table, from the workpiece outwards: its centre and its directions with all axes at 0.
    fn walk_table(&self, mut see: impl FnMut(Axis, &Vector, &Matrix)) {
        let mut centre = [0.0; 3];
        let mut basis = UPRIGHT;
        for link in &self.table {
            let Some(main) = link.axis.main() else {
                let about = about(link.axis);
                if link.is_free() {
                    see(link.axis, &centre, &basis);
                } else {
                    basis = product(&basis, &rotation(about, link.dimension));
                }
                continue;
            };
            let i = main.index();
            if link.absolute {
                if let Some(value) = centre.get_mut(i) {
                    *value = link.dimension;
                }
            } else {
                for (value, row) in centre.iter_mut().zip(&basis) {
                    *value += row.get(i).copied().unwrap_or(0.0) * link.dimension;
                }
            }
        }
    }

    /// The tool datum seen from the end of the head's links, in the directions there; and the directions of the tool
    /// there.
    fn walk_head(&self, angles: &Position) -> (Vector, Matrix) {
        self.walk_head_from([0.0; 3], angles, |_, _| {})
    }

    /// The same of another place than the tool datum, seen from that; shows where it is before each free axis.
    fn walk_head_from(
        &self,
        from: Vector,
        angles: &Position,
        mut see: impl FnMut(Axis, Vector),
    ) -> (Vector, Matrix) {
        let mut at = from;
        let mut turned = UPRIGHT;
        for link in &self.head {
            if let Some(main) = link.axis.main() {
                if let Some(value) = at.get_mut(main.index()) {
                    *value -= link.dimension;
                }
                continue;
            }
            // A free axis turns what stands before it; a fixed rotation turns the coordinate system, and with it what
            // stands before it the other way.
            let angle = if link.is_free() {
                see(link.axis, at);
                known(angles[link.axis])
            } else {
                -link.dimension
            };
            let matrix = rotation(about(link.axis), angle);
            at = turn(&matrix, at);
            turned = product(&matrix, &turned);
        }
        (at, turned)
    }
}

fn unit(index: usize) -> Vector {
    [0, 1, 2].map(|i| if i == index { 1.0 } else { 0.0 })
}

fn difference(a: Vector, b: Vector) -> Vector {
    [0, 1, 2].map(|i| a[i] - b[i])
}

/// How far a place is beside a line through the origin.
fn beside(at: Vector, direction: Vector) -> f64 {
    let [x, y, z] = at;
    let [u, v, w] = direction;
    let cross = [y * w - z * v, z * u - x * w, x * v - y * u];
    cross.iter().map(|x| x * x).sum::<f64>().sqrt()
}

/// An axis without a position counts as standing at 0.
fn known(angle: f64) -> f64 {
    if angle.is_nan() { 0.0 } else { angle }
}

/// Index of the main axis that a rotary axis turns about.
fn about(axis: Axis) -> usize {
    axis.index() - Axis::A.index()
}

/// Rotation about a main axis, right-handed, degrees.
fn rotation(about: usize, angle_deg: f64) -> Matrix {
    let (sin, cos) = sin_cos_deg(angle_deg);
    match about {
        0 => [[1.0, 0.0, 0.0], [0.0, cos, -sin], [0.0, sin, cos]],
        1 => [[cos, 0.0, sin], [0.0, 1.0, 0.0], [-sin, 0.0, cos]],
        _ => [[cos, -sin, 0.0], [sin, cos, 0.0], [0.0, 0.0, 1.0]],
    }
}

/// A turned vector. What a component does not turn into does not touch it, be it unknown.
pub(crate) fn turn(matrix: &Matrix, vector: Vector) -> Vector {
    matrix.map(|row| {
        let parts = row.iter().zip(&vector).filter(|(share, _)| **share != 0.0);
        parts.map(|(share, value)| share * value).sum()
    })
}

/// Undoes the turn of a vector: of a rotation, the transposed matrix is the inverse.
pub(crate) fn turn_back(matrix: &Matrix, vector: Vector) -> Vector {
    turn(&transposed(matrix), vector)
}

fn transposed(matrix: &Matrix) -> Matrix {
    [0, 1, 2].map(|i| [matrix[0][i], matrix[1][i], matrix[2][i]])
}

fn product(a: &Matrix, b: &Matrix) -> Matrix {
    a.map(|row| [0, 1, 2].map(|j| row[0] * b[0][j] + row[1] * b[1][j] + row[2] * b[2][j]))
}
