//! Where the path is.

use bahn_path::{PathElement, Position};

use super::Interpolator;
use super::phase::Phase;
use crate::drive::Passed;

impl<E> Interpolator<E> {
    /// The ends of elements that the last cycle came to, in their order.
    pub fn passed(&self) -> &[Passed] {
        self.outputs.passed()
    }

    /// Nominal position on the path.
    pub fn position(&self) -> Position {
        self.at.position
    }

    /// Where the path would be with its spindle at an angle, degrees; where it is when no spindle leads it.
    pub fn position_at(&self, actual_deg: f64) -> Position {
        match self.ring.current().zip(self.led.coupling.as_ref()) {
            Some((item, coupling)) => coupling.position(item, actual_deg),
            None => self.at.position,
        }
    }

    /// Path speed, mm/s.
    pub fn speed_mm_s(&self) -> f64 {
        self.at.speed
    }

    /// The element that is executed, or was last.
    pub fn element(&self) -> Option<&PathElement> {
        self.ring.current().map(|item| &item.element)
    }

    /// That element has begun: what it puts out first is output.
    pub fn has_begun(&self) -> bool {
        self.phase != Phase::Begin
    }

    /// The element after it, as far as it is known.
    pub fn next_element(&self) -> Option<&PathElement> {
        self.ring.following().map(|item| &item.element)
    }

    /// Path length to the end of that element, mm. Where the spindle was turned by hand while a thread waited, the axis may stand
    /// beyond: below 0 behind the end, and more than the length of the element before the start.
    pub fn rest_mm(&self) -> f64 {
        self.at.rest
    }

    /// The distance over which the path comes to a standstill when it brakes now, mm.
    pub fn braking_mm(&self) -> f64 {
        self.ring
            .standstill(self.at.speed * self.at.speed, self.at.rest)
            .1
    }

    /// How much of that element is covered, 0 to 1, also where the axis stands beyond its ends.
    pub fn part(&self) -> f64 {
        self.at.part_of(self.ring.current())
    }

    /// Elements that are prepared and not yet executed, the current one included.
    pub fn ahead(&self) -> usize {
        self.ring.ahead().len()
    }
}
