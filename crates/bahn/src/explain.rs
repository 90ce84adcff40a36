//! `bahn explain`: what the control's messages mean.

use bahn_parameters::{ControlModel, MessageId};

use crate::cli::ExplainOptions;
use crate::{Outcome, UsageError, console};

/// Prints one message with cause and remedy, or all texts.
pub(crate) fn command(options: &ExplainOptions) -> Result<Outcome, UsageError> {
    let wanted = options.message.join(" ");
    if wanted.is_empty() {
        let lines = MessageId::ALL
            .iter()
            .map(|id| format!("{:<32}{}\n", id.name(), id.text(options.model)));
        console::print(&lines.collect::<String>())?;
        return Ok(Outcome::Fine);
    }
    let Some(id) = MessageId::ALL.iter().find(|id| is_meant(**id, &wanted)) else {
        return Err(UsageError::new(format!(
            "there is no message `{wanted}`; `bahn explain` lists all"
        )));
    };
    console::print(&format!(
        "{}\n  cause:  {}\n  remedy: {}\n  source: {}\n",
        id.text(options.model),
        id.cause(),
        id.remedy(),
        id.source(),
    ))?;
    Ok(Outcome::Fine)
}

/// Whether the words are the name or the text of any model, whatever the case and spacing.
fn is_meant(id: MessageId, wanted: &str) -> bool {
    let letters = |text: &str| -> String {
        text.chars()
            .filter(|c| c.is_alphanumeric())
            .flat_map(char::to_uppercase)
            .collect()
    };
    let wanted = letters(wanted);
    letters(id.name()) == wanted
        || ControlModel::ALL
            .iter()
            .any(|model| letters(id.text(*model)) == wanted)
}
