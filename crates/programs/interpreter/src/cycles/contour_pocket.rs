//! SL cycles: rough-out (6), pilot drilling (15) and contour milling (16) of superimposed subcontours.

use bahn_parameters::MessageId;
use std::cell::Cell;
use std::sync::atomic::{AtomicBool, Ordering};

use bahn_path::parallel::Flat;
use bahn_path::region::{
    Contour as PlaneContour, Effort, HatchPattern, Merge, Outline, Pass, PocketArea, Segment, SubContour,
    Superposition,
};
use bahn_path::{Arc, Axis, AxisSet, Curve, Cylinder, FeedRate, Plane, Point2, Sense};

use super::machining::{Heights, Machining, Tracer, infeeds, plane_direction};
use crate::contour::{ContourMove, Side};
use crate::definition::Definition;
use crate::error::Fault;
use crate::modal::Modal;
use crate::q_parameters::{cos_deg, sin_deg};

/// What an SL cycle is asked to do: the subcontours that its labels describe.
#[derive(Clone, Debug)]
pub(crate) struct ContourJob {
    pub subcontours: Vec<SubContour>,
    /// The contour of cycle 25 or 27.
    pub train: Vec<ContourMove>,
    pub plane: Plane,
    /// What cycle 27 machines, and where its centre is along the tool axis, mm.
    pub cylinder: Option<(Cylinder, f64)>,
    /// Radius of the tool that machines before this one, or after it, mm.
    pub other_radius: Option<f64>,
}

/// Why a cycle did not come to its end.
pub(crate) enum Halt {
    Fault(Fault),
    /// The operator broke it off; nothing of it is executed.
    Interrupted,
}

impl<F: Into<Fault>> From<F> for Halt {
    fn from(fault: F) -> Halt {
        Halt::Fault(fault.into())
    }
}

/// Watches what the contours of a cycle cost, and whether somebody wants them no more.
pub(crate) struct Watch<'a> {
    ends: [Option<&'a AtomicBool>; 2],
    spent: Cell<usize>,
}

impl<'a> Watch<'a> {
    /// Each of the flags ends the computation.
    pub fn new(ends: [Option<&'a AtomicBool>; 2]) -> Watch<'a> {
        Watch {
            ends,
            spent: Cell::new(0),
        }
    }
}

impl Effort for Watch<'_> {
    type Stop = Halt;

    fn spend(&self, steps: usize) -> Result<(), Halt> {
        /// About a minute, or 300,000 crossings; a contour of 20,000 elements takes a tenth of it.
        const STEPS_MAX: usize = 1_000_000_000;
        let mut ends = self.ends.into_iter().flatten();
        if ends.any(|flag| flag.load(Ordering::Relaxed)) {
            return Err(Halt::Interrupted);
        }
        self.spent.set(self.spent.get().saturating_add(steps));
        if self.spent.get() > STEPS_MAX {
            let detail = "the contours of the cycle meet each other too often to be computed";
            return Err(Fault::new(MessageId::EntryValueIncorrect, detail).into());
        }
        Ok(())
    }
}

/// Farthest distance of the last point from the first one of a closed contour, mm: end points are
/// calculated and rounded in many programs (inferred).
const CLOSED_MM: f64 = 0.01;

impl ContourJob {
    pub fn new(plane: Plane) -> ContourJob {
        ContourJob {
            subcontours: Vec::new(),
            train: Vec::new(),
            plane,
            cylinder: None,
            other_radius: None,
        }
    }

    /// Takes what the contour subprogram of cycle 25 recorded.
    pub fn add_train(&mut self, moves: &[ContourMove]) -> Result<(), Fault> {
        self.train = train(moves);
        if self.train.len() < 2 {
            let detail = "the subprogram describes no contour";
            return Err(Fault::new(MessageId::CyclIncomplete, detail));
        }
        let flat = |item: &&ContourMove| Flat::of(&item.element, self.plane).is_none();
        let mut arcs = self
            .train
            .iter()
            .filter(|item| matches!(item.element.curve, Curve::Arc(_)));
        match arcs.find(flat) {
            Some(item) => Err(Fault::from(MessageId::PlaneWronglyDefined).at(item.element.block)),
            None => Ok(()),
        }
    }

    /// Adds what a contour subprogram recorded. Its first block gives the start point [003:5389-5454].
    pub fn add(&mut self, moves: &[ContourMove]) -> Result<(), Fault> {
        let mut moves = moves.iter().filter(|item| item.in_plane);
        let Some(first) = moves.next() else {
            return Err(Fault::new(
                MessageId::CyclIncomplete,
                "the subprogram describes no contour",
            ));
        };
        let mut contour = PlaneContour::start_at(self.plane.point(&first.element.end));
        let mut side = first.side;
        let mut last = first.element.block;
        for item in moves {
            if item.side == Side::Off && side != Side::Off {
                // The contour ends where the compensation does.
                break;
            }
            side = item.side;
            last = item.element.block;
            match Flat::of(&item.element, self.plane) {
                Some(Flat::Line { start, end }) => contour.push(Segment::line(start, end)),
                Some(Flat::Arc {
                    start,
                    end,
                    centre,
                    sweep_deg,
                }) => {
                    contour.push(Segment::Arc {
                        from: start,
                        to: end,
                        centre,
                        sweep_deg,
                    });
                }
                None if matches!(item.element.curve, Curve::Arc(_)) => {
                    return Err(Fault::from(MessageId::PlaneWronglyDefined).at(item.element.block));
                }
                None => {}
            }
        }
        if side == Side::Off {
            return Err(Fault::from(MessageId::RadiusCompensationUndefined).at(first.element.block));
        }
        let (start, end) = (contour.start(), contour.end());
        let gap = (end[0] - start[0]).hypot(end[1] - start[1]);
        if gap > CLOSED_MM || gap.is_nan() || contour.segments().is_empty() {
            let detail = format!("the contour does not close: its end is {gap:.3} mm from its start");
            return Err(Fault::new(MessageId::CyclIncomplete, detail).at(last));
        }
        self.subcontours
            .push(SubContour::programmed(contour.closed(), side == Side::Left));
        Ok(())
    }
}

/// What a contour subprogram recorded, as a train: a move to its start point, which leads the tool beside it, and its
/// elements.
fn train(moves: &[ContourMove]) -> Vec<ContourMove> {
    let mut in_plane = moves.iter().filter(|item| item.in_plane);
    let mut train: Vec<ContourMove> = Vec::new();
    if let Some(first) = in_plane.next() {
        let mut start = first.clone();
        start.element.curve = Curve::Line;
        start.element.start = start.element.end;
        train.push(start);
    }
    for item in in_plane {
        let ends = item.side == Side::Off && train.last().is_some_and(|before| before.side != Side::Off);
        if ends {
            // The contour ends where the compensation does.
            break;
        }
        train.push(item.clone());
    }
    train
}

/// The plane of the subcontours: the working plane, where parallel axes of the first coordinate block
/// stand for their main axes [003:5397-5432].
pub(crate) fn contour_plane(working: Plane, first_axes: AxisSet) -> Plane {
    let substitute = |axis: Axis| {
        let parallel = first_axes.iter().find(|a| *a != axis && a.main() == axis.main());
        parallel.filter(|_| !first_axes.contains(axis)).unwrap_or(axis)
    };
    Plane {
        first: substitute(working.first),
        second: substitute(working.second),
        normal: working.normal,
    }
}

/// Cycle 6 ROUGH-OUT [003:5477-5521].
pub(super) fn rough_out(
    m: &mut Machining<'_>,
    job: &ContourJob,
    d: &Definition,
    watch: &Watch<'_>,
) -> Result<(), Halt> {
    let pecking = d.length(2, 0)?;
    let plunge_feed = d.feed(2, 0)?;
    let allowance = d.length(2, 1)?;
    let angle = d.number(3, 0)?;
    let feed = d.feed(3, 0)?;
    let (heights, pecks) = contour_heights(m, d, pecking)?;
    let areas = own_areas(m, job, allowance, watch)?;
    let rules = m.settings.rules.contour_pocket;
    let mill = Milling {
        heights,
        plunge_feed,
        feed,
        reversed: rules.channel_clockwise,
    };
    let passes = (plane_direction_of(m.modal, angle), m.modal.tool_radius());
    clear_areas(m, job.plane, (&areas, &mill), passes, &pecks, watch)
}

/// Clears areas by channels and parallel passes in a direction, degrees, and a stepover apart, mm; in the order of
/// MP7420.
pub(super) fn clear_areas(
    m: &mut Machining<'_>,
    plane: Plane,
    (areas, mill): (&[PocketArea], &Milling),
    (direction_deg, stepover): (f64, f64),
    pecks: &[f64],
    watch: &Watch<'_>,
) -> Result<(), Halt> {
    let mut clearing = Vec::with_capacity(areas.len());
    for area in areas {
        check_passes(area, stepover)?;
        let region = &area.region;
        clearing.push(region.hatch_within(direction_deg, stepover, HatchPattern::Zigzag, watch)?);
    }
    let rules = m.settings.rules.contour_pocket;
    let mut trace = m.tracer();
    trace.set_plane(plane);
    trace.lift(&mill.heights);
    // The depths of one operation: all of them, or one after the other in turn with the other operation.
    let rounds: Vec<&[f64]> = if rules.per_infeed {
        pecks.chunks(1).collect()
    } else {
        vec![pecks]
    };
    for (area, passes) in areas.iter().zip(&clearing) {
        for depths in &rounds {
            if rules.clear_first {
                mill.clear(&mut trace, passes, depths, watch)?;
                mill.outlines(&mut trace, &area.outlines, depths, watch)?;
            } else {
                mill.outlines(&mut trace, &area.outlines, depths, watch)?;
                mill.clear(&mut trace, passes, depths, watch)?;
            }
        }
    }
    Ok(finish(trace, rules.stay_at_clearance)?)
}

/// Cycle 15 PILOT DRILLING: pecks as cycle 1 at each infeed point [003:5993-6014].
pub(super) fn pilot_drilling(
    m: &mut Machining<'_>,
    job: &ContourJob,
    d: &Definition,
    watch: &Watch<'_>,
) -> Result<(), Halt> {
    let pecking = d.length(2, 0)?;
    let feed = d.feed(2, 0)?;
    let allowance = d.length(2, 1)?;
    let (heights, pecks) = contour_heights(m, d, pecking)?;
    let areas = own_areas(m, job, allowance, watch)?;
    let stays = m.settings.rules.contour_pocket.stay_at_clearance;
    let mut trace = m.tracer();
    trace.set_plane(job.plane);
    for outline in areas.iter().flat_map(|area| &area.outlines) {
        watch.spend(pecks.len())?;
        trace.rapid_to(outline.infeed());
        super::drilling::peck(&mut trace, &heights, &pecks, feed, 0.0);
    }
    Ok(finish(trace, stays)?)
}

/// Cycle 16 CONTOUR MILLING: DR+ climb, DR- up-cut with M3 [003:6028-6066].
pub(super) fn contour_milling(
    m: &mut Machining<'_>,
    job: &ContourJob,
    d: &Definition,
    watch: &Watch<'_>,
) -> Result<(), Halt> {
    let pecking = d.length(2, 0)?;
    let plunge_feed = d.feed(2, 0)?;
    let feed = d.feed(2, 1)?;
    let sense = m.modal.spindle.milled(d.sense(2));
    let (heights, pecks) = contour_heights(m, d, pecking)?;
    let areas = own_areas(m, job, 0.0, watch)?;
    let mill = Milling {
        heights,
        plunge_feed,
        feed,
        reversed: sense == Sense::Clockwise,
    };
    let stays = m.settings.rules.contour_pocket.stay_at_clearance;
    let mut trace = m.tracer();
    trace.set_plane(job.plane);
    for area in &areas {
        mill.outlines(&mut trace, &area.outlines, &pecks, watch)?;
    }
    Ok(finish(trace, stays)?)
}

fn contour_heights(
    m: &mut Machining<'_>,
    d: &Definition,
    pecking: f64,
) -> Result<(Heights, Vec<f64>), Fault> {
    let setup = d.length(1, 0)?;
    let depth = d.length(1, 1)?;
    let heights = m.heights(d, [setup, depth], Some(pecking))?;
    Ok((
        heights,
        infeeds(heights.depth, pecking * heights.depth / depth.abs()),
    ))
}

/// The areas of the centre of the tool in use at a finishing allowance.
fn own_areas(
    m: &Machining<'_>,
    job: &ContourJob,
    allowance: f64,
    watch: &Watch<'_>,
) -> Result<Vec<PocketArea>, Halt> {
    let radius = m.modal.used_radius()?;
    areas(job, radius, allowance, m, watch)
}

/// The areas of the centre of a tool of a radius at a finishing allowance, mm.
pub(super) fn areas(
    job: &ContourJob,
    radius: f64,
    allowance: f64,
    m: &Machining<'_>,
    watch: &Watch<'_>,
) -> Result<Vec<PocketArea>, Halt> {
    if radius <= 0.0 {
        return Err(m.modal.no_radius("a contour pocket cannot be milled").into());
    }
    let settings = m.settings;
    let rules = settings.rules.contour_pocket;
    let merge = if rules.merge_programmed {
        Merge::ProgrammedContours
    } else {
        Merge::CentrePaths
    };
    // The finishing allowance is a positive number [003:5508].
    let distance = radius + allowance.abs();
    let Superposition { areas, too_narrow } = Superposition::new(&job.subcontours, distance, merge, watch)?;
    // Compensated one by one, a pocket narrower than the tool would silently stay unmachined.
    if areas.is_empty() || (merge == Merge::CentrePaths && !too_narrow.is_empty()) {
        let detail = "the tool does not fit into a pocket";
        return Err(Fault::new(MessageId::ToolRadiusTooLarge, detail).into());
    }
    Ok(areas)
}

/// Angle in workpiece coordinates of an angle in the programmed plane, degrees.
pub(super) fn plane_direction_of(modal: &Modal, angle_deg: f64) -> f64 {
    let (sin, cos) = (sin_deg(angle_deg), cos_deg(angle_deg));
    bahn_path::angle_deg(plane_direction(modal, [cos, sin]))
}

/// How outlines and passes are milled.
pub(super) struct Milling {
    pub heights: Heights,
    pub plunge_feed: f64,
    pub feed: f64,
    /// Against the sense of the outlines (area on the left).
    pub reversed: bool,
}

impl Milling {
    /// Each outline at all given depths: the tool comes back to the infeed point and is advanced there.
    fn outlines(
        &self,
        trace: &mut Tracer<'_>,
        outlines: &[Outline],
        depths: &[f64],
        watch: &Watch<'_>,
    ) -> Result<(), Halt> {
        for outline in outlines {
            let contour = if self.reversed {
                outline.contour.reversed()
            } else {
                outline.contour.clone()
            };
            trace.enter(&self.heights, contour.start());
            for depth in depths {
                if trace.is_full() {
                    return Ok(());
                }
                watch.spend(contour.segments().len())?;
                trace.feed_height(self.heights.at_depth(*depth), self.plunge_feed);
                self.along(trace, &contour);
            }
            trace.rapid_height(self.heights.clearance);
        }
        Ok(())
    }

    /// Parallel passes at all given depths; where a link would leave the area the tool jumps over the island.
    fn clear(
        &self,
        trace: &mut Tracer<'_>,
        passes: &[Pass],
        depths: &[f64],
        watch: &Watch<'_>,
    ) -> Result<(), Halt> {
        for depth in depths {
            for pass in passes {
                if trace.is_full() {
                    return Ok(());
                }
                watch.spend(1 + pass.link.as_ref().map_or(0, Vec::len))?;
                self.pass(trace, pass, *depth);
            }
            trace.rapid_height(self.heights.clearance);
        }
        Ok(())
    }

    fn pass(&self, trace: &mut Tracer<'_>, pass: &Pass, depth: f64) {
        match &pass.link {
            Some(way) => {
                for segment in way {
                    self.segment(trace, segment);
                }
            }
            None => {
                trace.rapid_height(self.heights.clearance);
                trace.enter(&self.heights, pass.from);
                trace.feed_height(self.heights.at_depth(depth), self.plunge_feed);
            }
        }
        trace.line_to(pass.to, self.feed);
    }

    /// Along a contour at the milling feed.
    pub fn along(&self, trace: &mut Tracer<'_>, contour: &PlaneContour) {
        for segment in contour.segments() {
            self.segment(trace, segment);
        }
    }

    fn segment(&self, trace: &mut Tracer<'_>, segment: &Segment) {
        match *segment {
            Segment::Line { to, .. } => trace.line_to(to, self.feed),
            Segment::Arc {
                to,
                centre,
                sweep_deg,
                ..
            } => {
                trace.arc_to(centre, to, sweep_deg, self.feed);
            }
        }
    }
}

/// Refuses a stepover so small that an area would take more passes than a cycle may have movements.
fn check_passes(area: &PocketArea, stepover: f64) -> Result<(), Fault> {
    const PASSES_MAX: f64 = 50_000.0;
    let Some((min, max)) = area.region.bounding_box() else {
        return Ok(());
    };
    if (max[0] - min[0]).hypot(max[1] - min[1]) / stepover > PASSES_MAX {
        let detail = "the tool is too small to clear an area of this size";
        return Err(Fault::new(MessageId::EntryValueIncorrect, detail));
    }
    Ok(())
}

/// Bit 4 of MP7420: back to the position before the call, or stay at the clearance height
/// [000:6739-6753].
pub(super) fn finish(mut trace: Tracer<'_>, stays: bool) -> Result<(), Fault> {
    if !stays {
        trace.rapid([0.0, 0.0]);
    }
    trace.finish()
}

impl Tracer<'_> {
    /// Above a point where the tool goes down.
    pub fn enter(&mut self, heights: &Heights, point: Point2) {
        self.rapid_to(point);
        if let Some(approach) = heights.approach {
            self.rapid_height(approach);
        }
    }

    pub fn rapid_to(&mut self, point: Point2) {
        self.to(Curve::Line, point, FeedRate::Rapid);
    }

    pub fn line_to(&mut self, point: Point2, feed_mm_min: f64) {
        self.to(Curve::Line, point, FeedRate::Programmed(feed_mm_min));
    }

    pub fn arc_to(&mut self, centre: Point2, point: Point2, sweep_deg: f64, feed_mm_min: f64) {
        let curve = Curve::Arc(Arc {
            plane: self.plane(),
            centre,
            sweep_deg,
        });
        self.to(curve, point, FeedRate::Programmed(feed_mm_min));
    }

    /// A movement to a point in workpiece coordinates.
    fn to(&mut self, curve: Curve, point: Point2, feed: FeedRate) {
        let mut end = self.position();
        self.plane().set(&mut end, point);
        self.movement(curve, end, feed);
    }
}
