//! `bahn tune`: the commissioning assistant.

mod picture;

use std::fmt::Write as _;
use std::io::Write as _;
use std::path::PathBuf;

use bahn_host::tuning::{Circle, CircleTest, Tuned, tune};
use bahn_parameters::{Definition, ListText};
use clap::{Args, ValueHint};
use serde::Serialize;

use crate::files::{self, NewFile};
use crate::options::Format;
use crate::report::tidy;
use crate::{Outcome, UsageError, console, diagnostics, machine_folder, settings};

pub(crate) const EXAMPLES: &str = "\
Examples:
  bahn tune machines/mill X
      Circle tests and stops of X with its partner Y on the plant; proposes kv, pre-control, speed controller, backlash,
      reversal peaks and stiction, and shows what they bring. Nothing is changed.
  bahn tune mill X,Y --picture tuned.png --write
      The same with a picture of the circle and of a stop, before and after, and what it proposes in the list.
  bahn tune mill X --radius 50 --feed 5000 --format json

The machine is switched on for every trial, passes its reference marks and describes a circle in each direction in the
middle of its travel; what counts is where the tables of the plant stand, which no encoder sees. The parameters are tried in
the order of the manual: speed controller (MP1940, MP1920, MP1910, MP1945), MP1390, kv (MP1510, MP1810 with MP1710, MP1720;
the same for both axes), MP1520, MP710, reversal peaks (MP711, MP712; MP1960), stiction (MP1511 to MP1513). A proposal is
taken when the contour error falls by 2 % and stops overshoot no more than 5 µm, or than before.

JSON: axes, radius_mm, feed_mm_min, trials, written; before and after (contour_mm, roundness_mm, overshoot_mm); changes
(parameter, name, from, to).
Exit codes: 0 fine, also without a proposal; 1 the machine is wrong or does not get through the circle; 2 wrong use.";

/// Options of `bahn tune`.
#[derive(Args, Debug)]
pub(crate) struct TuneOptions {
    /// Folder of the machine.
    #[arg(value_name = "DIR", value_hint = ValueHint::DirPath)]
    pub folder: PathBuf,
    /// The axis, X or Y, or both as X,Y: the axes of the circle are tuned together, since their kv must be equal.
    #[arg(value_name = "AXIS", value_parser = axes)]
    pub axes: [char; 2],
    /// Radius of the circle, mm.
    #[arg(long, value_name = "MM", default_value_t = 20.0)]
    pub radius: f64,
    /// Feed on the circle, mm/min.
    #[arg(long, value_name = "MM/MIN", default_value_t = 2000.0)]
    pub feed: f64,
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

/// X and Y in either order; one stands for both.
fn axes(text: &str) -> Result<[char; 2], String> {
    match text.to_ascii_uppercase().as_str() {
        "X" | "X,Y" | "XY" => Ok(['X', 'Y']),
        "Y" | "Y,X" | "YX" => Ok(['Y', 'X']),
        _ => Err("the circle test runs in the plane of X and Y: X, Y or X,Y".to_owned()),
    }
}

#[derive(Serialize)]
struct Report {
    axes: String,
    radius_mm: f64,
    feed_mm_min: f64,
    trials: usize,
    written: bool,
    before: Figures,
    after: Figures,
    changes: Vec<ChangeRow>,
}

#[derive(Serialize)]
struct Figures {
    contour_mm: f64,
    roundness_mm: f64,
    overshoot_mm: f64,
}

#[derive(Serialize)]
struct ChangeRow {
    parameter: String,
    name: String,
    from: f64,
    to: f64,
}

impl Figures {
    fn of(test: &CircleTest) -> Figures {
        Figures {
            contour_mm: tidy(test.contour_mm),
            roundness_mm: tidy(test.roundness_mm),
            overshoot_mm: tidy(test.overshoot_mm),
        }
    }
}

/// Tunes, reports, draws and writes.
pub(crate) fn command(options: &TuneOptions) -> Result<Outcome, UsageError> {
    let positive = |value: f64| value.is_finite() && value > 0.0;
    if !positive(options.radius) || !positive(options.feed) {
        return Err(UsageError::new("--radius and --feed are greater than 0"));
    }
    if let Some(path) = &options.picture
        && !matches!(files::extension(path).as_str(), "png" | "svg")
    {
        return Err(UsageError::new("--picture: the name must end in .svg or .png"));
    }
    let machine = match machine_folder::load(&options.folder)? {
        Ok(machine) => machine,
        Err(faults) => {
            diagnostics::print_faults(&faults);
            return Ok(Outcome::ProgramError);
        }
    };
    let mut list = machine.parameters.clone();
    settings::assign(&mut list, &options.mp)?;
    let circle = Circle {
        radius_mm: options.radius,
        feed_mm_min: options.feed,
    };
    let tuned = match tune(&machine, &list, options.axes, circle) {
        Ok(tuned) => tuned,
        Err(what) => {
            diagnostics::print_usage_error(&format!("the circle test cannot be run: {what}"));
            return Ok(Outcome::ProgramError);
        }
    };
    if options.write {
        write(&machine, &tuned, &options.mp)?;
    }
    if let Some(path) = &options.picture {
        picture::write(path, &tuned, circle)?;
    }
    let report = report(&tuned, circle, &list, options.write);
    match options.format {
        Format::Json => console::print_json(&report)?,
        Format::Text => console::print(&text(&report))?,
    }
    Ok(Outcome::Fine)
}

/// Puts the proposals, and what `--mp` began with, into the list of the folder.
fn write(machine: &bahn_host::LoadedMachine, tuned: &Tuned, begun_with: &[String]) -> Result<(), UsageError> {
    let path = machine.root.join(&machine.folder.parameters);
    let bytes = files::read_table(&path)?;
    let model = machine.parameters.model();
    let mut text = ListText::from_bytes(model, &bytes);
    let wrong = |error: bahn_parameters::ParameterError| UsageError::new(error.to_string());
    let mut list = machine.parameters.clone();
    for assignment in begun_with {
        let id = list.assign(assignment).map_err(wrong)?;
        let value = list.get(id.number, id.index.unwrap_or(0)).unwrap_or_default();
        text.set(id, value).map_err(wrong)?;
    }
    for change in &tuned.changes {
        text.set(change.id, change.to).map_err(wrong)?;
    }
    let mut file = NewFile::create(&path)?;
    file.write_all(&text.to_bytes())
        .map_err(|error| files::cannot("write", &path, &error))?;
    Ok(file.finish()?)
}

fn report(tuned: &Tuned, circle: Circle, list: &bahn_parameters::ParameterList, written: bool) -> Report {
    let name = |id| Definition::named(list.model(), id).map_or("", |definition| definition.name);
    Report {
        axes: tuned.axes.iter().collect(),
        radius_mm: circle.radius_mm,
        feed_mm_min: circle.feed_mm_min,
        trials: tuned.trials,
        written,
        before: Figures::of(&tuned.before),
        after: Figures::of(&tuned.after),
        changes: tuned
            .changes
            .iter()
            .map(|change| ChangeRow {
                parameter: change.id.to_string(),
                name: name(change.id).to_owned(),
                from: change.from,
                to: change.to,
            })
            .collect(),
    }
}

fn text(report: &Report) -> String {
    let mut text = String::new();
    let um = |mm: f64| mm * 1e3;
    // Writing to a string cannot fail.
    let _ = writeln!(
        text,
        "circle of {} mm at {} mm/min in the plane {}, {} trials\n\n{:<28}{:>10}{:>10}",
        report.radius_mm, report.feed_mm_min, report.axes, report.trials, "", "before", "after"
    );
    for (name, before, after) in [
        (
            "contour error, µm",
            report.before.contour_mm,
            report.after.contour_mm,
        ),
        (
            "roundness, µm",
            report.before.roundness_mm,
            report.after.roundness_mm,
        ),
        (
            "overshoot of a stop, µm",
            report.before.overshoot_mm,
            report.after.overshoot_mm,
        ),
    ] {
        let _ = writeln!(text, "{name:<28}{:>10.2}{:>10.2}", um(before), um(after));
    }
    text.push('\n');
    for change in &report.changes {
        let ChangeRow {
            parameter,
            name,
            from,
            to,
        } = change;
        let _ = writeln!(text, "{parameter:<10}{from:>12} -> {to:<12}{name}");
    }
    text.push_str(match (report.changes.is_empty(), report.written) {
        (true, _) => "nothing gets better than it is\n",
        (false, true) => "\nwritten into the list of machine parameters\n",
        (false, false) => "\nnothing is changed; --write puts it into the list\n",
    });
    text
}
