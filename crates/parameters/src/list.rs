//! A list of machine parameters: the values that make a control fit its machine.

use std::collections::HashMap;
use std::fmt;

use crate::definition::{parse_id, parse_number};
use crate::{ControlModel, Definition, ListError, ParameterError, ParameterId};

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
    /// One value for each of [`Definition::all`], in its order.
    values: Vec<f64>,
}

impl ParameterList {
    /// The list that the control makes when none is entered: standard colours, and the smallest value
    /// everywhere else [000:10066]. It is called a programming station there, 1 or 2 is not said;
    /// PLC active (inferred).
    pub fn smallest(model: ControlModel) -> ParameterList {
        let value = |definition: &Definition| {
            let standard = definition.recommended.strip_prefix("std ").and_then(parse_number);
            let smallest = if definition.min.is_finite() {
                definition.min
            } else {
                0.0
            };
            standard.unwrap_or(smallest)
        };
        let mut list = ParameterList {
            model,
            values: Definition::all(model).iter().map(value).collect(),
        };
        let station = if list.has_old_numbers() {
            (170, 0)
        } else {
            (7210, 0)
        };
        list.put(station, 1.0);
        list
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
        match model {
            ControlModel::Tnc151 | ControlModel::Tnc155 => include_str!("../data/reference/tnc151-155.mp"),
            ControlModel::Tnc360 => include_str!("../data/reference/tnc360.mp"),
            ControlModel::Tnc407 => include_str!("../data/reference/tnc407.mp"),
            ControlModel::Tnc415b => include_str!("../data/reference/tnc415b.mp"),
            ControlModel::Tnc425 => include_str!("../data/reference/tnc425.mp"),
        }
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

    /// Sets one value from text: `7420=4`, `1010.0=5000`, `MP7440=%00110`.
    ///
    /// # Errors
    /// When it is no assignment, the model has no such parameter, or the value is outside its range.
    pub fn assign(&mut self, assignment: &str) -> Result<(), ParameterError> {
        let (id, value) = parse_assignment(assignment)?;
        self.set_id(id, value).map(|_| ())
    }

    /// Reads the text of a list over the values of this one. Parsing never fails: what can be read is
    /// taken, and the errors are returned in the order of lines.
    ///
    /// A line holds number, separator (`:`, `=` or blanks), value and, behind a semicolon, a comment
    /// [000:10017]. The value is decimal, `%` binary or `$` hexadecimal [000:10019-10046]. A line
    /// that starts with `;` or `*` is a comment [001:2521-2523].
    ///
    /// ```
    /// # use bahn_parameters::{ControlModel, ParameterList};
    /// let mut list = ParameterList::reference(ControlModel::Tnc407);
    /// let errors = list.read(b"MP7430 : 1.0   ;overlap\nMP7440 : %00010\nMP7460 : 200\n");
    /// assert_eq!(list.get(7430, 0), Some(1.0));
    /// assert_eq!(errors[0].to_string(), "line 3: MP7460: 200 is not between 0.0001 and 179.9999");
    /// ```
    pub fn read(&mut self, text: &[u8]) -> Vec<ListError> {
        let text = String::from_utf8_lossy(text);
        let mut errors = Vec::new();
        let mut first_lines = HashMap::new();
        for (index, line) in text.trim_start_matches('\u{feff}').lines().enumerate() {
            if let Err(error) = self.read_line(line, index + 1, &mut first_lines) {
                errors.push(ListError {
                    line: index + 1,
                    error,
                });
            }
        }
        errors
    }

    fn read_line(
        &mut self,
        line: &str,
        number: usize,
        first_lines: &mut HashMap<ParameterId, usize>,
    ) -> Result<(), ParameterError> {
        // Control characters frame lists on tape and interface.
        let line = line.trim_matches(|c: char| c.is_whitespace() || c.is_control());
        let entry = line.split_once(';').map_or(line, |(entry, _)| entry);
        if entry.trim().is_empty() || line.starts_with('*') {
            return Ok(());
        }
        let (id, value) = parse_assignment(entry)?;
        let id = self.definition(id)?.id;
        if let Some(&first_line) = first_lines.get(&id) {
            return Err(ParameterError::DoublyDefined { id, first_line });
        }
        self.set_id(id, value)?;
        first_lines.insert(id, number);
        Ok(())
    }

    fn set_id(&mut self, id: ParameterId, value: f64) -> Result<f64, ParameterError> {
        let definition = self.definition(id)?;
        let value = definition.check(value)?;
        self.put((id.number, id.index.unwrap_or(0)), value);
        Ok(value)
    }

    fn definition(&self, id: ParameterId) -> Result<&'static Definition, ParameterError> {
        let found = Definition::find(self.model, id.number, id.index.unwrap_or(0));
        let has_indices = || {
            Definition::all(self.model)
                .iter()
                .any(|d| d.id.number == id.number)
        };
        match found {
            Some(definition) if id.index.is_none() && definition.id.index.is_some() => {
                Err(ParameterError::IndexMissing(id))
            }
            Some(definition) => Ok(definition),
            None if id.index.is_none() && has_indices() => Err(ParameterError::IndexMissing(id)),
            None => Err(ParameterError::UnknownNumber(id)),
        }
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
            let (id, value) = (definition.id.to_string(), definition.format_value(*value));
            write!(f, "{id:<9}: {value:<12} ;{}", definition.name)?;
            if !definition.axis.is_empty() {
                write!(f, ", {}", definition.axis)?;
            }
            writeln!(f)?;
        }
        Ok(())
    }
}

/// Reads `MP1010.0 : 10000`, `1010.0=10000` or `MP1010.0 10000`.
fn parse_assignment(text: &str) -> Result<(ParameterId, f64), ParameterError> {
    let text = text.trim();
    let prefix = if text.get(..2).is_some_and(|mp| mp.eq_ignore_ascii_case("MP")) {
        2
    } else {
        0
    };
    let number_at = text.len() - text[prefix..].trim_start().len();
    let is_number = |c: char| c.is_ascii_digit() || c == '.';
    let end = text[number_at..]
        .find(|c| !is_number(c))
        .map_or(text.len(), |at| number_at + at);
    let (name, rest) = text.split_at(end);
    let id = parse_id(name).ok_or(ParameterError::NoNumber)?;
    let rest = rest.trim_start();
    let value = rest.strip_prefix([':', '=']).unwrap_or(rest).trim();
    if let Some(number) = parse_number(value) {
        return Ok((id, number));
    }
    // Groups of bits may stand apart, as in the manual's "%111 000" [000:10040].
    if let Some(number) = value
        .starts_with('%')
        .then(|| parse_number(&value.replace(' ', "")))
        .flatten()
    {
        return Ok((id, number));
    }
    match value.split_once(char::is_whitespace) {
        Some((first, behind)) if parse_number(first).is_some() => {
            Err(ParameterError::NoSeparator(id, behind.trim().to_owned()))
        }
        _ => Err(ParameterError::NotANumber(id, value.to_owned())),
    }
}
