//! The operating panel in the browser: a station over HTTP and a web socket.
//!
//! - [`Server`] listens, serves the page and its modules, which are embedded, and the interface of docs/panel-api.md;
//! - `access` says who may come in: on loopback whoever comes from the page itself, anywhere else with a token;
//! - `regions` is a screen in parts, each encoded once for all viewers, who are sent what has changed;
//! - `crew` knows the viewers, and which of them operates;
//! - `socket` is one viewer, `api` what programs ask for.

#![allow(
    rustdoc::broken_intra_doc_links,
    reason = "citations as [000:7188] look like links"
)]
#![cfg_attr(
    test,
    allow(clippy::unwrap_used, clippy::panic, reason = "tests fail by panic")
)]

mod access;
mod api;
mod assets;
mod crew;
mod regions;
mod server;
mod socket;

pub use server::{Server, ServerError, ServerOptions};
