//! The functions in force of languages with G functions: what their blocks leave open is filled in here.
//!
//! Decision: A run in DIN/ISO begins with G01 and G90; F in a block of rapid traverse counts from the next one on
//! that is not; G17 to G19 without a tool call choose the tool axis; a block without words of its path function moves
//! on a line; one that says an arc, G07 or a polar function needs its end point there; G20 is refused (also
//! `program/src/iso/read.rs`)

use crate::{Distance, Modality, Motion, MotionKind, Operation, PathFunction};
use bahn_path::Sense;

/// The G functions in force. A run begins with G01 and G90 (inferred).
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct InForce {
    /// How blocks move that do not say it.
    pub function: PathFunction,
    /// Whether words that do not say it count from the datum.
    pub distance: Distance,
    /// Of the last G02, G03, G12 or G13.
    pub direction: Option<Sense>,
}

impl Default for InForce {
    fn default() -> InForce {
        InForce {
            function: PathFunction::Line,
            distance: Distance::Absolute,
            direction: None,
        }
    }
}

impl InForce {
    /// Takes the path function of a block.
    fn take(&mut self, modality: &Modality) {
        let Some(function) = modality.function else {
            return;
        };
        self.function = function;
        match function {
            PathFunction::Clockwise | PathFunction::PolarClockwise => {
                self.direction = Some(Sense::Clockwise);
            }
            PathFunction::CounterClockwise | PathFunction::PolarCounterClockwise => {
                self.direction = Some(Sense::CounterClockwise);
            }
            _ => {}
        }
    }

    /// Whether a block that is executed next moves on a straight line of its own, when this one is executed now.
    #[inline]
    pub fn line_follows(&self, now: &Operation, next: &Motion) -> bool {
        let Some(next) = next.modal else {
            return next.kind == MotionKind::Line;
        };
        let function = next.function.or_else(|| {
            let parts = now.parts().iter().rev();
            parts.into_iter().find_map(|part| match part {
                Operation::Motion(motion) => motion.modal.and_then(|modal| modal.function),
                _ => None,
            })
        });
        matches!(
            function.unwrap_or(self.function),
            PathFunction::Rapid | PathFunction::Line
        )
    }

    /// A positioning block with all that the functions in force say; they are those after it then.
    ///
    /// # Errors
    /// What is wrong with words that the path function in force does not have.
    pub fn resolve(&mut self, motion: &Motion, modality: &Modality) -> Result<Motion, &'static str> {
        self.take(modality);
        let function = self.function;
        let mut motion = motion.clone();
        motion.modal = None;
        if self.distance == Distance::Incremental {
            motion.coordinates.make_incremental(modality.open);
            let polar = [
                (&mut motion.polar_radius, modality.open_radius),
                (&mut motion.polar_angle, modality.open_angle),
            ];
            for (word, open) in polar {
                if let Some(word) = word.as_mut().filter(|_| open) {
                    word.incremental = true;
                }
            }
        }
        if let Some(distance) = modality.distance {
            self.distance = distance;
        }
        let polar = motion.polar_radius.is_some() || motion.polar_angle.is_some();
        motion.kind = match function.kind() {
            // Without a word that belongs to it a block moves on a line, if at all.
            MotionKind::LinePolar if !polar => MotionKind::Line,
            _ if !polar && motion.coordinates.is_empty() => MotionKind::Line,
            MotionKind::Circle if motion.polar_radius.is_some() => MotionKind::CircleRadius,
            kind => kind,
        };
        match motion.kind {
            MotionKind::CircleRadius => motion.radius = motion.polar_radius.take().map(|word| word.value),
            MotionKind::Line | MotionKind::CircleTangential | MotionKind::Circle | MotionKind::Paraxial
                if polar =>
            {
                return Err("R and H belong to polar functions, R to arcs as well");
            }
            MotionKind::Paraxial if motion.coordinates.axes().len() > 1 => {
                return Err("G07 moves one axis");
            }
            _ => {}
        }
        if matches!(
            motion.kind,
            MotionKind::Circle | MotionKind::CircleRadius | MotionKind::CirclePolar
        ) {
            motion.direction = self.direction;
        }
        Ok(motion)
    }
}
