//! Options and help texts of `bahn scope`.

use std::path::PathBuf;

use clap::{Args, ValueHint};

use crate::cli::{Format, image_size, seconds};

pub(crate) const EXAMPLES: &str = "\
Examples:
  bahn run part.h --machine mill --record run.csv --signals X.actual,X.lag,path.speed,M2045,M2482
  bahn scope run.csv -o run.svg
      All signals over the whole time.
  bahn scope run.csv --signals X.lag,M2045 --from 12 --to 14 -o lag.png
      Two signals, two seconds.
  bahn scope run.csv --cursor 12.5,12.8 --format json
      Least, greatest and mean values, edges, and the values at two times.

Six analogue signals at most have a lane each with its own scale, below them 16 markers, inputs and outputs.

JSON: from_s, to_s, samples; signals (name, unit, kind `analogue` or `logic`, min, max, mean, first, last; for
logic also rising, falling and on_s); cursors (time_s, values by name); with two cursors difference_s.";

/// Options of `bahn scope`.
#[derive(Args, Debug)]
pub(crate) struct ScopeOptions {
    /// The recording of `bahn run --record`.
    #[arg(value_name = "OUT.csv", value_hint = ValueHint::FilePath)]
    pub file: PathBuf,
    /// The signals, by their names in the first line of the recording; all without it.
    #[arg(long, value_name = "SIGNAL,..", value_delimiter = ',')]
    pub signals: Vec<String>,
    /// Begin of the time shown, s.
    #[arg(long, value_name = "S", value_parser = seconds)]
    pub from: Option<f64>,
    /// End of the time shown, s.
    #[arg(long, value_name = "S", value_parser = seconds)]
    pub to: Option<f64>,
    /// One or two times at which values are read, s.
    #[arg(long, value_name = "S,S", value_delimiter = ',', value_parser = seconds)]
    pub cursor: Vec<f64>,
    /// The drawing: .svg or .png.
    #[arg(long, short, value_name = "FILE.svg|FILE.png", value_parser = picture, value_hint = ValueHint::FilePath)]
    pub output: Option<Picture>,
    /// Title of the drawing; the name of the recording without it.
    #[arg(long, value_name = "TEXT", requires = "output")]
    pub title: Option<String>,
    /// Size of the drawing, pixels.
    #[arg(long, value_name = "WxH", default_value = "1200x800", requires = "output", value_parser = image_size)]
    pub size: (u32, u32),
    /// How the summary is written.
    #[arg(long, value_name = "FORMAT", value_enum, default_value_t)]
    pub format: Format,
}

/// A drawing by the end of its name.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(crate) enum Picture {
    Svg(PathBuf),
    Png(PathBuf),
}

fn picture(text: &str) -> Result<Picture, String> {
    let path = PathBuf::from(text);
    let extension = path
        .extension()
        .unwrap_or_default()
        .to_string_lossy()
        .to_ascii_lowercase();
    match extension.as_str() {
        "svg" => Ok(Picture::Svg(path)),
        "png" => Ok(Picture::Png(path)),
        _ => Err("the name must end in .svg or .png".to_owned()),
    }
}
