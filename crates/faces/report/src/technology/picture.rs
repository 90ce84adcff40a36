//! The picture of a run: velocity along the path with what is output and acknowledged there, and over time, with a bar
//! for each function from its output to its acknowledgement.

use std::collections::HashMap;

use bahn_picture::{Anchor, Colour, text_width};
use bahn_technology::{Event, EventKind, Report, Sample, Value};

use crate::scope::{Sheet, ticks};

const WIDTH: u32 = 1240;
const LEFT: f64 = 168.0;
const RIGHT: f64 = 30.0;
const TOP: f64 = 64.0;
/// Height of a velocity curve.
const CURVE: f64 = 210.0;
/// Below an axis: its numbers and its name.
const AXIS: f64 = 48.0;
/// Height of a row with the bar of a function.
const ROW: f64 = 20.0;
/// Height of a row with labels above the path.
const LABEL: f64 = 15.0;
const SMALL: f64 = 12.0;

/// Functions that have a bar, and labels above the path; more are counted.
const ROWS_MAX: usize = 40;
const LABELS_MAX: usize = 8;

const INK: Colour = [0x22; 3];
const PALE: Colour = [0x55; 3];
const GRID: Colour = [0xdd, 0xe3, 0xea];
const BORDER: Colour = [0x9a, 0xa7, 0xb4];
const CURVE_COLOUR: Colour = [0x0b, 0x53, 0x94];
const WAITING: Colour = [0xfb, 0xdd, 0xd8];
const WAIT: Colour = [0xc0, 0x20, 0x10];
const OUTPUT: Colour = [0x1a, 0x7a, 0x3c];
const ACKNOWLEDGED: Colour = [0x8a, 0x5a, 0x00];
const BAR: Colour = [0xbf, 0xd8, 0xc6];

/// A function from its output to its acknowledgement.
struct Bar {
    name: String,
    target: String,
    block: String,
    /// `None` for one that goes to a spindle of the NC alone.
    output_s: Option<f64>,
    fetch_s: Option<f64>,
    acknowledge_s: Option<f64>,
    waits: Vec<(f64, f64)>,
}

/// Speed along the path and over the time, and below them a bar for each function.
pub fn sheet(report: &Report, title: &str) -> Sheet {
    let bars = bars(report);
    let shown = bars.len().min(ROWS_MAX);
    let labels = labels(report, &bars);
    let lanes = labels
        .iter()
        .map(|label| label.lane + 1)
        .max()
        .unwrap_or_default();
    let way_top = TOP + LABEL * lanes as f64 + 8.0;
    let time_top = way_top + CURVE + AXIS + 26.0;
    let rows_top = time_top + CURVE + 8.0;
    let hidden = if bars.len() > shown { ROW } else { 0.0 };
    let height = rows_top + ROW * shown as f64 + hidden + AXIS + 4.0;
    let mut sheet = Sheet::new((WIDTH, height.ceil() as u32));
    head(&mut sheet, report, title);

    let greatest = report.samples.iter().map(|sample| sample.v).fold(0.0, f64::max);
    let along = Panel {
        top: way_top,
        bottom: way_top + CURVE,
        end: end_of(report, |sample| sample.distance_mm),
        greatest,
    };
    along.grid(&mut sheet, along.bottom, "way along the path, mm");
    for label in &labels {
        label.draw(&mut sheet, &along);
    }
    along.curve(&mut sheet, report, |sample| sample.distance_mm);

    let over_time = Panel {
        top: time_top,
        bottom: time_top + CURVE,
        end: end_of(report, |sample| sample.t).max(report.time_s),
        greatest,
    };
    let rows_end = rows_top + ROW * shown as f64;
    for (from, to) in spans(report) {
        let (from, to) = (over_time.x(from), over_time.x(to));
        sheet.area([from, over_time.top], [to.max(from + 1.0), rows_end], WAITING);
    }
    over_time.grid(&mut sheet, rows_end, "time, s");
    over_time.curve(&mut sheet, report, |sample| sample.t);
    for (row, bar) in bars.iter().take(shown).enumerate() {
        bar.draw(&mut sheet, &over_time, rows_top + ROW * (row as f64 + 0.5));
    }
    if bars.len() > shown {
        let text = format!("{} more functions", bars.len() - shown);
        let y = rows_end + AXIS + 0.3 * ROW;
        sheet.text([LEFT, y], Anchor::Left, SMALL, PALE, &text);
    }
    sheet
}

/// Title, how it ended, and what the colours mean.
fn head(sheet: &mut Sheet, report: &Report, title: &str) {
    sheet.text([LEFT, 22.0], Anchor::Left, 17.0, [0; 3], title);
    let how = match (&report.error, report.completed) {
        (Some(error), _) => format!("error: {error}"),
        (None, true) => format!("completed in {:.3} s", report.time_s),
        (None, false) => format!("not completed, {:.3} s", report.time_s),
    };
    sheet.text([LEFT, 43.0], Anchor::Left, 13.0, INK, &how);
    let right = f64::from(WIDTH) - RIGHT;
    let legend = [
        ("output", OUTPUT),
        ("acknowledged", ACKNOWLEDGED),
        ("the path stands for it", WAIT),
    ];
    let mut x = right;
    for (text, colour) in legend.iter().rev() {
        sheet.text([x, 22.0], Anchor::Right, SMALL, *colour, text);
        x -= text_width(text, SMALL) + 18.0;
        sheet.area([x, 17.0], [x + 12.0, 27.0], *colour);
        x -= 14.0;
    }
}

/// The greatest value of an axis.
fn end_of(report: &Report, value: impl Fn(&Sample) -> f64) -> f64 {
    let greatest = report.samples.iter().map(value).fold(0.0, f64::max);
    if greatest > 0.0 { greatest } else { 1.0 }
}

/// When the path stood for any function, with those that never ended to the end of the run.
fn spans(report: &Report) -> Vec<(f64, f64)> {
    let waits = report.waits.iter();
    waits
        .map(|wait| (wait.from_s, wait.to_s.unwrap_or(report.time_s)))
        .collect()
}

/// Each function that is output, with its own fetch, acknowledgement and waits.
fn bars(report: &Report) -> Vec<Bar> {
    let mut bars: Vec<Bar> = Vec::new();
    let mut of_order: HashMap<u64, usize> = HashMap::new();
    for event in &report.events {
        let (Some(function), Some(order)) = (&event.function, event.order) else {
            continue;
        };
        if event.kind == EventKind::Output {
            of_order.insert(order, bars.len());
            bars.push(Bar {
                name: name_of(event, function),
                target: text_of(&event.target).to_owned(),
                block: text_of(&event.block).to_owned(),
                output_s: Some(event.t),
                fetch_s: None,
                acknowledge_s: None,
                waits: Vec::new(),
            });
        } else if let Some(bar) = of_order.get(&order).and_then(|index| bars.get_mut(*index)) {
            match event.kind {
                EventKind::Fetch => bar.fetch_s = Some(event.t),
                EventKind::Acknowledge => bar.acknowledge_s = Some(event.t),
                _ => {}
            }
        }
    }
    for wait in &report.waits {
        let span = (wait.from_s, wait.to_s.unwrap_or(report.time_s));
        let index = *of_order.entry(wait.order).or_insert(bars.len());
        match bars.get_mut(index) {
            Some(bar) => bar.waits.push(span),
            None => bars.push(Bar {
                name: wait.function.clone(),
                target: String::new(),
                block: wait.block.clone(),
                output_s: None,
                fetch_s: None,
                acknowledge_s: None,
                waits: vec![span],
            }),
        }
    }
    bars.sort_by(|a, b| a.begin().total_cmp(&b.begin()));
    bars
}

fn text_of(text: &Option<String>) -> &str {
    text.as_deref().unwrap_or_default()
}

/// A function with its value: `H5=4711`.
fn name_of(event: &Event, function: &str) -> String {
    match &event.value {
        Value::Integer(value) => format!("{function}={value}"),
        Value::Number(value) => format!("{function}={value}"),
        Value::None | Value::Numbers(_) => function.to_owned(),
    }
}

impl Bar {
    /// When it is output, or the path begins to stand for it.
    fn begin(&self) -> f64 {
        let first_wait = self.waits.first().map(|(from, _)| *from);
        self.output_s.or(first_wait).unwrap_or_default()
    }

    fn draw(&self, sheet: &mut Sheet, panel: &Panel, y: f64) {
        let channel = if self.target == "channel" {
            ""
        } else {
            &self.target
        };
        let label = [&self.block, channel, &self.name];
        let label: Vec<&str> = label.into_iter().filter(|word| !word.is_empty()).collect();
        sheet.text([LEFT - 10.0, y], Anchor::Right, SMALL, INK, &label.join(" "));
        if let Some(from) = self.output_s.map(|time| panel.x(time)) {
            let end = self.acknowledge_s.or(self.fetch_s).unwrap_or(panel.end);
            let to = panel.x(end).max(from + 2.0);
            sheet.area([from, y - 6.0], [to, y + 6.0], BAR);
        }
        for (start, stop) in &self.waits {
            let (start, stop) = (panel.x(*start), panel.x(*stop));
            sheet.area([start, y - 2.0], [stop.max(start + 2.0), y + 2.0], WAIT);
        }
        for (time, colour) in [(self.output_s, OUTPUT), (self.acknowledge_s, ACKNOWLEDGED)] {
            if let Some(x) = time.map(|time| panel.x(time)) {
                sheet.area([x - 1.0, y - 8.0], [x + 1.0, y + 8.0], colour);
            }
        }
    }
}

/// A velocity curve with its axes.
struct Panel {
    top: f64,
    bottom: f64,
    /// Value at the right end.
    end: f64,
    /// Greatest velocity, mm/min.
    greatest: f64,
}

impl Panel {
    fn x(&self, value: f64) -> f64 {
        let width = f64::from(WIDTH) - LEFT - RIGHT;
        LEFT + width * (value / self.end).clamp(0.0, 1.0)
    }

    fn y(&self, velocity: f64) -> f64 {
        let full = if self.greatest > 0.0 {
            1.08 * self.greatest
        } else {
            1.0
        };
        self.bottom - (self.bottom - self.top) * velocity / full
    }

    /// Lines and numbers; those of the lower axis stand below `axis`.
    fn grid(&self, sheet: &mut Sheet, axis: f64, name: &str) {
        let right = f64::from(WIDTH) - RIGHT;
        for value in ticks(0.0, self.end, 12.0) {
            let x = self.x(value);
            sheet.line([x, self.top], [x, axis], 1.0, GRID);
            sheet.text([x, axis + 13.0], Anchor::Centre, SMALL, PALE, &number(value));
        }
        for value in ticks(0.0, self.greatest.max(1e-9), 5.0) {
            let y = self.y(value);
            sheet.line([LEFT, y], [right, y], 1.0, GRID);
            sheet.text([LEFT - 10.0, y], Anchor::Right, SMALL, PALE, &number(value));
        }
        sheet.frame([LEFT, self.top], [right, self.bottom], BORDER);
        let middle = 0.5 * (LEFT + right);
        sheet.text([middle, axis + 32.0], Anchor::Centre, 13.0, INK, name);
        sheet.text([20.0, self.top + 6.0], Anchor::Left, 13.0, INK, "velocity,");
        sheet.text([20.0, self.top + 23.0], Anchor::Left, 13.0, INK, "mm/min");
    }

    fn curve(&self, sheet: &mut Sheet, report: &Report, value: impl Fn(&Sample) -> f64) {
        let samples = standing(&report.samples, report.cycle_s);
        let places = samples
            .iter()
            .map(|sample| [self.x(value(sample)), self.y(sample.v)]);
        let points = thinned(places);
        if points.len() > 1 {
            sheet.lines(points, 1.6, CURVE_COLOUR);
        }
    }
}

/// The samples with one before each start: while the path stands there are none.
fn standing(samples: &[Sample], cycle_s: f64) -> Vec<Sample> {
    let mut all: Vec<Sample> = Vec::with_capacity(samples.len() + 1);
    all.extend(samples.first().map(|first| Sample {
        t: (first.t - cycle_s).max(0.0),
        distance_mm: 0.0,
        v: 0.0,
    }));
    for sample in samples {
        if let Some(last) = all.last().copied()
            && last.v < 1.0
            && sample.t - last.t > 1.5 * cycle_s
        {
            all.push(Sample {
                t: sample.t - cycle_s,
                ..last
            });
        }
        all.push(*sample);
    }
    all
}

/// A number without zeros after its point.
fn number(value: f64) -> String {
    // Adding 0 makes -0 a 0.
    format!("{}", (value * 1e6).round() / 1e6 + 0.0)
}

/// Points of which a column of pixels has no more than the first, the lowest, the highest and the last.
fn thinned(points: impl Iterator<Item = [f64; 2]>) -> Vec<[f64; 2]> {
    let mut kept: Vec<[f64; 2]> = Vec::new();
    let mut column: Vec<[f64; 2]> = Vec::new();
    let mut flush = |column: &mut Vec<[f64; 2]>| {
        let by_height = |a: &usize, b: &usize| column[*a][1].total_cmp(&column[*b][1]);
        let mut wanted = vec![0, column.len().saturating_sub(1)];
        wanted.extend((0..column.len()).min_by(by_height));
        wanted.extend((0..column.len()).max_by(by_height));
        wanted.sort_unstable();
        wanted.dedup();
        kept.extend(wanted.into_iter().filter_map(|at| column.get(at)));
        column.clear();
    };
    for point in points {
        if column
            .last()
            .is_some_and(|last| last[0].floor() != point[0].floor())
        {
            flush(&mut column);
        }
        column.push(point);
    }
    flush(&mut column);
    kept
}

/// What happens at a place of the path, with its words above the path.
struct Label {
    way: f64,
    text: String,
    colour: Colour,
    dashed: bool,
    lane: usize,
    /// Where the words begin.
    x: f64,
}

impl Label {
    fn draw(&self, sheet: &mut Sheet, panel: &Panel) {
        let x = panel.x(self.way);
        let y = panel.top - 8.0 - LABEL * self.lane as f64 - 0.5 * LABEL;
        if self.dashed {
            sheet.dashed([x, y], [x, panel.bottom], 1.0, self.colour);
        } else {
            sheet.line([x, y], [x, panel.bottom], 1.2, self.colour);
        }
        sheet.text([self.x, y], Anchor::Left, SMALL, self.colour, &self.text);
    }
}

/// Outputs, acknowledgements and waits along the path, in as few lanes as they need.
fn labels(report: &Report, bars: &[Bar]) -> Vec<Label> {
    let mut found: Vec<(f64, f64, String, Colour, bool)> = Vec::new();
    let mut add = |time: f64, text: String, colour: Colour, dashed: bool| {
        found.push((way_at(report, time), time, text, colour, dashed));
    };
    for bar in bars {
        if let Some(time) = bar.output_s {
            add(time, bar.name.clone(), OUTPUT, false);
        }
        let name = bar.name.split('=').next().unwrap_or_default();
        for (from, to) in &bar.waits {
            add(*from, format!("{:.2} s for {name}", to - from), WAIT, false);
        }
        // What the path stands for is acknowledged when it goes on.
        let ends_wait = |time: f64| bar.waits.iter().any(|(_, to)| (to - time).abs() < report.cycle_s);
        if let Some(time) = bar.acknowledge_s.filter(|time| !ends_wait(*time)) {
            add(time, format!("{name} done"), ACKNOWLEDGED, true);
        }
    }
    found.sort_by(|a, b| a.0.total_cmp(&b.0).then(a.1.total_cmp(&b.1)));
    let scale = Panel {
        top: 0.0,
        bottom: 0.0,
        end: end_of(report, |sample| sample.distance_mm),
        greatest: 0.0,
    };
    let mut ends: Vec<f64> = Vec::new();
    let mut labels = Vec::new();
    for (way, _, text, colour, dashed) in found {
        let width = text_width(&text, SMALL);
        let right = f64::from(WIDTH) - 6.0;
        let x = (scale.x(way) + 4.0).min(right - width);
        let free = ends.iter().position(|end| *end + 8.0 < x);
        let lane = match free {
            Some(lane) => lane,
            None if ends.len() < LABELS_MAX => {
                ends.push(0.0);
                ends.len() - 1
            }
            None => continue,
        };
        if let Some(end) = ends.get_mut(lane) {
            *end = x + width;
        }
        labels.push(Label {
            way,
            text,
            colour,
            dashed,
            lane,
            x,
        });
    }
    labels
}

/// How far the path was at a time.
fn way_at(report: &Report, time_s: f64) -> f64 {
    let samples = &report.samples;
    let next = samples.partition_point(|sample| sample.t < time_s);
    let before = next.checked_sub(1).and_then(|at| samples.get(at));
    match (before, samples.get(next)) {
        (Some(a), Some(b)) if b.t > a.t => {
            a.distance_mm + (b.distance_mm - a.distance_mm) * (time_s - a.t) / (b.t - a.t)
        }
        (Some(one), _) | (None, Some(one)) => one.distance_mm,
        (None, None) => 0.0,
    }
}

#[cfg(test)]
mod tests {
    use std::sync::Arc;

    use bahn_din::Program;
    use bahn_parameters::{ControlModel, ParameterList};
    use bahn_path::Position;
    use bahn_technology::{ChannelList, NcPrograms, Run, Script};
    use bahn_text::MemoryFiles;

    use super::*;

    /// A machine whose axes reach 10 m/min at 1 m/s².
    fn plain() -> ParameterList {
        let mut list = ParameterList::reference(ControlModel::default());
        for assignment in ["1010.0=10000", "1060.0=1", "1070=1"] {
            list.assign(assignment).unwrap();
        }
        list
    }

    /// The same function of the same block twice, the way back between: fetched only, then waited for.
    #[test]
    fn a_function_has_its_own_acknowledgement() {
        let list = ChannelList::from_bytes(b"m_synch[8] MVS_SVS\n");
        let text = b"N10 G01 X20 F6000\nN20 X40 M8\nN30 X60\nM30\n";
        let program = Program::from_bytes("back.nc", text);
        let script: Script = "M8 ack 0.2\nbackward 0.8..1.8\n".parse().unwrap();
        let mut start = Position::UNKNOWN;
        start[bahn_path::Axis::X] = 0.0;
        let report = Run {
            programs: &NcPrograms::new(&[Arc::new(program)], Arc::new(MemoryFiles::default())).unwrap(),
            settings: list.settings(),
            limits: &crate::test_run::limits(&plain(), 100.0),
            start,
            from: None,
            bounds: Default::default(),
            script: Some(&script),
        }
        .execute();
        let bars = bars(&report);
        // Forward, back, forward.
        assert_eq!(bars.len(), 3, "{:?}", report.waits);
        assert_eq!(
            bars.iter()
                .map(|bar| (bar.acknowledge_s.is_some(), bar.waits.len()))
                .collect::<Vec<_>>(),
            [(true, 1), (false, 0), (true, 1)]
        );
        for bar in &bars {
            let output = bar.output_s.unwrap();
            let fetch = bar.fetch_s.unwrap();
            assert!((fetch - output - report.cycle_s).abs() < 1e-9);
            if let Some(done) = bar.acknowledge_s {
                assert!(
                    (done - output - 0.2).abs() <= report.cycle_s + 1e-9,
                    "{output} {done}"
                );
            }
        }
    }

    #[test]
    fn a_column_keeps_its_ends_and_extremes() {
        let points = (0..1000).map(|at| {
            let x = f64::from(at) / 100.0;
            [x, if at == 555 { 50.0 } else { x }]
        });
        let kept = thinned(points);
        assert!(kept.len() <= 40, "{}", kept.len());
        assert!(kept.contains(&[5.55, 50.0]) && kept.contains(&[0.0, 0.0]) && kept.contains(&[9.99, 9.99]));
        assert_eq!(thinned(std::iter::empty()), Vec::<[f64; 2]>::new());
    }
}
