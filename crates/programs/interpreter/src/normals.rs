//! LN: straight lines with the normal of the surface, for which the tool is compensated in space [000:175].
//!
//! A CAM system has computed the programmed points for a tool with the radii R and R2. The tool in the spindle differs
//! from it by the oversizes DR and DR2 of the table and of TOOL CALL [000:9177], and touches the same point of the
//! surface when its tip is displaced by
//!
//! `DR2 · n + (DR - DR2) · h - DR2 · z`
//!
//! with the normal `n`, the direction `h` of its part in the working plane and the tool axis `z`: the centre of the
//! corner goes away from the surface, the axis of a toroid or flat end beside it (inferred). With MP7680 bit 6 the
//! length of the tool contains DR2, and the last term falls away [000:9179-9192]. DL is in the length already.
//!
//! Decision: LN displaces the tip so that the tool in the spindle touches the same point as the one that was computed
//! with; its normal is stretched and turned with the surface

use bahn_parameters::MessageId;
use bahn_path::{Axis, Position};
use bahn_program::{Compensation, Value};

use crate::context::Context;
use crate::error::Fault;
use crate::modal::Modal;

/// By how much the tip is displaced in the axes of the plane and the tool axis, mm.
pub(crate) fn displacement(c: &Context<'_>, components: &[Value; 3]) -> Result<[f64; 3], Fault> {
    if c.modal.compensation != Compensation::Off {
        let detail = "LN takes no radius compensation: R0 comes before it";
        return Err(Fault::new(MessageId::PathOffsetWronglyStarted, detail));
    }
    let mut normal = Position::ZERO;
    for (axis, value) in [Axis::X, Axis::Y, Axis::Z].into_iter().zip(components) {
        normal[axis] = c.numbers.q.value(*value)?;
    }
    let [u, v, w] = in_plane(c.modal, &normal);
    let length = u.hypot(v).hypot(w);
    if length <= 0.0 || !length.is_finite() {
        let detail = "a surface normal is a vector of length 1";
        return Err(Fault::new(MessageId::EntryValueIncorrect, detail));
    }
    let [u, v, w] = [u / length, v / length, w / length];
    let (dr, dr2) = oversizes(c.modal)?;
    let beside = u.hypot(v);
    /// Flatter surfaces are touched by the end of the tool, wherever: sine of the angle.
    const LEVEL: f64 = 1e-9;
    let outwards = if beside > LEVEL { (dr - dr2) / beside } else { 0.0 };
    let to_tip = if c.settings.rules.normal_length_with_dr2 {
        0.0
    } else {
        dr2
    };
    Ok([(dr2 + outwards) * u, (dr2 + outwards) * v, dr2 * w - to_tip])
}

/// DR and DR2, mm. Those of replacement tools are negative: a larger tool needs M107 [000:9177].
fn oversizes(modal: &Modal) -> Result<(f64, f64), Fault> {
    let Some(tool) = modal.tool else {
        return Ok((0.0, 0.0));
    };
    let dr2 = tool.shape.oversize.corner_radius;
    let dr = tool.shape.oversize.radius + tool.oversize[1];
    if (dr > 0.0 || dr2 > 0.0) && !modal.takes_larger_tools {
        let detail = format!(
            "tool {} is larger than the one that was computed with: DR {dr:+.4} DR2 {dr2:+.4} mm; M107 allows it",
            tool.number
        );
        return Err(Fault::new(MessageId::ToolRadiusTooLarge, detail));
    }
    Ok((dr, dr2))
}

/// A normal in the axes of the plane and the tool axis, as the transformations turn, mirror and stretch the surface.
fn in_plane(modal: &Modal, normal: &Position) -> [f64; 3] {
    let mut frame = modal.frame;
    frame.shift = Position::ZERO;
    // What stretches a surface flattens its normal.
    for axis in [Axis::X, Axis::Y, Axis::Z] {
        frame.factor[axis] = frame.factor[axis].signum() / frame.scale(axis);
    }
    frame.axis_scaling = None;
    let outer = frame.to_outer(normal);
    let plane = modal.plane;
    [plane.first, plane.second, plane.normal].map(|axis| outer[axis.main().unwrap_or(axis)])
}
