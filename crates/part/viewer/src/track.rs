//! The path as it is drawn, with time and block.

use bahn_path::{Arc, Axis, BlockRef, Curve, FeedRate, Function, PathElement, Position, ToolShape};

use crate::bytes::{differences, varint};

/// How far lines may be from an arc, mm; for drawing only.
const FIRST_TOLERANCE_MM: f64 = 0.02;
/// Points of a page.
const MOST_POINTS: usize = 250_000;
/// Points in a row that may be left out.
const MOST_LEFT_OUT: usize = 64;
/// Tools that are told apart.
const MOST_TOOLS: usize = 63;
/// Greatest angle of a chord, degrees.
const MOST_CHORD_DEG: f64 = 15.0;
/// Chords of an element at most.
const MOST_CHORDS: f64 = 2000.0;

/// How the tool moves to a point.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[repr(u8)]
enum Kind {
    Rapid = 0,
    Feed = 1,
    /// The tool stands still.
    Hold = 2,
    /// How the tool comes there is not known, or not in the coordinates of the blank.
    Hidden = 3,
}

#[derive(Clone, Copy, Debug)]
struct Point {
    /// X, Y, Z, mm.
    at: [f64; 3],
    time_s: f64,
    block: BlockRef,
    kind: Kind,
    tool: u8,
    /// The last one of its element: a place to stop at.
    is_end: bool,
}

/// A tool that was called.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct TrackTool {
    /// `None` before the first TOOL CALL.
    pub number: Option<u32>,
    pub shape: ToolShape,
    pub axis: Axis,
}

/// Collects the path. Its size is bounded.
#[derive(Clone, Debug)]
pub(crate) struct Track {
    points: Vec<Point>,
    tools: Vec<TrackTool>,
    tool: u8,
    /// Of chords, and of what is left out when there are too many points: of those before `thinned`.
    tolerance_mm: f64,
    thinned: usize,
    /// How often points were left out.
    times_thinned: u32,
    /// Points that are kept; when there are more, the tolerance is doubled and they become fewer.
    most: usize,
}

impl Default for Track {
    fn default() -> Track {
        Track::of_points(MOST_POINTS)
    }
}

impl Track {
    /// With so many points at most; more than those of two arcs.
    pub fn of_points(most: usize) -> Track {
        Track {
            points: Vec::new(),
            tools: vec![TrackTool {
                number: None,
                shape: ToolShape::default(),
                axis: Axis::Z,
            }],
            tool: 0,
            tolerance_mm: FIRST_TOLERANCE_MM,
            thinned: 0,
            times_thinned: 0,
            most,
        }
    }

    /// Takes an element that ends at a time.
    pub fn element(&mut self, element: &PathElement, end_s: f64) {
        for function in element.functions() {
            if let Function::Tool(call) = &function.function {
                self.take_tool(TrackTool {
                    number: Some(call.tool),
                    shape: call.shape,
                    axis: call.axis,
                });
            }
        }
        let begin_s = self.points.last().map_or(0.0, |point| point.time_s);
        let end_s = if end_s.is_finite() {
            end_s.max(begin_s)
        } else {
            begin_s
        };
        if self.points.len() + MOST_CHORDS as usize > self.most {
            self.thin();
        }
        self.draw(element, begin_s, end_s);
    }

    fn draw(&mut self, element: &PathElement, begin_s: f64, end_s: f64) {
        let (block, tool) = (element.block, self.tool);
        let point = |at, time_s, kind, is_end| Point {
            at,
            time_s,
            block,
            kind,
            tool,
            is_end,
        };
        let start = filled(&element.start, &element.end);
        let places = (place(&start), place(&element.end));
        let (Some(from), Some(to)) = places else {
            // Time goes on where the tool was seen last.
            let at = self
                .points
                .last()
                .map(|last| last.at)
                .or(places.1)
                .unwrap_or_default();
            self.push(point(at, end_s, Kind::Hidden, true));
            return;
        };
        if element.curve == Curve::Hold || element.placement.is_some() {
            let kind = if element.curve == Curve::Hold {
                Kind::Hold
            } else {
                Kind::Hidden
            };
            let at = if kind == Kind::Hold {
                to
            } else {
                self.points.last().map_or(to, |last| last.at)
            };
            self.push(point(at, end_s, kind, true));
            return;
        }
        if self
            .points
            .last()
            .is_none_or(|last| distance(last.at, from) > 1e-6)
        {
            self.push(point(from, begin_s, Kind::Hidden, false));
        }
        let kind = match element.feed {
            FeedRate::Rapid => Kind::Rapid,
            FeedRate::Programmed(_) => Kind::Feed,
        };
        let count = self.chords(element, &start);
        for step in 1..=count {
            let t = f64::from(step) / f64::from(count);
            let at = if step == count {
                Some(to)
            } else {
                place(&element.curve.position(&start, &element.end, t))
            };
            let Some(at) = at else { continue };
            self.push(point(at, begin_s + (end_s - begin_s) * t, kind, step == count));
        }
    }

    /// Chords whose middle is not farther from the curve than the tolerance: sagitta = r (1 - cos(a/2)).
    fn chords(&self, element: &PathElement, start: &Position) -> u32 {
        let (radius, sweep_deg) = match &element.curve {
            Curve::Arc(arc) => (radius(arc, start, &element.end), arc.sweep_deg.abs()),
            Curve::Corner(corner) => {
                let circle = corner.circle(start, &element.end);
                (circle.radius_mm, circle.sweep_rad.to_degrees().abs())
            }
            Curve::Hold | Curve::Line => return 1,
        };
        let half = (1.0 - self.tolerance_mm / radius)
            .clamp(-1.0, 1.0)
            .acos()
            .to_degrees();
        let each = (2.0 * half).min(MOST_CHORD_DEG);
        let count = (sweep_deg / each).ceil();
        if count.is_finite() {
            count.clamp(1.0, MOST_CHORDS) as u32
        } else {
            1
        }
    }

    fn push(&mut self, point: Point) {
        // The tool stands on in the same block: one point for all.
        if let Some(last) = self.points.last_mut()
            && (last.kind, last.block, last.tool) == (point.kind, point.block, point.tool)
            && matches!(point.kind, Kind::Hold | Kind::Hidden)
            && last.at == point.at
        {
            last.time_s = point.time_s;
            return;
        }
        self.points.push(point);
    }

    fn take_tool(&mut self, tool: TrackTool) {
        let at = match self.tools.iter().position(|known| *known == tool) {
            Some(at) => at,
            None if self.tools.len() < MOST_TOOLS => {
                self.tools.push(tool);
                self.tools.len() - 1
            }
            None => MOST_TOOLS - 1,
        };
        self.tool = at as u8;
    }

    /// Leaves out points that are near the line between their neighbours, with a tolerance that grows until few are left.
    fn thin(&mut self) {
        let enough = self.most / 2;
        self.times_thinned = self.times_thinned.wrapping_add(1);
        const COARSEST_MM: f64 = 1e4;
        loop {
            let all = self.points.split_off(self.thinned.min(self.points.len()));
            let mut first = 0;
            while let Some(anchor) = all.get(first) {
                self.points.push(*anchor);
                let mut last = first + 1;
                while last - first < MOST_LEFT_OUT && self.may_leave_out(&all, first, last) {
                    last += 1;
                }
                first = last;
            }
            if self.points.len() <= enough || self.tolerance_mm > COARSEST_MM {
                // The last one may still begin a line.
                self.thinned = self.points.len().saturating_sub(1);
                return;
            }
            self.tolerance_mm *= 2.0;
            self.thinned = 0;
        }
    }

    /// Whether the points after `first` up to `last` can be left out, when the one after `last` is the next.
    fn may_leave_out(&self, all: &[Point], first: usize, last: usize) -> bool {
        let (Some(from), Some(to)) = (all.get(first), all.get(last + 1)) else {
            return false;
        };
        all.get(first + 1..=last).unwrap_or_default().iter().all(|point| {
            (point.kind, point.tool) == (to.kind, to.tool)
                && matches!(point.kind, Kind::Rapid | Kind::Feed)
                && off_line(point.at, from.at, to.at) <= self.tolerance_mm
        })
    }

    /// Forgets the path; the tool stays.
    pub fn clear(&mut self) {
        self.points.clear();
        self.thinned = 0;
        self.tolerance_mm = FIRST_TOLERANCE_MM;
    }

    pub fn len(&self) -> usize {
        self.points.len()
    }

    pub fn times_thinned(&self) -> u32 {
        self.times_thinned
    }

    /// Where the tool stands.
    pub fn last(&self) -> Option<[f64; 3]> {
        self.points.last().map(|point| point.at)
    }

    /// Which of the tools is in the spindle.
    pub fn tool(&self) -> usize {
        usize::from(self.tool)
    }

    pub fn tools(&self) -> &[TrackTool] {
        &self.tools
    }

    /// How far the lines are from the path at most: what was left out, too, may be as far from them as chords from arcs.
    pub fn tolerance_mm(&self) -> f64 {
        if self.thinned > 0 {
            2.0 * self.tolerance_mm
        } else {
            self.tolerance_mm
        }
    }

    /// The programs that it knows, always the main program.
    pub fn programs(&self) -> Vec<u16> {
        let mut programs: Vec<u16> = self.points.iter().map(|point| point.block.program).collect();
        programs.push(0);
        programs.sort_unstable();
        programs.dedup();
        programs
    }

    /// Least and greatest coordinates, X, Y, Z; `None` without a point.
    pub fn bounds(&self) -> Option<[[f64; 3]; 2]> {
        let seen = self.points.iter().filter(|point| point.kind != Kind::Hidden);
        seen.map(|point| [point.at; 2]).reduce(|[min, max], [at, _]| {
            [
                [0, 1, 2].map(|k| f64::min(min[k], at[k])),
                [0, 1, 2].map(|k| f64::max(max[k], at[k])),
            ]
        })
    }

    /// The points from one on as bytes: their count, then column after column, each number as its difference from the one before:
    /// place on three axes from `min` in µm, time in ms, row of the list; then for each point kind, end and tool in a byte.
    pub fn written(
        &self,
        from: usize,
        axes: [usize; 3],
        min: [f64; 3],
        row: impl Fn(BlockRef) -> Option<u32>,
    ) -> Vec<u8> {
        let mut out = Vec::new();
        let points = self.points.get(from..).unwrap_or_default();
        varint(&mut out, points.len() as u64);
        for (axis, min) in axes.into_iter().zip(min) {
            let place = |point: &Point| point.at.get(axis).copied().unwrap_or_default() - min;
            differences(
                &mut out,
                points.iter().map(|point| (place(point) * 1000.0).round() as i64),
            );
        }
        differences(
            &mut out,
            points.iter().map(|point| (point.time_s * 1000.0).round() as i64),
        );
        differences(
            &mut out,
            points.iter().map(|point| row(point.block).map_or(-1, i64::from)),
        );
        out.extend(
            points
                .iter()
                .map(|point| point.kind as u8 | u8::from(point.is_end) << 7),
        );
        out.extend(points.iter().map(|point| point.tool));
        out
    }
}

fn radius(arc: &Arc, start: &Position, end: &Position) -> f64 {
    let (at_start, at_end) = arc.radii(start, end);
    at_start.max(at_end)
}

/// An axis that gets its first position by the element stands there from the beginning.
fn filled(start: &Position, end: &Position) -> Position {
    let mut filled = *start;
    for axis in Axis::ALL {
        if filled.get(axis).is_none() {
            filled[axis] = end[axis];
        }
    }
    filled
}

/// X, Y, Z; a parallel axis carries the tool in the same direction, so both add up (inferred) [003:5397-5432].
pub(crate) fn place(position: &Position) -> Option<[f64; 3]> {
    let along = |main: Axis, parallel: Axis| match (position.get(main), position.get(parallel)) {
        (Some(a), Some(b)) => Some(a + b),
        (a, b) => a.or(b),
    };
    Some([
        along(Axis::X, Axis::U)?,
        along(Axis::Y, Axis::V)?,
        along(Axis::Z, Axis::W)?,
    ])
}

fn distance(a: [f64; 3], b: [f64; 3]) -> f64 {
    (a[0] - b[0]).hypot(a[1] - b[1]).hypot(a[2] - b[2])
}

/// Distance of a point from a straight line between two others.
fn off_line(point: [f64; 3], from: [f64; 3], to: [f64; 3]) -> f64 {
    let delta = [0, 1, 2].map(|k| to[k] - from[k]);
    let length = delta.iter().map(|w| w * w).sum::<f64>();
    let along: f64 = [0, 1, 2].iter().map(|k| (point[*k] - from[*k]) * delta[*k]).sum();
    let t = if length > 0.0 {
        (along / length).clamp(0.0, 1.0)
    } else {
        0.0
    };
    distance(point, [0, 1, 2].map(|k| from[k] + delta[k] * t))
}

#[cfg(test)]
mod tests {
    use super::*;
    use bahn_path::Plane;

    fn at(x: f64, y: f64, z: f64) -> Position {
        let mut position = Position::UNKNOWN;
        (position[Axis::X], position[Axis::Y], position[Axis::Z]) = (x, y, z);
        position
    }

    fn element(curve: Curve, start: Position, end: Position, block: u32) -> PathElement {
        let feed = FeedRate::Programmed(100.0);
        PathElement::new(BlockRef { program: 0, block }, 0, curve, [start, end], feed)
    }

    /// A full circle of 50 mm in 31.4 s: chords keep within the tolerance and are no finer than that needs, and time
    /// goes on evenly.
    #[test]
    fn arcs_become_chords() {
        let arc = Arc {
            plane: Plane::XY,
            centre: [0.0, 0.0],
            sweep_deg: 360.0,
        };
        let start = at(50.0, 0.0, -3.0);
        let mut track = Track::default();
        track.element(&element(Curve::Arc(arc), start, start, 4), 31.4);
        let chords = track.points.len() - 1;
        let sagitta = 50.0 * (1.0 - (std::f64::consts::PI / chords as f64).cos());
        assert!(
            (0.5 * FIRST_TOLERANCE_MM..=FIRST_TOLERANCE_MM).contains(&sagitta),
            "{sagitta}"
        );
        for (k, point) in track.points.iter().enumerate() {
            assert!((point.at[0].hypot(point.at[1]) - 50.0).abs() < 1e-9);
            assert!((point.time_s - 31.4 * k as f64 / chords as f64).abs() < 1e-9);
        }
        assert_eq!(track.points.iter().filter(|point| point.is_end).count(), 1);
    }

    /// A million lines of 0.01 mm along a wave: few points are left, the wave stays within the tolerance that is said, and
    /// the last point is the end.
    #[test]
    fn a_long_path_becomes_few_points() {
        let wave = |k: u32| at(0.01 * f64::from(k), 5.0 * (f64::from(k) * 1e-3).sin(), 0.0);
        let mut track = Track::default();
        for k in 0..1_000_000 {
            track.element(
                &element(Curve::Line, wave(k), wave(k + 1), k / 100),
                1e-3 * f64::from(k + 1),
            );
        }
        assert!(track.points.len() <= MOST_POINTS, "{}", track.points.len());
        assert!(
            track.tolerance_mm() <= 2.0 * FIRST_TOLERANCE_MM,
            "{}",
            track.tolerance_mm()
        );
        let last = track.points.last().unwrap();
        assert!((last.time_s - 1000.0).abs() < 1e-9 && (last.at[0] - 10_000.0).abs() < 1e-6);
        for pair in track.points.windows(2) {
            assert!(pair[1].time_s >= pair[0].time_s);
            let middle = 0.5 * (pair[0].at[0] + pair[1].at[0]);
            let y = 0.5 * (pair[0].at[1] + pair[1].at[1]);
            assert!(
                (y - 5.0 * (0.1 * middle).sin()).abs() <= track.tolerance_mm(),
                "{middle}"
            );
        }
    }

    /// Where an axis has no position yet nothing is drawn, but time goes on; standing is one point, however often.
    #[test]
    fn standing_and_unknown_moves_are_points_in_time() {
        let mut track = Track::default();
        let mut only_z = Position::UNKNOWN;
        only_z[Axis::Z] = 100.0;
        track.element(&element(Curve::Line, Position::UNKNOWN, only_z, 1), 2.0);
        track.element(
            &element(Curve::Line, at(0.0, 0.0, 100.0), at(10.0, 0.0, 100.0), 2),
            3.0,
        );
        for k in 0..5 {
            let here = at(10.0, 0.0, 100.0);
            track.element(&element(Curve::Hold, here, here, 3), 4.0 + f64::from(k));
        }
        let kinds: Vec<Kind> = track.points.iter().map(|point| point.kind).collect();
        assert_eq!(kinds, [Kind::Hidden, Kind::Hidden, Kind::Feed, Kind::Hold]);
        assert_eq!(track.points.last().unwrap().time_s, 8.0);
        assert_eq!(track.bounds(), Some([[10.0, 0.0, 100.0], [10.0, 0.0, 100.0]]));
    }

    /// A feed of 0 never ends: the picture of the path goes on without a time.
    #[test]
    fn a_path_without_end_has_finite_times() {
        let mut track = Track::default();
        track.element(
            &element(Curve::Line, at(0.0, 0.0, 0.0), at(1.0, 0.0, 0.0), 1),
            f64::INFINITY,
        );
        track.element(
            &element(Curve::Line, at(1.0, 0.0, 0.0), at(2.0, 0.0, 0.0), 2),
            f64::INFINITY,
        );
        assert!(track.points.iter().all(|point| point.time_s == 0.0));
    }
}
