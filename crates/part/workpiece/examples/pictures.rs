//! Mills a sample part and writes its three views and its mesh into a folder:
//!
//! ```text
//! cargo run --release -p bahn-workpiece --example pictures -- out
//! ```

use std::error::Error;
use std::fs::{File, create_dir_all};
use std::io::BufWriter;
use std::path::PathBuf;

use bahn_path::{
    Arc, Axis, Blank, BlockRef, Curve, FeedRate, OverrideLaw, PathElement, Plane, Position, ToolShape,
};
use bahn_picture::Image;
use bahn_workpiece::{Page, PlanView, Projection, Resolution, ThreePlanes, View3d, Workpiece};

fn main() -> Result<(), Box<dyn Error>> {
    let folder = PathBuf::from(std::env::args().nth(1).unwrap_or_else(|| "out".to_owned()));
    create_dir_all(&folder)?;
    let blank = Blank {
        plane: Plane::XY,
        min: [0.0, 0.0, -30.0],
        max: [150.0, 100.0, 0.0],
    };
    let mut mill = Mill {
        workpiece: Workpiece::new(&blank, Resolution::BySize)?,
        tool: ToolShape::default(),
        at: Position::UNKNOWN,
    };
    sample_part(&mut mill);
    let part = mill.workpiece.finished();
    println!("removed {:.1} mm³", part.removed_mm3());

    let page = |note: &str| Page::standard("PGM SAMPLE", note);
    let save = |name: &str, image: Image| -> Result<(), Box<dyn Error>> {
        image.write_png(BufWriter::new(File::create(folder.join(name))?))?;
        Ok(())
    };
    save(
        "plan.png",
        part.plan_view(&page("plan view"), &PlanView::default()),
    )?;
    save(
        "plan-continuous.png",
        part.plan_view(
            &page("plan view"),
            &PlanView {
                levels: 0,
                ..PlanView::default()
            },
        ),
    )?;
    save(
        "three-planes.png",
        part.three_planes(&page("projection in 3 planes"), &ThreePlanes::default()),
    )?;
    let third = ThreePlanes {
        projection: Projection::ThirdAngle,
        sections: [Some(36.0), Some(30.0)],
        ..ThreePlanes::default()
    };
    save(
        "three-planes-third-angle.png",
        part.three_planes(&page("projection in 3 planes"), &third),
    )?;
    save("3d.png", part.view_3d(&page("3D view"), &View3d::default()))?;
    let left = View3d {
        azimuth_deg: -50.0,
        elevation_deg: 55.0,
        ..View3d::default()
    };
    save("3d-left.png", part.view_3d(&page("3D view"), &left))?;
    let below = View3d {
        azimuth_deg: 20.0,
        elevation_deg: -35.0,
        ..View3d::default()
    };
    save("3d-below.png", part.view_3d(&page("3D view from below"), &below))?;
    if let Some(detail) = part.detail([80.0, 15.0], [145.0, 90.0]) {
        save("3d-detail.png", detail.view_3d(&page("3D view MAGN"), &left))?;
    }
    part.write_stl(
        File::create(folder.join("part.stl"))?,
        &std::sync::atomic::AtomicBool::new(false),
    )?;
    Ok(())
}

struct Mill {
    workpiece: Workpiece,
    tool: ToolShape,
    at: Position,
}

impl Mill {
    fn tool(&mut self, radius: f64, corner_radius: f64) {
        self.tool = ToolShape {
            length: 0.0,
            radius,
            corner_radius,
            ..ToolShape::default()
        };
    }

    fn go(&mut self, curve: Curve, feed: FeedRate, x: f64, y: f64, z: f64) {
        let mut end = self.at;
        end[Axis::X] = x;
        end[Axis::Y] = y;
        end[Axis::Z] = z;
        let element = PathElement {
            block: BlockRef::default(),
            sequence: 0,
            curve,
            start: self.at,
            end,
            feed,
            override_law: OverrideLaw::Free,
            constant_speed: false,
            tangential_end: false,
            end_feed: None,
            dwell_s: 0.0,
            placement: None,
            functions: None,
        };
        self.workpiece.cut(&element, &self.tool, Axis::Z);
        self.at = end;
    }

    /// Rapid traverse at clearance height, then down.
    fn approach(&mut self, x: f64, y: f64, z: f64) {
        let [last_x, last_y] = [self.at[Axis::X], self.at[Axis::Y]];
        if !last_x.is_nan() {
            self.go(Curve::Line, FeedRate::Rapid, last_x, last_y, 2.0);
        }
        self.go(Curve::Line, FeedRate::Rapid, x, y, 2.0);
        self.line(x, y, z);
    }

    fn line(&mut self, x: f64, y: f64, z: f64) {
        self.go(Curve::Line, FeedRate::Programmed(500.0), x, y, z);
    }

    fn arc(&mut self, centre: [f64; 2], sweep_deg: f64, x: f64, y: f64, z: f64) {
        let arc = Arc {
            plane: Plane::XY,
            centre,
            sweep_deg,
        };
        self.go(Curve::Arc(arc), FeedRate::Programmed(500.0), x, y, z);
    }
}

fn sample_part(mill: &mut Mill) {
    // A step around the blank.
    mill.tool(10.0, 0.0);
    mill.approach(-12.0, 4.0, -6.0);
    for (x, y) in [(146.0, 4.0), (146.0, 96.0), (4.0, 96.0), (4.0, -12.0)] {
        mill.line(x, y, -6.0);
    }
    // A round pocket with a round island.
    mill.tool(4.0, 0.0);
    for depth in [-5.0, -10.0, -15.0] {
        for radius in [14.0, 18.0, 22.0, 24.0] {
            mill.approach(45.0 + radius, 50.0, depth);
            mill.arc([45.0, 50.0], 360.0, 45.0 + radius, 50.0, depth);
        }
    }
    // Bolt circle around the island, through.
    mill.tool(3.0, 0.0);
    for k in 0..6 {
        let (sin, cos) = (f64::from(k) * std::f64::consts::TAU / 6.0).sin_cos();
        mill.approach(45.0 + 19.0 * cos, 50.0 + 19.0 * sin, -32.0);
    }
    mill.approach(45.0, 50.0, -32.0);
    // A rectangular pocket with slanting walls left by a ball on ever smaller rectangles.
    mill.tool(3.0, 3.0);
    let mut inset = 0.0;
    while inset < 10.0 {
        let depth = -0.5 - 1.1 * inset;
        let (left, right, low, high) = (90.0 + inset, 134.0 - inset, 22.0 + inset, 52.0 - inset);
        mill.approach(left, low, depth);
        for (x, y) in [(right, low), (right, high), (left, high), (left, low)] {
            mill.line(x, y, depth);
        }
        inset += 0.35;
    }
    mill.tool(6.0, 2.0);
    for y in [34.0, 37.0, 40.0] {
        mill.approach(103.0, y, -12.0);
        mill.line(121.0, y, -12.0);
    }
    // A wave of a ball-nosed cutter.
    mill.tool(5.0, 5.0);
    mill.approach(86.0, 80.0, -2.0);
    for k in 0..=200 {
        let t = f64::from(k) / 200.0;
        let wave = (t * 3.0 * std::f64::consts::TAU).sin();
        mill.line(
            86.0 + 50.0 * t,
            74.0 + 7.0 * wave,
            -3.0 - 2.0 * (t * std::f64::consts::TAU).sin(),
        );
    }
    // A helix ramp of a flat end.
    mill.tool(2.5, 0.0);
    mill.approach(18.0, 20.0, 0.0);
    mill.arc(
        [24.0, 20.0],
        330.0,
        24.0 - 6.0 * 30f64.to_radians().cos(),
        20.0 + 3.0,
        -9.0,
    );
    mill.approach(24.0, 80.0, -8.0);
    mill.line(40.0, 88.0, -1.0);
}
