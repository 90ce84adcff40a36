//! Radius compensation: the path of the tool centre beside the contour.
//!
//! Decision: RND after the first RL/RR block is an arc tangent at the compensated contour point

use bahn_parameters::MessageId;
use bahn_path::parallel::flat::{self, Flat, SAME_POINT_MM};
use bahn_path::parallel::{Ending, what_is_left};
use bahn_path::{Arc, Curve, FeedRate, PathElement, Plane, Point2, Sense};

use super::corner::{bare, corner, transition};
use super::{ContourMove, FeedLaw, Side, Smooth};
use crate::error::{Cause, Fault};
use crate::output::Output;

/// Movements outside the plane that may wait after a held element. When more come, the contour is taken
/// to end here, so that an endless loop of them stays in constant memory (inferred).
const BETWEEN_MAX: usize = 500;

/// Elements that a contour subprogram may have.
const RECORDED_MAX: usize = 100_000;

/// An element that cannot be finished before the next one is known.
#[derive(Clone, Debug)]
struct Held {
    item: ContourMove,
    stage: Stage,
}

#[derive(Clone, Copy, Debug)]
enum Stage {
    /// First block with RL/RR: leads from the uncompensated position to the point beside the start of
    /// the following element [003:2038].
    Activation,
    /// An element beside which the tool runs.
    Compensated {
        /// The parallel curve, full length.
        offset: Flat,
        /// Where it starts after the corner before it.
        start: Point2,
        /// Path length cut off at the start; negative when extended (M97).
        start_cut: f64,
    },
}

/// Holds one element and the holds and tool-axis movements that follow it.
#[derive(Clone, Debug, Default)]
pub(crate) struct CompensationStage {
    held: Option<Held>,
    /// Movements without a part in the plane, waiting after the held element.
    between: Vec<ContourMove>,
    /// Plane position of the tool centre while it differs from the programmed position.
    displaced: Option<(Plane, Point2)>,
    /// Side of the contour being machined; off when compensation is not active.
    side: Side,
    /// Uncompensated elements, while a contour subprogram is recorded.
    recorded: Option<Vec<ContourMove>>,
}

impl CompensationStage {
    #[inline]
    pub fn push(&mut self, item: ContourMove, out: &mut Output) -> Result<(), Fault> {
        if let Some(recorded) = &mut self.recorded {
            if recorded.len() >= RECORDED_MAX {
                let detail = format!("a contour subprogram has more than {RECORDED_MAX} elements");
                return Err(Fault::new(MessageId::FurtherProgramEntryImpossible, detail));
            }
            recorded.push(item);
            return Ok(());
        }
        if item.side == Side::Off && self.is_idle() {
            out.push(item.element, item.barrier);
            return Ok(());
        }
        self.push_compensated(item, out)
    }

    /// Whether uncompensated movements pass through unchanged.
    #[inline]
    pub fn is_idle(&self) -> bool {
        self.side == Side::Off && self.displaced.is_none() && self.recorded.is_none()
    }

    /// A stage that keeps the programmed contour instead of compensating it.
    pub fn recorder() -> CompensationStage {
        CompensationStage {
            recorded: Some(Vec::new()),
            ..CompensationStage::default()
        }
    }

    /// What was recorded so far; leaves nothing behind.
    pub fn take_recorded(&mut self) -> Vec<ContourMove> {
        self.recorded.as_mut().map(std::mem::take).unwrap_or_default()
    }

    pub fn displaced(&self) -> Option<(Plane, Point2)> {
        self.displaced
    }

    pub fn holds_from(&self, sequence: u64) -> bool {
        let held = self.held.as_ref().map(|held| held.item.element.sequence);
        let between = self.between.last().map(|item| item.element.sequence);
        held.max(between).is_some_and(|of| of >= sequence)
    }

    /// Finishes the held element as if nothing followed: it ends beside its last point.
    pub fn flush(&mut self, out: &mut Output) -> Result<(), Fault> {
        self.finish_held(out)?;
        self.emit_between(out);
        Ok(())
    }

    fn push_compensated(&mut self, item: ContourMove, out: &mut Output) -> Result<(), Fault> {
        if !item.in_plane {
            return self.push_beside(item, out);
        }
        let flat = Flat::of(&item.element, item.plane);
        let is_line = item.element.curve == Curve::Line;
        let held_plane = self.held.as_ref().map(|held| held.item.plane);
        if item.side != Side::Off && held_plane.is_some_and(|plane| plane != item.plane) {
            // A main axis and its parallel axis in one compensated contour.
            return Err(Fault::from(MessageId::PlaneWronglyDefined).at(item.element.block));
        }
        match (self.side, item.side, flat) {
            (_, Side::Off, _) => self.leave(item, is_line, out),
            (Side::Off, _, _) => self.start(item, is_line, out),
            (was, is, _) if was != is => {
                // At least one R0 block between RL and RR [003:2042].
                Err(Fault::from(MessageId::PathOffsetWronglyStarted).at(item.element.block))
            }
            (_, _, Some(flat)) => self.follow(item, flat, out),
            // An arc outside the working plane cannot be compensated.
            (_, _, None) if !is_line => {
                Err(Fault::from(MessageId::PlaneWronglyDefined).at(item.element.block))
            }
            // A block to where the contour already is adds no corner.
            (_, _, None) => self.push_beside(item, out),
        }
    }

    /// A movement without a part in the plane, or a hold. With R0 it ends the compensation.
    fn push_beside(&mut self, item: ContourMove, out: &mut Output) -> Result<(), Fault> {
        let ends = item.side == Side::Off && item.element.curve != Curve::Hold;
        if ends || self.between.len() >= BETWEEN_MAX {
            self.flush(out)?;
        }
        if ends {
            self.side = Side::Off;
        }
        if self.held.is_some() {
            self.between.push(item);
        } else {
            self.emit_in_place(item, out);
        }
        Ok(())
    }

    /// First block with RL/RR.
    fn start(&mut self, item: ContourMove, is_line: bool, out: &mut Output) -> Result<(), Fault> {
        if !is_line {
            return Err(Fault::from(MessageId::PathOffsetWronglyStarted).at(item.element.block));
        }
        self.emit_between(out);
        self.side = item.side;
        self.held = Some(Held {
            item,
            stage: Stage::Activation,
        });
        Ok(())
    }

    /// Block with R0 after compensated ones: the last element ends beside its end point, then the tool
    /// goes in a straight line to the programmed position [003:1985].
    fn leave(&mut self, mut item: ContourMove, is_line: bool, out: &mut Output) -> Result<(), Fault> {
        if self.side != Side::Off && !is_line {
            return Err(Fault::from(MessageId::PathOffsetWronglyEnded).at(item.element.block));
        }
        let left = self.finish_held(out)?;
        self.emit_between(out);
        self.side = Side::Off;
        if let Some((plane, at)) = self.displaced.take() {
            plane.set(&mut item.element.start, at);
        }
        match (item.smooth.take(), left) {
            (Some(smooth), Some(left)) => depart(item, smooth, left, out),
            _ => {
                out.push(item.element, item.barrier);
                Ok(())
            }
        }
    }

    /// A compensated element after another one or after the activation.
    fn follow(&mut self, item: ContourMove, flat: Flat, out: &mut Output) -> Result<(), Fault> {
        let too_large = || {
            Fault::new(MessageId::ToolRadiusTooLarge, "the tool does not fit the arc").at(item.element.block)
        };
        let offset = flat
            .offset(item.side.sign() * item.radius)
            .ok_or_else(too_large)?;
        let stage = match self.held.take() {
            None => {
                // Compensation goes on after an interruption: straight to the point beside the start.
                let start = offset.start();
                self.emit_connection(&item, start, out);
                Stage::Compensated {
                    offset,
                    start,
                    start_cut: 0.0,
                }
            }
            Some(Held {
                item: first,
                stage: Stage::Activation,
            }) => {
                let normal = flat::scale(flat::left(flat.start_tangent()), item.side.sign());
                self.approach(first, offset.start(), normal, out)?;
                self.emit_between(out);
                Stage::Compensated {
                    offset,
                    start: offset.start(),
                    start_cut: 0.0,
                }
            }
            Some(Held {
                item: before,
                stage:
                    Stage::Compensated {
                        offset: a,
                        start,
                        start_cut,
                    },
            }) => {
                let joint = corner(&before, &a, &item, &offset)?;
                let transition = joint
                    .transition
                    .map(|curve| transition(&before, &item, curve, &joint));
                self.emit_compensated(before, &a, (start, start_cut), joint.ending, out)?;
                self.emit_between(out);
                if let Some(element) = transition {
                    self.displaced = Some((item.plane, joint.start));
                    out.push(element, None);
                }
                Stage::Compensated {
                    offset,
                    start: joint.start,
                    start_cut: joint.start_cut,
                }
            }
        };
        self.held = Some(Held { item, stage });
        Ok(())
    }

    /// Ends the held element beside its last point, and tells how the contour was left there.
    fn finish_held(&mut self, out: &mut Output) -> Result<Option<Leaving>, Fault> {
        let Some(Held { item, stage }) = self.held.take() else {
            return Ok(None);
        };
        let Some(flat) = Flat::of(&item.element, item.plane) else {
            // An activation without a way: the tool stays where it is.
            out.push(item.element, item.barrier);
            return Ok(None);
        };
        let normal = flat::scale(flat::left(flat.end_tangent()), item.side.sign());
        let leaving = Leaving {
            normal,
            side: item.side,
            feed: item.element.feed,
        };
        match stage {
            Stage::Activation => {
                // Nothing follows: perpendicular to the block itself (inferred).
                let target = flat::along(flat.end(), normal, item.radius);
                self.approach(item, target, normal, out)?;
            }
            Stage::Compensated {
                offset,
                start,
                start_cut,
            } => {
                let end = Ending {
                    end: offset.end(),
                    end_cut: 0.0,
                };
                self.emit_compensated(item, &offset, (start, start_cut), end, out)?;
            }
        }
        Ok(Some(leaving))
    }

    fn emit_compensated(
        &mut self,
        mut item: ContourMove,
        offset: &Flat,
        (start, start_cut): (Point2, f64),
        Ending { end, end_cut }: Ending,
        out: &mut Output,
    ) -> Result<(), Fault> {
        let programmed = item.element.curve;
        // Run backwards the tool damages the contour next to it [003:3469-3474].
        item.element.curve = what_is_left(programmed, offset, start_cut, end_cut).ok_or_else(|| {
            Fault::new(
                MessageId::ToolRadiusTooLarge,
                "the contour element is too short for the tool",
            )
            .at(item.element.block)
        })?;
        if let Curve::Arc(arc) = programmed {
            let contour_radius = flat::distance(item.plane.point(&item.element.start), arc.centre);
            let path_radius = flat::distance(offset.start(), arc.centre);
            apply_feed_law(&mut item.element, item.feed_law, contour_radius, path_radius);
        }
        item.plane.set(&mut item.element.start, start);
        item.plane.set(&mut item.element.end, end);
        self.displaced = Some((item.plane, end));
        out.push(item.element, item.barrier);
        Ok(())
    }

    fn emit_connection(&mut self, item: &ContourMove, end: Point2, out: &mut Output) {
        let at = self
            .displaced
            .map_or_else(|| item.plane.point(&item.element.start), |(_, point)| point);
        self.displaced = Some((item.plane, end));
        if flat::distance(at, end) <= SAME_POINT_MM {
            return;
        }
        let mut element = bare(&item.element, Curve::Line);
        element.end = item.element.start;
        item.plane.set(&mut element.start, at);
        item.plane.set(&mut element.end, end);
        out.push(element, None);
    }

    /// Straight line (and arc, with RND) to the point beside the first contour point.
    fn approach(
        &mut self,
        mut first: ContourMove,
        target: Point2,
        normal: Point2,
        out: &mut Output,
    ) -> Result<(), Fault> {
        let plane = first.plane;
        if let Some((_, at)) = self.displaced {
            plane.set(&mut first.element.start, at);
        }
        let start = plane.point(&first.element.start);
        if target.iter().any(|value| value.is_nan())
            || (first.smooth.is_some() && start.iter().any(|value| value.is_nan()))
        {
            return Err(no_position().at(first.element.block));
        }
        plane.set(&mut first.element.end, target);
        self.displaced = Some((plane, target));
        let Some(smooth) = first.smooth.take() else {
            out.push(first.element, first.barrier);
            return Ok(());
        };
        // The arc touches the compensated contour at `target`, its centre on the tool's side
        // (inferred, spec 8.6); the line runs tangentially into it.
        let centre = flat::along(target, normal, smooth.radius);
        let sense = first.side.sense();
        let touch = tangent_point(start, centre, smooth.radius, sense)
            .ok_or_else(|| Fault::from(MessageId::RoundingRadiusTooLarge).at(smooth.block))?;
        let sweep_deg = bahn_path::sweep_deg(centre, touch, target, sense);
        let mut arc = bare(
            &first.element,
            Curve::Arc(Arc {
                plane,
                centre,
                sweep_deg,
            }),
        );
        arc.block = smooth.block;
        if let Some(feed) = smooth.feed_mm_min {
            arc.feed = FeedRate::Programmed(feed);
        }
        arc.start = first.element.end;
        plane.set(&mut arc.start, touch);
        plane.set(&mut first.element.end, touch);
        arc.tangential_end = true;
        first.element.tangential_end = true;
        out.push(first.element, None);
        out.push(arc, first.barrier);
        Ok(())
    }

    /// A movement outside the plane, or a hold: the tool centre stays beside the contour.
    fn emit_in_place(&mut self, mut item: ContourMove, out: &mut Output) {
        if let Some((plane, at)) = self.displaced {
            plane.set(&mut item.element.start, at);
            plane.set(&mut item.element.end, at);
        }
        out.push(item.element, item.barrier);
    }

    fn emit_between(&mut self, out: &mut Output) {
        for item in std::mem::take(&mut self.between) {
            self.emit_in_place(item, out);
        }
    }
}

/// The way to the contour begins where an axis has no position yet [003:7984-7987].
pub(super) fn no_position() -> Fault {
    Fault::new(
        MessageId::ProgramStartUndefined,
        "an axis of the plane has no position before the contour",
    )
    .because(Cause::NoPosition)
}

/// How the contour is left at its last point.
#[derive(Clone, Copy, Debug)]
struct Leaving {
    /// Direction from the contour to the tool.
    normal: Point2,
    side: Side,
    feed: FeedRate,
}

/// Arc and straight line away from the contour: the mirror image of the approach.
fn depart(mut item: ContourMove, smooth: Smooth, left: Leaving, out: &mut Output) -> Result<(), Fault> {
    let plane = item.plane;
    let start = plane.point(&item.element.start);
    let end = plane.point(&item.element.end);
    let centre = flat::along(start, left.normal, smooth.radius);
    let sense = left.side.sense();
    let touch = tangent_point(end, centre, smooth.radius, sense.opposite())
        .ok_or_else(|| Fault::from(MessageId::RoundingRadiusTooLarge).at(smooth.block))?;
    let sweep_deg = bahn_path::sweep_deg(centre, start, touch, sense);
    let mut arc = bare(
        &item.element,
        Curve::Arc(Arc {
            plane,
            centre,
            sweep_deg,
        }),
    );
    arc.block = smooth.block;
    arc.feed = smooth.feed_mm_min.map_or(left.feed, FeedRate::Programmed);
    arc.start = item.element.start;
    arc.end = item.element.start;
    plane.set(&mut arc.end, touch);
    plane.set(&mut item.element.start, touch);
    arc.tangential_end = true;
    out.push(arc, None);
    out.push(item.element, item.barrier);
    Ok(())
}

/// Where the tangent from `point` touches the circle when the tool runs from the point to the circle and
/// on around it; `None` when the point lies inside.
fn tangent_point(point: Point2, centre: Point2, radius: f64, sense: Sense) -> Option<Point2> {
    let away = flat::sub(point, centre);
    let distance = away[0].hypot(away[1]);
    if distance < radius || radius <= 0.0 {
        return None;
    }
    let opening = (radius / distance).acos();
    let angle = away[1].atan2(away[0]) + sense.sign() * opening;
    Some([centre[0] + radius * angle.cos(), centre[1] + radius * angle.sin()])
}

/// M109 and M110: the feed at the cutting edge is constant [000:5120-5126]:
/// F_centre = F · R_centre / R_contour (inferred).
fn apply_feed_law(element: &mut PathElement, law: FeedLaw, contour_radius: f64, path_radius: f64) {
    let FeedRate::Programmed(feed) = element.feed else {
        return;
    };
    if contour_radius <= SAME_POINT_MM || path_radius <= SAME_POINT_MM {
        return;
    }
    let edge = feed * path_radius / contour_radius;
    element.feed = FeedRate::Programmed(match law {
        FeedLaw::Centre => feed,
        FeedLaw::Edge => edge,
        FeedLaw::EdgeReduced => edge.min(feed),
    });
}
