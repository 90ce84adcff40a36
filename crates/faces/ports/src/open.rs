//! Ports as they are written, opened, and set up as machine parameters say.

use std::net::SocketAddr;

use bahn_link::{Channel, Line, Settings, Spec};
use bahn_parameters::{MessageId, ParameterList};

use crate::Tell;

/// Why a port does not open.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Refused {
    /// What the control says.
    pub message: Option<&'static str>,
    /// What is wrong besides, in words.
    pub why: Option<String>,
}

impl Refused {
    /// Of which the control says nothing; why, in words.
    pub fn because(why: &str) -> Refused {
        Refused {
            message: None,
            why: Some(why.to_owned()),
        }
    }
}

/// Reads a port, which an option names.
///
/// # Errors
/// When it is not written as one.
pub fn spec(option: &str, text: &str) -> Result<Spec, Refused> {
    text.parse()
        .map_err(|error| Refused::because(&format!("{option} {text}: {error}")))
}

/// What a list says for a port.
pub fn settings(list: &ParameterList, spec: &Spec) -> Settings {
    Settings::of(list, spec.mode).on(spec.baud, spec.timeout)
}

/// Opens a port and tells where the other side finds it, when that is not what was written.
///
/// # Errors
/// When it cannot be opened.
pub fn open(spec: &Spec, settings: &Settings, tell: &Tell) -> Result<Channel, Refused> {
    let channel = Channel::open(spec, settings.characters).map_err(|error| {
        let message = match &spec.line {
            _ if error.is_taken => Some(MessageId::InterfaceAlreadyAssigned),
            // A device that nobody has switched on.
            Line::Connect(_) | Line::Serial(_) => Some(MessageId::ExtInOutputNotReady),
            Line::Listen(_) | Line::Pty(_) => None,
        };
        Refused {
            message: message.map(|message| message.text(settings.model)),
            why: Some(error.to_string()),
        }
    })?;
    let place = channel.place();
    if place != spec.line.to_string() && !spec.line.to_string().ends_with(&place) {
        tell(&format!("{} is {place}", spec.line));
    }
    warn_of_others(&spec.line, &place, tell);
    Ok(channel)
}

/// Whoever listens beyond this computer is told so: a data interface asks nobody for a password.
fn warn_of_others(line: &Line, place: &str, tell: &Tell) {
    let address = place.parse::<SocketAddr>();
    if matches!(line, Line::Listen(_))
        && !address.is_ok_and(|address| address.ip().to_canonical().is_loopback())
    {
        tell(&format!(
            "warning: {line} can be reached by others: whoever connects reads and writes there without a password"
        ));
    }
}
