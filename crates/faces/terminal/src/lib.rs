//! The operating panel in the terminal.
//!
//! - [`show`] shows the panel of a machine that runs, until the operator leaves; [`check`] says before that whether
//!   there is a terminal;
//! - `desk` makes inputs of keys, mouse and commands, by the table of short cuts that all front ends share; `hold` is
//!   how a key of the machine is held where a terminal reports only that it was pressed; `commands` are those after `:`,
//!   `machine` the keys of its operating panel;
//! - `draw` makes a picture of a screen, region by region; `graphics` is the part in half blocks, `palette` the colours;
//! - `window` takes the terminal over and leaves it as it was, `panel` is the loop that brings it all together.
//!
//! ```no_run
//! use bahn_service::{Live, MachineService, Station, load};
//!
//! # fn main() -> Result<(), Box<dyn std::error::Error>> {
//! bahn_terminal::check()?;
//! let live = Live::start(Station::power_on(load("machines/mill".as_ref())?)?);
//! bahn_terminal::show(MachineService::of(&live)?, || live.has_ended())?;
//! live.end()?;
//! # Ok(())
//! # }
//! ```

#![cfg_attr(
    test,
    allow(clippy::unwrap_used, clippy::panic, reason = "tests fail by panic")
)]

mod commands;
mod desk;
mod draw;
#[cfg(test)]
mod drawers;
mod graphics;
mod hold;
mod machine;
mod palette;
mod panel;
#[cfg(test)]
mod tests;
mod window;

pub use panel::{check, show};

/// Why the panel cannot be shown in the terminal.
#[derive(Debug, thiserror::Error)]
pub enum TerminalError {
    /// Input or output is a pipe or a file.
    #[error("the panel needs a terminal: input or output is none")]
    NoTerminal,
    /// The terminal does not do what it is asked.
    #[error("terminal: {0}")]
    Terminal(#[from] std::io::Error),
}
