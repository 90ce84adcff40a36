//! The port of a command, opened and set up as the machine parameters say.

use bahn_link::{Channel, Settings};
use bahn_parameters::ParameterList;

use crate::link::port;

/// Opens a port; `None` when it cannot be, which is told.
pub(super) fn open(text: &str, list: &ParameterList) -> Option<(Channel, Settings)> {
    let spec = port::spec("--port", text).ok()?;
    let settings = port::settings(list, &spec);
    let mut channel = port::open(&spec, &settings).ok()?;
    // A line that drops is no end: the transfer begins again over the next one.
    channel.connect_again();
    Some((channel, settings))
}
