//! The planned path in contour cycles.

use bahn_path::{Barrier, ElementSource, LiveData, Position};

use crate::planner::{Planned, PlannedStep, Planner};

/// From the position of the tool on the path to the positions of the axes of the machine.
pub trait Kinematics {
    /// The axis positions for a position on the path.
    fn axes(&self, path: &Position) -> Position;
}

/// The kinematics of machines whose axes are the programmed ones.
#[derive(Clone, Copy, Debug, Default)]
pub struct Identity;

impl Kinematics for Identity {
    fn axes(&self, path: &Position) -> Position {
        *path
    }
}

/// Walks the planned path and gives the nominal position of every contour cycle, `s = s0 + v · Δt`
/// [000:4753-4765], with no gap between elements.
#[derive(Debug)]
pub struct Sampler<S: ElementSource, K: Kinematics> {
    planner: Planner<S>,
    kinematics: K,
    cycle_s: f64,
    current: Option<Planned>,
    /// Samples given of the current element.
    cycles: f64,
    /// Time of the first of them from the start of the element, s.
    offset_s: f64,
    /// The step that comes after the end of the path was given.
    after: Option<Sample<S::Error>>,
}

/// An answer of a [`Sampler`].
#[allow(
    clippy::large_enum_variant,
    reason = "one at a time, and no cycle allocates: a scan goes with its barrier"
)]
#[derive(Clone, Debug, PartialEq)]
pub enum Sample<E> {
    /// The axis positions one cycle later.
    Axes(Position),
    /// The source waits for live data; the axes stand.
    Barrier(Barrier),
    /// The source has nothing yet; the axes stand.
    Starved,
    /// The program has ended; the axes stand.
    End,
    /// The program cannot go on; the axes stand.
    Error(E),
}

impl<S: ElementSource, K: Kinematics> Sampler<S, K> {
    /// A sampler of a planned path; the cycle in s must be positive.
    pub fn new(planner: Planner<S>, kinematics: K, cycle_s: f64) -> Sampler<S, K> {
        Sampler {
            planner,
            kinematics,
            cycle_s,
            current: None,
            cycles: 0.0,
            offset_s: 0.0,
            after: None,
        }
    }

    /// The next sample: the start of the path at first, then one cycle later each time, and at a stop
    /// of the source the end of the path.
    #[expect(
        clippy::should_implement_trait,
        reason = "named like ElementSource::next, which it mirrors"
    )]
    pub fn next(&mut self) -> Sample<S::Error> {
        if let Some(step) = self.after.take() {
            return step;
        }
        loop {
            if let Some(planned) = &self.current {
                let duration = planned.duration_s();
                // Counted, not added up, so that long elements do not drift.
                let time = self.offset_s + self.cycles * self.cycle_s;
                if time < duration {
                    self.cycles += 1.0;
                    return Sample::Axes(self.kinematics.axes(&planned.position_at(time)));
                }
                (self.cycles, self.offset_s) = (0.0, time - duration);
            }
            let step = match self.planner.next() {
                PlannedStep::Element(planned) => {
                    self.current = Some(planned);
                    continue;
                }
                PlannedStep::Barrier(barrier) => Sample::Barrier(barrier),
                PlannedStep::Starved => Sample::Starved,
                PlannedStep::End => Sample::End,
                PlannedStep::Error(error) => Sample::Error(error),
            };
            // The end of the path is a sample too, then the axes stand.
            let Some(planned) = self.current.take() else {
                return step;
            };
            (self.cycles, self.offset_s) = (0.0, 0.0);
            self.after = Some(step);
            return Sample::Axes(self.kinematics.axes(&planned.element.end));
        }
    }

    /// Lets the source go on after a barrier.
    pub fn resume(&mut self, live: LiveData) {
        self.planner.resume(live);
    }

    /// The planner under the sampler.
    pub fn planner(&self) -> &Planner<S> {
        &self.planner
    }
}
