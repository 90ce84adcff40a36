//! Tables on their way to the medium.

use std::path::Path;

use bahn_host::{TableForm, files, tools_fit};
use bahn_parameters::MessageId;

use super::{is_of_machine, is_protected};
use crate::site::Site;

/// Puts the new text of a table on the medium, when it has no fault and fits the machine.
pub(super) fn store(
    name: &str,
    path: &Path,
    form: TableForm,
    text: &str,
    site: &mut Site,
) -> Result<(), String> {
    if is_protected(name, site) {
        return Err(site.message(MessageId::ProtectedPgm));
    }
    let checked = form.check(text).map_err(|faults| {
        let fault = faults.into_iter().next();
        fault.map_or_else(String::new, |fault| fault.message)
    });
    let of_machine = is_of_machine(name, site);
    let fits = checked.and_then(|()| match of_machine {
        true => tools_fit(site.machine, form, text, site.parameters()),
        false => Ok(()),
    });
    if let Err(why) = fits {
        return Err(format!("{}: {why}", site.message(MessageId::EntryValueIncorrect)));
    }
    files::write_text(path, text).map_err(|error| error.to_string())?;
    site.programs.was_written();
    Ok(())
}
