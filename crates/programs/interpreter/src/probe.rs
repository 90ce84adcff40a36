//! Touch probe blocks: measuring in the program.

use bahn_parameters::MessageId;
use bahn_path::{Axis, Barrier, Curve, FeedRate, LiveData, Position};
use bahn_program::CycleBlock;

use crate::availability::Feature;
use crate::context::Context;
use crate::definition::{Resolved, resolve};
use crate::digitize::digitize;
use crate::error::Fault;
use crate::modal::{Modal, ReferencePlane};
use crate::numbers::{Numbers, known};
use crate::pen::Pen;
use crate::q_parameters::{QTable, preassigned};
use crate::settings::ProbeRules;
use crate::tilting::works_as_defined;

/// A probing that waits for its touch.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Probing {
    pub axis: Axis,
    pub target: u16,
    /// +1 in positive, -1 in negative axis direction.
    pub direction: f64,
    pub radius: f64,
    /// Pre-position to which the probe returns.
    pub before: Position,
}

/// TCH PROBE 0.0 and 0.1, the measuring function.
pub(crate) fn probe(c: &mut Context<'_>, block: &CycleBlock) -> Result<Option<Probing>, Fault> {
    if !c.executes(Feature::Probe(block.number))? {
        return Ok(None);
    }
    if block.number != 0 {
        return digitize(c, block).map(|()| None);
    }
    let words = resolve(block, c.numbers, c.settings)?;
    match block.sub {
        0 => reference_plane(c.modal, &c.numbers.q, &words).map(|()| None),
        1 => start_probing(c, &words).map(Some),
        _ => Err(Fault::new(
            MessageId::CyclIncomplete,
            "TCH PROBE 0 has two blocks",
        )),
    }
}

fn reference_plane(modal: &mut Modal, q: &QTable, words: &[Resolved]) -> Result<(), Fault> {
    let target = words.iter().find_map(|word| match word {
        Resolved::Target(number) => Some(*number),
        _ => None,
    });
    let direction = words.iter().find_map(|word| match word {
        Resolved::AxisDirection(axis, direction) => Some((*axis, direction.sign())),
        _ => None,
    });
    let (Some(target), Some((axis, direction))) = (target, direction) else {
        let detail = "TCH PROBE 0.0 needs a Q parameter and an axis with direction";
        return Err(Fault::new(MessageId::CyclIncomplete, detail));
    };
    q.get(target)?;
    modal.probe = Some(ReferencePlane {
        target,
        axis,
        direction,
    });
    Ok(())
}

/// TCH PROBE 0.1: in rapid to a point MP6140 before the nominal point, then with probing feed until
/// the stylus is deflected (inferred from MP6120-MP6150) [003:4401-4432].
fn start_probing(c: &mut Context<'_>, words: &[Resolved]) -> Result<Probing, Fault> {
    let Some(plane) = c.modal.probe.take() else {
        return Err(Fault::new(MessageId::CyclIncomplete, "TCH PROBE 0.0 is missing"));
    };
    works_as_defined(c)?;
    let rules = &c.settings.rules.probe;
    c.pen.finish_contour()?;
    if !c.settings.rules.probe_keeps_tool {
        take_probe_as_tool(c.modal, c.numbers, rules);
    }
    let frame = c.modal.frame;
    let mut nominal = frame.to_programmed(&c.modal.nominal);
    for word in words {
        if let Resolved::Coordinate {
            axis,
            value,
            incremental,
        } = word
        {
            let value = value * c.numbers.axis_unit(*axis);
            nominal[*axis] = if *incremental {
                known(nominal[*axis]) + value
            } else {
                value
            };
        }
    }
    if nominal.get(plane.axis).is_none() {
        let detail = format!("the position to probe has no {}", plane.axis);
        return Err(Fault::new(MessageId::CyclIncomplete, detail));
    }
    let mut before = nominal;
    before[plane.axis] -= plane.direction * rules.clearance_mm;
    let mut farthest = before;
    farthest[plane.axis] += plane.direction * rules.range_mm.max(rules.clearance_mm);
    let (before, farthest) = (frame.to_outer(&before), frame.to_outer(&farthest));
    approach_probe_point(c.modal, c.pen, &before, rules);
    c.modal.feed_mm_min.get_or_insert(rules.feed_mm_min);
    c.modal.actual = before;
    c.modal.nominal = before;
    c.modal.last_move = None;
    c.pen.out.barrier(Barrier::Probe {
        block: c.pen.block,
        from: before,
        to: farthest,
        feed_mm_min: rules.feed_mm_min,
        stylus_radius: rules.radius_mm,
    });
    Ok(Probing {
        axis: plane.axis,
        target: plane.target,
        direction: plane.direction,
        radius: rules.radius_mm,
        before,
    })
}

/// MP7411 = 0: the tool data are overwritten with those of the calibrated probe [003:7365-7369].
fn take_probe_as_tool(modal: &mut Modal, numbers: &mut Numbers, rules: &ProbeRules) {
    if let Some(tool) = &mut modal.tool {
        tool.radius = rules.radius_mm;
        tool.shape.radius = rules.radius_mm;
        tool.shape.length = rules.length_mm;
    }
    numbers
        .q
        .preassign(preassigned::TOOL_RADIUS, rules.radius_mm / numbers.main_unit_mm());
    numbers
        .q
        .preassign(preassigned::TOOL_LENGTH, rules.length_mm / numbers.main_unit_mm());
}

/// In the working plane first when the tool axis goes down, the tool axis first when it goes up, so
/// that the stylus does not meet the workpiece on its way.
fn approach_probe_point(modal: &Modal, pen: &mut Pen, before: &Position, rules: &ProbeRules) {
    let normal = modal.plane.normal;
    let from = modal.actual;
    let up = before[normal] > from[normal];
    let mut corner = *before;
    if up {
        corner = from;
        corner[normal] = before[normal];
    } else if !from[normal].is_nan() {
        corner[normal] = from[normal];
    }
    let feed = FeedRate::Programmed(rules.rapid_mm_min);
    for (start, end) in [(from, corner), (corner, *before)] {
        if start != end {
            let element = pen.element(Curve::Line, start, end, feed);
            pen.out.push(element, None);
        }
    }
    pen.since_motion = 0;
}

/// How far the ball stands beside the spindle in an axis of the plane, as it is programmed.
fn beside(modal: &Modal, axis: Axis, rules: &ProbeRules) -> f64 {
    let plane = modal.plane;
    let place = |of: [f64; 2]| {
        let mut position = modal.actual;
        let here = plane.point(&modal.actual);
        plane.set(&mut position, [here[0] + of[0], here[1] + of[1]]);
        modal.frame.to_programmed(&position)[axis]
    };
    match rules.offset_mm {
        [0.0, 0.0] => 0.0,
        offset => place(offset) - place([0.0; 2]),
    }
}

/// Takes the touch: the measured coordinate goes to the Q parameter, the position to Q115-Q118.
pub(crate) fn finish_probing(c: &mut Context<'_>, probing: &Probing, live: &LiveData) -> Result<(), Fault> {
    let Some(touch) = live.touch else {
        return Err(MessageId::TouchPointInaccessible.into());
    };
    if touch.position == probing.before {
        return Err(MessageId::StylusAlreadyInContact.into());
    }
    let unit = c.numbers.unit_mm;
    let position = c.modal.frame.to_programmed(&touch.position);
    let along_tool_axis = probing.axis == c.modal.plane.normal;
    // In the tool axis the tip itself touches, in the plane the ball touches beside its centre.
    let surface = if along_tool_axis {
        0.0
    } else {
        probing.direction * probing.radius + beside(c.modal, probing.axis, &c.settings.rules.probe)
    };
    c.numbers
        .q
        .set(probing.target, (position[probing.axis] + surface) / unit)?;
    for (number, axis) in (preassigned::TOUCH..).zip([Axis::X, Axis::Y, Axis::Z, Axis::C]) {
        if let Some(value) = position.get(axis) {
            c.numbers.q.preassign(number, value / c.numbers.axis_unit(axis));
        }
    }
    // To the surface and back to the pre-position.
    let feed = FeedRate::Programmed(c.settings.rules.probe.feed_mm_min);
    let back = FeedRate::Programmed(c.settings.rules.probe.rapid_mm_min);
    let ways = [
        (probing.before, touch.position, feed),
        (touch.position, probing.before, back),
    ];
    // On a machine the axes stand at the touch already.
    for (start, end, feed) in ways.into_iter().skip(usize::from(c.settings.machine)) {
        let element = c.pen.element(Curve::Line, start, end, feed);
        c.pen.out.push(element, None);
    }
    Ok(())
}
