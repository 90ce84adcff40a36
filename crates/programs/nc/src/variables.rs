//! Variables of a channel, which a contouring control does not have.

use bahn_din::{FunctionLetter, Variable, Variables};
use bahn_parameters::ControlModel;
use bahn_parameters::technology::Technology;

/// The control that executes a program.
pub(crate) struct Model {
    model: ControlModel,
    /// A variable was wanted: it is this that stops the block.
    pub refused: bool,
}

impl Model {
    pub fn of(model: ControlModel) -> Model {
        Model {
            model,
            refused: false,
        }
    }

    fn refused(&mut self, variable: &Variable) -> String {
        self.refused = true;
        format!("{variable} is a variable of a TF5200 channel, which `bahn technology` has")
    }
}

impl Variables for Model {
    fn read(&mut self, variable: &Variable) -> Result<f64, String> {
        Err(self.refused(variable))
    }

    fn write(&mut self, variable: &Variable, _value: f64) -> Result<(), String> {
        Err(self.refused(variable))
    }

    fn exists(&self, letter: FunctionLetter, number: u16) -> bool {
        letter == FunctionLetter::M && Technology::of_m(self.model, number).is_some()
    }
}
