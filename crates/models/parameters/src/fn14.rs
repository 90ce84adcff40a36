//! Texts of the numbered messages that programs and the PLC show.

use crate::ControlModel;

/// The prepared text of a number of FN14: ERROR [003:4364-4367]; `None` above 499. The machine builder
/// may replace it.
///
/// 300 to 399 are the 100 messages of the PLC, counted from 0 as in [000:6625], and 400 to 483 the
/// dialogs from 0, where the TNC 360 manual prints first numbers 01 and 1 (inferred).
///
/// ```
/// use bahn_parameters::{ControlModel, error_text};
/// assert_eq!(error_text(254, ControlModel::Tnc360).as_deref(), Some("ERROR 254"));
/// assert_eq!(error_text(305, ControlModel::Tnc360).as_deref(), Some("PLC ERROR 05"));
/// assert_eq!(error_text(305, ControlModel::Tnc407).as_deref(), Some("PLC: ERROR 5"));
/// assert_eq!(error_text(403, ControlModel::Tnc360).as_deref(), Some("DIALOG 3"));
/// assert_eq!(error_text(484, ControlModel::Tnc360).as_deref(), Some("USER PARAMETER 15"));
/// ```
pub fn error_text(number: u16, model: ControlModel) -> Option<String> {
    Some(match number {
        0..=299 => format!("ERROR {number}"),
        300..=399 if model == ControlModel::Tnc360 => format!("PLC ERROR {:02}", number - 300),
        // Spelling of the standard dialogue of the others [000:6625] [001:1326].
        300..=399 => format!("PLC: ERROR {}", number - 300),
        400..=483 => format!("DIALOG {}", number - 400),
        484..=499 => format!("USER PARAMETER {}", 499 - number),
        _ => return None,
    })
}
