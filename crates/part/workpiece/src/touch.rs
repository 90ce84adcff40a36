//! Probing the workpiece.

use bahn_path::{Axis, Position};

use crate::part::Part;
use crate::setup::Local;

/// Finest resolution of the controls is 0.1 µm: touch positions are given in steps of it.
const STEPS_PER_MM: f64 = 1e4;

/// The ball touches when its gap is smaller than this, mm.
const CONTACT_MM: f64 = 1e-6;

impl Part {
    /// Where a stylus that moves in a straight line from `from` to `to` first touches the material;
    /// `None` when it does not, or when an axis of the blank has no position.
    ///
    /// Positions are those of the stylus tip: the centre of the ball in the working plane, its lowest
    /// point in the tool axis. So a touch in the tool axis gives the height of the surface, and a touch
    /// in the plane gives the surface plus or minus the radius. A stylus that is in contact from the
    /// beginning (STYLUS ALREADY IN CONTACT [003:8005-8006]) touches at `from`.
    pub fn touch(&self, from: &Position, to: &Position, stylus_radius: f64) -> Option<Position> {
        let radius = if stylus_radius > 0.0 { stylus_radius } else { 0.0 };
        let ball_centre = |p: &Position| {
            let [x, y, z] = self.setup.local(p)?;
            Some([x, y, z + radius])
        };
        let (a, b) = (ball_centre(from)?, ball_centre(to)?);
        let t = self.first_contact(a, b, radius)?;
        let mut position = *from;
        for axis in Axis::ALL {
            let delta = to[axis] - from[axis];
            if delta.is_nan() || delta == 0.0 {
                continue;
            }
            let exact = from[axis] + delta * t;
            position[axis] = (exact * STEPS_PER_MM).round() / STEPS_PER_MM;
        }
        Some(position)
    }

    /// Fraction of the line at which the ball touches the first column.
    fn first_contact(&self, a: Local, b: Local, radius: f64) -> Option<f64> {
        let delta = [b[0] - a[0], b[1] - a[1], b[2] - a[2]];
        let length = delta.iter().map(|d| d * d).sum::<f64>().sqrt();
        let reach = |low: f64, high: f64, step: f64, count: usize| {
            let first = ((low - radius) / step).floor().clamp(0.0, count as f64) as usize;
            let end = (((high + radius) / step).floor() + 1.0).clamp(0.0, count as f64) as usize;
            first..end
        };
        let columns = reach(a[0].min(b[0]), a[0].max(b[0]), self.grid.dx, self.grid.nx);
        let rows = reach(a[1].min(b[1]), a[1].max(b[1]), self.grid.dy, self.grid.ny);
        let lowest = a[2].min(b[2]) - radius;
        let mut travel = f64::INFINITY;
        for j in rows {
            for i in columns.clone() {
                let height = f64::from(self.height(i, j));
                if height > 0.0 && height >= lowest {
                    let corner = [i as f64 * self.grid.dx, j as f64 * self.grid.dy];
                    let size = [self.grid.dx, self.grid.dy, height];
                    let limit = length.min(travel);
                    if let Some(hit) = travel_to_box(a, delta, length, radius, corner, size, limit) {
                        travel = travel.min(hit);
                    }
                }
            }
        }
        if travel > length {
            None
        } else if length > 0.0 {
            Some(travel / length)
        } else {
            Some(0.0)
        }
    }
}

/// How far the ball travels until it touches a column, if not farther than `limit`. It may always
/// advance by its gap to the column.
fn travel_to_box(
    from: Local,
    delta: Local,
    length: f64,
    radius: f64,
    corner: [f64; 2],
    size: Local,
    limit: f64,
) -> Option<f64> {
    /// A ball that only grazes the column comes nearer in ever smaller steps.
    const STEPS: usize = 400;
    let low = [corner[0], corner[1], 0.0];
    let mut travel = 0.0;
    for _ in 0..STEPS {
        let t = if length > 0.0 { travel / length } else { 0.0 };
        let square: f64 = (0..3)
            .map(|k| {
                let value = from[k] + delta[k] * t;
                let outside = (low[k] - value).max(value - low[k] - size[k]).max(0.0);
                outside * outside
            })
            .sum();
        let gap = square.sqrt() - radius;
        if gap < CONTACT_MM {
            return Some(travel);
        }
        travel += gap;
        if travel > limit {
            return None;
        }
    }
    None
}
