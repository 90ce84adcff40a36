//! The shape of the tool from below.

use bahn_path::ToolShape;

use crate::grid::Grid;

/// Tool with a round bottom profile: flat inside `flat`, then a quarter circle of radius `corner` up
/// to `radius = flat + corner`, mm; or a cone whose tip is the lowest point.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Tool {
    pub radius: f64,
    pub corner: f64,
    /// Rise of the cone for each mm from the axis; 0 without a point.
    pub cone: f64,
}

/// The four cases that have their own arithmetic.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Bottom {
    Flat,
    Ball,
    Torus,
    Cone,
}

impl Tool {
    /// `None` for a tool without a radius: it removes nothing. A tool that is thinner than the columns
    /// is widened so that its trace stays visible (inferred).
    pub fn new(shape: &ToolShape, grid: &Grid) -> Option<Tool> {
        if !(shape.radius.is_finite() && shape.radius > 0.0) {
            return None;
        }
        let radius = shape.radius.max(grid.half_diagonal());
        let corner = shape.corner_radius.max(0.0).min(shape.radius);
        let point = ToolShape::POINT_ANGLE_MIN_DEG..180.0;
        let cone = if corner == 0.0 && point.contains(&shape.point_angle_deg) {
            1.0 / (0.5 * shape.point_angle_deg).to_radians().tan()
        } else {
            0.0
        };
        Some(Tool { radius, corner, cone })
    }

    pub fn bottom(&self) -> Bottom {
        if self.cone > 0.0 {
            Bottom::Cone
        } else if self.corner <= 0.0 {
            Bottom::Flat
        } else if self.corner >= self.radius {
            Bottom::Ball
        } else {
            Bottom::Torus
        }
    }

    /// Radius of the flat part of the bottom, mm.
    pub fn flat(&self) -> f64 {
        self.radius - self.corner
    }

    /// The tool that a rapid traverse is checked with: thinner by a column, so that a wall which lies
    /// between two columns is no cut.
    pub fn thinner(&self, grid: &Grid) -> Tool {
        let radius = (self.radius - grid.cell()).max(0.5 * self.radius);
        Tool {
            radius,
            corner: self.corner.min(radius),
            cone: self.cone,
        }
    }
}
