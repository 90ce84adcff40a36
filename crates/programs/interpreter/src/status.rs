//! Tool and spindle, and what of a run stays in force after its end.

use bahn_parameters::MessageId;
use bahn_path::{Axis, Frame, Plane, Position, Sense, ToolShape};

use crate::working_plane::{self, WorkingPlane};

/// A tool in the spindle.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Tool {
    pub number: u32,
    pub axis: Axis,
    pub shape: ToolShape,
    /// Radius with the oversize of TOOL CALL, mm; negative ones must not be used.
    pub radius: f64,
    /// DL and DR of TOOL CALL, mm.
    pub oversize: [f64; 2],
    /// Its data are in the program or in the tool table.
    pub defined: bool,
}

impl Tool {
    /// A tool with its data, and whether they were found, and the oversizes of its call, mm.
    pub fn new(number: u32, axis: Axis, data: (ToolShape, bool), oversize: [f64; 2]) -> Tool {
        let (mut shape, defined) = data;
        let [length, radius] = oversize;
        shape.length += length;
        Tool {
            number,
            axis,
            shape,
            radius: shape.radius + radius,
            oversize,
            defined,
        }
    }
}

/// Spindle state as Q110 counts it [003:7616-7619].
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Spindle {
    Undefined,
    Clockwise,
    CounterClockwise,
    StoppedAfterClockwise,
    StoppedAfterCounterClockwise,
}

impl Spindle {
    pub fn q110(self) -> f64 {
        match self {
            Spindle::Undefined => -1.0,
            Spindle::Clockwise => 0.0,
            Spindle::CounterClockwise => 1.0,
            Spindle::StoppedAfterClockwise => 2.0,
            Spindle::StoppedAfterCounterClockwise => 3.0,
        }
    }

    /// The sense of a way that is given for a spindle that turns clockwise: with M04 the other one mills alike.
    pub fn milled(self, sense: Sense) -> Sense {
        match self {
            Spindle::CounterClockwise => sense.opposite(),
            _ => sense,
        }
    }

    pub fn stopped(self) -> Spindle {
        match self {
            Spindle::Clockwise => Spindle::StoppedAfterClockwise,
            Spindle::CounterClockwise => Spindle::StoppedAfterCounterClockwise,
            other => other,
        }
    }
}

/// What is in force for swivel axes.
#[derive(Clone, Copy, Debug, Default)]
pub(crate) struct Tilting {
    /// Cycle 19: the tilted working plane, `None` without it.
    pub plane: Option<WorkingPlane>,
    /// M114: the tip stays on the path while the head turns.
    pub compensates: bool,
    /// M116: F of a rotary axis is mm/min at the surface.
    pub surface_feed: bool,
    /// M126, M127: which way rotary axes take.
    pub way: Way,
}

/// Which way a rotary axis with a modulo value takes.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub(crate) enum Way {
    /// As far as is programmed.
    #[default]
    Programmed,
    /// M126: to the next place that has the programmed angle.
    Shortest,
    /// M127 after M126: to that within the turn in which the axis stands, not over 0.
    WithinTurn,
}

/// The message of the transformation that must be reset before a surface is probed.
pub(crate) fn bars_probing(frame: &Frame) -> Option<MessageId> {
    let of_any = |is: fn(f64) -> bool| Axis::ALL.into_iter().any(|axis| is(frame.factor[axis]));
    if of_any(|factor| factor < 0.0) {
        Some(MessageId::MirroringNotPermitted)
    } else if frame.rotation_deg != 0.0 {
        Some(MessageId::RotationNotPermitted)
    } else if of_any(|factor| factor.abs() != 1.0) || frame.axis_scaling.is_some() {
        Some(MessageId::ScalingFactorNotAllowed)
    } else {
        None
    }
}

/// What of a run stays in force after its end until a machine cancels it: coordinate transformations, feed and
/// the data of the tool [003:6199-6205] [000:6589-6601].
#[derive(Clone, Debug, Default)]
pub struct Status {
    /// Transformations with their plane, and the feed.
    programmed: Option<(Frame, Option<f64>)>,
    /// The working plane after which the transformations stand.
    plane: Option<WorkingPlane>,
    tool: Option<Tool>,
    /// How the spindle of the machine turns, and its programmed speed, rpm.
    spindle: Option<(Spindle, f64)>,
}

impl Status {
    /// What a run leaves: transformations and feed, and the data of its tool.
    pub(crate) fn left(
        programmed: (Frame, Option<f64>),
        plane: Option<WorkingPlane>,
        tool: Option<Tool>,
    ) -> Status {
        Status {
            programmed: Some(programmed),
            plane,
            tool,
            spindle: None,
        }
    }

    /// The spindle turns already, clockwise as with M3 or the other way, for the operator or the PLC has switched it
    /// on; or it stands. Its speed as it was programmed last, rpm.
    pub fn take_spindle(&mut self, sense: Option<Sense>, speed_rpm: f64) {
        let spindle = match sense {
            Some(Sense::Clockwise) => Spindle::Clockwise,
            Some(Sense::CounterClockwise) => Spindle::CounterClockwise,
            None => Spindle::Undefined,
        };
        self.spindle = Some((spindle, speed_rpm));
    }

    pub(crate) fn spindle(&self) -> Option<(Spindle, f64)> {
        self.spindle
    }

    /// Cancels transformations and feed.
    pub fn cancel_programmed(&mut self) {
        self.programmed = None;
        self.plane = None;
    }

    /// Cancels the data of the tool.
    pub fn cancel_tool(&mut self) {
        self.tool = None;
    }

    /// Coordinate transformations, and the feed, mm/min; `None` once they are cancelled.
    pub(crate) fn programmed(&self) -> Option<(Frame, Option<f64>)> {
        self.programmed
    }

    /// The tilted working plane.
    pub(crate) fn plane(&self) -> Option<WorkingPlane> {
        self.plane
    }

    /// Machine positions of the swivel axes in the tilted working plane, degrees.
    pub fn plane_angles(&self) -> Option<Position> {
        self.plane.map(|plane| plane.angles)
    }

    /// Tilts the working plane as cycle 19 does, to machine positions of the swivel axes in degrees, or puts it upright:
    /// transformations are ended in the reverse order of their beginning [000:4254]. `false` where others than a datum shift
    /// are in force, and in the plane any. The basic rotation is not looked at.
    pub fn tilt(&mut self, angles: Option<Position>) -> bool {
        let (mut frame, feed) = self
            .programmed
            .unwrap_or_else(|| (Frame::identity(Plane::XY), None));
        // Every run has that of the machine.
        frame.basic_rotation_deg = 0.0;
        if working_plane::may_tilt(&frame, self.plane.is_some()).is_err() {
            return false;
        }
        let outer = working_plane::outer_of(&frame, self.plane.as_ref());
        let inner = angles.map_or(outer, |_| working_plane::within(&outer));
        self.programmed = Some((inner, feed));
        self.plane = angles.map(|angles| WorkingPlane { angles, outer });
        true
    }

    pub(crate) fn tool_data(&self) -> Option<Tool> {
        self.tool
    }

    /// Why nothing is probed by hand or digitized: a transformation is active [003:8053-8077].
    pub fn bars_probing(&self) -> Option<MessageId> {
        self.programmed.and_then(|(frame, _)| bars_probing(&frame))
    }

    /// The transformations that are in force.
    pub fn frame(&self) -> Frame {
        let programmed = self.programmed.map(|(frame, _)| frame);
        programmed.unwrap_or_else(|| Frame::identity(Plane::XY))
    }

    /// Number of the tool whose data are in force.
    pub fn tool(&self) -> Option<u32> {
        self.tool.map(|tool| tool.number)
    }
}
