//! The look-ahead feed planner: elements in, elements with their speed out.

use std::collections::VecDeque;

use bahn_path::{Barrier, ElementSource, LiveData, PathElement, Position, Step};

use crate::corner::{Corner, Joint};
use crate::gate::Gates;
use crate::limits::{Dynamics, Limits};
use crate::motion::Motion;
use crate::profile::Profile;
use crate::times::{AuxiliaryTimes, Stopwatch};
use crate::window::Window;

/// Plans the speed along the path of a source, with look-ahead over as many elements as braking needs.
///
/// It is pulled like its source: [`Planner::next`] reads ahead until the speed of the oldest element is
/// final and hands that element out. Time per element does not depend on the depth of look-ahead.
#[derive(Debug)]
pub struct Planner<S: ElementSource> {
    source: S,
    look_ahead: LookAhead,
    stopwatch: Stopwatch,
    /// The step of the source that comes after all elements before it.
    after: Option<PlannedStep<S::Error>>,
}

/// An answer of a [`Planner`]: the step of its source, elements with their speed.
#[derive(Clone, Debug, PartialEq)]
pub enum PlannedStep<E> {
    /// The next element of the path.
    Element(Planned),
    /// The source waits for live data; the path before has ended in a stop.
    Barrier(Barrier),
    /// The source has nothing yet; the path before has ended in a stop.
    Starved,
    /// The program has ended.
    End,
    /// The program cannot go on; the path before has ended in a stop.
    Error(E),
}

/// An element with its speed and time.
#[derive(Clone, Debug, PartialEq)]
pub struct Planned {
    /// The element as the source gave it.
    pub element: PathElement,
    /// Speed along the element.
    pub profile: Profile,
    /// Waiting before the movement for functions at its start, s.
    pub wait_before_s: f64,
    /// Waiting after the movement for functions at its end, and dwell, s.
    pub wait_after_s: f64,
}

impl<S: ElementSource> Planner<S> {
    /// A planner over a source; the path starts from standstill.
    pub fn new(source: S, limits: &Limits, times: &AuxiliaryTimes) -> Planner<S> {
        Planner {
            source,
            look_ahead: LookAhead::new(Dynamics::new(limits)),
            stopwatch: Stopwatch::new(times),
            after: None,
        }
    }

    /// The next step of the planned path. After [`PlannedStep::End`] and [`PlannedStep::Error`] the
    /// answer stays what the source repeats.
    #[expect(
        clippy::should_implement_trait,
        reason = "named like ElementSource::next, which it mirrors"
    )]
    pub fn next(&mut self) -> PlannedStep<S::Error> {
        loop {
            if let Some((element, profile)) = self.look_ahead.pop() {
                let waiting = self.stopwatch.waiting(&element);
                return PlannedStep::Element(Planned {
                    element,
                    profile,
                    wait_before_s: waiting.before,
                    wait_after_s: waiting.after,
                });
            }
            if let Some(step) = self.after.take() {
                return step;
            }
            self.after = Some(match self.source.next() {
                Step::Element(element) => {
                    self.look_ahead.push(element);
                    continue;
                }
                Step::Barrier(barrier) => PlannedStep::Barrier(barrier),
                Step::Starved => PlannedStep::Starved,
                Step::End => PlannedStep::End,
                Step::Error(error) => PlannedStep::Error(error),
            });
            self.look_ahead.stop();
        }
    }

    /// Lets the source go on after a barrier.
    pub fn resume(&mut self, live: LiveData) {
        self.source.resume(live);
    }

    /// The source, for what else it knows.
    pub fn source(&self) -> &S {
        &self.source
    }

    /// The source, to steer it. Elements already read ahead are not affected.
    pub fn source_mut(&mut self) -> &mut S {
        &mut self.source
    }

    /// The source, when nothing more is planned.
    pub fn into_source(self) -> S {
        self.source
    }
}

impl Planned {
    /// Time from the start of the element to its end with all waiting, s; infinite when it cannot move.
    pub fn duration_s(&self) -> f64 {
        self.wait_before_s + self.profile.duration_s + self.wait_after_s
    }

    /// The position at a time from the start of the element, waiting included, s.
    pub fn position_at(&self, t: f64) -> Position {
        let t = t - self.wait_before_s;
        let PathElement {
            curve, start, end, ..
        } = &self.element;
        let fraction = if t >= self.profile.duration_s {
            1.0
        } else if self.profile.length_mm > 0.0 {
            self.profile.distance(t) / self.profile.length_mm
        } else {
            0.0
        };
        curve.position(start, end, fraction)
    }
}

/// The elements read ahead and the state at the end of them.
#[derive(Debug)]
struct LookAhead {
    dynamics: Dynamics,
    elements: VecDeque<PathElement>,
    window: Window,
    /// Whether the last element waits for what comes after it.
    open: bool,
    /// The last element ends in a stop.
    stop: bool,
    /// The last motion since a stop. Elements without length leave it as it is.
    last: Option<Motion>,
    /// The joint after `last` is passed whatever its angle.
    any_angle: bool,
    /// Way since the last corner or stop, mm.
    way: f64,
    /// The last corner while the way after it is too short to say how fast it may be passed.
    corner: Option<Corner>,
}

impl LookAhead {
    fn new(dynamics: Dynamics) -> LookAhead {
        LookAhead {
            dynamics,
            elements: VecDeque::new(),
            window: Window::new(),
            open: false,
            stop: true,
            last: None,
            any_angle: false,
            way: 0.0,
            corner: None,
        }
    }

    /// The oldest element when its speed is final.
    #[inline]
    fn pop(&mut self) -> Option<(PathElement, Profile)> {
        let full = self.window.is_full();
        if full {
            self.settle();
        }
        let profile = self.window.pop(full)?;
        Some((self.elements.pop_front()?, profile))
    }

    /// Reads an element.
    #[inline]
    fn push(&mut self, element: PathElement) {
        let gates = Gates::of(&element);
        let motion = Motion::of(&element, &self.dynamics);
        if self.open {
            self.join(motion.as_ref(), gates.start);
        }
        self.stop = gates.end;
        match &motion {
            Some(motion) => {
                self.way += motion.length;
                self.window.push(motion.length, motion.acceleration, motion.speed);
                self.any_angle = false;
            }
            None => self.window.push(0.0, 1.0, f64::INFINITY),
        }
        if motion.is_some() {
            self.last = motion;
        }
        // M90 is effective in operation with servo lag only [000:5114]; a joint that is tangential by
        // construction may differ by rounding.
        self.any_angle |= element.constant_speed && self.dynamics.servo_lag || element.tangential_end;
        self.open = true;
        self.elements.push_back(element);
        if self
            .corner
            .as_ref()
            .is_some_and(|corner| corner.knows_enough(self.way))
        {
            self.settle();
        }
    }

    /// Finds the joint between the last element and the next one.
    #[inline]
    fn join(&mut self, next: Option<&Motion>, gate: bool) {
        let Some(last) = self.last.as_ref().filter(|_| !self.stop && !gate) else {
            return self.join_stop();
        };
        let Some(next) = next else {
            // Without a length there is no direction: the corner is where the path goes on.
            return self.window.join(last.speed);
        };
        let joint = Joint::between(last, next, self.way, self.any_angle, &self.dynamics);
        match joint {
            Joint::Stop => self.join_stop(),
            Joint::Smooth(speed) => self.window.join(speed),
            Joint::Corner(corner) => {
                self.settle();
                self.window.hold();
                self.corner = Some(corner);
                self.way = 0.0;
            }
        }
    }

    fn join_stop(&mut self) {
        self.settle();
        self.window.join(0.0);
        self.last = None;
        self.way = 0.0;
    }

    /// Decides the corner that waits for the way after it.
    #[inline]
    fn settle(&mut self) {
        if let Some(corner) = self.corner.take() {
            self.window.settle(corner.pass_speed(self.way));
        }
    }

    /// The path stops at the end of what was read.
    fn stop(&mut self) {
        if self.open {
            self.join_stop();
            self.open = false;
        }
    }
}
