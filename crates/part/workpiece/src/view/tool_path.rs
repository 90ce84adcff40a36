//! The tool path over a view: feed solid, rapid traverse dashed, nothing where the part hides it.

use super::edges::Spot;
use super::raycast::Vector;
use super::{Area, Page};
use crate::trail::{Move, Trail};
use bahn_picture::{Colour, Image};

/// A point of the picture and its distance from the eye, pixels.
type Seen = [f64; 3];

/// Draws the path in an area of the picture, all of it where there are no spots. `project` gives a point of the
/// blank its place in the picture.
pub(super) fn draw(
    image: &mut Image,
    trail: &Trail,
    project: impl Fn(Vector) -> Seen,
    spots: &[Spot],
    area: &Area,
    page: &Page,
) {
    let mut pen = Pen {
        area: *area,
        spots,
        columns: image.width() as usize,
        image,
        width: page.line_width(),
    };
    for movement in trail.moves() {
        if page.is_stopped() {
            return;
        }
        let Move { from, to, rapid } = movement;
        let [from, to] = [from, to].map(|point| project(point.map(f64::from)));
        pen.line(from, to, *rapid);
    }
}

struct Pen<'a> {
    image: &'a mut Image,
    area: Area,
    spots: &'a [Spot],
    columns: usize,
    width: f64,
}

impl Pen<'_> {
    /// Length of the pieces that are seen or hidden as a whole, pixels.
    const PIECE: f64 = 3.0;

    fn line(&mut self, from: Seen, to: Seen, rapid: bool) {
        let length = (to[0] - from[0]).hypot(to[1] - from[1]);
        let at = |share: f64| [0, 1, 2].map(|k| from[k] + (to[k] - from[k]) * share);
        let Some([enter, leave]) = inside([from[0], from[1]], [to[0], to[1]], &self.area) else {
            return;
        };
        let pieces = ((leave - enter) * length / Pen::PIECE).ceil().max(1.0);
        let share = |k: f64| enter + (leave - enter) * k / pieces;
        // Pieces that follow each other are drawn in one go, some at a time: a line costs the area of its box.
        const TOGETHER: u32 = 8;
        let mut open: Option<(Seen, u32)> = None;
        for k in 0..pieces as u32 {
            let ends = [k, k + 1].map(|k| at(share(f64::from(k))));
            // Counted from the middle, so that there and back is the same line of dashes.
            let passed = (share(f64::from(k) + 0.5) - 0.5) * length + 0.3 * self.pattern();
            let drawn =
                self.is_seen(&ends) && (!rapid || passed.rem_euclid(self.pattern()) < 0.6 * self.pattern());
            let (start, count) = open.unwrap_or((ends[0], 0));
            if drawn && count + 1 < TOGETHER && f64::from(k + 1) < pieces {
                open = Some((start, count + 1));
                continue;
            }
            let end = if drawn { ends[1] } else { ends[0] };
            if drawn || open.is_some() {
                let colour = if rapid { RAPID } else { FEED };
                self.image
                    .line([start[0], start[1]], [end[0], end[1]], self.width, colour);
            }
            open = None;
        }
    }

    fn pattern(&self) -> f64 {
        12.0 * self.width.max(1.0)
    }

    /// Whether the middle of a piece lies before the part, or on it.
    fn is_seen(&self, [a, b]: &[Seen; 2]) -> bool {
        /// The tip moves on the surface that it leaves: so far behind it is still seen, pixels.
        const DEPTH: f64 = 3.0;
        let middle = [0, 1, 2].map(|k| 0.5 * (a[k] + b[k]));
        let (x, y) = (middle[0].max(0.0) as usize, middle[1].max(0.0) as usize);
        self.spots
            .get(y * self.columns + x.min(self.columns.saturating_sub(1)))
            .is_none_or(|spot| middle[2] < f64::from(spot.distance()) + DEPTH)
    }
}

/// The part of a line inside an area, as shares of its length (Liang and Barsky).
fn inside(from: [f64; 2], to: [f64; 2], area: &Area) -> Option<[f64; 2]> {
    let (mut enter, mut leave) = (0.0_f64, 1.0_f64);
    for k in 0..2 {
        let delta = to[k] - from[k];
        for (toward, room) in [(-delta, from[k] - area.min[k]), (delta, area.max[k] - from[k])] {
            if toward == 0.0 {
                if room < 0.0 {
                    return None;
                }
            } else if toward < 0.0 {
                enter = enter.max(room / toward);
            } else {
                leave = leave.min(room / toward);
            }
        }
    }
    // Also false for what is not a number.
    (enter <= leave).then_some([enter, leave])
}

const FEED: Colour = [24, 66, 190];
const RAPID: Colour = [196, 60, 150];

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn lines_are_clipped() {
        let area = Area {
            min: [0.0, 10.0],
            max: [100.0, 50.0],
        };
        assert_eq!(inside([-100.0, 20.0], [100.0, 20.0], &area), Some([0.5, 1.0]));
        assert_eq!(inside([50.0, 0.0], [50.0, 100.0], &area), Some([0.1, 0.5]));
        assert_eq!(inside([50.0, 30.0], [50.0, 30.0], &area), Some([0.0, 1.0]));
        assert_eq!(inside([-5.0, 30.0], [-1.0, 40.0], &area), None);
        assert_eq!(inside([0.0, 0.0], [100.0, 9.0], &area), None);
    }
}
