//! `bahn tune`: the commissioning assistant.

mod changes;
mod options;
mod spindle;

use std::fmt::Write as _;

use bahn_parameters::Adjustment;
use bahn_trials::tuning::{AxisTest, Circle, Task, Tuned, tune};

use serde::Serialize;

use crate::options::Format;
use crate::{Outcome, UsageError, console, diagnostics, machine_folder, settings};
use bahn_report::record::tidy;
use bahn_report::scope::{self, Picture};
use bahn_report::tune::sheet;

pub(crate) use options::TuneOptions;

use changes::{ChangeRow, change_rows, change_text, write};

pub(crate) const EXAMPLES: &str = "\
Examples:
  bahn tune machines/mill X
      Circle tests and stops of X with its partner Y on the plant; proposes kv, kink point, pre-control,
      speed controller, backlash, reversal peaks, stiction and integral factor, and shows what they
      bring. Nothing is changed.
  bahn tune mill X,Y --picture tuned.png --write
      The same with a picture of the circle and of a stop, before and after, and what it proposes in
      the list.
  bahn tune mill Z --machining-feed 4000
      Circles in the plane Z/X; a kink point lies above 4000 mm/min. Y,Z is the plane Y/Z.
  bahn tune machines/mill-tnc155 X
      X and Y of a TNC 155, with the entries that all its axes have in common.
  bahn tune machines/gantry B --radius 30 --feed 3000
      A rotary axis, or one without a partner, alone: 30 degrees to both sides at 3000 degrees/min,
      and stops.
  bahn tune mill X --radius 50 --feed 5000 --format json
  bahn tune machines/mill S
      The spindle: threads of cycles 17 and 18 in the middle of Z, in each gear range at its rated
      speed. Proposes the ramp MP3410.3, the steepest with which threads end within 0.01 mm of their
      depth, and MP3440, kv with which it is oriented soonest. Not on a TNC 151/155, which has no
      cycle 17.

The machine is switched on for every trial, passes its reference marks and describes a circle in each
direction in the middle of its travel, or goes to and fro there; then each axis stops from rapid
traverse and from the feed. What counts is where the tables of the plant stand, which no encoder sees.
The parameters are tried in the order of the manual: speed controller (MP1940, MP1920, MP1910,
MP1945); with servo lag kv (MP1810, with MP1710, MP1720) and, where only stops from rapid traverse
overshoot, the kink point (MP1820, MP1830); with pre-control kv (MP1510) and MP1520; MP1390, the
better of both; MP710, reversal peaks (MP711, MP712; MP1960), stiction (MP1511 to MP1513); MP1080. kv
is the same for both axes, and a slave (MP850) gets what its master gets. A proposal is taken when the
contour error falls by 2 % and stops overshoot no more than 5 µm, or than before. An axis alone leaves
MP1390 and MP1520, which are common to all, and its MP1810 does not go above that of the others.

On a TNC 151/155 other axes change, too: all that programs move get the same kv (MP177 to MP180), and
MP54, MP55, half of it, MP176 and MP181 (kink point), MP175 and MP174 (10 and 20 % above the greatest
lag at rapid traverse) are one for all. The other linear axes stop in each trial, too, and contour
error and roundness count together. MP60 stays. Where it is 0, MP32 to MP35 (the same kv again), MP53,
MP64, MP56 and MP57 follow. Then MP36 to MP39 and MP28 to MP31 of the axes named.

JSON: axes, radius_mm, feed_mm_min, trials, written; before and after (contour_mm, of an axis alone
from its nominal value; roundness_mm, overshoot_mm, standstill_mm of each axis); changes (parameter,
name, from, to); kv_lag, kv with servo lag of each axis. Of the spindle: trials, written, changes;
before and after (beyond_mm the depth, off_mm from where the spindle's angle says, threads_s,
orientation_s before two threads of each gear range).
Exit codes: 0 fine, also without a proposal; 1 the machine is wrong or does not get through the trial;
2 wrong use.";

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
    kv_lag: Vec<Kv>,
    /// Whether all axes of the path get the same.
    #[serde(skip)]
    for_all: bool,
}

#[derive(Serialize)]
struct Kv {
    axis: char,
    kv: f64,
}

#[derive(Serialize)]
struct Figures {
    contour_mm: f64,
    roundness_mm: f64,
    overshoot_mm: f64,
    standstill_mm: Vec<f64>,
}

impl Figures {
    fn of(test: &AxisTest) -> Figures {
        Figures {
            contour_mm: tidy(test.contour_mm),
            roundness_mm: tidy(test.roundness_mm),
            overshoot_mm: tidy(test.overshoot_mm),
            standstill_mm: test.standstill_mm.iter().map(|rest| tidy(*rest)).collect(),
        }
    }
}

/// Tunes, reports, draws and writes.
pub(crate) fn command(options: &TuneOptions) -> Result<Outcome, UsageError> {
    let positive = |value: f64| value.is_finite() && value > 0.0;
    if !positive(options.radius) || !positive(options.feed) {
        return Err(UsageError::new("--radius and --feed are greater than 0"));
    }
    if options.machining_feed.is_some_and(|feed| !positive(feed)) {
        return Err(UsageError::new("--machining-feed is greater than 0"));
    }
    let picture = options.picture.clone().map(|path| {
        Picture::of(path).ok_or_else(|| UsageError::new("--picture: the name must end in .svg or .png"))
    });
    let picture = picture.transpose()?;
    let machine = match machine_folder::load(&options.folder)? {
        Ok(machine) => machine,
        Err(faults) => {
            diagnostics::print_faults(&faults);
            return Ok(Outcome::ProgramError);
        }
    };
    let mut list = machine.parameters.clone();
    settings::assign(&mut list, &options.mp)?;
    if options.axes == ('S', None) {
        return spindle::command(&machine, &list, options);
    }
    let circle = Circle {
        radius_mm: options.radius,
        feed_mm_min: options.feed,
    };
    let task = Task {
        axis: options.axes.0,
        partner: options.axes.1,
        circle,
        machining_mm_min: options.machining_feed,
    };
    let tuned = match tune(&machine, &list, &task) {
        Ok(tuned) => tuned,
        Err(what) => {
            diagnostics::print_usage_error(&format!("the trial cannot be run: {what}"));
            return Ok(Outcome::ProgramError);
        }
    };
    if options.write {
        write(&machine, &tuned.changes, &options.mp)?;
    }
    if let Some(picture) = &picture {
        scope::write(&sheet(&tuned, circle), picture)?;
    }
    let report = report(&tuned, circle, &list, options.write);
    match options.format {
        Format::Json => console::print_json(&report)?,
        Format::Text => console::print(&text(&report))?,
    }
    Ok(Outcome::Fine)
}

fn report(tuned: &Tuned, circle: Circle, list: &bahn_parameters::ParameterList, written: bool) -> Report {
    Report {
        axes: tuned.axes.iter().collect(),
        radius_mm: circle.radius_mm,
        feed_mm_min: circle.feed_mm_min,
        trials: tuned.trials,
        written,
        before: Figures::of(&tuned.before),
        after: Figures::of(&tuned.after),
        changes: change_rows(&tuned.changes, list),
        kv_lag: tuned
            .kv_lag
            .iter()
            .map(|(axis, kv)| Kv { axis: *axis, kv: *kv })
            .collect(),
        for_all: list.is_common(Adjustment::LagMonitor) && tuned.axes.len() > 1,
    }
}

fn text(report: &Report) -> String {
    let mut text = String::new();
    let alone = report.axes.chars().count() == 1;
    let um = |mm: f64| mm * 1e3;
    let (unit, what) = match alone {
        true => ("1/1000", "from the nominal value"),
        false => ("µm", "contour error"),
    };
    let (
        Report {
            radius_mm,
            feed_mm_min,
            axes,
            trials,
            ..
        },
        heads,
    ) = (report, ("before", "after"));
    let path = match alone {
        true => format!("{axes} by {radius_mm} to both sides at {feed_mm_min}/min"),
        false => format!("circle of {radius_mm} mm at {feed_mm_min} mm/min in the plane {axes}"),
    };
    // Writing to a string cannot fail.
    let _ = writeln!(
        text,
        "{path}, {trials} trials\n\n{:<34}{:>10}{:>10}",
        "", heads.0, heads.1
    );
    let (before, after) = (&report.before, &report.after);
    let mut rows = vec![(what.to_owned(), before.contour_mm, after.contour_mm)];
    if !alone {
        rows.push(("roundness".to_owned(), before.roundness_mm, after.roundness_mm));
    }
    rows.push((
        "overshoot of a stop".to_owned(),
        before.overshoot_mm,
        after.overshoot_mm,
    ));
    let rests = before.standstill_mm.iter().zip(&after.standstill_mm);
    for (axis, (before, after)) in report.axes.chars().zip(rests) {
        rows.push((format!("at rest, {axis}"), *before, *after));
    }
    for (name, before, after) in rows {
        let name = format!("{name}, {unit}");
        let _ = writeln!(text, "{name:<34}{:>10.2}{:>10.2}", um(before), um(after));
    }
    text.push_str(&change_text(&report.changes, report.written));
    if report.for_all && !report.changes.is_empty() {
        let axes: Vec<String> = report.kv_lag.iter().map(|kv| kv.axis.to_string()).collect();
        let _ = writeln!(
            text,
            "{} have one kv, acceleration and monitoring: these are for all of them",
            axes.join(", ")
        );
    }
    let first = report.kv_lag.first().map_or(0.0, |first| first.kv);
    if report.kv_lag.iter().any(|other| other.kv != first) {
        let each: Vec<String> = report
            .kv_lag
            .iter()
            .map(|kv| format!("{} {}", kv.axis, kv.kv))
            .collect();
        let _ = writeln!(
            text,
            "kv with servo lag differs: {}; axes that interpolate need the same",
            each.join(", ")
        );
    }
    text
}
