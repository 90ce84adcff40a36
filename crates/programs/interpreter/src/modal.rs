//! Modal data: what stays in force from block to block.

use bahn_parameters::MessageId;
use bahn_path::{Axis, AxisSet, Curve, Cylinder, Frame, Plane, Point2, Position};
use bahn_program::{Compensation, InForce};

use crate::contour::{CornerArcs, FeedLaw, Side};
use crate::definition::{CycleData, Digitizing};
use crate::error::{Cause, Fault};
use crate::q_parameters::{QTable, preassigned};
use crate::status::{Spindle, Status, Tilting, Tool};

/// The modal data of a run [003:2164-2188] [003:6199-6205].
#[derive(Clone, Debug)]
pub(crate) struct Modal {
    /// Last programmed nominal position, workpiece coordinates.
    pub nominal: Position,
    /// Where the uncompensated path ended; differs from `nominal` after R+ and R-.
    pub actual: Position,
    /// After an interruption within a block: where the block began. Its incremental coordinates count from
    /// there, so that it ends where it was programmed to (inferred).
    pub increments_from: Option<Position>,
    /// Shift, mirror image, rotation and scaling.
    pub frame: Frame,
    /// Working plane of the tool axis.
    pub plane: Plane,
    /// The working plane with the parallel axes that were programmed last in place of their main axes
    /// [003:5397-5432]: the plane of radius compensation.
    pub contour_plane: Plane,
    /// Pole and circle centre, programmed coordinates, and the plane it was given in.
    pub pole: Option<(Plane, Point2)>,
    /// Polar radius that was programmed last, mm.
    pub polar_radius: Option<f64>,
    /// Last numeric feed, mm/min.
    pub feed_mm_min: Option<f64>,
    /// Radius compensation of contour blocks: off, left, right.
    pub compensation: Compensation,
    /// Radius compensation of paraxial blocks: off, R+, R-.
    pub paraxial: Compensation,
    /// Tool in the spindle.
    pub tool: Option<Tool>,
    /// Length that the position in the tool axis contains, mm; `None` as long as nobody knows it.
    pub length_mm: Option<f64>,
    /// Programmed spindle speed, rpm.
    pub speed_rpm: f64,
    pub spindle: Spindle,
    pub feed_law: FeedLaw,
    /// M112: arcs at corners of uncompensated lines.
    pub corner_arcs: Option<CornerArcs>,
    /// M124: points nearer to each other than this have no corners of M112, mm; 0: each counts.
    pub point_spacing_mm: f64,
    /// M107: LN blocks take tools that are larger than the one that was computed with.
    pub takes_larger_tools: bool,
    /// M103: factor of the feed into the material.
    pub plunge_factor: Option<f64>,
    /// Last movement in programmed coordinates, for tangential arcs.
    pub last_move: Option<LastMove>,
    /// The run began at a block after the beginning of its program, and has not moved since.
    pub begins_inside: bool,
    /// Cycle definition being read or ready for the call.
    pub cycle: CycleData,
    /// M89: call the cycle after every positioning block.
    pub cycle_after_each_block: bool,
    /// Cycle 13: angle of the oriented spindle stop, degrees.
    pub orientation_deg: Option<f64>,
    /// Cycle 14: labels of the subcontours.
    pub contour_labels: Vec<u16>,
    /// Least corner of BLK FORM 0.1 waiting for 0.2.
    pub blank_min: Option<(Plane, [f64; 3])>,
    /// The cylinder of cycle 27 while its contour is recorded.
    pub surface: Option<Surface>,
    /// Swivel axes: cycle 19, M114, M116, M126.
    pub tilting: Tilting,
    /// Probe block 0.0 waiting for 0.1.
    pub probe: Option<ReferencePlane>,
    /// Blocks of TCH PROBE 30, 31 or 32 that were read.
    pub measuring: Option<MeasuringBlocks>,
    /// TCH PROBE 5 to 7.
    pub digitizing: Digitizing,
    /// The G functions in force.
    pub in_force: InForce,
}

/// The surface of cycle 27 in which a contour is recorded.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Surface {
    /// Q16: radius of the cylinder, mm.
    pub radius_mm: f64,
    /// Q17: the rotary axis is programmed in program units, not in degrees.
    pub linear: bool,
    /// The cylinder, and where its centre is along the tool axis, mm, from the first block on.
    pub found: Option<(Cylinder, f64)>,
}

/// First block of TCH PROBE 0: result parameter, axis and direction [003:4414-4428].
#[derive(Clone, Copy, Debug)]
pub(crate) struct ReferencePlane {
    pub target: u16,
    pub axis: Axis,
    /// +1 in positive, -1 in negative axis direction.
    pub direction: f64,
}

/// Blocks of TCH PROBE 31 or 32 that were read; height in mm.
#[derive(Clone, Copy, Debug)]
pub(crate) struct MeasuringBlocks {
    pub number: u16,
    /// The block that was read last.
    pub sub: u16,
    pub check: bool,
    pub result: Option<u16>,
    pub height: f64,
    pub teeth: bool,
}

/// The last movement in programmed coordinates.
#[derive(Clone, Copy, Debug)]
pub(crate) struct LastMove {
    pub curve: Curve,
    pub start: Position,
    pub end: Position,
}

impl Modal {
    /// What stays in force after the end.
    pub fn status(&self) -> Status {
        Status::left((self.frame, self.feed_mm_min), self.tilting.plane, self.tool)
    }

    pub fn new(start: Position, length_mm: Option<f64>) -> Modal {
        Modal {
            nominal: start,
            actual: start,
            increments_from: None,
            frame: Frame::identity(Plane::XY),
            plane: Plane::XY,
            contour_plane: Plane::XY,
            pole: None,
            polar_radius: None,
            feed_mm_min: None,
            compensation: Compensation::Off,
            paraxial: Compensation::Off,
            tool: None,
            length_mm,
            speed_rpm: 0.0,
            spindle: Spindle::Undefined,
            feed_law: FeedLaw::Centre,
            corner_arcs: None,
            point_spacing_mm: 0.0,
            takes_larger_tools: false,
            plunge_factor: None,
            last_move: None,
            begins_inside: false,
            cycle: CycleData::default(),
            cycle_after_each_block: false,
            orientation_deg: None,
            contour_labels: Vec::new(),
            blank_min: None,
            surface: None,
            tilting: Tilting::default(),
            probe: None,
            measuring: None,
            digitizing: Digitizing::default(),
            in_force: InForce::default(),
        }
    }

    /// Takes the working plane of a tool axis.
    pub fn take_plane(&mut self, plane: Plane) {
        self.plane = plane;
        self.contour_plane = plane;
        self.frame.plane = plane;
    }

    /// Takes the axes of a block into the plane of compensation: U stands for X until X is programmed again.
    pub fn take_contour_axes(&mut self, axes: AxisSet) {
        let chosen = |current: Axis| {
            let same = |axis: &Axis| axis.main() == current.main() && !axis.is_rotary();
            axes.iter().find(same).unwrap_or(current)
        };
        self.contour_plane.first = chosen(self.contour_plane.first);
        self.contour_plane.second = chosen(self.contour_plane.second);
    }

    /// Radius of the tool in use, mm; 0 without a tool.
    pub fn tool_radius(&self) -> f64 {
        self.tool.map_or(0.0, |tool| tool.radius.max(0.0))
    }

    /// Side of the tool in workpiece coordinates: a mirrored contour has it on the other side.
    pub fn side(&self) -> Side {
        let side = match self.compensation {
            Compensation::Left => Side::Left,
            Compensation::Right => Side::Right,
            _ => return Side::Off,
        };
        if self.frame.reverses(self.contour_plane) {
            side.mirrored()
        } else {
            side
        }
    }

    /// Scaling factor in the working plane.
    ///
    /// # Errors
    /// PLANE WRONGLY DEFINED where its axes have different ones: a radius would become an ellipse.
    pub fn plane_scale(&self) -> Result<f64, Fault> {
        let [first, second] = [self.plane.first, self.plane.second].map(|axis| self.frame.scale(axis));
        if first != second {
            let detail = "the axes of the plane have different scaling factors";
            return Err(Fault::new(MessageId::PlaneWronglyDefined, detail));
        }
        Ok(first)
    }

    /// The spindle turns, or stands, as Q110 says.
    pub fn set_spindle(&mut self, spindle: Spindle, q: &mut QTable) {
        self.spindle = spindle;
        q.preassign(preassigned::SPINDLE, spindle.q110());
    }

    /// Sets the spindle to M5, and Q110 with it.
    pub fn stop_spindle(&mut self, q: &mut QTable) {
        self.set_spindle(self.spindle.stopped(), q);
    }

    /// Radius of the tool in use for compensation and pockets, mm.
    ///
    /// # Errors
    /// With R + DR below zero.
    pub fn used_radius(&self) -> Result<f64, Fault> {
        match self.tool {
            Some(tool) if tool.radius < 0.0 => {
                let detail = format!("R + DR of tool {} is {:.4} mm", tool.number, tool.radius);
                Err(Fault::new(MessageId::EntryValueIncorrect, detail))
            }
            tool => Ok(tool.map_or(0.0, |tool| tool.radius)),
        }
    }

    /// Why the tool in use has no radius.
    pub fn no_radius(&self, what: &str) -> Fault {
        let why = match self.tool {
            Some(tool) if !tool.defined => {
                format!("tool {} is not defined, so its radius is 0", tool.number)
            }
            Some(tool) => format!("the radius of tool {} is 0", tool.number),
            None => "no tool is called, so the radius is 0".to_owned(),
        };
        Fault::new(MessageId::ToolRadiusTooLarge, format!("{what}: {why}")).because(Cause::NoToolRadius)
    }

    /// The frame has changed: the tangent of the last movement is no longer known in it.
    pub fn forget_tangent(&mut self) {
        self.last_move = None;
    }
}
