//! What the tests share: a path as a list, built block by block, and the run of a planner over it.
#![allow(dead_code, reason = "every test file uses its part")]

pub mod random;

use bahn_motion::{AuxiliaryTimes, Limits, Planned, PlannedStep, Planner};
use bahn_path::{
    Arc, At, Axis, BlockRef, CornerArc, Curve, ElementSource, FeedRate, Function, LiveData, OverrideLaw,
    PathElement, PerAxis, Plane, Position, Sense, SpindleOrder, Step, Synchronisation, TechnologyFunction,
    sweep_deg,
};

/// 15 m/min, 1 m/s², radial 0.5 m/s², corners up to 10 degrees, servo lag.
pub fn limits() -> Limits {
    Limits {
        max_feed_mm_min: PerAxis::splat(15_000.0),
        acceleration_m_s2: PerAxis::splat(1.0),
        radial_acceleration_m_s2: 0.5,
        corner_angle_deg: 10.0,
        servo_lag: true,
        cycle_s: 0.003,
        servo_window_s: bahn_motion::SERVO_WINDOW_S,
        spindle: Default::default(),
        feed_override_percent: 100.0,
        rapid_override_percent: 100.0,
    }
}

/// A list of steps as a source.
#[derive(Debug)]
pub struct List {
    pub steps: std::vec::IntoIter<Step<&'static str>>,
    pub resumed: usize,
}

impl ElementSource for List {
    type Error = &'static str;

    fn next(&mut self) -> Step<&'static str> {
        self.steps.next().unwrap_or(Step::End)
    }

    fn resume(&mut self, _: LiveData) {
        self.resumed += 1;
    }
}

pub fn list(steps: Vec<Step<&'static str>>) -> List {
    List {
        steps: steps.into_iter(),
        resumed: 0,
    }
}

pub fn planner_of(elements: &[PathElement], limits: &Limits) -> Planner<List> {
    let steps = elements.iter().cloned().map(Step::Element).collect();
    Planner::new(list(steps), limits, &AuxiliaryTimes::default())
}

/// All elements planned.
pub fn plan(elements: &[PathElement], limits: &Limits) -> Vec<Planned> {
    let mut planner = planner_of(elements, limits);
    let mut planned = Vec::new();
    while let PlannedStep::Element(element) = planner.next() {
        planned.push(element);
    }
    planned
}

pub fn time_s(planned: &[Planned]) -> f64 {
    planned.iter().map(Planned::duration_s).sum()
}

/// Builds a path block by block from the position where it is.
#[derive(Clone, Debug)]
pub struct Path {
    pub at: Position,
    pub feed: FeedRate,
    pub elements: Vec<PathElement>,
}

impl Path {
    /// From zero, feed in mm/min.
    pub fn new(feed: f64) -> Path {
        Path {
            at: Position::ZERO,
            feed: FeedRate::Programmed(feed),
            elements: Vec::new(),
        }
    }

    pub fn feed(&mut self, feed: FeedRate) -> &mut Path {
        self.feed = feed;
        self
    }

    /// A line to the given coordinates.
    pub fn line(&mut self, to: &[(Axis, f64)]) -> &mut Path {
        let mut end = self.at;
        for (axis, value) in to {
            end[*axis] = *value;
        }
        self.to(Curve::Line, end)
    }

    /// A line by increments.
    pub fn by(&mut self, delta: &[(Axis, f64)]) -> &mut Path {
        let to: Vec<_> = delta
            .iter()
            .map(|(axis, d)| (*axis, self.at[*axis] + d))
            .collect();
        self.line(&to)
    }

    /// An arc in XY about a centre to an end point in a sense.
    pub fn arc(&mut self, centre: [f64; 2], to: [f64; 2], sense: Sense) -> &mut Path {
        let start = [self.at[Axis::X], self.at[Axis::Y]];
        let sweep_deg = sweep_deg(centre, start, to, sense);
        let mut end = self.at;
        (end[Axis::X], end[Axis::Y]) = (to[0], to[1]);
        self.to(
            Curve::Arc(Arc {
                plane: Plane::XY,
                centre,
                sweep_deg,
            }),
            end,
        )
    }

    /// An arc in XY that starts in the direction `heading_deg`, radius and sweep given, with height.
    pub fn turn(&mut self, heading_deg: f64, radius: f64, sweep_deg: f64, height: f64) -> &mut Path {
        self.spiral(heading_deg, [radius, radius], sweep_deg, height)
    }

    /// The same with different radii at start and end.
    pub fn spiral(&mut self, heading_deg: f64, radii: [f64; 2], sweep_deg: f64, height: f64) -> &mut Path {
        let side = (heading_deg + 90.0f64.copysign(sweep_deg)).to_radians();
        let centre = [
            self.at[Axis::X] + radii[0] * side.cos(),
            self.at[Axis::Y] + radii[0] * side.sin(),
        ];
        let out = side + std::f64::consts::PI + sweep_deg.to_radians();
        let mut end = self.at;
        end[Axis::X] = centre[0] + radii[1] * out.cos();
        end[Axis::Y] = centre[1] + radii[1] * out.sin();
        end[Axis::Z] += height;
        self.to(
            Curve::Arc(Arc {
                plane: Plane::XY,
                centre,
                sweep_deg,
            }),
            end,
        )
    }

    /// An arc in space from one direction into another, neither of length 1 nor perpendicular.
    pub fn corner(&mut self, from: [f64; 3], to: [f64; 3], radius: f64) -> &mut Path {
        let unit = |v: [f64; 3]| v.map(|x| x / (v[0] * v[0] + v[1] * v[1] + v[2] * v[2]).sqrt());
        let (a, b) = (unit(from), unit(to));
        let dot = a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
        // tan of half the angle between two directions.
        let leg = radius * ((1.0 - dot) / (1.0 + dot)).sqrt();
        let mut end = self.at;
        let mut corner = [self.at[Axis::X], self.at[Axis::Y], self.at[Axis::Z]];
        for (i, axis) in [Axis::X, Axis::Y, Axis::Z].into_iter().enumerate() {
            corner[i] += leg * a[i];
            end[axis] = corner[i] + leg * b[i];
        }
        self.to(Curve::Corner(CornerArc { corner }), end)
    }

    /// A block without movement.
    pub fn hold(&mut self, dwell_s: f64) -> &mut Path {
        let at = self.at;
        self.to(Curve::Hold, at);
        self.last().dwell_s = dwell_s;
        self
    }

    pub fn to(&mut self, curve: Curve, end: Position) -> &mut Path {
        let count = self.elements.len() as u32 + 1;
        self.elements.push(PathElement {
            block: BlockRef {
                program: 0,
                block: count,
            },
            sequence: u64::from(count),
            curve,
            start: self.at,
            end,
            feed: self.feed,
            override_law: OverrideLaw::Free,
            constant_speed: false,
            tangential_end: false,
            end_feed: None,
            dwell_s: 0.0,
            placement: None,
            functions: None,
        });
        self.at = end;
        self
    }

    /// The last block, to change it.
    #[expect(clippy::expect_used, reason = "the tests have put a block there")]
    pub fn last(&mut self) -> &mut PathElement {
        self.elements.last_mut().expect("a block")
    }
}

/// The path run from its end to its start.
pub fn reversed(elements: &[PathElement]) -> Vec<PathElement> {
    let flags: Vec<bool> = elements.iter().map(|e| e.constant_speed).collect();
    let count = elements.len();
    elements
        .iter()
        .rev()
        .enumerate()
        .map(|(i, element)| {
            let curve = match element.curve {
                Curve::Arc(arc) => Curve::Arc(Arc {
                    sweep_deg: -arc.sweep_deg,
                    ..arc
                }),
                other => other,
            };
            // M90 belongs to a corner: the one at the end is now the one of the element before.
            let constant_speed = count.checked_sub(i + 2).is_some_and(|corner| flags[corner]);
            PathElement {
                curve,
                start: element.end,
                end: element.start,
                constant_speed,
                ..element.clone()
            }
        })
        .collect()
}

/// A function of the path as the programs of the manuals have it: what M3, M4, M5 and M30 order the spindle to do.
pub fn function(function: Function, at: At, synchronisation: Synchronisation) -> TechnologyFunction {
    let spindle = match function {
        Function::M(3 | 13) => Some(SpindleOrder::Clockwise),
        Function::M(4 | 14) => Some(SpindleOrder::CounterClockwise),
        Function::M(5) => Some(SpindleOrder::Stop),
        Function::M(0 | 2 | 6 | 30) => Some(SpindleOrder::StopWithRun),
        _ => None,
    };
    TechnologyFunction {
        spindle,
        ..TechnologyFunction::new(function, at, synchronisation)
    }
}
