//! Options of `bahn panel`.

use std::net::SocketAddr;
use std::path::PathBuf;

use clap::Args;

pub(crate) const EXAMPLES: &str = "\
Examples:
  bahn panel --open                                   the mill, in the browser
  bahn panel --machine machines/mill-tnc360 --speed 5
      Another machine; time passes five times as fast.
  bahn panel --listen 0.0.0.0:8155 --token SECRET     for others, too; they need the token once
  bahn panel --machine machines/mill --record session.jsonl
      Keeps what is done in a file ...
  bahn panel --machine mill --replay session.jsonl    ... and shows it again, on a copy of the folder (docs/sessions.md)
  curl -X POST -d '{\"key\":\"CE\"}' http://127.0.0.1:8155/api/key
      A key from a program; docs/panel-api.md tells everything that can be asked for.

Without --machine a copy of machines/mill runs, in the user's data folder (XDG_DATA_HOME, else ~/.local/share): what is
programmed and set there is there the next time. Ctrl-C switches the machine off; everything is kept.
Exit codes: 0 fine, 1 the machine's folder has a fault, 2 wrong use.";

/// Options of `bahn panel`.
#[derive(Args, Debug)]
pub(crate) struct PanelOptions {
    /// Folder of a machine; a copy of machines/mill without it.
    #[arg(long, value_name = "DIR")]
    pub machine: Option<PathBuf>,
    /// Address to listen on; port 0 takes a free one. Any but loopback needs --token.
    #[arg(long, value_name = "ADDRESS:PORT", default_value = "127.0.0.1:8155")]
    pub listen: SocketAddr,
    /// What others must know; letters and digits.
    #[arg(long, value_name = "TEXT", value_parser = token)]
    pub token: Option<String>,
    /// Opens the page in the browser.
    #[arg(long)]
    pub open: bool,
    /// So many times as fast as the clock on the wall, 0.1 to 100.
    #[arg(long, value_name = "FACTOR", default_value_t = 1.0, value_parser = speed)]
    pub speed: f64,
    /// Keeps every input with its time in a new file.
    #[arg(long, value_name = "FILE")]
    pub record: Option<PathBuf>,
    /// Shows a session that was recorded on such a machine; behind its end the panel goes on.
    #[arg(long, value_name = "FILE", conflicts_with = "record")]
    pub replay: Option<PathBuf>,
}

/// A token stands in addresses and cookies.
fn token(text: &str) -> Result<String, String> {
    let fits = text.len() >= 6 && text.chars().all(|character| character.is_ascii_alphanumeric());
    fits.then(|| text.to_owned())
        .ok_or_else(|| "a token has six or more letters and digits".to_owned())
}

fn speed(text: &str) -> Result<f64, String> {
    let factor = text.parse::<f64>().ok();
    factor
        .filter(|factor| (0.1..=100.0).contains(factor))
        .ok_or_else(|| "time passes 0.1 to 100 times as fast".to_owned())
}
