//! What is sent of a part is the part: whole, and only where it changed.
#![allow(clippy::unwrap_used, reason = "a helper that panics fails its test")]

mod support;

use bahn_path::{Axis, Blank, Plane, ToolShape};
use bahn_viewer::{PartCoder, TILE, WHOLE};
use bahn_workpiece::{Part, Resolution, Workpiece};
use proptest::prelude::*;
use support::{Screen, element};

/// 20 mm thick, from Z-20 to Z0.
fn workpiece(x: f64, y: f64, resolution: Resolution) -> Workpiece {
    let blank = Blank {
        plane: Plane::XY,
        min: [0.0, 0.0, -20.0],
        max: [x, y, 0.0],
    };
    let mut workpiece = Workpiece::new(&blank, resolution).unwrap();
    workpiece.remember_tools();
    workpiece
}

fn cut(workpiece: &mut Workpiece, from: [f64; 3], to: [f64; 3], radius: f64, corner_radius: f64) {
    let tool = ToolShape {
        radius,
        corner_radius,
        ..ToolShape::default()
    };
    workpiece.cut(&element(from, to), &tool, Axis::Z);
}

/// The heights of all columns as a screen has them, by the rule of `WHOLE`.
fn expected(part: &Part) -> (Vec<u16>, Vec<u8>) {
    let top = part.max()[2] - part.min()[2];
    let height = |height: &f32| match f64::from(*height) {
        none if none <= 0.0 => 0,
        whole if whole >= top => WHOLE,
        other => (other / top * f64::from(WHOLE))
            .round()
            .clamp(1.0, f64::from(WHOLE) - 1.0) as u16,
    };
    (
        part.heights_mm().iter().map(height).collect(),
        part.marks().unwrap().to_vec(),
    )
}

fn same(screen: &Screen, part: &Part) {
    let (heights, marks) = expected(part);
    assert_eq!(screen.heights, heights);
    assert_eq!(screen.marks, marks);
}

#[test]
fn a_screen_that_takes_all_changes_has_the_part() {
    let mut workpiece = workpiece(50.0, 30.0, Resolution::Millimetres(0.25));
    let mut coder = PartCoder::new(workpiece.part());
    let mut screen = Screen::new(coder.cells());
    assert_eq!(coder.cells(), [200, 120]);
    for k in 0..12 {
        workpiece.take_tool(Some(k));
        let x = 4.0 * f64::from(k);
        cut(
            &mut workpiece,
            [x, 5.0, -1.0 - x / 4.0],
            [x, 25.0, -8.0],
            3.0,
            if k % 2 == 0 { 3.0 } else { 0.0 },
        );
        screen.take(&coder.changes(workpiece.part()).unwrap());
        same(&screen, workpiece.part());
    }
    // Through the blank: holes stay holes.
    cut(&mut workpiece, [25.0, 15.0, 5.0], [25.0, 15.0, -25.0], 4.0, 0.0);
    screen.take(&coder.changes(workpiece.part()).unwrap());
    same(&screen, workpiece.part());
    assert!(screen.heights.contains(&0) && screen.heights.contains(&WHOLE));
    // Whoever comes later gets the same at once.
    let mut late = Screen::new(coder.cells());
    late.take(&coder.whole());
    same(&late, workpiece.part());
}

/// 10 x 8 tiles; a hole in the middle of one changes this one only, and costs less than a byte for each of its cells.
#[test]
fn only_tiles_that_changed_are_sent() {
    let mut workpiece = workpiece(64.0, 51.2, Resolution::Millimetres(0.1));
    let mut coder = PartCoder::new(workpiece.part());
    assert_eq!(coder.cells().map(|count| count / TILE), [10, 8]);
    assert_eq!(coder.changes(workpiece.part()), None);
    let middle = |tile: usize| (tile as f64 + 0.5) * 6.4;
    let at = [middle(7), middle(3)];
    cut(
        &mut workpiece,
        [at[0], at[1], 1.0],
        [at[0], at[1], -3.0],
        2.0,
        0.0,
    );
    let bytes = coder.changes(workpiece.part()).unwrap();
    let mut screen = Screen::new(coder.cells());
    assert_eq!(screen.take(&bytes), [3 * 10 + 7]);
    // A bit for each cell, and three bytes for those that changed: a circle of 20 cells radius.
    let changed = std::f64::consts::PI * 20.0 * 20.0;
    let expected = (TILE * TILE) as f64 / 8.0 + 3.0 * changed;
    assert!(
        (bytes.len() as f64 - expected).abs() < 0.05 * expected,
        "{} {expected}",
        bytes.len()
    );
    assert_eq!(coder.changes(workpiece.part()), None);
    // The same hole with another tool: no cell is lower, nothing is sent.
    workpiece.take_tool(Some(9));
    cut(
        &mut workpiece,
        [at[0], at[1], 1.0],
        [at[0], at[1], -3.0],
        2.0,
        0.0,
    );
    assert_eq!(coder.changes(workpiece.part()), None);
}

/// Every cell of a million is one step of height in five bytes a tile.
#[test]
fn a_faced_part_is_a_few_bytes() {
    let mut workpiece = workpiece(100.0, 100.0, Resolution::BySize);
    let mut coder = PartCoder::new(workpiece.part());
    cut(
        &mut workpiece,
        [-10.0, 50.0, -2.0],
        [110.0, 50.0, -2.0],
        200.0,
        0.0,
    );
    let bytes = coder.changes(workpiece.part()).unwrap();
    let tiles = 16 * 16;
    assert_eq!(coder.cells(), [1000, 1000]);
    assert!(bytes.len() <= 3 + 6 * tiles, "{}", bytes.len());
    let mut screen = Screen::new(coder.cells());
    screen.take(&bytes);
    same(&screen, workpiece.part());
}

/// More than two million columns are thinned: a screen gets every other one, from the middle.
#[test]
fn a_part_of_many_columns_is_thinned() {
    let mut workpiece = workpiece(100.0, 100.0, Resolution::Millimetres(0.04));
    assert_eq!(workpiece.part().columns(), [2500, 2500]);
    cut(&mut workpiece, [50.0, 20.0, -5.0], [50.0, 80.0, -5.0], 10.0, 0.0);
    let mut coder = PartCoder::new(workpiece.part());
    assert_eq!(coder.cells(), [1250, 1250]);
    let mut screen = Screen::new(coder.cells());
    screen.take(&coder.changes(workpiece.part()).unwrap());
    let (heights, _) = expected(workpiece.part());
    for (j, row) in screen.heights.chunks(1250).enumerate() {
        for (i, height) in row.iter().enumerate() {
            assert_eq!(*height, heights[(2 * j + 1) * 2500 + 2 * i + 1]);
        }
    }
}

proptest! {
    #![proptest_config(ProptestConfig { cases: 48, ..ProptestConfig::default() })]

    /// Whatever is cut, in whatever steps it is looked at: the screen has the part.
    #[test]
    fn any_cuts_in_any_steps(
        cuts in prop::collection::vec((0.0..40.0, 0.0..30.0, -22.0..2.0, 0.0..40.0, 0.0..30.0, -22.0..2.0, 0.2..6.0, 0.0..1.0, any::<bool>()), 1..12)
    ) {
        let mut workpiece = workpiece(40.0, 30.0, Resolution::Millimetres(0.3));
        let mut coder = PartCoder::new(workpiece.part());
        let mut screen = Screen::new(coder.cells());
        for (number, (x0, y0, z0, x1, y1, z1, radius, round, look)) in (0..).zip(cuts) {
            workpiece.take_tool(Some(number));
            cut(&mut workpiece, [x0, y0, z0], [x1, y1, z1], radius, radius * round);
            if look && let Some(bytes) = coder.changes(workpiece.part()) {
                screen.take(&bytes);
                same(&screen, workpiece.part());
            }
        }
        if let Some(bytes) = coder.changes(workpiece.part()) {
            screen.take(&bytes);
        }
        same(&screen, workpiece.part());
        let mut late = Screen::new(coder.cells());
        late.take(&coder.whole());
        same(&late, workpiece.part());
    }
}
