//! Positioning blocks: from words to a movement in workpiece coordinates.
//!
//! Decision: Without `--datum` and MP960 nobody knows where M91 leads: the axes leave the workpiece and have no
//! position until they are programmed
//!
//! Decision: Axes that a block does not program keep their position when a transformation changes
//!
//! Decision: R+ and R- in a block of the tool axis or a rotary axis, and a call with the 5th axis as tool axis, are
//! WRONG AXIS PROGRAMMED (also `interpreter/src/tools.rs`)

use bahn_parameters::MessageId;
use bahn_parameters::equipment::Behaviour;
use bahn_path::{Arc, Axis, AxisSet, Curve, FeedRate, Frame, Position};
use bahn_program::{Compensation, Coordinates, Feed, Motion, MotionKind};

use crate::availability::{Feature, words};
use crate::block_functions::{BlockFunctions, Reference};
use crate::context::Context;
use crate::error::{Cause, Fault, WarningKind};
use crate::flow::Flow;
use crate::functions::take_m_functions;
use crate::modal::{LastMove, Modal};
use crate::normals::displacement;
use crate::numbers::{Numbers, known};
use crate::path_functions::{Programmed, programmed};
use crate::pen::Pen;
use crate::q_parameters::{QTable, preassigned};
use crate::settings::Settings;
use crate::status::Way;
use crate::surface_feed::surface_feed;
use crate::tilting::{stands_as_defined, take_way};
use crate::unrolled::unrolled;

/// L, C, CR, CT, LP, CP, CTP and paraxial blocks; with it whether the block calls the cycle after its movement.
#[inline]
pub(crate) fn positioning(mut c: Context<'_>, motion: &Motion) -> Result<(Flow, bool), Fault> {
    if is_short_way(c.modal, c.pen, motion) {
        return Ok((short_line(&mut c, motion)?, false));
    }
    any_positioning(c, motion)
}

fn any_positioning(mut c: Context<'_>, motion: &Motion) -> Result<(Flow, bool), Fault> {
    if motion.kind == MotionKind::Paraxial && c.settings.rules.paraxial_inhibited {
        let detail = "MP7246 disables paraxial positioning blocks";
        return Err(Fault::new(MessageId::BlockNotKnown, detail));
    }
    if motion.kind == MotionKind::LineNormal && !c.executes(Feature::Word(words::NORMALS))? {
        return Ok((Flow::Next, false));
    }
    take_compensation(c.modal, &mut c.numbers.q, motion)?;
    if c.pen.recording.is_some() {
        return Ok((record(&mut c, motion)?, false));
    }
    let functions = if motion.m.is_empty() && !c.modal.cycle_after_each_block {
        BlockFunctions::default()
    } else {
        take_m_functions(&mut c, &motion.m)?
    };
    let feed = take_feed(c.modal, c.numbers, c.settings, motion.feed)?;
    let cycle_call = functions.cycle_call;
    let flow = movement(&mut c, motion, functions, feed)?;
    Ok((flow, cycle_call))
}

/// Whether a block is a straight line in absolute numbers that nothing in force changes and nothing
/// that follows refers to: the most frequent block by far, and worth a way of its own.
#[inline]
fn is_short_way(modal: &Modal, pen: &Pen, motion: &Motion) -> bool {
    let coordinates = &motion.coordinates;
    motion.kind == MotionKind::Line
        && pen.line_follows
        && modal.corner_arcs.is_none()
        && motion.m.is_empty()
        && matches!(motion.compensation, None | Some(Compensation::Off))
        && modal.compensation == Compensation::Off
        && modal.paraxial == Compensation::Off
        && coordinates.incremental().is_empty()
        && coordinates.parameters().is_empty()
        && !coordinates.is_empty()
        && !modal.cycle_after_each_block
        && modal.plunge_factor.is_none()
        && pen.recording.is_none()
        && modal.frame.is_identity()
        && modal.tilting.way == Way::Programmed
        && !modal.tilting.surface_feed
        && modal.tilting.plane.is_none()
        && pen.contour.is_idle()
}

/// The short way of [`is_short_way`]: same result as the long one.
#[inline]
fn short_line(c: &mut Context<'_>, motion: &Motion) -> Result<Flow, Fault> {
    let Some(feed) = take_feed(c.modal, c.numbers, c.settings, motion.feed)? else {
        return Err(MessageId::FeedRateIsMissing.into());
    };
    let start = c.modal.actual;
    let numbers = motion.coordinates.numbers();
    let axes = motion.coordinates.axes();
    for axis in axes.iter() {
        let value = numbers[axis] * c.numbers.axis_unit(axis);
        c.modal.nominal[axis] = value;
        c.modal.actual[axis] = value;
    }
    check_axes(c, axes)?;
    check_range(c.settings, &c.modal.actual, axes)?;
    if c.modal.contour_plane != c.modal.plane || !axes.intersection(PARALLEL_AXES).is_empty() {
        c.modal.take_contour_axes(axes);
    }
    c.modal.last_move = None;
    c.modal.increments_from = None;
    c.pen.contour.release(&mut c.pen.out);
    let end = c.modal.actual;
    c.pen.note_motion(Curve::Line, &start, &end);
    let element = c.pen.element(Curve::Line, start, c.modal.actual, feed);
    c.pen.out.push(element, None);
    Ok(Flow::Next)
}

/// A block of a contour subprogram: only its geometry counts.
fn record(c: &mut Context<'_>, motion: &Motion) -> Result<Flow, Fault> {
    /// Stands for the feed that is ignored.
    const ANY_FEED: FeedRate = FeedRate::Programmed(1.0);
    if let Some(axes) = &mut c.pen.recording
        && axes.is_empty()
    {
        *axes = motion.coordinates.axes();
    }
    if c.modal.surface.is_some() {
        let motion = unrolled(c, motion)?;
        return movement(c, &motion, BlockFunctions::default(), Some(ANY_FEED));
    }
    movement(c, motion, BlockFunctions::default(), Some(ANY_FEED))
}

fn movement(
    c: &mut Context<'_>,
    motion: &Motion,
    functions: BlockFunctions,
    feed: Option<FeedRate>,
) -> Result<Flow, Fault> {
    let plain = motion.kind == MotionKind::Line
        && functions.reference == Reference::Datum
        && motion.coordinates.parameters().is_empty()
        && c.modal.frame.is_identity();
    let mut programmed = if plain {
        plain_line(c.modal, c.numbers, &motion.coordinates)
    } else if functions.reference != Reference::Datum {
        return referenced_line(c, motion, functions, feed);
    } else {
        programmed(c.modal, c.numbers, c.settings, motion)?
    };
    if programmed.axes.is_empty() {
        return c.pen.hold(c.modal, functions);
    }
    let Programmed { from, to, .. } = &mut programmed;
    take_way(c.modal, c.settings, &motion.coordinates, from, to);
    c.modal.increments_from = None;
    let Some(feed) = feed else {
        return Err(MessageId::FeedRateIsMissing.into());
    };
    check_axes(c, programmed.axes)?;
    check_range(c.settings, &programmed.to, programmed.axes)?;
    c.modal.last_move = Some(LastMove {
        curve: programmed.curve,
        start: programmed.from,
        end: programmed.to,
    });
    let (axes, nominal, curve) = if plain {
        (programmed.axes, programmed.to, programmed.curve)
    } else {
        to_workpiece(c.modal, &programmed)?
    };
    let beside = match &motion.normal {
        Some(normal) => Beside::Surface(displacement(c, normal)?),
        None if motion.kind == MotionKind::Paraxial => Beside::Paraxial(c.modal.paraxial),
        None => Beside::Nothing,
    };
    emit_movement(c, curve, nominal, axes, beside, feed, functions)
}

/// The fast way of most blocks: a straight line in plain numbers without transformations.
#[inline]
fn plain_line(modal: &Modal, numbers: &Numbers, coordinates: &Coordinates) -> Programmed {
    let from = modal.nominal;
    let mut to = from;
    let axes = coordinates.axes();
    let values = coordinates.numbers();
    for axis in axes.iter() {
        let value = values[axis] * numbers.axis_unit(axis);
        to[axis] = if coordinates.incremental().contains(axis) {
            known(modal.increments_from.unwrap_or(from)[axis]) + value
        } else {
            value
        };
    }
    Programmed {
        from,
        to,
        axes,
        curve: Curve::Line,
    }
}

/// M91, M92, M93: the coordinates refer to machine zero, machine datum or current position, whatever
/// transformations are active [003:3533-3553] [003:7479-7481].
fn referenced_line(
    c: &mut Context<'_>,
    motion: &Motion,
    functions: BlockFunctions,
    feed: Option<FeedRate>,
) -> Result<Flow, Fault> {
    if !matches!(motion.kind, MotionKind::Line | MotionKind::Paraxial) {
        return Err(Fault::new(
            MessageId::EntryValueIncorrect,
            "M91 to M93 act on straight lines",
        ));
    }
    if functions.reference != Reference::Position && c.pen.placement.is_some() {
        // [000:4268]; while swivel axes are compensated (inferred).
        let detail = "M91 and M92 do not act under cycle 19 and M114";
        return Err(Fault::new(MessageId::PlaneWronglyDefined, detail));
    }
    let mut nominal = c.modal.nominal;
    for (axis, word) in motion.coordinates.iter() {
        let value = c.numbers.q.value(word.value)? * c.numbers.axis_unit(axis);
        // Machine coordinates are those of the spindle nose, not of the tool's tip (inferred: a position
        // for tool changes must not depend on the tool).
        let length = match c.modal.tool {
            Some(tool) if tool.axis == axis => tool.shape.length,
            _ => 0.0,
        };
        let zero = c.settings.rules.machine_zero[axis] - length;
        if c.settings.machine && zero.is_nan() && functions.reference != Reference::Position {
            // On a machine its coordinates are known only after the reference marks [000:4568-4576].
            return Err(Fault::new(
                MessageId::ProgramStartUndefined,
                format!("{axis} has not passed its reference mark"),
            ));
        }
        nominal[axis] = match functions.reference {
            _ if word.incremental => known(nominal[axis]) + value,
            Reference::MachineZero => zero + value,
            Reference::MachineDatum => zero + c.settings.rules.machine_datum[axis] + value,
            Reference::Position | Reference::Datum => known(c.modal.actual[axis]) + value,
        };
    }
    let axes = motion.coordinates.axes();
    if axes.is_empty() {
        return c.pen.hold(c.modal, functions);
    }
    let Some(feed) = feed else {
        return Err(MessageId::FeedRateIsMissing.into());
    };
    check_axes(c, axes)?;
    c.modal.last_move = None;
    let placed = nominal.known().intersection(axes);
    check_range(c.settings, &nominal, placed)?;
    if placed != axes {
        return leave_workpiece(c, nominal, axes, feed, functions);
    }
    emit_movement(c, Curve::Line, nominal, axes, Beside::Nothing, feed, functions)
}

/// A movement to a place of the machine when nobody has said where the workpiece lies in it: the axes have
/// no position until they are programmed again (inferred).
fn leave_workpiece(
    c: &mut Context<'_>,
    nominal: Position,
    axes: AxisSet,
    feed: FeedRate,
    functions: BlockFunctions,
) -> Result<Flow, Fault> {
    if !std::mem::replace(&mut c.reported.machine_zero, true) {
        c.warn(WarningKind::MachineZeroUnknown);
    }
    c.pen.finish_contour()?;
    let start = c.pen.tool_centre(c.modal);
    let mut end = start;
    for axis in axes.iter() {
        end[axis] = nominal[axis];
    }
    (c.modal.nominal, c.modal.actual) = (nominal, end);
    let element = c.pen.element(Curve::Line, start, end, feed);
    c.pen.push(c.modal, element, functions, false)
}

/// Transforms a movement into workpiece coordinates. Axes that are neither programmed nor turned by
/// the rotation keep their number to the last bit.
fn to_workpiece(modal: &Modal, p: &Programmed) -> Result<(AxisSet, Position, Curve), Fault> {
    let frame = &modal.frame;
    let mut axes = p.axes;
    let mut to = p.to;
    let turned = AxisSet::EMPTY.with(frame.plane.first).with(frame.plane.second);
    if frame.turns() && !axes.intersection(turned).is_empty() {
        axes = axes.union(turned);
        for axis in turned.iter() {
            to[axis] = known(to[axis]);
        }
    }
    let outer = frame.to_outer(&to);
    let mut nominal = modal.nominal;
    for axis in axes.iter() {
        nominal[axis] = outer[axis];
    }
    let curve = match p.curve {
        Curve::Arc(arc) => Curve::Arc(arc_to_workpiece(frame, &arc)?),
        other => other,
    };
    Ok((axes, nominal, curve))
}

fn arc_to_workpiece(frame: &Frame, arc: &Arc) -> Result<Arc, Fault> {
    let plane = arc.plane;
    let same_plane = frame.plane.contains(plane.first) && frame.plane.contains(plane.second);
    if frame.turns() && !same_plane {
        let detail = "an arc outside the working plane cannot be rotated";
        return Err(Fault::new(MessageId::PlaneWronglyDefined, detail));
    }
    if frame.scale(plane.first) != frame.scale(plane.second) {
        return Err(Fault::new(
            MessageId::PlaneWronglyDefined,
            "scaling would make an ellipse of the arc",
        ));
    }
    let mut centre = Position::ZERO;
    plane.set(&mut centre, arc.centre);
    let sign = if frame.reverses(plane) { -1.0 } else { 1.0 };
    Ok(Arc {
        plane,
        centre: plane.point(&frame.to_outer(&centre)),
        sweep_deg: sign * arc.sweep_deg,
    })
}

/// What a block goes beside, other than a contour.
#[derive(Clone, Copy)]
enum Beside {
    Nothing,
    /// R+ and R-: the path is longer or shorter by the radius.
    Paraxial(Compensation),
    /// LN: how far the axes of the plane and the tool axis are displaced, mm.
    Surface([f64; 3]),
}

/// Makes the element, with R+ and R- or the displacement of LN applied, and hands it on.
fn emit_movement(
    c: &mut Context<'_>,
    curve: Curve,
    nominal: Position,
    axes: AxisSet,
    beside: Beside,
    feed: FeedRate,
    functions: BlockFunctions,
) -> Result<Flow, Fault> {
    c.modal.begins_inside = false;
    let start = c.modal.actual;
    let mut end = start;
    for axis in axes.iter() {
        end[axis] = nominal[axis];
    }
    match beside {
        Beside::Nothing | Beside::Paraxial(Compensation::Off) => {}
        Beside::Paraxial(_) if c.settings.as_programmed => {}
        Beside::Paraxial(compensation) => lengthen(c.modal, compensation, axes, &start, &mut end),
        Beside::Surface(way) => {
            let plane = c.modal.plane;
            for (axis, way) in [plane.first, plane.second, plane.normal].into_iter().zip(way) {
                end[axis] = nominal[axis] + way;
            }
        }
    }
    stands_as_defined(c, [&start, &end], axes)?;
    c.modal.take_contour_axes(axes);
    let plane = c.modal.contour_plane;
    let in_plane = axes.contains(plane.first) || axes.contains(plane.second);
    let feed = plunge_feed(c.modal, feed, &curve, &start, &end);
    let feed = surface_feed(c, feed, &curve, [&start, &end]);
    c.modal.nominal = nominal;
    c.modal.actual = end;
    let element = c.pen.element(curve, start, end, feed);
    c.pen.push(c.modal, element, functions, in_plane)
}

/// R+ lengthens and R- shortens a paraxial path in the working plane by the tool radius
/// [003:2046-2057]: target' = target ± R · sign(target - start) (inferred).
fn lengthen(modal: &Modal, compensation: Compensation, axes: AxisSet, start: &Position, end: &mut Position) {
    let amount = match compensation {
        Compensation::Lengthen => modal.tool_radius(),
        _ => -modal.tool_radius(),
    };
    for axis in axes.iter().filter(|axis| modal.contour_plane.contains(*axis)) {
        let path = end[axis] - known(start[axis]);
        if path != 0.0 {
            end[axis] += amount * path.signum();
        }
    }
}

/// M103: the feed component of the tool axis in negative direction is limited to the factor of the
/// programmed feed [000:7278-7292].
fn plunge_feed(modal: &Modal, feed: FeedRate, curve: &Curve, start: &Position, end: &Position) -> FeedRate {
    let (Some(factor), FeedRate::Programmed(programmed)) = (modal.plunge_factor, feed) else {
        return feed;
    };
    let down = start[modal.plane.normal] - end[modal.plane.normal];
    let length = curve.length(start, end);
    if down > 0.0 && length > 0.0 {
        return FeedRate::Programmed(programmed.min(programmed * factor * length / down));
    }
    feed
}

pub(crate) fn take_compensation(modal: &mut Modal, q: &mut QTable, motion: &Motion) -> Result<(), Fault> {
    let Some(word) = motion.compensation else {
        return Ok(());
    };
    let paraxial = matches!(word, Compensation::Lengthen | Compensation::Shorten);
    let contour = matches!(word, Compensation::Left | Compensation::Right);
    if paraxial && motion.kind != MotionKind::Paraxial {
        return Err(Fault::new(
            MessageId::EntryValueIncorrect,
            "R+ and R- belong to paraxial blocks",
        ));
    }
    // "Only for single-axis movements in the working plane" [003:2046]; the message is inferred.
    let beside_plane = |axis: Axis| axis.is_rotary() || axis.main() == modal.plane.normal.main();
    if paraxial && motion.coordinates.axes().iter().any(beside_plane) {
        let detail = "R+ and R- act in the working plane";
        return Err(Fault::new(MessageId::WrongAxisProgrammed, detail));
    }
    // R+/R- and RL/RR must not follow each other [000:7016-7030].
    if (paraxial && modal.compensation != Compensation::Off)
        || (contour && modal.paraxial != Compensation::Off)
    {
        return Err(MessageId::PathOffsetWronglyStarted.into());
    }
    if contour && modal.tool.is_none() {
        // Without a tool in the spindle there is no radius to compensate [003:7984-7986] (inferred).
        return Err(
            Fault::new(MessageId::ProgramStartUndefined, "no tool is called before").because(Cause::NoTool),
        );
    }
    if contour || paraxial {
        modal.used_radius()?;
    }
    modal.compensation = if contour { word } else { Compensation::Off };
    modal.paraxial = if paraxial { word } else { Compensation::Off };
    let q123 = match word {
        Compensation::Off => 0.0,
        Compensation::Left => 1.0,
        Compensation::Right => 2.0,
        Compensation::Lengthen => 3.0,
        Compensation::Shorten => 4.0,
    };
    q.preassign(preassigned::COMPENSATION, q123);
    Ok(())
}

/// The feed of the block: FMAX for this block only, else the last numeric feed [003:2160-2166].
pub(crate) fn take_feed(
    modal: &mut Modal,
    numbers: &Numbers,
    settings: &Settings,
    feed: Option<Feed>,
) -> Result<Option<FeedRate>, Fault> {
    match feed {
        Some(Feed::Max) => return Ok(Some(FeedRate::Rapid)),
        Some(Feed::Value(value)) => {
            let feed = numbers.feed(value, settings)?;
            modal.feed_mm_min = Some(feed);
        }
        None => {}
    }
    let rapid = settings.model.limits().rapid_feed_mm_min;
    Ok(modal.feed_mm_min.filter(|feed| *feed > 0.0).map(|feed| {
        // On the TNC 151/155 the highest feed is rapid traverse [001:471].
        if rapid.is_some_and(|rapid| feed >= rapid) {
            FeedRate::Rapid
        } else {
            FeedRate::Programmed(feed)
        }
    }))
}

/// The export versions TNC 415 F and TNC 425 E move so many axes since software 259 94 09, one less before [000:752-760]. All
/// software of the TNC 415 B and 425 moves five.
const LATER_AXES: usize = 4;

/// Refuses axes that the machine does not have for programs, and more than the control moves together [001:167-173]
/// [003:7761-7763] [000:139]. No manual prints the message *(inferred)*.
#[inline]
fn check_axes(c: &mut Context<'_>, axes: AxisSet) -> Result<(), Fault> {
    if let Some(reason) = c.settings.absent.reason(axes) {
        return Err(Fault::new(MessageId::WrongAxisProgrammed, reason));
    }
    let max = usize::from(c.settings.model.limits().line_axes_max);
    let early = max == LATER_AXES
        && axes.len() == max
        && !c.settings.rules.equipment.does(Behaviour::LinesOfFourAxes);
    let max = if early { max.min(LATER_AXES - 1) } else { max };
    if axes.len() <= max {
        return Ok(());
    }
    let detail = format!(
        "{} axes in a block: this control moves {max} together",
        axes.len()
    );
    if c.settings.skip_unknown {
        c.warn(WarningKind::Function { text: detail });
        return Ok(());
    }
    Err(Fault::new(MessageId::WrongAxisProgrammed, detail))
}

fn check_range(settings: &Settings, to: &Position, axes: AxisSet) -> Result<(), Fault> {
    let max = settings.model.limits().coordinate_max;
    // Written so that a value that is no number is refused too.
    match axes.iter().find(|axis| !(-max..=max).contains(&to[*axis])) {
        Some(axis) => {
            let detail = format!("{axis} is beyond {max}");
            Err(Fault::new(MessageId::EntryValueIncorrect, detail))
        }
        None => Ok(()),
    }
}

/// Axes that may stand for their main axis in the working plane [003:5397-5432].
const PARALLEL_AXES: AxisSet = AxisSet::EMPTY.with(Axis::U).with(Axis::V).with(Axis::W);
