//! The operating panel in the browser: a machine that is on over HTTP and a web socket, by its service.
//!
//! - [`Server`] listens, serves the page and its modules, which are embedded, and the interface of docs/panel-api.md;
//! - `door` takes connections, each of which has one of the `places`;
//! - `access` says who may come in and what he may do, `gate` asks it: on loopback whoever comes from the page itself, anywhere else with a token;
//!   `wrong` slows those who guess;
//! - `regions` is a screen in parts, each encoded once for all viewers, who are sent what has changed;
//! - `part` is the part that is being cut, coded once for those who look at it from every side;
//! - `pictures` are drawn one after the other;
//! - `crew` knows the viewers, and which of them operates;
//! - `socket` is one viewer, `api` what programs ask for; both have what is `shared`.
//!
//! ```no_run
//! use bahn_server::{Server, ServerOptions, Tokens};
//! use bahn_service::{Live, MachineService, Station, load};
//!
//! # fn main() -> Result<(), Box<dyn std::error::Error>> {
//! let live = Live::start(Station::power_on(load("machines/mill".as_ref())?)?);
//! let listen = "127.0.0.1:8155".parse()?;
//! let server = Server::start(MachineService::of(&live)?, ServerOptions { listen, tokens: Tokens::default() })?;
//! println!("http://{}/", server.address());
//! # Ok(())
//! # }
//! ```

#![allow(
    rustdoc::broken_intra_doc_links,
    reason = "citations as [000:7188] look like links"
)]
#![cfg_attr(
    test,
    allow(clippy::unwrap_used, clippy::panic, reason = "tests fail by panic")
)]

mod about;
mod access;
mod api;
mod assets;
mod crew;
mod door;
mod gate;
mod part;
mod pictures;
mod places;
mod regions;
mod server;
mod shared;
mod socket;
mod wrong;

pub use bahn_service::Tokens;
pub use server::{Server, ServerError, ServerOptions};
