//! The spindle: how steep its ramp in a thread may be, and kv of its orientation [000:5883] [000:6122-6140].

use std::fmt::Write as _;

use bahn_parameters::{ParameterList, PerPlcAxis};
use bahn_path::Axis;

use super::{BETTER, Change, changes};
use crate::trial;
use bahn_host::LoadedMachine;
use bahn_host::Threads;

/// A thread ends so near to its depth, mm: "spindle overshoot is to be avoided" [000:6128].
const DEPTH_WITHIN_MM: f64 = 0.01;
/// Depth of the threads, mm, as far as the tool axis has room, and their pitch.
const DEPTH_MM: f64 = 15.0;
const PITCH_MM: f64 = 1.25;
/// The threads of a gear are cut at its rated speed, at most with this part of rapid traverse *(inferred)*.
const RAPID_PART: f64 = 0.8;
/// The ramp MP3410.3 goes down by this factor until threads keep their depth, and up as long as they are cut faster.
const RAMP_FACTOR: f64 = 0.5;
/// Steps between a ramp that keeps the depth and one that does not.
const BISECTIONS: u8 = 3;
/// Steepest and flattest ramp, V/ms [000:6137].
const RAMP_RANGE: [f64; 2] = [0.0001, 1.9999];
/// kv of the orientation goes on by this factor, within its range [000:5913].
const KV_FACTOR: f64 = 1.4;
const KV_RANGE: [f64; 2] = [0.1, 10.0];
/// A trial is given up after this time of the machine, µs.
const TRIAL_MAX_US: u64 = 600_000_000;

/// What a trial has shown of threads in all gear ranges.
#[derive(Clone, Debug, PartialEq)]
pub struct ThreadTest {
    /// Largest distance of the depth that was reached from that which was commanded, mm.
    pub beyond_mm: f64,
    /// Largest distance of the tool from where the angle of the spindle says, mm.
    pub off_mm: f64,
    /// Time for the threads, s.
    pub threads_s: f64,
    /// Time for the orientation before a thread, s, of each gear range that was tried.
    pub orientation_s: Vec<(u8, f64)>,
}

/// What the assistant found for the spindle.
#[derive(Clone, Debug)]
pub struct TunedSpindle {
    /// With the list as it was.
    pub before: ThreadTest,
    /// With what it proposes.
    pub after: ThreadTest,
    /// What it proposes, in ascending order.
    pub changes: Vec<Change>,
    /// Trials that were run.
    pub trials: usize,
}

struct Assistant<'a> {
    machine: &'a LoadedMachine,
    blocks: String,
    gears: Vec<u8>,
    list: ParameterList,
    best: ThreadTest,
    trials: usize,
}

/// Tunes the spindle of a machine by a thread of cycle 17 and one of cycle 18 in each gear range: MP3410.3, the
/// steepest ramp with which threads keep their depth, and MP3440, kv with which it is oriented soonest.
///
/// # Errors
/// When the spindle has no position control, or the list does not get it through the trial.
pub fn tune_spindle(machine: &LoadedMachine, list: &ParameterList) -> Result<TunedSpindle, String> {
    let spindle = list.spindle_parameters();
    if list.model().limits().has_old_numbers() {
        return Err(format!(
            "the {} has no cycle 17: its spindle cuts no thread that could be tried; MP168 is its ramp, MP238 kv of its orientation",
            list.model().name()
        ));
    }
    if !spindle.controlled {
        return Err(
            "the spindle is not position controlled (MP3010): it cuts no threads of cycle 17".to_owned(),
        );
    }
    let (blocks, gears) = blocks(machine, list)?;
    let before = prove(machine, list, &blocks, &gears)?;
    let mut assistant = Assistant {
        machine,
        blocks,
        gears,
        list: list.clone(),
        best: before.clone(),
        trials: 1,
    };
    assistant.ramp();
    for gear in assistant.gears.clone() {
        assistant.kv(gear);
    }
    Ok(TunedSpindle {
        before,
        changes: changes(list, &assistant.list),
        after: assistant.best,
        trials: assistant.trials,
    })
}

/// A thread of cycle 17 and one of cycle 18 in each gear range, in the middle of the travel of Z; and the gear ranges.
fn blocks(machine: &LoadedMachine, list: &ParameterList) -> Result<(String, Vec<u8>), String> {
    let mut axes = PerPlcAxis::from_fn(|index| list.axis_parameters(index)).into_iter();
    let axis = axes
        .find(|axis| axis.active && axis.letter == Some(Axis::Z))
        .ok_or("the machine has no axis Z that could tap")?;
    let [least, greatest] = axis.travel.ranges_mm[0];
    let depth = DEPTH_MM.min((greatest - least) / 4.0);
    let zero = Some(machine.datum()[Axis::Z]).filter(|zero| zero.is_finite());
    let top = (least + greatest + depth) / 2.0 - zero.unwrap_or(0.0);
    let (mut text, mut gears, mut slower) = (String::new(), Vec::new(), 0.0);
    for (gear, range) in (0_u8..).zip(list.spindle_parameters().settings.gears) {
        let most = RAPID_PART * axis.motion.rapid_mm_min / PITCH_MM;
        let rpm = range.rated_rpm.min(most).floor();
        if rpm <= slower {
            continue;
        }
        slower = range.rated_rpm;
        gears.push(gear);
        // Writing to a string cannot fail.
        let _ = writeln!(
            text,
            "TOOL CALL 0 Z S{rpm}\nL Z{top:+.3} R0 FMAX M3\nCYCL DEF 9.0 DWELL TIME\nCYCL DEF 9.1 DWELL 1.5\n\
             CYCL DEF 17.0 RIGID TAPPING\nCYCL DEF 17.1 SET UP -0\nCYCL DEF 17.2 DEPTH -{depth:.3}\n\
             CYCL DEF 17.3 PITCH +{PITCH_MM}\nCYCL CALL\nCYCL DEF 18.0 THREAD CUTTING\n\
             CYCL DEF 18.1 DEPTH -{depth:.3}\nCYCL DEF 18.2 PITCH +{PITCH_MM}\nCYCL CALL\nL Z{top:+.3} FMAX"
        );
    }
    match gears.is_empty() {
        true => Err("the spindle has no gear range (MP3510)".to_owned()),
        false => Ok((text, gears)),
    }
}

/// A trial with a list.
fn prove(
    machine: &LoadedMachine,
    list: &ParameterList,
    blocks: &str,
    gears: &[u8],
) -> Result<ThreadTest, String> {
    let mut threads = Threads::default();
    trial::run_within(TRIAL_MAX_US, machine, list, blocks.trim(), |control, plant| {
        let cycle_s = f64::from(control.cycle_us()) * 1e-6;
        threads.cycle(control.first(), plant, cycle_s);
    })?;
    threads.end();
    let cuts = &threads.done;
    if cuts.len() != 2 * gears.len() {
        return Err("the threads were not cut".to_owned());
    }
    let greatest = |of: &dyn Fn(&bahn_host::ThreadCut) -> f64| cuts.iter().map(of).fold(0.0, f64::max);
    let both = gears.iter().copied().zip(cuts.chunks(2));
    Ok(ThreadTest {
        beyond_mm: greatest(&|cut| (cut.reached_mm - cut.depth_mm).abs()),
        off_mm: greatest(&|cut| cut.off_mm),
        threads_s: cuts.iter().map(|cut| cut.path_s).sum(),
        orientation_s: both
            .map(|(gear, cuts)| (gear, cuts.iter().map(|cut| cut.prepared_s).sum()))
            .collect(),
    })
}

impl ThreadTest {
    fn keeps_depth(&self) -> bool {
        self.beyond_mm <= DEPTH_WITHIN_MM
    }

    fn orientation_s(&self, gear: u8) -> f64 {
        let found = self.orientation_s.iter().find(|(own, _)| *own == gear);
        found.map_or(f64::INFINITY, |(_, seconds)| *seconds)
    }
}

impl Assistant<'_> {
    /// Tries an entry; keeps it when that is better.
    fn attempt(
        &mut self,
        number: u16,
        index: u8,
        value: f64,
        better: impl Fn(&ThreadTest, &ThreadTest) -> bool,
    ) -> bool {
        let mut list = self.list.clone();
        if list.assign(&format!("{number}.{index}={value}")).is_err() {
            return false;
        }
        self.trials += 1;
        let Ok(test) = prove(self.machine, &list, &self.blocks, &self.gears) else {
            return false;
        };
        let taken = better(&test, &self.best);
        if taken {
            (self.list, self.best) = (list, test);
        }
        taken
    }

    /// MP3410.3: down until threads keep their depth, then up as long as they do and are cut faster.
    fn ramp(&mut self) {
        let [flattest, steepest] = RAMP_RANGE;
        let rounded = |ramp: f64| (ramp.clamp(flattest, steepest) * 1e4).round() / 1e4;
        let entry = self.list.spindle_parameters().settings.ramps.rigid_v_ms;
        // 0 is no ramp at all.
        let mut ramp = if entry > 0.0 { entry } else { steepest };
        let mut fails = None;
        while !self.best.keeps_depth() && ramp > flattest {
            fails = Some(ramp);
            ramp = rounded(ramp * RAMP_FACTOR);
            self.attempt(3410, 3, ramp, |test, best| test.beyond_mm < best.beyond_mm);
        }
        if !self.best.keeps_depth() {
            return;
        }
        let faster = |test: &ThreadTest, best: &ThreadTest| {
            test.keeps_depth() && test.threads_s < best.threads_s * BETTER
        };
        while fails.is_none() && ramp < steepest {
            let next = rounded(ramp / RAMP_FACTOR);
            match self.attempt(3410, 3, next, faster) {
                true => ramp = next,
                false => fails = Some(next),
            }
        }
        let Some(mut fails) = fails else { return };
        for _ in 0..BISECTIONS {
            let middle = rounded((ramp * fails).sqrt());
            match self.attempt(3410, 3, middle, faster) {
                true => ramp = middle,
                false => fails = middle,
            }
        }
    }

    fn kv_of(&self, gear: u8) -> Option<f64> {
        let gears = self.list.spindle_parameters().settings.gears;
        gears.get(usize::from(gear)).map(|gear| gear.kv)
    }

    /// MP3440 of a gear range: up, or else down, as long as the spindle is oriented sooner and threads keep their depth.
    fn kv(&mut self, gear: u8) {
        for factor in [KV_FACTOR, 1.0 / KV_FACTOR] {
            let mut climbed = false;
            while let Some(kv) = self.kv_of(gear) {
                let [least, greatest] = KV_RANGE;
                let next = ((kv * factor).clamp(least, greatest) * 10.0).round() / 10.0;
                let sooner = |test: &ThreadTest, best: &ThreadTest| {
                    let keeps = test.keeps_depth() || test.beyond_mm <= best.beyond_mm;
                    keeps && test.orientation_s(gear) < best.orientation_s(gear) * BETTER
                };
                if next == kv || !self.attempt(3440, gear, next, sooner) {
                    break;
                }
                climbed = true;
            }
            if climbed {
                return;
            }
        }
    }
}
