//! A stylus is led along a surface: the axes follow a [`Scan`], and tell it where they are.
//!
//! Decision: On a machine the points are those of the servo step in which the stylus is deflected; an axis that
//! stands in its position window is where it is to be

use bahn_motion::{Scan, ScanStep, Sense};
use bahn_path::{Axis, Position, ScanFault, ScanJob, ScanPoint};

use crate::axes::OwnAxes;
use crate::axis::{AxisUnit, Mover};
use crate::kinematics::Chain;
use crate::leaning::MAIN;
use crate::now::Now;

/// The axes stand elsewhere than the scan has left them, mm.
const ELSEWHERE_MM: f64 = 1e-6;

/// What the stylus says in a cycle.
#[derive(Clone, Copy, Debug)]
pub struct Felt {
    /// The stylus is off its rest position.
    pub deflected: bool,
    /// How far, along the axes of the machine, mm.
    pub deflection_mm: ScanPoint,
}

/// A scan that the axes follow.
#[derive(Clone, Debug)]
pub struct ScanMove {
    scan: Scan,
    job: ScanJob,
    /// Deflected in the last servo step; where the tip was when it became so, as long as nobody has asked.
    deflected: bool,
    touch: Option<ScanPoint>,
    /// Where the tip is, nominal for the axes without an encoder.
    tip: ScanPoint,
    /// Lines that had ended when somebody asked last.
    lines: u32,
    /// The cycle that moved it last, µs.
    moved_us: u64,
}

impl ScanMove {
    /// A scan, no faster than its axes.
    pub fn new(mut job: ScanJob, axes: &OwnAxes, now: &Now) -> ScanMove {
        let axes = || axes.iter().filter(|unit| MAIN.contains(&unit.axis));
        let least = |of: fn(&AxisUnit) -> f64| axes().map(of).fold(f64::INFINITY, f64::min);
        let acceleration = least(|unit| unit.parameters.motion.acceleration_m_s2);
        let rapid = least(|unit| unit.parameters.motion.rapid_mm_min);
        for feed in [&mut job.rules.rapid_mm_min, &mut job.rules.probing_mm_min] {
            *feed = feed.min(rapid);
        }
        let scan = Scan::new(job, acceleration);
        ScanMove {
            tip: scan.position(),
            scan,
            job,
            deflected: false,
            touch: None,
            lines: 0,
            moved_us: now.us,
        }
    }

    /// The scan may set off: its clock begins now.
    pub fn begin(&mut self, now: &Now) {
        self.moved_us = now.us;
    }

    /// Range, pattern and feeds of the scan.
    pub fn job(&self) -> &ScanJob {
        &self.job
    }

    /// A scan moves this axis: X, Y or Z.
    pub fn leads(axis: Axis) -> bool {
        MAIN.contains(&axis)
    }

    /// It comes to an end for a fault.
    pub fn break_off(&mut self, fault: ScanFault) {
        self.scan.break_off(fault);
    }

    /// The end of a line was reached since this was asked.
    pub fn takes_line_end(&mut self) -> bool {
        let ended = self.scan.lines_ended();
        std::mem::replace(&mut self.lines, ended) != ended
    }

    /// Takes the position of the tip when the stylus is deflected; once in each servo step.
    pub fn watch<'a>(&mut self, deflected: bool, axes: impl Iterator<Item = &'a AxisUnit>, chain: &Chain) {
        let mut actual = Position::UNKNOWN;
        for unit in axes {
            actual[unit.axis] = unit.servo.actual_mm();
        }
        self.tip = self.tip_at(&chain.to_path(&actual));
        if deflected && !self.deflected {
            self.touch.get_or_insert(self.tip);
        }
        self.deflected = deflected;
    }

    fn tip_at(&self, axes: &Position) -> ScanPoint {
        std::array::from_fn(|k| axes[MAIN[k]] + self.job.beside[k])
    }

    /// Moves the axes for a cycle.
    pub fn moves(
        &mut self,
        running: bool,
        felt: &Felt,
        axes: &mut OwnAxes,
        chain: &Chain,
        now: &Now,
    ) -> ScanStep {
        self.regain(axes, chain, now);
        let feed = self.feed(running, now);
        let touch = if feed > 0.0 { self.touch.take() } else { self.touch };
        let sense = Sense {
            deflected: felt.deflected,
            at: self.place(axes),
            touch,
            deflection: felt.deflection_mm,
        };
        let step = self.scan.cycle(now.time_s, &sense, feed);
        self.lead(axes, chain, now);
        match step {
            ScanStep::Over(_) if !axes.have_arrived() => ScanStep::Moves,
            step => step,
        }
    }

    /// Without feed enable the axes may stand elsewhere: it goes on from there. Axes that CE took over from where they are
    /// go back with NC start to where it has left them. The stylus leaves the surface first, so that no point is taken where
    /// axes ran on (inferred).
    fn regain(&mut self, axes: &OwnAxes, chain: &Chain, now: &Now) {
        let passed_us = now.us.saturating_sub(self.moved_us);
        self.moved_us = now.us;
        // Two cycles and more without a movement.
        if passed_us as f64 * 1e-6 < 1.5 * now.time_s {
            return;
        }
        let here = self.tip_at(&chain.to_path(&axes.left_position()));
        let nominal = self.scan.position();
        self.touch = None;
        let away = (0..3).any(|k| (here[k] - nominal[k]).abs() > ELSEWHERE_MM);
        self.scan.stand_at(if away { here } else { nominal });
    }

    /// What the override leaves of the speeds; rapid traverse may be limited by PLC and probe.
    fn feed(&self, running: bool, now: &Now) -> f64 {
        if !running {
            return 0.0;
        }
        let limit = now.rapid_limit_mm_min / self.job.rules.rapid_mm_min;
        (now.feed_percent / 100.0).min(limit).min(1.0)
    }

    /// Where the tip is. An axis that stands in its position window is where it is to be.
    fn place(&self, axes: &OwnAxes) -> ScanPoint {
        let mut at = self.tip;
        let (nominal, velocity) = (self.scan.position(), self.scan.velocity_mm_s());
        for unit in axes.iter() {
            let place = MAIN.iter().position(|axis| *axis == unit.axis);
            if let Some(place) = place.filter(|place| velocity[*place] == 0.0)
                && unit.servo.in_position()
            {
                at[place] = nominal[place];
            }
        }
        at
    }

    /// The axes follow the scan.
    fn lead(&self, axes: &mut OwnAxes, chain: &Chain, now: &Now) {
        let (tip, mut position) = (self.scan.position(), chain.to_path(&axes.programmed_position()));
        for (place, axis) in MAIN.into_iter().enumerate() {
            position[axis] = tip[place] - self.job.beside[place];
        }
        let (nominal, time) = (chain.to_axes(&position), now.time_s);
        for unit in axes.iter_mut() {
            let value = nominal[unit.axis];
            let leads = MAIN.contains(&unit.axis) && value.is_finite() && !unit.is_plc_axis();
            if leads && matches!(unit.mover, Mover::None | Mover::Path) {
                unit.follow_probe(value, time);
            }
        }
    }
}
