//! The memory of the PLC, by its operands.

use bahn_exchange::{Assignment, Content, Operand};
use bahn_panel::Input;

use crate::error::ServiceError;
use crate::service::MachineService;

impl MachineService {
    /// What operands of the PLC hold, all at one moment.
    ///
    /// # Errors
    /// When the machine has ended, or too many wait.
    pub fn read(&self, operands: Vec<Operand>) -> Result<Vec<Content>, ServiceError> {
        self.look(move |station| {
            let memory = station.control().exchange();
            let read = |operand: Operand| match operand {
                // Strings are the PLC's own: NC and PLC do not exchange them.
                Operand::Text(_) => operand.read(memory.plc()),
                Operand::Bit(_) | Operand::Number(_) => operand.read(memory.nc()),
            };
            operands.into_iter().map(read).collect()
        })
    }

    /// Sets an operand of the PLC, which sees it with its next scan; the value is written as in scripts, `1`, `$FF`, `"TEXT"`.
    ///
    /// # Errors
    /// When the operand does not take the value, or the control does not let it be written: inputs are the machine's.
    pub fn write(&self, operand: Operand, value: &str) -> Result<(), ServiceError> {
        self.operates()?;
        let content = operand.content(value).map_err(ServiceError::BadValue)?;
        let assignment = Assignment::Operand(operand, content);
        self.give(Input::Action(assignment.to_string()))
    }
}
