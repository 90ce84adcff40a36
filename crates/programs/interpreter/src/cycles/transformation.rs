//! Cycles that act when they are defined: transformations, dwell, spindle orientation, contour labels.
//!
//! Decision: Cycle 26 keeps a factor until its axis is named again, and cycle 11 multiplies it; radii and chamfers
//! need one factor for both axes of the plane
//!
//! Decision: `CYCL DEF 7.1 #n` without its table or line is ENTRY VALUE INCORRECT

use bahn_parameters::{MessageId, technology};
use bahn_path::{Axis, AxisScaling, AxisSet, Curve, FeedRate, Function, Position};

use crate::context::Context;
use crate::definition::{Resolved, dwell_time};
use crate::error::{Fault, WarningKind};
use crate::modal::Modal;
use crate::pen::Pen;
use crate::settings::Settings;
use crate::tilting;

/// Cycle 7 DATUM SHIFT: absolute to the set datum, incremental to the last valid one [003:6222].
pub(super) fn datum_shift(c: &mut Context<'_>, words: &[Resolved]) -> Result<(), Fault> {
    let max = c.settings.model.limits().coordinate_max;
    let is_mark = |word: &Resolved| matches!(word, Resolved::Text(text) if text.starts_with('#'));
    if words.iter().any(is_mark) {
        return datum_from_table(c, words);
    }
    let (mut shift, mut named) = (c.modal.frame.shift, AxisSet::EMPTY);
    for word in words {
        let Resolved::Coordinate {
            axis,
            value,
            incremental,
        } = word
        else {
            continue;
        };
        let value = value * c.numbers.axis_unit(*axis);
        let shifted = if *incremental { shift[*axis] + value } else { value };
        if shifted.abs() > max {
            return Err(Fault::new(
                MessageId::EntryValueIncorrect,
                format!("{axis} is beyond {max}"),
            ));
        }
        shift[*axis] = shifted;
        named.insert(*axis);
    }
    take_shift(c.modal, shift, named)
}

/// The datum shift of cycle 7 on the axes that it names.
fn take_shift(modal: &mut Modal, shift: Position, named: AxisSet) -> Result<(), Fault> {
    tilting::ends_within(modal, &shift, named)?;
    modal.frame.shift = shift;
    modal.forget_tangent();
    Ok(())
}

/// `CYCL DEF 7.1 #n`: a line of the selected datum table shifts all axes of the table. Its values count from
/// the workpiece datum, or with MP7475 = 1 from the machine datum [000:6898-6904]. No manual prints a message
/// for what is missing: it is that of a wrong entry (inferred).
fn datum_from_table(c: &mut Context<'_>, words: &[Resolved]) -> Result<(), Fault> {
    let wrong = |detail: String| Fault::new(MessageId::EntryValueIncorrect, detail);
    let table = match &c.settings.datum_table {
        Ok(table) => table,
        Err(why) if c.settings.skip_unknown => {
            let what = why.clone();
            c.warn(WarningKind::PassedOver { what });
            return Ok(());
        }
        Err(why) => return Err(wrong(why.clone())),
    };
    let number = match words {
        [Resolved::Text(mark), Resolved::Number(number)] if &**mark == "#" => *number,
        _ => {
            return Err(wrong(
                "# takes the number of a line of the datum table, and nothing else".into(),
            ));
        }
    };
    let datum = match number.fract() == 0.0 {
        true => table.get(&(number as i32)),
        false => None,
    };
    let datum = *datum.ok_or_else(|| wrong(format!("the datum table has no line {number}")))?;
    let mut shift = c.modal.frame.shift;
    for axis in datum.known().iter() {
        shift[axis] = match c.settings.rules.datums_from_machine {
            true => datum[axis] + c.settings.rules.machine_zero[axis],
            false => datum[axis],
        };
        if shift[axis].is_nan() {
            let what = format!("MP7475 counts from the machine datum, which is not known for {axis}");
            return Err(wrong(what));
        }
    }
    take_shift(c.modal, shift, datum.known())
}

/// Cycle 8 MIRROR IMAGE: the named axes; none cancels. Neither the tool axis nor a rotary axis can be
/// mirrored [003:6290-6307].
pub(super) fn mirror_image(modal: &mut Modal, words: &[Resolved]) -> Result<(), Fault> {
    let mut mirrored = Vec::new();
    for word in words {
        match word {
            Resolved::Axis(axis) | Resolved::Coordinate { axis, .. } | Resolved::AxisDirection(axis, _) => {
                mirrored.push(*axis);
            }
            _ => {}
        }
    }
    for axis in &mirrored {
        if axis.is_rotary() || *axis == modal.plane.normal {
            let detail = format!("{axis} cannot be mirrored");
            return Err(Fault::new(MessageId::WrongAxisProgrammed, detail));
        }
    }
    for axis in Axis::ALL {
        let size = modal.frame.factor[axis].abs();
        modal.frame.factor[axis] = if mirrored.contains(&axis) { -size } else { size };
    }
    modal.forget_tangent();
    Ok(())
}

/// Cycle 10 ROTATION about the active datum in the working plane [003:6313-6333]. The input limit of 360
/// degrees is one of typed numbers: a calculated angle may go on counting, as the hemisphere of the manual
/// does in its last pass [003:4785-4789].
pub(super) fn rotation(
    modal: &mut Modal,
    words: &[Resolved],
    calculated: bool,
    settings: &Settings,
) -> Result<(), Fault> {
    // `IROT`: the word before the number says that it is incremental (spelling inferred).
    let incremental = words.iter().any(|word| {
        matches!(word, Resolved::Text(text) if text.len() > 1 && text.to_ascii_uppercase().starts_with('I'))
    });
    let Some(angle) = first_number(words) else {
        return Err(Fault::new(
            MessageId::CyclIncomplete,
            "the angle of rotation is missing",
        ));
    };
    let max = settings.model.limits().rotation_max_deg;
    if angle.abs() > max && !calculated {
        return Err(Fault::new(
            MessageId::EntryValueIncorrect,
            format!("ROT takes -{max} to +{max} degrees"),
        ));
    }
    let frame = &mut modal.frame;
    frame.rotation_deg = if incremental {
        frame.rotation_deg + angle
    } else {
        angle
    } % 360.0;
    frame.plane = modal.plane;
    modal.forget_tangent();
    Ok(())
}

/// Cycle 11 SCALING FACTOR, in the working plane or on all axes by MP7410 [003:6385-6412].
pub(super) fn scaling(modal: &mut Modal, words: &[Resolved], settings: &Settings) -> Result<(), Fault> {
    let Some(factor) = first_number(words) else {
        return Err(Fault::new(
            MessageId::CyclIncomplete,
            "the scaling factor is missing",
        ));
    };
    let [min, max] = settings.model.limits().scaling_range;
    if !(min..=max).contains(&factor) {
        return Err(Fault::new(
            MessageId::EntryValueIncorrect,
            format!("SCL takes {min} to {max}"),
        ));
    }
    for axis in Axis::ALL.into_iter().filter(|axis| !axis.is_rotary()) {
        let in_plane = axis.main() != modal.plane.normal.main();
        let scaled = in_plane || !settings.rules.scaling_in_plane_only;
        let sign = modal.frame.factor[axis].signum();
        modal.frame.factor[axis] = if scaled { sign * factor } else { sign };
    }
    modal.forget_tangent();
    Ok(())
}

/// Cycle 26 AXIS-SPECIFIC SCALING: a factor for each named axis about a centre, or the active datum where none is
/// given (later controls). An axis keeps its factor until it is named again; cycle 11 multiplies it (inferred).
pub(super) fn axis_scaling(c: &mut Context<'_>, words: &[Resolved]) -> Result<(), Fault> {
    let [min, max] = c.settings.model.limits().scaling_range;
    let mut scaling = c.modal.frame.axis_scaling.unwrap_or(AxisScaling::none());
    for word in words {
        let (Resolved::AxisFactor(axis, _) | Resolved::Centre(axis, _)) = word else {
            continue;
        };
        if axis.is_rotary() {
            let detail = format!("{axis} cannot be scaled");
            return Err(Fault::new(MessageId::WrongAxisProgrammed, detail));
        }
        let Resolved::AxisFactor(axis, factor) = *word else {
            continue;
        };
        if !(min..=max).contains(&factor) {
            let detail = format!("the factor of {axis} takes {min} to {max}");
            return Err(Fault::new(MessageId::EntryValueIncorrect, detail));
        }
        scaling.factor[axis] = factor;
        scaling.centre[axis] = 0.0;
    }
    for word in words {
        if let Resolved::Centre(axis, at) = *word {
            scaling.centre[axis] = at * c.numbers.axis_unit(axis);
        }
    }
    let acts = scaling.factor != AxisScaling::none().factor;
    c.modal.frame.axis_scaling = acts.then_some(scaling);
    c.modal.forget_tangent();
    Ok(())
}

/// Cycle 9 DWELL TIME in seconds [003:6462-6474].
pub(super) fn dwell(
    modal: &Modal,
    pen: &mut Pen,
    words: &[Resolved],
    settings: &Settings,
) -> Result<(), Fault> {
    let Some(seconds) = first_number(words) else {
        return Err(Fault::new(MessageId::CyclIncomplete, "the dwell time is missing"));
    };
    let seconds = dwell_time(seconds, settings)?;
    pen.finish_contour()?;
    let centre = pen.tool_centre(modal);
    let mut element = pen.element(Curve::Hold, centre, centre, FeedRate::Rapid);
    element.dwell_s = seconds;
    if pen.machine && seconds > 0.0 {
        pen.note_time();
    }
    pen.out.push(element, None);
    Ok(())
}

/// Cycle 13: angle of the oriented spindle stop, for M19 or another M function [003:6500-6528]; the PLC
/// is told of it when the cycle is executed [000:5853-5865].
pub(super) fn spindle_orientation(c: &mut Context<'_>, words: &[Resolved]) -> Result<(), Fault> {
    let Some(angle) = first_number(words) else {
        return Err(Fault::new(MessageId::CyclIncomplete, "the angle is missing"));
    };
    if !(0.0..=360.0).contains(&angle) {
        return Err(Fault::new(
            MessageId::EntryValueIncorrect,
            "the angle is 0 to 360 degrees",
        ));
    }
    c.modal.orientation_deg = Some(angle);
    c.output_function(
        Function::OrientationAngle(angle),
        technology::Block::OrientationAngle,
    )
}

/// Cycle 14 CONTOUR GEOMETRY: the labels of the subcontours [003:5460-5470].
pub(super) fn contour_geometry(
    modal: &mut Modal,
    words: &[Resolved],
    settings: &Settings,
) -> Result<(), Fault> {
    let mut labels = Vec::new();
    for word in words {
        match word {
            Resolved::Labels(list) => labels.extend_from_slice(list),
            Resolved::Number(number) if *number >= 1.0 && *number <= f64::from(u16::MAX) => {
                labels.push(*number as u16);
            }
            _ => {}
        }
    }
    let max = settings.model.limits().contour_labels_max;
    if labels.is_empty() || labels.len() > usize::from(max) {
        return Err(Fault::new(
            MessageId::EntryValueIncorrect,
            format!("cycle 14 takes 1 to {max} labels"),
        ));
    }
    modal.contour_labels = labels;
    Ok(())
}

fn first_number(words: &[Resolved]) -> Option<f64> {
    words.iter().find_map(|word| match word {
        Resolved::Number(number) => Some(*number),
        _ => None,
    })
}
