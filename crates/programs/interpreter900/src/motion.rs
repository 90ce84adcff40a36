//! The movement of a block.
//!
//! Decision: I, J, K count from the start of the circle, R names its radius, negative that of the longer arc (DIN 66025). In
//! polar coordinates (G10) the first axis of the plane takes the radius, the second one the angle; the pole is the zero of the
//! program
//!
//! Decision: F in G95 is multiplied with the programmed speed S. The percentage P8818 counts before the limit of a circle

use bahn_path::{
    Axis, Barrier, Curve, FeedRate, OverrideLaw, PathElement, Plane, Position, Sense, TechnologyFunction,
};
use bahn_system900::PathParameter;

use crate::block::Work;
use crate::circle::{self, Centre};
use crate::frame::Frame;
use crate::modal::Interpolation;
use crate::refusal::Refusal;
use crate::run::{Item, Said, Then};

/// Without P8843 the radius may differ so much, mm [002:4371-4376].
const RADIUS_ERROR_MM: f64 = 0.003;
/// The circle is smaller than P8852 [002:4566-4604].
const CIRCLE_TOO_SMALL: u16 = 1237;

/// A movement that is to be appended.
pub(crate) struct Move {
    pub curve: Curve,
    pub end: Position,
    pub feed: FeedRate,
}

impl Work<'_> {
    /// Where the block leads, in coordinates of the program; `None` where it moves nothing.
    pub fn target(&self, said: &Said, frame: &Frame) -> Option<Position> {
        let modal = &self.run.modal;
        let named = |axis: &Axis| said.coordinates[*axis].is_some();
        if !Axis::ALL.iter().any(named) {
            return None;
        }
        let here = frame.to_program(&self.run.position);
        let mut target = here;
        for axis in Axis::ALL {
            if let Some(value) = said.coordinates[axis] {
                target[axis] = match modal.is_absolute {
                    true => value,
                    false => here[axis] + value,
                };
            }
        }
        if modal.is_polar
            && let Ok(plane) = self.plane()
        {
            let [radius, angle_deg] = plane.point(&target);
            let (sin, cos) = angle_deg.to_radians().sin_cos();
            plane.set(&mut target, [radius * cos, radius * sin]);
        }
        Some(target)
    }

    /// The plane of circles.
    pub fn plane(&self) -> Result<Plane, Refusal> {
        let g = self.run.modal.plane;
        let words = self.memory.plane_axes(self.channel, g);
        let [first, second, normal] = words.map(|logical| self.axes.slot(logical));
        let axes = first.zip(second).filter(|(first, second)| first != second);
        let (first, second) =
            axes.ok_or_else(|| Refusal::of(format!("the plane of G{g} has axes that the channel has not")))?;
        // A flat machine has none: any other one stands for it.
        let other = |axis: &Axis| ![first, second].contains(axis);
        let normal = normal.filter(other).or_else(|| Axis::ALL.into_iter().find(other));
        Ok(Plane {
            first,
            second,
            normal: normal.unwrap_or(first),
        })
    }

    /// The movement of a block to a place of the program.
    pub fn movement(&self, said: &Said, frame: &Frame, target: &Position) -> Result<Move, Refusal> {
        let end = frame.to_control(target);
        let sense = match self.run.modal.interpolation {
            Interpolation::Rapid => {
                return Ok(Move {
                    curve: Curve::Line,
                    end,
                    feed: self.rapid(),
                });
            }
            Interpolation::Line => {
                return Ok(Move {
                    curve: Curve::Line,
                    end,
                    feed: self.feed()?,
                });
            }
            Interpolation::Clockwise => Sense::Clockwise,
            Interpolation::CounterClockwise => Sense::CounterClockwise,
        };
        self.circle(said, frame, end, sense)
    }

    fn circle(&self, said: &Said, frame: &Frame, end: Position, sense: Sense) -> Result<Move, Refusal> {
        let plane = self.plane()?;
        let sense = match frame.turns_over() {
            true => sense.opposite(),
            false => sense,
        };
        let start = self.run.position;
        let centre = match said.radius {
            Some(radius) => Centre::Radius(radius),
            None => {
                // I, J, K belong to the axes of the plane in its order [002:891-934].
                let [first, second] = self.centre_words();
                let word = |index: usize| said.centre.get(index).copied().flatten().unwrap_or(0.0);
                if said.centre.iter().all(Option::is_none) {
                    return Err(Refusal::of(
                        "the circle has neither a centre (I, J, K) nor a radius (R)",
                    ));
                }
                // As a way from the start it is mirrored and rotated, and not shifted.
                let here = frame.to_program(&start);
                let [x, y] = plane.point(&here);
                let mut about = here;
                plane.set(&mut about, [x + word(first), y + word(second)]);
                let [s, c] = [plane.point(&start), plane.point(&frame.to_control(&about))];
                Centre::FromStart([c[0] - s[0], c[1] - s[1]])
            }
        };
        let admitted = self
            .memory
            .path(self.channel, PathParameter::RadiusError)
            .number();
        let admitted = admitted
            .filter(|admitted| *admitted > 0.0)
            .unwrap_or(RADIUS_ERROR_MM);
        let arc = circle::arc(plane, [&start, &end], centre, sense, admitted)?;
        let limit = self.circle_limit(plane, circle::radius(&arc, &start, &end))?;
        Ok(Move {
            curve: Curve::Arc(arc),
            end,
            feed: self.feed()?.up_to(limit),
        })
    }

    /// Which of I, J, K belong to the axes of the plane: G17 I and J, G18 K and I, G19 J and K.
    fn centre_words(&self) -> [usize; 2] {
        match self.run.modal.plane {
            18 | 118 => [2, 0],
            19 | 119 => [1, 2],
            _ => [0, 1],
        }
    }

    /// P8852 admits so much deviation of a circle: v = Kv * sqrt(2 * R * deviation) (inferred) [002:4566-4604].
    fn circle_limit(&self, plane: Plane, radius: f64) -> Result<f64, Refusal> {
        let deviation = self.path(PathParameter::CircleDynamics);
        if deviation <= 0.0 {
            return Ok(f64::INFINITY);
        }
        if radius <= deviation {
            let detail = format!("the radius {radius:.3} mm is not above P8852, {deviation} mm");
            return Err(Refusal::numbered(CIRCLE_TOO_SMALL, detail));
        }
        let gains = [plane.first, plane.second].map(|axis| self.axes.gain(self.memory, axis));
        let gain = gains.into_iter().flatten().fold(f64::INFINITY, f64::min);
        Ok(60.0 * gain * (2.0 * radius * deviation).sqrt())
    }

    /// P8816, or as fast as the axes can [002:4286-4292].
    pub fn rapid(&self) -> FeedRate {
        match self.path(PathParameter::RapidFeed) {
            feed if feed > 0.0 => FeedRate::Programmed(feed),
            _ => FeedRate::Rapid,
        }
    }

    /// The feed of G1, G2, G3.
    fn feed(&self) -> Result<FeedRate, Refusal> {
        let test = self.path(PathParameter::TestFeed);
        if test > 0.0 {
            return Ok(FeedRate::Programmed(test));
        }
        let modal = &self.run.modal;
        let feed = match modal.is_per_turn {
            true => modal.feed * modal.speed_rpm,
            false => modal.feed,
        };
        let feed = self.scaled(feed);
        match feed > 0.0 {
            true => Ok(FeedRate::Programmed(feed)),
            false => Err(Refusal::of("the block has no feed: F is 0")),
        }
    }

    /// A programmed feed with the percentage of P8818.
    pub fn scaled(&self, feed: f64) -> f64 {
        let percent = self
            .memory
            .path(self.channel, PathParameter::FeedPercent)
            .number();
        feed * percent.unwrap_or(100.0) / 100.0
    }

    /// Appends a movement with its functions; one that leads nowhere carries them alone.
    pub fn append(&mut self, to: Move, functions: Vec<TechnologyFunction>) {
        let start = self.run.position;
        let moves = to.curve.length(&start, &to.end) > 0.0;
        let (curve, end) = match moves {
            true => (to.curve, to.end),
            false => (Curve::Hold, start),
        };
        if !moves && functions.is_empty() {
            return;
        }
        let mut element = PathElement::new(self.at, self.run.sequence, curve, [start, end], to.feed);
        if self.run.modal.is_feed_fixed {
            element.override_law = OverrideLaw::Disabled;
        }
        element.functions = (!functions.is_empty()).then(|| functions.into_boxed_slice());
        self.push(element);
    }

    /// The path stops here, for a time, s.
    pub fn halt(&mut self, dwell_s: f64) {
        let ends = [self.run.position; 2];
        let mut element = PathElement::new(self.at, self.run.sequence, Curve::Hold, ends, FeedRate::Rapid);
        element.dwell_s = dwell_s;
        self.push(element);
    }

    fn push(&mut self, element: PathElement) {
        self.run.idle = 0;
        self.run.position = element.end;
        self.run.queue.push_back(Item::Element(Box::new(element)));
    }

    /// What comes after is read when everything before is executed.
    pub fn wait_for_execution(&mut self) {
        self.wait(Barrier::Acknowledge { block: self.at }, Then::On);
    }

    pub fn wait(&mut self, barrier: Barrier, then: Then) {
        self.run.idle = 0;
        self.run.queue.push_back(Item::Barrier(Box::new(barrier), then));
    }

    /// Whether the movement of the block ends with an exact stop: G8, G28, and G0 by P8858 [002:4651-4660].
    pub fn stops_exactly(&self, said: &Said) -> bool {
        let modal = &self.run.modal;
        let rapid = modal.interpolation == Interpolation::Rapid;
        let ends_so = rapid && self.path(PathParameter::RapidEnd) != 2.0;
        ends_so || said.stops_exactly.unwrap_or(modal.stops_exactly)
    }
}
