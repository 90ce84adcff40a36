//! Options and help texts of `bahn scope`.

use std::path::PathBuf;

use bahn_report::scope::Picture;
use bahn_tnc::split_channel;
use clap::{Args, ValueHint};

use crate::options::{Format, image_size, seconds};

pub(crate) const EXAMPLES: &str = "\
Examples:
  bahn run part.h --machine mill --record run.csv --signals X.nominal,X.actual,Y.nominal,Y.actual
  bahn scope run.csv -o run.svg
      All signals from the start of the program to its end, with its blocks and messages.
  bahn scope run.csv --signals X.nominal+X.actual --from 12 --to 14 -o lag.png
      Two seconds; the nominal and the actual position in one lane.
  bahn scope run.csv --cursor 12.5,12.8 --format json
      Least, greatest and mean values, edges, and the values at two times.
  bahn scope run.csv --xy X,Y -o path.png
      The way of two axes (X.actual, Y.actual; with X.nominal, Y.nominal what it should be).
  bahn scope run.csv --circle X,Y --division 0.002 -o round.png
      The circle test (X and Y, .nominal and .actual): roundness, deviations along the radius, one ring 2 µm.
  bahn scope run.csv --step X
      kv, delay, rise time and overshoot of the first start of X (X.nominal, X.actual).
  bahn scope after.csv --against before.csv -o change.png
      Two recordings over each other, their starts of the program at the same place, with the differences.

Six lanes at most have a scale each, below them 16 markers, inputs and outputs. Time counts from power-on; what
is shown begins at the start of the program unless --from or --all say otherwise.

JSON: from_s, to_s, samples; signals (name, unit, kind `analogue` or `logic`, min, max, mean, first, last; for
logic also rising, falling and on_s); cursors (time_s, values by name); with two cursors difference_s; circle
(signals, centre_mm, radius_mm, outside_mm, outside_deg, inside_mm, inside_deg, mean_mm, roundness_mm, samples);
step (axis, start_s, speed_mm_min, kv, delay_ms, reaction_ms, rise_ms, overshoot_percent); against (name,
difference, at_s: the greatest difference of each signal).";

/// Options of `bahn scope`.
#[derive(Args, Debug)]
pub(crate) struct ScopeOptions {
    /// The recording of `bahn run --record`.
    #[arg(value_name = "OUT.csv", value_hint = ValueHint::FilePath)]
    pub file: PathBuf,
    /// The signals, by their names in the first line of the recording, `+` between those that share a lane; all
    /// without it.
    #[arg(long, value_name = "SIGNAL,..", value_delimiter = ',')]
    pub signals: Vec<String>,
    /// Begin of the time shown, s.
    #[arg(long, value_name = "S", value_parser = seconds)]
    pub from: Option<f64>,
    /// End of the time shown, s.
    #[arg(long, value_name = "S", value_parser = seconds)]
    pub to: Option<f64>,
    /// The whole recording, with what came before the start of the program.
    #[arg(long, conflicts_with = "from")]
    pub all: bool,
    /// One or two times at which values are read, s.
    #[arg(long, value_name = "S,S", value_delimiter = ',', value_parser = seconds)]
    pub cursor: Vec<f64>,
    /// Draw the way of two axes instead of signals over time; 2:X,2:Y are those of the second channel.
    #[arg(long, value_name = "AXIS,AXIS", value_parser = two_axes, requires = "output", conflicts_with = "circle")]
    pub xy: Option<[String; 2]>,
    /// Test the roundness of a circle in the plane of two axes; drawn as a ballbar shows it.
    #[arg(long, value_name = "AXIS,AXIS", value_parser = two_axes)]
    pub circle: Option<[String; 2]>,
    /// Deviation of one ring of the circle test, mm; chosen to fit without it.
    #[arg(long, value_name = "MM", requires = "circle", value_parser = positive)]
    pub division: Option<f64>,
    /// Measure the step response of an axis.
    #[arg(long, value_name = "AXIS")]
    pub step: Option<char>,
    /// Another recording to compare with.
    #[arg(long, value_name = "OTHER.csv", value_hint = ValueHint::FilePath)]
    pub against: Option<PathBuf>,
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

/// The axes of a circle test, of a channel by its number: `X,Y`, `2:X,2:Y`.
fn two_axes(text: &str) -> Result<[String; 2], String> {
    let axis = |text: &str| {
        let text = text.trim().to_ascii_uppercase();
        let letter = split_channel(&text).1;
        let is_axis = letter.len() == 1 && letter.bytes().all(|byte| byte.is_ascii_alphabetic());
        is_axis.then_some(text)
    };
    // `XY` will do.
    let parts = text.split_once(',').or_else(|| text.split_at_checked(1));
    let axes = parts
        .and_then(|(x, y)| axis(x).zip(axis(y)))
        .filter(|(x, y)| x != y);
    axes.map(|(x, y)| [x, y])
        .ok_or_else(|| "two axes like X,Y, or 2:X,2:Y of the second channel".to_owned())
}

fn positive(text: &str) -> Result<f64, String> {
    let value = text.parse::<f64>().ok();
    value
        .filter(|value| value.is_finite() && *value > 0.0)
        .ok_or_else(|| "a length greater than 0, mm".to_owned())
}

pub(crate) fn picture(text: &str) -> Result<Picture, String> {
    Picture::of(PathBuf::from(text)).ok_or_else(|| "the name must end in .svg or .png".to_owned())
}
