//! Laws of rough-out (cycle 6) on random pockets and islands, for every setting of MP7420.

use std::fmt::Write;

use crate::support::Job;
use bahn_interpreter::ContourPocketRules;
use bahn_path::{Axis, Plane};
use bahn_workpiece::EventKind;
use proptest::prelude::*;

const BLANK: f64 = 100.0;
const DEPTH: f64 = 6.0;

/// A subcontour whose distance is known in closed form.
#[derive(Clone, Copy, Debug)]
struct Shape {
    centre: [f64; 2],
    kind: Kind,
}

#[derive(Clone, Copy, Debug)]
enum Kind {
    /// Radius, and the angle where the contour starts.
    Circle(f64, f64),
    /// Half sides; the contour starts in the middle of the left side.
    Rectangle([f64; 2]),
}

impl Shape {
    /// Distance of a point from the contour, positive outside.
    fn distance(&self, p: [f64; 2]) -> f64 {
        let d = [p[0] - self.centre[0], p[1] - self.centre[1]];
        match self.kind {
            Kind::Circle(radius, _) => d[0].hypot(d[1]) - radius,
            Kind::Rectangle(half) => {
                let q = [d[0].abs() - half[0], d[1].abs() - half[1]];
                q[0].max(0.0).hypot(q[1].max(0.0)) + q[0].max(q[1]).min(0.0)
            }
        }
    }

    fn start(&self) -> [f64; 2] {
        match self.kind {
            Kind::Circle(radius, angle) => {
                let (sin, cos) = angle.to_radians().sin_cos();
                [self.centre[0] + radius * cos, self.centre[1] + radius * sin]
            }
            Kind::Rectangle(half) => [self.centre[0] - half[0], self.centre[1]],
        }
    }

    /// The contour subprogram, counter-clockwise: RL makes a pocket, RR an island.
    fn subprogram(&self, label: usize, side: &str) -> String {
        let [x, y] = self.start();
        let mut text = format!("LBL {label}\nL X{x:+.6} Y{y:+.6} {side}\n");
        let [cx, cy] = self.centre;
        let _ = match self.kind {
            Kind::Circle(..) => writeln!(text, "CC X{cx:+.6} Y{cy:+.6}\nC X{x:+.6} Y{y:+.6} DR+"),
            Kind::Rectangle([a, b]) => writeln!(
                text,
                "L Y{:+.6}\nL X{:+.6}\nL Y{:+.6}\nL X{:+.6}\nL Y{y:+.6}",
                cy - b,
                cx + a,
                cy + b,
                cx - a
            ),
        };
        text + "LBL 0\n"
    }
}

fn shape(size: std::ops::Range<f64>) -> impl Strategy<Value = Shape> {
    let kind = prop_oneof![
        (size.clone(), 0.0..360.0f64).prop_map(|(radius, angle)| Kind::Circle(radius, angle)),
        (size.clone(), size).prop_map(|(a, b)| Kind::Rectangle([a, b])),
    ];
    (20.0..80.0f64, 20.0..80.0f64, kind).prop_map(|(x, y, kind)| Shape { centre: [x, y], kind })
}

/// Pockets and islands that superimpose as unions: each starts outside all others of its kind, pockets also
/// outside the islands, and islands inside some pocket [003:5619] [003:5741-5927].
#[derive(Clone, Debug)]
struct Layout {
    pockets: Vec<Shape>,
    islands: Vec<Shape>,
}

fn layouts() -> impl Strategy<Value = Layout> {
    let pockets = prop::collection::vec(shape(12.0..30.0), 1..=3);
    let islands = prop::collection::vec(shape(2.0..9.0), 0..=3);
    (pockets, islands).prop_filter_map(
        "starts lie as the rules of superimposing want",
        |(pockets, islands)| {
            let outside = |shape: &Shape, others: &[Shape], own: Option<usize>| {
                let start = shape.start();
                others
                    .iter()
                    .enumerate()
                    .all(|(k, other)| Some(k) == own || other.distance(start) > 0.5)
            };
            let good = pockets
                .iter()
                .enumerate()
                .all(|(k, p)| outside(p, &pockets, Some(k)) && outside(p, &islands, None))
                && islands
                    .iter()
                    .enumerate()
                    .all(|(k, i)| outside(i, &islands, Some(k)))
                && islands
                    .iter()
                    .all(|i| pockets.iter().any(|p| p.distance(i.start()) < -0.5));
            good.then_some(Layout { pockets, islands })
        },
    )
}

impl Layout {
    fn program(&self, tool_radius: f64, allowance: f64, angle: f64) -> String {
        let count = self.pockets.len() + self.islands.len();
        let labels: Vec<String> = (1..=count).map(|label| label.to_string()).collect();
        let mut text = format!(
            "BEGIN PGM 1 MM\nBLK FORM 0.1 Z X+0 Y+0 Z-10\nBLK FORM 0.2 X+{BLANK} Y+{BLANK} Z+0\nTOOL DEF 1 L+0 R{tool_radius:+.6}\n\
             TOOL CALL 1 Z S1000\nCYCL DEF 14.0 GEOM\nCYCL DEF 14.1 CONTOUR LABEL {}\nCYCL DEF 6.0 ROUGH\nCYCL DEF 6.1 SET UP -2 DEPTH -{DEPTH}\n\
             CYCL DEF 6.2 PECKG -4 F100 ALLOW {allowance:+.6}\nCYCL DEF 6.3 ANGLE {angle:+.6} F500\nL Z+2 R0 FMAX M3\nCYCL CALL\nL Z+50 FMAX M2\n",
            labels.join("/")
        );
        for (k, pocket) in self.pockets.iter().enumerate() {
            text.push_str(&pocket.subprogram(k + 1, "RL"));
        }
        for (k, island) in self.islands.iter().enumerate() {
            text.push_str(&island.subprogram(self.pockets.len() + k + 1, "RR"));
        }
        text + "END PGM 1 MM\n"
    }

    /// How far inside the area of the tool's centre a point is, when the paths of the tool's centre are merged:
    /// inside one of the pockets, shrunk by the distance, and outside all islands, grown by it.
    fn inside(&self, p: [f64; 2], distance: f64) -> f64 {
        let pockets = self
            .pockets
            .iter()
            .map(|shape| -shape.distance(p) - distance)
            .fold(f64::MIN, f64::max);
        let islands = self
            .islands
            .iter()
            .map(|shape| shape.distance(p) - distance)
            .fold(f64::MAX, f64::min);
        pockets.min(islands)
    }
}

proptest! {
    #![proptest_config(ProptestConfig { cases: 150, max_global_rejects: 100_000, failure_persistence: None, ..ProptestConfig::default() })]

    /// The tool's centre stays where the tool leaves pocket rims and islands alone, and comes near enough to
    /// every place where it may be, so that all that the tool can reach is cleared.
    #[test]
    fn rough_out_clears_what_the_tool_can_reach(
        layout in layouts(),
        tool_radius in 1.5..5.0f64,
        allowance in prop_oneof![Just(0.0), 0.0..2.0f64],
        angle in prop_oneof![Just(0.0), -90.0..90.0f64],
        bits in 0..32u32,
    ) {
        // Bit 2 merges the contours themselves: then the tool goes further into the notches between pockets.
        let merges_contours = bits & 4 != 0;
        let run = Job::new(layout.program(tool_radius, allowance, angle))
            .with(|s| s.rules.contour_pocket = ContourPocketRules::from_bits(bits))
            .run();
        let distance = tool_radius + allowance;
        let mut places = Vec::new();
        for k in 0..50 * 50 {
            let p = [1.0 + 2.0 * f64::from(k % 50), 1.0 + 2.0 * f64::from(k / 50)];
            if layout.inside(p, distance) > 0.05 {
                places.push(p);
            }
        }
        if run.error.is_some() {
            // TOOL RADIUS TOO LARGE: no pocket is large enough.
            prop_assert_eq!(run.message().map(|(id, _)| id), Some(bahn_parameters::MessageId::ToolRadiusTooLarge));
            prop_assert!(places.is_empty(), "{:?} in {:?}", run.error, places);
            return Ok(());
        }
        for element in run.moves().filter(|e| e.start[Axis::Z] < 0.0 || e.end[Axis::Z] < 0.0) {
            for k in 0..=16 {
                let at = element.curve.position(&element.start, &element.end, f64::from(k) / 16.0);
                let p = Plane::XY.point(&at);
                let from_islands = layout.islands.iter().map(|i| i.distance(p)).fold(f64::MAX, f64::min);
                prop_assert!(from_islands > distance - 1e-3, "{p:?} is {from_islands} from an island");
                if !merges_contours {
                    prop_assert!(layout.inside(p, distance) > -1e-3, "{p:?} is {} inside", layout.inside(p, distance));
                }
            }
        }
        let mut workpiece = run.workpiece(0.5);
        let cut_in_rapid = workpiece.take_events().into_iter().find(|event| event.kind == EventKind::RapidCut);
        prop_assert_eq!(cut_in_rapid, None);
        let part = workpiece.finished();
        for p in places {
            let height = part.height_at(p).unwrap_or(f64::NAN);
            prop_assert!((height + DEPTH).abs() < 1e-4, "{height} at {p:?}");
        }
    }
}
