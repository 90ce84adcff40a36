//! Cycles 3, 4 and 5: slot, rectangular pocket, circular pocket.
//!
//! The path patterns of the manual are lost figures (8.4 to 8.10); these patterns machine the same
//! contour with the stepover that the manual gives (inferred).
//!
//! Decision: Path patterns of the pocket cycles (the manual's figures are lost)

use bahn_parameters::MessageId;
use bahn_path::{Axis, Plane, Point2, Sense};

use super::machining::{Heights, Machining, Tracer, infeeds};
use crate::definition::Definition;
use crate::error::Fault;
use crate::modal::Modal;
use crate::settings::Settings;
use crate::status::Spindle;

const SAME_MM: f64 = 1e-9;

/// Cycle 3 SLOT MILLING: the tool stands one radius inside the slot's end on its centre line; roughing
/// to and fro with an infeed at each end, then finishing by a quarter circle and climb milling the
/// contour [003:5110-5146] (geometry inferred from the example).
pub(super) fn slot_milling(m: &mut Machining<'_>, definition: &Definition) -> Result<(), Fault> {
    let setup = definition.length(1, 0)?;
    let depth = definition.length(2, 0)?;
    let pecking = definition.length(3, 0)?;
    let plunge_feed = definition.feed(3, 0)?;
    let (length_axis, length) = definition.coordinate(4)?;
    let (width_axis, width) = definition.coordinate(5)?;
    let feed = definition.feed(6, 0)?;
    let [along, _] = plane_axes(m.modal.plane, [length_axis, width_axis])?;
    let heights = m.heights(definition, [setup, depth], Some(pecking))?;
    let scale = m.modal.plane_scale()?;
    let radius = m.modal.used_radius()?;
    let travel = length.abs() * scale - 2.0 * radius;
    let allowance = 0.5 * width.abs() * scale - radius;
    // Cutter diameter between half the slot width and the slot width [003:5130-5132].
    let too_small = allowance > radius + SAME_MM;
    if allowance < -SAME_MM || travel < -SAME_MM || too_small {
        let detail = "the cutter diameter must lie between half the slot width and the slot width";
        return Err(Fault::new(MessageId::ToolRadiusTooLarge, detail));
    }
    let unit: Point2 = if along == 0 {
        [length.signum(), 0.0]
    } else {
        [0.0, length.signum()]
    };
    // Climb milling inside is counter-clockwise with the spindle clockwise.
    let climb = if m.modal.spindle == Spindle::CounterClockwise {
        -1.0
    } else {
        1.0
    };
    let pecks = infeeds(heights.depth, pecking * heights.depth / depth.abs());
    let plane = plane_with(m.modal.plane, [length_axis, width_axis]);
    let mut trace = m.tracer();
    trace.set_plane(plane);
    let mut far = false;
    for depth in &pecks {
        trace.feed_height(heights.at_depth(*depth), plunge_feed);
        far = !far;
        trace.line(if far { scaled(unit, travel) } else { [0.0, 0.0] }, feed);
    }
    if allowance > SAME_MM {
        finish_slot(&mut trace, unit, travel.max(0.0), allowance, far, climb, feed);
    }
    trace.rapid_height(heights.clearance);
    trace.rapid([0.0, 0.0]);
    trace.finish()
}

/// Cycle 4 POCKET MILLING: rectangles that grow from the centre by the stepover K·R; the first leg runs
/// in the positive direction of the longer side, along the second axis for a square
/// [003:5223-5278].
pub(super) fn pocket_milling(m: &mut Machining<'_>, definition: &Definition) -> Result<(), Fault> {
    let setup = definition.length(1, 0)?;
    let depth = definition.length(2, 0)?;
    let pecking = definition.length(3, 0)?;
    let plunge_feed = definition.feed(3, 0)?;
    let (first_axis, first) = definition.coordinate(4)?;
    let (second_axis, second) = definition.coordinate(5)?;
    let feed = definition.feed(6, 0)?;
    let corner = definition.optional_length(6, 0).unwrap_or(0.0).abs() * m.modal.plane_scale()?;
    let mut sides = [0.0; 2];
    let indices = plane_axes(m.modal.plane, [first_axis, second_axis])?;
    for (index, side) in indices.into_iter().zip([first, second]) {
        if let Some(slot) = sides.get_mut(index) {
            *slot = side.abs() * m.modal.plane_scale()?;
        }
    }
    let heights = m.heights(definition, [setup, depth], Some(pecking))?;
    let radius = m.modal.tool_radius();
    let half = [0.5 * sides[0] - radius, 0.5 * sides[1] - radius];
    if half[0] < -SAME_MM || half[1] < -SAME_MM {
        return Err(Fault::new(
            MessageId::ToolRadiusTooLarge,
            "the tool does not fit into the pocket",
        ));
    }
    let sense = m.modal.spindle.milled(definition.sense(6));
    let rings = Rectangles {
        half: [half[0].max(0.0), half[1].max(0.0)],
        step: stepover(m.modal, m.settings)?,
        tool_radius: radius,
        corner: (corner - radius).max(0.0),
        sense,
    };
    let pecks = infeeds(heights.depth, pecking * heights.depth / depth.abs());
    let plane = plane_with(m.modal.plane, [first_axis, second_axis]);
    let feeds = [plunge_feed, feed];
    mill_layers(m, plane, &heights, &pecks, feeds, |trace| rings.mill(trace, feed))
}

/// Cycle 5 CIRCULAR POCKET: a spiral from the centre, then the full circle [003:5313-5336].
pub(super) fn circular_pocket(m: &mut Machining<'_>, definition: &Definition) -> Result<(), Fault> {
    let setup = definition.length(1, 0)?;
    let depth = definition.length(2, 0)?;
    let pecking = definition.length(3, 0)?;
    let plunge_feed = definition.feed(3, 0)?;
    let pocket_radius = definition.length(4, 0)?.abs() * m.modal.plane_scale()?;
    let feed = definition.feed(5, 0)?;
    let heights = m.heights(definition, [setup, depth], Some(pecking))?;
    let radius = pocket_radius - m.modal.tool_radius();
    if radius < -SAME_MM {
        return Err(Fault::new(
            MessageId::ToolRadiusTooLarge,
            "the tool does not fit into the pocket",
        ));
    }
    let step = stepover(m.modal, m.settings)?;
    let sense = m.modal.spindle.milled(definition.sense(5));
    let pecks = infeeds(heights.depth, pecking * heights.depth / depth.abs());
    let feeds = [plunge_feed, feed];
    let plane = m.modal.contour_plane;
    mill_layers(m, plane, &heights, &pecks, feeds, |trace| {
        spiral(trace, radius.max(0.0), step, sense, feed);
    })
}

/// The working plane with parallel axes in place of their main axes where a cycle names them.
fn plane_with(plane: Plane, axes: [Axis; 2]) -> Plane {
    let named = |axis: Axis| axes.into_iter().find(|a| a.main() == axis.main()).unwrap_or(axis);
    Plane {
        first: named(plane.first),
        second: named(plane.second),
        normal: plane.normal,
    }
}

/// Mills the same pattern at each infeed from the centre and ends at the start position.
fn mill_layers(
    m: &mut Machining<'_>,
    plane: Plane,
    heights: &Heights,
    pecks: &[f64],
    [plunge_feed, feed]: [f64; 2],
    mut layer: impl FnMut(&mut Tracer<'_>),
) -> Result<(), Fault> {
    let mut trace = m.tracer();
    trace.set_plane(plane);
    for depth in pecks {
        if trace.is_full() {
            break;
        }
        trace.feed_height(heights.at_depth(*depth), plunge_feed);
        layer(&mut trace);
        trace.line([0.0, 0.0], feed);
    }
    trace.rapid_height(heights.clearance);
    trace.finish()
}

/// Stepover k = K · R with the overlap factor MP7430 [003:5270-5278].
fn stepover(modal: &Modal, settings: &Settings) -> Result<f64, Fault> {
    let step = settings.rules.overlap * modal.used_radius()?;
    if step <= 0.0 {
        return Err(modal.no_radius("a pocket cannot be cleared"));
    }
    Ok(step)
}

/// The indices of the two sides in the plane, of which each has an axis of its own.
fn plane_axes(plane: Plane, sides: [Axis; 2]) -> Result<[usize; 2], Fault> {
    let [first, second] = sides;
    let indices = [plane_axis(plane, first)?, plane_axis(plane, second)?];
    match indices[0] == indices[1] {
        true => Err(Fault::new(
            MessageId::WrongAxisProgrammed,
            "length and width lie on the same axis",
        )),
        false => Ok(indices),
    }
}

/// Index of an axis in the working plane; other axes are WRONG AXIS PROGRAMMED [003:8022-8025].
fn plane_axis(plane: Plane, axis: Axis) -> Result<usize, Fault> {
    if axis.main() == plane.first.main() {
        Ok(0)
    } else if axis.main() == plane.second.main() {
        Ok(1)
    } else {
        Err(Fault::new(
            MessageId::WrongAxisProgrammed,
            format!("{axis} is not in the working plane"),
        ))
    }
}

/// Finishing of a slot: quarter circle to the side, once round the contour, quarter circle back. In the
/// system of the slot's end, x points into the slot and y to the side so that climb milling starts at -y.
fn finish_slot(
    trace: &mut Tracer<'_>,
    unit: Point2,
    travel: f64,
    allowance: f64,
    far: bool,
    climb: f64,
    feed: f64,
) {
    let (end, inward) = if far {
        (scaled(unit, travel), scaled(unit, -1.0))
    } else {
        ([0.0, 0.0], unit)
    };
    let side = [-inward[1] * climb, inward[0] * climb];
    let at = |x: f64, y: f64| {
        [
            end[0] + x * inward[0] + y * side[0],
            end[1] + x * inward[1] + y * side[1],
        ]
    };
    let a = allowance;
    // A slot shorter than the quarter circle is entered straight.
    let lead = a.min(0.5 * travel);
    let smooth = lead >= a;
    if smooth {
        trace.arc(at(a, 0.0), at(a, -a), 90.0 * climb, feed);
    } else {
        trace.line(at(lead, -a), feed);
    }
    for (x, y) in [(travel, -a), (travel, a), (0.0, a), (0.0, -a), (lead, -a)] {
        trace.line(at(x, y), feed);
    }
    if smooth {
        trace.arc(at(a, 0.0), at(2.0 * a, 0.0), 90.0 * climb, feed);
    } else {
        trace.line(at(lead, 0.0), feed);
    }
}

/// Concentric rectangles of the tool centre.
struct Rectangles {
    /// Half sides of the last rectangle.
    half: [f64; 2],
    step: f64,
    tool_radius: f64,
    /// Corner radius of the last rectangle.
    corner: f64,
    sense: Sense,
}

impl Rectangles {
    fn mill(&self, trace: &mut Tracer<'_>, feed: f64) {
        // In the system of the longer side: x along it, y across; a square begins along the second axis.
        let long_first = self.half[0] > self.half[1] + SAME_MM;
        let (long, short) = if long_first {
            (self.half[0], self.half[1])
        } else {
            (self.half[1], self.half[0])
        };
        let core = long - short;
        // Swapping the axes turns the sense of rotation around.
        let turn = self.sense.sign() * if long_first { 1.0 } else { -1.0 };
        let map = |x: f64, y: f64| if long_first { [x, y] } else { [y, x] };
        let mut side = 1.0;
        if core > SAME_MM {
            trace.line(map(core, 0.0), feed);
            if self.step > self.tool_radius {
                // The first rectangle leaves a strip in the middle: mill the core to both ends.
                trace.line(map(-core, 0.0), feed);
                side = -1.0;
            }
        }
        let rings = (short / self.step - SAME_MM).ceil().max(1.0) as u64;
        for ring in 1..=rings {
            if trace.is_full() {
                return;
            }
            let y = (ring as f64 * self.step).min(short);
            let x = core + y;
            let corner = if ring == rings { self.corner.min(y) } else { 0.0 };
            // Half a turn of the whole pattern keeps the sense: start at (side·x, 0).
            let at = |px: f64, py: f64| map(side * px, side * py * turn);
            self.rectangle(trace, [x, y], corner, at, feed);
        }
    }

    fn rectangle(
        &self,
        trace: &mut Tracer<'_>,
        [x, y]: [f64; 2],
        corner: f64,
        at: impl Fn(f64, f64) -> Point2,
        feed: f64,
    ) {
        let sweep = 90.0 * self.sense.sign();
        trace.line(at(x, 0.0), feed);
        let mut rounded = |before: Point2, corner_point: Point2, after: Point2| {
            trace.line(at(before[0], before[1]), feed);
            if corner > SAME_MM {
                let centre = [
                    corner_point[0] - corner * corner_point[0].signum(),
                    corner_point[1] - corner * corner_point[1].signum(),
                ];
                trace.arc(at(centre[0], centre[1]), at(after[0], after[1]), sweep, feed);
            }
        };
        let c = corner;
        rounded([x, y - c], [x, y], [x - c, y]);
        rounded([-x + c, y], [-x, y], [-x, y - c]);
        rounded([-x, -y + c], [-x, -y], [-x + c, -y]);
        rounded([x - c, -y], [x, -y], [x, -y + c]);
        trace.line(at(x, 0.0), feed);
    }
}

/// Half circles whose diameter grows by the stepover each turn, then the full circle.
fn spiral(trace: &mut Tracer<'_>, radius: f64, step: f64, sense: Sense, feed: f64) {
    let turn = sense.sign();
    let mut x = 0.0f64;
    let mut side = 1.0;
    while x < radius - SAME_MM && !trace.is_full() {
        let next = (x + 0.5 * step).min(radius);
        let centre = 0.5 * (x - next) * side;
        trace.arc([centre, 0.0], [-side * next, 0.0], 180.0 * turn, feed);
        side = -side;
        x = next;
    }
    if radius > SAME_MM {
        trace.arc([0.0, 0.0], [side * radius, 0.0], 360.0 * turn, feed);
    }
}

fn scaled(v: Point2, factor: f64) -> Point2 {
    [v[0] * factor, v[1] * factor]
}
