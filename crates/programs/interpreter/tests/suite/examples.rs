//! The shipped example programs run to their end and mill what they say.

use std::collections::BTreeSet;
use std::f64::consts::PI;
use std::path::PathBuf;

use crate::support::*;
use bahn_path::ToolShape;

fn folder() -> PathBuf {
    PathBuf::from(env!("CARGO_MANIFEST_DIR")).join("../../../examples")
}

/// Runs an example with the tools of `tools.tsv` where it defines none.
fn example(name: &str) -> Run {
    let text = std::fs::read(folder().join(name)).unwrap();
    let mut job =
        Job::new(text.clone()).library("NUT", std::fs::read_to_string(folder().join("NUT.H")).unwrap());
    if !String::from_utf8_lossy(&text).contains("TOOL DEF") {
        let table = std::fs::read_to_string(folder().join("tools.tsv")).unwrap();
        let tools = table.lines().skip(1).map(|line| {
            let mut columns = line.split('\t');
            let mut number = || columns.next().unwrap().parse::<f64>().unwrap();
            let (tool, length, radius, corner_radius) = (number(), number(), number(), number());
            (
                tool as u32,
                ToolShape {
                    length,
                    radius,
                    corner_radius,
                    ..ToolShape::default()
                },
            )
        });
        job = job.with(|s| s.tools = Some(tools.collect()));
    }
    // The probe meets a level surface.
    let run = job.surfaces(&[-1.35, -1.35]).run();
    run.assert_completed();
    run
}

fn names() -> BTreeSet<String> {
    let files = std::fs::read_dir(folder())
        .unwrap()
        .map(|file| file.unwrap().file_name().into_string().unwrap());
    files
        .filter(|name| name.ends_with(".H") && name != "NUT.H")
        .collect()
}

/// Every example removes material, none of it in rapid traverse, none below the blank, without a warning.
#[test]
fn examples_run() {
    let names = names();
    assert!(names.len() >= 12);
    for name in names {
        let run = example(&name);
        assert_eq!(run.warnings, [], "{name}");
        let mut workpiece = run.workpiece(0.5);
        let events = workpiece.take_events();
        assert!(events.is_empty(), "{name}: {events:?}");
        assert!(workpiece.finished().removed_mm3() > 1000.0, "{name}");
    }
}

/// The README of the examples names each of them.
#[test]
fn examples_are_listed() {
    let readme = std::fs::read_to_string(folder().join("README.md")).unwrap();
    for name in names() {
        assert!(readme.contains(&format!("[{name}]({name})")), "{name}");
    }
}

/// probe.H: the pocket is 8 mm deep below the surface that was measured.
#[test]
fn probe_follows_the_surface() {
    let part = example("probe.H").workpiece(0.5).finished();
    close(part.height_at([50.0, 35.0]).unwrap(), -1.35 - 8.0, 1e-4);
}

/// dome.H: the surface is a sphere of R40 whose top is at Z = 0. Steps of 1° leave cusps between the rings: a
/// step of 40 mm · 1° along the arc, outside of the sphere by that times sine and cosine of the slope at most.
#[test]
fn dome_is_a_sphere() {
    let part = example("dome.H").workpiece(0.25).finished();
    let cusp = 40.0 * 1f64.to_radians();
    for x in [2.0f64, 8.0, 15.0, 22.0, 30.0] {
        let sphere = (1600.0 - x * x).sqrt() - 40.0;
        let height = part.height_at([x, 0.1]).unwrap();
        // A column half a cell nearer to the centre is higher by the slope.
        let slope = 0.25 * x / (sphere + 40.0);
        assert!(
            height > sphere - slope && height < sphere + cusp + slope,
            "{height} at {x}, sphere {sphere}"
        );
    }
}

/// helix.H: the bore is round and 24 mm deep: radius of the path 10 and of the tool 6.
#[test]
fn helix_bores_a_hole() {
    let run = example("helix.H");
    let part = run.workpiece(0.25).finished();
    assert_eq!(part.height_at([50.0 + 15.7, 50.0]), Some(-24.0));
    assert_eq!(part.height_at([50.0 + 16.3, 50.0]), Some(0.0));
    // Half a turn of the ramp, opposite to where it begins.
    close(part.height_at([50.0, 50.0 + 45.0]).unwrap(), -10.0, 1.5);
}

/// bolt-circle.H: 12 holes and 6 holes.
#[test]
fn bolt_circle_drills_its_holes() {
    let run = example("bolt-circle.H");
    let sinks = 18.0 * PI * (16.0 * 3.0 + 2.5 * 2.5 * (14.0 - 3.0));
    close(run.removed_mm3(0.1), sinks, 0.01 * sinks);
}
