//! The port of a command, opened and set up as the machine parameters say.

use bahn_link::{Channel, Settings, Spec};
use bahn_parameters::ParameterList;

use crate::diagnostics;

/// Opens a port; `None` when it cannot be, which is told.
pub(super) fn open(text: &str, list: &ParameterList) -> Option<(Channel, Settings)> {
    let opened = text
        .parse::<Spec>()
        .map_err(|error| format!("--port {text}: {error}"))
        .and_then(|spec| {
            let settings = Settings::of(list, spec.mode).on(spec.baud, spec.timeout);
            let channel = Channel::open(&spec, settings.characters).map_err(|error| error.to_string())?;
            let (place, line) = (channel.place(), spec.line.to_string());
            if !line.ends_with(&place) {
                diagnostics::print_line(&format!("{line} is {place}"));
            }
            Ok((channel, settings))
        });
    opened
        .map_err(|error| diagnostics::print_line(&format!("error: {error}")))
        .ok()
}
