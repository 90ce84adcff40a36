//! The joints between elements: where the path stops, passes or waits for more to be known.
//!
//! One state machine for planning and for running. It gets the path element by element and decides
//! whoever keeps the joints ([`Caps`]) how fast each may be passed: that of a corner only when the distance to
//! the next corner is known, since its speed depends on it.

use bahn_path::PathElement;

use crate::corner::{Corner, Joint, Passing};
use crate::gate::Gates;
use crate::limits::Dynamics;
use crate::motion::Motion;

/// Keeps how fast joints may be passed. The joint is always that at the end of the last element.
pub(crate) trait Caps {
    /// It may be passed at this speed, mm/s.
    fn join(&mut self, speed: f64);
    /// Its speed is still to be found out; `settle` gives it.
    fn hold(&mut self);
    /// Gives the joint that `hold` left open, mm/s.
    fn settle(&mut self, speed: f64);
}

/// The state at the end of the path that is known.
#[derive(Clone, Debug, Default)]
pub(crate) struct Joints {
    /// The last element waits for what comes after it.
    open: bool,
    /// It ends in a stop.
    stop: bool,
    /// The last motion since a stop. Elements without length leave it as it is.
    last: Option<Motion>,
    /// Which angle the joint after `last` may have to be passed.
    passing: Passing,
    /// Distance since the last corner or stop, mm.
    distance: f64,
    /// The last corner while the distance after it is too short to say how fast it may be passed.
    corner: Option<Corner>,
}

impl Joints {
    /// Finds the joint before an element, which is then to be put at the end of the path.
    #[inline]
    pub(crate) fn join(
        &mut self,
        caps: &mut impl Caps,
        next: Option<&Motion>,
        gates: Gates,
        dynamics: &Dynamics,
    ) {
        if !self.open {
            return;
        }
        let Some(last) = self.last.as_ref().filter(|_| !self.stop && !gates.start) else {
            return self.join_stop(caps);
        };
        let Some(next) = next else {
            // Without a length there is no direction: the corner is where the path goes on.
            return caps.join(last.speed.min(last.end_speed));
        };
        match Joint::between(last, next, self.distance, self.passing, dynamics) {
            Joint::Stop => self.join_stop(caps),
            Joint::Smooth(speed) => caps.join(speed),
            Joint::Corner(corner) => {
                self.settle(caps);
                caps.hold();
                self.corner = Some(corner);
                self.distance = 0.0;
            }
        }
    }

    /// The element was put at the end of the path.
    #[inline]
    pub(crate) fn follow(
        &mut self,
        caps: &mut impl Caps,
        element: &PathElement,
        motion: Option<Motion>,
        gates: Gates,
        dynamics: &Dynamics,
    ) {
        if let Some(motion) = motion {
            self.distance += motion.length;
            self.passing = Passing::ByAngle;
            self.last = Some(motion);
        }
        // M90 is effective in operation with servo lag only [000:5114]; a joint that is tangential by
        // construction may differ by rounding.
        if element.constant_speed && dynamics.servo_lag {
            self.passing = Passing::AnyAngle;
        } else if element.tangential_end && self.passing == Passing::ByAngle {
            self.passing = Passing::Tangential;
        }
        self.open = true;
        self.stop = gates.end;
        let enough = |corner: &Corner| corner.knows_enough(self.distance);
        if self.corner.as_ref().is_some_and(enough) {
            self.settle(caps);
        }
    }

    /// What is known ends in a stop for good.
    pub(crate) fn stop(&mut self, caps: &mut impl Caps) {
        if self.open {
            self.join_stop(caps);
            self.open = false;
        }
    }

    fn join_stop(&mut self, caps: &mut impl Caps) {
        self.settle(caps);
        caps.join(0.0);
        self.last = None;
        self.distance = 0.0;
    }

    /// Decides the corner that waits for the distance after it.
    #[inline]
    pub(crate) fn settle(&mut self, caps: &mut impl Caps) {
        if let Some(corner) = self.corner.take() {
            caps.settle(corner.pass_speed(self.distance));
        }
    }
}
