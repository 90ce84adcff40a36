//! What happens to a System 900, as scripts write it.

use bahn_host::{Action, Command900, Event};

/// What a script has: an event of the machine, or a parameter that gets a value.
pub(super) fn action(what: &str) -> Result<Action<Command900>, String> {
    let word = what.split_whitespace().next().unwrap_or_default();
    if Event::WORDS.contains(&word) {
        let event = Event::parse(what).map_err(|error| error.to_string())?;
        return Ok(Action::Event(event, what.to_owned()));
    }
    what.parse().map(|command| Action::Command(0, command))
}
