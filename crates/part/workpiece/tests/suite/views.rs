//! The pictures show what they should. How they look is for people: see the example `pictures`.

use std::collections::HashSet;
use std::sync::Arc;
use std::sync::atomic::{AtomicBool, Ordering};

use crate::common::*;
use bahn_path::{Axis, Blank, Plane};
use bahn_picture::{Image, ImageError};
use bahn_workpiece::{
    Colouring, Page, Part, PlanView, Projection, Resolution, ThreePlanes, View3d, Workpiece,
};

fn page() -> Page {
    Page::new(320, 240, "PGM 7", "test").unwrap()
}

/// [`BLANK`] with a pocket in its left half.
fn pocketed() -> Part {
    let mut workpiece = workpiece(0.5);
    workpiece.cut(
        &line(at(25.0, 20.0, -10.0), at(25.0, 60.0, -10.0)),
        &flat(15.0),
        Axis::Z,
    );
    workpiece.finished()
}

fn colours(image: &Image) -> HashSet<[u8; 3]> {
    image.pixels().iter().copied().collect()
}

fn count(image: &Image, colour: [u8; 3]) -> usize {
    image.pixels().iter().filter(|pixel| **pixel == colour).count()
}

#[test]
fn png_has_the_size_of_the_page() {
    let image = pocketed().plan_view(&page(), &PlanView::default());
    let mut bytes = Vec::new();
    image.write_png(&mut bytes).unwrap();
    let reader = png::Decoder::new(std::io::Cursor::new(bytes))
        .read_info()
        .unwrap();
    assert_eq!(reader.info().size(), (320, 240));
    assert_eq!((image.width(), image.height()), (320, 240));
}

#[test]
fn pages_that_are_no_pages() {
    for (width, height) in [(0, 300), (300, 0), (100, 300), (u32::MAX, 300), (300, 8001)] {
        assert!(Page::new(width, height, "", "").is_err());
    }
}

#[test]
fn plan_view_shows_the_pocket_to_scale() {
    let image = pocketed().plan_view(&page(), &PlanView::default());
    // Upper face and deepest level. The pocket is 30 mm wide, 40 mm long and has two half circles:
    // 1200 + pi 15² = 1907 of 8000 mm².
    let (skin, pocket) = (count(&image, [236, 239, 242]), count(&image, [20, 46, 84]));
    let share = pocket as f64 / (skin + pocket) as f64;
    assert!((share - 1907.0 / 8000.0).abs() < 0.02, "{share}");
}

#[test]
fn sections_move() {
    let part = pocketed();
    let at = |sections| {
        part.three_planes(
            &page(),
            &ThreePlanes {
                sections,
                ..ThreePlanes::default()
            },
        )
    };
    let middle = at([None, None]);
    assert_eq!(middle, at([Some(50.0), Some(40.0)]));
    assert_ne!(middle, at([Some(25.0), None]));
    // A section outside the blank stays at its border.
    assert_eq!(at([Some(1e9), None]), at([Some(100.0), None]));
    assert_eq!(at([Some(f64::NAN), None]), middle);
}

#[test]
fn projection_decides_the_arrangement() {
    let part = pocketed();
    let plan_rows = |projection| {
        let image = part.three_planes(
            &page(),
            &ThreePlanes {
                projection,
                ..ThreePlanes::default()
            },
        );
        let at = image
            .pixels()
            .iter()
            .position(|pixel| *pixel == [20, 46, 84])
            .unwrap();
        at / 320
    };
    // European: the plan view is below the front view, American: above.
    assert!(plan_rows(Projection::FirstAngle) > plan_rows(Projection::ThirdAngle) + 20);
}

/// Turned by +90 degrees X points up and Y to the left: what is at (x, y) is drawn at (-y, x) [000:6386-6396].
#[test]
fn a_turned_part_lies_on_its_side() {
    let part = pocketed();
    let turned = part.turned();
    let [min, max] = [part.min(), part.max()];
    assert_eq!(turned.axes(), [Axis::Y, Axis::X, Axis::Z]);
    assert_eq!((turned.min()[0], turned.max()[0]), (-max[1], -min[1]));
    assert_eq!((turned.min()[1], turned.max()[1]), (min[0], max[0]));
    assert!((turned.removed_mm3() - part.removed_mm3()).abs() < 1e-6);
    for (x, y) in [(25.1, 20.1), (25.1, 60.1), (30.3, 40.2), (80.2, 40.2), (0.3, 0.3)] {
        assert_eq!(turned.height_at([-y, x]), part.height_at([x, y]), "{x} {y}");
    }
    // The pocket is in the left half; turned it is in the lower one.
    let dark = |part: &Part| {
        let image = part.plan_view(&page(), &PlanView::default());
        image.pixels().to_vec()
    };
    assert_ne!(dark(&part), dark(&turned));
}

#[test]
fn the_3d_view_turns() {
    let part = pocketed();
    let view = |azimuth_deg, elevation_deg, height_factor| {
        part.view_3d(
            &page(),
            &View3d {
                azimuth_deg,
                elevation_deg,
                height_factor,
                ..View3d::default()
            },
        )
    };
    let front = view(0.0, 30.0, 1.0);
    assert!(colours(&front).len() > 20);
    assert_ne!(front, view(90.0, 30.0, 1.0));
    assert_ne!(front, view(0.0, 30.0, 3.0));
    assert_eq!(view(30.0, 40.0, 1.0), view(390.0, 40.0, 1.0));
    // Whatever the options, there is a picture.
    view(f64::NAN, f64::INFINITY, f64::NAN);
    view(0.0, 90.0, 0.0);
    view(0.0, -90.0, 1e9);
}

#[test]
fn odd_blanks_have_pictures() {
    for size in [
        [840.0, 10.0, 10.0],
        [0.01, 0.01, 0.8],
        [30_000.0, 400.0, 0.001],
        [10.0, 840.0, 400.0],
    ] {
        let min = [-7.0, 1e6, -0.5];
        let max = [0, 1, 2].map(|k| min[k] + size[k]);
        for plane in [Plane::XY, Plane::YZ, Plane::ZX] {
            let resolution = Resolution::Millimetres(size.iter().copied().fold(0.0, f64::max) / 200.0);
            let part = Workpiece::new(&Blank { plane, min, max }, resolution)
                .unwrap()
                .finished();
            part.plan_view(
                &page(),
                &PlanView {
                    levels: 0,
                    ..PlanView::default()
                },
            );
            part.plan_view(
                &page(),
                &PlanView {
                    levels: 255,
                    ..PlanView::default()
                },
            );
            part.three_planes(&page(), &ThreePlanes::default());
            part.view_3d(&page(), &View3d::default());
            assert_eq!(part.removed_mm3(), 0.0);
        }
    }
}

#[test]
fn a_detail_is_a_part_of_its_own() {
    let part = pocketed();
    // The middle of the pocket: 10 x 10 mm, 10 mm deep.
    let detail = part.detail([20.0, 35.0], [30.0, 45.0]).unwrap();
    assert_eq!(
        (detail.min(), detail.max()),
        ([20.0, 35.0, -20.0], [30.0, 45.0, 0.0])
    );
    assert_eq!(detail.columns(), [20, 20]);
    assert!((detail.removed_mm3() - 1000.0).abs() < 1e-6);
    assert_eq!(detail.height_at([25.0, 40.0]), Some(-10.0));
    detail.view_3d(&page(), &View3d::default());
    // Wider than the blank: all of it. Beside the blank: nothing.
    assert_eq!(
        part.detail([-50.0, -50.0], [500.0, 500.0]).unwrap().columns(),
        part.columns()
    );
    assert!(part.detail([200.0, 0.0], [300.0, 50.0]).is_none());
    assert!(part.detail([30.0, 0.0], [20.0, 50.0]).is_none());
    assert!(part.detail([f64::NAN; 2], [f64::NAN; 2]).is_none());
}

#[test]
fn long_titles_are_cut() {
    let title = "x".repeat(5000);
    let page = Page::new(320, 240, &title, &title).unwrap();
    pocketed().plan_view(&page, &PlanView::default());
}

/// Every text of a picture is on the page, and none covers another one.
fn assert_legible(image: &Image, what: &str) {
    let (width, height) = (f64::from(image.width()), f64::from(image.height()));
    let labels = image.labels();
    for (k, a) in labels.iter().enumerate() {
        assert!(
            a.min[0] >= 0.0 && a.min[1] >= 0.0 && a.max[0] <= width && a.max[1] <= height,
            "{what}: {a:?} leaves the page"
        );
        for b in labels.iter().skip(k + 1) {
            let apart = (0..2).any(|axis| a.max[axis] <= b.min[axis] || b.max[axis] <= a.min[axis]);
            assert!(apart, "{what}: {a:?} and {b:?}");
        }
    }
}

#[test]
fn labels_stay_on_the_page_and_apart() {
    let pages = [[500, 400], [240, 600], [900, 200]];
    for size in [
        [100.0, 80.0, 20.0],
        [800.0, 10.0, 10.0],
        [10.0, 800.0, 10.0],
        [10.0, 10.0, 800.0],
        [0.4, 0.3, 0.02],
        [3000.0, 2500.0, 40.0],
    ] {
        let min = [-1234.5, 0.0, -0.5 * size[2]];
        let max = [0, 1, 2].map(|k| min[k] + size[k]);
        let blank = Blank {
            plane: Plane::XY,
            min,
            max,
        };
        let cell = size[0].max(size[1]) / 150.0;
        let mut workpiece = Workpiece::new(&blank, Resolution::Millimetres(cell)).unwrap();
        // A ramp through the lower face: many depths, and holes.
        let middle = 0.5 * (min[1] + max[1]);
        let ramp = line(
            at(min[0], middle, max[2]),
            at(max[0], middle, min[2] - 0.1 * size[2]),
        );
        workpiece.cut(&ramp, &flat(0.2 * size[1]), Axis::Z);
        let part = workpiece.finished();
        for [width, height] in pages {
            let page = Page::new(width, height, "PGM 7", "view").unwrap();
            let what = format!("{size:?} on {width}x{height}");
            assert_legible(&part.plan_view(&page, &PlanView::default()), &what);
            for projection in [Projection::FirstAngle, Projection::ThirdAngle] {
                let options = ThreePlanes {
                    projection,
                    ..ThreePlanes::default()
                };
                assert_legible(&part.three_planes(&page, &options), &what);
            }
        }
    }
}

/// Share of the pixels that a test on their colour holds for.
fn share(image: &Image, of: impl Fn([f64; 3]) -> bool) -> f64 {
    let found = image.pixels().iter().filter(|pixel| of(pixel.map(f64::from)));
    found.count() as f64 / image.pixels().len() as f64
}

#[test]
fn every_tool_has_its_colour_and_rapid_cuts_are_red() {
    let cut = |remember: bool| {
        let mut workpiece = workpiece(0.5);
        if remember {
            workpiece.remember_tools();
        }
        workpiece.take_tool(Some(5));
        workpiece.cut(
            &line(at(20.0, 10.0, -5.0), at(20.0, 70.0, -5.0)),
            &flat(8.0),
            Axis::Z,
        );
        workpiece.take_tool(Some(7));
        workpiece.cut(
            &line(at(50.0, 10.0, -5.0), at(50.0, 70.0, -5.0)),
            &flat(8.0),
            Axis::Z,
        );
        // Back in the same slot it cuts nothing, beside it does.
        workpiece.cut(
            &rapid(at(50.0, 70.0, -5.0), at(50.0, 10.0, -5.0)),
            &flat(8.0),
            Axis::Z,
        );
        workpiece.cut(
            &rapid(at(80.0, 10.0, -5.0), at(80.0, 70.0, -5.0)),
            &flat(8.0),
            Axis::Z,
        );
        workpiece.finished()
    };
    let options = View3d {
        elevation_deg: 90.0,
        azimuth_deg: 0.0,
        colouring: Colouring::Tool,
        ..View3d::default()
    };
    let page = Page::new(600, 500, "", "").unwrap();
    let image = cut(true).view_3d(&page, &options);
    let texts: Vec<&str> = image.labels().iter().map(|label| label.text.as_str()).collect();
    for text in ["T5", "T7", "rapid traverse"] {
        assert_eq!(
            texts.iter().filter(|label| **label == text).count(),
            1,
            "{texts:?}"
        );
    }
    // The three slots are equally large: 16 x 60 mm and two half circles.
    let brass = share(&image, |[r, g, b]| r > g && g > 1.4 * b && r < 1.6 * g);
    let teal = share(&image, |[r, g, _]| g > 1.6 * r);
    let red = share(&image, |[r, g, b]| r > 3.0 * g && r > 3.0 * b);
    assert!(brass > 0.02, "{brass}");
    for other in [teal, red] {
        assert!((other / brass - 1.0).abs() < 0.1, "{brass} {teal} {red}");
    }
    // Nobody asked before the cut: nothing is claimed.
    let plain = cut(false).view_3d(&page, &options);
    assert!(!plain.labels().iter().any(|label| label.text == "T5"));
}

/// Two slots, equally large, one of each tool; the path is remembered.
fn two_slots() -> Part {
    let mut workpiece = workpiece(0.5);
    workpiece.remember_tools();
    workpiece.remember_path();
    for (tool, x) in [(5, 25.0), (7, 75.0)] {
        workpiece.take_tool(Some(tool));
        workpiece.cut(&line(at(x, 20.0, -5.0), at(x, 60.0, -5.0)), &flat(8.0), Axis::Z);
    }
    workpiece.finished()
}

/// The colours of the 3D view, seen from above: first and second tool, skin and machined surface.
#[test]
fn plan_view_and_three_planes_take_the_colouring() {
    let part = two_slots();
    let page = Page::new(600, 500, "", "").unwrap();
    let views = |colouring| {
        let plan = PlanView {
            colouring,
            ..PlanView::default()
        };
        let planes = ThreePlanes {
            colouring,
            ..ThreePlanes::default()
        };
        [part.plan_view(&page, &plan), part.three_planes(&page, &planes)]
    };
    for image in views(Colouring::Tool) {
        let [first, second] = [[232, 190, 106], [64, 168, 150]].map(|colour| count(&image, colour));
        // Each of the swatches of the legend too is as large as the other.
        assert!(
            first > 500 && first.abs_diff(second) * 20 < first,
            "{first} {second}"
        );
        for text in ["T5", "T7"] {
            assert!(image.labels().iter().any(|label| label.text == text), "{text}");
        }
        assert_legible(&image, "colours of tools");
    }
    for image in views(Colouring::Part) {
        // 16 x 40 mm and two half circles each: 2 (640 + pi 64) = 1682 of 8000 mm². Their rims are darker.
        let [steel, brass] = [[134, 152, 176], [232, 204, 146]].map(|colour| count(&image, colour) as f64);
        let part = brass / (brass + steel);
        assert!(
            brass > 500.0 && (part - 1682.0 / 8000.0).abs() < 0.04,
            "{brass} {steel}"
        );
    }
    let defaults = [
        part.plan_view(&page, &PlanView::default()),
        part.three_planes(&page, &ThreePlanes::default()),
    ];
    assert!(views(Colouring::Depth) == defaults);
}

/// The path is a line of 40 mm in either slot, of 100 mm that take more than 200 pixels.
#[test]
fn plan_view_and_three_planes_show_the_path() {
    let part = two_slots();
    let page = Page::new(600, 500, "", "").unwrap();
    let changed = |with: &Image, without: &Image| {
        let pairs = with.pixels().iter().zip(without.pixels());
        pairs.filter(|(a, b)| a != b).count()
    };
    let plan = |tool_path| {
        let options = PlanView {
            tool_path,
            ..PlanView::default()
        };
        part.plan_view(&page, &options)
    };
    let drawn = changed(&plan(true), &plan(false));
    assert!((2 * 80..2 * 400).contains(&drawn), "{drawn}");
    for projection in [Projection::FirstAngle, Projection::ThirdAngle] {
        let planes = |tool_path| {
            let options = ThreePlanes {
                projection,
                tool_path,
                ..ThreePlanes::default()
            };
            part.three_planes(&page, &options)
        };
        // In the plan twice, from the side once, from the front two points.
        let drawn = changed(&planes(true), &planes(false));
        assert!((3 * 60..3 * 300).contains(&drawn), "{drawn}");
    }
}

/// A flag that is set stops every view before it draws the part, and a picture before its next row.
#[test]
fn a_stopped_view_draws_nothing_and_is_not_written() {
    let stop = Arc::new(AtomicBool::new(true));
    let part = two_slots();
    let page = Page::new(600, 500, "", "").unwrap();
    let stopped = page.clone().stopped_by(stop.clone());
    let slot = |image: &Image| count(image, [20, 46, 84]);
    let plan = |page: &Page| part.plan_view(page, &PlanView::default());
    let planes = |page: &Page| part.three_planes(page, &ThreePlanes::default());
    for (view, pixels) in [
        (&plan as &dyn Fn(&Page) -> Image, 2000),
        (&planes as &dyn Fn(&Page) -> Image, 1000),
    ] {
        // What is left is in the legend.
        let (with, without) = (slot(&view(&page)), slot(&view(&stopped)));
        assert!(with > without + pixels, "{with} {without}");
    }
    /// Sets the flag as soon as something is written.
    struct First(Arc<AtomicBool>);
    impl std::io::Write for First {
        fn write(&mut self, bytes: &[u8]) -> std::io::Result<usize> {
            self.0.store(true, Ordering::Relaxed);
            Ok(bytes.len())
        }
        fn flush(&mut self) -> std::io::Result<()> {
            Ok(())
        }
    }
    stop.store(false, Ordering::Relaxed);
    let written = plan(&page).write_png_until(First(stop.clone()), &stop);
    assert!(matches!(written, Err(ImageError::Stopped)));
}

#[test]
fn a_detail_keeps_its_tools() {
    let mut workpiece = workpiece(0.5);
    workpiece.remember_tools();
    workpiece.remember_path();
    for (tool, x) in [(5, 20.0), (7, 80.0)] {
        workpiece.take_tool(Some(tool));
        workpiece.cut(&line(at(x, 10.0, -5.0), at(x, 70.0, -5.0)), &flat(8.0), Axis::Z);
    }
    let detail = workpiece.part().detail([60.0, 0.0], [100.0, 80.0]).unwrap();
    let options = View3d {
        colouring: Colouring::Tool,
        tool_path: true,
        ..View3d::default()
    };
    let image = detail.view_3d(&page(), &options);
    let has = |text: &str| image.labels().iter().any(|label| label.text == text);
    assert!(has("T7") && !has("T5"));
}

#[test]
fn the_part_hides_the_tool_path() {
    let picture = |y: f64, remember: bool| {
        let mut workpiece = workpiece(0.5);
        if remember {
            workpiece.remember_path();
        }
        workpiece.cut(&line(at(10.0, y, -10.0), at(90.0, y, -10.0)), &flat(5.0), Axis::Z);
        let options = View3d {
            azimuth_deg: 0.0,
            elevation_deg: 10.0,
            tool_path: true,
            ..View3d::default()
        };
        let image = workpiece
            .finished()
            .view_3d(&Page::new(500, 400, "", "").unwrap(), &options);
        let blue = |pixel: &&[u8; 3]| f64::from(pixel[2]) > 2.0 * f64::from(pixel[0]);
        image.pixels().iter().filter(blue).count()
    };
    // An axis in the corner is blue too, and is there without a path. The blank is 100 mm wide and takes more than
    // 300 pixels, the path 80 mm: in front of the part, and behind it.
    let none = picture(-20.0, false);
    assert!(picture(-20.0, true) >= none + 240);
    assert_eq!(picture(100.0, true), picture(100.0, false));
}
