//! A laser interferometer beside the machine: where each table stands in truth, against where the control says that it
//! stands, and what compensates the difference [000:3632-3865].
//!
//! Decision: `bahn compensate` goes to its points with servo lag and at most kv 1.5, so that no table is pushed to
//! the other side of its play; drift is taken out in proportion to the time

use std::collections::BTreeMap;

use bahn_parameters::axis::AxisParameters;
use bahn_parameters::{Adjustment, PLC_AXIS_NAMES, ParameterList, PerPlcAxis};
use bahn_tnc::{CompensationAssignment, CompensationTable, Signal};

use crate::trial;
use bahn_host::LoadedMachine;

/// Points of a table at most: three axes share 640 [000:3770].
const POINTS_MAX: usize = 100;
/// Unit of DIST, mm [000:3777].
const DIST_UNIT_MM: f64 = 1e-4;
/// The axis stays so far from its software limits, mm.
const MARGIN_MM: f64 = 1.0;
/// It comes to its points so gently that it does not go beyond them, with servo lag: mm/min, (m/min)/mm at most. A table
/// that was pushed beyond lies on the other side of its play.
const FEED_MM_MIN: f64 = 1000.0;
const KV_MAX: f64 = 1.5;
/// It rests so long before it is measured, s.
const REST_S: f64 = 0.5;
/// Entries of tables, mm.
const ENTRY_MM: f64 = 1e-4;
/// Names of tables begin with it.
pub const TABLE_NAME: &str = "LASER-";

/// What was measured of an axis, errors in mm: positive where the table stands too far.
#[derive(Clone, Debug, PartialEq)]
pub struct AxisErrors {
    /// Letter of the axis.
    pub letter: char,
    /// Its index in the list.
    pub index: u8,
    /// Exponent of the spacing of the points.
    pub exponent: u32,
    /// Position of each point by the control, mm from the machine datum.
    pub at_mm: Vec<f64>,
    /// Error at it when the axis comes upwards, and downwards; 0 is the error of the point next to the machine datum.
    pub errors_mm: Vec<[f64; 2]>,
    /// What the readings moved by in the time of the run, mm: the machine grew.
    pub drift_mm: f64,
}

impl AxisErrors {
    /// Greatest error of both directions.
    pub fn greatest_mm(&self) -> f64 {
        let all = self.errors_mm.iter().flatten();
        all.fold(0.0, |greatest, error| greatest.max(error.abs()))
    }

    /// Backlash, mm: the table stays behind where it comes upwards.
    pub fn backlash_mm(&self) -> f64 {
        let count = self.errors_mm.len().max(1) as f64;
        self.errors_mm.iter().map(|[up, down]| down - up).sum::<f64>() / count
    }

    /// Errors without the backlash.
    fn means(&self) -> Vec<f64> {
        self.errors_mm
            .iter()
            .map(|[up, down]| (up + down) / 2.0)
            .collect()
    }

    /// The linear error, mm/m, and what it leaves, mm.
    pub fn linear(&self) -> (f64, f64) {
        let means = self.means();
        let count = means.len().max(1) as f64;
        let (at, error) = (
            self.at_mm.iter().sum::<f64>() / count,
            means.iter().sum::<f64>() / count,
        );
        let pairs = || std::iter::zip(&self.at_mm, &means).map(|(x, y)| (x - at, y - error));
        let slope = pairs().map(|(x, y)| x * y).sum::<f64>() / pairs().map(|(x, _)| x * x).sum::<f64>();
        let left = pairs().map(|(x, y)| (y - slope * x).abs()).fold(0.0, f64::max);
        (slope * 1e3, left)
    }

    /// Its table as a file.
    pub fn table(&self) -> String {
        use std::fmt::Write as _;
        let name = PLC_AXIS_NAMES
            .get(usize::from(self.index))
            .copied()
            .unwrap_or("X");
        let datum = self.at_mm.first().copied().unwrap_or(0.0);
        let mut text = format!(
            "{TABLE_NAME}{} MM DATUM {datum:.4} DIST {} {name}\n",
            self.letter, self.exponent
        );
        let means = self.means();
        let first = means.first().copied().unwrap_or(0.0);
        for (number, error) in means.iter().enumerate() {
            // Only differences count; the first entry is 0.
            let _ = writeln!(text, "{number} {name}={:.4}", error - first);
        }
        text
    }
}

/// What compensates the errors of a machine.
#[derive(Clone, Debug)]
pub struct Compensated {
    /// As the machine is without compensation, with it, and what was chosen, by axis.
    pub axes: Vec<AxisResult>,
    /// The list of machine parameters with MP710, MP720 and MP730 (TNC 151/155: MP36 to MP39, MP40 to MP43).
    pub list: ParameterList,
    /// Names and texts of the tables (.COM), and the assignment (.CMA); none when no axis needs one.
    pub tables: BTreeMap<String, String>,
    /// Name and text of the assignment (.CMA).
    pub assignment: Option<String>,
}

/// What was measured and chosen for an axis.
#[derive(Clone, Debug)]
pub struct AxisResult {
    /// Errors of the machine without compensation.
    pub before: AxisErrors,
    /// Those that are left with it.
    pub after: AxisErrors,
    /// Entry of MP710 (MP36 to MP39), mm.
    pub backlash_mm: f64,
    /// Entry of MP720 (MP40 to MP43), mm/m; it acts where there is no table.
    pub linear_mm_m: f64,
    /// A table acts, in place of `linear_mm_m`.
    pub by_table: bool,
    /// A counting step of the encoder, mm.
    pub resolution_mm: f64,
    /// The least difference of two entries of backlash, mm.
    pub entry_mm: f64,
}

impl AxisResult {
    /// Whether the axis has errors that can be told from a counting step and an entry, and they do not get less.
    pub fn gets_no_better(&self) -> bool {
        let before = self.before.greatest_mm();
        before > self.resolution_mm.max(self.entry_mm) && self.after.greatest_mm() >= before
    }
}

/// Measures axes of a machine, all linear ones when none is named, after it has warmed up for some minutes; finds what
/// compensates their errors, and measures again with it. The machine is as before then.
///
/// # Errors
/// When there is no such axis, or a run is broken off.
pub fn compensate(
    machine: &mut LoadedMachine,
    letters: &[char],
    warm_up_min: f64,
) -> Result<Compensated, String> {
    let axes = linear_axes(&machine.parameters, letters)?;
    let kept = std::mem::take(&mut machine.files);
    let found = find(machine, &axes, warm_up_min);
    machine.files = kept;
    found
}

fn linear_axes(list: &ParameterList, letters: &[char]) -> Result<Vec<AxisParameters>, String> {
    let all: Vec<AxisParameters> = PerPlcAxis::from_fn(|index| list.axis_parameters(index))
        .into_iter()
        .filter(|axis| axis.controlled && !axis.plc_axis && axis.synchronization.master.is_none())
        .filter(|axis| axis.letter.is_some_and(|letter| !letter.is_rotary()))
        .collect();
    if letters.is_empty() {
        return Ok(all);
    }
    let find = |letter: &char| {
        let found = all
            .iter()
            .find(|axis| axis.letter.is_some_and(|own| own.letter() == *letter));
        found
            .copied()
            .ok_or_else(|| format!("the machine has no linear axis {letter}"))
    };
    letters.iter().map(find).collect()
}

fn find(
    machine: &mut LoadedMachine,
    axes: &[AxisParameters],
    warm_up_min: f64,
) -> Result<Compensated, String> {
    let mut list = machine.parameters.clone();
    for axis in axes {
        for what in [Adjustment::Backlash, Adjustment::Linear, Adjustment::Nonlinear] {
            list.adjust(what, axis.index, 0.0);
        }
    }
    let mut results = Vec::new();
    let mut tables = BTreeMap::new();
    let mut cells = String::new();
    for axis in axes {
        let before = measure(machine, &list, axis, warm_up_min)?;
        let mut result = choose(&mut list, axis, before);
        if result.by_table {
            let name = format!("{TABLE_NAME}{}", result.before.letter);
            let index = usize::from(axis.index);
            cells += &format!(" {}={name}", PLC_AXIS_NAMES.get(index).copied().unwrap_or("X"));
            tables.insert(name, result.before.table());
        }
        result.after = result.before.clone();
        results.push(result);
    }
    let assignment = (!tables.is_empty()).then(|| format!("0{cells}\nACTIVE 0\n"));
    take_tables(machine, &tables, assignment.as_deref())?;
    for (axis, result) in axes.iter().zip(&mut results) {
        result.after = measure(machine, &list, axis, warm_up_min)?;
    }
    Ok(Compensated {
        axes: results,
        list,
        tables,
        assignment,
    })
}

/// Chooses MP710, and MP720 or a table; enters them.
fn choose(list: &mut ParameterList, axis: &AxisParameters, before: AxisErrors) -> AxisResult {
    let resolution_mm = axis.encoder.signal_period_um * 1e-3 / bahn_servo::Encoder::STEPS as f64;
    let (slope, left) = before.linear();
    let entry = |list: &mut ParameterList, what, value| {
        list.adjust(what, axis.index, value)
            .map_or(0.0, |(_, entry)| entry)
    };
    let entry_mm = list
        .adjustment_step(Adjustment::Backlash, axis.index)
        .unwrap_or(ENTRY_MM);
    let backlash =
        Some(before.backlash_mm()).filter(|backlash| backlash.abs() >= entry_mm.max(resolution_mm));
    let backlash_mm = entry(list, Adjustment::Backlash, backlash.unwrap_or(0.0));
    let linear_mm_m = entry(list, Adjustment::Linear, slope);
    let tables = list.adjustment(Adjustment::Nonlinear, axis.index).is_some();
    let by_table = tables && left > ENTRY_MM.max(resolution_mm);
    entry(list, Adjustment::Nonlinear, f64::from(u8::from(by_table)));
    AxisResult {
        after: before.clone(),
        before,
        backlash_mm,
        linear_mm_m,
        by_table,
        resolution_mm,
        entry_mm,
    }
}

/// The control reads the tables as it will read the files.
fn take_tables(
    machine: &mut LoadedMachine,
    tables: &BTreeMap<String, String>,
    assignment: Option<&str>,
) -> Result<(), String> {
    let assignment = assignment.map(CompensationAssignment::read).transpose();
    machine.files.compensation = assignment.map_err(|error| error.to_string())?;
    for (name, text) in tables {
        let table = CompensationTable::read(text).map_err(|error| error.to_string())?;
        machine.files.compensation_tables.insert(name.clone(), table);
    }
    Ok(())
}

/// The spacing of an exponent, mm.
fn spacing(exponent: u32) -> f64 {
    f64::from(1u32 << exponent) * DIST_UNIT_MM
}

/// The points of an axis: exponent of their spacing, and positions.
fn points(axis: &AxisParameters) -> Result<(u32, Vec<f64>), String> {
    let [least, greatest] = axis.travel.ranges_mm[0];
    let span = greatest - least - 2.0 * MARGIN_MM;
    // It comes to the first and to the last point from as far as to any other one.
    let exponent = (10..=23).find(|exponent| span / spacing(*exponent) <= (POINTS_MAX + 1) as f64);
    let letter = axis.letter.map_or('X', |letter| letter.letter());
    match exponent.filter(|exponent| span.is_finite() && span > 4.0 * spacing(*exponent)) {
        Some(exponent) => {
            let count = (span / spacing(exponent)).floor() as usize - 1;
            let at = |number: usize| least + MARGIN_MM + (1 + number) as f64 * spacing(exponent);
            Ok((exponent, (0..count).map(at).collect()))
        }
        None => Err(format!(
            "the travel of {letter} cannot be measured: {least} to {greatest} mm"
        )),
    }
}

/// The list with which an axis comes gently to its points.
fn gentle(list: &ParameterList, axis: &AxisParameters) -> ParameterList {
    let mut gentle = list.clone();
    let kv = axis.lag.kv.min(KV_MAX);
    let lag_mm = axis.motion.rapid_mm_min * 1e-3 / kv;
    for (what, value) in [
        (Adjustment::ServoLag, 1.0),
        (Adjustment::KvLag, kv),
        (Adjustment::LagMonitor, 2.0 * lag_mm),
        (Adjustment::LagEmergency, 3.0 * lag_mm),
    ] {
        gentle.adjust(what, axis.index, value);
    }
    gentle
}

/// Goes through the points upwards and downwards, and to the first one again.
fn measure(
    machine: &LoadedMachine,
    list: &ParameterList,
    axis: &AxisParameters,
    warm_up_min: f64,
) -> Result<AxisErrors, String> {
    let (exponent, at_mm) = points(axis)?;
    let slot = axis.letter.ok_or_else(|| "an axis without letter".to_owned())?;
    let letter = slot.letter();
    let zero = Some(machine.datum()[slot])
        .filter(|zero| zero.is_finite())
        .unwrap_or(0.0);
    let (first, last) = (
        at_mm.first().copied().unwrap_or(0.0),
        at_mm.last().copied().unwrap_or(0.0),
    );
    let approach_mm = spacing(exponent);
    let up = std::iter::once(first - approach_mm).chain(at_mm.iter().copied());
    let down = std::iter::once(last + approach_mm).chain(at_mm.iter().rev().copied());
    let closing = [first - approach_mm, first];
    let way: Vec<f64> = up.chain(down).chain(closing).collect();
    let mut blocks = format!(
        "CYCL DEF 9.0 DWELL TIME\nCYCL DEF 9.1 DWELL {:.3}\n",
        (warm_up_min * 60.0).max(0.1)
    );
    for place in &way {
        blocks += &format!(
            "L {letter}{:+.4} R0 F{FEED_MM_MIN}\nCYCL DEF 9.0 DWELL TIME\nCYCL DEF 9.1 DWELL {REST_S}\n",
            place - zero
        );
    }
    let signal: Option<Signal> = format!("{letter}.actual").parse().ok();
    let mut readings = vec![(0u64, 0.0, 0.0); way.len()];
    trial::run(machine, &gentle(list, axis), &blocks, |control, plant| {
        let block = control
            .element()
            .map_or(0, |element| element.block.block as usize);
        // What is read last, at the end of its rest, stays.
        let reading = block.checked_sub(3).and_then(|block| readings.get_mut(block / 3));
        if let (Some(reading), Some(signal), Some(state)) = (reading, &signal, plant.axis(letter)) {
            *reading = (control.time_us(), control.observe(signal), state.position);
        }
    })?;
    let errors: Vec<(f64, f64)> = readings
        .iter()
        .map(|(time_us, actual, table)| (*time_us as f64 * 1e-6, table - actual))
        .collect();
    evaluate(letter, axis.index, exponent, at_mm, &errors)
}

/// Errors of the points from all readings in their order: approach, upwards, approach, downwards, approach, first again.
fn evaluate(
    letter: char,
    index: u8,
    exponent: u32,
    at_mm: Vec<f64>,
    readings: &[(f64, f64)],
) -> Result<AxisErrors, String> {
    let count = at_mm.len();
    let (Some(first), Some(again)) = (readings.get(1), readings.last()) else {
        return Err(format!("{letter} was not measured"));
    };
    let drift_mm = again.1 - first.1;
    let rate = drift_mm / (again.0 - first.0).max(1e-9);
    let error = |place: usize| {
        readings
            .get(place)
            .map_or(0.0, |(time, error)| error - rate * (time - first.0))
    };
    let mut errors_mm: Vec<[f64; 2]> = (0..count)
        .map(|number| [error(1 + number), error(1 + 2 * count - number)])
        .collect();
    let next = (0..count).min_by(|a, b| {
        let distance = |number: &usize| at_mm.get(*number).map_or(f64::INFINITY, |at| at.abs());
        distance(a).total_cmp(&distance(b))
    });
    let zero = next
        .and_then(|next| errors_mm.get(next))
        .map_or(0.0, |[up, down]| (up + down) / 2.0);
    for pair in &mut errors_mm {
        *pair = pair.map(|error| error - zero);
    }
    Ok(AxisErrors {
        letter,
        index,
        exponent,
        at_mm,
        errors_mm,
        drift_mm,
    })
}
