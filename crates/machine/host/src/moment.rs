//! The moment at which a machine is.

use bahn_tnc::Control;

use crate::hosted::Hosted;
use crate::operable::Operable;
use crate::orders::Waiting;

/// Control, plant, operator and what is ordered: all that decides how a machine goes on, and what is kept to go back.
#[derive(Clone)]
pub(crate) struct Moment<P, C: Hosted = Control> {
    pub control: C,
    pub plant: P,
    pub operator: C::Operator,
    pub waiting: Waiting<C::Command>,
    /// What the family's host knows beside.
    pub aside: C::Aside,
}

impl<P: Operable, C: Hosted> Moment<P, C> {
    /// The moment of power-on: nothing is waited for.
    pub fn new(control: C, plant: P, operator: C::Operator) -> Moment<P, C> {
        Moment {
            aside: control.aside(),
            control,
            plant,
            operator,
            waiting: Waiting::default(),
        }
    }

    /// The same once more; `None` where the plant cannot be copied.
    pub fn copied(&self) -> Option<Moment<P, C>> {
        self.plant.copied().map(|plant| self.with(plant))
    }

    /// The same with a copy of its plant.
    pub fn with(&self, plant: P) -> Moment<P, C> {
        Moment {
            plant,
            control: self.control.clone(),
            operator: self.operator.clone(),
            waiting: self.waiting.clone(),
            aside: self.aside.clone(),
        }
    }
}
