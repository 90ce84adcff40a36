//! Machine parameters: those that are in force, and the list from which the machine is switched on.

use std::sync::PoisonError;

use bahn_host::{LoadedMachine, files};
use bahn_panel::Input;
use bahn_parameters::{ControlModel, Definition, ListText, ParameterId, ParameterList};

use crate::error::ServiceError;
use crate::service::MachineService;

impl MachineService {
    /// The machine parameters as they are now.
    ///
    /// # Errors
    /// When the machine has ended, or too many wait.
    pub fn parameters(&self) -> Result<ParameterList, ServiceError> {
        self.look(|station| station.control().first().edited_list().clone())
    }

    /// The value of a machine parameter as it is written in a list; one without an index has index 0.
    ///
    /// # Errors
    /// When there is no such parameter.
    pub fn parameter(&self, number: u16, index: u8) -> Result<String, ServiceError> {
        let value = self.look(move |station| {
            let list = station.control().first().edited_list();
            let definition = Definition::named(list.model(), named(list.model(), number, index)?).ok()?;
            Some(definition.format_value(list.get(number, index)?))
        })?;
        value.ok_or(ServiceError::NoParameter(number, index))
    }

    /// Changes a machine parameter until power-off, or for good, in its list, too.
    ///
    /// # Errors
    /// When there is no such parameter, it does not take the value, or it cannot be changed now.
    pub fn set_parameter(
        &self,
        number: u16,
        index: u8,
        value: &str,
        for_good: bool,
    ) -> Result<(), ServiceError> {
        self.operates()?;
        let value = value.trim().to_owned();
        let (id, assignment, value, is_other) = self.look(move |station| {
            let no_parameter = ServiceError::NoParameter(number, index);
            let mut list = station.control().first().edited_list().clone();
            let id = named(list.model(), number, index).ok_or(no_parameter.clone())?;
            let before = list.get(number, index);
            let assignment = format!("{id}={value}");
            list.assign(&assignment)
                .map_err(|error| ServiceError::BadValue(error.to_string()))?;
            let after = list.get(number, index).ok_or(no_parameter)?;
            Ok::<_, ServiceError>((id, assignment, after, before != Some(after)))
        })??;
        if for_good {
            self.write_parameter(id, value)?;
        }
        // What is so already needs no reset.
        if is_other {
            self.give(Input::Action(assignment))?;
        }
        Ok(())
    }

    /// Writes a machine parameter into its list, which stays one that the machine can be switched on with.
    fn write_parameter(&self, id: ParameterId, value: f64) -> Result<(), ServiceError> {
        let shared = &self.shared;
        let _one_at_a_time = shared.writes.lock().unwrap_or_else(PoisonError::into_inner);
        let selected = self.look(|station| station.control().remember().parameter_list)?;
        let name = selected.unwrap_or_else(|| shared.folders.list.clone());
        let root = &shared.folders.root;
        let path = root.join(&name);
        let refused = |error: bahn_host::HostError| ServiceError::NotWritten(error.to_string());
        let bytes = files::read_table(&path).map_err(refused)?;
        let mut text = ListText::from_bytes(shared.machine.model, &bytes);
        text.set(id, value)
            .map_err(|_| ServiceError::NoParameter(id.number, id.index.unwrap_or(0)))?;
        let bytes = text.to_bytes();
        let loaded = LoadedMachine::load_with_file(root, &name, &bytes).map_err(refused)?;
        // The machine could not be switched on with it.
        loaded.map_err(|_| ServiceError::BadValue(format!("{id}: the machine does not go on with it")))?;
        files::write_whole(&path, &bytes).map_err(refused)
    }
}

/// The id of a parameter: with an index, or of one that has none.
fn named(model: ControlModel, number: u16, index: u8) -> Option<ParameterId> {
    let with = ParameterId {
        number,
        index: Some(index),
    };
    let without = ParameterId { number, index: None };
    let is_known = |id: &ParameterId| Definition::named(model, *id).is_ok();
    [with, without]
        .into_iter()
        .filter(|id| id.index.is_some() || index == 0)
        .find(is_known)
}
