//! The logic diagram: operands scan by scan, around an event [000:11439-11472].

use std::collections::VecDeque;

use bahn_exchange::{Content, Operand};

/// Operands that a diagram has at most [000:11461].
pub const OPERANDS_MAX: usize = 16;

/// Operands over scans of the PLC.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct Diagram {
    /// The operands that were recorded, one a row.
    pub operands: Vec<Operand>,
    /// Number of the first recorded scan.
    pub first: u64,
    /// The scan that triggered.
    pub trigger: Option<u64>,
    /// The operands after each scan.
    pub samples: VecDeque<Vec<Content>>,
}

impl Diagram {
    /// Stretches of scans over which an operand keeps its content: first sample, number of samples.
    pub fn stretches(&self, operand: usize) -> Vec<(usize, usize, &Content)> {
        let mut stretches: Vec<(usize, usize, &Content)> = Vec::new();
        for (at, sample) in self.samples.iter().enumerate() {
            let Some(content) = sample.get(operand) else {
                continue;
            };
            match stretches.last_mut() {
                Some((_, count, last)) if *last == content => *count += 1,
                _ => stretches.push((at, 1, content)),
            }
        }
        stretches
    }

    /// The contents of an operand from a sample up to another one.
    pub fn row(&self, operand: usize, start: usize, end: usize) -> impl Iterator<Item = &Content> {
        let samples = self.samples.iter().skip(start).take(end.saturating_sub(start));
        samples.filter_map(move |sample| sample.get(operand))
    }

    /// A row of bits in characters: a high line for 1, a low one for 0.
    pub fn levels(&self, operand: usize, start: usize, end: usize) -> String {
        let level = |content: &Content| match content {
            Content::Number(0) => '_',
            _ => '\u{2580}',
        };
        self.row(operand, start, end).map(level).collect()
    }
}

/// What makes a recorder keep what it has.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum Trigger {
    /// Its first scan: recording begins at once.
    Start,
    /// Nothing: it goes on, and keeps the latest scans.
    Never,
    /// Any of these operands gets its value: an edge [000:11461].
    Edge(Vec<(Operand, Content)>),
}

/// Records a diagram, scan by scan.
#[derive(Clone, Debug)]
pub struct DiagramRecorder {
    diagram: Diagram,
    trigger: Trigger,
    /// Whether each edge had its value before.
    was_met: Vec<bool>,
    before: usize,
    total: usize,
    fills: bool,
    /// Samples after the trigger, that of the event with them.
    after: usize,
    scans: u64,
}

impl DiagramRecorder {
    /// Records operands over `total` scans, `before` of them before the trigger at most. `now` are the operands before the
    /// first one: an edge needs to know where it comes from.
    pub fn new(
        operands: Vec<Operand>,
        trigger: Trigger,
        (before, total): (usize, usize),
        now: impl Fn(Operand) -> Content,
    ) -> DiagramRecorder {
        let was_met = match &trigger {
            Trigger::Edge(edges) => edges
                .iter()
                .map(|(operand, value)| now(*operand) == *value)
                .collect(),
            _ => Vec::new(),
        };
        DiagramRecorder {
            diagram: Diagram {
                operands,
                ..Diagram::default()
            },
            trigger,
            was_met,
            before: before.min(total.saturating_sub(1)),
            total,
            fills: false,
            after: 0,
            scans: 0,
        }
    }

    /// When the trigger comes early, more scans after it make up for those that are not there before it.
    pub fn filled(mut self) -> DiagramRecorder {
        self.fills = true;
        self
    }

    /// A scan is over.
    pub fn scan(&mut self, read: impl Fn(Operand) -> Content) {
        if self.is_over() {
            return;
        }
        self.scans += 1;
        let sample = self.diagram.operands.iter().map(|operand| read(*operand));
        self.diagram.samples.push_back(sample.collect());
        if self.after > 0 {
            self.after += 1;
        } else if self.triggers(read) {
            self.after = 1;
            self.diagram.trigger = Some(self.scans).filter(|_| self.trigger != Trigger::Start);
        }
        let kept = match (&self.trigger, self.after) {
            (Trigger::Edge(_), 0) => self.before,
            _ => self.total,
        };
        while self.diagram.samples.len() > kept {
            self.diagram.samples.pop_front();
        }
        self.diagram.first = self.scans + 1 - self.diagram.samples.len() as u64;
    }

    fn triggers(&mut self, read: impl Fn(Operand) -> Content) -> bool {
        match &self.trigger {
            Trigger::Start => true,
            Trigger::Never => false,
            Trigger::Edge(edges) => {
                let mut edge = false;
                for ((operand, value), was) in edges.iter().zip(&mut self.was_met) {
                    let is = read(*operand) == *value;
                    edge |= is && !std::mem::replace(was, is);
                    *was = is;
                }
                edge
            }
        }
    }

    /// What was waited for has come.
    pub fn is_triggered(&self) -> bool {
        self.after > 0
    }

    /// All is recorded that follows the trigger.
    pub fn is_over(&self) -> bool {
        match self.fills || self.trigger == Trigger::Start {
            true => self.is_triggered() && self.diagram.samples.len() >= self.total,
            false => self.after >= self.total - self.before,
        }
    }

    /// What is recorded so far.
    pub fn diagram(&self) -> &Diagram {
        &self.diagram
    }

    /// The recorder ends and gives what it has recorded.
    pub fn into_diagram(self) -> Diagram {
        self.diagram
    }
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used, reason = "a test may fail")]
    use super::*;

    /// A square wave of 8 scans, high in the scans 5 to 8, 13 to 16, ...
    fn wave(scan: u64) -> Content {
        Content::Number(i32::from((scan - 1) % 8 >= 4))
    }

    fn recorded(trigger: &Trigger, size: (usize, usize), scans: u64, fills: bool) -> DiagramRecorder {
        let operand: Operand = "M1".parse().unwrap();
        let mut recorder = DiagramRecorder::new(vec![operand], trigger.clone(), size, |_| Content::Number(0));
        if fills {
            recorder = recorder.filled();
        }
        for scan in 1..=scans {
            recorder.scan(|_| wave(scan));
        }
        recorder
    }

    #[test]
    fn the_event_has_scans_before_and_after_it() {
        let up = Trigger::Edge(vec![("M1".parse().unwrap(), Content::Number(1))]);
        // The edge comes in scan 5; two scans before it and six from it on are kept.
        let recorder = recorded(&up, (2, 8), 100, false);
        assert!(recorder.is_over());
        let diagram = recorder.into_diagram();
        assert_eq!((diagram.first, diagram.trigger), (3, Some(5)));
        assert_eq!(diagram.levels(0, 0, 100), "__\u{2580}\u{2580}\u{2580}\u{2580}__");
        assert_eq!(diagram.stretches(0).len(), 3);
        // Only four are there before it: the other four come after it where that is wanted.
        assert_eq!(recorded(&up, (8, 16), 100, false).diagram().samples.len(), 12);
        assert_eq!(recorded(&up, (8, 16), 100, true).diagram().samples.len(), 16);
        let down = Trigger::Edge(vec![("M1".parse().unwrap(), Content::Number(0))]);
        let diagram = recorded(&down, (2, 8), 100, false).into_diagram();
        assert_eq!(
            (diagram.first, diagram.trigger),
            (7, Some(9)),
            "low is no edge at the start"
        );
    }

    #[test]
    fn without_event_the_first_or_the_latest_scans_are_kept() {
        let first = recorded(&Trigger::Start, (0, 8), 100, false);
        assert!(first.is_over());
        assert_eq!((first.diagram().first, first.diagram().trigger), (1, None));
        let latest = recorded(&Trigger::Never, (4, 8), 100, false);
        assert!(!latest.is_over());
        assert_eq!((latest.diagram().first, latest.diagram().samples.len()), (93, 8));
    }
}
