//! A probing movement on a straight line: on until a stylus is deflected, back to where it was, and home.

use bahn_motion::Aim;
use bahn_path::{Axis, Direction, PerAxis, Position};

use crate::axes::OwnAxes;
use crate::axis::AxisUnit;
use crate::kinematics::Chain;
use crate::now::Now;
use crate::straight::Straight;

/// A straight movement that ends where the stylus touches.
#[derive(Clone, Copy, Debug)]
pub struct Probing {
    phase: Phase,
    line: Straight,
    feed_mm_min: f64,
    /// Feed back to the start, mm/min; `None` where it ends at the touch.
    home_mm_min: Option<f64>,
    /// The software limit that lies within the way: it ends there [000:3522].
    limit: Option<(Axis, Direction)>,
    /// Where along the line the stylus was deflected, mm.
    touch: Option<f64>,
}

#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Phase {
    /// Until it is told to begin.
    Waits,
    Search,
    /// Touched: down to a standstill.
    Brake,
    /// Back to where the stylus was deflected.
    Return,
    /// Back to the start.
    Home,
}

/// What a probing movement comes to in a cycle.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Probed {
    /// The movement goes on; nothing was touched yet.
    Moves,
    /// The stylus was deflected in this cycle; the axes still move.
    Touches,
    /// The axes stand: where the stylus was deflected, path coordinates, or it was not.
    Over(Option<Position>),
    /// The axes stand at a software limit, and the stylus was not deflected.
    AtLimit(Axis, Direction),
}

impl Probing {
    /// Between two places, path coordinates, with feeds in mm/min: as far as the traverse range reaches. It waits until it is
    /// to [begin](Probing::begin).
    pub fn new(
        [from, to]: [Position; 2],
        feed_mm_min: f64,
        home_mm_min: Option<f64>,
        axes: &OwnAxes,
        chain: &Chain,
    ) -> Probing {
        let (to, limit) = within_range(&from, to, axes, chain);
        Probing {
            phase: Phase::Waits,
            line: Straight::new([from, to], axes),
            feed_mm_min,
            home_mm_min,
            limit,
            touch: None,
        }
    }

    /// The movement may set off, and the stylus may be deflected.
    pub fn begin(&mut self) {
        self.phase = Phase::Search;
    }

    /// It has begun: the stylus may be deflected.
    pub fn has_begun(&self) -> bool {
        self.phase != Phase::Waits
    }

    /// The line on which the axes go to the surface.
    pub fn line(&mut self) -> &mut Straight {
        &mut self.line
    }

    /// Its start and its farthest end, path coordinates.
    pub fn ends(&self) -> [Position; 2] {
        self.line.ends()
    }

    /// It moves no axis now.
    pub fn stands(&self) -> bool {
        self.line.stands()
    }

    /// Takes the position of the axes when the stylus is deflected; once in each servo step.
    pub fn watch<'a>(
        &mut self,
        deflected: bool,
        axes: impl Iterator<Item = &'a AxisUnit> + Clone,
        chain: &Chain,
    ) {
        if self.phase != Phase::Search || self.touch.is_some() || !deflected {
            return;
        }
        let mut actual = Position::UNKNOWN;
        for unit in axes.clone() {
            actual[unit.axis] = unit.servo.actual_mm();
        }
        self.touch = Some(self.line.part_of(&chain.to_path(&actual), axes));
    }

    /// Moves the axes for a cycle.
    pub fn moves(&mut self, running: bool, axes: &mut OwnAxes, chain: &Chain, now: &Now) -> Probed {
        let percent = now.feed_percent.min(100.0);
        let mut touches = false;
        let aim = match self.phase {
            Phase::Waits => return Probed::Moves,
            _ if !running => Aim::Feed(0.0),
            Phase::Search => match self.touch {
                Some(_) => {
                    self.phase = Phase::Brake;
                    touches = true;
                    Aim::Feed(0.0)
                }
                None => Aim::Position(self.line.length()),
            },
            Phase::Brake => Aim::Feed(0.0),
            Phase::Return => Aim::Position(self.touch.unwrap_or(0.0)),
            Phase::Home => Aim::Position(0.0),
        };
        let home = self.home_mm_min.filter(|_| self.phase == Phase::Home);
        let feed = if aim == Aim::Feed(0.0) {
            self.feed_mm_min
        } else {
            (home.unwrap_or(self.feed_mm_min) * percent / 100.0).min(now.rapid_limit_mm_min)
        };
        let position = self.line.lead(aim, feed, axes, chain, now);
        let stands = self.line.stands();
        let answer = match (self.phase, self.touch) {
            (Phase::Brake, _) if stands => {
                self.phase = Phase::Return;
                None
            }
            (Phase::Return, Some(touch)) if self.line.is_at(touch) && self.home_mm_min.is_some() => {
                self.phase = Phase::Home;
                None
            }
            (Phase::Return, Some(touch)) if self.line.is_at(touch) => Some(Some(position)),
            (Phase::Home, Some(touch)) if self.line.is_at(0.0) => Some(Some(self.line.along(touch))),
            (Phase::Search, None) if self.line.is_at(self.line.length()) => Some(None),
            _ => None,
        };
        match (answer, self.limit) {
            (Some(None), Some((axis, direction))) if stands && axes.have_arrived() => {
                Probed::AtLimit(axis, direction)
            }
            (Some(touched), _) if stands && axes.have_arrived() => Probed::Over(touched),
            _ if touches => Probed::Touches,
            _ => Probed::Moves,
        }
    }
}

/// The way of a probing as far as the traverse range reaches, and the limit that ends it. On kinematics that are
/// not Cartesian the way is that of the axes (inferred); in a tilted plane they move in straight lines, too.
fn within_range(
    from: &Position,
    to: Position,
    axes: &OwnAxes,
    chain: &Chain,
) -> (Position, Option<(Axis, Direction)>) {
    let [least, greatest] = axes.traverse_box();
    let placed = chain
        .placement()
        .map(|_| [from, &to].map(|position| chain.to_axes(position)));
    let mut part = 1.0;
    let mut limit = None;
    for unit in axes.iter() {
        let axis = unit.axis;
        let (offset, way) = (chain.offsets.of(axis), to[axis] - from[axis]);
        let (offset, from, way) = match &placed {
            Some([from, to]) => (0.0, from[axis], to[axis] - from[axis]),
            None => (offset, from[axis], way),
        };
        let (end, direction) = if way > 0.0 {
            (greatest[axis], Direction::Plus)
        } else {
            (least[axis], Direction::Minus)
        };
        let reach = (end - offset - from) / way;
        if way != 0.0 && reach < part {
            (part, limit) = (reach.max(0.0), Some((axis, direction)));
        }
    }
    if limit.is_none() {
        return (to, None);
    }
    let end = PerAxis::from_fn(|axis| {
        let way = to[axis] - from[axis];
        if way == 0.0 {
            to[axis]
        } else {
            from[axis] + part * way
        }
    });
    (end.into(), limit)
}
