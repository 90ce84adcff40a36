//! The PLC program that a control is delivered with.

use bahn_parameters::{ControlModel, Numbering};

/// The standard PLC program of the TNC 151 and 155, in their own form [001:144-165].
const TNC_15X: &str = include_str!("../data/STANDARD.PLC");

/// The text of the standard PLC program of a control model; `None` where the machine builder writes the only one.
///
/// ```
/// use bahn_parameters::ControlModel;
/// let program = bahn_plc::standard_program(ControlModel::Tnc155);
/// assert!(program.is_some_and(|text| text.contains("U     E22")));
/// assert_eq!(bahn_plc::standard_program(ControlModel::Tnc415b), None);
/// ```
pub fn standard_program(model: ControlModel) -> Option<&'static str> {
    match model.limits().numbering {
        Numbering::Old => Some(TNC_15X),
        Numbering::New => None,
    }
}
