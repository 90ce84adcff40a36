//! What has happened at a data interface, as whoever has its line says it.

use std::fmt;
use std::str::FromStr;

/// What has happened at an interface, as it is written: `received 15.H`.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum TransferNews {
    /// Somebody carries out what is ordered at this interface.
    Connected(usize),
    /// A name on the medium, with its sectors.
    Listed(String, Option<u32>),
    /// Sectors that are free on the medium.
    Free(u32),
    /// A file is stored.
    Received(String),
    /// A file was read out.
    Sent(String),
    /// ERASE/OVERREAD: is the file replaced?
    Overread(String),
    /// Is the file read in?
    Offered(String),
    /// Is it read out?
    Output(String),
    /// It is protected: does the transfer go on with the next one?
    Protected(String),
    /// A message, as the control shows it.
    Message(String),
    /// It is over, and all of it has arrived.
    Complete,
    /// It is over, and something is missing.
    Incomplete,
}

impl fmt::Display for TransferNews {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            TransferNews::Connected(port) => write!(f, "connected {port}"),
            TransferNews::Listed(name, Some(sectors)) => write!(f, "listed {name} {sectors}"),
            TransferNews::Listed(name, None) => write!(f, "listed {name}"),
            TransferNews::Free(sectors) => write!(f, "free {sectors}"),
            TransferNews::Received(name) => write!(f, "received {name}"),
            TransferNews::Sent(name) => write!(f, "sent {name}"),
            TransferNews::Overread(name) => write!(f, "overread {name}"),
            TransferNews::Offered(name) => write!(f, "offered {name}"),
            TransferNews::Output(name) => write!(f, "output {name}"),
            TransferNews::Protected(name) => write!(f, "protected {name}"),
            TransferNews::Message(text) => write!(f, "message {text}"),
            TransferNews::Complete => f.write_str("ended complete"),
            TransferNews::Incomplete => f.write_str("ended incomplete"),
        }
    }
}

impl FromStr for TransferNews {
    type Err = String;

    fn from_str(text: &str) -> Result<TransferNews, String> {
        let (what, rest) = text.split_once(' ').unwrap_or((text, ""));
        let named = (!rest.is_empty()).then(|| rest.to_owned());
        let news = match what {
            "connected" => rest
                .parse()
                .ok()
                .filter(|port| *port < 2)
                .map(TransferNews::Connected),
            "listed" => named.map(|rest| match rest.rsplit_once(' ') {
                Some((name, sectors)) if sectors.parse::<u32>().is_ok() => {
                    TransferNews::Listed(name.to_owned(), sectors.parse().ok())
                }
                _ => TransferNews::Listed(rest, None),
            }),
            "free" => rest.parse().ok().map(TransferNews::Free),
            "received" => named.map(TransferNews::Received),
            "sent" => named.map(TransferNews::Sent),
            "overread" => named.map(TransferNews::Overread),
            "offered" => named.map(TransferNews::Offered),
            "output" => named.map(TransferNews::Output),
            "protected" => named.map(TransferNews::Protected),
            "message" => named.map(TransferNews::Message),
            "ended" if rest == "complete" => Some(TransferNews::Complete),
            "ended" if rest == "incomplete" => Some(TransferNews::Incomplete),
            _ => None,
        };
        news.ok_or_else(|| format!("`{text}` is nothing that happens at an interface"))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn news_are_read_as_they_are_written() {
        for text in [
            "connected 1",
            "listed PART.H 12",
            "listed PART.H",
            "free 1200",
            "received 15.H",
            "sent 15.I",
            "overread 15.H",
            "offered 15.H",
            "output 15.H",
            "protected 15.H",
            "message TRANSFERRED DATA INCORRECT E",
            "ended complete",
            "ended incomplete",
        ] {
            assert_eq!(text.parse::<TransferNews>().unwrap().to_string(), text);
        }
        for text in ["", "connected 2", "received", "free much", "ended", "else X"] {
            assert!(text.parse::<TransferNews>().is_err(), "{text}");
        }
    }
}
