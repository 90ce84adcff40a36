//! The drawing of an oscilloscope: a lane for each analogue signal with its own scale and zero line, the
//! logic signals below, time at the bottom.

use std::fmt::Write;

use super::summary::short;
use super::table::{Kind, Table, Trace};

/// Lanes at most, as the control's oscilloscope has channels.
pub(super) const ANALOGUE: usize = 6;
/// Logic traces at most.
pub(super) const LOGIC: usize = 16;

const LEFT: f64 = 150.0;
const RIGHT: f64 = 24.0;
const TOP: f64 = 52.0;
const BOTTOM: f64 = 52.0;
/// Height of a logic trace.
const ROW: f64 = 24.0;
/// Between two lanes.
const GAP: f64 = 10.0;

/// Dark colours on white, told apart also by those who do not see all of them.
const COLOURS: [&str; ANALOGUE] = ["#0b5394", "#b03a00", "#1a7a3c", "#8a1c7c", "#7a5c00", "#444444"];
const LOGIC_COLOUR: &str = "#1f3b57";

/// What is drawn.
pub(super) struct Drawing<'a> {
    pub table: &'a Table,
    pub title: &'a str,
    pub cursors: &'a [f64],
    pub size: (u32, u32),
}

/// A rectangle of the drawing with the time that its width is.
struct Lane {
    top: f64,
    height: f64,
}

impl Drawing<'_> {
    /// The drawing as SVG.
    pub fn svg(&self) -> String {
        let (width, height) = (f64::from(self.size.0), f64::from(self.size.1));
        let of = |kind| self.table.traces.iter().filter(move |trace| trace.kind == kind);
        let analogue: Vec<&Trace> = of(Kind::Analogue).take(ANALOGUE).collect();
        let logic: Vec<&Trace> = of(Kind::Logic).take(LOGIC).collect();
        let mut svg = format!(
            "<svg xmlns=\"http://www.w3.org/2000/svg\" width=\"{width}\" height=\"{height}\" viewBox=\"0 0 {width} \
             {height}\" font-family=\"Ubuntu, Helvetica, Arial, sans-serif\" font-size=\"13\" fill=\"#222\">\n\
             <rect width=\"100%\" height=\"100%\" fill=\"white\"/>\n"
        );
        text(&mut svg, (LEFT, 26.0), "start", "#000", 17.0, self.title);
        self.head(&mut svg, width);
        let logic_height = ROW * logic.len() as f64 + if logic.is_empty() { 0.0 } else { GAP };
        let room = height - TOP - BOTTOM - logic_height;
        let count = analogue.len().max(1) as f64;
        let lane_height = ((room - GAP * (count - 1.0)) / count).max(20.0);
        let end = if logic.is_empty() && analogue.is_empty() {
            TOP
        } else {
            height - BOTTOM
        };
        self.time_axis(&mut svg, end);
        for (index, (trace, colour)) in analogue.iter().zip(COLOURS).enumerate() {
            let lane = Lane {
                top: TOP + index as f64 * (lane_height + GAP),
                height: lane_height,
            };
            self.lane(&mut svg, &lane, trace, colour);
        }
        let first = height - BOTTOM - ROW * logic.len() as f64;
        for (index, trace) in logic.iter().enumerate() {
            self.logic(&mut svg, first + index as f64 * ROW, trace);
        }
        self.cursors(&mut svg, end);
        svg + "</svg>\n"
    }

    /// Time of a horizontal place and back.
    fn x(&self, time: f64) -> f64 {
        let (from, to) = self.table.ends();
        let width = f64::from(self.size.0) - LEFT - RIGHT;
        LEFT + (time - from) / (to - from).max(1e-9) * width
    }

    /// The time per division and what the cursors say.
    fn head(&self, svg: &mut String, width: f64) {
        let mut note = match self.cursors {
            [] => String::new(),
            [one] => format!("cursor {} s", short(*one)),
            [one, two, ..] => {
                format!(
                    "cursors {} s and {} s, difference {} s",
                    short(*one),
                    short(*two),
                    short(two - one)
                )
            }
        };
        let hidden = self.table.traces.len() - self.shown();
        if hidden > 0 {
            let _ = write!(
                note,
                "{}{hidden} more signals are not drawn",
                if note.is_empty() { "" } else { "; " }
            );
        }
        text(svg, (width - RIGHT, 26.0), "end", "#555", 13.0, &note);
    }

    /// Signals that have a place.
    pub fn shown(&self) -> usize {
        let count = |kind| {
            self.table
                .traces
                .iter()
                .filter(|trace| trace.kind == kind)
                .count()
        };
        count(Kind::Analogue).min(ANALOGUE) + count(Kind::Logic).min(LOGIC)
    }

    fn time_axis(&self, svg: &mut String, bottom: f64) {
        let (from, to) = self.table.ends();
        for time in ticks(from, to, 12.0) {
            let x = self.x(time);
            line(svg, (x, TOP), (x, bottom), "#dde3ea", 1.0);
            text(svg, (x, bottom + 20.0), "middle", "#222", 13.0, &short(time));
        }
        let middle = 0.5 * (LEFT + f64::from(self.size.0) - RIGHT);
        text(svg, (middle, bottom + 40.0), "middle", "#222", 13.0, "time, s");
    }

    fn lane(&self, svg: &mut String, lane: &Lane, trace: &Trace, colour: &str) {
        let width = f64::from(self.size.0) - LEFT - RIGHT;
        let (least, greatest) = range(&trace.values, &trace.unit);
        let y = |value: f64| lane.top + lane.height * (greatest - value) / (greatest - least);
        let _ = writeln!(
            svg,
            "<rect x=\"{LEFT}\" y=\"{:.1}\" width=\"{width:.1}\" height=\"{:.1}\" fill=\"none\" stroke=\"#9aa7b4\"/>",
            lane.top, lane.height
        );
        for value in ticks(least, greatest, (lane.height / 22.0).clamp(2.0, 6.0)) {
            let at = y(value);
            let is_zero = value.abs() < 1e-12;
            let (stroke, weight) = if is_zero {
                ("#5b6b7b", 1.2)
            } else {
                ("#dde3ea", 1.0)
            };
            line(svg, (LEFT, at), (LEFT + width, at), stroke, weight);
            text(svg, (LEFT - 6.0, at + 4.5), "end", "#222", 12.0, &short(value));
        }
        let middle = lane.top + 0.5 * lane.height;
        text(svg, (12.0, middle - 3.0), "start", colour, 15.0, &trace.name);
        text(svg, (12.0, middle + 15.0), "start", "#555", 13.0, &trace.unit);
        let points = self.envelope(trace, y);
        let _ = writeln!(
            svg,
            "<polyline points=\"{}\" fill=\"none\" stroke=\"{colour}\" stroke-width=\"1.4\" stroke-linejoin=\"round\"/>",
            points.trim_end()
        );
    }

    /// The points of a trace; where many samples share a pixel, the least and the greatest of them.
    fn envelope(&self, trace: &Trace, y: impl Fn(f64) -> f64) -> String {
        let mut points = String::new();
        let mut column: Option<(i64, Vec<(f64, f64)>)> = None;
        let samples = self.table.times.iter().zip(&trace.values);
        for (time, value) in samples {
            let x = self.x(*time);
            let pixel = x.floor() as i64;
            match &mut column {
                Some((own, samples)) if *own == pixel => samples.push((x, *value)),
                _ => {
                    if let Some((_, samples)) = column.replace((pixel, vec![(x, *value)])) {
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

    fn logic(&self, svg: &mut String, top: f64, trace: &Trace) {
        let (high, low) = (top + 4.0, top + ROW - 5.0);
        text(svg, (12.0, low - 1.0), "start", LOGIC_COLOUR, 14.0, &trace.name);
        text(svg, (LEFT - 6.0, high + 5.0), "end", "#777", 9.0, "1");
        text(svg, (LEFT - 6.0, low + 3.0), "end", "#777", 9.0, "0");
        let width = f64::from(self.size.0) - RIGHT;
        line(svg, (LEFT, low), (width, low), "#dde3ea", 1.0);
        let mut points = String::new();
        let mut last = None;
        for (time, value) in self.table.times.iter().zip(&trace.values) {
            let y = if *value == 0.0 { low } else { high };
            if last != Some(y) {
                let x = self.x(*time);
                if let Some(before) = last {
                    let _ = write!(points, "{x:.1},{before:.1} ");
                }
                let _ = write!(points, "{x:.1},{y:.1} ");
                last = Some(y);
            }
        }
        if let Some(y) = last {
            let _ = write!(points, "{:.1},{y:.1}", self.x(self.table.ends().1));
        }
        let _ = writeln!(
            svg,
            "<polyline points=\"{points}\" fill=\"none\" stroke=\"{LOGIC_COLOUR}\" stroke-width=\"1.6\"/>"
        );
    }

    fn cursors(&self, svg: &mut String, bottom: f64) {
        let (from, to) = self.table.ends();
        for time in self.cursors.iter().filter(|time| (from..=to).contains(*time)) {
            let x = self.x(*time);
            let _ = writeln!(
                svg,
                "<line x1=\"{x:.1}\" y1=\"{TOP}\" x2=\"{x:.1}\" y2=\"{bottom}\" stroke=\"#c00000\" \
                 stroke-dasharray=\"6 4\"/>"
            );
        }
    }
}

fn push_column(points: &mut String, samples: &[(f64, f64)], y: &impl Fn(f64) -> f64) {
    let compare = |a: &usize, b: &usize| {
        let value = |index: &usize| samples.get(*index).map_or(0.0, |(_, value)| *value);
        value(a).total_cmp(&value(b))
    };
    let indices = 0..samples.len();
    let least = indices.clone().min_by(compare).unwrap_or(0);
    let greatest = indices.max_by(compare).unwrap_or(0);
    let mut kept = [0, least, greatest, samples.len().saturating_sub(1)];
    kept.sort_unstable();
    let mut before = None;
    for index in kept {
        if before == Some(index) {
            continue;
        }
        before = Some(index);
        if let Some((x, value)) = samples.get(index) {
            let _ = write!(points, "{x:.1},{:.1} ", y(*value));
        }
    }
}

/// The range of a lane: all values with a little room; never without height. The ripple of a constant speed
/// does not fill a lane; positions are shown as finely as they are.
fn range(values: &[f64], unit: &str) -> (f64, f64) {
    let least = values.iter().copied().fold(f64::INFINITY, f64::min);
    let greatest = values.iter().copied().fold(f64::NEG_INFINITY, f64::max);
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

/// Round values between two, `count` of them or fewer.
fn ticks(from: f64, to: f64, count: f64) -> Vec<f64> {
    let span = (to - from).max(1e-9);
    let rough = span / count.max(1.0);
    let power = 10f64.powf(rough.log10().floor());
    let step = [1.0, 2.0, 5.0, 10.0]
        .into_iter()
        .map(|factor| factor * power)
        .find(|step| *step >= rough)
        .unwrap_or(10.0 * power);
    let first = (from / step).ceil() as i64;
    let last = (to / step).floor() as i64;
    (first..=last.min(first + 100))
        .map(|number| number as f64 * step)
        .collect()
}

fn line(svg: &mut String, (x1, y1): (f64, f64), (x2, y2): (f64, f64), stroke: &str, width: f64) {
    let _ = writeln!(
        svg,
        "<line x1=\"{x1:.1}\" y1=\"{y1:.1}\" x2=\"{x2:.1}\" y2=\"{y2:.1}\" stroke=\"{stroke}\" stroke-width=\"{width}\"/>"
    );
}

fn text(svg: &mut String, (x, y): (f64, f64), anchor: &str, fill: &str, size: f64, text: &str) {
    let escaped: String = text
        .chars()
        .map(|character| match character {
            '<' => "&lt;".to_owned(),
            '>' => "&gt;".to_owned(),
            '&' => "&amp;".to_owned(),
            c if c.is_control() => " ".to_owned(),
            c => c.to_string(),
        })
        .collect();
    let _ = writeln!(
        svg,
        "<text x=\"{x:.1}\" y=\"{y:.1}\" text-anchor=\"{anchor}\" fill=\"{fill}\" font-size=\"{size}\">{escaped}</text>"
    );
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn ticks_are_round() {
        assert_eq!(ticks(0.0, 10.0, 5.0), [0.0, 2.0, 4.0, 6.0, 8.0, 10.0]);
        assert_eq!(ticks(-0.3, 0.3, 3.0), [-0.2, 0.0, 0.2]);
        assert!(ticks(5.0, 5.0, 4.0).len() < 3);
    }

    #[test]
    fn a_lane_has_room_and_its_zero_line() {
        let (least, greatest) = range(&[0.1, 1.0], "mm");
        assert!(least < 0.0 && greatest > 1.0);
        let (least, greatest) = range(&[500.0, 501.0], "mm");
        assert!(least > 499.0 && greatest < 502.0, "far from zero it is left out");
        let (least, greatest) = range(&[3.0, 3.0], "V");
        assert!(least < 3.0 && greatest > 3.0);
        let (least, greatest) = range(&[1800.02, 1800.04], "rpm");
        assert!(least < 1700.0 && greatest > 1900.0, "{least} {greatest}");
    }

    /// 10 000 samples on about a thousand pixels: a spike of one sample is still there.
    #[test]
    fn no_spike_is_lost() {
        let mut values = vec![0.0; 10_000];
        values[4321] = 7.0;
        let table = Table {
            times: (0..10_000).map(|n| f64::from(n) * 0.003).collect(),
            traces: vec![Trace {
                name: "X.lag".into(),
                unit: "mm".into(),
                kind: Kind::Analogue,
                values,
            }],
        };
        let drawing = Drawing {
            table: &table,
            title: "A & B",
            cursors: &[],
            size: (1200, 800),
        };
        let points = drawing.envelope(&table.traces[0], |value| 100.0 - value);
        assert_eq!(points.matches(",93.0 ").count(), 1);
        assert!(points.split_whitespace().count() < 3 * 1100);
        assert!(drawing.svg().contains("A &amp; B"));
    }
}
