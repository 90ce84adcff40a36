//! The channel: blocks become a path with places where functions are output and waited for; a cycle loop drives along it.
//!
//! `take` (in `prepare`) turns a block into elements and actions; the [gates](bahn_kernel::gates) of the kernel drive along them
//! and do what is to be done there, and `side` is what they ask and tell. `drive` is what the script says of a cycle, `programs`
//! runs one program after the other.

mod beside;
mod decoding;
mod drive;
mod fault;
mod in_force;
mod order;
mod own;
mod plan;
mod prepare;
mod programs;
mod ranges;
mod record;
mod resolve;
mod side;
mod skipped;

use bahn_kernel::gates::{Gates, Moment};
use bahn_motion::Limits;
use bahn_path::Position;

use crate::bounds::Bounds;
use crate::plc::{Plc, PlcMemory, Script};
use crate::report::Skipped;
use crate::settings::ChannelSettings;
use order::OrderId;
use own::Own;
use plan::{Plan, Taking};
use side::Side;

/// A channel: what is planned, what moves along it, and what is done where that is.
struct Channel<'a> {
    plan: Plan<'a>,
    gates: Gates<OrderId, Own>,
    side: Side<'a>,
    progress: Progress,
}

/// How far the run is.
#[derive(Default)]
struct Progress {
    /// File of the program that runs.
    program: String,
    /// Resets that were done.
    reset_count: usize,
    /// Starts of the operator that are over.
    starts: usize,
    /// What was passed over before the block with which the run began.
    skipped: Option<Vec<Skipped>>,
    /// Functions for which the path stands.
    missing: Vec<OrderId>,
    /// How far the run goes at most.
    bounds: Bounds,
}

impl<'a> Channel<'a> {
    fn new(
        settings: &'a ChannelSettings,
        limits: &'a Limits,
        script: Option<&'a Script>,
        memory: Option<&'a mut (dyn PlcMemory + 'a)>,
        start: Position,
    ) -> Channel<'a> {
        // The interpolator has the same bounds.
        let cycle_s = if limits.cycle_s.is_nan() {
            0.0001
        } else {
            limits.cycle_s.clamp(0.0001, 1.0)
        };
        let plc = Plc::new(script, memory, cycle_s);
        Channel {
            plan: Plan::new(settings),
            gates: Gates::new(limits, cycle_s, start, settings.pre_output.value_to_go),
            side: Side::new(settings, limits, plc, cycle_s),
            progress: Progress::default(),
        }
    }

    /// Now, and where the path is.
    fn now(&self) -> Moment {
        self.gates.now(&self.side)
    }

    /// What takes a block into the path.
    fn taking(&mut self) -> Taking<'_> {
        let Side {
            orders,
            ranges,
            late,
            record,
            plc,
            cycle_s,
            ..
        } = &mut self.side;
        Taking {
            in_force: &self.plan.in_force,
            decoding: &mut self.plan.decoding,
            gates: &mut self.gates,
            orders,
            ranges,
            late,
            cycle_s: *cycle_s,
            script: plc.script(),
            warnings: &mut record.warnings,
        }
    }
}
