//! What signals did, in numbers.

use std::collections::BTreeMap;

use serde::Serialize;

use super::circle::CircleTest;
use super::step::StepResponse;
use super::table::{Kind, Table, Trace};
use crate::record::tidy;

/// The summary as JSON has it.
#[derive(Clone, Debug, Serialize)]
pub struct Summary {
    from_s: f64,
    to_s: f64,
    samples: usize,
    signals: Vec<SignalSummary>,
    cursors: Vec<Cursor>,
    #[serde(skip_serializing_if = "Option::is_none")]
    difference_s: Option<f64>,
    #[serde(skip_serializing_if = "Option::is_none")]
    circle: Option<CircleTest>,
    #[serde(skip_serializing_if = "Option::is_none")]
    step: Option<StepResponse>,
    #[serde(skip_serializing_if = "Option::is_none")]
    against: Option<Vec<Difference>>,
}

/// The greatest difference of a signal from another recording, and when.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Difference {
    name: String,
    unit: String,
    difference: f64,
    at_s: f64,
}

#[derive(Clone, Debug, Serialize)]
struct SignalSummary {
    name: String,
    unit: String,
    kind: Kind,
    min: f64,
    max: f64,
    /// Over time: each sample holds until the next.
    mean: f64,
    first: f64,
    last: f64,
    #[serde(flatten)]
    logic: Option<Edges>,
}

#[derive(Clone, Debug, PartialEq, Serialize)]
struct Edges {
    rising: usize,
    falling: usize,
    /// Time at 1, s.
    on_s: f64,
}

/// Values at a time.
#[derive(Clone, Debug, Serialize)]
struct Cursor {
    time_s: f64,
    values: BTreeMap<String, f64>,
}

impl Summary {
    /// Of the signals of a recording, with their values at some times, s.
    pub fn new(table: &Table, cursors: &[f64]) -> Summary {
        let (from_s, to_s) = table.ends();
        let cursor = |time: &f64| {
            let index = table.at(*time);
            let values = table
                .traces
                .iter()
                .filter_map(|trace| Some((trace.name.clone(), *trace.values.get(index)?)));
            Cursor {
                time_s: *time,
                values: values.collect(),
            }
        };
        Summary {
            from_s,
            to_s,
            samples: table.times.len(),
            signals: table
                .traces
                .iter()
                .map(|trace| summary(&table.times, trace))
                .collect(),
            cursors: cursors.iter().map(cursor).collect(),
            difference_s: match cursors {
                [first, second] => Some(tidy(second - first)),
                _ => None,
            },
            circle: None,
            step: None,
            against: None,
        }
    }

    /// Adds what was measured besides.
    pub fn with(
        self,
        circle: Option<CircleTest>,
        step: Option<StepResponse>,
        against: Option<Vec<Difference>>,
    ) -> Summary {
        Summary {
            circle,
            step,
            against,
            ..self
        }
    }

    /// What the circle test says; `None` where none was asked for.
    pub fn circle(&self) -> Option<&CircleTest> {
        self.circle.as_ref()
    }

    /// The summary as lines for people.
    pub fn text(&self) -> String {
        let mut text = format!(
            "{:.3} to {:.3} s, {} samples\n\n{:<16}{:>14}{:>14}{:>14}  edges\n",
            self.from_s, self.to_s, self.samples, "signal", "min", "max", "mean"
        );
        for signal in &self.signals {
            let name = match signal.unit.as_str() {
                "" => signal.name.clone(),
                unit => format!("{} {unit}", signal.name),
            };
            let edges = signal.logic.as_ref().map_or(String::new(), |edges| {
                format!(
                    "  {} up, {} down, on {:.3} s",
                    edges.rising, edges.falling, edges.on_s
                )
            });
            text += &format!(
                "{name:<16}{:>14}{:>14}{:>14}{edges}\n",
                short(signal.min),
                short(signal.max),
                short(signal.mean)
            );
        }
        for cursor in &self.cursors {
            let values: Vec<String> = cursor
                .values
                .iter()
                .map(|(name, value)| format!("{name} = {}", short(*value)))
                .collect();
            text += &format!("\nat {:.4} s: {}", cursor.time_s, values.join(", "));
        }
        if let Some(difference) = self.difference_s {
            text += &format!("\nbetween them {difference:.4} s");
        }
        if !self.cursors.is_empty() {
            text.push('\n');
        }
        text + &self.measured()
    }

    /// Circle, step response and comparison in words.
    fn measured(&self) -> String {
        let mut text = String::new();
        if let Some(circle) = &self.circle {
            let [x, y] = circle.centre_mm.map(short);
            text += &format!(
                "\ncircle: radius {} mm around {x} / {y}, roundness {} mm\n  outside {} mm at {:.1}°, inside {} mm at \
                 {:.1}°, mean {} mm ({} samples)\n",
                short(circle.radius_mm),
                short(circle.roundness_mm),
                short(circle.outside_mm),
                circle.outside_deg,
                short(circle.inside_mm),
                circle.inside_deg,
                short(circle.mean_mm),
                circle.samples
            );
        }
        if let Some(step) = &self.step {
            let kv = step
                .kv
                .map_or("no lag".to_owned(), |kv| format!("kv {kv:.3} (m/min)/mm"));
            text += &format!(
                "\nstep response of {} at {:.3} s to {:.0} mm/min: {kv}, delay {:.1} ms\n  reaction {:.1} ms, rise from 10 \
                 to 90 % {:.1} ms, overshoot {:.1} %\n",
                step.axis,
                step.start_s,
                step.speed_mm_min,
                step.delay_ms,
                step.reaction_ms,
                step.rise_ms,
                step.overshoot_percent
            );
        }
        if let Some(differences) = &self.against {
            text += "\ngreatest differences from the recording compared with\n";
            for one in differences {
                let name = format!("{} {}", one.name, one.unit);
                text += &format!("{name:<16}{:>14}  at {:.3} s\n", short(one.difference), one.at_s);
            }
        }
        text
    }
}

/// The greatest difference of each signal that both recordings have, each sample against the one that holds in
/// the other at its time.
pub fn differences(table: &Table, other: &Table) -> Vec<Difference> {
    let (from, to) = other.ends();
    let pairs = table
        .traces
        .iter()
        .filter_map(|trace| Some((trace, other.trace(&trace.name)?)));
    pairs
        .map(|(trace, compared)| {
            let samples = table.times.iter().zip(&trace.values);
            let within = samples.filter(|(time, _)| (from..=to).contains(*time));
            let difference = |(time, value): (&f64, &f64)| {
                let there = compared.values.get(other.at(*time)).copied().unwrap_or(*value);
                (value - there, *time)
            };
            let greatest = within.map(difference).fold((0.0_f64, from), |greatest, one| {
                if one.0.abs() > greatest.0.abs() {
                    one
                } else {
                    greatest
                }
            });
            Difference {
                name: trace.name.clone(),
                unit: trace.unit.clone(),
                difference: tidy(greatest.0),
                at_s: greatest.1,
            }
        })
        .collect()
}

/// At most five decimals, without zeros at the end.
pub fn short(value: f64) -> String {
    let text = format!("{:.5}", value + 0.0);
    let text = text.trim_end_matches('0').trim_end_matches('.');
    if text == "-0" {
        "0".to_owned()
    } else {
        text.to_owned()
    }
}

fn summary(times: &[f64], trace: &Trace) -> SignalSummary {
    let values = &trace.values;
    let first = values.first().copied().unwrap_or(0.0);
    let last = values.last().copied().unwrap_or(0.0);
    let pairs = || times.windows(2).zip(values);
    let span = |pair: &[f64]| match pair {
        [from, to] => to - from,
        _ => 0.0,
    };
    let whole: f64 = pairs().map(|(pair, _)| span(pair)).sum();
    let area: f64 = pairs().map(|(pair, value)| span(pair) * value).sum();
    let edges = || {
        values.windows(2).filter_map(|pair| match pair {
            [before, after] if before != after => Some(after > before),
            _ => None,
        })
    };
    SignalSummary {
        name: trace.name.clone(),
        unit: trace.unit.clone(),
        kind: trace.kind,
        min: values.iter().copied().fold(first, f64::min),
        max: values.iter().copied().fold(first, f64::max),
        mean: tidy(if whole > 0.0 { area / whole } else { first }),
        first,
        last,
        logic: (trace.kind == Kind::Logic).then(|| Edges {
            rising: edges().filter(|up| *up).count(),
            falling: edges().filter(|up| !*up).count(),
            on_s: tidy(area),
        }),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// 0.5 for 1 s, 2 for 3 s: mean 6.5 / 4; the marker is on for 3 s.
    #[test]
    fn samples_hold_until_the_next() {
        let trace = |name: &str, kind, values: [f64; 3]| Trace {
            name: name.to_owned(),
            unit: String::new(),
            kind,
            values: values.to_vec(),
        };
        let table = Table {
            times: vec![1.0, 2.0, 5.0],
            traces: vec![
                trace("X.lag", Kind::Analogue, [0.5, 2.0, -1.0]),
                trace("M1", Kind::Logic, [0.0, 1.0, 0.0]),
            ],
            ..Table::default()
        };
        let summary = Summary::new(&table, &[2.5, 4.0]);
        let [lag, marker] = summary.signals.as_slice() else {
            panic!("two signals")
        };
        assert_eq!((lag.min, lag.max, lag.mean), (-1.0, 2.0, 1.625));
        assert_eq!(
            marker.logic,
            Some(Edges {
                rising: 1,
                falling: 1,
                on_s: 3.0
            })
        );
        assert_eq!(summary.cursors[0].values["X.lag"], 2.0);
        assert_eq!(summary.difference_s, Some(1.5));
    }

    #[test]
    fn numbers_are_short() {
        assert_eq!(short(-0.000001), "0");
        assert_eq!(short(1500.0), "1500");
        assert_eq!(short(0.21354), "0.21354");
    }
}
