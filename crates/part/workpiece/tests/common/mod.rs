//! Path elements for tests.
#![allow(dead_code)]

use bahn_path::{
    Arc, Axis, Blank, BlockRef, Curve, FeedRate, OverrideLaw, PathElement, Plane, Position, ToolShape,
};
use bahn_workpiece::{Resolution, Workpiece};

/// 100 x 80 mm, 20 mm thick, top at Z0.
pub const BLANK: Blank = Blank {
    plane: Plane::XY,
    min: [0.0, 0.0, -20.0],
    max: [100.0, 80.0, 0.0],
};

pub fn at(x: f64, y: f64, z: f64) -> Position {
    let mut p = Position::UNKNOWN;
    p[Axis::X] = x;
    p[Axis::Y] = y;
    p[Axis::Z] = z;
    p
}

pub fn flat(radius: f64) -> ToolShape {
    ToolShape {
        length: 0.0,
        radius,
        corner_radius: 0.0,
        ..ToolShape::default()
    }
}

pub fn ball(radius: f64) -> ToolShape {
    ToolShape {
        length: 0.0,
        radius,
        corner_radius: radius,
        ..ToolShape::default()
    }
}

pub fn torus(radius: f64, corner_radius: f64) -> ToolShape {
    ToolShape {
        length: 0.0,
        radius,
        corner_radius,
        ..ToolShape::default()
    }
}

/// A drill with a point.
pub fn drill(radius: f64, point_angle_deg: f64) -> ToolShape {
    ToolShape {
        point_angle_deg,
        ..flat(radius)
    }
}

pub fn element(curve: Curve, start: Position, end: Position) -> PathElement {
    PathElement {
        block: BlockRef { program: 0, block: 7 },
        sequence: 1,
        curve,
        start,
        end,
        feed: FeedRate::Programmed(100.0),
        override_law: OverrideLaw::Free,
        constant_speed: false,
        tangential_end: false,
        end_feed: None,
        dwell_s: 0.0,
        placement: None,
        functions: None,
    }
}

pub fn line(start: Position, end: Position) -> PathElement {
    element(Curve::Line, start, end)
}

pub fn rapid(start: Position, end: Position) -> PathElement {
    PathElement {
        feed: FeedRate::Rapid,
        ..line(start, end)
    }
}

pub fn arc(plane: Plane, start: Position, end: Position, centre: [f64; 2], sweep_deg: f64) -> PathElement {
    element(
        Curve::Arc(Arc {
            plane,
            centre,
            sweep_deg,
        }),
        start,
        end,
    )
}

pub fn workpiece(mm: f64) -> Workpiece {
    Workpiece::new(&BLANK, Resolution::Millimetres(mm)).unwrap()
}

/// Volume that the elements remove from [`BLANK`] at a resolution.
pub fn removed(mm: f64, tool: ToolShape, elements: &[PathElement]) -> f64 {
    let mut workpiece = workpiece(mm);
    for element in elements {
        workpiece.cut(element, &tool, Axis::Z);
    }
    workpiece.part().removed_mm3()
}
