//! A browser without a window, for tests of pages.
//!
//! The face of this room:
//! - [`Browser`]: a Chromium that is started for a test, with a profile of its own, and ends with it;
//! - [`Page`]: a tab of it: opens addresses, evaluates JavaScript, sees what was logged and what was fetched;
//! - mouse, touch and keys as a person uses them ([`Page::click`], [`Page::tap`], [`Page::press`]): they go through the
//!   browser's own input, so what is covered or out of focus does not get them;
//! - [`Page::viewport`], [`Page::dark`], [`Page::screenshot`]: windows of any size, and pictures of them.
//!
//! It speaks the DevTools protocol over a web socket on the loopback. WebGL is drawn by software, so pictures
//! are the same on every host and times are those of a processor, not of a graphics card.
//!
//! ```no_run
//! use bahn_browser::Browser;
//! let Some(browser) = Browser::for_test()? else { return Ok(()) };
//! let mut page = browser.page()?;
//! page.open("data:text/html,<button onclick='this.id=1'>on</button>")?;
//! page.click("button")?;
//! assert_eq!(page.evaluate("document.querySelector('button').id")?, "1");
//! assert!(page.complaints().is_empty());
//! # Ok::<(), bahn_browser::BrowserError>(())
//! ```
//!
//! Places are CSS pixels from the upper left corner of the window.

mod base64;
mod browser;
mod connection;
mod error;
mod input;
mod keys;
mod page;

pub use browser::Browser;
pub use error::BrowserError;
pub use page::{Page, Timings};
