//! The commissioning assistant: circle tests and stops on the plant, parameter by parameter in the order of the manual
//! [000:9549-9817] [000:18523-18607].

use bahn_control::{Control, Signal};
use bahn_machine::Machine;
use bahn_parameters::axis::AxisParameters;
use bahn_parameters::{Adjustment, ParameterId, ParameterList};

use crate::machine_folder::LoadedMachine;
use crate::trial;

/// Overshoot of a stop that is never too much, mm.
const OVERSHOOT_MM: f64 = 0.005;
/// So much better must a trial be than the best before.
const BETTER: f64 = 0.98;
/// kv rises by this factor from trial to trial, as long as the contour gets better.
const KV_FACTOR: f64 = 1.25;
/// Backlash that is none, mm.
const BACKLASH_MIN_MM: f64 = 0.001;
/// Recommended monitoring, times the lag at rapid traverse [000:9806-9817].
const MONITOR: f64 = 1.2;
const EMERGENCY: f64 = 1.4;
/// Blocks of the trial: the two circles, and the two movements with their stops.
const CIRCLES: std::ops::RangeInclusive<u32> = 5..=6;
const STOPS: [u32; 2] = [7, 10];

/// The circle of a test.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Circle {
    /// Radius, mm.
    pub radius_mm: f64,
    /// Feed, mm/min.
    pub feed_mm_min: f64,
}

/// What a trial has shown of the tables, which no encoder sees.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct CircleTest {
    /// Greatest distance from the circle, mm.
    pub contour_mm: f64,
    /// Difference between the greatest and the least radius, mm.
    pub roundness_mm: f64,
    /// How far the first axis goes beyond a stop after rapid traverse, mm.
    pub overshoot_mm: f64,
    /// Angle, degrees, and distance from the circle, mm, in the order of time.
    pub points: Vec<[f64; 2]>,
    /// Time, s, and way that is left, mm, around the first stop: the step response of the position loop.
    pub stop: Vec<[f64; 2]>,
    /// Play between encoder and table of both axes, mm.
    pub backlash_mm: [f64; 2],
}

/// A parameter that the assistant would change.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Change {
    /// Which.
    pub id: ParameterId,
    /// Its entry before and now.
    pub from: f64,
    /// See `from`.
    pub to: f64,
}

/// What the assistant found.
#[derive(Clone, Debug)]
pub struct Tuned {
    /// The axes of the circle.
    pub axes: [char; 2],
    /// With the list as it was.
    pub before: CircleTest,
    /// With what it proposes.
    pub after: CircleTest,
    /// What it proposes, in ascending order.
    pub changes: Vec<Change>,
    /// Trials that were run.
    pub trials: usize,
}

/// What is tried: adjustments of axes by their index.
type Try = Vec<(Adjustment, u8, f64)>;

struct Assistant<'a> {
    machine: &'a LoadedMachine,
    axes: [AxisParameters; 2],
    circle: Circle,
    list: ParameterList,
    best: CircleTest,
    overshoot_mm: f64,
    trials: usize,
}

/// Tunes two axes of a machine that describe a circle.
///
/// # Errors
/// When the machine has no such axes, or its list does not get it through the circle.
pub fn tune(
    machine: &LoadedMachine,
    list: &ParameterList,
    letters: [char; 2],
    circle: Circle,
) -> Result<Tuned, String> {
    let axis = |letter: char| {
        let mut axes = (0..5).map(|index| list.axis_parameters(index));
        let found =
            axes.find(|axis| axis.controlled && axis.letter.is_some_and(|own| own.letter() == letter));
        found.ok_or_else(|| format!("the machine has no axis {letter}"))
    };
    let axes = [axis(letters[0])?, axis(letters[1])?];
    let before = test(machine, list, &axes, circle)?;
    let mut assistant = Assistant {
        machine,
        axes,
        circle,
        list: list.clone(),
        overshoot_mm: before.overshoot_mm.max(OVERSHOOT_MM),
        best: before.clone(),
        trials: 1,
    };
    assistant.speed_controllers();
    assistant.position_loops();
    assistant.mechanics();
    Ok(Tuned {
        axes: letters,
        changes: changes(list, &assistant.list),
        before,
        after: assistant.best,
        trials: assistant.trials,
    })
}

/// The entries in which two lists differ.
fn changes(before: &ParameterList, after: &ParameterList) -> Vec<Change> {
    let all = bahn_parameters::Definition::all(before.model());
    let differ = all.iter().filter_map(|definition| {
        let index = definition.id.index.unwrap_or(0);
        let value = |list: &ParameterList| list.get(definition.id.number, index);
        let (from, to) = (value(before)?, value(after)?);
        (from != to).then_some(Change {
            id: definition.id,
            from,
            to,
        })
    });
    differ.collect()
}

impl Assistant<'_> {
    /// Tries adjustments; keeps them when the contour gets better and stops do not overshoot. Whether it did.
    fn attempt(&mut self, adjustments: &Try) -> bool {
        let mut list = self.list.clone();
        for (what, index, value) in adjustments {
            list.adjust(*what, *index, *value);
        }
        if changes(&self.list, &list).is_empty() {
            return false;
        }
        self.trials += 1;
        let Ok(test) = test(self.machine, &list, &self.axes, self.circle) else {
            return false;
        };
        let better =
            test.contour_mm < self.best.contour_mm * BETTER && test.overshoot_mm <= self.overshoot_mm;
        if better {
            self.list = list;
            self.best = test;
        }
        better
    }

    fn value(&self, what: Adjustment, index: u8) -> Option<f64> {
        self.list.adjustment(what, index)
    }

    /// Goes on by a factor from what an entry is, up or else down, as long as that is better.
    fn climb(&mut self, what: Adjustment, index: u8, factor: f64, with: impl Fn(f64) -> Try) {
        for factor in [factor, 1.0 / factor] {
            let mut climbed = false;
            while let Some(value) = self.value(what, index) {
                let mut all = with(value * factor);
                all.push((what, index, value * factor));
                if !self.attempt(&all) {
                    break;
                }
                climbed = true;
            }
            if climbed {
                return;
            }
        }
    }

    /// P, I with its monitoring, and acceleration pre-control of digital speed controllers [000:18552-18607].
    fn speed_controllers(&mut self) {
        for axis in self.axes.map(|axis| axis.index) {
            if self.list.axis_parameters(axis).digital.is_none() {
                continue;
            }
            for factor in [0.4, 0.6, 0.8, 1.0, 1.3] {
                self.attempt(&vec![(Adjustment::AccelerationPrecontrol, axis, factor)]);
            }
            self.climb(Adjustment::Proportional, axis, 1.3, |_| Vec::new());
            self.climb(Adjustment::Integral, axis, 1.4, |integral| {
                vec![(
                    Adjustment::SpeedMonitor,
                    axis,
                    Adjustment::speed_monitor(integral),
                )]
            });
            self.climb(Adjustment::AccelerationPrecontrol, axis, 1.1, |_| Vec::new());
        }
    }

    /// Method and kv, the same for both axes [000:4780-4788], with the monitoring that goes with it.
    fn position_loops(&mut self) {
        let first = self.axes[0].index;
        self.attempt(&vec![(Adjustment::ServoLag, first, 0.0)]);
        let mut misses = 0;
        let mut factor = KV_FACTOR;
        while misses < 2 {
            if self.attempt(&self.kv(factor)) {
                (misses, factor) = (0, KV_FACTOR);
            } else {
                misses += 1;
                factor *= KV_FACTOR;
            }
        }
        for transient in [1.0, 2.0] {
            self.attempt(&vec![(Adjustment::Transient, first, transient)]);
        }
    }

    fn kv(&self, factor: f64) -> Try {
        let mut all = Vec::new();
        for axis in &self.axes {
            let greatest = |what| {
                let values = self.axes.iter().filter_map(|axis| self.value(what, axis.index));
                values.fold(0.0, f64::max) * factor
            };
            let (precontrol, lag) = (greatest(Adjustment::KvPrecontrol), greatest(Adjustment::KvLag));
            all.push((Adjustment::KvPrecontrol, axis.index, precontrol));
            all.push((Adjustment::KvLag, axis.index, lag));
            let at_rapid = axis.motion.rapid_mm_min * 1e-3 / lag;
            all.push((Adjustment::LagMonitor, axis.index, MONITOR * at_rapid));
            all.push((Adjustment::LagEmergency, axis.index, EMERGENCY * at_rapid));
        }
        all
    }

    /// Backlash, reversal peaks and stiction.
    fn mechanics(&mut self) {
        let play = self.best.backlash_mm;
        let backlash: Try = std::iter::zip(&self.axes, play)
            .filter(|(_, play)| play.abs() > BACKLASH_MIN_MM)
            .map(|(axis, play)| {
                (
                    Adjustment::Backlash,
                    axis.index,
                    axis.compensation.backlash_mm + play,
                )
            })
            .collect();
        if !backlash.is_empty() {
            self.attempt(&backlash);
        }
        for axis in self.axes.map(|axis| axis.index) {
            if self.list.axis_parameters(axis).digital.is_some() {
                for height in [0.002, 0.004, 0.006, 0.009, 0.013] {
                    self.attempt(&vec![(Adjustment::DigitalReversal, axis, height)]);
                }
                self.climb(Adjustment::DigitalReversal, axis, 1.2, |_| Vec::new());
                continue;
            }
            for height in [0.001, 0.002, 0.004, 0.008] {
                for parts in [1.0, 3.0] {
                    let peak = vec![
                        (Adjustment::ReversalHeight, axis, height),
                        (Adjustment::ReversalStep, axis, height / parts),
                    ];
                    self.attempt(&peak);
                }
            }
            for factor in [5000.0, 10_000.0] {
                let stiction = vec![
                    (Adjustment::StictionFactor, axis, factor),
                    (Adjustment::StictionLimit, axis, 30.0),
                    (Adjustment::StictionFeed, axis, 200.0),
                ];
                self.attempt(&stiction);
            }
        }
        // Higher kv may bear what the mechanics spoiled before.
        self.attempt(&self.kv(KV_FACTOR));
    }
}

/// A circle in each direction, then rapid traverse to and fro with stops.
fn blocks(
    machine: &LoadedMachine,
    axes: &[AxisParameters; 2],
    circle: Circle,
) -> Result<(String, [f64; 2]), String> {
    let mut places = [0.0; 2];
    let mut names = ['X'; 2];
    let datum = machine.datum();
    let mut centre = [0.0; 2];
    for (place, axis) in axes.iter().enumerate() {
        let letter = axis.letter.ok_or_else(|| "an axis without letter".to_owned())?;
        let [least, greatest] = axis.travel.ranges_mm[0];
        if greatest - least < 2.0 * circle.radius_mm + 2.0 {
            return Err(format!(
                "a circle of {} mm has no place in the travel of {}",
                circle.radius_mm,
                letter.letter()
            ));
        }
        let middle = (least + greatest) / 2.0;
        let zero = if datum[letter].is_finite() {
            datum[letter]
        } else {
            0.0
        };
        (places[place], names[place], centre[place]) = (middle - zero, letter.letter(), middle);
    }
    let ([a, b], [x, y], r) = (names, places, circle.radius_mm);
    let dwell = "CYCL DEF 9.0 DWELL TIME\nCYCL DEF 9.1 DWELL 0.4";
    let text = format!(
        "L {a}{:+.4} {b}{y:+.4} R0 FMAX\n{dwell}\nCC {a}{x:+.4} {b}{y:+.4}\n\
         C {a}{:+.4} {b}{y:+.4} DR+ F{:.0}\nC {a}{:+.4} {b}{y:+.4} DR-\n\
         L {a}{:+.4} FMAX\n{dwell}\nL {a}{:+.4} FMAX\n{dwell}\nL {a}{x:+.4} FMAX",
        x + r,
        x + r,
        circle.feed_mm_min,
        x + r,
        x - r,
        x + r
    );
    Ok((text, centre))
}

/// What is seen of the tables in a contour cycle.
struct Sample {
    time_us: u64,
    block: u32,
    table: [f64; 2],
    nominal: [f64; 2],
    actual: [f64; 2],
}

/// A trial with a list.
fn test(
    machine: &LoadedMachine,
    list: &ParameterList,
    axes: &[AxisParameters; 2],
    circle: Circle,
) -> Result<CircleTest, String> {
    let (text, centre) = blocks(machine, axes, circle)?;
    let letters = axes.map(|axis| axis.letter.map_or('X', |letter| letter.letter()));
    let signals = |name: &str| letters.map(|letter| format!("{letter}.{name}").parse::<Signal>().ok());
    let (nominal, actual) = (signals("nominal"), signals("actual"));
    let mut samples: Vec<Sample> = Vec::new();
    let mut block = 0;
    trial::run(machine, list, &text, |control: &Control, plant: &Machine| {
        if let Some(element) = control.element() {
            block = element.block.block;
        }
        let observe = |signal: &Option<Signal>| signal.map_or(0.0, |signal| control.observe(&signal));
        samples.push(Sample {
            time_us: control.time_us(),
            block,
            table: letters.map(|letter| plant.axis(letter).map_or(0.0, |axis| axis.position)),
            nominal: [observe(&nominal[0]), observe(&nominal[1])],
            actual: [observe(&actual[0]), observe(&actual[1])],
        });
    })?;
    evaluate(&samples, centre, circle)
}

fn evaluate(samples: &[Sample], centre: [f64; 2], circle: Circle) -> Result<CircleTest, String> {
    let round: Vec<&Sample> = samples
        .iter()
        .filter(|sample| CIRCLES.contains(&sample.block))
        .collect();
    if round.len() < 10 {
        return Err("the circle was not described".to_owned());
    }
    let count = round.len() as f64;
    // Where the zero point of the plant lies from that of the control: lags of a whole circle have no mean.
    let mean = |place: usize| {
        round
            .iter()
            .map(|sample| sample.table[place] - sample.nominal[place])
            .sum::<f64>()
            / count
    };
    let at = [centre[0] + mean(0), centre[1] + mean(1)];
    let points: Vec<[f64; 2]> = round
        .iter()
        .map(|sample| {
            let (x, y) = (sample.table[0] - at[0], sample.table[1] - at[1]);
            [
                y.atan2(x).to_degrees().rem_euclid(360.0),
                x.hypot(y) - circle.radius_mm,
            ]
        })
        .collect();
    let greatest = points
        .iter()
        .map(|point| point[1])
        .fold(f64::NEG_INFINITY, f64::max);
    let least = points.iter().map(|point| point[1]).fold(f64::INFINITY, f64::min);
    let stops = STOPS.map(|block| stop(samples, block));
    Ok(CircleTest {
        contour_mm: greatest.abs().max(least.abs()),
        roundness_mm: greatest - least,
        overshoot_mm: stops.iter().map(|(overshoot, _)| *overshoot).fold(0.0, f64::max),
        stop: stops
            .into_iter()
            .next()
            .map(|(_, points)| points)
            .unwrap_or_default(),
        points,
        backlash_mm: [play(&round, 0), play(&round, 1)],
    })
}

/// How far a stop goes beyond where it ends, mm, and the way left over time, s.
fn stop(samples: &[Sample], block: u32) -> (f64, Vec<[f64; 2]>) {
    // It rests in the dwell behind the block.
    let all = || {
        samples
            .iter()
            .filter(|sample| (block..=block + 2).contains(&sample.block))
    };
    let (Some(first), Some(last)) = (all().next(), all().next_back()) else {
        return (0.0, Vec::new());
    };
    let end = last.table[0];
    let direction = (end - first.table[0]).signum();
    let mut moves = all().filter(|sample| (sample.nominal[0] - last.nominal[0]).abs() > 1e-6);
    let arrived_us = moves.next_back().map_or(first.time_us, |sample| sample.time_us);
    let beyond = all()
        .map(|sample| (sample.table[0] - end) * direction)
        .fold(0.0, f64::max);
    let from = arrived_us.saturating_sub(60_000);
    let points = all().filter(|sample| sample.time_us >= from).map(|sample| {
        [
            (sample.time_us - from) as f64 * 1e-6,
            (end - sample.table[0]) * direction,
        ]
    });
    (beyond, points.collect())
}

/// The play between encoder and table: what the table lags behind its encoder when it goes one way and the other.
fn play(round: &[&Sample], place: usize) -> f64 {
    let mut sums = [(0.0, 0.0); 2];
    for pair in round.windows(2) {
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
