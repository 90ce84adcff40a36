//! The commissioning assistant: circle tests and stops on the plant, parameter by parameter in the order of the manual
//! [000:9549-9817] [000:18523-18607], of the TNC 151/155 under their old numbers [001:2377-2392] [001:2612-2760].
//!
//! Decision: `bahn tune` judges by where the tables of the plant stand; each trial is a machine that is switched on
//! anew; a proposal counts when the contour error falls by 2 % and stops overshoot no more than 5 µm or than before
//!
//! Decision: A kink point lies at half of rapid traverse, or where the greatest machining feed is said to be, and is
//! tried where kv alone overshoots; nothing goes over from pre-control to servo lag; the slave of an axis gets its
//! loop

mod alike;
mod proof;
mod spindle;

use bahn_parameters::axis::AxisParameters;
use bahn_parameters::{Adjustment, Definition, ParameterId, ParameterList, PerPlcAxis};
use bahn_servo::Characteristic;

use bahn_host::LoadedMachine;
use proof::Subject;
pub use proof::{AxisTest, Circle};
pub use spindle::{ThreadTest, TunedSpindle, tune_spindle};

/// Overshoot of a stop that is never too much, mm.
const OVERSHOOT_MM: f64 = 0.005;
/// So much better must a trial be than the best before.
const BETTER: f64 = 0.98;
/// kv rises by this factor from trial to trial, as long as the contour gets better.
const KV_FACTOR: f64 = 1.25;
/// Factors of kv above a kink point that are tried where kv alone overshoots at rapid traverse *(inferred: the flow chart is
/// lost)* [000:9700-9706].
const KINK_FACTORS: [f64; 3] = [0.7, 0.5, 0.35];
/// Backlash that is none, mm.
const BACKLASH_MIN_MM: f64 = 0.001;
/// Distance from the nominal value at rest that is none, mm.
const STANDSTILL_MIN_MM: f64 = 0.0005;
/// First integral factor, and what follows [000:9796].
const INTEGRAL_STEP: f64 = 100.0;
const INTEGRAL_STEPS: u8 = 10;
/// Recommended monitoring, times the lag at rapid traverse [000:9806-9817].
const MONITOR: f64 = 1.2;
const EMERGENCY: f64 = 1.4;
/// The same where one entry holds for all axes: lag of the slowest loop and 10 to 20 % [001:2689].
const COMMON_MONITOR: f64 = 1.1;
const COMMON_EMERGENCY: f64 = 1.2;

/// What is tuned, and with what.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Task {
    /// Letter of the axis that is tuned.
    pub axis: char,
    /// Who describes the circle with it; `None` is its partner, where a linear axis has one: X and Y each other, Z has X.
    pub partner: Option<char>,
    /// The circle, or the way of an axis alone.
    pub circle: Circle,
    /// Greatest machining feed, mm/min, above which the kink point lies; `None` is half of rapid traverse *(inferred)*.
    pub machining_mm_min: Option<f64>,
}

/// A parameter that the assistant would change.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Change {
    /// The machine parameter that changes.
    pub id: ParameterId,
    /// Its entry before and now.
    pub from: f64,
    /// Its entry afterwards.
    pub to: f64,
}

/// What the assistant found.
#[derive(Clone, Debug)]
pub struct Tuned {
    /// The axes of the circle, or the one axis.
    pub axes: Vec<char>,
    /// With the list as it was.
    pub before: AxisTest,
    /// With what it proposes.
    pub after: AxisTest,
    /// What it proposes, in ascending order.
    pub changes: Vec<Change>,
    /// kv with servo lag, MP1810, of all axes of the path as proposed: those that interpolate need the same [000:4780].
    pub kv_lag: Vec<(char, f64)>,
    /// Trials that were run.
    pub trials: usize,
}

/// What is tried: adjustments of axes by their index.
type Try = Vec<(Adjustment, u8, f64)>;

struct Assistant<'a> {
    subject: Subject<'a>,
    list: ParameterList,
    best: AxisTest,
    machining_mm_min: Option<f64>,
    trials: usize,
}

/// The axes that a program moves.
fn path_axes(list: &ParameterList) -> impl Iterator<Item = AxisParameters> + '_ {
    let axes = PerPlcAxis::from_fn(|index| list.axis_parameters(index)).into_iter();
    axes.filter(|axis| axis.active && axis.controlled && !axis.plc_axis && axis.letter.is_some())
}

fn letter(axis: &AxisParameters) -> char {
    axis.letter.map_or('?', |letter| letter.letter())
}

/// The axis, alone or with its partner.
fn axes(list: &ParameterList, task: &Task) -> Result<Vec<AxisParameters>, String> {
    let find = |name: char| path_axes(list).find(|axis| letter(axis) == name);
    let named = |name: char| {
        let axis = find(name).ok_or_else(|| {
            let known: Vec<String> = path_axes(list).map(|axis| letter(&axis).to_string()).collect();
            format!(
                "programs move no axis {name} of this machine; there are {}",
                known.join(", ")
            )
        })?;
        if let Some(master) = axis.synchronization.master {
            let master = letter(&list.axis_parameters(master));
            return Err(format!(
                "{name} goes where {master} goes (MP850): tune {master}, and {name} gets the same"
            ));
        }
        Ok(axis)
    };
    let axis = named(task.axis)?;
    let is_pair_of_all = list.is_common(Adjustment::LagMonitor);
    let partner = match (task.partner, task.axis) {
        (Some(partner), _) if partner == task.axis => {
            return Err(format!("a circle needs two axes, not {partner} twice"));
        }
        (Some(partner), _) => Some(named(partner)?),
        (None, 'X') => find('Y'),
        (None, 'Y' | 'Z') => find('X'),
        (None, _) => None,
    };
    let mut pair: Vec<AxisParameters> = std::iter::once(axis).chain(partner).collect();
    // What is found for all axes does not depend on which one is named first.
    if is_pair_of_all {
        pair.sort_by_key(|axis| axis.index);
    }
    let rotary = pair
        .iter()
        .find(|axis| axis.letter.is_some_and(|letter| letter.is_rotary()));
    match rotary {
        Some(rotary) if pair.len() > 1 => Err(format!(
            "{} is a rotary axis: it is tuned alone, by stops and reversals",
            letter(rotary)
        )),
        _ => Ok(pair),
    }
}

/// Tunes an axis of a machine: with a partner by circles, alone by reversals; both by stops.
///
/// # Errors
/// When the machine has no such axes, or its list does not get it through the trial.
pub fn tune(machine: &LoadedMachine, list: &ParameterList, task: &Task) -> Result<Tuned, String> {
    let axes = axes(list, task)?;
    let subject = Subject {
        machine,
        beside: beside(list, &axes),
        axes,
        circle: task.circle,
    };
    let before = subject.prove(list)?;
    let mut assistant = Assistant {
        subject,
        list: list.clone(),
        best: before.clone(),
        machining_mm_min: task.machining_mm_min,
        trials: 1,
    };
    assistant.speed_controllers();
    match assistant.are_all_alike() {
        true => assistant.common_loops(),
        false => assistant.position_loops(),
    }
    assistant.mechanics();
    assistant.integral();
    let masters = path_axes(&assistant.list).filter(|axis| axis.synchronization.master.is_none());
    Ok(Tuned {
        axes: assistant.subject.axes.iter().map(letter).collect(),
        changes: changes(list, &assistant.list),
        kv_lag: masters.map(|axis| (letter(&axis), axis.lag.kv)).collect(),
        before,
        after: assistant.best,
        trials: assistant.trials,
    })
}

/// The linear axes that get the same kv as those of a circle: where acceleration and monitoring are one for all.
fn beside(list: &ParameterList, axes: &[AxisParameters]) -> Vec<AxisParameters> {
    if !list.is_common(Adjustment::LagMonitor) || axes.len() == 1 {
        return Vec::new();
    }
    let is_linear = |axis: &AxisParameters| axis.letter.is_some_and(|letter| !letter.is_rotary());
    let others = path_axes(list).filter(|axis| is_linear(axis));
    others
        .filter(|other| axes.iter().all(|axis| axis.index != other.index))
        .collect()
}

/// The entries in which two lists differ.
fn changes(before: &ParameterList, after: &ParameterList) -> Vec<Change> {
    let all = Definition::all(before.model());
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

/// MP1710 and MP1720 for the lag that an axis has at rapid traverse; MP175 and MP174 for the greatest one of all axes.
fn monitor(list: &mut ParameterList, index: u8) {
    let common = list.is_common(Adjustment::LagMonitor);
    let lag_mm = path_axes(list)
        .filter(|axis| common || axis.index == index)
        .map(|axis| {
            let rapid = axis.motion.rapid_mm_min;
            Characteristic::with_kink(axis.lag.kv, &axis.lag, rapid).lag_mm(rapid)
        })
        .fold(0.0, f64::max);
    let (monitor, emergency) = match common {
        true => (COMMON_MONITOR, COMMON_EMERGENCY),
        false => (MONITOR, EMERGENCY),
    };
    list.adjust(Adjustment::LagMonitor, index, monitor * lag_mm);
    list.adjust(Adjustment::LagEmergency, index, emergency * lag_mm);
}

impl Assistant<'_> {
    fn indices(&self) -> Vec<u8> {
        self.subject.axes.iter().map(|axis| axis.index).collect()
    }

    fn is_alone(&self) -> bool {
        self.subject.axes.len() == 1
    }

    fn first(&self) -> u8 {
        self.subject.axes.first().map_or(0, |axis| axis.index)
    }

    /// Whether all axes of the path get the same: they have acceleration and monitoring in common.
    fn are_all_alike(&self) -> bool {
        self.list.is_common(Adjustment::LagMonitor) && !self.is_alone()
    }

    /// The axes that get the kv of the trial.
    fn kv_axes(&self) -> Vec<u8> {
        match self.are_all_alike() {
            true => path_axes(&self.list).map(|axis| axis.index).collect(),
            false => self.indices(),
        }
    }

    /// What a trial is judged by, mm.
    fn judge(&self) -> fn(&AxisTest) -> f64 {
        match self.are_all_alike() {
            true => |test| test.contour_mm + test.roundness_mm,
            false => |test| test.contour_mm,
        }
    }

    /// The list with adjustments; what belongs to the position loop of an axis its slaves get, too.
    fn adjusted(&self, adjustments: &Try) -> ParameterList {
        use Adjustment::{KinkFactor, KinkPoint, KvLag, KvPrecontrol};
        let mut list = self.list.clone();
        for (what, index, value) in adjustments {
            list.adjust(*what, *index, *value);
            if !matches!(what, KvLag | KvPrecontrol | KinkFactor | KinkPoint) {
                continue;
            }
            let slaves: Vec<u8> = path_axes(&self.list)
                .filter(|axis| axis.synchronization.master == Some(*index))
                .map(|axis| axis.index)
                .collect();
            for one in std::iter::once(*index).chain(slaves) {
                list.adjust(*what, one, *value);
                if *what != KvPrecontrol {
                    monitor(&mut list, one);
                }
            }
        }
        list
    }

    /// Tries adjustments; keeps them when the contour gets better and stops do not overshoot. Whether it did.
    fn attempt(&mut self, adjustments: &Try) -> bool {
        let error_mm = self.judge();
        self.attempt_by(adjustments, |test, best| error_mm(test) < error_mm(best) * BETTER)
    }

    fn attempt_by(&mut self, adjustments: &Try, better: impl Fn(&AxisTest, &AxisTest) -> bool) -> bool {
        let list = self.adjusted(adjustments);
        if changes(&self.list, &list).is_empty() {
            return false;
        }
        self.trials += 1;
        let Ok(test) = self.subject.prove(&list) else {
            return false;
        };
        let bearable_mm = self.best.overshoot_mm.max(OVERSHOOT_MM);
        let taken = better(&test, &self.best) && test.overshoot_mm <= bearable_mm;
        if taken {
            self.list = list;
            self.best = test;
        }
        taken
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
        for axis in self.indices() {
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

    /// kv and kink point, the same kv for axes that interpolate [000:4780-4788], with the monitoring that goes with it: first
    /// with servo lag, then with pre-control [000:9667-9788]. Two axes that run with servo lag go over to pre-control when
    /// that is better; one that is tuned alone leaves MP1390, which is common to all, and nothing goes back to servo lag.
    fn position_loops(&mut self) {
        let first = self.first();
        let Some(method) = self.value(Adjustment::ServoLag, first) else {
            self.servo_lag();
            return;
        };
        let entry = (self.list.clone(), self.best.clone());
        if self.takes_method(1.0) {
            self.servo_lag();
        }
        let lag = (self.list.clone(), self.best.clone());
        if !self.takes_method(0.0) {
            (self.list, self.best) = if method == 0.0 { entry } else { lag };
            return;
        }
        self.precontrol();
        if method == 0.0 {
            return;
        }
        let precontrol = (self.list.clone(), self.best.clone());
        let back = self.takes_method(1.0);
        let worse = precontrol.1.contour_mm > self.best.contour_mm * BETTER;
        if !(back && (worse || self.is_alone())) {
            (self.list, self.best) = precontrol;
        }
    }

    /// Goes over to servo lag (1) or pre-control (0): what is better counts from there. Whether the machine bears it.
    fn takes_method(&mut self, servo_lag: f64) -> bool {
        let first = self.first();
        let mut entries = vec![(Adjustment::ServoLag, first, servo_lag)];
        // The same kv as before, with its monitoring.
        for axis in self.indices() {
            entries.extend(
                self.value(Adjustment::KvLag, axis)
                    .map(|kv| (Adjustment::KvLag, axis, kv)),
            );
        }
        // An axis that has no kv with pre-control begins with that with servo lag, as the table of MP32 does [001:2712].
        for axis in path_axes(&self.list).filter(|axis| servo_lag == 0.0 && axis.precontrol.kv <= 0.0) {
            entries.push((Adjustment::KvPrecontrol, axis.index, axis.lag.kv));
        }
        self.takes(&entries)
    }

    /// Adjusts what is not a matter of better or worse. Whether the machine bears it.
    fn takes(&mut self, adjustments: &Try) -> bool {
        let list = self.adjusted(adjustments);
        if changes(&self.list, &list).is_empty() {
            return true;
        }
        self.trials += 1;
        let Ok(test) = self.subject.prove(&list) else {
            return false;
        };
        (self.list, self.best) = (list, test);
        true
    }

    /// kv with servo lag [000:9667-9706]: as high as stops bear it, and where only those from rapid traverse do not, with a
    /// kink point above the machining feeds.
    fn servo_lag(&mut self) {
        self.raise(|assistant, factor| {
            let straight = assistant.kv(Adjustment::KvLag, factor);
            if assistant.attempt(&straight) {
                return true;
            }
            let points: Vec<(u8, f64)> = assistant.kink_points();
            KINK_FACTORS.iter().any(|kink| {
                let mut kinked = straight.clone();
                for (axis, point) in &points {
                    kinked.push((Adjustment::KinkPoint, *axis, *point));
                    kinked.push((Adjustment::KinkFactor, *axis, *kink));
                }
                assistant.attempt(&kinked)
            })
        });
    }

    /// kv with pre-control, and the transient response, one for all axes, which no axis decides alone [000:9728-9788].
    fn precontrol(&mut self) {
        self.raise(|assistant, factor| {
            let kv = assistant.kv(Adjustment::KvPrecontrol, factor);
            assistant.attempt(&kv)
        });
        if self.is_alone() {
            return;
        }
        let first = self.first();
        for transient in [1.0, 2.0] {
            self.attempt(&vec![(Adjustment::Transient, first, transient)]);
        }
    }

    /// Goes up by factors; one miss may lie between two hits.
    fn raise(&mut self, mut hit: impl FnMut(&mut Self, f64) -> bool) {
        let (mut misses, mut factor) = (0, KV_FACTOR);
        while misses < 2 {
            if hit(self, factor) {
                (misses, factor) = (0, KV_FACTOR);
            } else {
                misses += 1;
                factor *= KV_FACTOR;
            }
        }
    }

    /// The greatest kv of the axes times a factor. With servo lag an axis alone goes no higher than those with which it
    /// interpolates: the worst one determines the entry [000:9696-9698].
    fn kv(&self, what: Adjustment, factor: f64) -> Try {
        let axes = self.kv_axes();
        let greatest = |axes: &[u8]| {
            let values = axes.iter().filter_map(|axis| self.value(what, *axis));
            values.fold(0.0, f64::max)
        };
        let mut kv = greatest(&axes) * factor;
        if self.is_alone() && what == Adjustment::KvLag {
            let others: Vec<u8> = path_axes(&self.list).map(|axis| axis.index).collect();
            kv = kv.min(greatest(&others));
        }
        axes.into_iter().map(|axis| (what, axis, kv)).collect()
    }

    /// MP1830: the greatest machining feed in percent of rapid traverse [000:9684-9688]; where one entry holds for all axes, of
    /// that of the slowest one, so that it lies above the feed for each [001:2677-2679].
    fn kink_points(&self) -> Vec<(u8, f64)> {
        let rapids = path_axes(&self.list).map(|axis| axis.motion.rapid_mm_min);
        let least = rapids.fold(f64::INFINITY, f64::min);
        let common = self.list.is_common(Adjustment::KinkPoint);
        let points = self.subject.axes.iter().map(|axis| {
            let rapid = if common { least } else { axis.motion.rapid_mm_min };
            let feed = self.machining_mm_min.unwrap_or(rapid / 2.0);
            (axis.index, (100.0 * feed / rapid).min(100.0))
        });
        points.collect()
    }

    /// Backlash, reversal peaks and stiction.
    fn mechanics(&mut self) {
        let play = self.best.backlash_mm.clone();
        let backlash: Try = std::iter::zip(&self.subject.axes, play)
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
        for axis in self.indices() {
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
        let first = self.first();
        // Higher kv may bear what the mechanics spoiled before.
        let what = match self.list.axis_parameters(first).precontrol_in_automatic {
            true => Adjustment::KvPrecontrol,
            false => Adjustment::KvLag,
        };
        let kv = self.kv(what, KV_FACTOR);
        self.attempt(&kv);
    }

    /// The integral factor at standstill: from 100 in steps of 100, for drives without play, and not beside the automatic
    /// offset adjustment [000:9790-9798].
    fn integral(&mut self) {
        for (place, axis) in self.indices().into_iter().enumerate() {
            let now = self.list.axis_parameters(axis);
            let play = self.best.backlash_mm.get(place).map_or(0.0, |play| play.abs());
            let has_play = play > BACKLASH_MIN_MM || now.compensation.backlash_mm != 0.0;
            if now.digital.is_some() || has_play || now.offset_interval_s > 0.0 {
                continue;
            }
            for step in 1..=INTEGRAL_STEPS {
                let rest = |test: &AxisTest| test.standstill_mm.get(place).copied().unwrap_or(0.0);
                if rest(&self.best) < STANDSTILL_MIN_MM {
                    break;
                }
                let factor = INTEGRAL_STEP * f64::from(step);
                let taken =
                    self.attempt_by(&vec![(Adjustment::IntegralFactor, axis, factor)], |test, best| {
                        rest(test) < rest(best) * BETTER && test.contour_mm * BETTER <= best.contour_mm
                    });
                if !taken {
                    break;
                }
            }
        }
    }
}
