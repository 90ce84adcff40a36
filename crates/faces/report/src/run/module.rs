//! The positioning module beside a machine: followed from cycle to cycle, and told of in the end.

use std::collections::BTreeMap;

use bahn_host::{Host, HostError, Next, Notice, Reader, Stamped};
use bahn_link::PositioningModule;
use bahn_tnc::{AxisSignal, Signal};
use serde::Serialize;

use super::listed::{Listed, Said};
use super::measured::PlcLoad;
use crate::record::tidy;
use crate::text::list;

/// So often it is asked whether all axes have their references, contour cycles of the control.
const LOOK_CYCLES: u32 = 10;

/// A positioning module that goes along with a run.
pub struct ModuleRun {
    /// The module, and how it is wired.
    pub module: PositioningModule,
    name: String,
    notices: Reader<Stamped>,
    listed: Listed,
    /// Largest lag of each axis, mm or degrees.
    lags: Vec<(char, f64)>,
    /// When all axes had their references, µs.
    ready_us: Option<u64>,
    cycles: u32,
    plc: PlcLoad,
}

impl ModuleRun {
    /// A module that was switched on with its control, under the name of its machine.
    pub fn new(module: PositioningModule, name: &str) -> ModuleRun {
        let letters = module.host.control().axis_letters();
        ModuleRun {
            name: name.to_owned(),
            notices: module.host.notices(),
            listed: Listed::default(),
            lags: letters.map(|letter| (letter, 0.0)).collect(),
            ready_us: None,
            cycles: 0,
            plc: PlcLoad::default(),
            module,
        }
    }

    /// Follows its control through a contour cycle.
    pub(super) fn cycle(&mut self, control: &mut Host) -> Result<(), HostError> {
        self.module.follow(control)?;
        let control = self.module.host.control();
        for next in self.notices.by_ref() {
            if let Next::Item(Stamped {
                notice: Notice::Shown(shown),
                ..
            }) = next
            {
                self.listed.message(control, &shown);
            }
        }
        for (letter, most) in &mut self.lags {
            let lag = control.first().observe(&Signal::Axis(*letter, AxisSignal::Lag));
            *most = most.max(lag.abs());
        }
        self.plc.cycle(control.plc_percent());
        self.cycles = (self.cycles + 1) % LOOK_CYCLES;
        if self.ready_us.is_none() && self.cycles == 0 {
            let all = control.snapshot().axes.iter().all(|axis| axis.referenced);
            self.ready_us = all.then(|| control.time_us());
        }
        Ok(())
    }

    /// One of its axes moves.
    pub(super) fn moves(&self) -> bool {
        !self.module.host.control().stands()
    }

    pub(super) fn report(&self) -> ModuleReport {
        let control = self.module.host.control();
        let snapshot = control.snapshot();
        let axes = self.lags.iter().map(|(letter, max_lag)| {
            let axis = snapshot.axes.iter().find(|axis| axis.letter == *letter);
            let report = ModuleAxis {
                position: tidy(axis.map_or(0.0, |axis| axis.machine)),
                referenced: axis.is_some_and(|axis| axis.referenced),
                max_lag: tidy(*max_lag),
            };
            (*letter, report)
        });
        let [received, sent] = self.module.characters();
        ModuleReport {
            machine: self.name.clone(),
            model: control.model().id(),
            ready_s: self.ready_us.map(|us| us as f64 * 1e-6),
            axes: axes.collect(),
            characters: Characters { received, sent },
            plc_max_percent: tidy(self.plc.longest()),
            plc_mean_percent: tidy(self.plc.mean()),
            messages: self.listed.messages.clone(),
        }
    }
}

/// What is told of a positioning module.
#[derive(Clone, Debug, Serialize)]
pub(super) struct ModuleReport {
    machine: String,
    model: &'static str,
    /// When all axes had their references, s since power-on.
    ready_s: Option<f64>,
    axes: BTreeMap<char, ModuleAxis>,
    characters: Characters,
    /// Nominal processing time: 100 % are the PLC's part of its cycle.
    plc_max_percent: f64,
    plc_mean_percent: f64,
    messages: Vec<Said>,
}

/// An axis of it in the end, mm or degrees in machine coordinates.
#[derive(Clone, Debug, Serialize)]
struct ModuleAxis {
    position: f64,
    referenced: bool,
    max_lag: f64,
}

/// How many characters went over the line.
#[derive(Clone, Debug, Serialize)]
struct Characters {
    received: u64,
    sent: u64,
}

impl ModuleReport {
    pub(super) fn text(&self, row: &mut impl FnMut(&str, &str)) {
        let ready = match self.ready_s {
            Some(ready_s) => format!("all axes have their references after {ready_s:.1} s"),
            None => "its axes have no references".to_owned(),
        };
        row("Module", &format!("{}: {ready}", self.machine));
        let axes = self.axes.iter();
        let axes: Vec<String> = axes
            .map(|(letter, axis)| format!("{letter} {:.3} (lag {:.3})", axis.position, axis.max_lag))
            .collect();
        row("", &format!("at the end {}", axes.join(", ")));
        let Characters { received, sent } = &self.characters;
        row(
            "",
            &format!("{received} characters came over RS-422, {sent} went"),
        );
        list(row, "Of the module", &self.messages, Said::text);
    }
}
