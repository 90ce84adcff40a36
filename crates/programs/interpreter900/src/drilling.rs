//! Drilling, G81, G83, G84, G85, and patterns, G86 to G89.
//!
//! Decision: G84 with a compensating chuck turns the spindle round at the depth: M4 before it comes out, M3 at P34. Rigid, the path
//! follows the spindle, P31 3 clockwise, 4 counter-clockwise
//!
//! Decision: G87 goes round the parallelogram: along vector 1, along vector 2, and back. G89 without P125 takes steps that
//! reach the end of P124, or a full circle without its last point. A pattern without drilling in force is refused

use bahn_path::parallel::Side;
use bahn_path::{At, Curve, FeedRate, Function, OverrideLaw, Sense, SpindleOrder, Synchronisation};
use bahn_path::{TechnologyFunction, Thread};
use bahn_system900::PathData;

use crate::refusal::{Refusal, wrong};
use crate::run::{Extra, Run};

/// Most places of a pattern.
const PLACES_MAX: f64 = 10_000.0;
/// Most strokes of a hole.
const STROKES_MAX: f64 = 10_000.0;

/// The numbers of a hole.
struct Hole {
    dwell_s: f64,
    chuck: i32,
    feed: f64,
    depth: f64,
    plane: f64,
    retract: f64,
    strokes: f64,
    margin: f64,
}

impl Hole {
    fn of(word: u16, data: &PathData) -> Result<Hole, Refusal> {
        let all = data.drilling();
        let number = |at: usize| all.get(at).copied().flatten();
        let needed = |at: usize| {
            number(at).ok_or_else(|| Refusal::Wrong(format!("G{word} needs P{}: it is cleared", 30 + at)))
        };
        if word == 83 && number(9).is_some_and(|gradual| gradual != 0.0) {
            return Err(Refusal::NotYet("G83 with infeeds that decrease, P39,".to_owned()));
        }
        let plane = needed(4)?;
        let hole = Hole {
            dwell_s: number(0).unwrap_or(0.0).max(0.0),
            chuck: number(1).unwrap_or(0.0) as i32,
            feed: needed(2)?,
            depth: needed(3)?,
            plane,
            retract: number(5).unwrap_or(plane),
            strokes: number(6).unwrap_or(1.0).round().max(1.0),
            margin: number(8).unwrap_or(1.0),
        };
        if hole.feed <= 0.0 {
            return wrong(format!("G{word}: P32 is not above 0"));
        }
        if hole.strokes > STROKES_MAX {
            return wrong(format!("G{word}: P36 is more than {STROKES_MAX}"));
        }
        Ok(hole)
    }
}

/// The state of a run that makes holes.
pub(crate) struct Drill<'a>(pub &'a mut Run);

impl Drill<'_> {
    /// Moves the third axis of the plane.
    fn along(&mut self, to: f64, feed: Option<f64>, extra: Extra) -> Result<(), Refusal> {
        let normal = self.0.modal.plane.normal;
        let mut end = self.0.here;
        end[normal] = self.0.modal.axis_to_machine(normal, to);
        if end[normal] == self.0.here[normal] && extra.functions.is_empty() && extra.dwell_s == 0.0 {
            return Ok(());
        }
        self.0.push(
            Curve::Line,
            end,
            feed.map_or(FeedRate::Rapid, FeedRate::Programmed),
            extra,
        )
    }

    /// A hole where the axes stand.
    pub fn drill(&mut self, word: u16, data: &PathData) -> Result<(), Refusal> {
        if self.0.modal.side != Side::Off {
            return Err(Refusal::NotYet(format!("G{word} within G41 or G42")));
        }
        let hole = Hole::of(word, data)?;
        self.along(hole.plane, None, Extra::default())?;
        let dwell = Extra {
            dwell_s: hole.dwell_s,
            ..Extra::default()
        };
        match word {
            83 => {
                let stroke = (hole.depth - hole.plane) / hole.strokes;
                let back = hole.margin.copysign(-stroke);
                for at in 1..=hole.strokes as u32 {
                    let is_last = f64::from(at) >= hole.strokes;
                    let depth = match is_last {
                        true => hole.depth,
                        false => hole.plane + f64::from(at) * stroke,
                    };
                    let extra = Extra {
                        dwell_s: if is_last { hole.dwell_s } else { 0.0 },
                        ..Extra::default()
                    };
                    self.along(depth, Some(hole.feed), extra)?;
                    self.along(hole.plane, None, Extra::default())?;
                    if !is_last {
                        self.along(depth + back, None, Extra::default())?;
                    }
                }
            }
            84 => self.tap(&hole)?,
            85 => {
                self.along(hole.depth, Some(hole.feed), dwell)?;
                self.along(hole.plane, Some(hole.feed), Extra::default())?;
            }
            _ => {
                self.along(hole.depth, Some(hole.feed), dwell)?;
                self.along(hole.plane, None, Extra::default())?;
            }
        }
        self.along(hole.retract, None, Extra::default())?;
        Ok(())
    }

    fn tap(&mut self, hole: &Hole) -> Result<(), Refusal> {
        let [rpm, ..] = self.0.modal.speeds;
        if rpm <= 0.0 {
            return wrong("G84 needs the speed of the spindle, S");
        }
        let feed = Some(hole.feed * rpm);
        let (down, up) = match hole.chuck {
            3 | 4 => {
                let sense = match hole.chuck {
                    3 => Sense::Clockwise,
                    _ => Sense::CounterClockwise,
                };
                let thread = |spindle, retracts| Extra {
                    law: Some(OverrideLaw::Spindle(Thread {
                        pitch_mm: hole.feed,
                        spindle,
                        orientation_deg: None,
                        retracts,
                    })),
                    ..Extra::default()
                };
                (thread(sense, false), thread(sense.opposite(), true))
            }
            _ => {
                let law = Some(OverrideLaw::Disabled);
                let turn = |m: u16, at: At, synchronisation, order| TechnologyFunction {
                    spindle: Some(order),
                    ..TechnologyFunction::new(Function::M(m), at, synchronisation)
                };
                let functions = vec![
                    turn(
                        4,
                        At::Start,
                        Synchronisation::MvsSvs,
                        SpindleOrder::CounterClockwise,
                    ),
                    turn(3, At::End, Synchronisation::MnsSns, SpindleOrder::Clockwise),
                ];
                let down = Extra {
                    law,
                    ..Extra::default()
                };
                let up = Extra {
                    law,
                    functions,
                    ..Extra::default()
                };
                (down, up)
            }
        };
        self.along(hole.depth, feed, down)?;
        self.along(hole.plane, feed, up)?;
        Ok(())
    }

    /// Holes at the places of a pattern.
    pub fn drill_pattern(&mut self, pattern: u16, word: u16, data: &PathData) -> Result<(), Refusal> {
        for [x, y] in places(pattern, data)? {
            let mut program = self.0.modal.to_program(&self.0.here);
            self.0.modal.plane.set(&mut program, [x, y]);
            let mut end = self.0.modal.to_machine(&program);
            let normal = self.0.modal.plane.normal;
            end[normal] = self.0.here[normal];
            self.0.push(Curve::Line, end, FeedRate::Rapid, Extra::default())?;
            self.drill(word, data)?;
        }
        Ok(())
    }
}

/// Where the places of a pattern lie, coordinates of the program.
fn places(pattern: u16, data: &PathData) -> Result<Vec<[f64; 2]>, Refusal> {
    let all = data.pattern();
    let number = |at: usize| all.get(at - 100).copied().flatten();
    let count = |at: usize| {
        let said = number(at).unwrap_or(0.0).round();
        match (1.0..=PLACES_MAX).contains(&said) {
            true => Ok(said as u32),
            false => wrong(format!("G{pattern}: P{at} is not 1 to {PLACES_MAX}")),
        }
    };
    let step = |length: usize, count: u32| {
        let divided = number(length).map(|length| length / f64::from(count.max(2) - 1));
        number(length + 1).or(divided).unwrap_or(0.0)
    };
    let vector = |angle: usize, count: u32| {
        let (sin, cos) = number(angle).unwrap_or(0.0).to_radians().sin_cos();
        let step = step(angle + 1, count);
        [step * cos, step * sin]
    };
    if pattern == 89 {
        let [x, y, radius] = [120, 121, 122].map(|at| number(at).unwrap_or(0.0));
        let all = count(126)?;
        let sweep = number(124).unwrap_or(360.0);
        let parts = if sweep.abs() >= 360.0 { all } else { all.max(2) - 1 };
        let step = number(125).unwrap_or(sweep / f64::from(parts));
        let first = number(123).unwrap_or(0.0);
        return Ok((0..all)
            .map(|at| {
                let (sin, cos) = (first + f64::from(at) * step).to_radians().sin_cos();
                [x + radius / 2.0 * cos, y + radius / 2.0 * sin]
            })
            .collect());
    }
    let [x, y] = [100, 101].map(|at| number(at).unwrap_or(0.0));
    let along = count(106)?;
    let one = vector(103, along);
    let at = |i: u32, j: u32, two: [f64; 2]| {
        let of = |axis: usize| {
            let part = |vector: [f64; 2]| vector.get(axis).copied().unwrap_or_default();
            part([x, y]) + f64::from(i) * part(one) + f64::from(j) * part(two)
        };
        [of(0), of(1)]
    };
    if pattern == 86 {
        return Ok((0..along).map(|i| at(i, 0, [0.0; 2])).collect());
    }
    let across = count(116)?;
    let two = vector(113, across);
    if f64::from(along) * f64::from(across) > PLACES_MAX {
        return wrong(format!("G{pattern}: more than {PLACES_MAX} places"));
    }
    if pattern == 88 {
        let rows = (0..across).flat_map(|j| (0..along).map(move |i| (i, j)));
        return Ok(rows.map(|(i, j)| at(i, j, two)).collect());
    }
    let mut round: Vec<(u32, u32)> = (0..along).map(|i| (i, 0)).collect();
    round.extend((1..across).map(|j| (along - 1, j)));
    if across > 1 {
        round.extend((0..along - 1).rev().map(|i| (i, across - 1)));
    }
    if along > 1 {
        round.extend((1..across - 1).rev().map(|j| (0, j)));
    }
    Ok(round.into_iter().map(|(i, j)| at(i, j, two)).collect())
}
