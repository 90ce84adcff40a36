//! The time that a control needs to process a block, in a test run.

use std::collections::VecDeque;

use bahn_parameters::ControlModel;

/// Elements that are processed ahead at most (inferred: the control's own look-ahead is not printed).
const AHEAD: usize = 512;

/// Processing and machining of the elements, one after the other: an element begins when the one before has
/// ended and it is processed; it is processed when the one before is, and there is room for it. That the
/// path brakes where it waits is left out.
pub struct BlockTime {
    block_s: f64,
    /// When the latest element was processed, and when it ends, s.
    processed_s: f64,
    end_s: f64,
    /// When the elements began that are still looked at.
    begun_s: VecDeque<f64>,
}

impl BlockTime {
    /// With the block processing time of a control model [000:143] [003:7815].
    pub fn of(model: ControlModel) -> BlockTime {
        BlockTime {
            block_s: model.limits().block_time_ms * 1e-3,
            processed_s: 0.0,
            end_s: 0.0,
            begun_s: VecDeque::with_capacity(AHEAD),
        }
    }

    /// Takes the next element; how long the machine waits for it, s.
    pub fn wait_s(&mut self, duration_s: f64) -> f64 {
        let room_s = if self.begun_s.len() < AHEAD {
            0.0
        } else {
            self.begun_s.pop_front().unwrap_or(0.0)
        };
        self.processed_s = self.processed_s.max(room_s) + self.block_s;
        let begin_s = self.end_s.max(self.processed_s);
        let wait_s = begin_s - self.end_s;
        self.begun_s.push_back(begin_s);
        self.end_s = begin_s + duration_s;
        wait_s
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// TNC 360, 40 ms: 1000 elements of 10 ms take 40 s and the 10 ms of the last one; of 100 ms nothing but
    /// the first one waits.
    #[test]
    fn short_elements_wait() {
        let total = |duration_s: f64| {
            let mut time = BlockTime::of(ControlModel::Tnc360);
            (0..1000)
                .map(|_| time.wait_s(duration_s) + duration_s)
                .sum::<f64>()
        };
        assert!(
            (total(0.010) - (1000.0 * 0.040 + 0.010)).abs() < 1e-9,
            "{}",
            total(0.010)
        );
        assert!(
            (total(0.100) - (0.040 + 1000.0 * 0.100)).abs() < 1e-9,
            "{}",
            total(0.100)
        );
    }

    /// What is processed while a long element runs is ready after it. The first element ends at 5.04 s, number
    /// k is processed at 0.04 k and could begin at 5.04 + 0.001 (k - 2): number 130 is the first that waits,
    /// 5.2 - 5.168 s.
    #[test]
    fn long_elements_give_time_to_process() {
        let mut time = BlockTime::of(ControlModel::Tnc360);
        time.wait_s(5.0);
        let waited: f64 = (2..=129).map(|_| time.wait_s(0.001)).sum();
        assert_eq!(waited, 0.0);
        assert!((time.wait_s(0.001) - 0.032).abs() < 1e-9);
    }
}
