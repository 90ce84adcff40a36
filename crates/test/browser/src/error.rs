//! What can go wrong.

use thiserror::Error;

/// What can go wrong with a browser.
#[derive(Debug, Error)]
pub enum BrowserError {
    /// Neither `BAHN_CHROMIUM` nor the search path has a Chromium.
    #[error(
        "there is no Chromium: install it (`apt-get install chromium`, which `make test` does), or name it in BAHN_CHROMIUM"
    )]
    NotInstalled,
    /// It cannot be started.
    #[error("the browser cannot be started: {0}")]
    Start(String),
    /// It does not answer any more.
    #[error("the browser does not answer: {0}")]
    Lost(String),
    /// It refuses an order.
    #[error("{method}: {message}")]
    Refused {
        /// The order in terms of the DevTools protocol.
        method: String,
        /// The message of the browser.
        message: String,
    },
    /// JavaScript threw an error.
    #[error("the script failed: {0}")]
    Script(String),
    /// Nothing on the page is meant by a selector.
    #[error("nothing on the page is `{0}`, or it has no size")]
    NoElement(String),
    /// What was waited for did not come.
    #[error("in {seconds} s there was never `{condition}`; at last: {last}")]
    Never {
        /// What was waited for.
        condition: String,
        /// The time limit that has passed, s.
        seconds: f64,
        /// What it was at the end.
        last: String,
    },
}
