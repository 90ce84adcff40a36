//! The pictures show what they should. How they look is for people: see the example `pictures`.

#![expect(clippy::unwrap_used, reason = "a test may stop")]

mod common;

use std::collections::HashSet;

use bahn_path::{Axis, Blank, Plane};
use bahn_picture::Image;
use bahn_workpiece::{Page, Part, PlanView, Projection, Resolution, ThreePlanes, View3d, Workpiece};
use common::*;

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
            part.plan_view(&page(), &PlanView { levels: 0 });
            part.plan_view(&page(), &PlanView { levels: 255 });
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
