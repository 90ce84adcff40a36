//! Poles, arcs and polar coordinates: the end point and the curve of a path function.
//!
//! Decision: An arc of the TNC 415/425 takes one more axis, rotary or linear, but none parallel to its plane; a
//! linear one only where both axes of the plane are named
//!
//! Decision: After GOTO a tangential arc and a CC without coordinates are PROGRAM-START UNDEFINED until something
//! moves

use bahn_parameters::MessageId;
use bahn_path::{Arc, Axis, AxisSet, Curve, Plane, Point2, Position, Sense};
use bahn_program::{Coordinates, Motion, MotionKind, Value, Word};

use crate::arc;
use crate::error::{Cause, Fault};
use crate::modal::Modal;
use crate::numbers::{Numbers, known};
use crate::q_parameters::{cos_deg, sin_deg};
use crate::settings::Settings;

/// A movement in programmed coordinates.
pub(crate) struct Programmed {
    pub from: Position,
    pub to: Position,
    /// Axes that the block moves.
    pub axes: AxisSet,
    pub curve: Curve,
}

impl Programmed {
    /// The end lies at an angle around a pole of a plane.
    fn end_at(&mut self, plane: Plane, pole: Point2, radius: f64, angle_deg: f64) {
        let end = [
            pole[0] + radius * cos_deg(angle_deg),
            pole[1] + radius * sin_deg(angle_deg),
        ];
        plane.set(&mut self.to, end);
        self.axes = self.axes.with(plane.first).with(plane.second);
    }
}

pub(crate) fn programmed(
    modal: &mut Modal,
    numbers: &Numbers,
    settings: &Settings,
    motion: &Motion,
) -> Result<Programmed, Fault> {
    let from = modal.frame.to_programmed(&modal.nominal);
    let mut p = Programmed {
        from,
        to: from,
        axes: AxisSet::EMPTY,
        curve: Curve::Line,
    };
    take_coordinates(modal, numbers, &motion.coordinates, &mut p)?;
    match motion.kind {
        MotionKind::Line | MotionKind::LineNormal | MotionKind::Paraxial => {}
        MotionKind::LinePolar => {
            polar_point(modal, numbers, settings, motion, &mut p)?;
        }
        MotionKind::Circle => circle(modal, settings, motion, &mut p)?,
        MotionKind::CircleRadius => circle_radius(modal, numbers, settings, motion, &mut p)?,
        MotionKind::CircleTangential => {
            let plane = plane_of(modal, &motion.coordinates)?;
            check_beside(plane, p.axes, settings)?;
            p.curve = tangential(modal, plane, &p)?;
        }
        MotionKind::CirclePolar => circle_polar(modal, numbers, settings, motion, &mut p)?,
        MotionKind::CircleTangentialPolar => {
            let beside = p.axes;
            let plane = polar_point(modal, numbers, settings, motion, &mut p)?;
            check_helix(plane, beside, settings)?;
            p.curve = tangential(modal, plane, &p)?;
        }
    }
    Ok(p)
}

/// Cartesian words into the end point.
fn take_coordinates(
    modal: &Modal,
    numbers: &Numbers,
    coordinates: &Coordinates,
    p: &mut Programmed,
) -> Result<(), Fault> {
    let from = match &modal.increments_from {
        Some(nominal) => modal.frame.to_programmed(nominal),
        None => p.from,
    };
    for (axis, word) in coordinates.iter() {
        let value = numbers.q.value(word.value)? * numbers.axis_unit(axis);
        p.to[axis] = if word.incremental {
            known(from[axis]) + value
        } else {
            value
        };
        p.axes.insert(axis);
    }
    Ok(())
}

/// CC: pole and circle centre; without coordinates the last programmed position [003:2748-2775].
pub(crate) fn circle_centre(
    modal: &mut Modal,
    numbers: &Numbers,
    coordinates: &Coordinates,
) -> Result<(), Fault> {
    let here = modal.frame.to_programmed(&modal.nominal);
    let axes: Vec<Axis> = coordinates.axes().iter().collect();
    let plane = match axes[..] {
        // Nor at one that takes the last position over as pole [003:7984-7987].
        [] if modal.begins_inside => {
            let detail = "no movement before gives a position";
            return Err(Fault::new(MessageId::ProgramStartUndefined, detail));
        }
        [] => modal.plane,
        [a, b] => Plane::of_axes(a, b).ok_or(Fault::from(MessageId::PlaneWronglyDefined))?,
        _ => {
            return Err(Fault::new(
                MessageId::PlaneWronglyDefined,
                "CC needs both axes of a plane",
            ));
        }
    };
    let mut p = Programmed {
        from: here,
        to: here,
        axes: AxisSet::EMPTY,
        curve: Curve::Hold,
    };
    take_coordinates(modal, numbers, coordinates, &mut p)?;
    let point = plane.point(&p.to).map(known);
    modal.pole = Some((plane, point));
    Ok(())
}

fn pole(modal: &Modal) -> Result<(Plane, Point2), Fault> {
    modal.pole.ok_or_else(|| {
        Fault::new(MessageId::PlaneWronglyDefined, "no CC is programmed before").because(Cause::NoPole)
    })
}

/// The plane of an arc from its words: two linear axes name it, otherwise the working plane. A third one is the tool
/// axis, which moves along (inferred).
fn plane_of(modal: &Modal, coordinates: &Coordinates) -> Result<Plane, Fault> {
    let linear = |axis: &Axis| !axis.is_rotary();
    let in_plane = |axis: &Axis| axis.main() != modal.plane.normal.main();
    let mut axes: Vec<Axis> = coordinates.axes().iter().filter(linear).collect();
    if axes.len() > 2 {
        axes.retain(in_plane);
    }
    match axes[..] {
        [a, b] => Plane::of_axes(a, b).ok_or(Fault::from(MessageId::PlaneWronglyDefined)),
        [a] if modal.plane.contains(a) => Ok(modal.plane),
        [] => Ok(modal.plane),
        _ => Err(Fault::new(
            MessageId::PlaneWronglyDefined,
            "the end point of an arc lies in a plane",
        )),
    }
}

/// Refuses axes beside an arc that the control does not move together with it: the TNC 415/425 have one, linear or
/// rotary [000:140]. One that is parallel to the plane would make another curve of it (inferred).
fn check_beside(plane: Plane, axes: AxisSet, settings: &Settings) -> Result<(), Fault> {
    let max = settings.model.limits().circle_axes_max;
    let beside: AxisSet = axes.iter().filter(|axis| !plane.contains(*axis)).collect();
    let mains = [plane.first, plane.second].map(Axis::main);
    let is_parallel = |axis: Axis| !axis.is_rotary() && mains.contains(&axis.main());
    if beside.iter().any(is_parallel) || 2 + beside.len() > usize::from(max) {
        let detail = match max {
            2 => "the end point of an arc lies in its plane".to_owned(),
            _ => format!("this control moves {max} axes on an arc, two of them in its plane"),
        };
        return Err(Fault::new(MessageId::PlaneWronglyDefined, detail));
    }
    Ok(())
}

/// Refuses axes beside a helix, an arc with one more axis [000:141]: a linear one, on the TNC 415/425 also a rotary
/// one.
fn check_helix(plane: Plane, beside: AxisSet, settings: &Settings) -> Result<(), Fault> {
    let limits = settings.model.limits();
    let linear = beside.iter().all(|axis| !axis.is_rotary());
    if linear && beside.len() <= usize::from(limits.helix_axes_max - 2) {
        return Ok(());
    }
    check_beside(plane, beside, settings)
}

/// C: arc about CC [003:2801-2824].
fn circle(modal: &Modal, settings: &Settings, motion: &Motion, p: &mut Programmed) -> Result<(), Fault> {
    let (plane, centre) = pole(modal)?;
    let names_plane = p.axes.contains(plane.first) && p.axes.contains(plane.second);
    let is_beside = |axis: Axis| !axis.is_rotary() && !plane.contains(axis);
    if !names_plane && p.axes.iter().any(is_beside) {
        let detail = "the end point lies outside the plane of CC";
        return Err(Fault::new(MessageId::PlaneWronglyDefined, detail));
    }
    check_beside(plane, p.axes, settings)?;
    let sense = sense(motion)?;
    p.axes = p.axes.with(plane.first).with(plane.second);
    let (start, end) = (plane.point(&p.from), plane.point(&p.to));
    arc::check_radii(centre, start, end, settings.rules.arc_tolerance_mm)?;
    let sweep_deg = bahn_path::sweep_deg(centre, start, end, sense);
    p.curve = Curve::Arc(Arc {
        plane,
        centre,
        sweep_deg,
    });
    Ok(())
}

/// CR: arc with radius [003:2853-2879].
fn circle_radius(
    modal: &Modal,
    numbers: &Numbers,
    settings: &Settings,
    motion: &Motion,
    p: &mut Programmed,
) -> Result<(), Fault> {
    let plane = plane_of(modal, &motion.coordinates)?;
    check_beside(plane, p.axes, settings)?;
    let sense = sense(motion)?;
    let Some(radius) = motion.radius else {
        let detail = "the arc has no radius R";
        return Err(Fault::new(MessageId::AngleReferenceMissing, detail).because(Cause::NoRadius));
    };
    let radius = numbers.length(radius)?;
    if radius.abs() > settings.model.limits().circle_radius_max_mm {
        return Err(Fault::new(
            MessageId::EntryValueIncorrect,
            "the radius is beyond the input range",
        ));
    }
    p.axes = p.axes.with(plane.first).with(plane.second);
    let (start, end) = (plane.point(&p.from), plane.point(&p.to));
    p.curve = Curve::Arc(arc::with_radius(plane, start, end, radius, sense)?);
    Ok(())
}

/// CT, CTP: arc that starts in the direction of the movement before [003:2957-2995].
fn tangential(modal: &Modal, plane: Plane, p: &Programmed) -> Result<Curve, Fault> {
    // No program is resumed at a block with a tangential arc [003:7984-7987].
    let message = match modal.begins_inside {
        true => MessageId::ProgramStartUndefined,
        false => MessageId::RoundingOffNotDefined,
    };
    let no_tangent = || Fault::new(message, "no movement before gives a tangent");
    let last = modal.last_move.as_ref().ok_or_else(no_tangent)?;
    let direction = last.curve.tangent(&last.start, &last.end, 1.0);
    let tangent = [direction[plane.first], direction[plane.second]];
    if tangent == [0.0, 0.0] {
        return Err(no_tangent());
    }
    arc::tangential(plane, plane.point(&p.from), tangent, plane.point(&p.to))
}

/// End point from PR and PA [003:3090-3092].
fn polar_point(
    modal: &mut Modal,
    numbers: &Numbers,
    settings: &Settings,
    motion: &Motion,
    p: &mut Programmed,
) -> Result<Plane, Fault> {
    let (plane, pole) = pole(modal)?;
    let from = plane.point(&p.from);
    let (dx, dy) = (from[0] - pole[0], from[1] - pole[1]);
    let radius = match motion.polar_radius {
        Some(Word {
            value,
            incremental: false,
        }) => numbers.length(value)?,
        Some(Word {
            value,
            incremental: true,
        }) => dx.hypot(dy) + numbers.length(value)?,
        None => modal.polar_radius.unwrap_or(dx.hypot(dy)),
    };
    if motion.polar_radius.is_some() {
        modal.polar_radius = Some(radius);
    }
    let Some(word) = motion.polar_angle else {
        return Err(no_angle());
    };
    let angle = numbers.q.value(word.value)?;
    // The limit is one of typed numbers [003:3089]: hole circles by Q parameters count on beyond a turn.
    let typed = matches!(word.value, Value::Number(_));
    if typed && angle.abs() > settings.model.limits().polar_angle_max_deg {
        return Err(Fault::new(
            MessageId::EntryValueIncorrect,
            "PA is beyond the input range",
        ));
    }
    let angle = if word.incremental {
        bahn_path::angle_deg([dx, dy]) + angle
    } else {
        angle
    };
    p.end_at(plane, pole, radius, angle);
    Ok(plane)
}

/// CP, with a tool-axis word a helix [003:3173-3183] [003:3243-3324].
fn circle_polar(
    modal: &Modal,
    numbers: &Numbers,
    settings: &Settings,
    motion: &Motion,
    p: &mut Programmed,
) -> Result<(), Fault> {
    let (plane, pole) = pole(modal)?;
    if p.axes.iter().any(|axis| plane.contains(axis)) {
        return Err(Fault::new(
            MessageId::PlaneWronglyDefined,
            "CP takes its end point from PA",
        ));
    }
    check_helix(plane, p.axes, settings)?;
    let sense = sense(motion)?;
    let Some(word) = motion.polar_angle else {
        return Err(no_angle());
    };
    let angle = numbers.q.value(word.value)?;
    if angle.abs() > settings.model.limits().circle_angle_max_deg {
        return Err(Fault::new(
            MessageId::EntryValueIncorrect,
            "PA is beyond the input range",
        ));
    }
    let start = plane.point(&p.from);
    let offset = [start[0] - pole[0], start[1] - pole[1]];
    let radius = offset[0].hypot(offset[1]);
    if radius.is_nan() {
        return Err(MessageId::CircleEndPosIncorrect.into());
    }
    let start_angle = bahn_path::angle_deg(offset);
    let sweep_deg = if word.incremental {
        if angle != 0.0 && Sense::of_sweep(angle) != sense {
            // Incremental PA and DR must have the same sign [003:3173-3183].
            return Err(Fault::new(
                MessageId::AngleReferenceMissing,
                "IPA and DR have different signs",
            ));
        }
        angle
    } else {
        arc::sweep_to_angle(start_angle, angle, sense)
    };
    let end_angle = if word.incremental {
        start_angle + sweep_deg
    } else {
        angle
    };
    p.end_at(plane, pole, radius, end_angle);
    p.curve = Curve::Arc(Arc {
        plane,
        centre: pole,
        sweep_deg,
    });
    Ok(())
}

fn sense(motion: &Motion) -> Result<Sense, Fault> {
    match motion.direction {
        Some(sense) => Ok(sense),
        None => Err(
            Fault::new(MessageId::AngleReferenceMissing, "the arc has no DR+ or DR-")
                .because(Cause::NoDirection),
        ),
    }
}

fn no_angle() -> Fault {
    Fault::new(MessageId::AngleReferenceMissing, "PA is missing").because(Cause::NoAngle)
}
