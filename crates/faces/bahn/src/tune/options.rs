//! The options of the commissioning assistant.

use std::path::PathBuf;

use clap::{Args, ValueHint};

use crate::options::Format;

/// Options of `bahn tune`.
#[derive(Args, Debug)]
pub(crate) struct TuneOptions {
    /// Folder of the machine.
    #[arg(value_name = "DIR", value_hint = ValueHint::DirPath)]
    pub folder: PathBuf,
    /// The axis, or the two of a circle as X,Y: they are tuned together, since their kv must be equal. X, Y and Z find a
    /// partner by themselves. S is the spindle.
    #[arg(value_name = "AXIS", value_parser = axes)]
    pub axes: (char, Option<char>),
    /// Radius of the circle, mm; an axis alone goes so far to both sides, mm or degrees.
    #[arg(long, value_name = "MM", default_value_t = 20.0)]
    pub radius: f64,
    /// Feed on the path, mm/min or degrees/min.
    #[arg(long, value_name = "MM/MIN", default_value_t = 2000.0)]
    pub feed: f64,
    /// Greatest machining feed, above which a kink point lies, mm/min; half of rapid traverse without it.
    #[arg(long, value_name = "MM/MIN")]
    pub machining_feed: Option<f64>,
    /// Put what is proposed into the list of machine parameters, crash-safe and with its comments.
    #[arg(long)]
    pub write: bool,
    /// Draw the circle test and a stop, before and after: .png or .svg.
    #[arg(long, value_name = "FILE.png|FILE.svg", value_hint = ValueHint::FilePath)]
    pub picture: Option<PathBuf>,
    /// One machine parameter to begin with instead of that of the list, as 1510.0=1 (repeatable, or several with commas).
    #[arg(long = "mp", value_name = "N=V", value_delimiter = ',')]
    pub mp: Vec<String>,
    /// How the report is written.
    #[arg(long, value_name = "FORMAT", value_enum, default_value_t)]
    pub format: Format,
}

/// A letter, or two with a comma.
pub(super) fn axes(text: &str) -> Result<(char, Option<char>), String> {
    let letters: Vec<char> = text
        .to_ascii_uppercase()
        .chars()
        .filter(|letter| *letter != ',')
        .collect();
    match *letters {
        [axis] if axis.is_ascii_alphabetic() => Ok((axis, None)),
        [axis, partner] if axis.is_ascii_alphabetic() && partner.is_ascii_alphabetic() => {
            Ok((axis, Some(partner)))
        }
        _ => Err("an axis, or two that describe a circle: X, B or X,Y".to_owned()),
    }
}
