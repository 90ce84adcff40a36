//! Cycle 27 CYLINDER SURFACE: the first contour of cycle 14, programmed in a rotary axis and the linear axis along it, is
//! machined on a cylinder about that axis [000:6759-6763]. Parameters and way of the tool are those of the user's manual of
//! the TNC 415 and its successors (public).
//!
//! While the contour is recorded its words of the rotary axis become a way around the cylinder: everything after works in
//! the unrolled surface as in any plane, and the [placement](Placement) rolls it up again.

use std::sync::Arc;

use bahn_parameters::MessageId;
use bahn_path::region::Effort;
use bahn_path::{Curve, Cylinder, FeedRate, Frame, Placement, Position};

use super::contour_data::Values;
use super::contour_pocket::{ContourJob, Halt, Milling, Watch};
use super::contour_train::beside;
use super::machining::{Heights, Machining, infeeds};
use crate::context::Context;
use crate::error::Fault;
use crate::modal::Surface;
use crate::tilting::tool_of;

/// Before the contour is recorded: Q16 and Q17, and what must not be in force.
pub(crate) fn take_surface(c: &mut Context<'_>) -> Result<(), Fault> {
    let values = Values {
        numbers: c.numbers,
        settings: c.settings,
    };
    let radius_mm = values.length(16)?;
    if radius_mm <= 0.0 {
        let detail = "the cylinder radius Q16 is not greater than 0";
        return Err(Fault::new(MessageId::EntryValueIncorrect, detail));
    }
    let linear = match values.number(17)? {
        0.0 => false,
        1.0 => true,
        _ => {
            let detail = "the type of dimension Q17 is 0 (degrees) or 1 (mm or inches)";
            return Err(Fault::new(MessageId::EntryValueIncorrect, detail));
        }
    };
    let frame = &c.modal.frame;
    let plain = Frame {
        shift: frame.shift,
        ..Frame::identity(frame.plane)
    };
    if *frame != plain || c.pen.placement.is_some() {
        let detail = "cycle 27 takes datum shifts only: rotation, mirror image, scaling, cycle 19 and M114 end before it";
        return Err(Fault::new(MessageId::PlaneWronglyDefined, detail));
    }
    c.modal.surface = Some(Surface {
        radius_mm,
        linear,
        found: None,
    });
    Ok(())
}

/// Runs cycle 27.
pub(super) fn cylinder_surface(c: &mut Context<'_>, job: &ContourJob, watch: &Watch<'_>) -> Result<(), Halt> {
    let Some((cylinder, centre_mm)) = job.cylinder else {
        return Err(MessageId::CyclIncomplete.into());
    };
    let before = (c.modal.nominal, c.modal.actual);
    let result = machine(c, job, (cylinder, centre_mm), watch);
    c.pen.placement = None;
    if result.is_err() {
        (c.modal.nominal, c.modal.actual) = before;
    }
    result
}

fn machine(
    c: &mut Context<'_>,
    job: &ContourJob,
    (cylinder, centre_mm): (Cylinder, f64),
    watch: &Watch<'_>,
) -> Result<(), Halt> {
    let values = Values {
        numbers: c.numbers,
        settings: c.settings,
    };
    let (heights, plunging) = heights(&values, centre_mm)?;
    let mill = Milling {
        heights,
        plunge_feed: values.feed(11)?,
        feed: values.feed(12)?,
        reversed: false,
    };
    // Q3 acts to the side of the radius compensation (public).
    let distance = c.modal.used_radius()? + values.length(3)?;
    if distance < 0.0 {
        let detail = "the allowance Q3 is less than the tool radius takes away";
        return Err(Fault::new(MessageId::EntryValueIncorrect, detail).into());
    }
    let path = beside(&job.train, job.plane, distance)?;
    let [first, second] = path.start();
    let mut start = Position::UNKNOWN;
    job.plane.set(&mut start, [first, second]);
    approach(c, &cylinder, &heights, &start)?;
    let placement = Placement::rolled(cylinder, tool_of(c.modal));
    rename(c, None, Some(&placement));
    c.pen.placement = Some(Arc::new(placement.clone()));
    let mut m = Machining::new(c);
    let mut trace = m.tracer();
    trace.set_plane(job.plane);
    // Each depth the same way around, from the setup clearance (public).
    for depth in infeeds(heights.depth, plunging) {
        if trace.is_full() {
            break;
        }
        watch.spend(path.segments().len())?;
        trace.rapid_height(heights.clearance);
        trace.rapid_to(path.start());
        trace.feed_height(heights.at_depth(depth), mill.plunge_feed);
        mill.along(&mut trace, &path);
    }
    trace.rapid_height(heights.clearance);
    trace.finish()?;
    rename(c, Some(&placement), None);
    Ok(())
}

/// Q1, Q6 and Q16 along the tool axis, and Q10, mm.
fn heights(values: &Values<'_>, centre_mm: f64) -> Result<(Heights, f64), Fault> {
    let depth = values.length(1)?;
    let radius = values.length(16)?;
    if depth == 0.0 {
        return Err(Fault::new(MessageId::CyclIncomplete, "the milling depth Q1 is 0"));
    }
    if depth > 0.0 {
        // The surface is machined from outside (inferred).
        let detail = "the milling depth Q1 leads away from the cylinder";
        return Err(Fault::new(MessageId::WrongSignProgrammed, detail));
    }
    if -depth >= radius {
        let detail = "the milling depth Q1 reaches the centre of the cylinder";
        return Err(Fault::new(MessageId::EntryValueIncorrect, detail));
    }
    let surface = centre_mm + radius;
    let heights = Heights {
        clearance: surface + values.length(6)?.abs(),
        direction: -1.0,
        surface,
        depth: -depth,
        approach: None,
    };
    Ok((heights, values.plunging()?))
}

/// At rapid traverse over the start of the contour: up to the setup clearance where the tool is below it, then over the
/// centre of the cylinder (inferred: the manual tells the operator to do so).
fn approach(
    c: &mut Context<'_>,
    cylinder: &Cylinder,
    heights: &Heights,
    start: &Position,
) -> Result<(), Fault> {
    let normal = c.modal.plane.normal;
    let mut m = Machining::new(c);
    let mut trace = m.tracer();
    let height = trace.position()[normal];
    if height.is_nan() || height < heights.clearance {
        trace.rapid_height(heights.clearance);
    }
    let mut over = trace.position();
    for axis in start.known().iter() {
        over[axis] = start[axis];
    }
    over[cylinder.around] = cylinder.centre_mm;
    over[cylinder.rotary] = cylinder.zero_deg + start[cylinder.around] * cylinder.deg_per_mm;
    trace.movement(Curve::Line, over, FeedRate::Rapid);
    trace.finish()
}

/// Nothing moves: where the tool stands has another name.
fn rename(c: &mut Context<'_>, from: Option<&Placement>, to: Option<&Placement>) {
    for position in [&mut c.modal.nominal, &mut c.modal.actual] {
        *position = Placement::change(from, to, position);
    }
}
