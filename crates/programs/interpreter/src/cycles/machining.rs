//! What the machining cycles share: working direction, infeeds, and tracing of movements.
//!
//! Decision: Working direction of a cycle is the sign of DEPTH; other signs of SETUP and PECKG warn, strict checking
//! refuses them

use bahn_parameters::MessageId;
use bahn_path::{
    Arc, At, Curve, FeedRate, Function, OverrideLaw, Plane, Point2, Position, SpindleOrder, Synchronisation,
    TechnologyFunction,
};

use crate::context::Context;
use crate::definition::Definition;
use crate::error::{Fault, WarningKind};
use crate::modal::Modal;
use crate::numbers::known;
use crate::pen::Pen;
use crate::q_parameters::{QTable, cos_deg, sin_deg};
use crate::reported::Reported;
use crate::settings::Settings;

/// Heights of a cycle along the tool axis, absolute workpiece coordinates, mm. The tool stands at the
/// setup clearance when the cycle is called [003:4898-4910].
#[derive(Clone, Copy, Debug)]
pub(super) struct Heights {
    /// Where the tool stood at the call.
    pub clearance: f64,
    /// Working direction: -1 into a workpiece below the tool.
    pub direction: f64,
    /// Surface of the workpiece.
    pub surface: f64,
    /// Total depth below the surface, mm, positive.
    pub depth: f64,
    /// Where cycles with a clearance height of their own go down to in rapid traverse.
    pub approach: Option<f64>,
}

impl Heights {
    /// The height at a depth below the surface.
    pub fn at_depth(&self, depth: f64) -> f64 {
        self.surface + self.direction * depth
    }
}

/// What the machining cycles work with.
pub(super) struct Machining<'a> {
    pub modal: &'a mut Modal,
    pub pen: &'a mut Pen,
    /// Q110 follows the spindle.
    pub q: &'a mut QTable,
    pub reported: &'a mut Reported,
    pub settings: &'a Settings,
}

impl<'a> Machining<'a> {
    pub fn new(c: &'a mut Context<'_>) -> Machining<'a> {
        Machining {
            modal: c.modal,
            pen: c.pen,
            q: &mut c.numbers.q,
            reported: c.reported,
            settings: c.settings,
        }
    }

    /// Heights from SETUP and DEPTH. The sign of DEPTH is the working direction; another sign of SETUP or
    /// PECKG is accepted with a warning, in strict checking it is WRONG SIGN PROGRAMMED [003:4902].
    pub fn heights(
        &mut self,
        definition: &Definition,
        [setup, depth]: [f64; 2],
        pecking: Option<f64>,
    ) -> Result<Heights, Fault> {
        if depth == 0.0 {
            return Err(Fault::new(MessageId::CyclIncomplete, "the depth is 0"));
        }
        if pecking == Some(0.0) {
            return Err(Fault::new(MessageId::CyclIncomplete, "the pecking depth is 0"));
        }
        let other_sign = |value: f64| value != 0.0 && value.signum() != depth.signum();
        if other_sign(setup) || pecking.is_some_and(other_sign) {
            if self.settings.strict {
                let detail = "setup clearance, depth and pecking depth must have the same sign";
                return Err(Fault::new(MessageId::WrongSignProgrammed, detail));
            }
            if self.modal.cycle.machining.report_sign() {
                let cycle = definition.number;
                self.reported
                    .warn(definition.at, WarningKind::CycleSign { cycle });
            }
        }
        let scale = self.modal.frame.scale(self.modal.plane.normal);
        let clearance = known(self.pen.tool_centre(self.modal)[self.modal.plane.normal]);
        let direction = depth.signum();
        Ok(Heights {
            clearance,
            direction,
            surface: clearance + direction * setup.abs() * scale,
            depth: depth.abs() * scale,
            approach: None,
        })
    }

    /// Begins to trace the movements of a cycle from where the tool stands.
    pub fn tracer(&mut self) -> Tracer<'_> {
        let at = self.pen.tool_centre(self.modal);
        let mut origin = at;
        let plane = self.modal.plane;
        let point = plane.point(&at).map(known);
        plane.set(&mut origin, point);
        let axes = [[1.0, 0.0], [0.0, 1.0]].map(|v| plane_direction(self.modal, v));
        let reversed = self.modal.frame.reverses(plane);
        let room = if self.pen.rehearsal { 0 } else { MOVEMENTS_MAX };
        Tracer {
            modal: self.modal,
            pen: self.pen,
            at: origin,
            origin: point,
            axes,
            reversed,
            plane,
            override_law: OverrideLaw::Free,
            on_the_way: None,
            room,
        }
    }
}

/// A direction of the programmed plane in workpiece coordinates: mirrored and rotated, not scaled.
pub(super) fn plane_direction(modal: &Modal, v: Point2) -> Point2 {
    let frame = &modal.frame;
    let plane = modal.plane;
    let mirrored = [
        v[0] * frame.factor[plane.first].signum(),
        v[1] * frame.factor[plane.second].signum(),
    ];
    let (sin, cos) = (sin_deg(frame.turn_deg()), cos_deg(frame.turn_deg()));
    [
        mirrored[0] * cos - mirrored[1] * sin,
        mirrored[0] * sin + mirrored[1] * cos,
    ]
}

/// The depths of the infeeds below the surface: multiples of the pecking depth, the total depth last
/// [003:4935-4937].
pub(super) fn infeeds(depth: f64, pecking: f64) -> Vec<f64> {
    /// More cuts than this are taken for a wrong entry; the rest is one cut.
    const CUTS_MAX: usize = 100_000;
    const SAME_DEPTH_MM: f64 = 1e-9;
    let pecking = pecking.abs();
    let mut depths: Vec<f64> = (1..CUTS_MAX)
        .map(|i| i as f64 * pecking)
        .take_while(|reached| *reached < depth - SAME_DEPTH_MM && pecking > 0.0)
        .collect();
    depths.push(depth);
    depths
}

/// Traces the movements of a cycle. Points are given in a system at the start position with the axes of
/// the programmed plane, so that mirroring and rotation act on the pattern [003:6276-6284].
pub(super) struct Tracer<'a> {
    modal: &'a mut Modal,
    pen: &'a mut Pen,
    at: Position,
    origin: Point2,
    axes: [Point2; 2],
    reversed: bool,
    plane: Plane,
    override_law: OverrideLaw,
    /// A function of the next movement.
    on_the_way: Option<TechnologyFunction>,
    /// Movements that may still be made.
    room: usize,
}

/// Movements of one cycle call. More are taken for a wrong entry (a stepover or infeed far too small), so
/// that a call stays in bounded memory and time.
const MOVEMENTS_MAX: usize = 500_000;

impl Tracer<'_> {
    /// Whether the cycle has used up its movements: patterns stop, and [`Tracer::finish`] says so.
    pub fn is_full(&self) -> bool {
        self.room == 0
    }

    /// Sets what the feed override may do to the movements that follow.
    pub fn set_override_law(&mut self, law: OverrideLaw) {
        self.override_law = law;
    }

    /// The plane of the movements.
    pub fn plane(&self) -> Plane {
        self.plane
    }

    /// Moves in another plane of the same tool axis: one with parallel axes [003:5397-5432].
    pub fn set_plane(&mut self, plane: Plane) {
        self.plane = plane;
        self.origin = plane.point(&self.at).map(known);
    }

    /// Where the cycle has a clearance height of its own, the tool goes there first.
    pub fn lift(&mut self, heights: &Heights) {
        if heights.approach.is_some() {
            self.rapid_height(heights.clearance);
        }
    }

    /// Along the tool axis at rapid traverse.
    pub fn rapid_height(&mut self, height: f64) {
        self.height(height, FeedRate::Rapid);
    }

    /// Along the tool axis at a feed rate.
    pub fn feed_height(&mut self, height: f64, feed_mm_min: f64) {
        self.height(height, FeedRate::Programmed(feed_mm_min));
    }

    fn height(&mut self, height: f64, feed: FeedRate) {
        let mut end = self.at;
        end[self.plane.normal] = height;
        self.movement(Curve::Line, end, feed);
    }

    /// Straight in the plane at rapid traverse.
    pub fn rapid(&mut self, local: Point2) {
        self.straight(local, FeedRate::Rapid);
    }

    /// Straight in the plane.
    pub fn line(&mut self, local: Point2, feed_mm_min: f64) {
        self.straight(local, FeedRate::Programmed(feed_mm_min));
    }

    fn straight(&mut self, local: Point2, feed: FeedRate) {
        let mut end = self.at;
        self.plane.set(&mut end, self.outer(local));
        self.movement(Curve::Line, end, feed);
    }

    /// An arc about a local centre through a sweep, degrees, counter-clockwise positive.
    pub fn arc(&mut self, centre: Point2, end: Point2, sweep_deg: f64, feed_mm_min: f64) {
        let sweep_deg = if self.reversed { -sweep_deg } else { sweep_deg };
        let arc = Arc {
            plane: self.plane,
            centre: self.outer(centre),
            sweep_deg,
        };
        let mut to = self.at;
        self.plane.set(&mut to, self.outer(end));
        self.movement(Curve::Arc(arc), to, FeedRate::Programmed(feed_mm_min));
    }

    /// A movement in workpiece coordinates; movements without length are left out.
    pub fn movement(&mut self, curve: Curve, end: Position, feed: FeedRate) {
        const NO_MOVE_MM: f64 = 1e-9;
        let length = curve.length(&self.at, &end);
        let first_position = !end.known().iter().all(|axis| self.at.get(axis).is_some());
        if (length > NO_MOVE_MM || first_position) && self.room > 0 {
            self.room -= 1;
            let mut element = self.pen.element(curve, self.at, end, feed);
            element.override_law = self.override_law;
            element.functions = self
                .on_the_way
                .take()
                .map(|function| Box::new([function]) as Box<[_]>);
            self.pen.since_motion = 0;
            self.pen.out.push(element, None);
        }
        self.at = end;
    }

    /// Time at the place where the tool stands.
    pub fn dwell(&mut self, seconds: f64) {
        if seconds > 0.0 {
            let mut element = self.pen.element(Curve::Hold, self.at, self.at, FeedRate::Rapid);
            element.dwell_s = seconds;
            element.override_law = self.override_law;
            self.pen.out.push(element, None);
        }
    }

    /// An order to the spindle where the tool stands.
    pub fn order(&mut self, order: SpindleOrder) {
        let mut element = self.pen.element(Curve::Hold, self.at, self.at, FeedRate::Rapid);
        element.override_law = self.override_law;
        let order = spindle_function(order, At::Start, Synchronisation::MvsSvs);
        element.functions = Some(Box::new([order]));
        self.pen.out.push(element, None);
    }

    /// An order to the spindle so long before the end of the next movement, s, for which the path does not wait.
    pub fn order_before_end(&mut self, order: SpindleOrder, lead_s: f64) {
        let order = spindle_function(order, At::BeforeEnd(lead_s), Synchronisation::Mos);
        self.on_the_way = Some(order);
    }

    /// Where the tool stands.
    pub fn position(&self) -> Position {
        self.at
    }

    /// Ends the cycle: the run goes on from where the tool stands.
    pub fn finish(self) -> Result<(), Fault> {
        if self.pen.rehearsal {
            // Cycles end where they began, more or less.
            return Ok(());
        }
        if self.is_full() {
            let detail = format!("the cycle needs more than {MOVEMENTS_MAX} movements");
            return Err(Fault::new(MessageId::EntryValueIncorrect, detail));
        }
        if self.pen.tool_centre(self.modal) != self.at {
            self.modal.actual = self.at;
            self.modal.nominal = self.at;
        }
        Ok(())
    }

    fn outer(&self, local: Point2) -> Point2 {
        let [u, v] = self.axes;
        [
            self.origin[0] + local[0] * u[0] + local[1] * v[0],
            self.origin[1] + local[0] * u[1] + local[1] * v[1],
        ]
    }
}

/// The M function with which a cycle orders the spindle.
fn spindle_function(order: SpindleOrder, at: At, synchronisation: Synchronisation) -> TechnologyFunction {
    let code = match order {
        SpindleOrder::Clockwise => 3,
        SpindleOrder::CounterClockwise => 4,
        SpindleOrder::Stop | SpindleOrder::StopWithRun => 5,
    };
    TechnologyFunction {
        spindle: Some(order),
        ..TechnologyFunction::new(Function::M(code), at, synchronisation)
    }
}
