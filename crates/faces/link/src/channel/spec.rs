//! How a port is written: what is connected, and how.

use std::fmt;
use std::path::PathBuf;
use std::str::FromStr;
use std::time::Duration;

use bahn_parameters::interfaces::{self, Mode};

use crate::settings::PATIENCE;

/// Baud rates that later controls have beside those of [`interfaces::BAUD_RATES`].
const LATER_BAUD_RATES: [u32; 2] = [57_600, 115_200];
/// Patience at most, one day.
const PATIENCE_MAX: f64 = 86_400.0;

/// What a port is connected to.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum Line {
    /// Listens at an address: `tcp:127.0.0.1:4711`.
    Listen(String),
    /// Connects to an address: `connect:127.0.0.1:4711`.
    Connect(String),
    /// A pseudo terminal, with a symbolic link to it: `pty:/tmp/rs232`.
    Pty(Option<PathBuf>),
    /// A serial port of this computer: `serial:/dev/ttyUSB0`.
    Serial(String),
}

impl fmt::Display for Line {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Line::Listen(address) => write!(f, "tcp:{address}"),
            Line::Connect(address) => write!(f, "connect:{address}"),
            Line::Pty(None) => f.write_str("pty"),
            Line::Pty(Some(link)) => write!(f, "pty:{}", link.display()),
            Line::Serial(name) => write!(f, "serial:{name}"),
        }
    }
}

/// A port and how it is set up.
///
/// ```
/// use bahn_link::{Line, Mode, Spec};
///
/// let spec: Spec = "tcp:127.0.0.1:4711,mode=fe2,baud=9600,timeout=0.5".parse()?;
/// assert_eq!(spec.line, Line::Listen("127.0.0.1:4711".into()));
/// assert_eq!((spec.mode, spec.baud), (Mode::Fe2, Some(9600)));
/// let wrong = "pty,baud=9601".parse::<Spec>().unwrap_err();
/// assert_eq!((wrong.column, wrong.part.as_str()), (5, "baud=9601"));
/// # Ok::<(), bahn_link::SpecError>(())
/// ```
#[derive(Clone, Debug, PartialEq)]
pub struct Spec {
    /// What it is connected to.
    pub line: Line,
    /// Which device that is.
    pub mode: Mode,
    /// Characters are sent at this baud rate; otherwise as fast as the channel can.
    pub baud: Option<u32>,
    /// Time of error N and of a dead device.
    pub timeout: Duration,
    /// Seed of the faults of the line.
    pub fault: Option<u64>,
}

/// What is wrong with a port as it is written.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
#[error("column {column}, `{part}`: {what}")]
pub struct SpecError {
    /// Where it is, counted in characters from 1.
    pub column: usize,
    /// The part that is wrong.
    pub part: String,
    /// What is wrong with it.
    pub what: String,
}

impl FromStr for Spec {
    type Err = SpecError;

    fn from_str(text: &str) -> Result<Spec, SpecError> {
        let mut column = 1;
        let mut spec: Option<Spec> = None;
        let mut named: Vec<&str> = Vec::new();
        for part in text.split(',') {
            let wrong = |what: String| SpecError {
                column,
                part: part.to_owned(),
                what,
            };
            match &mut spec {
                None => spec = Some(Spec::of(line(part).map_err(wrong)?)),
                Some(spec) => {
                    let (name, value) = part
                        .split_once('=')
                        .ok_or_else(|| wrong("an option is NAME=VALUE".into()))?;
                    if named.contains(&name) {
                        return Err(wrong(format!("{name} is there already")));
                    }
                    named.push(name);
                    spec.set(name, value).map_err(wrong)?;
                }
            }
            column += part.chars().count() + 1;
        }
        spec.ok_or_else(|| SpecError {
            column: 1,
            part: String::new(),
            what: NO_LINE.into(),
        })
    }
}

const NO_LINE: &str = "a port is tcp:ADDR:PORT, connect:ADDR:PORT, pty[:LINK] or serial:NAME";

fn line(text: &str) -> Result<Line, String> {
    let (kind, rest) = match text.split_once(':') {
        Some((kind, rest)) => (kind, Some(rest)),
        None => (text, None),
    };
    let address = |rest: Option<&str>| {
        let rest = rest.unwrap_or_default();
        let (host, port) = rest
            .rsplit_once(':')
            .filter(|(host, _)| !host.is_empty())
            .ok_or("an address is ADDR:PORT")?;
        let port = port
            .parse::<u16>()
            .map_err(|_| format!("{port} is no port from 0 to 65535"))?;
        Ok::<String, String>(format!("{host}:{port}"))
    };
    match (kind, rest) {
        ("tcp", rest) => address(rest).map(Line::Listen),
        ("connect", rest) => address(rest).map(Line::Connect),
        ("pty", None) => Ok(Line::Pty(None)),
        ("pty", Some(link)) if !link.is_empty() => Ok(Line::Pty(Some(link.into()))),
        ("serial", Some(name)) if !name.is_empty() => Ok(Line::Serial(name.to_owned())),
        _ => Err(NO_LINE.into()),
    }
}

impl Spec {
    /// A port with nothing said of it.
    pub fn of(line: Line) -> Spec {
        Spec {
            line,
            mode: Mode::default(),
            baud: None,
            timeout: PATIENCE,
            fault: None,
        }
    }

    fn set(&mut self, name: &str, value: &str) -> Result<(), String> {
        match name {
            "mode" => {
                self.mode = value
                    .parse()
                    .map_err(|()| "a mode is me, fe1, fe2, ext1 or ext2".to_owned())?;
            }
            "baud" => {
                let rates = || interfaces::BAUD_RATES.into_iter().chain(LATER_BAUD_RATES);
                let known = value
                    .parse()
                    .ok()
                    .filter(|baud| rates().any(|rate| rate == *baud));
                self.baud = Some(known.ok_or_else(|| {
                    let known: Vec<String> = rates().map(|baud| baud.to_string()).collect();
                    format!("a baud rate is one of {}", known.join(", "))
                })?);
            }
            "timeout" => {
                let fits = |seconds: &f64| (0.001..=PATIENCE_MAX).contains(seconds);
                let seconds = value.parse().ok().filter(fits);
                let seconds = seconds.ok_or("a time-out is a number of seconds above 0")?;
                self.timeout = Duration::from_secs_f64(seconds);
            }
            "fault" => {
                let seed = value
                    .parse()
                    .map_err(|_| "a seed is a number from 0".to_owned())?;
                self.fault = Some(seed);
            }
            _ => return Err("the options are mode, baud, timeout and fault".into()),
        }
        Ok(())
    }
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used, reason = "a test may fail")]
    use super::*;

    #[test]
    fn lines_are_written_as_they_are_read() {
        for text in [
            "tcp:127.0.0.1:19000",
            "tcp:[::1]:0",
            "connect:shop.example:4711",
            "pty",
            "pty:/tmp/link",
            "serial:/dev/ttyUSB0",
            "serial:COM3",
        ] {
            assert_eq!(text.parse::<Spec>().unwrap().line.to_string(), text);
        }
    }

    #[test]
    fn wrong_ports_are_reported_with_their_place() {
        for (text, column, what) in [
            ("", 1, NO_LINE),
            ("tcp", 1, "an address is ADDR:PORT"),
            ("tcp::80", 1, "an address is ADDR:PORT"),
            ("connect:host", 1, "an address is ADDR:PORT"),
            ("tcp:host:70000", 1, "70000 is no port from 0 to 65535"),
            ("pty:", 1, NO_LINE),
            ("serial", 1, NO_LINE),
            ("usb:1", 1, NO_LINE),
            ("pty,", 5, "an option is NAME=VALUE"),
            ("pty,mode=fe3", 5, "a mode is me, fe1, fe2, ext1 or ext2"),
            ("pty,mode=fe1,mode=me", 14, "mode is there already"),
            (
                "pty,mode=fe1,timeout=0",
                14,
                "a time-out is a number of seconds above 0",
            ),
            ("pty,timeout=nan", 5, "a time-out is a number of seconds above 0"),
            ("pty,fault=-1", 5, "a seed is a number from 0"),
            (
                "pty,parity=odd",
                5,
                "the options are mode, baud, timeout and fault",
            ),
        ] {
            let error = text.parse::<Spec>().unwrap_err();
            assert_eq!((error.column, error.what.as_str()), (column, what), "{text}");
        }
        let baud = "pty,mode=me,baud=9601".parse::<Spec>().unwrap_err();
        assert_eq!(baud.column, 13);
        assert!(
            baud.to_string().ends_with("9600, 19200, 38400, 57600, 115200"),
            "{baud}"
        );
    }
}
