//! A list of machine parameters: the values that make a control fit its machine.

use std::fmt;

use crate::equipment::{Equipment, Use};
use crate::text::{USERS_MAX, read_assignment};
use crate::{ControlModel, Definition, ListError, ListText, ParameterError, ParameterId};

/// The machine parameters of one machine: a value within its range for every parameter of the model.
///
/// ```
/// use bahn_parameters::{ControlModel, ParameterList};
/// let mut list = ParameterList::reference(ControlModel::Tnc415b);
/// list.assign("1010.0=5000")?;
/// assert_eq!(list.get(1010, 0), Some(5000.0));
/// assert!(list.assign("7420=%100000").is_err(), "MP7420 has five bits");
/// # Ok::<(), bahn_parameters::ParameterError>(())
/// ```
#[derive(Clone, Debug, PartialEq)]
pub struct ParameterList {
    model: ControlModel,
    /// What the control has that it is the list of.
    equipment: Equipment,
    /// One value for each of [`Definition::all`], in its order.
    values: Vec<f64>,
    /// Those that the operator may change, in ascending order: TNC 151/155.
    users: Vec<ParameterId>,
}

impl ParameterList {
    /// The list that the control makes when none is entered: standard colours, and the smallest value
    /// everywhere else [000:10066]. It is called a programming station there, 1 or 2 is not said;
    /// PLC active (inferred).
    pub fn smallest(model: ControlModel) -> ParameterList {
        ParameterList {
            model,
            equipment: Equipment::default(),
            values: Definition::all(model).iter().map(Definition::standard).collect(),
            users: Vec::new(),
        }
    }

    /// The documented reference list of the model: a typical milling machine, for test runs and as a
    /// start for a new machine. Its text is in `data/reference`.
    pub fn reference(model: ControlModel) -> ParameterList {
        let mut list = ParameterList::smallest(model);
        list.read(ParameterList::reference_text(model).as_bytes());
        list
    }

    /// The text of the reference list, with the reason of every value.
    pub fn reference_text(model: ControlModel) -> &'static str {
        match model.family() {
            ControlModel::Tnc151 | ControlModel::Tnc155 => include_str!("../data/reference/tnc151-155.mp"),
            ControlModel::Tnc360 => include_str!("../data/reference/tnc360.mp"),
            ControlModel::Tnc407 => include_str!("../data/reference/tnc407.mp"),
            ControlModel::Tnc415b => include_str!("../data/reference/tnc415b.mp"),
            _ => include_str!("../data/reference/tnc425.mp"),
        }
    }

    /// The same list in a control with other options or software.
    pub fn with_equipment(mut self, equipment: Equipment) -> ParameterList {
        self.equipment = equipment;
        self
    }

    /// Options and software of the control.
    pub fn equipment(&self) -> Equipment {
        self.equipment
    }

    /// The control model of the list.
    pub fn model(&self) -> ControlModel {
        self.model
    }

    /// The value of a parameter; a parameter with one value only has index 0. `None` when the model has
    /// no such parameter.
    pub fn get(&self, number: u16, index: u8) -> Option<f64> {
        self.values
            .get(Definition::position(self.model, number, index)?)
            .copied()
    }

    /// Sets a value, rounded to the decimal places of the parameter.
    ///
    /// # Errors
    /// When the model has no such parameter, or the value is outside its range.
    pub fn set(&mut self, number: u16, index: u8, value: f64) -> Result<(), ParameterError> {
        self.set_id(
            ParameterId {
                number,
                index: Some(index),
            },
            value,
        )
        .map(|_| ())
    }

    /// Sets one value from text: `7420=4`, `1010.0=5000`, `MP7440=%00110`. Returns which.
    ///
    /// # Errors
    /// When it is no assignment, the model has no such parameter, the value is outside its range, or the control lacks the
    /// option or the software that has it.
    pub fn assign(&mut self, assignment: &str) -> Result<ParameterId, ParameterError> {
        let found = read_assignment(self.model, assignment, 0).map_err(|(error, _)| error)?;
        let is_user = found.user_at.is_some();
        if is_user && self.users.len() >= USERS_MAX && !self.users.contains(&found.id) {
            return Err(ParameterError::TooManyUserParameters(found.id));
        }
        let place = (found.id.number, found.id.index.unwrap_or(0));
        let before = self.get(place.0, place.1);
        let value = self.set_id(found.id, found.value)?;
        if let Some((why, before)) = self.lacks(found.id, value).zip(before) {
            self.put(place, before);
            let id = found.id;
            return Err(ParameterError::Lacking { id, value, why });
        }
        self.give(found.id, is_user || self.users.contains(&found.id));
        Ok(found.id)
    }

    /// What the control lacks for a value: an option, or a later software. The value that the control gives a parameter by
    /// itself asks for nothing.
    pub(crate) fn lacks(&self, id: ParameterId, value: f64) -> Option<String> {
        let standard = Definition::find(self.model, id.number, id.index.unwrap_or(0))?.standard();
        let name = id.to_string();
        let wanted = Use::parameter(&name, value, value == standard);
        self.equipment.lacks(self.model, wanted)
    }

    /// Reads the text of a list over the values of this one. Parsing never fails: what can be read is
    /// taken, and the errors are returned in the order of lines.
    ///
    /// What a line may hold is said at [`ListText`].
    ///
    /// ```
    /// # use bahn_parameters::{ControlModel, ParameterList};
    /// let mut list = ParameterList::reference(ControlModel::Tnc407);
    /// let errors = list.read(b"MP7430 : 1.0   ;overlap\nMP7440 : %00010\nMP7460 : 200\n");
    /// assert_eq!(list.get(7430, 0), Some(1.0));
    /// assert_eq!(errors[0].to_string(), "line 3: MP7460: 200 is not between 0.001 and 179.999");
    /// ```
    pub fn read(&mut self, text: &[u8]) -> Vec<ListError> {
        let text = ListText::from_bytes(self.model, text);
        self.take(&text);
        text.faults().to_vec()
    }

    /// Takes the values of a text, whatever faults it has.
    pub fn take(&mut self, text: &ListText) {
        for entry in text.entries() {
            self.put((entry.id.number, entry.id.index.unwrap_or(0)), entry.value);
            self.give(entry.id, entry.user);
        }
    }

    /// Reads the text of a list as the control does when its editor is left: every parameter must be
    /// defined, and a text without any entry gives the list of [`ParameterList::smallest`]
    /// [000:10050-10066].
    ///
    /// # Errors
    /// All faults of the text, in the order of lines, then all parameters that are missing.
    pub fn load(model: ControlModel, text: &[u8]) -> Result<ParameterList, Vec<ListError>> {
        let text = ListText::from_bytes(model, text);
        let faults = text.all_faults();
        if !faults.is_empty() {
            return Err(faults);
        }
        let mut list = ParameterList::smallest(model);
        list.take(&text);
        Ok(list)
    }

    /// The parameters whose values are not the same in another list of the model, in ascending order.
    pub fn differences(&self, other: &ParameterList) -> Vec<ParameterId> {
        let ids = Definition::all(self.model).iter().map(|definition| definition.id);
        let of = |list: &ParameterList, id: ParameterId| list.get(id.number, id.index.unwrap_or(0));
        ids.filter(|id| of(self, *id) != of(other, *id)).collect()
    }

    /// Those that the operator may change by the letter P in the list, in ascending order [001:1299-1334].
    pub(crate) fn given(&self) -> &[ParameterId] {
        &self.users
    }

    /// A parameter is given to the operator, or not.
    fn give(&mut self, id: ParameterId, to_the_operator: bool) {
        self.users.retain(|user| *user != id);
        if to_the_operator && self.users.len() < USERS_MAX {
            let place = self.users.partition_point(|user| *user < id);
            self.users.insert(place, id);
        }
    }

    fn set_id(&mut self, id: ParameterId, value: f64) -> Result<f64, ParameterError> {
        let definition = Definition::named(self.model, id)?;
        let value = definition.check(value)?;
        self.put((id.number, id.index.unwrap_or(0)), value);
        Ok(value)
    }

    fn put(&mut self, (number, index): (u16, u8), value: f64) {
        let position = Definition::position(self.model, number, index);
        if let Some(slot) = position.and_then(|position| self.values.get_mut(position)) {
            *slot = value;
        }
    }
}

/// The text of the list, every parameter in a line with its name: what [`ParameterList::read`] reads.
impl fmt::Display for ParameterList {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        for (definition, value) in Definition::all(self.model).iter().zip(&self.values) {
            let user = if self.users.contains(&definition.id) {
                " P"
            } else {
                ""
            };
            let value = format!("{}{user}", definition.format_value(*value));
            writeln!(f, "{}", definition.line(&value))?;
        }
        Ok(())
    }
}
