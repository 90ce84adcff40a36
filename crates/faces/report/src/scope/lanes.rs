//! The picture of an oscilloscope: lanes with their own scale and zero line, the logic signals below, blocks
//! and messages above, time at the bottom.

use std::collections::BTreeSet;

use bahn_picture::{Anchor, Colour, text_width};

use super::sheet::{Sheet, ticks};
use super::summary::short;
use super::table::{Event, Kind, Table, Trace};

/// Lanes at most, as the control's oscilloscope has channels.
pub const ANALOGUE: usize = 6;
/// Logic traces at most.
pub const LOGIC: usize = 16;

const LEFT: f64 = 150.0;
const RIGHT: f64 = 24.0;
const TOP: f64 = 74.0;
const BOTTOM: f64 = 52.0;
/// Where the numbers of blocks stand.
const BLOCKS: f64 = 62.0;
/// Height of a logic trace.
const ROW: f64 = 24.0;
/// Between two lanes, pixels.
const GAP: f64 = 10.0;

/// Dark colours on white, told apart also by those who do not see all of them.
const COLOURS: [Colour; ANALOGUE] = [
    [0x0b, 0x53, 0x94],
    [0xb0, 0x3a, 0x00],
    [0x1a, 0x7a, 0x3c],
    [0x8a, 0x1c, 0x7c],
    [0x7a, 0x5c, 0x00],
    [0x44, 0x44, 0x44],
];
const LOGIC_COLOUR: Colour = [0x1f, 0x3b, 0x57];
/// The recording that is compared with.
const OTHER: Colour = [0xe8, 0x9a, 0x1c];
const INK: Colour = [0x22; 3];
const PALE: Colour = [0x55; 3];
const GRID: Colour = [0xdd, 0xe3, 0xea];
const BORDER: Colour = [0x9a, 0xa7, 0xb4];
const ZERO: Colour = [0x5b, 0x6b, 0x7b];
const BLOCK: Colour = [0xb7, 0xc9, 0xb7];
const MESSAGE: Colour = [0xc0, 0x00, 0x00];

/// A recording as it is drawn, lane below lane.
pub struct Drawing<'a> {
    pub table: &'a Table,
    /// A recording that is compared with, at the same times.
    pub other: Option<&'a Table>,
    /// Names of analogue signals that share a lane; signals without a lane here have one of their own.
    pub shared: &'a [Vec<String>],
    pub title: &'a str,
    pub cursors: &'a [f64],
    pub size: (u32, u32),
}

/// A strip of the picture with the signals drawn in it.
struct Lane<'a> {
    top: f64,
    height: f64,
    traces: Vec<&'a Trace>,
}

impl Drawing<'_> {
    /// Draws all lanes, logic traces, events and cursors.
    pub fn sheet(&self) -> Sheet {
        let mut sheet = Sheet::new(self.size);
        let lanes = self.lanes();
        let logic = self.logic_traces();
        sheet.text([LEFT, 20.0], Anchor::Left, 17.0, [0; 3], self.title);
        self.head(&mut sheet);
        let empty = lanes.is_empty() && logic.is_empty();
        let end = if empty { TOP } else { sheet.height() - BOTTOM };
        self.time_axis(&mut sheet, end);
        self.blocks(&mut sheet, end);
        let mut drawn = 0;
        for lane in &lanes {
            self.lane(&mut sheet, lane, drawn);
            drawn += lane.traces.len();
        }
        let first = sheet.height() - BOTTOM - ROW * logic.len() as f64;
        for (index, trace) in logic.iter().enumerate() {
            self.logic(&mut sheet, first + index as f64 * ROW, trace);
        }
        self.messages(&mut sheet, end);
        self.cursors(&mut sheet, end);
        sheet
    }

    /// Signals that have a place.
    pub fn shown(&self) -> usize {
        let lanes = self.lanes();
        lanes.iter().map(|lane| lane.traces.len()).sum::<usize>() + self.logic_traces().len()
    }

    fn logic_traces(&self) -> Vec<&Trace> {
        let traces = self.table.traces.iter();
        traces
            .filter(|trace| trace.kind == Kind::Logic)
            .take(LOGIC)
            .collect()
    }

    fn lanes(&self) -> Vec<Lane<'_>> {
        let mut groups: Vec<Vec<&Trace>> = Vec::new();
        let mut placed: BTreeSet<&str> = BTreeSet::new();
        for trace in self
            .table
            .traces
            .iter()
            .filter(|trace| trace.kind == Kind::Analogue)
        {
            if !placed.insert(&trace.name) {
                continue;
            }
            let shared = self.shared.iter().find(|names| names.contains(&trace.name));
            let others = shared.into_iter().flatten().filter(|name| **name != trace.name);
            let mut group = vec![trace];
            for other in others.filter_map(|name| self.table.trace(name)) {
                if other.kind == Kind::Analogue && placed.insert(&other.name) {
                    group.push(other);
                }
            }
            groups.push(group);
        }
        groups.truncate(ANALOGUE);
        let logic = self.logic_traces().len();
        let logic_height = ROW * logic as f64 + if logic == 0 { 0.0 } else { GAP };
        let room = f64::from(self.size.1) - TOP - BOTTOM - logic_height;
        let count = groups.len().max(1) as f64;
        let height = ((room - GAP * (count - 1.0)) / count).max(20.0);
        let lanes = groups.into_iter().enumerate();
        lanes
            .map(|(index, traces)| Lane {
                top: TOP + index as f64 * (height + GAP),
                height,
                traces,
            })
            .collect()
    }

    /// Horizontal place of a time.
    fn x(&self, time: f64) -> f64 {
        let (from, to) = self.table.ends();
        let width = f64::from(self.size.0) - LEFT - RIGHT;
        LEFT + (time - from) / (to - from).max(1e-9) * width
    }

    /// What the cursors say, and what is not drawn.
    fn head(&self, sheet: &mut Sheet) {
        let mut notes = Vec::new();
        match self.cursors {
            [] => {}
            [one] => notes.push(format!("cursor {} s", short(*one))),
            [one, two, ..] => notes.push(format!(
                "cursors {} s and {} s, difference {} s",
                short(*one),
                short(*two),
                short(two - one)
            )),
        }
        let hidden = self.table.traces.len() - self.shown();
        if hidden > 0 {
            notes.push(format!("{hidden} more signals are not drawn"));
        }
        if self.other.is_some() {
            notes.push("orange: the recording compared with".to_owned());
        }
        let at = [sheet.width() - RIGHT, 20.0];
        sheet.text(at, Anchor::Right, 13.0, PALE, &notes.join("; "));
    }

    fn time_axis(&self, sheet: &mut Sheet, bottom: f64) {
        let (from, to) = self.table.ends();
        for time in ticks(from, to, 12.0) {
            let x = self.x(time);
            sheet.line([x, TOP], [x, bottom], 1.0, GRID);
            sheet.text([x, bottom + 15.0], Anchor::Centre, 13.0, INK, &short(time));
        }
        let middle = 0.5 * (LEFT + sheet.width() - RIGHT);
        sheet.text([middle, bottom + 36.0], Anchor::Centre, 13.0, INK, "time, s");
    }

    /// Where blocks begin; their numbers as far as there is room.
    fn blocks(&self, sheet: &mut Sheet, bottom: f64) {
        const SIZE: f64 = 11.0;
        let mut free = LEFT;
        let mut line_free = LEFT - 1.0;
        for (time, event) in &self.table.events {
            let Event::Block(number) = event else { continue };
            let x = self.x(*time);
            if x >= line_free {
                sheet.line([x, BLOCKS + 7.0], [x, bottom], 1.0, BLOCK);
                line_free = x + 3.0;
            }
            let text = number.to_string();
            let half = 0.5 * text_width(&text, SIZE);
            if x - half >= free {
                sheet.text([x, BLOCKS], Anchor::Centre, SIZE, PALE, &text);
                free = x + half + 6.0;
            }
        }
        if free > LEFT {
            sheet.text([LEFT - 6.0, BLOCKS], Anchor::Right, SIZE, PALE, "block");
        }
    }

    /// Messages with their text, one below the other where they are close.
    fn messages(&self, sheet: &mut Sheet, bottom: f64) {
        const SIZE: f64 = 12.0;
        const ROWS: usize = 8;
        let mut free = [f64::NEG_INFINITY; ROWS];
        for (time, event) in &self.table.events {
            let Event::Message(text) = event else { continue };
            let x = self.x(*time);
            sheet.line([x, TOP - 30.0], [x, bottom], 1.2, MESSAGE);
            let width = text_width(text, SIZE);
            // At the right end the text stands left of its line.
            let from = if x + 5.0 + width > sheet.width() {
                x - 5.0 - width
            } else {
                x + 5.0
            };
            if let Some((row, end)) = free.iter_mut().enumerate().find(|(_, end)| **end < from) {
                *end = from + width + 8.0;
                let y = if row == 0 {
                    44.0
                } else {
                    TOP + 14.0 * row as f64 - 6.0
                };
                sheet.text([from, y], Anchor::Left, SIZE, MESSAGE, text);
            }
        }
    }

    /// A lane; its colours go on from those of the `drawn` traces above it.
    fn lane(&self, sheet: &mut Sheet, lane: &Lane<'_>, drawn: usize) {
        let width = sheet.width() - LEFT - RIGHT;
        let compared = |name: &str| self.other.and_then(|other| Some((other, other.trace(name)?)));
        let values = lane.traces.iter().flat_map(|trace| {
            let other = compared(&trace.name)
                .into_iter()
                .flat_map(|(_, other)| &other.values);
            trace.values.iter().chain(other).copied()
        });
        let unit = lane.traces.first().map_or("", |trace| trace.unit.as_str());
        let (least, greatest) = range(values, unit);
        let y = |value: f64| lane.top + lane.height * (greatest - value) / (greatest - least);
        let bottom = lane.top + lane.height;
        sheet.frame([LEFT, lane.top], [LEFT + width, bottom], BORDER);
        for value in ticks(least, greatest, (lane.height / 22.0).clamp(2.0, 6.0)) {
            let at = y(value);
            let (colour, weight) = if value.abs() < 1e-12 {
                (ZERO, 1.2)
            } else {
                (GRID, 1.0)
            };
            sheet.line([LEFT, at], [LEFT + width, at], weight, colour);
            sheet.text([LEFT - 6.0, at], Anchor::Right, 12.0, INK, &short(value));
        }
        let count = lane.traces.len() as f64;
        let first = lane.top + 0.5 * lane.height - 9.0 * count;
        for (place, trace) in lane.traces.iter().enumerate() {
            let colour = COLOURS[(drawn + place) % COLOURS.len()];
            let at = first + 18.0 * place as f64;
            sheet.text([12.0, at], Anchor::Left, 15.0, colour, &trace.name);
            if let Some((other, values)) = compared(&trace.name) {
                sheet.lines(self.envelope(other, values, y), 1.4, OTHER);
            }
            sheet.lines(self.envelope(self.table, trace, y), 1.4, colour);
        }
        sheet.text([12.0, first + 18.0 * count], Anchor::Left, 13.0, PALE, unit);
    }

    /// The points of a trace; where many samples share a pixel, the least and the greatest of them.
    fn envelope(&self, table: &Table, trace: &Trace, y: impl Fn(f64) -> f64) -> Vec<[f64; 2]> {
        let mut points = Vec::new();
        let mut column: Option<(i64, Vec<[f64; 2]>)> = None;
        let (from, to) = self.table.ends();
        let samples = table.times.iter().zip(&trace.values);
        for (time, value) in samples.filter(|(time, _)| (from..=to).contains(*time)) {
            let x = self.x(*time);
            let pixel = x.floor() as i64;
            match &mut column {
                Some((own, samples)) if *own == pixel => samples.push([x, *value]),
                _ => {
                    if let Some((_, samples)) = column.replace((pixel, vec![[x, *value]])) {
                        push_column(&mut points, &samples, &y);
                    }
                }
            }
        }
        if let Some((_, samples)) = column {
            push_column(&mut points, &samples, &y);
        }
        points
    }

    fn logic(&self, sheet: &mut Sheet, top: f64, trace: &Trace) {
        let (high, low) = (top + 4.0, top + ROW - 5.0);
        let middle = 0.5 * (high + low);
        sheet.text([12.0, middle], Anchor::Left, 14.0, LOGIC_COLOUR, &trace.name);
        sheet.text([LEFT - 6.0, high], Anchor::Right, 9.0, PALE, "1");
        sheet.text([LEFT - 6.0, low], Anchor::Right, 9.0, PALE, "0");
        sheet.line([LEFT, low], [sheet.width() - RIGHT, low], 1.0, GRID);
        if let Some(other) = self.other
            && let Some(compared) = other.trace(&trace.name)
        {
            sheet.lines(self.steps(other, compared, high, low), 1.6, OTHER);
        }
        sheet.lines(self.steps(self.table, trace, high, low), 1.6, LOGIC_COLOUR);
        // What a scan of the PLC hides.
        for (time, event) in &self.table.events {
            if matches!(event, Event::Pulse(name) if *name == trace.name) {
                sheet.line([self.x(*time), high], [self.x(*time), low], 1.6, LOGIC_COLOUR);
            }
        }
    }

    fn steps(&self, table: &Table, trace: &Trace, high: f64, low: f64) -> Vec<[f64; 2]> {
        let mut points = Vec::new();
        let mut last = None;
        let (from, to) = self.table.ends();
        let samples = table.times.iter().zip(&trace.values);
        for (time, value) in samples.filter(|(time, _)| (from..=to).contains(*time)) {
            let y = if *value == 0.0 { low } else { high };
            if last != Some(y) {
                let x = self.x(*time);
                points.extend(last.map(|before| [x, before]));
                points.push([x, y]);
                last = Some(y);
            }
        }
        points.extend(last.map(|y| [self.x(table.ends().1.min(to)), y]));
        points
    }

    fn cursors(&self, sheet: &mut Sheet, bottom: f64) {
        let (from, to) = self.table.ends();
        for time in self.cursors.iter().filter(|time| (from..=to).contains(*time)) {
            let x = self.x(*time);
            sheet.dashed([x, TOP], [x, bottom], 1.0, MESSAGE);
        }
    }
}

fn push_column(points: &mut Vec<[f64; 2]>, samples: &[[f64; 2]], y: &impl Fn(f64) -> f64) {
    let value = |index: &usize| samples.get(*index).map_or(0.0, |[_, value]| *value);
    let compare = |a: &usize, b: &usize| value(a).total_cmp(&value(b));
    let indices = 0..samples.len();
    let least = indices.clone().min_by(compare).unwrap_or(0);
    let greatest = indices.max_by(compare).unwrap_or(0);
    let mut kept = vec![0, least, greatest, samples.len().saturating_sub(1)];
    kept.sort_unstable();
    kept.dedup();
    points.extend(kept.iter().filter_map(|index| {
        let [x, value] = samples.get(*index)?;
        Some([*x, y(*value)])
    }));
}

/// The range of a lane: all values with a little room; never without height. The ripple of a constant speed
/// does not fill a lane; positions are shown as finely as they are.
fn range(values: impl Iterator<Item = f64>, unit: &str) -> (f64, f64) {
    let (least, greatest) = values.fold((f64::INFINITY, f64::NEG_INFINITY), |(least, greatest), value| {
        (least.min(value), greatest.max(value))
    });
    if !least.is_finite() || !greatest.is_finite() {
        return (-1.0, 1.0);
    }
    // The zero line belongs to what is near it.
    let span = greatest - least;
    let near = |value: f64| value.abs() < 0.5 * span;
    let (least, greatest) = (
        if near(least) { least.min(0.0) } else { least },
        if near(greatest) {
            greatest.max(0.0)
        } else {
            greatest
        },
    );
    let is_speed = matches!(unit, "rpm" | "mm/min" | "deg/min");
    let least_span = if is_speed {
        0.01 * greatest.abs().max(least.abs())
    } else {
        1e-9
    };
    let room = match greatest - least {
        span if span > least_span => 0.06 * span,
        _ => (0.1 * greatest.abs()).max(1e-3),
    };
    (least - room, greatest + room)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_lane_has_room_and_its_zero_line() {
        let range = |values: &[f64], unit| range(values.iter().copied(), unit);
        let (least, greatest) = range(&[0.1, 1.0], "mm");
        assert!(least < 0.0 && greatest > 1.0);
        let (least, greatest) = range(&[500.0, 501.0], "mm");
        assert!(least > 499.0 && greatest < 502.0, "far from zero it is left out");
        let (least, greatest) = range(&[3.0, 3.0], "V");
        assert!(least < 3.0 && greatest > 3.0);
        let (least, greatest) = range(&[1800.02, 1800.04], "rpm");
        assert!(least < 1700.0 && greatest > 1900.0, "{least} {greatest}");
    }

    fn trace(name: &str, values: Vec<f64>) -> Trace {
        Trace {
            name: name.into(),
            unit: "mm".into(),
            kind: Kind::Analogue,
            values,
        }
    }

    fn drawing<'a>(table: &'a Table, shared: &'a [Vec<String>]) -> Drawing<'a> {
        Drawing {
            table,
            other: None,
            shared,
            title: "A",
            cursors: &[],
            size: (1200, 800),
        }
    }

    /// 10 000 samples on about a thousand pixels: a spike of one sample is still there.
    #[test]
    fn no_spike_is_lost() {
        let mut values = vec![0.0; 10_000];
        values[4321] = 7.0;
        let table = Table {
            times: (0..10_000).map(|n| f64::from(n) * 0.003).collect(),
            traces: vec![trace("X.lag", values)],
            ..Table::default()
        };
        let points = drawing(&table, &[]).envelope(&table, &table.traces[0], |value| 100.0 - value);
        assert_eq!(points.iter().filter(|[_, y]| *y == 93.0).count(), 1);
        assert!(points.len() < 3 * 1100);
    }

    /// X.nominal and X.actual share a lane, X.lag has its own: two lanes, three signals.
    #[test]
    fn signals_share_a_lane() {
        let table = Table {
            times: vec![0.0, 1.0],
            traces: ["X.nominal", "X.lag", "X.actual"]
                .map(|name| trace(name, vec![0.0, 1.0]))
                .to_vec(),
            ..Table::default()
        };
        let shared = [vec!["X.nominal".to_owned(), "X.actual".to_owned()]];
        let drawing = drawing(&table, &shared);
        let lanes = drawing.lanes();
        let names: Vec<Vec<&str>> = lanes
            .iter()
            .map(|lane| lane.traces.iter().map(|trace| trace.name.as_str()).collect())
            .collect();
        assert_eq!(names, [vec!["X.nominal", "X.actual"], vec!["X.lag"]]);
        assert_eq!(drawing.shown(), 3);
    }
}
