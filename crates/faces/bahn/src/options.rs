//! Options that several subcommands share, and those of the small ones.

use std::path::PathBuf;

use bahn_parameters::{ControlModel, InchFeed};
use bahn_workpiece::Colouring;
use clap::{Args, ValueEnum, ValueHint};

use bahn_report::test_run::PathFile;

use crate::files;

pub(crate) const CHECK_EXAMPLES: &str = "\
Examples:
  bahn check *.h
  bahn check --model tnc360 --format json part.h
  bahn check part.nc         DIN 66025 of a TF5200

Every block is read; then the program is executed without geometry, with those that it calls, and beyond its
errors: labels, calls, tools, feeds, poles, arcs, cycles. What only follows from an earlier error is not
reported, nor what depends on Q parameters that the program does not set. A hundred faults of each program
are printed, the others counted; JSON has a thousand.

JSON report (--format json), one object for each file: file, blocks, errors, warnings, complete (executed to
its end), diagnostics (severity, message, program, block, line, column, length, detail, help).";

pub(crate) const FMT_EXAMPLES: &str = "\
Examples:
  bahn fmt part.h            the listing on standard output
  bahn fmt --write *.h       replace the files
  bahn fmt --check *.h       name the files that are written differently; exit code 1 if there are any
  bahn fmt examples/plate.I --parameters mill.mp
      Block numbers of DIN/ISO in the step of MP7220 of a list.";

pub(crate) const EXPLAIN_EXAMPLES: &str = "\
Examples:
  bahn explain TOOL RADIUS TOO LARGE
  bahn explain GROSS POSITIONING ERROR X A
      With axis, sign and code as the control shows it.
  bahn explain plc error 16
      An error of the PLC program, found by the compiler or while it runs.
  bahn explain software
      What takes an option or a release of the software, with its source.
  bahn explain tapping
      Everything that mentions the word: messages, PLC errors, machine parameters.
  bahn explain
      List all messages.";

/// What the program runs on.
#[derive(Args, Clone, Debug)]
#[command(next_help_heading = "Machine")]
pub(crate) struct MachineOptions {
    /// Folder of a machine: its control model, parameters, tools, datum and the texts of its PLC count; the
    /// program runs without its PLC and its drives.
    #[arg(long = "machine", value_name = "DIR", value_hint = ValueHint::DirPath, conflicts_with = "model")]
    pub folder: Option<PathBuf>,
    /// Tool table; without one tools are those that the program defines.
    #[arg(long, value_name = "TABLE", value_hint = ValueHint::FilePath)]
    pub tools: Option<PathBuf>,
    /// Angles of the points of drills that the program defines with TOOL DEF, by tool number in degrees, as
    /// 1=118,2=90 (a tool table has the column T-ANGLE).
    #[arg(long, value_name = "TOOL=DEG", value_delimiter = ',', value_parser = point_angle)]
    pub point_angle: Vec<(u32, f64)>,
    /// List of machine parameters that replaces values of the model's reference list. With MP10 or MP410 in it, or in
    /// `--mp`, the program has these axes and no others.
    #[arg(long, value_name = "LIST", value_hint = ValueHint::FilePath)]
    pub parameters: Option<PathBuf>,
    /// One machine parameter, as 7420=4 or 1010.0=5000 (repeatable, or several with commas).
    #[arg(
        long = "mp",
        value_name = "N=V",
        value_delimiter = ',',
        allow_hyphen_values = true
    )]
    pub mp: Vec<String>,
    /// Feed and rapid-traverse override, 0 to 150 %.
    #[arg(long = "override", value_name = "PERCENT", default_value = "100", value_parser = override_percent)]
    pub override_percent: f64,
    /// Time for the change to another tool, s.
    #[arg(long, value_name = "S", default_value = "6", value_parser = seconds)]
    pub tool_change_time: f64,
    /// Time for starting or stopping the spindle, s; a change of speed takes half of it.
    #[arg(long, value_name = "S", default_value = "1", value_parser = seconds)]
    pub spindle_time: f64,
    /// Simulate the block processing time of the model: short elements take at least so long.
    #[arg(long)]
    pub block_time: bool,
    /// Time for every M function, s.
    #[arg(long, value_name = "S", default_value = "0", value_parser = seconds)]
    pub m_time: f64,
}

/// How the program runs.
#[derive(Args, Debug)]
#[command(next_help_heading = "Run")]
pub(crate) struct RunOptions {
    /// Set a Q parameter before the start, as Q1=5 (repeatable, or several with commas).
    #[arg(long, value_name = "Qn=V", value_delimiter = ',')]
    pub set: Vec<String>,
    /// Where the axes stand before the start, as X10,Y0,Z50 in mm and degrees; other axes have no position
    /// until they are programmed.
    #[arg(
        long,
        value_name = "X..,Y..,Z..",
        value_delimiter = ',',
        allow_hyphen_values = true
    )]
    pub start: Vec<String>,
    /// Where tools are changed: the tip of another tool stands there, as Z200 or X0,Y-100,Z200 in mm, workpiece
    /// coordinates; by default above the blank.
    #[arg(long, value_name = "Z..", value_delimiter = ',', allow_hyphen_values = true)]
    pub tool_change: Vec<String>,
    /// Where the workpiece lies in the machine: its datum from machine zero, for M91, M92 and the traverse
    /// range, as X300,Y200,Z-350; by default MP960 where it is not 0.
    #[arg(
        long,
        value_name = "X..,Y..,Z..",
        value_delimiter = ',',
        allow_hyphen_values = true
    )]
    pub datum: Vec<String>,
    /// Time after which a run is broken off with the report so far, s; 300 in a table, none otherwise.
    #[arg(long, value_name = "S", value_parser = time_limit)]
    pub time_limit: Option<f64>,
    /// Pass over optional blocks (/).
    #[arg(long)]
    pub skip_blocks: bool,
    /// What F counts in a program in inches, instead of what it counts on the model.
    #[arg(long, value_name = "WHAT", value_enum)]
    pub inch_feed: Option<InchFeedOption>,
    /// End at the first programmed stop (STOP, M0) instead of passing over it.
    #[arg(long)]
    pub stop: bool,
    /// Refuse what is otherwise accepted with a warning, such as functions that have no effect here or signs
    /// of cycle parameters that disagree.
    #[arg(long)]
    pub strict: bool,
    /// Pass over words and blocks that nothing here knows, and functions without which the control would
    /// move differently, each with a warning, instead of ending with an error.
    #[arg(long, conflicts_with = "strict")]
    pub skip_unknown: bool,
    /// Blocks that may be executed without a movement; more are taken for an endless loop.
    #[arg(long, value_name = "N", default_value_t = 10_000_000, value_parser = clap::value_parser!(u64).range(1..))]
    pub max_blocks: u64,
}

/// Files that a command writes.
#[derive(Args, Debug)]
#[command(next_help_heading = "Output")]
pub(crate) struct OutputOptions {
    /// Write the tool path as table (.csv) or drawing (.svg) (repeatable).
    #[arg(long, value_name = "OUT.csv|OUT.svg", value_parser = path_file, value_hint = ValueHint::FilePath)]
    pub path: Vec<PathFile>,
    /// Write what FN15 PRINT puts out, a line each.
    #[arg(long, value_name = "OUT.txt", value_hint = ValueHint::FilePath)]
    pub print: Option<PathBuf>,
    /// Write the programs that TCH PROBE 5 to 7 digitize into this folder; a program of that name is replaced.
    /// `bahn run` without this writes them beside the programs of the machine and replaces none.
    #[arg(long, value_name = "DIR", value_hint = ValueHint::DirPath)]
    pub digitized: Option<PathBuf>,
    /// What TCH PROBE 5 to 7 digitize: a solid (STL, mm, workpiece coordinates) instead of the part that the program
    /// machines.
    #[arg(long, value_name = "SOLID.stl", value_hint = ValueHint::FilePath)]
    pub solid: Option<PathBuf>,
    /// Compare the finished part with a solid (STL, mm, workpiece coordinates): says how far it is off; a picture with
    /// `--color deviation` shows where.
    #[arg(long, value_name = "SOLID.stl", value_hint = ValueHint::FilePath)]
    pub compare: Option<PathBuf>,
    /// Write a picture of the finished part (PNG).
    #[arg(long, value_name = "OUT.png", value_hint = ValueHint::FilePath)]
    pub image: Option<PathBuf>,
    /// View of the picture.
    #[arg(long, value_enum, default_value_t, requires = "image")]
    pub view: View,
    /// 3D view: where the eye stands about the tool axis, degrees; 0 in front, 90 on the right.
    #[arg(long, value_name = "DEGREES", default_value = "30", requires = "image", allow_hyphen_values = true, value_parser = finite)]
    pub angle: f64,
    /// 3D view: how high the eye stands, degrees; 90 from above, negative from below.
    #[arg(long, value_name = "DEGREES", default_value = "38", requires = "image", allow_hyphen_values = true, value_parser = finite)]
    pub elevation: f64,
    /// What the colours tell; in space the blank and what was machined (`part`), from above the depth.
    #[arg(long, value_name = "WHAT", value_enum, requires = "image")]
    pub color: Option<ColorOption>,
    /// Draw the tool path over the part, feed solid, rapid traverse dashed.
    #[arg(long, requires = "image")]
    pub toolpath: bool,
    /// Three planes: where the sections lie, as X30,Y20; the middle of the blank otherwise.
    #[arg(
        long,
        value_name = "X..,Y..",
        value_delimiter = ',',
        requires = "image",
        allow_hyphen_values = true
    )]
    pub section: Vec<String>,
    /// Size of the picture in pixels.
    #[arg(long, value_name = "WxH", default_value = "1000x800", requires = "image", value_parser = image_size)]
    pub size: (u32, u32),
    /// Write the finished part as mesh (binary STL).
    #[arg(long, value_name = "OUT.stl", value_hint = ValueHint::FilePath)]
    pub mesh: Option<PathBuf>,
    /// Side of the columns that the part is made of, mm; by default about a million columns.
    #[arg(long, value_name = "MM", value_parser = positive)]
    pub resolution: Option<f64>,
    /// Test run without graphics: no material is removed, `removed_mm3` is not reported.
    #[arg(long, conflicts_with_all = ["image", "mesh", "resolution"])]
    pub no_graphics: bool,
}

/// Options of `bahn check`.
#[derive(Args, Debug)]
pub(crate) struct CheckOptions {
    /// Part programs that are examined.
    #[arg(value_name = "FILE", required = true, value_hint = ValueHint::FilePath)]
    pub files: Vec<PathBuf>,
    /// Control model whose limits apply.
    #[arg(long, value_name = "MODEL", default_value_t, ignore_case = true, value_parser = model_parser())]
    pub model: ControlModel,
    /// Refuse functions that have no effect here, or only part of it.
    #[arg(long)]
    pub strict: bool,
    /// Warn of functions without which the control would move differently, instead of refusing them.
    #[arg(long, conflicts_with = "strict")]
    pub skip_unknown: bool,
    /// What F counts in a program in inches, instead of what it counts on the model.
    #[arg(long, value_name = "WHAT", value_enum)]
    pub inch_feed: Option<InchFeedOption>,
    /// How errors are written.
    #[arg(long, value_name = "FORMAT", value_enum, default_value_t)]
    pub format: Format,
}

/// Options of `bahn fmt`.
#[derive(Args, Debug)]
pub(crate) struct FmtOptions {
    /// Part programs whose listings are written.
    #[arg(value_name = "FILE", required = true, value_hint = ValueHint::FilePath)]
    pub files: Vec<PathBuf>,
    /// Replace the files by their listings.
    #[arg(long, short, conflicts_with = "check")]
    pub write: bool,
    /// Write nothing but the names of files that differ from their listing.
    #[arg(long)]
    pub check: bool,
    /// Write decimal commas instead of points.
    #[arg(long)]
    pub comma: bool,
    /// Step of the block numbers of DIN/ISO programs, 0 writes none; by default MP7220 of the list, or 10 without one.
    #[arg(long, value_name = "STEP")]
    pub iso_step: Option<u8>,
    /// List of machine parameters with MP7220, as the control that the programs go to has it.
    #[arg(long, value_name = "LIST", value_hint = ValueHint::FilePath)]
    pub parameters: Option<PathBuf>,
    /// Control model of the list.
    #[arg(long, value_name = "MODEL", default_value_t, ignore_case = true, requires = "parameters", value_parser = model_parser())]
    pub model: ControlModel,
}

impl FmtOptions {
    /// Step of block numbers where no list says it.
    pub const ISO_STEP: u8 = 10;
}

/// Options of `bahn explain`.
#[derive(Args, Debug)]
pub(crate) struct ExplainOptions {
    /// Text of the message as it is shown, its name, or words to search; nothing lists all.
    #[arg(value_name = "MESSAGE")]
    pub message: Vec<String>,
    /// Control model whose texts are listed.
    #[arg(long, value_name = "MODEL", default_value_t, ignore_case = true, value_parser = model_parser())]
    pub model: ControlModel,
}

/// What F counts in a program in inches.
#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
pub(crate) enum InchFeedOption {
    /// Inches per minute.
    Whole,
    /// Tenths of an inch per minute.
    Tenths,
}

impl From<InchFeedOption> for InchFeed {
    fn from(option: InchFeedOption) -> InchFeed {
        match option {
            InchFeedOption::Whole => InchFeed::Whole,
            InchFeedOption::Tenths => InchFeed::Tenths,
        }
    }
}

/// How a report is written.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, ValueEnum)]
pub(crate) enum Format {
    /// Lines for people.
    #[default]
    Text,
    /// JSON for programs.
    Json,
}

/// Views of the part.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, ValueEnum)]
pub(crate) enum View {
    /// From above, the deeper the darker.
    Plan,
    /// Plan view and two sections.
    ThreePlanes,
    /// The part in space.
    #[default]
    #[value(name = "3d")]
    ThreeD,
}

/// What the colours of a view tell.
#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
pub(crate) enum ColorOption {
    /// Blank and machined surfaces.
    Part,
    /// The deeper, the darker.
    Depth,
    /// The tool that cut last; cuts in rapid traverse are red.
    Tool,
    /// How far the part is from that of --compare, from above: red where material is left, blue where it is missing.
    Deviation,
}

impl From<ColorOption> for Colouring {
    fn from(option: ColorOption) -> Colouring {
        match option {
            ColorOption::Part => Colouring::Part,
            ColorOption::Depth => Colouring::Depth,
            ColorOption::Tool => Colouring::Tool,
            // Drawn by itself.
            ColorOption::Deviation => Colouring::Part,
        }
    }
}

pub(crate) fn model_parser() -> impl clap::builder::TypedValueParser<Value = ControlModel> {
    use clap::builder::{PossibleValuesParser, TypedValueParser};
    PossibleValuesParser::new(ControlModel::ALL.map(ControlModel::id))
        .try_map(|id| id.parse::<ControlModel>())
}

fn finite(text: &str) -> Result<f64, String> {
    text.parse::<f64>()
        .ok()
        .filter(|value| value.is_finite())
        .ok_or_else(|| "no number".to_owned())
}

pub(crate) fn positive(text: &str) -> Result<f64, String> {
    finite(text)
        .ok()
        .filter(|value| *value > 0.0)
        .ok_or_else(|| "it takes a number greater than 0".to_owned())
}

/// A tool and the angle of its point.
fn point_angle(text: &str) -> Result<(u32, f64), String> {
    let least = bahn_path::ToolShape::POINT_ANGLE_MIN_DEG;
    let (tool, angle) = text
        .split_once('=')
        .ok_or_else(|| "it takes a tool and its angle, as 1=118".to_owned())?;
    let tool = tool
        .trim()
        .parse()
        .map_err(|_| format!("`{tool}` is no tool number"))?;
    match angle.trim().parse::<f64>() {
        Ok(angle) if (least..180.0).contains(&angle) => Ok((tool, angle)),
        _ => Err(format!("a point has {least} to 180 degrees")),
    }
}

pub(crate) fn seconds(text: &str) -> Result<f64, String> {
    finite(text)
        .ok()
        .filter(|value| *value >= 0.0)
        .ok_or_else(|| "it takes a time of 0 s or more".to_owned())
}

pub(crate) fn time_limit(text: &str) -> Result<f64, String> {
    finite(text)
        .ok()
        .filter(|value| (0.001..=1e9).contains(value))
        .ok_or_else(|| "it takes a time of at least 0.001 s".to_owned())
}

pub(crate) fn override_percent(text: &str) -> Result<f64, String> {
    finite(text.trim_end_matches('%'))
        .ok()
        .filter(|value| (0.0..=150.0).contains(value))
        .ok_or_else(|| "it takes 0 to 150 %".to_owned())
}

fn path_file(text: &str) -> Result<PathFile, String> {
    let path = PathBuf::from(text);
    match files::extension(&path).as_str() {
        "csv" => Ok(PathFile::Csv(path)),
        "svg" => Ok(PathFile::Svg(path)),
        _ => Err("the name must end in .csv or .svg".to_owned()),
    }
}

pub(crate) fn image_size(text: &str) -> Result<(u32, u32), String> {
    let wrong = || {
        let (least, most) = (bahn_workpiece::Page::MIN_SIDE, bahn_workpiece::Page::MAX_SIDE);
        format!("it takes width x height, as 1000x800, from {least} to {most}")
    };
    let (width, height) = text.split_once(['x', 'X']).ok_or_else(wrong)?;
    let size = (
        width.parse().map_err(|_| wrong())?,
        height.parse().map_err(|_| wrong())?,
    );
    bahn_workpiece::Page::new(size.0, size.1, "", "")
        .map(|_| size)
        .map_err(|_| wrong())
}
