//! Where a tool and the contact of the tool probe meet: one place for each touch of a measuring [000:7960-8058].
//!
//! A tool that turns is touched once. Teeth are touched one by one, each turned to the contact: the first
//! looks in the angle reference axis when the spindle is oriented to 0° (inferred). Calibrating touches the upper face and four sides, each side a
//! second time with the spindle turned by half a turn, so that a tool that runs out of true does not count (inferred).
//!
//! Decision: Of single teeth the first looks in the angle reference axis when the spindle is at 0°; the longest is
//! the tool, the one that is farthest off counts for the tolerances; the PLC orients (MP6560 > 0) to the angle of
//! cycle 13

use bahn_parameters::machining::ToolProbeParameters;
use bahn_path::{Axis, Direction, MeasuredPart, Plane, Position, ToolMeasuring};

use crate::tool::{Edges, Tool, in_table_steps};

/// Touches of one measuring at most: the teeth of a tool table.
const TOUCHES_MAX: usize = 20;
/// Touches of the sides in calibrating; the upper face comes before.
const SIDES: usize = 8;
/// How much more teeth turned by half a turn are.
const HALF_TURN_DEG: f64 = 180.0;

/// One touch of a measuring.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Contact {
    pub axis: Axis,
    /// +1 in positive direction.
    pub direction: f64,
    /// The stop before the contact, and the farthest place, path coordinates.
    pub before: Position,
    pub farthest: Position,
    /// What the path coordinate is where a tool as the table says touches.
    pub expected: f64,
    /// The tool stands with the spindle at this angle; `None` when it turns.
    pub orientation_deg: Option<f64>,
}

/// All touches of a measuring, and what was found at those that are over.
#[derive(Clone, Debug)]
pub(crate) struct Contacts {
    order: ToolMeasuring,
    parameters: ToolProbeParameters,
    plane: Plane,
    /// The middle of the upper face, path coordinates of the tip of the tool.
    centre: Position,
    radius: f64,
    edges: Edges,
    differences: [f64; TOUCHES_MAX],
    at: usize,
}

impl Contacts {
    /// Those of an order; `None` when the tool cannot be measured so.
    pub fn new(
        order: ToolMeasuring,
        parameters: ToolProbeParameters,
        tool: &Tool,
        plane: Plane,
        centre: Position,
    ) -> Option<Contacts> {
        let teeth = usize::from(tool.edges.count);
        let counted = !order.teeth || (1..=TOUCHES_MAX).contains(&teeth);
        let contacts = Contacts {
            order,
            parameters,
            plane,
            centre,
            radius: tool.shape.radius,
            edges: tool.edges,
            differences: [0.0; TOUCHES_MAX],
            at: 0,
        };
        (counted && contacts.radius > 0.0).then_some(contacts)
    }

    fn count(&self) -> usize {
        match self.order.part {
            MeasuredPart::Probe => 1 + SIDES,
            _ if self.order.teeth => usize::from(self.edges.count),
            _ => 1,
        }
    }

    /// The spindle is oriented for the touches.
    pub fn stands(&self) -> bool {
        self.order.teeth || self.order.part == MeasuredPart::Probe
    }

    /// The touch that is next, `None` after the last one.
    pub fn next(&self) -> Option<Contact> {
        let at = Some(self.at).filter(|at| *at < self.count())?;
        Some(match (self.order.part, at) {
            (MeasuredPart::Probe, 0) => self.face(0.0, Some(0.0)),
            (MeasuredPart::Probe, _) => {
                let (side, again) = ((at - 1) / 2, at % 2 == 0);
                let axis = if side < 2 {
                    self.plane.first
                } else {
                    self.plane.second
                };
                let direction = if side % 2 == 0 { 1.0 } else { -1.0 };
                let depth = self.parameters.depth_mm + self.edges.length_offset;
                self.side(
                    axis,
                    direction,
                    depth,
                    Some(if again { HALF_TURN_DEG } else { 0.0 }),
                )
            }
            (MeasuredPart::Radius, _) => {
                let parameters = &self.parameters;
                let (axis, turn) = match parameters.across {
                    true => (self.plane.second, 90.0),
                    false => (self.plane.first, 0.0),
                };
                let direction = parameters.direction.sign();
                let turn = match parameters.direction {
                    Direction::Minus => turn + HALF_TURN_DEG,
                    Direction::Plus => turn,
                };
                let depth = parameters.depth_mm + self.edges.length_offset;
                self.side(axis, direction, depth, self.tooth(at, turn))
            }
            // The tooth looks back to the middle of the contact.
            (MeasuredPart::Length, _) => self.face(self.beside(), self.tooth(at, HALF_TURN_DEG)),
        })
    }

    /// The difference between tool and table that a touch has shown, mm; positive for more.
    pub fn take(&mut self, contact: &Contact, touch: f64) {
        if let Some(difference) = self.differences.get_mut(self.at) {
            *difference = (contact.expected - touch) * contact.direction;
        }
        self.at += 1;
    }

    /// What a measuring of the tool has found: its longest tooth, and of all the one that is farthest off.
    pub fn found(&self) -> [f64; 2] {
        let found = self.differences.get(..self.count()).unwrap_or_default();
        let longest = found.iter().copied().fold(f64::NEG_INFINITY, f64::max);
        let farthest = found.iter().copied().fold(
            0.0,
            |most: f64, one| if one.abs() > most.abs() { one } else { most },
        );
        [longest, farthest].map(in_table_steps)
    }

    /// What calibrating has found: the middle of the upper face (X, Y, Z), and the width of the contact, mm.
    pub fn calibrated(&self) -> ([f64; 3], f64) {
        let [
            top,
            first,
            first_again,
            back,
            back_again,
            second,
            second_again,
            front,
            front_again,
            ..,
        ] = self.differences;
        let mean = |a: f64, b: f64| f64::midpoint(a, b);
        let first = [mean(first, first_again), mean(back, back_again)];
        let second = [mean(second, second_again), mean(front, front_again)];
        let mut centre = self.parameters.centre_mm;
        let middles = [
            (self.plane.first, (first[1] - first[0]) / 2.0),
            (self.plane.second, (second[1] - second[0]) / 2.0),
            (self.plane.normal, top),
        ];
        for (place, axis) in [Axis::X, Axis::Y, Axis::Z].into_iter().enumerate() {
            let off = middles.iter().find(|(own, _)| *own == axis).map(|(_, off)| *off);
            if let Some(value) = centre.get_mut(place) {
                *value += off.unwrap_or_default();
            }
        }
        let wider = mean(first[0] + first[1], second[0] + second[1]);
        (centre, self.parameters.width_mm + wider)
    }

    /// How far from its axis the length of a tool is measured: R-OFFS, of single teeth without it the radius
    /// (inferred: as the successors).
    fn beside(&self) -> f64 {
        match self.edges.radius_offset {
            0.0 if self.order.teeth => self.radius,
            offset => offset,
        }
    }

    /// The spindle angle at which a tooth looks to an angle of the plane. Seen from the spindle M3, the sense in which
    /// its angle counts, turns against that of the plane.
    fn tooth(&self, at: usize, looks_deg: f64) -> Option<f64> {
        let pitch = 360.0 / f64::from(self.edges.count.max(1));
        (self.order.teeth).then(|| (at as f64 * pitch - looks_deg).rem_euclid(360.0))
    }

    fn face(&self, beside: f64, orientation_deg: Option<f64>) -> Contact {
        let (mut before, mut farthest) = (self.centre, self.centre);
        let normal = self.plane.normal;
        for place in [&mut before, &mut farthest] {
            place[self.plane.first] += beside;
        }
        before[normal] += self.parameters.safety_mm;
        farthest[normal] -= self.parameters.safety_mm;
        Contact {
            axis: normal,
            direction: -1.0,
            before,
            farthest,
            expected: self.centre[normal],
            orientation_deg,
        }
    }

    fn side(&self, axis: Axis, direction: f64, depth: f64, orientation_deg: Option<f64>) -> Contact {
        let reach = self.parameters.width_mm / 2.0 + self.radius;
        let (mut before, mut farthest) = (self.centre, self.centre);
        before[axis] -= direction * (reach + self.parameters.safety_mm);
        farthest[axis] += direction * (reach + self.parameters.safety_mm);
        for place in [&mut before, &mut farthest] {
            place[self.plane.normal] -= depth;
        }
        Contact {
            axis,
            direction,
            before,
            farthest,
            expected: self.centre[axis] - direction * reach,
            orientation_deg,
        }
    }
}
