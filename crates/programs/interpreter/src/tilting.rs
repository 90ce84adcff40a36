//! Swivel axes: the tilted working plane of cycle 19 [000:4250-4276], M114 to M117 [000:4439-4447] [000:6559-6561], M126 and
//! M127 [000:836].
//!
//! Decision: In the plane of cycle 19 nothing moves, works or probes while a swivel axis stands more than 0.01°
//! beside its angle, or while it moves with others: PLANE WRONGLY DEFINED; swivel axes alone go anywhere. A shift of
//! cycle 7 that was begun before the plane does not end in it
//!
//! Decision: Cycle 19 takes machine angles; axes that it does not name stand at 0, without an axis it ends. Rotation,
//! mirror image and scaling begin after it; what was begun in the plane ends first: else PLANE WRONGLY DEFINED, as
//! for M91, M92 and M114 in it

use std::sync::Arc;

use bahn_parameters::MessageId;
use bahn_parameters::technology::ControlAction;
use bahn_path::{Axis, AxisSet, Placement, Position, Switch, Swivels};
use bahn_program::Coordinates;

use crate::context::Context;
use crate::definition::Resolved;
use crate::error::{Fault, WarningKind};
use crate::modal::Modal;
use crate::settings::Settings;
use crate::status::{Tilting, Way};
use crate::working_plane::{WorkingPlane, may_tilt, outer_of, within};

/// Cycle 19 WORKING PLANE: the positions of the swivel axes, machine coordinates; one that is not given stands at 0. Without
/// an axis the plane is upright again (inferred).
pub(crate) fn working_plane(c: &mut Context<'_>, words: &[Resolved]) -> Result<(), Fault> {
    if c.modal.tilting.compensates {
        return Err(out_of_order("M114 is in force; M115 ends it"));
    }
    let (frame, plane) = (&c.modal.frame, c.modal.tilting.plane);
    may_tilt(frame, plane.is_some()).map_err(out_of_order)?;
    let outer = outer_of(frame, plane.as_ref());
    let angles = swivel_angles(c, words)?;
    c.pen.finish_contour()?;
    c.modal.frame = angles.map_or(outer, |_| within(&outer));
    c.modal.tilting.plane = angles.map(|angles| WorkingPlane { angles, outer });
    c.modal.forget_tangent();
    place(c);
    Ok(())
}

/// In the plane of cycle 19 a movement of other axes begins and ends where the swivel axes stand as the cycle says: they
/// "must first be positioned" [000:4250-4252]. The manual names no message: it is that of a plane that is not as it was
/// defined (inferred). An axis that nobody knows the position of is not looked at; neither are swivel axes that move alone.
pub(crate) fn stands_as_defined(c: &Context<'_>, ends: [&Position; 2], moved: AxisSet) -> Result<(), Fault> {
    /// So far an axis may stand beside its angle, degrees (inferred): what jogging by hand and a display leave.
    const BESIDE_DEG: f64 = 0.01;
    let (Some(plane), Some(swivels)) = (&c.modal.tilting.plane, &c.settings.rules.swivels) else {
        return Ok(());
    };
    let free: AxisSet = swivels.free_axes().collect();
    if moved.iter().all(|axis| free.contains(axis)) {
        return Ok(());
    }
    for (end, axis) in ends
        .into_iter()
        .flat_map(|end| free.iter().map(move |axis| (end, axis)))
    {
        let zero = c.settings.rules.machine_zero[axis];
        let stands = end[axis] - if zero.is_nan() { 0.0 } else { zero };
        let angle = plane.angles[axis];
        let beside = |at: f64| ((at - angle + 180.0).rem_euclid(360.0) - 180.0).abs() > BESIDE_DEG;
        // In a test run nobody may have said where the workpiece lies: then it does at the datum of the machine.
        if beside(stands) && (c.settings.machine || beside(end[axis])) {
            let detail = format!("{axis} stands at {stands:.3} degrees, cycle 19 says {angle:.3}");
            return Err(out_of_order(&detail));
        }
    }
    Ok(())
}

/// The same for what works from where the axes stand: cycles and the probe.
pub(crate) fn works_as_defined(c: &Context<'_>) -> Result<(), Fault> {
    let plane = c.modal.plane;
    let moved = AxisSet::EMPTY
        .with(plane.first)
        .with(plane.second)
        .with(plane.normal);
    stands_as_defined(c, [&c.modal.actual; 2], moved)
}

/// Cycle 7 in the plane of cycle 19 is a shift in that plane; the one that was begun before cycle 19 ends after it, in
/// the reverse order of their beginning [000:4254].
pub(crate) fn ends_within(modal: &Modal, shift: &Position, named: AxisSet) -> Result<(), Fault> {
    let Some(plane) = &modal.tilting.plane else {
        return Ok(());
    };
    let linear = |axis: &Axis| !axis.is_rotary();
    let is_none = |shift: &Position| {
        let mut axes = Axis::ALL.into_iter().filter(linear);
        axes.all(|axis| shift[axis] == 0.0)
    };
    let begun_before = |axis: Axis| plane.outer.shift[axis] != 0.0;
    let mut named = named.iter().filter(linear);
    if is_none(shift) && is_none(&modal.frame.shift) && named.any(begun_before) {
        return Err(out_of_order(
            "the datum shift was begun before cycle 19 and ends after the plane",
        ));
    }
    Ok(())
}

fn out_of_order(detail: &str) -> Fault {
    Fault::new(MessageId::PlaneWronglyDefined, detail)
}

/// The positions of cycle 19; `None` where it names no axis.
fn swivel_angles(c: &mut Context<'_>, words: &[Resolved]) -> Result<Option<Position>, Fault> {
    let mut angles = Position::ZERO;
    let mut named = AxisSet::EMPTY;
    for word in words {
        let Resolved::Coordinate {
            axis,
            value,
            incremental,
        } = word
        else {
            continue;
        };
        if *incremental {
            let detail = "cycle 19 takes the positions of the swivel axes, not steps";
            return Err(Fault::new(MessageId::EntryValueIncorrect, detail));
        }
        angles[*axis] = *value;
        named.insert(*axis);
    }
    if named.is_empty() || c.pen.rehearsal && c.settings.rules.swivels.is_none() {
        return Ok(None);
    }
    if !c.settings.rules.tilting {
        pass_over(
            c,
            "CYCL DEF 19: MP7500 does not allow to tilt the working plane".into(),
        )?;
        return Ok(None);
    }
    let Some(swivels) = geometry(c, "CYCL DEF 19")? else {
        return Ok(None);
    };
    let free: AxisSet = swivels.free_axes().collect();
    match named.iter().find(|axis| !free.contains(*axis)) {
        Some(axis) => {
            let detail = format!("{axis} is no swivel axis of MP7510 to MP7592");
            Err(Fault::new(MessageId::WrongAxisProgrammed, detail))
        }
        None => Ok(Some(angles)),
    }
}

/// The swivel axes; `None` without them where their functions are passed over.
pub(crate) fn geometry<'a>(c: &mut Context<'a>, what: &str) -> Result<Option<&'a Swivels>, Fault> {
    let swivels = c.settings.rules.swivels.as_deref();
    if swivels.is_none() && !c.pen.rehearsal {
        pass_over(
            c,
            format!("{what} needs the machine geometry of MP7510 to MP7592"),
        )?;
    }
    Ok(swivels)
}

/// What the machine is not made for is refused, or passed over with a warning where that is wanted.
fn pass_over(c: &mut Context<'_>, what: String) -> Result<(), Fault> {
    if !c.settings.skip_unknown {
        return Err(Fault::new(MessageId::BlockNotKnown, what));
    }
    c.warn(WarningKind::PassedOver { what });
    Ok(())
}

/// What M functions do with swivel axes.
pub(crate) fn act(c: &mut Context<'_>, action: ControlAction) -> Result<(), Fault> {
    match action {
        ControlAction::CompensateSwivels(switch) => compensate(c, switch.is_on())?,
        ControlAction::SurfaceFeed(switch) => {
            c.modal.tilting.surface_feed = switch.is_on() && geometry(c, "M116")?.is_some();
        }
        ControlAction::ShortestWay(Switch::On) => c.modal.tilting.way = Way::Shortest,
        ControlAction::ShortestWay(Switch::Off) if c.modal.tilting.way == Way::Shortest => {
            c.modal.tilting.way = Way::WithinTurn;
        }
        _ => {}
    }
    Ok(())
}

/// M114: the tip stays on the path while the head turns; M115: no more.
fn compensate(c: &mut Context<'_>, on: bool) -> Result<(), Fault> {
    if on {
        if c.modal.tilting.plane.is_some() {
            return Err(out_of_order(
                "cycle 19 is in force, M114 compensates in workpiece coordinates",
            ));
        }
        if geometry(c, "M114")?.is_none() {
            return Ok(());
        }
    }
    if c.modal.tilting.compensates != on {
        c.pen.finish_contour()?;
        c.modal.tilting.compensates = on;
        place(c);
    }
    Ok(())
}

/// Makes the placement of what is drawn from now on. Nothing moves: where the tool stands has another name in it.
pub(crate) fn place(c: &mut Context<'_>) {
    let placement = placement(c.modal, c.settings);
    if placement.as_ref() == c.pen.placement.as_deref() {
        return;
    }
    let old = c.pen.placement.take();
    for position in [&mut c.modal.nominal, &mut c.modal.actual] {
        *position = Placement::change(old.as_deref(), placement.as_ref(), position);
    }
    c.pen.placement = placement.map(Arc::new);
}

/// Another tool is in the spindle, and where its tip is is known: the placement has it, too.
pub(crate) fn take_tool(c: &mut Context<'_>) {
    let placement = placement(c.modal, c.settings);
    if placement.as_ref() != c.pen.placement.as_deref() {
        c.pen.placement = placement.map(Arc::new);
    }
}

/// Another tool comes into the spindle and the axes stand still: where its tip is. In a tilted plane that is along the tool
/// as it is without one, which `change_length` does; while swivel axes are compensated it depends on how they stand.
pub(crate) fn change_tool(
    c: &mut Context<'_>,
    axis: Axis,
    length: f64,
    change_length: impl FnOnce(&mut Modal, Axis, f64),
) {
    let (Some(old), true) = (c.pen.placement.clone(), c.modal.length_mm.is_some()) else {
        return change_length(c.modal, axis, length);
    };
    let noses = [c.modal.nominal, c.modal.actual].map(|position| old.to_nose(&position));
    c.modal.length_mm = Some(length);
    let Some(new) = placement_with(c.modal, c.settings, (axis, length)) else {
        return;
    };
    [c.modal.nominal, c.modal.actual] = noses.map(|nose| new.from_nose(&nose));
}

/// The placement of what is in force; `None` where all stands upright.
fn placement(modal: &Modal, settings: &Settings) -> Option<Placement> {
    placement_with(modal, settings, tool_of(modal))
}

/// Axis and length, mm, of the tool in the spindle.
pub(crate) fn tool_of(modal: &Modal) -> (Axis, f64) {
    let length = modal
        .tool
        .map_or(modal.length_mm.unwrap_or(0.0), |tool| tool.shape.length);
    (modal.plane.normal, length)
}

fn placement_with(modal: &Modal, settings: &Settings, tool: (Axis, f64)) -> Option<Placement> {
    let Tilting {
        plane, compensates, ..
    } = &modal.tilting;
    let swivels = settings.rules.swivels.as_ref()?;
    // Machine zero seen from the workpiece datum, the other way round.
    let datum: Position = settings.rules.machine_zero.values().map(|zero| -zero).into();
    match plane {
        Some(plane) => {
            let places = [&datum, &plane.outer.shift];
            Some(Placement::tilted(swivels, &plane.angles, places, tool))
        }
        None => compensates.then(|| Placement::compensated(Arc::clone(swivels), &datum, tool)),
    }
}

/// M126, M127: where a rotary axis with a modulo value goes that is told to go to an angle.
pub(crate) fn take_way(
    modal: &Modal,
    settings: &Settings,
    coordinates: &Coordinates,
    from: &Position,
    to: &mut Position,
) {
    if modal.tilting.way == Way::Programmed {
        return;
    }
    let absolute = |axis: &Axis| !coordinates.incremental().contains(*axis);
    for axis in coordinates.axes().iter().filter(absolute) {
        let modulo = settings.rules.modulo_deg[axis];
        let (Some(modulo), Some(from)) = (modulo, from.get(axis)) else {
            continue;
        };
        to[axis] = match modal.tilting.way {
            // Half a turn goes in positive direction (inferred).
            Way::Shortest => {
                let way = (to[axis] - from).rem_euclid(modulo);
                from + if way > 0.5 * modulo { way - modulo } else { way }
            }
            _ => (from / modulo).floor() * modulo + to[axis].rem_euclid(modulo),
        };
    }
}
