//! Random contours of lines and arcs, spelled in several ways.

use std::fmt::Write;

use proptest::prelude::*;

/// A contour, its tool and the spelling-independent facts of its program.
#[derive(Clone, Debug)]
pub struct Contour {
    pub start: [f64; 2],
    pub pieces: Vec<Piece>,
    /// RL, else RR.
    pub left: bool,
    pub tool_radius: f64,
}

/// One element from where the one before ends.
#[derive(Clone, Debug)]
pub struct Piece {
    pub shape: Shape,
    pub end: [f64; 2],
    /// What stands between this element and the next.
    pub joint: Joint,
}

impl Piece {
    /// Direction at start and end, degrees, without a jump between them.
    fn headings(&self, from: [f64; 2]) -> (f64, f64) {
        match self.shape {
            Shape::Line => {
                let heading = (self.end[1] - from[1]).atan2(self.end[0] - from[0]).to_degrees();
                (heading, heading)
            }
            Shape::Arc(centre, ccw) => {
                let sign = if ccw { 1.0 } else { -1.0 };
                let angle = |p: [f64; 2]| (p[1] - centre[1]).atan2(p[0] - centre[0]).to_degrees();
                let sweep = sign * (sign * (angle(self.end) - angle(from))).rem_euclid(360.0);
                let start = angle(from) + 90.0 * sign;
                (start, start + sweep)
            }
        }
    }
}

#[derive(Clone, Copy, Debug)]
pub enum Shape {
    Line,
    /// Centre, and whether it turns counter-clockwise.
    Arc([f64; 2], bool),
}

#[derive(Clone, Copy, Debug)]
pub enum Joint {
    Corner,
    Rounding(f64),
    Chamfer(f64),
}

/// How a program gives its points.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Spelling {
    Absolute,
    Incremental,
    /// Points by LP and CP about poles.
    Polar,
    /// Absolute in a program of inches.
    Inch,
}

impl Contour {
    /// Blocks of the approach, the contour and the departure. The first contour element is block
    /// [`Contour::FIRST`] of the program when there are neither joints nor arcs before it.
    pub fn blocks(&self, spelling: Spelling) -> String {
        let mut text = String::new();
        let unit = if spelling == Spelling::Inch { 25.4 } else { 1.0 };
        let n = |value: f64| format!("{:+.12}", value / unit);
        let _ = writeln!(
            text,
            "L X{} Y{} R0 FMAX",
            n(self.start[0] - 50.0),
            n(self.start[1] - 50.0)
        );
        let side = if self.left { "RL" } else { "RR" };
        let _ = writeln!(
            text,
            "L X{} Y{} {side} F{}",
            n(self.start[0]),
            n(self.start[1]),
            // Tenths of an inch/min.
            if spelling == Spelling::Inch { 100 } else { 254 }
        );
        let mut at = self.start;
        for piece in &self.pieces {
            let [dx, dy] = [piece.end[0] - at[0], piece.end[1] - at[1]];
            match (piece.shape, spelling) {
                (Shape::Line, Spelling::Incremental) => {
                    let _ = writeln!(text, "L IX{} IY{}", n(dx), n(dy));
                }
                (Shape::Line, Spelling::Polar) => {
                    // About the start of the element.
                    let angle = dy.atan2(dx).to_degrees();
                    let _ = writeln!(
                        text,
                        "CC X{} Y{}\nLP PR{} PA{angle:+.12}",
                        n(at[0]),
                        n(at[1]),
                        n(dx.hypot(dy))
                    );
                }
                (Shape::Line, _) => {
                    let _ = writeln!(text, "L X{} Y{}", n(piece.end[0]), n(piece.end[1]));
                }
                (Shape::Arc(centre, ccw), spelling) => {
                    let dr = if ccw { "DR+" } else { "DR-" };
                    let _ = match spelling {
                        Spelling::Incremental => writeln!(
                            text,
                            "CC IX{} IY{}\nC IX{} IY{} {dr}",
                            n(centre[0] - at[0]),
                            n(centre[1] - at[1]),
                            n(dx),
                            n(dy)
                        ),
                        Spelling::Polar => {
                            let angle = (piece.end[1] - centre[1])
                                .atan2(piece.end[0] - centre[0])
                                .to_degrees();
                            writeln!(
                                text,
                                "CC X{} Y{}\nCP PA{angle:+.12} {dr}",
                                n(centre[0]),
                                n(centre[1])
                            )
                        }
                        _ => writeln!(
                            text,
                            "CC X{} Y{}\nC X{} Y{} {dr}",
                            n(centre[0]),
                            n(centre[1]),
                            n(piece.end[0]),
                            n(piece.end[1])
                        ),
                    };
                }
            }
            let _ = match piece.joint {
                Joint::Corner => Ok(()),
                Joint::Rounding(radius) => writeln!(text, "RND R{}", &n(radius)[1..]),
                Joint::Chamfer(length) => writeln!(text, "L {}", &n(length)[1..]),
            };
            at = piece.end;
        }
        let _ = writeln!(text, "L X{} Y{} R0", n(at[0] + 50.0), n(at[1] - 50.0));
        text
    }

    /// The program with tool, in the unit of the spelling. Blocks 1 and 2 are the tool's.
    pub fn program(&self, spelling: Spelling) -> String {
        self.program_with(spelling, "")
    }

    /// The program with blocks between tool and contour.
    pub fn program_with(&self, spelling: Spelling, before: &str) -> String {
        let inch = spelling == Spelling::Inch;
        let radius = self.tool_radius / if inch { 25.4 } else { 1.0 };
        let unit = if inch { "INCH" } else { "MM" };
        format!(
            "BEGIN PGM 1 {unit}\nTOOL DEF 1 L+0 R{radius:+.12}\nTOOL CALL 1 Z S1000\n{before}{}END PGM 1 {unit}\n",
            self.blocks(spelling)
        )
    }

    /// Distance of a point to an element.
    pub fn distance(&self, piece: usize, p: [f64; 2]) -> f64 {
        let from = if piece == 0 {
            self.start
        } else {
            self.pieces[piece - 1].end
        };
        let Piece { shape, end, .. } = &self.pieces[piece];
        let to_ends = (p[0] - from[0])
            .hypot(p[1] - from[1])
            .min((p[0] - end[0]).hypot(p[1] - end[1]));
        match shape {
            Shape::Line => {
                let d = [end[0] - from[0], end[1] - from[1]];
                let t = ((p[0] - from[0]) * d[0] + (p[1] - from[1]) * d[1]) / (d[0] * d[0] + d[1] * d[1]);
                let t = t.clamp(0.0, 1.0);
                (p[0] - from[0] - t * d[0]).hypot(p[1] - from[1] - t * d[1])
            }
            Shape::Arc(centre, ccw) => {
                let angle = |q: &[f64; 2]| (q[1] - centre[1]).atan2(q[0] - centre[0]);
                let sign = if *ccw { 1.0 } else { -1.0 };
                let turn = |to: f64| (sign * (to - angle(&from))).rem_euclid(std::f64::consts::TAU);
                if turn(angle(&p)) <= turn(angle(end)) {
                    let radius = (from[0] - centre[0]).hypot(from[1] - centre[1]);
                    ((p[0] - centre[0]).hypot(p[1] - centre[1]) - radius).abs()
                } else {
                    to_ends
                }
            }
        }
    }

    /// Whether two neighbouring elements turn by 170° or more together: such a contour may cut itself.
    pub fn turns_back(&self) -> bool {
        let mut from = self.start;
        let mut before: Option<[f64; 2]> = None;
        let mut headings: Vec<[f64; 2]> = Vec::new();
        for piece in &self.pieces {
            let (start, end) = piece.headings(from);
            // Keep the angles continuous from element to element.
            let turn = before.map_or(0.0, |b| (start - b[1] + 180.0).rem_euclid(360.0) - 180.0);
            let first = before.map_or(start, |b| b[1] + turn);
            let own = [first, first + end - start];
            before = Some(own);
            headings.push(own);
            from = piece.end;
        }
        headings.windows(2).any(|pair| {
            let all = [pair[0][0], pair[0][1], pair[1][0], pair[1][1]];
            let span =
                all.iter().copied().fold(f64::MIN, f64::max) - all.iter().copied().fold(f64::MAX, f64::min);
            span >= 170.0
        })
    }

    /// The block of each element in the absolute spelling.
    pub fn element_blocks(&self) -> Vec<u32> {
        let mut block = 4;
        self.pieces
            .iter()
            .map(|piece| {
                block += if matches!(piece.shape, Shape::Arc(..)) {
                    2
                } else {
                    1
                };
                let own = block;
                block += if matches!(piece.joint, Joint::Corner) {
                    0
                } else {
                    1
                };
                own
            })
            .collect()
    }
}

/// Contours of 2 to 8 elements. Corners turn by at most 130°, arcs by at most 100°. With joints, some corners
/// are rounded or chamfered.
pub fn contours(joints: bool) -> impl Strategy<Value = Contour> {
    let shape = prop_oneof![
        3 => Just(None),
        2 => (4.0..40.0f64, 10.0..100.0f64, any::<bool>()).prop_map(Some),
    ];
    let joint = if joints {
        prop_oneof![
            3 => Just(Joint::Corner),
            2 => (0.5..6.0f64).prop_map(Joint::Rounding),
            1 => (0.5..4.0f64).prop_map(Joint::Chamfer),
        ]
        .boxed()
    } else {
        Just(Joint::Corner).boxed()
    };
    // A corner may be tangential.
    let turn = prop_oneof![4 => -130.0..130.0f64, 1 => Just(0.0)];
    let piece = (turn, 3.0..60.0f64, shape, joint);
    (
        prop::collection::vec(piece, 2..=8),
        (-20.0..20.0f64, -20.0..20.0f64),
        0.0..360.0f64,
        any::<bool>(),
        0.5..8.0f64,
    )
        .prop_map(|(drawn, (x, y), heading, left, tool_radius)| {
            let mut at = [x, y];
            let mut heading = heading.to_radians();
            let mut pieces: Vec<Piece> = Vec::new();
            let count = drawn.len();
            let mut next_is_line = drawn
                .iter()
                .skip(1)
                .map(|(_, _, shape, _)| shape.is_none())
                .collect::<Vec<_>>();
            next_is_line.push(true);
            for (k, (turn, length, arc, joint)) in drawn.into_iter().enumerate() {
                heading += turn.to_radians();
                let shape = match arc {
                    None => {
                        at = [at[0] + length * heading.cos(), at[1] + length * heading.sin()];
                        Shape::Line
                    }
                    Some((radius, sweep, ccw)) => {
                        let sign = if ccw { 1.0 } else { -1.0 };
                        let centre = [
                            at[0] - sign * radius * heading.sin(),
                            at[1] + sign * radius * heading.cos(),
                        ];
                        heading += sign * sweep.to_radians();
                        at = [
                            centre[0] + sign * radius * heading.sin(),
                            centre[1] - sign * radius * heading.cos(),
                        ];
                        Shape::Arc(centre, ccw)
                    }
                };
                // A joint stands between two elements, a chamfer between two lines.
                let joint = match joint {
                    _ if k + 1 == count => Joint::Corner,
                    Joint::Chamfer(_) if !matches!(shape, Shape::Line) || !next_is_line[k] => Joint::Corner,
                    joint => joint,
                };
                pieces.push(Piece {
                    shape,
                    end: at,
                    joint,
                });
            }
            Contour {
                start: [x, y],
                pieces,
                left,
                tool_radius,
            }
        })
}

/// Closed convex contours: chords and arcs of one circle, beginning in the middle of a chord.
pub fn convex_contours() -> impl Strategy<Value = Contour> {
    (
        prop::collection::vec((10.0..100.0f64, any::<bool>()), 3..=9),
        10.0..60.0f64,
        any::<bool>(),
        any::<bool>(),
        0.5..12.0f64,
    )
        .prop_filter_map(
            "the corners go round once",
            |(steps, radius, ccw, left, tool_radius)| {
                let total: f64 = steps.iter().map(|(step, _)| step).sum();
                let widest = steps
                    .iter()
                    .map(|(step, _)| step * 360.0 / total)
                    .fold(0.0, f64::max);
                if widest > 170.0 {
                    return None;
                }
                let sign = if ccw { 1.0 } else { -1.0 };
                let mut angle = 0.0f64;
                let mut corners = vec![[radius, 0.0]];
                let mut arcs = Vec::new();
                for (step, arc) in &steps {
                    angle += sign * (step * 360.0 / total).to_radians();
                    corners.push([radius * angle.cos(), radius * angle.sin()]);
                    arcs.push(*arc);
                }
                corners.pop();
                let count = corners.len();
                let middle = [0, 1].map(|k: usize| 0.5 * (corners[0][k] + corners[1][k]));
                let piece = |shape, end| Piece {
                    shape,
                    end,
                    joint: Joint::Corner,
                };
                let mut pieces = vec![piece(Shape::Line, corners[1])];
                for k in 1..count {
                    let shape = if arcs[k] {
                        Shape::Arc([0.0, 0.0], ccw)
                    } else {
                        Shape::Line
                    };
                    pieces.push(piece(shape, corners[(k + 1) % count]));
                }
                pieces.push(piece(Shape::Line, middle));
                Some(Contour {
                    start: middle,
                    pieces,
                    left,
                    tool_radius,
                })
            },
        )
}
