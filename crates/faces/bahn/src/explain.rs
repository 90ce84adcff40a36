//! `bahn explain`: what the control's messages and the errors of the PLC mean; everything that mentions a word.

use bahn_report::explain::explained;

use crate::options::ExplainOptions;
use crate::{Outcome, UsageError, console};

/// Explains a message or PLC error, lists what mentions a word, or lists all texts.
pub(crate) fn command(options: &ExplainOptions) -> Result<Outcome, UsageError> {
    let wanted = options.message.join(" ");
    let text = explained(&wanted, options.model);
    if text.is_empty() {
        return Err(UsageError::new(format!(
            "there is no message `{wanted}`, and nothing mentions it; `bahn explain` lists all"
        )));
    }
    console::print(&text)?;
    Ok(Outcome::Fine)
}
