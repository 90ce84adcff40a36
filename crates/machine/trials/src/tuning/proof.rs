//! What a list of machine parameters does on the plant: a trial of two axes that describe circles, or of one that goes to
//! and fro, with stops of each.
//!
//! Decision: An axis alone is judged by how far it is from its nominal value less what is in proportion to its speed,
//! since axes that lag alike leave no contour; its MP1810 goes no higher than that of the others

use std::fmt::Write as _;

use bahn_machine::Machine;
use bahn_parameters::ParameterList;
use bahn_parameters::axis::AxisParameters;
use bahn_tnc::{Control, Signal};

use crate::trial;
use bahn_host::LoadedMachine;

/// What must be left between a trial and the ends of the travel, mm.
const MARGIN_MM: f64 = 1.0;
/// An axis goes at rapid traverse for so long before it brakes, s *(inferred)*: "as large as possible" [000:9711].
const AT_RAPID_S: f64 = 0.3;
/// An axis alone goes a part of its way slower by this: play is the same then, what the loop lags is not.
const SLOWER: f64 = 3.0;
/// Axes whose tables are watched in a trial: those of a circle, and others that stop beside it.
const WATCHED_MAX: usize = 4;
/// So near to its end a stop is over, mm.
const STOPPED_MM: f64 = 0.01;
/// Time around a stop that is kept before the nominal value stands, µs.
const BEFORE_STOP_US: u64 = 60_000;

/// The circle of a test, or the way of an axis alone.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Circle {
    /// Radius, mm; an axis alone goes so far to both sides, mm or degrees.
    pub radius_mm: f64,
    /// Feed, mm/min or degrees/min.
    pub feed_mm_min: f64,
}

/// What a trial has shown of the tables, which no encoder sees. Units are mm, of rotary axes degrees.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct AxisTest {
    /// Greatest distance from the circle; of an axis alone from where its nominal value was a
    /// constant time before, since such a time is no error of a contour.
    pub contour_mm: f64,
    /// Difference between the greatest and the least radius; of an axis alone between the greatest distance ahead and behind.
    pub roundness_mm: f64,
    /// How far an axis goes beyond a stop after rapid traverse or the feed.
    pub overshoot_mm: f64,
    /// Time for the stops, each from its first movement until the axis stays within 0.01 of its end, s.
    pub stops_s: f64,
    /// How far each axis stands from its nominal value when it rests.
    pub standstill_mm: Vec<f64>,
    /// Angle, degrees, and distance from the circle, in the order of time; of an axis alone time, s, and distance.
    pub points: Vec<[f64; 2]>,
    /// Time, s, and way that is left around the first stop: the step response of the position loop.
    pub stop: Vec<[f64; 2]>,
    /// Play between encoder and table of each axis.
    pub backlash_mm: Vec<f64>,
}

/// Axes that are tried together.
pub(super) struct Subject<'a> {
    pub machine: &'a LoadedMachine,
    /// One, or the two of a circle.
    pub axes: Vec<AxisParameters>,
    /// Those that share entries with them: they stop, too.
    pub beside: Vec<AxisParameters>,
    pub circle: Circle,
}

/// The blocks of a trial, and in which of them is what.
struct Blocks {
    text: String,
    count: u32,
    /// Where the circles are, or the way to and fro.
    path: std::ops::RangeInclusive<u32>,
    /// Blocks with a stop after them, and the place of the axis that stops.
    stops: Vec<(u32, usize)>,
    /// In positions of the machine.
    centre: Vec<f64>,
}

/// What is seen of the tables in a contour cycle.
struct Sample {
    time_us: u64,
    block: u32,
    table: [f64; WATCHED_MAX],
    nominal: [f64; WATCHED_MAX],
    actual: [f64; WATCHED_MAX],
}

impl Blocks {
    fn push(&mut self, block: &str) {
        let _ = writeln!(self.text, "{block}");
        self.count += 1;
    }

    /// A stop with the dwell in which the axis comes to rest.
    fn stop(&mut self, place: usize, block: &str) {
        self.push(block);
        self.stops.push((self.count, place));
        self.dwell();
    }

    fn dwell(&mut self) {
        self.push("CYCL DEF 9.0 DWELL TIME");
        self.push("CYCL DEF 9.1 DWELL 0.4");
    }
}

impl Subject<'_> {
    /// The axes of the path, then those beside it.
    fn watched(&self) -> impl Iterator<Item = &AxisParameters> {
        self.axes.iter().chain(&self.beside).take(WATCHED_MAX)
    }

    fn letters(&self) -> Vec<char> {
        self.watched()
            .map(|axis| axis.letter.map_or('X', |letter| letter.letter()))
            .collect()
    }

    /// The middle of the travel of an axis: in the coordinates of programs and of the machine, and the room to both sides.
    fn middle(&self, axis: &AxisParameters, least_room: f64) -> Result<[f64; 3], String> {
        let letter = axis.letter.ok_or_else(|| "an axis without letter".to_owned())?;
        let [least, greatest] = axis.travel.ranges_mm[0];
        let room = (greatest - least) / 2.0 - MARGIN_MM;
        if room < least_room {
            let what = match self.axes.len() {
                1 => "a way to both sides",
                _ => "a circle",
            };
            return Err(format!(
                "{what} of {least_room} mm has no place in the travel of {}",
                letter.letter()
            ));
        }
        let datum = self.machine.datum();
        let zero = Some(datum[letter]).filter(|zero| zero.is_finite()).unwrap_or(0.0);
        let middle = (least + greatest) / 2.0;
        Ok([middle - zero, middle, room])
    }

    /// A circle in each direction, or a way to and fro; then each axis at rapid traverse and at the feed, with stops.
    fn blocks(&self) -> Result<Blocks, String> {
        let (letters, r, feed) = (self.letters(), self.circle.radius_mm, self.circle.feed_mm_min);
        let mut middles = Vec::new();
        for axis in &self.axes {
            middles.push(self.middle(axis, r)?);
        }
        let path = middles.len();
        let mut blocks = Blocks {
            text: String::new(),
            count: 0,
            path: 0..=0,
            stops: Vec::new(),
            centre: middles.iter().map(|middle| middle[1]).collect(),
        };
        match (letters.get(..path).unwrap_or_default(), middles.as_slice()) {
            (&[a, b], &[[x, ..], [y, ..]]) => {
                blocks.push(&format!("L {a}{:+.4} {b}{y:+.4} R0 FMAX", x + r));
                blocks.dwell();
                blocks.push(&format!("CC {a}{x:+.4} {b}{y:+.4}"));
                let first = blocks.count + 1;
                blocks.push(&format!("C {a}{:+.4} {b}{y:+.4} DR+ F{feed:.0}", x + r));
                blocks.push(&format!("C {a}{:+.4} {b}{y:+.4} DR-", x + r));
                blocks.path = first..=blocks.count;
            }
            (&[a], &[[x, ..]]) => {
                blocks.push(&format!("L {a}{:+.4} R0 FMAX", x - r));
                blocks.dwell();
                let first = blocks.count + 1;
                blocks.push(&format!("L {a}{:+.4} F{feed:.0}", x + r));
                blocks.push(&format!("L {a}{:+.4}", x - r));
                blocks.push(&format!("L {a}{x:+.4} F{:.0}", feed / SLOWER));
                blocks.push(&format!("L {a}{:+.4}", x - r));
                blocks.path = first..=blocks.count;
            }
            _ => return Err("one axis is tuned, or two that describe a circle".to_owned()),
        }
        for axis in &self.beside {
            middles.push(self.middle(axis, 0.0)?);
        }
        for (place, ((axis, letter), [x, _, room])) in self.watched().zip(&letters).zip(&middles).enumerate()
        {
            // As long as it takes to reach rapid traverse, mm/s, with the acceleration, mm/s².
            let (v, a) = (
                axis.motion.rapid_mm_min / 60.0,
                axis.motion.acceleration_m_s2 * 1e3,
            );
            let half = (0.5 * (v * v / a.max(1.0) + v * AT_RAPID_S)).clamp(r.min(*room), *room);
            blocks.stop(place, &format!("L {letter}{:+.4} R0 FMAX", x - half));
            blocks.stop(place, &format!("L {letter}{:+.4} FMAX", x + half));
            blocks.stop(
                place,
                &format!("L {letter}{:+.4} F{feed:.0}", x + half - r.min(half)),
            );
        }
        Ok(blocks)
    }

    /// A trial with a list.
    pub fn prove(&self, list: &ParameterList) -> Result<AxisTest, String> {
        let blocks = self.blocks()?;
        let letters = self.letters();
        let signals = |name: &str| -> Vec<Option<Signal>> {
            let all = letters.iter();
            all.map(|letter| format!("{letter}.{name}").parse().ok())
                .collect()
        };
        let (nominal, actual) = (signals("nominal"), signals("actual"));
        let watched = letters.len();
        let places = |of: &dyn Fn(usize) -> f64| {
            std::array::from_fn(|place| if place < watched { of(place) } else { 0.0 })
        };
        let mut samples: Vec<Sample> = Vec::new();
        let mut block = 0;
        trial::run(
            self.machine,
            list,
            blocks.text.trim(),
            |control: &Control, plant: &Machine| {
                if let Some(element) = control.element() {
                    block = element.block.block;
                }
                let observe = |signals: &[Option<Signal>], place: usize| {
                    let signal = signals.get(place).and_then(Option::as_ref);
                    signal.map_or(0.0, |signal| control.observe(signal))
                };
                let table = |place: usize| {
                    let letter = letters.get(place).copied().unwrap_or('X');
                    plant.axis(letter).map_or(0.0, |axis| axis.position)
                };
                samples.push(Sample {
                    time_us: control.time_us(),
                    block,
                    table: places(&table),
                    nominal: places(&|place| observe(&nominal, place)),
                    actual: places(&|place| observe(&actual, place)),
                });
            },
        )?;
        self.evaluate(&samples, &blocks)
    }

    fn evaluate(&self, samples: &[Sample], blocks: &Blocks) -> Result<AxisTest, String> {
        let path: Vec<&Sample> = samples
            .iter()
            .filter(|sample| blocks.path.contains(&sample.block))
            .collect();
        if path.len() < 10 {
            return Err("the path was not described".to_owned());
        }
        let points = match blocks.centre.as_slice() {
            &[x, y] => circle(&path, [x, y], self.circle.radius_mm),
            _ => line(&path),
        };
        let greatest = points
            .iter()
            .map(|point| point[1])
            .fold(f64::NEG_INFINITY, f64::max);
        let least = points.iter().map(|point| point[1]).fold(f64::INFINITY, f64::min);
        let stops: Vec<Stop> = blocks
            .stops
            .iter()
            .map(|(block, place)| stop(samples, *block, *place))
            .collect();
        let places = 0..self.axes.len();
        let rest = |place: usize| {
            let of_axis = stops.iter().filter(|stop| stop.place == place);
            of_axis.map(|stop| stop.rest).fold(0.0, f64::max)
        };
        Ok(AxisTest {
            contour_mm: greatest.abs().max(least.abs()),
            roundness_mm: greatest - least,
            overshoot_mm: stops.iter().map(|stop| stop.beyond).fold(0.0, f64::max),
            stops_s: stops.iter().map(|stop| stop.seconds).sum(),
            standstill_mm: places.clone().map(rest).collect(),
            backlash_mm: places.map(|place| play(&path, place)).collect(),
            stop: stops
                .into_iter()
                .next()
                .map(|stop| stop.points)
                .unwrap_or_default(),
            points,
        })
    }
}

/// Where the zero point of the plant lies from that of the control: lags of a whole circle, or of a way to and fro, have no
/// mean.
fn zero(path: &[&Sample], place: usize) -> f64 {
    let sum: f64 = path
        .iter()
        .map(|sample| sample.table[place] - sample.nominal[place])
        .sum();
    sum / path.len() as f64
}

/// Angle and distance from the circle.
fn circle(path: &[&Sample], centre: [f64; 2], radius_mm: f64) -> Vec<[f64; 2]> {
    let at = [centre[0] + zero(path, 0), centre[1] + zero(path, 1)];
    let points = path.iter().map(|sample| {
        let (x, y) = (sample.table[0] - at[0], sample.table[1] - at[1]);
        [y.atan2(x).to_degrees().rem_euclid(360.0), x.hypot(y) - radius_mm]
    });
    points.collect()
}

/// Time and distance from the nominal value, less what is in proportion to the speed: all axes of a path have that alike.
fn line(path: &[&Sample]) -> Vec<[f64; 2]> {
    let zero = zero(path, 0);
    let lags: Vec<[f64; 3]> = path
        .windows(2)
        .filter_map(|pair| {
            let [before, sample] = pair else { return None };
            let time_s = (sample.time_us - before.time_us) as f64 * 1e-6;
            let speed = (sample.nominal[0] - before.nominal[0]) / time_s.max(1e-6);
            Some([
                sample.time_us as f64 * 1e-6,
                speed,
                sample.table[0] - sample.nominal[0] - zero,
            ])
        })
        .collect();
    let sum = |of: fn(&[f64; 3]) -> f64| lags.iter().map(of).sum::<f64>();
    let delay_s = sum(|[_, speed, lag]| speed * lag) / sum(|[_, speed, _]| speed * speed).max(1e-12);
    let from_s = lags.first().map_or(0.0, |lag| lag[0]);
    let points = lags
        .iter()
        .map(|[time, speed, lag]| [time - from_s, lag - delay_s * speed]);
    points.collect()
}

/// A stop: how far the axis goes beyond where it ends, how far from its nominal value it rests, and the way left over time, s.
#[derive(Default)]
struct Stop {
    place: usize,
    beyond: f64,
    seconds: f64,
    rest: f64,
    points: Vec<[f64; 2]>,
}

fn stop(samples: &[Sample], block: u32, place: usize) -> Stop {
    // It rests in the dwell after the block.
    let all = || {
        samples
            .iter()
            .filter(|sample| (block..=block + 2).contains(&sample.block))
    };
    let (Some(first), Some(last)) = (all().next(), all().next_back()) else {
        return Stop::default();
    };
    let end = last.table[place];
    let direction = (end - first.table[place]).signum();
    let mut moves = all().filter(|sample| (sample.nominal[place] - last.nominal[place]).abs() > 1e-6);
    let arrived_us = moves.next_back().map_or(first.time_us, |sample| sample.time_us);
    let beyond = all()
        .map(|sample| (sample.table[place] - end) * direction)
        .fold(0.0, f64::max);
    let mut outside = all().filter(|sample| (sample.table[place] - end).abs() > STOPPED_MM);
    let stopped_us = outside.next_back().map_or(first.time_us, |sample| sample.time_us);
    let from = arrived_us.saturating_sub(BEFORE_STOP_US);
    let points = all().filter(|sample| sample.time_us >= from).map(|sample| {
        [
            (sample.time_us - from) as f64 * 1e-6,
            (end - sample.table[place]) * direction,
        ]
    });
    Stop {
        place,
        beyond,
        seconds: (stopped_us - first.time_us) as f64 * 1e-6,
        rest: (last.nominal[place] - last.actual[place]).abs(),
        points: points.collect(),
    }
}

/// The play between encoder and table: what the table lags behind its encoder when it goes one way and the other.
fn play(path: &[&Sample], place: usize) -> f64 {
    let mut sums = [(0.0, 0.0); 2];
    for pair in path.windows(2) {
        let [before, sample] = pair else { continue };
        let way = sample.nominal[place] - before.nominal[place];
        // Near the turning points the table may lie anywhere in its play.
        if way.abs() > 1e-3 {
            let (sum, count) = &mut sums[usize::from(way > 0.0)];
            *sum += sample.table[place] - sample.actual[place];
            *count += 1.0;
        }
    }
    let [(back, backs), (forth, forths)] = sums;
    if backs == 0.0 || forths == 0.0 {
        return 0.0;
    }
    back / backs - forth / forths
}
