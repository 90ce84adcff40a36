//! The course of the operands over the last cycles, as a line of small bars.

use std::collections::VecDeque;

use bahn_host::{Content, Operand};

/// Cycles that are remembered.
const CYCLES: usize = 240;
/// Heights of a bar.
const BARS: [char; 8] = [
    '\u{2581}', '\u{2582}', '\u{2583}', '\u{2584}', '\u{2585}', '\u{2586}', '\u{2587}', '\u{2588}',
];

/// The contents of the last cycles.
#[derive(Debug, Default)]
pub struct Trend {
    shown: bool,
    operands: Vec<(Operand, VecDeque<i32>)>,
}

impl Trend {
    /// Whether bars are shown instead of binary numbers.
    pub fn is_shown(&self) -> bool {
        self.shown
    }

    /// Bars or binary numbers.
    pub fn turn_over(&mut self) {
        self.shown = !self.shown;
    }

    /// What was remembered is forgotten.
    pub fn clear(&mut self) {
        self.operands.clear();
    }

    /// Takes the contents of the operands of the table after a cycle.
    pub fn take(&mut self, operands: &[Operand], contents: impl Iterator<Item = Content>) {
        self.operands.retain(|(operand, _)| operands.contains(operand));
        for (operand, content) in operands.iter().zip(contents) {
            let Content::Number(value) = content else {
                continue;
            };
            let at = self.operands.iter().position(|(own, _)| own == operand);
            let at = at.unwrap_or_else(|| {
                self.operands.push((*operand, VecDeque::with_capacity(CYCLES)));
                self.operands.len() - 1
            });
            if let Some((_, values)) = self.operands.get_mut(at) {
                if values.len() == CYCLES {
                    values.pop_front();
                }
                values.push_back(value);
            }
        }
    }

    /// The bars of the last cycles, the newest last, from the smallest to the largest value among them.
    pub fn bars(&self, operand: Operand, width: usize) -> String {
        let Some((_, values)) = self.operands.iter().find(|(own, _)| *own == operand) else {
            return String::new();
        };
        let values = values.range(values.len().saturating_sub(width)..);
        let (least, most) = values.clone().fold((i32::MAX, i32::MIN), |(least, most), value| {
            (least.min(*value), most.max(*value))
        });
        // A bit goes from 0 to 1, whatever it did.
        let (least, most) = match operand {
            Operand::Bit(_) => (0, 1),
            _ => (least, most),
        };
        let span = f64::from(most) - f64::from(least);
        let bar = |value: i32| {
            let part = if span > 0.0 {
                (f64::from(value) - f64::from(least)) / span
            } else {
                0.0
            };
            let height = (part * (BARS.len() - 1) as f64).round() as usize;
            BARS.get(height).copied().unwrap_or(' ')
        };
        values.map(|value| bar(*value)).collect()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn bars_span_what_was_seen() {
        let operands: Vec<Operand> = ["W8", "I4"].iter().map(|text| text.parse().unwrap()).collect();
        let mut trend = Trend::default();
        for value in 0..300 {
            let bit = i32::from(value >= 298);
            trend.take(
                &operands,
                [Content::Number(value), Content::Number(bit)].into_iter(),
            );
        }
        // 297 is the smallest of three, 299 the largest; 298 is half-way: step 3.5 of 7, rounded up.
        assert_eq!(trend.bars(operands[0], 3), "\u{2581}\u{2585}\u{2588}");
        assert_eq!(trend.bars(operands[1], 3), "\u{2581}\u{2588}\u{2588}");
        assert_eq!(
            trend.bars(operands[0], 1000).chars().count(),
            CYCLES,
            "older ones are forgotten"
        );
        trend.take(&operands[1..], [Content::Number(0)].into_iter());
        assert_eq!(trend.bars(operands[0], 3), "", "it left the table");
    }
}
