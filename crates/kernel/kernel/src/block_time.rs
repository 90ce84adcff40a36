//! The time that the control needs to process a block [000:143] [003:7815].
//!
//! Decision: Block processing time is spent for every element of the path from the first one on; of time in which
//! nothing is read one element is saved

/// A simulated processing time: elements of the path are read only as fast as it allows.
#[derive(Clone, Copy, Debug, Default)]
pub struct BlockTime {
    /// Time for an element, µs; 0 for none.
    time_us: u32,
    /// Time that is not spent, µs.
    credit_us: u64,
    /// Until when it was counted, µs.
    counted_us: u64,
}

impl BlockTime {
    /// An element takes so long from now on, µs; 0 for no time.
    pub fn set(&mut self, time_us: u32) {
        *self = BlockTime {
            time_us,
            ..BlockTime::default()
        };
    }

    /// How many elements may be read now, of those that are wanted; asked in every cycle, whether any are. Time in which the
    /// look-ahead was full, or nothing came, or no program ran, is not saved but for one element.
    pub fn allow(&mut self, now_us: u64, wanted: usize) -> usize {
        let passed = now_us.saturating_sub(self.counted_us);
        self.counted_us = now_us;
        if self.time_us == 0 {
            return wanted;
        }
        self.credit_us = self.credit_us.min(u64::from(self.time_us)) + passed;
        let elements = self.credit_us / u64::from(self.time_us);
        wanted.min(usize::try_from(elements).unwrap_or(wanted))
    }

    /// So many were read.
    pub fn spend(&mut self, elements: u64) {
        self.credit_us = self.credit_us.saturating_sub(elements * u64::from(self.time_us));
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// 4 ms for an element, a cycle of 3 ms: 0, 1, 1, 1, 0 of them may be read; a pause saves one at most.
    #[test]
    fn elements_come_in_their_time() {
        let mut time = BlockTime::default();
        time.set(4000);
        let mut read = |now_us: u64| {
            let allowed = time.allow(now_us, 256);
            time.spend(allowed as u64);
            allowed
        };
        assert_eq!([3000, 6000, 9000, 12_000, 15_000].map(&mut read), [0, 1, 1, 1, 0]);
        for pause in 0..1000 {
            time.allow(1_000_000 + pause * 3000, 256);
        }
        // One that was saved; its 4 ms and the cycle of 3 ms are no two.
        assert_eq!(time.allow(4_000_000, 256), 1);
        time.set(0);
        assert_eq!(time.allow(1_006_000, 256), 256);
    }
}
