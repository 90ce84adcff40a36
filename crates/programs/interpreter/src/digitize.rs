//! TCH PROBE 5, 6 and 7: a surface is digitized into a program [003:6532-6882].
//!
//! Decision: Digitizing goes on in a shifted datum, for which the control has no message: range and points count from
//! there; numbers of blocks begin again with 0 after 65535 (also `program/src/digitized.rs`)

use bahn_parameters::MessageId;
use bahn_path::{
    Axis, Barrier, Curve, FeedRate, Plane, Position, ScanFault, ScanJob, ScanName, ScanPattern, ScanPoint,
    Scanned,
};
use bahn_program::CycleBlock;

use crate::context::Context;
use crate::definition::{Definition, Resolved, resolve};
use crate::error::Fault;
use crate::modal::Modal;
use crate::status::bars_probing;

/// Number of TCH PROBE RANGE; that of MEANDER follows.
const RANGE: u16 = 5;
const MEANDER: u16 = 6;
/// Greatest L.SPAC and P.P.INT, mm [003:6668].
const SPACING_MAX_MM: f64 = 5.0;
/// Least TRAVEL, mm [000:7811].
const TRAVEL_MIN_MM: f64 = 0.1;

/// A block of TCH PROBE 5, 6 or 7. The last one of 6 and 7 scans: see [`begin_scan`].
pub(crate) fn digitize(c: &mut Context<'_>, block: &CycleBlock) -> Result<(), Fault> {
    let words = resolve(block, c.numbers, c.settings)?;
    let (unit, at) = (c.numbers.unit_mm, c.pen.block);
    let digitizing = &mut c.modal.digitizing;
    if block.number == RANGE {
        digitizing.range.take(RANGE, block.sub, words, unit, at);
        return Ok(());
    }
    digitizing.pattern.take(block.number, block.sub, words, unit, at);
    let last = if block.number == MEANDER { 2 } else { 3 };
    if block.sub == last { define(c) } else { Ok(()) }
}

/// All blocks are there: what is to be scanned.
fn define(c: &mut Context<'_>) -> Result<(), Fault> {
    if let Some(message) = bars_probing(&c.modal.frame) {
        return Err(Fault::new(message, "transformations are reset before digitizing"));
    }
    if c.modal.frame.turns() {
        return Err(Fault::new(
            MessageId::RotationNotPermitted,
            "a basic rotation is active",
        ));
    }
    c.modal.digitizing.wanted = Some(job(c)?);
    Ok(())
}

/// The scan that a block has defined, if it has.
pub(crate) fn begin_scan(c: &mut Context<'_>, job: ScanJob) -> Result<(), Fault> {
    c.pen.finish_contour()?;
    approach(c, &job);
    let block = c.pen.block;
    c.modal.digitizing.scan = Some((block, job));
    c.pen.out.barrier(Barrier::Scan { block, job });
    Ok(())
}

/// What the blocks say.
fn job(c: &Context<'_>) -> Result<ScanJob, Fault> {
    let digitizing = &c.modal.digitizing;
    let faulty = |what: &str| Fault::new(MessageId::FaultyRangeData, what);
    let incomplete = || Fault::new(MessageId::CyclIncomplete, "blocks of the cycle are missing");
    if digitizing.range.is_empty() {
        return Err(faulty("TCH PROBE 5 RANGE is missing"));
    }
    let range = digitizing.range.ready().ok_or_else(incomplete)?;
    let pattern = digitizing.pattern.ready().ok_or_else(incomplete)?;
    let tool_axis = first_axis(range.block(2)).ok_or_else(incomplete)?;
    if tool_axis != c.modal.plane.normal {
        let detail = format!("{tool_axis} is not the axis of the probe");
        return Err(Fault::new(MessageId::WrongAxisProgrammed, detail));
    }
    let shift = [Axis::X, Axis::Y, Axis::Z].map(|axis| c.modal.frame.shift[axis]);
    let corner = |sub| point(range, sub, c, &shift).ok_or_else(incomplete);
    let (min, max) = (corner(2)?, corner(3)?);
    if min.iter().zip(&max).any(|(min, max)| min >= max) {
        return Err(faulty("MIN must lie below MAX in X, Y and Z"));
    }
    let height = range.length(4, 0)? + shift.get(tool_axis.index()).copied().unwrap_or(0.0);
    if max.get(tool_axis.index()).is_none_or(|max| height < *max) {
        return Err(faulty("HEIGHT lies below MAX"));
    }
    // The stylus stands on the height between its lines.
    let mut highest = max;
    if let Some(value) = highest.get_mut(tool_axis.index()) {
        *value = height;
    }
    if let Some(axis) = [min, highest]
        .iter()
        .find_map(|at| beyond_limits(c, at, tool_axis))
    {
        return Err(faulty(&format!("the range leaves the traverse range of {axis}")));
    }
    let (pattern, last) = match pattern.number {
        MEANDER => (meander(pattern, tool_axis)?, 2),
        _ => (contour_lines(pattern, c, tool_axis, [&min, &max], &shift)?, 3),
    };
    let cycle = digitizing.pattern.ready().ok_or_else(incomplete)?;
    let [travel, spacing, interval] = [
        cycle.length(last, 0)?,
        cycle.length(last, 1)?,
        cycle.length(last, 2)?,
    ];
    let entry = |what: String| Err(Fault::new(MessageId::EntryValueIncorrect, what));
    if travel < TRAVEL_MIN_MM {
        return entry(format!("TRAVEL is at least {TRAVEL_MIN_MM} mm"));
    }
    let spaced = spacing.abs() <= SPACING_MAX_MM && interval <= SPACING_MAX_MM;
    let signed = matches!(pattern, ScanPattern::ContourLines { .. });
    if !spaced || spacing == 0.0 || spacing < 0.0 && !signed || interval <= 0.0 {
        return entry(format!(
            "L.SPAC and P.P.INT are greater than 0 and at most {SPACING_MAX_MM} mm"
        ));
    }
    let rules = &c.settings.rules;
    // A test run knows of no calibration: the probe is the tool that was called (inferred).
    let keeps = rules.probe_keeps_tool || !c.settings.machine;
    let tool = c.modal.tool.filter(|tool| keeps && tool.radius > 0.0);
    Ok(ScanJob {
        tool_axis,
        min,
        max,
        shift,
        clearance_mm: height,
        pattern,
        travel_mm: travel,
        spacing_mm: spacing,
        interval_mm: interval,
        stylus_radius_mm: tool.map_or(rules.probe.radius_mm, |tool| tool.radius),
        beside: beside(c),
        inch: c.numbers.unit_mm != 1.0,
        program: file_name(range)?,
        rules: rules.scan,
    })
}

/// How far the ball stands beside the spindle; a test run has its tools in the middle.
fn beside(c: &Context<'_>) -> ScanPoint {
    let mut beside = Position::ZERO;
    if c.settings.machine {
        c.modal.plane.set(&mut beside, c.settings.rules.probe.offset_mm);
    }
    [Axis::X, Axis::Y, Axis::Z].map(|axis| beside[axis])
}

/// The first axis whose software limit lies before a point of the range [003:8050]; none where nobody knows the datum.
fn beyond_limits(c: &Context<'_>, point: &ScanPoint, tool_axis: Axis) -> Option<Axis> {
    let rules = &c.settings.rules;
    let [least, greatest] = &rules.traverse;
    let length = c.modal.tool.map_or(0.0, |tool| tool.shape.length);
    let mut axes = [Axis::X, Axis::Y, Axis::Z].into_iter().zip(point);
    let beyond = axes.find(|(axis, value)| {
        let length = if *axis == tool_axis { length } else { 0.0 };
        let machine = **value + length - rules.machine_zero[*axis];
        machine < least[*axis] || machine > greatest[*axis]
    });
    beyond.map(|(axis, _)| axis)
}

fn meander(cycle: &Definition, tool_axis: Axis) -> Result<ScanPattern, Fault> {
    match first_axis(cycle.block(1)) {
        Some(line) if is_in_plane(line, tool_axis) => Ok(ScanPattern::Meander { line }),
        Some(line) => Err(Fault::new(
            MessageId::WrongAxisProgrammed,
            format!("lines cannot go along {line}"),
        )),
        None => Err(Fault::new(MessageId::CyclIncomplete, "DIRECTN is missing")),
    }
}

fn contour_lines(
    cycle: &Definition,
    c: &Context<'_>,
    tool_axis: Axis,
    [min, max]: [&ScanPoint; 2],
    shift: &ScanPoint,
) -> Result<ScanPattern, Fault> {
    let fault = |message, detail: &str| Err(Fault::new(message, detail));
    let mut start = *min;
    let mut given = Vec::new();
    for word in cycle.block(1) {
        if let Resolved::Coordinate { axis, value, .. } = word {
            if given.contains(axis) {
                return fault(
                    MessageId::AxisDoubleProgrammed,
                    "the starting point has one axis twice",
                );
            }
            if !is_in_plane(*axis, tool_axis) {
                return fault(
                    MessageId::PlaneWronglyDefined,
                    "the starting point lies in the working plane",
                );
            }
            given.push(*axis);
            if let (Some(at), Some(shift)) = (start.get_mut(axis.index()), shift.get(axis.index())) {
                *at = value * c.numbers.unit_mm + shift;
            }
        }
    }
    if given.len() < 2 {
        return fault(
            MessageId::CyclIncomplete,
            "STARTING POINT needs both axes of the plane",
        );
    }
    if start
        .iter()
        .zip(min.iter().zip(max))
        .any(|(at, (min, max))| at < min || at > max)
    {
        return fault(
            MessageId::StartPositionIncorrect,
            "the starting point lies outside of the range",
        );
    }
    let directions: Vec<(Axis, f64)> = cycle.block(2).iter().filter_map(direction).collect();
    let [approach, along] = directions.as_slice() else {
        return fault(MessageId::CyclIncomplete, "ORDER needs two directions");
    };
    if approach.0 == along.0 || !is_in_plane(approach.0, tool_axis) || !is_in_plane(along.0, tool_axis) {
        return fault(
            MessageId::WrongAxisProgrammed,
            "ORDER needs both axes of the plane",
        );
    }
    Ok(ScanPattern::ContourLines {
        start,
        approach: *approach,
        direction: *along,
        // Seconds (inferred): no manual names the unit.
        time_limit_s: cycle.number(1, 0)?,
    })
}

fn direction(word: &Resolved) -> Option<(Axis, f64)> {
    match word {
        Resolved::AxisDirection(axis, direction) => Some((*axis, direction.sign())),
        _ => None,
    }
}

fn is_in_plane(axis: Axis, tool_axis: Axis) -> bool {
    Plane::of_tool_axis(tool_axis).is_some_and(|plane| plane.contains(axis)) && axis != tool_axis
}

fn first_axis(words: &[Resolved]) -> Option<Axis> {
    words.iter().find_map(|word| match word {
        Resolved::Axis(axis) => Some(*axis),
        _ => None,
    })
}

/// A point with all three axes, mm.
fn point(cycle: &Definition, sub: u16, c: &Context<'_>, shift: &ScanPoint) -> Option<ScanPoint> {
    let mut point = [None; 3];
    for word in cycle.block(sub) {
        if let Resolved::Coordinate { axis, value, .. } = word {
            *point.get_mut(axis.index())? = Some(value * c.numbers.unit_mm + shift.get(axis.index())?);
        }
    }
    let [x, y, z] = point;
    Some([x?, y?, z?])
}

/// The name of the program: letters, digits and what else stands in names of files on every medium.
fn file_name(range: &Definition) -> Result<ScanName, Fault> {
    let name: String = range.block(1).iter().filter_map(Resolved::as_name).collect();
    ScanName::new(&name)
        .ok_or_else(|| Fault::new(MessageId::EntryValueIncorrect, "PGM NAME is no name of a program"))
}

/// First in the axis of the probe to clearance height, then above where the scan begins [003:6640] [003:6716].
fn approach(c: &mut Context<'_>, job: &ScanJob) {
    let feed = FeedRate::Programmed(job.rules.rapid_mm_min);
    let tip = job.begin();
    let begin = std::array::from_fn(|k| tip[k] - job.beside[k]);
    let begin = at(c.modal, &begin);
    let mut above = c.modal.actual;
    above[job.tool_axis] = begin[job.tool_axis];
    travel(c, &[above, begin], feed);
}

fn travel(c: &mut Context<'_>, stations: &[Position], feed: FeedRate) {
    for end in stations {
        let start = c.modal.actual;
        if start != *end {
            let element = c.pen.element(Curve::Line, start, *end, feed);
            c.pen.out.push(element, None);
        }
        c.modal.actual = *end;
        c.modal.nominal = *end;
    }
    c.pen.since_motion = 0;
    c.modal.last_move = None;
}

fn at(modal: &Modal, point: &ScanPoint) -> Position {
    let mut position = modal.actual;
    for (axis, value) in [Axis::X, Axis::Y, Axis::Z].into_iter().zip(point) {
        position[axis] = *value;
    }
    position
}

/// The scan is over: it ends at clearance height, contour lines above their starting point [003:6675] [003:6744].
pub(crate) fn finish_scan(c: &mut Context<'_>, scanned: Option<Scanned>) -> Result<(), Fault> {
    let scan = c.modal.digitizing.scan.take();
    let (Some(scan), Some(scanned)) = (scan, scanned) else {
        return Ok(());
    };
    let (tip, beside) = (scanned.at, scan.1.beside);
    let here = at(c.modal, &std::array::from_fn(|k| tip[k] - beside[k]));
    c.modal.actual = here;
    c.modal.nominal = here;
    if let Some(fault) = scanned.fault {
        return Err(message(fault).into());
    }
    Ok(())
}

fn message(fault: ScanFault) -> MessageId {
    match fault {
        ScanFault::AlreadyInContact => MessageId::StylusAlreadyInContact,
        ScanFault::Inaccessible => MessageId::TouchPointInaccessible,
        ScanFault::RangeExceeded => MessageId::RangeExceeded,
        ScanFault::TimeLimit => MessageId::TimeLimitExceeded,
        ScanFault::DeflectionExceedsMax => MessageId::StylusDeflectionExceedsMax,
        ScanFault::CannotRetract | ScanFault::NotReady => MessageId::ProbeSystemNotReady,
        ScanFault::MemoryFull => MessageId::FurtherProgramEntryImpossible,
    }
}
