//! Whether the feeds of a program in inches look ten times too small or too great: F counts inches or tenths
//! of an inch per minute, and nothing in a program says which.

use bahn_parameters::InchFeed;

use crate::{CycleWord, Feed, Operation, Program, Unit, Value};

/// A program none of whose feeds is above this is taken for one of whole inches read as tenths: hardly a
/// part is milled so slowly throughout *(inferred)*.
const SLOW_MM_MIN: f64 = 60.0;
/// A program none of whose feeds is below this is taken for one of tenths read as whole inches: plunging and
/// drilling are slower *(inferred)*.
const FAST_MM_MIN: f64 = 2500.0;
/// Feeds from here on stand for rapid traverse and say nothing *(inferred)*.
const RAPID_MM_MIN: f64 = 5000.0;

/// A feed that speaks against what F is taken to count.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct FeedDoubt {
    /// Block of the feed.
    pub block: u32,
    /// The feed as it is read, mm/min: the greatest of the program if that is too small, else the least.
    pub feed_mm_min: f64,
}

impl Program {
    /// The feed that makes it doubtful that F counts what it is taken to count; `None` in programs in mm, and
    /// where some feed is what one expects. Only numbers that stand in the program are looked at.
    ///
    /// ```
    /// use bahn_parameters::InchFeed;
    /// use bahn_program::Program;
    ///
    /// let program = Program::from_bytes("1.H", b"BEGIN PGM 1 INCH\nL X+1 R0 F12\nEND PGM 1 INCH".to_vec());
    /// let doubt = program.feed_doubt(InchFeed::Tenths).unwrap();
    /// assert_eq!((doubt.block, doubt.feed_mm_min), (1, 12.0 * 2.54));
    /// assert_eq!(program.feed_doubt(InchFeed::Whole), None);
    /// ```
    pub fn feed_doubt(&self, reading: InchFeed) -> Option<FeedDoubt> {
        if self.unit() != Unit::Inch {
            return None;
        }
        let mut least: Option<FeedDoubt> = None;
        let mut greatest = None;
        for numbered in self.blocks() {
            // A block of DIN/ISO is a whole cycle, and may be more.
            let parts = numbered.block.operation.parts().iter();
            parts.for_each(|part| {
                each_feed(part, &mut |feed| {
                    let feed_mm_min = feed * Unit::Inch.feed_mm_min(reading);
                    let found = Some(FeedDoubt {
                        block: numbered.number,
                        feed_mm_min,
                    });
                    if feed_mm_min > 0.0 && least.is_none_or(|least| feed_mm_min < least.feed_mm_min) {
                        least = found;
                    }
                    let slower = |greatest: &FeedDoubt| feed_mm_min <= greatest.feed_mm_min;
                    if feed_mm_min > 0.0
                        && feed_mm_min < RAPID_MM_MIN
                        && !greatest.as_ref().is_some_and(slower)
                    {
                        greatest = found;
                    }
                })
            });
        }
        match reading {
            InchFeed::Tenths => greatest.filter(|feed| feed.feed_mm_min <= SLOW_MM_MIN),
            InchFeed::Whole => least.filter(|feed| feed.feed_mm_min >= FAST_MM_MIN),
        }
    }
}

/// Calls a function with each number after an F.
fn each_feed(operation: &Operation, found: &mut impl FnMut(f64)) {
    let mut value = |value: Value| {
        if let Value::Number(number) = value {
            found(number);
        }
    };
    match operation {
        Operation::Motion(motion) => {
            if let Some(Feed::Value(feed)) = motion.feed {
                value(feed);
            }
        }
        Operation::Rounding { feed, .. } | Operation::Chamfer { feed, .. } => {
            feed.iter().copied().for_each(value);
        }
        Operation::Cycle(block) => {
            for word in &block.words {
                if let CycleWord::Feed(Feed::Value(feed)) = word {
                    value(*feed);
                }
            }
        }
        _ => {}
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn doubt(blocks: &str, reading: InchFeed) -> Option<u32> {
        let text = format!("BEGIN PGM 1 INCH\n{blocks}\nEND PGM 1 INCH\n");
        let program = Program::from_bytes("1.H", text.into_bytes());
        program.feed_doubt(reading).map(|doubt| doubt.block)
    }

    /// F20 is 50.8 mm/min in tenths and 508 mm/min in whole inches; F400 is 1016 and 10 160.
    #[test]
    fn feeds_off_by_ten_are_found() {
        use InchFeed::{Tenths, Whole};
        let slow = "L X+1 F8\nL X+2 F20 ; the greatest\nCYCL DEF 1.5 F4\nL X+3 F6299";
        assert_eq!((doubt(slow, Tenths), doubt(slow, Whole)), (Some(2), None));
        let fast = "L X+1 F400\nL Z-1 F120\nRND R1 F200";
        assert_eq!((doubt(fast, Tenths), doubt(fast, Whole)), (None, Some(2)));
        let usual = "L X+1 F400\nL Z-1 F30";
        assert_eq!((doubt(usual, Tenths), doubt(usual, Whole)), (None, None));
        let without = "L X+1 FMAX\nL X+2 FQ1";
        assert_eq!((doubt(without, Tenths), doubt(without, Whole)), (None, None));
    }

    /// P05 of G83 is the feed of its plunging, F4 of block 1.5: 10.16 mm/min in tenths, slower than 2500 in whole inches.
    #[test]
    fn feeds_of_cycles_in_din_iso_count() {
        let text = "%A G70 *\nN10 G83 P01 -.1 P02 -1 P03 -.5 P04 0 P05 4 *\nN20 G01 G40 G90 X+1 F400 *\nN99 %A G70 *\n";
        let program = Program::from_bytes("1.I", text.as_bytes().to_vec());
        assert_eq!(program.feed_doubt(InchFeed::Whole), None);
    }

    #[test]
    fn programs_in_mm_are_left_alone() {
        let program = Program::from_bytes("1.H", b"BEGIN PGM 1 MM\nL X+1 F10\nEND PGM 1 MM".to_vec());
        assert_eq!(program.feed_doubt(InchFeed::Tenths), None);
    }
}
