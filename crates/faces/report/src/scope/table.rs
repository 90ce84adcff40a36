//! A recording: signals over time, and what happened.

use std::path::Path;

use bahn_exchange::Bit;
use bahn_host::files;

use crate::ReportError;

/// What a signal is drawn as.
#[derive(Clone, Copy, Debug, PartialEq, Eq, serde::Serialize)]
#[serde(rename_all = "lowercase")]
pub enum Kind {
    Analogue,
    /// 0 or 1: a marker, input, output, timer or counter.
    Logic,
}

/// A signal with its samples.
#[derive(Clone, Debug, PartialEq)]
pub struct Trace {
    pub name: String,
    pub unit: String,
    pub kind: Kind,
    pub values: Vec<f64>,
}

/// What the column `event` says.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum Event {
    /// The program was started.
    Start,
    /// A block of the main program began.
    Block(u32),
    /// A message came up.
    Message(String),
    /// An operand had a value within a scan of the PLC that was gone again at its end.
    Pulse(String),
}

/// A recording as a table: times, traces, events.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Table {
    /// Time of each sample, s, ascending.
    pub times: Vec<f64>,
    pub traces: Vec<Trace>,
    /// What happened, with its time, s.
    pub events: Vec<(f64, Event)>,
}

impl Table {
    /// Reads a recording from its file.
    pub fn load(path: &Path) -> Result<Table, ReportError> {
        let bytes = files::read_program(path)?
            .ok_or_else(|| ReportError::new(format!("{}: {}", path.display(), files::TOO_LARGE)))?;
        Table::read(&bahn_text::decode(&bytes))
            .map_err(|error| ReportError::new(format!("{}:{error}", path.display())))
    }

    /// An error begins with its line.
    pub fn read(text: &str) -> Result<Table, String> {
        let mut lines = bahn_text::without_mark(text).lines();
        let mut columns: Vec<&str> = lines
            .next()
            .unwrap_or_default()
            .split(',')
            .map(str::trim)
            .collect();
        if columns.first() != Some(&"time [s]") {
            return Err("1: no recording: its first line begins with `time [s]`".to_owned());
        }
        let has_events = columns.pop_if(|last| *last == "event").is_some();
        let mut table = Table {
            traces: columns.iter().skip(1).map(|head| Trace::named(head)).collect(),
            ..Table::default()
        };
        if table.traces.is_empty() {
            return Err("1: the recording has no signal".to_owned());
        }
        for (number, line) in (2..).zip(lines) {
            if !line.trim().is_empty() {
                table
                    .row(line, has_events)
                    .map_err(|error| format!("{number}: {error}"))?;
            }
        }
        if table.times.is_empty() {
            return Err("2: the recording has no row".to_owned());
        }
        Ok(table)
    }

    fn row(&mut self, line: &str, has_events: bool) -> Result<(), String> {
        let mut fields = line.splitn(self.traces.len() + 2, ',');
        let mut next = |name: &str| {
            let field = fields.next().ok_or_else(|| format!("{name} is missing"))?.trim();
            field
                .parse::<f64>()
                .ok()
                .filter(|value| value.is_finite())
                .ok_or_else(|| format!("{name}: `{field}` is no number"))
        };
        let time = next("time")?;
        if self.times.last().is_some_and(|last| time <= *last) {
            return Err(format!("the time {time} does not follow the one before"));
        }
        for trace in &mut self.traces {
            let value = next(&trace.name)?;
            trace.values.push(value);
        }
        self.times.push(time);
        match fields.next() {
            Some(field) if has_events => self.events(time, field),
            Some(_) => return Err("there are more values than signals".to_owned()),
            None => {}
        }
        Ok(())
    }

    /// `start; block 5; M100 pulse; message LIMIT SWITCH X+`, in quotes where it holds a comma.
    fn events(&mut self, time: f64, field: &str) {
        let field = field.trim();
        let field = match field.strip_prefix('"').and_then(|field| field.strip_suffix('"')) {
            Some(quoted) => quoted.replace("\"\"", "\""),
            None => field.to_owned(),
        };
        for event in field.split("; ").map(str::trim) {
            let event = match event.split_once(' ') {
                None if event == "start" => Event::Start,
                Some(("block", number)) => match number.parse() {
                    Ok(number) => Event::Block(number),
                    Err(_) => continue,
                },
                Some(("message", text)) => Event::Message(text.to_owned()),
                Some((operand, rest)) if rest == "pulse" || rest.starts_with("pulse x") => {
                    Event::Pulse(operand.to_owned())
                }
                _ => continue,
            };
            self.events.push((time, event));
        }
    }

    /// When the program was started, s.
    pub fn start(&self) -> Option<f64> {
        let start = self.events.iter().find(|(_, event)| *event == Event::Start);
        start.map(|(time, _)| *time)
    }

    /// The signal of a name; E17 and I17, A7 and O7 are the same.
    pub fn trace(&self, name: &str) -> Option<&Trace> {
        let found = self.traces.iter().find(|trace| trace.name == name);
        found.or_else(|| {
            let wanted: Bit = name.parse().ok()?;
            let mut traces = self.traces.iter();
            traces.find(|trace| trace.name.parse() == Ok(wanted))
        })
    }

    /// The signals of these names, in this order; all without names.
    pub fn choose<'a>(mut self, names: impl IntoIterator<Item = &'a str>) -> Result<Table, ReportError> {
        let mut chosen: Vec<Trace> = Vec::new();
        for name in names {
            let Some(trace) = self.trace(name) else {
                let known: Vec<&str> = self.traces.iter().map(|trace| trace.name.as_str()).collect();
                return Err(ReportError::NoSignal(name.to_owned(), known.join(", ")));
            };
            if chosen.iter().all(|known| known.name != trace.name) {
                chosen.push(trace.clone());
            }
        }
        if !chosen.is_empty() {
            self.traces = chosen;
        }
        Ok(self)
    }

    /// The samples between two times.
    pub fn between(mut self, from: Option<f64>, to: Option<f64>) -> Result<Table, ReportError> {
        let (from, to) = (from.unwrap_or(f64::NEG_INFINITY), to.unwrap_or(f64::INFINITY));
        let first = self.times.partition_point(|time| *time < from);
        let end = self.times.partition_point(|time| *time <= to);
        if first >= end {
            let (least, greatest) = self.ends();
            return Err(ReportError::OutOfTime(least, greatest));
        }
        cut(&mut self.times, first, end);
        for trace in &mut self.traces {
            cut(&mut trace.values, first, end);
        }
        self.events.retain(|(time, _)| (from..=to).contains(time));
        Ok(self)
    }

    /// Moves the recording in time, s.
    pub fn shift(&mut self, by: f64) {
        let times = self.times.iter_mut();
        for time in times.chain(self.events.iter_mut().map(|(time, _)| time)) {
            *time += by;
        }
    }

    /// First and last time, s.
    pub fn ends(&self) -> (f64, f64) {
        let first = self.times.first().copied().unwrap_or(0.0);
        (first, self.times.last().copied().unwrap_or(first))
    }

    /// The sample at a time: the last one that is not after it.
    pub fn at(&self, time: f64) -> usize {
        self.times.partition_point(|own| *own <= time).saturating_sub(1)
    }
}

fn cut(values: &mut Vec<f64>, first: usize, end: usize) {
    values.truncate(end);
    values.drain(..first);
}

impl Trace {
    /// From the head of a column: `X.lag [mm]`, `M2045`.
    fn named(head: &str) -> Trace {
        let head = head.trim();
        let (name, unit) = match head.split_once(" [") {
            Some((name, unit)) => (name, unit.trim_end_matches(']')),
            None => (head, ""),
        };
        // A channel may stand before it, as in `2:M2045`.
        let operand = name.split_once(':').map_or(name, |(_, operand)| operand);
        let digits = operand
            .strip_prefix(['M', 'I', 'O', 'T', 'C', 'E', 'A', 'Z'])
            .unwrap_or_default();
        // The pins of "control is ready".
        let is_pin = matches!(operand, "X41/34" | "X42/4");
        let is_bit =
            is_pin || unit.is_empty() && !digits.is_empty() && digits.chars().all(|c| c.is_ascii_digit());
        Trace {
            name: name.to_owned(),
            unit: unit.to_owned(),
            kind: if is_bit { Kind::Logic } else { Kind::Analogue },
            values: Vec::new(),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const TEXT: &str = "time [s],X.lag [mm],M2045\n0.003,0.5,0\n0.006,-1,1\n0.009,2.5,0\n";

    #[test]
    fn columns_are_signals() {
        let table = Table::read(TEXT).unwrap();
        assert_eq!(table.times, [0.003, 0.006, 0.009]);
        let kinds: Vec<_> = table
            .traces
            .iter()
            .map(|trace| (trace.name.as_str(), trace.unit.as_str(), trace.kind))
            .collect();
        assert_eq!(
            kinds,
            [("X.lag", "mm", Kind::Analogue), ("M2045", "", Kind::Logic)]
        );
        let part = table.between(Some(0.004), Some(0.006)).unwrap();
        assert_eq!((part.times.len(), part.traces[0].values[0]), (1, -1.0));
    }

    #[test]
    fn the_last_column_says_what_happened() {
        let text = "time [s],X.lag [mm],event\n1,0,\n2,0,start; block 1; M900 pulse x2\n3,0,\"message A, \"\"B\"\"\"\n4,0\n";
        let table = Table::read(text).unwrap();
        assert_eq!(
            table.events,
            [
                (2.0, Event::Start),
                (2.0, Event::Block(1)),
                (2.0, Event::Pulse("M900".into())),
                (3.0, Event::Message("A, \"B\"".into()))
            ]
        );
        assert_eq!(table.start(), Some(2.0));
        assert_eq!(table.traces.len(), 1, "it is no signal");
    }

    #[test]
    fn faults_have_their_line() {
        let fault = |text: &str| Table::read(text).unwrap_err();
        assert!(fault("").starts_with("1: no recording"));
        assert!(fault("time [s]\n").starts_with("1: the recording has no signal"));
        assert!(fault("time [s],event\n").starts_with("1: the recording has no signal"));
        assert_eq!(fault("time [s],M1\n1,0\n2,x\n"), "3: M1: `x` is no number");
        assert_eq!(
            fault("time [s],M1\n1,0\n1,0\n"),
            "3: the time 1 does not follow the one before"
        );
        assert_eq!(
            fault("time [s],M1\n1,0,3\n"),
            "2: there are more values than signals"
        );
        assert_eq!(fault("time [s],M1\n1\n"), "2: M1 is missing");
        assert_eq!(fault("time [s],M1\n"), "2: the recording has no row");
    }
}
