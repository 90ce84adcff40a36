//! The moment at which a machine is.

use bahn_tnc::Control;

use crate::digitizing::Digitizing;
use crate::notice::Before;
use crate::operable::Operable;
use crate::operator::Operator;
use crate::orders::Waiting;

/// Control, plant, operator and what is ordered: all that decides how a machine goes on, and what is kept to go back.
#[derive(Clone)]
pub(crate) struct Moment<P> {
    pub control: Control,
    pub plant: P,
    pub operator: Operator,
    pub waiting: Waiting,
    pub before: Before,
    /// The list of machine parameters with which the control is to be started anew.
    pub restart: Option<String>,
    /// What each channel digitizes.
    pub digitizing: Vec<Digitizing>,
}

impl<P: Operable> Moment<P> {
    /// The moment of power-on: nothing is waited for or digitized.
    pub fn new(control: Control, plant: P, operator: Operator) -> Moment<P> {
        Moment {
            digitizing: vec![Digitizing::default(); control.channels()],
            control,
            plant,
            operator,
            waiting: Waiting::default(),
            before: Before::default(),
            restart: None,
        }
    }

    /// The same once more; `None` where the plant cannot be copied.
    pub fn copied(&self) -> Option<Moment<P>> {
        self.plant.copied().map(|plant| self.with(plant))
    }

    /// The same with a copy of its plant.
    pub fn with(&self, plant: P) -> Moment<P> {
        Moment {
            plant,
            control: self.control.clone(),
            operator: self.operator.clone(),
            waiting: self.waiting.clone(),
            before: self.before.clone(),
            restart: self.restart.clone(),
            digitizing: self.digitizing.clone(),
        }
    }
}
