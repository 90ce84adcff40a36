//! Cycles 21 to 24: pilot drilling, rough-out, floor and side finishing of the contours of cycle 14 with the data of
//! cycle 20 (later controls). Areas, passes and MP7420 are those of cycles 6, 15 and 16.
//!
//! Decision: Cycles 22 and 23 clear as cycle 6 does, the first axis along, and reach the depth straight down; Q19 has
//! no effect. Cycle 24 touches the middle of the longest element on quarter circles of the tool's radius, or less
//! where there is no room

use bahn_parameters::MessageId;
use bahn_path::Point2;
use bahn_path::region::{Contour, Effort, Outline, PocketArea, RESOLUTION_MM, Region, Segment};

use super::contour_data::Values;
use super::contour_pocket::{
    ContourJob, Halt, Milling, Watch, areas, clear_areas, finish, plane_direction_of,
};
use super::drilling::peck;
use super::machining::{Heights, Machining, Tracer, infeeds};
use crate::context::Context;
use crate::definition::Definition;
use crate::error::Fault;
use crate::modal::Modal;
use crate::status::Spindle;

/// What the cycles work with, mm and mm/min.
struct Data {
    heights: Heights,
    overlap: f64,
    /// Q3, from cycle 24 on Q14.
    side_allowance: f64,
    floor_allowance: f64,
    corner_radius: f64,
    climb: bool,
    plunging: f64,
    plunge_feed: f64,
    feed: f64,
}

impl Data {
    fn of(values: &Values<'_>, modal: &Modal, d: &Definition) -> Result<Data, Fault> {
        let overlap = values.number(2)?;
        if !(overlap > 0.0 && overlap < 2.0) {
            let detail = "the tool path overlap Q2 lies between 0 and 2";
            return Err(Fault::new(MessageId::EntryValueIncorrect, detail));
        }
        let heights = values.heights(modal, values.length(6)?)?;
        let scale = modal.frame.scale(modal.plane.normal);
        let floor_allowance = values.length(4)?.abs() * scale;
        if floor_allowance >= heights.depth {
            let detail = "the allowance for the floor Q4 leaves no depth";
            return Err(Fault::new(MessageId::EntryValueIncorrect, detail));
        }
        let plunging = match d.number {
            23 => heights.depth,
            _ => values.plunging()? * scale,
        };
        Ok(Data {
            heights,
            overlap,
            side_allowance: values.length(if d.number == 24 { 14 } else { 3 })?,
            floor_allowance,
            corner_radius: values.length(8)?.abs(),
            climb: (values.number(9)? > 0.0) != (modal.spindle == Spindle::CounterClockwise),
            plunging,
            plunge_feed: values.feed(11)?,
            feed: if d.number == 21 { 0.0 } else { values.feed(12)? },
        })
    }

    fn milling(&self) -> Milling {
        Milling {
            heights: self.heights,
            plunge_feed: self.plunge_feed,
            feed: self.feed,
            reversed: !self.climb,
        }
    }

    /// The areas of the centre of a tool, with Q8 in their inside corners.
    fn areas(
        &self,
        m: &Machining<'_>,
        job: &ContourJob,
        radius: f64,
        watch: &Watch<'_>,
    ) -> Result<Vec<PocketArea>, Halt> {
        let areas = areas(job, radius, self.side_allowance, m, watch)?;
        if self.corner_radius == 0.0 {
            return Ok(areas);
        }
        let mut rounded = Vec::new();
        for area in &areas {
            let inner = area.region.offset_within(-self.corner_radius, watch)?;
            rounded.extend(parts(&inner.offset_within(self.corner_radius, watch)?, area));
        }
        if rounded.is_empty() {
            let detail = "the rounding radius Q8 does not fit into the pocket";
            return Err(Fault::new(MessageId::RoundingRadiusTooLarge, detail).into());
        }
        Ok(rounded)
    }
}

/// The connected parts of a region that lies in an area, each outline from near an infeed point of the area.
fn parts(region: &Region, area: &PocketArea) -> Vec<PocketArea> {
    let outline = |contour: &Contour| {
        let gap = |outline: &&Outline| contour.distance(outline.infeed());
        let nearest = area.outlines.iter().min_by(|a, b| gap(a).total_cmp(&gap(b)));
        let infeed = nearest.map_or(contour.start(), Outline::infeed);
        Outline {
            contour: contour.starting_near(infeed),
            leader: nearest.map_or(0, |outline| outline.leader),
            members: nearest.map_or_else(Vec::new, |outline| outline.members.clone()),
        }
    };
    let part = |region: Region| PocketArea {
        outlines: region.contours().iter().map(outline).collect(),
        region,
    };
    region.parts().map(part).collect()
}

/// Runs cycle 21, 22, 23 or 24.
pub(super) fn contour_data_cycle(
    c: &mut Context<'_>,
    job: &ContourJob,
    d: &Definition,
    watch: &Watch<'_>,
) -> Result<(), Halt> {
    let values = Values {
        numbers: c.numbers,
        settings: c.settings,
    };
    let data = Data::of(&values, c.modal, d)?;
    let mut m = Machining::new(c);
    match d.number {
        21 => drill(&mut m, job, &data, watch),
        22 => rough(&mut m, job, &data, watch),
        23 => floor(&mut m, job, &data, watch),
        _ => sides(&mut m, job, &data, watch),
    }
}

/// Cycle 21: pecks at each infeed point of the rough-out tool Q13, down to the allowance of the floor.
fn drill(m: &mut Machining<'_>, job: &ContourJob, data: &Data, watch: &Watch<'_>) -> Result<(), Halt> {
    let radius = job.other_radius.unwrap_or(0.0);
    let areas = data.areas(m, job, radius, watch)?;
    let heights = data.heights;
    let depth = heights.depth - data.floor_allowance;
    let pecks = infeeds(depth, data.plunging);
    let from_approach = Heights {
        clearance: heights.approach.unwrap_or(heights.clearance),
        depth,
        ..heights
    };
    let stays = m.settings.rules.contour_pocket.stay_at_clearance;
    let mut trace = m.tracer();
    trace.set_plane(job.plane);
    trace.lift(&heights);
    for outline in areas.iter().flat_map(|area| &area.outlines) {
        watch.spend(pecks.len())?;
        trace.enter(&heights, outline.infeed());
        peck(&mut trace, &from_approach, &pecks, data.plunge_feed, 0.0);
        trace.rapid_height(heights.clearance);
    }
    Ok(finish(trace, stays)?)
}

/// Cycle 22: channels and passes along the first axis of the plane, Q2 of the radius apart (pattern inferred: that of
/// cycle 6). After a coarse tool Q18 only what that one could not reach.
fn rough(m: &mut Machining<'_>, job: &ContourJob, data: &Data, watch: &Watch<'_>) -> Result<(), Halt> {
    let radius = m.modal.used_radius()?;
    let mut areas = data.areas(m, job, radius, watch)?;
    if let Some(coarse) = job.other_radius {
        areas = left_by(&areas, radius, coarse, data, job, m, watch)?;
    }
    let pecks = infeeds(data.heights.depth - data.floor_allowance, data.plunging);
    let passes = (plane_direction_of(m.modal, 0.0), radius * data.overlap);
    clear_areas(m, job.plane, (&areas, &data.milling()), passes, &pecks, watch)
}

/// Where a tool must still go after a coarser one.
fn left_by(
    areas: &[PocketArea],
    radius: f64,
    coarse: f64,
    data: &Data,
    job: &ContourJob,
    m: &Machining<'_>,
    watch: &Watch<'_>,
) -> Result<Vec<PocketArea>, Halt> {
    /// What is thinner was cut: both tools touch the same contours, mm.
    const CUT_MM: f64 = 0.001;
    let cleared = match data.areas(m, job, coarse, watch) {
        Ok(cleared) => cleared,
        // It fits nowhere, and all is left.
        Err(Halt::Fault(fault)) if fault.is(MessageId::ToolRadiusTooLarge) => return Ok(areas.to_vec()),
        Err(halt) => return Err(halt),
    };
    let mut swept = Vec::with_capacity(cleared.len());
    for area in &cleared {
        swept.push(area.region.offset_within(coarse, watch)?);
    }
    let mut left = Vec::new();
    for area in areas {
        let reached = area.region.offset_within(radius, watch)?;
        let regions: Vec<&Region> = std::iter::once(&reached).chain(&swept).collect();
        let only_here = |inside: &[bool]| {
            inside
                .split_first()
                .is_some_and(|(own, others)| *own && !others.contains(&true))
        };
        let rest = Region::combine_within(&regions, &only_here, watch)?;
        let rest = rest.offset_within(-CUT_MM, watch)?.offset_within(CUT_MM, watch)?;
        let around = rest.offset_within(radius, watch)?;
        let both = |inside: &[bool]| !inside.contains(&false);
        let wanted = Region::combine_within(&[&area.region, &around], &both, watch)?;
        left.extend(parts(&wanted, area));
    }
    Ok(left)
}

/// Cycle 23: the floor at the milling depth, beside the allowance of the sides.
fn floor(m: &mut Machining<'_>, job: &ContourJob, data: &Data, watch: &Watch<'_>) -> Result<(), Halt> {
    let radius = m.modal.used_radius()?;
    let areas = data.areas(m, job, radius, watch)?;
    let passes = (plane_direction_of(m.modal, 0.0), radius * data.overlap);
    let depths = [data.heights.depth];
    clear_areas(m, job.plane, (&areas, &data.milling()), passes, &depths, watch)
}

/// Cycle 24: each outline, reached and left on an arc where there is room for one, beside the allowance Q14.
fn sides(m: &mut Machining<'_>, job: &ContourJob, data: &Data, watch: &Watch<'_>) -> Result<(), Halt> {
    let radius = m.modal.used_radius()?;
    let areas = data.areas(m, job, radius, watch)?;
    let pecks = infeeds(data.heights.depth, data.plunging);
    let mill = data.milling();
    let stays = m.settings.rules.contour_pocket.stay_at_clearance;
    let mut trace = m.tracer();
    trace.set_plane(job.plane);
    trace.lift(&data.heights);
    for area in &areas {
        for outline in &area.outlines {
            side(&mut trace, &mill, area, &outline.contour, radius, &pecks, watch)?;
        }
    }
    Ok(finish(trace, stays)?)
}

fn side(
    trace: &mut Tracer<'_>,
    mill: &Milling,
    area: &PocketArea,
    outline: &Contour,
    radius: f64,
    pecks: &[f64],
    watch: &Watch<'_>,
) -> Result<(), Halt> {
    let touch = Touch::new(&area.region, outline, radius, mill.reversed);
    let contour = outline.starting_near(touch.at);
    let contour = if mill.reversed {
        contour.reversed()
    } else {
        contour
    };
    trace.enter(&mill.heights, touch.from);
    for depth in pecks {
        if trace.is_full() {
            return Ok(());
        }
        watch.spend(contour.segments().len())?;
        trace.line_to(touch.from, mill.feed);
        trace.feed_height(mill.heights.at_depth(*depth), mill.plunge_feed);
        touch.arc(trace, touch.at, mill);
        mill.along(trace, &contour);
        touch.arc(trace, touch.to, mill);
    }
    trace.rapid_height(mill.heights.clearance);
    Ok(())
}

/// Where an outline is reached and left: two quarter circles in the area that touch it in the middle of its longest
/// element; of the radius of the tool, or a half, a quarter, an eighth of it as there is room, else none (inferred).
struct Touch {
    at: Point2,
    centre: Point2,
    from: Point2,
    to: Point2,
    sweep_deg: f64,
}

impl Touch {
    fn new(region: &Region, outline: &Contour, radius: f64, reversed: bool) -> Touch {
        let longer = |a: Segment, b: &Segment| {
            if b.length() > a.length() + RESOLUTION_MM {
                *b
            } else {
                a
            }
        };
        let mut segments = outline.segments().iter();
        let longest = segments.next().map(|first| segments.fold(*first, longer));
        let at = longest.map_or(outline.start(), |segment| segment.point(0.5));
        let [x, y] = longest.map_or([0.0, 0.0], |segment| segment.tangent(0.5));
        let point =
            |along: f64, inwards: f64| [at[0] + along * x - inwards * y, at[1] + along * y + inwards * x];
        let fits = |r: &f64| {
            let centre = point(0.0, *r);
            region.contains(centre) && region.boundary_distance(centre) >= r - RESOLUTION_MM
        };
        let r = [1.0, 0.5, 0.25, 0.125]
            .map(|part| part * radius)
            .into_iter()
            .find(fits)
            .unwrap_or(0.0);
        let sign = if reversed { -1.0 } else { 1.0 };
        Touch {
            at,
            centre: point(0.0, r),
            from: point(-sign * r, r),
            to: point(sign * r, r),
            sweep_deg: sign * 90.0,
        }
    }

    fn arc(&self, trace: &mut Tracer<'_>, to: Point2, mill: &Milling) {
        if self.centre != self.at {
            trace.arc_to(self.centre, to, self.sweep_deg, mill.feed);
        }
    }
}
