//! A language server for part programs, PLC programs and lists of machine parameters.
//!
//! The face of this room:
//! - [`serve`]: answers one editor over a [`Connection`], until it says that it has done;
//! - [`Disk`]: what the server wants to know of the disk;
//! - [`Settings`]: how documents are read, unless the editor says otherwise.
//!
//! ```
//! use std::path::Path;
//! use std::sync::Arc;
//! use bahn_lsp::{Connection, Disk, Settings, serve};
//! use bahn_text::{Files, NamedFile};
//!
//! struct NoFiles;
//! impl Files for NoFiles {
//!     fn read(&self, _: &str) -> Option<NamedFile> { None }
//! }
//! impl Disk for NoFiles {
//!     fn has(&self, _: &Path) -> bool { false }
//!     fn model_of(&self, _: &Path) -> Option<bahn_parameters::ControlModel> { None }
//!     fn names(&self, _: &Path) -> Vec<String> { Vec::new() }
//! }
//!
//! let (editor, server) = Connection::memory();
//! drop(editor);
//! assert!(serve(&server, Arc::new(NoFiles), &Settings::default()).is_err(), "the editor has gone");
//! ```
//!
//! `transport` reads and writes messages, `server` is the loop, `requests` have a file for each kind of request. What a language knows stands behind the trait
//! `Analysis` of `language`: part programs (`part`), DIN 66025 (`din`), PLC programs (`plc`), lists (`list`). One version of a document is
//! read once, when somebody asks; what takes long, as the run that finds the values of Q parameters, is done in the
//! `background` and broken off when the text changes.

mod background;
mod capabilities;
mod channel;
mod din;
mod document;
mod error;
mod language;
mod list;
mod markdown;
mod part;
mod plc;
mod requests;
mod server;
mod settings;
mod system900;
mod text;
mod transport;
mod uri;
mod world;

pub use lsp_server::Connection;
pub use server::serve;
pub use settings::Settings;
pub use transport::{Frame, Streams, read};
pub use world::Disk;

pub use error::ServeError;
