//! Positioning blocks in listings.

use super::Output;
use crate::{Compensation, Motion, MotionKind, Word};
use bahn_path::Sense;

impl Output {
    pub(super) fn motion(&mut self, motion: &Motion) {
        let start = self.text.len();
        self.text.push_str(motion.kind.word());
        self.polar_word("PR", motion.polar_radius);
        self.polar_word("PA", motion.polar_angle);
        self.coordinates(&motion.coordinates);
        if let Some(normal) = motion.normal.as_deref() {
            for (address, value) in ["NX", "NY", "NZ"].into_iter().zip(normal) {
                self.signed_word(address, Some(*value));
            }
        }
        self.signed_word("R", motion.radius);
        if let Some(direction) = motion.direction {
            self.word(sense_text(direction));
        }
        if let Some(compensation) = motion.compensation {
            self.word(match compensation {
                Compensation::Off => "R0",
                Compensation::Left => "RL",
                Compensation::Right => "RR",
                Compensation::Lengthen => "R+",
                Compensation::Shorten => "R-",
            });
        }
        if let Some(feed) = motion.feed {
            self.feed_word(feed);
        }
        self.m_functions(&motion.m);
        if motion.kind == MotionKind::Paraxial && self.text.len() > start {
            // The axis word opens the block.
            self.text.remove(start);
        }
    }

    fn polar_word(&mut self, address: &str, word: Option<Word>) {
        if let Some(word) = word {
            self.word(if word.incremental { "I" } else { "" });
            self.text.push_str(address);
            self.signed(word.value);
        }
    }
}

/// The word of a sense of rotation: `DR+` or `DR-`.
pub(super) fn sense_text(sense: Sense) -> &'static str {
    match sense {
        Sense::CounterClockwise => "DR+",
        Sense::Clockwise => "DR-",
    }
}
