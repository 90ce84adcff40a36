//! Axes that may stand elsewhere are brought back.
//!
//! LinuxCNC's machine may leave for its tool changer at M6 and stay there (TOOL_CHANGE_POSITION, G28 or G30), and whoever goes
//! on after a stop or a function M100 to M199 may have moved it. What the control's path leaves out there, since the axis
//! stands still, the text has to say.
//!
//! Decision: A tool that is called before its M06 does not move a machine of LinuxCNC; where the run lifts its tip
//! out of the blank the text goes there before the next movement
//!
//! Decision: In G-code every axis is brought back after a tool change and a stop, where the machine may have left:
//! the tool axis last, or first where it is retracted

use bahn_path::{Axis, AxisSet, Curve, FeedRate, Position};

use super::line::Said;
use crate::TOLERANCE_MM;

/// Where the machine stands in the proof when it may stand anywhere, mm or degrees: for each axis somewhere else, and nowhere
/// that a program goes. An axis that no line has brought anywhere stays unknown.
pub(super) fn elsewhere(at: &Position) -> Position {
    let mut elsewhere = *at;
    for axis in at.known().iter() {
        elsewhere[axis] = 1e6 + 1e3 * axis.index() as f64;
    }
    elsewhere
}

/// Where the text has brought the axes.
pub(super) struct Stand {
    at: Position,
    tool_axis: Axis,
    away: bool,
}

impl Stand {
    pub fn new() -> Stand {
        Stand {
            at: Position::UNKNOWN,
            tool_axis: Axis::Z,
            away: false,
        }
    }

    pub fn tool_axis(&mut self, axis: Axis) {
        self.tool_axis = axis;
    }

    /// What was said may move the machine.
    pub fn said(&mut self, said: &Said) {
        if said.may_move_the_machine() {
            self.at = elsewhere(&self.at);
            self.away = true;
        }
    }

    /// An axis that gets its first position is brought there; one that stands at its first is not in the text.
    pub fn goes(&mut self, start: &Position, end: &Position) {
        for axis in end.known().iter() {
            if self.at[axis].is_finite() || start[axis] != end[axis] {
                self.at[axis] = end[axis];
            }
        }
    }

    /// The lines that bring every axis to where a movement begins, where the text stands elsewhere, and where it begins then.
    ///
    /// The tool axis comes last, down to where the movement begins. One that retracts it begins with that: the tool does not go
    /// back to where it was in the workpiece first.
    pub fn back(&mut self, ends: [&Position; 2], curve: &Curve, feed: FeedRate) -> (Vec<Said>, Position) {
        let [start, end] = ends;
        let mut lines = Vec::new();
        let known = self.at.known();
        let counted = self.counted_from(start, curve);
        if !std::mem::take(&mut self.away) && counted == known && !self.is_elsewhere(start) {
            return (lines, *start);
        }
        let tool = self.tool_axis;
        let moves = |axis: &Axis| end[*axis].is_finite() && start[*axis] != end[*axis];
        let alone = Axis::ALL.into_iter().filter(moves).all(|axis| axis == tool);
        let retracts =
            matches!(curve, Curve::Line) && end[tool] > start[tool] && (alone || feed == FeedRate::Rapid);
        let others = |axis: &Axis| counted.contains(*axis) && *axis != tool;
        let only = |axis: &Axis| counted.contains(*axis) && *axis == tool;
        match retracts {
            true => {
                self.line(end, &only, feed, &mut lines);
                self.line(end, &others, FeedRate::Rapid, &mut lines);
            }
            false => {
                self.line(start, &others, FeedRate::Rapid, &mut lines);
                self.line(start, &only, FeedRate::Rapid, &mut lines);
            }
        }
        let mut begins = *start;
        for axis in self.at.known().iter().filter(|axis| start[*axis].is_finite()) {
            begins[axis] = self.at[axis];
        }
        (lines, begins)
    }

    /// The axes that the text must have brought to the begin of a movement: those that it has brought anywhere, and those that an arc
    /// counts its centre from.
    fn counted_from(&self, start: &Position, curve: &Curve) -> AxisSet {
        let mut counted = self.at.known();
        if let Curve::Arc(arc) = curve {
            let plane = [arc.plane.first, arc.plane.second];
            let stands = plane.into_iter().filter(|axis| start[*axis].is_finite());
            stands.for_each(|axis| counted.insert(axis));
        }
        counted
    }

    /// Whether the path goes on elsewhere than where the text stands: a tool call puts the tip of another tool there, and the
    /// text may change the tool only later, at an M6.
    fn is_elsewhere(&self, start: &Position) -> bool {
        let apart = |axis: Axis| (self.at[axis] - start[axis]).abs() > TOLERANCE_MM;
        self.at.known().iter().any(apart)
    }

    /// A line of some axes.
    fn line(&mut self, to: &Position, of: &dyn Fn(&Axis) -> bool, feed: FeedRate, lines: &mut Vec<Said>) {
        let start = self.at;
        for axis in to.known().iter().filter(of) {
            self.at[axis] = to[axis];
        }
        if self.at.known().iter().any(|axis| start[axis] != self.at[axis]) {
            lines.push(Said::Move {
                curve: Curve::Line,
                start,
                end: self.at,
                feed,
            });
        }
    }
}
