//! Drilling at a position: G81, G83, G85 by P30 to P39 [002:1377-1397].
//!
//! Decision: The tool axis is the normal of the plane. It goes rapidly to P34, with P32 to P33, waits P30, goes back to P34 -
//! rapidly, with G85 at feed - and rapidly to P35. G83 goes down in P36 equal strokes, each time rapidly out to P34 and back
//! to P38 above the depth that it had. P33, P34 and P35 are coordinates of the program

use bahn_path::{Axis, Curve, FeedRate, Position};
use bahn_system900::PathParameter;

use crate::block::Work;
use crate::motion::Move;
use crate::refusal::Refusal;

/// P38 where it is cleared, mm [002:1394].
const MARGIN_MM: f64 = 1.0;
/// Strokes of G83 at most (inferred).
const STROKES_MAX: f64 = 1000.0;

impl Work<'_> {
    /// Drills where the axes stand.
    pub fn drill(&mut self, g: u16) -> Result<(), Refusal> {
        let words = self.memory.plane_axes(self.channel, self.run.modal.plane);
        let Some(normal) = self.axes.slot(words[2]) else {
            return Err(Refusal::of(format!("G{g} needs the normal axis of the plane")));
        };
        let feed = self.scaled(self.path(PathParameter::DrillFeed));
        if feed <= 0.0 {
            return Err(Refusal::of(format!("G{g} has no feed: P32")));
        }
        let feed = FeedRate::Programmed(feed);
        let [depth, plane, retract] = [
            PathParameter::DrillDepth,
            PathParameter::DrillPlane,
            PathParameter::DrillRetract,
        ]
        .map(|parameter| self.path(parameter));
        let rapid = self.rapid();
        self.go(normal, plane, rapid)?;
        match g {
            83 => self.strokes(normal, [depth, plane], feed)?,
            _ => self.go(normal, depth, feed)?,
        }
        let dwell_s = self.path(PathParameter::DrillDwell);
        self.halt(dwell_s.max(0.0));
        self.go(normal, plane, if g == 85 { feed } else { rapid })?;
        self.go(normal, retract, rapid)
    }

    /// The strokes of G83 down to the depth.
    fn strokes(&mut self, normal: Axis, [depth, plane]: [f64; 2], feed: FeedRate) -> Result<(), Refusal> {
        if self.path(PathParameter::DrillDegressive) == 1.0 {
            return Err(Refusal::not_executed(
                "G83 with P39",
                "strokes that become smaller are not done yet",
            ));
        }
        let count = self.path(PathParameter::DrillStrokes).round();
        if !(1.0..=STROKES_MAX).contains(&count) {
            return Err(Refusal::of(format!(
                "G83 has {count} strokes: P36 is 1 to {STROKES_MAX}"
            )));
        }
        let margin = self
            .memory
            .path(self.channel, PathParameter::DrillMargin)
            .number();
        let margin = margin.unwrap_or(MARGIN_MM);
        let stroke = (depth - plane) / count;
        let rapid = self.rapid();
        let mut reached = plane;
        for number in 1..=count as u32 {
            if number > 1 {
                self.halt(0.0);
                self.go(normal, plane, rapid)?;
                self.go(normal, reached - margin.copysign(stroke), rapid)?;
            }
            reached = match number == count as u32 {
                true => depth,
                false => plane + stroke * f64::from(number),
            };
            self.go(normal, reached, feed)?;
        }
        Ok(())
    }

    /// The tool axis goes to a coordinate of the program.
    fn go(&mut self, normal: Axis, to: f64, feed: FeedRate) -> Result<(), Refusal> {
        let frame = self.frame()?;
        let mut target: Position = frame.to_program(&self.run.position);
        target[normal] = to;
        let to = Move {
            curve: Curve::Line,
            end: frame.to_control(&target),
            feed,
        };
        self.append(to, Vec::new());
        Ok(())
    }
}
