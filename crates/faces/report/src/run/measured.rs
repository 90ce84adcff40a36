//! What is measured of a run: where its time goes, how far the axes leave the contour, how deep threads are, how busy the
//! PLC is.

use bahn_host::{Phase, Threads};
use bahn_machine::Machine;
use bahn_path::FeedRate;
use bahn_tnc::Control;

use super::deviation::Deviation;
use super::times::Times;

/// How busy a PLC is: nominal processing time, 100 % are its part of the cycle.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct PlcLoad {
    sum: f64,
    cycles: u64,
    longest: f64,
}

impl PlcLoad {
    /// Takes a contour cycle.
    pub fn cycle(&mut self, percent: f64) {
        self.sum += percent;
        self.cycles += 1;
        self.longest = self.longest.max(percent);
    }

    /// Of the longest scan, %.
    pub fn longest(self) -> f64 {
        self.longest
    }

    /// In the mean, %.
    pub fn mean(self) -> f64 {
        self.sum / self.cycles.max(1) as f64
    }
}

/// What is measured while a program runs.
pub(super) struct Measured {
    pub deviation: Deviation,
    pub threads: Threads,
    pub times: Times,
    pub power_up_us: u64,
    pub reference_us: u64,
    pub program_us: u64,
    pub plc: PlcLoad,
}

impl Measured {
    pub fn new(control: &Control) -> Measured {
        Measured {
            deviation: Deviation::new(control.first()),
            threads: Threads::default(),
            times: Times::default(),
            power_up_us: 0,
            reference_us: 0,
            program_us: 0,
            plc: PlcLoad::default(),
        }
    }

    /// Takes a contour cycle; `running` says that a run is on its way.
    pub fn cycle(&mut self, control: &Control, plant: &Machine, phase: Phase, running: bool) {
        let cycle_us = u64::from(control.cycle_us());
        self.plc.cycle(control.plc_percent());
        match phase {
            Phase::PowerUp => self.power_up_us += cycle_us,
            Phase::Reference => self.reference_us += cycle_us,
            Phase::Program | Phase::Ready => {}
        }
        if running {
            self.program_us += cycle_us;
            self.times.cycle(control);
            let feed = control.element().map(|element| element.feed);
            let contour = matches!(feed, Some(FeedRate::Programmed(_)));
            self.deviation.cycle(control.first(), contour);
            let cycle_s = f64::from(control.cycle_us()) * 1e-6;
            self.threads.cycle(control.first(), plant, cycle_s);
        } else {
            self.deviation.restart();
            self.threads.end();
        }
    }

    /// Waiting in vain is no machining time.
    pub fn take_back(&mut self, time_us: u64) {
        let taken = self.times.take_back(time_us);
        self.program_us = self.program_us.saturating_sub(taken);
    }
}
