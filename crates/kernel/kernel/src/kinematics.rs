//! Between the path and the axes: the kinematics of a channel, and what is superimposed on it.

use std::sync::Arc;

use bahn_path::{Axis, Curve, Function, PathElement, PerAxis, Placement, Position};

use crate::superimposing::Superimposed;

/// The least and greatest machine position of each axis; infinite where there is no limit.
pub type Box2 = [Position; 2];

/// What is added between path and axes: the workpiece datum with its correction by the PLC and, in the tool
/// axis, the length of the tool.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Offsets {
    /// Machine position of the workpiece datum, mm or degrees.
    pub datum: Position,
    /// Axis along which the tool lies: its length counts there.
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
    pub fn take(&mut self, function: &Function) {
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
    /// here, after the kinematics.
    fn bounds(&self, curve: &Curve, start: &Position, end: &Position, offsets: &Offsets) -> [Position; 2];

    /// By how much each axis moves at most when a slot of the path moves by 1: a row for each axis, a column for each
    /// slot. Feed and acceleration of the path are such that no axis exceeds its own.
    fn shares(&self) -> Shares {
        PerAxis::from_fn(|axis| PerAxis::from_fn(|slot| if slot == axis { 1.0 } else { 0.0 }))
    }
}

/// Shares of the axes in the slots of the path, as [`Kinematics::shares`] gives them.
pub type Shares = PerAxis<PerAxis<f64>>;

/// What each slot of the path may have of something of which each axis has a limit, so that all slots together leave no
/// axis more than its limit.
pub fn along_path(shares: &Shares, limits: &PerAxis<f64>) -> PerAxis<f64> {
    PerAxis::from_fn(|slot| {
        let rows = shares.iter().zip(limits.iter());
        let moved = rows.filter(|(row, _)| row[slot] != 0.0);
        let each = moved.map(|(row, limit)| limit / row.iter().map(|share| share.abs()).sum::<f64>());
        each.fold(f64::INFINITY, f64::min)
    })
}

/// Each axis moves one coordinate of the path.
#[derive(Clone, Copy, Debug, Default)]
pub struct Cartesian;

impl Kinematics for Cartesian {
    fn to_axes(&self, path: &Position, offsets: &Offsets) -> Position {
        PerAxis::from_fn(|axis| path[axis] + offsets.of(axis)).into()
    }

    fn to_path(&self, axes: &Position, offsets: &Offsets) -> Position {
        PerAxis::from_fn(|axis| axes[axis] - offsets.of(axis)).into()
    }

    fn bounds(&self, curve: &Curve, start: &Position, end: &Position, offsets: &Offsets) -> [Position; 2] {
        curve
            .bounds(start, end)
            .map(|corner| self.to_axes(&corner, offsets))
    }
}

/// The kinematics of a channel with what is superimposed on it now.
#[derive(Clone, Debug)]
pub struct Chain {
    kinematics: Arc<dyn Kinematics>,
    /// Datum and tool that stand between path and machine positions.
    pub offsets: Offsets,
    /// What the handwheel adds to the axes.
    pub superimposed: Superimposed,
    /// How the path stands that is executed, when not upright.
    placement: Option<Arc<Placement>>,
}

impl Chain {
    /// A kinematics upright, with nothing superimposed.
    pub fn new(kinematics: Arc<dyn Kinematics>, offsets: Offsets) -> Chain {
        Chain {
            kinematics,
            offsets,
            superimposed: Superimposed::default(),
            placement: None,
        }
    }

    /// The kinematics without datum, tool, handwheel and tilted plane.
    pub fn kinematics(&self) -> &dyn Kinematics {
        self.kinematics.as_ref()
    }

    /// The path stands in this placement from now on.
    pub fn place(&mut self, placement: Option<&Arc<Placement>>) {
        if !Placement::is_same(self.placement.as_ref(), placement) {
            self.placement = placement.cloned();
        }
    }

    /// How the path stands, when not upright.
    pub fn placement(&self) -> Option<&Arc<Placement>> {
        self.placement.as_ref()
    }

    /// The same kinematics and offsets, without a placement.
    pub fn upright(&self) -> Chain {
        Chain {
            placement: None,
            ..self.clone()
        }
    }

    /// What is added after a placement, which has the tool in it.
    fn after(&self) -> Offsets {
        Offsets {
            tool_length: 0.0,
            ..self.offsets
        }
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
        self.superimposed.added(self.without_wheels(path), 1.0)
    }

    /// The axis positions of a path position, without what the handwheel adds to them.
    pub fn without_wheels(&self, path: &Position) -> Position {
        match &self.placement {
            None => self.kinematics.to_axes(path, &self.offsets),
            Some(placement) => self.kinematics.to_axes(&placement.to_nose(path), &self.after()),
        }
    }

    /// The path position of axis positions.
    pub fn to_path(&self, axes: &Position) -> Position {
        self.placed(&self.superimposed.added(*axes, -1.0), self.placement.as_deref())
    }

    /// Where the tool is in the coordinates that are shown, beside which the handwheel may have led it: those of the
    /// path, but on a cylinder those of the axes (inferred).
    pub fn tip(&self, axes: &Position) -> Position {
        let placement = self.placement.as_deref();
        self.placed(axes, placement.filter(|placement| placement.cylinder().is_none()))
    }

    fn placed(&self, axes: &Position, placement: Option<&Placement>) -> Position {
        match placement {
            None => self.kinematics.to_path(axes, &self.offsets),
            Some(placement) => placement.from_nose(&self.kinematics.to_path(axes, &self.after())),
        }
    }

    /// The least and greatest axis positions on an element, in the placement that it has.
    pub fn bounds(&self, element: &PathElement) -> Box2 {
        let PathElement {
            curve, start, end, ..
        } = element;
        match &element.placement {
            None => self.kinematics.bounds(curve, start, end, &self.offsets),
            Some(placement) => {
                let [least, greatest] = placement.bounds(curve, start, end);
                self.kinematics
                    .bounds(&Curve::Line, &least, &greatest, &self.after())
            }
        }
    }
}
