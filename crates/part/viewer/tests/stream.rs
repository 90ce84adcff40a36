//! Whoever looks at a part that is being cut has it, however late he came and however seldom he looks.
#![allow(clippy::unwrap_used, reason = "a helper that panics fails its test")]

mod support;

use bahn_path::{Axis, Blank, Plane, ToolShape};
use bahn_viewer::{PartNews, PartStream, Sent, Trail, WHOLE};
use bahn_workpiece::{Part, Resolution, Workpiece};
use proptest::prelude::*;
use support::{Reader, Screen, element};

const MIN: [f64; 3] = [-5.0, -5.0, -20.0];

fn workpiece() -> Workpiece {
    let blank = Blank {
        plane: Plane::XY,
        min: MIN,
        max: [65.0, 40.0, 0.0],
    };
    let mut workpiece = Workpiece::new(&blank, Resolution::Millimetres(0.5)).unwrap();
    workpiece.remember_tools();
    workpiece
}

/// A viewer of the part.
struct Viewer {
    sent: Sent,
    id: u64,
    screen: Screen,
    /// Places of the path along X, µm from the corner of the blank.
    path: Vec<i64>,
}

impl Viewer {
    fn new() -> Viewer {
        Viewer {
            sent: Sent::default(),
            id: 0,
            screen: Screen::new([0, 0]),
            path: Vec::new(),
        }
    }

    fn look(&mut self, stream: &PartStream, trail: &Trail) -> Option<PartNews> {
        let news = stream.news(trail, None, &mut self.sent)?;
        if self.id != news.id {
            let cells = &news.head.as_ref().unwrap()["cells"];
            let cells = [0, 1].map(|k| cells[k].as_u64().unwrap() as usize);
            (self.id, self.screen) = (news.id, Screen::new(cells));
        }
        if let Some(tiles) = &news.tiles {
            self.screen.take(&tiles.0);
        }
        if let Some(path) = &news.path {
            self.path.truncate(news.from);
            let mut reader = Reader { bytes: &path.0 };
            let mut x = 0;
            for _ in 0..reader.varint() {
                x += reader.signed();
                self.path.push(x);
            }
        }
        Some(news)
    }

    fn has(&self, part: &Part, ends: &[f64]) {
        let top = part.max()[2] - part.min()[2];
        let height = |height: &f32| match f64::from(*height) {
            none if none <= 0.0 => 0,
            whole if whole >= top => WHOLE,
            other => (other / top * f64::from(WHOLE))
                .round()
                .clamp(1.0, f64::from(WHOLE) - 1.0) as u16,
        };
        let heights: Vec<u16> = part.heights_mm().iter().map(height).collect();
        assert!(self.screen.heights == heights);
        assert!(self.screen.marks == part.marks().unwrap());
        let expected = ends.iter().map(|x| ((x - MIN[0]) * 1000.0).round() as i64);
        assert_eq!(self.path, expected.collect::<Vec<_>>());
    }
}

proptest! {
    #![proptest_config(ProptestConfig { cases: 32, ..ProptestConfig::default() })]

    /// One looks after every cut, one sometimes, one comes at the end: all have the same part and path. Now and then the
    /// blank is whole again.
    #[test]
    fn everybody_has_the_part(
        cuts in prop::collection::vec((0.0..60.0, 0.0..35.0, -22.0..2.0, 0.5..6.0, any::<bool>(), prop::bool::weighted(0.1)), 1..24)
    ) {
        let mut workpiece = workpiece();
        let mut trail = Trail::default();
        let mut stream = PartStream::new(7, "PART", workpiece.part(), &trail);
        let (mut keen, mut lazy) = (Viewer::new(), Viewer::new());
        let (mut before, mut ends) = ([0.0, 0.0, 5.0], Vec::new());
        for (number, (x, y, z, radius, looks, restored)) in (0..).zip(cuts) {
            if restored {
                workpiece = self::workpiece();
                trail.begin_anew();
                ends.clear();
            }
            let tool = ToolShape { radius, ..ToolShape::default() };
            workpiece.take_tool(Some(number));
            let element = element(before, [x, y, z]);
            workpiece.cut(&element, &tool, Axis::Z);
            trail.element(&element, f64::from(number));
            if ends.is_empty() {
                ends.push(before[0]);
            }
            ends.push(x);
            before = [x, y, z];
            prop_assert!(stream.fits(workpiece.part()));
            stream.take(workpiece.part(), &trail);
            keen.look(&stream, &trail);
            keen.has(workpiece.part(), &ends);
            if looks {
                lazy.look(&stream, &trail);
                lazy.has(workpiece.part(), &ends);
            }
        }
        let mut late = Viewer::new();
        let news = late.look(&stream, &trail).unwrap();
        let tip = news.at.unwrap();
        for (k, at) in before.iter().enumerate() {
            prop_assert!((tip[k] - (at - MIN[k])).abs() < 1e-9);
        }
        late.has(workpiece.part(), &ends);
        lazy.look(&stream, &trail);
        lazy.has(workpiece.part(), &ends);
        // Nothing is new.
        prop_assert!(late.look(&stream, &trail).is_none());
    }
}

/// A path of a million lines is bounded: who followed it all the time has no other one than who comes at its end.
#[test]
fn a_long_path_is_the_same_for_all() {
    let mut workpiece = workpiece();
    let mut trail = Trail::default();
    let stream = PartStream::new(1, "LONG", workpiece.part(), &trail);
    let mut keen = Viewer::new();
    let wave = |k: u32| [f64::from(k) * 1e-4, 10.0 * (f64::from(k) * 1e-3).sin(), 1.0];
    for k in 0..1_000_000 {
        trail.element(&element(wave(k), wave(k + 1)), f64::from(k));
        if k % 5000 == 0 {
            keen.look(&stream, &trail);
        }
    }
    keen.look(&stream, &trail);
    let mut late = Viewer::new();
    late.look(&stream, &trail);
    assert!(keen.path == late.path);
    assert!(
        (10_000..=60_000).contains(&late.path.len()),
        "{}",
        late.path.len()
    );
    let end_um = ((100.0 - MIN[0]) * 1000.0).round() as i64;
    assert_eq!(late.path.last(), Some(&end_um));
}
