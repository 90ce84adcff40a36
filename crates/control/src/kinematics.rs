//! Between the path and the axes: the kinematics of a channel, and what is superimposed on it.

use bahn_path::{Axis, Curve, Function, Position};

/// The least and greatest machine position of each axis; infinite where there is no limit.
pub(crate) type Box2 = [Position; 2];

/// What is added between path and axes: the workpiece datum with its correction by the PLC and, in the tool
/// axis, the length of the tool.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Offsets {
    /// Machine position of the workpiece datum, mm or degrees.
    pub datum: Position,
    /// Axis of the tool.
    pub tool_axis: Axis,
    /// Length of the tool, mm.
    pub tool_length: f64,
}

impl Offsets {
    /// What is added to a path position.
    pub fn of(&self, axis: Axis) -> f64 {
        let length = if axis == self.tool_axis {
            self.tool_length
        } else {
            0.0
        };
        self.datum[axis] + length
    }

    /// Takes the tool of a call.
    pub(crate) fn take(&mut self, function: &Function) {
        if let Function::Tool(call) = function {
            self.tool_axis = call.axis;
            self.tool_length = call.shape.length;
        }
    }
}

/// How the axes of a channel stand when the tool is at a place of the path, and the reverse. Slots without a
/// position are NaN and stay so.
pub trait Kinematics: std::fmt::Debug + Send + Sync {
    /// The axis positions of a path position, machine coordinates, mm or degrees.
    fn to_axes(&self, path: &Position, offsets: &Offsets) -> Position;

    /// The path position of axis positions.
    fn to_path(&self, axes: &Position, offsets: &Offsets) -> Position;

    /// The least and greatest axis positions on a curve from a start to an end: software limits are checked
    /// here, behind the kinematics.
    fn bounds(&self, curve: &Curve, start: &Position, end: &Position, offsets: &Offsets) -> [Position; 2];
}

/// Each axis moves one coordinate of the path.
#[derive(Clone, Copy, Debug, Default)]
pub struct Cartesian;

impl Kinematics for Cartesian {
    fn to_axes(&self, path: &Position, offsets: &Offsets) -> Position {
        Axis::ALL.map(|axis| path[axis] + offsets.of(axis)).into()
    }

    fn to_path(&self, axes: &Position, offsets: &Offsets) -> Position {
        Axis::ALL.map(|axis| axes[axis] - offsets.of(axis)).into()
    }

    fn bounds(&self, curve: &Curve, start: &Position, end: &Position, offsets: &Offsets) -> [Position; 2] {
        curve
            .bounds(start, end)
            .map(|corner| self.to_axes(&corner, offsets))
    }
}

/// The kinematics of a channel with what is superimposed on it now.
#[derive(Clone, Debug)]
pub(crate) struct Chain {
    kinematics: std::sync::Arc<dyn Kinematics>,
    pub offsets: Offsets,
}

impl Chain {
    pub fn new(kinematics: std::sync::Arc<dyn Kinematics>, offsets: Offsets) -> Chain {
        Chain { kinematics, offsets }
    }

    /// The same kinematics with other offsets.
    pub fn with(&self, offsets: Offsets) -> Chain {
        Chain {
            offsets,
            ..self.clone()
        }
    }

    /// The axis positions of a path position.
    pub fn to_axes(&self, path: &Position) -> Position {
        self.kinematics.to_axes(path, &self.offsets)
    }

    /// The path position of axis positions.
    pub fn to_path(&self, axes: &Position) -> Position {
        self.kinematics.to_path(axes, &self.offsets)
    }

    /// The least and greatest axis positions on a curve.
    pub fn bounds(&self, curve: &Curve, start: &Position, end: &Position) -> Box2 {
        self.kinematics.bounds(curve, start, end, &self.offsets)
    }
}
