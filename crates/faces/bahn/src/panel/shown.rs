//! How a panel is shown, whatever the family of its machine is.

use std::process::{Command, Stdio};
use std::time::Duration;

use bahn_host::HostError;
use bahn_server::Server;
use bahn_service::Operated;

use super::options::PanelOptions;
use crate::interrupt::Interrupt;
use crate::{UsageError, diagnostics};

/// How often Ctrl-C is looked for.
const LOOK: Duration = Duration::from_millis(50);

/// A panel goes on with what the machine has kept: only one at a time can.
pub(super) fn in_use(error: HostError) -> UsageError {
    match error {
        HostError::SwitchedOn(_) => UsageError::new(format!(
            "{error}; end what runs it, or give another folder with --machine (`bahn machine new` makes one)"
        )),
        other => other.into(),
    }
}

/// Says where a browser finds the page, with the token, and opens it when that is wanted.
pub(super) fn say_page(options: &PanelOptions, name: &str, server: &Server) {
    let address = server.address();
    let address = match &options.token {
        Some(token) => format!("http://{address}/?token={token}"),
        None => format!("http://{address}/"),
    };
    let ends = match options.in_the_terminal() {
        true => "",
        false => "; Ctrl-C switches the machine off",
    };
    diagnostics::print_text(&format!("{name}: the panel is at {address}{ends}"));
    if options.open {
        open(&address);
    }
}

/// Shows the panel in the terminal where that is wanted, until the operator leaves or Ctrl-C ends it.
pub(super) fn show(
    options: &PanelOptions,
    machine: impl Operated + 'static,
    interrupt: &Interrupt,
    has_ended: impl Fn() -> bool,
) -> Result<(), UsageError> {
    if options.in_the_terminal() {
        return terminal::show(machine, || interrupt.is_requested() || has_ended());
    }
    while !interrupt.is_requested() {
        std::thread::sleep(LOOK);
    }
    Ok(())
}

pub(super) fn in_words(error: impl std::fmt::Display) -> UsageError {
    UsageError::new(error.to_string())
}

/// The panel in the terminal.
#[cfg(feature = "terminal")]
pub(super) mod terminal {
    use bahn_service::Operated;

    use crate::UsageError;

    pub(in crate::panel) fn check() -> Result<(), UsageError> {
        bahn_terminal::check().map_err(|error| UsageError::new(error.to_string()))
    }

    pub(in crate::panel) fn show(
        machine: impl Operated + 'static,
        ends: impl Fn() -> bool,
    ) -> Result<(), UsageError> {
        bahn_terminal::show(machine, ends).map_err(|error| UsageError::new(error.to_string()))
    }
}

/// Nothing asks for it in a build without it.
#[cfg(not(feature = "terminal"))]
pub(super) mod terminal {
    use bahn_service::Operated;

    use crate::UsageError;

    pub(in crate::panel) fn check() -> Result<(), UsageError> {
        Err(UsageError::new("this build has no panel in the terminal"))
    }

    pub(in crate::panel) fn show(_: impl Operated + 'static, _: impl Fn() -> bool) -> Result<(), UsageError> {
        check()
    }
}

/// Who has no browser opens the page elsewhere.
fn open(address: &str) {
    let opener = if cfg!(target_os = "macos") {
        "open"
    } else {
        "xdg-open"
    };
    let opened = Command::new(opener)
        .arg(address)
        .stdin(Stdio::null())
        .stdout(Stdio::null())
        .stderr(Stdio::null())
        .spawn();
    if opened.is_err() {
        diagnostics::print_text("no browser was found here: open that address in one");
    }
}
