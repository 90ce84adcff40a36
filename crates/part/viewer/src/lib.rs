//! The part in a browser: rotated, cut open and measured, with the path of the tool and a slider along it.
//!
//! The face of this room:
//! - [`PartCoder`]: the part as bytes, only the tiles that changed, for whoever streams it;
//! - [`PartStream`] with its [`Trail`]: a part that is being cut, for any number of viewers, each of which is sent what it lacks;
//! - [`Recording`]: collects path and part while a program runs, in bounded memory;
//! - [`About`], [`Listing`], [`Remark`]: what else there is to say of the run;
//! - [`write_page`]: one file with all of it, which needs no network and nothing else;
//! - [`FILES`]: the modules and styles by themselves, for a server; [`escaped`], [`base64`]: text and bytes in a page.
//!
//! Heights have 16 bits: a step is 1/65535 of the thickness of the blank. They are sent in tiles of 64 x 64 cells,
//! each cell that changed as its difference from what its neighbours let expect, with a mark that tells the tool which cut it.
//!
//! ```
//! use bahn_viewer::{About, Recording, write_page};
//! let about = About { title: "EMPTY".to_owned(), ..About::default() };
//! let mut page = Vec::new();
//! write_page(&mut page, Recording::default(), None, &about)?;
//! assert!(page.starts_with(b"<!DOCTYPE html>"));
//! # Ok::<(), std::io::Error>(())
//! ```

mod bytes;
mod coder;
mod history;
mod page;
mod scene;
mod sheet;
mod stream;
mod track;
mod trail;

pub use bytes::base64;
pub use coder::PartCoder;
pub use page::{FILES, STAGE, STAGE_PLACE, WebFile, escaped, write_page};
pub use scene::{About, Listing, Recording, Remark};
pub use sheet::{TILE, WHOLE};
pub use stream::{Bytes, PartNews, PartStream, Sent};
pub use trail::Trail;
