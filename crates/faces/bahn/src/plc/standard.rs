//! `bahn plc standard`: the PLC program that a control is delivered with.

use std::io::Write;

use bahn_parameters::ControlModel;
use bahn_plc::standard_program;

use super::options::StandardOptions;
use crate::files::{self, NewFile};
use crate::{Outcome, UsageError, console};

/// Prints the standard program of a model, or writes it to a file.
pub(super) fn command(options: &StandardOptions) -> Result<Outcome, UsageError> {
    let with_one = || {
        ControlModel::FAMILIES
            .into_iter()
            .filter(|model| standard_program(*model).is_some())
    };
    let model = options.model.or_else(|| with_one().next());
    let text = model.and_then(standard_program).ok_or_else(|| {
        let names: Vec<&str> = with_one().map(ControlModel::name).collect();
        let name = model.map_or("control", ControlModel::name);
        let names = names.join(" and ");
        UsageError::new(format!(
            "the {name} has no standard PLC program; {names} have one"
        ))
    })?;
    match &options.output {
        None => console::print(text)?,
        Some(path) => {
            let mut file = NewFile::create(path)?;
            file.write_all(text.as_bytes())
                .map_err(|error| files::cannot("write", path, &error))?;
            file.finish()?;
        }
    }
    Ok(Outcome::Fine)
}
