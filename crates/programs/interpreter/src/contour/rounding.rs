//! Roundings and chamfers between two contour elements.
//!
//! Decision: RND, CT and chamfer after a block that moves the tool axis beside the plane take its direction in the
//! plane, at the depth at which it ends; one of the tool axis alone has none (also `interpreter/tests/suite/readings.rs`)

use bahn_parameters::MessageId;
use bahn_path::parallel::{self, Flat};
use bahn_path::{Axis, BlockRef, CornerArc, Curve, FeedRate, PathElement, Plane, Point2, Position};

use super::compensation::CompensationStage;
use super::corner_arc::{self, Lies};
use super::{ContourMove, Side, Smooth};
use crate::error::Fault;
use crate::output::Output;

/// A rounding or chamfer asked for by a block.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Join {
    pub kind: JoinKind,
    /// Feed of the joint only [003:3034].
    pub feed_mm_min: Option<f64>,
    pub block: BlockRef,
    pub sequence: u64,
}

#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) enum JoinKind {
    /// RND: radius, mm [003:3008-3034].
    Rounding(f64),
    /// Chamfer: length cut off each side, mm [003:2664-2680].
    Chamfer(f64),
}

/// Holds that may wait after a rounding or chamfer for the element after it (inferred).
const AFTER_MAX: usize = 500;

/// Holds the last movement until it is known whether a rounding follows.
#[derive(Clone, Debug, Default)]
pub(crate) struct RoundingStage {
    held: Option<ContourMove>,
    /// Length of the held movement before arcs of M112 took from it, mm.
    held_length: f64,
    join: Option<Join>,
    /// Holds (functions without movement) that came after the join was asked for.
    after: Vec<ContourMove>,
    /// M124: a movement whose end is left out if the next one takes over from its start.
    left_out: Option<Box<ContourMove>>,
    /// Side of the plane movement before the held one: tells the first compensated block.
    side_before: Side,
}

impl RoundingStage {
    #[inline]
    pub fn push(
        &mut self,
        mut item: ContourMove,
        next: &mut CompensationStage,
        out: &mut Output,
    ) -> Result<(), Fault> {
        if let Some(left_out) = self.left_out.take() {
            if corner_arc::takes_over(&left_out, &item) {
                item.element.start = left_out.element.start;
            } else {
                self.take(*left_out, next, out)?;
            }
        }
        if self.join.is_none() && corner_arc::is_left_out(&item) {
            self.left_out = Some(Box::new(item));
            return Ok(());
        }
        self.take(item, next, out)
    }

    #[inline]
    fn take(
        &mut self,
        item: ContourMove,
        next: &mut CompensationStage,
        out: &mut Output,
    ) -> Result<(), Fault> {
        if let Some(join) = self.join {
            return self.push_joined(join, item, next, out);
        }
        if item.corner_arcs.is_some() {
            return self.push_with_arc(item, next, out);
        }
        let Some(held) = &mut self.held else {
            self.held = Some(item);
            return Ok(());
        };
        let before = std::mem::replace(held, item);
        if before.in_plane {
            self.side_before = before.side;
        }
        next.push(before, out)
    }

    /// M112: an arc at the corner to the held movement, where there is one.
    fn push_with_arc(
        &mut self,
        mut item: ContourMove,
        next: &mut CompensationStage,
        out: &mut Output,
    ) -> Result<(), Fault> {
        let length = item.element.length();
        if let Some(mut held) = self.held.take() {
            if held.in_plane {
                self.side_before = held.side;
            }
            let mut arc = None;
            if let Some((lies, radius)) = corner_arc::arc_between(&held, self.held_length, &item) {
                let join = Join {
                    kind: JoinKind::Rounding(radius),
                    feed_mm_min: None,
                    block: held.element.block,
                    sequence: held.element.sequence,
                };
                arc = match lies {
                    Lies::In(plane) => round_in(plane, &mut held, &mut item, radius, join)?,
                    Lies::InSpace => round_in_space(&mut held, &mut item, radius, join),
                };
            }
            next.push(held, out)?;
            if let Some(arc) = arc {
                next.push(arc, out)?;
            }
        }
        self.held_length = length;
        self.held = Some(item);
        Ok(())
    }

    pub fn holds_from(&self, sequence: u64) -> bool {
        let held = self
            .held
            .iter()
            .chain(self.after.last())
            .chain(self.left_out.as_deref());
        held.map(|item| item.element.sequence)
            .chain(self.join.map(|join| join.sequence))
            .any(|of| of >= sequence)
    }

    pub fn has_join(&self) -> bool {
        self.join.is_some()
    }

    #[inline]
    pub fn has_no_join(&self) -> bool {
        self.join.is_none()
            && self.left_out.is_none()
            && self.held.as_ref().is_none_or(|held| held.side == Side::Off)
    }

    /// The held movement, when an uncompensated one follows.
    #[inline]
    pub fn release(&mut self) -> Option<ContourMove> {
        self.held.as_ref()?;
        self.side_before = Side::Off;
        self.held.take()
    }

    pub fn join(&mut self, join: Join) -> Result<(), Fault> {
        let fault = match join.kind {
            JoinKind::Rounding(_) => MessageId::RoundingOffNotDefined,
            JoinKind::Chamfer(_) => MessageId::ChamferNotPermitted,
        };
        if self.join.is_some() || !self.held.as_ref().is_some_and(|held| held.in_plane) {
            return Err(Fault::new(
                fault,
                "the block before must be a movement in the working plane",
            ));
        }
        self.join = Some(join);
        Ok(())
    }

    pub fn flush(&mut self, next: &mut CompensationStage, out: &mut Output) -> Result<(), Fault> {
        if let Some(left_out) = self.left_out.take() {
            self.take(*left_out, next, out)?;
        }
        if let Some(join) = self.join.take() {
            return Err(not_between(join));
        }
        if let Some(held) = self.held.take() {
            if held.in_plane {
                self.side_before = held.side;
            }
            next.push(held, out)?;
        }
        Ok(())
    }

    fn push_joined(
        &mut self,
        join: Join,
        mut item: ContourMove,
        next: &mut CompensationStage,
        out: &mut Output,
    ) -> Result<(), Fault> {
        if item.element.curve == Curve::Hold {
            if self.after.len() >= AFTER_MAX {
                return Err(not_between(join));
            }
            self.after.push(item);
            return Ok(());
        }
        let Some(mut held) = self.held.take().filter(|_| item.in_plane) else {
            return Err(not_between(join));
        };
        self.join = None;
        let started = held.side != Side::Off && self.side_before == Side::Off;
        let ends = held.side != Side::Off && item.side == Side::Off;
        match (started, ends, join.kind) {
            (true, false, JoinKind::Rounding(radius)) if item.side == held.side => {
                held.smooth = Some(smooth(radius, join));
                next.push(held, out)?;
            }
            (false, true, JoinKind::Rounding(radius)) => {
                item.smooth = Some(smooth(radius, join));
                next.push(held, out)?;
            }
            (false, false, _) if item.side == held.side => {
                let joint = match join.kind {
                    JoinKind::Rounding(radius) => round(&mut held, &mut item, radius, join)?,
                    JoinKind::Chamfer(length) => Some(chamfer(&mut held, &mut item, length, join)?),
                };
                next.push(held, out)?;
                if let Some(joint) = joint {
                    next.push(joint, out)?;
                }
            }
            // Different compensation before and after the block [003:7962-7964].
            _ => return Err(Fault::from(MessageId::PathOffsetWronglyStarted).at(join.block)),
        }
        for hold in self.after.drain(..) {
            next.push(hold, out)?;
        }
        self.side_before = item.side;
        self.held = Some(item);
        Ok(())
    }
}

fn smooth(radius: f64, join: Join) -> Smooth {
    Smooth {
        radius,
        feed_mm_min: join.feed_mm_min,
        block: join.block,
    }
}

fn not_between(join: Join) -> Fault {
    let message = match join.kind {
        JoinKind::Rounding(_) => MessageId::RoundingOffNotDefined,
        JoinKind::Chamfer(_) => MessageId::ChamferNotPermitted,
    };
    Fault::new(message, "no contour element follows in the working plane").at(join.block)
}

/// Arc tangent to both elements; the corner point is not reached [003:3008-3033]. `None` when the
/// elements already are tangential: there is no corner to round.
fn round(
    held: &mut ContourMove,
    item: &mut ContourMove,
    radius: f64,
    join: Join,
) -> Result<Option<ContourMove>, Fault> {
    let (Some(a), Some(b)) = (
        Flat::of(&held.element, held.plane),
        Flat::of(&item.element, item.plane),
    ) else {
        return Err(Fault::from(MessageId::RoundingOffNotDefined).at(join.block));
    };
    let rounded = parallel::rounding(held.plane, [a, b], radius);
    let rounded = rounded.map_err(|_| Fault::from(MessageId::RoundingRadiusTooLarge).at(join.block))?;
    let Some(rounded) = rounded else {
        return Ok(None);
    };
    let ends = [rounded.from, rounded.to];
    let mut joint = joint_element(held, join, ends);
    joint.element.curve = Curve::Arc(rounded.arc);
    let plane = held.plane;
    parallel::cut(plane, [&mut held.element, &mut item.element], [a, b], ends);
    joint.element.tangential_end = true;
    held.element.tangential_end = true;
    Ok(Some(joint))
}

/// Arc in the plane of its lines, which need not be that of the contour.
fn round_in(
    plane: Plane,
    held: &mut ContourMove,
    item: &mut ContourMove,
    radius: f64,
    join: Join,
) -> Result<Option<ContourMove>, Fault> {
    let own = std::mem::replace(&mut held.plane, plane);
    let items = std::mem::replace(&mut item.plane, plane);
    let mut arc = round(held, item, radius, join)?;
    (held.plane, item.plane) = (own, items);
    if let Some(arc) = &mut arc {
        arc.plane = own;
    }
    Ok(arc)
}

/// Arc tangent to two lines of X, Y and Z that lie in no main plane.
fn round_in_space(
    held: &mut ContourMove,
    item: &mut ContourMove,
    radius: f64,
    join: Join,
) -> Option<ContourMove> {
    const MAIN: [Axis; 3] = [Axis::X, Axis::Y, Axis::Z];
    let ([a, b], _) = corner_arc::directions_in_space(&held.element, &item.element)?;
    // Half of the change of direction, by what the directions differ by and by what they have in common.
    let length = |vector: [f64; 3]| vector.iter().map(|d| d * d).sum::<f64>().sqrt();
    let half_tangent = length([0, 1, 2].map(|i| b[i] - a[i])) / length([0, 1, 2].map(|i| b[i] + a[i]));
    let leg = radius * half_tangent;
    let corner = held.element.end;
    let (mut from, mut to) = (corner, corner);
    for (i, axis) in MAIN.into_iter().enumerate() {
        from[axis] -= leg * a[i];
        to[axis] += leg * b[i];
    }
    let mut joint = joint_between(held, join, from, to);
    joint.element.curve = Curve::Corner(CornerArc {
        corner: MAIN.map(|axis| corner[axis]),
    });
    joint.element.tangential_end = true;
    held.element.tangential_end = true;
    held.element.end = from;
    item.element.start = to;
    Some(joint)
}

/// Straight cut between two straight lines [003:2664-2680].
fn chamfer(
    held: &mut ContourMove,
    item: &mut ContourMove,
    length: f64,
    join: Join,
) -> Result<ContourMove, Fault> {
    let (Some(a @ Flat::Line { .. }), Some(b @ Flat::Line { .. })) = (
        Flat::of(&held.element, held.plane),
        Flat::of(&item.element, item.plane),
    ) else {
        return Err(Fault::from(MessageId::ChamferNotPermitted).at(join.block));
    };
    let ends = parallel::chamfer([a, b], length).map_err(|_| {
        Fault::new(
            MessageId::ChamferNotPermitted,
            "the chamfer is longer than a side",
        )
        .at(join.block)
    })?;
    let joint = joint_element(held, join, ends);
    let plane = held.plane;
    parallel::cut(plane, [&mut held.element, &mut item.element], [a, b], ends);
    Ok(joint)
}

/// A joint in the plane of the element before it.
fn joint_element(held: &ContourMove, join: Join, [from, to]: [Point2; 2]) -> ContourMove {
    let (mut start, mut end) = (held.element.end, held.element.end);
    held.plane.set(&mut start, from);
    held.plane.set(&mut end, to);
    joint_between(held, join, start, end)
}

/// The joint takes compensation and (unless it has its own) feed of the element before it.
fn joint_between(held: &ContourMove, join: Join, start: Position, end: Position) -> ContourMove {
    let mut joint = held.clone();
    joint.smooth = None;
    joint.corner = Default::default();
    joint.barrier = None;
    joint.element = PathElement {
        block: join.block,
        sequence: join.sequence,
        curve: Curve::Line,
        functions: None,
        dwell_s: 0.0,
        start,
        end,
        ..joint.element
    };
    if let Some(feed) = join.feed_mm_min {
        joint.element.feed = FeedRate::Programmed(feed);
    }
    joint
}
