//! Options of `bahn panel`.

use std::net::{IpAddr, Ipv4Addr, SocketAddr};
use std::path::PathBuf;

use clap::Args;

pub(crate) const EXAMPLES: &str = "\
Examples:
  bahn panel --open                                   the mill, in the browser
  bahn panel --terminal                               the mill, in this terminal; ? shows the keys
  bahn panel --machine machines/mill-tnc360 --speed 5
      Another machine; time passes five times as fast.
  bahn panel --machine machines/portal900             a machine with a System 900 (docs/system900.md)
  bahn panel --rs232 serial:/dev/ttyUSB0             EXT reads programs in and out there (docs/link.md)
  bahn panel --listen 0.0.0.0:8155 --token SECRET     for others, too; they need the token once
  bahn panel --listen 0.0.0.0:8155 --token SECRET --viewer-token CLASSROOM
      Who comes with ?token=CLASSROOM sees everything and does nothing.
  bahn panel --machine machines/mill --record session.jsonl
      Keeps what is done in a file ...
  bahn panel --machine mill --replay session.jsonl    ... and shows it again, on a copy of the folder (docs/sessions.md)

Without --machine a copy of machines/mill runs, in the user's data folder (XDG_DATA_HOME, else ~/.local/share): what is
programmed and set there is there the next time. Ctrl-C switches the machine off; everything is kept.
Programs press keys and look at the screen, too: docs/panel-api.md.
In the terminal NO_COLOR does without colours, and ':' presses any key by its name: ':key NC_START'.
Exit codes: 0 fine, 1 the machine's folder has a fault, 2 wrong use.";

/// Options of `bahn panel`.
#[derive(Args, Debug)]
pub(crate) struct PanelOptions {
    /// Folder of a machine; a copy of machines/mill without it.
    #[arg(long, value_name = "DIR")]
    pub machine: Option<PathBuf>,
    /// Address to listen on; port 0 takes a free one. Any but loopback needs --token or --viewer-token [default: 127.0.0.1:8155, none
    /// with --terminal].
    #[arg(long, value_name = "ADDRESS:PORT")]
    pub listen: Option<SocketAddr>,
    /// What those must know who operate; six or more letters and digits.
    #[arg(long, value_name = "TEXT", value_parser = token)]
    pub token: Option<String>,
    /// What those must know who only look.
    #[arg(long, value_name = "TEXT", value_parser = token)]
    pub viewer_token: Option<String>,
    /// Opens the page in the browser.
    #[arg(long)]
    pub open: bool,
    /// Shows the panel in this terminal. With --listen or --open the page shows the same machine.
    #[cfg(feature = "terminal")]
    #[arg(long)]
    pub terminal: bool,
    /// So many times as fast as real time, 0.1 to 100.
    #[arg(long, value_name = "FACTOR", default_value_t = 1.0, value_parser = speed)]
    pub speed: f64,
    /// What is connected to RS-232-C/V.24, for the key EXT and the PLC: tcp:ADDR:PORT, connect:ADDR:PORT, pty:LINK,
    /// serial:NAME (docs/link.md). Which device that is, MOD says.
    #[arg(long, value_name = "SPEC")]
    pub rs232: Option<String>,
    /// The same for RS-422/V.11.
    #[arg(long, value_name = "SPEC")]
    pub rs422: Option<String>,
    /// Where FN15 prints: rs232, rs422, or a file to which lines are added.
    #[arg(long, value_name = "WHERE")]
    pub print: Option<String>,
    /// Keeps every input with its time in a new file.
    #[arg(long, value_name = "FILE")]
    pub record: Option<PathBuf>,
    /// Shows a session that was recorded on such a machine; after its end the panel goes on.
    #[arg(long, value_name = "FILE", conflicts_with = "record")]
    pub replay: Option<PathBuf>,
}

impl PanelOptions {
    /// The panel is shown in this terminal.
    pub fn in_the_terminal(&self) -> bool {
        #[cfg(feature = "terminal")]
        return self.terminal;
        #[cfg(not(feature = "terminal"))]
        return false;
    }

    /// Where to listen; nowhere when the terminal alone is wanted.
    pub fn address(&self) -> Option<SocketAddr> {
        let serves = !self.in_the_terminal() || self.open;
        self.listen.or_else(|| serves.then_some(DEFAULT_ADDRESS))
    }
}

/// Where the panel is when nobody says otherwise.
const DEFAULT_ADDRESS: SocketAddr = SocketAddr::new(IpAddr::V4(Ipv4Addr::LOCALHOST), 8155);

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
