//! Options and help texts of `bahn test`.

use std::path::{Path, PathBuf};

use bahn_parameters::ControlModel;
use clap::{Args, ValueHint};

use bahn_report::shelf::ReportFile;
use bahn_report::test_run::PathFile;

use crate::files;
use crate::options::{Format, MachineOptions, OutputOptions, RunOptions, model_parser, positive};

pub(crate) const EXAMPLES: &str = "\
Examples:
  bahn test part.h
      Run part.h; report machining time, path, tools, removed material, warnings.
  bahn test part.h --image part.png --view 3d
      Show the finished part.
  bahn test part.h --html part.html
      A page for any browser, one file: the part to turn, cut open and measure, a slider along the path with the
      blocks in step.
  bahn test part.h --path part.csv --path part.svg
      Every tool movement as a table and as a drawing.
  bahn test part.h --model tnc360 --mp 7420=4 --set Q1=5,Q2=-3.5
      On a TNC 360 with another machine parameter and Q parameters set.
  bahn test part.h --tools tool.t --start X0,Y0,Z100 --format json
      With a tool table, from a start position; the report as JSON.
  bahn test part.nc --start X0,Y0,Z0
      A program of DIN 66025, as this control executes it; docs/din66025.md says what of it.
  bahn test machines/portal900/programs/P1000.900 --machine machines/portal900
      A program of a System 900, which a machine with that control alone runs; docs/system900.md.
  bahn test parts/ --report shelf.html
      All programs of a folder and the folders in it on all cores: a table, and a page with the pictures.
  bahn test parts/ --report shelf.csv --comma --density 7.85
      For a German spreadsheet, with the weights of the steel.
  bahn test MODEL.H --tools tools.tsv --digitized . --mesh model.stl
  bahn test AGAIN.H --tools tools.tsv --compare model.stl --color deviation --image off.png
      Digitize the part; then compare what the digitized program makes with it.
  find . -name '*.H' | bahn test - --against machines/mill
      What is different from a run with parameters and tools of a machine.

Tables: several files, a folder, - (names on standard input, one a line), --report, --against or --density
give a table in place of the report. Every file is a program of its own. One that fails alone, but is called
by CALL PGM from another one of the table, is marked `called` and is no error. Parts are made of about
250,000 columns there unless --resolution says otherwise. Exit code 1 when a program has an error, cannot be
read or takes longer than --time-limit; the others run all the same.

Comparison (--against): a list of machine parameters, a tool table, a folder of a machine, or the report of
an earlier run (.json, .csv). Shown is what changes from there to this run.

Spindle and tools: a cut with the spindle stopped, with S0 or with the spindle turning the wrong way is
reported once for each tool. Tools with + in the column DIRECT cut with M4, all others with M3.

Tool table (--tools): a text file with a line of column names and one line for each tool:
  T  L     R    R2  NAME
  1  80.5  10   0   END MILL D20
  2  62    4    4   BALL D8
T is the number, L the length, R the radius, R2 the corner radius (0 flat end, as great as R ball
end), in mm; DL, DR, DR2 are added to them; T-ANGLE is the angle of a drill's point in degrees, DIRECT
is - for M3, + for M4. A tool that is locked (TL) must not be called; in place of one whose life is over
(CUR.TIME greater than TIME2, minutes) its replacement RT is called. Other columns are ignored. Columns are separated by blanks, tabs, commas or
semicolons. TOOL.T files of later controls (first line BEGIN TOOL .T MM or INCH, fixed columns) load
too.

Machine parameters (--parameters): a text file with lines like `MP7430 : 1.2 ;overlap`. They replace
values of the reference list of the model; --mp replaces single ones after that.

Machine (--machine): the control model, parameters, tools, datum and PLC texts (FN14) of a folder; --parameters,
--mp, --tools and --datum replace its own.

JSON report (--format json), lengths in mm: program, unit, completed, error (message, program, block,
line, detail, or null), machining_time_s (null when the feed is 0), path_mm (feed, rapid),
blocks_executed, tool_calls (block, tool, speed_rpm), final_position, q, removed_mm3 (null without a
blank), warnings (message, program, block, line, count), stops (block, function, program, line), printed (block,
text, program, line: FN15).

JSON of a table: model, totals, programs (path, result, error, unit, machining_time_s, feed_mm, rapid_mm,
blocks_executed, tools, blank_mm, finished_mm, removed_mm3, removed_kg, finished_kg, travel by axis with
the limits of the machine and whether it fits, warnings, calls, changes).

Ctrl-C ends the run with the report or the table so far and exit code 130.";

/// Options of the test run.
#[derive(Args, Debug)]
pub(crate) struct TestOptions {
    /// Part programs up to 1 GiB, folders of them, or - for a list of names on standard input.
    #[arg(value_name = "FILE|FOLDER|-", required = true, value_hint = ValueHint::AnyPath)]
    pub files: Vec<PathBuf>,

    /// Control model on which the programs run.
    #[arg(long, value_name = "MODEL", default_value_t, ignore_case = true, value_parser = model_parser())]
    pub model: ControlModel,

    /// How the report is written.
    #[arg(long, value_name = "FORMAT", value_enum, default_value_t)]
    pub format: Format,

    #[command(flatten)]
    pub machine: MachineOptions,
    #[command(flatten)]
    pub run: RunOptions,
    #[command(flatten)]
    pub output: OutputOptions,
    /// Write a page (one file, no network) with the part to turn, cut open and measure, the tool path with a slider,
    /// blocks, times and warnings.
    #[arg(long, value_name = "OUT.html", value_hint = ValueHint::FilePath, help_heading = "Output")]
    pub html: Option<PathBuf>,
    #[command(flatten)]
    pub table: TableOptions,
}

/// Many programs at once.
#[derive(Args, Debug)]
#[command(next_help_heading = "Table")]
pub(crate) struct TableOptions {
    /// Endings of the programs that are taken from folders, in upper or lower case.
    #[arg(long, value_name = "EXT,..", value_delimiter = ',', default_value = "h")]
    pub ext: Vec<String>,
    /// Write the table as .csv, .json or .html (repeatable).
    #[arg(long, value_name = "OUT.csv|json|html", value_parser = report_file, value_hint = ValueHint::FilePath)]
    pub report: Vec<ReportFile>,
    /// Decimal commas and semicolons in the .csv.
    #[arg(long, requires = "report")]
    pub comma: bool,
    /// Density of the material, g/cm³, for weights.
    #[arg(long, value_name = "G/CM3", value_parser = positive)]
    pub density: Option<f64>,
    /// Show what changes from OTHER to this run: a parameter list, a tool table, a folder of a machine, or an
    /// earlier report.
    #[arg(long, value_name = "OTHER", value_hint = ValueHint::AnyPath)]
    pub against: Option<PathBuf>,
}

impl TestOptions {
    /// The program, when it is a single one that gets a report.
    pub fn single(&self) -> Option<&Path> {
        let table = &self.table;
        let wants_table = !table.report.is_empty() || table.against.is_some() || table.density.is_some();
        match self.files.as_slice() {
            [file] if !wants_table && file.as_os_str() != "-" && !file.is_dir() => Some(file),
            _ => None,
        }
    }

    /// Files that are read.
    pub fn inputs(&self) -> Vec<&Path> {
        let machine = [
            &self.machine.tools,
            &self.machine.parameters,
            &self.table.against,
            &self.output.solid,
            &self.output.compare,
        ];
        let machine = machine.into_iter().flatten();
        self.files.iter().chain(machine).map(PathBuf::as_path).collect()
    }

    /// Files that are written, with their options.
    pub fn written(&self) -> Vec<(&'static str, &Path)> {
        let reports = self.table.report.iter().map(|file| ("--report", file.path()));
        let page = self.html.iter().map(|path| ("--html", path.as_path()));
        self.output.written().chain(page).chain(reports).collect()
    }
}

impl OutputOptions {
    /// Files that are written, with their options.
    pub fn written(&self) -> impl Iterator<Item = (&'static str, &Path)> {
        let paths = self.path.iter().map(|file| match file {
            PathFile::Csv(path) | PathFile::Svg(path) => ("--path", path.as_path()),
        });
        let image = self.image.iter().map(|path| ("--image", path.as_path()));
        let mesh = self.mesh.iter().map(|path| ("--mesh", path.as_path()));
        let print = self.print.iter().map(|path| ("--print", path.as_path()));
        paths.chain(image).chain(mesh).chain(print)
    }

    /// The names of the files that are written; picture and mesh when the `part` was drawn.
    pub fn names(&self, part: bool) -> Vec<String> {
        let paths = self.path.iter().map(|file| match file {
            PathFile::Csv(path) | PathFile::Svg(path) => path,
        });
        let paths = paths.chain(&self.print);
        let of_the_part = self.image.iter().chain(&self.mesh).filter(|_| part);
        let all = paths.chain(of_the_part);
        all.map(|path| path.display().to_string()).collect()
    }
}

fn report_file(text: &str) -> Result<ReportFile, String> {
    let path = PathBuf::from(text);
    match files::extension(&path).as_str() {
        "csv" => Ok(ReportFile::Csv(path)),
        "json" => Ok(ReportFile::Json(path)),
        "html" | "htm" => Ok(ReportFile::Html(path)),
        _ => Err("the name must end in .csv, .json or .html".to_owned()),
    }
}
