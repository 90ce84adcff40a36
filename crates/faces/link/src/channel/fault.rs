//! A bad line: what a seed does to the bytes that pass.

use std::time::Duration;

/// Of so many bytes one is lost, one doubled, one has a bit flipped, and before one the line is slow.
const ONE_IN: u64 = 3000;
/// Of so many bytes one begins a silence.
const SILENCE_ONE_IN: u64 = 200_000;
/// How long nothing passes then: what is sent is lost.
const SILENCE: Duration = Duration::from_millis(500);
/// How long a slow device takes.
const SLOW: Duration = Duration::from_millis(20);

/// Between two faults so many bytes pass well. A check character cannot see two faults of a block that undo each other: a
/// blank lost here and one doubled there; a bad line is one whose faults can be seen.
const BETWEEN: u32 = 300;

/// The faults of one direction of a line. The same seed does the same to the same bytes.
#[derive(Clone, Debug)]
pub struct Faults {
    state: u64,
    /// Bytes with a fault each.
    one_in: u64,
    silent_until: Duration,
    slow_until: Duration,
    /// Bytes that still pass well.
    well: u32,
}

impl Faults {
    /// The faults of a seed, for one of the two directions.
    pub(crate) fn of_seed(seed: u64, direction: u64) -> Faults {
        Faults::with_rate(seed, direction, ONE_IN)
    }

    /// The same with another rate.
    pub fn with_rate(seed: u64, direction: u64, one_in: u64) -> Faults {
        Faults {
            state: seed.wrapping_mul(2).wrapping_add(direction),
            one_in: one_in.max(1),
            silent_until: Duration::ZERO,
            slow_until: Duration::ZERO,
            well: 0,
        }
    }

    /// When the line takes the next byte: a slow device keeps it waiting.
    pub fn ready(&self) -> Duration {
        self.slow_until
    }

    /// What becomes of a byte that is sent now.
    #[inline]
    pub fn pass(&mut self, byte: u8, now: Duration, into: &mut Vec<u8>) {
        let dice = self.next();
        if now < self.silent_until {
            return;
        }
        if self.well > 0 {
            self.well -= 1;
            return into.push(byte);
        }
        self.well = BETWEEN;
        if dice / 8 % SILENCE_ONE_IN == 1 {
            self.silent_until = now + SILENCE;
            return;
        }
        match dice / 8 % (self.one_in * 4) {
            0 => {}
            4 => into.extend([byte, byte]),
            8 => into.push(byte ^ (1 << (dice % 8))),
            12 => {
                self.slow_until = now + SLOW;
                into.push(byte);
            }
            _ => {
                self.well = 0;
                into.push(byte);
            }
        }
    }

    /// The next random number, by SplitMix64.
    fn next(&mut self) -> u64 {
        self.state = self.state.wrapping_add(0x9E37_79B9_7F4A_7C15);
        let mut mixed = self.state;
        mixed = (mixed ^ (mixed >> 30)).wrapping_mul(0xBF58_476D_1CE4_E5B9);
        mixed = (mixed ^ (mixed >> 27)).wrapping_mul(0x94D0_49BB_1331_11EB);
        mixed ^ (mixed >> 31)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Each fault comes about as often as it should, and the same seed does the same.
    #[test]
    fn faults_of_a_seed() {
        let run = |seed| {
            let mut faults = Faults::with_rate(seed, 0, 250);
            let (mut lost, mut doubled, mut flipped, mut slow) = (0, 0, 0, 0);
            let mut all = Vec::new();
            for number in 0..1_000_000_u64 {
                let mut out = Vec::new();
                let waits = faults.ready();
                // Slowly enough that a silence takes one byte.
                faults.pass(b'U', SILENCE * number as u32, &mut out);
                slow += u32::from(faults.ready() != waits);
                match out[..] {
                    [] => lost += 1,
                    [_, _] => doubled += 1,
                    [byte] => flipped += u32::from(byte != b'U'),
                    _ => assert!(out.len() < 3),
                }
                all.extend(out);
            }
            for count in [lost, doubled, flipped, slow] {
                // Less than one of 1000, since some bytes pass well after each.
                assert!((350..550).contains(&count), "{lost} {doubled} {flipped} {slow}");
            }
            all
        };
        assert!(run(1) == run(1));
        assert!(run(1) != run(2));
    }
}
