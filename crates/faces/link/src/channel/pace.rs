//! A channel that is faster than its line takes the time of the line.

use std::time::Duration;

/// What a process may be woken up too late without the line standing still.
const LATE: Duration = Duration::from_millis(4);
/// Characters that may go at once where those of [`LATE`] are fewer: a transmitter holds some.
const CHARACTERS: u32 = 4;

/// Lets characters go one after the other.
#[derive(Clone, Copy, Debug)]
pub(super) struct Pace {
    /// Time of a character.
    character: Duration,
    /// What may be caught up.
    credit: Duration,
    /// When the line is free.
    free: Duration,
}

impl Pace {
    pub fn new(character: Duration) -> Pace {
        Pace {
            character,
            credit: LATE.max(character * CHARACTERS),
            free: Duration::ZERO,
        }
    }

    /// How many characters may go now.
    pub fn room(&mut self, now: Duration) -> usize {
        self.free = self.free.max(now.saturating_sub(self.credit));
        if self.free > now {
            return 0;
        }
        let elapsed = now - self.free;
        let whole = elapsed.as_nanos() / self.character.as_nanos().max(1);
        1 + usize::try_from(whole).unwrap_or_default()
    }

    /// Counts characters that were sent.
    pub fn sent(&mut self, characters: usize) {
        self.free += self.character * u32::try_from(characters).unwrap_or(u32::MAX);
    }

    /// When the next one may go.
    pub fn next(&self) -> Duration {
        self.free
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Woken up at any time, a full line carries what it can, and never more.
    #[test]
    fn a_line_is_full_and_not_fuller() {
        let character = Duration::from_micros(260);
        for step in [50, 260, 1000, 3000] {
            let step = Duration::from_micros(step);
            let mut pace = Pace::new(character);
            let mut now = Duration::from_secs(1);
            let mut sent = 0;
            while now < Duration::from_secs(3) {
                let room = pace.room(now);
                pace.sent(room);
                sent += room;
                now += step;
            }
            let capacity = 2_000_000 / 260;
            assert!(
                (capacity - 20..=capacity + 20).contains(&sent),
                "{step:?}: {sent} of {capacity}"
            );
        }
    }

    #[test]
    fn nothing_is_saved_up_while_nothing_is_sent() {
        let mut pace = Pace::new(Duration::from_millis(10));
        assert_eq!(pace.room(Duration::from_secs(100)), 5);
        pace.sent(5);
        assert_eq!(pace.room(Duration::from_secs(100)), 0);
        assert_eq!(pace.next(), Duration::from_millis(100_010));
    }
}
