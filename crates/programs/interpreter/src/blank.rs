//! The blank of the graphics: BLK FORM.

use bahn_parameters::{MessageId, technology};
use bahn_path::{Axis, Blank, Function, Plane};
use bahn_program::Coordinates;

use crate::context::Context;
use crate::error::{Cause, Fault, WarningKind};
use crate::modal::Modal;
use crate::numbers::{Numbers, known};

/// BLK FORM 0.1: tool axis and least corner, absolute only [003:2113-2114].
pub(crate) fn blank_min(
    modal: &mut Modal,
    numbers: &Numbers,
    coordinates: &Coordinates,
    axis: Option<Axis>,
) -> Result<(), Fault> {
    if !coordinates.incremental().is_empty() {
        return Err(Fault::new(
            MessageId::BlkFormDefinitionIncorrect,
            "the MIN corner is absolute",
        ));
    }
    let Some(plane) = Plane::of_tool_axis(axis.unwrap_or(Axis::Z)) else {
        return Err(MessageId::BlkFormDefinitionIncorrect.into());
    };
    modal.blank_min = Some((plane, corner(numbers, coordinates, [0.0; 3])?));
    Ok(())
}

/// BLK FORM 0.2: greatest corner, absolute or incremental from the least one [003:2113-2121].
/// The blank is that of the first one of the main program.
pub(crate) fn blank_max(
    c: &mut Context<'_>,
    first: &mut Option<Blank>,
    coordinates: &Coordinates,
) -> Result<(), Fault> {
    let wrong = |detail: String| Fault::new(MessageId::BlkFormDefinitionIncorrect, detail);
    let Some((plane, min)) = c.modal.blank_min.take() else {
        return Err(wrong("BLK FORM 0.1 is missing".into()).because(Cause::NoBlankMin));
    };
    let max = corner(c.numbers, coordinates, min)?;
    let limits = c.settings.model.limits();
    let sides = [max[0] - min[0], max[1] - min[1], max[2] - min[2]];
    let longest = sides.iter().copied().fold(0.0, f64::max);
    let shortest = sides.iter().copied().fold(f64::INFINITY, f64::min);
    if shortest == 0.0 && longest == 0.0 {
        // Written by programs that want no graphics.
        c.warn(WarningKind::BlankEmpty);
        return Ok(());
    }
    if shortest <= 0.0 {
        return Err(wrong(
            "the MAX corner must be greater than the MIN corner on every axis".into(),
        ));
    }
    if longest > limits.blank_side_max_mm {
        return Err(wrong(format!(
            "a side is longer than {} mm",
            limits.blank_side_max_mm
        )));
    }
    if longest / shortest >= limits.blank_ratio_limit {
        return Err(wrong(format!(
            "the ratio of the sides must stay below {}:1",
            limits.blank_ratio_limit
        )));
    }
    if c.at.in_called_program() {
        if first.is_none() {
            c.warn(WarningKind::BlankInCalledProgram);
        }
        return Ok(());
    }
    let blank = Blank { plane, min, max };
    first.get_or_insert(blank);
    c.output_function(Function::Blank(blank), technology::Block::Blank)
}

fn corner(numbers: &Numbers, coordinates: &Coordinates, base: [f64; 3]) -> Result<[f64; 3], Fault> {
    let mut corner = base;
    for (slot, axis) in corner.iter_mut().zip([Axis::X, Axis::Y, Axis::Z]) {
        let Some(word) = coordinates.get(axis) else {
            return Err(Fault::new(
                MessageId::BlkFormDefinitionIncorrect,
                format!("{axis} is missing"),
            ));
        };
        let value = known(numbers.length(word.value)?);
        *slot = if word.incremental { *slot + value } else { value };
    }
    Ok(corner)
}
