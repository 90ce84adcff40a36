//! Cycle 25 CONTOUR TRAIN: the tool runs along an open or closed contour, the first of cycle 14 [000:652] (parameters
//! of later controls).

use bahn_path::region::{Contour as PlaneContour, Effort, Segment};
use bahn_path::{PathElement, Plane};

use super::contour_data::Values;
use super::contour_pocket::{ContourJob, Halt, Milling, Watch};
use super::machining::{Machining, infeeds};
use crate::context::Context;
use crate::contour::{Contour, ContourMove, Corner, FeedLaw, Side};
use crate::error::Fault;
use crate::output::{Item, Output};
use crate::status::Spindle;
use bahn_path::parallel::Flat;

/// Runs cycle 25.
pub(super) fn contour_train(c: &mut Context<'_>, job: &ContourJob, watch: &Watch<'_>) -> Result<(), Halt> {
    let values = Values {
        numbers: c.numbers,
        settings: c.settings,
    };
    let heights = values.heights(c.modal, 0.0)?;
    let plunging = values.plunging()? * c.modal.frame.scale(c.modal.plane.normal);
    let climb = values.number(15)?;
    let mill = Milling {
        heights,
        plunge_feed: values.feed(11)?,
        feed: values.feed(12)?,
        reversed: false,
    };
    let distance = c.modal.used_radius()? + values.length(3)?.abs();
    let mut path = beside(&job.train, job.plane, distance)?;
    let side = job.train.last().map_or(Side::Off, |last| last.side);
    // With M03 a tool left of its way climbs; a contour with R0 has no side, and climbs in its own direction.
    let climbs = (side != Side::Right) != (c.modal.spindle == Spindle::CounterClockwise);
    if climb != 0.0 && (climb > 0.0) != climbs {
        path = path.reversed();
    }
    let pecks = infeeds(heights.depth, plunging);
    let mut m = Machining::new(c);
    let mut trace = m.tracer();
    trace.set_plane(job.plane);
    trace.lift(&heights);
    trace.rapid_to(path.start());
    for depth in &pecks {
        if trace.is_full() {
            break;
        }
        watch.spend(path.segments().len())?;
        if job.plane.point(&trace.position()) != path.start() {
            trace.rapid_height(heights.clearance);
            trace.rapid_to(path.start());
        }
        trace.feed_height(heights.at_depth(*depth), mill.plunge_feed);
        mill.along(&mut trace, &path);
        if climb == 0.0 {
            // To and fro.
            path = path.reversed();
        }
    }
    trace.rapid_height(heights.clearance);
    Ok(trace.finish()?)
}

/// The way of the tool centre beside a contour, from beside its first point to beside its last.
pub(super) fn beside(moves: &[ContourMove], plane: Plane, distance: f64) -> Result<PlaneContour, Fault> {
    let side = moves.last().map_or(Side::Off, |last| last.side);
    let mut stages = Contour::default();
    let mut out = Output::default();
    for item in moves {
        stages.push(
            ContourMove {
                element: PathElement {
                    functions: None,
                    ..item.element.clone()
                },
                plane,
                side,
                radius: distance,
                corner: Corner::Normal,
                feed_law: FeedLaw::Centre,
                smooth: None,
                barrier: None,
                corner_arcs: None,
                ..*item
            },
            &mut out,
        )?;
    }
    stages.flush(&mut out)?;
    let elements = out.queue.iter().filter_map(|item| match item {
        Item::Element(element) => Some(element),
        Item::Barrier(_) => None,
    });
    let mut segments = elements
        .skip(1)
        .filter_map(|element| Flat::of(element, plane))
        .map(segment)
        .peekable();
    let start = segments.peek().map_or([0.0; 2], Segment::from);
    let mut path = PlaneContour::start_at(start);
    segments.for_each(|segment| path.push(segment));
    Ok(path)
}

fn segment(flat: Flat) -> Segment {
    match flat {
        Flat::Line { start, end } => Segment::line(start, end),
        Flat::Arc {
            start,
            end,
            centre,
            sweep_deg,
        } => Segment::Arc {
            from: start,
            to: end,
            centre,
            sweep_deg,
        },
    }
}
