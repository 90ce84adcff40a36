//! Values that are in range each, but do not go together.
//!
//! The control's editor does not look for them; each rule is a sentence of the manual.
//!
//! Decision: A list of which no machine can be (MP850 to itself, in a circle or to an absent axis, two axes of one
//! letter) is an error at its line, at power-on and in the list editor, too

use crate::settings::{AxisParameters, PlcParameters, SpindleOutput, SpindleParameters, Station};
use crate::{ControlModel, ListText, ParameterId, ParameterList};

/// Values that do not go together.
#[derive(Clone, Debug, PartialEq)]
pub struct Inconsistency {
    /// The parameter that is wrong, or one of them.
    pub id: ParameterId,
    /// What the manual demands, as a sentence about the fault: "the axis cannot move ..".
    pub rule: &'static str,
    /// What it is here.
    pub detail: String,
    /// Where the manuals say so, as `000:5012`.
    pub source: &'static str,
    /// There is no such machine: the list is faulty, and no control is switched on with it.
    pub impossible: bool,
}

impl ListText {
    /// What does not go together in a list that can be read as a whole; nothing where it has no entry.
    pub fn inconsistencies(&self) -> Vec<Inconsistency> {
        if self.entries().is_empty() {
            return Vec::new();
        }
        let mut list = ParameterList::smallest(self.model());
        list.take(self);
        list.inconsistencies()
    }
}

impl ParameterList {
    /// Everything that does not go together, by the rules of the manuals. Empty for a programming station,
    /// which moves nothing.
    pub fn inconsistencies(&self) -> Vec<Inconsistency> {
        if self.operation_parameters().station != Station::Machine {
            return Vec::new();
        }
        let axes: Vec<AxisParameters> = (0..self.model().limits().axes_max)
            .map(|index| self.axis_parameters(index))
            .filter(|axis| axis.active)
            .collect();
        let mut found = Vec::new();
        let mut report = Reporter {
            list: self,
            found: &mut found,
        };
        for axis in &axes {
            travel(axis, &mut report);
            if axis.controlled {
                lag(axis, &mut report);
                monitoring(axis, &mut report);
            }
            offset(axis, &mut report);
        }
        letters(&axes, &mut report);
        assignment(&axes, &mut report);
        same_kv(&axes, &mut report);
        reference_run(&axes, &mut report);
        synchronized(&axes, &mut report);
        spindle(&self.spindle_parameters(), &axes, &mut report);
        strobes(&self.plc_parameters(), &mut report);
        found
    }
}

struct Reporter<'a> {
    list: &'a ParameterList,
    found: &'a mut Vec<Inconsistency>,
}

impl Reporter<'_> {
    fn is_old(&self) -> bool {
        matches!(
            self.list.model().family(),
            ControlModel::Tnc151 | ControlModel::Tnc155
        )
    }

    /// Reports when a rule does not hold. `new` is number and index, `old` the number in the list of the
    /// TNC 151/155.
    fn check(
        &mut self,
        holds: bool,
        (new, index, old): (u16, Option<u8>, u16),
        rule: &'static str,
        source: &'static str,
        detail: impl FnOnce() -> String,
    ) {
        if holds {
            return;
        }
        let id = if self.is_old() {
            ParameterId {
                number: old,
                index: None,
            }
        } else {
            ParameterId { number: new, index }
        };
        self.found.push(Inconsistency {
            id,
            rule,
            detail: detail(),
            source,
            impossible: false,
        });
    }

    /// Reports what no machine can be when a rule does not hold.
    fn demand(
        &mut self,
        holds: bool,
        name: (u16, Option<u8>, u16),
        rule: &'static str,
        source: &'static str,
        detail: impl FnOnce() -> String,
    ) {
        self.check(holds, name, rule, source, detail);
        if let (false, Some(found)) = (holds, self.found.last_mut()) {
            found.impossible = true;
        }
    }
}

fn travel(axis: &AxisParameters, report: &mut Reporter) {
    if axis.travel.modulo.is_some() {
        return;
    }
    let ranges = if report.is_old() { 1 } else { 3 };
    for (range, [min, max]) in (0u16..ranges).zip(axis.travel.ranges_mm) {
        let name = (910 + range, Some(axis.index), 44 + 2 * u16::from(axis.index));
        report.check(
            min < max,
            name,
            "the axis cannot move between its software limits",
            "000:3438-3497",
            || format!("traverse range {}: {min} to {max}", range + 1),
        );
    }
}

fn lag(axis: &AxisParameters, report: &mut Reporter) {
    let (index, lag) = (Some(axis.index), axis.lag);
    let v_m_min = axis.motion.rapid_mm_min / 1000.0;
    // [000:4907]
    let kink = lag.kink_percent / 100.0;
    let lag_mm = v_m_min / lag.kv * (kink + (1.0 - kink) / lag.kink_factor);
    let rule = "rapid traverse gives POSITIONING ERROR in lag operation";
    report.check(
        lag.monitoring_mm > lag_mm,
        (1710, index, 175),
        rule,
        "000:9806-9817",
        || {
            format!(
                "{} mm, the lag at rapid traverse is {lag_mm:.3} mm",
                lag.monitoring_mm
            )
        },
    );
    let rule = "the limit for EMERGENCY STOP is not above the cancellable one";
    report.check(
        lag.emergency_mm > lag.monitoring_mm,
        (1720, index, 174),
        rule,
        "000:5200-5206",
        || format!("{} mm and {} mm", lag.emergency_mm, lag.monitoring_mm),
    );
    let precontrol = axis.precontrol;
    let ascends = precontrol.emergency_mm > precontrol.monitoring_mm;
    report.check(ascends, (1420, index, 57), rule, "000:5228-5238", || {
        format!(
            "{} mm and {} mm",
            precontrol.emergency_mm, precontrol.monitoring_mm
        )
    });
    let rule = "pre-control needs a kv factor of 0.1 at least";
    let name = (1510, index, 32 + u16::from(axis.index));
    report.check(
        !axis.precontrol_in_automatic || precontrol.kv >= 0.1,
        name,
        rule,
        "000:4984-4991",
        || format!("kv {:.3} (m/min)/mm", precontrol.kv),
    );
    let rule = "manual feed is above rapid traverse";
    let (manual, rapid) = (axis.motion.manual_mm_min, axis.motion.rapid_mm_min);
    report.check(
        manual <= rapid,
        (1020, index, 4 + u16::from(axis.index)),
        rule,
        "000:4822",
        || format!("{manual} and {rapid} mm/min"),
    );
}

fn monitoring(axis: &AxisParameters, report: &mut Reporter) {
    let (window, standstill) = (axis.monitoring.window_mm, axis.monitoring.standstill_mm);
    let rule = "standstill monitoring reacts inside the positioning window";
    report.check(
        standstill > window,
        (1110, Some(axis.index), 169),
        rule,
        "000:5289-5300",
        || format!("{standstill} mm, the window is {window} mm"),
    );
}

fn offset(axis: &AxisParameters, report: &mut Reporter) {
    let (factor, interval_s) = (axis.output.integral_factor, axis.offset_interval_s);
    let holds = factor == 0.0 || interval_s == 0.0;
    let rule = "integral factor and automatic offset adjustment are both active";
    let name = (1080, Some(axis.index), 28 + u16::from(axis.index));
    report.check(holds, name, rule, "000:5012", || {
        format!("factor {factor}, interval {interval_s} s")
    });
}

/// A block names an axis by its letter: the 4th and the 5th axis have different ones (inferred) [000:3350-3370].
fn letters(axes: &[AxisParameters], report: &mut Reporter) {
    for (at, axis) in axes.iter().enumerate() {
        let before = axes.get(..at).unwrap_or_default();
        let alike = before.iter().find(|other| other.letter == axis.letter);
        let letter = axis.letter.map_or(' ', bahn_path::Axis::letter);
        report.demand(
            alike.is_none(),
            (410, Some(axis.index), 90),
            "two axes have the same letter",
            "000:3350-3370",
            || {
                format!(
                    "axes {} and {} are {letter}",
                    alike.map_or(0, |other| other.index + 1),
                    axis.index + 1
                )
            },
        );
    }
}

fn assignment(axes: &[AxisParameters], report: &mut Reporter) {
    for (at, axis) in axes.iter().enumerate() {
        let before = axes.get(..at).unwrap_or_default();
        let index = Some(axis.index);
        let input = axis.wiring.input;
        let free = before.iter().all(|other| other.wiring.input != input);
        let rule = "two axes have the same encoder input";
        report.check(
            free,
            (110, index, 253 + u16::from(axis.index)),
            rule,
            "000:3374-3391",
            || format!("X{}", input + 1),
        );
        let output = axis.wiring.output;
        let free = before.iter().all(|other| other.wiring.output != output);
        let rule = "two axes have the same nominal value output";
        report.check(free, (120, index, 0), rule, "000:3393-3406", || {
            format!("output {}", output + 1)
        });
    }
}

/// The main axes interpolate; their following errors must agree [000:4780-4788].
fn same_kv(axes: &[AxisParameters], report: &mut Reporter) {
    let main: Vec<&AxisParameters> = axes
        .iter()
        .filter(|axis| axis.index < 3 && axis.controlled)
        .collect();
    let Some(first) = main.first() else { return };
    for axis in main.iter().skip(1) {
        let name = (1810, Some(axis.index), 177 + u16::from(axis.index));
        let rule = "axes that interpolate have different kv factors";
        report.check(axis.lag.kv == first.lag.kv, name, rule, "000:4780-4788", || {
            format!("{} and {}", axis.lag.kv, first.lag.kv)
        });
    }
}

fn reference_run(axes: &[AxisParameters], report: &mut Reporter) {
    // A slave whose relation is that at switch-on needs no mark [000:4492-4496]; the PLC passes those of its own axes:
    // module 9123.
    let needs_mark = |axis: &&AxisParameters| {
        let slave = axis.synchronization;
        axis.controlled && !axis.plc_axis && (slave.master.is_none() || slave.coupling.from_reference_marks)
    };
    for axis in axes.iter().filter(needs_mark) {
        let rule = "the axis is not referenced automatically";
        report.check(
            axis.reference.place.is_some(),
            (1340, Some(0), 59),
            rule,
            "000:4649-4654",
            || format!("MP1340 does not name axis {}", axis.index + 1),
        );
    }
}

/// Masters and slaves [000:4465] [000:4492-4539].
fn synchronized(axes: &[AxisParameters], report: &mut Reporter) {
    const PAIRS_MAX: usize = 2;
    let slaves = || axes.iter().filter(|axis| axis.synchronization.master.is_some());
    if let Some(third) = slaves().nth(PAIRS_MAX) {
        let rule = "more than two pairs of axes are synchronized";
        report.check(false, (850, Some(third.index), 0), rule, "000:4465", || {
            format!("{} slaves", slaves().count())
        });
    }
    for slave in slaves() {
        let name = |number| (number, Some(slave.index), 0);
        let master = axes
            .iter()
            .find(|axis| Some(axis.index) == slave.synchronization.master);
        let Some(master) = master.filter(|master| master.index != slave.index && master.controlled) else {
            let rule = "the axis follows one that does not exist, or itself";
            let number = slave.synchronization.master.map_or(0, |master| master + 1);
            report.demand(false, name(850), rule, "000:4467-4486", || {
                format!("axis {} follows axis {number}", slave.index + 1)
            });
            continue;
        };
        let pair = || format!("master is axis {}", master.index + 1);
        let is_rotary = |axis: &AxisParameters| axis.letter.is_some_and(bahn_path::Axis::is_rotary);
        let alone = master.synchronization.master.is_none();
        let rule = "an axis is master and slave at the same time";
        report.demand(alone, name(850), rule, "000:4519-4539", pair);
        let rule = "master and slave are to be linear axes";
        let linear = !is_rotary(master) && !is_rotary(slave);
        report.check(linear, name(850), rule, "000:4519-4539", pair);
        let rule = "master and slave have different kv factors";
        report.check(
            slave.lag.kv == master.lag.kv,
            name(1810),
            rule,
            "000:4519-4539",
            pair,
        );
        let rule = "one of master and slave has a digital speed controller";
        let alike = slave.digital.is_some() == master.digital.is_some();
        report.check(alike, (1900, None, 0), rule, "000:4519-4539", pair);
        if slave.synchronization.coupling.from_reference_marks {
            let rule = "master and slave look for their reference marks in different ways";
            let alike = slave.reference.kind == master.reference.kind;
            report.check(alike, name(1350), rule, "000:4497-4504", pair);
            let rule = "the slave comes before its master in the reference run";
            let after = slave.reference.place.is_none() || slave.reference.place > master.reference.place;
            report.check(after, (1340, Some(0), 0), rule, "000:4497-4504", pair);
        }
    }
}

/// The strobe of an M, S or T function is off before its acknowledgement is looked at [001:548-552].
fn strobes(plc: &PlcParameters, report: &mut Reporter) {
    let Some(times) = plc.strobes else {
        return;
    };
    let rule = "the strobe is not off before E17 is looked at";
    report.check(
        times.off_s < times.test_s,
        (0, None, 121),
        rule,
        "001:548-552",
        || format!("off after {:.2} s, E17 after {:.2} s", times.off_s, times.test_s),
    );
}

fn spindle(spindle: &SpindleParameters, axes: &[AxisParameters], report: &mut Reporter) {
    if matches!(spindle.output, SpindleOutput::Analogue { .. }) {
        let codes = spindle.codes;
        let unlimited = codes.min <= 1 && codes.max == 99 && codes.step == 1;
        let rule = "the analogue spindle needs a speed code without limits";
        report.check(unlimited, (3020, None, 63), rule, "000:5478-5480", || {
            format!("codes {} to {}, step {}", codes.min, codes.max, codes.step)
        });
        let speeds: Vec<f64> = spindle.settings.gears.map(|gear| gear.rated_rpm).to_vec();
        let used = speeds
            .iter()
            .rposition(|speed| *speed > 0.0)
            .map_or(0, |last| last + 1);
        let ascending = speeds
            .iter()
            .take(used)
            .is_sorted_by(|slower, faster| slower < faster);
        let rule = "the gear ranges do not ascend";
        report.check(
            ascending && used > 0,
            (3510, Some(0), 78),
            rule,
            "000:5522-5524",
            || format!("{speeds:?} rpm"),
        );
        let [least, greatest] = spindle.tapping.override_percent;
        let rule = "the feed override stops every tapping cycle";
        report.check(
            greatest > 0.0,
            (7110, Some(1), 183),
            rule,
            "000:6094-6098",
            || format!("{least} to {greatest} %"),
        );
        let taken = axes.iter().find(|axis| axis.wiring.output == 5);
        let rule = "an axis has the output of the spindle";
        report.check(
            taken.is_none(),
            (120, taken.map(|axis| axis.index), 0),
            rule,
            "000:3374-3378",
            String::new,
        );
    }
    if spindle.controlled {
        let taken = axes.iter().find(|axis| axis.wiring.input == spindle.input);
        let rule = "an axis has the encoder input of the spindle";
        report.check(
            taken.is_none(),
            (110, taken.map(|axis| axis.index), 253 + u16::from(spindle.input)),
            rule,
            "000:3374-3378",
            String::new,
        );
        let window = spindle.tapping.window_mm;
        let widest = axes
            .iter()
            .map(|axis| axis.monitoring.window_mm)
            .fold(0.0, f64::max);
        let rule = "the window of rigid tapping is wider than the positioning window";
        report.check(window <= widest, (7150, None, 0), rule, "000:6137-6141", || {
            format!("{window} mm and {widest} mm")
        });
    }
    let [least, greatest] = spindle.settings.override_percent;
    let rule = "the least spindle override is above the greatest";
    report.check(
        least <= greatest,
        (3310, Some(1), 89),
        rule,
        "000:5585-5589",
        || format!("{least} and {greatest} %"),
    );
}
