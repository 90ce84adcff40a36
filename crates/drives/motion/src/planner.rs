//! The look-ahead feed planner: elements in, elements with their speed out.

use std::collections::VecDeque;

use bahn_path::{Barrier, ElementSource, LiveData, PathElement, Position, Step};

use crate::gate::Gates;
use crate::joints::Joints;
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

/// The elements read ahead.
#[derive(Debug)]
struct LookAhead {
    dynamics: Dynamics,
    elements: VecDeque<PathElement>,
    window: Window,
    joints: Joints,
}

impl LookAhead {
    fn new(dynamics: Dynamics) -> LookAhead {
        LookAhead {
            dynamics,
            elements: VecDeque::new(),
            window: Window::new(),
            joints: Joints::default(),
        }
    }

    /// The oldest element when its speed is final.
    #[inline]
    fn pop(&mut self) -> Option<(PathElement, Profile)> {
        let full = self.window.is_full();
        if full {
            self.joints.settle(&mut self.window);
        }
        let profile = self.window.pop(full)?;
        Some((self.elements.pop_front()?, profile))
    }

    /// Reads an element from the source.
    #[inline]
    fn push(&mut self, element: PathElement) {
        let LookAhead {
            dynamics,
            window,
            joints,
            ..
        } = self;
        let gates = Gates::of(&element);
        let motion = Motion::of(&element, dynamics);
        joints.join(window, motion.as_ref(), gates, dynamics);
        match &motion {
            Some(motion) => window.push(motion.length, motion.acceleration, motion.speed),
            None => window.push(0.0, 1.0, f64::INFINITY),
        }
        joints.follow(window, &element, motion, gates, dynamics);
        self.elements.push_back(element);
    }

    /// The path stops at the end of what was read.
    fn stop(&mut self) {
        self.joints.stop(&mut self.window);
    }
}
