//! Incremental encoders and their reference marks.

use bahn_servo::Encoder;
use bahn_servo::rounding::floor_to_i64;

use crate::noise::Noise;
use crate::reader::Section;

/// Most reference marks of one encoder.
const MARKS_MAX: usize = 100_000;

/// How an encoder can fail [000:3288-3328].
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum EncoderFault {
    /// The signal amplitude falls: monitoring A sees it, nothing is counted.
    Amplitude,
    /// The edges follow too closely: monitoring B sees it, nothing is counted.
    Edges,
    /// Nothing is counted and no monitoring sees it: a broken coupling.
    Stuck,
    /// Every second reference mark is seen at a wrong place: a dirty scale; monitoring C
    /// of distance-coded marks has to find it.
    Marks,
    /// No reference mark is seen: its signal is lost.
    NoMarks,
    /// Every reference mark is seen twice: there is another one after it, on a scale that is scratched.
    Twice,
}

impl EncoderFault {
    /// Only the marks are concerned: it counts as ever.
    fn counts(self) -> bool {
        matches!(
            self,
            EncoderFault::Marks | EncoderFault::NoMarks | EncoderFault::Twice
        )
    }
}

/// So many signal periods after a mark that is seen twice it is seen again.
const AGAIN_PERIODS: i64 = 20;

/// A scale or rotary encoder, read at a position in mm or degrees.
#[derive(Clone, Debug)]
pub(crate) struct Counter {
    pub input: usize,
    steps_per_unit: f64,
    /// Where the count is 0: the position at power-on, moved by counts that were lost.
    zero: f64,
    /// Positions of the reference marks, ascending.
    marks: Vec<f64>,
    /// A mark each so many units, if there is no list: an encoder without end.
    every: Option<f64>,
    /// The marks that enclose the position.
    above: f64,
    below: f64,
    latched: Option<i64>,
    noise: Noise,
    /// The noise of the last reading.
    blur: f64,
    noise_amplitude: f64,
    /// Fastest permitted movement, units per second.
    speed_max: f64,
    fault: Option<EncoderFault>,
    /// What is read while the encoder fails.
    frozen: i64,
}

/// Counting steps to a signal period.
///
/// Decision: A System 900 counts the edges of its encoders, four to a period: P12012 are counts after quadrupling. What a TNC
/// interpolates within a period it does not see
fn steps_per_period(counts_edges: bool) -> f64 {
    if counts_edges { 4.0 } else { Encoder::STEPS as f64 }
}

impl Counter {
    /// Reads the `encoder` table of an axis; `travel` are the ends, `start` the position at power-on.
    pub fn read(section: &Section, travel: [f64; 2], start: f64, noise: Noise) -> Option<Counter> {
        let input = section.encoder_input("input");
        if !section.has("input") {
            section.fault(format!("[{}] needs input", section.name));
        }
        let period = section.needed_number("period_um", 0.1..=100_000.0) / 1000.0;
        let sense = if section.flag("reversed").unwrap_or(false) {
            -1.0
        } else {
            1.0
        };
        let mut counter = Counter {
            input: input.unwrap_or(0),
            steps_per_unit: sense * steps_per_period(section.reader.numbered) / period,
            zero: start,
            marks: Vec::new(),
            every: None,
            above: f64::INFINITY,
            below: f64::NEG_INFINITY,
            latched: None,
            noise,
            blur: 0.0,
            noise_amplitude: section.number("noise_um", 0.0..=1000.0).unwrap_or(0.0) / 1000.0,
            speed_max: section
                .number("frequency_max_khz", 0.001..=10_000.0)
                .map_or(f64::INFINITY, |kilohertz| kilohertz * 1000.0 * period),
            fault: None,
            frozen: 0,
        };
        counter.read_marks(section, travel, period);
        counter.enclose(start);
        Some(counter)
    }

    /// An encoder with one mark per revolution, in revolutions: the spindle.
    pub fn rotary(input: usize, lines: f64, reversed: bool, mark_turns: f64, noise: Noise) -> Counter {
        let sense = if reversed { -1.0 } else { 1.0 };
        let mut counter = Counter {
            input,
            steps_per_unit: sense * lines * Encoder::STEPS as f64,
            zero: 0.0,
            marks: vec![mark_turns],
            every: Some(1.0),
            above: 0.0,
            below: 0.0,
            latched: None,
            noise,
            blur: 0.0,
            noise_amplitude: 0.0,
            speed_max: f64::INFINITY,
            fault: None,
            frozen: 0,
        };
        counter.enclose(0.0);
        counter
    }

    /// One of three kinds of marks: `mark` (one), `marks_every` (one per turn of a ballscrew) and
    /// `marks_coded` (distance-coded).
    fn read_marks(&mut self, section: &Section, travel: [f64; 2], period: f64) {
        let mark = section.number("mark", -1e6..=1e6);
        let every = section.number("marks_every", 0.01..=1e6);
        let coded = section.number("marks_coded", 0.01..=1e6);
        let first = section.number("marks_from", -1e6..=1e6);
        let kinds = [mark, every, coded].iter().flatten().count();
        if kinds > 1 {
            section.fault(format!(
                "[{}] has one of mark, marks_every and marks_coded",
                section.name
            ));
        }
        if first.is_some() && every.is_none() && coded.is_none() {
            section.fault_at(
                "marks_from",
                "marks_from goes with marks_every or marks_coded".to_owned(),
            );
        }
        self.marks.extend(mark);
        let first = first.unwrap_or(if travel[0].is_finite() { travel[0] } else { 0.0 });
        if let Some(spacing) = every {
            self.marks.push(first);
            self.every = Some(spacing);
        }
        if let Some(spacing) = coded {
            let last = if travel[1].is_finite() {
                travel[1]
            } else {
                first + 360.0
            };
            self.marks = coded_marks(first, last, spacing, period);
            if self.marks.len() < 2 {
                section.fault_at("marks_coded", "two marks must lie within the travel".to_owned());
            }
        }
    }

    /// Counts from a position.
    pub fn begin(&mut self, position: f64) {
        self.zero = position;
        self.enclose(position);
    }

    /// Finds the marks on both sides of a position; a mark at the position itself is below.
    fn enclose(&mut self, position: f64) {
        [self.below, self.above] = self.enclosing(position);
        if self.fault == Some(EncoderFault::Twice) {
            let offset = self.again();
            let [below, above] = self.enclosing(position - offset);
            self.below = self.below.max(below + offset);
            self.above = self.above.min(above + offset);
        }
    }

    /// So far after a mark it is seen again.
    fn again(&self) -> f64 {
        (AGAIN_PERIODS * Encoder::STEPS) as f64 / self.steps_per_unit.abs()
    }

    fn enclosing(&self, position: f64) -> [f64; 2] {
        if let (Some(spacing), Some(first)) = (self.every, self.marks.first()) {
            let turn = ((position - first) / spacing).floor();
            return [first + turn * spacing, first + (turn + 1.0) * spacing];
        }
        let next = self.marks.partition_point(|mark| *mark <= position);
        let above = self.marks.get(next).copied().unwrap_or(f64::INFINITY);
        let below = next
            .checked_sub(1)
            .and_then(|last| self.marks.get(last))
            .copied()
            .unwrap_or(f64::NEG_INFINITY);
        [below, above]
    }

    /// Notices the marks passed on the way to a position. The mark has its own place: the latched count
    /// does not depend on where the steps of the simulation end.
    #[inline]
    pub fn move_to(&mut self, position: f64) {
        if position >= self.above {
            self.pass(self.above, position);
        } else if position < self.below {
            self.pass(self.below, position);
        }
    }

    #[cold]
    fn pass(&mut self, mark: f64, position: f64) {
        self.enclose(position);
        match self.fault {
            None | Some(EncoderFault::Twice) => self.latched = Some(self.steps(mark)),
            Some(EncoderFault::Marks) => {
                let moved = if self.is_even(mark) { 3 * Encoder::STEPS } else { 0 };
                self.latched = Some(self.steps(mark) + moved);
            }
            Some(_) => {}
        }
    }

    /// Whether a mark is the first, third ... of the scale.
    fn is_even(&self, mark: f64) -> bool {
        match (self.every, self.marks.first()) {
            (Some(spacing), Some(first)) => ((mark - first) / spacing).round() % 2.0 == 0.0,
            _ => self
                .marks
                .partition_point(|other| *other < mark)
                .is_multiple_of(2),
        }
    }

    fn steps(&self, position: f64) -> i64 {
        floor_to_i64((position - self.zero) * self.steps_per_unit)
    }

    /// What the control reads at a position and speed (units per second) after time has passed, or `again`: then the
    /// marks of the step before are still there.
    #[inline]
    pub fn read_at(&mut self, position: f64, speed: f64, again: bool, read: &mut Encoder) {
        if !again {
            if self.noise_amplitude > 0.0 {
                self.blur = self.noise.next() * self.noise_amplitude;
            }
            read.mark = self.latched.take();
        }
        let failing = self.fault.filter(|fault| !fault.counts());
        read.count = match failing {
            Some(_) => self.frozen,
            None => self.steps(position + self.blur),
        };
        read.amplitude_low = failing == Some(EncoderFault::Amplitude);
        read.edges_too_close = failing == Some(EncoderFault::Edges) || speed.abs() > self.speed_max;
    }

    /// Makes the encoder fail, or repairs it; what was not counted meanwhile stays lost.
    pub fn set_fault(&mut self, fault: Option<EncoderFault>, position: f64) {
        let frozen = |fault: Option<EncoderFault>| fault.is_some_and(|fault| !fault.counts());
        match (frozen(self.fault), frozen(fault)) {
            (false, true) => self.frozen = self.steps(position),
            (true, false) => {
                self.zero = position - (self.frozen as f64 + 0.5) / self.steps_per_unit;
            }
            _ => {}
        }
        self.fault = fault;
        self.enclose(position);
    }
}

/// Distance-coded marks: one every `spacing`, and one between each two that stands one signal period
/// further off its neighbour than the one before, so that two successive marks tell the place
/// [000:4549-4551] [001:977-987].
fn coded_marks(first: f64, last: f64, spacing: f64, period: f64) -> Vec<f64> {
    let mut marks = Vec::new();
    for pair in 0..MARKS_MAX / 2 {
        let fixed = first + pair as f64 * spacing;
        let offset = spacing / 2.0 + (pair + 1) as f64 * period;
        if fixed > last || offset >= spacing {
            break;
        }
        marks.push(fixed);
        if fixed + offset <= last {
            marks.push(fixed + offset);
        }
    }
    marks
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn neighbours_of_coded_marks_differ_by_one_period() {
        // 20 mm and 20 µm: distances 10.02, 9.98, 10.04, 9.96 ...
        let marks = coded_marks(-100.0, 100.0, 20.0, 0.02);
        let distances: Vec<f64> = marks.windows(2).map(|pair| pair[1] - pair[0]).collect();
        for (distance, expected) in distances.iter().zip([10.02, 9.98, 10.04, 9.96, 10.06]) {
            assert!((distance - expected).abs() < 1e-9, "{distance} {expected}");
        }
        assert_eq!(marks.len(), 21);
    }
}
