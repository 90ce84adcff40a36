//! Settings of programs that are executed while they are transferred [000:16951-16968].

use crate::ParameterList;

/// Memory for a program that is executed while it is transferred: MP7228 [000:16957-16968].
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct DripFeedMemory {
    /// What must be free for it, bytes: MP7228.0.
    pub min_bytes: u64,
    /// What it takes at most, bytes: MP7228.1, and no more than there is; 0 is all there is (inferred).
    pub max_bytes: u64,
}

impl DripFeedMemory {
    /// Transfer goes on when so much of a full memory is free again, bytes [000:16961].
    pub const RESUMES_BYTES: u64 = 256;

    /// The least that it needs is there.
    pub fn is_enough(&self) -> bool {
        self.min_bytes <= self.max_bytes
    }
}

impl ParameterList {
    /// Memory for programs that are executed while they are transferred. MP7228 counts kByte: chapter 8 of the manual says so,
    /// the list says bytes.
    pub fn drip_feed_memory(&self) -> DripFeedMemory {
        let kbyte = |index| self.get_new(7228, index).unwrap_or_default() as u64 * 1024;
        let there = u64::from(self.model().limits().program_memory_bytes);
        DripFeedMemory {
            min_bytes: kbyte(0),
            max_bytes: Some(kbyte(1)).filter(|max| *max > 0).unwrap_or(there).min(there),
        }
    }
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used, reason = "a test may fail")]
    use super::*;
    use crate::ControlModel;

    /// MP7228 counts kByte; nothing is more than what the model has.
    #[test]
    fn memory_of_the_drip_feed() {
        let memory = |min: f64, max: f64| {
            let mut list = ParameterList::reference(ControlModel::Tnc407);
            list.set(7228, 0, min).unwrap();
            list.set(7228, 1, max).unwrap();
            list.drip_feed_memory()
        };
        let there = 6000 * 22;
        assert_eq!(
            memory(0.0, 0.0),
            DripFeedMemory {
                min_bytes: 0,
                max_bytes: there
            }
        );
        assert_eq!(
            memory(2.0, 10.0),
            DripFeedMemory {
                min_bytes: 2048,
                max_bytes: 10_240
            }
        );
        assert_eq!(memory(0.0, 1024.0).max_bytes, there);
        assert!(memory(10.0, 10.0).is_enough());
        assert!(!memory(11.0, 10.0).is_enough());
        assert!(!memory(1024.0, 0.0).is_enough());
    }
}
