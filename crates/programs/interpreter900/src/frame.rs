//! From the coordinates of a program to positions of the control, and back.
//!
//! Decision: Programmed coordinates are mirrored about their zero, then rotated by G45, then shifted by zero point, G92 and
//! axis shifts; the tool length is added along the normal axis of the plane (the manual names the parts, not their order)

use bahn_path::{Axis, PerAxis, Position};
use bahn_system900::{Memory, PathParameter};

use crate::modal::{Modal, Rotation};
use crate::refusal::Refusal;
use crate::run::ChannelAxes;

/// How the coordinates of a program stand in those of the control.
#[derive(Clone, Debug)]
pub(crate) struct Frame {
    offset: PerAxis<f64>,
    /// First and second axis of the plane, where the channel has them.
    plane: [Option<Axis>; 2],
    mirrors: [bool; 2],
    rotation: Option<Rotation>,
}

impl Frame {
    /// That of a block.
    pub fn of(memory: &Memory, channel: u8, axes: &ChannelAxes, modal: &Modal) -> Result<Frame, Refusal> {
        let words = memory.plane_axes(channel, modal.plane);
        let [first, second, normal] = words.map(|logical| axes.slot(logical));
        let mut offset = modal.shift;
        for (logical, axis) in axes.iter() {
            let Some(point) = memory.zero_point(channel, modal.zero_point, logical) else {
                return Err(Refusal::of(format!(
                    "the channel has no zero point G{} in work area {}",
                    modal.zero_point,
                    memory.path(channel, PathParameter::WorkArea).written()
                )));
            };
            offset[axis] += point;
            if modal.shifts_axes {
                let at = u32::from(logical) - 1;
                let own = memory.path_at(channel, PathParameter::AxisShift, at);
                offset[axis] += own.number().unwrap_or(0.0);
            }
        }
        if let Some(normal) = normal {
            offset[normal] += memory.tool_of(channel, PathParameter::ActiveTool).length;
        }
        Ok(Frame {
            offset,
            plane: [first, second],
            mirrors: modal.mirrors,
            rotation: modal.rotation,
        })
    }

    /// The position of the control for coordinates of the program.
    pub fn to_control(&self, program: &Position) -> Position {
        let mut position = *program;
        if let [Some(first), Some(second)] = self.plane {
            let mut point = [position[first], position[second]];
            for (value, mirrored) in point.iter_mut().zip(self.mirrors) {
                if mirrored {
                    *value = -*value;
                }
            }
            if let Some(Rotation { origin, angle_deg }) = self.rotation {
                let (sin, cos) = angle_deg.to_radians().sin_cos();
                let [u, v] = point;
                point = [u * cos - v * sin + origin[0], u * sin + v * cos + origin[1]];
            }
            [position[first], position[second]] = point;
        }
        for axis in Axis::ALL {
            position[axis] += self.offset[axis];
        }
        position
    }

    /// The coordinates of the program for a position of the control.
    pub fn to_program(&self, position: &Position) -> Position {
        let mut program = *position;
        for axis in Axis::ALL {
            program[axis] -= self.offset[axis];
        }
        if let [Some(first), Some(second)] = self.plane {
            let mut point = [program[first], program[second]];
            if let Some(Rotation { origin, angle_deg }) = self.rotation {
                let (sin, cos) = angle_deg.to_radians().sin_cos();
                let [x, y] = [point[0] - origin[0], point[1] - origin[1]];
                point = [x * cos + y * sin, y * cos - x * sin];
            }
            for (value, mirrored) in point.iter_mut().zip(self.mirrors) {
                if mirrored {
                    *value = -*value;
                }
            }
            [program[first], program[second]] = point;
        }
        program
    }

    /// The sense of rotation is the other one where one axis of the plane is mirrored.
    pub fn turns_over(&self) -> bool {
        self.mirrors[0] != self.mirrors[1]
    }
}
