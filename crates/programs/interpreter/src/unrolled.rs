//! The contour of cycle 27, as it lies on the unrolled surface of its cylinder [000:6759-6763].
//!
//! Decision: Cycle 27 (syntax and way of later manuals) machines outside and from the positive side of the tool axis,
//! the rotary axis is one of a table and lies along a main axis; the tool goes up to the setup clearance and over the
//! centre by itself; only datum shifts may be in force. The path is the unrolled surface, whose placement turns the
//! rotary axis; axes are shown, not the surface (also `interpreter/src/cycles/cylinder.rs`, `path/src/cylinder.rs`)

use bahn_parameters::MessageId;
use bahn_path::{Axis, AxisSet, Cylinder, PerAxis, Position};
use bahn_program::{Coordinates, Motion, Value, Word};

use crate::context::Context;
use crate::error::Fault;
use crate::modal::{Modal, Surface};
use crate::numbers::known;
use crate::settings::Settings;

/// A block of the contour, in the unrolled surface.
pub(crate) fn unrolled(c: &mut Context<'_>, motion: &Motion) -> Result<Motion, Fault> {
    let coordinates = unrolled_words(c, &motion.coordinates)?;
    Ok(Motion {
        coordinates,
        ..motion.clone()
    })
}

/// The words of a block of the contour: that of the rotary axis becomes one of the way around. The first block names the
/// axis.
pub(crate) fn unrolled_words(c: &mut Context<'_>, words: &Coordinates) -> Result<Coordinates, Fault> {
    let Some(surface) = c.modal.surface else {
        return Ok(*words);
    };
    let cylinder = match surface.found {
        Some((cylinder, _)) => cylinder,
        None => find(c, &surface, words.axes())?,
    };
    let along = [Axis::X, Axis::Y, Axis::Z]
        .into_iter()
        .find(|axis| *axis != cylinder.around && *axis != c.modal.plane.normal);
    let mut flat = Coordinates::default();
    for (axis, word) in words.iter() {
        if Some(axis) == along {
            flat.set(axis, word);
        } else if axis == cylinder.rotary {
            let value = c.numbers.q.value(word.value)?;
            // Around the cylinder mm count as programmed, degrees by the radius; in program units.
            let way = match surface.linear {
                true => value * cylinder.deg_per_mm.signum(),
                false => value / cylinder.deg_per_mm / c.numbers.unit_mm,
            };
            let word = Word {
                value: Value::Number(way),
                ..word
            };
            flat.set(cylinder.around, word);
        } else {
            let detail = format!(
                "the contour of cycle 27 is programmed in {} and the linear axis along it, not in {axis}",
                cylinder.rotary
            );
            return Err(Fault::new(MessageId::WrongAxisProgrammed, detail));
        }
    }
    Ok(flat)
}

/// Finds the cylinder of the rotary axis that the first block names, and lets the contour begin in its surface.
fn find(c: &mut Context<'_>, surface: &Surface, axes: AxisSet) -> Result<Cylinder, Fault> {
    let Some(rotary) = axes.iter().find(|axis| axis.is_rotary()) else {
        let detail = "the first block of the contour of cycle 27 names no rotary axis";
        return Err(Fault::new(MessageId::WrongAxisProgrammed, detail));
    };
    let (cylinder, centre_mm) = cylinder(c.modal, c.settings, rotary, surface.radius_mm)?;
    let around = cylinder.around;
    c.modal.surface = Some(Surface {
        found: Some((cylinder, centre_mm)),
        ..*surface
    });
    // A shift of the axis across is none of the way around.
    c.modal.frame.shift[around] = 0.0;
    for position in [&mut c.modal.nominal, &mut c.modal.actual] {
        position[around] = (known(position[rotary]) - cylinder.zero_deg) / cylinder.deg_per_mm;
    }
    Ok(cylinder)
}

/// The cylinder about a rotary axis of the table, and where its centre is along the tool axis, mm; workpiece coordinates.
fn cylinder(
    modal: &Modal,
    settings: &Settings,
    rotary: Axis,
    radius_mm: f64,
) -> Result<(Cylinder, f64), Fault> {
    /// A direction this near to an axis is that axis.
    const PARALLEL: f64 = 1.0 - 1e-9;
    let wrong = |detail: String| Fault::new(MessageId::PlaneWronglyDefined, detail);
    let zero = &settings.rules.machine_zero;
    let machine: Position = PerAxis::from_fn(|axis| known(modal.actual[axis]) - known(zero[axis])).into();
    let swivels = settings.rules.swivels.as_deref();
    let centre = swivels.and_then(|swivels| swivels.table_axis(rotary, &machine));
    let (Some(swivels), Some((point, direction))) = (swivels, centre) else {
        let detail = format!("{rotary} is no axis of a table in MP7510 to MP7592");
        return Err(Fault::new(MessageId::WrongAxisProgrammed, detail));
    };
    let tool = modal.plane.normal;
    let head = swivels.head_rotation(&machine);
    let upright = [0, 1, 2].into_iter().zip(head).all(|(i, row)| row[i] > PARALLEL);
    if !upright {
        return Err(wrong("the swivel head does not stand upright".into()));
    }
    let mains = [Axis::X, Axis::Y, Axis::Z];
    let along = mains
        .into_iter()
        .zip(direction)
        .find(|(_, share)| share.abs() > PARALLEL);
    let Some((along, share)) = along else {
        return Err(wrong(format!("{rotary} does not lie along a main axis")));
    };
    // The tool axis must be perpendicular to the rotary axis (public).
    if along == tool || !mains.contains(&tool) {
        return Err(wrong(format!(
            "the tool axis {tool} is not perpendicular to the rotary axis {rotary}"
        )));
    }
    let across = mains.into_iter().find(|axis| *axis != along && *axis != tool);
    let Some(around) = across else {
        return Err(wrong("no axis lies across".into()));
    };
    // Seen from the workpiece a positive turn leads the tool along `rotary x tool`: forwards where the three axes are in
    // the order X, Y, Z, X.
    let forwards = (along.index() + 1) % 3 == tool.index();
    let sign = if forwards == (share > 0.0) { 1.0 } else { -1.0 };
    let at = |axis: Axis| point.get(axis.index()).copied().unwrap_or(0.0) + known(zero[axis]);
    let cylinder = Cylinder {
        rotary,
        around,
        deg_per_mm: sign / radius_mm.to_radians(),
        zero_deg: modal.frame.shift[rotary],
        centre_mm: at(around),
    };
    Ok((cylinder, at(tool)))
}
